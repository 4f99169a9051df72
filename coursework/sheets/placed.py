"""Drawn points as the answers print them: a pole may stand anywhere, and the printed one stands where its
drawing is in the box."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from coursework.marking.judges import judged, judges_of

if TYPE_CHECKING:
    from coursework.course.variant import Variant

_POINT = "point"


@lru_cache(maxsize=16)  # a variant is rendered in every format before the next
def placed_points(variant: Variant) -> dict[str, np.ndarray]:
    """Return by quantity the points of drawings whose pole is free, mm from the lower left corner of the
    printed box.

    Each drawing, a pole at (0, 0) and the points that are asked after it, is moved to the middle of its share
    of the box, by whole millimetres. The judge of the parts says whether that is as right: else nothing is
    moved.
    """
    box = variant.exercise.spec.drawing_mm
    points: dict[str, np.ndarray] = {}
    for name, ids in judges_of(variant) if box else ():
        parts = [part for part in variant.parts if part.id in ids]
        values = {part.id: variant.key.reference[part.quantity] for part in parts}
        drawings: list[list[str]] = []
        for part in (part for part in parts if part.kind == _POINT):
            if not np.any(values[part.id]):
                drawings.append([])
            if drawings:
                drawings[-1].append(part.id)
        moved = _moved(values, drawings, *(box or (0, 0)))
        if all(verdict.share == 1 for verdict in judged(variant, name, {**values, **moved}).values()):
            points |= {part.quantity: moved[part.id] for part in parts if part.id in moved}
    return points


def _moved(
    values: dict[str, np.ndarray], drawings: list[list[str]], width: float, height: float
) -> dict[str, np.ndarray]:
    """Return the points of drawings, one below the other in a box."""
    moved: dict[str, np.ndarray] = {}
    share = height / max(len(drawings), 1)
    for index, points in enumerate(reversed(drawings)):
        corners = np.array([values[i] for i in points])
        middle = np.array([width / 2, (index + 0.5) * share])
        shift = np.rint(middle - (corners.min(axis=0) + corners.max(axis=0)) / 2)
        moved |= {i: values[i] + shift for i in points}
    return moved
