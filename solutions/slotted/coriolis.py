"""Coriolis acceleration: solution. The sliding velocity, turned by a right angle the way the guide turns."""

from math import pi

import numpy as np

from coursework.degrees import polar, wrap
from coursework.errors import Undefined
from coursework.figures import Figure, angle_mark, ground_pivot, line, point, slider, slot_link, vector
from coursework.solution import given, mistake

SYMBOLS = {"sense": r"\sigma"}
UNITS = {"sense": "1"}

#: What each pair of points is: same point or different ones, of the same body or of different ones.
_CASES = {
    "C3_C3": "same_point_same_body",
    "C4_P4": "different_points_same_body",
    "C3_C4": "same_point_different_bodies",
    "C3_P4": "different_points_different_bodies",
}


def a_coriolis(omega, r_dot):
    """The norm of the Coriolis term."""
    return 2 * abs(omega * r_dot)


def sense(omega, r_dot):
    """+1 when the sliding velocity, turned with the guide, points 90 degrees ahead of it, -1 when behind."""
    return np.sign(omega) * np.sign(r_dot)


def direction(theta, sense):
    """None when there is no Coriolis term."""
    if np.ndim(sense) == 0 and sense == 0:
        raise Undefined("the Coriolis acceleration is zero: it has no direction")
    return wrap(theta + 90 * np.where(sense == 0, np.nan, sense)[()])


def relative_motion(points):
    return np.select([points == pair for pair in _CASES], list(_CASES.values()), "")


@mistake("a_coriolis", kind="constant")
def no_factor_2(omega, r_dot):
    return abs(omega * r_dot)


@mistake("a_coriolis")
def turns_for_radians(a_coriolis):
    return a_coriolis / (2 * pi)


@mistake("sense", kind="sign")
def crossed_product_sign(r_dot):
    return np.sign(r_dot)


@mistake("sense", kind="sign")
def sense_of_rotation_alone(omega):
    return np.sign(omega)


@mistake("sense", kind="sign")
def wrong_way(sense):
    return -sense


@mistake("direction")
def along_slide(theta):
    return theta


def _exchanged(case, one, other):
    """A case whose answer to one of the two questions is the opposite."""
    return np.select(
        [np.char.find(case, one) >= 0], [np.char.replace(case, one, other)], np.char.replace(case, other, one)
    )


@mistake("relative_motion", kind="exchanged")
def bodies_confused(relative_motion):
    return _exchanged(relative_motion, "same_body", "different_bodies")


@mistake("relative_motion", kind="exchanged")
def points_confused(relative_motion):
    return _exchanged(relative_motion, "same_point_", "different_points_")


def figure(theta, r_dot, direction):
    """The sliding velocity and the Coriolis acceleration, a right angle apart."""
    along = polar(1.0, theta)
    C = 60 * along
    return Figure(
        slot_link(0, 110 * along),
        line(0, 45, dashed=True),
        slider(C, theta),
        vector(C, 30 * np.sign(r_dot) * along, r"\dot{r}"),
        vector(C, polar(40.0, direction), "a_c"),
        point(C, "C"),
        ground_pivot(0, "O"),
        angle_mark(0, 0, theta, r"\theta", radius=24),
        paper_mm=(108, 54),
    )


def residual(omega, r_dot, theta, a_coriolis, direction):
    """The term 2 i omega r_dot e^(i theta) of equation 17, as a complex number."""
    right = 2j * omega * r_dot * np.exp(1j * np.radians(theta))
    return abs(a_coriolis * np.exp(1j * np.radians(direction)) - right) / abs(right)


KNOWN = (
    # The four combinations of signs of Figure 25: outwards or inwards, anticlockwise or clockwise.
    given(omega=2, r_dot=100, theta=30).gives(
        a_coriolis=400, direction=120, relative_motion="same_point_different_bodies"
    ),
    given(omega=-2, r_dot=100, theta=-120, points="C4_P4").gives(
        a_coriolis=400, direction=150, relative_motion="different_points_same_body"
    ),
    given(omega=3, r_dot=-50, theta=90, points="C3_C3").gives(
        a_coriolis=300, direction=0, relative_motion="same_point_same_body"
    ),
    given(omega=-0.5, r_dot=-10, theta=170, points="C3_P4").gives(
        a_coriolis=10, direction=-100, relative_motion="different_points_different_bodies"
    ),
)
