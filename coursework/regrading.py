"""Marking again: what changed and for whom, and answers that a person accepts by hand."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from coursework.errors import BadInput
from coursework.gradebook import Graded, Line
from coursework.language import words
from coursework.submissions import delimiter_of

ACCEPTED = "accepted"
CHANGES_COLUMNS = (
    "student", "exercise", "seed", "part", "answer",
    "verdict_before", "verdict_now", "points_before", "points_now",
)  # fmt: skip
_PLACE = ("student", "exercise", "seed", "part")


class Accepted:
    """Answers accepted by hand: a CSV with ``student,exercise,seed,part`` and, if wanted, ``points`` and
    ``reason``. An answer so named has full points, or those that are said."""

    def __init__(self, path: Path | None) -> None:
        self._by_place: dict[tuple[str, str, str, str], Mapping[str, str]] = {}
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
            points = row.get("points", "")
            if points and _points(points) is None:
                raise BadInput(f"{path}, line {number}: points are a number; found {points!r}")
            self._by_place[self._key(row["student"], row["exercise"], row.get("seed", ""), row["part"])] = row

    @staticmethod
    def _key(student: str, exercise: str, seed: Any, part: str) -> tuple[str, str, str, str]:
        return student.casefold(), exercise, str(seed), part

    def apply(self, graded: Graded, lang: str) -> Graded:
        """The sheet with its accepted answers marked so."""
        if not self._by_place:
            return graded
        lines = dict(graded.lines)
        for part, line in graded.lines.items():
            for seed in (graded.seed, ""):
                key = self._key(graded.student, graded.exercise, seed, part)
                row = self._by_place.get(key)
                if row is not None:
                    self.used.add(key)
                    lines[part] = _accepted(line, row, lang)
        return graded._replace(lines=lines)

    @property
    def unused(self) -> list[str]:
        """The answers named that nobody gave."""
        return [", ".join(filter(None, key)) for key in self._by_place if key not in self.used]


def _accepted(line: Line, row: Mapping[str, str], lang: str) -> Line:
    points = _points(row.get("points", ""))
    said = words(lang)["marking"]["accepted"]
    reason = row.get("reason", "").strip()
    says = f"{said} {reason}".strip()
    return line._replace(
        verdict=ACCEPTED, points=line.out_of if points is None else points, says=says, feedback=says
    )


def _points(text: str) -> float | None:
    try:
        return float(text.replace(",", ".")) if text.strip() else None
    except ValueError:
        return None


class Before:
    """The marks that were there before."""

    def __init__(self, path: Path) -> None:
        self._marks: dict[str, tuple[str, str]] = {}
        self.exists = path.exists()
        if self.exists:
            alike: dict[tuple[str, str], tuple[str, str]] = {}
            for row in _rows(path):
                mark = (row.get("verdict", ""), row.get("points", ""))
                self._marks["\0".join(row.get(c, "") for c in _PLACE)] = alike.setdefault(mark, mark)

    def changed(self, row: Mapping[str, Any]) -> dict[str, Any] | None:
        """What changed in a row of the new marks; None when nothing did."""
        now = (row["verdict"], row["points"])
        before = self._marks.pop("\0".join(str(row[c]) for c in _PLACE), ("", ""))
        return None if before == now else _change(row, before, now)

    def gone(self) -> Iterator[dict[str, Any]]:
        """Marks that are no more."""
        for place, before in self._marks.items():
            row = dict(zip(_PLACE, place.split("\0"), strict=True))
            yield _change({**row, "answer": ""}, before, ("", ""))


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
        with path.open(encoding="utf-8-sig", newline="") as file:
            delimiter = delimiter_of(file.readline())
            file.seek(0)
            for row in csv.DictReader(file, delimiter=delimiter):
                yield {(k or "").strip().casefold(): (v or "") for k, v in row.items() if isinstance(v, str)}
    except OSError as fault:
        raise BadInput(f"{path} cannot be read: {fault.strerror}") from fault
    except (UnicodeDecodeError, csv.Error) as fault:
        raise BadInput(f"{path} is not CSV in UTF-8: {fault}") from fault
