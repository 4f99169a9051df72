"""Figures of the lesson on forces: a rocker under three forces, a four-bar linkage taken apart, inertia of a
slider-crank."""

import numpy as np

from coursework.degrees import polar
from coursework.figures import (
    Figure,
    ground_pivot,
    line,
    link,
    pin,
    point,
    rail,
    rotation_arrow,
    slider,
    vector,
)
from coursework.kinematics.dyads import rrp, rrr

R1, R2, R3, R4, THETA2 = 200.0, 60.0, 180.0, 140.0, 60.0


def _pins():
    A, C = polar(R2, THETA2), complex(R1)
    return A, rrr(A, C, R3, R4, 1), C


def three_forces():
    """The rocker: the load at P, the force of the coupler at B along the coupler, that of the frame at C; all
    meet in K."""
    A, B, C = _pins()
    P, load = C + 0.55 * (B - C), 40 * polar(1, -20)
    along = (B - A) / abs(B - A)
    # K is where the line of the load crosses that of the coupler.
    t = (np.conj(along) * (B - P)).imag / (np.conj(along) * load).imag
    K = P + t * load
    moment = (np.conj(P - C) * load).imag
    push = -moment / (np.conj(B - C) * along).imag * along
    return Figure(
        *(line(end, K, dashed=True) for end in (P, B, C)),
        link(C, B, label="4"),
        vector(P, load, "F"),
        vector(B, push, "S"),
        vector(C, -load - push, "R"),
        point(K, "K"),
        point(P, "P"),
        pin(B, "B"),
        pin(C, "C"),
        paper_mm=(100, 75),
    )


def taken_apart():
    """Crank, coupler and rocker side by side: the crank pulls the rocker, the force S on each end and against
    it."""
    A, B, C = _pins()
    along = (B - A) / abs(B - A)
    S, gap = 40 * along, 95 * along
    crank, rocker = -gap, gap
    return Figure(
        link(crank, A + crank, label="2"),
        link(A, B, label="3"),
        link(C + rocker, B + rocker, label="4"),
        vector(A, -S, "S"),
        vector(B, S, "S"),
        vector(A + crank, S, "S"),
        vector(B + rocker, -S, "S"),
        rotation_arrow(crank, 26, 110, 200, r"\Gamma"),
        rotation_arrow(C + rocker, 30, -10, -80, "M"),
        ground_pivot(crank, "O"),
        ground_pivot(C + rocker, "C"),
        *(pin(end) for end in (A + crank, A, B, B + rocker)),
        paper_mm=(120, 70),
    )


def inertia():
    """The inertia forces of rod and piston, against their accelerations, at a constant rate of the crank."""
    r2, r3, theta2 = 60.0, 170.0, 40.0

    def places(angle):
        A = polar(r2, angle)
        B = rrp(A, r3, 0.0)
        return np.array([A, A + 0.4 * (B - A), B])

    step = 0.5
    bend = (places(theta2 + step) - 2 * places(theta2) + places(theta2 - step)) / np.radians(step) ** 2
    A, G, B = places(theta2)
    return Figure(
        rail(B - 30, B + 30),
        line(0, B + 60, dashed=True),
        link(0, A, label="2"),
        link(A, B, label="3"),
        slider(B, label="4"),
        vector(G, -0.9 * bend[1], r"F_3"),
        vector(B, -0.9 * complex(bend[2].real), r"F_4"),
        ground_pivot(0, "O"),
        pin(A, "A"),
        pin(B, "B"),
        point(G, "G"),
    )
