"""Mechanical advantage of a slider-crank: against fifty digits, the torque of the loaded scene, and where it
ends."""

import mpmath
import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.errors import CannotAssemble, Undefined

COURSE = coursework.open_course()
EXERCISE = COURSE["mechanical_advantage_slider"]
ASKED = tuple(part.quantity for part in EXERCISE.spec.parts)
PLAIN = {"r2": 60.0, "r3": 200.0, "e": 15.0, "theta2": 50.0, "omega2": 7.0, "Gamma_e": 12.0}


def exact(r2, r3, e, theta2, omega2, Gamma_e):
    """Fifty digits: the piston's velocity by differences of its place in time, then the power."""
    with mpmath.workdps(50):
        r2, r3, e, omega2, torque = map(mpmath.mpf, (r2, r3, e, omega2, Gamma_e))

        def piston(time):
            A = r2 * mpmath.expjpi(mpmath.mpf(theta2) / 180) * mpmath.expj(omega2 * time)
            return mpmath.re(A) + mpmath.sqrt(r3**2 - (e - mpmath.im(A)) ** 2)

        h = mpmath.mpf("1e-16")
        velocity = (piston(h) - piston(-h)) / (2 * h)
        power = 1000 * torque * abs(omega2)
        return {
            "r1_dot": velocity,
            "mechanical_advantage": r2 * abs(omega2) / abs(velocity),
            "F_e": power / (r2 * abs(omega2)),
            "F_s": power / abs(velocity),
        }


@each_row("seed", range(10))
def test_answers_are_those_of_the_power_in_fifty_digits(seed):
    variant = EXERCISE.variant(seed)
    answers, reference = variant.solution(), exact(**variant.given)
    assert set(answers) == set(ASKED) == set(reference)
    for name, value in reference.items():
        assert abs(float(answers[name] - value)) < 1e-12 * abs(value), name


def test_the_loaded_slider_crank_needs_that_torque():
    """A piston that is held back by F_s, and nothing else, asks the drive for Gamma_e."""
    found = EXERCISE.solve(**PLAIN, only=("F_s", "r1_dot"))
    bearing = {n: PLAIN[n] for n in ("r2", "r3", "e", "theta2", "omega2")}
    scene = COURSE["slider_crank_torque"].solve(
        **bearing, F=-found["F_s"] * np.sign(found["r1_dot"]), effects=("load",), only="torque"
    )
    assert scene["torque"] == pytest.approx(PLAIN["Gamma_e"], rel=1e-12)


def test_there_is_no_advantage_at_the_dead_centres():
    at_rest = {**PLAIN, "e": 0.0, "theta2": 180.0}
    with pytest.raises(Undefined, match="piston is at rest"):
        EXERCISE.solve(**at_rest, only="mechanical_advantage")
    row = EXERCISE.solve(**{**at_rest, "theta2": np.array([0.0, 60.0, 180.0])}, only="F_s")["F_s"]
    assert np.isnan(row).tolist() == [True, False, True]


def test_a_rod_too_short_is_said():
    with pytest.raises(CannotAssemble):
        EXERCISE.solve(**{**PLAIN, "r3": 20.0}, only="F_s")
