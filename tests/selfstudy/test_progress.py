"""Progress is kept whole, over all exercises and notebooks; what was missed comes again, and what comes next
is said plainly."""

from __future__ import annotations

import json
import subprocess
import sys
from datetime import UTC, date, datetime, timedelta

import pytest
from study_words import BOTH, SAID, flat, start_of
from tables import each_row

import coursework
from coursework.cli import run
from coursework.course.variant import Variant
from coursework.selfstudy.mastery import (
    AFTER_DAYS,
    advised,
    errors_shown,
    outings,
    questions,
    skills,
    standings,
)
from coursework.selfstudy.progress import (
    FILE,
    ExerciseStore,
    LaterVersion,
    NotProgress,
    Progress,
    ProgressFile,
    entry,
)

COURSE = coursework.open_course()
START = datetime(2026, 3, 2, 9, 0, tzinfo=UTC)


class Clock:
    """A clock that is set by hand."""

    def __init__(self):
        self.now = START

    def __call__(self):
        return self.now

    def pass_days(self, days):
        self.now += timedelta(days=days)


def answered(day, part, verdict, seed=1, exercise="x", **more):
    return entry(
        START + timedelta(days=day, seconds=len(more)),
        exercise,
        seed,
        part,
        "answer",
        answer="1",
        verdict=verdict,
        **more,
    )


# ----------------------------------------------------------------------- format


def test_a_text_of_progress_is_read_as_it_was_written():
    told = Progress([answered(0, "a", "correct", note="é"), entry(START, "x", 1, "a", "hint", step=2)])
    again = Progress.read(told.text())
    assert list(again) == list(told)
    assert again.text() == told.text()
    assert Progress.read(Progress().text()).text() == Progress().text()
    content = json.loads(told.text())
    assert (content["format"], content["version"]) == ("coursework progress", 1)


def test_what_a_reader_does_not_know_it_keeps():
    content = json.loads(Progress([answered(0, "a", "correct")]).text())
    content["entries"].append(entry(START, "x", 1, "a", "sang", tune="do"))
    told = Progress.read(json.dumps(content))
    assert [e["what"] for e in Progress.read(told.text())] == ["answer", "sang"]
    assert len(questions(told)) == 1


@each_row(
    "text",
    [
        "",
        "[]",
        "{}",
        '{"format": "x", "version": 1, "entries": []}',
        '{"format": "coursework progress", "version": 1, "entries": [{}]}',
        '{"format": "coursework progress", "version": 1, "entries": [{"at": "2026-01-01", "exercise": '
        '"x", "seed": 1, "part": "a", "what": "hint"}]}',
        '{"format": "coursework progress", "version": 1, "entries": [{"at": "2026-01-01T00:00:00Z", '
        '"exercise": "x", "seed": -1, "part": "a", "what": "hint"}]}',
    ],
)
def test_what_is_no_progress_is_refused(text):
    with pytest.raises(NotProgress):
        Progress.read(text)
    with pytest.raises(LaterVersion):
        Progress.read('{"format": "coursework progress", "version": 2, "entries": []}')


def test_entries_of_two_files_are_there_once_each():
    one, other = answered(0, "a", "wrong"), answered(1, "a", "correct")
    both = Progress([one]) | Progress([other, one])
    assert list(both) == [one, other]
    assert (both | both).text() == both.text()


# ------------------------------------------------------------------------- file


def test_two_notebooks_open_at_once_lose_nothing(here):
    first, second = (coursework.study("slotted_mechanism", seed=1, lang=lang) for lang in ("fr", "en"))
    other = coursework.study("coriolis", seed=1)
    first.check({"rA": "1"})
    second.check({"theta4": "2"})
    other.check({"a_coriolis": "3"})
    first.check({"omega4": "4"})
    later = coursework.study("slotted_mechanism", seed=1)
    assert later.answers == {"rA": "1", "theta4": "2", "omega4": "4"}
    assert coursework.study("coriolis", seed=1).answers == {"a_coriolis": "3"}
    assert [p.name for p in here.iterdir()] == [FILE]


