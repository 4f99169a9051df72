"""What students write as a number is read as they mean it; what cannot be read says why and is kept."""

import math
import sys
from decimal import Decimal

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from strategies import CHOICES, FINITE, NARROW, NBSP, ODD, SPACES, THIN
from tables import each_row

from coursework.errors import WrongUnit
from coursework.parsing.choices import read_choice
from coursework.parsing.equations import read_equation
from coursework.parsing.numbers import read_integer, read_number
from coursework.parsing.points import read_point
from coursework.parsing.reading import Reading

#: Text, canonical unit, the one honest value.
NUMBERS = [
    *[
        (s, "mm", 319.8)
        for s in (
            "319.8",
            "319,8",
            " 319.8 ",
            "+319.8",
            "319.8 mm",
            "319,8mm",
            f"319,8{NARROW}mm",
            f"319,8{THIN}mm",
            f"{NBSP}319,8{NBSP}mm{NBSP}",
            "0.3198 m",
            "31,98 cm",
            "319800 µm",
            "319800 μm",
            "0,0003198 km",
            "3.198e2",
            "3,198E2 mm",
            "3.198x10^2",
            "3,198·10²",
            "3.198*10^2 mm",
            "3.198×10^2",
            "3198×10^-1",
            "3198·10⁻¹ mm",
            "3,198.10^2 mm",
            "3.198 10^2",
            "3.198 e 2",
            "3.198*10**2",
            "3.198×10^{2}",
            "rA = 319,8 mm",
            "r_A ≈ 319.8",
            "x: 319.8",
            "rA=319.8mm.",
            "environ 319,8 mm",
            "about 319.8",
            "≈ 319,8",
            "~319.8 mm",
            "= 319.8",
            "319.8;",
            "$r_A = 319{,}8\\,\\mathrm{mm}$",
            "\\SI{319.8}{mm}",
            "$319.8$ mm",
            "319.8 (mm)",
            "319.8 [mm]",
            "319.8*mm",
            "３１９．８ ｍｍ",
            "٣١٩٫٨ mm",
            "319.8\u200b",
            "319,8 millimètres",
            "639.6/2",
            "319.8\n",
            "3198/10 mm",
        )
    ],
    *[(s, "mm", -319.8) for s in ("-319.8", "−319,8", "–319.8 mm", "- 319.8", "－319.8", "-0,3198 m")],
    *[
        (s, "mm", 1234.5)
        for s in (
            "1234.5",
            "1 234,5",
            f"1{NBSP}234,5",
            f"1{NARROW}234,5",
            f"1{THIN}234.5",
            "1'234.5",
            "1’234.5",
            "1,234.5",
            "1.234,5",
            "1 234,5 mm",
            "1,234.5 mm",
            "123.45 cm",
        )
    ],
    *[
        (s, "mm", 1234567)
        for s in ("1,234,567", "1.234.567", "1 234 567", "1'234'567", "1.234.567,0", "1,234,567.0")
    ],
    ("1.234", "mm", 1.234),
    ("0,123", "mm", 0.123),
    ("1234,567", "mm", 1234.567),
    (",5", "mm", 0.5),
    (".5", "mm", 0.5),
    ("12.", "mm", 12),
    ("0", "mm", 0),
    ("-0", "rad/s", 0),
    *[
        (s, "deg", 104 + 38 / 60)
        for s in ("104°38'", "104° 38′", "104°38’", "104 ° 38 '", "104°38", "θ4 = 104°38'")
    ],
    *[
        (s, "deg", 104.64)
        for s in ("104° 38′ 24″", "104°38'24\"", "104°38'24''", "104,64°", "104.64 deg", "104,64 degrés")
    ],
    ("-0°30'", "deg", -0.5),
    ("30°15'", "rad", math.radians(30.25)),
    *[
        (s, "deg", 120)
        for s in (
            "2π/3 rad",
            "2*pi/3 rad",
            "(2/3)π rad",
            "\\frac{2\\pi}{3} rad",
            "120",
            "120°",
            "1/3 tr",
            "400/3 grad",
            "90°+30°",
            "180-60 °",
            "2*60°",
        )
    ],
    ("0,58 π rad", "deg", 104.4),
    ("1.82 rad", "deg", math.degrees(1.82)),
    ("π/3", "rad", math.pi / 3),
    ("π/3", "rad/s", math.pi / 3),
    ("sqrt(2)/2", "1", math.sqrt(0.5)),
    ("√2/2", "1", math.sqrt(0.5)),
    ("1/3", "1", 1 / 3),
    ("75 %", "1", 0.75),
    ("75%", "1", 0.75),
    ("0.75 mm/mm", "1", 0.75),
    ("sin(30°)", "1", 0.5),
    ("180 - 75.4", "deg", 104.6),
    *[
        (s, "deg", 180 - math.degrees(math.atan(1.6)))
        for s in (
            "180 - arctan(1.6)",
            "arctan(-1.6) + 180",
            "180° - arctan(1.6)",
            "180 - arctan(1.6)°",
            "180 - arctan(1.6) deg",
            "180° - arctan(1.6)°",
            "180 + atan2(-1.6; 1)",
            "θ4 = 180 - arctg(1,6)",
            "180 - 1*atan(16/10) degrés",
            "180-arctan 1.6",
            "-(arctan(1.6) - 180)",
        )
    ],
    *[
        (s, "deg", 120)
        for s in (
            "90 + arcsin(0.5)",
            "arccos(-0.5)",
            "arccos(-0,5)°",
            "acos(-0.5) deg",
            "acos(-0.5) rad",
            "2 arccos(0,5)",
            "2*arccos(0.5)°",
            "180 - arccos(sin(30))",
            "90° + asin(sin(30°))",
        )
    ],
    *[
        (s, "rad", 2 * math.pi / 3)
        for s in ("90 + arcsin(0.5)", "arccos(-0.5)", "acos(-0.5)°", "acos(-0.5) rad", "acos(-0.5) deg")
    ],
    *[
        (s, "deg", math.degrees(math.acos(-0.5)) * k)
        for s, k in (
            ("acos(-0.5)*57.3", 57.3 * math.pi / 180),
            ("acos(-0.5)*180/3.14", math.pi / 3.14),
            ("180/3.14 * acos(-0.5)", math.pi / 3.14),
        )
    ],
    ("180 - 57.3*acos(0.5)", "deg", 180 - 57.3 * math.pi / 3),
    *[
        (s, "rad/s", 9.42)
        for s in (
            "9.42 rad/s",
            "9,42 rad.s-1",
            "9.42 rad·s⁻¹",
            "9.42 rad s^-1",
            "9.42 1/s",
            "9.42/s",
            "9.42 s⁻¹",
        )
    ],
    *[
        (s, "rad/s", 3 * math.pi)
        for s in ("90 tr/min", "90 rpm", "90 rev/min", "540 °/s", "540 deg/s", "3π rad/s", "1.5 Hz")
    ],
    *[
        (s, "mm/s^2", -12.5)
        for s in ("-12.5 mm/s2", "−12,5 mm/s²", "-12.5 mm.s-2", "-12.5 mm s^-2", "-0.0125 m/s²")
    ],
    *[
        (s, "N*m", 4.2)
        for s in ("4.2 N.m", "4,2 Nm", "4.2 N·m", "4.2 N m", "4200 N.mm", "4.2N.m", "0,0042 kNm")
    ],
    ("5 mm/s/mm", "mm/s/mm", 5),
    *[
        (s, "rad/s", 3 * math.pi)
        for s in (
            "90 RPM",
            "90 Rpm",
            "90 revs/min",
            "90 tours par minute",
            "90 Tr/Min",
            "90 TR/MIN",
            "90 revolutions per minute",
        )
    ],
    *[
        (s, "rad/s", -9.42)
        for s in ("—9,42 Rad/s", "-9,42 rad per s", "(-9,42 rad/s)", "— 9,42", "−9,42 radians par seconde")
    ],
    *[(s, "N*m", 5) for s in ("5 N-m", "5000 N-mm")],
    *[
        (s, "mm", 12.5)
        for s in (
            '"12.5"',
            "«12,5 mm»",
            "« 12,5 » ",
            "“12.5”",
            "'12.5",
            "'12,5 mm",
            "'12.5'",
            "'=12.5",
            "12.5&nbsp;mm",
        )
    ],
    *[(s, "deg", 122.1) for s in ("122.1&deg;", "122,1 Deg", "122.1 DEG", "'122.1°", "(122.1°)")],
    *[(s, "1", 1.25) for s in ("1.25:1", "1,25 : 1", "5:4")],
    *[(s, "mm", 1.5) for s in ("1 1/2", "1 1/2 mm", "1 2/4", f"1{NBSP}1/2", "rA = 1 1/2", "1 1/2mm")],
    ("−12 3/4 m", "mm", -12750),
    ("2 1/2 tr/min", "rad/s", math.pi / 12),
    ("1 234/5", "mm", 246.8),
]


