"""Coupler curve against fifty digits, along the whole curve, and the drawing that is P's."""

import mpmath
import numpy as np
import pytest
from tables import each_row

import coursework

EXERCISE = coursework.open_course()["coupler_curve"]
ASKED = tuple(part.quantity for part in EXERCISE.spec.parts if part.kind != "choice")
NUMBERS = ("r1", "r2", "r3", "r4", "AP", "beta", "theta2", "omega2")


def place(r1, r2, r3, r4, AP, beta, theta2, mode):
    """A, B and P by the crossing of two circles, whose chord is solved as a quadratic equation."""
    A = r2 * mpmath.expj(theta2)
    along, height = (r1 - A) / abs(r1 - A), abs(r1 - A)
    x = (r3**2 - r4**2 + height**2) / (2 * height)
    y = mpmath.sqrt(r3**2 - x**2) * (1 if mode == "open" else -1)
    B = A + along * (x + 1j * y)
    return A, B, A + (B - A) / r3 * AP * mpmath.expj(beta)


def exact(given):
    """Positions in fifty digits, rates by their differences in time."""
    with mpmath.workdps(50):
        r1, r2, r3, r4, AP, beta, theta2, omega2 = (mpmath.mpf(given[n]) for n in NUMBERS)
        beta, theta2 = mpmath.radians(beta), mpmath.radians(theta2)

        def at(time):
            return place(r1, r2, r3, r4, AP, beta, theta2 + omega2 * time, given["mode"])

        h = mpmath.mpf("1e-16")
        (A0, B0, P0), now, (A1, B1, P1) = at(-h), at(0), at(h)
        v = (P1 - P0) / (2 * h)
        return {
            "theta3": mpmath.degrees(mpmath.arg(now[1] - now[0])),
            "xP": now[2].real,
            "yP": now[2].imag,
            "omega3": mpmath.arg((B1 - A1) / (B0 - A0)) / (2 * h),
            "v_P_x": v.real,
            "v_P_y": v.imag,
            "v_P": abs(v),
            "direction": mpmath.degrees(mpmath.arg(v)),
        }


@each_row("seed", range(12))
def test_every_quantity_agrees_with_fifty_digits(seed):
    given = dict(EXERCISE.variant(seed).given)
    right, found = exact(given), EXERCISE.solve(**given, only=ASKED)
    size = {"xP": given["r3"], "yP": given["r3"], "theta3": 180, "direction": 180}
    speed = float(right["v_P"])
    for name in ASKED:
        scale = size.get(name, speed if name.startswith("v_") else abs(float(right[name])))
        assert abs(found[name] - right[name]) < 2e-13 * scale, name


def _curve(given, beta=0.0, mode="", at_B=False):
    """Every fifth degree of a point of the coupler, by the exact road."""
    lengths = [mpmath.mpf(given[n]) for n in ("r1", "r2", "r3", "r4", "AP")]
    points = []
    for turn in range(0, 360, 5):
        A, B, P = place(*lengths, mpmath.radians(beta), mpmath.radians(turn), mode or given["mode"])
        points.append(complex(A + B - P) if at_B else complex(P))
    return np.array(points)


@each_row("seed", range(6))
def test_the_right_drawing_is_that_of_P_and_the_others_those_of_the_mistakes(seed):
    """Each drawing is, up to place and scale, the curve that its name stands for."""
    variant = EXERCISE.variant(seed)
    given = dict(variant.given)
    other = "crossed" if given["mode"] == "open" else "open"
    curves = {
        "curve": _curve(given, given["beta"]),
        "curve_of_the_point_across_AB": _curve(given, -given["beta"]),
        "curve_of_the_other_mode": _curve(given, given["beta"], other),
        "curve_of_a_point_laid_off_at_B": _curve(given, given["beta"], at_B=True),
    }
    drawn = [np.array(e.points[:-1]) for e in variant.figure.elements if type(e).__name__ == "trace"]
    sizes = set()
    for name, curve in curves.items():
        graph = EXERCISE.solution.graph if name == "curve" else EXERCISE.solution.mistaken(name)
        place_of = str(graph.evaluate(("curve",), {"arrangement": given["arrangement"]})["curve"])
        shown = drawn[("I", "II", "III", "IV").index(place_of)]
        steps = np.diff(shown) / np.diff(curve)
        np.testing.assert_allclose(steps, steps[0].real, rtol=1e-9)
        sizes.add(round(steps[0].real, 9))
    assert len(sizes) == 1


def test_over_the_turn_the_velocity_is_the_slope_of_the_curve():
    given = dict(EXERCISE.variant(5).given)
    theta2 = np.arange(0, 360, 0.01)
    found = EXERCISE.solve(**{**given, "theta2": theta2}, only=("xP", "yP", "v_P_x", "v_P_y"))
    points, velocity = found["xP"] + 1j * found["yP"], found["v_P_x"] + 1j * found["v_P_y"]
    steps = (np.roll(points, -1) - np.roll(points, 1)) / (2 * np.radians(0.01))
    np.testing.assert_allclose(steps * given["omega2"], velocity, atol=1e-6 * np.abs(velocity).max())


def test_a_point_of_the_coupler_at_a_pin_moves_as_the_pin():
    given = dict(EXERCISE.variant(1).given) | {"beta": 0.0}
    at_B = EXERCISE.solve(**{**given, "AP": given["r3"]}, only=("xP", "yP", "v_P"))
    assert abs(at_B["xP"] + 1j * at_B["yP"] - given["r1"]) == pytest.approx(given["r4"], rel=1e-13)
    at_A = EXERCISE.solve(**{**given, "AP": 1e-12 * given["r3"]}, only="v_P")["v_P"]
    assert at_A == pytest.approx(given["r2"] * abs(given["omega2"]), rel=1e-10)
