"""A folder that builds write into: nothing is lost that somebody wrote."""

import pytest

import coursework
from coursework.cli import demo, run
from coursework.cli.options import BAD, DONE
from coursework.errors import BadInput
from coursework.issuing import build as building
from coursework.issuing import issuing
from coursework.issuing.issued import Issued, issued_content
from coursework.issuing.roster import Student
from coursework.system.writing import File, write_tree

CLASS = [Student("Ada"), Student("Bo"), Student("Cy")]


def wanted(**contents):
    """Files by path, ``__`` for a slash and ``_`` for a dot."""
    paths = {name.replace("__", "/").replace("_", "."): text for name, text in contents.items()}
    return [File(building.Path(path), lambda text=text: text.encode()) for path, text in paths.items()]


def tree(folder):
    return {
        p.relative_to(folder).as_posix(): p.read_text("utf-8")
        for p in folder.rglob("*")
        if p.is_file() and p.name != ".built.json"
    }


FIRST = {"handouts__a_pdf": "pdf", "answers_csv": "form", "issued_json": "one"}


@pytest.fixture
def out(tmp_path):
    assert write_tree(tmp_path / "out", wanted(**FIRST)) == []
    return tmp_path / "out"


def test_the_same_build_again_keeps_what_somebody_wrote_and_what_else_was_built(out):
    (out / "answers.csv").write_text("form, filled")
    (out / "handouts" / "mine.txt").write_text("mine")
    again = wanted(handouts__a_html="html", answers_csv="form", issued_json="one")
    (note,) = write_tree(out, again)
    assert str(out / "answers.csv") in note
    assert "is kept" in note
    assert tree(out) == {
        "handouts/a.pdf": "pdf",
        "handouts/a.html": "html",
        "handouts/mine.txt": "mine",
        "answers.csv": "form, filled",
        "issued.json": "one",
    }
    # What the second build found of the first is still known to be a build's.
    assert write_tree(out, wanted(handouts__a_pdf="better", issued_json="one")) == []
    assert tree(out)["handouts/a.pdf"] == "better"


def test_another_build_takes_the_place_of_the_one_before_and_sets_aside_what_somebody_wrote(out):
    (out / "answers.csv").write_text("form, filled")
    (out / "answers.before.csv").write_text("older")
    (out / "handouts" / "mine.txt").write_text("mine")
    other = wanted(handouts__b_pdf="pdf", answers_csv="other form", issued_json="two")
    (note,) = write_tree(out, other, anew=True)
    assert "answers.before-2.csv" in note
    assert tree(out) == {
        "handouts/b.pdf": "pdf",
        "handouts/mine.txt": "mine",
        "answers.csv": "other form",
        "answers.before.csv": "older",
        "answers.before-2.csv": "form, filled",
        "issued.json": "two",
    }


def test_of_another_build_a_changed_handout_is_kept_and_told_and_an_empty_folder_is_not(tmp_path):
    write_tree(tmp_path, wanted(handouts__x__a_pdf="pdf", handouts__y__a_pdf="pdf", issued_json="one"))
    (tmp_path / "handouts" / "y" / "a.pdf").write_text("with a note")
    (note,) = write_tree(tmp_path, wanted(issued_json="two"), anew=True)
    assert "issued before" in note
    assert tree(tmp_path) == {"handouts/y/a.pdf": "with a note", "issued.json": "two"}
    assert not (tmp_path / "handouts" / "x").exists()


@pytest.mark.parametrize("strange", ["answers.csv", "handouts", "handouts/a.pdf"])
def test_a_strangers_file_is_never_replaced_unasked(tmp_path, strange):
    (tmp_path / strange).parent.mkdir(exist_ok=True)
    (tmp_path / strange).write_text("mine")
    before = tree(tmp_path)
    with pytest.raises(BadInput, match="move it, choose another --out, or --overwrite") as told:
        write_tree(tmp_path, wanted(**FIRST))
    assert str(tmp_path / strange) in str(told.value)
    assert tree(tmp_path) == before
    assert len(write_tree(tmp_path, wanted(**FIRST), anew=True)) == 1
    assert "mine" in tree(tmp_path).values()
    assert set(FIRST.values()) < set(tree(tmp_path).values())


def test_what_a_build_would_write_alike_is_in_nobodys_way(out):
    (out / ".built.json").unlink()
    assert write_tree(out, wanted(**FIRST)) == []


def test_where_nothing_is_issued_any_more_a_filled_form_is_not_taken_for_the_new_one(out):
    (out / "issued.json").unlink()
    (out / "answers.csv").write_text("form, filled")
    other = wanted(answers_csv="other form", issued_json="two")
    with pytest.raises(BadInput, match=r"answers\.csv"):
        write_tree(out, other)
    write_tree(out, other, anew=True)
    assert "handouts/a.pdf" not in tree(out)


