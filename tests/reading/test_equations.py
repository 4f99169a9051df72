"""Equations are told from what is none."""

from tables import each_row

from coursework.reading.choices import read_choice
from coursework.reading.equations import parse_equation, read_equation
from coursework.reading.equivalence import same_equation

NAMES = ("r1", "r2", "r3", "r4", "theta2", "theta3", "theta4")


def test_an_equation_is_read_as_written():
    reading = read_equation("$r_2\\cos\\theta_2 + r_3\\cos\\theta_3 = r_1 + r_4\\cos\\theta_4$.", NAMES)
    reference = parse_equation("r2*cos(theta2) + r3*cos(theta3) = r1 + r4*cos(theta4)", NAMES)
    assert reading.status == "read"
    assert same_equation(reading.values[0], reference)


@each_row(
    ("text", "code"),
    [("r1 + r2", "no_equals_sign"), ("r1 === r2", "two_equals_signs"), ("r1 = = r2", "two_equals_signs"), ("r1 = r2 = r3", "two_equals_signs"), ("r1 = r9", "unknown_symbol"),
     ("r1 = ", "not_a_number"), (5, "no_equals_sign"), (True, "not_a_number"), ("r1 = 9^9^9", "too_complex")],
)  # fmt: skip
def test_what_is_no_equation_says_why(text, code):
    reading = read_equation(text, NAMES)
    assert (reading.status, reading.code, reading.text) == ("unreadable", code, str(text))


def test_operators_and_places_tell_formulas_apart():
    ratios = {"speeds": ("$V_e / V_s$",), "inverse": ("$V_s / V_e$",)}
    assert read_choice("V_e / V_s", ratios).values == ("speeds",)
    assert read_choice("V_s/V_e", ratios).values == ("inverse",)
    assert read_choice("V_e*V_s", ratios).status == "unreadable"
    values = {"clamp": ("$m_u = 1$",), "none": ("$m_u = 0$",), "two": ("$m_u = 2$",)}
    for text in ("2", "2)", "(2)", "[2]"):
        assert read_choice(text, values).values == ("two",), text
    assert read_choice("m_u = +1", values).values == ("clamp",)
    counts = {"zero": ("0",), "three": ("3",), "one": ("1",)}
    assert read_choice("1.0", counts).values == ("one",)
