"""Units are read by dimension and prefix, and converted without surprise."""

import math
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tables import each_row

from coursework.errors import WrongUnit
from coursework.parsing.units import UnknownUnit, convert, find_unit, parse_unit, same_dimension

#: Spelling, canonical unit, and what one of the spelling is in it, from the definitions of the units.
SPELLINGS = [
    *[
        (s, "rad/s", 1)
        for s in (
            "rad/s",
            "rad.s-1",
            "rad·s⁻¹",
            "rad s^-1",
            "1/s",
            "s^-1",
            "rad.s^{-1}",
            "rad*s**-1",
            "rad 1/s",
        )
    ],
    *[(s, "rad/s", math.pi / 30) for s in ("tr/min", "rpm", "rev/min", "tours/min", "tr.min⁻¹", "turns/min")],
    *[(s, "rad/s", math.pi / 180) for s in ("°/s", "deg/s", "deg.s-1", "degrés/s")],
    *[(s, "mm/s^2", 1) for s in ("mm/s2", "mm/s²", "mm.s-2", "mm s^-2", "mm·s⁻²", "mm/s/s", "mm/(s^2)")],
    *[(s, "N*m", 1) for s in ("N.m", "Nm", "N·m", "N m", "N*m", "J", "N×m", "N.m/rad", "kg.m²/s²")],
    *[(s, "mm^2", 1) for s in ("mm²", "mm^2", "mm2", "mm**2")],
    ("µm", "mm", 1e-3),
    ("μm", "mm", 1e-3),
    ("um", "mm", 1e-3),
    ("Mm", "mm", 1e9),
    ("cm", "mm", 10),
    ("dam", "m", 10),
    ("km", "mm", 1e6),
    ("millimètres", "mm", 1),
    ("meter", "mm", 1e3),
    ("milliampères", "A", 1e-3),
    ("kiloohms", "V/A", 1e3),
    ("coulomb", "A.s", 1),
    ("cm²", "mm^2", 100),
    ("m²", "mm^2", 1e6),
    ("kNmm", "N*m", 1),
    ("mNm", "N*m", 1e-3),
    ("daN.m", "N*m", 10),
    ("Ω", "kg*m^2/s^3/A^2", 1),
    ("Ω", "kg*m^2/s^3/A^2", 1),
    ("kΩ", "V/A", 1e3),
    ("°", "rad", math.pi / 180),
    ("º", "deg", 1),
    ("grad", "deg", 0.9),
    ("gon", "deg", 0.9),
    ("tr", "deg", 360),
    ("tours", "deg", 360),
    ("turn", "deg", 360),
    ("mrad", "rad", 1e-3),
    ("min", "s", 60),
    ("h", "s", 3600),
    ("ms", "s", 1e-3),
    ("km/h", "mm/s", 1e6 / 3600),
    ("t", "kg", 1e3),
    ("MPa", "N/mm^2", 1),
    ("kW", "N*m/s", 1e3),
    ("Hz", "1/s", 1),
    ("Hz", "rad/s", 2 * math.pi),
    ("mm/s/mm", "1/s", 1),
    ("cm/s/mm", "mm/s/mm", 10),
    ("%", "1", 0.01),
    ("mm/m", "1", 1e-3),
    ("rad/rad", "1", 1),
    ("µF", "A.s/V", 1e-6),
    ("mH", "V.s/A", 1e-3),
    ("mS", "1/Ω", 1e-3),
    ("mT", "Wb/m²", 1e-3),
    ("Wb", "V.s", 1),
    ("kVA", "W", 1e3),
    ("kWh", "J", 3.6e6),
    ("mAh", "C", 3.6),
    ("bar", "Pa", 1e5),
    ("mbar", "hPa", 1),
    ("L", "dm³", 1),
    ("cl", "mL", 10),
    ("l/min", "m^3/s", 1e-3 / 60),
    ("mol/L", "mol/m3", 1e3),
    ("cd/m²", "cd/cm²", 1e-4),
    ("ft", "in", 12),
    ("feet", "mm", 304.8),
    ("inches", "mm", 25.4),
    ("in^4", "cm^4", 2.54**4),
    ("cm⁴", "mm^4", 1e4),
    ("lb", "g", 453.59237),
    ("psi", "lbf/in^2", 1),
    ("W/(m²·°C)", "W/m²/K", 1),
    ("J/kg/K", "J/(kg.°C)", 1),
    ("mK", "delta_K", 1e-3),
    ("delta_degC", "delta_K", 1),
]


