"""Figures of the lesson on velocities: relative velocity, polygons and what they are images of, coincident
points."""

import numpy as np

from coursework.degrees import angle, polar
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
    rotation_arrow,
    slider,
    slot_link,
    trace,
    vector,
    wheel,
)
from coursework.kinematics.dyads import rrr

from ._machines import rows_of

R1, R2, R3, R4, THETA2 = 200.0, 60.0, 180.0, 140.0, 60.0  #: mm and degrees: the linkage of the lesson
OMEGA2 = 10.0  #: rad/s
KV = 5.0  #: mm/s for a mm of mechanism, where a velocity is drawn beside it
E_ON_AB = 0.42 + 0.40j  #: the coupler's third point: AE over AB


def _linkage(theta2=THETA2, omega2=OMEGA2):
    """O, A, C, B; the velocities of A and of B, mm/s."""
    O, A, C = 0j, polar(R2, theta2), complex(R1)
    B = rrr(A, C, R3, R4)
    V_A = 1j * omega2 * A
    coupler, rocker = B - A, B - C
    omega4 = (np.conj(coupler) * V_A).real / (np.conj(coupler) * 1j * rocker).real
    return O, A, C, B, V_A, 1j * omega4 * rocker


def _drawn(O, A, C, B):
    return (
        line(O, C, dashed=True),
        link(O, A),
        link(A, B),
        link(C, B),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
    )


def _unit(z):
    return z / abs(z)


def relative_velocity():
    """The linkage with the velocities of A and B; beside it, the triangle of the three."""
    O, A, C, B, V_A, V_B = _linkage()
    p = 340 + 60j
    a, b = p + V_A / KV, p + V_B / KV
    return Figure(
        *_drawn(O, A, C, B),
        vector(A, 0.7 * V_A / KV, r"\vec V_A"),
        vector(B, 0.7 * V_B / KV, r"\vec V_B"),
        vector(p, a - p, r"\vec V_A"),
        vector(p, b - p, r"\vec V_B"),
        vector(a, b - a, r"\vec V_{B/A}"),
        paper_mm=(130, 70),
    )


def four_cases():
    """A guide 4 that turns, a block 3 that slides in it, and the points that are compared."""
    along = polar(1.0, 35)
    C, P = 70 * along, 125 * along
    return Figure(
        slot_link(0j, 150 * along),
        slider(C, 35),
        point(C, "C_3, C_4", toward=125),
        point(P, "P_4", toward=125),
        ground_pivot(0j, "O"),
        note(159 * along, "4"),
        note(C - 16j * along, "3"),
        rotation_arrow(0j, 98, 42, 58, r"\omega_4"),
        paper_mm=(90, 58),
    )


def two_points_of_a_body():
    """A body, two of its points, and the velocity of the second made of two vectors."""
    A, B = 0j, polar(100.0, 25)
    V_A, turning = polar(46.0, 55), 0.5j * (B - A)
    outline = tuple(polar(r, t) for r, t in ((30, 200), (34, 270), (70, 330), (135, 14), (128, 36), (70, 62)))
    return Figure(
        trace((*outline, outline[0]), dotted=False),
        line(A, B, dashed=True),
        vector(A, V_A, r"\vec V_A"),
        vector(B, V_A, r"\vec V_A"),
        vector(B + V_A, turning, r"\vec V_{B/A}"),
        vector(B, V_A + turning, r"\vec V_B"),
        rotation_arrow(polar(50.0, 350), 13, 200, 460, r"\omega"),
        point(A, "A", toward=220),
        point(B, "B", toward=-30),
        paper_mm=(100, 62),
    )


def quarter_turn():
    """The vector AB as a complex number, and its derivative: a quarter turn of it, times omega."""
    r = polar(100.0, 30)
    return Figure(
        axes(0j, 60),
        vector(0j, r, r"r\,e^{i\theta}"),
        vector(r, 0.55j * r, r"i\,\omega\,r\,e^{i\theta}"),
        angle_mark(0j, 0, 30, r"\theta", radius=34),
        arc(r, 13, 120, 210),
        rotation_arrow(0j, 76, 34, 50, r"\omega"),
        point(0j, "A", toward=225),
        point(r, "B", toward=-30),
        paper_mm=(70, 60),
    )


def directions_before_the_drawing():
    """The linkage, the velocity of A, and the lines along which the two others lie."""
    O, A, C, B, V_A, _ = _linkage()
    across = [_unit(1j * (B - Z)) for Z in (A, C)]
    return Figure(
        *_drawn(O, A, C, B),
        vector(A, V_A / 9, r"\vec V_A"),
        *(line(B - 55 * u, B + 55 * u, dashed=True) for u in across),
        note(B + 66 * across[0], r"\vec V_{B/A}"),
        note(B + 68 * across[1], r"\vec V_B"),
        angle_mark(O, 0, THETA2, r"\theta_2"),
        rotation_arrow(O, 40, 100, 140, r"\omega_2"),
        paper_mm=(100, 66),
    )


