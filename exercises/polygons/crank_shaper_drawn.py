"""Crank and slotted lever, solved on paper: velocity and acceleration of the ram from two polygons (Figure
27's exercise)."""

from typing import Any, NamedTuple

import numpy as np

from coursework.degrees import angle, asin
from coursework.figures import (
    Figure,
    angle_mark,
    centre_line,
    circle,
    ground_pivot,
    line,
    link,
    note,
    pin,
    rail,
    slider,
    slot_link,
)
from coursework.kinematics.dyads import rrp
from coursework.model import Exercise, Part, drawn

from .._drawn import (
    all_long,
    crank_turns_visibly,
    guided,
    of_drawing,
    on_paper,
    told_angle,
    told_number,
)


class Ram(NamedTuple):
    """Vectors OD and DE."""

    lever: Any
    rod: Any


def ram(guided, r4, r5, h):
    lever = r4 * guided.along
    return Ram(lever, rrp(lever, r5, h) - lever)


def crank_off_the_axes(theta2):
    return theta2 % 90 >= 5


def lever_swings_and_carries_P(r1, r2, r4):
    return (r2 < 0.6 * r1) & (r1 + r2 < 0.95 * r4)


def rod_reaches_with_room(r1, r2, r4, r5, h):
    lowest = r4 * np.sqrt(np.maximum(1 - (r2 / r1) ** 2, 0))
    return r5 > 1.3 * np.maximum(abs(h - r4), abs(h - lowest))


def rod_never_in_line_with_the_lever(r1, r2, r4, r5, h):
    """The line O-E of a rod stretched out is flatter than the lever ever is."""
    return asin(h / (r4 + r5)) < 87 - asin(np.minimum(r2 / r1, 1))


def velocities_are_long_enough_to_draw(p, a, b, d, e, pv_b, pv_e):
    of_P2, sliding, of_D, of_rod = map(on_paper, (a - p, a - b, d - p, e - d))
    return all_long(1 / 6, of_P2, pv_b, sliding, of_D, pv_e) & all_long(1 / 12, of_rod, of_P2, pv_b, of_D)


def accelerations_are_long_enough_to_draw(q, a2, k, n, b2, d2, m, e2, pa_e):
    others = *map(on_paper, (a2 - q, a2 - k, b2 - n, b2 - k, d2 - q)), pa_e
    return all_long(1 / 6, *others) & all_long(1 / 15, on_paper(n - q), on_paper(e2 - m), *others)


def tells(r1, r2, r4, r5, h, theta2):
    pose = guided(r1, r2, theta2)
    return {
        "theta4": told_angle(pose.arm),
        "OP": told_number(abs(pose.arm)),
        "theta5": told_angle(ram(pose, r4, r5, h).rod),
    }


def figure(guided, ram, r1, r2, r4, theta2):
    O, C, P = 0j, 1j * r1, guided.arm
    D, E, half_rail = ram.lever, ram.lever + ram.rod, 0.4 * r2
    return Figure(
        circle(C, r2, dashed=True),
        rail(E - half_rail, E + half_rail),
        slot_link(O, 1.06 * D),
        link(C, P),
        link(D, E),
        centre_line(O, max(E.real, 0.0) + 0.3 * r4, label="x"),
        line(C, C + 1.6 * r2, dashed=True),
        angle_mark(C, 0, theta2, r"\theta_2", radius=1.3 * r2),
        slider(P, angle(P), label="P"),
        note(E + half_rail, "y=h"),
        slider(E, 0, label="E"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(P),
        pin(D, "D"),
        pin(E),
    )


def _point(quantity, points=1):
    return of_drawing(quantity, kind="point", points=points)


EXERCISE = Exercise(
    given={
        "r1": drawn(190, 260, step=5, unit="mm"),
        "r2": drawn(90, 125, step=5, unit="mm"),
        "r4": drawn(380, 460, step=10, unit="mm"),
        "r5": drawn(140, 220, step=5, unit="mm"),
        "h": drawn(lambda r4: r4 - 60, lambda r4: r4, step=5, unit="mm", positive=True),
        "theta2": drawn(-175, 180, step=5, unit="deg"),
        "omega2": drawn(-12, 12, unit="rad/s"),
    },
    helpers=(guided, ram),
    constraints=(
        crank_turns_visibly,
        crank_off_the_axes,
        lever_swings_and_carries_P,
        rod_reaches_with_room,
        rod_never_in_line_with_the_lever,
        velocities_are_long_enough_to_draw,
        accelerations_are_long_enough_to_draw,
    ),
    parts=(
        of_drawing("kv", "mm/s/mm"),
        _point("p"),
        _point("a"),
        _point("b", 2),
        _point("d"),
        _point("e", 2),
        of_drawing("pv_b"),
        of_drawing("pv_e"),
        of_drawing("omega4", "rad/s"),
        of_drawing("v_C", "mm/s"),
        of_drawing("ka", "mm/s^2/mm"),
        _point("q"),
        _point("a2"),
        _point("k", 2),
        _point("n"),
        _point("b2", 2),
        _point("d2"),
        _point("m"),
        _point("e2", 2),
        of_drawing("pa_e"),
        of_drawing("a_C", "mm/s^2"),
        Part("alpha", unit="deg", atol=2.0),
        Part("beta", unit="deg", atol=2.0),
        Part("Q", rtol=0.03),
        Part("mechanical_advantage", rtol=0.1),
    ),
    figure=figure,
    tells=tells,
    drawing_mm=(160, 180),
    symbols={
        "r1": "OC",
        "r2": "CP",
        "r4": "OD",
        "r5": "DE",
        "kv": "k_v",
        "p": "p_v",
        "a": "p_2",
        "b": "p_4",
        "pv_b": "p_v p_4",
        "pv_e": "p_v e",
        "v_C": "V_E",
        "alpha": r"\theta_a",
        "beta": r"\theta_r",
        "ka": "k_a",
        "q": "p_a",
        "a2": "p_2",
        "n": "p_4'",
        "b2": "p_4",
        "d2": "d",
        "m": "e'",
        "e2": "e",
        "pa_e": "p_a e",
        "a_C": "a_E",
        "mechanical_advantage": r"\lambda",
    },
)
