"""Digits on paper: what rounding students and erring ones make of a margin."""

from __future__ import annotations

import json

import pytest
from tables import each_row

from coursework.accuracy.overview import overview
from coursework.accuracy.pages import overview_report, paper_report
from coursework.accuracy.paper import PLAIN, Share, on_paper, total
from coursework.cli import run
from coursework.language.words import languages
from coursework.rendering.renderer import renderer_of

VARIANTS = 60


@pytest.fixture(scope="module")
def rows(course):
    names = ("four_bar_motion", "slider_extras", "slotted_mechanism")
    return [row for name in names for row in on_paper(course[name], VARIANTS)]


def by_digits(rows):
    return {row.digits: row for row in total(rows)}


def test_who_keeps_the_digits_that_are_expected_is_never_wronged(course, rows):
    own = by_digits(rows)
    expected = course.folder.rules.digits
    assert all(own[d].wronged_ours.found == 0 for d in own if d >= expected)
    assert own[expected].wronged_ours.of > 1000


def test_fewer_digits_wrong_more_right_answers(rows):
    shares = [row.wronged.value for digits, row in sorted(by_digits(rows).items()) if digits != PLAIN]
    assert shares == sorted(shares, reverse=True)
    assert shares[0] > 0.1


def test_a_margin_for_fewer_digits_lets_more_mistakes_pass(rows):
    own = by_digits(rows)
    shares = [own[d].mistakes.value for d in (2, 3, 4, 5, 6)]
    assert shares == sorted(shares, reverse=True)
    assert own[2].mistakes.value > 2 * own[4].mistakes.value
    assert own[6].mistakes.found >= own[PLAIN].mistakes.found
    assert own[PLAIN].mistakes.of > 1000


def test_the_margin_is_that_of_the_marking(course):
    """A student's rounded answer is refused here where the marking refuses it."""
    from coursework.marking.marking import mark
    from coursework.quantities.rounding import student_who_rounds

    exercise = course["slider_extras"]
    refused = asked = 0
    for seed in range(12):
        variant = exercise.variant(seed, parts=("all",))
        parts = [p for p in variant.parts if p.kind in ("number", "angle")]
        found = student_who_rounds(
            exercise.solution.graph, [p.quantity for p in parts], variant.used, variant.effects, 3
        )
        marking = mark(variant, {p.id: found[p.quantity] for p in parts})
        asked += len(parts)
        refused += sum(marking[p.id].verdict not in ("correct", "follow_through") for p in parts)
    row = next(r for r in on_paper(exercise, 12) if r.digits == 3)
    assert row.wronged_ours.of == asked
    assert 0 < refused <= row.wronged_ours.found  # the marking forgives what follows from an earlier answer


def test_shares_add_up():
    assert Share(10, 1) + Share(30, 3) == Share(40, 4)
    assert Share(40, 4).value == pytest.approx(0.1)
    assert Share().value == 0


@pytest.fixture(scope="module")
def lines(course):
    return [overview(course[name], quick=True) for name in ("slotted_mechanism", "coriolis")]


@each_row("lang", languages())
def test_the_pages_are_written_in_every_language(course, rows, lines, lang):
    for page in (
        paper_report(course, rows, VARIANTS, lang),
        overview_report(course, lines, ("mobility",), lang),
    ):
        html = renderer_of(course.folder).report_html(page)
        assert html.count("<table") >= 2
        assert course["slotted_mechanism"].title(lang) in html
        assert renderer_of(course.folder).report_pdf(page).startswith(b"%PDF")
    assert course["mobility"].title(lang) in html


def test_the_command_tells_both(tmp_path, capsys):
    assert run(["accuracy", "coriolis", "--paper", "--quick", "--lang", "en", "--out", str(tmp_path)]) == 0
    assert "4 digits" in capsys.readouterr().out
    assert {row["digits"] for row in json.loads((tmp_path / "accuracy.json").read_text("utf-8"))} == {
        0,
        2,
        3,
        4,
        5,
        6,
    }