@each_row(("text", "unit", "value"), NUMBERS)
def test_a_spelling_of_a_number_is_read(text, unit, value):
    reading = read_number(text, unit)
    assert reading.status == "read", reading
    assert reading.values == pytest.approx((value,), rel=1e-14)
    assert reading.text == text


#: Facts of how established grading systems read answers, where their rule is ours.
ESTABLISHED = [
    ("0.1 km", "100 m"),
    ("1000 dm", "100 m"),
    ("1000 um", "1 mm"),
    ("0.001 m", "1 mm"),
    ("1000 pm", "1 nm"),
    ("1e-6 km^2", "1 m^2"),
    ("10000 cm^2", "1 m^2"),
    ("1000 cm^3", "1 dm^3"),
    ("0.001 s", "1 ms"),
    ("0.001 us", "1 ns"),
    ("1000000 ms^2", "1 s^2"),
    ("0.001 kg", "1 g"),
    ("0.001 mg", "1 ug"),
    ("1000 mN", "1 N"),
    ("0.000001 MN", "1 N"),
    ("1000000 pN", "1 uN"),
    ("0.001 MN", "1 kN"),
    ("1000 MJ", "1 GJ"),
    ("1000000000 nJ", "1 J"),
    ("0.000001 GW", "1 kW"),
    ("0.001 TW", "1 GW"),
    ("0.001 GPa", "1 MPa"),
    ("1000 MHz", "1 GHz"),
    ("1000 mC", "1 C"),
    ("1e9 uV", "1000 V"),
    ("1 kohm", "1000 ohm"),
    ("0.001 Mohm", "1000 ohm"),
    ("1 km/s", "1 m/ms"),
    ("1e-3 Pa ms^-2", "1 kPa s^-2"),
    ("1 km g / s^2", "1 m kg s^-2"),
    ("314cm", "3.14 m"),
    ("314000000x10^-8m", "3.14 m"),
    ("1 meter", "1 m"),
    ("12.3*m/s", "12.3 m/s"),
    ("-123000*J", "-123 kJ"),
    ("0.0*km/s", "0 m/s"),
    ("1E0 J", "1 J"),
    ("1 J^1", "1 J"),
    ("1J", "1 J"),
    ("10^-3 kJ", "1 J"),
    ("1 kg*m^2/s^2", "1 J"),
    ("1E9 fm", "1 um"),
    ("1/60 min", "1 s"),
]


