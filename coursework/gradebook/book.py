"""Marking a class: rows of answers against what was issued. Pure; :mod:`coursework.gradebook.grading` writes the files.

Every row in comes out once, as a marked row or as a rejected one, or is counted where it is blank beside another to the
same part. Sheets are marked by the hundred, so that
what their variants share is computed once; many of them by several processes.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from coursework.gradebook.graded import Graded
from coursework.gradebook.rows import Rejected
from coursework.making.issued import Issued
from coursework.marking.mark import Mark

# ------------------------------------------------------------------------- tables

MARKS_COLUMNS = (
    "student", "exercise", "seed", "part", "answer", "read_as", "verdict", "points", "out_of", "feedback",
)  # fmt: skip
#: Kinds of verdict, in the order of the summary's columns.
VERDICTS = (
    "correct", "follow_through", "mistake", "slip", "accepted", "partial", "wrong", "wrong_unit", "missing_unit",
    "unreadable", "to_mark", "missing",
)  # fmt: skip
SUMMARY_COLUMNS = ("student", "points", "out_of", "percent", *VERDICTS)
REJECTED_COLUMNS = ("student", "exercise", "seed", "part", "answer", "source", "reason")


def marks_rows(graded: Graded) -> Iterator[dict[str, Any]]:
    """A sheet's lines of ``marks.csv``: its answers, in the order they came, then what was accepted without one."""
    for part in (*graded.answered, *graded.unanswered):
        line = graded.lines[part]
        yield {
            "student": graded.student,
            "exercise": graded.exercise,
            "seed": graded.seed,
            "part": part,
            "answer": line.answer,
            "read_as": line.read_as,
            "verdict": line.verdict,
            "points": f"{line.points:g}",
            "out_of": f"{line.out_of:g}",
            "feedback": line.feedback,
        }


def rejected_rows(rejected: Iterable[Rejected]) -> Iterator[dict[str, Any]]:
    """The lines of ``rejected.csv``."""
    for one in rejected:
        yield {**dict.fromkeys(REJECTED_COLUMNS, ""), **one.row, "source": one.source, "reason": one.reason}


@dataclass
class Total:
    """Points and verdicts of one student, or of one exercise."""

    points: float = 0.0
    out_of: float = 0.0
    answers: int = 0
    verdicts: Counter[str] = field(default_factory=Counter)

    def add(self, line: Mark) -> None:
        self.points += line.points
        self.out_of += line.out_of
        self.verdicts[line.verdict.partition(":")[0]] += 1


@dataclass
class Gradebook:
    """What a marking came to."""

    issued: Issued
    rows_in: int = 0
    blanks: int = 0  #: rows without an answer where another row counts
    rejected: list[Rejected] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)  #: of what was accepted by hand, for somebody to mend
    students: dict[str, Total] = field(default_factory=dict)
    exercises: dict[str, Total] = field(default_factory=dict)  #: of the answers that came
    handed_in: dict[str, set[str]] = field(default_factory=dict)  #: exercises by student
    blank: dict[tuple[str, str], set[str]] = field(default_factory=dict)  #: parts by sheet; see ``unread``
    waiting: int = 0  #: answers that wait to be marked by a person
    changes: int = 0  #: marks that differ from those that were there before

    @property
    def marked(self) -> int:
        return sum(total.answers for total in self.exercises.values())

    def add(self, graded: Graded) -> None:
        """Count a sheet: all its parts for the student, its answers for the exercise."""
        student = self.students.setdefault(graded.student, Total())
        exercise = self.exercises.setdefault(graded.exercise, Total())
        self.handed_in.setdefault(graded.student, set()).add(graded.exercise)
        for line in graded.lines.values():
            student.add(line)
        if graded.student in self._rejected_of:
            blank = {line.part for line in graded.lines.values() if line.verdict == "missing"}
            self.blank[graded.student, graded.exercise] = blank
        for part in graded.answered:
            exercise.add(graded.lines[part])
            exercise.answers += 1
        for part in graded.unanswered:
            exercise.add(graded.lines[part])

    @cached_property
    def _rejected_of(self) -> frozenset[str]:
        """The students of rejected rows."""
        return frozenset(filter(None, (self.issued.student(r.row.get("student", "")) for r in self.rejected)))

    def unread(self) -> dict[str, dict[tuple[str, int], set[str]]]:
        """What came in rejected rows alone: by student, the parts of exercise and seed."""
        issued = self.issued
        found: dict[str, dict[tuple[str, int], set[str]]] = {}
        for row in (one.row for one in self.rejected):
            student, exercise = issued.student(row.get("student", "")), row.get("exercise", "")
            if not student or not row.get("answer", "").strip():
                continue
            written = row.get("seed", "")
            seed = int(written) if not issued.has_roster and re.fullmatch("[0-9]{1,30}", written) else -1
            sheet = exercise, issued.seeds.get((student, exercise), seed)
            if sheet not in issued.records:
                continue
            parts = {str(part["id"]) for part in issued.records[sheet]["parts"]}
            if row.get("part"):
                parts &= {row["part"]}
            if exercise in self.handed_in.get(student, ()):
                parts &= self.blank.get((student, exercise), set())
            if parts:
                found.setdefault(student, {}).setdefault(sheet, set()).update(parts)
        return found

    @property
    def unreadable(self) -> int:
        """How many lines of ``marks.csv`` hold an answer that could not be read."""
        return sum(total.verdicts["unreadable"] for total in self.exercises.values())

    @property
    def needs_a_look(self) -> int:
        """How many rows somebody must look at: rejected or unreadable, accepted by hand and at fault, or for a person to mark."""
        return len(self.rejected) + self.unreadable + len(self.faults) + self.waiting


def summary_rows(book: Gradebook) -> Iterator[dict[str, Any]]:
    """The lines of ``summary.csv``: every student of the roster and every one who answered.

    Points are out of all that a student was issued, or without a roster of all that they answered to. What came in
    rejected rows alone is unreadable, and not missing.
    """
    issued, unread = book.issued, book.unread()
    for student in dict.fromkeys((*issued.students, *book.students, *unread)):
        total = book.students.get(student, Total())
        own = unread.get(student, {})
        owed = {
            (e, seed)
            for e, seed in (*issued.issued_to(student).items(), *own)
            if e not in book.handed_in.get(student, ())
        }
        lost = [part for key in owed for part in issued.records[key]["parts"]]
        out_of = total.out_of + sum(part["points"] for part in lost)
        waiting = sum(map(len, own.values()))
        yield {
            "student": student,
            "points": f"{total.points:g}",
            "out_of": f"{out_of:g}",
            "percent": f"{100 * total.points / out_of:.1f}" if out_of else "",
            **{verdict: total.verdicts[verdict] for verdict in VERDICTS},
            "unreadable": total.verdicts["unreadable"] + waiting,
            "missing": total.verdicts["missing"] + len(lost) - waiting,
        }
