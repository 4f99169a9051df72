"""Turning points of periodic functions, against functions whose zeros are known."""

import math

import numpy as np
import pytest
from tables import each_row

from coursework.kinematics.cycle import turning_points

TURN = 2 * math.pi


def shifted_cosine(angle, phase, level):
    return np.cos(angle - phase) - level


def away(found, expected):
    difference = np.asarray(found) - np.asarray(expected)
    return abs(difference - TURN * np.rint(difference / TURN))


def test_zeros_of_a_shifted_cosine_are_found_to_the_last_digits():
    phase = np.linspace(-4, 4, 201)
    found = turning_points(shifted_cosine, [phase, np.zeros(201)])
    assert found.shape == (201, 2)
    expected = np.sort(np.mod(np.stack([phase - math.pi / 2, phase + math.pi / 2], axis=1), math.pi), axis=1)
    assert away(2 * np.mod(found, math.pi), 2 * expected).max() < 5e-15
    assert (found[:, 0] < found[:, 1]).all()
    assert (found[:, 1] < found[:, 0] + TURN).all()


def test_every_zero_of_a_function_with_many_is_found():
    def slope(angle, k):
        return np.cos(k * angle)

    found = turning_points(slope, [np.array([1.0, 5.0, 20.0])])
    assert np.isfinite(found).sum(axis=1).tolist() == [2, 10, 40]
    assert abs(np.cos(20 * found[2])).max() < 1e-13


@each_row("dip", [1e-4, 1e-6, 1e-10])
@each_row("phase", [0.3, 2.0, 0.1234567, 6.1])
def test_two_zeros_closer_than_a_sample_are_told_from_none(dip, phase):
    """1 - dip is crossed twice, within less than a sample of the top; 1 + dip is never reached."""
    for sign in (1, -1):

        def slope(angle, p, level, sign=sign):
            # 1 - cos in full precision, so that the expected zeros are those of the numbers computed.
            return sign * (2 * np.sin((angle - p) / 2) ** 2 - level)

        found = turning_points(slope, [np.array([phase, phase]), np.array([dip, -dip])])
        half = 2 * math.asin(math.sqrt(dip / 2))
        assert np.isfinite(found).sum(axis=1).tolist() == [2, 0]
        assert np.sort(away(found[0], phase)) == pytest.approx([half, half], rel=1e-6, abs=1e-15)


def test_a_zero_on_a_sample_is_found_once():
    def slope(angle, at):
        return np.sin(angle - at)

    first = 0.1234567
    for samples in (36, 72, 240):
        at = first + np.arange(samples) * (TURN / samples)
        found = turning_points(slope, [at], samples=samples)
        assert np.isfinite(found).sum(axis=1).tolist() == [2] * samples


def test_a_row_that_does_not_exist_all_turn_is_nan_and_no_other():
    def slope(angle, reach):
        with np.errstate(invalid="ignore"):
            return np.sqrt(reach - np.cos(angle)) * np.sin(angle)

    found = turning_points(slope, [np.array([2.0, 0.5, 3.0])])
    assert np.isnan(found).all(axis=1).tolist() == [False, True, False]


def test_rows_are_independent_of_how_many_are_asked_together():
    phase, level = np.linspace(0, 6, 5000), np.linspace(-0.9, 0.9, 5000)
    together = turning_points(shifted_cosine, [phase, level])
    for i in (0, 2047, 2048, 4999):
        assert np.array_equal(
            turning_points(shifted_cosine, [phase[i : i + 1], level[i : i + 1]])[0], together[i]
        )
