"""Common base of exercises with drawn polygons: parts, and four-bar linkages and slider-cranks that make good
drawings."""

from typing import Any, NamedTuple

import numpy as np

from coursework.degrees import angle, polar
from coursework.figures import (
    Figure,
    angle_mark,
    dimension,
    ground_pivot,
    line,
    link,
    pin,
    rail,
    slider,
    slot_link,
)
from coursework.kinematics.dyads import rrp, rrr, side_of
from coursework.kinematics.vectors import cross
from coursework.language.numbers import significant
from coursework.model import Part, chosen, drawn, in_turn

PAPER_MM = (160, 90)  #: the box of millimetre paper to draw in
KNOWN = ("both", "direction", "length", "neither")


def known(*quantities, count=2):
    """Return the data of a vector before it is drawn, for a number of rows of the table."""
    rows = (Part(quantity, kind="choice", choices=KNOWN) for quantity in quantities)
    return in_turn(count, ("r2", "theta2", "omega2"), *rows)


def of_drawing(quantity, unit="mm", kind="number", points=1):
    return Part(quantity, unit=unit, kind=kind, points=points, judge="drawing")


def told_angle(vector):
    """The direction of a bar as the statement tells it: LaTeX, to the tenth of a degree."""
    return rf"\num{{{float(angle(vector)):.1f}}}^{{\circ}}"


def told_number(value):
    """A number as the statement tells it: LaTeX, four digits."""
    return rf"\num{{{significant(float(value))}}}"


# ------------------------------------------------------------------------- four-bar

FOUR_BAR = {
    "r1": drawn(120, 260, step=5, unit="mm"),
    "r2": drawn(40, 100, step=5, unit="mm"),
    "r3": drawn(100, 260, step=5, unit="mm"),
    "r4": drawn(80, 200, step=5, unit="mm"),
    "theta2": drawn(-175, 180, step=5, unit="deg"),
    "omega2": drawn(-20, 20, unit="rad/s"),
    "mode": chosen("open", "crossed"),
}


def bars(r1, r2, r3, r4, theta2, mode):
    """Vectors OA, AB and CB."""
    A, C = polar(r2, theta2), r1 + 0j
    B = rrr(A, C, r3, r4, side_of(mode))
    return A, B - A, B - C


def crank_turns_visibly(omega2):
    return abs(omega2) >= 4


def lines_cross_clearly(bars):
    """Coupler and rocker 35 degrees apart at least, and so the lines that find b."""
    return abs(cross(bars[1], bars[2])) > 0.57 * abs(bars[1]) * abs(bars[2])


def four_bar_figure(bars, r1, r2, theta2):
    O, A, C = 0j, bars[0], complex(r1)
    B = A + bars[1]
    return Figure(
        line(O, C, dashed=True, label="r_1"),
        link(O, A, label="r_2"),
        link(A, B, label="r_3"),
        link(C, B, label="r_4"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        angle_mark(O, 0, theta2, r"\theta_2"),
    )


# --------------------------------------------------------------------- slider-crank


def largest_offset(r2):
    """A quarter of the cranks, those of 20 mm times a whole number, are in line with their piston."""
    return np.where(r2 % 20 == 0, 0.0, 0.5 * r2)


SLIDER_CRANK = {
    "r2": drawn(30, 100, step=5, unit="mm"),
    "r3": drawn(lambda r2: 1.5 * r2, lambda r2: 3 * r2, step=5, unit="mm", positive=True),
    "e": drawn(lambda r2: -largest_offset(r2), largest_offset, step=5, unit="mm", default=0),
    "theta2": drawn(-175, 180, step=5, unit="deg"),
    "omega2": drawn(-40, 40, unit="rad/s"),
}


def offset_is_none_or_visible(e, r2):
    return (e == 0) | (abs(e) >= 0.2 * r2)


def rod_reaches_all_turn(r2, r3, e):
    return r3 > 1.2 * (r2 + abs(e))


def rod(r2, r3, e, theta2):
    """Vector AB."""
    crank = polar(r2, theta2)
    return rrp(crank, r3, e) - crank


def slider_crank_figure(rod, r2, theta2, e):
    O, A = 0j, polar(r2, theta2)
    B, half_rail = A + rod, 0.5 * r2
    end = B.real + 1.6 * half_rail
    return Figure(
        rail(B - half_rail, B + half_rail),
        line(O, end, dashed=True),
        *(
            (line(B, complex(end, e), dashed=True), dimension(end, complex(end, e), "e", offset=0))
            if e
            else ()
        ),
        link(O, A, label="r_2"),
        link(A, B, label="r_3"),
        slider(B),
        ground_pivot(O, "O"),
        pin(A, "A"),
        pin(B, "B"),
        angle_mark(O, 0, theta2, r"\theta_2"),
    )


def all_long(share, *vectors):
    """Return whether the shortest vector has at least this share of the longest."""
    lengths = [abs(v) for v in vectors]
    return np.minimum.reduce(lengths) > share * np.maximum.reduce(lengths)


def on_paper(vector):
    """Return the length of a vector of a drawing, components along the last axis, in mm."""
    return np.hypot(vector[..., 0], vector[..., 1])


def velocities_are_long_enough_to_draw(p, a, ab, pv_b):
    """The shortest is a third of the longest at least."""
    return all_long(1 / 3, on_paper(a - p), ab, pv_b)


# ------------------------------------------------------------------------ slotted guide


class Guided(NamedTuple):
    """A slotted mechanism: vectors O2A and O4A."""

    crank: Any
    arm: Any

    @property
    def along(self):
        """Unit vector of the guide, away from O4."""
        return self.arm / abs(self.arm)


def guided(r1, r2, theta2):
    """Of O2 at the height r1 above O4, the origin."""
    crank = polar(r2, theta2)
    return Guided(crank, 1j * r1 + crank)


SLOTTED = {
    "r1": drawn(100, 300, step=5, unit="mm"),
    "r2": drawn(40, 250, step=5, unit="mm"),
    "theta2": drawn(-175, 180, step=5, unit="deg"),
    "omega2": drawn(-20, 20, unit="rad/s"),
}


def slotted_figure(guided, r1, r2, theta2):
    O4, O2, A = 0j, 1j * r1, guided.arm
    beyond = guided.along * (r1 + r2) * 1.1
    return Figure(
        slot_link(O4, beyond),
        line(O4, O2, dashed=True, label="r_1"),
        link(O2, A, label="r_2"),
        slider(A, angle(A), label="A"),
        pin(A),
        ground_pivot(O4, "O_4"),
        ground_pivot(O2, "O_2"),
        line(O2, O2 + 0.6 * r2, dashed=True),
        angle_mark(O2, 0, theta2, r"\theta_2"),
    )