@each_row(("answer", "reference"), ESTABLISHED)
def test_answers_that_other_graders_accept_are_read_alike(answer, reference):
    number, unit = reference.split(" ", 1)
    assert read_number(answer, unit).values == pytest.approx((float(number),), rel=1e-12)


@each_row(
    ("text", "unit", "values", "echoes"),
    [
        ("1,234", "mm", (1.234, 1234), ("1.234", "1234")),
        ("-1,234 mm", "mm", (-1.234, -1234), ("-1.234 mm", "-1234 mm")),
        ("12,345 m", "mm", (12345, 12345000), ("12.345 m", "12345 m")),
        ("1/2π", "1", (math.pi / 2, 0.5 / math.pi), ("1.570796", "0.1591549")),
        ("3.10^2", "mm", (300, 9.61), ("3e2", "9.61")),
        ("3,2×10-2", "mm", (0.032, 30), ("3.2e-2", "30")),
        ("2.739x102", "mm", (279.378, 273.9), ("279.378", "2.739e2")),
        ("2,739 × 102 mm", "mm", (279.378, 273.9), ("279.378 mm", "2.739e2 mm")),
        ("2,739·102", "mm", (279.378, 273.9), ("279.378", "2.739e2")),
        ("-2.7940x101", "mm", (-282.194, -27.94), ("-282.194", "-2.7940e1")),
        ("2.1x1011", "1", (2123.1, 2.1e11), ("2123.1", "2.1e11")),
    ],
)
def test_two_honest_readings_are_both_kept_the_likelier_first(text, unit, values, echoes):
    reading = read_number(text, unit)
    assert reading.values == pytest.approx(values)
    assert reading.read_as == echoes


