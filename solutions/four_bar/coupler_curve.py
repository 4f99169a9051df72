"""Coupler curve: solution. The point P is carried by the coupler: its vector from A turns with AB."""

from itertools import permutations

import numpy as np

from coursework.degrees import angle, atan2, cos, polar, sin
from coursework.figures import Figure, ground_pivot, line, link, pin, trace, vector
from coursework.figures.polygons import Side, crank_v, polygon_of_velocities, turning, two_bars_v
from coursework.kinematics.dyads import rrr, side_of
from coursework.mechanics import Body, Mechanism
from coursework.solution import given, mistake, stable

from ._four_bar import *

UNITS = {"AC": "mm", "phi": "deg", "psi": "deg", "side": "1", "omega4": "rad/s", "theta4": "deg"}
SYMBOLS = {"AC": "AC", "phi": r"\varphi", "psi": r"\psi", "side": r"\varepsilon"}
EFFECTS = {"velocity": ("omega3", "v_P_x", "v_P_y", "v_P", "direction")}
MECHANISM = Mechanism(
    ground={"O": 0, "C": "r1"},
    bodies=(
        Body("2", "theta2", "O", {"A": "r2"}),
        Body("3", "theta3", "A", {"B": "r3", "P": lambda AP, beta: polar(AP, beta)}),
        Body("4", "theta4", "C", {"B": "r4"}),
    ),
)

#: Which curve stands in each of the four drawings, for every arrangement: 0 is that of P, 1 that of beta on
#: the other side of AB, 2 that of the other mode, 3 that of a point laid off at B.
_ORDERS = tuple(permutations(range(4)))
_DRAWINGS = ("I", "II", "III", "IV")


def _arm(AP, beta, theta3):
    """The vector AP: a beta of many turns costs no digit."""
    return polar(AP, beta) * polar(1, theta3)


@stable(lambda r2, theta2, _arm: r2 * cos(theta2) + _arm.real)
def xP(r2, theta2, AP, theta3, beta):
    return r2 * cos(theta2) + AP * cos(theta3 + beta)


@stable(lambda r2, theta2, _arm: r2 * sin(theta2) + _arm.imag)
def yP(r2, theta2, AP, theta3, beta):
    return r2 * sin(theta2) + AP * sin(theta3 + beta)


@stable(lambda r2, omega2, theta2, omega3, _arm: -r2 * omega2 * sin(theta2) - omega3 * _arm.imag)
def v_P_x(r2, omega2, theta2, AP, omega3, theta3, beta):
    return -r2 * omega2 * sin(theta2) - AP * omega3 * sin(theta3 + beta)


@stable(lambda r2, omega2, theta2, omega3, _arm: r2 * omega2 * cos(theta2) + omega3 * _arm.real)
def v_P_y(r2, omega2, theta2, AP, omega3, theta3, beta):
    return r2 * omega2 * cos(theta2) + AP * omega3 * cos(theta3 + beta)


def v_P(v_P_x, v_P_y):
    return np.hypot(v_P_x, v_P_y)


def direction(v_P_x, v_P_y):
    """Of the path, the way that P goes along it."""
    return atan2(v_P_y, v_P_x)


def _drawing_of(curve, arrangement):
    """The drawing in which one of the four curves stands."""
    there = [arrangement == number for number in range(1, len(_ORDERS) + 1)]
    return np.select(there, [_DRAWINGS[order.index(curve)] for order in _ORDERS], "")


def curve(arrangement):
    return _drawing_of(0, arrangement)


@mistake("mode")
def other_mode(mode):
    return np.where(side_of(mode) > 0, "crossed", "open")


@mistake("beta", kind="sign")
def beta_on_the_other_side(beta):
    return -beta


@mistake("xP", "yP")
def beta_from_the_x_axis(r2, theta2, AP, beta):
    return r2 * cos(theta2) + AP * cos(beta), r2 * sin(theta2) + AP * sin(beta)


@mistake("v_P_x", "v_P_y")
def beta_left_out_of_the_velocity(r2, omega2, theta2, AP, omega3, theta3):
    return (
        -r2 * omega2 * sin(theta2) - AP * omega3 * sin(theta3),
        r2 * omega2 * cos(theta2) + AP * omega3 * cos(theta3),
    )


@mistake("v_P_x", "v_P_y")
def coupler_at_the_speed_of_the_crank(r2, omega2, theta2, AP, theta3, beta):
    return (
        -r2 * omega2 * sin(theta2) - AP * omega2 * sin(theta3 + beta),
        r2 * omega2 * cos(theta2) + AP * omega2 * cos(theta3 + beta),
    )


@mistake("v_P_x", "v_P_y")
def velocity_relative_to_A_alone(AP, omega3, theta3, beta):
    return -AP * omega3 * sin(theta3 + beta), AP * omega3 * cos(theta3 + beta)


