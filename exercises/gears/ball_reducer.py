"""Ball reducer: a ball rolls on the frame, an input shaft and an output shaft, four times without slip."""

import numpy as np

from coursework.figures import Figure, ball, centre_line, contact, dimension, point, section
from coursework.model import Exercise, Part, drawn, in_turn

NATURES = ("rotation", "translation", "helical")
NO_SLIP_SYMBOLS = ("R", "r", "omega", "phi_dot", "psi_dot", "theta_dot")


def smallest_ball(R):
    """A fifth of R: the letters fit in the figure, and the ratio differs from 1."""
    return np.maximum(4, R / 5)


def largest_ball(R):
    return np.minimum(20, R / 2)


def input_turns_visibly(psi_dot):
    return abs(psi_dot) >= 5


def input_accelerates_visibly(psi_ddot):
    return abs(psi_ddot) >= 5


def acceleration_unlike_velocity(psi_dot, psi_ddot):
    """As numbers: else one stands for the other unseen."""
    return abs(psi_ddot / psi_dot - 1) > 0.05


def figure(R, r):
    """Half-section by the plane of z and O1O3; x and y of the drawing are along x_a and z."""
    wall, shaft = 0.7 * r, 0.4 * R
    O3, outer = R + r, R + 2 * r
    top, bottom = 2.7 * r, -2.7 * r
    input_shaft = (
        complex(0, 0.6 * r),
        complex(R, 0.6 * r),
        complex(R, -0.6 * r),
        complex(shaft, -0.6 * r),
        complex(shaft, bottom),
        complex(0, bottom),
    )
    output_shaft = (
        complex(0, r),
        complex(outer, r),
        complex(outer, r + wall),
        complex(shaft, r + wall),
        complex(shaft, top),
        complex(0, top),
    )
    frame = (
        complex(outer, 0.7 * r),
        complex(outer + wall, 0.7 * r),
        complex(outer + wall, -r - wall),
        complex(shaft + 0.15 * r, -r - wall),
        complex(shaft + 0.15 * r, -r),
        complex(outer, -r),
    )
    return Figure(
        section(frame, label="S_0", angle=45),
        section(input_shaft, label="S_1", angle=-45),
        section(output_shaft, label="S_2", angle=45, spacing=2.6),
        ball(O3, r),
        centre_line(complex(0, 1.1 * bottom), complex(0, 1.1 * top), label="z"),
        centre_line(0, outer + 2 * wall, label="x_a"),
        point(0, "O_1"),
        point(O3, "O_3", toward=90),
        contact(outer, "A", toward=-140),
        contact(complex(O3, -r), "B", toward=-120),
        contact(R, "C", toward=-40),
        contact(complex(O3, r), "D"),
        dimension(0, R, label="R", offset=1.15 * bottom),
        dimension(O3, outer, label="r", offset=1.15 * bottom),
    )


def _no_slip(point):
    return Part(f"no_slip_{point}", kind="equation", variables=NO_SLIP_SYMBOLS, parameters=("R", "r"))


def _axis(motion):
    return (
        Part(f"axis_{motion}_point", unit="mm", kind="point_on_line", along=f"axis_{motion}_dir", points=1),
        Part(f"axis_{motion}_dir", kind="direction", points=1),
    )


def _nature(motion):
    return Part(f"nature_{motion}", kind="choice", choices=NATURES, points=1)


OMEGA_WHY = Part(
    "omega_why",
    kind="choice",
    choices=("equal_distances", "A_and_B_at_rest", "O3_on_a_circle", "no_slip_on_shafts"),
    points=1,
)

EXERCISE = Exercise(
    given={
        "R": drawn(20, 80, unit="mm"),
        "r": drawn(smallest_ball, largest_ball, unit="mm", positive=True),
        "psi_dot": drawn(-150, 150, unit="rad/s", nonzero=True),
        "psi_ddot": drawn(-100, 100, unit="rad/s^2", default=0, shown=("a_O3_y",)),
    },
    constraints=(input_turns_visibly, input_accelerates_visibly, acceleration_unlike_velocity),
    parts=(
        *in_turn(
            1,
            ("R", "r", "psi_dot"),
            Part("graph", kind="graph", room=2, points=2),
            (OMEGA_WHY, Part("mobility", kind="integer", points=1)),
        ),
        Part("bases", kind="drawing", room=(150, 45), points=2, by_request=True),
        *in_turn(3, ("r", "psi_dot", "R"), *map(_no_slip, "ABCD")),
        Part("omega", unit="rad/s", points=1),
        Part("phi_dot", unit="rad/s", points=1),
        Part("theta_dot", unit="rad/s", points=1),
        Part("rho", points=1),
        Part("v_O3", unit="mm/s", points=1),
        Part("a_O3_x", unit="mm/s^2", points=1),
        Part("a_O3_y", unit="mm/s^2", points=1),
        *in_turn(
            2, ("psi_dot", "R", "r"), *((*_axis(motion), _nature(motion)) for motion in ("30", "31", "32"))
        ),
        Part("rolling_D", unit="rad/s", points=1),
        Part("spin_D", unit="rad/s", points=1),
    ),
    figure=figure,
    version=3,
    symbols={
        "mobility": "m",
        "v_O3": r"v_{O_3}",
        "a_O3_x": r"a_{O_3,x}",
        "a_O3_y": r"a_{O_3,y}",
        "axis_30_point": r"P_{30}",
        "axis_31_point": r"P_{31}",
        "axis_32_point": r"P_{32}",
        "axis_30_dir": r"\vec{u}_{30}",
        "axis_31_dir": r"\vec{u}_{31}",
        "axis_32_dir": r"\vec{u}_{32}",
        "rolling_D": r"\Omega_{3/2,x}",
        "spin_D": r"\Omega_{3/2,z}",
    },
)
