"""Answers that a person accepted, whatever their marks."""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from coursework.errors import BadInput, counted, nearest
from coursework.gradebook.changes import lines_of
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.placing import UnplacedError, name_hint, sheet_of_row
from coursework.gradebook.rows import AnswerRow
from coursework.issuing.issued import Issued
from coursework.issuing.students import folded
from coursework.language.words import words
from coursework.marking.feedback import RecordedSentence
from coursework.marking.mark import Mark
from coursework.messages import Message, as_message
from coursework.system.limits import MOST_TABLE_BYTES

ACCEPTED = "accepted"

_NEEDED = ("student", "exercise", "part")
_OPTIONAL = ("seed", "points", "reason")
_ALIKE = 0.75  #: of two column names, beyond which one is the other with a typing error


class Accepted:
    """Answers accepted by hand: a CSV with ``student,exercise,seed,part`` and, optionally, ``points`` and
    ``reason``. An accepted answer has full points, or the stated ones; of two lines on one answer the later
    counts.

    Raises
    ------
    BadInput
        The file cannot be read, a line names no answer, or its points are none.
    """

    def __init__(self, path: Path | None) -> None:
        self.path = path
        self.lines: list[Acceptance] = []  #: of the file
        self._by_place: dict[tuple[str, str, str, str], list[Acceptance]] = {}
        self._headings: list[str] = []  #: what is wrong with them
        self._used: set[Acceptance] = set()
        for number, row, more in (
            () if path is None else lines_of(path, MOST_TABLE_BYTES, (*_NEEDED, *_OPTIONAL))
        ):
            if not self.lines:
                self._headings = [
                    Message("{file}, line 1: {problem}", file=path, problem=wrong) for wrong in _misspelt(row)
                ]
            acceptance = _acceptance(
                Message("{file}, line {line}", file=path, line=number), number, row, more
            )
            self.lines.append(acceptance)
            self._by_place.setdefault(_key(*acceptance.answer_id), []).append(acceptance)

    def apply(self, graded: Graded, lang: str) -> Graded:
        """Return the sheet with its accepted answers marked as such, including answers that no row gave.

        Raises
        ------
        BadInput
            An answer is given more points than its part has.
        """
        if not self._by_place:
            return graded
        lines = dict(graded.lines)
        unanswered = [*graded.unanswered]
        for part, line in graded.lines.items():
            for acceptance in self._named(graded, part):
                self._used.add(acceptance)
                lines[part] = accepted_mark(
                    line, acceptance.points, acceptance.reason, lang, acceptance.location
                )
                if part not in (*graded.answered, *unanswered):
                    unanswered.append(part)
        return graded._replace(lines=lines, unanswered=tuple(unanswered))

    def _named(self, graded: Graded, part: str) -> list[Acceptance]:
        """Return the lines on an answer, in the order of the file."""
        keys = (_key(graded.student, graded.exercise, seed, part) for seed in (graded.seed, ""))
        return sorted(
            (acceptance for key in keys for acceptance in self._by_place.get(key, ())),
            key=lambda acceptance: acceptance.line,
        )

    def unfollowed(self, issued: Issued, students: Iterable[str]) -> tuple[list[str], list[str]]:
        """Return the faults of the file (unknown headings and names, contradictory lines), and the issued
        answers named in it that nobody gave. ``students`` are those who answered."""
        faults: list[str] = list(self._headings)
        notes: list[str] = []
        issued_parts = _IssuedParts(issued, tuple(students)) if self.lines else None
        for acceptance in self.lines:
            if issued_parts is not None and acceptance not in self._used:
                note = Message(
                    "accepted by hand, but never answered: {answer}", answer=acceptance.answer_text
                )
                why = issued_parts.why_not(acceptance)
                faults += (
                    [Message("{place}: {note}; {problem}", place=acceptance.location, note=note, problem=why)]
                    if why
                    else []
                )
                notes += [] if why else [note]
        faults += [] if issued_parts is None else self._contradictions(issued_parts)
        return faults, notes

    def _contradictions(self, issued_parts: _IssuedParts) -> Iterator[str]:
        """Yield a message for each line on an answer that gives other points than the line before it."""
        groups: dict[tuple[str, ...], list[Acceptance]] = {}
        for acceptance in self.lines:
            groups.setdefault((folded(acceptance.student), acceptance.exercise, acceptance.part), []).append(
                acceptance
            )
        for group in groups.values():
            for before, acceptance in _in_turn(group):
                if issued_parts.points(before) != issued_parts.points(acceptance):
                    yield Message(
                        "{place}: {gives} for {answer}, and line {line} says {before}; line {last} counts: take one of them away",
                        place=acceptance.location,
                        gives=acceptance.gives,
                        answer=acceptance.answer_text,
                        line=before.line,
                        before=before.gives,
                        last=acceptance.line,
                    )


class Acceptance(NamedTuple):
    """A line of the file."""

    location: str
    line: int
    student: str  #: as it is written, and so are the others
    exercise: str
    seed: str
    part: str
    points: float | None  #: None for all of them
    reason: str

    @property
    def answer_id(self) -> tuple[str, str, str, str]:
        return self.student, self.exercise, self.seed, self.part

    @property
    def answer_text(self) -> str:
        return ", ".join(filter(None, self.answer_id))

    @property
    def gives(self) -> Message:
        return (
            Message("full points")
            if self.points is None
            else Message("points {points:g}", points=self.points)
        )


