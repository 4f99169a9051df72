"""Sides of polygons that have no length in any position, as those of a body that never turns: nothing is
there to draw."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import ModuleType
from typing import Any

import numpy as np

from coursework.linkages.points import names_in
from coursework.linkages.vectors import PolygonWriter
from coursework.markup.markdown import plain_line
from coursework.solution import Solution

_SAMPLES = 64
_NOTHING = 1e-9  #: of the longest side


def refuse_still_sides(polygons: Sequence[PolygonWriter], exercise: ModuleType, solution: ModuleType) -> None:
    """Refuse polygons of which a side that must be long enough to draw has no length wherever the mechanism
    closes.

    Parameters
    ----------
    polygons
        The polygons.
    exercise, solution
        Modules of their mechanism: the ranges of what is given, and what computes the rest.

    Raises
    ------
    BadInput
        A side has no length, with the line of the question.
    """
    known = Solution.of(exercise.__name__, solution, "").graph
    given = _samples(exercise.EXERCISE.given)
    for polygon in polygons:
        made = dict(vars(solution))
        sides = {f"length_of_side_{k}": side for k, side in enumerate(polygon.sides)}
        for name, side in sides.items():
            exec(f"def {name}({', '.join(names_in(side.value))}):\n    return abs({side.value})", made)
        graph = known.with_functions({n: made[n] for n in sides})
        with np.errstate(all="ignore"):
            found = graph.evaluate([*sides], {n: v for n, v in given.items() if n in graph.leaves})
        lengths = np.array([np.broadcast_to(found[name], _SAMPLES) for name in sides])
        lengths = lengths[:, np.isfinite(lengths).all(axis=0)]
        is_still = (lengths <= _NOTHING * lengths.max(axis=0)).all(axis=1)
        for side, has_none in zip(sides.values(), is_still, strict=True):
            if lengths.size and has_none and f"abs({side.value})" in polygon.lines:
                raise polygon.linkage.refused(
                    ("ask", "polygon"),
                    "{vector} is zero in all positions, as on a body that never turns: a polygon of "
                    "{kind!r} has nothing to draw there; ask {table} in its place",
                    kind=polygon.kind,
                    vector=plain_line(f"${side.name}$", "en"),
                    table="velocities" if polygon.kind == "velocity" else "accelerations",
                )


def _samples(given: Mapping[str, Any]) -> dict[str, Any]:
    """Return values of what is given, from all of its ranges, and of what is chosen all cases in turn."""
    rng, found = np.random.default_rng(1), {}
    for name, spec in given.items():
        if spec.is_choice:
            found[name] = np.resize(np.array(spec.choices), _SAMPLES)
        elif spec.is_fixed:
            found[name] = np.full(_SAMPLES, float(spec.default))
        else:
            low, high = spec.bounds(found)
            found[name] = low + (high - low) * rng.random(_SAMPLES)
    return found
