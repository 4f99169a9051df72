"""Two positions of a coupler: solution. A pivot is as far from both places of its pin: on the perpendicular
bisector.

The two bisectors cross at the pole. The solution takes, on each, the point as far below the chord as the
coupler is long.
"""

import numpy as np

from coursework.degrees import cos, sin
from coursework.figures import Figure, axes, ground_pivot, line, link, pin, point
from coursework.solution import Judged, formula, given, judge, mistake

from ...exercises.synthesis._positions import in_its_place, placed, side
from ._pivots import PIVOTS, judged_lengths, of_placement, pivots_of

UNITS = {
    "x_B1": "mm",
    "y_B1": "mm",
    "x_B2": "mm",
    "y_B2": "mm",
    "d_A": "mm",
    "d_B": "mm",
    "half": "deg",
    "frame": "mm",
}
SYMBOLS = {
    "x_B1": "x_{B_1}",
    "y_B1": "y_{B_1}",
    "x_B2": "x_{B_2}",
    "y_B2": "y_{B_2}",
    "d_A": "A_1A_2",
    "d_B": "B_1B_2",
    "half": r"\frac{\varphi_{12}}{2}",
    "frame": "OC",
}


def x_B1(x1, L, phi1):
    return x1 + L * cos(phi1)


def y_B1(y1, L, phi1):
    return y1 + L * sin(phi1)


def x_B2(x2, L, phi2):
    return x2 + L * cos(phi2)


def y_B2(y2, L, phi2):
    return y2 + L * sin(phi2)


def half(phi1, phi2):
    return (phi2 - phi1) / 2


@formula(r"\frac{<x1> + <x2>}{2} - \frac{<y2> - <y1>}{2} \times \frac{\cos <half>}{\sin <half>}")
def x_P(x1, x2, y1, y2, half):
    """On the bisector of A1 A2, which is seen from there under twice the half angle."""
    return (x1 + x2) / 2 - (y2 - y1) / 2 * cos(half) / sin(half)


@formula(r"\frac{<y1> + <y2>}{2} + \frac{<x2> - <x1>}{2} \times \frac{\cos <half>}{\sin <half>}")
def y_P(x1, x2, y1, y2, half):
    return (y1 + y2) / 2 + (x2 - x1) / 2 * cos(half) / sin(half)


def d_A(x1, x2, y1, y2):
    return np.hypot(x2 - x1, y2 - y1)


def d_B(x_B1, x_B2, y_B1, y_B2):
    return np.hypot(x_B2 - x_B1, y_B2 - y_B1)


@formula(r"\frac{<x1> + <x2>}{2} + <L> \times \frac{<y2> - <y1>}{<d_A>}")
def x_O(x1, x2, y1, y2, L, d_A):
    """From the middle of the chord, the length of the coupler to its right."""
    return (x1 + x2) / 2 + L * (y2 - y1) / d_A


@formula(r"\frac{<y1> + <y2>}{2} - <L> \times \frac{<x2> - <x1>}{<d_A>}")
def y_O(x1, x2, y1, y2, L, d_A):
    return (y1 + y2) / 2 - L * (x2 - x1) / d_A


@formula(r"\frac{<x_B1> + <x_B2>}{2} + <L> \times \frac{<y_B2> - <y_B1>}{<d_B>}")
def x_C(x_B1, x_B2, y_B1, y_B2, L, d_B):
    return (x_B1 + x_B2) / 2 + L * (y_B2 - y_B1) / d_B


@formula(r"\frac{<y_B1> + <y_B2>}{2} - <L> \times \frac{<x_B2> - <x_B1>}{<d_B>}")
def y_C(x_B1, x_B2, y_B1, y_B2, L, d_B):
    return (y_B1 + y_B2) / 2 - L * (x_B2 - x_B1) / d_B


@formula(r"\sqrt{\left(<x1> - <x_O>\right)^2 + \left(<y1> - <y_O>\right)^2}")
def r2(x1, y1, x_O, y_O):
    return np.hypot(x1 - x_O, y1 - y_O)


@formula(r"\sqrt{\left(<x_B1> - <x_C>\right)^2 + \left(<y_B1> - <y_C>\right)^2}")
def r4(x_B1, y_B1, x_C, y_C):
    return np.hypot(x_B1 - x_C, y_B1 - y_C)


def _faults(O, C, first, second, L):
    """Of a pair of pivots, by name, in the order in which they are told."""
    (A1, B1), (A2, B2) = first, second
    r2, r4 = abs(A1 - O), abs(B1 - C)
    shortest, longest = L / 3, 4 * L
    unwieldy = (np.minimum(r2, r4) < shortest) | (np.maximum(r2, r4) > longest) | (abs(C - O) < L / 2)
    return of_placement(O, C, (first, second)) | {
        "out_of_bounds": unwieldy,
        "assembled_otherwise": side(A1, B1, C) != side(A2, B2, C),
    }


def fault(x_O, y_O, x_C, y_C, x1, y1, phi1, x2, y2, phi2, L):
    """Of the pivots of the solution: none, with room to spare."""
    first, second = placed(x1, y1, phi1, L), placed(x2, y2, phi2, L)
    C = x_C + 1j * y_C
    faults = _faults(x_O + 1j * y_O, C, first, second, L)
    flat = [abs((np.conj(C - A) * (B - A)).imag) < 0.15 * L * abs(C - A) for A, B in (first, second)]
    return np.where(
        faults["out_of_bounds"] | faults["assembled_otherwise"] | flat[0] | flat[1], "some", "none"
    )[()]


