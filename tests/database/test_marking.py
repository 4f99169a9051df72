"""Only what changed is marked; marks come back as they were made."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from sqlalchemy import func, select
from stored_class import ANA, BEN, CAME, CLEO, content, put, rows

import coursework
from coursework.database import marking as marking_module
from coursework.database.assignments import put_issued
from coursework.database.current_marks import adjusted_sheets
from coursework.database.marking import Work, mark_new, mark_submission, would_change
from coursework.database.states import ENGINE, exercise_state
from coursework.database.submissions import insert_submission
from coursework.database.tables import mark, marking, person
from coursework.gradebook.book import marks_rows
from coursework.gradebook.class_marking import marked, rejecting
from coursework.gradebook.feedback_sheets import feedback_sheet
from coursework.gradebook.placing import placed_sheets
from coursework.issuing.issued import Issued
from coursework.rendering.renderer import renderer_of

SOLUTION = "solutions/crank_pin.py"
#: Imported beside the engine; they carry marks, and make none.
CARRIES = {f"gradebook/{name}.py" for name in ("conflicting_sheets", "graded_sheet", "placing", "rows")} | {
    f"issuing/{name}.py" for name in ("identity", "issued", "students")
}


@pytest.fixture
def course(small_course):
    return coursework.open_course(small_course)


@pytest.fixture
def told(course):
    return content(course)


@pytest.fixture
def three(course):
    """Answers of three, one of them with a mistake, one unreadable."""
    return [rows(course, ANA, 0), rows(course, BEN, 1, x="12"), rows(course, CLEO, 2, y="somewhere")]


@pytest.fixture
def number(store, told, three):
    return put(store, told, *three)


def plain(course, told, some):
    issued = Issued(told, "test")
    sheets = placed_sheets(course, issued, [row for each in some for row in each])
    return list(marked(course, issued, sheets))


def standing(store, number, student=None):
    with store.reading() as connection:
        return adjusted_sheets(connection, number, student)[-1]


def comparable(one):
    """A sheet as plain values."""
    return one._replace(record=dict(one.record))


def copy_of(course, tmp_path, old="", new="", file=SOLUTION):
    """The course once more, with a line of it changed: what is imported once is not imported again."""
    place = tmp_path / f"copy{len(list(tmp_path.glob('copy*')))}"
    shutil.copytree(course.folder.root, place)
    text = (place / file).read_text("utf-8")
    assert old in text
    (place / file).write_text(text.replace(old, new, 1), "utf-8")
    return coursework.open_course(place)


def test_marks_come_back_as_plain_marking_gives_them(store, number, course, told, three):
    now = mark_new(course, store, number)
    assert (now.sheets, now.marked, now.new, now.changes) == (3, 3, 3, ())
    expected = [*map(comparable, plain(course, told, three))]
    assert [*map(comparable, standing(store, number))] == expected
    assert [*map(comparable, standing(store, number, BEN))] == expected[1:2]


def test_tables_and_sheets_are_made_of_what_comes_back(store, number, course, told, three):
    mark_new(course, store, number)
    for one, other in zip(standing(store, number), plain(course, told, three), strict=True):
        assert list(marks_rows(one)) == list(marks_rows(other))
        html = [
            renderer_of(course.folder).html(feedback_sheet(course, g, answers=True)) for g in (one, other)
        ]
        assert html[0] == html[1]


def test_nothing_new_is_not_marked_again(store, number, course, monkeypatch):
    mark_new(course, store, number)
    monkeypatch.setattr(marking_module, "judged", None)
    now = mark_new(course, store, number)
    assert (now.marked, now.changes) == (0, ())


def test_an_answer_that_comes_late_marks_its_sheet_alone(store, told, course):
    first = rows(course, ANA, 0)
    number = put(store, told, first[:1], rows(course, BEN, 1))
    mark_new(course, store, number)
    put(store, told, first[1:])
    now = mark_new(course, store, number)
    assert (now.sheets, now.marked, now.new) == (2, 1, 0)
    assert {(c.student, c.verdict_before, c.verdict_now) for c in now.changes} == {(ANA, "", "correct")}
    assert [*map(comparable, standing(store, number))] == [
        *map(comparable, plain(course, told, [first[:1], rows(course, BEN, 1), first[1:]]))
    ]


def test_a_corrected_solution_is_told_before_it_is_written_and_marks_anew(store, number, course, tmp_path):
    mark_new(course, store, number)
    corrected = copy_of(course, tmp_path, "sin(", "1.5 * sin(")
    would = would_change(corrected, store, number)
    assert would.marked == 3
    assert {c.verdict_before for c in would.changes} == {"correct"}
    assert all(line.verdict == "correct" for line in standing(store, number, ANA)[0].lines.values())
    now = mark_new(corrected, store, number)
    assert now == would
    assert any(line.verdict != "correct" for line in standing(store, number, ANA)[0].lines.values())
    assert mark_new(corrected, store, number).marked == 0


@pytest.mark.parametrize(
    ("file", "changes"),
    [
        (SOLUTION, True),
        ("exercises/crank_pin.py", True),
        ("exercises/crank_pin.en.md.j2", True),
        ("solutions/_shared.py", True),
        ("exercises/_data.toml", True),
        ("exercises/other.py", False),
        ("solutions/_lonely.py", False),
        ("templates/sheet/sheet.html.j2", False),
    ],
)
def test_a_state_is_of_the_files_that_an_exercise_stands_on(course, tmp_path, file, changes):
    shared = copy_of(course, tmp_path)
    root = shared.folder.root
    for name in (
        "solutions/_shared.py",
        "solutions/_lonely.py",
        "exercises/other.py",
        "templates/sheet/sheet.html.j2",
    ):
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text("ONE = 1\n", "utf-8")
    (root / "exercises/_data.toml").write_text("a = 1\n", "utf-8")
    for name, line in (
        (SOLUTION, "from ._between import ONE\n"),
        ("exercises/crank_pin.py", 'DATA = "_data.toml"\n'),
    ):
        (root / name).write_text((root / name).read_text("utf-8") + line, "utf-8")
    (root / "solutions/_between.py").write_text("from ._shared import ONE\n", "utf-8")
    before = exercise_state(shared, "crank_pin")
    other = copy_of(shared, tmp_path)
    assert exercise_state(other, "crank_pin") == before
    changed = copy_of(shared, tmp_path, file=file, old="", new="# more\n")
    assert (exercise_state(changed, "crank_pin") != before) == changes


def test_the_engine_is_all_that_a_mark_is_computed_by(course):
    """What is imported by marking, and by whom it imports, in a new process."""
    code = (
        "import sys, coursework.gradebook.class_marking, coursework.course.course as c; from pathlib "
        "import Path;"
        "from coursework.course.variant import Variant; from coursework.marking.marking import mark;"
        "v = c.opened(sys.argv[1], Variant)['crank_pin'].variant(3); mark(v, dict.fromkeys((p.id for p "
        "in v.parts), '7'));"
        "print(*(m.__file__ for n, m in sys.modules.items() if n.partition('.')[0] == 'coursework'), "
        "sep='\\n')"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(course.folder.root)], capture_output=True, text=True, check=True
    )
    root = Path(coursework.__file__).parent
    files = {Path(line).relative_to(root) for line in done.stdout.split("\n") if line}
    places = [Path(one) for one in ENGINE]
    assert [place for place in places if not (root / place).exists()] == []
    outside = {f.as_posix() for f in files if not any(p == f or p in f.parents for p in places)}
    assert {f for f in outside if f.rpartition("/")[2] != "__init__.py"} <= CARRIES


def test_a_hand_in_on_the_site_marks_its_own_sheets(store, number, course):
    mark_new(course, store, number)
    with store.begin() as connection:
        who = connection.execute(select(person.c.id).where(person.c.name == BEN)).scalar()
        ids = [
            insert_submission(
                connection,
                number,
                rows(course, BEN, 1, n),
                source="site",
                received_at=CAME,
                person_id=who,
                number=n,
            ).id
            for n in (2, 3)
        ]
    now = mark_submission(course, store, ids[1])
    assert (now.sheets, now.marked, now.new) == (1, 1, 1)
    assert [(g.sitting, g.submitted[:10]) for g in standing(store, number, BEN)] == [
        (1, ""),
        (3, "2026-11-23"),
    ]
    assert mark_submission(course, store, ids[1]).marked == 0
    assert mark_new(course, store, number).marked == 1
    assert sorted(g.sitting for g in standing(store, number, BEN)) == [1, 2, 3]
    assert mark_new(course, store, number).marked == 0


def test_a_file_marks_its_own_sheets_with_what_came_before(store, told, course):
    first = rows(course, ANA, 0)
    number = put(store, told, first[:1], rows(course, BEN, 1))
    with store.begin() as connection:
        late = insert_submission(connection, number, first[1:], source="late.csv", received_at=CAME)
    assert mark_submission(course, store, late.id).marked == 1
    (one,) = standing(store, number)
    assert one.answered == tuple(row.part for row in first)


def test_answers_that_are_taken_for_a_later_sitting_leave_the_earlier_one(store, course):
    told = content(course, (ANA,))
    number = put(store, told, rows(course, ANA, 0, written=False))
    mark_new(course, store, number)
    told["issued"].append(
        {**told["issued"][0], "sitting": 2, "record": course["crank_pin"].variant(5, "en").record}
    )
    with store.begin() as connection:
        put_issued(connection, told)
    mark_new(course, store, number)
    assert [(g.seed, g.sitting) for g in standing(store, number)] == [(5, 2)]


def test_two_who_mark_at_once_leave_one_marking(store, number, course):
    first, second = (marking_module.Work(course, store, number) for _ in range(2))
    for work in (first, second):
        work.mark()
        with store.begin() as connection:
            work.write(connection)
    with store.reading() as connection:
        assert connection.execute(select(func.count()).select_from(marking)).scalar() == 3
        assert connection.execute(select(func.count()).select_from(mark)).scalar() == sum(
            len(g.lines) for g in standing(store, number)
        )


def test_a_sheet_that_cannot_be_marked_says_so_each_time(store, number, course, told, three, monkeypatch):
    from coursework.gradebook import class_marking

    whole = class_marking._mark_sheet

    def broken(variant, *more):
        return "out of ink" if variant.seed == 1 else whole(variant, *more)

    monkeypatch.setattr(class_marking, "_mark_sheet", broken)
    issued = Issued(told, "test")
    sheets = placed_sheets(course, issued, [row for each in three for row in each])
    list(marked(course, issued, sheets))
    mark_new(course, store, number)
    for _ in range(2):
        work = Work(course, store, number)
        list(rejecting(work.sheets, work.results()))
        assert work.sheets.rejected == sheets.rejected != []
        assert work.sheets.warnings == sheets.warnings
        assert mark_new(course, store, number).marked == 0
