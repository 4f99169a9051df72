"""Triangles, flat ones too, against fifty digits."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from reference import exact, mp, relative

from coursework.errors import CannotAssemble
from coursework.kinematics.angles import Degrees
from coursework.kinematics.triangles import corner, corner_beside, third_side

EPS = 2.0**-52
sides = st.floats(0.1, 10)
angles = st.one_of(st.floats(0.001, math.pi - 0.001), st.sampled_from([1e-12, 1e-8, 1e-4, math.pi - 1e-8]))


def sides_and_angles(one, other, angle):
    """The third side, and the angle beside ``one``, of two sides and the angle between them."""
    one, other, angle = exact(one, other, angle)
    third = one - other * mp.expj(-angle)
    return abs(third), mp.arg(third)


def test_triangles_known_by_hand():
    assert third_side(3.0, 4.0, Degrees(90)) == pytest.approx(5, rel=4 * EPS)
    assert third_side(5.0, 8.0, Degrees(60)) == pytest.approx(7, rel=4 * EPS)
    assert third_side(2.0, 7.0, Degrees(180)) == 9
    assert third_side(2.0, 7.0, 0.0) == 5
    assert corner(3.0, 4.0, 5.0) == pytest.approx(math.pi / 2, rel=4 * EPS)
    assert corner(5.0, 8.0, 7.0) == pytest.approx(math.pi / 3, rel=4 * EPS)
    assert corner(3.0, 4.0, 7.0) == math.pi
    assert corner(3.0, 7.0, 4.0) == 0
    assert corner_beside(3.0, 4.0, Degrees(90), 5.0) == pytest.approx(math.atan2(4, 3), rel=4 * EPS)


@given(sides, sides, angles)
def test_a_side_and_an_angle_from_two_sides_and_their_angle_keep_their_digits(one, other, angle):
    third, beside = sides_and_angles(one, other, angle)
    assert relative(third_side(one, other, angle), third) < 8 * EPS
    assert relative(corner_beside(one, other, angle, third_side(one, other, angle)), beside) < 32 * EPS


@given(sides, sides, st.floats(0.0, 1.0))
def test_an_angle_from_three_sides_is_that_of_fifty_digits(near, other, share):
    opposite = abs(near - other) + share * (near + other - abs(near - other))
    a, b, c = exact(near, other, opposite)
    cosine = (a**2 + b**2 - c**2) / (2 * a * b)
    if abs(cosine) > 1 - mp.mpf(2) ** -40:
        return  # flat to its last digits: what it is belongs to the rounding of ``opposite``
    # Each margin is a difference of sides, whose rounding the angle's slope takes over.
    slope = 1 / mp.sqrt(1 - cosine**2)
    size = (near + other) ** 2 / (near * other)
    assert abs(corner(near, other, opposite) - mp.acos(cosine)) < 8 * EPS * (1 + size * slope)


@given(sides, sides, st.floats(0.01, 3.1))
def test_the_angles_of_a_triangle_add_up_and_do_not_depend_on_the_order_of_its_sides(one, other, angle):
    third = third_side(one, other, angle)
    assert third == pytest.approx(third_side(other, one, angle), rel=4 * EPS)
    total = angle + corner_beside(one, other, angle, third) + corner_beside(other, one, angle, third)
    assert total == pytest.approx(math.pi, abs=64 * EPS)
    assert corner(one, third, other) == pytest.approx(corner(third, one, other), rel=4 * EPS)


def test_another_third_side_counts():
    """Of 3-4-5 the right angle is known, but the third side is taken as 6."""
    expected = math.acos((3**2 + 6**2 - 4**2) / (2 * 3 * 6))
    assert corner_beside(3.0, 4.0, Degrees(90), 6.0) == pytest.approx(expected, rel=4 * EPS)


def test_what_is_no_triangle_is_refused_or_nan():
    with pytest.raises(CannotAssemble, match="3, 4 and 9 make no triangle"):
        corner(3.0, 4.0, 9.0)
    with pytest.raises(CannotAssemble, match="make no triangle"):
        corner_beside(3.0, 4.0, Degrees(90), 9.0)
    found = corner(3.0, 4.0, np.array([5.0, 9.0, 0.5]))
    assert np.isnan(found).tolist() == [False, True, True]
    found = corner_beside(3.0, 4.0, Degrees(90), np.array([5.0, 9.0]))
    assert np.isnan(found).tolist() == [False, True]
    assert third_side(np.full((2, 1), 3.0), np.full(3, 4.0), math.pi / 2).shape == (2, 3)
