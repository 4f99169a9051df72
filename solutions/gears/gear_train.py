"""Ordinary gear train: solution. At a mesh the pitch circles roll without slip: speeds are as the inverse of
the teeth."""

import numpy as np

from coursework.solution import formula, given, mistake

EFFECTS = {"velocity": ("r", "omega2", "omega5", "v")}


def k(mode):
    """Outer teeth on outer teeth reverse, inner teeth do not."""
    return np.where(mode == "external", 3, 2)[()]


@formula(r"\left(-1\right)^{<k>} \times \frac{<z1> \times <z4>}{<z3> \times <z5>}")
def r(k, z1, z3, z4, z5):
    """Driving over driven teeth; the idler is both."""
    return (1 - 2 * (k % 2)) * z1 * z4 / (z3 * z5)


def omega2(omega1, z1, z2):
    return -omega1 * z1 / z2


def omega5(r, omega1):
    return r * omega1


@formula(r"\frac{<m>}{2} \times \left(<z5> + \left(-1\right)^{<k> + 1} \times <z4>\right)")
def a(m, z4, z5, k):
    """Sum of the pitch radii, or their difference where one wheel is inside the other."""
    return m / 2 * (z5 - (1 - 2 * (k % 2)) * z4)


@formula(r"\frac{<m> \times <z1>}{2} \times \left|<omega1>\right|")
def v(m, z1, omega1):
    """On the pitch circle of wheel 1."""
    return m * z1 / 2 * abs(omega1)


@formula(r"\frac{<eta>^3 \times <Gamma1>}{\left|<r>\right|}")
def Gamma5(eta, Gamma1, r):
    """What is left of the power after three meshes, over the speed."""
    return eta**3 * Gamma1 / abs(r)


@mistake("k")
def shafts_counted(k):
    """The two wheels of one shaft as a mesh."""
    return k + 1


@mistake("k")
def idler_counted_once(k):
    """As if the idler were not there."""
    return k - 1


@mistake("r", kind="inverse")
def ratio_upside_down(r):
    return 1 / r


@mistake("r", kind="sign")
def idler_sign_forgotten(r):
    return -r


@mistake("r")
def idler_for_the_wheel_it_drives(r, z2, z3):
    """The teeth of the idler in the place of those of wheel 3."""
    return r * z3 / z2


@mistake("r")
def all_in_a_row(k, z1, z5):
    """As if 4 were another idler."""
    return (1 - 2 * (k % 2)) * z1 / z5


@mistake("omega2")
def idler_by_the_wheel_after_it(omega1, z1, z3):
    return -omega1 * z1 / z3


@mistake("omega5")
def divided_by_the_ratio(omega1, r):
    return omega1 / r


@mistake("a", kind="term_sign")
def other_kind_of_teeth(m, z4, z5, k):
    return m / 2 * (z5 + (1 - 2 * (k % 2)) * z4)


@mistake("v", kind="constant")
def diameter_for_radius(m, z1, omega1):
    return m * z1 * abs(omega1)


@mistake("Gamma5")
def torque_as_the_speed(eta, Gamma1, r):
    return eta**3 * Gamma1 * abs(r)


@mistake("Gamma5")
def efficiency_of_one_mesh(eta, Gamma1, r):
    return eta * Gamma1 / abs(r)


@mistake("Gamma5", approximation=True)
def torque_without_losses(Gamma1, r):
    return Gamma1 / abs(r)


def residual(z1, z2, z3, z4, z5, m, omega1, Gamma1, eta, mode, omega2, omega5, a, v, Gamma5, r):
    """Pitch circles that roll on one another, mesh by mesh, and the power that each leaves."""
    inner = np.where(mode == "internal", -1.0, 1.0)
    speed = m * z1 * abs(omega1)
    omega3 = -omega2 * z2 / z3
    power = Gamma1 * abs(omega1)
    return (
        (m * z1 * omega1 + m * z2 * omega2) / speed,
        (m * z4 * omega3 + inner * m * z5 * omega5) / speed,
        (a - abs(m * z5 + inner * m * z4) / 2) / a,
        (v - m * z1 * abs(omega1) / 2) / v,
        (r * omega1 - omega5) / omega1,
        (Gamma5 * abs(omega5) - power * eta * eta * eta) / power,
    )


KNOWN = (
    # Half of half the speed, three times reversed.
    given(z1=20, z2=30, z3=40, z4=18, z5=36, m=2, omega1=120, Gamma1=10, eta=1, mode="external").gives(
        k=3, r=-0.25, omega2=-80, omega5=-30, a=54, v=2400, Gamma5=40
    ),
    # A third of a quarter, with inner teeth; an idler of the size of its driver.
    given(z1=15, z2=15, z3=45, z4=20, z5=80, m=1.5, omega1=-60, Gamma1=2, eta=0.9, mode="internal").gives(
        k=2, r=1 / 12, omega2=60, omega5=-5, a=45, v=675, Gamma5=24 * 0.729
    ),
)
