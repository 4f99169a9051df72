"""Figures of the lesson on mechanical advantage: forces and velocities, transmission angle, dead points,
toggle, jack."""

import numpy as np

from coursework.degrees import angle, polar
from coursework.figures import (
    Figure,
    angle_mark,
    arc,
    ground_pivot,
    line,
    link,
    pin,
    rail,
    slider,
    trace,
    vector,
)
from coursework.kinematics.dyads import rrr
from coursework.kinematics.vectors import cross

from ._machines import rows_of

R1, R2, R3, R4 = 200.0, 60.0, 180.0, 140.0


def _four_bar(theta2):
    """Pins A, B and C."""
    A, C = polar(R2, theta2), complex(R1)
    return A, rrr(A, C, R3, R4, 1), C


def powers():
    """The force on A along its velocity, that on B against its own, and the two velocities' projections on
    AB."""
    A, B, C = _four_bar(60)
    crank, rocker, along = A, B - C, (B - A) / abs(B - A)
    omega4 = cross(crank, along) / cross(rocker, along)
    v_A, v_B = 0.9j * crank, 0.9j * omega4 * rocker
    share = (v_A * along.conjugate()).real * along
    return Figure(
        line(0, C, dashed=True, label="r_1"),
        link(0, A, label="r_2"),
        link(A, B, label="r_3"),
        link(C, B, label="r_4"),
        vector(A, v_A, "V_e"),
        vector(B, v_B, "V_s"),
        line(A + v_A, A + share, dashed=True),
        line(B + v_B, B + share, dashed=True),
        ground_pivot(0, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        angle_mark(A, angle(-A), angle(B - A), r"\nu", radius=26),
        angle_mark(B, angle(A - B), angle(C - B), r"\mu", radius=30),
    )


def transmission_angle():
    """The force of the coupler on the rocker, in two parts: square to the rocker, and along it."""
    A, B, C = _four_bar(60)
    along, down = (B - A) / abs(B - A), (C - B) / abs(C - B)
    push = 80 * along
    idle = (push * down.conjugate()).real * down
    return Figure(
        link(A, B, label="r_3"),
        link(C, B, label="r_4"),
        vector(B, push, "S"),
        vector(B, push - idle, "S_t"),
        vector(B, idle, "S_n"),
        line(B + push, B + push - idle, dashed=True),
        line(B + push, B + idle, dashed=True),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        angle_mark(B, angle(A - B), angle(C - B), r"\mu", radius=30),
        paper_mm=(95, 75),
    )


def _in_line(reach):
    """The pin B at this distance from O, above OC."""
    return rrr(0j, complex(R1), reach, R4, 1)


def dead_points():
    """Crank and coupler stretched out, and folded: the ends of the rocker's swing."""
    far, near, C = _in_line(R3 + R2), _in_line(R3 - R2), complex(R1)
    outer, inner = R2 * far / abs(far), -R2 * near / abs(near)
    return Figure(
        arc(C, R4, angle(far - C), angle(near - C), dashed=True),
        arc(0, R2, -180, 180, dashed=True),
        line(0, inner, thin=False),
        line(inner, near, dashed=True),
        line(C, near, dashed=True),
        link(0, outer, label="r_2"),
        link(outer, far, label="r_3"),
        link(C, far, label="r_4"),
        ground_pivot(0, "O"),
        ground_pivot(C, "C"),
        pin(outer, "A_1"),
        pin(far, "B_1"),
        pin(inner, "A_2"),
        pin(near, "B_2"),
    )


def _toggle(phi):
    """Knee and ram below D, both bars 100 long, at an angle from the line of the ram."""
    knee = 100 * polar(1, -90 - phi)
    return knee, 2j * knee.imag


def toggle():
    """Two bars nearly in line, the force on the knee and that on the ram."""
    B, C = _toggle(20)
    return Figure(
        rail(C - 28j, C + 28j),
        line(0, C, dashed=True),
        link(0, B, label="r_4"),
        link(B, C, label="r_5"),
        slider(C, 90),
        vector(B - 45, 40, "F_e"),
        vector(C - 60j, 38j, "F_s"),
        ground_pivot(0, "D"),
        pin(B, "B", toward=20),
        pin(C, "C"),
        angle_mark(0, -90, -110, r"\varphi", radius=50),
        angle_mark(C, 90, 110, r"\psi", radius=50),
        paper_mm=(60, 95),
    )


def toggle_moving():
    """The knee goes to and fro at an even pace; the arrows are its velocity and the ram's."""
    frames = []
    for way in 0.45 + 2 * np.pi * np.arange(36) / 36:
        B, C = _toggle(float(np.degrees(np.arcsin(0.33 + 0.3 * np.cos(way)))))
        knee = 30 * float(np.sin(way))
        fall = 2 * knee * B.real / B.imag
        frames.append(
            Figure(
                rail(-205j, -145j),
                line(0, -205j, dashed=True),
                trace((_toggle(2)[0], _toggle(12)[0], _toggle(25)[0], _toggle(39)[0])),
                link(0, B),
                link(B, C),
                slider(C, 90),
                vector(B, knee + 1j * fall / 2, "V_B"),
                vector(C, 1j * fall, "V_C"),
                ground_pivot(0, "D"),
                pin(B, "B"),
                pin(C, "C"),
                paper_mm=(70, 95),
            )
        )
    return frames


def jack():
    """A boom about D lifted by a jack from P to B: the distance from D to the jack's line is its arm."""
    D, P, B, end = 0j, 45 - 55j, polar(95, 38), polar(170, 38)
    way = (B - P) / abs(B - P)
    foot = P + ((D - P) * way.conjugate()).real * way
    return Figure(
        link(D, end),
        line(P, B, thin=False, label="d"),
        line(D, foot, dashed=True, label="h"),
        vector(B, 45 * way, "F"),
        vector(end, -45j, "W"),
        ground_pivot(D, "D"),
        ground_pivot(P, "P"),
        pin(B, "B"),
        paper_mm=(85, 70),
    )


def drivers_to_be_found():
    """Four positions without a name: crank and coupler in line, no bars in line, coupler and rocker in line,
    a dead centre."""
    reach = rrr(0j, 80 + 0j, 25 + 70, 50, 1)
    flat = rrr(0j, 80 + 0j, 50, 44 + 60, 1)
    free = complex(polar(25, 100))
    linkages = (
        (25 * reach / abs(reach), reach, 80 + 0j),
        (free, rrr(free, 80 + 0j, 70, 50, 1), 80 + 0j),
        (flat, flat + 44 * (80 - flat) / abs(80 - flat), 80 + 0j),
    )
    drawings = [
        [link(0, A), link(A, B), link(C, B), ground_pivot(0), ground_pivot(C), pin(A), pin(B)]
        for A, B, C in linkages
    ]
    A, B = 25 + 0j, 85 + 0j
    drawings.append(
        [rail(60 + 0j, 105 + 0j), link(0, A), link(A, B), slider(B), ground_pivot(0), pin(A), pin(B)]
    )
    return Figure(*rows_of(drawings, 4, 112 + 70j), paper_mm=(165, 45))
