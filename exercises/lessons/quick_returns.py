"""Figures of the lesson on quick returns: the arcs of four mechanisms, then a crank and slotted lever drawn
to scale."""

from typing import Any, NamedTuple

from coursework.degrees import angle, asin, atan2, polar
from coursework.figures import (
    Element,
    Figure,
    angle_mark,
    arc,
    centre_line,
    circle,
    dimension,
    ground_pivot,
    line,
    link,
    pin,
    point,
    rail,
    rotation_arrow,
    slider,
    slot_link,
    trace,
)
from coursework.figures.polygons import (
    crank_a,
    crank_v,
    guide_a,
    guide_v,
    normal,
    polygon_of_accelerations,
    polygon_of_velocities,
    slider_a,
    slider_v,
    tangential,
    turning,
)
from coursework.figures.polygons.construction import Construction
from coursework.kinematics.dyads import rrp, rrr

from ._machines import rows_of


def _arcs(center, radius, start, middle):
    """The two arcs of the crank, anticlockwise: alpha from start to middle, beta the rest."""
    return (
        rotation_arrow(center, radius, start, middle, r"\theta_a"),
        rotation_arrow(center, 0.8 * radius, middle, start + 360, r"\theta_r"),
    )


def offset_arcs():
    """A piston out of line with the crank, at both ends of its stroke."""
    r2, r3, e = 60.0, 200.0, 80.0
    far = complex(((r3 + r2) ** 2 - e**2) ** 0.5, e)
    near = complex(((r3 - r2) ** 2 - e**2) ** 0.5, e)
    A1, A2 = -r2 * near / abs(near), r2 * far / abs(far)
    return Figure(
        circle(0, r2, dashed=True),
        centre_line(-70, far.real + 30, "x"),
        rail(near - 20, far + 25),
        dimension(far.real + 18, far + 18, "e", offset=0),
        line(0, A1, thin=False),
        line(A1, near, dashed=True),
        link(0, A2, label="r_2"),
        link(A2, far, label="r_3"),
        slider(near),
        slider(far),
        *_arcs(0, 40, angle(A2), angle(A1) % 360),
        ground_pivot(0, "O"),
        pin(A1, "A_1"),
        pin(A2, "A_2"),
        pin(near, "C_1"),
        pin(far, "C_2"),
    )


def crank_rocker_arcs():
    """A rocker at both ends of its swing: crank and coupler stretched out, and folded."""
    r1, r2, r3, r4 = 130.0, 60.0, 100.0, 115.0
    C = complex(r1)
    far, near = rrr(0j, C, r3 + r2, r4, 1), rrr(0j, C, r3 - r2, r4, 1)
    A1, A2 = -r2 * near / abs(near), r2 * far / abs(far)
    return Figure(
        circle(0, r2, dashed=True),
        arc(C, r4, angle(far - C), angle(near - C), dashed=True),
        line(0, A1, thin=False),
        line(A1, near, dashed=True),
        line(C, near, dashed=True),
        link(0, A2, label="r_2"),
        link(A2, far, label="r_3"),
        link(C, far, label="r_4"),
        *_arcs(0, 40, angle(A2), angle(A1) % 360),
        ground_pivot(0, "O"),
        ground_pivot(C, "C"),
        pin(A1, "A_1"),
        pin(A2, "A_2"),
        pin(near, "B_1"),
        pin(far, "B_2"),
    )


def shaper_arcs():
    """A guide that oscillates, at both ends of its swing: it touches the circle of the crank."""
    r1, r2 = 200.0, 100.0
    swing, O2 = asin(r2 / r1), 1j * r1
    right, left = O2 + polar(r2, -swing), O2 + polar(r2, 180 + swing)
    return Figure(
        circle(O2, r2, dashed=True),
        line(0, O2, dashed=True, label="r_1"),
        line(0, 1.35 * right, dashed=True),
        line(0, 1.35 * left, dashed=True),
        link(O2, right, label="r_2"),
        link(O2, left),
        *_arcs(O2, 60, -swing, 180 + swing),
        angle_mark(0, 90, 90 - swing, r"\varphi", radius=60),
        ground_pivot(0, "O_4"),
        ground_pivot(O2, "O_2"),
        pin(right, "A_1"),
        pin(left, "A_2"),
        paper_mm=(110, 90),
    )


def whitworth_arcs():
    """A guide that turns fully, level at both ends of the stroke: a chord through O4 cuts the circle of the
    crank."""
    r1, r2, r4 = 50.0, 120.0, 90.0
    O2, reach = 1j * r1, (r2**2 - r1**2) ** 0.5
    right, left, tilt = complex(reach), complex(-reach), asin(r1 / r2)
    return Figure(
        circle(O2, r2, dashed=True),
        line(0, O2, dashed=True, label="r_1"),
        line(left - 30, right + 30, dashed=True),
        link(O2, right, label="r_2"),
        link(O2, left),
        *_arcs(O2, 92, -tilt, 180 + tilt),
        angle_mark(O2, -90, -tilt, r"\psi", radius=32),
        ground_pivot(0, "O_4"),
        ground_pivot(O2, "O_2"),
        pin(right, "A_1"),
        pin(left, "A_2"),
        point(complex(r4), "P_1"),
        point(complex(-r4), "P_2"),
        paper_mm=(110, 90),
    )


# The crank and slotted lever of the exercise: mm, rad/s. OC and the height of the ram's line are the lesson's
# own.
CRANK, LEVER, ROD, OMEGA, OC, H = 105.0, 420.0, 165.0, 9.42, 210.0, 450.0
THETA = 20.0  #: the crank 110 degrees from CO
KV, KA = 20.0, 100.0


