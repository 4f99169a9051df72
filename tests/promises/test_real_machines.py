"""Real machines: each number that a lesson states is found again without the solver, and no number of a machine is typed by hand."""

from __future__ import annotations

import re

import numpy as np
import pytest

from coursework.course.lessons import lesson_file
from coursework.language.words import languages

LESSONS = {"real_machines_levers": 4}  #: and the machines of each
TURN = np.radians(np.arange(0.0, 360.0, 0.25))


def joined(A, C, a, c, side):
    """The point at a from A and at c from C, on the left of A -> C (1) or on the right (-1), by Pythagoras."""
    way = C - A
    along = (abs(way) ** 2 + a**2 - c**2) / (2 * abs(way))
    return A + way / abs(way) * (along + 1j * side * np.sqrt(a**2 - along**2))


def acute(first, second):
    """The least angle between two lines given as vectors, degrees."""
    return np.degrees(np.arcsin(abs((first * second.conjugate()).imag) / (abs(first) * abs(second)))).min()


def ends(wave):
    """The crank's angle from where a wave is least to where it is largest, degrees, and its extent."""
    return np.degrees(TURN[wave.argmax()] - TURN[wave.argmin()]) % 360, np.ptp(wave)


def levers():
    """The windscreen wiper by its triangles, the bus by its parallelogram, the lorry and the crane by energy."""
    A, C = 42 * np.exp(1j * TURN), -260.0
    B = joined(A, C, 257, 58, -1)
    forward, sweep = ends(np.unwrap(np.angle(B - C)))
    yield "wiper_r2 wiper_r3 wiper_r4 wiper_CD", (42, 257, 58, 480)
    yield "wiper_sweep wiper_forward", (np.degrees(sweep), forward)
    yield "wiper_least_mu", (acute(B - A, B - C),)
    yield "wiper_area", (sweep / 2 * (0.54**2 - 0.14**2),)
    A, C = 35 * np.exp(1j * TURN), 186j
    B = joined(A, C, 180, 60, -1)
    arm = np.unwrap(np.angle(B - C)) + np.radians(105)
    E = 420 * np.exp(1j * arm)
    yield "bus_r2 bus_r3 bus_r4 bus_L bus_b bus_blade", (35, 180, 60, 420, 90, 520)
    yield "bus_sweep bus_least_mu", (np.degrees(np.ptp(arm)), acute(B - A, B - C))
    yield "bus_travel bus_rise bus_tilt", (np.ptp(E.real), np.ptp(E.imag), 0)
    yield "bus_area", (0.52 * np.ptp(E.real) / 1000,)
    yield from lorry()
    yield from crane()


def lorry():
    foot = 900 - 600j
    spread = np.angle(1900) - np.angle(foot)
    tilt = np.arccos((1900**2 + abs(foot) ** 2 - 2080**2) / (2 * 1900 * abs(foot))) - spread
    angle = np.linspace(0, tilt, 400)
    head, load = 1900 * np.exp(1j * angle), (1.7 + 0.5j) * np.exp(1j * angle)
    # The work of the jack is that of the load: F dL = W dy.
    step = 1e-6
    nearer = abs(1900 * np.exp(1j * (angle - step)) - foot)
    arm = (abs(head - foot) - nearer) / step / 1000
    yield "tipper_a tipper_xC tipper_yC tipper_down tipper_up tipper_load", (1900, 900, 600, 1166, 2080, 100)
    yield (
        "tipper_tilt tipper_stroke tipper_ratio",
        (np.degrees(tilt), 2080 - abs(1900 - foot), 2080 / abs(1900 - foot)),
    )
    yield "tipper_first tipper_last", (100 * load[0].real / arm[0], 100 * load[-1].real / arm[-1])
    yield "tipper_arm_first tipper_arm_most tipper_arm_last", (arm[0], arm.max(), arm[-1])
    yield "tipper_x_first tipper_x_last", (load[0].real, load[-1].real)


def crane():
    luffed = np.radians(np.linspace(48, 90, 4201))
    A = 30 * np.exp(1j * luffed)
    B = joined(A, -3.8 + 8.5j, 4, 24.4, -1)
    P = A + (B - A) / 4 * 11.6 * np.exp(1j * np.radians(197))
    yield "crane_r2 crane_r3 crane_r4 crane_AP crane_low crane_high", (30, 4, 24.4, 11.6, 48, 90)
    yield "crane_near crane_far crane_height", (P.real.min(), P.real.max(), np.ptp(P.imag))
    # The work on the load, 100 kN: MN m for each radian of the jib.
    yield "crane_torque crane_plain", (0.1 * abs(np.gradient(P.imag, luffed)).max(), 0.1 * P.real.max())


FOUND = {"real_machines_levers": levers}


@pytest.mark.parametrize("lesson", LESSONS)
def test_each_number_of_a_machine_is_found_again_without_the_solver(course, lesson):
    stated = course.folder.lesson_module(lesson).values()
    found = {n: v for names, values in FOUND[lesson]() for n, v in zip(names.split(), values, strict=True)}
    assert set(found) == set(stated)
    digits = {n: len(text.partition(".")[2]) for n, text in stated.items()}
    wrong = {n: (text, found[n]) for n, text in stated.items() if f"{found[n] + 0.0:.{digits[n]}f}" != text}
    # A value at the edge between two roundings may fall on either side.
    wrong = {n: (t, v) for n, (t, v) in wrong.items() if abs(float(t) - v) > 0.51 * 10.0 ** -digits[n]}
    assert wrong == {}


@pytest.mark.parametrize("lesson", LESSONS)
def test_no_number_of_a_machine_is_typed_by_hand_and_all_machines_stand_in_every_language(course, lesson):
    stated = set(course.folder.lesson_module(lesson).values())
    for lang in languages():
        text = lesson_file(course.folder, lesson, lang).read_text("utf-8")
        assert set(re.findall(r"\{=(\w+)\}", text)) == stated, lang
        lessons_own = text.partition("\n## Questions")[0]
        assert re.findall(r"\\num\{[^}]*\}", lessons_own) == [], lang
        assert (
            len(re.findall(r"^!\[\(a\) .* \(b\) .*\]\(figure:\w+\?tall=\d+\)$", text, re.MULTILINE))
            == LESSONS[lesson]
        )
