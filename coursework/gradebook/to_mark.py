"""Answers that a person marks: ``to_mark.csv`` lists them, and the points written there count when it is marked again."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from coursework.errors import BadInput, nearest
from coursework.gradebook.accepted import ACCEPTED, points_of
from coursework.gradebook.changes import rows_of
from coursework.gradebook.graded import Graded
from coursework.language.words import words
from coursework.making.students import folded
from coursework.marking.feedback import Told
from coursework.marking.mark import Mark

TO_MARK = "to_mark"  #: the verdict of an answer that waits
TO_MARK_COLUMNS = ("student", "exercise", "seed", "part", "answer", "points", "out_of", "reason")


class _Given(NamedTuple):
    """A line of the file whose points are filled in."""

    place: str
    named: tuple[str, ...]
    answer: str
    points: float
    reason: str


class ToMark:
    """The answers that a person marks, with the points given so far.

    A line counts for the very answer that it shows: where another came since, it waits anew.

    Raises
    ------
    BadInput
        The file cannot be read, lacks a column, or its points are none.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.rows: list[dict[str, Any]] = []
        self.waiting = 0
        self.changed: list[str] = []  #: answers that are not those that were marked
        self._given: dict[tuple[str, ...], _Given] = {}
        self._used: set[tuple[str, ...]] = set()
        for number, row in enumerate(rows_of(path) if path.exists() else (), start=2):
            _check_columns(path, row)
            place = f"{path}, line {number}"
            points = points_of(row["points"], place)
            if points is not None:
                named = tuple(row[c] for c in ("student", "exercise", "seed", "part"))
                given = _Given(place, named, row.get("answer", ""), points, row.get("reason", ""))
                self._given[_key(*named)] = given

    def apply(self, graded: Graded, lang: str) -> Graded:
        """The sheet with the points that a person gave; what waits is remembered, to be written.

        Raises
        ------
        BadInput
            An answer is given more points than its part has.
        """
        lines, unanswered = dict(graded.lines), list(graded.unanswered)
        for part, line in graded.lines.items():
            if line.verdict != TO_MARK:
                continue
            found = self._found(graded, part, line)
            if found is not None:
                lines[part] = _marked(line, found, lang)
                if part not in (*graded.answered, *unanswered):
                    unanswered.append(part)
            self.waiting += found is None
            self.rows.append(_row(graded, line, found))
        return graded._replace(lines=lines, unanswered=tuple(unanswered))

    def _found(self, graded: Graded, part: str, line: Mark) -> _Given | None:
        key = _key(graded.student, graded.exercise, str(graded.seed), part)
        found = self._given.get(key)
        if found is None:
            return None
        self._used.add(key)
        if " ".join(found.answer.split()) != " ".join(line.answer.split()):
            self.changed.append(", ".join(found.named))
            return None
        return found

    @property
    def unused(self) -> list[str]:
        """The marked answers that nobody gave."""
        return [", ".join(one.named) for key, one in self._given.items() if key not in self._used]

    @property
    def loses(self) -> bool:
        """Whether points that were written in the file are not in the one that takes its place."""
        return bool(self.changed or self.unused)


def _check_columns(path: Path, row: dict[str, str]) -> None:
    for column in (*TO_MARK_COLUMNS[:4], "points"):
        if column not in row:
            found = ", ".join(filter(None, row)) or "nothing"
            raise BadInput(f"{path} lacks the column {column!r}; found {found}{nearest(column, row)}")


def _key(student: str, exercise: str, seed: str, part: str) -> tuple[str, ...]:
    return folded(student), exercise, seed, part


def _marked(line: Mark, found: _Given, lang: str) -> Mark:
    """The mark that a person gave: accepted for all the points, partly right for some, wrong for none."""
    if found.points > line.out_of:
        raise BadInput(
            f"{found.place}: {found.points:g} points for {line.part}, which has {line.out_of:g}; give that or fewer"
        )
    full = found.points >= line.out_of
    says = f"{words(lang)['marking']['by_hand']} {found.reason}".strip()
    verdict = ACCEPTED if full else "partial" if found.points > 0 else "wrong"
    return line._replace(verdict=verdict, points=found.points, told=(Told(says, says),))


def _row(graded: Graded, line: Mark, found: _Given | None) -> dict[str, Any]:
    return {
        "student": graded.student,
        "exercise": graded.exercise,
        "seed": graded.seed,
        "part": line.part,
        "answer": line.answer,
        "points": "" if found is None else f"{found.points:g}",
        "out_of": f"{line.out_of:g}",
        "reason": "" if found is None else found.reason,
    }


def sorted_rows(rows: Sequence[dict[str, Any]]) -> Iterator[dict[str, Any]]:
    """The lines of the file: question by question, as a person marks them; what waits first."""
    yield from sorted(rows, key=lambda row: (row["points"] != "", row["exercise"], row["part"]))
