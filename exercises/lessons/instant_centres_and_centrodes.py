"""Figures of the lesson on instant centres: a body that turns about a point, three bodies, linkages, a
ladder."""

import numpy as np

from coursework.degrees import polar
from coursework.figures import (
    Figure,
    circle,
    ground_pivot,
    line,
    link,
    pin,
    point,
    rail,
    slider,
    vector,
)
from coursework.kinematics.dyads import rrp, rrr

R1, R2, R3, R4, THETA2 = 120.0, 50.0, 110.0, 90.0, 60.0


def perpendiculars():
    """Two velocities of one body, and the point where the lines perpendicular to them cross."""
    I, A, B = 0j, polar(90, 125), polar(130, 70)
    E = A + 0.55 * (B - A) * polar(1, -25)
    return Figure(
        link(A, B, E, label="3"),
        *(line(I, P, dashed=True) for P in (A, B, E)),
        *(vector(P, 0.55j * P, name) for P, name in ((A, "V_A"), (B, "V_B"), (E, "V_E"))),
        point(I, "I_{13}"),
        *(pin(P, name) for P, name in ((A, "A"), (B, "B"), (E, "E"))),
        paper_mm=(95, 80),
    )


def three_bodies():
    """A point that would be on both turning bodies, away from the line of their pivots."""
    O, C, P = 0j, 120 + 0j, complex(75, 45)
    return Figure(
        line(O, C, dashed=True),
        line(O, P),
        line(C, P),
        vector(P, 0.45j * P, r"V_{P2}"),
        vector(P, -0.5j * (P - C), r"V_{P3}"),
        ground_pivot(O, "I_{12}"),
        ground_pivot(C, "I_{13}"),
        point(P, "P"),
        paper_mm=(95, 60),
    )


def four_bar():
    """All six centres."""
    O, A, C = 0j, polar(R2, THETA2), complex(R1)
    B = rrr(A, C, R3, R4, 1)
    along, rocker = B - A, B - C
    I24 = A - along * A.imag / along.imag
    # p A = C + q (B - C)
    p = (np.conj(rocker) * C).imag / (np.conj(rocker) * A).imag
    I13 = p * A
    return Figure(
        *(line(end, I13, dashed=True) for end in (A, B)),
        *(line(end, I24, dashed=True) for end in (A, O)),
        line(O, C, dashed=True),
        link(O, A, label="2"),
        link(A, B, label="3"),
        link(C, B, label="4"),
        ground_pivot(O, "I_{12}"),
        ground_pivot(C, "I_{14}"),
        pin(A, "I_{23}"),
        pin(B, "I_{34}"),
        point(I13, "I_{13}"),
        point(I24, "I_{24}"),
    )


def slider_crank():
    """The perpendiculars to the guide all pass through the centre at infinity."""
    O, A = 0j, polar(50, 55)
    B = rrp(A, 130, 0.0)
    I13, I24 = complex(B.real, B.real * A.imag / A.real), A - (B - A) * A.real / (B - A).real
    return Figure(
        rail(B - 25, B + 25),
        line(A, I13, dashed=True),
        line(B, I13 + 12j, dashed=True),
        line(O, I24 + 12j, dashed=True),
        line(A, I24, dashed=True),
        link(O, A, label="2"),
        link(A, B, label="3"),
        slider(B, label="4"),
        ground_pivot(O, "I_{12}"),
        pin(A, "I_{23}"),
        pin(B, "I_{34}"),
        point(I13, "I_{13}"),
        point(I24, "I_{24}"),
        paper_mm=(105, 100),
    )


def ladder():
    """A bar whose ends slide along two walls, and the two circles that roll on one another."""
    L, lean = 100.0, 55.0
    A, B = L * 1j * np.sin(np.radians(lean)), L * np.cos(np.radians(lean)) + 0j
    I = A + B
    return Figure(
        line(0, 1.1 * L, dashed=True),
        line(0, 1.1j * L, dashed=True),
        circle(0, L, label="b"),
        circle(I / 2, L / 2, dashed=True, label="r"),
        line(A, I, dashed=True),
        line(B, I, dashed=True),
        link(A, B),
        vector(A, -0.35 * abs(I - A) * 1j, "V_A"),
        vector(B, 0.35 * abs(I - B) + 0j, "V_B"),
        pin(A, "A"),
        pin(B, "B"),
        point(I, "I"),
        paper_mm=(85, 85),
    )
