"""Answers that a person marks: ``to_mark.csv`` lists them, and the points written in it count at the next
marking."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from coursework.errors import BadInput, nearest
from coursework.gradebook.accepted import ACCEPTED, check_points, points_of
from coursework.gradebook.changes import rows_of
from coursework.gradebook.graded_sheet import Graded
from coursework.issuing.students import folded
from coursework.language.words import words
from coursework.marking.feedback import RecordedSentence
from coursework.marking.mark import Mark
from coursework.messages import Message

TO_MARK = "to_mark"  #: the verdict of an answer that waits
TO_MARK_COLUMNS = ("student", "exercise", "seed", "part", "answer", "points", "out_of", "reason")


class GivenPoints(NamedTuple):
    """Line of the file with points."""

    location: str
    named: tuple[str, ...]
    answer: str
    points: float
    reason: str


class ToMark:
    """Answers that a person marks, with the points given so far.

    A line counts only for the answer that it shows; a changed answer waits again.

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
        self.given: dict[tuple[str, ...], GivenPoints] = {}  #: the lines of the file with points
        self._used: set[tuple[str, ...]] = set()
        for number, row in enumerate(rows_of(path) if path.exists() else (), start=2):
            _check_columns(path, row)
            location = Message("{file}, line {line}", file=path, line=number)
            points = points_of(row["points"], location)
            if points is not None:
                named = tuple(row[c] for c in ("student", "exercise", "seed", "part"))
                given = GivenPoints(location, named, row.get("answer", ""), points, row.get("reason", ""))
                self.given[_key(*named)] = given

    def apply(self, graded: Graded, lang: str) -> Graded:
        """Return the sheet with the points that a person gave; list the answers that a person marks.

        Raises
        ------
        BadInput
            An answer is given more points than its part has.
        """
        lines, unanswered = dict(graded.lines), list(graded.unanswered)
        for part, line in graded.lines.items():
            if line.verdict != TO_MARK:
                continue
            given = self.given_for(graded, part, line)
            if given is not None:
                lines[part] = given_mark(line, given.points, given.reason, lang, given.location)
                if part not in (*graded.answered, *unanswered):
                    unanswered.append(part)
            self.waiting += given is None
            self.rows.append(_row(graded, line, given))
        return graded._replace(lines=lines, unanswered=tuple(unanswered))

    def given_for(self, graded: Graded, part: str, line: Mark) -> GivenPoints | None:
        """Return the points that the file gives to an answer; None if it gives none, or gives them to another
        answer."""
        key = _key(graded.student, graded.exercise, str(graded.seed), part)
        given = self.given.get(key)
        if given is None:
            return None
        self._used.add(key)
        if not same_answer(given.answer, line.answer):
            self.changed.append(", ".join(given.named))
            return None
        return given

    @property
    def unused(self) -> list[str]:
        """Marked answers that nobody gave."""
        return [", ".join(given.named) for key, given in self.given.items() if key not in self._used]

    @property
    def loses(self) -> bool:
        """True if points written in the file are missing from the file that replaces it."""
        return bool(self.changed or self.unused)


def _check_columns(path: Path, row: dict[str, str]) -> None:
    for column in (*TO_MARK_COLUMNS[:4], "points"):
        if column not in row:
            titles = ", ".join(filter(None, row)) or "nothing"
            raise BadInput(
                "{file} lacks the column {column!r}; found {found}{nearest}",
                file=path,
                column=column,
                found=titles,
                nearest=nearest(column, row),
            )


def _key(student: str, exercise: str, seed: str, part: str) -> tuple[str, ...]:
    return folded(student), exercise, seed, part


def given_mark(line: Mark, points: float, reason: str, lang: str, location: str) -> Mark:
    """Return the mark that a person gave: accepted for all points, partly right for some, wrong for none.
    ``location`` is the place of the statement, for messages.

    Raises
    ------
    BadInput
        The part has fewer points.
    """
    check_points(points, line.part, line.out_of, location)
    verdict = ACCEPTED if points >= line.out_of else "partial" if points > 0 else "wrong"
    message = f"{words(lang)['marking']['by_hand']} {reason}".strip()
    return line._replace(verdict=verdict, points=points, told=(RecordedSentence(message, message),))


def same_answer(text: str, other: str) -> bool:
    """Return True if two texts are the same answer, apart from spaces."""
    return " ".join(text.split()) == " ".join(other.split())


def _row(graded: Graded, line: Mark, given: GivenPoints | None) -> dict[str, Any]:
    return {
        "student": graded.student,
        "exercise": graded.exercise,
        "seed": graded.seed,
        "part": line.part,
        "answer": line.answer,
        "points": "" if given is None else f"{given.points:g}",
        "out_of": f"{line.out_of:g}",
        "reason": "" if given is None else given.reason,
    }


def sorted_rows(rows: Sequence[dict[str, Any]]) -> Iterator[dict[str, Any]]:
    """Yield the lines of the file: question by question, answers without points first."""
    yield from sorted(rows, key=lambda row: (row["points"] != "", row["exercise"], row["part"]))