@given(
    st.floats(-3, 3),
    st.sampled_from(["180 - arctan({})", "90 + arcsin({}/3)", "arccos({}/3) deg", "180° - atan({})"]),
)
@settings(max_examples=300, deadline=None)
def test_the_formula_of_an_angle_in_degrees_has_no_other_reading_near_a_wrong_one(x, form):
    """Whatever is read is the angle that the formula gives to who works in degrees, or in radians at most."""
    text = form.format(f"({x:.6f})")
    x = float(f"{x:.6f}")
    right = {
        "180 - arctan({})": 180 - math.degrees(math.atan(x)),
        "90 + arcsin({}/3)": 90 + math.degrees(math.asin(x / 3)),
        "arccos({}/3) deg": math.degrees(math.acos(x / 3)),
        "180° - atan({})": 180 - math.degrees(math.atan(x)),
    }[form]
    assert read_number(text, "deg", thousands=False).values == pytest.approx((right,), abs=1e-9)


@each_row(
    "text",
    [
        "27.39x102",
        "0.2739x102",
        "2.739*100",
        "2.739*110.5",
        "2.739*102*3",
        "2.739*102+1",
        "2.739x112",
        "2*102/3",
    ],
)
def test_a_product_that_is_no_power_of_ten_has_one_reading(text):
    assert len(read_number(text, "mm").values) == 1


@each_row(
    ("text", "unit", "value"),
    [
        ("273.9 (273.92)", "mm", 273.9),
        ("273,9 mm (273,92)", "mm", 273.9),
        ("273.9 (27.392 cm)", "mm", 273.9),
        ("6 (5+1)", "1", 6),
        ("6 (5+1) mm", "mm", 6),
        ("1 234 (1234)", "mm", 1234),
        ("1,234 (1.234)", "mm", 1.234),
        ("0,33 (1/3)", "1", 0.33),
        ("1.41 (sqrt(2))", "1", 1.41),
        ("122.1 (2.13)", "deg", 122.1),
        ("104.6° (1.8256 rad)", "deg", 104.6),
        ("9.42 (90 tr/min)", "rad/s", 9.42),
        ("rA = 319.8 (319.80)", "mm", 319.8),
        ("1.8256 rad = 104.6°", "deg", 104.6),
        ("6 - 3 = 3", "1", 3),
        ("θ4 = 180 - 57.9 = 122.1°", "deg", 122.1),
        ("319.84 ≈ 319.8", "mm", 319.8),
        ("639.6/2 = 319.8 mm", "mm", 319.8),
        ("1,234 = 1234", "mm", 1234),
        ("(-9,42 rad/s)", "rad/s", -9.42),
        ("(319.8 mm)", "mm", 319.8),
        ("2(3+4)", "1", 14),
        ("2 (π/3)", "rad", 2 * math.pi / 3),
        ("(1+2)(3+4)", "1", 21),
    ],
)
def test_a_number_written_twice_alike_is_that_number_and_no_product(text, unit, value):
    assert read_number(text, unit).values == pytest.approx((value,), rel=1e-14)


@each_row(
    ("text", "value", "echo"),
    [
        ("π/3", 60, "1.047198 rad"),
        ("acos(cos(60))", 60, "60 deg"),
        ("3.14159 - atan(1.6)", 122.005231, "2.129393 rad"),
        ("180 - atan(1.6)", 122.0053832, "122.0054 deg"),
    ],
)
def test_a_formula_of_an_angle_has_the_unit_that_its_pieces_have(text, value, echo):
    reading = read_number(text, "deg")
    assert reading.values == pytest.approx((value,))
    assert reading.read_as == (echo,)


