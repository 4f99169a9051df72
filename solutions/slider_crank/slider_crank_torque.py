"""Slider-crank: the crank's torque and the forces in the joints, from the effects that are called for.

Each effect is a bundle of forces and moments on the bodies, inertia among them by d'Alembert's principle;
their sum is balanced body by body from the piston back to the crank. Without effects nothing pulls.

The guide bears on one side of the piston only, and friction follows the side. The force without friction
tells the side; with friction it must not turn over, or the mechanism jams. Past f |tan theta3| = 1 the
other side may balance too: it is not reached from a state without friction, and is left out.
"""

from typing import Any, NamedTuple

import numpy as np

from coursework.accuracy import Motion, Study
from coursework.degrees import atan2, cos, polar, sin, sqrt
from coursework.errors import Undefined
from coursework.figures.polygons import (
    Side,
    crank_a,
    crank_v,
    polygon_of_accelerations,
    polygon_of_velocities,
    slider_a,
    slider_v,
)
from coursework.kinematics.angles import Degrees
from coursework.kinematics.slider_crank import SliderCrank
from coursework.mechanics import Body, Load, Mechanism, Slide
from coursework.solution import formula, given, mistake, stable

GRAVITY = 9.81  #: m/s^2, along -y

UNITS = {
    "p": "mm",
    "q": "mm",
    "theta3": "deg",
    "r1": "mm",
    "omega3": "rad/s",
    "r1_dot": "mm/s",
    "alpha3": "rad/s^2",
    "r1_ddot": "mm/s^2",
    "a_G_x": "mm/s^2",
    "a_G_y": "mm/s^2",
    "X4": "N",
    "Y4": "N",
    "X3": "N",
    "Y3": "N",
    "M2": "N*m",
    "M_A": "N*m",
    "friction_force": "N",
    "R_B_x": "N",
    "R_B_y": "N",
    "R_A_x": "N",
    "R_A_y": "N",
}
SYMBOLS = {"side": r"\sigma", "friction": "f_s", "friction_force": "T"}
EFFECTS = {
    "position": ("theta3", "r1"),
    "velocity": ("omega3", "r1_dot"),
    "acceleration": ("alpha3", "r1_ddot", "a_G_x", "a_G_y"),
    "forces": ("torque", "N_guide", "R_A", "R_B", "R_O"),
}
MECHANISM = Mechanism(
    ground={"O": 0},
    bodies=(
        Body("2", "theta2", "O", {"A": "r2"}, inertia="J2"),
        Body(
            "3", "theta3", "A", {"B": "r3", "G": lambda s3, r3: s3 * r3}, mass="m3", inertia="J3", centre="G"
        ),
        Body("4", 0, "B", mass="m4"),
    ),
    slides=(Slide("B", "4"),),
    loads=(Load("B", force="F"),),
    friction={"B": "f"},
)


class _Loads(NamedTuple):
    """Loads on the bodies besides the joints: forces X4, Y4 on the piston and X3, Y3 on the rod, in N;
    moments M_A on the rod about A and M2 on the crank about O, in N*m."""

    X4: Any = 0.0
    Y4: Any = 0.0
    X3: Any = 0.0
    Y3: Any = 0.0
    M_A: Any = 0.0
    M2: Any = 0.0


_NONE = _Loads()


def p(e, r2, theta2):
    """Height of B above A: r3 sin theta3."""
    return e - r2 * sin(theta2)


@stable(lambda r2, r3, e, theta2: SliderCrank(r2, r3, e).run(Degrees(theta2)))
def q(r3, p):
    """Distance of B to the right of A: r3 cos theta3, positive."""
    return sqrt(r3**2 - p**2)


@formula(r"\arcsin \frac{<p>}{<r3>}")
def theta3(p, q):
    """Direction of AB, between -90 and 90 degrees."""
    return atan2(p, q)


def r1(r2, theta2, q):
    return r2 * cos(theta2) + q


def omega3(r2, omega2, theta2, q):
    """The piston keeps to its line: no velocity across it."""
    return -r2 * omega2 * cos(theta2) / q


def r1_dot(r2, omega2, theta2, p, omega3):
    """Velocity of the piston, positive to the right."""
    return -r2 * omega2 * sin(theta2) - p * omega3


def alpha3(r2, omega2, alpha2, theta2, p, q, omega3):
    """No acceleration across the line either."""
    return (r2 * omega2**2 * sin(theta2) - r2 * alpha2 * cos(theta2) + p * omega3**2) / q


