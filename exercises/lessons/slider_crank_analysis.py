"""Figures of the lesson on the slider-crank: the mechanism, its loop, its polygons; then six bars with a
slider."""

import numpy as np

from coursework.degrees import angle, polar
from coursework.figures import (
    Figure,
    angle_mark,
    arc,
    centre_line,
    dimension,
    ground_pivot,
    line,
    link,
    pin,
    point,
    rail,
    rotation_arrow,
    slider,
    trace,
    vector,
)
from coursework.figures.polygons import (
    crank_a,
    crank_v,
    polygon_of_accelerations,
    polygon_of_velocities,
    slider_a,
    slider_v,
    two_bars_a,
    two_bars_v,
)
from coursework.figures.polygons.construction import Construction
from coursework.kinematics.dyads import rrp, rrr
from coursework.kinematics.vectors import cross, dot

from ._machines import rows_of

# The example of the lesson: mm, degrees, rad/s.
R2, R3, E, THETA2, OMEGA2 = 60.0, 180.0, 20.0, 60.0, 10.0
KV, KA = 10.0, 100.0


def _pose(theta2, e=E):
    """Pins A and B of the slider-crank."""
    A = polar(R2, theta2)
    return A, rrp(A, R3, e)


def slider_crank():
    A, B = _pose(THETA2)
    return Figure(
        centre_line(-30, B.real + 90, label="x"),
        rail(B - 55, B + 55),
        dimension(B.real + 75, B + 75, "e", offset=0),
        dimension(0, B.real, "r_1", offset=-42),
        link(0, A, label="r_2"),
        link(A, B, label="r_3"),
        line(A, A + 48, dashed=True),
        slider(B),
        ground_pivot(0, "O"),
        pin(A, "A"),
        pin(B, "B"),
        angle_mark(0, 0, THETA2, r"\theta_2"),
        angle_mark(A, 0, angle(B - A), r"\theta_3", radius=90),
        rotation_arrow(0, 40, 110, 165, r"\omega_2"),
    )


def loop():
    """The four vectors of the loop, laid end to end."""
    A, B = _pose(THETA2)
    return Figure(
        vector(0, A, "r_2"),
        vector(A, B - A, "r_3"),
        vector(0, B.real, "r_1"),
        vector(B.real, 1j * B.imag, "e"),
        point(0, "O"),
        point(A, "A"),
        point(B, "B"),
        paper_mm=(90, 50),
    )


def two_roots():
    """The circle of the rod cuts the line of the piston twice."""
    A, B = _pose(THETA2)
    other = 2 * A.real + 2j * E - complex(B.real, B.imag)
    return Figure(
        line(other.real - 20 + 1j * E, B + 40, dashed=True),
        arc(A, R3, -35, 8, dashed=True),
        arc(A, R3, 172, 215, dashed=True),
        link(0, A, label="r_2"),
        link(A, B, label="r_3"),
        line(A, other, dashed=True, label="r_3"),
        slider(B),
        ground_pivot(0, "O"),
        pin(A, "A"),
        pin(B, "B_1"),
        point(other, "B_2"),
        paper_mm=(105, 55),
    )


def _rates():
    """Crank OA, rod AB; omega3, v_B; alpha3, a_B."""
    A, B = _pose(THETA2)
    rod = B - A
    omega3 = -OMEGA2 * A.real / rod.real
    v_B = -OMEGA2 * A.imag - omega3 * rod.imag
    alpha3 = (OMEGA2**2 * A.imag + omega3**2 * rod.imag) / rod.real
    a_B = -(OMEGA2**2) * A.real - alpha3 * rod.imag - omega3**2 * rod.real
    return A, rod, omega3, v_B, alpha3, a_B


def velocity_polygon():
    A, rod, omega3, v_B, *_ = _rates()
    polygon = polygon_of_velocities(
        crank_v("A", "OA", A, OMEGA2), slider_v("B", "A", rod, omega3, v_B), scale=KV
    )
    return Construction(polygon, "en").figure


def acceleration_polygon():
    A, rod, omega3, _, alpha3, a_B = _rates()
    polygon = polygon_of_accelerations(
        crank_a("A", "OA", A, OMEGA2), slider_a("B", "A", rod, omega3, alpha3, "r_3", a_B), scale=KA
    )
    return Construction(polygon, "en").figure


# Six bars: the crank's pivot O above D, the slider P on the x axis.
R1, CRANK, COUPLER, ROCKER, ROD, THETA = 120.0, 50.0, 110.0, 130.0, 220.0, 100.0


