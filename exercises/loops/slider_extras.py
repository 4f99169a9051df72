"""Six links, two loops: crank, coupler and rocker, then a rod and a slider (the supplementary exercise)."""

import numpy as np

from coursework.degrees import cos, polar
from coursework.figures import Figure, angle_mark, ground_pivot, line, link, pin, rail, slider
from coursework.kinematics.dyads import rrp, rrr, side_of
from coursework.model import Driver, Exercise, Part, chosen, drawn, in_turn, loop_equations

SYMBOLS_OF_THE_LOOPS = (
    "r1",
    "r2",
    "r3",
    "r4",
    "r5",
    "r6",
    "theta2",
    "theta3",
    "theta4",
    "theta5",
)


def pin_A(r1, r2, theta2):
    return 1j * r1 + polar(r2, theta2)


def pin_B(pin_A, r3, r4, mode):
    return rrr(pin_A, 0j, r3, r4, side_of(mode))


def pin_P(pin_B, r5):
    """The slider, on the x axis to the right of B."""
    return rrp(pin_B, r5, 0.0)


# Over the turn, the angle at B stays between 30 and 150 degrees: by the law of cosines, it does when
# r4^2 - 2 r3 r4 cos 30 + r3^2 < (r1 - r2)^2 and (r1 + r2)^2 < r4^2 + 2 r3 r4 cos 30 + r3^2.


def longest_crank(r1):
    """So that a coupler of 80 mm is within reach."""
    return np.minimum(70, r1 - 45)


def longest_coupler(r1, r2):
    return np.minimum(200, 1.9 * (r1 - r2))


def shortest_rocker(r1, r2, r3):
    when_A_is_near = cos(30) * r3 - np.sqrt((r1 - r2) ** 2 - (r3 / 2) ** 2)
    when_A_is_far = np.sqrt((r1 + r2) ** 2 - (r3 / 2) ** 2) - cos(30) * r3
    return np.maximum(60, np.maximum(when_A_is_near, when_A_is_far))


def longest_rocker(r1, r2, r3):
    return np.minimum(160, cos(30) * r3 + np.sqrt((r1 - r2) ** 2 - (r3 / 2) ** 2))


def shortest_rod(r4):
    """The range of r4 may be empty; fmax then leaves a bound."""
    return np.fmax(150, 1.3 * r4)


def crank_across_the_frame(theta2):
    """Else a is 0."""
    return theta2 % 180 != 90


def coefficient_c_not_small(r1, r2, r3, r4, pin_A):
    return abs(r4**2 - abs(pin_A) ** 2 - r3**2) > 0.1 * r1**2


def figure(pin_A, pin_B, pin_P, r1, theta2):
    O, D, x = 1j * r1, 0, 0.25 * r1
    return Figure(
        rail(pin_P - x, pin_P + x),
        line(D, O, dashed=True, label="r_1"),
        line(D, pin_P, dashed=True, label="r_6"),
        link(O, pin_A, label="r_2"),
        link(pin_A, pin_B, label="r_3"),
        link(D, pin_B, label="r_4"),
        slider(pin_P),
        link(pin_P, pin_B, label="r_5"),
        ground_pivot(D, "D"),
        ground_pivot(O, "O"),
        pin(pin_A, "A"),
        pin(pin_B, "B"),
        pin(pin_P, "P"),
        angle_mark(O, 0, theta2, r"\theta_2"),
    )


def coupler_turns_visibly(omega3, omega2):
    return abs(omega3) > 0.06 * abs(omega2)


def rocker_turns_visibly(omega4, omega2):
    return abs(omega4) > 0.06 * abs(omega2)


def rod_turns_visibly(omega5, omega2):
    return abs(omega5) > 0.03 * abs(omega2)


def slider_moves_visibly(r6_dot, r2, omega2):
    return abs(r6_dot) > 0.15 * r2 * abs(omega2)


def links_accelerate_visibly(alpha3, alpha4, alpha5, omega2):
    bars = (abs(alpha3) > 0.08 * omega2**2) & (abs(alpha4) > 0.08 * omega2**2)
    return bars & (abs(alpha5) > 0.03 * omega2**2)


def slider_accelerates_visibly(r6_ddot, r2, omega2):
    return abs(r6_ddot) > 0.2 * r2 * omega2**2


def rod_normal_acceleration_counts(omega5, r5, theta5, r6_ddot):
    return abs(omega5**2 * r5 * cos(theta5)) > 0.022 * abs(r6_ddot)


LENGTHS = ("r1", "r2", "r3", "r4", "r5")


def _equations(loop):
    return loop_equations(
        loop,
        SYMBOLS_OF_THE_LOOPS,
        rates=("omega2", "omega3", "omega4", "omega5", "r6_dot"),
        second_rates=("alpha3", "alpha4", "alpha5", "r6_ddot"),
        parameters=LENGTHS,
        usual=("x", "y"),
    )


EXERCISE = Exercise(
    given={
        "r1": drawn(80, 200, step=5, unit="mm"),
        "r2": drawn(25, longest_crank, step=5, unit="mm"),
        "r3": drawn(80, longest_coupler, step=5, unit="mm"),
        "r4": drawn(shortest_rocker, longest_rocker, step=5, unit="mm", positive=True),
        "r5": drawn(shortest_rod, 350, step=5, unit="mm", positive=True),
        "theta2": drawn(-175, 180, step=5, unit="deg"),
        "omega2": drawn(2, 20, unit="rad/s", positive=False, nonzero=True),
        "mode": chosen("open", "crossed"),
    },
    helpers=(pin_A, pin_B, pin_P),
    constraints=(
        crank_across_the_frame,
        coefficient_c_not_small,
        coupler_turns_visibly,
        rocker_turns_visibly,
        rod_turns_visibly,
        slider_moves_visibly,
        links_accelerate_visibly,
        slider_accelerates_visibly,
        rod_normal_acceleration_counts,
    ),
    parts=(
        *in_turn(1, ("r2", "theta2", "omega2"), *(Part(i, kind="integer") for i in ("mobility", "cycles"))),
        *_equations("loop_1"),
        *_equations("loop_2"),
        Part("a", unit="mm^2", points=1),
        Part("b", unit="mm^2", points=1),
        Part("c", unit="mm^2", points=1),
        Part("theta3", unit="deg", kind="angle", points=2),
        Part("theta4", unit="deg", kind="angle", points=1),
        Part("B", unit="mm", points=1),
        Part("C", unit="mm^2", points=1),
        Part("r6", unit="mm", points=1),
        Part("theta5", unit="deg", kind="angle", points=1),
        Part("omega3", unit="rad/s", points=1),
        Part("omega4", unit="rad/s", points=1),
        Part("omega5", unit="rad/s", points=1),
        Part("r6_dot", unit="mm/s", points=1),
        Part("alpha3", unit="rad/s^2", points=1),
        Part("alpha4", unit="rad/s^2", points=1),
        Part("alpha5", unit="rad/s^2", points=1),
        Part("r6_ddot", unit="mm/s^2", points=1),
    ),
    figure=figure,
    version=2,
    symbols={"mobility": "w", "cycles": r"\gamma"},
    driver=Driver("theta2", "omega2", output="r6_dot"),
)
