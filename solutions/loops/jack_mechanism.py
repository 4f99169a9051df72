"""A body tipped by a jack: solution. The triangle OBA gives the positions; the loop derived twice, projected
along the jack and across it, gives the rates one at a time.
"""

from math import pi

import numpy as np

from coursework.degrees import acos, atan2, cos, from_radians, polar, sin, sqrt, wrap
from coursework.errors import Undefined
from coursework.figures import Figure, ground_pivot, line, link, pin, point, vector
from coursework.figures.polygons import (
    Side,
    normal,
    polygon_of_accelerations,
    polygon_of_velocities,
    tangential,
    turning,
)
from coursework.kinematics.chains import Vector
from coursework.kinematics.triangles import corner
from coursework.mechanics import Body, Mechanism, Slide
from coursework.solution import Moving, formula, given, mistake, stable

UNITS = {"OB": "mm", "beta": "deg", "gamma": "deg", "mu": "deg"}
SYMBOLS = {"OB": "OB", "beta": r"\beta", "gamma": r"\gamma", "mu": r"\mu"}
LOOPS = {
    "loop_1": (Vector("xB", 0.0), Vector("yB", pi / 2), Vector("L", "theta2"), Vector("a", "theta4", -1))
}
EFFECTS = {
    "velocity": ("omega4", "omega2", "v_G"),
    "acceleration": ("alpha4", "alpha2", "a_G"),
    "coriolis": ("a_coriolis",),
}
#: Counted by the tilt of the body; the drive acts along the jack, between cylinder and rod, and its thrust is
#: the moment that would hold the body alone, times omega4 / L_dot.
MECHANISM = Mechanism(
    ground={"O": 0, "B": lambda xB, yB: xB + 1j * yB},
    bodies=(
        Body("4", "theta4", "O", {"A": "a", "G": lambda c, eta: polar(c, eta)}),
        Body("3", "theta2", "A"),
        Body("2", "theta2", "B"),
    ),
    slides=(Slide("A", "3", on="2"),),
    pushed="A",
)


def OB(xB, yB):
    return np.hypot(xB, yB)


def beta(xB, yB):
    """Direction of OB, by its quadrant."""
    return atan2(yB, xB)


@stable(lambda a, OB, L: from_radians(corner(a, OB, L)))
def gamma(a, OB, L):
    """The angle BOA, by the law of cosines."""
    return acos((a**2 + OB**2 - L**2) / (2 * a * OB))


def theta4(beta, gamma):
    return wrap(beta + gamma)


@stable(lambda a, OB, L: from_radians(corner(a, L, OB)))
def mu(a, L, OB):
    """The angle OAB."""
    return acos((a**2 + L**2 - OB**2) / (2 * a * L))


def theta2(theta4, mu):
    return wrap(theta4 + mu)


def _carried(c, eta, theta4):
    """The vector OG: an eta of many turns costs no digit."""
    return polar(c, eta) * polar(1, theta4)


@stable(lambda _carried: _carried.imag)
def yG(c, theta4, eta):
    return c * sin(theta4 + eta)


@formula(
    r"\arccos \left(\frac{<a>^2 + <OB>^2 - <L_max>^2}{2 \times <a> \times <OB>}\right)"
    r" - \arccos \left(\frac{<a>^2 + <OB>^2 - <L_min>^2}{2 \times <a> \times <OB>}\right)"
)
def swing(a, OB, L_max, L_min):
    """Between the two ends of the jack."""
    return from_radians(corner(a, OB, L_max) - corner(a, OB, L_min))


def omega4(L_dot, a, mu):
    """The velocity of A along the jack is that at which it grows."""
    if np.ndim(mu) == 0 and sin(mu) == 0:
        raise Undefined("the jack lies along OA: a dead point, where it cannot turn the body")
    return L_dot / (a * sin(mu))


def omega2(a, omega4, mu, L):
    """The velocity of A across the jack turns it."""
    return a * omega4 * cos(mu) / L


def v_G(c, omega4):
    return c * abs(omega4)


def a_coriolis(omega2, L_dot):
    return 2 * omega2 * L_dot


def alpha4(L_ddot, L, omega2, a, omega4, mu):
    """The acceleration of A along the jack."""
    return (L_ddot - L * omega2**2 + a * omega4**2 * cos(mu)) / (a * sin(mu))


