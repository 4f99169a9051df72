"""A copy of an exercise works in another course by itself: all that it needs is there, and nothing is
replaced."""

import json
import subprocess
import sys

import pytest
from sweeps import sampled

import coursework
from coursework.authoring.checks import check
from coursework.authoring.copying import copy_exercise
from coursework.course.folder import course_folder
from coursework.errors import BadInput, UnknownName
from coursework.issuing.issued import plain_value

COURSE = coursework.open_course()
BUILTIN = COURSE.folder
#: Another exercise, data, and shared modules across folders.
FEW = (
    "havens_construction",
    "vocabulary",
    "complex_chain",
)


def copied(target, name, renamed="", langs=("en", "fr")):
    return copy_exercise(BUILTIN, name, target, renamed or name, langs)


def clean(target, name, variants):
    report = check(coursework.open_course(target)[name], variants)
    return report.failures


@pytest.mark.e2e
@pytest.mark.parametrize("name", sampled(FEW, ["havens_construction"]))
def test_a_copy_is_checked_clean_and_asks_the_same(name, tmp_path):
    made = copied(tmp_path / "mine", name)
    assert all(path.is_file() for path in made.written)
    assert not made.there
    course = coursework.open_course(tmp_path / "mine")
    assert course.names == (name,)
    assert clean(tmp_path / "mine", name, 5) == []
    assert [v.record for v in course[name].variants(range(5))] == [
        v.record for v in COURSE[name].variants(range(5))
    ]


@pytest.mark.e2e
@pytest.mark.parametrize("name", sampled(FEW, ["complex_chain"]))
def test_a_renamed_copy_in_one_language_is_checked_clean(name, tmp_path):
    made = copied(tmp_path / "mine", name, "another", ("en",))
    assert coursework.open_course(tmp_path / "mine").names == ("another",)
    assert not [path for path in made.written if ".fr." in path.name or path.name.partition(".")[0] == name]
    assert clean(tmp_path / "mine", "another", 5) == []


@pytest.mark.slow
@pytest.mark.parametrize("name", COURSE.names)
def test_every_exercise_is_copied_alone_and_works(name, tmp_path):
    copied(tmp_path / "same", name)
    assert coursework.open_course(tmp_path / "same").names == (name,)
    assert clean(tmp_path / "same", name, 3) == []
    copied(tmp_path / "other", name, "another", ("fr",))
    renamed = coursework.open_course(tmp_path / "other")
    assert renamed.names == ("another",)
    assert renamed["another"].variant(0, "fr").solution()


@pytest.mark.slow
def test_all_exercises_are_copied_into_one_course(tmp_path):
    for name in COURSE.names:
        copied(tmp_path / "mine", name)
    course = coursework.open_course(tmp_path / "mine")
    assert course.names == COURSE.names
    for name in course.names:
        answers, right = course[name].variant(0).solution(), COURSE[name].variant(0).solution()
        assert {n: plain_value(v) for n, v in answers.items()} == {
            n: plain_value(v) for n, v in right.items()
        }


def test_nothing_is_replaced(tmp_path):
    copied(tmp_path, "planar_chain")
    with pytest.raises(BadInput, match="--as"):
        copied(tmp_path, "planar_chain")
    shared = tmp_path / "exercises" / "chains" / "_solids.py"
    second = copied(tmp_path, "closed_chain")
    assert shared in second.there
    shared.write_text(shared.read_text("utf-8") + "\n# mine\n", "utf-8")
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    with pytest.raises(BadInput, match=r"_solids\.py"):
        copied(tmp_path, "serial_joints")
    assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before


