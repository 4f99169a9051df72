"""Acceleration polygon of six links whose velocities are known: two bars that meet, then a rod and its slider."""

import numpy as np

from coursework.marking.drawn_polygons import scale_for
from coursework.model import Exercise, drawn

from .._drawn import PAPER_MM, all_long, known, of_drawing, told_number
from ._six_bar import (
    GIVEN,
    HELPERS,
    bars,
    crank_off_the_axes,
    figure,
    pin_A,
    pin_B,
    pin_P,
    rates,
    told_directions,
)


def sides(rates, accelerations, pin_A, pin_B, pin_P, r1):
    """Of A; of B about A, of B and of C about B, each normal then tangential; of C. Over omega2 squared."""
    crank, coupler, rod = pin_A - 1j * r1, pin_B - pin_A, pin_P - pin_B
    w3, w4, w5, _ = rates
    a3, a4, a5, of_C = accelerations
    return (
        -crank,
        -(w3**2) * coupler,
        1j * a3 * coupler,
        -(w4**2) * pin_B,
        1j * a4 * pin_B,
        -(w5**2) * rod,
        1j * a5 * rod,
        of_C,
    )


def vectors_are_long_enough_to_draw(sides):
    """An eighth of the longest at least, but for the normal ones and those of C about B."""
    of_A, _, tangential_BA, _, tangential_B, _, _, of_C = sides
    return all_long(1 / 8, of_A, tangential_BA, tangential_B, of_C)


def drawing_fills_its_paper(sides, omega2):
    """At its round scale the longest vector has 42 mm at least, and the shortest known ones 4.2."""
    of_A, normal_BA, _, normal_B, tangential_B, normal_C, _, of_C = (omega2**2 * side for side in sides)
    of_B = normal_B + tangential_B
    points = of_A, of_A + normal_BA, normal_B, of_B, of_B + normal_C, of_C + 0 * of_A
    lengths = [omega2**2 * abs(side) / scale_for(*points) for side in sides]
    shortest = np.minimum.reduce([lengths[k] for k in (1, 3, 5)])
    return (np.maximum.reduce(lengths) > 42) & (shortest > 4.2)


def tells(r1, r2, r3, r4, r5, theta2, omega2, mode):
    links = bars(r1, r2, r3, r4, r5, theta2, mode)
    A = pin_A(r1, r2, theta2)
    B = pin_B(A, r3, r4, mode)
    turning = rates(A, B, pin_P(B, r5), r1)[:3]
    speeds = (told_number(abs(omega2 * rate * bar)) for rate, bar in zip(turning, links[1:], strict=True))
    return told_directions(links) | dict(zip(("V_BA", "V_B", "V_CB"), speeds, strict=True))


EXERCISE = Exercise(
    given={**GIVEN, "omega2": drawn(4, 20, unit="rad/s")},
    helpers=(*HELPERS, sides),
    keep=(crank_off_the_axes, vectors_are_long_enough_to_draw, drawing_fills_its_paper),
    parts=(
        known("known_BA_n"),
        known("known_BA_t"),
        known("known_B_n"),
        known("known_C"),
        of_drawing("ka", "mm/s^2/mm"),
        of_drawing("p", kind="point"),
        of_drawing("a", kind="point", points=2),
        of_drawing("n", kind="point", points=2),
        of_drawing("m", kind="point", points=2),
        of_drawing("b", kind="point", points=3),
        of_drawing("f", kind="point", points=2),
        of_drawing("c", kind="point", points=3),
        of_drawing("bb_t"),
        of_drawing("pa_c"),
        of_drawing("alpha3", "rad/s^2"),
        of_drawing("r6_ddot", "mm/s^2"),
    ),
    figure=figure,
    tells=tells,
    drawing_mm=PAPER_MM,
    symbols={
        "ka": "k_a",
        "p": "p_a",
        "n": "b'",
        "m": "b''",
        "f": "c'",
        "bb_t": "b' b",
        "pa_c": "p_a c",
        "r6_ddot": "a_C",
    },
)
