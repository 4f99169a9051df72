"""Ball crank and fork: solution. The vector CA stays in the middle plane of the fork: its product with y3
vanishes."""

from coursework.degrees import acos, atan, atan2, cos, polar, sin
from coursework.figures import Figure, angle_mark, ball, ground_pivot, line, slot_link, vector
from coursework.solution import Moving, given, mistake, stable

UNITS = {"y": "mm"}
SYMBOLS = {"y": "y"}
EFFECTS = {"velocity": ("omega3",)}


def perpendicular():
    return "y3"


def closure_y():
    return "R*sin(theta1) - e + q*sin(theta3) = 0"


def closure_z():
    return "q*cos(theta3) = h"


def law():
    return "h*sin(theta3) + (R*sin(theta1) - e)*cos(theta3) = 0"


def y(R, theta1, e):
    """Of the ball from the output axis, along y0."""
    return R * sin(theta1) - e


def theta3(y, h):
    return atan2(-y, h)


def q(y, h):
    return (y**2 + h**2) ** 0.5


def angular():
    return "contact"


def closure_angle():
    return "cos(epsilon) = sin(theta1)*cos(theta3)"


def _crank_and_normal(theta1, theta3):
    """Their angle by the sine too, which keeps its digits where the cosine is near 1."""
    across = (sin(theta3) ** 2 + (cos(theta1) * cos(theta3)) ** 2) ** 0.5
    return atan2(across, sin(theta1) * cos(theta3))


@stable(_crank_and_normal)
def epsilon(theta1, theta3):
    """Between the crank and the normal of the fork's faces, by the product of their vectors."""
    return acos(sin(theta1) * cos(theta3))


def law_dot():
    return "omega3*(h^2 + (R*sin(theta1) - e)^2) = -h*R*cos(theta1)*omega1"


def omega3(h, R, theta1, omega1, y):
    return -h * R * cos(theta1) * omega1 / (h**2 + y**2)


def ratio(omega3, omega1):
    return omega3 / omega1


@stable(lambda R, e, h: atan2(2 * R * h, h**2 - (R - e) * (R + e)))
def swing(R, e, h):
    """Between the two places of the ball farthest along y."""
    return atan((R + e) / h) + atan((R - e) / h)


@mistake("perpendicular", "law", "theta3")
def along_the_fork(y, h):
    return "z3", "h*cos(theta3) - (R*sin(theta1) - e)*sin(theta3) = 0", atan2(h, y)


@mistake("closure_y", "law", "theta3", kind="sign")
def fork_turned_the_other_way(theta3):
    return (
        "R*sin(theta1) - e - q*sin(theta3) = 0",
        "h*sin(theta3) - (R*sin(theta1) - e)*cos(theta3) = 0",
        -theta3,
    )


@mistake("closure_y", "closure_z", kind="arguments")
def fork_angle_from_the_y_axis():
    return "R*sin(theta1) - e + q*cos(theta3) = 0", "q*sin(theta3) = h"


@mistake("closure_y", "law", "y", kind="arguments")
def abscissa_of_the_ball(R, theta1, e):
    return (
        "R*cos(theta1) - e + q*sin(theta3) = 0",
        "h*sin(theta3) + (R*cos(theta1) - e)*cos(theta3) = 0",
        R * cos(theta1) - e,
    )


@mistake("closure_y", "law", "y", kind="term")
def axis_offset_left_out(R, theta1):
    return (
        "R*sin(theta1) + q*sin(theta3) = 0",
        "h*sin(theta3) + R*sin(theta1)*cos(theta3) = 0",
        R * sin(theta1),
    )


@mistake("q")
def height_for_the_distance(h):
    return h


@mistake("angular", "closure_angle", "epsilon")
def angles_added_in_space(theta1, theta3):
    return "sum", "epsilon = theta1 + theta3", abs(theta1 + theta3)


@mistake("closure_angle", "epsilon", kind="arguments")
def angle_with_the_wrong_axis(theta1, theta3):
    return "cos(epsilon) = cos(theta1)*cos(theta3)", acos(cos(theta1) * cos(theta3))


