"""Each drawn exercise is constructed by touch from its statement alone, for full points, on a telephone and
on a desk."""

import constructions
import pytest
from site_browser import too_wide
from site_pencil import Draughtsman

import coursework

pytestmark = pytest.mark.e2e

DRAWN = [name for name in coursework.open_course().names if coursework.open_course()[name].spec.drawing_mm]


@pytest.mark.parametrize(("size", "lang"), [("telephone", "fr"), ("desk", "en")])
def test_each_drawn_exercise_is_constructed_for_full_points(desk, size, lang):
    failed = {}
    for exercise in DRAWN:
        hand = Draughtsman(desk, exercise, size, lang, number=("telephone", "desk").index(size))
        values = getattr(constructions, exercise)(hand)
        for part, value in values.items():
            hand.type(part, f"{value:.5g}")
        filled = {part for part, text in hand.answers().items() if text}
        hand.fill(part for part in hand.variant.parts if part.id not in filled)
        lost = [(m.part, m.answer, m.verdict) for m in hand.marks().values() if m.points < m.out_of]
        if lost or too_wide(hand.page):
            failed[exercise] = lost
        hand.close()
    assert failed == {}


#: A mistake that is drawn, and the words that it earns: exercise, what is done wrongly, what is said of which
#: point.
MISTAKEN = [
    ("velocity_polygon", {"a": "sense", "b": (0, "direction")}, {"a": "a_sense", "b": "ba_direction"}),
    (
        "velocity_polygon",
        {"a": "direction", "b": (1, "direction")},
        {"a": "a_direction", "b": "vb_direction"},
    ),
    ("velocity_polygon_slider", {"a": "vector", "b": (0, "sense")}, {"a": "a_vector", "b": "ba_sense"}),
    (
        "acceleration_polygon",
        {"a": "length", "n": "p", "m": "sense", "b": (0, "a")},
        {"a": "a_length", "n": "n_on_p", "m": "m_sense", "b": "bt_on_a"},
    ),
    (
        "acceleration_polygon_slider",
        {"n": "direction", "b": (1, "direction")},
        {"n": "n_direction", "b": "pb_direction"},
    ),
    (
        "acceleration_polygon_slotted",
        {"k": "sense", "n": "length", "b": (0, "a")},
        {"k": "k_sense", "n": "n_length", "b": "s_on_a"},
    ),
    ("acceleration_polygon_six_bar", {"m": "length", "f": "p"}, {"m": "m_length", "f": "f_on_p"}),
    ("velocity_polygon_six_bar", {"scale": 10}, dict.fromkeys(("kv", "p", "a", "b", "c"), "too_small")),
    ("acceleration_polygon_slider", {"stated": 2}, {"ka": "scale_not_drawn"}),
    (
        "two_circles",
        {"a": "length", "radii": "exchanged"},
        {"a": "a_length", "b1": "radii_exchanged", "b2": "radii_exchanged"},
    ),
    (
        "havens_construction",
        {"v10": "sense", "v20": "foot"},
        {"v10": "vector_sense", "v20": "distance_forgotten"},
    ),
]


def test_mistakes_that_are_drawn_are_named(desk):
    otherwise = {}
    for number, (exercise, mistakes, named) in enumerate(MISTAKEN, start=2):
        hand = Draughtsman(desk, exercise, mistakes=mistakes, number=number)
        getattr(constructions, exercise)(hand)
        marks = hand.marks()
        said = {part: marks[part].verdict for part in named}
        if said != {part: f"mistake:{name}" for part, name in named.items()}:
            otherwise[exercise] = said
        hand.close()
    assert otherwise == {}
