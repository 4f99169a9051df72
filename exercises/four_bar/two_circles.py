"""Four-bar linkage drawn to scale: where two circles meet, and the angles measured there (Figure 12)."""

import numpy as np

from coursework.degrees import cos, polar
from coursework.figures import Figure, angle_mark, ground_pivot, line, link, pin
from coursework.model import Exercise, drawn

from .._drawn import PAPER_MM, all_long, of_drawing
from .four_bar_positions import crank_off_the_axes


def figure(r1, r2, theta2):
    """Draw the data before the construction, without B."""
    O, A, C = 0j, polar(r2, theta2), complex(r1)
    return Figure(
        line(O, C, dashed=True, label="r_1"),
        link(O, A, label="r_2"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        angle_mark(O, 0, theta2, r"\theta_2"),
        paper_mm=(80, 50),
    )


def _angle(quantity):
    return of_drawing(quantity, "deg", kind="angle")


def circles_cut_clearly(theta3_open, theta4_open):
    """At 40 degrees at least."""
    return abs(cos(theta4_open - theta3_open)) < 0.766


def pins_B_far_apart(b1, b2, kl, r3, r4):
    """Their distance is at least that of the shorter bar."""
    apart = kl * np.hypot(*np.moveaxis(b1 - b2, -1, 0))
    return (apart > r3) | (apart > r4)


def bars_are_long_enough_to_draw(r1, r2, r3, r4, kl):
    """15 mm at least, and that from which the scale is told twice as long."""
    return all_long(0.4, r1, r2, r3, r4) & (r2 > 15 * kl) & (np.maximum(r1, r2) > 30 * kl)


EXERCISE = Exercise(
    given={
        "r1": drawn(60, 240, step=5, unit="mm"),
        "r2": drawn(40, 150, step=5, unit="mm"),
        "r3": drawn(50, 240, step=5, unit="mm"),
        "r4": drawn(50, 220, step=5, unit="mm"),
        "theta2": drawn(-175, 180, step=5, unit="deg"),
    },
    constraints=(
        crank_off_the_axes,
        circles_cut_clearly,
        pins_B_far_apart,
        bars_are_long_enough_to_draw,
    ),
    parts=(
        of_drawing("kl", "mm/mm"),
        of_drawing("p", kind="point"),
        of_drawing("a", kind="point"),
        of_drawing("c", kind="point"),
        of_drawing("b1", kind="point", points=3),
        of_drawing("b2", kind="point", points=3),
        _angle("theta3_open"),
        _angle("theta4_open"),
        _angle("theta3_crossed"),
        _angle("theta4_crossed"),
    ),
    figure=figure,
    drawing_mm=PAPER_MM,
    symbols={
        "kl": "k_l",
        "p": "O",
        "a": "A",
        "c": "C",
        "b1": "B_1",
        "b2": "B_2",
        "theta3_open": r"\theta_3^{(1)}",
        "theta4_open": r"\theta_4^{(1)}",
        "theta3_crossed": r"\theta_3^{(2)}",
        "theta4_crossed": r"\theta_4^{(2)}",
    },
)
