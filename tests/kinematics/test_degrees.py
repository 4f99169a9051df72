"""Trigonometry in degrees: exact at the quarters, right everywhere, the same on scalars and arrays."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tables import each_row

from coursework import degrees

ANGLES = st.floats(-1e6, 1e6)


@each_row("turns", [-3, 0, 1, 10**9])
def test_quarters_of_a_turn_are_exact(turns):
    for quarter, (sine, cosine) in enumerate([(0, 1), (1, 0), (0, -1), (-1, 0)]):
        theta = 360.0 * turns + 90.0 * quarter
        assert (degrees.sin(theta), degrees.cos(theta)) == (sine, cosine)
        array = np.array([theta])
        assert (degrees.sin(array)[0], degrees.cos(array)[0]) == (sine, cosine)


@given(ANGLES)
def test_sine_and_cosine_agree_with_fifty_digits(theta):
    with mpmath.workdps(50):
        turn = mpmath.mpf(theta) * mpmath.pi / 180
        for ours, exact in ((degrees.sin, mpmath.sin(turn)), (degrees.cos, mpmath.cos(turn))):
            assert abs(ours(theta) - exact) <= 3e-16 * max(1e-3, abs(exact)) + 1e-18
            assert abs(ours(np.array([theta]))[0] - exact) <= 5e-16


@given(st.floats(-180, 180, exclude_min=True), st.floats(0.1, 10))
def test_the_direction_of_a_polar_vector_is_its_angle(theta, length):
    for vector in (degrees.polar(length, theta), degrees.polar(length, np.array([theta]))[0]):
        assert abs(math.remainder(degrees.angle(complex(vector)) - theta, 360)) < 1e-12


@each_row("make", [float, lambda x: np.array([x])])
def test_directions_lie_above_minus_180_and_up_to_180(make):
    assert degrees.atan2(make(-0.0), make(-1.0)) == 180
    assert degrees.angle(make(-1.0) + make(0.0) * 1j) == 180
    for theta, expected in (
        (-180.0, 180),
        (180.0, 180),
        (540.0, 180),
        (181.0, -179),
        (-190.0, 170),
        (360.0, 0),
    ):
        assert degrees.wrap(make(theta)) == expected


@given(ANGLES)
def test_wrapping_keeps_the_direction(theta):
    wrapped = degrees.wrap(theta)
    assert -180 < wrapped <= 180
    assert wrapped == degrees.wrap(np.array([theta]))[0] or abs(abs(wrapped) - 180) < 1e-9
    assert abs(math.remainder(wrapped - theta, 360)) < 1e-9


def test_inverse_functions_undo():
    for value in (-0.9, 0.0, 0.3, 1.0):
        assert degrees.sin(degrees.asin(value)) == pytest.approx(value, abs=1e-15)
        assert degrees.cos(degrees.acos(value)) == pytest.approx(value, abs=1e-15)
        assert degrees.tan(degrees.atan(value)) == pytest.approx(value, abs=1e-15)
        np.testing.assert_allclose(degrees.sin(degrees.asin(np.array([value]))), [value], atol=1e-15)
