"""How far an answer is from a reference, counted in the half-width that is accepted.

Judged by value, never by spelling: angles modulo a turn, points by their distance to a line, vectors by direction,
equations by the points that they hold at, cases and whole numbers by identity.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np

from coursework.model import Part
from coursework.quantities.graph import plain_scalar
from coursework.reading.equations import Equation, parse_equation
from coursework.reading.equivalence import same_equation

SLACK = 1e-12  #: relative, so that an answer on the tolerance's edge is inside it
_FAR = 1e100  #: a point so far off is not computed with


def distance(part: Part, value: Any, reference: Any, along: Any = None, envelope: float = 0.0) -> float:
    """How far a value is from a reference, as a multiple of the accepted half-width: right up to 1.

    The half-width is the part's own, or the ``envelope`` where that is wider. 0 or infinity for the kinds
    judged by identity. Angles are compared modulo 360.
    """
    match part.kind:
        case "number":
            return _over(abs(value - reference), max(part.half_width(reference), envelope), reference)
        case "angle":
            gap = abs(math.remainder(value - reference, 360.0))
            return _over(gap, max(part.half_width(reference), envelope), 360.0)
        case "point":
            return _off_point(part, value, reference, envelope)
        case "point_on_line":
            return _off_line(part, value, reference, along, envelope)
        case "direction":
            return _off_direction(part, value, reference)
        case "equation":
            return 0.0 if _same(value, reference, part.variables, part.parameters) else math.inf
        case _:
            return 0.0 if value == plain_scalar(reference) else math.inf


@lru_cache(maxsize=4096)
def _same(value: Equation, reference: str, variables: tuple[str, ...], parameters: tuple[str, ...]) -> bool:
    """Equations are dear to compare, and many students write the same."""
    return same_equation(value, _equation(reference, variables), parameters=parameters)


@lru_cache(maxsize=256)
def _equation(text: str, variables: tuple[str, ...]) -> Equation:
    """A reference equation, or a mistaken one, read once."""
    return parse_equation(text, variables)


def _over(gap: float, half_width: float, scale: float) -> float:
    """``gap`` in half-widths, the boundary inclusive up to rounding."""
    if not math.isfinite(gap):
        return math.inf
    if gap <= half_width + SLACK * max(half_width, abs(scale)):
        return min(1.0, gap / half_width) if half_width else 0.0
    return gap / half_width if half_width else math.inf


def _off_point(part: Part, point: Any, reference: Any, envelope: float) -> float:
    offset = np.asarray(point, dtype=float) - reference
    if float(np.max(np.abs(offset))) > _FAR:
        return math.inf
    gap, size = float(np.linalg.norm(offset)), float(np.linalg.norm(reference))
    return _over(gap, max(part.half_width(size), envelope), size)


def _off_line(part: Part, point: Any, reference: Any, along: Any, envelope: float) -> float:
    offset = np.asarray(point, dtype=float) - reference
    if float(np.max(np.abs(offset))) > _FAR:
        return math.inf
    axis = np.asarray(along, dtype=float)
    gap = float(np.linalg.norm(np.cross(offset, axis)) / np.linalg.norm(axis))
    size = float(np.linalg.norm(reference))
    return _over(gap, max(part.half_width(size), envelope), size)


def _off_direction(part: Part, vector: Any, reference: Any) -> float:
    v, d = np.asarray(vector, dtype=float), np.asarray(reference, dtype=float)
    largest = float(np.max(np.abs(v)))
    v = v / largest if largest else v
    size = float(np.linalg.norm(v) * np.linalg.norm(d))
    if size == 0.0:
        return math.inf
    return _over(float(np.linalg.norm(np.cross(v, d))) / size, part.half_width(1.0), 1.0)
