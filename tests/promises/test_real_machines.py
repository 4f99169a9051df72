"""Real machines: each number that a lesson states is found again without the solver, and no number of a
machine is typed by hand."""

from __future__ import annotations

import re

import numpy as np
import pytest

from coursework.authoring.linkage_files import LINKAGES
from coursework.course.lessons import lesson_file
from coursework.language.words import languages
from coursework.linkages.compiled import compiled
from coursework.structure.assour import roman

#: And the machines of each.
LESSONS = {
    "real_machines_levers": 4,
    "real_machines_paths": 4,
    "real_machines_strokes": 4,
}
TURN = np.radians(np.arange(0.0, 360.0, 0.25))


def joined(A, C, a, c, side):
    """The point at a from A and at c from C, on the left of A -> C (1) or on the right (-1), by
    Pythagoras."""
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
    """The windscreen wiper by its triangles, the bus by its parallelogram, the lorry and the crane by
    energy."""
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
    # With equal times the least angle has the cosine (r1 / r3) sin 55 degrees.
    r2 = 50 * np.sin(np.radians(55))
    r3 = np.sqrt(150**2 + r2**2 - 50**2)
    mu = np.degrees(np.arccos(150 / r3 * np.sin(np.radians(55))))
    yield "design_r2 design_r3 design_mu", (r2, r3, mu)


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
    yield (
        "crane_r2 crane_r3 crane_r4 crane_AP crane_load crane_low crane_high",
        (30, 4, 24.4, 11.6, 100, 48, 90),
    )
    yield "crane_near crane_far crane_height", (P.real.min(), P.real.max(), np.ptp(P.imag))
    # The work on the load, 100 kN: MN m for each radian of the jib.
    yield "crane_torque crane_plain", (0.1 * abs(np.gradient(P.imag, luffed)).max(), 0.1 * P.real.max())


def swept(wave):
    """How far an angle swings, degrees."""
    return np.degrees(np.ptp(np.unwrap(wave)))


def paths():
    """Claw, pusher and toy by Pythagoras, the pump by the law of its inversion."""
    A, C = 8 * np.exp(1j * TURN), -22.9 + 11.2j
    B = joined(A, C, 18.2, 16.4, -1)
    P = A + (B - A) / 18.2 * 16 * np.exp(-1j * np.radians(70))
    holds = P[P.real > P.real.max() - 1.3]
    share = len(holds) / len(P)
    yield "claw_r2 claw_r3 claw_r4 claw_AP claw_depth", (8, 18.2, 16.4, 16, 1.3)
    yield "claw_pitch claw_share", (np.ptp(holds.imag), 100 * share)
    yield "claw_moves claw_stands", (1000 * share / 24, 1000 * (1 - share) / 24)
    P = hoecken(TURN)
    level = hoecken(np.radians(np.linspace(80, 280, 801)))
    steady = np.radians(np.linspace(105, 255, 601))
    speed = abs(np.gradient(hoecken(steady).real, steady, edge_order=2))
    yield "pusher_r2 pusher_r1 pusher_r3 pusher_AP pusher_share", (50, 100, 125, 250, 100 * 200 / 360)
    yield "pusher_length pusher_off", (np.ptp(level.real), np.ptp(level.imag))
    grown = 300 / np.ptp(level.real)
    yield "design_r2 design_off", (50 * grown, np.ptp(level.imag) * grown)
    yield "pusher_lift pusher_speed", (np.ptp(P.imag), 100 * (1 - speed.min() / speed.max()))
    A = 150 + 150 * np.exp(1j * np.radians(np.linspace(-45, 45, 361)))
    P = (500**2 - 230**2) / A.conjugate()
    half = np.arccos(abs(P - A) / 2 / 230)  # of the rhombus, at P
    crossed = np.degrees(np.minimum(2 * half, np.pi - 2 * half)).min()
    yield "pump_r2 pump_a pump_b pump_product", (150, 500, 230, 0.5**2 - 0.23**2)
    yield "pump_line pump_stroke pump_swing pump_least", (P.real.mean(), np.ptp(P.imag), 90, crossed)
    yield from toy()


def hoecken(theta):
    A = 50 * np.exp(1j * theta)
    return 2 * joined(A, 100.0, 125, 125, 1) - A


