"""Quantities common to quick returns: two strokes of one turn, and their times.

The crank turns at a constant rate, so that times are as the arcs ``alpha`` (the longer) and ``beta``.
"""

import math

from coursework.solution import formula


def beta(alpha):
    return 360 - alpha


def Q(alpha, beta):
    return alpha / beta


def T(omega2):
    """Duration of a turn."""
    return 2 * math.pi / abs(omega2)


@formula(r"\frac{<alpha>}{360^{\circ}} \times <T>")
def t_advance(alpha, T):
    return alpha / 360 * T


@formula(r"\frac{<beta>}{360^{\circ}} \times <T>")
def t_return(beta, T):
    return beta / 360 * T