WRITER = """
import sys
from pathlib import Path
from coursework.selfstudy.progress import ExerciseStore, ProgressFile
kept = ExerciseStore(ProgressFile(Path(sys.argv[1])), sys.argv[2])
for number in range(20):
    kept.add(1, "answers", {f"part{number}": str(number)})
"""


def test_notebooks_that_write_at_the_same_time_lose_nothing(tmp_path):
    names = [f"exercise{k}" for k in range(3)]
    running = [subprocess.Popen([sys.executable, "-P", "-c", WRITER, str(tmp_path), name]) for name in names]
    assert [one.wait() for one in running] == [0, 0, 0]
    progress = Progress.read((tmp_path / FILE).read_text("utf-8"))
    assert len(progress) == 60
    assert not list(tmp_path.glob("*.lock"))


def test_a_lock_that_somebody_left_behind_does_not_stop_anybody(here):
    import os

    lock = here / "progress.lock"
    lock.touch()
    os.utime(lock, (1, 1))
    coursework.study("coriolis").check({"a_coriolis": "3"})
    assert coursework.study("coriolis").answers == {"a_coriolis": "3"}


def test_what_is_written_in_one_instant_stays_in_order(here):
    clock = Clock()
    session = coursework.study("coriolis", clock=clock)
    for text in ("1", "2", "1", "3", "1"):
        session.check({"a_coriolis": text})
    assert session.answers == coursework.study("coriolis").answers == {"a_coriolis": "1"}
    (one,) = outings(session._store.progress)
    assert len(one.verdicts) == 5


@BOTH
def test_the_file_of_a_later_version_is_left_as_it_is(lang, here):
    text = '{"format": "coursework progress", "version": 9, "entries": [], "more": 1}'
    (here / FILE).write_text(text, "utf-8")
    session = coursework.study("coriolis", lang=lang)
    assert start_of(SAID[lang]["trouble"]["later"])[:30] in flat(session.check({"a_coriolis": "3"}))
    assert session.answers == {"a_coriolis": "3"}
    assert (here / FILE).read_text("utf-8") == text


# ---------------------------------------------------------------------- spacing


def test_what_was_missed_comes_again_after_1_3_7_and_16_days():
    entries, day = [answered(0, "a", "wrong"), answered(0, "b", "correct")], 0
    for seed, after in enumerate(AFTER_DAYS, start=2):
        (a, b) = questions(Progress(entries))
        assert b.due is None
        day += after
        assert a.due == (START + timedelta(days=day)).date()
        entries.append(answered(day, "a", "correct", seed=seed))
    assert [q.due for q in questions(Progress(entries))] == [None, None]
    entries.append(answered(day + 9, "a", "mistake:m", seed=99))
    assert questions(Progress(entries))[0].due == (START + timedelta(days=day + 10)).date()


def test_an_outing_before_it_is_due_moves_nothing():
    early = [
        answered(0, "a", "wrong"),
        answered(0, "a", "correct", seed=2),
        answered(0, "a", "correct", seed=3),
    ]
    assert questions(Progress(early))[0].due == (START + timedelta(days=1)).date()


@each_row(
    ("happened", "is_right", "is_clean"),
    [
        ([answered(0, "a", "correct")], True, True),
        ([answered(0, "a", "unreadable"), answered(0, "a", "correct", k=1)], True, True),
        ([answered(0, "a", "follow_through"), answered(0, "a", "correct", k=1)], True, True),
        ([answered(0, "a", "wrong"), answered(0, "a", "correct", k=1)], True, False),
        ([entry(START, "x", 1, "a", "hint", step=1), answered(0, "a", "correct", k=1)], True, False),
        ([entry(START, "x", 1, "a", "reveal"), answered(0, "a", "correct", k=1)], True, False),
        ([answered(0, "a", "correct"), entry(START + timedelta(1), "x", 1, "a", "reveal")], True, True),
        ([entry(START, "x", 1, "a", "reveal")], False, False),
    ],
)
def test_what_is_right_first_time_and_alone(happened, is_right, is_clean):
    (one,) = outings(Progress(happened))
    assert (one.is_right, one.is_clean) == (is_right, is_clean)


