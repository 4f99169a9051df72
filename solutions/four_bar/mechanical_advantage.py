"""Mechanical advantage of a four-bar linkage: solution. What goes in as power comes out as power.

The force F_e acts on the crank pin A along its velocity, F_s is what the rocker pushes with at B along its
own. The linkage is that of four_bar_motion; its angles and the rate of its rocker come from the numeric core.
"""

import numpy as np

from coursework.degrees import polar, sin
from coursework.errors import Undefined
from coursework.figures import Figure, ground_pivot, line, link, pin, vector
from coursework.figures.polygons import crank_v, polygon_of_velocities, two_bars_v
from coursework.kinematics.dyads import side_of
from coursework.solution import Moving, given, mistake

from ._four_bar import *

UNITS = {
    "AC": "mm",
    "phi": "deg",
    "psi": "deg",
    "side": "1",
    "theta3": "deg",
    "theta4": "deg",
    "omega3": "rad/s",
    "V_e": "mm/s",
    "V_s": "mm/s",
    "V_BA": "mm/s",
    "F_e": "N",
    "Gamma_e": "N*m",
}
SYMBOLS = {
    "AC": "AC",
    "phi": r"\varphi",
    "psi": r"\psi",
    "side": r"\varepsilon",
    "V_BA": "V_{BA}",
    "torque_ratio": r"\frac{\Gamma_s}{\Gamma_e}",
}
EFFECTS = {
    "position": ("theta3", "theta4"),
    "velocity": ("omega3", "omega4"),
    "advantage": ("mechanical_advantage", "torque_ratio"),
}


def V_e(r2, omega2):
    """Speed of the crank pin A."""
    return r2 * abs(omega2)


def V_s(r4, omega4):
    """Speed of B."""
    return r4 * abs(omega4)


def V_BA(r3, omega3):
    """Speed of B as seen from A."""
    return r3 * abs(omega3)


def _over(numerator, denominator):
    """A quotient that does not exist where the output stands still."""
    if np.ndim(denominator) == 0 and denominator == 0:
        raise Undefined("the output is at rest: the mechanical advantage grows without bound there")
    return numerator / np.where(denominator == 0, np.nan, denominator)[()]


def mechanical_advantage(V_e, V_s):
    """Equation 21: F_e V_e = F_s V_s; undefined when B is at rest."""
    return _over(V_e, V_s)


def F_s(F_e, mechanical_advantage):
    """Equation 20."""
    return mechanical_advantage * F_e


def torque_ratio(omega2, omega4):
    """Equation 19: Gamma_e omega_e = Gamma_s omega_s; undefined when the rocker is at rest."""
    return abs(_over(omega2, omega4))


def Gamma_e(r2, F_e):
    """Torque on the crank, in N*m, of a force square to it."""
    return r2 * F_e / 1000


def F_e(r2, Gamma_e):
    """Where the torque is what is given."""
    return 1000 * Gamma_e / r2


def Gamma_s(Gamma_e, torque_ratio):
    return torque_ratio * Gamma_e


@mistake("omega4", kind="angle_sign")
def sum_in_denominator(r2, omega2, r4, theta2, theta3, theta4):
    return r2 * omega2 * sin(theta2 - theta3) / (r4 * sin(theta3 + theta4))


@mistake("mode")
def other_mode(mode):
    return np.where(side_of(mode) > 0, "crossed", "open")


@mistake("mechanical_advantage", kind="inverse")
def advantage_inverse(V_e, V_s):
    return V_s / V_e


@mistake("mechanical_advantage")
def advantage_angular(omega2, omega4):
    return abs(omega2 / omega4)


@mistake("mechanical_advantage")
def radii_exchanged(r2, omega2, r4, omega4):
    return abs(r4 * omega2 / (r2 * omega4))


@mistake("mechanical_advantage")
def v_of_rod(V_e, V_BA):
    return V_e / V_BA


@mistake("F_s")
def force_divided(F_e, mechanical_advantage):
    return F_e / mechanical_advantage


@mistake("torque_ratio", kind="inverse")
def torque_ratio_inverse(omega2, omega4):
    return abs(omega4 / omega2)


@mistake("torque_ratio")
def torque_ratio_of_forces(mechanical_advantage):
    return mechanical_advantage


