"""What holds for every four-bar that turns fully: closure, symmetry, unit, roles, and rates against
differences of positions."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from reference import away, four_bar, mp, turned
from strategies import side
from tables import each_row

from coursework.kinematics.four_bar import FourBar
from coursework.system.blocks import BLOCK

EPS = 2.0**-52
length = st.floats(1.0, 1000.0)
angle = st.floats(-7.0, 7.0)


@st.composite
def cranked(draw):
    """A linkage whose crank turns fully, by its margins: the crank, two links that exceed it, and a
    ground that fits."""
    a = draw(st.floats(0.01, 100.0))
    b, c = a * (1 + draw(st.floats(1e-6, 50.0))), a * (1 + draw(st.floats(1e-6, 50.0)))
    least, most = abs(b - c) + a, b + c - a
    return least + draw(st.floats(0.001, 0.999)) * (most - least), a, b, c


@settings(max_examples=150, deadline=None)
@given(cranked(), angle, side)
def test_the_loop_closes_and_the_joint_is_on_its_side(lengths, theta, side):
    d, a, b, c = lengths
    linkage = FourBar(*lengths, side)
    coupler, rocker = linkage.angles(theta)
    gap = a * mp.expj(theta) + b * mp.expj(coupler) - d - c * mp.expj(rocker)
    assert abs(gap) < 16 * EPS * max(lengths)
    crank_pin, joint = linkage.pins(theta)
    assert side * ((d - crank_pin).conjugate() * (joint - crank_pin)).imag > 0


@settings(max_examples=60, deadline=None)
@given(cranked(), angle, side)
def test_angles_agree_with_fifty_digits(lengths, theta, side):
    linkage = FourBar(*lengths, side)
    coupler, rocker, _ = four_bar(*lengths, theta, side)
    found = linkage.angles(theta)
    # What the last digit of a length moves: the conditioning, and lengths beside the link.
    allowed = 16 * EPS * max(lengths) * (1 + 1 / min(lengths[2:]))
    assert away(found[0], coupler) < allowed
    assert away(found[1], rocker) < allowed


@settings(max_examples=60, deadline=None)
@given(cranked(), angle, side)
def test_a_mirrored_linkage_moves_in_the_mirror(lengths, theta, side):
    here = FourBar(*lengths, side).motion(theta, 2.0, 3.0, 4.0, order=3)
    there = FourBar(*lengths, -side).motion(-theta, -2.0, -3.0, -4.0, order=3)
    assert [-x for x in here] == list(there)


@settings(max_examples=60, deadline=None)
@given(cranked(), angle, side, st.integers(-300, 300))
def test_a_scaled_linkage_moves_alike_to_the_bit(lengths, theta, side, shift):
    scaled = [math.ldexp(x, shift) for x in lengths]
    here, there = (FourBar(*x, side).motion(theta, 2.0, 3.0) for x in (lengths, scaled))
    assert here == there


@settings(max_examples=80, deadline=None)
@given(cranked(), angle, side)
def test_driven_by_its_rocker_the_linkage_is_the_same(lengths, theta, side):
    d, a, b, c = lengths
    coupler, rocker = FourBar(*lengths, side).angles(theta)
    # Seen from D with the axis reversed, the rocker is the crank; the mirror keeps angles' sense.
    exchanged = math.pi - rocker
    swapped = {mode: FourBar(d, c, b, a, mode) for mode in (1, -1)}
    back = []
    for linkage in swapped.values():
        found = linkage.pins(np.array([exchanged]))
        back.append(abs(d - np.conj(found[1][0]) - a * np.exp(1j * theta)))
    condition = 1 / abs(math.sin(theta - coupler)) if math.sin(theta - coupler) else math.inf
    assert min(x for x in back if x == x or condition > 1e7) <= 64 * EPS * max(lengths) * condition


@settings(max_examples=40, deadline=None)
@given(cranked(), angle, side, st.integers(-9, 9), st.integers(-9, 9), st.integers(-9, 9))
def test_rates_are_derivatives_of_the_positions(lengths, theta, side, rate, acceleration, jerk):
    found = FourBar(*lengths, side).motion(theta, rate, acceleration, jerk, order=3)
    crank = turned(theta, rate, acceleration, jerk)
    condition = FourBar(*lengths, side).conditioning(theta)
    for i in (0, 1):
        path = lambda t, i=i: four_bar(*lengths, crank(t), side)[i]  # noqa: E731
        start = path(mp.mpf(0))

        def unwrapped(t, path=path, start=start):
            apart = path(t) - start
            return apart - 2 * mp.pi * mp.nint(apart / (2 * mp.pi))

        for order in (1, 2, 3):
            expected = mp.diff(unwrapped, 0, order)
            size = (abs(rate) + abs(acceleration) ** 0.5 + abs(jerk) ** (1 / 3)) ** order
            sharp = (condition * max(lengths) / min(lengths)) ** (2 * order)
            assert abs(found[2 * order + i] - expected) <= 64 * EPS * (sharp * size + abs(expected))


@each_row("smooth", [False, True])
def test_orders_that_are_not_asked_are_not_there_and_change_nothing(smooth):
    linkage = FourBar(100, 40, 80, 70, smooth=smooth)
    whole = linkage.motion(1.0, 2.0, 3.0, 4.0, order=3)
    for order in (0, 1, 2):
        asked = linkage.motion(1.0, 2.0, 3.0, 4.0, order=order)
        assert asked[: 2 * order + 2] == whole[: 2 * order + 2]
        assert asked[2 * order + 2 :] == (None,) * (6 - 2 * order)


@each_row("smooth", [False, True])
def test_many_linkages_at_many_angles_are_each_of_them_alone(smooth):
    ground, crank = np.array([100.0, 100, 90, 60]), np.array([40.0, 50, 20, 60])
    coupler, rocker = np.array([80.0, 70, 60, 100]), np.array([70.0, 80, 90, 100])
    mode, theta = np.array(["open", "crossed", "open", "crossed"]), np.linspace(0.1, 6.0, 7)
    table = FourBar(*(x[:, None] for x in (ground, crank, coupler, rocker)), mode[:, None], smooth=smooth)
    found = table.motion(theta, 2.0, np.linspace(0, 1, 7), 1.0, order=3)
    assert found.coupler_angle.shape == (4, 7)
    for i in range(4):
        one = FourBar(ground[i], crank[i], coupler[i], rocker[i], str(mode[i]), smooth=smooth)
        for j in range(7):
            alone = one.motion(theta[j], 2.0, np.linspace(0, 1, 7)[j], 1.0, order=3)
            assert [x[i, j] for x in found] == pytest.approx(list(alone), rel=1e-12, abs=1e-14)


def test_a_long_array_is_its_pieces():
    linkage, theta = FourBar(100, 40, 80, 70), np.linspace(0, 50, 3 * BLOCK + 17)
    found = linkage.motion(theta, 2.0, theta)
    for place in (0, BLOCK - 1, BLOCK, 2 * BLOCK + 5, len(theta) - 1):
        alone = linkage.motion(theta[place : place + 1], 2.0, theta[place : place + 1])
        assert [x[place] for x in found[:6]] == pytest.approx([x[0] for x in alone[:6]], rel=1e-14, abs=1e-15)


def test_rates_are_those_of_the_two_policies_away_from_any_change_point():
    theta = np.linspace(0, 12, 50)
    kept, smooth = (
        FourBar(100, 40, 80, 70, smooth=s).motion(theta, 2.0, 3.0, 4.0, order=3) for s in (False, True)
    )
    assert np.allclose(kept, smooth, rtol=1e-12, atol=1e-14)
