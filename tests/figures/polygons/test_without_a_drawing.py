"""What is read off a drawing earns little where the drawing is missing, or all of it is turned."""

import pytest

import coursework
from coursework.quantities.error_kinds import PENALTIES

COURSE = coursework.open_course()
DRAWN = [name for name in COURSE.names if COURSE[name].spec.drawing_mm]


def answers(variant, points):
    """The right answers of a sheet, and these of the points by id."""
    right = {p.id: variant.reference(p.quantity) for p in variant.parts if p.judge}
    given = {i: value for i, value in right.items() if variant.exercise.spec.part(i).kind != "point"}
    return {**given, **{i: f"{x:.3f}; {y:.3f}" for i, (x, y) in points.items()}}


def read_off(variant, given):
    """The points earned by what is judged with the drawing and is not a point of it, and what they are out
    of."""
    marking = variant.grade(given)
    parts = [p for p in variant.parts if p.judge == "drawing" and p.kind != "point"]
    return sum(marking[p.id].points for p in parts), sum(p.points for p in parts)


def turned(x, y):
    return -y, x


@pytest.mark.parametrize("name", DRAWN)
def test_what_is_read_off_no_drawing_or_one_turned_by_a_right_angle_earns_little(name):
    for variant in COURSE[name].variants(range(5), "en"):
        places = {p.id: variant.reference(p.quantity) for p in variant.parts if p.kind == "point"}
        whole, out_of = read_off(variant, answers(variant, places))
        assert whole == out_of
        for drawing in ({}, {i: turned(*place) for i, place in places.items()}):
            earned, _ = read_off(variant, answers(variant, drawing))
            assert earned <= PENALTIES["not_drawn"] * out_of, (variant.seed, drawing)
