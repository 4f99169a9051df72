"""Havens planetary gear: velocities, by composition of motions and by a rolling contact (our own layout)."""

import numpy as np

from coursework.degrees import polar
from coursework.figures import (
    Figure,
    angle_mark,
    circle,
    contact,
    ground_pivot,
    line,
    link,
    note,
    pin,
    slot_link,
    vector,
)
from coursework.model import Driver, Exercise, Part, detectable, drawn, in_turn, loop_equations

REASONS = ("fixed_pivot", "slot", "translation", "composition", "no_slip")


def arm(d, r2, r3, theta1):
    """Vector O4A1."""
    return d + polar(r2 + r3, theta1)


def guide_turns_fully(d, r2, r3):
    return (0.15 * (r2 + r3) < d) & (d < 0.8 * (r2 + r3))


def crank_off_the_axes(theta1):
    return theta1 % 90 != 0


def crank_turns_visibly(omega1):
    return abs(omega1) >= 2


def figure(arm, d, r2, r3, b, theta1, omega1):
    O4, O1, e = complex(-d), 0j, r2 + r3
    A1, along = polar(e, theta1), arm / abs(arm)
    B2, I = A1 + b * along, polar(r3, theta1)
    end = B2 + 0.25 * e * along
    return Figure(
        slot_link(O4, end),
        circle(O1, r3, label="3"),
        circle(A1, r2, label="2"),
        line(O1, 0.7 * e, dashed=True),
        link(O1, A1, label="1"),
        vector(A1, 0.75j * np.sign(omega1) * A1, "V"),
        contact(I, "I"),
        ground_pivot(O4, "O_4"),
        ground_pivot(O1, "O_1"),
        pin(A1, "A_1"),
        pin(B2, "B_2"),
        note(end + 0.1 * e * along, "4"),
        angle_mark(O1, 0, theta1, r"\theta_1", radius=0.55 * r3),
    )


def guide_turns_visibly(omega4, omega1):
    return abs(omega4) > 0.1 * abs(omega1)


def block_slides_visibly(v_slide, e, omega1):
    return abs(v_slide) > 0.12 * e * abs(omega1)


def pinion_turns_visibly(omega3, omega1):
    return abs(omega3) > 0.3 * abs(omega1)


def B2_moves_visibly(v_B2_x, v_B2_y, e, omega1):
    least = 0.1 * e * abs(omega1)
    return (abs(v_B2_x) > least) & (abs(v_B2_y) > least)


OF_B2 = ("v_B2_x", "v_B2_y")


def _reason(quantity):
    return Part(quantity, kind="choice", choices=REASONS, points=1)


EXERCISE = Exercise(
    given={
        "d": drawn(10, 80, unit="mm"),
        "r2": drawn(24, 60, step=2, unit="mm"),
        "r3": drawn(14, 40, step=2, unit="mm"),
        "b": drawn(10, 50, step=2, unit="mm"),
        "theta1": drawn(-175, 180, step=5, unit="deg"),
        "omega1": drawn(-20, 20, unit="rad/s"),
    },
    helpers=(arm,),
    constraints=(
        guide_turns_fully,
        crank_off_the_axes,
        crank_turns_visibly,
        guide_turns_visibly,
        block_slides_visibly,
        pinion_turns_visibly,
        B2_moves_visibly,
        detectable("omega2_is_omega1", "omega2", "omega3"),
        detectable("willis_no_arm", "omega3"),
        *(detectable(mistake, *OF_B2) for mistake in ("B2_with_crank", "B2_guide_only", "slide_sign")),
        detectable("cosine_rule_sign", "rA", "omega4", "omega3", *OF_B2),
        detectable("guide_angle_from_O1", "theta4", "omega4", "omega3", *OF_B2),
    ),
    parts=(
        *in_turn(
            3,
            ("r2", "theta1", "omega1"),
            Part("nature_42", kind="choice", choices=("rotation", "translation", "general"), shuffled=True),
            *map(_reason, ("why_v_40_A1", "why_v_14_A1", "why_v_24_B2", "why_v_20_B2", "why_v_30_I")),
        ),
        Part("theta4", unit="deg", kind="angle", points=1),
        Part("rA", unit="mm", points=1),
        Part("omega4", unit="rad/s", points=1),
        Part("omega2", unit="rad/s", points=1),
        Part("v_A1_4", unit="mm/s", points=1),
        Part("v_slide", unit="mm/s", points=1),
        Part("v_B2_x", unit="mm/s", points=1),
        Part("v_B2_y", unit="mm/s", points=1),
        Part("omega3", unit="rad/s", points=2),
        Part("v_I", unit="mm/s", points=1),
        *loop_equations("loop_1", ("d", "r2", "r3", "theta1", "rA", "theta4")),
    ),
    figure=figure,
    version=2,
    symbols={
        "v_A1_4": "V_{4/0}(A_1)",
        "v_slide": "V_{1/4}(A_1)",
        "v_B2_x": "v_{B_2,x}",
        "v_B2_y": "v_{B_2,y}",
    },
    driver=Driver("theta1", "omega1", output="v_slide"),
)
