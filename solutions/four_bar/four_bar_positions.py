"""Four-bar linkage, positions: solution. Both assemblies close the triangle A, B, C.

The loop's projections, with theta4 eliminated, leave a cos(theta3) + b sin(theta3) = c. Its
discriminant a^2 + b^2 - c^2 is the product of the two margins by which the triangle closes: the numeric core
takes it so, and loses nothing at a dead point.
"""

import numpy as np

from coursework.degrees import acos, atan, atan2, cos, from_radians, polar, sin, sqrt, wrap
from coursework.figures import Figure, circle, ground_pivot, line, link, pin
from coursework.kinematics.angles import Degrees
from coursework.kinematics.chains import Vector
from coursework.kinematics.four_bar import FourBar
from coursework.mechanics import Body, Mechanism
from coursework.solution import Moving, formula, given, mistake, stable
from coursework.structure import grashof

UNITS = {
    "theta3": "deg",
    "theta4": "deg",
    "phi": "deg",
    "psi": "deg",
    "AC": "mm",
    "s_plus_l": "mm",
    "p_plus_q": "mm",
}
SYMBOLS = {"phi": r"\varphi", "psi": r"\psi", "AC": "AC", "s_plus_l": "s + l", "p_plus_q": "p + q"}
LOOPS = {
    "loop_1": (
        Vector("r2", "theta2"),
        Vector("r3", "theta3"),
        Vector("r1", 0.0, -1),
        Vector("r4", "theta4", -1),
    ),
}
MECHANISM = Mechanism(
    ground={"O": 0, "C": "r1"},
    bodies=(
        Body("2", "theta2", "O", {"A": "r2"}),
        Body("3", "theta3_open", "A", {"B": "r3"}),
        Body("4", "theta4_open", "C", {"B": "r4"}),
    ),
)
EFFECTS = {
    "position": ("a", "b", "c", "theta3_open", "theta4_open", "theta3_crossed", "theta4_crossed", "mu"),
}


def _open(r1, r2, r3, r4, theta2):
    """The linkage at its crank angle, by the numeric core."""
    return FourBar(r1, r2, r3, r4, "open").at(Degrees(theta2))


def _crossed(r1, r2, r3, r4, theta2):
    return FourBar(r1, r2, r3, r4, "crossed").at(Degrees(theta2))


def s_plus_l(r1, r2, r3, r4):
    """Of the shortest and the longest bar."""
    return grashof.shortest(r1, r2, r3, r4) + grashof.longest(r1, r2, r3, r4)


def p_plus_q(r1, r2, r3, r4, s_plus_l):
    return r1 + r2 + r3 + r4 - s_plus_l


def _compared(s_plus_l, p_plus_q):
    """The two sums, shown before what they tell; the type itself compares the printed lengths, exactly."""


def linkage_type(r1, r2, r3, r4, _compared):
    """Can it close at all; does s + l reach p + q; and if not, which bar is the shortest?"""
    return grashof.linkage_type(r1, r2, r3, r4)


@formula(r"2 \times <r2> \times <r3> \times \cos <theta2> - 2 \times <r1> \times <r3>")
def a(r1, r2, r3, theta2):
    """Coefficient of cos(theta3)."""
    return -2 * r3 * ((r1 - r2) + 2 * r2 * sin(theta2 / 2) ** 2)


def b(r2, r3, theta2):
    """Coefficient of sin(theta3): zero when the crank lies along the frame."""
    return 2 * r2 * r3 * sin(theta2)


@formula(r"<r4>^2 - <r1>^2 - <r2>^2 - <r3>^2 + 2 \times <r1> \times <r2> \times \cos <theta2>")
def c(r1, r2, r3, r4, theta2):
    """Right-hand side: r4^2 - r3^2 - AC^2."""
    return (r4 - r3) * (r4 + r3) - (r1 - r2) ** 2 - 4 * r1 * r2 * sin(theta2 / 2) ** 2


def phi(a, b):
    """Direction of C towards A, in which a and b are the components."""
    return atan2(b, a)


@stable(lambda _open: 180.0 - from_radians(_open.corner))
def psi(a, b, c):
    """Angle between the coupler and the direction phi."""
    return acos(c / sqrt(a**2 + b**2))


@stable(lambda _open: from_radians(_open.coupler_angle))
def theta3_open(phi, psi):
    """Inner joint B to the left of the line from A to C."""
    return wrap(phi - psi)


@stable(lambda _crossed: from_radians(_crossed.coupler_angle))
def theta3_crossed(phi, psi):
    """Inner joint B to the right of the line from A to C."""
    return wrap(phi + psi)


