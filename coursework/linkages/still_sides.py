"""Sides of polygons that have next to no length in any position, as those of a body that never turns: nothing
is there to draw."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from types import ModuleType
from typing import Any

import numpy as np

from coursework.linkages.points import names_in
from coursework.linkages.vectors import PolygonWriter
from coursework.markup.markdown import plain_line
from coursework.messages import Message
from coursework.solution import Solution

_SAMPLES = 512
_NOTHING = 1e-9  #: of the longest side


def refuse_still_sides(polygons: Sequence[PolygonWriter], exercise: ModuleType, solution: ModuleType) -> None:
    """Refuse polygons of which a side that must be long enough to draw is too short wherever the mechanism
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
        A side is too short, with the line of the question.
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
        if not lengths.size:
            continue
        shares = (lengths / lengths.max(axis=0).clip(min=1e-300)).max(axis=1)
        for side, share in zip(sides.values(), shares, strict=True):
            # Half of what a variant must have: one that has it was not missed by chance.
            if share < polygon.least / 2 and f"abs({side.value})" in polygon.lines:
                vector = plain_line(f"${side.name}$", "en")
                why = (
                    Message(
                        "{vector} is zero in all positions, as on a body that never turns, or turns steadily",
                        vector=vector,
                    )
                    if share <= _NOTHING
                    else Message(
                        "{vector} has at most {share:.2g} % of the longest vector, and is drawn from "
                        "{least:g} % on",
                        vector=vector,
                        share=100 * share,
                        least=100 * polygon.least,
                    )
                )
                raise polygon.linkage.refused(
                    ("ask", "polygon"),
                    "{why}: a polygon of {kind!r} has nothing to draw there; ask {table} in its place",
                    why=why,
                    kind=polygon.kind,
                    table="velocities" if polygon.kind == "velocity" else "accelerations",
                )


def equal_in_all(
    pairs: Collection[tuple[str, str]], exercise: ModuleType, solution: ModuleType
) -> frozenset[tuple[str, str]]:
    """Return the pairs of quantities that have the same value wherever the mechanism closes, such as the rate
    of a body that never turns and ``"0"``.

    Parameters
    ----------
    pairs
        Names of quantities.
    exercise, solution
        As for :func:`refuse_still_sides`.
    """
    known = Solution.of(exercise.__name__, solution, "").graph
    given = _samples(exercise.EXERCISE.given)
    asked = {name for pair in pairs for name in pair}
    names = [*asked & known.names]
    with np.errstate(all="ignore"):
        found = known.evaluate(names, {n: v for n, v in given.items() if n in known.leaves})
    values = {n: np.broadcast_to(v, _SAMPLES) for n, v in {**given, **found, "0": 0.0}.items() if n in asked}
    closes = np.isfinite(np.array([values[name] for name in names])).all(axis=0)
    sizes = {n: np.max(abs(v[closes]), initial=0.0) for n, v in values.items()}
    largest = max((sizes[n] for n in names), default=0.0)
    return frozenset(
        (one, other)
        for one, other in pairs
        if {one, other} <= values.keys()
        and np.max(abs(values[one] - values[other])[closes], initial=0.0) <= _NOTHING * largest
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
