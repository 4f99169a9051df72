"""Slider-cranks and slotted guides where textbook formulas lose their digits, against fifty digits."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from reference import away, exact, mp, relative, slider_crank, turned
from tables import each_row

from coursework.errors import CannotAssemble, Undefined, WrongValue
from coursework.kinematics import slotted_guide
from coursework.kinematics.angles import Degrees
from coursework.kinematics.slider_crank import SliderCrank, time_ratio_excess

EPS = 2.0**-52


@each_row("near", [1e-2, 1e-5, 1e-8, 1e-12])
def test_a_rod_as_long_as_its_crank_gives_twice_the_cosine(near):
    theta = math.pi / 2 - near
    expected = 2 * mp.cos(mp.mpf(theta))
    assert relative(SliderCrank(1.0, 1.0).position(theta), expected) < 4 * EPS
    # Past the square position the kept side stops at O, and the smooth one goes on.
    theta = math.pi / 2 + near
    assert SliderCrank(1.0, 1.0).position(theta) == pytest.approx(0, abs=EPS)
    assert relative(SliderCrank(1.0, 1.0, smooth=True).position(theta), 2 * mp.cos(mp.mpf(theta))) < 4 * EPS


def test_the_smooth_policy_at_equal_lengths_moves_as_twice_the_cosine_through_every_angle():
    turned = Degrees(np.arange(0.0, 720.0, 15.0))
    found = SliderCrank(1.0, 1.0, smooth=True).motion(turned, 1.0, order=3)
    for quantity, expected in (
        (found.position, 2 * turned.cos),
        (found.velocity, -2 * turned.sin),
        (found.acceleration, -2 * turned.cos),
        (found.jerk, 2 * turned.sin),
    ):
        assert abs(quantity - expected).max() < 8 * EPS
    with pytest.raises(Undefined, match="perpendicular"):
        SliderCrank(1.0, 1.0).motion(Degrees(90), order=1)


@each_row("step", [1.0, 7.0, 179.0])
def test_a_rod_longer_than_its_crank_never_changes_side(step):
    turned = Degrees(np.arange(0, 720) * step)
    for side in (1, -1):
        for smooth in (False, True):
            run = SliderCrank(1.0, 1.0001, 0.0, side, smooth=smooth).position(turned) - turned.cos
            assert (side * run > 0).all()


@each_row("offset", [0.0, 0.01, -0.02])
@each_row("past", [1e-12, 1e-8, 1e-4, 0.5, 3.0])
def test_displacement_from_dead_centre_is_a_product(offset, past):
    r, l = 0.05, 0.2
    centre = mp.asin(mp.mpf(offset) / (mp.mpf(r) + mp.mpf(l)))
    theta = float(centre) + past
    outer = mp.sqrt((mp.mpf(r) + mp.mpf(l)) ** 2 - mp.mpf(offset) ** 2)
    expected = outer - slider_crank(r, l, offset, theta)[1]
    found = SliderCrank(r, l, offset).displacement(theta)
    assert found > 0
    # The angle of an offset dead centre is itself rounded: that moves the displacement by its slope.
    assert abs(found - expected) <= 8 * EPS * abs(expected) + (abs(offset) > 0) * 4 * EPS * r * (past + 1e-15)


def test_displacement_with_a_very_long_rod_is_that_of_a_scotch_yoke():
    theta = 1e-3
    found = SliderCrank(1.0, 1e8).displacement(theta)
    assert relative(found, 1 + mp.mpf(10) ** 8 - slider_crank(1.0, 1e8, 0.0, theta)[1]) < 4 * EPS
    assert found == pytest.approx(1 - math.cos(theta), rel=1e-7)


@each_row("offset", [1e-15, 1e-9, 1e-3, 0.5, 0.9])
def test_the_asymmetry_of_a_quick_return_keeps_its_digits(offset):
    e, r, l = mp.mpf(offset), mp.mpf(1), mp.mpf(2)
    expected = mp.asin(e / (l - r)) - mp.asin(e / (l + r))
    found = SliderCrank(1.0, 2.0, offset).quick_return()
    assert relative(found, expected) < 8 * EPS
    assert SliderCrank(1.0, 2.0, -offset).quick_return() == -found
    assert relative(time_ratio_excess(found), 2 * expected / (mp.pi - expected)) < 8 * EPS


@each_row("crank", [1e-7, 1e-3, 0.5, 0.9])
def test_the_stroke_of_a_tiny_crank_keeps_its_digits(crank):
    r, l, e = mp.mpf(crank), mp.mpf(1), mp.mpf(0.05)
    expected = mp.sqrt((l + r) ** 2 - e**2) - mp.sqrt((l - r) ** 2 - e**2)
    assert relative(SliderCrank(crank, 1.0, 0.05).stroke(), expected) < 8 * EPS


@each_row("margin", [1e-2, 1e-8, 1e-13, 0.0])
def test_the_error_of_an_offset_slider_does_not_grow_as_the_margin_shrinks(margin):
    r, l, e = 0.75, 1.0 + margin, 0.25
    for theta in (-math.pi / 2, -math.pi / 2 + 1e-9, -math.pi / 2 - 1e-4):
        expected = slider_crank(r, l, e, theta)
        found = SliderCrank(r, l, e).motion(theta, order=0)
        assert abs(found.position - expected[1]) < 4 * EPS
        assert away(found.rod_angle, expected[0]) < 8 * EPS


@each_row("beyond", [0, 1, 3, 30])
def test_lengths_of_many_digits_have_exact_margins_too(beyond):
    r, e = 0.1003, 0.7001
    l = r + e
    while math.fsum((l, -r, -e)) < 0:
        l = math.nextafter(l, 1)
    for _ in range(beyond):
        l = math.nextafter(l, 1)
    for theta in (-math.pi / 2, -math.pi / 2 + 1e-8):
        # The loop is exact in the lengths; the angle's sine is not known better than its last digit.
        expected = slider_crank(r, l, e, theta)[1]
        assert abs(SliderCrank(r, l, e).position(theta) - expected) < 4 * EPS


def test_a_slider_that_does_not_reach_says_by_how_much_and_is_nan_in_arrays():
    with pytest.raises(CannotAssemble, match=r"gap 0\.5"):
        SliderCrank(1.0, 0.5).position(Degrees(90))
    theta = np.linspace(-3, 3, 401)
    motion = SliderCrank(1.0, 0.5, 0.1).motion(theta, order=3)
    beyond = abs(np.sin(theta) - 0.1) > 0.5
    assert all(np.array_equal(np.isnan(x), beyond) for x in motion)
    with pytest.raises(WrongValue, match="rod is 0"):
        SliderCrank(1.0, 0.0)


@each_row("shift", [-550, 2, 530])
def test_a_slider_in_a_unit_that_is_a_power_of_two_changes_no_bit(shift):
    theta = np.linspace(-4, 4, 41)
    here = SliderCrank(1.0, 2.5, 0.3).motion(theta, 2.0, 3.0, order=2)
    scaled = SliderCrank(*(math.ldexp(x, shift) for x in (1.0, 2.5, 0.3)))
    there = scaled.motion(theta, 2.0, 3.0, order=2)
    assert np.array_equal(here[0:6:2], there[0:6:2])
    assert np.array_equal(np.ldexp(here[1:6:2], shift), there[1:6:2])
    assert scaled.stroke() == math.ldexp(SliderCrank(1.0, 2.5, 0.3).stroke(), shift)


@settings(max_examples=50, deadline=None)
@given(
    st.floats(0.01, 10),
    st.floats(0.01, 5),
    st.floats(-0.95, 0.95),
    st.floats(-7, 7),
    st.sampled_from([1, -1]),
    st.booleans(),
)
def test_slider_rates_are_derivatives_of_the_position(r, excess, share, theta, side, smooth):
    e = share * excess
    l = r + excess
    found = SliderCrank(r, l, e, side, smooth=smooth).motion(theta, 2.0, -3.0, 4.0, order=3)
    crank, condition = turned(theta, 2.0, -3.0, 4.0), SliderCrank(r, l, e).conditioning(theta)
    for i, unit in ((0, 1.0), (1, r)):
        path = lambda t, i=i: slider_crank(r, l, e, crank(t), side)[i]  # noqa: E731
        if i == 0:
            # The sine of the rod's angle is smooth where the angle passes half a turn.
            path = lambda t: mp.asin((mp.mpf(e) - mp.mpf(r) * mp.sin(crank(t))) / mp.mpf(l)) * side  # noqa: E731
        for order in (1, 2, 3):
            expected = mp.diff(path, 0, order)
            assert abs(found[2 * order + i] - expected) <= 64 * EPS * (
                unit * (8 * condition) ** (2 * order) + abs(expected)
            )


@each_row("theta", [0.0, 1.0, math.pi - 1e-8, math.pi, 4.0])
def test_a_guide_whose_crank_equals_its_ground_turns_at_half_the_rate(theta):
    motion = slotted_guide.motion(0.3, 0.3, theta, 1.0, order=2)
    assert motion.guide_rate == 0.5
    assert motion.guide_acceleration == 0.0
    expected = mp.mpf(theta) / 2 if theta < math.pi + 1e-9 else mp.mpf(theta) / 2 - mp.pi
    assert away(motion.guide_angle, expected) < 4 * EPS


def test_a_guide_with_the_pin_on_its_pivot_is_undefined():
    with pytest.raises(Undefined, match="pivot"):
        slotted_guide.motion(0.3, 0.3, Degrees(180), order=0)
    found = slotted_guide.motion(0.3, 0.3, Degrees(np.array([179.0, 180.0])), order=0)
    assert np.array_equal(np.isnan(found.guide_angle), [False, True])
    rates = slotted_guide.motion(0.3, 0.3, Degrees(np.array([179.0, 180.0])), 1.0, order=1)
    assert rates.guide_rate.tolist() == [0.5, 0.5]


def test_the_peak_of_a_whitworth_guide_is_a_quotient_of_lengths():
    d = 0.2
    r = d * (1 + 1e-9)
    expected = mp.mpf(r) / (mp.mpf(r) - mp.mpf(d))
    assert relative(slotted_guide.motion(d, r, Degrees(180), 1.0, order=1).guide_rate, expected) < 4 * EPS


@each_row(("ground", "crank", "turns"), [(1.0, 1.5, 1), (1.0, 0.7, 0)])
def test_a_whitworth_guide_gains_a_turn_where_a_shaper_swings_back(ground, crank, turns):
    theta = np.linspace(0, 2 * math.pi, 2001)
    motion = slotted_guide.motion(ground, crank, theta, 1.0, order=1)
    gained = np.unwrap(motion.guide_angle)
    assert gained[-1] - gained[0] == pytest.approx(2 * math.pi * turns, abs=1e-12)
    # The mean rate of a periodic function: the sum over equal steps is exact to rounding.
    assert np.mean(motion.guide_rate[:-1]) == pytest.approx(turns, abs=1e-12)


def test_the_swing_of_a_shaper_and_its_time_ratio_keep_their_digits():
    for ratio in (1e-9, 0.5, 0.99):
        expected = 4 * mp.asin(mp.mpf(ratio)) / (mp.pi - 2 * mp.asin(mp.mpf(ratio)))
        assert relative(time_ratio_excess(slotted_guide.swing(1.0, ratio)), expected) < 8 * EPS
    assert math.isnan(slotted_guide.swing(1.0, 1.5))


@settings(max_examples=40, deadline=None)
@given(st.floats(0.1, 10), st.floats(0.1, 10), st.floats(-7, 7))
def test_guide_rates_are_derivatives_of_the_arm(d, r, theta):
    if abs(d - r) < 1e-3:
        r = d + 1e-3
    crank = turned(theta, 2.0, -3.0, 4.0)
    arm = lambda t: mp.mpf(d) + mp.mpf(r) * mp.expj(crank(t))  # noqa: E731
    found = slotted_guide.motion(d, r, theta, 2.0, -3.0, 4.0, order=3)
    start, nearness = arm(mp.mpf(0)), max(d, r) / abs(arm(mp.mpf(0)))
    for i, path in enumerate((lambda t: mp.arg(arm(t) / start), lambda t: abs(arm(t)))):
        for order in (1, 2, 3):
            expected = mp.diff(path, 0, order)
            allowed = (1.0, max(d, r))[i] * float(4 * nearness) ** (order + 1) * 10
            assert abs(found[2 * order + i] - expected) <= 64 * EPS * (allowed + abs(expected))


def guide_at(d, r, angle):
    """Length of the arm, and derivatives of guide and arm up to the third, by the vector of the pin."""
    with mp.workdps(120):
        d, r = exact(d, r)
        crank = r * mp.expjpi(mp.mpf(angle) / 180)
        arm = abs(d + crank)
        unit = (d + crank) / arm
        # Along and across the guide, of the pin's velocity, acceleration and jerk.
        (v, v_), (a, a_), (j, j_) = (((z := factor * crank / unit).real, z.imag) for factor in (1j, -1, -1j))
        w = v_ / arm
        slide = a + arm * w**2
        turn = (a_ - 2 * v * w) / arm
        return (
            arm,
            (w, v),
            (turn, slide),
            ((j_ - 3 * slide * w - 3 * v * turn + arm * w**3) / arm, j + 3 * arm * w * turn + 3 * v * w**2),
        )


@each_row("gap", [0.0, 1e-9, -1e-9, 1e-12, -1e-3, 0.7])
@each_row("near", [60.0, 1e-1, 1e-3, 1e-6, 1e-9])
@each_row("side", [1, -1])
def test_a_pin_that_passes_beside_the_pivot_costs_no_digit_of_any_order(gap, near, side):
    d, r, angle = 200.0, 200.0 * (1 + gap), 180.0 - side * near
    found = slotted_guide.motion(d, r, Degrees(angle), order=3)
    arm, *derivatives = guide_at(d, r, angle)
    assert relative(found.arm, arm) < 4 * EPS
    for order, pair in enumerate(derivatives, 1):
        for value, expected in zip(found[2 * order : 2 * order + 2], pair, strict=True):
            # An equal crank turns its guide evenly, and the rate does not change at all.
            assert abs(value - expected) <= 16 * EPS * abs(expected) + mp.mpf("1e-50"), order


@each_row("offset", [0.0, 0.3, -0.3])
@each_row("near", [1e-2, 1e-6, 1e-10])
def test_the_rod_of_a_slider_gains_speed_evenly_on_both_sides_of_a_dead_centre(offset, near):
    for crank in (near, -near, 180 - near):
        found = SliderCrank(1.0, 2.5, offset).motion(Degrees(crank), 1.0, 0.0, order=2)
        with mp.workdps(60):
            r, l, e = exact(1.0, 2.5, offset)
            s = mp.sinpi(mp.mpf(crank) / 180)
            expected = (
                r * (s * (l**2 - e**2 - r**2) + r * e * (1 + s**2)) / mp.sqrt(l**2 - (e - r * s) ** 2) ** 3
            )
        assert relative(found.rod_acceleration, expected) < 16 * EPS
