"""Figures of the lesson on accuracy: a linkage at its change point, and two pencil lines that cross."""

from coursework.degrees import polar, sin
from coursework.figures import Figure, angle_mark, dimension, ground_pivot, line, link, pin, point, trace
from coursework.kinematics.dyads import rrr

_HALF = 3.0  #: half the width of what a pencil line may be off, mm


def _linkage(at, theta2):
    """Bars of 100, 50, 70 and 80 mm, half as large."""
    O, A, C = at, at + polar(25.0, theta2), at + 50
    B = rrr(A, C, 35.0, 40.0)
    return [
        link(O, A),
        link(A, B),
        link(C, B),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        angle_mark(O, 0, theta2, r"\theta_2", radius=9),
    ]


def change_point():
    """The linkage of the lesson at 120 degrees, and just beside the place where all four bars lie on one
    line."""
    return Figure(*_linkage(0j, 120.0), *_linkage(complex(96), 176.0), paper_mm=(140, 48))


def _crossing(at, angle):
    """Two strips through a point, the area that both cover, and its longer diagonal."""
    way, far = polar(1.0, angle), 34.0
    found = []
    for along, across in ((complex(1), 1j), (way, 1j * way)):
        found.append(line(at - far * along, at + far * along))
        for side in (-_HALF, _HALF):
            shift = side * across
            found.append(line(at - far * along + shift, at + far * along + shift, dashed=True))
    reach = _HALF / sin(angle)
    corners = [at + reach * (i + j * way) for i, j in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
    found.append(trace((*corners, corners[0]), dotted=False))
    found.append(angle_mark(at, 0, angle, r"\gamma", radius=24))
    return [*found, point(at), dimension(corners[2], corners[0], offset=-13.0 if angle < 45 else -15.0)]


def crossings():
    """The same doubt about two lines, twice: what it makes of the point where they cross."""
    return Figure(*_crossing(0j, 80.0), *_crossing(complex(86, 0), 16.0), paper_mm=(140, 60))
