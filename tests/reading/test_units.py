"""Units are read by dimension and prefix, and converted without surprise."""

import math
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coursework.errors import WrongUnit
from coursework.reading.units import UnknownUnit, convert, find_unit, parse_unit, same_dimension

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
]


@pytest.mark.parametrize(("spelling", "canonical", "size"), SPELLINGS)
def test_a_spelling_people_use_is_its_unit(spelling, canonical, size):
    assert convert(1.0, spelling, canonical) == pytest.approx(size, rel=1e-14)


@pytest.mark.parametrize(
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


@pytest.mark.parametrize(
    ("text", "piece", "offer"),
    [
        ("MM", "MM", "'mm'"),
        ("Kg", "Kg", "'kg'"),
        ("rad/S", "S", "'s'"),
        ("tr/mn", "mn", "'m"),
    ],
)
def test_an_unknown_unit_names_its_piece_and_the_nearest(text, piece, offer):
    with pytest.raises(UnknownUnit) as error:
        parse_unit(text)
    assert error.value.found == piece
    assert offer in str(error.value)


@pytest.mark.parametrize(
    "text",
    ["", " ", "frogs", "mm//s", "mm/", "/mm", "(mm", "mm)", "mm 3", "5 mm", "mm^99", "mm^", "m^1.5", "()",
    "mm()", "°C",
     "Tm9" * 9, "(" * 30 + "m" + ")" * 30, "m" * 5000, "^2", "mm^-", "é", "° 1-1 °", "m 1", "° 1 °"],
)  # fmt: skip
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
    for text in ("MM", "KM", "S", "Gr", "RAD.S", "mRad", "MRAD", "NM"):
        with pytest.raises(UnknownUnit):
            parse_unit(text)
