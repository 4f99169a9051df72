"""Curves are drawn to scale; a right point lies on its own."""

from __future__ import annotations

import re

import numpy as np
import pytest
from study_words import BOTH, SAID, flat, start_of
from tables import each_row

import coursework
from coursework.errors import UnknownName, WrongValue
from coursework.figures.plot import AnswerPoint, Axis, Plot, round_values
from coursework.selfstudy import predictions


def test_a_right_answer_within_a_wide_tolerance_is_the_curves_own(here):
    session = coursework.study("slider_crank", seed=8, lang="en")
    value = session.variant.walk["ab_n"] + 0.9 * session.variant.key.half_width(
        next(p for p in session.variant.parts if p.id == "ab_n")
    )
    assert "✓" in str(session.check({"ab_n": f"{value:.4g}"}))
    assert "another" not in str(session.plot("ab_n"))


@BOTH
def test_a_right_answer_of_another_choice_is_not_marked_on_the_curve(lang, here):
    session = coursework.study("four_bar_positions", seed=1, lang=lang)
    names = [p.id for p in predictions.moving(session.variant)]
    session.check({"theta3_open": f"{session.variant.walk['theta3_crossed']:.3f}"})
    assert "theta3_open" in names
    shown = session.plot("theta3_open")
    assert not any("<circle" in getattr(piece, "svg", "") for piece in shown.pieces)
    assert start_of(SAID[lang]["beside_curve"]) in flat(shown)


def points_of(svg: str) -> list[np.ndarray]:
    """The curve's pieces, mm, y down."""
    (path,) = re.findall(r'<path d="([^"]*)" fill="none" stroke="#1b3a57" stroke-width="0.5"', svg)
    return [np.array([p.split() for p in run.split("L")], dtype=float) for run in path.split("M")[1:]]


def test_a_curve_is_drawn_to_scale_and_the_same_twice():
    x = np.linspace(0, 360, 25)
    plot = Plot(Axis(r"\theta_2", "°", x), [Axis("y", "mm", 2 * x + 5)], "en")
    (curve,) = points_of(plot.svg())
    assert plot.svg() == plot.svg()
    step = np.diff(curve, axis=0)
    assert np.ptp(step, axis=0) == pytest.approx([0, 0], abs=0.021)
    assert (step * [1, -1] > 0).all()


def test_a_dense_curve_is_drawn_with_the_points_that_are_seen():
    def drawn(count):
        x = np.linspace(0, 360, count)
        y = np.sin(np.radians(x)) + np.where(abs(x - 200) < 2, 0.5, 0)  # smooth, with a step
        return points_of(Plot(Axis("x", "", x), [Axis("y", "mm", y)]).svg())[0]

    thin, usual = np.array(drawn(7001)), np.array(drawn(1000))
    assert len(usual) == 1000
    assert 30 < len(thin) < 300
    smooth = np.abs(np.gradient(usual[:, 1])) < 0.3
    assert np.abs(np.interp(usual[:, 0], thin[:, 0], thin[:, 1]) - usual[:, 1])[smooth].max() < 0.05


def test_a_curve_is_cut_where_it_has_no_value_and_where_a_direction_turns_over():
    x = np.arange(8.0)
    y = np.array([1, 2, np.nan, 3, 4, 5, 4, 3.0])
    assert len(points_of(Plot(Axis("x", "", x), [Axis("y", "mm", y)]).svg())) == 2
    y = np.array([170, 175, 179, -178, -170, -160, -150, -140.0])
    assert len(points_of(Plot(Axis("x", "", x), [Axis("y", "°", y)]).svg())) == 2
    assert len(points_of(Plot(Axis("x", "", x), [Axis("y", "mm", y)]).svg())) == 1


def test_a_right_point_lies_on_its_curve_and_is_told_from_a_wrong_one():
    x = np.linspace(0, 10, 11)
    spots = [[AnswerPoint(4, 16, True)], [AnswerPoint(4, 60, False)]]
    plot = Plot(Axis("x", "", x), [Axis("y", "mm", x**2), Axis("z", "mm", x**2)], "en", 4, spots)
    svg = plot.svg()
    cx, cy = map(float, re.search(r'<circle cx="([\d.]+)" cy="([\d.]+)" r="1.3"', svg).groups())
    first = points_of(Plot(plot.horizontal, plot.panels[:1], "en", 4, spots[:1]).svg())[0]
    assert [cx, cy] == pytest.approx(first[4].tolist(), abs=0.011)
    assert svg.count('stroke="#b3261e"') == 1


