"""Gradebook of a class: totals of its marked sheets. Pure; :mod:`coursework.gradebook.grading` writes the
files.

Each row comes out once, as a marked or a rejected row, or is counted as blank if another row answers the same
part. Sheets are marked by the hundred, so that shared parts of their variants are computed once; many of them
by several processes.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from coursework.gradebook.columns import (
    LATE,
    MARK,
    PRESENCE,
    PROVISIONAL,
    SITTING,
    SUBMITTED,
    carried_columns,
    exercise_columns,
    identity,
    own_columns,
    summary_columns,
)
from coursework.gradebook.columns import MARKS_COLUMNS as MARKS_COLUMNS
from coursework.gradebook.columns import REJECTED_COLUMNS as REJECTED_COLUMNS
from coursework.gradebook.columns import SUMMARY_COLUMNS as SUMMARY_COLUMNS
from coursework.gradebook.columns import VERDICTS as VERDICTS
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.presence import AWAY
from coursework.gradebook.rows import Rejected
from coursework.gradebook.scale import exact, mark_of
from coursework.issuing.issued import Issued
from coursework.marking.mark import Mark
from coursework.messages import localised

# ------------------------------------------------------------------------- tables


def marks_rows(graded: Graded) -> Iterator[dict[str, Any]]:
    """Yield the lines of a sheet in ``marks.csv``: the answers in the order received, then parts accepted
    without an answer."""
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
            SITTING: graded.sitting,
            SUBMITTED: graded.submitted,
        }


def rejected_rows(rejected: Iterable[Rejected]) -> Iterator[dict[str, Any]]:
    """Yield the lines of ``rejected.csv``."""
    for row in rejected:
        yield {
            **dict.fromkeys(REJECTED_COLUMNS, ""),
            **row.row,
            "source": localised(row.place),
            "reason": localised(row.reason),
        }


@dataclass(slots=True)
class Total:
    """Points and verdicts of one student, or of one exercise."""

    points: float = 0.0
    out_of: float = 0.0
    answers: int = 0
    verdicts: Counter[str] = field(default_factory=Counter)
    by_exercise: dict[str, float] = field(default_factory=dict)  #: points of a student's sheets
    open: int = 0  #: answers that wait for a person

    def add(self, line: Mark) -> None:
        self.points += line.points
        self.out_of += line.out_of
        self.verdicts[line.verdict.partition(":")[0]] += 1


Sitting = tuple[str, int]  #: a student, and which time they sit


@dataclass
class Gradebook:
    """Totals of the marked sheets of a class."""

    issued: Issued
    rows_in: int = 0
    blanks: int = 0  #: rows without an answer where another row counts
    rejected: list[Rejected] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)  #: of what was accepted by hand, for somebody to mend
    students: dict[Sitting, Total] = field(default_factory=dict)  #: of submitted sheets
    exercises: dict[str, Total] = field(default_factory=dict)  #: of the answers received
    #: Parts by sheet; see ``unread``.
    blank: dict[tuple[Sitting, str], set[str]] = field(default_factory=dict)
    waiting: int = 0  #: answers that wait to be marked by a person
    on_scans: int = 0  #: of these, pictures of scans
    changes: int = 0  #: marks that differ from those that were there before
    #: Parts that a platform asked apart, by exercise.
    apart: dict[str, set[str]] = field(default_factory=dict)
    asked_apart: dict[tuple[Sitting, str], set[str]] = field(default_factory=dict)  #: the same of somebody
    complete: set[str] = field(default_factory=set)  #: exercises of which a complete variant was received
    seen: tuple[str, ...] = ()  #: what platforms wrote of what was read
    #: Penalties of late submissions, as shares of the points.
    charged: Mapping[Sitting, float] = field(default_factory=dict)
    presence: Mapping[str, str] = field(default_factory=dict)  #: by student, where somebody stated it
    aside: Collection[Rejected] = ()  #: rejected rows that a person has put aside: nothing waits in them

    @property
    def marked(self) -> int:
        return sum(total.answers for total in self.exercises.values())

    def add(self, graded: Graded) -> None:
        """Count a sheet: all its parts for the student, its answers for the exercise."""
        sitting = graded.student, graded.sitting
        student = self.students.setdefault(sitting, Total())
        exercise = self.exercises.setdefault(graded.exercise, Total())
        for line in graded.lines.values():
            student.add(line)
        if graded.apart:
            self.apart.setdefault(graded.exercise, set()).update(graded.lines)
            self.asked_apart.setdefault((sitting, graded.exercise), set()).update(graded.lines)
        else:
            self.complete.add(graded.exercise)
        student.open += graded.open
        points = student.by_exercise
        points[graded.exercise] = points.get(graded.exercise, 0.0) + graded.points
        if graded.student in self._rejected_of:
            blank = {line.part for line in graded.lines.values() if line.verdict == "missing"}
            self.blank[sitting, graded.exercise] = blank
        for part in graded.answered:
            exercise.add(graded.lines[part])
            exercise.answers += 1
        for part in graded.unanswered:
            exercise.add(graded.lines[part])

    def handed_in(self, sitting: Sitting) -> Collection[str]:
        """Return the exercises of which a sheet was submitted."""
        return self.students[sitting].by_exercise.keys() if sitting in self.students else ()

    @cached_property
    def _rejected_of(self) -> frozenset[str]:
        """Return the students of rejected rows."""
        return frozenset(filter(None, (self.issued.student(r.row.get("student", "")) for r in self.rejected)))

    def unread(self) -> dict[Sitting, dict[tuple[str, int], set[str]]]:
        """Return the parts answered in rejected rows alone, by sitting and by variant."""
        issued = self.issued
        unread: dict[Sitting, dict[tuple[str, int], set[str]]] = {}
        for row in (one.row for one in self.rejected if one not in self.aside):
            student, exercise = issued.student(row.get("student", "")), row.get("exercise", "")
            if not student or not row.get("answer", "").strip():
                continue
            sheet = exercise, self._seed_of(student, exercise, row.get("seed", ""))
            if sheet not in issued.records:
                continue
            sitting = student, issued.sitting_of(student, *sheet)
            parts = {str(part["id"]) for part in issued.records[sheet]["parts"]}
            if row.get("part"):
                parts &= {row["part"]}
            if exercise in self.handed_in(sitting):
                parts &= self.blank.get((sitting, exercise), set())
            if parts:
                unread.setdefault(sitting, {}).setdefault(sheet, set()).update(parts)
        return unread

    def _seed_of(self, student: str, exercise: str, written: str) -> int:
        """Return the seed of a rejected row: the student's own, if there is a roster."""
        issued = self.issued
        seed = int(written) if re.fullmatch("[0-9]{1,30}", written) else -1
        seeds = issued.seeds_of(student, exercise)
        return (
            seed
            if seed in seeds or issued.is_pool or not (seeds or issued.has_roster)
            else issued.seeds.get((student, exercise), -1)
        )

    @property
    def unreadable(self) -> int:
        """Number of lines of ``marks.csv`` with an answer that could not be read."""
        return sum(total.verdicts["unreadable"] for total in self.exercises.values())

    @property
    def review_count(self) -> int:
        """Number of rows that a person must review: rejected, unreadable, wrongly accepted by hand, or to be
        marked by a person."""
        return len(self.rejected) + self.unreadable + len(self.faults) + self.waiting