@mistake("Gamma_s")
def torque_with_the_crank_arm(r2, F_s):
    return r2 * F_s / 1000


def polygons(r2, r3, r4, theta2, theta3, theta4, omega2, omega3, omega4):
    AB, CB = polar(r3, theta3), polar(r4, theta4)
    return (
        polygon_of_velocities(
            crank_v("A", "OA", polar(r2, theta2), omega2),
            two_bars_v("B", "A", "C", AB, omega3, CB, omega4),
        ),
    )


def motion(r1, r2, r4, theta2, theta4, omega2, omega4):
    """The pins of input and output."""
    crank, rocker = polar(r2, theta2), polar(r4, theta4)
    return {"A": Moving(crank, 1j * omega2 * crank), "B": Moving(r1 + rocker, 1j * omega4 * rocker)}


def figure(r1, r2, theta2, r3, theta3, omega2, omega4):
    """The velocities of A and B on the linkage, at one scale: those of input and output."""
    O, A, C = 0j, polar(r2, theta2), complex(r1)
    B = A + polar(r3, theta3)
    v_e, v_s = 1j * omega2 * A, 1j * omega4 * (B - C)
    scale = 0.25 * (r1 + r2) / max(abs(v_e), abs(v_s), 1e-9 * r1)
    return Figure(
        line(O, C, dashed=True, label="r_1"),
        link(O, A, label="r_2"),
        link(A, B, label="r_3"),
        link(C, B, label="r_4"),
        vector(A, scale * v_e, "V_e"),
        vector(B, scale * v_s, "V_s"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        paper_mm=(108, 54),
    )


def residual(
    r1,
    r2,
    r3,
    r4,
    theta2,
    omega2,
    mode,
    F_e,
    theta3,
    theta4,
    omega3,
    omega4,
    mechanical_advantage,
    F_s,
    torque_ratio,
    Gamma_s,
):
    """Loop closure and its derivative, the side of B, and the power that each pair of efforts passes on."""
    crank, coupler, rocker = (
        length * np.exp(1j * np.radians(theta))
        for length, theta in ((r2, theta2), (r3, theta3), (r4, theta4))
    )
    turned = (np.conj(r1 - crank) * coupler).imag / (r1 * r3)
    v_A, v_B = 1j * omega2 * crank, 1j * omega4 * rocker
    power = F_e * abs(v_A)
    return (
        abs(crank + coupler - r1 - rocker) / (r1 + r2 + r3 + r4),
        np.maximum(np.where(mode == "open", -turned, turned), 0),
        abs(v_A + 1j * omega3 * coupler - v_B) / (abs(v_A) + abs(v_B)),
        abs(F_s * abs(v_B) - power) / power,
        abs(1000 * Gamma_s * abs(omega4) - power) / power,
        abs(F_s - mechanical_advantage * F_e) / F_s,
        abs(torque_ratio * r2 - mechanical_advantage * r4) / (torque_ratio * r2),
    )


KNOWN = (
    # A parallelogram passes on forces and torques as they are.
    given(r1=100, r2=50, r3=100, r4=50, theta2=90, omega2=-3, mode="open", F_e=80).gives(
        omega4=-3, mechanical_advantage=1, F_s=80, torque_ratio=1, Gamma_s=4
    ),
    # Crank on the frame, ABC a 3-4-5 triangle: coupler and rocker turn alike, by -40/50 of the crank.
    given(r1=90, r2=40, r3=40, r4=30, theta2=0, omega2=5, mode="open", F_e=90).gives(
        theta4="126.8699", omega4=-4, mechanical_advantage=5 / 3, F_s=150, torque_ratio=1.25, Gamma_s=4.5
    ),
    # The crank pointing away from C: 20/100 of its speed, in its own sense.
    given(r1=80, r2=20, r3=60, r4=80, theta2=180, omega2=10, mode="crossed", F_e=60).gives(
        omega3=2, omega4=2, mechanical_advantage=1.25, F_s=75, torque_ratio=5, Gamma_e=1.2, Gamma_s=6
    ),
    # A torque that is given instead of the force, and an advantage that is known.
    given(r2=30, Gamma_e=3, mechanical_advantage=2).gives(F_e=100, F_s=200),
)
