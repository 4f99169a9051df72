"""Toggle press: positions, mechanical advantage and forces shortly before the two bars of the toggle are in
line."""

import numpy as np

from coursework.degrees import angle, cos, polar, sin, sqrt
from coursework.figures import (
    Figure,
    angle_mark,
    ground_pivot,
    line,
    link,
    pin,
    rail,
    rotation_arrow,
    slider,
    vector,
)
from coursework.kinematics.dyads import rrr, side_of
from coursework.kinematics.vectors import cross
from coursework.model import Driver, Exercise, Part, chosen, drawn, loop_equations


def crank_pivot(xO, yO):
    return xO + 1j * yO


def B(r4, phi):
    return -1j * r4 * polar(1, -phi)


def A(crank_pivot, B, r2, r3, A_side):
    return rrr(crank_pivot, B, r2, r3, side_of(A_side))


def C(B, r5):
    """Below B on the y axis."""
    return 1j * (B.imag - sqrt(r5**2 - B.real**2))


def theta2(A, crank_pivot):
    """Crank angle in the figure."""
    return angle(A - crank_pivot)


def with_the_crank_at(driven, crank_pivot, A, B, r2, r3, r4):
    """The same assembly at another crank angle, told as the data tell it."""
    crank_pin = crank_pivot + polar(r2, driven)
    knee = rrr(crank_pin, 0j, r3, r4, np.sign(cross(-A, B - A)))
    return {
        "phi": -angle(1j * knee),
        "A_side": np.where(cross(knee - crank_pivot, crank_pin - crank_pivot) > 0, "left", "right")[()],
    }


def _stretched(r2, r3, r4, yO, phi):
    """Position of O for which the crank, in line with the coupler, leaves the upper bar at this angle."""
    return -r4 * sin(phi) - sqrt((r2 + r3) ** 2 - (r4 * cos(phi) + yO) ** 2)


def farthest_pivot(r2, r3, r4, yO):
    return _stretched(r2, r3, r4, yO, 4.0)


def nearest_pivot(r2, r3, r4, yO):
    return _stretched(r2, r3, r4, yO, 1.0)


def crank_turns(crank_pivot, r2, r3, r4):
    """The crank is the shortest bar, and clears both of its aligned positions."""
    r1 = abs(crank_pivot)
    return (r2 < np.minimum(np.minimum(r1, r3), r4)) & (abs(r3 - r4) < r1 - r2) & (r1 + r2 < r3 + r4)


def crank_and_coupler_make_an_angle(crank_pivot, A, B):
    """Of 25 to 155 degrees at A: neither of the crank's dead points is near."""
    return abs(cross(A - crank_pivot, B - A)) > sin(25) * abs(A - crank_pivot) * abs(B - A)


def coupler_is_not_square_to_the_crank(crank_pivot, A, B):
    """Its distance from O is told from the length of the crank."""
    return abs(cross(A - crank_pivot, B - A)) < 0.97 * abs(A - crank_pivot) * abs(B - A)


def coupler_crosses_the_upper_bar(A, B):
    """At 45 to 135 degrees."""
    return abs(cross(B, B - A)) > sin(45) * abs(B) * abs(B - A)


def crank_is_clear_of_the_toggle(crank_pivot, A, r2, r4, r5):
    """On paper too."""
    return (crank_pivot.real < -1.6 * r2) & (crank_pivot.imag > -1.1 * r4) & (crank_pivot.imag < -0.3 * r4)


def bars_differ_visibly(psi, phi):
    """So that the second angle is not that of the first."""
    return abs(psi - phi) > 0.05 * psi + 0.2


def coupler_leans(A, B):
    """By 8 degrees at least, so that the two bars bear different forces."""
    coupler = B - A
    return abs(coupler.imag) > sin(8) * abs(coupler)


def ram_goes_down(v_C):
    return v_C < 0


def bars_bear_different_forces(F_4, F_5):
    return abs(F_4 / F_5 - 1) > 0.022


def figure(crank_pivot, A, B, C, r2, r4, r5, phi, omega2):
    O, D = crank_pivot, 0j
    turn = 40 if omega2 > 0 else -40
    away = angle(O - A)
    half_rail, push = 0.22 * r4, 0.3 * r4
    return Figure(
        rail(C - 1j * half_rail, C + 1j * half_rail),
        line(D, C, dashed=True),
        link(O, A, label="r_2"),
        link(A, B, label="r_3"),
        link(D, B, label="r_4"),
        link(B, C, label="r_5"),
        slider(C, 90),
        vector(C - 1j * (half_rail + push), 1j * push, "F"),
        ground_pivot(D, "D"),
        ground_pivot(O, "O"),
        pin(A, "A"),
        pin(B, "B"),
        pin(C, "C"),
        angle_mark(D, -90, -90 - phi, r"\varphi", radius=0.6 * r4),
        rotation_arrow(O, 1.3 * r2, away - turn, away + turn, label=r"\omega_2"),
    )


EXERCISE = Exercise(
    given={
        "r2": drawn(30, 80, step=1, unit="mm"),
        "r3": drawn(lambda r2: 3.5 * r2, lambda r2: 6 * r2, step=5, unit="mm", positive=True),
        "r4": drawn(lambda r2: 3 * r2, lambda r2: 5 * r2, step=5, unit="mm", positive=True),
        "r5": drawn(lambda r4: 0.75 * r4, lambda r4: 1.4 * r4, step=5, unit="mm", positive=True),
        "yO": drawn(lambda r4: -1.05 * r4, lambda r4: -0.5 * r4, step=5, unit="mm", positive=False),
        "xO": drawn(farthest_pivot, nearest_pivot, step=1, unit="mm", positive=False),
        "phi": drawn(3, 14, step=0.5, unit="deg"),
        "A_side": chosen("left", "right", shown=False),
        "omega2": drawn(-8, 8, step=0.5, unit="rad/s", nonzero=True),
        "F": drawn(5000, 40000, step=500, unit="N"),
    },
    helpers=(crank_pivot, B, A, C, theta2),
    constraints=(
        crank_turns,
        crank_and_coupler_make_an_angle,
        coupler_is_not_square_to_the_crank,
        coupler_crosses_the_upper_bar,
        crank_is_clear_of_the_toggle,
        bars_differ_visibly,
        coupler_leans,
        ram_goes_down,
        bars_bear_different_forces,
    ),
    parts=(
        Part("psi", unit="deg", atol=0.1, points=1),
        Part("yC", unit="mm", points=1),
        Part("theta2", unit="deg", kind="angle", points=2),
        Part("theta3", unit="deg", kind="angle", points=1),
        Part("v_C", unit="mm/s", points=2),
        Part("mechanical_advantage", points=1),
        Part("F_5", unit="N", points=1),
        Part("N_guide", unit="N", points=1),
        Part("F_4", unit="N", points=2),
        Part("torque", unit="N*m", points=2),
        *loop_equations(
            "loop_1",
            ("xO", "yO", "r2", "theta2", "r3", "theta3", "r4", "theta4"),
            rates=("omega2", "omega3", "omega4"),
        ),
        *loop_equations("loop_2", ("r4", "theta4", "r5", "theta5", "yC"), rates=("omega4", "omega5", "v_C")),
    ),
    effects=("load",),
    figure=figure,
    symbols={
        "xO": "x_O",
        "yO": "y_O",
        "yC": "y_C",
        "phi": r"\varphi",
        "psi": r"\psi",
        "mechanical_advantage": r"\lambda",
        "N_guide": "N",
        "torque": r"\Gamma",
    },
    driver=Driver("theta2", "omega2", effort="torque", output="v_C", poses=with_the_crank_at),
)
