"""Beginning of every drawn polygon: the pole p, and the end a of the first vector, which is completely
known."""

from coursework.marking.drawn_polygons import to_paper, turned
from coursework.solution import mistake


def p(_images):
    """Anywhere: here it is the origin."""
    return to_paper(0 * _images[0], 1.0)


@mistake("a")
def a_length(p, a):
    return p + 1.35 * (a - p)


@mistake("a")
def a_direction(p, a):
    """Turned by a quarter of a turn."""
    return turned(p, a, 90)


@mistake("a", kind="sign")
def a_sense(p, a):
    return 2 * p - a


@mistake("a")
def a_vector(p, a):
    return p + 0.6 * (turned(p, a, 75) - p)