@judge
def passes_both_positions(answers, x1, y1, phi1, x2, y2, phi2, L):
    """Any pair of pivots from which the coupler reaches both positions; lengths from the student's own
    pivots."""
    pivots = pivots_of(answers)
    if pivots is None:
        return {}
    O, C = pivots
    first, second = placed(x1, y1, phi1, L), placed(x2, y2, phi2, L)
    faults = _faults(O, C, first, second, L)
    name = next((name for name, is_so in faults.items() if is_so), "")
    share = {"": 1.0, "out_of_bounds": 0.5, "assembled_otherwise": 0.5}.get(name, 0.0)
    said = dict.fromkeys(PIVOTS, Judged(share, name, {"frame": float(abs(C - O))}))
    return said | judged_lengths(answers, O, C, (first, second), share < 1)


@mistake("x_P", "y_P")
def middle_of_the_path_of_A(x1, x2, y1, y2):
    return (x1 + x2) / 2, (y1 + y2) / 2


@mistake("x_P", "y_P", kind="term_sign")
def on_the_other_side(x_P, y_P, x1, x2, y1, y2):
    return x1 + x2 - x_P, y1 + y2 - y_P


@mistake("x_O", "y_O", "x_C", "y_C")
def off_the_bisectors(x1, y1, x_B1, y_B1, L):
    """Below the first position."""
    return x1, y1 - L, x_B1, y_B1 - L


@mistake("x_O", "y_O", "x_C", "y_C", kind="exchanged")
def pivots_exchanged(x_O, y_O, x_C, y_C):
    return x_C, y_C, x_O, y_O


@mistake("x_O", "y_O", "x_C", "y_C")
def out_of_bounds(x_P, y_P):
    """Both at the pole: the body would merely turn."""
    return x_P, y_P, x_P, y_P


@mistake("x_O", "y_O", "x_C", "y_C")
def assembled_otherwise(x_O, y_O, x_C, y_C, x1, y1, phi1, x2, y2, phi2, L):
    """With a pivot C on the bisector that sees the positions from two sides; the right one where there is
    none."""
    return _of_another_assembly(x_O, y_O, x_C, y_C, x1, y1, phi1, x2, y2, phi2, L)


def _of_another_assembly(x_O, y_O, x_C, y_C, x1, y1, phi1, x2, y2, phi2, L):
    first, second = placed(x1, y1, phi1, L), placed(x2, y2, phi2, L)
    middle, way = (first[1] + second[1]) / 2, second[1] - first[1]
    O, found = x_O + 1j * y_O, x_C + 1j * y_C
    for share in (-0.8, -1.2, -1.6, 0.6, 1.4, -2.0, 2.0, -2.6, 2.6):
        C = middle + 1j * share * L * way / abs(way)
        faults = _faults(O, C, first, second, L)
        wanted = faults["assembled_otherwise"] & ~faults["out_of_bounds"] & ~faults["off_the_bisectors"]
        found = np.where(wanted, C, found)[()]
    return x_O, y_O, found.real, found.imag


@mistake("r2", "r4")
def length_elsewhere(r2, r4, L):
    """From the pole, or from a pivot that has moved since."""
    return r2 + L / 2, r4 + L / 2


def figure(x1, y1, phi1, x2, y2, phi2, L, x_O, y_O, x_C, y_C, x_P, y_P):
    """Both bisectors, the pole where they cross, and the linkage in both positions."""
    first, second = placed(x1, y1, phi1, L), placed(x2, y2, phi2, L)
    O, C, P = complex(x_O, y_O), complex(x_C, y_C), complex(x_P, y_P)
    near = abs(P - O) < 5 * L
    return Figure(
        axes(0j, 0.5 * L),
        *(line((p + q) / 2, pivot, dashed=True) for p, q, pivot in zip(first, second, (O, C), strict=True)),
        *((line(O, P, dashed=True), line(C, P, dashed=True), point(P, "P")) if near else ()),
        line(first[0], second[0]),
        line(first[1], second[1]),
        *in_its_place(O, C, *second),
        *(link(*ends) for ends in ((O, first[0]), first, (C, first[1]))),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        *(pin(z, name) for z, name in zip((*first, *second), ("A_1", "B_1", "A_2", "B_2"), strict=True)),
        paper_mm=(110, 80),
    )


def residual(x1, y1, phi1, x2, y2, phi2, L, x_P, y_P, x_O, y_O, x_C, y_C, r2, r4):
    """The displacement turns about the pole; each pivot is as far from both places of its pin."""
    first, second = (
        (x + 1j * y, x + 1j * y + L * np.exp(1j * np.radians(phi)))
        for x, y, phi in ((x1, y1, phi1), (x2, y2, phi2))
    )
    P, O, C = x_P + 1j * y_P, x_O + 1j * y_O, x_C + 1j * y_C
    turned = np.exp(1j * np.radians(phi2 - phi1))
    size = L + abs(P)
    return (
        *(abs(P + turned * (p - P) - q) / size for p, q in zip(first, second, strict=True)),
        *((abs(p[0] - O) - r2) / r2 for p in (first, second)),
        *((abs(p[1] - C) - r4) / r4 for p in (first, second)),
    )


KNOWN = (
    # A quarter of a turn about the origin, clockwise.
    given(L=30, x1=-50, y1=50, phi1=0, x2=50, y2=50, phi2=-90).gives(x_P=0, y_P=0, x_B1=-20, y_B2=20),
    # Anticlockwise: the pole is above the chord of A, by half of its length.
    given(L=60, x1=-40, y1=100, phi1=90, x2=40, y2=100, phi2=180).gives(
        x_P=0, y_P=140, x_O=0, y_O=40, r2=5200**0.5
    ),
)