# ---------------------------------------------------------------------- summary

BEST = "best"


@dataclass(frozen=True)
class Result:
    """Result of a student in one sitting; sheets that were not submitted count."""

    sitting: int
    points: float
    out_of: float
    by_exercise: Mapping[str, float]
    verdicts: Mapping[str, int]
    late: float = 0.0  #: penalty for late submission, in points; those of the answers are unchanged
    open: int = 0  #: answers that wait for a person; until then the mark is provisional

    @property
    def counts(self) -> float:
        """Points on which the mark is based."""
        return self.points - self.late

    @property
    def is_blank(self) -> bool:
        """True if nothing was answered."""
        return self.verdicts["missing"] == sum(self.verdicts[verdict] for verdict in VERDICTS)


def results(book: Gradebook) -> Iterator[tuple[str, Result]]:
    """Yield each student of the roster, and each other student who answered, with the sitting that counts.

    Points are out of all variants issued to a student, or without a roster out of all that they answered;
    those of an assignment out of the whole assignment. Answers in rejected rows alone count as unreadable,
    not as missing.
    """
    unread = book.unread()
    sittings: dict[str, set[int]] = {}
    for student, sitting in (*book.students, *unread):
        sittings.setdefault(student, set()).add(sitting)
    for student in dict.fromkeys((*book.issued.students, *sittings)):
        sat = sorted(sittings.get(student, {1}))
        sat_results = [_result(book, (student, n), unread.get((student, n), {})) for n in sat]
        yield student, counting_result(book.issued, sat_results)