def test_an_angle_and_itself_in_radians_are_one_answer():
    assert read_number("2.13 (122.1)", "deg").values == (122.1,)
    assert read_number("2.131 = 122.1", "deg").values == (122.1,)
    assert read_number("2.10 (122.1)", "deg").code == "two_values"


@given(
    st.decimals(-400, 400, places=2),
    st.decimals(-400, 400, places=1),
    st.sampled_from(["{} ({})", "{} ({}) mm", "{} = {}"]),
)
@settings(max_examples=250, deadline=None)
def test_two_numbers_are_one_only_where_they_agree(one, other, form):
    assume(min(abs(one), abs(other)) > 4)  # half a digit of a smaller one is more than 1.5 % of it
    for two in (other, one.quantize(Decimal("0.1")), one.quantize(Decimal("0.1")) + Decimal("0.2")):
        reading = read_number(form.format(one, two), "mm")
        if abs(one - two) <= Decimal("0.05"):
            assert reading.values == (float(two if "=" in form else one),)
        else:
            assert reading.code == "two_values"


@each_row(
    ("text", "unit", "echo", "given"),
    [
        ("319,8 mm", "mm", "319.8 mm", True),
        ("319,80", "mm", "319.80", False),
        ("rA = 1 234,5 mm", "mm", "1234.5 mm", True),
        ("3,2·10² mm", "mm", "3.2e2 mm", True),
        ("104°38'", "deg", "104.6333 deg", True),
        ("30°+15°", "deg", "45 deg", True),
        ("0,58 π rad", "deg", "1.822124 rad", True),
        ("2π/3", "rad/s", "2.094395", False),
        ("5 mm/s²", "mm/s^2", "5 mm/s²", True),
        ("5 mm·s⁻²", "mm/s^2", "5 mm·s⁻²", True),
        ("-12.5", "mm", "-12.5", False),
        ("3.2e2", "mm", "3.2e2", False),
    ],
)
def test_the_echo_has_a_point_and_the_unit_as_written(text, unit, echo, given):
    reading = read_number(text, unit)
    assert reading.read_as == (echo,)
    assert reading.unit_given is given


@each_row("blank", [None, "", " ", "\t\n", NBSP, THIN + NARROW, "\u3000\u200b", "\ufeff", " " * 20_000])
def test_nothing_but_spaces_is_missing(blank):
    for reading in (
        read_number(blank, "mm"),
        read_integer(blank),
        read_point(blank, "mm", 2),
        read_choice(blank, {"a": ()}),
        read_equation(blank, ("r",)),
    ):
        assert reading.status == "missing"
        assert reading.values == ()


