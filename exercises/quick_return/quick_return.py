"""Quick return with crank and rocker: velocity, acceleration, stroke and time ratio (Figure 27)."""

import numpy as np

from coursework.degrees import acos, angle, asin, cos, polar, sin, wrap
from coursework.figures import (
    Figure,
    angle_mark,
    arc,
    centre_line,
    circle,
    ground_pivot,
    line,
    link,
    note,
    pin,
    rail,
    rotation_arrow,
    slider,
)
from coursework.kinematics.dyads import rrp, rrr, side_of
from coursework.kinematics.vectors import cross
from coursework.model import Driver, Exercise, Part, chosen, drawn, loop_equations

#: Symbols of what every quick return asks of the working stroke and of the return.
OF_BOTH_STROKES = {
    "xC": "x_C",
    "stroke": "s",
    "alpha": r"\theta_a",
    "beta": r"\theta_r",
    "t_advance": "t_a",
    "t_return": "t_r",
}


def B(r1, theta1, r2, r3, r4, angle_OAB, B_side):
    OB = abs(r2 - polar(r3, angle_OAB))
    return rrr(0j, polar(r1, theta1), OB, r4, side_of(B_side))


def A(B, r2, r3, A_side):
    return rrr(0j, B, r2, r3, side_of(A_side))


def C(B, r5, h):
    return rrp(B, r5, h)


def theta2(A):
    """Crank angle in the figure."""
    return angle(A)


def with_the_crank_at(driven, A, B, r1, theta1, r2, r3, r4):
    """The same assembly at another crank angle, told as the data tell it."""
    D = polar(r1, theta1)
    crank = polar(r2, driven)
    pin_B = rrr(crank, D, r3, r4, np.sign(cross(D - A, B - A)))
    return {
        "angle_OAB": abs(angle((pin_B - crank) / -crank)),
        "B_side": np.where(cross(D, pin_B) > 0, "left", "right")[()],
        "A_side": np.where(cross(pin_B, crank) > 0, "left", "right")[()],
    }


def OB_at_the_ends(r2, r3):
    """Where the rocker turns back, crank and coupler are in line."""
    return np.stack([r3 - r2, r3 + r2])


def rocker_at_the_ends(OB_at_the_ends, r1, theta1, r4, B_side):
    at_D = acos((r1**2 + r4**2 - OB_at_the_ends**2) / (2 * r1 * r4))
    return theta1 + 180 - side_of(B_side) * at_D


def _passes(ends, direction):
    """Return whether the swing between two directions, less than half a turn apart, passes near or through
    another one."""
    low = np.minimum(ends[0], ends[1])
    swing = abs(ends[1] - ends[0])
    return (direction - low + 6) % 360 < swing + 12


def greatest_rise(rocker_at_the_ends, r1, theta1, r4, h):
    """Of |h - yB| over the turn: at an end of the swing, or where the rocker points straight up or down."""
    middle = h - r1 * sin(theta1)
    rise = abs(middle - r4 * sin(rocker_at_the_ends)).max(axis=0)
    for upright, top in ((90, r4), (-90, -r4)):
        inside = _passes(rocker_at_the_ends, upright)
        rise = np.where(inside, np.maximum(rise, abs(middle - top)), rise)
    return rise


def crank_is_the_shortest(r1, r2, r3, r4):
    return r2 < np.minimum(r1, np.minimum(r3, r4))


def crank_turns(r1, r2, r3, r4):
    longest = np.maximum(r1, np.maximum(r3, r4))
    return 2 * (r2 + longest) < r1 + r2 + r3 + r4


def transmission_angle_from_30_to_150(r1, r2, r3, r4):
    limit = 2 * r3 * r4 * cos(30)
    sides = r3**2 + r4**2
    return (abs(sides - (r1 - r2) ** 2) < limit) & (abs(sides - (r1 + r2) ** 2) < limit)


def rod_stays_flat(greatest_rise, r5):
    return greatest_rise < r5 * sin(50)


def two_turning_points(rocker_at_the_ends, r1, theta1, r4, r5, h):
    """The rod never lines up with the rocker: C would turn back there too."""
    rise = h - r1 * sin(theta1)
    stretched = asin(rise / (r5 + r4))
    folded = 180 + asin(rise / (r5 - r4))
    return ~_passes(rocker_at_the_ends, stretched) & ~_passes(rocker_at_the_ends, folded)


def return_is_quick(DOB_far, DOB_near):
    """The angle between the two directions of OB is what one stroke takes beyond half a turn."""
    beyond = abs(DOB_far - DOB_near)
    return 180 + beyond > 1.05 * (180 - beyond)


def angle_OAB_not_square(angle_OAB):
    return abs(angle_OAB - 90) >= 10


def bars_turn_visibly(omega3, omega4, omega5, omega2):
    at_least = abs(omega2)
    return (abs(omega3) > 0.05 * at_least) & (abs(omega4) > 0.05 * at_least) & (abs(omega5) > 0.02 * at_least)


def rod_turning_counts_in_the_speed(v_C, omega5, r5, theta5):
    return abs(omega5 * r5 * sin(theta5)) > 0.025 * abs(v_C)


def rod_turning_counts_in_the_acceleration(a_C, omega5, r5, theta5):
    return omega5**2 * r5 * cos(theta5) > 0.025 * abs(a_C)


def piston_moves_visibly(v_C, r2, omega2):
    return abs(v_C) > 0.15 * r2 * abs(omega2)


