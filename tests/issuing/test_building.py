"""Files of a build, made by threads or by processes of their own."""

import pickle

import pytest
from sweeps import sampled

import coursework
from coursework.errors import BadCourse, BadStatement
from coursework.issuing import build as building
from coursework.issuing import issuing
from coursework.issuing.roster import Student
from coursework.rendering.renderer import Renderer
from coursework.system import writing

COURSE = coursework.open_course()
TEXTS = ("html", "tex", "ipynb")


def written(folder):
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.e2e
@pytest.mark.parametrize("name", sampled(COURSE.names))
def test_a_file_sent_to_another_process_is_the_same_there(name):
    roster = [Student("Zoé", "fr"), Student("John & Mary", "en")]
    issues = issuing.issue(COURSE, [name], first_seed=3, count=2, langs=["fr"], roster=roster)
    sent = [file for file in building.files(COURSE, issues, TEXTS) if file.anywhere]
    assert len(sent) >= 10
    for file in sent:
        there = pickle.loads(pickle.dumps(file))
        assert (there.path, there.make()) == (file.path, file.make())


def test_a_variant_goes_with_the_parts_that_were_chosen_and_what_its_key_has_computed():
    (issue,) = issuing.issue(
        COURSE, ["slotted_mechanism"], first_seed=0, count=1, langs=["fr"], parts=["loop_1_x", "theta4"]
    )
    variant = issue.variant
    width = variant.key.half_width(variant.parts[0])
    there = pickle.loads(pickle.dumps(variant))
    assert there is not variant
    assert there.exercise is variant.exercise
    assert there.part_ids == variant.part_ids == ("theta4", "loop_1_x")
    assert (there.record, there.lang) == (variant.record, variant.lang)
    assert there.key.numbers.envelope == variant.key.numbers.envelope != {}
    assert there.key.half_width(there.parts[0]) == width > 0


@pytest.mark.e2e
@pytest.mark.parametrize("count", sampled([2, 5], [2]))
def test_processes_write_what_threads_write(tmp_path, monkeypatch, count):
    names = ["slotted_mechanism", "grashof"]
    issues = issuing.issue(COURSE, names, first_seed=0, count=count, langs=["fr", "en"])
    told = []
    for folder, enough in (("threads", 10**6), ("processes", 1)):
        monkeypatch.setattr(writing, "WORTH_PROCESSES", enough)
        wanted = list(building.files(COURSE, issues, ("pdf", "html", "booklet")))
        writing.write_tree(tmp_path / folder, wanted, told.append)
        assert sorted(told) == sorted(file.path for file in wanted)
        told.clear()
    assert written(tmp_path / "threads") == written(tmp_path / "processes") != {}


def test_a_sheet_that_a_process_cannot_make_ends_the_build_with_its_fault(tmp_path, monkeypatch):
    (tmp_path / "templates" / "parts").mkdir(parents=True)
    (tmp_path / "templates" / "parts" / "figure_and_data.typ.j2").write_text("#nonsense", "utf-8")
    broken = Renderer([tmp_path / "templates", *COURSE.folder.template_folders])
    monkeypatch.setattr(writing, "WORTH_PROCESSES", 1)
    monkeypatch.setattr(building, "renderer_of", lambda folder: broken)
    issues = issuing.issue(COURSE, ["slotted_mechanism"], first_seed=0, count=2, langs=["fr"])
    with pytest.raises(BadStatement, match="nonsense"):
        writing.write_tree(tmp_path / "out", list(building.files(COURSE, issues, ("pdf",))))
    assert not list((tmp_path / "out").rglob("*.pdf"))


def test_a_course_that_cannot_be_opened_by_a_process_is_told_as_such(small_course, tmp_path, monkeypatch):
    course = coursework.open_course(small_course)
    issues = issuing.issue(course, ["crank_pin"], first_seed=0, count=2, langs=["fr"])
    wanted = list(building.files(course, issues, ("html",)))
    small_course.rename(tmp_path / "moved")
    monkeypatch.setattr(writing, "WORTH_PROCESSES", 1)
    with pytest.raises(BadCourse, match="no course at"):
        writing.write(tmp_path / "out", wanted)
