"""Crank-rocker design: any linkage that does it is right, however it was found; judged against its motion."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from sweeps import sampled

import coursework

EXERCISE = coursework.open_course()["crank_rocker_design"]


def simulated(r1, r2, r3, r4, count=200_001):
    """Swing, slow arc and worst transmission angle, from the rocker's angle over a turn; degrees."""
    crank = r2 * np.exp(1j * np.linspace(0, 2 * np.pi, count))
    diagonal = abs(crank - r1)
    inner = (r3**2 + r4**2 - diagonal**2) / (2 * r3 * r4)
    assert np.all(abs(inner) < 1)
    at_c = np.angle(r1 - crank)  # direction C -> A from the direction C -> O
    rocker = at_c - np.arccos((r4**2 + diagonal**2 - r3**2) / (2 * r4 * diagonal))
    low, high = int(np.argmin(rocker)), int(np.argmax(rocker))
    arc = 360 * abs(high - low) / (count - 1)
    mu = np.degrees(np.arccos(inner))
    swing = math.degrees(rocker[high] - rocker[low])
    return swing, max(arc, 360 - arc), min(mu.min(), 180 - mu.max())


def on_the_arc(r4, psi, phi, beta):
    """A linkage whose O sees both ends of the swing under phi: where two rays from them meet."""
    B1, B2 = (r4 * np.exp(1j * np.radians(90 + side * psi / 2)) for side in (1, -1))
    ways = np.exp(1j * np.radians([-beta, 180 + 180 - beta - phi]))
    near, far = np.linalg.solve(
        [[ways[0].real, -ways[1].real], [ways[0].imag, -ways[1].imag]], [(B2 - B1).real, (B2 - B1).imag]
    )
    return abs(B1 + near * ways[0]), (far - near) / 2, (far + near) / 2


@pytest.mark.parametrize("seed", sampled(range(12), range(2)))
def test_every_place_on_the_arc_is_judged_as_its_motion_is(seed):
    variant = EXERCISE.variant(seed, "en")
    given = variant.given
    alpha = 360 * given["Q"] / (1 + given["Q"])
    told = {True: 0, False: 0}
    for beta in range(120, 176, 3):
        if beta + alpha - 180 >= 179:
            continue
        r1, r2, r3 = on_the_arc(given["r4"], given["psi"], alpha - 180, beta)
        if not (
            0 < r2 < min(r1, r3, given["r4"])
            and r1 + r2 + r3 + given["r4"] > 2 * (r2 + max(r1, r3, given["r4"]))
        ):
            continue
        swing, arc, mu = simulated(r1, r2, r3, given["r4"])
        does = abs(swing - given["psi"]) < 0.9 and abs(arc - alpha) < 0.9 and mu > given["mu_min"]
        fails = abs(swing - given["psi"]) > 1.1 or abs(arc - alpha) > 1.1 or mu < given["mu_min"] - 0.6
        if not does and not fails:
            continue
        verdict = variant.grade({"r1": r1, "r2": r2, "r3": r3})["r1"].verdict
        assert (verdict == "correct") == does, (beta, swing, arc, mu, verdict)
        told[does] += 1
    assert min(told.values()) >= 1
    assert sum(told.values()) >= 8


def test_what_is_told_is_the_motion_of_the_students_own_lengths():
    variant = EXERCISE.variant(2, "en")
    r4 = variant.given["r4"]
    lengths = {"r1": round(1.2 * r4), "r2": round(0.3 * r4), "r3": round(1.1 * r4)}
    swing, arc, mu = simulated(**lengths, r4=r4)
    feedback = variant.grade(lengths)["r1"].feedback
    found = [float(number) for number in re.findall(r"= ([\d.]+)°", feedback)]
    assert found == pytest.approx([swing, arc, mu], abs=0.06)


def test_a_linkage_and_its_mirror_in_size_are_told_apart():
    """The rocker is given: all lengths twice as long swing through another angle."""
    variant = EXERCISE.variant(0, "en")
    answer = variant.solution()
    right = {name: answer[name] for name in ("r1", "r2", "r3")}
    assert variant.grade(right)["r1"].verdict == "correct"
    assert variant.grade({n: 2 * v for n, v in right.items()})["r1"].points < 2
