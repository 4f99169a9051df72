"""Coriolis acceleration of a block on a guide that turns: how large, and which way? (Figures 24 and 25)."""

from dataclasses import replace

import numpy as np

from coursework.degrees import polar
from coursework.figures import (
    Figure,
    angle_mark,
    ground_pivot,
    line,
    note,
    point,
    rotation_arrow,
    slider,
    slot_link,
    vector,
)
from coursework.model import Exercise, Part, chosen, drawn


def guide_turns_visibly(omega):
    return abs(omega) >= 1


def block_slides_visibly(r_dot):
    return abs(r_dot) >= 20


def figure(theta, omega, r_dot):
    """Lengths are of no account; the senses of both motions are those of the data."""
    O, along, turn = 0j, polar(1.0, theta), np.sign(omega)
    C, P = 60 * along, 105 * along
    aside = 9j * turn * along
    return Figure(
        slot_link(O, 118 * along),
        line(O, 45, dashed=True),
        slider(C, theta),
        point(C, "C"),
        point(P, "P"),
        ground_pivot(O, "O"),
        note(126 * along, "4"),
        note(C - 1.1 * aside, "3"),
        vector(C + aside, 24 * np.sign(r_dot) * along, r"\dot{r}"),
        rotation_arrow(O, 75, theta + 14 * turn, theta + 40 * turn, r"\omega"),
        angle_mark(O, 0, theta, r"\theta", radius=24),
    )


EXERCISE = Exercise(
    given={
        "omega": drawn(-20, 20, unit="rad/s", nonzero=True),
        "r_dot": drawn(-500, 500, step=10, unit="mm/s", nonzero=True),
        "theta": drawn(-175, 180, step=5, unit="deg"),
        "points": replace(
            chosen("C3_C3", "C4_P4", "C3_C4", "C3_P4", shown=("relative_motion",)), default="C3_C4"
        ),
    },
    constraints=(guide_turns_visibly, block_slides_visibly),
    parts=(
        Part("a_coriolis", unit="mm/s^2", points=2),
        Part("direction", unit="deg", kind="angle", points=2),
        Part(
            "relative_motion",
            kind="choice",
            choices=(
                "same_point_same_body",
                "different_points_same_body",
                "same_point_different_bodies",
                "different_points_different_bodies",
            ),
            points=1,
        ),
    ),
    figure=figure,
    symbols={"a_coriolis": "a_c", "direction": r"\theta_c", "points": r"\mathrm{points}"},
)