@each_row(("spelling", "canonical", "size"), SPELLINGS)
def test_a_spelling_people_use_is_its_unit(spelling, canonical, size):
    assert convert(1.0, spelling, canonical) == pytest.approx(size, rel=1e-14)


@each_row(
    ("a", "b"),
    [
        ("mm", "s"),
        ("rad", "1"),
        ("1", "deg"),
        ("N.m", "N"),
        ("rad/s", "rad/s^2"),
        ("mm", "mm^2"),
        ("°", "mm"),
    ],
)
def test_another_dimension_is_refused_with_both_named(a, b):
    assert not same_dimension(a, b)
    with pytest.raises(WrongUnit) as error:
        convert(1.0, a, b)
    assert repr(a) in str(error.value)
    assert repr(b) in str(error.value)


@each_row(("text", "piece", "offer"), [("MM", "MM", "'mm'"), ("Kg", "Kg", "'kg'"), ("tr/mn", "mn", "'m")])
def test_an_unknown_unit_names_its_piece_and_the_nearest(text, piece, offer):
    with pytest.raises(UnknownUnit) as error:
        parse_unit(text)
    assert error.value.found == piece
    assert offer in str(error.value)


@each_row(
    "text",
    [
        "",
        " ",
        "frogs",
        "mm//s",
        "mm/",
        "/mm",
        "(mm",
        "mm)",
        "mm 3",
        "5 mm",
        "mm^99",
        "mm^",
        "m^1.5",
        "()",
        "mm()",
        "Tm9" * 9,
        "(" * 30 + "m" + ")" * 30,
        "m" * 5000,
        "^2",
        "mm^-",
        "é",
        "° 1-1 °",
        "m 1",
        "° 1 °",
    ],
)
def test_what_is_no_unit_is_refused(text):
    assert find_unit(text) is None
    with pytest.raises(WrongUnit):
        parse_unit(text)


def test_case_matters():
    assert parse_unit("Mm").factor / parse_unit("mm").factor == pytest.approx(1e9)
    assert same_dimension("Nm", "J")
    assert same_dimension("nm", "m")
    assert find_unit("KM") is None


def test_the_same_unit_leaves_a_number_untouched():
    for value in (319.8, 0.1 + 0.2, 5e-324, 1.7e308):
        assert convert(value, "mm", "mm") == value
        assert convert(value, "N.m", "J") == value


@given(st.fractions(min_value=-1000, max_value=1000, max_denominator=10**6))
@settings(max_examples=200)
def test_a_power_of_ten_costs_one_rounding(value):
    for source, target, factor in [
        ("m", "mm", 1000),
        ("mm", "m", Fraction(1, 1000)),
        ("kN", "MN", Fraction(1, 1000)),
    ]:
        assert convert(float(value), source, target) == float(Fraction(float(value)) * factor)


UNITS = st.sampled_from(["mm", "rad/s", "N.m", "deg", "tr/min", "kg.m²", "mm/s/mm", "%", "km/h", "grad"])


@given(st.floats(-1e6, 1e6), UNITS, UNITS)
def test_a_conversion_and_back_is_the_same_value(value, a, b):
    if same_dimension(a, b):
        assert convert(convert(value, a, b), b, a) == pytest.approx(value, rel=1e-14)


def test_a_quotient_binds_from_left_to_right():
    assert parse_unit("mm/s/mm").dimension == parse_unit("1/s").dimension
    assert parse_unit("N/m.s").dimension == parse_unit("N.s/m").dimension


