"""Quantities common to four-bar linkages with the frame along x: the triangle A, B, C, and the loop's first
derivative.

The formulas are the course's; the numeric core keeps their digits near a dead point.
"""

from coursework.degrees import acos, angle, atan2, from_radians, polar, sin, sqrt, wrap
from coursework.kinematics.angles import Degrees
from coursework.kinematics.dyads import side_of
from coursework.kinematics.four_bar import FourBar
from coursework.mechanics import Body, Mechanism
from coursework.solution import formula, stable

MECHANISM = Mechanism(
    ground={"O": 0, "C": "r1"},
    bodies=(
        Body("2", "theta2", "O", {"A": "r2"}),
        Body("3", "theta3", "A", {"B": "r3", "M": lambda r3: r3 / 2}),
        Body("4", "theta4", "C", {"B": "r4"}),
    ),
)


def _bars(r1, r2, r3, r4, side):
    return FourBar(r1, r2, r3, r4, side)


def _linkage(_bars, theta2):
    """The linkage at its crank angle, by the numeric core."""
    return _bars.at(Degrees(theta2))


@formula(r"\sqrt{<r1>^2 + <r2>^2 - 2 \times <r1> \times <r2> \times \cos <theta2>}")
def AC(r1, r2, theta2):
    """Law of cosines, as a sum of two squares."""
    return sqrt((r1 - r2) ** 2 + 4 * r1 * r2 * sin(theta2 / 2) ** 2)


@formula(r"\operatorname{atan2}\left(-<r2> \sin <theta2>;\ <r1> - <r2> \cos <theta2>\right)")
def phi(r1, r2, theta2):
    """Direction of AC."""
    return atan2(-r2 * sin(theta2), (r1 - r2) + 2 * r2 * sin(theta2 / 2) ** 2)


@stable(lambda _linkage: from_radians(_linkage.corner))
def psi(r3, r4, AC):
    """Angle CAB, by the law of cosines."""
    return acos((AC**2 + r3**2 - r4**2) / (2 * AC * r3))


def side(mode):
    """+1 when B lies left of the line A -> C, -1 when right."""
    return side_of(mode)


@stable(lambda _linkage: from_radians(_linkage.coupler_angle))
def theta3(psi, phi, side):
    return wrap(phi + side * psi)


@stable(lambda _linkage: from_radians(_linkage.rocker_angle))
def theta4(r1, r2, theta2, r3, theta3):
    """Direction of CB, by its quadrant."""
    return angle(polar(r2, theta2) + polar(r3, theta3) - r1)


@stable(lambda omega2, _linkage: _linkage.coupler_ratio * omega2)
def omega3(r2, omega2, r3, theta2, theta3, theta4):
    """Along the rocker, B has no velocity."""
    return r2 * omega2 * sin(theta2 - theta4) / (r3 * sin(theta4 - theta3))


@stable(lambda omega2, _linkage: _linkage.rocker_ratio * omega2)
def omega4(r2, omega2, r4, theta2, theta3, theta4):
    """Along the coupler, A and B have the same velocity."""
    return r2 * omega2 * sin(theta2 - theta3) / (r4 * sin(theta4 - theta3))
