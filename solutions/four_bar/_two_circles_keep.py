"""Four-bar linkage drawn to scale: the conditions on answers that a variant must satisfy."""

import numpy as np

from coursework.degrees import polar
from coursework.kinematics.dyads import rrr
from coursework.marking.drawn_polygons import scale_for

from ...exercises._drawn import all_long
from ._four_bar_positions_keep import cos_mu, diagonal

__all__ = ["HELPERS", "KEEP"]


def circles_cut_clearly(cos_mu):
    """At 40 degrees at least."""
    return abs(cos_mu) < 0.766


def pins_B_far_apart(diagonal, cos_mu, r3, r4):
    """Their distance is at least that of the shorter bar."""
    height = r3 * r4 * (1 - cos_mu**2) ** 0.5 / diagonal
    return (2 * height > r3) | (2 * height > r4)


def on_paper(r1, r2, r3, r4, theta2):
    """mm on paper for a mm of the mechanism, at the round scale at which both assemblies fit the box."""
    A = polar(r2, theta2)
    return 1 / scale_for(A, r1 + 0 * A, *(rrr(A, r1 + 0 * A, r3, r4, side) for side in (1, -1)))


def bars_are_long_enough_to_draw(r1, r2, r3, r4, on_paper):
    """15 mm at least, and that from which the scale is told twice as long."""
    return all_long(0.4, r1, r2, r3, r4) & (on_paper * r2 > 15) & (on_paper * np.maximum(r1, r2) > 30)


HELPERS = (diagonal, cos_mu, on_paper)
KEEP = (circles_cut_clearly, pins_B_far_apart, bars_are_long_enough_to_draw)