def test_a_build_that_cannot_be_put_in_place_leaves_all_as_it_was(out, monkeypatch):
    (out / "answers.csv").write_text("form, filled")
    before, moved = tree(out), []
    replace = building.Path.replace

    def fails(self, target):
        moved.append(target)
        if self.parent.name == "new" and target == out / "issued.json":
            raise PermissionError(13, "Permission denied", str(target))
        return replace(self, target)

    monkeypatch.setattr(building.Path, "replace", fails)
    other = wanted(handouts__b_pdf="pdf", answers_csv="other form", issued_json="two")
    with pytest.raises(BadInput, match="cannot be written: Permission denied"):
        write_tree(out, other, anew=True)
    assert len(moved) > 5
    assert tree(out) == before
    monkeypatch.undo()
    # And what is a build's is still known.
    (note,) = write_tree(out, other, anew=True)
    assert "answers.before.csv" in note


@pytest.mark.parametrize("content", ["", "[]", '{"files": 3}', '{"files": {"../x.txt": ["d"], "/y": 3}}'])
def test_a_damaged_list_of_what_was_built_is_no_list_and_told(out, content):
    (out / ".built.json").write_text(content)
    (note,) = write_tree(out, wanted(**FIRST))
    assert str(out / ".built.json") in note
    assert write_tree(out, wanted(**FIRST)) == []


def test_a_filled_form_outlives_the_same_command(small_course, tmp_path, capsys):
    def build(*options):
        command = ["--course", small_course, "build", "--variants", 2, "--out", tmp_path / "out", *options]
        status = run([str(a) for a in command])
        return status, capsys.readouterr().err

    form = tmp_path / "out" / "answers.csv"
    assert build("--formats", "html,pdf") == (DONE, "")
    form.write_text(form.read_text("utf-8").replace(",x,", ",x,12.5"), "utf-8")
    filled = form.read_bytes()
    status, told = build("--formats", "html")
    assert status == DONE
    assert form.read_bytes() == filled
    assert "answers.csv" in told
    assert len(list((tmp_path / "out" / "handouts").rglob("*.pdf"))) == 2
    status, told = build("--seed", 5, "--formats", "html")
    assert status == BAD
    assert "--overwrite" in told
    status, told = build("--seed", 5, "--formats", "html", "--overwrite")
    assert status == DONE
    assert "answers.before.csv" in told
    assert form.with_name("answers.before.csv").read_bytes() == filled
    assert not list((tmp_path / "out" / "handouts").rglob("*.pdf"))


def test_a_folder_that_cannot_be_written_is_told_by_the_name_that_was_asked(small_course, tmp_path, capsys):
    (tmp_path / "file").write_text("")
    out = tmp_path / "file" / "week3"
    assert run(["--course", str(small_course), "build", "--formats", "html", "--out", str(out)]) == BAD
    told = capsys.readouterr().err
    assert f"{out} cannot be written: " in told
    assert "name another folder" in told
    assert ".building" not in told


@pytest.mark.e2e
@pytest.mark.parametrize(
    ("command", "name"),
    [(["notebook", "grashof", "mobility"], "grashof.fr.ipynb"), (["lesson", "rolling"], "rolling.fr.ipynb")],
)
def test_a_notebook_that_somebody_wrote_in_is_not_replaced_unasked(command, name, tmp_path, capsys):
    (tmp_path / name).write_text("mine", "utf-8")
    command = [*command, "--out", str(tmp_path)]
    assert run(command) == BAD
    told = capsys.readouterr().err
    assert f"{tmp_path / name} exists already" in told
    assert "choose another --out, or --overwrite" in told
    assert tree(tmp_path) == {name: "mine"}
    assert run([*command, "--overwrite"]) == DONE
    assert (tmp_path / name).read_text("utf-8") != "mine"


def test_the_demo_deletes_no_file_of_ones_own(tmp_path, monkeypatch):
    folder = tmp_path / "submissions"
    folder.mkdir()
    (folder / "mine.txt").write_text("mine")
    (folder / "answers.csv").write_text("typed")
    monkeypatch.setattr(demo, "HABITS", demo.HABITS[:1])
    course = coursework.open_course()
    issues = issuing.issue(course, ["slotted_mechanism"], first_seed=3, count=1, langs=["fr"], roster=CLASS)
    issued = Issued(issued_content(issues), "issued.json")
    (note,) = demo._hand_in(course, issued, folder)
    assert "answers.before.csv" in note
    assert demo._hand_in(course, issued, folder) == []
    assert {"mine", "typed"} < set(tree(folder).values())
