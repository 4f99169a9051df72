"""Toggle press: solution. The angle of the upper bar is what is given, so that nothing is a small difference.

The two bars of the toggle make small angles with the line of the ram; speeds and forces hang on the sine of
their sum, which keeps its digits down to the dead point of the toggle, where the ram stands still and any
force is held without a torque. Bars and coupler bear forces along themselves alone: the ram, then the knee B,
then the crank balance.
"""

from math import pi

import numpy as np

from coursework.degrees import acos, asin, atan2, cos, from_radians, polar, sin, wrap
from coursework.errors import CannotAssemble, Undefined
from coursework.figures import Figure, ground_pivot, line, link, pin, vector
from coursework.figures.polygons import Side, crank_v, polygon_of_velocities, turning, two_bars_v
from coursework.kinematics.chains import Vector
from coursework.kinematics.dyads import side_of
from coursework.kinematics.triangles import corner
from coursework.mechanics import Body, Load, Mechanism, Slide
from coursework.solution import Moving, given, mistake, stable

UNITS = {
    "xB": "mm",
    "yB": "mm",
    "OB": "mm",
    "beta": "deg",
    "AOB": "deg",
    "OAB": "deg",
    "A_turn": "1",
    "theta4": "deg",
    "theta5": "deg",
    "omega3": "rad/s",
    "omega4": "rad/s",
    "omega5": "rad/s",
    "load": "N",
    "F_3": "N",
}
SYMBOLS = {
    "xB": "x_B",
    "yB": "y_B",
    "OB": "OB",
    "beta": r"\beta",
    "AOB": r"\angle AOB",
    "OAB": r"\angle OAB",
    "A_turn": r"\varepsilon",
    "load": "F_C",
}
LOOPS = {
    "loop_1": (
        Vector("xO", 0.0),
        Vector("yO", pi / 2),
        Vector("r2", "theta2"),
        Vector("r3", "theta3"),
        Vector("r4", "theta4", -1),
    ),
    "loop_2": (Vector("r4", "theta4"), Vector("r5", "theta5"), Vector("yC", pi / 2, -1)),
}
RATES = {"yC": ("v_C", "")}
EFFECTS = {"advantage": ("mechanical_advantage",), "forces": ("torque", "F_5", "F_4", "F_3", "N_guide")}
MECHANISM = Mechanism(
    ground={"D": 0, "O": lambda xO, yO: xO + 1j * yO},
    bodies=(
        Body("2", "theta2", "O", {"A": "r2"}),
        Body("3", "theta3", "A", {"B": "r3"}),
        Body("4", "theta4", "D", {"B": "r4"}),
        Body("5", "theta5", "B", {"C": "r5"}),
        Body("6", 0, "C"),
    ),
    slides=(Slide("C", "6", along=90),),
    loads=(Load("C", force="F", angle=90),),
)


def psi(r4, r5, phi):
    """Of the lower bar: B is as far from the line of the ram by the one bar as by the other."""
    if np.ndim(r4 * sin(phi) - r5) == 0 and abs(r4 * sin(phi)) > r5:
        raise CannotAssemble(
            f"the lower bar does not reach the line of the ram: B is {abs(r4 * sin(phi)):.6g} from it, "
            "the bar is "
            f"{r5:.6g} long (gap {abs(r4 * sin(phi)) - r5:.3g})"
        )
    return asin(r4 * sin(phi) / r5)


def yC(r4, phi, r5, psi):
    return -(r4 * cos(phi) + r5 * cos(psi))


def xB(r4, phi):
    return -r4 * sin(phi)


def yB(r4, phi):
    return -r4 * cos(phi)


def OB(xB, xO, yB, yO):
    return np.hypot(xB - xO, yB - yO)


def beta(xB, xO, yB, yO):
    """Direction of OB, by its quadrant."""
    return atan2(yB - yO, xB - xO)


@stable(lambda r2, OB, r3: from_radians(corner(r2, OB, r3)))
def AOB(r2, OB, r3):
    """Angle at O of triangle OAB, by the law of cosines."""
    return acos((r2**2 + OB**2 - r3**2) / (2 * r2 * OB))


@stable(lambda r2, r3, OB: from_radians(corner(r2, r3, OB)))
def OAB(r2, r3, OB):
    """Its angle at A."""
    return acos((r2**2 + r3**2 - OB**2) / (2 * r2 * r3))


def A_turn(A_side):
    """+1 when A lies left of the line O -> B, -1 when right."""
    return side_of(A_side)


def theta2(beta, A_turn, AOB):
    """Direction of OA."""
    return wrap(beta + A_turn * AOB)


def theta3(theta2, A_turn, OAB):
    """At A the path O-A-B turns by the supplement of its angle, back towards OB."""
    return wrap(theta2 + A_turn * (OAB - 180))


def theta4(phi):
    """Direction of DB."""
    return wrap(-90 - phi)


