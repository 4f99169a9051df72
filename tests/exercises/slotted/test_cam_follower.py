"""Roller cam at fifty digits: the pitch curve as a curve in the plane of the cam, by differences alone."""

import mpmath
import pytest
from tables import each_row

import coursework
from coursework.errors import Undefined

EXERCISE = coursework.open_course()["cam_follower"]


def law_of(name, x):
    pi = mpmath.pi
    return {
        "parabolic": 2 * x**2 if x < 0.5 else 1 - 2 * (1 - x) ** 2,
        "harmonic": (1 - mpmath.cos(pi * x)) / 2,
        "cycloidal": x - mpmath.sin(2 * pi * x) / (2 * pi),
        "polynomial_345": 10 * x**3 - 15 * x**4 + 6 * x**5,
        "polynomial_4567": 35 * x**4 - 84 * x**5 + 70 * x**6 - 20 * x**7,
    }[name]


def exact(law, h, beta, delta, theta, omega, Rb, Rr, R2, e):
    h, beta, delta, theta, omega, Rb, Rr, e = map(mpmath.mpf, (h, beta, delta, theta, omega, Rb, Rr, e))

    def lift(at):
        return h * law_of(law, at / beta if at < beta else (2 * beta + delta - at) / beta)

    def centre(t):
        """In the plane of the cam, at a time from now."""
        at = theta + mpmath.degrees(omega * t)
        return mpmath.mpc(e, mpmath.sqrt((Rb + Rr) ** 2 - e**2) + lift(at)) * mpmath.expj(-mpmath.radians(at))

    d = mpmath.mpf("1e-12")
    p, q, r = (centre(k * d) for k in (-1, 0, 1))
    area = ((q - p).conjugate() * (r - p)).imag / 2
    rho = -abs(q - p) * abs(r - q) * abs(r - p) / (4 * area)  # run through clockwise
    normal = -1j * (r - p) / abs(r - p)  # to the right of the way: inwards
    upwards = 1j * mpmath.expj(-mpmath.radians(theta))
    heights = [mpmath.diff(lambda t: lift(theta + mpmath.degrees(omega * t)), 0, n) for n in range(4)]
    return {
        **dict(zip("svaj", heights, strict=True)),
        "phi": mpmath.degrees(mpmath.acos(-(normal * upwards.conjugate()).real)),
        "rho": rho,
        "rho_c": rho - Rr,
        "K": q + Rr * normal,
    }


@each_row("seed", range(12))
def test_answers_are_those_of_the_pitch_curve(seed):
    variant = EXERCISE.variant(seed)
    found = variant.quantities(["s", "v", "a", "j", "phi", "rho", "rho_c", "K"])
    with mpmath.workdps(60):
        right = exact(**variant.given)
    x, y = found.pop("K")
    K = right.pop("K")
    assert complex(x, y) == pytest.approx(complex(K), rel=1e-9)
    for name, value in found.items():
        assert float(value) == pytest.approx(float(right[name]), rel=1e-8, abs=1e-8), name


def test_a_rise_too_long_for_the_turn_has_no_cam():
    given = {**EXERCISE.variant(0).given, "beta": 170.0, "delta": 30.0}
    with pytest.raises(Undefined, match="do not fit in a turn"):
        EXERCISE.solve(**given, only="s")