def r1_ddot(r2, omega2, alpha2, theta2, p, q, omega3, alpha3):
    """Acceleration of the piston, positive to the right."""
    return -r2 * alpha2 * sin(theta2) - r2 * omega2**2 * cos(theta2) - p * alpha3 - q * omega3**2


def a_G_x(r2, omega2, alpha2, theta2, s3, p, q, omega3, alpha3):
    """Acceleration of A, and the share s3 of that of B about A."""
    return -r2 * alpha2 * sin(theta2) - r2 * omega2**2 * cos(theta2) - s3 * (p * alpha3 + q * omega3**2)


def a_G_y(r2, omega2, alpha2, theta2, s3, p, q, omega3, alpha3):
    return r2 * alpha2 * cos(theta2) - r2 * omega2**2 * sin(theta2) + s3 * (q * alpha3 - p * omega3**2)


def load(F):
    """The force on the piston."""
    return _Loads(X4=F)


def gravity(m3, m4, s3, q):
    """The weights of rod and piston; that of the balanced crank passes through O."""
    weight = -m3 * GRAVITY
    return _Loads(Y4=-m4 * GRAVITY, Y3=weight, M_A=s3 * q * weight / 1000)


def inertia(m3, J3, m4, J2, s3, p, q, r1_ddot, a_G_x, a_G_y, alpha3, alpha2):
    """The forces and moments of inertia, opposed to the accelerations."""
    X3, Y3 = -m3 * a_G_x / 1000, -m3 * a_G_y / 1000
    return _Loads(
        X4=-m4 * r1_ddot / 1000,
        X3=X3,
        Y3=Y3,
        M_A=s3 * (q * Y3 - p * X3) / 1000 - J3 * alpha3,
        M2=-J2 * alpha2,
    )


def friction(f, r1_dot):
    """The coefficient with the sign of the motion; a piston at rest is given no friction."""
    return f * np.sign(r1_dot)


def applied(inertia=_NONE, gravity=_NONE, load=_NONE):
    """The effects called for, added up."""
    return _Loads(*(a + b + c for a, b, c in zip(inertia, gravity, load, strict=True)))


@formula(r"<F> - <m4> \times \frac{<r1_ddot>}{\num{1000}}")
def X4(applied):
    return applied.X4


@formula(r"-<m4> \times \num{9.81}")
def Y4(applied):
    return applied.Y4


@formula(r"-<m3> \times \frac{<a_G_x>}{\num{1000}}")
def X3(applied):
    return applied.X3


@formula(r"-<m3> \times \left(\num{9.81} + \frac{<a_G_y>}{\num{1000}}\right)")
def Y3(applied):
    return applied.Y3


@formula(r"-<J2> \times <alpha2>")
def M2(applied):
    return applied.M2


@formula(
    r"-\frac{<s3> \times <m3>}{\num{1000}} \times \left(<q> \times \left(\num{9.81} + "
    r"\frac{<a_G_y>}{\num{1000}}\right)"
    r" - <p> \times \frac{<a_G_x>}{\num{1000}}\right) - <J3> \times <alpha3>"
)
def M_A(applied):
    """Moment about A of what acts on the rod, without its joints."""
    return applied.M_A


def side(p, q, X4, Y4, M_A):
    """The side of the guide that bears, +1 under the piston: where it would bear without friction."""
    return np.sign(_push(p, q, X4, Y4, M_A))


def _push(p, q, X4, Y4, M_A):
    """Moment about A of what acts on rod and piston, turned over; N*mm."""
    return p * X4 - q * Y4 - 1000 * M_A


@formula(
    r"\frac{<p> \times <X4> - <q> \times <Y4> - \num{1000} \times <M_A>}"
    r"{<q> + <side> \times <friction> \times <p>}"
)
def N_guide(p, q, X4, Y4, M_A, side, friction=0.0):
    """Force of the guide on the piston: rod and piston balance about A.

    Raises
    ------
    Undefined
        Scalars only: no side of the guide is consistent. NaN in arrays.
    """
    push, arm = _push(p, q, X4, Y4, M_A), q + side * friction * p
    if not isinstance(arm, float):
        return np.where(arm > 0, push / arm, np.nan)
    if not arm > 0:
        raise Undefined(
            f"the mechanism jams: with friction {abs(friction):.6g} the guide can hold the piston on neither "
            f"side, the rod being inclined by tan theta3 = {p:.6g}/{q:.6g}"
        )
    return push / arm


