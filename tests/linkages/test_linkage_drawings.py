"""Polygons asked by a mechanism's file are judged vector by vector, from any pole and at any scale."""

import numpy as np
import pytest
from linkage_samples import course

from coursework.authoring.checks import check_all
from coursework.marking.marking import mark

POLE = np.array([31.0, -12.0])


def _drawing(variant, scale=1.25):
    """Right answers to the drawn parts, from another pole and at another scale than the reference's."""
    key = variant.exercise.solve(**variant.given)
    answers = {}
    for letter in "va":
        own = {n: v for n, v in key.items() if n.startswith(f"{letter}_") or n == f"p{letter}"}
        answers |= {n: POLE + np.asarray(v) / scale for n, v in own.items()}
        answers[f"k{letter}"] = key[f"k{letter}"] * scale
    return answers


def _marks(variant, answers):
    texts = {n: f"{v[0]:.9f}; {v[1]:.9f}" if np.ndim(v) else f"{v:.9g}" for n, v in answers.items()}
    return mark(variant, texts)


@pytest.mark.parametrize(("name", "count"), [("four_bar", 11), ("slotted_lever", 11)])
def test_a_right_drawing_gets_full_marks_from_any_pole_and_scale(name, count):
    variant = course()[name].variant(2)
    marks = _marks(variant, _drawing(variant))
    drawn = [n for n in marks if n[:2] in ("v_", "a_", "pv", "pa", "kv", "ka")]
    assert len(drawn) == count
    assert {n: marks[n].points / marks[n].out_of for n in drawn} == dict.fromkeys(drawn, 1.0)


def test_a_guide_drawn_without_coriolis_costs_the_point_it_leads_to():
    variant = course()["slotted_lever"].variant(2)
    answers = _drawing(variant)
    answers["a_k_4"] = answers["a_a"]
    marks = _marks(variant, answers)
    assert [n for n, m in marks.items() if n in answers and m.points < m.out_of] == ["a_k_4"]


@pytest.mark.parametrize(("point", "mistake"), [("v_a", "pv_a_sense"), ("a_b1", "a_a_b1_sense")])
def test_a_vector_laid_off_backwards_is_named_and_costs_its_end_alone(point, mistake):
    variant = course()["four_bar"].variant(2)
    answers = _drawing(variant)
    start = POLE if point == "v_a" else answers["a_a"]
    answers[point] = 2 * start - answers[point]
    marks = _marks(variant, answers)
    assert marks[point].verdict == f"mistake:{mistake}"
    assert [n for n, m in marks.items() if n in answers and m.points < m.out_of] == [point]


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["four_bar", "toggle", "two_loops", "slotted_lever", "scotch_yoke", "geared_five_bar"]
)
def test_the_mechanisms_to_start_from_pass_their_check(name):
    (report,) = check_all(course(), [name], 20, lambda *_: None)
    assert not report.failures


def test_equations_of_a_loop_are_right_in_any_form_and_a_missing_bar_is_named():
    variant = course()["slotted_ram"].variant(1)
    right = {
        "loop_1_x": "s*cos(theta4) = r2*cos(theta2) + e*sin(theta4)",
        "loop_2_y": "h - r6*sin(theta5) - r5*sin(theta4) = 0",
    }
    marks = mark(variant, right)
    assert {n: marks[n].points for n in right} == dict.fromkeys(right, 1.0)
    marks = mark(variant, {"loop_2_x": "r5*cos(theta4) + s_E = 0"})
    assert (marks["loop_2_x"].points, marks["loop_2_x"].verdict) == (0.0, "slip:link_missing")
