"""Mistakes on a drawn velocity polygon: the pole p, the end a of a known velocity, b where two lines cross.

A solution that takes these has the hidden ``_lines``: the directions on which b lies, complex: square to AB, through a, and that of
the velocity of B, through p.
"""

import numpy as np

from coursework.solution import mistake

from ._drawn import _met, _off_both, _turned


@mistake("a")
def a_length(p, a):
    return p + 1.35 * (a - p)


@mistake("a")
def a_direction(p, a):
    """Along the crank."""
    return _turned(p, a, 90)


@mistake("a", share=0.5)
def a_sense(p, a):
    return 2 * p - a


@mistake("a")
def a_vector(p, a):
    return p + 0.6 * (_turned(p, a, 75) - p)


@mistake("b")
def ba_direction(p, a, _lines):
    """On the line of the velocity of B, but not square to AB from a."""
    across, way = _lines
    return _met(a, across * np.exp(-0.35j), p, way)


@mistake("b")
def vb_direction(p, a, _lines):
    across, way = _lines
    return _met(a, across, p, way * np.exp(-0.35j))


@mistake("b", share=0.5)
def ba_sense(a, b):
    return 2 * a - b


@mistake("b", share=0.5)
def vb_sense(p, b):
    return 2 * p - b


@mistake("b")
def ba_on_p(p, a, b):
    """Each line through the wrong one of the two points."""
    return p + a - b


@mistake("b")
def b_vector(a, b, _lines):
    return _off_both(b, _lines, a)


@mistake("kv", "p", "a", "b")
def too_small(kv, p, a, b):
    return 10 * kv, p / 10, a / 10, b / 10


@mistake("kv", "p", "a", "b", "ab", "pv_b", share=0.5)
def scale_upside_down(kv, p, a, b, ab, pv_b):
    """The drawing is right."""
    return 1 / kv, p, a, b, ab, pv_b


@mistake("ab", "pv_b")
def lengths_exchanged(ab, pv_b):
    return pv_b, ab
