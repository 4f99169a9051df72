"""Acceleration polygon of six links whose velocities are known: two bars that meet, then a rod and its
slider."""

import numpy as np

from coursework.degrees import angle
from coursework.kinematics.angles import Degrees
from coursework.kinematics.four_bar import FourBar
from coursework.kinematics.slider_crank import SliderCrank
from coursework.model import Exercise, drawn

from .._drawn import (
    PAPER_MM,
    all_long,
    known,
    of_drawing,
    on_paper,
    told_number,
)
from ._six_bar import (
    GIVEN,
    HELPERS,
    bars,
    crank_off_the_axes,
    figure,
    told_directions,
)


def vectors_are_long_enough_to_draw(p, a, b, m, bb_t, pa_c):
    """An eighth of the longest at least, but for the normal ones and those of C about B."""
    return all_long(1 / 8, on_paper(a - p), bb_t, on_paper(b - m), pa_c)


def drawing_fills_its_paper(p, a, n, m, b, f, c, bb_t, pa_c):
    """At its round scale the longest vector has 42 mm at least, and the shortest known ones 4.2."""
    normal = [on_paper(side) for side in (n - a, m - p, f - b)]
    others = [on_paper(side) for side in (a - p, b - m, c - f)]
    return (np.maximum.reduce([*normal, *others, bb_t, pa_c]) > 42) & (np.minimum.reduce(normal) > 4.2)


def tells(r1, r2, r3, r4, r5, theta2, omega2, mode):
    links = bars(r1, r2, r3, r4, r5, theta2, mode)
    pose = FourBar(r1, r2, r3, r4, mode).at(Degrees.between(-90.0, theta2))
    omega3, omega4 = pose.coupler_ratio * omega2, pose.rocker_ratio * omega2
    rod = SliderCrank(r4, r5).motion(Degrees(angle(links[2])), omega4, order=1)
    return told_directions(links) | {
        "V_BA": told_number(abs(omega3 * r3)),
        "V_B": told_number(abs(omega4 * r4)),
        "V_CB": told_number(abs(rod.rod_rate * r5)),
    }


EXERCISE = Exercise(
    given={**GIVEN, "omega2": drawn(4, 20, unit="rad/s")},
    helpers=HELPERS,
    constraints=(
        crank_off_the_axes,
        vectors_are_long_enough_to_draw,
        drawing_fills_its_paper,
    ),
    parts=(
        *known("known_BA_n", "known_BA_t", "known_B_n", "known_C"),
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
    version=2,
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
