"""What accuracy costs: the rows say what is true of the methods, whatever the machine's speed."""

from __future__ import annotations

import json
import math
import sys
from dataclasses import replace

import pytest
from sweeps import slow

from coursework.accuracy.closure import Closure
from coursework.accuracy.measuring import HARD, measure, study_of
from coursework.accuracy.page import report
from coursework.cli import run
from coursework.errors import BadInput
from coursework.kinematics.chains import Vector
from coursework.language.words import languages
from coursework.rendering.renderer import renderer_of

STUDIED = ("four_bar_motion", "slider_crank", "slotted_mechanism")
FIELDS = {"method", "place", "ns_per_configuration", "max_error", "n"}


@pytest.fixture(scope="module")
def rows(course):
    return {name: list(measure(course[name], quick=True)) for name in (*STUDIED, "slider_crank_torque")}


def error(rows, what, method, place="generic"):
    (row,) = (r for r in rows if (r.what, r.method, r.place) == (what, method, place))
    return row.max_error


@pytest.mark.parametrize("name", STUDIED)
def test_the_stable_form_keeps_all_digits_where_the_textbook_loses_half(rows, name):
    for what in ("position", "rate"):
        assert error(rows[name], what, "stable") < 2e-15
        assert error(rows[name], what, "stable", HARD) < 2e-15
        assert error(rows[name], what, "textbook") < 5e-15
        assert error(rows[name], what, "textbook", HARD) > 1e-10


@pytest.mark.parametrize("name", STUDIED)
def test_precisions_are_told_apart(rows, name):
    own = rows[name]
    assert 1e-9 < error(own, "position", "single") < 1e-5
    assert error(own, "position", "mpmath") < 1e-45
    extended = [r.max_error for r in own if (r.method, r.place) == ("extended", "generic")]
    assert all(e < error(own, "position", "textbook") / 100 for e in extended)


@pytest.mark.parametrize("name", STUDIED)
def test_newton_squares_its_error_where_the_solutions_are_apart(rows, name):
    first, second, third = (error(rows[name], "position", f"newton-{k}") for k in (1, 2, 3))
    assert second < 10 * first**2
    assert third < max(10 * second**2, 1e-14)


@pytest.mark.parametrize("name", STUDIED)
def test_tables_gain_the_fourth_power_of_their_step(rows, name):
    coarse, fine = (error(rows[name], "position", f"table-{n}") for n in (64, 512))
    assert coarse / fine > 8**4 / 8
    assert error(rows[name], "position", "table-4096") < 1e-11


@pytest.mark.parametrize("name", STUDIED)
def test_the_error_of_a_difference_is_a_v_of_its_step(rows, name):
    found = {r.setting: r.max_error for r in rows[name] if r.family == "differences" and r.place == "generic"}
    best = min(found, key=found.get)
    assert 1e-7 < best < 1e-3
    assert found[1e-1] / found[1e-2] == pytest.approx(100, rel=0.1)
    assert found[1e-9] > 100 * found[best]
    assert error(rows[name], "rate", "complex_step") < 1e-14


def test_a_tighter_tolerance_integrates_better(rows):
    found = [r.max_error for r in rows["slider_crank_torque"]]
    assert found == sorted(found, reverse=True)
    assert found[0] > 1e-5
    assert found[-1] < 1e-9


def test_rows_are_whole(rows):
    for own in rows.values():
        for row in own:
            assert row.as_json().keys() >= FIELDS
            assert row.ns_per_configuration > 0
            assert 0 <= row.failed <= row.n
            assert (row.max_error is None) == (row.failed == row.n)
        assert len({(r.what, r.method, r.place) for r in own}) == len(own)


#: One study on a French page always; all of them in every language, slow.
PAGES = [("fr", STUDIED[:1]), *((lang, STUDIED) for lang in languages())]


