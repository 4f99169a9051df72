"""Polygons as data: points, equations, sides, scales."""

from __future__ import annotations

import cmath
import math

import pytest
from courses_polygons import COURSE
from tables import each_row

from coursework.errors import BadCourse, UnknownName
from coursework.figures.polygons.polygon import Polygon, Side, normal, tangential, turning
from coursework.rendering.displayed import DisplayedConstruction as Construction

TRIANGLE = (
    Side("p_v", "a", "V_A", 3, r"\parallel Ox", "3"),
    Side("a", "b", "V_{B/A}", 4j, r"\parallel Oy"),
    Side("p_v", "b", "V_B", 3 + 4j, r"\perp CB"),
)


def test_a_polygon_tells_its_points_what_they_hang_on_and_its_equation():
    polygon = Polygon("velocity", TRIANGLE)
    assert dict(polygon.points) == {"p_v": 0, "a": 3, "b": 3 + 4j}
    assert polygon.hangs == {"a": TRIANGLE[:1], "b": TRIANGLE[1:]}
    assert [stage.kind for stage in polygon.stages] == ["known", "line", "crossing"]
    assert polygon.equations == ("V_B = V_A + V_{B/A}",)
    assert (polygon.pole, polygon.unit, polygon.size) == ("p_v", "mm/s", 5)
    with pytest.raises(UnknownName, match="p_v b"):
        polygon.side("p_v", "c")


def test_a_side_laid_off_backwards_stands_on_the_other_side_of_the_equation():
    """a_A = a_G + a_s + a_c, whose last vector ends at the known point."""
    polygon = Polygon(
        "acceleration",
        (
            Side("p", "a", "A", 5, "x", "5"),
            Side("k", "a", "C", 1j, "y", "1"),
            Side("p", "g", "G", -1j, "y"),
            Side("g", "k", "S", 5, "x"),
        ),
    )
    assert dict(polygon.points) == {"p": 0, "a": 5, "k": 5 - 1j, "g": -1j}
    assert polygon.equations == ("A = G + C + S",)


def test_a_line_of_a_vector_that_vanishes_is_drawn_by_its_way():
    sides = (TRIANGLE[0], Side("a", "b", "V_{B/A}", 0, r"\perp AB", way=2j), Side("p_v", "b", "V_B", 3, "x"))
    drawn = Construction(Polygon("velocity", sides), "en")
    assert drawn.polygon.points["b"] == 3
    assert "a, b" in [box.label.replace(r",\ ", ", ") for box in drawn.figure.labels()]
    assert [row.paper for row in drawn.rows][1] == "0.0"


@each_row(
    ("sides", "said"),
    [
        ((), "at least one side"),
        (TRIANGLE[:2], "b lies on one line only"),
        ((TRIANGLE[0], Side("c", "d", "V", 1, "x", "1")), "neither of its ends"),
        ((TRIANGLE[0], Side("p_v", "a", "V", 3, "x", "3")), "both its ends"),
        ((*TRIANGLE[:2], Side("p_v", "b", "V_B", 3 + 5j, "x")), "does not close"),
        ((*TRIANGLE[:2], Side("p_v", "b", "V_B", 3 + 4j, "x", way=1)), "does not close"),
        ((*TRIANGLE, Side("a", "c", "V_C", 1)), "c is not found"),
        ((*TRIANGLE, Side("a", "b", "V", 5j)), "does not close"),
    ],
)
def test_a_polygon_that_cannot_be_drawn_is_refused(sides, said):
    with pytest.raises(BadCourse, match=said):
        Polygon("velocity", sides)


@each_row(
    ("side", "said"),
    [
        ({"value": 1, "length": "r"}, "state it"),
        ({"value": math.nan, "direction": "x"}, "not finite"),
        ({"value": 0, "direction": "x"}, "state way"),
    ],
)
def test_a_side_that_says_too_little_is_refused(side, said):
    with pytest.raises(BadCourse, match=said):
        Side("p", "a", "V", **side)


def test_an_unknown_kind_or_language_is_told():
    with pytest.raises(UnknownName, match="velocity"):
        Polygon("speed", TRIANGLE)
    with pytest.raises(UnknownName, match="fr"):
        Construction(Polygon("velocity", TRIANGLE), "xx")


@each_row(("length", "scale"), [(90.0, 1), (90.1, 2), (450, 5), (451, 10), (0.9, 0.01), (123456, 2000)])
def test_a_scale_is_the_least_round_one_that_fits(length, scale):
    polygon = Polygon("velocity", (Side("p", "a", "V", length, "x", "v"),))
    assert polygon.scale_in(90, 70) == pytest.approx(scale, rel=1e-12)
    upright = Polygon("velocity", (Side("p", "a", "V", 1j * length, "y", "v"),))
    assert upright.scale_in(1e9, 90) == pytest.approx(scale, rel=1e-12)


def test_what_does_not_move_has_no_scale_and_no_drawing():
    with pytest.raises(BadCourse, match="nothing moves"):
        Polygon("velocity", (Side("p", "a", "V", 0, "x", "v"),)).scale_in(90, 70)
    variant = COURSE["slider_crank"].variant(0)
    record = {**variant.record, "given": {n: dict(v) for n, v in variant.record["given"].items()}}
    record["given"]["omega2"]["value"], record["given"]["alpha2"]["value"] = 0, 8
    (only,) = COURSE["slider_crank"].from_record(record).polygons()
    assert only.polygon.kind == "acceleration"


def test_the_sides_of_a_turning_bar_are_the_derivatives_of_its_vector():
    bar, omega, alpha, h = 3 + 4j, 2.0, -5.0, 1e-4

    def at(t):
        return bar * cmath.exp(1j * (omega * t + alpha * t**2 / 2))

    velocity = (at(h) - at(-h)) / (2 * h)
    acceleration = (at(h) - 2 * at(0) + at(-h)) / h**2
    assert turning("a", "b", "B/A", "AB", bar, omega).value == pytest.approx(velocity, rel=1e-6)
    n = normal("a", "b'", "B/A", "AB", bar, omega, "v")
    t = tangential("b'", "b", "B/A", "AB", bar, alpha)
    assert n.value + t.value == pytest.approx(acceleration, rel=1e-5)
    assert (n.value / bar).imag == pytest.approx(0)
    assert (t.value / bar).real == pytest.approx(0)


def test_a_length_on_paper_does_not_hang_on_a_last_bit():
    """46.75 mm, halfway between two tenths, as one processor or another comes by it."""
    printed = []
    for bits in range(-9, 10):
        length = 2 * 46.75 * (1 + bits * 2.0**-52)
        sides = (Side("p_v", "a", "V_A", length, "x", "1"), Side("p_v", "b", "V_B", 100j, "y", "1"))
        drawn = Construction(Polygon("velocity", sides), "en")
        assert drawn.scale == 2
        printed.append([row.paper for row in drawn.rows])
    assert printed == [["46.8", "50.0"]] * 19
