"""Mechanisms of the course as figures, by their lengths and angles."""

import cmath
import math

import pytest

from coursework.figures import (
    Figure,
    angle_mark,
    arc,
    axes,
    ball,
    centre_line,
    circle,
    contact,
    dimension,
    ground_pivot,
    line,
    link,
    note,
    pin,
    point,
    rail,
    rotation_arrow,
    section,
    slider,
    slot_link,
    trace,
    vector,
)


def polar(r, degrees):
    return cmath.rect(r, math.radians(degrees))


def angle(z):
    return math.degrees(cmath.phase(z))


def meet(p, rp, q, rq, side=1):
    """Intersection of two circles, on the left of p→q for side 1."""
    d = abs(q - p)
    x = (d * d + rp * rp - rq * rq) / (2 * d)
    return p + (q - p) / d * complex(x, side * math.sqrt(rp * rp - x * x))


def slotted(r1=228.6, r2=114.3, theta2=135):
    o2 = 1j * r1
    a = o2 + polar(r2, theta2)
    theta4 = angle(a)
    return Figure(
        axes(0, 90),
        line(0, o2, dashed=True, label="r_1"),
        slot_link(0, polar(r1 + 1.25 * r2, theta4)),
        slider(a, theta4),
        link(o2, a, label="r_2"),
        circle(o2, r2, dashed=True),
        ground_pivot(0, "O_4"),
        ground_pivot(o2, "O_2"),
        pin(a, "A"),
        angle_mark(o2, 0, theta2, r"\theta_2"),
        angle_mark(0, 0, theta4, r"\theta_4"),
    )


def four_bar(r1=200, r2=70, r3=180, r4=120, theta2=60, side=1):
    a, c = polar(r2, theta2), complex(r1)
    b = meet(a, r3, c, r4, side)
    return Figure(
        axes(0, 60),
        dimension(0, c, "r_1"),
        link(0, a, label="r_2"),
        link(a, b, label="r_3"),
        link(c, b, label="r_4"),
        ground_pivot(0, "O"),
        ground_pivot(c, "C"),
        pin(a, "A"),
        pin(b, "B"),
        angle_mark(0, 0, theta2, r"\theta_2"),
        angle_mark(c, 0, angle(b - c), r"\theta_4"),
        angle_mark(a, 0, angle(b - a), r"\theta_3"),
    )


def six_link(r1=120, r2=40, r3=130, r4=100, r5=240, theta2=30):
    o = 1j * r1
    a = o + polar(r2, theta2)
    b = meet(a, r3, 0j, r4, -1)
    c = b.real + math.sqrt(r5**2 - b.imag**2)
    return Figure(
        axes(0, 45),
        line(0, o, dashed=True, label="r_1"),
        link(o, a, label="r_2"),
        link(a, b, label="r_3"),
        link(0, b, label="r_4"),
        link(c, b, label="r_5"),
        rail(c - 50, c + 50),
        slider(c, 0),
        ground_pivot(0, "D"),
        ground_pivot(o, "O"),
        pin(a, "A"),
        pin(b, "B"),
        pin(c, "C"),
        dimension(0, c, "r_6"),
        angle_mark(o, 0, theta2, r"\theta_2"),
        angle_mark(0, 0, angle(b), r"\theta_4"),
    )


def ball_reducer(R=40, r=12):
    o3, edge, wall = complex(R + r, 0), R + 2 * r, R + 2 * r + 9
    frame = [edge + 8j, edge - 1j * r, R + 3 - 1j * r, R + 3 - 1j * (r + 9), wall - 1j * (r + 9), wall + 8j]
    return Figure(
        section((-26j, R - 26j, R + 5j, 5j), "S_1"),
        section((1j * r, edge + 1j * r, edge + 1j * (r + 9), 1j * (r + 9)), "S_2", -45),
        section(tuple(frame), "S_0", -45),
        ball(o3, r),
        centre_line(-44j, 38j, "z"),
        contact(o3 + r, "A", toward=180),
        contact(o3 - 1j * r, "B", toward=90),
        contact(o3 - r, "C", toward=0),
        contact(o3 + 1j * r, "D", toward=-90),
        point(o3, "O_3"),
        dimension(-26j, R - 26j, "R", offset=-7),
        dimension(o3 - 1j * r, o3 + r - 1j * r, "r", offset=-21),
        rotation_arrow(-38j, 6, 210, 330, r"\dot{\psi}"),
        rotation_arrow(33j, 6, 210, 330, r"\dot{\theta}"),
    )


def quick_return(r1=300, theta1=-60, r2=105, r3=330, r4=420, r5=500, h=420, theta2=100):
    a, d = polar(r2, theta2), polar(r1, theta1)
    b = meet(a, r3, d, r4)
    c = complex(b.real + math.sqrt(r5**2 - (h - b.imag) ** 2), h)
    return Figure(
        axes(0, 130),
        link(0, a, label="r_2"),
        link(a, b, label="r_3"),
        link(d, b, label="r_4"),
        link(b, c, label="r_5"),
        rail(c + 120, c - 190),
        slider(c, 0),
        line(0, d, dashed=True, label="r_1"),
        circle(0, r2, dashed=True),
        ground_pivot(0, "O"),
        ground_pivot(d, "D"),
        pin(a, "A"),
        pin(b, "B"),
        pin(c, "C"),
        rotation_arrow(0, 45, 150, 230, r"\omega_2"),
        angle_mark(a, angle(-a), angle(b - a), r"\alpha"),
        vector(c, -90, r"\overrightarrow{V}_C"),
    )


def slider_crank(r2=50, r3=150, theta2=50):
    a = polar(r2, theta2)
    b = complex(a.real + math.sqrt(r3**2 - a.imag**2))
    return Figure(
        axes(0, 75),
        link(0, a, label="r_2"),
        link(a, b, label="r_3"),
        rail(b - 40, b + 40),
        slider(b, 0),
        ground_pivot(0, "O"),
        pin(a, "A"),
        pin(b, "B"),
        angle_mark(0, 0, theta2, r"\theta_2"),
        dimension(0, b, "r_1"),
        trace([polar(r2, k) for k in range(0, 361, 5)]),
    )


def two_loops():
    c, f = 180 - 20j, 330 + 40j
    a = polar(60, 70)
    b = meet(a, 170, c, 110)
    d = c + polar(120, angle(b - c) - 50)
    e = meet(d, 130, f, 90)
    return Figure(
        link(0, a, label="r_2"),
        link(a, b, label="r_3"),
        link(c, b, d, label="4"),
        link(d, e, label="r_6"),
        link(f, e, label="r_7"),
        ground_pivot(0, "O"),
        ground_pivot(c, "C"),
        ground_pivot(f, "F"),
        pin(a, "A"),
        pin(b, "B"),
        pin(d, "D"),
        pin(e, "E"),
        angle_mark(c, angle(b - c), angle(d - c), r"\beta"),
        note(complex(330, 150), "groupe 6-7"),
        arc(0, 60, 0, 180, dashed=True),
        link(f, f + 40, f + 40 + 30j, weld=True),
    )


SAMPLES = {
    "slotted": slotted,
    "four_bar": four_bar,
    "six_link": six_link,
    "ball_reducer": ball_reducer,
    "quick_return": quick_return,
    "slider_crank": slider_crank,
    "two_loops": two_loops,
}
every_sample = pytest.mark.parametrize("name", SAMPLES)