def piston_accelerates_visibly(a_C, r2, omega2):
    return abs(a_C) > 0.15 * r2 * omega2**2


def _clearest(*directions):
    """The direction, by steps of 15 degrees, that is farthest from all of these."""
    return max(range(0, 360, 15), key=lambda way: min(abs(wrap(way - taken)) for taken in directions))


def figure(A, B, C, r1, theta1, r2, omega2):
    O, D = 0j, polar(r1, theta1)
    to_O = angle(O - A)
    corner = wrap(angle(B - A) - to_O)
    turning = _clearest(
        0.5 * theta1, 0, theta1, angle(A), angle(B), angle(A + 0.5 * r2 * polar(1, angle(B - A)))
    )
    half_turn = 25 if omega2 > 0 else -25
    around = max(1.5 * r2, 0.4 * r1)
    marks = (angle_mark(O, 0, theta1, r"\theta_1", radius=around),) if theta1 else ()
    return Figure(
        circle(O, r2, dashed=True),
        rotation_arrow(O, 1.3 * r2, turning - half_turn, turning + half_turn, label=r"\omega_2"),
        rail(C - 2.2 * r2, C + 2.2 * r2),
        line(O, D, dashed=True, label="r_1"),
        link(O, A, label="r_2"),
        link(A, B, label="r_3"),
        link(D, B, label="r_4"),
        link(B, C, label="r_5"),
        arc(A, 0.25 * r2, to_O, to_O + corner),
        centre_line(O, 1.4 * around, label="x"),
        *marks,
        note(C + 1.8 * r2, "y=h"),
        slider(C, 0, label="C"),
        ground_pivot(O, "O"),
        ground_pivot(D, "D"),
        pin(A, "A"),
        pin(B, "B"),
        pin(C),
    )


SYMBOLS_OF_THE_LOOPS = (
    "r1",
    "theta1",
    "r2",
    "theta2",
    "r3",
    "theta3",
    "r4",
    "theta4",
    "r5",
    "theta5",
    "xC",
    "h",
)
RATES_OF_THE_LOOPS = ("omega2", "omega3", "omega4", "omega5", "v_C")

EXERCISE = Exercise(
    given={
        "r1": drawn(180, 320, step=5, unit="mm"),
        "r2": drawn(40, 110, step=5, unit="mm"),
        "r3": drawn(lambda r1: 0.7 * r1, lambda r1: 1.2 * r1, step=5, unit="mm", positive=True),
        "r4": drawn(lambda r1: 0.7 * r1, lambda r1: 1.1 * r1, step=5, unit="mm", positive=True),
        "r5": drawn(250, 600, step=5, unit="mm"),
        "B_side": chosen("left", "right"),
        "A_side": chosen("left", "right"),
        # On either side of O-D the linkages are mirror images in the x axis.
        "theta1": drawn(
            lambda B_side: np.where(B_side == "left", -30, -60),
            lambda B_side: np.where(B_side == "left", 60, 30),
            step=5,
            unit="deg",
        ),
        "h": drawn(
            lambda B_side: np.where(B_side == "left", -100, -250),
            lambda B_side: np.where(B_side == "left", 250, 100),
            step=5,
            unit="mm",
        ),
        "angle_OAB": drawn(60, 140, step=5, unit="deg"),
        "omega2": drawn(2, 20, unit="rad/s", positive=False, nonzero=True),
    },
    helpers=(B, A, theta2, C, OB_at_the_ends, rocker_at_the_ends, greatest_rise),
    constraints=(
        crank_is_the_shortest,
        crank_turns,
        transmission_angle_from_30_to_150,
        rod_stays_flat,
        two_turning_points,
        return_is_quick,
        angle_OAB_not_square,
        bars_turn_visibly,
        rod_turning_counts_in_the_speed,
        rod_turning_counts_in_the_acceleration,
        piston_moves_visibly,
        piston_accelerates_visibly,
    ),
    parts=(
        Part("theta2", unit="deg", kind="angle", points=1),
        Part("theta3", unit="deg", kind="angle", points=1),
        Part("theta4", unit="deg", kind="angle", points=1),
        Part("xC", unit="mm", points=1),
        Part("theta5", unit="deg", kind="angle", points=1),
        Part("omega3", unit="rad/s", points=1),
        Part("omega4", unit="rad/s", points=1),
        Part("omega5", unit="rad/s", points=1),
        Part("v_C", unit="mm/s", points=1),
        Part("a_C", unit="mm/s^2", points=2),
        Part("stroke", unit="mm", points=1),
        Part("alpha", unit="deg", points=1),
        Part("beta", unit="deg", points=1),
        Part("Q", points=1),
        Part("T", unit="s", points=1),
        Part("t_advance", unit="s", points=1),
        Part("t_return", unit="s", points=1),
        Part("mechanical_advantage", points=1),
        *loop_equations("loop_1", SYMBOLS_OF_THE_LOOPS, rates=RATES_OF_THE_LOOPS),
        *loop_equations("loop_2", SYMBOLS_OF_THE_LOOPS, rates=RATES_OF_THE_LOOPS),
    ),
    symbols={
        "A_side": "A",
        "B_side": "B",
        "angle_OAB": r"\angle OAB",
        **OF_BOTH_STROKES,
        "mechanical_advantage": r"\lambda",
    },
    figure=figure,
    driver=Driver("theta2", "omega2", output="v_C", poses=with_the_crank_at),
)