def _triangle(at=0j):
    """Images p, a, b of the polygon, mm on paper at 10 mm/s a mm; unit vectors of the two lines."""
    _, A, C, B, V_A, V_B = _linkage()
    return at, at + V_A / 10, at + V_B / 10, _unit(1j * (B - A)), _unit(1j * (B - C))


def steps_of_the_polygon():
    """Three states of the velocity polygon, side by side."""
    apart = 78.0
    p, a, *_ = _triangle()
    first = (vector(p, a - p), point(p, "p_v"), point(a, "a"), note(p + 40j, "1"))
    p, a, b, along, _ = _triangle(apart)
    second = (
        vector(p, a - p),
        line(a + 12 * along, a - 52 * along, dashed=True),
        point(p, "p_v"),
        point(a, "a"),
        note(p + 40j, "2"),
    )
    p, a, b, along, other = _triangle(2 * apart)
    third = (
        vector(p, a - p),
        line(a + 12 * along, a - 52 * along, dashed=True),
        line(p - 12 * other, p + 52 * other, dashed=True),
        point(p, "p_v"),
        point(a, "a"),
        vector(a, b - a),
        vector(p, b - p),
        point(b, "b"),
        note(p + 40j, "3"),
    )
    return Figure(*first, *second, *third, paper_mm=(160, 50))


def polygon():
    """The whole polygon of the lesson's linkage."""
    p, a, b, *_ = _triangle()
    return Figure(
        vector(p, a - p, r"\vec V_A"),
        vector(a, b - a, r"\vec V_{B/A}"),
        vector(p, b - p, r"\vec V_B"),
        point(p, "p_v", toward=-45),
        point(a, "a", toward=90),
        point(b, "b", toward=225),
        scale=1,
    )


def linkage_and_its_polygon():
    """The linkage over a turn of its crank, and beside it the polygon of its velocities."""
    return [_beside(theta2) for theta2 in np.arange(0.0, 360.0, 10.0)]


def _beside(theta2):
    O, A, C, B, V_A, V_B = _linkage(theta2)
    p = 370 + 60j
    a, b = p + V_A / 8, p + V_B / 8
    return Figure(
        *_drawn(O, A, C, B),
        circle(p, 75, dashed=True),
        vector(p, a - p),
        vector(a, b - a),
        vector(p, b - p),
        point(p, "p_v"),
        point(a, "a"),
        point(b, "b"),
        paper_mm=(140, 70),
    )


def image_of_a_link():
    """The coupler as a plate ABE; in the polygon the triangle abe, turned by a right angle."""
    O, A, C, B, V_A, V_B = _linkage()
    E = A + E_ON_AB * (B - A)
    p = 420 + 70j
    a, b = p + V_A / KV, p + V_B / KV
    e = a + E_ON_AB * (b - a)
    return Figure(
        line(O, C, dashed=True),
        link(A, B, E),
        link(O, A),
        link(C, B),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        pin(E, "E"),
        line(p, a),
        line(p, b),
        line(p, e, dashed=True),
        link(a, b, e),
        point(p, "p_v"),
        point(a, "a"),
        point(b, "b"),
        point(e, "e"),
        paper_mm=(150, 80),
    )


def equiprojectivity():
    """Two points of a bar, their velocities, and the projections of these on the bar, which are equal."""
    A, B = 0j, 120 + 0j
    V_A, V_B = polar(58.0, 52), complex(58.0 * np.cos(np.radians(52)), -26)
    return Figure(
        link(A, B),
        line(B, B + 60, dashed=True),
        vector(A, V_A, r"\vec V_A"),
        vector(B, V_B, r"\vec V_B"),
        line(A + V_A, A + V_A.real, dashed=True),
        line(B + V_B, B + V_B.real, dashed=True),
        vector(A, V_A.real + 0j, "h"),
        vector(B, V_B.real + 0j, "h"),
        pin(A, "A", toward=200),
        pin(B, "B", toward=120),
        paper_mm=(110, 60),
    )


def radial_and_transverse():
    """The derivative of r e^{i theta}: one part along the vector, one across it."""
    r = polar(90.0, 35)
    along, across = 34 * _unit(r), 46j * _unit(r)
    return Figure(
        axes(0j, 55),
        vector(0j, r, r"\vec r"),
        vector(r, along, r"\dot r\,e^{i\theta}"),
        vector(r, across, r"i\,\omega\,r\,e^{i\theta}"),
        vector(r, along + across, r"\vec V"),
        line(r + along, r + along + across, dashed=True),
        line(r + across, r + along + across, dashed=True),
        angle_mark(0j, 0, 35, r"\theta", radius=32),
        paper_mm=(80, 62),
    )


