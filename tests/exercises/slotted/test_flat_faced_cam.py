"""Flat-faced cam at fifty digits: the law from its six conditions, the cam as the envelope of the face, its
circle through three points."""

import mpmath
import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.errors import Undefined

EXERCISE = coursework.open_course()["flat_faced_cam"]
ASKED = tuple(part.quantity for part in EXERCISE.spec.parts)


def law(h, beta):
    """The polynomial of degree five that rests at both ends, found from its six conditions."""
    rows, right = [], []
    for x, lifted in ((mpmath.mpf(0), 0), (beta, h)):
        for n in range(3):
            rows.append([mpmath.ff(k, n) * x ** (k - n) if k >= n else 0 for k in range(6)])
            right.append(lifted if n == 0 else 0)
    coefficients = mpmath.lu_solve(mpmath.matrix(rows), mpmath.matrix(right))
    return lambda theta: sum(c * theta**k for k, c in enumerate(coefficients))


def exact(h, beta, Rb, rho_min, theta, omega):
    with mpmath.workdps(60):
        h, Rb, rho_min, omega = map(mpmath.mpf, (h, Rb, rho_min, omega))
        beta, theta = mpmath.radians(mpmath.mpf(beta)), mpmath.radians(mpmath.mpf(theta))
        lift, d = law(h, beta), mpmath.mpf("1e-15")

        def contact(at):
            """Of the cam at the angle 0: where the lines of the face just before and just after cross."""
            sides = [at - d, at + d]
            normals = [mpmath.matrix([[mpmath.sin(t), mpmath.cos(t)]]) for t in sides]
            matrix = mpmath.matrix([list(n) for n in normals])
            found = mpmath.lu_solve(matrix, mpmath.matrix([Rb + lift(t) for t in sides]))
            return mpmath.mpc(found[0], found[1])

        def radius(at):
            """Of the circle through three neighbouring points."""
            step = mpmath.mpf("1e-9")
            p, q, r = (contact(at + k * step) for k in (-1, 0, 1))
            area = ((q - p).conjugate() * (r - p)).imag / 2
            return -abs(q - p) * abs(r - q) * abs(r - p) / (4 * area)

        def bulge(at):
            return lift(at) + mpmath.diff(lift, at, 2)

        tightest = mpmath.findroot(lambda t: mpmath.diff(bulge, t), 0.78 * beta)
        time = mpmath.mpf("1e-15")
        before, now, after = (lift(theta + omega * t) for t in (-time, 0, time))
        middle = mpmath.findroot(lambda t: mpmath.diff(lift, t, 2), 0.45 * beta)
        return {
            "s": now,
            "q": (contact(theta) * mpmath.expj(theta)).real,
            "v": (after - before) / (2 * time),
            "a": (after - 2 * now + before) / time**2,
            "q_max": mpmath.diff(lift, middle),
            "rho": radius(theta),
            "theta_c": mpmath.degrees(tightest),
            "Rb_min": rho_min - bulge(tightest),
        }


@each_row("seed", range(10))
def test_every_quantity_agrees_with_fifty_digits(seed):
    given = dict(EXERCISE.variant(seed).given)
    right, found = exact(**given), EXERCISE.solve(**given, only=ASKED)
    for name in ASKED:
        close = 1e-12 if name != "rho" else 1e-10
        assert found[name] == pytest.approx(float(right[name]), rel=close), name


def test_no_smaller_base_circle_will_do():
    given = dict(EXERCISE.variant(3).given)
    smallest = EXERCISE.solve(**given, only="Rb_min")["Rb_min"]
    theta = np.linspace(-180, 180, 7201)
    radii = EXERCISE.solve(**{**given, "Rb": smallest, "theta": theta}, only="rho")["rho"]
    assert radii.min() == pytest.approx(given["rho_min"], abs=1e-4)
    assert radii.min() >= given["rho_min"] - 1e-9


def test_over_the_turn_the_follower_goes_up_stays_and_comes_back():
    theta, given = np.linspace(-180, 180, 36001), {"h": 20.0, "beta": 80.0, "Rb": 60.0, "omega": 2.0}
    found = EXERCISE.solve(**given, theta=theta, only=("s", "q", "v", "a"))
    s, radians = found["s"], np.radians(theta)
    assert (s.min(), s.max()) == (0, 20)
    np.testing.assert_array_equal(s[(theta > 80) & (theta < 120)], 20)
    np.testing.assert_array_equal(s[(theta > -160) & (theta < 0)], 0)
    np.testing.assert_allclose(np.interp(200 - 360, theta, s), 0, atol=1e-12)
    np.testing.assert_allclose(np.gradient(s, radians)[1:-1], found["q"][1:-1], atol=2e-5)
    np.testing.assert_allclose(np.gradient(found["v"], radians / 2)[1:-1], found["a"][1:-1], atol=0.1)
    rise, back = (EXERCISE.solve(**given, theta=t, only=("s", "q")) for t in (30.0, 170.0))
    assert (rise["s"], rise["q"]) == pytest.approx((back["s"], -back["q"]), rel=1e-13)


def test_face_and_cam_touch_and_never_cross():
    """Every point of the cam lies on or below the face, and one on it."""
    moved = EXERCISE.variant(2).animation()
    Rb = EXERCISE.variant(2).given["Rb"]
    for elements in moved.frames[::6]:
        cam = next(np.array(e.points) for e in elements if type(e).__name__ == "profile")
        face = next(e.points[0].imag for e in elements if type(e).__name__ == "bar")
        assert cam.imag.max() <= face + 1e-9
        assert cam.imag.max() == pytest.approx(face, abs=0.01 * Rb)


def test_a_rise_that_leaves_no_room_for_the_return_is_refused():
    with pytest.raises(Undefined, match="do not fit in a turn"):
        EXERCISE.solve(h=10, beta=160, only="theta_c")
    found = EXERCISE.solve(h=10, beta=np.array([100.0, 170.0]), only="q_max")["q_max"]
    np.testing.assert_array_equal(np.isnan(found), [False, True])