@mistake("v_P")
def sum_of_the_two_speeds(r2, omega2, AP, omega3):
    return r2 * abs(omega2) + AP * abs(omega3)


@mistake("direction")
def square_to_AP(theta3, beta, omega3):
    return angle(1j * polar(omega3, theta3 + beta))


@mistake("direction", kind="arguments")
def sine_and_cosine_exchanged(v_P_x, v_P_y):
    return atan2(v_P_x, v_P_y)


@mistake("curve")
def curve_of_the_point_across_AB(arrangement):
    return _drawing_of(1, arrangement)


@mistake("curve")
def curve_of_the_other_mode(arrangement):
    return _drawing_of(2, arrangement)


@mistake("curve")
def curve_of_a_point_laid_off_at_B(arrangement):
    return _drawing_of(3, arrangement)


def polygons(r2, r3, r4, AP, beta, theta2, theta3, theta4, omega2, omega3, omega4, v_P_x, v_P_y):
    """Two bars meet at B; P turns with B about A: the triangle abp is similar to ABP."""
    AB, CB = polar(r3, theta3), polar(r4, theta4)
    return (
        polygon_of_velocities(
            crank_v("A", "OA", polar(r2, theta2), omega2),
            two_bars_v("B", "A", "C", AB, omega3, CB, omega4),
            (
                turning("a", "p", "P/A", "AP", _arm(AP, beta, theta3), omega3, r"AP\,V_{B/A} / r_3"),
                Side("p_v", "p", r"\vec{V}_P", v_P_x + 1j * v_P_y),
            ),
        ),
    )


def figure(r1, r2, r3, r4, theta2, theta3, mode, AP, beta, xP, yP, v_P_x, v_P_y):
    """The curve that P draws over the turn, and its velocity, which touches it."""
    O, A, C, P = 0j, polar(r2, theta2), complex(r1), complex(xP, yP)
    B = A + polar(r3, theta3)
    cranks = polar(r2, np.arange(0, 361, 5))
    path = cranks + polar(AP, beta) * (rrr(cranks, r1 + 0j, r3, r4, side_of(mode)) - cranks) / r3
    velocity = complex(v_P_x, v_P_y)
    return Figure(
        line(O, C, dashed=True),
        trace(tuple(map(complex, path)), dotted=False),
        link(O, A, label="r_2"),
        link(A, B, P),
        link(C, B, label="r_4"),
        vector(P, 0.35 * (r1 + r2) * velocity / abs(velocity), r"\vec{v}_P"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        pin(P, "P"),
        paper_mm=(108, 70),
    )


def residual(
    r1, r2, r3, r4, theta2, omega2, mode, AP, beta, theta3, omega3, xP, yP, v_P_x, v_P_y, v_P, direction
):
    """B on both bars and on its side; P at its place on the coupler; A, B and P keep their distances."""
    A, P = r2 * np.exp(1j * np.radians(theta2)), xP + 1j * yP
    coupler = r3 * np.exp(1j * np.radians(theta3))
    rocker = A + coupler - r1
    turned = (np.conj(r1 - A) * coupler).imag / (r1 * r3)
    v_A, at_P = 1j * omega2 * A, v_P_x + 1j * v_P_y
    v_B = v_A + 1j * omega3 * coupler
    speed = abs(v_A) + abs(at_P)
    return (
        (abs(rocker) - r4) / r4,
        np.maximum(np.where(mode == "open", -turned, turned), 0),
        abs((P - A) / coupler - AP / r3 * np.exp(1j * np.radians(beta))),
        (np.conj(rocker) * v_B).real / (r4 * speed),
        (np.conj(P - A) * (at_P - v_A)).real / (AP * speed),
        (np.conj(P - A - coupler) * (at_P - v_B)).real / ((AP + r3) * speed),
        abs(v_P * np.exp(1j * np.radians(direction)) - at_P) / speed,
    )


KNOWN = (
    # A rectangle that is a parallelogram: the coupler only translates, P moves as A does.
    given(r1=100, r2=50, r3=100, r4=50, AP=40, beta=90, theta2=90, omega2=2, mode="open").gives(
        theta3=0, xP=0, yP=90, omega3=0, v_P_x=-100, v_P_y=0, v_P=100, direction=180, curve="I"
    ),
    # Crank along the frame, ABC a 3-4-5 triangle, AP square to AB: P right above O.
    given(r1=80, r2=30, r3=40, r4=30, AP=50, beta=90, theta2=0, omega2=5, mode="open", arrangement=24).gives(
        theta3="36.8699", xP=0, yP=40, omega3=-3, v_P_x=120, v_P_y=240, direction="63.4349", curve="IV"
    ),
    # P at B: it goes round the fixed pivot C as B does.
    given(r1=80, r2=30, r3=40, r4=30, AP=40, beta=0, theta2=0, omega2=5, mode="crossed").gives(
        xP=62, yP=-24, v_P=90, omega3=-3
    ),
)
