"""Four-bar linkage: where are coupler and rocker, in its two assemblies? (chapter 3, exercise 2)."""

from coursework.degrees import cos, polar
from coursework.figures import Figure, angle_mark, ground_pivot, line, link, pin
from coursework.kinematics.dyads import rrr
from coursework.model import Driver, Exercise, Part, drawn, loop_equations


def crank_off_the_axes(theta2):
    return theta2 % 90 >= 10


def a_keeps_its_size(r1, r2, theta2):
    return abs(r1 - r2 * cos(theta2)) > 0.2 * r1


def closes_well(mu):
    return abs(cos(mu)) < 0.9


def angle_at_B_not_square(mu):
    return abs(cos(mu)) > 0.03


def angle_at_A_not_square(psi):
    return abs(cos(psi)) > 0.1


def figure(r1, r2, r3, r4, theta2):
    O, A, C = 0j, polar(r2, theta2), complex(r1)
    B = rrr(A, C, r3, r4)
    return Figure(
        line(O, C, dashed=True, label="r_1"),
        link(O, A, label="r_2"),
        link(A, B, label="r_3"),
        link(C, B, label="r_4"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B_1"),
        angle_mark(O, 0, theta2, r"\theta_2"),
    )


EXERCISE = Exercise(
    given={
        "r1": drawn(60, 240, step=5, unit="mm"),
        "r2": drawn(40, 150, step=5, unit="mm"),
        "r3": drawn(50, 240, step=5, unit="mm"),
        "r4": drawn(50, 220, step=5, unit="mm"),
        "theta2": drawn(-175, 180, step=5, unit="deg"),
    },
    constraints=(
        crank_off_the_axes,
        a_keeps_its_size,
        closes_well,
        angle_at_B_not_square,
        angle_at_A_not_square,
    ),
    parts=(
        Part(
            "linkage_type",
            kind="choice",
            choices=(
                "crank-rocker",
                "rocker-crank",
                "double-crank",
                "double-rocker",
                "triple-rocker",
                "change-point",
            ),
            points=1,
        ),
        Part("a", unit="mm^2", points=1),
        Part("b", unit="mm^2", points=1),
        Part("c", unit="mm^2", points=1),
        Part("theta3_open", unit="deg", kind="angle", points=1),
        Part("theta4_open", unit="deg", kind="angle", points=1),
        Part("theta3_crossed", unit="deg", kind="angle", points=1),
        Part("theta4_crossed", unit="deg", kind="angle", points=1),
        Part("mu", unit="deg", points=1),
        *loop_equations("loop_1", ("r1", "r2", "theta2", "r3", "theta3", "r4", "theta4")),
    ),
    either_order=(("theta3_open", "theta4_open"), ("theta3_crossed", "theta4_crossed")),
    symbols={
        "theta3_open": r"\theta_3^{(1)}",
        "theta4_open": r"\theta_4^{(1)}",
        "theta3_crossed": r"\theta_3^{(2)}",
        "theta4_crossed": r"\theta_4^{(2)}",
    },
    figure=figure,
    driver=Driver("theta2"),
)
