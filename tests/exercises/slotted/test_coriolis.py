"""Coriolis acceleration against the second derivative of a sliding point, and where there is none."""

import mpmath
import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.errors import Undefined, WrongValue

EXERCISE = coursework.open_course()["coriolis"]


def exact(omega, r_dot, theta):
    """A block that starts at the pivot has no other acceleration than that of Coriolis: fifty digits of
    it."""
    with mpmath.workdps(50):

        def place(time):
            return r_dot * time * mpmath.expjpi(mpmath.mpf(theta) / 180) * mpmath.expj(omega * time)

        h = mpmath.mpf("1e-15")
        acceleration = (place(h) - 2 * place(0) + place(-h)) / h**2
        return abs(acceleration), mpmath.degrees(mpmath.arg(acceleration))


@each_row("seed", range(12))
def test_size_and_direction_are_those_of_a_second_derivative(seed):
    variant = EXERCISE.variant(seed)
    answers = variant.solution()
    size, direction = exact(*(mpmath.mpf(variant.given[n]) for n in ("omega", "r_dot", "theta")))
    assert answers["a_coriolis"] == pytest.approx(float(size), rel=1e-14)
    apart = (answers["direction"] - float(direction) + 180) % 360 - 180
    assert abs(apart) < 1e-9
    assert -180 < answers["direction"] <= 180


def test_it_is_the_term_of_the_slotted_mechanism():
    """The signed term there, along i e^(i theta4), is this norm in this direction."""
    slotted = coursework.open_course()["slotted_mechanism"]
    for variant in slotted.variants(range(20)):
        there = slotted.solve(**variant.given, only=("theta4", "omega4", "rA_dot", "a_coriolis"))
        here = EXERCISE.solve(
            omega=there["omega4"],
            r_dot=there["rA_dot"],
            theta=there["theta4"],
            only=("a_coriolis", "direction"),
        )
        assert here["a_coriolis"] == pytest.approx(abs(there["a_coriolis"]), rel=1e-14)
        across = np.cos(np.radians(here["direction"] - there["theta4"] - 90))
        assert across == pytest.approx(np.sign(there["a_coriolis"]), abs=1e-12)


def test_reversing_one_motion_turns_it_about_and_reversing_both_leaves_it():
    plain = EXERCISE.solve(omega=4, r_dot=120, theta=35, only=("a_coriolis", "direction"))
    for signs, turned in (((-1, 1), 180), ((1, -1), 180), ((-1, -1), 0)):
        other = EXERCISE.solve(
            omega=4 * signs[0], r_dot=120 * signs[1], theta=35, only=("a_coriolis", "direction")
        )
        assert other["a_coriolis"] == plain["a_coriolis"]
        assert (other["direction"] - plain["direction"]) % 360 == turned


def test_a_term_that_vanishes_has_no_direction():
    for given in ({"omega": 5.0, "r_dot": 0.0}, {"omega": 0.0, "r_dot": 40.0}):
        with pytest.raises((Undefined, WrongValue)):
            EXERCISE.solve(**given, theta=20.0, only="direction")
    with pytest.raises(Undefined, match="no direction"):
        EXERCISE.solve(sense=0.0, theta=20.0, only="direction")
    row = EXERCISE.solve(sense=np.array([-1.0, 0.0, 1.0]), theta=20.0, only="direction")["direction"]
    np.testing.assert_array_equal(row, [-70.0, np.nan, 110.0])


def test_the_four_cases_are_two_questions():
    pairs = np.array(["C3_C3", "C4_P4", "C3_C4", "C3_P4"])
    cases = EXERCISE.solve(points=pairs, only="relative_motion")["relative_motion"]
    for pair, case in zip(pairs, cases, strict=True):
        one, other = pair.split("_")
        assert case.startswith("same_point") == (one[0] == other[0])
        assert case.endswith("same_body") == (one[1] == other[1])


def test_without_a_pair_the_points_are_the_coincident_ones():
    found = EXERCISE.solve(omega=1, r_dot=1, theta=0, only="relative_motion")
    assert found == {"relative_motion": "same_point_different_bodies"}