@each_row(
    ("text", "code"),
    [
        ("nan", "not_finite"),
        ("NaN", "not_finite"),
        ("inf", "not_finite"),
        ("-Infinity", "not_finite"),
        ("∞", "not_finite"),
        ("1e999", "not_finite"),
        ("1e308 km", "not_finite"),
        ("1/0", "not_finite"),
        ("9" * 450, "not_finite"),
        ("10^64*10^64*10^64*10^64*10^64", "not_finite"),
        ("1e9999999999 m", "not_finite"),
        ("9**9**9", "too_complex"),
        ("9^9^9^9^9", "too_complex"),
        ("(" * 300 + "1", "too_complex"),
        ("7" * 10_000, "too_long"),
        ("x" * 10_000, "too_long"),
        ("319.8 ± 50", "two_values"),
        ("319.8 +/- 250 mm", "two_values"),
        ("319-320", "two_values"),
        ("319,5 – 320 mm", "two_values"),
        ("3 à 5 mm", "two_values"),
        ("3 or 5", "two_values"),
        ("1 ; 2", "two_values"),
        ("> 3", "two_values"),
        ("3..5", "two_values"),
        ("319.8 MM", "unknown_unit"),
        ("3 Gr", "unknown_unit"),
        ("3 NM", "unknown_unit"),
        ("3 per", "unknown_unit"),
        ("12:30", "not_a_number"),
        ("3 RPMS/par", "unknown_unit"),
        ("3.14 frogs", "unknown_unit"),
        ("3,2·10² frogs", "unknown_unit"),
        ("abc", "unknown_symbol"),
        ("theta2", "unknown_symbol"),
        ("trois fois", "unknown_symbol"),
        ("180°-75", "mixed_units"),
        ("90°-5", "mixed_units"),
        ("-", "not_a_number"),
        ("?", "not_a_number"),
        ("!", "not_a_number"),
        ("5 6", "not_a_number"),
        ("1,2,3", "not_a_number"),
        ("1,23,456", "not_a_number"),
        ("1.2.3", "not_a_number"),
        ("1 3/2", "not_a_number"),
        ("1 0/2", "not_a_number"),
        ("1 1/2/3", "not_a_number"),
        ("rA = 3 = 4", "two_values"),
        ("273.9 (274.2)", "two_values"),
        ("6 (5)", "two_values"),
        ("2 (3+4)", "two_values"),
        ("6 (5) mm", "two_values"),
        ("6 - 3 = 4", "two_values"),
        ("5 (-5)", "two_values"),
        ("9 mm (9 cm)", "two_values"),
        ("1 = 1 = 1", "not_a_number"),
        ("5 (±0.1)", "two_values"),
        ("3 = ", "not_a_number"),
        ("104°75'", "not_a_number"),
        ("__import__('os')", "not_a_number"),
        (True, "not_a_number"),
        (False, "not_a_number"),
        ([1, 2], "not_a_number"),
        ([], "not_a_number"),
        ({}, "not_a_number"),
        (float("nan"), "not_finite"),
        (float("inf"), "not_finite"),
        (10**400, "not_finite"),
    ],
)
def test_what_cannot_be_read_says_why_and_is_kept(text, code):
    reading = read_number(text, "deg" if "°" in str(text) else "mm")
    assert (reading.status, reading.code) == ("unreadable", code)
    assert reading.values == reading.read_as == ()
    assert reading.text == str(text)
    assert 0 < len(reading.found) <= 60


@each_row(
    ("text", "unit", "found"),
    [
        ("3 kg", "mm", "kg"),
        ("0 s", "mm", "s"),
        ("0.0*m", "mm/s", "m"),
        ("5 mm", "deg", "mm"),
        ("1 rad", "1", "rad"),
        ("2 %", "mm", "%"),
        ("3 m/s²", "mm/s", "m/s²"),
        ("104°38'", "mm", "deg"),
        ("2π mm", "deg", "mm"),
        ("1 Nm", "N", "Nm"),
    ],
)
def test_a_unit_of_another_dimension_is_a_wrong_unit(text, unit, found):
    reading = read_number(text, unit)
    assert (reading.status, reading.code, reading.found) == ("wrong_unit", "other_dimension", found)


def test_numbers_of_json_are_taken_as_they_are():
    assert read_number(319.8, "mm").values == (319.8,)
    assert read_number(3, "mm") == Reading("3", "read", (3.0,), ("3",))


@each_row(
    "answer",
    [
        np.float64(238.4367),
        np.array(238.4367),
        np.array([238.4367]),
        np.array([[238.4367]]),
        [238.4367],
        (238.4367,),
        [np.float64(238.4367)],
        [np.array([238.4367])],
        "np.float64(238.4367)",
        "array([238.4367])",
        "np.array(238.4367)",
        "[238.4367]",
    ],
)
def test_what_a_cell_computes_is_taken_as_the_number_that_it_holds(answer):
    reading = read_number(answer, "mm")
    assert (reading.status, reading.values, reading.read_as) == ("read", (238.4367,), ("238.4367",))


def test_an_array_is_read_as_its_items_are():
    assert read_point(np.array([12.3, 4.5]), "mm", 2).values == ((12.3, 4.5),)
    assert read_point(np.array([[12.3, 4.5]]), "mm", 2).values == ((12.3, 4.5),)
    assert read_integer(np.int64(3)).values == (3,)
    assert read_integer(np.array([3])).values == (3,)
    assert read_choice(np.array(["drag link"]), CHOICES).values == ("double_crank",)
    assert read_number(np.array([1.0, 2.0]), "mm").code == "not_a_number"
    assert read_number(np.array([True]), "mm").code == "not_a_number"
    assert read_number(np.zeros(10_000), "mm").code == "not_a_number"


