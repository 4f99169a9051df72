"""Quick-return design: any slider-crank that does it is right; judged against its motion."""

from __future__ import annotations

import numpy as np
import pytest
from sweeps import sampled

import coursework
from coursework.language.numbers import significant

EXERCISE = coursework.open_course()["quick_return_design"]


def simulated(r2, r3, e, count=400_001):
    """Stroke, crank arc from the far end to the near one (anticlockwise), largest inclination; mm,
    degrees."""
    theta = np.linspace(0, 2 * np.pi, count)
    x = r2 * np.cos(theta) + np.sqrt(r3**2 - (e - r2 * np.sin(theta)) ** 2)
    far, near = int(np.argmax(x)), int(np.argmin(x))
    arc = 360 * ((near - far) % (count - 1)) / (count - 1)
    return x[far] - x[near], arc, np.degrees(np.arcsin(np.max(abs(e - r2 * np.sin(theta))) / r3))


def through_a_crank(stroke, Q, r2):
    """Rod and offset that go with a crank: O on the arc that sees the stroke, its distances differing by 2
    r2."""
    from scipy.optimize import brentq

    angle = np.pi * (Q - 1) / (Q + 1)
    radius = stroke / (2 * np.sin(angle))

    def sides(turn):
        O = complex(stroke / 2, radius * np.cos(angle)) + radius * np.exp(1j * turn)
        return abs(O), abs(O - stroke), abs(O.imag)

    turn = brentq(lambda t: sides(t)[1] - sides(t)[0] - 2 * r2, np.pi / 2, 1.5 * np.pi - angle)
    near, far, e = sides(turn)
    return (far + near) / 2, e


@pytest.mark.parametrize("seed", sampled(range(12), range(1)))
def test_every_crank_shorter_than_half_the_stroke_is_judged_as_its_motion_is(seed):
    variant = EXERCISE.variant(seed, "en")
    given = variant.given
    alpha = 360 * given["Q"] / (1 + given["Q"])
    told = {True: 0, False: 0}
    for share in np.linspace(0.5, 0.995, 30):
        r2 = share * given["stroke"] / 2
        r3, e = through_a_crank(given["stroke"], given["Q"], r2)
        if r3 - r2 <= e * 1.001:
            continue
        for sign in (1, -1):
            stroke, arc, lean = simulated(r2, r3, sign * e)
            slow = arc if given["mode"] == "inward" else 360 - arc
            assert stroke == pytest.approx(given["stroke"], rel=1e-6)
            if given["delta"] < lean < given["delta"] + 1:
                continue
            does = abs(slow - alpha) < 1 and lean < given["delta"]
            verdict = variant.grade({"r2": r2, "r3": r3, "e": sign * e})["e"].verdict
            assert (verdict == "correct") == does, (r2, r3, e, stroke, slow, lean, verdict)
            told[does] += 1
    assert min(told.values()) >= 3


def test_what_is_told_is_the_motion_of_the_students_own_lengths():
    variant = EXERCISE.variant(1, "en")
    stroke, _, lean = simulated(40, 120, 30)
    feedback = variant.grade({"r2": "4 cm", "r3": 120, "e": 30})["r2"].feedback
    assert f"{significant(stroke)} mm" in feedback
    assert significant(lean) in feedback