def counting_result(issued: Issued, results_of_student: Sequence[Result]) -> Result:
    """Return the result of the sitting that counts: the best, or the last if the assignment states so; of two
    equally good ones the later."""
    if (issued.assignment or {}).get("sittings", BEST) != BEST:
        return results_of_student[-1]
    return max(
        results_of_student, key=lambda r: (exact(r.counts) / exact(r.out_of) if r.out_of else 0, r.sitting)
    )


def _result(book: Gradebook, sitting: Sitting, unread_parts: Mapping[tuple[str, int], set[str]]) -> Result:
    total = book.students.get(sitting, Total())
    lost = [
        part
        for key in _missing_sheets(book, sitting, unread_parts)
        for part in _missing_parts(book, sitting, key)
    ]
    waiting = sum(map(len, unread_parts.values()))
    verdicts = Counter(total.verdicts)
    verdicts["unreadable"] += waiting
    verdicts["missing"] += len(lost) - waiting
    out_of = total.out_of + sum(part["points"] for part in lost)
    late = float(exact(total.points * book.charged.get(sitting, 0.0)))
    return Result(sitting[1], total.points, out_of, total.by_exercise, verdicts, late, total.open + waiting)


def _missing_parts(book: Gradebook, sitting: Sitting, key: tuple[str, int]) -> list[Mapping[str, Any]]:
    """Return the parts of a variant without an answer. If a platform asks part by part, these are parts that
    it asked of other students."""
    parts = book.issued.records[key]["parts"]
    apart = book.apart.get(key[0])
    if apart is None or key[0] in book.complete:
        return list(parts)
    return [p for p in parts if p["id"] in apart - book.asked_apart.get((sitting, key[0]), set())]


def _missing_sheets(
    book: Gradebook, sitting: Sitting, unread_sheets: Iterable[tuple[str, int]]
) -> set[tuple[str, int]]:
    """Return the variants of which nothing could be marked."""
    issued, done = book.issued, set(book.handed_in(sitting))
    owed = {(e, seed) for e, seed in (*issued.issued_to(*sitting).items(), *unread_sheets) if e not in done}
    met = {e for e, _ in owed} | (done - (book.apart.keys() - book.complete))
    # Nobody's paper asks all the exercises too; which variant was theirs bears on no points.
    return owed | {next(k for k in issued.records if k[0] == e) for e in _asked_of_all(book) if e not in met}


def _asked_of_all(book: Gradebook) -> tuple[str, ...]:
    """Return the exercises of which each student has some variant: those of an assignment; those of a pool of
    which an answer was received."""
    issued = book.issued
    if issued.assignment is not None:
        return () if issued.has_roster and not issued.is_pool else issued.exercises
    return tuple(book.exercises) if issued.is_pool else ()


def _number(points: float) -> float:
    """Return points as tables print them: an integer if possible, else a number."""
    rounded = float(f"{points:g}")
    return int(rounded) if rounded.is_integer() else rounded


def summary_table(book: Gradebook) -> tuple[Sequence[str], list[dict[str, Any]]]:
    """Return the columns and the lines of ``summary.csv``."""
    rows = list(summary_rows(book))
    columns = summary_columns(
        book.issued,
        late=bool(book.charged),
        provisional=any(row[PROVISIONAL] for row in rows),
        presence=any(row[PRESENCE] for row in rows),
    )
    return columns, rows


def is_away(book: Gradebook, student: str, result: Result) -> bool:
    """Return whether a student answered nothing, and is stated to be absent or excused."""
    return result.is_blank and book.presence.get(student) in AWAY


def summary_rows(book: Gradebook) -> Iterator[dict[str, Any]]:
    """Yield the lines of ``summary.csv``."""
    issued = book.issued
    identity_columns, exercises, carried = identity(issued), exercise_columns(issued), carried_columns(issued)
    for student, result in results(book):
        roster_cells = own_columns(issued, student)
        points, out_of = result.points, result.out_of
        marked_of = 0.0 if is_away(book, student, result) else out_of
        yield {
            **{column: roster_cells.get(title, "") for title, column in carried.items()},
            **{column: roster_cells.get(title, "") for column, title in identity_columns.items()},
            **{column: _number(result.by_exercise.get(e, 0.0)) for e, column in exercises.items()},
            "student": student,
            SITTING: result.sitting,
            "points": f"{points:g}",
            "out_of": f"{out_of:g}",
            LATE: f"{result.late:g}",
            PROVISIONAL: result.open or "",
            PRESENCE: book.presence.get(student, ""),
            MARK: mark_of(issued, result.counts, marked_of),
            "percent": f"{100 * result.counts / marked_of:.1f}" if marked_of else "",
            **{verdict: result.verdicts[verdict] for verdict in VERDICTS},
        }
