"""The end of a rocker on a drawn acceleration polygon, and mistakes on it: m (b'') is the end of its normal
part about the fixed pivot, from which the line of the tangential one goes.

A solution that takes these has those of :mod:`_drawn_acceleration`; the third of its ``_images`` is that of
m, and its ``_start`` is m.
"""

import numpy as np

from coursework.marking.drawn_polygons import met, to_paper, turned
from coursework.solution import mistake


def known_B_n():
    return "both"


def known_B_t():
    return "direction"


def m(_images, ka):
    return to_paper(_images[2], ka)


@mistake("m")
def m_length(p, m):
    return p + 1.7 * (m - p)


@mistake("m")
def m_direction(p, m):
    """Square to the bar."""
    return turned(p, m, 90)


@mistake("m", kind="sign")
def m_sense(p, m):
    """From C to B."""
    return 2 * p - m


@mistake("m")
def m_vector(p, m):
    return p + 1.6 * (turned(p, m, 75) - p)


@mistake("m")
def m_on_a(p, a, m):
    return a + m - p


@mistake("b")
def ct_direction(n, _start, _lines):
    along, other = _lines
    return met(n, along, _start, other * np.exp(-0.35j))


@mistake("b", kind="sign")
def ct_sense(_start, b):
    return 2 * _start - b


@mistake("b")
def ct_on_p(n, p, _lines):
    """The normal part of B left out."""
    along, other = _lines
    return met(n, along, p, other)