def friction_force(N_guide, friction=0.0):
    """Along +x, on the piston."""
    return -friction * abs(N_guide)


def R_B_x(X4, friction_force):
    """Force of the rod on the piston."""
    return -(X4 + friction_force)


def R_B_y(Y4, N_guide):
    return -(Y4 + N_guide)


def R_A_x(R_B_x, X3):
    """Force of the crank on the rod."""
    return R_B_x - X3


def R_A_y(R_B_y, Y3):
    return R_B_y - Y3


def torque(r2, theta2, R_A_x, R_A_y, M2):
    """The crank balances about O under the drive, the rod and its own inertia."""
    return r2 * (R_A_y * cos(theta2) - R_A_x * sin(theta2)) / 1000 - M2


def R_A(R_A_x, R_A_y):
    return np.hypot(R_A_x, R_A_y)


def R_B(R_B_x, R_B_y):
    return np.hypot(R_B_x, R_B_y)


def R_O(R_A):
    """The balanced crank bears no force but those of its two pins."""
    return R_A


@mistake("load", kind="term_sign")
def load_sign(F):
    return _Loads(X4=-F)


@mistake("friction", kind="term_sign")
def friction_wrong_way(friction):
    return -friction


@mistake("friction")
def friction_forgotten(friction):
    return 0 * friction


@mistake("gravity")
def weights_forgotten(gravity):
    return _Loads(*(0 * part for part in gravity))


@mistake("gravity")
def rod_weight_forgotten(m4):
    return _Loads(Y4=-m4 * GRAVITY)


@mistake("inertia", kind="term_sign")
def inertia_sign(inertia):
    return _Loads(*(-part for part in inertia))


@mistake("inertia")
def inertia_forgotten(inertia):
    return _Loads(*(0 * part for part in inertia))


@mistake("inertia")
def rod_inertia_forgotten(J3, alpha3, inertia):
    return inertia._replace(M_A=inertia.M_A + J3 * alpha3)


@mistake("m3", "J3")
def rod_massless():
    return 0.0, 0.0


@mistake("J2")
def crank_inertia_forgotten():
    return 0.0


@mistake("torque")
def rod_obliquity_forgotten(r2, theta2, F):
    return r2 * F * sin(theta2) / 1000


@mistake("torque", kind="sign")
def torque_of_the_rod_on_the_crank(torque):
    return -torque


def polygons(r2, theta2, omega2, alpha2, s3, p, q, omega3, r1_dot, alpha3, r1_ddot):
    """With the centre of mass of the rod, whose image divides ab as G divides AB."""
    OA, AB = polar(r2, theta2), q + 1j * p
    a_GA = s3 * (1j * alpha3 - omega3**2) * AB
    return (
        polygon_of_velocities(crank_v("A", "OA", OA, omega2), slider_v("B", "A", AB, omega3, r1_dot)),
        polygon_of_accelerations(
            crank_a("A", "OA", OA, omega2, alpha2),
            slider_a("B", "A", AB, omega3, alpha3, "r_3", r1_ddot),
            (
                Side("a", "g", r"\vec{a}_{G/A}", a_GA, r"\parallel ab", r"s_3\,ab"),
                Side("p_a", "g", r"\vec{a}_G", (1j * alpha2 - omega2**2) * OA + a_GA),
            ),
        ),
    )