def test_capitals_never_make_one_unit_of_another():
    """A spelling that was a unit keeps its meaning: milli and mega are told apart by their capitals alone."""
    for low, high in (("mW", "MW"), ("mm", "Mm"), ("mN", "MN"), ("mrad", "Mrad"), ("grad", "Grad")):
        assert parse_unit(low).factor != parse_unit(high).factor
    for text in ("MM", "KM", "Gr", "mRad", "MRAD", "NM"):
        with pytest.raises(UnknownUnit):
            parse_unit(text)


@each_row(
    ("unit", "canonical", "constant"),
    [
        *[
            ("in", "m", "inch"),
            ("ft", "m", "foot"),
            ("lb", "kg", "pound"),
            ("lbf", "N", "lbf"),
            ("psi", "Pa", "psi"),
        ],
        *[("eV", "J", "eV"), ("L", "m^3", "liter"), ("bar", "Pa", "bar"), ("kWh", "W.s", None)],
    ],
)
def test_factors_are_those_that_another_table_has(unit, canonical, constant):
    from scipy import constants

    expected = getattr(constants, constant) if constant else constants.kilo * constants.hour
    assert convert(1.0, unit, canonical) == pytest.approx(expected, rel=1e-15)


@each_row(
    ("value", "unit", "target", "expected"),
    [
        *[
            (20.0, "°C", "K", 293.15),
            (293.15, "K", "°C", 20.0),
            (-40.0, "°C", "°F", -40.0),
            (212, "°F", "degC", 100),
        ],
        *[(20.0, "°C", "delta_K", 20.0), (20.0, "delta_K", "°C", 20.0), (9.0, "°F", "delta_degC", 5.0)],
        *[
            (0.0, "K", "mK", 0.0),
            (1.0, "K", "mK", 1000.0),
            (20.0, "℃", "K", 293.15),
            (20.0, "degrés Celsius", "K", 293.15),
        ],
    ],
)
def test_a_temperature_has_its_zero_and_a_difference_has_none(value, unit, target, expected):
    from coursework.parsing.spelling import plain_spelling

    assert convert(value, plain_spelling(unit), target) == pytest.approx(expected, abs=1e-12)


def test_a_temperature_is_converted_exactly():
    assert convert(Fraction("36.6"), "°C", "K") == Fraction("309.75")


@each_row(
    ("answer", "unit", "status"),
    [
        *[("20 °C", "deg", "wrong_unit"), ("90°", "°C", "wrong_unit"), ("10 dB", "1", "wrong_unit")],
        *[("3 dB", "%", "wrong_unit"), ("3 V", "A", "wrong_unit"), ("12 in mm", "mm", "unreadable")],
        # In other capitals, or with its degree sign, it would be right: a human looks.
        *[("3 S", "s", "unreadable"), ("5 rad/S", "rad/s", "unreadable"), ("20 C", "°C", "unreadable")],
        *[("20 C", "A.s", "read"), ("50 %", "1", "read"), ("-3 dB", "dB", "read"), ("20°C", "K", "read")],
    ],
)
def test_what_is_like_another_unit_is_not_taken_for_it(answer, unit, status):
    from coursework.parsing.numbers import read_number

    assert read_number(answer, unit).status == status


@each_row(
    ("unit", "text", "latex"),
    [
        ("cm^4", "cm⁴", r"\ \mathrm{cm^{4}}"),
        ("mm^-1", "mm⁻¹", r"\ \mathrm{mm^{-1}}"),
        ("kg*m^2", "kg·m²", r"\ \mathrm{kg{\cdot}m^{2}}"),
        ("kohm", "kΩ", r"\ \mathrm{k\Omega}"),
        ("delta_K", "K", r"\ \mathrm{K}"),
        ("%", "%", r"\ \mathrm{\%}"),
        ("deg", "°", r"^{\circ}"),
        ("1", "", ""),
    ],
)
def test_a_unit_is_printed_with_its_powers_and_signs(unit, text, latex):
    from coursework.language.numbers import unit_latex, unit_text

    assert (unit_text(unit, "en"), unit_latex(unit)) == (text, latex)
