"""Havens planetary gear: against fifty digits, by turns over a revolution, and at the places where the guide
stands still or has no direction."""

import mpmath
import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.errors import Undefined

EXERCISE = coursework.open_course()["havens_planetary"]
PLAIN = {"d": 30.0, "r2": 36.0, "r3": 22.0, "b": 25.0, "theta1": 50.0, "omega1": 6.0}
MOTION = ("rA", "theta4", "omega4", "omega2", "v_A1_4", "v_slide", "v_B2_x", "v_B2_y", "omega3", "v_I")


def exact(d, r2, r3, b, theta1, omega1):
    """Seventy digits, from the places of A1 and B2 alone: S2 is the line A1B2, I a point of it at rest on the
    pinion."""
    with mpmath.workdps(70):
        d, r2, r3, b, omega1 = map(mpmath.mpf, (d, r2, r3, b, omega1))
        start = mpmath.expjpi(mpmath.mpf(theta1) / 180)

        def pins(time):
            A1 = (r2 + r3) * start * mpmath.expj(omega1 * time)
            along = (A1 + d) / abs(A1 + d)
            return A1, A1 + b * along

        h = mpmath.mpf("1e-25")
        (A1, B2), before, after = pins(mpmath.mpf(0)), pins(-h), pins(h)
        v_A1, v_B2 = ((ahead - back) / (2 * h) for ahead, back in zip(after, before, strict=True))
        arm = A1 + d
        along = arm / abs(arm)
        omega2 = mpmath.im((v_B2 - v_A1) / (B2 - A1))
        v_I = mpmath.im((v_A1 + 1j * omega2 * (r3 * start - A1)) / start)
        return {
            "rA": abs(arm),
            "theta4": mpmath.degrees(mpmath.arg(arm)),
            "omega4": mpmath.im(v_A1 / arm),
            "omega2": omega2,
            "v_A1_4": mpmath.im(v_A1 / along),
            "v_slide": mpmath.re(v_A1 / along),
            "v_B2_x": mpmath.re(v_B2),
            "v_B2_y": mpmath.im(v_B2),
            "omega3": v_I / r3,
            "v_I": v_I,
        }


@each_row("seed", range(10))
def test_answers_are_those_of_the_places_in_fifty_digits(seed):
    variant = EXERCISE.variant(seed)
    answers, reference = variant.solution(), exact(**variant.given)
    for name, value in reference.items():
        size = 180 if name == "theta4" else abs(value)
        assert abs(mpmath.mpf(float(answers[name])) - value) < 2e-13 * size, name


@each_row(("d", "turns_of_guide"), [(30.0, 1), (90.0, 0)])
def test_over_a_turn_wheel_and_pinion_turn_as_their_teeth_say(d, turns_of_guide):
    """By Willis: turns of the pinion = turns of the crank + (crank - guide) r2 / r3; a guide beyond the crank
    only swings."""
    theta1 = np.arange(0.0, 360.0, 0.25)
    found = EXERCISE.solve(**{**PLAIN, "d": d, "theta1": theta1}, only=("omega4", "omega3"))
    assert found["omega4"].mean() / 6 == pytest.approx(turns_of_guide, abs=1e-12)
    turns_of_pinion = 1 + (1 - turns_of_guide) * 36 / 22
    assert found["omega3"].mean() / 6 == pytest.approx(turns_of_pinion, rel=1e-12)


def test_I_and_B2_have_the_same_velocity_along_their_line():
    found = EXERCISE.solve(**PLAIN, only=MOTION)
    crank = np.exp(1j * np.radians(50))
    I, B2 = 22 * crank, 58 * crank + 25 * np.exp(1j * np.radians(found["theta4"]))
    line = np.conj(B2 - I)
    by_wheel = ((found["v_B2_x"] + 1j * found["v_B2_y"]) * line).real
    assert (1j * found["v_I"] * crank * line).real == pytest.approx(by_wheel, rel=1e-12)


@each_row("away", [1e-2, 1e-6, 1e-10])
def test_rates_keep_their_digits_beside_O4(away):
    """A guide hardly shorter than the crank, A1 passing beside its pivot."""
    given = {**PLAIN, "d": 58.0 * (1 - 1e-9), "theta1": 180.0 - away}
    answers, reference = EXERCISE.solve(**given, only=MOTION), exact(**given)
    for name in ("rA", "omega4", "omega3", "v_slide"):
        assert abs(mpmath.mpf(float(answers[name])) - reference[name]) < 5e-13 * abs(reference[name]), name


def test_on_O4_the_guide_has_no_direction():
    with pytest.raises(Undefined, match="guide's pivot"):
        EXERCISE.solve(**{**PLAIN, "d": 58.0, "theta1": 180.0}, only="theta4")
    row = EXERCISE.solve(**{**PLAIN, "d": 58.0, "theta1": np.array([180.0, 90.0])}, only="theta4")["theta4"]
    assert np.isnan(row).tolist() == [True, False]


def test_the_position_needs_no_gear():
    assert not {"omega2", "omega3", "v_slide"} & set(EXERCISE.plan(("theta4", "rA")))
    assert "v_B2_x" not in EXERCISE.plan(("v_I",))


def test_every_vector_of_the_construction_has_its_own_reason():
    reasons = [p.quantity for p in EXERCISE.spec.parts if p.quantity.startswith("why")]
    answers = EXERCISE.solve(**PLAIN, only=reasons)
    assert sorted(answers.values()) == sorted(EXERCISE.spec.part(reasons[0]).choices)
