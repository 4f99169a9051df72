"""Figures of the lesson on positions: two circles, the loop as vectors, and what goes wrong."""

import numpy as np

from coursework.degrees import angle, cos, polar, sin
from coursework.figures import (
    Figure,
    angle_mark,
    arc,
    axes,
    circle,
    ground_pivot,
    line,
    link,
    note,
    pin,
    point,
    slider,
    slot_link,
    vector,
)
from coursework.kinematics.dyads import rrr, side_of

R1, R2, R3, R4, THETA2 = 200.0, 60.0, 180.0, 140.0, 60.0  #: mm and degrees: the linkage of the lesson
TWO_PANELS, THREE_PANELS = (150.0, 62.0), (160.0, 58.0)


def _near(center, radius, target, half=14.0):
    """The piece of a circle near a point of it, as a compass draws it."""
    middle = angle(target - center)
    return arc(center, radius, middle - half, middle + half)


def _placed(at, theta2=THETA2):
    O, A, C = at, at + polar(R2, theta2), at + R1
    return O, A, C, *(rrr(A, C, R3, R4, side_of(mode)) for mode in ("open", "crossed"))


def two_circles():
    """O, C and A placed; the two circles; their two crossings."""
    O, A, C, first, second = _placed(0j)
    return Figure(
        line(O, C, dashed=True),
        circle(O, R2, dashed=True),
        circle(A, R3, label="r_3"),
        circle(C, R4, label="r_4"),
        line(A, C, dashed=True),
        link(O, A, label="r_2"),
        link(A, first),
        link(C, first),
        line(A, second, dashed=True, thin=False),
        line(C, second, dashed=True, thin=False),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(first, "B_1"),
        point(second, "B_2"),
        paper_mm=(100, 72),
    )


def steps_of_the_construction():
    """Three states of one drawing, side by side."""
    apart = 285.0
    return Figure(
        *_first_step(0j), *_second_step(apart + 0j), *_third_step(2 * apart + 0j), paper_mm=THREE_PANELS
    )


def _first_step(at):
    O, A, C, *_ = _placed(at)
    return (
        line(O, C, dashed=True),
        link(O, A),
        point(O, "O"),
        point(C, "C"),
        point(A, "A"),
        angle_mark(O, 0, THETA2, r"\theta_2"),
        note(O + complex(0, 125), "1"),
    )


def _second_step(at):
    O, A, C, first, second = _placed(at)
    arcs = (_near(center, r, B, 16) for center, r in ((A, R3), (C, R4)) for B in (first, second))
    return (
        line(O, C, dashed=True),
        link(O, A),
        *arcs,
        line(A, first, dashed=True, label="r_3"),
        line(C, first, dashed=True, label="r_4"),
        point(O),
        point(C, "C"),
        point(A, "A"),
        point(first, "B_1"),
        point(second, "B_2"),
        note(O + complex(0, 125), "2"),
    )


def _third_step(at):
    O, A, C, first, _ = _placed(at)
    return (
        line(O, C, dashed=True),
        link(O, A),
        link(A, first),
        link(C, first),
        point(O),
        point(C),
        point(A),
        point(first, "B_1"),
        angle_mark(A, 0, angle(first - A), r"\theta_3", radius=75),
        angle_mark(C, 0, angle(first - C), r"\theta_4", radius=40),
        note(O + complex(0, 125), "3"),
    )


def precision():
    """Two arcs, each a band as wide as the pencil's doubt: square to each other, then nearly tangent."""
    return Figure(*_bands(0j, 90.0), *_bands(90 + 0j, 25.0), paper_mm=(110, 48))


def _bands(at, mu):
    """Bands of two lines that cross at an angle mu, and the diamond of what both allow."""
    along = [polar(1.0, 90 + s * mu / 2) for s in (1, -1)]
    half, reach = 3.0, 34.0
    doubt = 2 * half
    edges = [
        line(at + s * half * 1j * u - reach * u, at + s * half * 1j * u + reach * u)
        for u in along
        for s in (1, -1)
    ]
    middles = [line(at - reach * u, at + reach * u, dashed=True) for u in along]
    u, v = along
    long, wide = half / sin(mu / 2) * 1j, half / cos(mu / 2)
    diamond = link(at + long, at + wide, at - long, at - wide)
    marks = angle_mark(at, angle(v), angle(u), r"\mu", radius=26)
    return (*edges, *middles, diamond, marks, point(at), note(at - 1j * (reach + doubt), f"{mu:.0f}°"))


def circles_that_do_not_meet():
    """Too far apart; one inside the other; touching."""
    return Figure(
        *_pair(0j, 100.0, 40.0, 42.0),
        *_pair(245 + 0j, 30.0, 78.0, 36.0),
        *_pair(395 + 0j, 90.0, 50.0, 40.0),
        paper_mm=THREE_PANELS,
    )


