"""Symbols of the joints in space for the table of joints: in perspective, and in plan as ISO 3952 draws
them."""

import cmath
import math

from coursework.figures import Figure, line, link, pin, point, rail, slider, trace, vector
from coursework.figures.perspective import in_perspective


def perspective(name):
    """Return a joint in perspective, its axis upwards."""
    alone = in_perspective([{"joint": name, "along": "z", "point": (0.0, 0.0, 0.0)}])
    symbol = [e for e in alone.elements if not isinstance(e, (vector, point))]
    return Figure(line(-6j, 0), *symbol, scale=1.4)  # the stem of the body below


def _ring(centre, radius, first=0.0, last=360.0):
    steps = [first + (last - first) * k / 40 for k in range(41)]
    return trace([centre + cmath.rect(radius, math.radians(step)) for step in steps], dotted=False)


def _box(half, tall):
    corners = (complex(-half, -tall), complex(half, -tall), complex(half, tall), complex(-half, tall))
    return trace([*corners, corners[0]], dotted=False)


def _thread():
    return trace([complex(x, 1.3 * math.sin(1.25 * x)) for x in (k / 4 - 5 for k in range(41))], dotted=False)


_PLAN = {
    "revolute": lambda: [link(-8, 0), link(0, 8), pin(0)],
    "prismatic": lambda: [rail(-8, 8), slider(0, 0.0)],
    "helical": lambda: [line(-9, -5), line(5, 9), _box(5, 2.6), _thread()],
    "cylindrical": lambda: [_box(5, 2.6), line(-9, 9), line(7j, 2.6j)],
    "spherical_pin": lambda: [
        _ring(0, 2.4),
        _ring(0, 4, 130, 410),
        line(-9, -4),
        line(2.4, 9),
        line(0.9 + 2.2j, 2 + 6j),
    ],
    "spherical": lambda: [_ring(0, 2.4), _ring(0, 4, 110, 250), line(-9, -4), line(2.4, 9)],
    "planar": lambda: [
        line(-6 + 0.9j, 6 + 0.9j),
        line(-6 - 0.9j, 6 - 0.9j),
        line(0.9j, 6j),
        line(-0.9j, -6j),
    ],
    "annular": lambda: [
        line(-6 - 2.6j, 6 - 2.6j),
        line(-6 + 2.6j, 6 + 2.6j),
        _ring(0, 2.4),
        line(0, 8j),
        line(-2.6j, -7j),
    ],
    "line_contact": lambda: [line(-6 - 2.6j, 6 - 2.6j), _box(4.5, 2.2), line(2.2j, 7j), line(-2.6j, -7j)],
    "point_contact": lambda: [line(-6 - 2.6j, 6 - 2.6j), _ring(0, 2.4), line(2.4j, 7j), line(-2.6j, -7j)],
}


def plan(name):
    """Return a joint in plan, its axis across the page or in it."""
    return Figure(*_PLAN[name](), scale=0.9)