def alpha2(a, alpha4, omega4, mu, a_coriolis, L):
    """Its acceleration across the jack, less the Coriolis term."""
    return (a * alpha4 * cos(mu) + a * omega4**2 * sin(mu) - a_coriolis) / L


def a_G(c, alpha4, omega4):
    return c * sqrt(alpha4**2 + omega4**4)


@mistake("theta4")
def angle_from_OB(gamma):
    return gamma


@mistake("gamma", kind="term_sign")
def cosine_rule_sign(a, OB, L):
    return acos((L**2 - a**2 - OB**2) / (2 * a * OB))


@mistake("theta2")
def jack_square_to_the_body(theta4):
    return wrap(theta4 + 90)


@mistake("theta2", kind="term_sign")
def jack_on_the_other_side_of_OA(theta4, mu):
    return wrap(theta4 - mu)


@mistake("yG")
def G_on_the_line_OA(c, theta4):
    return c * sin(theta4)


@mistake("swing")
def swing_up_to_now(gamma, a, OB, L_min):
    return gamma - from_radians(corner(a, OB, L_min))


@mistake("omega4")
def jack_speed_as_speed_of_A(L_dot, a):
    return L_dot / a


@mistake("omega4")
def jack_speed_projected_on_the_path_of_A(L_dot, a, mu):
    return L_dot * sin(mu) / a


@mistake("omega2")
def jack_turns_with_the_body(omega4):
    return omega4


@mistake("omega2")
def whole_speed_of_A_across_the_jack(a, omega4, L):
    return a * omega4 / L


@mistake("v_G")
def speed_of_A_for_G(a, omega4):
    return a * abs(omega4)


@mistake("a_coriolis", kind="constant")
def coriolis_no_2(omega2, L_dot):
    return omega2 * L_dot


@mistake("a_coriolis")
def coriolis_of_the_body(omega4, L_dot):
    return 2 * omega4 * L_dot


@mistake("alpha4")
def no_normal_terms(L_ddot, a, mu):
    return L_ddot / (a * sin(mu))


@mistake("alpha4")
def turning_of_the_jack_left_out(L_ddot, a, omega4, mu):
    return (L_ddot + a * omega4**2 * cos(mu)) / (a * sin(mu))


@mistake("alpha2")
def no_coriolis(a, alpha4, omega4, mu, L):
    return (a * alpha4 * cos(mu) + a * omega4**2 * sin(mu)) / L


@mistake("a_G")
def a_G_tangential_only(c, alpha4):
    return c * abs(alpha4)


def polygons(a, c, eta, L, L_dot, L_ddot, theta2, theta4, omega2, omega4, alpha2, alpha4, a_coriolis):
    """A_2 is the cylinder's point under A: what the jack gives is laid off first, along it; G turns with A
    about O."""
    along, OA, OG = polar(1, theta2), polar(a, theta4), polar(c, theta4 + eta)
    BA = L * along
    return (
        polygon_of_velocities(
            (
                Side(
                    "p_v", "a'", r"\vec{V}_{A/A_2}", L_dot * along, r"\parallel BA", r"\left|\dot{L}\right|"
                ),
                turning("a'", "a", "A_2", "BA", BA, omega2),
                turning("p_v", "a", "A", "OA", OA, omega4),
                turning("p_v", "g", "G", "OG", OG, omega4, r"c\,V_A / a"),
            )
        ),
        polygon_of_accelerations(
            (
                normal("p_a", "a_2'", "A_2", "BA", BA, omega2, "V_{A_2}^2 / L"),
                Side(
                    "a_2'",
                    "k'",
                    r"\vec{a}^c_{A/A_2}",
                    1j * a_coriolis * along,
                    r"\perp BA",
                    r"2 \left|\omega_2\right| V_{A/A_2}",
                ),
                Side(
                    "k'",
                    "k",
                    r"\vec{a}^s_{A/A_2}",
                    L_ddot * along,
                    r"\parallel BA",
                    r"\left|\ddot{L}\right|",
                ),
                normal("p_a", "a'", "A", "OA", OA, omega4, "V_A^2 / a"),
                tangential("k", "a", "A_2", "BA", BA, alpha2),
                tangential("a'", "a", "A", "OA", OA, alpha4),
                normal("p_a", "g'", "G", "OG", OG, omega4, "V_G^2 / c"),
                tangential("g'", "g", "G", "OG", OG, alpha4, r"c\,a_A^t / a"),
                Side("p_a", "g", r"\vec{a}_G", (1j * alpha4 - omega4**2) * OG),
            )
        ),
    )