def jack():
    """A jack of varying length L between B and A, and the arm OA that it turns."""
    O, B = 0j, 150 - 25j
    A = polar(130.0, 68)
    u = _unit(A - B)
    return Figure(
        line(O, B, dashed=True),
        slot_link(B, B + 96 * u),
        line(B + 96 * u, A, thin=False),
        line(B + 40 * u, A, thin=False),
        link(O, A, label="a"),
        pin(A, "A"),
        ground_pivot(O, "O"),
        ground_pivot(B, "B"),
        line(B, B + 45, dashed=True),
        vector(A, 38 * u, r"\dot L"),
        vector(A, 34j * u, r"L\,\omega_2"),
        angle_mark(O, 0, 68, r"\theta_4"),
        angle_mark(B, 0, angle(u), r"\theta_2"),
        paper_mm=(95, 66),
    )


def _slotted():
    """The slotted mechanism of the notes: O4, O2, A; velocities of A and of the guide's point there, mm/s."""
    O4, O2 = 0j, 228.6j
    A = O2 + polar(114.3, 135)
    V_A = 1j * OMEGA2 * (A - O2)
    across = 1j * _unit(A)
    return O4, O2, A, V_A, across * (np.conj(across) * V_A).real


def coincident_points():
    """The mechanism with three velocities at A; beside it their polygon."""
    O4, O2, A, V_A, V_A4 = _slotted()
    scale = 8.0
    p = 330 + 250j
    a, own = p + V_A / scale, p + V_A4 / scale
    return Figure(
        slot_link(O4, 1.45 * A),
        line(O4, O2, dashed=True),
        link(O2, A),
        slider(A, angle(A)),
        pin(A, "A", toward=45),
        ground_pivot(O4, "O_4"),
        ground_pivot(O2, "O_2"),
        rotation_arrow(O2, 55, 15, 65, r"\omega_2"),
        note(1.53 * A, "4"),
        vector(p, a - p, r"\vec V_A"),
        vector(p, own - p, r"\vec V_{A_4}"),
        vector(own, a - own, r"\vec V_{A/A_4}"),
        point(p, "p_v"),
        point(a, "a"),
        point(own, "a_4"),
        paper_mm=(120, 78),
    )


def curved_slot():
    """A pin in a slot bent to an arc: the sliding velocity lies along the tangent, square to the radius
    KA."""
    O, K, rho = 0j, 70 - 52j, 110.0
    A = K + polar(rho, 96)
    bend = [
        K + polar(rho + side, t)
        for side, ts in ((7, range(62, 137, 5)), (-7, range(132, 61, -5)))
        for t in ts
    ]
    tangent = 1j * _unit(A - K)
    return Figure(
        trace((*bend, bend[0]), dotted=False),
        arc(K, rho, 62, 132, dashed=True),
        link(O, K + polar(rho - 7, 128)),
        ground_pivot(O, "O"),
        line(K, A, dashed=True, label=r"\rho"),
        point(K, "K"),
        pin(A, "A", toward=60),
        line(A - 62 * tangent, A + 50 * tangent, dashed=True),
        vector(A, -46 * tangent, r"\vec V_{A/A_4}"),
        line(A, A + 75, dashed=True),
        angle_mark(A, 0, angle(-tangent), r"\tau", radius=58),
        note(K + polar(rho, 125) - 18, "4"),
        paper_mm=(100, 68),
    )


def cam():
    """A cam and a follower with a flat face: at the contact, the sliding velocity lies along the common
    tangent."""
    O, K, radius = 0j, polar(22.0, 30), 48.0
    I = K + 1j * radius
    face = I.imag
    return Figure(
        wheel(K, radius),
        ground_pivot(O, "O"),
        link(complex(-60, face), complex(75, face)),
        link(complex(0, face), complex(0, face + 62)),
        point(K, "K"),
        line(K, I, dashed=True),
        point(I, "I", toward=230),
        line(complex(-85, face), complex(110, face), dashed=True),
        vector(I, 42 + 0j, r"\vec V_{I_3/I_2}"),
        rotation_arrow(O, 30, 250, 310, r"\omega_2"),
        note(complex(8, face + 55), "3"),
        note(K + 25 - 10j, "2"),
        paper_mm=(90, 65),
    )


# ------------------------------------------------------------------ polygons to be matched

#: Angles of the crank in four positions, and the order in which their polygons stand.
POSITIONS, ORDER = (40.0, 110.0, 215.0, 290.0), (2, 0, 3, 1)


def polygons_to_be_matched():
    """Four positions of one linkage, and their polygons in another order."""
    linkages, polygons = [], []
    for theta2 in POSITIONS:
        A, C = complex(polar(R2, theta2)), complex(R1)
        B = complex(rrr(A, C, R3, R4, 1))
        linkages.append(
            [link(0, A), link(A, B), link(C, B), ground_pivot(0), ground_pivot(C), pin(A, "A"), pin(B, "B")]
        )
        a, across = 1j * A, 1j * (B - C)
        along = B - A
        # Equal projections on AB.
        b = across * (a * along.conjugate()).real / (across * along.conjugate()).real
        polygons.append([vector(0, a, "V_A"), vector(0, b, "V_B"), line(a, b)])
    drawings = [*linkages, *(polygons[k] for k in ORDER)]
    return Figure(*rows_of(drawings, 4, 100 + 80j), paper_mm=(165, 95))