def _rocker(r1, r2, r3, theta2, theta3):
    along = (r2 - r1) - 2 * r2 * sin(theta2 / 2) ** 2
    return atan2(r2 * sin(theta2) + r3 * sin(theta3), along + r3 * cos(theta3))


_ROCKER = (
    r"\operatorname{atan2}\left(<r2> \sin <theta2> + <r3> \sin <MODE>;\ "
    r"<r2> \cos <theta2> + <r3> \cos <MODE> - <r1>\right)"
)


@formula(_ROCKER.replace("MODE", "theta3_open"))
@stable(lambda _open: from_radians(_open.rocker_angle))
def theta4_open(r1, r2, r3, theta2, theta3_open):
    """Direction from C to B, by its quadrant."""
    return _rocker(r1, r2, r3, theta2, theta3_open)


@formula(_ROCKER.replace("MODE", "theta3_crossed"))
@stable(lambda _crossed: from_radians(_crossed.rocker_angle))
def theta4_crossed(r1, r2, r3, theta2, theta3_crossed):
    """Direction from C to B, by its quadrant."""
    return _rocker(r1, r2, r3, theta2, theta3_crossed)


@formula(r"\sqrt{<r1>^2 + <r2>^2 - 2 \times <r1> \times <r2> \times \cos <theta2>}")
def AC(r1, r2, theta2):
    """Diagonal AC, by the law of cosines as a sum of two squares."""
    return sqrt((r1 - r2) ** 2 + 4 * r1 * r2 * sin(theta2 / 2) ** 2)


@stable(lambda _open: from_radians(_open.transmission_angle))
def mu(AC, r3, r4):
    """Angle CBA at B, by the law of cosines."""
    return acos((r3**2 + r4**2 - AC**2) / (2 * r3 * r4))


# The symbols of the closure, which holds in both assemblies alike: here in the one that the figure shows.


def theta3(theta3_open):
    return theta3_open


def theta4(theta4_open):
    return theta4_open


@mistake("c", kind="term_sign")
def notes_c_sign(r1, c):
    return c + 2 * r1**2


@mistake("c", kind="term_sign")
def c_cosine_sign(r1, r2, theta2, c):
    return c - 4 * r1 * r2 * cos(theta2)


@mistake("a")
def a_without_r1(r2, r3, theta2):
    return 2 * r2 * r3 * cos(theta2)


@mistake("phi", kind="quadrant")
def theta3_arctan_no_quadrant(a, b):
    return atan(b / a)


@mistake("theta4_open", "theta4_crossed", kind="quadrant")
def theta4_arctan_no_quadrant(theta4_open, theta4_crossed):
    return atan(sin(theta4_open) / cos(theta4_open)), atan(sin(theta4_crossed) / cos(theta4_crossed))


@mistake("theta3_open", "theta4_open", "theta3_crossed", "theta4_crossed")
def theta_exchanged(r1, r2, r3, theta2, theta3_open, theta3_crossed):
    theta4_open = _rocker(r1, r2, r3, theta2, theta3_open)
    theta4_crossed = _rocker(r1, r2, r3, theta2, theta3_crossed)
    return theta4_open, theta3_open, theta4_crossed, theta3_crossed


@mistake("theta2")
def degrees_as_radians(theta2):
    return theta2 * 180 / np.pi


@mistake("AC", kind="term_sign")
def diagonal_sign(r1, r2, theta2):
    return sqrt(r1**2 + r2**2 + 2 * r1 * r2 * cos(theta2))


@mistake("mu", kind="branch")
def acute_mu(mu):
    return np.minimum(mu, 180 - mu)


@mistake("mu", kind="branch")
def inverse_angle_B(mu):
    return 180 - mu


@mistake("linkage_type")
def fixed_plus_input(r1, r2, r3, r4):
    by_shortest = grashof.type_by_shortest(r1, r2, r3, r4)
    return np.where(r1 + r2 < r3 + r4, by_shortest, "triple-rocker")


@mistake("linkage_type")
def grashof_not_tested(r1, r2, r3, r4):
    return grashof.type_by_shortest(r1, r2, r3, r4)


@mistake("linkage_type")
def always_crank_rocker(linkage_type):
    turns = np.isin(linkage_type, ("crank-rocker", "rocker-crank", "double-crank", "double-rocker"))
    return np.where(turns, "crank-rocker", linkage_type)


