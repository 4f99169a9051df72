"""Mechanical advantage: against fifty digits, by the instant centre of the coupler, and where nothing
moves."""

import mpmath
import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.errors import Cycle, Undefined

EXERCISE = coursework.open_course()["mechanical_advantage"]
ASKED = tuple(part.quantity for part in EXERCISE.spec.parts)
PLAIN = {
    "r1": 200.0,
    "r2": 60.0,
    "r3": 180.0,
    "r4": 150.0,
    "theta2": 50.0,
    "omega2": 7.0,
    "mode": "open",
    "F_e": 100.0,
}


def exact(r1, r2, r3, r4, theta2, omega2, mode, F_e):
    """Fifty digits: the velocity of B by differences in time, then the power."""
    with mpmath.workdps(50):
        r1, r2, r3, r4, omega2, F_e = map(mpmath.mpf, (r1, r2, r3, r4, omega2, F_e))
        turn = {"open": 1, "crossed": -1}[mode]

        def B(time):
            A = r2 * mpmath.expjpi(mpmath.mpf(theta2) / 180) * mpmath.expj(omega2 * time)
            AC = r1 - A
            at_A = mpmath.acos((r3**2 + abs(AC) ** 2 - r4**2) / (2 * r3 * abs(AC)))
            return A + r3 * AC / abs(AC) * mpmath.expj(turn * at_A)

        h = mpmath.mpf("1e-15")
        velocity = (B(h) - B(-h)) / (2 * h)
        power = F_e * r2 * abs(omega2)
        omega4 = mpmath.im(velocity / (B(0) - r1))
        return {
            "omega4": omega4,
            "mechanical_advantage": power / abs(velocity) / F_e,
            "F_s": power / abs(velocity),
            "torque_ratio": abs(omega2 / omega4),
            "Gamma_s": power / abs(omega4) / 1000,
        }


@each_row("seed", range(10))
def test_answers_are_those_of_the_power_in_fifty_digits(seed):
    variant = EXERCISE.variant(seed)
    answers, reference = variant.solution(), exact(**variant.given)
    assert set(answers) == set(ASKED) == set(reference)
    for name, value in reference.items():
        assert abs(float(answers[name] - value)) < 1e-12 * abs(value), name


@each_row("away", [1e-2, 1e-5, 1e-8])
def test_the_advantage_keeps_its_digits_next_to_a_change_point(away):
    given = {**PLAIN, "r1": 100.0, "r2": 50.0, "r3": 70.0, "r4": 80.0, "theta2": 180.0 - away}
    answers, reference = EXERCISE.solve(**given, only=ASKED), exact(**given)
    for name in ASKED:
        assert abs(float(answers[name] - reference[name])) < 1e-12 * abs(reference[name]), name


def test_torques_are_as_the_distances_of_the_pivots_from_the_coupler():
    """Only the force along the coupler passes from crank to rocker: its arms are these distances."""
    theta2 = np.array([20.0, 75.0, 130.0, -40.0, -95.0])
    given = {**PLAIN, "theta2": theta2}
    found = EXERCISE.solve(**given, only=("theta3", "torque_ratio"))
    A, along = 60 * np.exp(1j * np.radians(theta2)), np.exp(1j * np.radians(found["theta3"]))
    arm_of_crank, arm_of_rocker = abs((A * along.conj()).imag), abs(((A - 200) * along.conj()).imag)
    np.testing.assert_allclose(found["torque_ratio"], arm_of_rocker / arm_of_crank, rtol=1e-12)


def test_the_force_is_the_torque_over_its_arm_whichever_is_given():
    by_force = EXERCISE.solve(**PLAIN, only=("F_s", "Gamma_s", "Gamma_e"))
    assert by_force["Gamma_s"] == pytest.approx(by_force["F_s"] * 0.150, rel=1e-14)
    torque = {**PLAIN, "Gamma_e": by_force["Gamma_e"]}
    del torque["F_e"]
    by_torque = EXERCISE.solve(**torque, only=("F_s", "Gamma_s"))
    assert by_torque == pytest.approx({n: by_force[n] for n in by_torque}, rel=1e-14)
    del torque["Gamma_e"]
    with pytest.raises(Cycle, match="give one of them a value"):
        EXERCISE.solve(**torque, only="F_s")


def test_there_is_no_advantage_where_the_output_is_at_rest():
    """Crank and coupler stretched out: the rocker turns back."""
    dead = {**PLAIN, "r1": 60.0, "r2": 30.0, "r3": 90.0, "r4": 60 * 3**0.5, "theta2": 60.0}
    for name in ("mechanical_advantage", "torque_ratio"):
        with pytest.raises(Undefined, match="output is at rest"):
            EXERCISE.solve(**dead, omega4=0.0, only=name)
        row = EXERCISE.solve(**dead, omega4=np.array([0.0, -2.0]), only=name)[name]
        assert np.isnan(row).tolist() == [True, False]
    assert EXERCISE.solve(**dead, only="mechanical_advantage")["mechanical_advantage"] > 1e12


def test_the_way_the_crank_turns_does_not_count_for_the_advantage():
    there, back = (EXERCISE.solve(**{**PLAIN, "omega2": w}, only=ASKED) for w in (7.0, -7.0))
    assert back["omega4"] == -there["omega4"]
    assert all(back[name] == there[name] for name in ASKED if name != "omega4")
