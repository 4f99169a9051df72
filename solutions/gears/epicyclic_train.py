"""Epicyclic train: solution. Seen from the carrier it is an ordinary train: (omega3 - omega4) = r0 (omega1 -
omega4)."""

import numpy as np

from coursework.solution import formula, given, mistake, stable

UNITS = {"omega1": "rad/s", "omega3": "rad/s", "omega4": "rad/s"}
EFFECTS = {"velocity": ("omega_b", "omega2", "omega24"), "forces": ("Gamma_out", "Gamma_fix")}


def z3(z1, z2):
    """The ring is as far out as the far side of a planet."""
    return z1 + 2 * z2


@formula(r"-\frac{<z1>}{<z3>}")
def r0(z1, z3):
    """Sun and planet reverse, planet and ring do not."""
    return -z1 / z3


def omega4(mode, omega_a, r0):
    """Willis with omega3 = 0, with omega1 = 0; or the carrier fixed."""
    driven = np.where(mode == "ring", -r0, 1.0) * omega_a / (1 - r0)
    return np.where(mode == "carrier", 0.0, driven)[()]


def omega1(mode, omega_a):
    return np.where(mode == "sun", 0.0, omega_a)[()]


def omega3(mode, omega_a, r0):
    return np.where(mode == "ring", 0.0, np.where(mode == "sun", omega_a, r0 * omega_a))[()]


def omega_b(mode, omega3, omega4):
    return np.where(mode == "carrier", omega3, omega4)[()]


@formula(r"-\frac{<z1>}{<z2>} \times \left(<omega1> - <omega4>\right)")
def omega24(z1, z2, omega1, omega4):
    """Seen from the carrier, the planet meshes with the sun."""
    return -z1 / z2 * (omega1 - omega4)


def omega2(omega4, omega24):
    """By composition."""
    return omega4 + omega24


@formula(r"-\frac{<omega_a>}{<omega_b>} \times <Gamma_in>")
def Gamma_out(omega_a, omega_b, Gamma_in):
    """Nothing is lost: the powers of input and load add up to zero."""
    return -omega_a / omega_b * Gamma_in


def _shares(mode, r0):
    """Of the input's torque, on what is fixed; the forces on a planet are equal at both meshes."""
    return np.where(mode == "ring", -1 / r0, np.where(mode == "sun", -r0, 1 / r0 - 1))[()]


@stable(lambda Gamma_in, omega_a, _shares: _shares * Gamma_in)
def Gamma_fix(Gamma_in, Gamma_out):
    """The torques on the whole train add up to zero."""
    return -Gamma_in - Gamma_out


@mistake("z3", kind="constant")
def ring_as_far_as_a_planet(z1, z2):
    return z1 + z2


@mistake("z3")
def planet_on_both_sides_left_out(z1, z2):
    return 2 * z1 + z2


@mistake("r0", kind="inverse")
def basic_ratio_upside_down(z1, z3):
    return -z3 / z1


@mistake("r0", kind="sign")
def ratio_positive(z1, z3):
    return z1 / z3


@mistake("omega_b")
def another_member_fixed(mode, omega_a, r0):
    """As an ordinary train, or with the ring fixed where it is the carrier."""
    ordinary = np.where(mode == "ring", r0, 1 / r0) * omega_a
    return np.where(mode == "carrier", -r0 / (1 - r0) * omega_a, ordinary)[()]


@mistake("omega24")
def sun_seen_from_the_frame(z1, z2, omega_a):
    return -z1 / z2 * omega_a


@mistake("omega2")
def carrier_left_out_of_the_planet(omega24):
    return omega24


@mistake("Gamma_out", kind="inverse")
def torque_upside_down(omega_a, omega_b, Gamma_in):
    return -omega_b / omega_a * Gamma_in


@mistake("Gamma_out")
def torque_passed_on(Gamma_in):
    return -Gamma_in


@mistake("Gamma_fix")
def held_without_the_load(Gamma_in):
    return -Gamma_in


@mistake("Gamma_fix")
def torques_added(Gamma_in, Gamma_out):
    """Magnitudes, whatever their senses."""
    return -Gamma_in - abs(Gamma_out)


def residual(z1, z2, z3, mode, omega_a, Gamma_in, r0, omega_b, omega24, omega2, Gamma_out, Gamma_fix):
    """Rolling at both meshes, with the velocities of points in the frame; the forces on a planet and its
    pin."""
    omega1 = np.where(mode == "sun", 0.0, omega_a)
    omega3 = np.where(mode == "ring", 0.0, np.where(mode == "sun", omega_a, omega_b))
    omega4 = np.where(mode == "carrier", 0.0, omega_b)
    at_sun, at_ring = z1 * omega1, (z1 + 2 * z2) * omega3  # velocities of pitch points, in units of m / 2
    pin = (z1 + z2) * omega4
    speed = abs(z1 * omega_a) + abs(z3 * omega_a)
    # The planet balances if the forces at both meshes are equal; its pin bears twice as much.
    force = np.where(mode == "sun", Gamma_in / (z1 + 2 * z2), Gamma_in / z1)
    on = {"sun": force * z1, "ring": force * (z1 + 2 * z2), "carrier": -2 * force * (z1 + z2)}
    held = np.where(mode == "ring", on["ring"], np.where(mode == "sun", on["sun"], on["carrier"]))
    load = np.where(mode == "carrier", on["ring"], on["carrier"])
    size = abs(on["carrier"])
    return (
        (z3 - z1 - 2 * z2) / z3,
        (pin - z2 * omega2 - at_sun) / speed,
        (pin + z2 * omega2 - at_ring) / speed,
        (omega2 - omega4 - omega24) / omega_a,
        (omega3 - omega4 - r0 * (omega1 - omega4)) / omega_a,
        (Gamma_out - load) / size,
        (Gamma_fix - held) / size,
    )


KNOWN = (
    # Sun and planets alike: the ring has three times the teeth, the carrier a quarter of the speed.
    given(z1=20, z2=20, mode="ring", omega_a=400, Gamma_in=10).gives(
        z3=60, r0=-1 / 3, omega_b=100, omega24=-300, omega2=-200, Gamma_out=-40, Gamma_fix=30
    ),
    given(z1=20, z2=20, mode="sun", omega_a=400, Gamma_in=30).gives(
        omega_b=300, omega24=300, omega2=600, Gamma_out=-40, Gamma_fix=10
    ),
    given(z1=20, z2=20, mode="carrier", omega_a=-300, Gamma_in=10).gives(
        omega_b=100, omega24=300, omega2=300, Gamma_out=30, Gamma_fix=-40
    ),
    # A planet half as large as the sun.
    given(z1=40, z2=20, mode="ring", omega_a=90, Gamma_in=1).gives(
        z3=80, r0=-0.5, omega_b=30, omega24=-120, omega2=-90
    ),
)