@mistake("law_dot", "omega3")
def derivative_of_the_tangent_alone(h, R, theta1, omega1):
    return "omega3*h = -R*cos(theta1)*omega1", -R * cos(theta1) * omega1 / h


@mistake("law_dot", "omega3")
def inner_derivative_left_out(h, R, omega1, y):
    return "omega3*(h^2 + (R*sin(theta1) - e)^2) = -h*R*omega1", -h * R * omega1 / (h**2 + y**2)


@mistake("ratio", kind="inverse")
def ratio_upside_down(omega1, omega3):
    return omega1 / omega3


@mistake("ratio")
def ratio_of_the_angles(theta3, theta1):
    return theta3 / theta1


@mistake("swing", kind="term")
def one_side_alone(R, e, h):
    return atan((R + e) / h)


def motion(R, theta1, omega1):
    """The ball, seen along the output axis."""
    return {
        "A": Moving(R * sin(theta1) + 0j, R * omega1 * cos(theta1) + 0j, -R * omega1**2 * sin(theta1) + 0j)
    }


def figure(R, h, e, y, theta3):
    """Along the output axis: CA along z3, y3 square to it."""
    C, A = e - 1j * h, complex(y + e)
    return Figure(
        line(C, e + 0j, dashed=True),
        line(e + 0j, A, dashed=True),
        slot_link(C, C + 1.25 * (A - C)),
        vector(C, polar(0.7 * h, theta3), r"\vec{y}_3"),
        vector(C, A - C, r"\vec{CA}"),
        angle_mark(C, 90, 90 + theta3, r"\theta_3", radius=0.45 * h),
        ball(A, 0.09 * R, "A"),
        ground_pivot(C, "C"),
        paper_mm=(100, 60),
    )


def residual(R, h, e, theta1, omega1, theta3, q, epsilon, omega3, ratio, swing):
    """CA in space and its products with the vectors of the fork; their derivative; the ends of the swing."""
    from math import pi

    import numpy as np

    t1, t3 = np.radians(theta1), np.radians(theta3)
    ball_at = np.array([R * np.cos(t1), R * np.sin(t1) - e, h + 0 * t1])
    goes = omega1 * np.array([-R * np.sin(t1), R * np.cos(t1), 0 * t1])
    y3 = np.array([0 * t3, np.cos(t3), np.sin(t3)])
    z3 = np.array([0 * t3, -np.sin(t3), np.cos(t3)])
    x1 = np.array([np.cos(t1), np.sin(t1), 0 * t1])
    size, speed = R + h, R * abs(omega1)
    ends = [np.arctan2(e - side * R, h) for side in (-1, 1)]
    return (
        (ball_at * y3).sum(axis=0) / size,
        ((ball_at * z3).sum(axis=0) - q) / size,
        np.cos(np.radians(epsilon)) - (x1 * y3).sum(axis=0),
        ((goes * y3).sum(axis=0) + (ball_at * omega3 * z3).sum(axis=0)) / speed,
        ratio - omega3 / omega1,
        swing * pi / 180 - (ends[0] - ends[1]),
    )


KNOWN = (
    # The ball as far out as the axis is deep: the fork at 45 degrees, at the end of its swing.
    given(R=50, h=50, e=0, theta1=90, omega1=4).gives(
        theta3=-45, q=50 * 2**0.5, omega3=0, ratio=0, swing=90, perpendicular="y3", epsilon=45
    ),
    # The ball right above the axis: the fork upright, and as fast as it can be.
    given(R=60, h=80, e=30, theta1=30, omega1=2).gives(theta3=0, q=80, omega3=-0.75 * 3**0.5, epsilon=60),
    # A 3-4-5 triangle, and an eccentric axis.
    given(R=40, h=80, e=20, theta1=-90, omega1=5).gives(theta3="36.8699", q=100, omega3=0),
    given(R=40, h=80, e=20, theta1=180, omega1=5).gives(omega3=16000 / 6800, ratio=3200 / 6800),
)
