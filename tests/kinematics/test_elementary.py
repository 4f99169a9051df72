"""Tangent and arctangent by one formula, on numbers and on arrays, against fifty digits."""

from __future__ import annotations

import math

import numpy as np
import pytest
from reference import away, four_bar, mp
from tables import each_row

from coursework.kinematics import elementary, vectors
from coursework.kinematics.angles import Degrees
from coursework.kinematics.elementary import quotient_arctangent, tangent
from coursework.kinematics.four_bar import FourBar
from coursework.kinematics.vectors import direction_of

EPS = 2.0**-52
ARCTANGENTS = [quotient_arctangent, np.arctan]


def spread(most):
    """Of both signs up to a number, thin near it and dense near 0."""
    near = most * np.concatenate([np.linspace(0, 1, 400), np.geomspace(1e-300, 1, 200)])
    return np.concatenate([near, -near])


@each_row(
    ("function", "exact", "most"),
    [
        (tangent, mp.tan, math.pi / 4),
        (quotient_arctangent, mp.atan, 1.0),
        (elementary.arctangent, mp.atan, 1.0),
    ],
)
def test_no_result_is_off_by_more_than_an_ulp_and_a_half(function, exact, most):
    for x, found in zip(spread(most).tolist(), function(spread(most)).tolist(), strict=True):
        ulp = math.ulp(float(exact(mp.mpf(x))))
        assert abs(mp.mpf(found) - exact(mp.mpf(x))) <= 1.5 * ulp, x


@each_row(("function", "most"), [(tangent, math.pi / 4), (quotient_arctangent, 1.0)])
def test_a_number_gives_what_its_place_in_an_array_gives(function, most):
    given = spread(most)
    kept = given.copy()
    found = function(given)
    assert np.array_equal(given, kept)
    assert [function(x) for x in given.tolist()] == found.tolist()
    assert np.array_equal(function(-given), -found)
    assert math.isnan(function(math.nan))


@pytest.mark.parametrize("arctangent", ARCTANGENTS)
@pytest.mark.parametrize("length", [1.0, 1e-200, 3e150])
def test_a_direction_is_right_in_every_quadrant(arctangent, length, monkeypatch):
    monkeypatch.setattr(vectors, "arctangent", arctangent)
    turn = np.linspace(-math.pi, math.pi, 97)
    for chosen in (turn, turn[24:73], turn[:24], turn[73:], turn[50:51]):
        x, y = length * np.cos(chosen), length * np.sin(chosen)
        found = direction_of(y.copy(), x.copy(), np.full_like(x, length))
        for value, right, above in zip(found, x, y, strict=True):
            expected = mp.atan2(mp.mpf(above), mp.mpf(right))
            assert away(value, expected) <= 2 * EPS * max(abs(expected), EPS)
        alone = [direction_of(b, a, length) for a, b in zip(x, y, strict=True)]
        assert np.array_equal(alone, found)


@each_row("sign", [0.0, -0.0, -1e-300])
def test_half_a_turn_is_counted_upwards(sign):
    for x in (np.array([-1.0]), np.array([-1.0, 1.0])):
        y = np.full_like(x, sign)
        assert direction_of(y, x.copy(), np.ones_like(x))[0] == math.pi
    with np.errstate(invalid="ignore"):
        assert math.isnan(direction_of(np.float64(0.0), np.float64(0.0), np.float64(0.0)))


@pytest.mark.parametrize("arctangent", ARCTANGENTS)
@pytest.mark.parametrize("lengths", [(200.0, 60.0, 180.0, 140.0), (60.0, 100.0, 110.0, 120.0)])
def test_a_linkage_keeps_its_digits_whichever_arctangent_the_processor_takes(
    arctangent, lengths, monkeypatch
):
    monkeypatch.setattr(vectors, "arctangent", arctangent)
    turn = np.concatenate([np.linspace(-180, 180, 91), [1e-9, -1e-9, 180 - 1e-9]])
    coupler, rocker = FourBar(*lengths).angles(Degrees(turn))
    for angle, one, other in zip(turn, coupler, rocker, strict=True):
        exact = four_bar(*lengths, angle, radians=False)
        assert away(one, exact[0]) <= 8 * EPS
        assert away(other, exact[1]) <= 8 * EPS