def test_a_skill_is_lost_by_its_error_and_held_by_two_variants_where_it_would_have_shown():
    lost = [answered(0, "a", "mistake:m", kind="mm")]
    shown = [answered(k, "a", "correct", seed=k, kind="mm", shown=["mistake:m"]) for k in (2, 3)]
    for entries, is_open, count in ((lost, True, 0), (lost + shown[:1], True, 1), (lost + shown, False, 2)):
        found = {s.id: s for s in skills(Progress(entries))}
        assert (found["mistake:m"].is_open, found["mistake:m"].shown) == (is_open, count)
        assert found["kind:mm"].is_open == is_open
    beside = [answered(0, "b", "correct", kind="mm", shown=["mistake:m"])]
    assert all(s.shown == 0 for s in skills(Progress(lost + beside)))
    again = [*lost, *shown, answered(9, "a", "mistake:m", seed=9)]
    assert {s.id: s.is_open for s in skills(Progress(again))}["mistake:m"]
    assert not [s for s in skills(Progress(shown)) if s.is_open]


def test_what_comes_next():
    names, today = ("x", "y", "z"), START.date()
    errors = {"y": [], "z": ["mistake:m"]}
    nothing = advised(Progress(), today, names, lambda name: errors.get(name, ()))
    assert (nothing.exercise, nothing.why) == ("x", "new")
    wrong = Progress([answered(0, "a", "mistake:m")])
    assert (
        advised(wrong, today, names, lambda name: errors.get(name, ())).exercise,
        advised(wrong, today, names, lambda name: errors.get(name, ())).why,
    ) == ("z", "skill")
    due = advised(wrong, today + timedelta(days=1), names, lambda name: errors.get(name, ()))
    assert (due.exercise, due.why, due.parts, due.day) == ("x", "due", ("a",), today)
    all_begun = wrong | Progress([answered(0, "a", "correct", exercise=e) for e in ("y", "z")])
    later = advised(all_begun, today, names, lambda name: errors.get(name, ()))
    assert (later.exercise, later.why, later.day) == ("x", "later", today + timedelta(days=1))
    assert advised(Progress(), today, (), lambda name: ()) is None


# ------------------------------------------------------------------- in a course


@BOTH
def test_a_session_proposes_what_was_missed_when_it_is_due(lang, here):
    clock = Clock()
    session = coursework.study("slotted_mechanism", seed=1, lang=lang, clock=clock)
    right = session.variant.solution()
    session.check({"rA": f"{right['rA']:.6g}", "theta4": f"{right['theta4'] + 180:.6g}"})
    assert session.next().variant.exercise.name != "slotted_mechanism"
    clock.pass_days(1)
    following = session.next()
    assert following.variant.exercise.name == "slotted_mechanism"
    assert following.variant.seed != 1
    assert start_of(SAID[lang]["next"]["due"]) in flat(following)
    assert "following.statement()" in str(following)
    assert following.variant.text.title in flat(following.statement())
    value = following.variant.solution()["theta4"]
    assert "- ✓" in str(following.check({"theta4": f"{value:.6g}"}))
    assert session.next().variant.exercise.name != "slotted_mechanism"
    clock.pass_days(3)
    assert session.next().variant.exercise.name == "slotted_mechanism"


@BOTH
def test_progress_tells_what_cost_an_answer_in_words_that_judge_nobody(lang, here):
    session = coursework.study("slotted_mechanism", seed=1, lang=lang)
    wrong = session.variant.key.wrong["no_coriolis"]["alpha4"]
    session.check({"alpha4": f"{wrong:.6g}"})
    said = flat(session.progress())
    assert flat(SAID[lang]["progress"]["open"]) in said
    assert flat(session.variant.mistake_text("no_coriolis"))[:40].split("$")[0] in said
    for word in ("bad", "weak", "poor", "fail", "mauvais", "faible", "échec"):
        assert word not in said.lower().split()


