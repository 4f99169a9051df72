"""Figures of the lesson on accelerations: the four terms, polygons, and where Coriolis comes from and points
to."""

import numpy as np

from coursework.degrees import angle, polar
from coursework.figures import (
    Figure,
    angle_mark,
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
    vector,
)
from coursework.kinematics.dyads import rrr

from ._machines import rows_of

#: Mm, degrees, rad/s: the linkage of the lesson.
R1, R2, R3, R4, THETA2, OMEGA2 = (
    200.0,
    60.0,
    180.0,
    140.0,
    60.0,
    10.0,
)
KA = 100.0  #: mm/s^2 for a mm of its polygon
SLOTTED_KA = 200.0
E_ON_AB = 0.42 + 0.40j  #: the coupler's third point: AE over AB


def _unit(z):
    return z / abs(z)


def _dot(u, v):
    return (np.conj(u) * v).real


def _cross(u, v):
    return (np.conj(u) * v).imag


def _linkage():
    """Vectors OA, AB, CB of the lesson's linkage."""
    A = polar(R2, THETA2)
    B = rrr(A, complex(R1), R3, R4)
    return A, B - A, B - R1


def _images():
    """Of A, of b', of b'' and of B, mm/s^2, at a constant rate of the crank."""
    OA, AB, CB = _linkage()
    omega3, omega4 = (OMEGA2 * _cross(OA, one) / _cross(CB, AB) for one in (CB, AB))
    a, b_n, b_m = -(OMEGA2**2) * OA, -(omega3**2) * AB, -(omega4**2) * CB
    gap = b_m - a - b_n  # i alpha3 AB - i alpha4 CB
    alpha3 = -_dot(gap, CB) / _cross(CB, AB)
    return a, a + b_n, b_m, a + b_n + 1j * alpha3 * AB


def four_terms():
    """The four terms of the second derivative at the end of a vector: two along it, two across it."""
    tip = polar(100.0, 30)
    u = _unit(tip)
    return Figure(
        axes(0j, 45),
        line(0j, tip),
        line(tip, 1.7 * tip, dashed=True),
        vector(tip, 42 * u, r"\ddot r"),
        vector(tip, -38 * u, r"r\,\omega^2"),
        vector(tip, 44j * u, r"2\,\dot r\,\omega"),
        vector(tip, -32j * u, r"r\,\alpha"),
        angle_mark(0j, 0, 30, r"\theta", radius=30),
        point(0j, "O", toward=225),
        point(tip),
        paper_mm=(100, 60),
    )


def normal_and_tangential():
    """A bar AB: the acceleration of B about A, towards A and across."""
    B = polar(100.0, 30)
    u = _unit(B)
    normal, tangential = -34 * u, 46j * u
    return Figure(
        link(0j, B),
        vector(B, normal, r"\vec a^n"),
        vector(B, tangential, r"\vec a^t"),
        vector(B, normal + tangential, r"\vec a_{B/A}"),
        line(B + normal, B + normal + tangential, dashed=True),
        line(B + tangential, B + normal + tangential, dashed=True),
        rotation_arrow(0j, 42, 340, 372, r"\omega"),
        rotation_arrow(0j, 60, 340, 372, r"\alpha"),
        pin(0j, "A", toward=225),
        pin(B, "B", toward=-30),
        paper_mm=(90, 62),
    )


def _paper(at=0j, scale=KA):
    return at, *(at + z / scale for z in _images())


def steps_of_the_polygon():
    """Three states of the acceleration polygon, side by side."""
    _, AB, CB = _linkage()
    apart, across, other = 82.0, _unit(1j * AB), _unit(1j * CB)
    p, a, n, m, b = _paper()
    first = (
        vector(p, a - p),
        vector(a, n - a),
        point(p, "p_a"),
        point(a, "a", toward=0),
        point(n, "b'", toward=200),
        note(p - 36 + 2j, "1"),
    )
    p, a, n, m, b = _paper(apart)
    second = (
        vector(p, a - p),
        vector(a, n - a),
        line(n - 6 * across, n + 56 * across, dashed=True),
        point(p, "p_a"),
        point(a, "a", toward=0),
        point(n, "b'", toward=200),
        note(p - 36 + 2j, "2"),
    )
    p, a, n, m, b = _paper(2 * apart)
    third = (
        vector(p, a - p),
        vector(a, n - a),
        line(n - 6 * across, n + 56 * across, dashed=True),
        vector(p, m - p),
        line(m - 6 * other, m + 70 * other, dashed=True),
        point(p, "p_a"),
        point(a, "a", toward=0),
        point(n, "b'", toward=200),
        point(m, "b''", toward=-45),
        point(b, "b", toward=150),
        note(p - 36 + 2j, "3"),
    )
    return Figure(*first, *second, *third, paper_mm=(165, 62))