def _in_turn(lines: Iterable[Acceptance]) -> Iterator[tuple[Acceptance, Acceptance]]:
    """Yield the lines on one part of a student, each with the last line before it on the same variant; a line
    without a seed is on every variant."""
    last: dict[str, Acceptance] = {}  #: by seed
    latest: Acceptance | None = None
    for acceptance in lines:
        before = (
            [last[seed] for seed in {acceptance.seed, ""} if seed in last] if acceptance.seed else [latest]
        )
        earlier = max(filter(None, before), key=lambda other: other.line, default=None)
        if earlier is not None:
            yield earlier, acceptance
        last[acceptance.seed] = latest = acceptance


def _key(student: str, exercise: str, seed: Any, part: str) -> tuple[str, str, str, str]:
    return folded(student), exercise, str(seed), part


# ---------------------------------------------------------------------- reading


def _acceptance(location: str, number: int, row: dict[str, str], more: Sequence[str]) -> Acceptance:
    missing = [c for c in _NEEDED if not row.get(c)]
    if missing:
        raise BadInput(
            "{place}: {columns} missing; name the answer to accept",
            place=location,
            columns=", ".join(missing),
        )
    if any(cell.strip() for cell in more):
        raise BadInput(
            "{place}: {cells} more than there are headings, {found!r}; put a text with a comma, or a number with one, between quotation marks",
            place=location,
            cells=counted(len(more), "cell"),
            found=", ".join(more)[:40],
        )
    seed = re.sub(r"[.,]0+$", "", row.get("seed", ""))  # as spreadsheets write whole numbers
    points = points_of(row.get("points", ""), location)
    named = (row["student"], row["exercise"], seed, row["part"])
    return Acceptance(location, number, *named, points, row.get("reason", ""))


def _misspelt(columns: Iterable[str]) -> Iterator[str]:
    """Yield a message for each heading that looks like a misspelt optional heading."""
    columns = list(columns)
    absent = [c for c in _OPTIONAL if c not in columns]
    for column in columns:
        if column not in (*_NEEDED, *_OPTIONAL) and (
            meant := difflib.get_close_matches(column, absent, n=1, cutoff=_ALIKE)
        ):
            yield Message(
                "no column {column!r} is read; did you mean {near!r}?", column=column, near=meant[0]
            )


def points_of(text: str, location: str) -> float | None:
    """Return the points in a cell; None for an empty cell."""
    if not text:
        return None
    try:
        points = float(text.replace(",", "."))
    except ValueError:
        points = math.nan
    if not 0 <= points < math.inf:
        raise BadInput(
            "{place}: points are a number, 0 or more; found {found!r}", place=location, found=text[:40]
        )
    return points


# -------------------------------------------------------------------- following


def accepted_mark(line: Mark, points: float | None, reason: str, lang: str, location: str) -> Mark:
    """Return the mark of an accepted answer: full points, if ``points`` is None. ``location`` is the place of
    the statement, for messages.

    Raises
    ------
    BadInput
        The part has fewer points.
    """
    points = line.out_of if points is None else points
    check_points(points, line.part, line.out_of, location)
    message = f"{words(lang)['marking']['accepted']} {reason}".strip()
    return line._replace(verdict=ACCEPTED, points=points, told=(RecordedSentence(message, message),))


def check_points(points: float, part: str, out_of: float, location: str) -> None:
    """Refuse more points than a part has."""
    if points > out_of:
        raise BadInput(
            "{place}: {points:g} points for {part}, which has {out_of:g}; give that or fewer",
            place=location,
            points=points,
            part=part,
            out_of=out_of,
        )


class _IssuedParts:
    """Parts of the issued variants, as lines of the file name them."""

    def __init__(self, issued: Issued, students: Sequence[str]) -> None:
        self._issued, self._students = issued, students
        self._answered = frozenset(map(folded, students))
        self._parts: dict[
            tuple[str, str], dict[str, float]
        ] = {}  #: points, by exercise and seed; of any seed by ""
        for (exercise, seed), record in issued.records.items():
            points = {str(part["id"]): float(part["points"]) for part in record["parts"]}
            self._parts[exercise, str(seed)] = points
            self._parts.setdefault((exercise, ""), {}).update(points)

    def why_not(self, acceptance: Acceptance) -> str:
        """Return the reason for which a line names no issued answer; empty if it names one."""
        issued, parts = self._issued, self._parts.get((acceptance.exercise, acceptance.seed))
        if not issued.has_roster and folded(acceptance.student) not in self._answered:
            return Message(
                "no student {student!r} among those who answered{hint}",
                student=acceptance.student,
                hint=name_hint(acceptance.student, self._students),
            )
        if issued.has_roster or parts is None:
            try:
                _, exercise, seed = sheet_of_row(
                    issued, AnswerRow(*acceptance.answer_id, None, acceptance.location)
                )
            except UnplacedError as why:
                return as_message(why)
            parts = self._parts[exercise, str(seed)]
        return (
            ""
            if acceptance.part in parts
            else f"{acceptance.exercise} has no part {acceptance.part!r}{nearest(acceptance.part, parts)}"
        )

    def points(self, acceptance: Acceptance) -> float | None:
        """Return the points that a line gives; None for full points of an unknown part."""
        parts = self._parts.get((acceptance.exercise, acceptance.seed), {})
        return parts.get(acceptance.part) if acceptance.points is None else acceptance.points
