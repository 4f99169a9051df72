"""A drawn velocity polygon, and mistakes on it: the pole p, the end a of a known velocity, b where two lines
cross.

A solution that takes these has two hidden bundles: ``_images``, the velocities of A and of B, complex; and
``_lines``, the directions on which b lies, complex: square to AB, through a, and that of the velocity of B,
through p.
"""

import numpy as np

from coursework.marking.drawn_polygons import met, off_both, scale_for, to_paper
from coursework.solution import mistake

from ._drawn_start import *


def known_A():
    return "both"


def known_BA():
    return "direction"


def known_B():
    return "direction"


def kv(_images):
    """A round scale at which the drawing fills its box."""
    return scale_for(*_images)


def a(_images, kv):
    return to_paper(_images[0], kv)


def b(p, a, _lines):
    across, way = _lines
    return met(a, across, p, way)


def ab(_images, kv):
    """Measured on the drawing."""
    v_A, v_B = _images
    return abs(v_B - v_A) / kv


def pv_b(_images, kv):
    """Measured on the drawing."""
    _, v_B = _images
    return abs(v_B) / kv


@mistake("b")
def ba_direction(p, a, _lines):
    """On the line of the velocity of B, but not square to AB from a."""
    across, way = _lines
    return met(a, across * np.exp(-0.35j), p, way)


@mistake("b")
def vb_direction(p, a, _lines):
    across, way = _lines
    return met(a, across, p, way * np.exp(-0.35j))


@mistake("b", kind="sign")
def ba_sense(a, b):
    return 2 * a - b


@mistake("b", kind="sign")
def vb_sense(p, b):
    return 2 * p - b


@mistake("b")
def ba_on_p(p, a, b):
    """Each line through the wrong one of the two points."""
    return p + a - b


@mistake("b")
def b_vector(a, b, _lines):
    return off_both(b, _lines, a)


@mistake("kv", "p", "a", "b")
def too_small(kv, p, a, b):
    return 10 * kv, p / 10, a / 10, b / 10


@mistake("kv", "p", "a", "b", "ab", "pv_b", kind="inverse")
def scale_upside_down(kv, p, a, b, ab, pv_b):
    """The drawing is right."""
    return 1 / kv, p, a, b, ab, pv_b


@mistake("ab", "pv_b")
def lengths_exchanged(ab, pv_b):
    return pv_b, ab
