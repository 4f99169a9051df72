"""Answers that a person accepted, whatever the marking says."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, NamedTuple

from coursework.errors import BadInput
from coursework.gradebook.changes import rows_of
from coursework.gradebook.graded import Graded
from coursework.language.words import words
from coursework.making.students import folded
from coursework.marking.feedback import Told
from coursework.marking.mark import Mark

ACCEPTED = "accepted"


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
        rows = rows_of(path)
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
        lines = dict(graded.lines)
        unanswered: list[str] = []
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


def _accepted(line: Mark, found: _Acceptance, lang: str) -> Mark:
    points = line.out_of if found.points is None else found.points
    if points > line.out_of:
        raise BadInput(
            f"{found.place}: {points:g} points for {line.part}, which has {line.out_of:g}; give that or fewer"
        )
    says = f"{words(lang)['marking']['accepted']} {found.reason}".strip()
    return line._replace(verdict=ACCEPTED, points=points, told=(Told(says, says),))


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