def theta5(psi):
    """Direction of BC."""
    return psi - 90


def omega3(r2, omega2, theta2, phi, r3, theta3):
    """Along the upper bar, B has no velocity."""
    return -r2 * omega2 * cos(theta2 + phi) / (r3 * cos(theta3 + phi))


def _sine_at_A(r2, r3, OB):
    """Sine of the angle OAB, by Heron's formula: it vanishes at the dead points of the crank."""
    flat = (OB + r3 - r2) * (OB + r2 - r3) * (r2 + r3 - OB) * (r2 + r3 + OB)
    return np.sqrt(flat) / (2 * r2 * r3)


@stable(
    lambda r2, omega2, A_turn, _sine_at_A, r4, theta3, phi: (
        -r2 * omega2 * A_turn * _sine_at_A / (r4 * cos(theta3 + phi))
    )
)
def omega4(r2, omega2, theta2, theta3, r4, phi):
    """Along the coupler, A and B have the same velocity."""
    return -r2 * omega2 * sin(theta2 - theta3) / (r4 * cos(theta3 + phi))


def omega5(r4, omega4, phi, r5, psi):
    """C keeps to its line."""
    return -r4 * omega4 * cos(phi) / (r5 * cos(psi))


def v_C(r4, omega4, phi, psi):
    """Velocity of the ram, positive upwards: by the instant centre of the lower bar."""
    return -r4 * omega4 * sin(phi + psi) / cos(psi)


def mechanical_advantage(r2, omega2, v_C):
    """Of the crank pin over the ram, by their speeds."""
    if np.ndim(v_C) == 0 and v_C == 0:
        raise Undefined("the ram is at rest: the mechanical advantage grows without bound there")
    return abs(r2 * omega2 / np.where(v_C == 0, np.nan, v_C)[()])


def load(F):
    """The force on the ram, upwards."""
    return F


def F_5(psi, load=0.0):
    """Compression of the lower bar: the ram balances along its line."""
    return load / cos(psi)


def N_guide(psi, load=0.0):
    """Force of the guide on the ram, positive to the right: the ram balances across its line."""
    return -load * sin(psi) / cos(psi)


def F_4(F_5, psi, theta3, phi):
    """Compression of the upper bar: the knee balances across the coupler."""
    return F_5 * cos(psi - theta3) / cos(theta3 + phi)


def F_3(F_5, phi, psi, theta3):
    """Compression of the coupler: the knee balances across the upper bar."""
    return F_5 * sin(phi + psi) / cos(theta3 + phi)


@stable(lambda r2, F_3, A_turn, _sine_at_A: -r2 * F_3 * A_turn * _sine_at_A / 1000)
def torque(r2, F_3, theta3, theta2):
    """The crank balances about O under the drive and the coupler."""
    return r2 * F_3 * sin(theta3 - theta2) / 1000


@mistake("A_side")
def A_other_side(A_side):
    return np.where(side_of(A_side) > 0, "right", "left")


@mistake("v_C")
def ram_as_fast_as_the_knee(r4, omega4):
    return -r4 * omega4


@mistake("v_C")
def lower_bar_keeps_its_direction(r4, omega4, phi):
    return -r4 * omega4 * sin(phi)


@mistake("mechanical_advantage", kind="inverse")
def advantage_inverse(r2, omega2, v_C):
    return abs(v_C / (r2 * omega2))


@mistake("mechanical_advantage")
def advantage_angular(omega2, omega4):
    return abs(omega2 / omega4)


@mistake("F_4")
def same_force_in_both_bars(F_5):
    return F_5


@mistake("F_3")
def lower_bar_alone_on_the_knee(F_5, psi, theta3):
    return F_5 * sin(psi) / cos(theta3)


@mistake("torque")
def coupler_square_to_the_crank(r2, F_3, torque):
    return r2 * F_3 / 1000 * np.sign(torque)


def polygons(r2, r3, r4, r5, theta2, theta3, theta4, theta5, omega2, omega3, omega4, omega5, v_C):
    """Two bars meet at B, then the lower bar from B to the ram."""
    AB, DB, BC = polar(r3, theta3), polar(r4, theta4), polar(r5, theta5)
    return (
        polygon_of_velocities(
            crank_v("A", "OA", polar(r2, theta2), omega2),
            two_bars_v("B", "A", "D", AB, omega3, DB, omega4),
            (
                turning("b", "c", "C/B", "BC", BC, omega5),
                Side("p_v", "c", r"\vec{V}_C", 1j * v_C, r"\parallel Oy", way=1j),
            ),
        ),
    )


def motion(xO, yO, r2, theta2, omega2, r4, theta4, omega4, yC, v_C):
    """Crank pin, knee and ram."""
    crank, upper = polar(r2, theta2), polar(r4, theta4)
    return {
        "A": Moving(xO + 1j * yO + crank, 1j * omega2 * crank),
        "B": Moving(upper, 1j * omega4 * upper),
        "C": Moving(1j * yC, 1j * v_C),
    }


