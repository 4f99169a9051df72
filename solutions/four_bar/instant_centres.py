"""Instant centres of a four-bar linkage: solution. Three centres of three bodies lie on one line.

I12, I23, I34 and I14 are the pins O, A, B and C. A point of one body at a centre is a point of the other: its
velocity, written twice, gives a ratio of angular velocities.
"""

import numpy as np

from coursework.degrees import polar, sin
from coursework.errors import Undefined
from coursework.figures import Figure, ground_pivot, line, link, pin, point, vector
from coursework.figures.polygons import crank_v, polygon_of_velocities, two_bars_v
from coursework.kinematics.dyads import side_of
from coursework.solution import formula, given, mistake, stable

from ._four_bar import *

UNITS = {"AC": "mm", "phi": "deg", "psi": "deg", "side": "1", "theta3": "deg", "theta4": "deg", "l_M": "mm"}
SYMBOLS = {"AC": "AC", "phi": r"\varphi", "psi": r"\psi", "side": r"\varepsilon", "l_M": r"I_{13}M"}
EFFECTS = {"position": ("x24", "d13"), "velocity": ("omega3", "omega4", "v_M")}


@formula(r"\frac{<n> \times \left(<n> - 1\right)}{2}")
def N(n):
    """A centre for each pair of bodies."""
    return n * (n - 1) // 2


def lines_13():
    """Bodies 1, 2, 3 have their centres on OA, bodies 1, 3, 4 on CB."""
    return "lines_12_23_and_14_34"


def lines_24():
    """Bodies 1, 2, 4 have their centres on the frame, bodies 2, 3, 4 on the coupler."""
    return "lines_12_14_and_23_34"


def _over(numerator, denominator):
    """A quotient that does not exist where two lines are parallel."""
    if np.ndim(denominator) == 0 and denominator == 0:
        raise Undefined("two lines that should cross at an instant centre are parallel: it is at infinity")
    return numerator / np.where(denominator == 0, np.nan, denominator)[()]


@formula(r"\frac{<r2> \times \sin\left(<theta3> - <theta2>\right)}{\sin <theta3>}")
def x24(r2, theta2, theta3):
    """On the frame and on the coupler."""
    return _over(r2 * sin(theta3 - theta2), sin(theta3))


@formula(r"\frac{<x24>}{<x24> - <r1>} \times <omega2>")
@stable(lambda omega2, _linkage: _linkage.rocker_ratio * omega2)
def omega4(omega2, x24, r1):
    """I24 as a point of the crank and as a point of the rocker."""
    return _over(x24, x24 - r1) * omega2


@formula(r"\frac{<r1> \times \sin <theta4>}{\sin\left(<theta4> - <theta2>\right)}")
def d13(r1, theta2, theta4):
    """On the crank and on the rocker."""
    return _over(r1 * sin(theta4), sin(theta4 - theta2))


@formula(r"\frac{<r2>}{<r2> - <d13>} \times <omega2>")
@stable(lambda omega2, _linkage: _linkage.coupler_ratio * omega2)
def omega3(omega2, r2, d13):
    """A as a point of the crank and as a point of the coupler, which turns about I13."""
    return _over(r2, r2 - d13) * omega2


@formula(
    r"\sqrt{\left(<r2> - <d13>\right)^2 + \frac{<r3>^2}{4}"
    r" + \left(<r2> - <d13>\right) \times <r3> \times \cos\left(<theta3> - <theta2>\right)}"
)
def l_M(r2, theta2, r3, theta3, d13):
    """Law of cosines in the triangle I13, A, M."""
    return abs(polar(r2 - d13, theta2) + polar(r3 / 2, theta3))


@formula(r"<l_M> \times \left|<omega3>\right|")
@stable(
    lambda r2, omega2, theta2, r3, theta3, omega3: abs(
        polar(r2 * omega2, theta2) + polar(r3 / 2 * omega3, theta3)
    )
)
def v_M(l_M, omega3):
    """The coupler turns about I13."""
    return l_M * abs(omega3)


@mistake("N", kind="constant")
def each_pair_twice(n):
    return n * (n - 1)


@mistake("N", kind="term_sign")
def each_body_with_itself(n):
    return n * (n + 1) // 2


@mistake("lines_13", "lines_24")
def lines_of_the_other_centre():
    return "lines_12_14_and_23_34", "lines_12_23_and_14_34"


@mistake("lines_13", "lines_24")
def lines_through_opposite_pins():
    return "lines_12_34_and_14_23", "lines_12_34_and_14_23"


@mistake("x24")
def I24_measured_from_C(x24, r1):
    return x24 - r1


@mistake("d13")
def measured_from_A(d13, r2):
    return d13 - r2


