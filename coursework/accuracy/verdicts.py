"""Conclusions of a measurement in words, stable under repeated measurement.

No time stands in a sentence, and none is called shorter than another unless the quartiles are apart and their
ratio is plain. Errors are the same in every run, and may be stated.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import Any

from coursework.accuracy.measuring import DATA, GENERIC, HARD, Measurement
from coursework.accuracy.timing import is_busy, overlap

LIMITS = (1e-3, 1e-6, 1e-12)
_REFERENCES = ("mpmath", DATA)

Words = Mapping[str, Any]


def cheapest(rows: Iterable[Measurement]) -> list[Measurement]:
    """Return the rows whose times are indistinguishable from the shortest, shortest first."""
    by_time = sorted(rows, key=lambda row: row.median)
    return [row for row in by_time if overlap(by_time[0], row)]


class Rows:
    """Rows of one kind, looked up by family, place and setting."""

    def __init__(self, rows: Sequence[Measurement]) -> None:
        self.rows = rows

    def of(self, family: str, point: str = GENERIC) -> list[Measurement]:
        results = [r for r in self.rows if r.family == family and r.place == point]
        return sorted(results, key=lambda r: (r.setting is not None, r.setting))

    def answered(self, family: str, point: str = GENERIC) -> list[Measurement]:
        """Return the rows with an answer somewhere, and so an error."""
        return [r for r in self.of(family, point) if r.max_error is not None]

    def one(self, family: str, point: str = GENERIC) -> Measurement | None:
        result = self.of(family, point)
        return result[0] if result else None

    def within(self, limit: float, places: Sequence[str]) -> list[Measurement]:
        """Return the generic rows of the ways that stay below a limit at all of these places, without
        references."""
        results = []
        for row in self.rows:
            if row.place != places[0] or row.family in _REFERENCES:
                continue
            selected = [r for r in self.rows if r.method == row.method and r.place in places]
            stored = all(not r.failed and r.max_error is not None and r.max_error <= limit for r in selected)
            if stored and {r.place for r in selected} == set(places):
                results.append(row)
        return results

    @property
    def is_busy(self) -> bool:
        """True if other load disturbed the times."""
        return is_busy(row for row in self.rows if row.place != HARD and row.family not in _REFERENCES)

    @property
    def places(self) -> tuple[str, ...]:
        """Generic places, and hard ones where there are any."""
        return (GENERIC, HARD) if any(r.place == HARD for r in self.rows) else (GENERIC,)


def enough(rows: Rows, texts: Words, name: Any, number: Any) -> list[str]:
    """Return for some errors the cheapest ways that stay below them everywhere; limits with one answer are
    joined."""
    entries: dict[tuple[str, str], list[float]] = {}
    for limit in LIMITS:
        for key, methods in _answers(rows, texts, name, limit):
            entries.setdefault((key, methods), []).append(limit)
    reading = texts["reading"]
    return [
        reading[key].format(limit=_and([number(limit) for limit in limits], texts), methods=methods)
        for (key, methods), limits in entries.items()
    ]


def _answers(rows: Rows, texts: Words, name: Any, limit: float) -> list[tuple[str, str]]:
    """Return the sentences for one limit: each one's key, and the methods that it names."""
    best = cheapest(rows.within(limit, rows.places))
    if best and rows.is_busy:
        return [("busy", "")]
    results = [("nowhere_below", "")]
    if best:
        results = [("everywhere_alike" if best[1:] else "everywhere", listed(best, texts, name))]
    better = [] if rows.is_busy else _cheaper_at_generic_places(rows, limit, best)
    if better:
        results.append(("generic_only", listed(better, texts, name)))
    return results


def _cheaper_at_generic_places(rows: Rows, limit: float, best: Sequence[Measurement]) -> list[Measurement]:
    """Return the ways that suffice at generic places and are clearly cheaper than the best that suffice
    everywhere."""
    generic = cheapest(rows.within(limit, (GENERIC,)))
    return [] if {row.method for row in best} & {row.method for row in generic} else generic


def listed(rows: Sequence[Measurement], texts: Words, name: Any) -> str:
    """Return the names of the methods in alphabetical order, since their times give no order."""
    return _and(sorted(f"*{name(row)}*" for row in rows), texts)


def _and(words: Sequence[str], texts: Words) -> str:
    return str(texts["reading"]["and"]).join([", ".join(words[:-1]), words[-1]]) if words[1:] else words[0]


def paid_after(row: Measurement, stable: Measurement | None) -> float | None:
    """Return the number of uses after which a table pays off; None where it is not clearly cheaper than the
    solver."""
    if row.build_ns is None or stable is None or overlap(row, stable) or row.median > stable.median:
        return None
    return row.build_ns / (stable.median - row.median)


def halves(rows: Sequence[Measurement]) -> bool:
    """Return whether each step of Newton's method only halves the error, as it does where two solutions
    meet."""
    return len(rows) > 1 and all(
        a.max_error and b.max_error and 0.3 < b.max_error / a.max_error < 0.7 for a, b in pairwise(rows)
    )