class _Pose(NamedTuple):
    """Vectors CP, OP, OD, DE; the rates of the lever and the rod, the sliding; the same of the second
    order."""

    crank: Any
    arm: Any
    lever: Any
    rod: Any
    omega4: Any
    omega5: Any
    sliding: Any
    alpha4: Any
    alpha5: Any
    gain: Any
    v_E: Any
    a_E: Any


def _pose(theta):
    crank = polar(CRANK, theta)
    arm = 1j * OC + crank
    along = arm / abs(arm)
    lever = LEVER * along
    rod = rrp(lever, ROD, H) - lever
    of_P = 1j * OMEGA * crank / along
    omega4, sliding = of_P.imag / abs(arm), of_P.real
    of_P = -(OMEGA**2) * crank / along
    alpha4 = (of_P.imag - 2 * sliding * omega4) / abs(arm)
    gain = of_P.real + abs(arm) * omega4**2
    omega5 = -omega4 * lever.real / rod.real
    of_D = (1j * alpha4 - omega4**2) * lever
    alpha5 = (omega5**2 * rod.imag - of_D.imag) / rod.real
    v_E = (1j * omega4 * lever + 1j * omega5 * rod).real
    a_E = (of_D + (1j * alpha5 - omega5**2) * rod).real
    return _Pose(crank, arm, lever, rod, omega4, omega5, sliding, alpha4, alpha5, gain, v_E, a_E)


def slotted_lever():
    """To scale, as it is drawn on paper: 1 cm for 100 mm."""
    it = _pose(THETA)
    O, C, P, D = 0j, 1j * OC, it.arm, it.lever
    E = D + it.rod
    return Figure(
        circle(C, CRANK, dashed=True),
        rail(E - 150, E + 70),
        slot_link(O + 0.16 * D, D),
        line(O, 0.16 * D, thin=False),
        line(O, C, dashed=True),
        link(C, P),
        link(D, E),
        slider(P, angle(D)),
        slider(E),
        rotation_arrow(C, 130, 120, 160, r"\omega"),
        angle_mark(C, -90, THETA, None, radius=50),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(P, "P"),
        pin(D, "D"),
        pin(E, "E"),
        paper_mm=(90, 105),
    )


def slotted_lever_velocities():
    it = _pose(THETA)
    polygon = polygon_of_velocities(
        crank_v("P", "CP", it.crank, OMEGA, "", "CP"),
        guide_v("P", "M", "OP", it.arm, it.omega4, it.sliding),
        (turning("p_v", "d", "D", "OD", it.lever, it.omega4, "OD V_M / OP"),),
        slider_v("E", "D", it.rod, it.omega5, it.v_E),
        scale=KV,
    )
    return Construction(polygon, "en").figure


def slotted_lever_accelerations():
    it = _pose(THETA)
    polygon = polygon_of_accelerations(
        crank_a("P", "CP", it.crank, OMEGA),
        guide_a("P", "M", "OP", it.arm, it.omega4, it.alpha4, it.sliding, it.gain, "OP", r"\omega_4"),
        (
            normal("p_a", "d'", "D", "OD", it.lever, it.omega4, "V_D^2 / OD"),
            tangential("d'", "d", "D", "OD", it.lever, it.alpha4, "OD a_M^t / OP"),
        ),
        slider_a("E", "D", it.rod, it.omega5, it.alpha5, "DE", it.a_E),
        scale=KA,
    )
    return Construction(polygon, "en").figure


def slotted_lever_moving() -> list[Figure]:
    """A whole turn, 48 instants: close together where the lever is slow, far apart on the way back."""
    return [Figure(*_moving(k * 7.5 + THETA)) for k in range(48)]


def _moving(theta) -> tuple[Element, ...]:
    it = _pose(theta)
    C, P, D = 1j * OC, it.arm, it.lever
    E = D + it.rod
    swing = [LEVER * polar(1, 60 + 2 * k) for k in range(31)]
    line_of_E = 1j * H
    return (
        circle(C, CRANK, dashed=True),
        trace(tuple(swing)),
        rail(line_of_E - 140, line_of_E + 430),
        line(0, D, thin=False),
        link(C, P),
        link(D, E),
        slider(P, float(atan2(D.imag, D.real))),
        slider(E),
        ground_pivot(0, "O"),
        ground_pivot(C, "C"),
        pin(P, "P"),
        pin(D, "D"),
        pin(E, "E"),
    )


# ------------------------------------------------------------------ strokes to be compared

#: Height of the piston's line above the crank's pivot, mm, and the sense of the crank, 1 anticlockwise.
STROKES = ((30.0, 1), (30.0, -1), (-30.0, 1), (0.0, 1))


def strokes_to_be_compared():
    """Four slider-cranks with the sense of their cranks: which strokes take longer?"""
    drawings = []
    for e, turns in STROKES:
        A = complex(polar(35.0, 120.0))
        C = complex((90.0**2 - (e - A.imag) ** 2) ** 0.5 + A.real, e)
        ends = (190, 270) if turns > 0 else (270, 190)
        drawings.append(
            [
                circle(0, 35.0, dashed=True),
                rail(complex(40, e), complex(130, e)),
                link(0, A),
                link(A, C),
                slider(C),
                rotation_arrow(0, 25.0, *ends, r"\omega"),
                ground_pivot(0),
                pin(A),
                pin(C),
            ]
        )
    return Figure(*rows_of(drawings, 4, 100 + 70j), paper_mm=(165, 45))