@mistake("linkage_type")
def frame_and_coupler_exchanged(linkage_type):
    return np.where(
        linkage_type == "double-crank",
        "double-rocker",
        np.where(linkage_type == "double-rocker", "double-crank", linkage_type),
    )


def residual(r1, r2, r3, r4, theta2, a, b, c, theta3_open, theta4_open, theta3_crossed, theta4_crossed, mu):
    """Loop closure in both assemblies, the side of B, the equation in theta3, the triangle ABC."""

    def unit(theta):
        return np.exp(1j * np.radians(theta))

    crank = r2 * unit(theta2)
    size = r1 + r2 + r3 + r4
    found = []
    for side, theta3, theta4 in ((1, theta3_open, theta4_open), (-1, theta3_crossed, theta4_crossed)):
        found.append(abs(crank + r3 * unit(theta3) - r1 - r4 * unit(theta4)) / size)
        turned = side * (np.conj(r1 - crank) * unit(theta3)).imag / size
        found.append(np.maximum(-turned, 0))
        found.append(abs((np.conj(a + 1j * b) * unit(theta3)).real - c) / (abs(a) + abs(b) + abs(c)))
    found.append(abs(abs(r3 - r4 * unit(mu)) - abs(r1 - crank)) / size)
    return tuple(found)


def motion(r1, r2, r3, r4, theta2, theta3_open, theta4_open):
    """The two moving joints and the middle of the coupler, in the assembly that the figure shows."""
    crank = polar(r2, theta2)
    return {
        "A": Moving(crank),
        "B_1": Moving(r1 + polar(r4, theta4_open)),
        "M": Moving(crank + polar(r3 / 2, theta3_open)),
    }


def figure(r1, r2, r3, r4, theta2, theta3_open, theta3_crossed):
    """The drawn construction: the circles about A and C, and both inner joints."""
    O, A, C = 0j, polar(r2, theta2), complex(r1)
    B1, B2 = A + polar(r3, theta3_open), A + polar(r3, theta3_crossed)
    return Figure(
        circle(A, r3, dashed=True),
        circle(C, r4, dashed=True),
        line(O, C, dashed=True),
        line(A, C, dashed=True),
        link(O, A, label="r_2"),
        link(A, B1, label="r_3"),
        link(C, B1, label="r_4"),
        line(A, B2, thin=False),
        line(C, B2, thin=False),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B1, "B_1"),
        pin(B2, "B_2"),
    )


KNOWN = (
    # A rectangle, and the same turned over about its diagonal: a 7-24-25 triangle.
    given(r1=40, r2=30, r3=40, r4=30, theta2=90).gives(
        a=-3200,
        b=2400,
        c=-3200,
        theta3_open=0,
        theta4_open=90,
        theta3_crossed="-73.7398",
        theta4_crossed="-163.7398",
        mu=90,
        linkage_type="change-point",
    ),
    # Crank along the frame, b = 0, and ABC equilateral.
    given(r1=100, r2=40, r3=60, r4=60, theta2=0).gives(
        a=-7200,
        b=0,
        c=-3600,
        theta3_open=60,
        theta4_open=120,
        theta3_crossed=-60,
        theta4_crossed=-120,
        mu=60,
        linkage_type="triple-rocker",
    ),
    # Crank away from the frame, b = 0 again, and ABC half a square.
    given(r1=40, r2=20, r3=30 * 2**0.5, r4=30 * 2**0.5, theta2=180).gives(
        b=0,
        theta3_open=45,
        theta4_open=135,
        theta3_crossed=-45,
        theta4_crossed=-135,
        mu=90,
        linkage_type="crank-rocker",
    ),
    # A dead point: coupler and rocker in line, both assemblies at once.
    given(r1=60, r2=20, r3=50, r4=30, theta2=180).gives(
        a=-8000,
        c=-8000,
        theta3_open=0,
        theta3_crossed=0,
        theta4_open=180,
        theta4_crossed=180,
        mu=180,
        linkage_type="change-point",
    ),
    # The output, the frame, the coupler shortest.
    given(r1=100, r2=90, r3=80, r4=40, theta2=60).gives(linkage_type="rocker-crank"),
    given(r1=40, r2=90, r3=80, r4=100, theta2=60).gives(linkage_type="double-crank"),
    given(r1=100, r2=90, r3=40, r4=80, theta2=60).gives(linkage_type="double-rocker"),
    # Equality of the printed lengths, which their doubles miss: 0.1 + 0.6 = 0.3 + 0.4.
    given(r1=0.3, r2=0.1, r3=0.4, r4=0.6, theta2=60).gives(linkage_type="change-point"),
)
