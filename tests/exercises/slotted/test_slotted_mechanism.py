"""Slotted mechanism against 50 digits, its hard places, and the misprint of the course."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.errors import Undefined

EXERCISE = coursework.open_course()["slotted_mechanism"]


def reference(given):
    """Every quantity from the vector O4A alone; rates by differentiating it in time at 50 digits."""
    with mpmath.workdps(50):
        r1, r2, omega2, alpha2 = (mpmath.mpf(given[n]) for n in ("r1", "r2", "omega2", "alpha2"))
        start, frame = (mpmath.mpf(given[n]) * mpmath.pi / 180 for n in ("theta2", "theta1"))

        def arm(t):
            crank = start + omega2 * t + alpha2 * t * t / 2
            return r1 * mpmath.expj(frame) + r2 * mpmath.expj(crank)

        direction = mpmath.arg(arm(0))

        def length(t):
            return abs(arm(t))

        def angle(t):
            return mpmath.arg(arm(t) * mpmath.expj(-direction))

        step = {"h": mpmath.mpf(10) ** -12}
        rates = {
            "rA": length(0),
            "theta4": direction * 180 / mpmath.pi,
            "rA_dot": mpmath.diff(length, 0, 1, **step),
            "omega4": mpmath.diff(angle, 0, 1, **step),
            "rA_ddot": mpmath.diff(length, 0, 2, **step),
            "alpha4": mpmath.diff(angle, 0, 2, **step),
        }
        rates["a_centripetal"] = -rates["rA"] * rates["omega4"] ** 2
        rates["a_coriolis"] = 2 * rates["omega4"] * rates["rA_dot"]
        rates["a_tangential"] = rates["rA"] * rates["alpha4"]
        rates["a_radial"] = rates["rA_ddot"]
        return rates


@each_row("seed", range(12))
def test_every_quantity_agrees_with_fifty_digits(seed):
    given = dict(EXERCISE.variant(seed).given)
    exact = reference(given)
    found = EXERCISE.solve(**given, only=tuple(exact))
    size = {"alpha4": given["omega2"] ** 2, "rA_ddot": given["r2"] * given["omega2"] ** 2}
    for name, value in found.items():
        assert abs(value - exact[name]) <= 1e-13 * max(abs(exact[name]), size.get(name, 0)), name


def test_the_guide_turns_at_half_speed_wherever_it_is_when_frame_and_crank_are_equal():
    theta2 = np.concatenate([np.linspace(-89, 269, 300), -90 + np.logspace(-9, -1, 30)])
    omega4 = EXERCISE.solve(r1=200, r2=200, theta2=theta2, omega2=3, only="omega4")["omega4"]
    np.testing.assert_allclose(omega4, 1.5, rtol=1e-14)


def test_on_the_pivot_the_guide_has_no_direction():
    with pytest.raises(Undefined, match="lies on the guide's pivot"):
        EXERCISE.solve(r1=200, r2=200, theta2=-90, only="theta4")
    found = EXERCISE.solve(r1=200, r2=200, theta2=np.array([-90.0, 0.0]), only="theta4")["theta4"]
    np.testing.assert_array_equal(np.isnan(found), [True, False])
    with pytest.raises(Undefined, match="neither oscillates nor turns"):
        EXERCISE.solve(r1=200, r2=200, only="guide")


@each_row("gap", [1e-3, 1e-9, 1e-12])
def test_the_swing_is_exact_as_the_crank_nears_the_frame(gap):
    r1, r2 = 200.0, 200.0 * (1 - gap)
    with mpmath.workdps(50):
        exact = 2 * mpmath.asin(mpmath.mpf(r2) / r1) * 180 / mpmath.pi
    assert EXERCISE.solve(r1=r1, r2=r2, only="swing")["swing"] == pytest.approx(float(exact), rel=1e-15)


def test_the_misprinted_length_of_the_course_is_no_mistake_of_ours():
    """The notes print 2286 m for O4O2; with it the position that they give does not come out."""
    right = EXERCISE.solve(r1="228.6 mm", r2="114.3 mm", theta2=135, only=("rA", "theta4"))
    assert (round(right["rA"], 2), round(right["theta4"], 2)) == (319.80, 104.64)
    printed = EXERCISE.solve(r1="2286 m", r2="114.3 mm", theta2=135, only=("rA", "theta4"))
    assert abs(printed["rA"] - 319.80) > 1e6


def _exact_motion(r1, r2, theta1, theta2, omega2, alpha2):
    """Arm, direction and their derivatives from the vector of A itself, in fifty digits."""
    with mpmath.workdps(60):
        r1, r2, theta1, theta2, omega2, alpha2 = map(mpmath.mpf, (r1, r2, theta1, theta2, omega2, alpha2))
        crank = r2 * mpmath.expjpi(theta2 / 180)
        arm = r1 * mpmath.expjpi(theta1 / 180) + crank
        unit = arm / abs(arm)
        v = 1j * omega2 * crank / unit
        a = (1j * alpha2 - omega2**2) * crank / unit
        rate, slide = v.imag / abs(arm), v.real
        return {
            "rA": abs(arm),
            "rA_dot": slide,
            "omega4": rate,
            "rA_ddot": a.real + abs(arm) * rate**2,
            "alpha4": (a.imag - 2 * slide * rate) / abs(arm),
        }


@each_row(
    ("r1", "r2", "theta2"),
    [(200.0, 200.0001, -90 + 1e-8), (200.0, 100.0, -90 + 1e-9), (1e-6, 200.0, 30.0), (250.0, 0.001, 100.0)],
)
def test_rates_keep_their_digits_where_the_formulas_lose_them(r1, r2, theta2):
    """The block beside O4, and a crank far longer or far shorter than the frame."""
    given = {"r1": r1, "r2": r2, "theta1": 90.0, "theta2": theta2, "omega2": 3.0, "alpha2": 2.0}
    found = EXERCISE.solve(**given, only=("rA", "rA_dot", "omega4", "rA_ddot", "alpha4"))
    for name, right in _exact_motion(**given).items():
        assert found[name] == pytest.approx(float(right), rel=2e-13), name


def test_the_tangential_term_is_asked_by_request_and_told_from_the_whole_across_the_guide():
    """A seed asks what it asked before; a build may ask for the term besides."""
    variant = EXERCISE.variant(3, "en")
    assert "a_tangential" not in variant.part_ids
    found = EXERCISE.solve(**variant.given, only=("rA", "alpha4", "a_coriolis", "a_tangential"))
    record = dict(variant.record)
    part = {"id": "a_tangential", "quantity": "a_tangential", "unit": "mm/s^2", "kind": "number", "points": 1}
    record["parts"] = [*record["parts"], part]
    asked = EXERCISE.from_record(record)
    right = asked.grade({"a_tangential": f"{found['rA'] * found['alpha4'] / 1000:.5g} m/s²"})["a_tangential"]
    assert right.verdict == "correct"
    whole = f"{found['a_tangential'] + found['a_coriolis']:.5g}"
    assert (
        asked.grade({"a_tangential": whole})["a_tangential"].verdict
        == "mistake:coriolis_in_the_tangential_term"
    )
