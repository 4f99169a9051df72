"""Laws of cams against fifty digits, near their ends as well, and over a turn."""

import mpmath
import numpy as np
import pytest
from tables import each_row

from coursework.kinematics.cams import LAWS, rise, rise_345, rise_dwell_return


@each_row("u", [1e-9, 1e-3, 0.25, 0.5, 0.75, 1 - 1e-3, 1 - 2**-40])
def test_the_polynomial_and_its_derivatives_keep_their_digits(u):
    with mpmath.workdps(50):
        x = mpmath.mpf(u)
        right = (
            10 * x**3 - 15 * x**4 + 6 * x**5,
            30 * x**2 - 60 * x**3 + 30 * x**4,
            60 * x - 180 * x**2 + 120 * x**3,
        )
    for found, exact in zip(rise_345(u), right, strict=True):
        assert found == pytest.approx(float(exact), rel=2e-15, abs=0)


def test_outside_the_rise_the_follower_rests():
    lift, slope, bend = rise_345(np.array([-0.5, 0.0, 1.0, 2.0]))
    np.testing.assert_array_equal(lift, [0, 0, 1, 1])
    np.testing.assert_array_equal(slope, 0)
    np.testing.assert_array_equal(bend, 0)


def test_it_returns_as_it_rose_wherever_the_turn_is_begun():
    dwell, turn = 0.5, 6.0
    u = np.linspace(0, 1, 41)
    up, ups = rise_dwell_return(u, dwell, turn)
    back, downs = rise_dwell_return(2 + dwell - u, dwell, turn)
    earlier, before = rise_dwell_return(2 + dwell - u - turn, dwell, turn)
    np.testing.assert_array_equal(up, u)
    np.testing.assert_allclose(back, u, atol=1e-15)
    np.testing.assert_allclose(earlier, u, atol=1e-15)
    assert (ups == 1).all()
    assert (downs == -1).all()
    assert (before == -1).all()


def test_between_it_stays_up_and_down():
    share, _ = rise_dwell_return(np.array([1.1, 1.4, 2.6, 4.0, 5.9, -0.1, -3.0]), 0.5, 6.0)
    np.testing.assert_array_equal(share, [1, 1, 0, 0, 0, 0, 0])


def test_numbers_of_mpmath_keep_their_digits():
    with mpmath.workdps(50):
        share, way = rise_dwell_return(mpmath.mpf(1) / 3, mpmath.mpf(1), mpmath.mpf(4))
        lift, slope, _ = rise_345(share)
        assert way == 1
        assert abs(lift - mpmath.mpf(17) / 81) < mpmath.mpf("1e-48")
        assert abs(slope - mpmath.mpf(40) / 27) < mpmath.mpf("1e-48")


def exact(law, x):
    """As textbooks write them, in the digits at work."""
    pi = mpmath.pi
    return {
        "parabolic": 2 * x**2 if x < 0.5 else 1 - 2 * (1 - x) ** 2,
        "harmonic": (1 - mpmath.cos(pi * x)) / 2,
        "cycloidal": x - mpmath.sin(2 * pi * x) / (2 * pi),
        "polynomial_345": 10 * x**3 - 15 * x**4 + 6 * x**5,
        "polynomial_4567": 35 * x**4 - 84 * x**5 + 70 * x**6 - 20 * x**7,
    }[law]


@pytest.mark.parametrize("law", LAWS)
def test_each_law_and_its_derivatives_are_those_of_fifty_digits(law):
    u = np.array([1e-3, 0.125, 0.3, 0.5 - 1e-3, 0.75, 1 - 1e-3])
    with mpmath.workdps(50):
        right = [[float(mpmath.diff(lambda y: exact(law, y), mpmath.mpf(x), n)) for x in u] for n in range(4)]
    for found, row in zip(rise(law, u), right, strict=True):
        np.testing.assert_allclose(found, row, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize(("law", "smooth"), list(zip(LAWS, (1, 1, 2, 2, 3), strict=True)))
def test_a_law_rests_outside_and_starts_as_smoothly_as_its_kind_says(law, smooth):
    outside, inside = rise(law, np.array([-1.0, 0.0, 1.0, 2.0])), rise(law, np.array([1e-9, 1 - 1e-9]))
    np.testing.assert_array_equal(outside[0], [0, 0, 1, 1])
    np.testing.assert_allclose(np.array(outside[1:]), 0, atol=1e-15)
    assert [np.all(abs(inside[n]) < 1e-5) for n in range(1, smooth + 1)] == [True] * smooth
    assert smooth == 3 or np.all(abs(inside[smooth + 1]) > 1)


def test_laws_of_many_cams_are_found_at_once():
    u = np.array([0.1, 0.4, 0.6, 0.8, 0.9])
    together = rise(np.array(LAWS), u)
    for k, law in enumerate(LAWS):
        assert [row[k] for row in together] == pytest.approx([float(x) for x in rise(law, u[k])], rel=1e-15)
