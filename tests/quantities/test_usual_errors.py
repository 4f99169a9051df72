"""Usual errors are made of the formula that computes: each differs from it in one thing, and says which."""

from __future__ import annotations

import ast

import numpy as np
import pytest

import coursework
from coursework.course.exercise import ALL
from coursework.degrees import acos, atan2, cos, polar, sin, sqrt
from coursework.quantities.formula_code import formula_of
from coursework.quantities.usual_errors import formula_errors
from coursework.solution import formula

COURSE = coursework.open_course()
every_exercise = pytest.mark.parametrize("name", COURSE.names)


def side(a, b, C):
    return sqrt(a**2 + b**2 - 2 * a * b * cos(C))


def _run(rod, rise):
    return sqrt(rod**2 - rise**2)


def reach(r, theta, rod):
    return r * cos(theta) + _run(rod, r * sin(theta))


def direction(x, y):
    return atan2(y, x)


def arm(r1, r2, theta):
    return abs(r1 + polar(r2, theta))


@formula(r"\frac{<a>^2 - <b>^2}{2 \times <a>}")
def stated(a, b):
    return (a - b) * (a + b) / (2 * a)


def errors(function, **values):
    """By kind and what it is about, the values."""
    found = {}
    for error in formula_errors(function):
        about = "" if error.about is None else ast.unparse(error.about)
        try:
            found.setdefault((error.kind, about), error.formula(values))
        except ValueError:
            found.setdefault((error.kind, about), np.nan)
    return found


def test_each_error_of_the_law_of_cosines_is_made():
    a, b, C = 5.0, 3.0, 60.0
    found = errors(side, a=a, b=b, C=C)
    expected = {
        ("term", "a ** 2"): np.nan,  # of a negative number
        ("term", "2 * a * b * cos(C)"): 34**0.5,
        ("term_sign", "2 * a * b * cos(C)"): 7.0,
        ("constant", "2"): (34 - 7.5) ** 0.5,
        ("factor", "b"): 29**0.5,
        ("factor", "cos(C)"): 2.0,
        ("square", "a"): np.nan,
        ("square", "b"): (25 + 3 - 15) ** 0.5,
        ("root", "a ** 2 + b ** 2 - 2 * a * b * cos(C)"): 19.0,
        ("function", "cos(C)"): (34 - 30 * 0.75**0.5) ** 0.5,
        ("degrees", "C"): (34 - 30 * np.cos(60.0)) ** 0.5,
    }
    for error, value in expected.items():
        assert found[error] == pytest.approx(value, nan_ok=True), error


def test_a_private_helper_is_looked_into():
    found = errors(reach, r=3.0, theta=30.0, rod=5.0)
    assert found["term", "(r * sin(theta)) ** 2"] == pytest.approx(3 * 0.75**0.5 + 5)
    assert found["all_degrees", ""] == pytest.approx(3 * np.cos(30.0) + (25 - (3 * np.sin(30.0)) ** 2) ** 0.5)


def test_an_arc_tangent_may_lose_its_quadrant_and_exchange_its_arguments():
    found = errors(direction, x=-1.0, y=1.0)
    assert found["quadrant", "atan2(y, x)"] == pytest.approx(-45)
    assert errors(direction, x=-1.0, y=2.0)["arguments", "atan2(y, x)"] == pytest.approx(-26.565051177)


def test_a_norm_may_lose_a_component():
    assert errors(arm, r1=4.0, r2=3.0, theta=90.0)["term", "r1"] == pytest.approx(3)


def test_a_stated_formula_is_read_as_it_is_printed():
    assert formula_of(stated)({"a": 5.0, "b": 3.0}) == pytest.approx(1.6)
    found = errors(stated, a=5.0, b=3.0)
    assert found["term", "b ** 2"] == pytest.approx(2.5)
    assert found["inverse", ""] == pytest.approx(1 / 1.6)


def test_the_other_angle_of_a_cosine():
    def corner(u):
        return acos(u)

    assert errors(corner, u=0.5)["branch", "acos(u)"] == pytest.approx(-60)


@every_exercise
def test_a_formula_is_what_its_quantity_is_computed_by(name):
    """Read off the code, or off the print: the same value to the last digits but a few."""
    exercise = COURSE[name]
    graph = exercise.solution.graph.textbook
    for variant in exercise.variants(range(3), parts=(ALL,)):
        met = graph.walk(variant.asked_quantities, variant.used, variant.effects)
        values = {**variant.used, **graph.everything(tuple(met), variant.used, variant.effects)}
        for quantity in met:
            node = graph.node(quantity)
            found = formula_of(node.function)
            if found is None or np.asarray(values[quantity]).dtype.kind not in "if":
                continue
            value = np.asarray(found({**node.defaults, **values}), dtype=float)
            size = max(1.0, float(np.max(np.abs(value)))) if exercise.units.get(quantity) == "deg" else 0.0
            assert np.allclose(value, values[quantity], rtol=1e-7, atol=1e-7 * size), quantity


@every_exercise
def test_no_two_errors_of_a_formula_are_the_same_code(name):
    graph = COURSE[name].solution.graph.textbook
    for quantity in graph.quantities:
        codes = [ast.dump(error.formula.tree) for error in formula_errors(graph.node(quantity).function)]
        assert len(set(codes)) == len(codes)


def test_an_error_gives_a_value_only_where_all_quantities_of_the_formula_are_met():
    """Also one that leaves a quantity out: who lacks it has not used the formula."""

    def total(near, far):
        return near + far

    (left_out, *_) = (e for e in formula_errors(total) if e.kind == "term")
    assert {left_out.formula({"near": 1.0, "far": 2.0})} <= {1.0, 2.0}
    for met in ({"near": 1.0}, {"far": 2.0}):
        with pytest.raises(KeyError):
            left_out.formula(met)