def figure(xO, yO, r2, r4, theta2, theta4, yC, F_3, F_4, F_5):
    """The mechanism, and beside it the triangle of the forces on the knee."""
    O, D, B, C = xO + 1j * yO, 0j, polar(r4, theta4), 1j * yC
    A = O + polar(r2, theta2)
    scale = -0.8 * yC / max(F_4, F_5)
    of_3, of_4, of_5 = (scale * F * (B - end) / abs(B - end) for F, end in ((F_3, A), (F_4, D), (F_5, C)))
    start = 0.8 * r4 + 0.1j * yC
    return Figure(
        line(D, C, dashed=True),
        link(O, A, label="r_2"),
        link(A, B, label="r_3"),
        link(D, B, label="r_4"),
        link(B, C, label="r_5"),
        vector(start, of_4, "F_4"),
        vector(start + of_4, of_3, "F_3"),
        vector(start + of_4 + of_3, of_5, "F_5"),
        ground_pivot(D, "D"),
        ground_pivot(O, "O"),
        pin(A, "A"),
        pin(B, "B"),
        pin(C, "C"),
        paper_mm=(108, 75),
    )


def residual(
    xO,
    yO,
    r2,
    r3,
    r4,
    r5,
    phi,
    A_side,
    omega2,
    F,
    psi,
    yC,
    theta2,
    theta3,
    v_C,
    omega3,
    omega4,
    omega5,
    mechanical_advantage,
    F_5,
    N_guide,
    F_4,
    F_3,
    torque,
):
    """Both loops and their derivatives, the side of A; ram, knee and crank balance; no power is lost."""

    def along(theta):
        return np.exp(1j * np.radians(theta))

    def cross(u, v):
        return (np.conj(u) * v).imag

    O, crank, coupler = xO + 1j * yO, r2 * along(theta2), r3 * along(theta3)
    upper, lower = -1j * along(-phi), -1j * along(psi)
    knee = r4 * upper
    left = np.where(A_side == "left", 1, -1) * cross(knee - O, crank)
    speed = r2 * abs(omega2) + r4 * abs(omega4)
    on_ram = F * 1j + N_guide + F_5 * lower
    on_knee = F_3 * coupler / r3 + F_4 * upper - F_5 * lower
    return (
        abs(O + crank + coupler - knee) / (r2 + r3 + r4),
        abs(knee + r5 * lower - 1j * yC) / (r4 + r5),
        np.maximum(-left, 0) / (r2 * r3),
        abs(1j * (omega2 * crank + omega3 * coupler - omega4 * knee)) / speed,
        abs(1j * omega4 * knee + 1j * omega5 * r5 * lower - 1j * v_C) / speed,
        abs(on_ram) / F,
        abs(on_knee) / F,
        abs(1000 * torque - F_3 * cross(crank, coupler / r3)) / (r2 * abs(F_3)),
        abs(1000 * torque * omega2 + F * v_C) / abs(F * v_C),
        abs(mechanical_advantage * v_C) / (r2 * abs(omega2)) - 1,
    )


_SQUARE = {"xO": -50 - 120, "yO": -50 * 3**0.5 - 40, "r2": 40, "r3": 120, "r4": 100, "A_side": "left"}

KNOWN = (
    # Two bars at 30 degrees, the coupler level and the crank upright: an equilateral triangle of forces on
    # the knee.
    given(**_SQUARE, r5=100, phi=30, omega2=-3, F=3000).gives(
        psi=30,
        yC=-100 * 3**0.5,
        theta2=90,
        theta3=0,
        omega4=2 * 3**0.5 * 0.4,
        v_C=-80 * 3**0.5,
        mechanical_advantage=0.5 * 3**0.5,
        F_5=2000 * 3**0.5,
        F_4=2000 * 3**0.5,
        F_3=2000 * 3**0.5,
        N_guide=-1000 * 3**0.5,
        torque=-80 * 3**0.5,
    ),
    # The lower bar at 45 degrees; nothing loads the ram.
    given(**_SQUARE, r5=50 * 2**0.5, phi=30, omega2=-3, F=3000)
    .under("load")
    .gives(psi=45, yC=-50 - 50 * 3**0.5, F_5=3000 * 2**0.5, N_guide=-3000),
    given(**_SQUARE, r5=100, phi=30, omega2=-3).under().gives(torque=0, F_4=0, F_5=0, N_guide=0),
    # The toggle in line: the ram is at rest, and needs no torque.
    given(xO=-160, yO=-100, r2=40, r3=130, r4=100, r5=80, phi=0, A_side="right", omega2=2, F=5000).gives(
        psi=0, yC=-180, v_C=0, F_5=5000, F_4=5000, F_3=0, N_guide=0, torque=0
    ),
)
