"""A student's drawing stands over the right one: right vectors and wrong ones are told apart, by colour and
by dash."""

import re

import pytest

import coursework
from coursework.figures.plot import RIGHT, WRONG
from coursework.figures.polygons.own_drawing import drawn_polygon
from coursework.sheets.answer_sheet import answer_sheet

COURSE = coursework.open_course()


def right_one(name, seed=3):
    """The right polygon, and its points on paper from another pole at a round scale."""
    polygon = answer_sheet(COURSE[name].variant(seed, "en")).polygons[0].polygon
    scale = polygon.size / 100
    pole = polygon.points[polygon.pole]
    return polygon, {n: 30 + 20j + (z - pole) / scale for n, z in polygon.points.items()}, scale


def strokes(svg, colour):
    return re.findall(rf'stroke="{colour}" stroke-width="[^"]*" stroke-dasharray="([^"]*)"', svg)


@pytest.mark.parametrize("name", ["velocity_polygon", "acceleration_polygon", "velocity_polygon_six_bar"])
def test_a_right_drawing_is_all_green_and_a_reversed_vector_is_red(name):
    polygon, points, scale = right_one(name)
    svg = drawn_polygon(polygon, points, scale).outlined_svg()
    assert strokes(svg, WRONG) == []
    assert set(strokes(svg, RIGHT)) == {"none"}
    pole, first = points[polygon.pole], next(iter(polygon.hangs))
    shifted = {n: z for n, z in points.items() if n == polygon.pole} | {first: 2 * pole - points[first]}
    wrong = drawn_polygon(polygon, shifted, scale).outlined_svg()
    assert len(strokes(wrong, WRONG)) == 1
    assert "none" not in strokes(wrong, WRONG)


def test_what_cannot_be_judged_is_not_drawn():
    polygon, points, _ = right_one("velocity_polygon")
    assert drawn_polygon(polygon, {}, 5) is None
    assert drawn_polygon(polygon, {polygon.pole: 0j}, 5) is None
    for scale in (None, 0.0, -3.0, float("inf"), 1e-300):
        assert drawn_polygon(polygon, points, scale).outlined_svg().startswith("<svg")
    far = {n: 1e8 * z for n, z in points.items()}
    assert "nan" not in drawn_polygon(polygon, far, 5).outlined_svg()
