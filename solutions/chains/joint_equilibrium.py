"""Equilibrium of a joint: solution. Of the six equations five give the unknowns, and the sixth, without any,
the motor's torque."""

import numpy as np

from coursework.solution import formula, given, mistake

EFFECTS = {"forces": ("X", "Y_A", "Z_A", "Y_B", "Z_B", "Gamma")}
_UNKNOWNS = {"ball": 3, "cylindrical": 4, "revolute": 5}


def moment_z():
    return "b*Y_B + d*F_y - R*F_x = 0"


def moment_y():
    return "b*Z_B + d*F_z = 0"


def X(F_x):
    """Only the ball joint can bear a force along the axis."""
    return -F_x


def Y_B(R, F_x, d, F_y, b):
    return (R * F_x - d * F_y) / b


def Z_B(d, F_z, b):
    return -d * F_z / b


def Y_A(F_y, Y_B):
    return -F_y - Y_B


def Z_A(F_z, Z_B):
    return -F_z - Z_B


def Gamma(R, F_z):
    """No joint bears a moment about the axis."""
    return -R * F_z / 1000


def _of_B(other):
    return np.select([other == name for name in _UNKNOWNS], list(_UNKNOWNS.values()))[()]


def Ns(_of_B):
    """Three of the ball joint at A, besides those of B."""
    return 3 + _of_B


@formula(r"<Ns> - 5")
def h(Ns):
    """Five equations of equilibrium hold the unknowns; that of the moments about x has none."""
    return Ns - 5


@mistake("moment_z", "Y_B")
def axial_force_without_a_moment(d, F_y, b):
    return "b*Y_B + d*F_y = 0", -d * F_y / b


@mistake("moment_z", "Y_B", kind="term_sign")
def axial_moment_reversed(R, F_x, d, F_y, b):
    return "b*Y_B + d*F_y + R*F_x = 0", -(R * F_x + d * F_y) / b


@mistake("moment_y", "Z_B")
def arm_from_the_other_bearing(b, d, F_z):
    return "b*Z_B + (b - d)*F_z = 0", -(b - d) * F_z / b


@mistake("X", kind="sign")
def action_of_the_shaft(F_x):
    """On the frame."""
    return F_x


@mistake("Y_A", "Z_A")
def half_each(F_y, F_z):
    return -F_y / 2, -F_z / 2


@mistake("Gamma")
def torque_of_the_radial_force(R, F_y):
    return -R * F_y / 1000


@mistake("Ns")
def freedoms_for_unknowns(_of_B):
    return 3 + (6 - _of_B)


@mistake("h")
def six_equations_for_five(Ns):
    """As if the shaft could not turn."""
    return Ns - 6


def residual(b, d, R, F_x, F_y, F_z, X, Y_A, Z_A, Y_B, Z_B, Gamma):
    """Resultant of the forces on the shaft, and their moments about B and about D, as vectors."""
    zero = np.zeros_like(X)

    def vector(*entries):
        return np.stack(np.broadcast_arrays(*entries), axis=-1)

    forces = (
        (vector(zero, zero, zero), vector(X, Y_A, Z_A)),
        (vector(b, zero, zero), vector(zero, Y_B, Z_B)),
        (vector(d, R, zero), vector(F_x, F_y, F_z)),
    )
    torque = vector(1000 * Gamma, zero, zero)
    size = abs(F_x) + abs(F_y) + abs(F_z)
    found = [np.linalg.norm(sum(force for _, force in forces), axis=-1) / size]
    for centre in (vector(b, zero, zero), vector(d, R, zero)):
        moment = torque + sum(np.cross(at - centre, force) for at, force in forces)
        found.append(np.linalg.norm(moment, axis=-1) / (size * (b + d + R)))
    return tuple(found)


KNOWN = (
    # The wheel in the middle, without axial force: half each.
    given(b=200, d=100, R=50, F_x=0, F_y=400, F_z=-600, other="ball").gives(
        X=0, Y_A=-200, Y_B=-200, Z_A=300, Z_B=300, Gamma=30, Ns=6, h=1
    ),
    # Overhanging by half, and an axial force whose moment is that of the radial one.
    given(b=100, d=150, R=75, F_x=-200, F_y=-100, F_z=200, other="revolute").gives(
        X=200, Y_B=0, Y_A=100, Z_B=-300, Z_A=100, Gamma=-15, Ns=8, h=3
    ),
    given(other="cylindrical").gives(Ns=7, h=2),
)