def polygon():
    """The whole polygon of the lesson's linkage."""
    p, a, n, m, b = _paper()
    return Figure(
        vector(p, a - p, r"\vec a_A"),
        vector(a, n - a, r"\vec a^n_{B/A}"),
        vector(n, b - n, r"\vec a^t_{B/A}"),
        vector(p, m - p, r"\vec a^n_B"),
        vector(m, b - m, r"\vec a^t_B"),
        vector(p, b - p, r"\vec a_B"),
        point(p, "p_a", toward=45),
        point(a, "a", toward=-20),
        point(n, "b'", toward=200),
        point(m, "b''", toward=-30),
        point(b, "b", toward=150),
        scale=1,
    )


def image_of_a_link():
    """The coupler as a plate ABE; in the polygon a triangle abe of the same shape, turned by one angle."""
    OA, AB, _ = _linkage()
    O, A, B = 0j, OA, OA + AB
    E = A + E_ON_AB * AB
    p = 430 + 215j
    a, _, _, b = (p + z / 36 for z in _images())
    e = a + E_ON_AB * (b - a)
    return Figure(
        line(O, R1 + 0j, dashed=True),
        link(A, B, E),
        link(O, A),
        link(R1 + 0j, B),
        ground_pivot(O, "O"),
        ground_pivot(R1 + 0j, "C"),
        pin(A, "A"),
        pin(B, "B"),
        pin(E, "E"),
        line(p, a),
        line(p, b),
        line(p, e, dashed=True),
        link(a, b, e),
        point(p, "p_a"),
        point(a, "a"),
        point(b, "b"),
        point(e, "e"),
        paper_mm=(150, 80),
    )


def where_coriolis_comes_from():
    """A guide a moment apart. On the left the sliding velocity has turned; on the right the radius has
    grown."""
    return Figure(*_turned(0j), *_carried(175 + 0j), paper_mm=(130, 64))


def _turned(at):
    before, after = polar(1.0, 20), polar(1.0, 48)
    start, end = at + 55 * before, at + 55 * after
    slide = 46.0
    moved = at + 118j
    return (
        line(at, at + 118 * before, dashed=True),
        line(at, at + 118 * after, dashed=True),
        vector(start, slide * before, r"\dot r"),
        vector(end, slide * after, r"\dot r"),
        angle_mark(at, 20, 48, r"\omega\,\Delta t", radius=34),
        point(at, "O", toward=225),
        vector(moved, slide * before),
        vector(moved, slide * after),
        vector(moved + slide * before, slide * (after - before), r"\dot r\,\omega\,\Delta t"),
        note(at + complex(45, -16), "1"),
    )


def _carried(at):
    along = polar(1.0, 35)
    near, far = at + 62 * along, at + 96 * along
    shared = 0.62j * 62 * along
    return (
        line(at, at + 118 * along, dashed=True),
        vector(near, shared, r"r\,\omega"),
        vector(far, 0.62j * 96 * along),
        line(near + shared, far + shared, dashed=True),
        vector(far + shared, 0.62j * 34 * along, r"\dot r\,\Delta t\,\omega"),
        vector(near, 34 * along, r"\dot r\,\Delta t"),
        point(at, "O", toward=225),
        point(near),
        point(far),
        note(at + complex(45, -16), "2"),
    )


def bead_on_a_turning_bar():
    """A bar at a constant rate, a bead that slides out and in again: its sliding velocity and its Coriolis
    acceleration."""
    return [_bead(turned) for turned in np.arange(0.0, 360.0, 10.0)]


def _bead(turned):
    u = polar(1.0, turned)
    r, slide = 75 - 35 * np.cos(np.radians(turned)), 35 * np.sin(np.radians(turned))
    C = r * u
    return Figure(
        circle(0j, 122, dashed=True),
        slot_link(0j, 122 * u),
        slider(C, turned),
        ground_pivot(0j),
        vector(C, slide * u, r"\dot r"),
        vector(C, 1.5j * slide * u, r"\vec a^c"),
        paper_mm=(85, 85),
    )


def four_senses():
    """Sliding out or in, turning one way or the other; the Coriolis acceleration of each."""
    panels = [
        _sense(62.0 * k, slide, turn) for k, (slide, turn) in enumerate(((1, 1), (1, -1), (-1, 1), (-1, -1)))
    ]
    return Figure(*(element for panel in panels for element in panel), paper_mm=(165, 62))


