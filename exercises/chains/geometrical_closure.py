"""A crank whose ball moves a fork about an axis at right angles: geometrical closure, and the law of a zero
product."""

import numpy as np

from coursework.degrees import cos, polar, sin
from coursework.figures import (
    Figure,
    angle_mark,
    ball,
    centre_line,
    circle,
    dimension,
    ground_pivot,
    line,
    link,
    point,
    slot_link,
    vector,
)
from coursework.model import Driver, Exercise, Part, drawn, in_turn

LENGTHS = ("R", "h", "e")


def across(R, e, theta1):
    """Distance of the ball from the output axis along y."""
    return R * sin(theta1) - e


def axis_offset_is_visible(R, e):
    return (abs(e) > 0.15 * R) & (abs(e) < 0.7 * R)


def crank_off_the_axes(theta1):
    return theta1 % 90 >= 10


def fork_leans_visibly(across, h):
    return abs(across) > 0.12 * h


def fork_turns_visibly(R, h, theta1, across):
    return R * h * abs(cos(theta1)) > 0.08 * (h**2 + across**2)


def lean_of_the_fork_tells_in_the_rate(across, h):
    """Or a fork whose square of the cosine is near 1 would hide that it is left out."""
    return across**2 > 0.03 * h**2


def figure(across, R, h, e, theta1):
    """Above, seen along the output axis; below, seen along the input axis."""
    C, A = e - 1j * h, complex(across + e)
    reach = 1.12 * float(np.hypot(R + abs(e), h))
    along = (A - C) / abs(A - C)
    top = -1j * (h + 1.9 * R)
    seen = top + polar(R, theta1 - 90)
    return Figure(
        centre_line(-1.35 * R, 1.35 * R),
        vector(-1.9 * R - 1j * h, 0.45 * R, "y"),
        vector(-1.9 * R - 1j * h, 0.45j * R, "z"),
        line(C, C + 0.6j * h, dashed=True),
        slot_link(C, C + reach * along),
        ball(A, 0.09 * R),
        point(A, "A"),
        ground_pivot(C, "C"),
        angle_mark(C, 90, 90 + float(np.degrees(np.arctan2(-across, h))), r"\theta_3", radius=0.5 * h),
        dimension(1.5 * R - 1j * h, 1.5 * R + 0j, "h", offset=0),
        centre_line(-1j * h - 0.8j * R, 0.35j * R),
        circle(top, R, dashed=True),
        line(top, top - 1.3j * R, dashed=True),
        vector(top - 1.9 * R + 0.5j * R, 0.45 * R, "y"),
        vector(top - 1.9 * R + 0.5j * R, -0.45j * R, "x"),
        slot_link(complex(A.real, top.imag) + 1.25j * R, complex(A.real, top.imag) - 1.25j * R),
        link(top, seen, label="R"),
        ball(seen, 0.09 * R),
        point(seen, "A"),
        point(top, "O"),
        angle_mark(top, -90, theta1 - 90, r"\theta_1", radius=0.45 * R),
        paper_mm=(110, 120),
    )


EXERCISE = Exercise(
    given={
        "R": drawn(30, 80, step=1, unit="mm"),
        "h": drawn(lambda R: 1.1 * R, lambda R: 2.2 * R, step=1, unit="mm", positive=True),
        "e": drawn(-50, 50, step=1, unit="mm"),
        "theta1": drawn(-175, 180, step=5, unit="deg"),
        "omega1": drawn(-30, 30, unit="rad/s", nonzero=True),
    },
    helpers=(across,),
    constraints=(
        axis_offset_is_visible,
        crank_off_the_axes,
        fork_leans_visibly,
        fork_turns_visibly,
        lean_of_the_fork_tells_in_the_rate,
    ),
    parts=(
        *in_turn(
            1,
            ("R", "h", "theta1"),
            Part("perpendicular", kind="choice", choices=("x3", "y3", "z3"), points=1),
            Part("angular", kind="choice", choices=("contact", "sum", "law"), points=1),
        ),
        Part("closure_y", kind="equation", variables=(*LENGTHS, "q", "theta1", "theta3"), points=1),
        Part("closure_z", kind="equation", variables=(*LENGTHS, "q", "theta1", "theta3"), points=1),
        Part("law", kind="equation", variables=(*LENGTHS, "theta1", "theta3"), parameters=LENGTHS, points=2),
        Part("theta3", unit="deg", kind="angle", points=2),
        Part("q", unit="mm", points=1),
        Part("closure_angle", kind="equation", variables=("theta1", "theta3", "epsilon"), points=1),
        Part("epsilon", unit="deg", points=1),
        Part(
            "law_dot",
            kind="equation",
            variables=(*LENGTHS, "theta1", "omega1", "omega3"),
            parameters=LENGTHS,
            points=2,
        ),
        Part("omega3", unit="rad/s", points=2),
        Part("ratio", points=1),
        Part("swing", unit="deg", points=1),
    ),
    figure=figure,
    version=3,
    symbols={
        "perpendicular": r"\mathrm{perpendicular}",
        "angular": r"\mathrm{angular}",
        "closure_angle": r"\mathrm{closure}_{\varepsilon}",
        "closure_y": r"\mathrm{closure}_y",
        "closure_z": r"\mathrm{closure}_z",
        "law": r"\mathrm{law}",
        "law_dot": r"\mathrm{derivative}",
        "ratio": r"\rho",
        "swing": r"\Delta\theta_3",
    },
    driver=Driver("theta1", "omega1", output="omega3"),
)