@each_row(
    ("text", "values"),
    [
        ("113,466", (113.466,)),
        ("1,234°", (1.234,)),
        ("1,234 rad", (pytest.approx(math.degrees(1.234)),)),
        ("-1,234", (-1.234,)),
        ("1 234", (1234,)),
        ("1,234.5", (1234.5,)),
    ],
)
def test_a_comma_parts_no_thousands_of_a_direction(text, values):
    assert read_number(text, "deg", thousands=False).values == values


def test_an_unknown_canonical_unit_is_the_callers_error():
    with pytest.raises(WrongUnit):
        read_number("5 mm", "frogs")


def test_a_plain_number_is_the_same_reading_as_any_other():
    assert read_number("319.8", "mm") == Reading("319.8", "read", (319.8,), ("319.8",))
    assert hash(read_number("319.8", "mm")) == hash(Reading("319.8", "read", (319.8,), ("319.8",)))


def spellings(value: float) -> list[str]:
    """Ways to write one double so that its decimal digits are all there."""
    text = repr(value)
    mantissa, _, exponent = f"{value:.17e}".partition("e")
    power = int(exponent)
    return [
        text,
        text.replace("-", "−"),
        text.upper(),
        f"{mantissa}x10^{power}",
        f"{mantissa}·10^({power})",
        f"{mantissa} × 10^{{{power}}}",
        f"{mantissa}*10**{power}",
        f"{mantissa.replace('.', ',')}e{power}",
        f"{mantissa.replace('.', ',')}E{power:+d}",
    ]


@given(FINITE, SPACES, st.sampled_from(["", "mm"]))
@settings(max_examples=200)
@example(5e-324, "", "mm")
@example(sys.float_info.max, " ", "")
def test_a_double_in_any_spelling_reads_back_exactly(value, space, unit):
    for text in spellings(value):
        assert read_number(f"{space}{text}{space}{unit}", "mm").values == (value,), text


@given(
    st.integers(-(10**12), 10**12),
    st.integers(0, 999),
    st.sampled_from(" '" + NBSP + NARROW),
    st.sampled_from(".,"),
)
@settings(max_examples=200)
def test_groups_of_thousands_read_back_exactly(whole, thousandths, group, point):
    text = f"{whole:,}".replace(",", group) + point + f"{thousandths:03d}4"
    expected = float(f"{'-' if whole < 0 else ''}{abs(whole)}.{thousandths:03d}4")
    assert read_number(text, "mm").values == (expected,)


@given(st.decimals(-1000, 1000, places=4))
@settings(max_examples=200)
def test_a_decimal_in_metres_is_that_decimal_in_millimetres(value):
    assert read_number(f"{value} m", "mm").values == (float(value * 1000),)


@given(st.text(max_size=60) | ODD, st.sampled_from(["mm", "deg", "1", "rad/s", "N*m"]))
@settings(max_examples=80, deadline=None)
def test_any_text_gives_a_reading_and_keeps_the_text(text, unit):
    for reading in (
        read_number(text, unit),
        read_integer(text),
        read_point(text, unit, 2),
        read_choice(text, {"open": ("ouvert",), "crossed": ("croisé",)}),
        read_equation(text, ("r1", "theta2")),
    ):
        assert reading.text == text
        assert reading.status in ("read", "missing", "unreadable", "wrong_unit")
        assert (reading.status == "read") == bool(reading.values) == bool(reading.read_as)
        assert (reading.status in ("unreadable", "wrong_unit")) == bool(reading.code)
        assert len(reading.values) == len(reading.read_as) <= 2
        assert len(reading.found) <= 60


@given(ODD)
@settings(max_examples=200, deadline=None)
def test_a_value_that_is_read_is_finite(text):
    assert all(math.isfinite(v) for v in read_number(text, "deg").values)


def test_an_array_of_many_numbers_is_no_whole_number():
    assert read_integer(np.zeros(200)).status == "unreadable"


def test_an_inverse_function_of_degrees_has_no_unit_that_one_could_tell():
    reading = read_number("cos(atan2(-2; atan2(1; 3/(45°))))", "deg")
    assert (reading.status, reading.code) == ("unreadable", "two_values")