def _six_bar():
    O = 1j * R1
    A = O + polar(CRANK, THETA)
    B = rrr(A, 0j, COUPLER, ROCKER, 1)
    return O, A, B, rrp(B, ROD, 0.0)


def six_bar():
    O, A, B, P = _six_bar()
    return Figure(
        rail(P - 45, P + 45),
        centre_line(0, P.real + 80, label="x"),
        dimension(0, P.real, "r_6", offset=-38),
        line(0, O, dashed=True, label="r_1"),
        link(O, A, label="r_2"),
        link(A, B, label="r_3"),
        link(0, B, label="r_4"),
        link(P, B, label="r_5"),
        slider(P),
        ground_pivot(0, "D"),
        ground_pivot(O, "O"),
        pin(A, "A"),
        pin(B, "B"),
        pin(P, "P"),
        angle_mark(O, 0, THETA, r"\theta_2"),
    )


def six_bar_loops():
    """Two polygons that share the vector of the rocker."""
    O, A, B, P = _six_bar()
    return Figure(
        vector(0, O, "r_1"),
        vector(O, A - O, "r_2"),
        vector(A, B - A, "r_3"),
        vector(0, B, "r_4"),
        vector(P, B - P, "r_5"),
        vector(0, P, "r_6"),
        rotation_arrow((O + A + B) / 4, 14, 150, -120, "1"),
        rotation_arrow((B + P) / 3, 12, -120, 150, "2"),
        point(0, "D"),
        point(O, "O"),
        point(A, "A"),
        point(B, "B"),
        point(P, "P"),
    )


def _six_bar_rates():
    """Vectors OA, AB, DB, PB; their rates for 10 rad/s of the crank; the second ones."""
    O, A, B, P = _six_bar()
    crank, coupler, rocker, rod, w2 = A - O, B - A, B, B - P, OMEGA2
    w3 = w2 * cross(crank, rocker) / cross(rocker, coupler)
    w4 = w2 * cross(crank, coupler) / cross(rocker, coupler)
    w5 = w4 * rocker.real / rod.real
    rest = w2**2 * crank + w3**2 * coupler - w4**2 * rocker
    a3, a4 = dot(rest, rocker) / cross(coupler, rocker), dot(rest, coupler) / cross(coupler, rocker)
    a5 = (a4 * rocker.real - w4**2 * rocker.imag + w5**2 * rod.imag) / rod.real
    return (crank, coupler, rocker, rod), (w3, w4, w5), (a3, a4, a5)


def six_bar_velocities():
    (crank, coupler, rocker, rod), (w3, w4, w5), _ = _six_bar_rates()
    v_P = (1j * w4 * rocker - 1j * w5 * rod).real
    polygon = polygon_of_velocities(
        crank_v("A", "OA", crank, OMEGA2),
        two_bars_v("B", "A", "D", coupler, w3, rocker, w4),
        slider_v("P", "B", -rod, w5, v_P),
    )
    return Construction(polygon, "en").figure


def six_bar_accelerations():
    (crank, coupler, rocker, rod), (w3, w4, w5), (a3, a4, a5) = _six_bar_rates()
    a_P = ((1j * a4 - w4**2) * rocker - (1j * a5 - w5**2) * rod).real
    polygon = polygon_of_accelerations(
        crank_a("A", "OA", crank, OMEGA2),
        two_bars_a("B", "A", "D", coupler, w3, a3, "r_3", rocker, w4, a4, "r_4"),
        slider_a("P", "B", -rod, w5, a5, "r_5", a_P),
    )
    return Construction(polygon, "en").figure


# ------------------------------------------------------------------ curves to be named


def curves_to_be_named():
    """Position, velocity and acceleration of a piston over a turn of the crank, without names, each to its
    own scale."""
    turn = np.radians(np.arange(0.0, 361.0, 3.0))
    ratio = R3 / R2
    leaning = np.sqrt(ratio**2 - np.sin(turn) ** 2)
    curves = [
        -np.sin(turn) - np.sin(turn) * np.cos(turn) / leaning,
        -np.cos(turn) - (np.cos(2 * turn) * leaning**2 + (np.sin(2 * turn) / 2) ** 2) / leaning**3,
        np.cos(turn) + leaning - ratio,
    ]
    drawings = []
    for curve in curves:
        high = 40 * curve / np.abs(curve).max()
        points = tuple(complex(x, y) for x, y in zip(np.degrees(turn) / 3.6, high, strict=True))
        grid = [line(x - 40j, x + 40j, dashed=True) for x in (0, 25, 50, 75, 100)]
        drawings.append([*grid, line(0, 100), trace(points, dotted=False)])
    return Figure(*rows_of(drawings, 3, 100 + 80j), paper_mm=(165, 60))