@mistake("omega4", "omega3", kind="inverse")
def ratio_upside_down(omega2, omega3, omega4):
    return omega2**2 / omega4, omega2**2 / omega3


@mistake("omega3")
def speed_of_A_over_its_distance_to_O(omega2, r2, d13):
    """OI13 for AI13."""
    return r2 * omega2 / d13


@mistake("v_M")
def about_A(r3, omega3):
    return r3 / 2 * abs(omega3)


@mistake("v_M")
def mean_of_the_ends(r2, omega2, r4, omega4):
    return (r2 * abs(omega2) + r4 * abs(omega4)) / 2


@mistake("mode")
def other_mode(mode):
    return np.where(side_of(mode) > 0, "crossed", "open")


def polygons(r2, r3, r4, theta2, theta3, theta4, omega2, omega3, omega4):
    """The same velocities without any centre."""
    AB, CB = polar(r3, theta3), polar(r4, theta4)
    return (
        polygon_of_velocities(
            crank_v("A", "OA", polar(r2, theta2), omega2), two_bars_v("B", "A", "C", AB, omega3, CB, omega4)
        ),
    )


def figure(r1, r2, theta2, r3, theta3, omega2, omega3, x24, d13):
    """The lines that cross at both centres, and the velocities of A and M, perpendicular to those from
    I13."""
    O, A, C = 0j, polar(r2, theta2), complex(r1)
    B, I13, I24 = A + polar(r3, theta3), polar(d13, theta2), complex(x24)
    M = (A + B) / 2
    v_A, v_M = 1j * omega2 * A, 1j * omega3 * (M - I13)
    scale = 0.3 * r1 / max(abs(v_A), abs(v_M))
    return Figure(
        *(line(end, I13, dashed=True) for end in (O, A, B, C, M)),
        *(line(end, I24, dashed=True) for end in (O, C, A, B)),
        link(O, A),
        link(A, B),
        link(C, B),
        vector(A, scale * v_A, "v_A"),
        vector(M, scale * v_M, "v_M"),
        ground_pivot(O, "I_{12}"),
        ground_pivot(C, "I_{14}"),
        pin(A, "I_{23}"),
        pin(B, "I_{34}"),
        point(M, "M"),
        point(I13, "I_{13}"),
        point(I24, "I_{24}"),
        paper_mm=(120, 90),
    )


def residual(r1, r2, r3, r4, theta2, omega2, mode, theta3, theta4, x24, d13, omega3, omega4, v_M):
    """Loop closure; each centre on its two lines; the velocities of the loop and of M, without any centre."""
    crank, coupler, rocker = (
        length * np.exp(1j * np.radians(theta))
        for length, theta in ((r2, theta2), (r3, theta3), (r4, theta4))
    )
    turned = (np.conj(r1 - crank) * coupler).imag / (r1 * r3)
    v_A, v_B = 1j * omega2 * crank, 1j * omega4 * rocker
    speeds = abs(v_A) + abs(v_B)
    I13 = d13 * crank / r2
    return (
        abs(crank + coupler - r1 - rocker) / (r1 + r2 + r3 + r4),
        np.maximum(np.where(mode == "open", -turned, turned), 0),
        ((x24 - crank) * np.conj(coupler)).imag / (r3 * (r2 + abs(x24))),
        ((I13 - r1) * np.conj(rocker)).imag / (r4 * (r1 + abs(d13))),
        abs(v_A + 1j * omega3 * coupler - v_B) / speeds,
        (v_M - abs(v_A + v_B) / 2) / speeds,
    )


KNOWN = (
    # Six bodies, a shaper: fifteen centres.
    given(n=6).gives(N=15),
    given(n=4).gives(N=6),
    # Crank upright and coupler at -45 degrees, of height 30: I24 is where it meets the frame. B is at (90,
    # 10): the rocker slopes by -1/3, and meets the line of the crank at 40.
    given(r1=120, r2=100, r3=90 * 2**0.5, r4=1000**0.5, theta2=90, omega2=3, mode="crossed").gives(
        x24=100, omega4=-15, d13=40, omega3=5, v_M=5 * 2250**0.5
    ),
    # A 3-4-5 triangle ABC, right-angled at B, the crank along the frame: coupler and rocker turn alike, about
    # C.
    given(r1=90, r2=40, r3=40, r4=30, theta2=0, omega2=5, mode="open").gives(
        omega4=-4, omega3=-4, x24=40, d13=90
    ),
    # A crossed parallelogram: crank and coupler are alike by reflection in the bisector of their lines, IA =
    # IC, so that x + sqrt(x^2 + 60^2) = 100.
    given(r1=100, r2=60, r3=100, r4=60, theta2=90, omega2=2, mode="crossed").gives(x24=32, omega4=-16 / 17),
)