def test_what_cannot_be_copied_is_said(tmp_path):
    with pytest.raises(UnknownName, match="slotted_mechanism"):
        copied(tmp_path / "a", "sloted_mechanism")
    with pytest.raises(BadInput, match="cannot name"):
        copied(tmp_path / "a", "grashof", "Mein Grashof")
    copied(tmp_path / "fr", "grashof", langs=("fr",))
    for text in (tmp_path / "fr").rglob("*.fr.md.j2"):
        text.rename(text.with_name(text.name.replace(".fr.", ".xx.")))
    (tmp_path / "fr" / "exercises" / "course.toml").write_text('languages = ["fr"]\n', "utf-8")
    with pytest.raises(BadInput, match="no text in en"):
        copy_exercise(course_folder(tmp_path / "fr"), "grashof", tmp_path / "en", "grashof", ("en",))
    assert not (tmp_path / "en").exists()


OWN = {
    "exercises/topic/own.py": "import json\nfrom pathlib import Path\n\nfrom . import "
    "base\nfrom ..other._far import far\n"
    'LOADS = json.loads((Path(__file__).parent / "data/loads.json").read_text("utf-8"))\nMARK = base.B '
    "+ far()\n",
    "exercises/topic/base.py": "from ._near import near\n\nB = near()\nEXERCISE = None\n",
    "exercises/topic/_near.py": "def near():\n    return 1\n",
    "exercises/other/_far.py": "def far():\n    return 2\n",
    "exercises/topic/data/loads.json": "[1]",
    "exercises/topic/own.en.md.j2": '# Own\n\n{% include "_words.en.md.j2" %}\n\n![a drawing](own.svg)\n',
    "exercises/_words.en.md.j2": "Words.{% include 'deeper.md.j2' %}\n",
    "templates/deeper.md.j2": "Deeper.\n",
    "exercises/topic/own.svg": "<svg/>",
    "exercises/topic/unasked.csv": "a\n",
    "solutions/topic/own.py": "from ...exercises.topic.own import MARK, LOADS\n\n\ndef x(a):\n"
    "    return a + MARK + LOADS[0]\n",
}


def test_modules_texts_data_and_pictures_are_found_wherever_they_stand(tmp_path):
    for path, text in OWN.items():
        (tmp_path / "old" / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "old" / path).write_text(text, "utf-8")
    new = tmp_path / "new"
    made = copy_exercise(course_folder(tmp_path / "old"), "own", new, "mine", ("en",))
    found = {path.relative_to(new).as_posix() for path in made.written} - {"exercises/course.toml"}
    expected = {path for path in OWN if "unasked" not in path}
    assert found == {p.replace("/own.", "/mine.").replace("/base.", "/_base.") for p in expected}
    solution = course_folder(new).module("solutions", "mine")
    assert solution.x(10) == 14
    assert "(mine.svg)" in (new / "exercises/topic/mine.en.md.j2").read_text("utf-8")


@pytest.mark.e2e
def test_the_command_copies_and_says_what_it_wrote(tmp_path):
    run = [sys.executable, "-P", "-c", "import sys; from coursework.cli import main; main()"]

    def told(*arguments):
        return subprocess.run([*run, *arguments], cwd=tmp_path, capture_output=True, text=True, check=False)

    done = told("new", "mine", "--from", "slotted_mechanism", "--as", "guide", "--lang", "en")
    assert done.returncode == 0, done.stderr
    written = {line.removeprefix("wrote ") for line in done.stdout.splitlines() if line.startswith("wrote ")}
    assert written == {p.relative_to(tmp_path).as_posix() for p in tmp_path.rglob("*") if p.is_file()}
    record = told("--course", "mine", "variant", "guide", "--json")
    assert json.loads(record.stdout)["lang"] == "en"
    for wrong in (
        ("new", "mine", "--from", "slotted_mechanism", "--as", "guide"),
        ("new", "mine", "x", "--from", "grashof"),
        ("new", "mine", "--as", "x"),
        ("new", "mine", "--from", "grashoff"),
        ("new", "mine", "--from", "grashof", "--lang", "fr"),
    ):
        refused = told(*wrong)
        assert refused.returncode == 2, wrong
        assert len(refused.stderr.splitlines()) == 1
