"""Common base of exercises about a slider-crank."""

import numpy as np

from coursework.degrees import polar
from coursework.kinematics.dyads import rrp


def rod(r2, r3, e, theta2):
    """Vector AB."""
    crank = polar(r2, theta2)
    return rrp(crank, r3, e) - crank


def largest_offset(r2):
    """Half of the cranks, those of whole centimetres, are in line with their piston."""
    return np.where(r2 % 10 == 0, 0.0, 0.5 * r2)


def offset_is_none_or_visible(e, r2):
    return (e == 0) | (abs(e) >= 0.1 * r2)


def rod_turns_visibly(omega3, r3, r2, omega2):
    return r3 * abs(omega3) > 0.1 * r2 * abs(omega2)
