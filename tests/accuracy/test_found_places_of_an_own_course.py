"""Hard places of an instructor's own formulas: what is planted is found."""

from __future__ import annotations

import pytest

import coursework
from coursework.accuracy.hard_places import hard_places

EXERCISE = """
from coursework.model import Exercise, Part, drawn
EXERCISE = Exercise(
    given={
        "a": drawn(50, 90, step=5, unit="mm"),
        "b": drawn(100, 140, step=5, unit="mm"),
        "theta": drawn(-180, 175, step=5, unit="deg"),
    },
    parts=(Part("x"),),
)
"""


@pytest.fixture
def planted(tmp_path):
    def course_of(formula):
        for folder, text in (
            ("exercises", EXERCISE),
            ("solutions", f"from coursework.degrees import *\n{formula}\n"),
        ):
            (tmp_path / folder).mkdir()
            (tmp_path / folder / "planted.py").write_text(text, "utf-8")
        return coursework.open_course(tmp_path)["planted"]

    return course_of


def only(places, **wanted):
    (place,) = (p for p in places if all(getattr(p, n) == v for n, v in wanted.items()))
    return place


def test_a_difference_that_is_divided_by_vanishes_where_its_terms_are_equal(planted):
    exercise = planted("def x(a, b):\n    return (a + b) / (a - b)")
    place = only(hard_places(exercise, ("x",)), moved="a", kind="quotient")
    assert place.given["a"] == place.given["b"]
    assert place.lost > 1e-12
    assert not place.double


def test_a_root_that_is_taken_of_nothing(planted):
    exercise = planted("def x(a, b, theta):\n    return sqrt(b - a * sin(theta))")
    places = hard_places(exercise, ("x",))
    touching = [p for p in places if p.double and p.moved == "theta"]
    assert touching
    for place in touching:  # the crank upright, and as long as b
        assert place.given["theta"] == pytest.approx(90, abs=1e-4)
        assert place.given["a"] == pytest.approx(place.given["b"], abs=1e-6)


def test_the_direction_of_a_distance_that_vanishes(planted):
    exercise = planted("def x(a, b, theta):\n    return atan2(a * sin(theta), b + a * cos(theta))")
    place = next(p for p in hard_places(exercise, ("x",)) if p.double and p.moved == "theta")
    assert abs(place.given["theta"]) == pytest.approx(180, abs=1e-4)
    assert place.given["a"] == pytest.approx(place.given["b"], abs=1e-6)


def test_a_formula_that_keeps_its_digits_has_no_hard_place(planted):
    exercise = planted("def x(a, b, theta):\n    return a * b + theta")
    assert not [p for p in hard_places(exercise, ("x",)) if p.kind != "vanishing"]