def motion(a, c, eta, theta4, omega4, alpha4):
    """The jack's head and the centre of the load, the jack growing at its rate."""
    A, G = polar(a, theta4), polar(c, theta4 + eta)
    return {
        name: Moving(at, 1j * omega4 * at, (1j * alpha4 - omega4**2) * at)
        for name, at in (("A", A), ("G", G))
    }


def figure(xB, yB, a, L, c, eta, theta4, theta2, omega4, L_dot):
    """The velocity of A, square to OA, and its part along the jack."""
    O, B, A, G = 0j, complex(xB, yB), polar(a, theta4), polar(c, theta4 + eta)
    scale = 0.35 * a / abs(a * omega4)
    return Figure(
        line(O, 1.05 * a + 0j, dashed=True),
        line(O, B, dashed=True, label="OB"),
        link(O, A, G),
        link(B, A, label="L"),
        line(A + scale * 1j * omega4 * A, A + scale * polar(L_dot, theta2), dashed=True),
        vector(A, scale * 1j * omega4 * A, r"\vec{v}_A"),
        vector(A, scale * polar(L_dot, theta2), r"\dot{L}"),
        ground_pivot(O, "O"),
        ground_pivot(B, "B"),
        pin(A, "A"),
        point(G, "G"),
        paper_mm=(108, 66),
    )


def residual(
    a,
    xB,
    yB,
    L,
    L_dot,
    L_ddot,
    L_min,
    L_max,
    c,
    eta,
    theta4,
    yG,
    theta2,
    swing,
    omega4,
    omega2,
    alpha4,
    alpha2,
    a_coriolis,
    v_G,
    a_G,
):
    """The loop and its two derivatives, as complex equations; the body above OB; the ends of the jack."""
    arm, way = a * np.exp(1j * np.radians(theta4)), np.exp(1j * np.radians(theta2))
    foot = xB + 1j * yB
    speed, size = abs(L_dot) + a * abs(omega4), abs(L_ddot) + a * (omega4**2 + abs(alpha4))
    closed = (a**2 + abs(foot) ** 2 - np.array([L_min, L_max]) ** 2) / (2 * a * abs(foot))
    acceleration = L_ddot - L * omega2**2 + 1j * (L * alpha2 + a_coriolis)
    return (
        abs(foot + L * way - arm) / (a + L),
        np.maximum(-(np.conj(foot) * arm).imag, 0) / a**2,
        abs((L_dot + 1j * L * omega2) * way - 1j * omega4 * arm) / speed,
        abs(acceleration * way - (1j * alpha4 - omega4**2) * arm) / size,
        a_coriolis / size - 2 * L_dot * omega2 / size,
        np.radians(swing) - np.arccos(closed[1]) + np.arccos(closed[0]),
        yG / c - (np.exp(1j * np.radians(eta)) * arm).imag / a,
        (v_G - c * abs(omega4)) / speed,
        (a_G - c * abs(1j * alpha4 - omega4**2)) / size,
    )


_SQUARE = {"a": 400, "xB": 400, "yB": -300, "L_min": 250, "L_max": 600, "c": 200, "eta": 30}

KNOWN = (
    # The body level, the jack upright under A, growing steadily: OBA a 3-4-5 triangle.
    given(**_SQUARE, L=300, L_dot=120, L_ddot=0).gives(
        theta4=0, theta2=90, yG=100, omega4=0.3, omega2=0, v_G=60, a_coriolis=0, alpha4=0, alpha2=0.12, a_G=18
    ),
    # OA square to OB and as long: the jack makes half a right angle with both.
    given(
        a=500, xB=300, yB=-400, L_min=400, L_max=900, c=250, eta=20, L=500 * 2**0.5, L_dot=100, L_ddot=0
    ).gives(theta4="36.8699", theta2="81.8699", omega4=0.2 * 2**0.5, omega2=0.1 * 2**0.5),
    # The jack's ends: OBA with 60 and 90 degrees at O.
    given(
        a=500, xB=300, yB=-400, L_min=500, L_max=500 * 2**0.5, c=250, eta=20, L=500, L_dot=90, L_ddot=0
    ).gives(swing=30, theta4="6.8699", theta2="66.8699"),
)