def corner(beside, other, opposite):
    """The angle of a triangle between two sides, radians."""
    return np.arccos((beside**2 + other**2 - opposite**2) / (2 * beside * other))


def toy():
    C, B, D = 15 * np.exp(1j * TURN), -38.8 - 12.5j, -14.6 + 41.9j
    H = joined(C, B, 38.8, 23.7, -1)
    # The plate CHF is turned from CH by the angle at C; the leg FEG from EF by the angle at E.
    F = C + (H - C) / 38.8 * 73.4 * np.exp(1j * corner(38.8, 73.4, 35.2))
    E = joined(F, D, 57.7, 34.1, 1)
    G = E + (F - E) / 57.7 * 111.7 * np.exp(1j * corner(57.7, 111.7, 59))
    bears = G[G.imag < G.imag.min() + 3]
    yield "toy_r2 toy_tread toy_share", (15, 3, 100 * len(bears) / len(G))
    yield "toy_stride toy_lift toy_width", (np.ptp(bears.real), np.ptp(G.imag), np.ptp(G.real))
    yield "toy_rocker", (swept(np.angle(H - B)),)


def strokes():
    """The shaper by its triangle, the needle by its sine, the engine by its toggle, the cross by its closed
    forms."""
    A = 250j + 100 * np.exp(1j * TURN)
    D = 560 * A / abs(A)
    x = D.real - np.sqrt(180**2 - (D.imag - 480) ** 2)
    cut = (np.degrees(TURN[x.argmin()] - TURN[x.argmax()])) % 360
    speed = 6 * np.gradient(np.append(x, x[:2]), TURN[1] - TURN[0])[1:-1] / 1000
    yield "shaper_r1 shaper_r5 shaper_r6 shaper_h shaper_r2 shaper_speed", (250, 560, 180, 480, 100, 6)
    yield "shaper_swing shaper_stroke", (2 * np.degrees(np.arcsin(0.4)), np.ptp(x))
    yield "shaper_cut shaper_Q", (cut, (90 + np.degrees(np.arcsin(0.4))) / (90 - np.degrees(np.arcsin(0.4))))
    yield "shaper_forward shaper_back", (-speed.min(), speed.max())
    yield "design_Q design_stroke", (2, 450)
    yield from needle()
    yield from engine()
    yield from cross()
    # Each scheme of the figure, counted by hand: a jack is two bodies and a slide.
    for letter, bodies, pairs in zip(
        "abcdefgh", (3, 3, 3, 5, 5, 5, 7, 7), (4, 4, 4, 7, 7, 7, 10, 10), strict=True
    ):
        yield f"{letter}_bodies {letter}_pairs", (bodies, pairs)


def needle():
    down = -15.5 * np.sin(TURN) + np.sqrt(48**2 - (15.5 * np.cos(TURN)) ** 2)
    speed = 100 * np.gradient(np.append(down, down[:2]), TURN[1] - TURN[0])[1:-1] / 1000
    F, G = 12 * np.exp(1j * (TURN + np.radians(38))), -24 + 17j
    D = joined(F, G, 20.5, 27, -1)
    eye = (F + (D - F) / 20.5 * 74 * np.exp(1j * np.radians(41))).imag
    least, most, low = (np.degrees(TURN[k]) for k in (eye.argmin(), eye.argmax(), down.argmax()))
    yield "needle_r2 needle_r3 needle_OF needle_stroke", (15.5, 48, 12, 31)
    yield "needle_turns needle_share", (100 * 30 / np.pi, 100 * np.mean(-down - 68 < -116))
    yield "needle_speed", (abs(speed).max(),)
    yield "needle_low needle_high", (155 * (1 + 15.5 / 48), 155 * (1 - 15.5 / 48))
    yield "eye_lift eye_late eye_rise", (np.ptp(eye), (least - low) % 360, (most - least) % 360)