def test_hints_and_solutions_that_were_shown_are_kept_once(here):
    session = coursework.study("slotted_mechanism", seed=1)
    for _ in range(2):
        session.hint("omega4", 2)
        session.reveal("theta4")
    told = [(e["what"], e["part"], e.get("step")) for e in session._store.progress]
    assert told == [("hint", "omega4", 2), ("reveal", "theta4", None)]


def test_right_answers_show_errors_that_would_have_given_another(here):
    session = coursework.study("slotted_mechanism", seed=1)
    right = session.variant.solution()
    session.check({"alpha4": f"{right['alpha4']:.6g}", "rA": f"{right['rA']:.6g}"})
    shown = {e["part"]: set(e["shown"]) for e in session._store.progress}
    assert "mistake:no_coriolis" in shown["alpha4"]
    assert "mistake:no_coriolis" not in shown["rA"]


@BOTH
def test_the_command_tells_the_same(lang, here, capsys):
    clock = Clock()
    session = coursework.study("slotted_mechanism", seed=1, lang=lang, clock=clock)
    session.check({"rA": "1"})
    assert run(["progress", "--lang", lang, "--on", "2026-03-03"]) == 0
    said = flat(capsys.readouterr().out)
    assert start_of(SAID[lang]["next"]["due"]) in said
    assert flat(SAID[lang]["progress"]["due"]) in said
    assert run(["progress", str(here), "--json", "--on", "2026-03-02"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["exercises"] == [
        {
            "exercise": "slotted_mechanism",
            "variants": 1,
            "tried": 1,
            "right": 0,
            "clean": 0,
            "due": "2026-03-03",
        }
    ]
    assert told["next"]["why"] in ("new", "skill")
    assert run(["progress", "nowhere"]) == 2


def test_the_order_of_a_course_is_that_in_which_exercises_are_proposed(here):
    order = COURSE.folder.study_order
    assert set(order) == set(COURSE.names)
    assert len(order) == len(COURSE.names)
    assert (
        advised(Progress(), date(2026, 1, 1), order, lambda name: ()).exercise
        == order[0]
        == COURSE.folder.in_order[0]
    )
    (line,) = standings(Progress([answered(0, "a", "correct")]))
    assert (line.tried, line.right, line.clean) == (1, 1, 1)


def test_a_site_may_keep_what_a_notebook_keeps(tmp_path):
    """The format alone, without the notebook's file: what is kept here is read there, and put together."""
    (tmp_path / "a").mkdir()
    kept = ExerciseStore(ProgressFile(tmp_path / "a"), "coriolis")
    kept.add(1, "answers", {"a_coriolis": "3"})
    served = Progress.read((tmp_path / "a" / FILE).read_text("utf-8")) | Progress(
        [answered(0, "b", "correct")]
    )
    (tmp_path / "a" / FILE).write_text(served.text(), "utf-8")
    kept.add(1, "answers", {"direction": "4"})
    assert len(Progress.read((tmp_path / "a" / FILE).read_text("utf-8"))) == 3


def test_a_right_answer_shows_of_each_slip_that_it_was_not_made():
    """Angular velocities of a linkage whose triangle has sides 3, 4 and 5: -1 rad/s, of which a slip of the
    sign gives 1."""
    exercise = COURSE["four_bar_motion"]
    given = {
        "r1": 80,
        "r2": 30,
        "r3": 40,
        "r4": 30,
        "theta2": 0,
        "omega2": 5 / 3,
        "alpha2": 10,
        "mode": "open",
    }
    variant = Variant(exercise, 0, {name: float(v) if v != "open" else v for name, v in given.items()}, "en")
    part = next(p for p in variant.parts if p.id == "omega3")
    assert variant.key.reference["omega3"] == pytest.approx(-1)
    assert {"slip:sign", "slip:unit", "slip:radians", "slip:turns_a_minute"} <= set(
        errors_shown(variant, part)
    )
    assert dict(variant.key.slip_values(part))["sign"] == pytest.approx(1)
