"""Three positions of a coupler: solution. Each pivot is the centre of the circle through three places of its
pin."""

import numpy as np

from coursework.degrees import cos, sin
from coursework.figures import Figure, arc, axes, ground_pivot, link, pin
from coursework.solution import Judged, formula, given, judge, mistake, stable

from ...exercises.synthesis._positions import in_its_place, placed, side
from ._pivots import PIVOTS, judged_lengths, of_placement, pivots_of

UNITS = {
    **{f"{axis}_B{k}": "mm" for axis in "xy" for k in (1, 2, 3)},
    "b_A2": "mm^2",
    "b_A3": "mm^2",
    "b_B2": "mm^2",
    "b_B3": "mm^2",
    "D_A": "mm^2",
    "D_B": "mm^2",
    "frame": "mm",
}
SYMBOLS = {
    **{f"{axis}_B{k}": f"{axis}_{{B_{k}}}" for axis in "xy" for k in (1, 2, 3)},
    "b_A2": "A_1A_2^2",
    "b_A3": "A_1A_3^2",
    "b_B2": "B_1B_2^2",
    "b_B3": "B_1B_3^2",
    "D_A": "D_A",
    "D_B": "D_B",
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


def x_B3(x3, L, phi3):
    return x3 + L * cos(phi3)


def y_B3(y3, L, phi3):
    return y3 + L * sin(phi3)


def _ordered(x1, y1, phi1, x2, y2, phi2, x3, y3, phi3):
    """The three places of A and directions, in turn, so that the first is not the one far from both
    others."""
    first, second, third = (x1, y1, phi1), (x2, y2, phi2), (x3, y3, phi3)

    def apart(p, q):
        return abs(p[0] - q[0]) + abs(p[1] - q[1])

    lone = (apart(first, second) > apart(second, third)) & (apart(first, third) > apart(second, third))

    def turned(one, other):
        return tuple(np.where(lone, b, a)[()] for a, b in zip(one, other, strict=True))

    return turned(first, second), turned(second, third), turned(third, first)


def _centre(places, L):
    """The point as far from three places of a point at L from A, in digits that far places and a long coupler
    leave."""
    (x1, y1, phi1), *others = places
    rows = []
    for x2, y2, phi in others:
        x, y, across = x2 - x1, y2 - y1, 2 * L * sin((phi - phi1) / 2)
        way = x - across * sin((phi + phi1) / 2), y + across * cos((phi + phi1) / 2)
        rows.append((*way, (x**2 + y**2) / 2 + L * (x * cos(phi) + y * sin(phi))))
    (a, b, p), (c, d, q) = rows
    return x1 + (p * d - q * b) / (a * d - c * b), y1 + (a * q - c * p) / (a * d - c * b)


def _O(_ordered):
    return _centre(_ordered, 0.0)


def _C(_ordered, L):
    return _centre(_ordered, L)


def b_A2(x1, y1, x2, y2):
    return (x2 - x1) ** 2 + (y2 - y1) ** 2


def b_A3(x1, y1, x3, y3):
    return (x3 - x1) ** 2 + (y3 - y1) ** 2


def D_A(x1, y1, x2, y2, x3, y3):
    """Four times the area of the triangle A1 A2 A3, with a sign."""
    return 2 * ((x2 - x1) * (y3 - y1) - (x3 - x1) * (y2 - y1))


@stable(lambda _O: _O[0])
def x_O(x1, y1, y2, y3, b_A2, b_A3, D_A):
    return x1 + ((y3 - y1) * b_A2 - (y2 - y1) * b_A3) / D_A


@stable(lambda _O: _O[1])
def y_O(y1, x1, x2, x3, b_A2, b_A3, D_A):
    return y1 + ((x2 - x1) * b_A3 - (x3 - x1) * b_A2) / D_A


def b_B2(x_B1, y_B1, x_B2, y_B2):
    return (x_B2 - x_B1) ** 2 + (y_B2 - y_B1) ** 2


def b_B3(x_B1, y_B1, x_B3, y_B3):
    return (x_B3 - x_B1) ** 2 + (y_B3 - y_B1) ** 2


def D_B(x_B1, y_B1, x_B2, y_B2, x_B3, y_B3):
    return 2 * ((x_B2 - x_B1) * (y_B3 - y_B1) - (x_B3 - x_B1) * (y_B2 - y_B1))


@stable(lambda _C: _C[0])
def x_C(x_B1, y_B1, y_B2, y_B3, b_B2, b_B3, D_B):
    return x_B1 + ((y_B3 - y_B1) * b_B2 - (y_B2 - y_B1) * b_B3) / D_B


@stable(lambda _C: _C[1])
def y_C(y_B1, x_B1, x_B2, x_B3, b_B2, b_B3, D_B):
    return y_B1 + ((x_B2 - x_B1) * b_B3 - (x_B3 - x_B1) * b_B2) / D_B


@formula(r"\sqrt{\left(<x1> - <x_O>\right)^2 + \left(<y1> - <y_O>\right)^2}")
def r2(x1, y1, x_O, y_O):
    return np.hypot(x1 - x_O, y1 - y_O)


@formula(r"\sqrt{\left(<x_B1> - <x_C>\right)^2 + \left(<y_B1> - <y_C>\right)^2}")
def r4(x_B1, y_B1, x_C, y_C):
    return np.hypot(x_B1 - x_C, y_B1 - y_C)


def _positions(x1, y1, phi1, x2, y2, phi2, x3, y3, phi3, L):
    return placed(x1, y1, phi1, L), placed(x2, y2, phi2, L), placed(x3, y3, phi3, L)


def fault(x_O, y_O, x_C, y_C, r2, r4, L, _positions):
    """Of the linkage of the solution: none, with room to spare."""
    O, C = x_O + 1j * y_O, x_C + 1j * y_C
    unwieldy = (np.minimum(r2, r4) < L / 3) | (np.maximum(r2, r4) > 4 * L) | (abs(C - O) < L / 2)
    sides = [side(A, B, C) for A, B in _positions]
    flat = [abs((np.conj(C - A) * (B - A)).imag) < 0.15 * L * abs(C - A) for A, B in _positions]
    otherwise = (sides[0] != sides[1]) | (sides[0] != sides[2])
    return np.where(unwieldy | otherwise | flat[0] | flat[1] | flat[2], "some", "none")[()]


@judge
def passes_all_positions(answers, x1, y1, phi1, x2, y2, phi2, x3, y3, phi3, L):
    """Pivots from which the coupler reaches all positions; lengths from the student's own pivots."""
    pivots = pivots_of(answers)
    if pivots is None:
        return {}
    O, C = pivots
    places = _positions(x1, y1, phi1, x2, y2, phi2, x3, y3, phi3, L)
    name = next((name for name, is_so in of_placement(O, C, places).items() if is_so), "")
    said = dict.fromkeys(PIVOTS, Judged(0.0 if name else 1.0, name, {"frame": float(abs(C - O))}))
    return said | judged_lengths(answers, O, C, places, bool(name))


@mistake("x_O", "y_O", "x_C", "y_C")
def off_the_bisectors(x1, x2, x3, y1, y2, y3, x_B1, x_B2, x_B3, y_B1, y_B2, y_B3):
    """The centres of mass of the two triangles."""
    return (x1 + x2 + x3) / 3, (y1 + y2 + y3) / 3, (x_B1 + x_B2 + x_B3) / 3, (y_B1 + y_B2 + y_B3) / 3


@mistake("x_O", "y_O", "x_C", "y_C", kind="exchanged")
def pivots_exchanged(x_O, y_O, x_C, y_C):
    return x_C, y_C, x_O, y_O


@mistake("r2", "r4")
def length_elsewhere(r2, r4, L):
    return r2 + L / 2, r4 + L / 2


def figure(_positions, L, x_O, y_O, x_C, y_C, r2, r4):
    """Both circles, and the linkage in its three positions."""
    O, C = complex(x_O, y_O), complex(x_C, y_C)
    places = [tuple(map(complex, position)) for position in _positions]
    arcs = []
    for pivot, radius, ends in ((O, r2, [A for A, _ in places]), (C, r4, [B for _, B in places])):
        angles = np.degrees(np.unwrap([np.angle(end - pivot) for end in ends]))
        arcs.append(arc(pivot, radius, float(angles.min()) - 12, float(angles.max()) + 12, dashed=True))
    return Figure(
        axes(0j, 0.4 * L),
        *arcs,
        *(element for place in (places[0], places[2]) for element in in_its_place(O, C, *place)),
        *(link(*ends) for ends in ((O, places[1][0]), places[1], (C, places[1][1]))),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        *(pin(A, f"A_{k}") for k, (A, _) in enumerate(places, 1)),
        *(pin(B, f"B_{k}") for k, (_, B) in enumerate(places, 1)),
        paper_mm=(110, 85),
    )


def residual(x1, y1, phi1, x2, y2, phi2, x3, y3, phi3, L, x_O, y_O, x_C, y_C, r2, r4):
    """Each pivot is as far from the three places of its pin."""
    O, C = x_O + 1j * y_O, x_C + 1j * y_C
    found = []
    for x, y, phi in ((x1, y1, phi1), (x2, y2, phi2), (x3, y3, phi3)):
        A = x + 1j * y
        found += [(abs(A - O) - r2) / r2, (abs(A + L * np.exp(1j * np.radians(phi)) - C) - r4) / r4]
    return tuple(found)


KNOWN = (
    # A mere translation: A on a circle of radius 75 about (0, 50), at 3-4-5 places, B 60 further.
    given(L=60, x1=-60, y1=95, phi1=0, x2=0, y2=125, phi2=0, x3=60, y3=95, phi3=0).gives(
        x_O=0, y_O=50, r2=75, x_C=60, y_C=50, r4=75
    ),
)