def test_a_point_far_off_its_curve_is_an_arrow_at_the_edge_with_its_number():
    x = np.linspace(0, 10, 11)
    for y, is_far in ((60.0, False), (900.0, True), (-900.0, True)):
        plot = Plot(Axis("x", "", x), [Axis("y", "mm", x**2)], "en", 4, [[AnswerPoint(4, y, False, 246.7)]])
        cross, arrow = (s in plot.svg() for s in ('stroke="#b3261e"', 'z" fill="#b3261e"'))
        assert (plot.has_outside, cross, arrow) == ((is_far,), not is_far, is_far)
    far, near = (
        Plot(plot.horizontal, plot.panels, "en", 4, [[AnswerPoint(4, 900.0, False, w)]]) for w in (1.0, 246.7)
    )
    assert far.svg() != near.svg()


@BOTH
def test_a_wrong_angle_is_not_drawn_as_if_it_were_nearly_right(lang, here):
    session = coursework.study("slotted_mechanism", seed=1, lang=lang)
    session.check({"theta4": "246,7"})
    session.reveal("theta4")
    shown = session.plot("theta4")
    assert start_of(SAID[lang]["outside"]) in flat(shown)
    (svg,) = (piece.svg for piece in shown.pieces if hasattr(piece, "svg"))
    # 246.7° is above the curve, which reaches 114°.
    assert re.search(r'h2.8l-1.4 -2z" fill="#b3261e"', svg)


@each_row(("low", "high"), [(-4.7, 3.6), (-5.5, 3.5), (-1, 1), (40, 110), (0.013, 0.0189)])
def test_a_scale_has_three_round_numbers_at_least(low, high):
    ticks = round_values(low, high, 4)
    assert 3 <= len(ticks) <= 6
    assert all(low <= t <= high for t in ticks)
    assert np.ptp(np.diff(ticks)) < 1e-9 * (high - low)


def test_a_plot_says_what_it_cannot_draw():
    x = np.arange(3.0)
    for panels in ([], [Axis("y", "", np.arange(2.0))], [Axis("y", "", x * np.nan)]):
        with pytest.raises(WrongValue, match=r"curve|plot"):
            Plot(Axis("x", "", x), panels)


def test_the_curves_of_a_session_pass_through_the_answers(here):
    for name in ("slotted_mechanism", "slider_crank", "three_loop_shaper"):
        session = coursework.study(name, seed=2, lang="en")
        variant = session.variant
        driver = variant.exercise.spec.driver.angle
        for part in predictions.moving(variant):
            angles, values = predictions.curve(variant, part.quantity)
            at = np.argmin(np.abs((angles - variant.given[driver] + 180) % 360 - 180))
            gap = values[at] - variant.walk[part.quantity]
            gap = (gap + 180) % 360 - 180 if part.kind == "angle" else gap
            assert abs(gap) <= 1e-6 * np.nanmax(np.abs(values))
        assert "largest" in str(session.predict({})) or session.plot().pieces
        with pytest.raises(UnknownName):
            session.plot("nothing")


@BOTH
def test_a_curve_is_not_shown_before_its_answer(lang, here):
    """It would tell the value at the position of the statement."""
    session = coursework.study("slotted_mechanism", seed=1, lang=lang)
    session.predict({"p1": "90"})
    for shown in (session.plot(), session.plot("rA"), session.plot("omega4", "rA")):
        assert not any(hasattr(piece, "svg") for piece in shown.pieces)
        assert start_of(SAID[lang]["not_yet"]) in flat(shown)
        assert start_of(SAID[lang]["compared"]) not in flat(shown)
    right = session.variant.solution()
    session.check({"rA": f"{right['rA']:.6g}", "omega4": "9999"})
    shown = session.plot()
    (plot,) = (piece for piece in shown.pieces if hasattr(piece, "svg"))
    assert plot.said.startswith("r_A")
    held = flat(shown).partition(flat(SAID[lang]["not_yet"]).partition("{")[0])[2]
    assert "omega4" in held.partition(".")[0]
    assert "rA," not in held.partition(".")[0]
    assert start_of(SAID[lang]["compared"]) in flat(shown)  # where the length is largest can be told now
    session.reveal("omega4")
    assert any(hasattr(piece, "svg") for piece in session.plot("omega4").pieces)
    assert not any(hasattr(piece, "svg") for piece in session.plot("theta4").pieces)
