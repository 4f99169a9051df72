"""Tipping body and jack: against fifty digits of two circles that cross, at the jack's ends, and near dead
points."""

import mpmath
import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.errors import CannotAssemble, Undefined

EXERCISE = coursework.open_course()["jack_mechanism"]
ASKED = tuple(part.quantity for part in EXERCISE.spec.parts if not part.by_request)


def exact(a, xB, yB, L_min, L_max, L, L_dot, L_ddot, c, eta):
    """The place of A where two circles cross, as the jack grows; rates by its differences in fifty digits."""
    with mpmath.workdps(50):
        a, xB, yB, L, L_dot, L_ddot, c, eta = map(mpmath.mpf, (a, xB, yB, L, L_dot, L_ddot, c, eta))
        B, eta = mpmath.mpc(xB, yB), mpmath.radians(eta)

        def head(length):
            x = (a**2 - length**2 + abs(B) ** 2) / (2 * abs(B))
            return B / abs(B) * mpmath.mpc(x, mpmath.sqrt(a**2 - x**2))

        def after(t):
            return head(L + L_dot * t + L_ddot * t**2 / 2)

        h = mpmath.mpf("1e-14") * L / abs(L_dot)
        before, now, later = after(-h), after(0), after(h)

        def rates(of):
            """First and second derivative of the direction of a vector that turns."""
            back, on = (mpmath.arg(of(z) / of(now)) for z in (before, later))
            return (on - back) / (2 * h), (on + back) / h**2

        omega4, alpha4 = rates(lambda z: z)
        omega2, alpha2 = rates(lambda z: z - B)
        carry = c / a * mpmath.expj(eta)
        reach = [mpmath.arg(head(mpmath.mpf(end))) for end in (L_min, L_max)]
        return {
            "theta4": mpmath.degrees(mpmath.arg(now)),
            "theta2": mpmath.degrees(mpmath.arg(now - B)),
            "yG": (carry * now).imag,
            "swing": mpmath.degrees(reach[1] - reach[0]),
            "omega4": omega4,
            "omega2": omega2,
            "v_G": abs(carry * (later - before) / (2 * h)),
            "a_coriolis": 2 * omega2 * L_dot,
            "alpha4": alpha4,
            "alpha2": alpha2,
            "a_G": abs(carry * (later - 2 * now + before) / h**2),
        }


@each_row("seed", range(12))
def test_every_quantity_agrees_with_fifty_digits(seed):
    given = dict(EXERCISE.variant(seed).given)
    right, found = exact(**given), EXERCISE.solve(**given, only=ASKED)
    squared = float(right["omega4"]) ** 2
    sizes = {"alpha4": squared, "alpha2": squared, "yG": given["c"], "theta4": 180}
    for name in ASKED:
        size = max(abs(float(right[name])), sizes.get(name, 0))
        assert abs(found[name] - right[name]) < 1e-12 * size, name


def test_the_four_terms_along_and_across_the_jack_are_the_acceleration_of_A():
    given = dict(EXERCISE.variant(3).given)
    found = EXERCISE.solve(
        **given, only=("theta4", "theta2", "omega4", "omega2", "alpha4", "alpha2", "a_coriolis")
    )
    along = given["L_ddot"] - given["L"] * found["omega2"] ** 2
    across = given["L"] * found["alpha2"] + found["a_coriolis"]
    by_jack = (along + 1j * across) * np.exp(1j * np.radians(found["theta2"]))
    turning = 1j * found["alpha4"] - found["omega4"] ** 2
    by_body = turning * given["a"] * np.exp(1j * np.radians(found["theta4"]))
    assert by_jack == pytest.approx(by_body, rel=1e-13)


@each_row("gap", [1e-3, 1e-7, 1e-10])
def test_near_the_dead_point_no_digit_is_lost(gap):
    """The jack nearly in line with OA: its length close to the sum of the two other sides."""
    given = {"a": 500.0, "xB": 300.0, "yB": -400.0, "L": 1000.0 * (1 - gap), "L_dot": 100.0}
    with mpmath.workdps(50):
        L = mpmath.mpf(given["L"])
        x = mpmath.acos(1 - L**2 / 500000)
        right = 100 * L / (250000 * mpmath.sin(x))
    found = EXERCISE.solve(**given, only="omega4")["omega4"]
    assert found == pytest.approx(float(right), rel=1e-11 if gap < 1e-9 else 1e-13)


def test_in_line_the_jack_turns_nothing_and_too_long_it_reaches_nothing():
    line = {"a": 500.0, "xB": 300.0, "yB": -400.0, "L_dot": 100.0}
    with pytest.raises(Undefined, match="dead point"):
        EXERCISE.solve(**line, L=1000.0, only="omega4")
    with pytest.raises(CannotAssemble):
        EXERCISE.solve(**line, L=1001.0, only="theta4")
    both = EXERCISE.solve(**line, L=np.array([700.0, 1001.0]), only="theta4")["theta4"]
    np.testing.assert_array_equal(np.isnan(both), [False, True])


def test_the_animation_swings_between_the_ends_of_the_jack():
    variant = EXERCISE.variant(4)
    moved = variant.animation()
    swing = EXERCISE.solve(**variant.given, only="swing")["swing"]
    assert not moved.turns
    assert np.ptp(moved.angles) == pytest.approx(swing, abs=0.01)
    lengths = np.abs(moved.points["A"].position - complex(variant.given["xB"], variant.given["yB"]))
    assert lengths.min() >= variant.given["L_min"] - 0.01
    assert lengths.max() <= variant.given["L_max"] + 0.01
    assert lengths.max() - lengths.min() == pytest.approx(
        variant.given["L_max"] - variant.given["L_min"], abs=0.1
    )


def test_vectors_of_the_animation_are_the_slopes_of_paths_at_the_rate_of_the_jack():
    variant = EXERCISE.variant(4)
    points, lengths = variant.animation().points, variant.given["L_min"] + np.arange(5.0, 100.0, 0.01)
    rate, bend = variant.given["L_dot"], variant.given["L_ddot"]
    given = {**variant.given, "L": lengths}
    found = EXERCISE.solve(**given, only=("theta4", "omega4", "alpha4"))
    at = variant.given["a"] * np.exp(1j * np.radians(found["theta4"]))
    slope = np.gradient(at, lengths)
    velocity, acceleration = slope * rate, np.gradient(slope, lengths) * rate**2 + slope * bend
    angles = np.degrees(np.angle(points["A"].position))
    inside = (angles > found["theta4"][9]) & (angles < found["theta4"][-9])
    assert inside.sum() > 2
    for told, right in ((points["A"].velocity, velocity), (points["A"].acceleration, acceleration)):
        read = np.interp(angles[inside], found["theta4"], right.real) + 1j * np.interp(
            angles[inside], found["theta4"], right.imag
        )
        np.testing.assert_allclose(told[inside], read, atol=1e-5 * np.abs(right).max())


def test_the_statement_of_bodies_and_joints_turns_them_as_the_formulas_do():
    """By the joints, for one of the tilt: the jack turns by omega2 / omega4."""
    from coursework.scenes.scenes import Scene

    variant = EXERCISE.variant(6)
    found = EXERCISE.solve(**variant.given, only=("theta4", "omega4", "omega2"))
    stance = Scene(EXERCISE, variant.given).pose(np.radians([found["theta4"]]), by_joints=True)
    names = EXERCISE.solution.mechanism.names
    assert stance.rates[names.index("2"), 0] == pytest.approx(found["omega2"] / found["omega4"], rel=1e-12)
