"""The dyads in every orientation: they close, they turn with the paper, and their rates are derivatives."""

import cmath
import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from reference import mp
from strategies import side
from tables import each_row

from coursework.errors import CannotAssemble, Undefined
from coursework.kinematics import dyads
from coursework.kinematics.angles import Degrees
from coursework.kinematics.vectors import components, cross, direction, turned

EPS = 2.0**-52
coordinate = st.floats(-50, 50)
point = st.builds(complex, coordinate, coordinate)
length = st.floats(1, 100)
angle = st.floats(-4, 4)


def unit(theta):
    return cmath.rect(1, theta)


@settings(max_examples=100, deadline=None)
@given(point, point, length, length, side)
def test_an_rrr_dyad_closes_on_its_side_or_says_the_gap(p, q, b, c, side):
    apart, most, least = abs(q - p), b + c, abs(b - c)
    assume(apart > 1e-6)
    if apart > most * (1 + 1e-12) or apart < least * (1 - 1e-12):
        with pytest.raises(CannotAssemble) as raised:
            dyads.rrr(p, q, b, c, side)
        assert f"gap {max(apart - most, least - apart):.3g}" in str(raised.value)
        assert np.isnan(dyads.rrr(np.array([p]), q, b, c, side)).all()
    elif least * (1 + 1e-6) < apart < most * (1 - 1e-6):
        joint = dyads.rrr(p, q, b, c, side)
        worst = 32 * EPS * (b + c + abs(p) + abs(q))
        assert abs(abs(joint - p) - b) < worst * (1 + max(b, c) / apart)
        assert abs(abs(joint - q) - c) < worst * (1 + max(b, c) / apart)
        assert side * cross(q - p, joint - p) > 0


def test_an_rrr_dyad_whose_pins_coincide_may_point_anywhere():
    with pytest.raises(Undefined, match="anywhere"):
        dyads.rrr(1 + 1j, 1 + 1j, 2.0, 2.0)
    with pytest.raises(CannotAssemble):
        dyads.rrr(1 + 1j, 1 + 1j, 2.0, 1.0)
    assert np.isnan(dyads.rrr(np.array([1 + 1j]), 1 + 1j, 2.0, 2.0)).all()


def test_an_rrr_dyad_in_line_is_exact():
    assert dyads.rrr(0j, 3 + 0j, 1.0, 2.0) == 1
    assert dyads.rrr(0j, 1 + 0j, 2.0, 1.0, -1) == 2


@each_row("scale", [1e160, 1e-170])
def test_dyads_of_any_size_close(scale):
    p, q = complex(0, scale), complex(3 * scale, scale)
    assert abs(dyads.rrr(p, q, 2.4 * scale, 1.8 * scale) / scale - (1.92 + 2.44j)) < 8 * EPS
    assert abs(dyads.rrp(p, 5 * scale, complex(0, 5 * scale)) / scale - (3 + 5j)) < 16 * EPS
    direction_, slide = dyads.rpr(complex(3 * scale, 4 * scale), 0j)
    assert abs(direction_ - (0.6 + 0.8j)) < 4 * EPS
    assert slide / scale == pytest.approx(5, rel=4 * EPS)
    (first,), (second,) = dyads.rrr_rates(complex(0, scale), complex(scale, 0), [1j * scale], [scale + 0j])
    assert (first, second) == pytest.approx((-1.0, 1.0), rel=4 * EPS)


@settings(max_examples=60, deadline=None)
@given(point, st.floats(1, 20), st.floats(-0.99, 0.99), point, angle, side)
def test_an_rrp_dyad_lies_on_its_line_ahead_or_behind(p, length, share, through, theta, side):
    along = unit(theta)
    through = p + 1j * along * share * length + along * abs(through)
    found = dyads.rrp(p, length, through, side, along)
    assert abs(cross(along, found - through)) < 64 * EPS * (abs(through) + abs(p) + length)
    assert abs(abs(found - p) - length) < 64 * EPS * (abs(through) + abs(p) + length) / math.sqrt(
        1 - share**2
    )
    assert side * (np.conj(along) * (found - p)).real > 0


def test_a_horizontal_line_is_its_ordinate_and_the_guide_may_be_steep():
    assert dyads.rrp(0j, 5.0, 3.0) == 4 + 3j
    assert dyads.rrp(0j, 5.0, 3.0, -1) == -4 + 3j
    # A guide 0.05 degrees off the vertical: the same mechanism turned gives the same mechanism turned.
    turn = Degrees(89.95)
    along = complex(turn.cos, turn.sin)
    assert abs(dyads.rrp(0j, 5.0, 3j * along, 1, along) - (4 + 3j) * along) < 8 * EPS * 5
    with pytest.raises(CannotAssemble, match=r"gap 1\)"):
        dyads.rrp(0j, 5.0, 6.0)


@settings(max_examples=60, deadline=None)
@given(point, point, st.floats(-0.9, 0.9), side)
def test_an_rpr_dyad_puts_the_block_in_the_slot(p, q, share, side):
    assume(abs(p - q) > 1e-3)
    offset = share * abs(p - q)
    along, slide = dyads.rpr(p, q, offset, side)
    assert abs(along) == pytest.approx(1, abs=8 * EPS)
    assert slide * side > 0
    assert abs(q + (slide + 1j * offset) * along - p) < 64 * EPS * (abs(p) + abs(q))


