"""Curved slot: the pin seen from the lever itself in fifty digits, the slot that straightens, and its two
ends."""

import mpmath
import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.errors import Undefined

EXERCISE = coursework.open_course()["curved_slot"]
ASKED = tuple(part.quantity for part in EXERCISE.spec.parts if not part.by_request)


def exact(r1, r2, d, rho, theta2, omega2, mode):
    """The pin's place in the lever's own frame, and its derivatives by differences in time."""
    with mpmath.workdps(60):
        r1, r2, d, rho, omega2 = map(mpmath.mpf, (r1, r2, d, rho, omega2))
        start = mpmath.radians(mpmath.mpf(theta2))

        def pose(t):
            """A, and the direction of the lever, by the circles about A and D."""
            A = r2 * mpmath.expj(start + omega2 * t)
            way, far = (r1 - A) / abs(r1 - A), abs(r1 - A)
            x = (rho**2 - d**2 + far**2) / (2 * far)
            C = A + way * mpmath.mpc(x, mpmath.sqrt(rho**2 - x**2) * (1 if mode == "open" else -1))
            return A, C

        def seen(t):
            A, C = pose(t)
            return (A - r1) * d / (C - r1)

        h = mpmath.mpf("1e-16")
        A, C = pose(0)
        lever = (C - r1) / d
        turned = [mpmath.arg((pose(t)[1] - r1) / (C - r1)) for t in (-h, h)]
        before, now, after = (seen(t) for t in (-h, 0, h))
        normal = (C - A) / rho
        tangent = -1j * normal
        v, a = (after - before) / (2 * h) * lever, (after - 2 * now + before) / h**2 * lever
        omega4 = (turned[1] - turned[0]) / (2 * h)
        slide = (v / tangent).real
        return {
            "theta3": mpmath.degrees(mpmath.arg(normal)),
            "theta4": mpmath.degrees(mpmath.arg(lever)),
            "tau": mpmath.degrees(mpmath.arg(tangent)),
            "omega4": omega4,
            "v_A4": abs(omega4 * (A - r1)),
            "v_rel": slide,
            "a_rel_n": (a / normal).real,
            "a_coriolis": 2 * omega4 * slide,
            "alpha4": (turned[1] + turned[0]) / h**2,
            "a_rel_t": (a / tangent).real,
        }


@each_row("seed", range(12))
def test_every_quantity_is_what_is_seen_from_the_lever(seed):
    given = dict(EXERCISE.variant(seed).given)
    right, found = exact(**given), EXERCISE.solve(**given, only=ASKED)
    for name in ASKED:
        assert found[name] == pytest.approx(float(right[name]), rel=3e-12), name


@each_row("seed", range(4))
def test_the_pin_stays_in_the_slot_that_is_drawn(seed):
    """Within both of its ends over the whole turn, on its middle line."""
    moved = EXERCISE.variant(seed).animation()
    rho = EXERCISE.variant(seed).given["rho"]
    assert moved.turns
    for elements in moved.frames:
        A = next(e.p for e in elements if getattr(e, "label", "") == "A")
        slot = next(e for e in elements if type(e).__name__ == "arc" and e.dashed)
        assert abs(A - slot.center) == pytest.approx(rho, rel=1e-12)
        way = np.degrees(np.angle((A - slot.center) / np.exp(1j * np.radians(slot.from_deg)))) % 360
        assert 8.9 <= way <= slot.to_deg - slot.from_deg - 8.9


def test_a_slot_of_large_radius_is_a_straight_one():
    """The slotted mechanism: its guide through D lies along the tangent, C as far off as one likes."""
    slotted, far = coursework.open_course()["slotted_mechanism"], 1e7
    for theta2 in (-140.0, -30.0, 35.0, 100.0):
        given = {"r1": 150.0, "r2": 60.0, "theta2": theta2, "omega2": 4.0}
        straight = slotted.solve(
            **{**given, "theta1": 180.0, "alpha2": 0.0}, only=("omega4", "alpha4", "a_coriolis", "rA_ddot")
        )
        found = EXERCISE.solve(
            **given,
            d=far,
            rho=far,
            mode="open",
            only=("omega4", "alpha4", "a_coriolis", "a_rel_n", "a_rel_t"),
        )
        assert found["omega4"] == pytest.approx(straight["omega4"], rel=1e-4)
        assert found["alpha4"] == pytest.approx(straight["alpha4"], rel=1e-3)
        assert abs(found["a_coriolis"]) == pytest.approx(abs(straight["a_coriolis"]), rel=1e-3)
        assert abs(found["a_rel_t"]) == pytest.approx(abs(straight["rA_ddot"]), rel=1e-3)
        assert found["a_rel_n"] < 1e-2


def test_at_the_ends_of_its_way_the_pin_rests_in_the_slot():
    ends = EXERCISE.solve(
        r1=150,
        r2=50,
        d=120,
        rho=130,
        theta2=np.array([0.0, 180.0]),
        omega2=3,
        mode="crossed",
        only=("v_rel", "a_coriolis", "a_rel_n", "a_rel_t"),
    )
    for name in ("v_rel", "a_coriolis", "a_rel_n"):
        np.testing.assert_allclose(ends[name], 0, atol=1e-10)
    assert (np.abs(ends["a_rel_t"]) > 100).all()


def test_where_the_normal_passes_through_the_pivot_the_lever_has_no_rate():
    """A dead point: A, C and D in line."""
    with pytest.raises(Undefined):
        EXERCISE.solve(r1=200, r2=50, d=100, rho=50, theta2=0, omega2=1, mode="open", only="omega4")


def test_bodies_and_joints_turn_the_lever_as_the_formulas_do():
    from coursework.scenes.scenes import Scene

    variant = EXERCISE.variant(5)
    found = EXERCISE.solve(**variant.given, only=("omega4", "alpha4"))
    stance = Scene(EXERCISE, variant.given).pose(np.radians([variant.given["theta2"]]), by_joints=True)
    lever, omega2 = EXERCISE.solution.mechanism.names.index("4"), variant.given["omega2"]
    assert stance.rates[lever, 0] * omega2 == pytest.approx(found["omega4"], rel=1e-12)
    assert stance.bends[lever, 0] * omega2**2 == pytest.approx(found["alpha4"], rel=1e-11)
