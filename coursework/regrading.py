"""Marking again: what changed and for whom, and answers that a person accepts by hand."""

from __future__ import annotations

import csv
import math
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from coursework.errors import BadInput
from coursework.gradebook import VERDICTS, Graded, Line
from coursework.language import words
from coursework.names import folded
from coursework.tables import as_written, delimiter_of, open_csv

ACCEPTED = "accepted"
CHANGES_COLUMNS = (
    "student", "exercise", "seed", "part", "answer",
    "verdict_before", "verdict_now", "points_before", "points_now",
)  # fmt: skip
_PLACE = ("student", "exercise", "seed", "part")


class Accepted:
    """Answers accepted by hand: a CSV with ``student,exercise,seed,part`` and, if wanted, ``points`` and
    ``reason``. An answer so named has full points, or those that are said.

    Raises
    ------
    BadInput
        The file cannot be read, a line names no answer, or its points are none.
    """

    def __init__(self, path: Path | None) -> None:
        self._by_place: dict[tuple[str, str, str, str], _Acceptance] = {}
        self.path = path
        self.used: set[tuple[str, str, str, str]] = set()
        if path is None:
            return
        rows = _rows(path)
        for number, row in enumerate(rows, start=2):
            missing = [c for c in ("student", "exercise", "part") if not row.get(c)]
            if missing:
                raise BadInput(
                    f"{path}, line {number}: {', '.join(missing)} missing; name the answer to accept"
                )
            place = f"{path}, line {number}"
            named = (row["student"], row["exercise"], row.get("seed", ""), row["part"])
            points = _points(row.get("points", ""), place)
            self._by_place[self._key(*named)] = _Acceptance(place, named, points, row.get("reason", ""))

    @staticmethod
    def _key(student: str, exercise: str, seed: Any, part: str) -> tuple[str, str, str, str]:
        return folded(student), exercise, str(seed), part

    def apply(self, graded: Graded, lang: str) -> Graded:
        """The sheet with its accepted answers marked so, those too that no row gave.

        Raises
        ------
        BadInput
            An answer is given more points than its part has.
        """
        if not self._by_place:
            return graded
        lines, unanswered = dict(graded.lines), []
        for part, line in graded.lines.items():
            for seed in (graded.seed, ""):
                key = self._key(graded.student, graded.exercise, seed, part)
                found = self._by_place.get(key)
                if found is not None:
                    self.used.add(key)
                    lines[part] = _accepted(line, found, lang)
                    if part not in (*graded.answered, *unanswered):
                        unanswered.append(part)
        return graded._replace(lines=lines, unanswered=tuple(unanswered))

    @property
    def unused(self) -> list[str]:
        """The answers named that nobody gave."""
        return [
            ", ".join(filter(None, one.named)) for key, one in self._by_place.items() if key not in self.used
        ]


class _Acceptance(NamedTuple):
    """A line of the file."""

    place: str
    named: tuple[str, str, str, str]  #: as it is written
    points: float | None  #: None for all of them
    reason: str


def _accepted(line: Line, found: _Acceptance, lang: str) -> Line:
    points = line.out_of if found.points is None else found.points
    if points > line.out_of:
        raise BadInput(
            f"{found.place}: {points:g} points for {line.part}, which has {line.out_of:g}; give that or fewer"
        )
    says = f"{words(lang)['marking']['accepted']} {found.reason}".strip()
    return line._replace(verdict=ACCEPTED, points=points, says=says, feedback=says)


def _points(text: str, place: str) -> float | None:
    if not text:
        return None
    try:
        points = float(text.replace(",", "."))
    except ValueError:
        points = math.nan
    if not 0 <= points < math.inf:
        raise BadInput(f"{place}: points are a number, 0 or more; found {text[:40]!r}")
    return points


def _number(text: str) -> float:
    """Points of a file that anybody may have edited."""
    try:
        return float(text.replace(",", ".") or 0)
    except ValueError:
        return math.nan


_ROUNDING = 1e-4  #: of points, as both tables print them
#: Verdicts that have a line in the marks for each in the summary.
_IN_BOTH = tuple(v for v in VERDICTS if v not in ("unreadable", "missing"))


class Before:
    """The marks that were there before."""

    def __init__(self, path: Path) -> None:
        self._marks: dict[str, tuple[str, str]] = {}
        self._names: dict[str, str] = {}  #: as they are written
        self._points: dict[str, float] = {}
        self._verdicts: Counter[str] = Counter()
        self.exists = path.exists()
        if self.exists:
            alike: dict[tuple[str, str], tuple[str, str]] = {}
            for row in _rows(path):
                mark = (row.get("verdict", ""), row.get("points", ""))
                name = folded(row.get("student", ""))
                self._names.setdefault(name, row.get("student", ""))
                self._points[name] = self._points.get(name, 0.0) + _number(mark[1])
                self._verdicts[mark[0].partition(":")[0]] += 1
                self._marks[_place(row)] = alike.setdefault(mark, mark)

    @property
    def students(self) -> tuple[str, ...]:
        """Those who had marks, in the order of the file."""
        return tuple(self._names.values())

    def edited(self, summary: Path) -> bool:
        """Whether the marks are no longer those of the summary that was written with them."""
        if not (self.exists and summary.exists()):
            return False
        told: Counter[str] = Counter()
        for row in _rows(summary):
            points = self._points.get(folded(row.get("student", "")), 0.0)
            if not abs(_number(row.get("points", "")) - points) < _ROUNDING * max(1.0, points):
                return True
            told.update({v: int(row[v]) for v in _IN_BOTH if row.get(v, "").isdecimal()})
        return any(told[verdict] != self._verdicts[verdict] for verdict in _IN_BOTH)

    def changed(self, row: Mapping[str, Any]) -> dict[str, Any] | None:
        """What changed in a row of the new marks; None when nothing did."""
        now = (row["verdict"], row["points"])
        before = self._marks.pop(_place(row), ("", ""))
        return None if before == now else _change(row, before, now)

    def gone(self) -> Iterator[dict[str, Any]]:
        """Marks that are no more."""
        for place, before in self._marks.items():
            row = dict(zip(_PLACE, place.split("\0"), strict=True))
            yield _change({**row, "student": self._names[row["student"]], "answer": ""}, before, ("", ""))


def _place(row: Mapping[str, Any]) -> str:
    """Which answer a row of marks is of; one text, of which a large class has many."""
    student, *rest = (str(row.get(c, "")) for c in _PLACE)
    return "\0".join((folded(student), *rest))


def _change(row: Mapping[str, Any], before: tuple[str, str], now: tuple[str, str]) -> dict[str, Any]:
    return {
        **{c: row[c] for c in (*_PLACE, "answer")},
        "verdict_before": before[0],
        "verdict_now": now[0],
        "points_before": before[1],
        "points_now": now[1],
    }


def _rows(path: Path) -> Iterator[dict[str, str]]:
    try:
        with open_csv(path) as file:
            delimiter = delimiter_of(file.readline())
            file.seek(0)
            for row in csv.DictReader(file, delimiter=delimiter):
                yield {
                    (k or "").strip().casefold(): as_written(v.strip())
                    for k, v in row.items()
                    if isinstance(v, str)
                }
    except OSError as fault:
        raise BadInput(f"{path} cannot be read: {fault.strerror}") from fault
    except csv.Error as fault:
        raise BadInput(f"{path} is not CSV: {fault}") from fault