def _pair(at, AC, r3, r4):
    A, C = at, at + AC
    touching = (point(A + r3, "B"),) if abs(AC - r3 - r4) < 1 else ()
    return (
        circle(A, r3),
        circle(C, r4),
        line(A, C, dashed=True),
        line(A, A + polar(r3, 140), label="r_3"),
        line(C, C + polar(r4, 50), label="r_4"),
        point(A, "A"),
        point(C, "C"),
        *touching,
    )


def two_modes():
    """Both assemblies, over a turn of the crank: they stay mirror images in AC."""
    frames = []
    for theta2 in np.arange(0.0, 360.0, 10.0):
        O, A, C, first, second = _placed(0j, theta2)
        frames.append(
            Figure(
                line(O, C, dashed=True),
                line(A, C, dashed=True),
                circle(O, R2, dashed=True),
                link(O, A),
                link(A, first),
                link(C, first),
                line(A, second, dashed=True, thin=False),
                line(C, second, dashed=True, thin=False),
                ground_pivot(O, "O"),
                ground_pivot(C, "C"),
                pin(A, "A"),
                pin(first, "B_1"),
                pin(second, "B_2"),
                paper_mm=(110, 85),
            )
        )
    return frames


def vector_as_a_complex_number():
    """One vector, its length, its angle and its two projections."""
    tip = polar(100.0, 37)
    return Figure(
        axes(0j, 108),
        vector(0j, tip, "r"),
        line(tip, tip.real, dashed=True),
        line(tip, 1j * tip.imag, dashed=True),
        note(tip.real / 2 - 6j, r"r\,\mathrm{cos}\,\theta"),
        note(1j * tip.imag / 2 - 17, r"r\,\mathrm{sin}\,\theta"),
        angle_mark(0j, 0, 37, r"\theta", radius=30),
        paper_mm=(70, 52),
    )


def vector_loop():
    """The four-bar linkage as four vectors, each with its angle from the x axis at its own start."""
    O, A, C, B, _ = _placed(0j)
    return Figure(
        vector(O, A - O, r"\vec r_2"),
        vector(A, B - A, r"\vec r_3"),
        vector(O, C - O, r"\vec r_1"),
        vector(C, B - C, r"\vec r_4"),
        point(O, "O"),
        point(A, "A"),
        point(B, "B"),
        point(C, "C"),
        angle_mark(O, 0, THETA2, r"\theta_2", radius=28),
        angle_mark(A, 0, angle(B - A), r"\theta_3", radius=55),
        angle_mark(C, 0, angle(B - C), r"\theta_4", radius=32),
        axes(complex(-70, 60), 40),
        paper_mm=(110, 75),
    )


def slotted_mechanism():
    """The notes' mechanism: frame upright, crank at 135 degrees, and the guide through O4."""
    O4, O2 = 0j, 228.6j
    A = O2 + polar(114.3, 135)
    return Figure(
        slot_link(O4, 1.25 * A),
        line(O4, O2, dashed=True, label="r_1"),
        link(O2, A, label="r_2"),
        slider(A, angle(A)),
        pin(A, "A"),
        ground_pivot(O4, "O_4"),
        ground_pivot(O2, "O_2"),
        line(O2, O2 + 75, dashed=True),
        line(O4, O4 + 75, dashed=True),
        angle_mark(O2, 0, 135, r"\theta_2"),
        angle_mark(O4, 0, angle(A), r"\theta_4"),
        paper_mm=(70, 75),
    )


def opposite_directions():
    """Two opposite directions, one slope."""
    tip = polar(100.0, 104.64)
    return Figure(
        line(-60 + 0j, 85 + 0j),
        line(-110j, 115j),
        vector(0j, tip, "A"),
        line(0j, -tip, dashed=True),
        line(tip, tip.real, dashed=True),
        angle_mark(0j, 0, 104.64, r"\theta_4", radius=30),
        angle_mark(0j, 0, -75.36, r"\theta_4 - 180°", radius=42),
        note(complex(85, -8), "x"),
        note(complex(8, 115), "y"),
        paper_mm=(60, 62),
    )


def line_and_unit_circle():
    """a x + b y = c is a line square to the direction of (a, b); theta3 is where it meets the unit circle."""
    phi, psi = 163.0, 133.9
    root, normal = 100.0, polar(1.0, phi)
    foot = root * cos(psi) * normal
    reach = 1j * normal * 1.25 * root
    ends = [polar(root, phi + s * psi) for s in (-1, 1)]
    return Figure(
        line(-118 + 0j, 118 + 0j),
        line(-118j, 118j),
        circle(0j, root),
        line(foot - reach, foot + reach, thin=False),
        vector(0j, 0.999 * root * normal),
        *(line(0j, z, dashed=True) for z in ends),
        *(point(z, label) for z, label in zip(ends, (r"\theta_3^{(1)}", r"\theta_3^{(2)}"), strict=True)),
        angle_mark(0j, 0, phi, r"\varphi", radius=22),
        angle_mark(0j, phi, phi + psi, r"\psi", radius=40),
        angle_mark(0j, phi, phi - psi, r"\psi", radius=52),
        note(1.16 * root * normal, "(a, b)"),
        paper_mm=(85, 70),
    )