def engine():
    C = -106.5 + 187.7j
    A = 88.5 * np.exp(1j * TURN)
    B = joined(A, C, 200, 120, -1)
    swung = np.angle(B - C)
    drawn_back = [
        120 * np.cos(a) + np.sqrt(200**2 - (120 * np.sin(a)) ** 2) for a in (swung.max(), swung.min())
    ]
    full, part = sorted((320 - x for x in drawn_back), reverse=True)
    yield "engine_r2 engine_r3 engine_r4 engine_r5 engine_strokes", (88.5, 200, 120, 200, 4)
    yield "engine_swing engine_long engine_short", (swept(swung), full, part)
    yield "engine_ratio engine_least_mu", (full / part, acute(B - A, B - C))


def cross():
    ratio = np.sqrt(0.5)
    theta = np.radians(np.linspace(-45, 45, 3601))
    omega = ratio * (np.cos(theta) - ratio) / (1 - 2 * ratio * np.cos(theta) + ratio**2)
    alpha = np.gradient(omega, theta, edge_order=2)
    yield "cross_r1 cross_r2 cross_frames cross_teeth cross_pitch", (40, 40 * ratio, 24, 16, 4.75)
    yield "cross_film cross_share cross_moves cross_stands", (19, 25, 250 / 24, 750 / 24)
    yield "cross_fast cross_entry cross_peak", (ratio / (1 - ratio), 1, abs(alpha).max())
    yield "cross_film_speed", (ratio / (1 - ratio) * 24 * 16 * 4.75 / 1000,)


FOUND = {"real_machines_levers": levers, "real_machines_paths": paths, "real_machines_strokes": strokes}


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


def test_the_classes_of_the_schemes_without_a_name_are_those_of_their_groups(course):
    name = "real_machines_strokes"
    schemes = [name for name, _ in course.folder.lesson_module(name).NAMELESS]
    right = [roman(compiled(LINKAGES / "exercises" / f"{scheme}.toml").formulas.rank) for scheme in schemes]
    for lang in languages():
        text = lesson_file(course.folder, name, lang).read_text("utf-8")
        assert re.findall(r"^\| \([a-h]\) .* (I+) \|$", text, re.MULTILINE) == right, lang


def test_the_answers_to_figures_to_identify_are_those_of_the_solver(course):
    """Figures of other lessons that ask for a class or a type of linkage."""

    def answer(lesson, figure, lang):
        text = lesson_file(course.folder, lesson, lang).read_text("utf-8")
        return text.partition(f"(figure:{figure}")[2].partition("```answer")[2].partition("```")[0]

    schemes = [name for name, _ in course.folder.lesson_module("mobility_and_groups").UNNAMED]
    classes = [roman(compiled(LINKAGES / "exercises" / f"{name}.toml").formulas.rank) for name in schemes]
    linkages = course.folder.lesson_module("grashof_and_coupler_curves").UNNAMED
    lengths = [dict(zip(("r1", "r2", "r3", "r4"), bars, strict=True)) for bars, _ in linkages]
    kinds = [
        course["four_bar_positions"].solve(**bars, theta2=at, only="linkage_type")["linkage_type"]
        for bars, (_, at) in zip(lengths, linkages, strict=True)
    ]
    for lang in languages():
        told = answer("mobility_and_groups", "schemes_to_be_counted", lang)
        assert re.findall(r": classe? (I+)\.", told) == classes, lang
    told = answer("grashof_and_coupler_curves", "types_to_be_named", "en").replace("double ", "double-")
    named = re.findall(r"(?:double-|triple |crank-|rocker-)(?:rocker|crank)|change point", told)
    assert [name.replace(" ", "-") for name in named] == kinds


@pytest.mark.parametrize("lesson", LESSONS)
def test_no_number_of_a_machine_is_typed_by_hand_and_all_machines_stand_in_every_language(course, lesson):
    stated = set(course.folder.lesson_module(lesson).values())
    for lang in languages():
        text = lesson_file(course.folder, lesson, lang).read_text("utf-8")
        assert set(re.findall(r"\{=(\w+)\}", text)) == stated, lang
        lessons_own = text.partition("\n## Questions")[0]
        assert re.findall(r"\\num\{[^}]*\}", lessons_own) == [], lang
        assert (
            len(
                re.findall(r"^!\[\(a\) (?!.*\(c\)).* \(b\) .*\]\(figure:\w+\?tall=\d+\)$", text, re.MULTILINE)
            )
            == LESSONS[lesson]
        )