def _sense(x, slide, turn):
    O, along = x + 0j, 1j
    C = O + 42 * along
    return (
        slot_link(O, O + 76 * along),
        slider(C, 90),
        point(C),
        ground_pivot(O),
        vector(C, 24 * slide * along, r"\dot r"),
        vector(C, 24j * slide * turn * along, r"\vec a^c"),
        rotation_arrow(O, 20, 90 - 40 * turn, 90 - 12 * turn, r"\omega"),
    )


def _slotted():
    """O2, A; then the images of A, of k, of a_4' and of A_4, mm/s^2."""
    O2 = 228.6j
    crank = polar(114.3, 135)
    A = O2 + crank
    u, V_A = _unit(A), 1j * OMEGA2 * crank
    slide, omega = _dot(u, V_A), _dot(1j * u, V_A) / abs(A)
    a = -(OMEGA2**2) * crank
    coriolis = 2j * omega * slide * u
    normal = -(omega**2) * A
    own = normal + _dot(1j * u, a - coriolis) * 1j * u
    return O2, A, a, a - coriolis, normal, own


def slotted_mechanism():
    """The mechanism, the sliding velocity of A and its Coriolis acceleration, which is that velocity
    turned."""
    O2, A, a, k, *_ = _slotted()
    u = _unit(A)
    return Figure(
        slot_link(0j, 1.35 * A),
        line(0j, O2, dashed=True),
        link(O2, A),
        slider(A, angle(A)),
        pin(A, "A", toward=120),
        ground_pivot(0j, "O_4"),
        ground_pivot(O2, "O_2"),
        rotation_arrow(0j, 115, 112, 136, r"\omega_4"),
        rotation_arrow(O2, 45, 15, 65, r"\omega_2"),
        vector(A, -110 * u, r"\vec V_{A/A_4}"),
        vector(A, (a - k) / 33, r"\vec a^c"),
        note(1.42 * A, "4"),
        paper_mm=(80, 76),
    )


def steps_with_coriolis():
    """Three states of the polygon with Coriolis, side by side."""
    _, A, *images = _slotted()
    u = _unit(A)
    shown = []
    for step in (1, 2, 3):
        p = 68.0 * (step - 1) + 0j
        a, k, normal, own = (p + z / SLOTTED_KA for z in images)
        shown += [vector(p, a - p), vector(k, a - k), point(p, "p_a"), point(a, "a"), point(k, "k")]
        shown += [note(p - 6 - 46j, f"{step}")]
        if step > 1:
            shown += [vector(p, normal - p), line(normal + 6j * u, normal - 22j * u, dashed=True)]
            shown += [point(normal, "a_4'", toward=190)]
        if step > 2:
            shown += [line(k - 5 * u, k + 42 * u, dashed=True), point(own, "a_4", toward=45)]
    return Figure(*shown, paper_mm=(165, 62))


def polygon_with_coriolis():
    """The whole polygon of the slotted mechanism."""
    _, _, *images = _slotted()
    a, k, normal, own = (1.3 * z / SLOTTED_KA for z in images)
    return Figure(
        vector(0j, a, r"\vec a_A"),
        vector(k, a - k, r"\vec a^c"),
        vector(0j, normal, r"\vec a^n_{A_4}"),
        vector(normal, own - normal, r"\vec a^t_{A_4}"),
        vector(own, k - own, r"\vec a^s_{A/A_4}"),
        point(0j, "p_a", toward=135),
        point(a, "a", toward=0),
        point(k, "k", toward=225),
        point(normal, "a_4'", toward=190),
        point(own, "a_4", toward=45),
        scale=1,
    )


# ------------------------------------------------------------------ senses to be found

#: The sense of the guide's rotation, 1 anticlockwise, and that of the sliding, 1 away from the pivot.
SENSES = ((1, 1), (-1, 1), (1, -1), (-1, -1))


def sides_of_coriolis():
    """Four turning guides with a block that slides in them, and the two sides to choose from."""
    drawings = []
    for turns, slides in SENSES:
        along = complex(polar(1.0, 60.0))
        at = 60 * along
        ends = (-30, 50) if turns > 0 else (50, -30)
        drawings.append(
            [
                slot_link(0, 110 * along),
                ground_pivot(0),
                slider(at, 60.0),
                vector(at, 34 * slides * along),
                rotation_arrow(0, 28, 60 + ends[0], 60 + ends[1], r"\omega"),
                note(at + 20j * along, "1"),
                note(at - 20j * along, "2"),
            ]
        )
    return Figure(*rows_of(drawings, 4, 100 + 100j), paper_mm=(165, 55))
