"""The scale of a drawing, as drawings state it."""

import pytest
from tables import each_row

import coursework
from coursework.parsing.numbers import read_number

COURSE = coursework.open_course()


@each_row(
    ("text", "unit", "value"),
    [
        ("1 cm = 100 mm", "mm/mm", 10),
        ("1 cm = 0,1 m", "mm/mm", 10),
        ("10 mm = 25 mm", "mm/mm", 2.5),
        ("1 mm pour 2 mm", "mm/mm", 2),
        ("k_v = 1 cm pour 200 mm/s", "mm/s/mm", 20),
        ("1 mm -> 20 mm·s⁻¹", "mm/s/mm", 20),
        ("20 mm/s for 1 mm of paper", "mm/s/mm", 20),
        ("1 mm représente 0,5 m.s-2", "mm/s^2/mm", 500),
        ("1 mm = 2·10³ mm/s²", "mm/s^2/mm", 2000),
        ("20 mm/s per mm", "mm/s/mm", 20),
    ],
)
def test_a_scale_is_read_as_drawings_state_it(text, unit, value):
    reading = read_number(text, unit)
    assert reading.values == pytest.approx((value,))
    assert reading.text == text


@each_row("text", ["1:2", "1/2", "échelle 1:2", "Échelle : 1/2", "k_l = 1:2"])
def test_a_ratio_of_lengths_has_two_readings_that_of_drawings_first(text):
    assert read_number(text, "mm/mm").values == (2.0, 0.5)


@each_row(
    ("text", "unit", "code"),
    [
        ("1:20", "mm/s/mm", "not_a_number"),
        ("1 mm = 20 kg", "mm/s/mm", "other_dimension"),
        ("1 mm pour 2 mm ou 3 mm", "mm/mm", "two_values"),
        ("0:2", "mm/mm", "not_finite"),
        ("1 cm = 100 mm", "mm", "two_values"),
    ],
)
def test_what_is_no_scale_is_not_read_as_one(text, unit, code):
    assert read_number(text, unit).code == code


@each_row("written", ["1:{:g}", "1/{:g}", "1 cm = {:g} cm", "1 mm pour {:g} mm", "{:g}"])
def test_the_scale_of_a_drawing_is_right_in_any_of_them_and_a_number_upside_down_is_not(written):
    variant = COURSE["two_circles"].variant(1)
    found = variant.solution()
    points = {p.id: tuple(found[p.id]) for p in variant.parts if p.kind == "point"}
    mark = variant.grade(points | {"kl": written.format(found["kl"])})["kl"]
    assert mark.verdict == "correct"
    assert variant.grade(points | {"kl": f"{1 / found['kl']:g}"})["kl"].verdict == "mistake:scale_upside_down"
