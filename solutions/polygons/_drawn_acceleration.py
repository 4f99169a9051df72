"""A drawn acceleration polygon, and mistakes on it: the pole p, the end a of a known acceleration, the end n
(b') of the normal part of B about A, b where two lines cross.

A solution that takes these has three hidden ones: ``_images``, what is drawn, complex, from that of A to that
of B; ``_start``, the point where the second line starts; and ``_lines``: of each of the two lines that find
b, the point through which it goes and its direction, complex.
"""

import numpy as np

from coursework.marking.drawn_polygons import met, off_both, scale_for, to_paper, turned
from coursework.solution import mistake

from ._drawn_start import *


def known_BA_n():
    return "both"


def known_BA_t():
    return "direction"


def ka(_images):
    """A round scale at which the drawing fills its box."""
    return scale_for(*_images)


def a(_images, ka):
    return to_paper(_images[0], ka)


def n(_images, ka):
    return to_paper(_images[1], ka)


def b(n, _start, _lines):
    along, other = _lines
    return met(n, along, _start, other)


def pa_b(_images, ka):
    """Measured on the drawing."""
    return abs(_images[-1]) / ka


@mistake("n")
def n_length(a, n):
    return a + 1.7 * (n - a)


@mistake("n")
def n_direction(a, n):
    """Square to the bar."""
    return turned(a, n, 90)


@mistake("n", kind="sign")
def n_sense(a, n):
    """From A to B."""
    return 2 * a - n


@mistake("n")
def n_vector(a, n):
    return a + 1.6 * (turned(a, n, 75) - a)


@mistake("n")
def n_on_p(p, a, n):
    return p + n - a


@mistake("b")
def bt_direction(n, _start, _lines):
    along, other = _lines
    return met(n, along * np.exp(-0.35j), _start, other)


@mistake("b", kind="sign")
def bt_sense(n, b):
    return 2 * n - b


@mistake("b")
def bt_on_a(a, _start, _lines):
    """The normal part left out."""
    along, other = _lines
    return met(a, along, _start, other)


@mistake("b")
def b_vector(n, b, _lines):
    return off_both(b, _lines, n)


@mistake("bb_t", "pa_b")
def lengths_exchanged(bb_t, pa_b):
    return pa_b, bb_t