@pytest.mark.parametrize(
    ("lang", "studied"),
    [PAGES[0], *(pytest.param(*page, marks=slow) for page in PAGES[1:])],
    ids=["one-fr", *(f"all-{lang}" for lang in languages())],
)
def test_the_page_reads_the_rows_in_every_language(course, rows, lang, studied):
    every = [row for name in (*studied, "slider_crank_torque") for row in rows[name]]
    page = report(course, every, lang)
    assert len(page.sections) == 2 * len(studied) + 1
    html = renderer_of(course.folder).report_html(page)
    assert html.count("<figure>") == 4 * len(studied) + 1
    assert "<script" not in html
    assert "http://" not in html.replace("http://www.w3.org", "")
    assert renderer_of(course.folder).report_pdf(page).startswith(b"%PDF")
    if lang == "fr":
        assert "forme stable" in html
        assert "closed form" not in html


@pytest.mark.parametrize("place", ["generic", HARD])
def test_the_page_passes_over_differences_that_have_no_answer(course, rows, place):
    def lost(row):
        return (row.family, row.place) == ("differences", place) and row.setting < 1e-4

    own = [replace(r, max_error=None, failed=r.n) if lost(r) else r for r in rows["slotted_mechanism"]]
    assert any(map(lost, own))
    html = renderer_of(course.folder).report_html(report(course, own, "en"))
    assert "no answer" in html


def test_the_command_writes_page_and_rows(tmp_path, capsys):
    assert run(["accuracy", "slotted_mechanism", "--quick", "--lang", "en", "--out", str(tmp_path)]) == 0
    capsys.readouterr()
    written = json.loads((tmp_path / "accuracy.json").read_text("utf-8"))
    assert {row["place"] for row in written} == {"generic", "hard"}
    assert (tmp_path / "accuracy.html").exists()
    assert (tmp_path / "accuracy.pdf").read_bytes().startswith(b"%PDF")


def test_an_exercise_without_a_study_is_told_in_one_line(course, capsys):
    assert study_of(course["ball_reducer"]) is None
    with pytest.raises(BadInput, match="ACCURACY"):
        list(measure(course["ball_reducer"]))
    assert run(["accuracy", "ball_reducer"]) == 2
    assert "ACCURACY" in capsys.readouterr().err


def test_two_loops_are_closed_by_elimination():
    """A four-bar and a slider behind its rocker, as a closed form gives them."""
    loops = [
        [Vector("a", "t2"), Vector("b", "t3"), Vector("c", "t4", -1), Vector("d", 0.0, -1)],
        [Vector("c", "t4"), Vector("l", "t5"), Vector("x", 0.0, -1)],
    ]
    closure = Closure(loops, ("t3", "t4", "t5", "x"))
    known = {"a": 30.0, "b": 40.0, "c": 30.0, "d": 40.0, "l": 50.0, "t2": math.pi / 2}
    import numpy as np

    start = [np.array([v]) for v in (0.1, 1.5, -0.6, 41.0)]
    t3, t4, t5, x = (v[0] for v in closure.newton(known, start, 8))
    assert (t3, t4) == pytest.approx((0.0, math.pi / 2), abs=1e-12)
    assert (t5, x) == pytest.approx((-math.asin(0.6), 40.0), abs=1e-12)


def test_without_matplotlib_the_page_is_written_but_for_its_charts(rows, tmp_path, monkeypatch, capsys):
    from coursework.accuracy import measuring

    monkeypatch.setattr(measuring, "measure", lambda exercise, quick: rows[exercise.name])
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert run(["accuracy", "slotted_mechanism", "--lang", "en", "--out", str(tmp_path)]) == 0
    assert "all is written but the charts: charts need matplotlib" in capsys.readouterr().err
    assert {p.name for p in tmp_path.iterdir()} == {"accuracy.json", "accuracy.html", "accuracy.pdf"}
    page = (tmp_path / "accuracy.html").read_text("utf-8")
    assert "<figure>" not in page
    assert "The charts are left out" in page
    assert len(json.loads((tmp_path / "accuracy.json").read_text("utf-8"))) == len(rows["slotted_mechanism"])
