"""Velocity polygon of six links: two bars that meet, then a rod and its slider (the supplementary
exercise)."""

import numpy as np

from coursework.kinematics.vectors import cross, dot
from coursework.model import Exercise

from .._drawn import (
    PAPER_MM,
    all_long,
    crank_turns_visibly,
    known,
    of_drawing,
    on_paper,
)
from ._six_bar import GIVEN, HELPERS, bars, crank_off_the_axes, figure, told_directions


def crank_not_square_to_the_coupler(pin_A, pin_B, r1):
    """Else who draws the velocity of A along the crank finds nothing that moves, and the drawing ends
    there."""
    crank, coupler = pin_A - 1j * r1, pin_B - pin_A
    return abs(dot(crank, coupler)) > 0.1 * abs(crank) * abs(coupler)


def vectors_are_long_enough_to_draw(p, a, ab, pv_b, bc, pv_c):
    """A quarter of the longest at least, that of the slider about B an eighth."""
    others = on_paper(a - p), ab, pv_b, pv_c
    return all_long(1 / 4, *others) & all_long(1 / 8, bc, *others)


def slider_moves_after_a_tilted_line(pin_A, pin_B, pin_P, r1):
    """Who tilts the line of B about A finds a velocity of the slider that can be seen all the same."""
    a, along, path, rod = (
        1j * (pin_A - 1j * r1),
        (pin_B - pin_A) * np.exp(-0.35j),
        1j * pin_B,
        1j * (pin_P - pin_B),
    )
    b = path * cross(1j * along, a) / cross(1j * along, path)
    return abs(b.real - b.imag * rod.real / rod.imag) > abs(a) / 8


def tells(r1, r2, r3, r4, r5, theta2, mode):
    return told_directions(bars(r1, r2, r3, r4, r5, theta2, mode))


EXERCISE = Exercise(
    given=GIVEN,
    helpers=HELPERS,
    constraints=(
        crank_turns_visibly,
        crank_off_the_axes,
        crank_not_square_to_the_coupler,
        slider_moves_after_a_tilted_line,
        vectors_are_long_enough_to_draw,
    ),
    parts=(
        *known("known_A", "known_BA", "known_B", "known_CB", "known_C", count=3),
        of_drawing("kv", "mm/s/mm"),
        of_drawing("p", kind="point"),
        of_drawing("a", kind="point", points=2),
        of_drawing("b", kind="point", points=3),
        of_drawing("c", kind="point", points=3),
        of_drawing("ab"),
        of_drawing("pv_b"),
        of_drawing("bc"),
        of_drawing("pv_c"),
        of_drawing("omega3", "rad/s"),
        of_drawing("omega4", "rad/s"),
        of_drawing("omega5", "rad/s"),
        of_drawing("r6_dot", "mm/s"),
    ),
    figure=figure,
    tells=tells,
    drawing_mm=PAPER_MM,
    version=2,
    symbols={
        "kv": "k_v",
        "p": "p_v",
        "ab": "a b",
        "pv_b": "p_v b",
        "bc": "b c",
        "pv_c": "p_v c",
        "r6_dot": "V_C",
    },
)
