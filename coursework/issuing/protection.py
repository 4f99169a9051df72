"""Demands on variants: the usual errors that must show in the answers, so that a wrong method is not marked
right.

A term that hardly matters on some variants may be forgotten there without effect. Such variants are skipped
as long as enough are left: the weightiest errors are demanded first, and demands that would leave too few
variants are dropped. The demands of an exercise are computed once from its first variants, so that a seed is
valid for everybody or for nobody.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple, TypeVar

import numpy as np

from coursework.course.error_values import TAKEN, ErrorValues, UsualError
from coursework.course.exercise import CourseExercise
from coursework.course.key_batch import given_columns, keys_of
from coursework.course.variant import Variant
from coursework.errors import CourseworkError
from coursework.issuing.flaws import SHOWN, flawless
from coursework.kinds.nearness import gaps
from coursework.model import Part
from coursework.quantities.usual_errors import WEIGHTY

V = TypeVar("V", bound=Variant)

UNSEEN = "unseen"
SAMPLE = 96  #: variants in the sample that decides the demands
#: Share of the variants that must be left by the demands: of weighty errors, of others.
LEFT = {True: 0.125, False: 0.25}
_SAME = 1e-9  #: relative difference allowed between two computations of a value


class Demand(NamedTuple):
    """Error that must show: in the answer to one part, or in some answer."""

    error: UsualError
    part: str = ""


@dataclass(frozen=True)
class Protection:
    """Demands on the variants of an exercise, and the unprotected errors with their share of the sample."""

    demanded: frozenset[Demand]
    unprotected: dict[Demand, float]


def seen(exercise: CourseExercise, variants: Sequence[Variant]) -> dict[Demand, np.ndarray]:
    """Return, by demand, the variants that meet it, shape ``(n,)``; also those on which the error changes
    nothing.

    The variants have their keys, all of the same parts as the first.
    """
    parts = [p for p in variants[0].parts if p.sort.is_scalar and not p.judge]
    quantities = tuple(dict.fromkeys(p.quantity for p in parts))
    given = given_columns(exercise, variants)
    table = ErrorValues(exercise, quantities, given, exercise.spec.effects, len(variants))
    farthest: dict[Demand, np.ndarray] = {}
    idle: dict[Demand, np.ndarray] = {}
    for part in parts:
        errors, values = table.of(part.quantity)
        half_widths, same = _gaps(part, variants, values)
        for error, gap, is_same in zip(errors, half_widths, same, strict=True):
            is_here = error.source == part.quantity
            if error.source in quantities and not is_here and error.kind not in TAKEN:
                continue  # it shows in its own part
            demand = Demand(error, part.id if error.kind in TAKEN else "")
            farthest[demand] = np.maximum(farthest.get(demand, 0.0), gap)
            idle[demand] = idle.get(demand, True) & is_same
    return {demand: (gap > SHOWN) | idle[demand] for demand, gap in farthest.items()}


def _gaps(part: Part, variants: Sequence[Variant], values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the distances of wrong values from the reference, in half-widths, and the equal values: shapes
    ``(errors, n)``."""
    reference = np.array([float(v.key.reference[part.quantity]) for v in variants])
    width = np.array([v.key.half_width(part) for v in variants])
    with np.errstate(all="ignore"):
        gap = gaps(values, reference, part.sort.turn)
        same = gap <= _SAME * (part.sort.turn or np.abs(reference))
        far = np.where(gap > 0, np.inf, 0.0) if part.sort.is_exact else gap / width
    return np.where(np.isnan(far), np.inf, far), same


@lru_cache(maxsize=256)
def protection(exercise: CourseExercise, parts: tuple[str, ...] | None) -> Protection:
    """Return the demands for the parts asked, the usual ones by default."""
    drawn: list[Variant] = []
    for start in range(0, 10 * SAMPLE, SAMPLE):
        some = [
            v
            for v in exercise.variants(range(start, start + SAMPLE), exercise.languages[0], parts)
            if v.parts
        ]
        keys_of(exercise, some)
        drawn += flawless(some)
        if len(drawn) >= SAMPLE:
            break
    if not drawn:
        return Protection(frozenset(), {})
    # The variants with the most frequent parts.
    drawn = [drawn[i] for i in max(_by_parts(drawn), key=len)[:SAMPLE]]
    met = {d: shows for d, shows in seen(exercise, drawn).items() if not shows.all()}
    left = np.ones(len(drawn), dtype=bool)
    demanded: set[Demand] = set()
    asked_quantities = {part.quantity for part in drawn[0].parts}
    for demand in sorted(met, key=lambda d: _order(d, met[d], asked_quantities)):
        less = left & met[demand]
        if np.count_nonzero(less) >= LEFT[demand.error.kind in WEIGHTY] * len(drawn):
            left = less
            demanded.add(demand)
    unprotected = {
        d: 1 - float(met[d][left].mean()) for d in met if d not in demanded and not met[d][left].all()
    }
    return Protection(frozenset(demanded), unprotected)


def _order(demand: Demand, met: np.ndarray, asked_quantities: Collection[str]) -> tuple[Any, ...]:
    """Return the sort key of demands: weighty errors first, then those of the asked quantities, then those
    that most variants show."""
    error = demand.error
    return (
        error.kind not in WEIGHTY,
        error.source not in asked_quantities,
        -int(np.count_nonzero(met)),
        error,
        demand.part,
    )


def protected(exercise: CourseExercise, variants: Sequence[V]) -> list[tuple[V, Demand | None]]:
    """Return the variants, each with the first demand that it does not meet, if any."""
    if not variants:
        return []
    chosen = variants[0].chosen
    part_ids = None if chosen is None else tuple(p.id for p in chosen)
    demanded = protection(exercise, part_ids).demanded
    unmet: dict[int, Demand] = {}
    for places in _by_parts(variants) if demanded else ():
        for demand, shows in _seen(exercise, [variants[i] for i in places]):
            if demand in demanded:
                for i in np.flatnonzero(~shows):
                    unmet.setdefault(places[i], demand)
    return [(variant, unmet.get(i)) for i, variant in enumerate(variants)]


def _seen(exercise: CourseExercise, variants: Sequence[Variant]) -> Iterator[tuple[Demand, np.ndarray]]:
    try:
        yield from seen(exercise, variants).items()
    except CourseworkError:
        return  # its quantities report the error when they are asked


def _by_parts(variants: Sequence[Variant]) -> list[list[int]]:
    """Return the indices of the variants, grouped by the parts they ask."""
    places: dict[tuple[str, ...], list[int]] = {}
    for i, variant in enumerate(variants):
        places.setdefault(variant.part_ids, []).append(i)
    return list(places.values())


def valid_variants(
    exercise: CourseExercise[V], variants: Sequence[V], refused: Counter[str] | None = None
) -> list[V]:
    """Return the variants that are worth issuing; ``refused`` counts the others by their first flaw."""
    keys_of(exercise, variants)
    refused = Counter() if refused is None else refused
    valid = []
    for variant, unmet in protected(exercise, flawless(variants, refused)):
        if unmet is None:
            valid.append(variant)
        else:
            refused[f"{UNSEEN}: {unmet.error.kind} in {unmet.error.source}"] += 1
    return valid
