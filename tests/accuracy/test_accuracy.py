"""What accuracy costs: the rows say what is true of the methods, whatever the machine's speed."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from itertools import islice, takewhile

import numpy as np
import pytest
from sweeps import sampled, slow
from tables import each_row

from coursework.accuracy.closure import Closure
from coursework.accuracy.measuring import DATA, HARD, measure
from coursework.accuracy.motion import FREE, RUBBING, motion_rows
from coursework.accuracy.overview import overview
from coursework.accuracy.page import report
from coursework.accuracy.pages import overview_report
from coursework.accuracy.subject import numbers_of, study_of
from coursework.cli import run
from coursework.cli.measure import overview_text
from coursework.errors import BadInput
from coursework.kinematics.chains import Vector
from coursework.language.words import languages
from coursework.rendering.renderer import renderer_of

STUDIED = ("slotted_mechanism", "four_bar_motion", "slider_crank")
each_studied = pytest.mark.parametrize("name", sampled(STUDIED, STUDIED[:1]))
FIELDS = {"method", "place", "ns_per_configuration", "ns_low", "ns_high", "rounds", "max_error", "n"}


class Rows(dict):
    """Rows of an exercise, measured at first use."""

    def __init__(self, course):
        super().__init__()
        self.course = course

    def __missing__(self, name):
        found = measure(self.course[name], quick=True)
        self[name] = list(takewhile(lambda row: row.place != RUBBING, found))
        return self[name]


@pytest.fixture(scope="module")
def rows(course):
    """All but the motion with friction, which takes as long as the rest together."""
    return Rows(course)


@pytest.fixture(scope="module")
def free(course):
    """The motion without friction alone: the rows that come first."""
    exercise = course["slider_crank_torque"]
    found = list(islice(motion_rows(exercise, study_of(exercise), quick=True), 8))
    assert {row.place for row in found} == {FREE}
    assert {row.method for row in found} == {"integration", "steps", "cycle_table"}
    return found


@pytest.fixture(scope="module")
def rubbing(course):
    motion = measure(course["slider_crank_torque"], quick=True)
    return [row for row in motion if row.place == RUBBING]


def error(rows, what, method, place="generic"):
    (row,) = (r for r in rows if (r.what, r.method, r.place) == (what, method, place))
    return row.max_error


@pytest.mark.e2e
@each_studied
def test_the_stable_form_keeps_all_digits_where_the_textbook_loses_half(rows, name):
    for what in ("position", "rate"):
        assert error(rows[name], what, "stable") < 2e-15
        assert error(rows[name], what, "stable", HARD) < 2e-15
        assert error(rows[name], what, "textbook") < 5e-15
        assert error(rows[name], what, "textbook", HARD) > 1e-9


@each_studied
@pytest.mark.e2e
def test_precisions_are_told_apart(rows, name):
    own = rows[name]
    assert 1e-9 < error(own, "position", "single") < 1e-5
    assert error(own, "position", "mpmath") < 1e-45
    extended = [
        r.max_error for r in own if (r.what, r.method, r.place) == ("position", "extended", "generic")
    ]
    assert all(e < error(own, "position", "textbook") / 100 for e in extended)


@each_studied
@pytest.mark.e2e
def test_newton_squares_its_error_where_the_solutions_are_apart(rows, name):
    first, second, third = (error(rows[name], "position", f"newton-{k}") for k in (1, 2, 3))
    assert second < 10 * first**2
    assert third < max(10 * second**2, 1e-14)


@each_studied
def test_tables_gain_the_fourth_power_of_their_step(rows, name):
    coarse, fine = (error(rows[name], "position", f"table-{n}") for n in (64, 512))
    assert coarse / fine > 8**4 / 8
    assert error(rows[name], "position", "table-4096") < 1e-11
    assert all(r.build_ns > 0 for r in rows[name] if r.family == "table")


@each_studied
def test_the_error_of_a_difference_is_a_v_of_its_step(rows, name):
    found = {r.setting: r.max_error for r in rows[name] if r.family == "differences" and r.place == "generic"}
    best = min(found, key=found.get)
    assert 1e-7 < best < 1e-3
    assert found[1e-1] / found[1e-2] == pytest.approx(100, rel=0.1)
    assert found[1e-9] > 100 * found[best]
    assert error(rows[name], "rate", "complex_step") < 1e-14


@pytest.mark.e2e
def test_a_tighter_tolerance_integrates_better(free):
    found = [row.error for row in free if row.method == "integration"]
    assert len(found) > 1
    assert found == sorted(found, reverse=True)


@slow
def test_with_friction_tolerances_and_steps_come_near_too(rubbing, course):
    """By methods that share nothing: each comes near what the tightest tolerance gives."""
    for family in ("integration", "steps"):
        found = [r.max_error for r in rubbing if r.family == family]
        assert len(found) > 1
        assert found == sorted(found, reverse=True)
        assert found[-1] < 2e-3
    (section,) = report(course, rubbing, "fr").sections
    assert "avec frottement" in section.text


@pytest.mark.e2e
def test_motion_by_tolerance_is_as_exact_as_it_is_told_to_be(free):
    loose, *_, tight = (row.error for row in free if row.method == "integration")
    assert loose > 1e-5
    assert tight < 1e-7


def test_equal_steps_gain_about_the_fourth_power_of_their_number(free):
    own = {row.setting: row.error for row in free if row.method == "steps"}
    assert 8 < own[50] / own[100] < 64
    assert 8 < own[100] / own[200] < 64


def test_a_table_of_the_cycle_is_exact_to_its_steps(free):
    assert all(row.error < 1e-6 and row.build for row in free if row.method == "cycle_table")


@each_studied
def test_rows_are_whole(rows, name):
    own = rows[name]
    for row in own:
        assert row.as_json().keys() >= FIELDS
        assert 0 <= row.failed <= row.n
        assert (row.max_error is None) == (row.failed == row.n)
        if row.family != DATA:
            assert row.ns_per_configuration > 0
            assert row.low <= row.median <= row.high
            assert row.rounds >= 3
    assert len({(r.what, r.method, r.place) for r in own}) == len(own)


#: One study on a French page always; all of them in every language, slow.
PAGES = [("fr", STUDIED[:1]), *((lang, STUDIED) for lang in languages())]


@pytest.mark.e2e
@pytest.mark.parametrize(
    ("lang", "studied"),
    [PAGES[0], *(pytest.param(*page, marks=slow) for page in PAGES[1:])],
    ids=["one-fr", *(f"all-{lang}" for lang in languages())],
)
def test_the_page_reads_the_rows_in_every_language(course, rows, lang, studied):
    every = [row for name in (*studied, "slider_crank_torque") for row in rows[name]]
    page = report(course, every, lang)
    html = renderer_of(course.folder).report_html(page)
    assert html.count("<figure>") == sum(len(section.charts) for section in page.sections)
    assert sum(len(section.charts) for section in page.sections) >= 4 * len(studied) + 1
    assert "<script" not in html
    assert "http://" not in html.replace("http://www.w3.org", "")
    assert renderer_of(course.folder).report_pdf(page).startswith(b"%PDF")
    if lang == "fr":
        assert "le solveur" in html
        assert "the solver" not in html


@pytest.mark.e2e
@each_row("place", ["generic", HARD])
def test_the_page_passes_over_differences_that_have_no_answer(course, rows, place):
    def lost(row):
        return (row.family, row.place) == ("differences", place) and row.setting < 1e-4

    own = [replace(r, max_error=None, failed=r.n) if lost(r) else r for r in rows["slotted_mechanism"]]
    assert any(map(lost, own))
    html = renderer_of(course.folder).report_html(report(course, own, "en"))
    assert "no answer" in html


@pytest.mark.e2e
def test_the_command_writes_page_and_rows(tmp_path, capsys):
    assert run(["accuracy", "slotted_mechanism", "--quick", "--lang", "en", "--out", str(tmp_path)]) == 0
    capsys.readouterr()
    written = json.loads((tmp_path / "accuracy.json").read_text("utf-8"))
    assert {row["place"] for row in written} == {"generic", "hard"}
    assert (tmp_path / "accuracy.html").exists()
    assert (tmp_path / "accuracy.pdf").read_bytes().startswith(b"%PDF")


def test_an_exercise_without_numbers_is_told_in_one_line(course, capsys):
    assert not numbers_of(course["mobility"])
    assert overview(course["mobility"]) is None
    with pytest.raises(BadInput, match="no number"):
        list(measure(course["mobility"]))
    assert run(["accuracy", "mobility"]) == 2
    assert "asks for no number" in capsys.readouterr().err


@pytest.mark.e2e
def test_what_loses_digits_is_named_and_whether_it_is_asked(course):
    """The rod's rate of a small crank loses digits; no answer of the exercise takes it."""
    line = overview(course["quick_return_whitworth"], quick=True)
    assert line.losing.keys() == {"omega5"}
    assert line.asked_losing == ()
    assert "omega5 ×" in overview_text(line)
    assert "the asked answers keep all that the data allow" in overview_text(line)
    page = overview_report(course, [line], (), "en")
    assert "all keep in their answers" in page.sections[0].text
    assert r"\omega_5$, not asked, loses" in str(page.sections[1].tables[0])
    asked = replace(line, asked_losing=("omega5",))
    assert "the asked answers" not in overview_text(asked)
    assert "Not so yet: " in overview_report(course, [asked], (), "en").sections[0].text


def test_two_loops_are_closed_by_elimination():
    """A four-bar and a slider behind its rocker, as a closed form gives them."""
    loops = [
        [Vector("a", "t2"), Vector("b", "t3"), Vector("c", "t4", -1), Vector("d", 0.0, -1)],
        [Vector("c", "t4"), Vector("l", "t5"), Vector("x", 0.0, -1)],
    ]
    closure = Closure(loops, ("t3", "t4", "t5", "x"))
    known = {"a": 30.0, "b": 40.0, "c": 30.0, "d": 40.0, "l": 50.0, "t2": math.pi / 2}
    start = [np.array([v]) for v in (0.1, 1.5, -0.6, 41.0)]
    t3, t4, t5, x = (v[0] for v in closure.newton(known, start, 8))
    assert (t3, t4) == pytest.approx((0.0, math.pi / 2), abs=1e-12)
    assert (t5, x) == pytest.approx((-math.asin(0.6), 40.0), abs=1e-12)