def residual(
    r2,
    r3,
    e,
    theta2,
    omega2,
    alpha2,
    s3,
    m3,
    J3,
    m4,
    J2,
    F,
    f,
    theta3,
    r1,
    omega3,
    r1_dot,
    alpha3,
    r1_ddot,
    N_guide,
    R_A_x,
    R_A_y,
    torque,
    R_A,
    R_B,
    R_O,
):
    """The closed loop and its derivatives; rod and piston together, the piston alone, the crank alone, about
    O."""
    crank, rod = r2 * np.exp(1j * np.radians(theta2)), r3 * np.exp(1j * np.radians(theta3))
    of_A, of_B = (1j * alpha2 - omega2**2) * crank, (1j * alpha3 - omega3**2) * rod
    position, velocity = crank + rod - r1 - 1j * e, 1j * (omega2 * crank + omega3 * rod) - r1_dot

    at_A = R_A_x + 1j * R_A_y
    guide = 1j * N_guide - f * abs(N_guide) * np.sign(r1_dot)
    on_piston, on_rod = F + guide - 9.81j * m4, -9.81j * m3
    momentum_4, momentum_3 = m4 * r1_ddot / 1000, m3 * (of_A + s3 * of_B) / 1000
    forces = at_A + on_piston + on_rod - momentum_4 - momentum_3

    def about_O(place, force):
        return (np.conj(place) * force).imag / 1000

    G, B = crank + s3 * rod, r1 + 1j * e
    moments = (
        about_O(crank, at_A)
        + about_O(B, on_piston - momentum_4)
        + about_O(G, on_rod - momentum_3)
        - J3 * alpha3
    )
    sum_of_forces = R_A + abs(on_piston) + abs(on_rod) + abs(momentum_4) + abs(momentum_3)
    return (
        abs(position) / (r2 + r3),
        abs(velocity) / (r2 * abs(omega2) + r3 * abs(omega3)),
        abs(of_A + of_B - r1_ddot) / (abs(of_A) + abs(of_B)),
        abs(forces) / sum_of_forces,
        abs(moments) / (sum_of_forces * (r2 + r3) / 1000),
        abs(torque - about_O(crank, at_A) - J2 * alpha2) / (abs(torque) + J2 * abs(alpha2)),
        abs(R_B - abs(on_piston - momentum_4)) / sum_of_forces,
        abs(R_A - abs(at_A)) / R_A,
        abs(R_O - R_A) / R_A,
    )


_UPRIGHT = {"r2": 30, "r3": 50, "theta2": 90}

KNOWN = (
    # Crank upright, a 3-4-5 triangle: the load of 400 N makes 500 N in the rod, and 12 N*m to hold.
    given(**_UPRIGHT, F=-400).under("load").gives(torque=-12, N_guide=300, R_A=500, R_B=500, R_O=500),
    # Friction of coefficient 1/2 helps to hold: 400 = R (4/5 + 3/5 / 2), with R in the rod.
    given(**_UPRIGHT, F=-400, f=0.5, omega2=2)
    .under("load", "friction")
    .gives(torque=-96 / 11, N_guide=2400 / 11, R_A=4000 / 11),
    # The other way round, the rod presses the piston harder onto the guide: 400 = R (4/5 - 3/5 / 2).
    given(**_UPRIGHT, F=-400, f=0.5, omega2=-2)
    .under("load", "friction")
    .gives(torque=-19.2, N_guide=480, R_A=800),
    # Crank and rod level: a quarter of the rod's weight rests on the piston, the rest on the crank pin.
    given(r2=40, r3=120, theta2=0, s3=0.25, m3=2, m4=1)
    .under("gravity")
    .gives(torque=0.5886, N_guide=14.715, R_A=14.715, R_B=4.905),
    # Outer dead centre at a constant rate: the piston is held back at 1.92 m/s^2, G at 1.68 m/s^2.
    given(r2=40, r3=120, theta2=0, omega2=6, s3=0.5, m3=2, J3=1, m4=1, J2=1)
    .under("inertia")
    .gives(torque=0, N_guide=0, R_A=5.28, R_B=1.92),
    # Starting from rest with the crank upright: rod and piston begin to move as one mass of 3 kg.
    given(**_UPRIGHT, omega2=0, alpha2=10, s3=0.5, m3=2, J3=1, m4=1, J2=0.05)
    .under("inertia")
    .gives(torque=0.5 + 3 * 0.3 * 0.03, N_guide=-0.45, R_A=0.45 * 5**0.5, R_B=0.15 * 13**0.5),
    # Nothing called for, nothing borne.
    given(**_UPRIGHT).under().gives(torque=0, N_guide=0, R_A=0, R_B=0, R_O=0),
)

# A crank spun up from rest but for a nudge: some turns, and the inertia of the rod felt in each.
ACCURACY = Study(
    given={
        "r2": 150,
        "r3": 420,
        "e": 30,
        "theta2": 20,
        "omega2": 4,
        "alpha2": 0,
        "s3": 0.35,
        "m3": 12,
        "J3": 0.3,
        "m4": 8,
        "J2": 0.3,
        "F": 0,
        "f": 0.2,
    },
    motion=Motion(effort=3.0, duration=2.0),
)