def test_an_rpr_dyad_without_room_or_direction_says_so():
    with pytest.raises(CannotAssemble, match=r"gap 0\.5"):
        dyads.rpr(1 + 0j, 0j, 1.5)
    with pytest.raises(Undefined, match="pivot"):
        dyads.rpr(1 + 0j, 1 + 0j)
    along, slide = dyads.rpr(np.array([1 + 0j, 2 + 0j]), 1 + 0j)
    assert np.array_equal(np.isnan(along), [True, False])
    assert slide.dtype == float


@settings(max_examples=60, deadline=None)
@given(point, angle, point, angle)
def test_two_lines_meet_where_both_slides_say(first, one, second, other):
    assume(abs(math.sin(one - other)) > 1e-3)
    pin = dyads.prp(first, unit(one), second, unit(other))
    size = (abs(first) + abs(second)) / abs(math.sin(one - other)) + 1
    assert abs(cross(unit(one), pin - first)) < 64 * EPS * size
    assert abs(cross(unit(other), pin - second)) < 64 * EPS * size
    slides = dyads.rpp(pin, first, unit(one), unit(other))
    assert abs(first + slides[0] * unit(one) + slides[1] * unit(other) - pin) < 64 * EPS * size


def test_parallel_slides_do_not_assemble():
    with pytest.raises(CannotAssemble, match="parallel"):
        dyads.prp(0j, 1 + 0j, 1j, 1 + 0j)
    with pytest.raises(CannotAssemble, match="parallel"):
        dyads.rpp(1j, 0j, 1 + 0j, -1 + 0j)
    assert np.isnan(dyads.prp(np.array([0j]), 1 + 0j, 1j, 1 + 0j)).all()


# Points and lines that move as polynomials of time.
P = (1 + 2j, 3 - 1j, -2 + 4j, 1 + 1j)
Q = (7 + 1j, -1 + 2j, 3 + 1j, -4 + 2j)
PSI = (0.4, 0.7, -0.9, 1.3)


def path(derivatives):
    return lambda t: sum(
        (mp.mpmathify(d) * t**n / mp.factorial(n) for n, d in enumerate(derivatives)), mp.mpf(0)
    )


def check(rates, *paths):
    for order in (1, 2, 3):
        for found, along in zip(rates, paths, strict=True):
            expected = mp.diff(along, 0, order)
            assert abs(found[order - 1] - expected) < 1e-12 * (1 + abs(expected))


def joint_of(p, q, b, c, side):
    line = q - p
    along = (abs(line) ** 2 + b**2 - c**2) / (2 * abs(line))
    return p + line / abs(line) * (along + 1j * side * mp.sqrt(b**2 - along**2))


@each_row("side", [1, -1])
def test_rates_of_rrr_are_derivatives(side):
    joint = dyads.rrr(P[0], Q[0], 5.0, 4.0, side)
    rates = dyads.rrr_rates(joint - P[0], joint - Q[0], P[1:], Q[1:])
    p, q = path(P), path(Q)
    at = lambda t: joint_of(p(t), q(t), 5, 4, side)  # noqa: E731
    check(rates, lambda t: mp.arg(at(t) - p(t)), lambda t: mp.arg(at(t) - q(t)))
    # The joint moves as P does, and about P.
    moved = [a + b for a, b in zip(P[1:], turned(joint - P[0], rates[0]), strict=True)]
    check([moved], at)


def test_only_the_orders_given_are_computed():
    joint = dyads.rrr(P[0], Q[0], 5.0, 4.0)
    whole = dyads.rrr_rates(joint - P[0], joint - Q[0], P[1:], Q[1:])
    for order in (1, 2, 3):
        found = dyads.rrr_rates(joint - P[0], joint - Q[0], P[1 : 1 + order], Q[1 : 1 + order])
        assert found == (whole[0][:order], whole[1][:order])


def test_rates_at_a_dead_point_do_not_exist():
    with pytest.raises(Undefined, match="dead point"):
        dyads.rrr_rates(1 + 0j, -2 + 0j, [1j], [0j])
    first, _ = dyads.rrr_rates(np.array([1 + 0j, 1j]), -2 + 0j, [1j], [0j])
    assert np.array_equal(np.isfinite(first[0]), [False, True])


def test_drivers():
    assert dyads.rotating(1 + 1j, 2.0, Degrees(90)) == 1 + 3j
    assert dyads.sliding(1 + 1j, 1j, 2.0) == 1 + 3j


@settings(max_examples=100, deadline=None)
@given(st.floats(-1, 1), st.floats(-1, 1))
def test_directions_are_those_of_the_four_quadrant_arctangent(y, x):
    assume(x or y)
    with np.errstate(all="ignore"):
        found = direction(np.float64(y), np.float64(x)).item()
    expected = math.atan2(y, x)
    assert -math.pi < found <= math.pi
    # Beside the cut, -pi and pi are the same direction.
    assert abs(math.remainder(found - expected, math.tau)) <= 2 * EPS * abs(expected)


def test_directions_on_the_axes_are_exact():
    y, x = np.array([0.0, 0.0, 1.0, -1.0, -0.0, 1.0, -1.0]), np.array([1.0, -1.0, 0.0, 0.0, -1.0, -0.0, -0.0])
    quarter = math.pi / 2
    with np.errstate(all="ignore"):
        assert direction(y, x).tolist() == [0, math.pi, quarter, -quarter, math.pi, quarter, -quarter]
        assert np.isnan(direction(np.zeros(1), np.zeros(1))).all()


def test_components_are_those_of_the_sum():
    first, second = components(7 + 4j, 2 + 1j, 1 + 1j)
    assert (first, second) == (3, 1)
