"""Marking a class: rows of answers against what was issued. Pure; the command line writes the files.

Every row in comes out once, as a marked row or as a rejected one.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from coursework.errors import BadInput, CourseworkError, nearest
from coursework.submissions import COLUMNS, Rejected, Row

if TYPE_CHECKING:
    from coursework.course import Course, Variant
    from coursework.handout import FeedbackSheet
    from coursework.marking import Mark, Marking

ISSUED_FORMAT = 1
MARKS_COLUMNS = (
    "student",
    "exercise",
    "seed",
    "part",
    "answer",
    "read_as",
    "verdict",
    "points",
    "out_of",
    "feedback",
)
SUMMARY_COLUMNS = (
    "student",
    "points",
    "out_of",
    "percent",
    "correct",
    "mistake",
    "wrong",
    "wrong_unit",
    "unreadable",
    "missing",
)
REJECTED_COLUMNS = ("student", "exercise", "seed", "part", "answer", "source", "reason")


@dataclass(frozen=True)
class MarkedRow:
    """One input row with its mark."""

    row: Row
    student: str
    seed: int
    mark: Mark


@dataclass(frozen=True)
class Graded:
    """One student's marked variant."""

    student: str
    variant: Variant
    marking: Marking
    marked: tuple[MarkedRow, ...]


@dataclass
class Gradebook:
    """All that a marking gives."""

    graded: list[Graded] = field(default_factory=list)
    rejected: list[Rejected] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    rows_in: int = 0


class Issued:
    """What was issued: records by exercise and seed, and to whom when there was a roster."""

    def __init__(self, content: Mapping[str, Any], source: str):
        records = content.get("issued") if isinstance(content, Mapping) else None
        if not isinstance(records, list) or not records:
            raise BadInput(f"{source} is no list of issued records; 'coursework build' writes issued.json")
        self.course_name = str(content.get("course", ""))
        self.has_roster = bool(content.get("roster"))
        self.records: dict[tuple[str, int], Mapping[str, Any]] = {}
        self.owner: dict[tuple[str, int], str] = {}
        self.seeds: dict[tuple[str, str], int] = {}
        for item in records:
            try:
                record, student = item["record"], str(item.get("student", ""))
                key = (str(record["exercise"]), int(record["seed"]))
                sum(part["points"] for part in record["parts"])
            except (KeyError, TypeError, ValueError, AttributeError) as fault:
                raise BadInput(f"{source}: an item is no issued record ({fault})") from fault
            self.records[key] = record
            if student:
                self.owner[key] = student
                self.seeds[student.casefold(), key[0]] = key[1]
        self.exercises = tuple(dict.fromkeys(exercise for exercise, _ in self.records))
        self.students = tuple(dict.fromkeys(self.owner.values()))
        self._student_named = {s.casefold(): s for s in self.students}

    @staticmethod
    def read(path: Path) -> Issued:
        """Read ``issued.json``.

        Raises
        ------
        BadInput
            The file is not there, or is not what ``build`` writes.
        """
        try:
            return Issued(json.loads(path.read_text("utf-8")), str(path))
        except OSError as fault:
            raise BadInput(f"{path} cannot be read: {fault.strerror}") from fault
        except (json.JSONDecodeError, UnicodeDecodeError) as fault:
            raise BadInput(f"{path} is not JSON: {str(fault)[:100]}") from fault

    def student(self, name: str) -> str | None:
        """The student's name as issued; None for a stranger to the roster."""
        if not self.has_roster:
            return name
        return self._student_named.get(" ".join(name.split()).casefold())


class _Refused(Exception):
    """Why a row cannot be marked."""


def _place(issued: Issued, row: Row) -> tuple[str, str, int]:
    """Student, exercise and seed of a row, or why it has none."""
    student = issued.student(row.student)
    if not row.student:
        raise _Refused("no student's name")
    if student is None:
        raise _Refused(f"no student {row.student!r} on the roster{_near(row.student, issued.students)}")
    if row.exercise not in issued.exercises:
        raise _Refused(f"no exercise {row.exercise!r} was issued{_near(row.exercise, issued.exercises)}")
    mine = issued.seeds.get((student.casefold(), row.exercise))
    if not row.seed and mine is not None:
        return student, row.exercise, mine
    if not re.fullmatch(r"[0-9]{1,30}(\.0)?", row.seed):
        raise _Refused(f"a seed is a whole number; found {row.seed[:40]!r}")
    seed = int(row.seed.removesuffix(".0"))
    if (row.exercise, seed) not in issued.records:
        raise _Refused(f"seed {seed} of {row.exercise} was not issued")
    if issued.has_roster and mine != seed:
        theirs = f"; {student} has seed {mine}" if mine is not None else f"; {student} was issued none"
        raise _Refused(f"seed {seed} of {row.exercise} is another student's{theirs}")
    return student, row.exercise, seed


def _near(name: str, known: Iterable[str]) -> str:
    hint = nearest(name[:60], known)
    return hint if "did you mean" in hint else ""


def grade(
    course: Course,
    issued: Issued,
    rows: Iterable[Row | Rejected],
    progress: Callable[[int, int], None] = lambda done, of: None,
) -> Gradebook:
    """Mark every row.

    ``progress`` is told how many sheets are marked, of how many.

    Raises
    ------
    CourseworkError
        The course cannot mark: no solutions, an exercise of another version.
    """
    book = Gradebook()
    sheets: dict[tuple[str, str, int], dict[str, Row]] = {}
    variants = {key: course[key[0]].from_record(record) for key, record in issued.records.items()}
    asked = {key: {p.id for p in v.parts} for key, v in variants.items()}
    for row in rows:
        book.rows_in += 1
        if isinstance(row, Rejected):
            book.rejected.append(row)
            continue
        if row.warning and row.warning not in book.warnings:
            book.warnings.append(row.warning)
        try:
            student, exercise, seed = _place(issued, row)
            if row.part not in asked[exercise, seed]:
                known = sorted(asked[exercise, seed])
                raise _Refused(f"{exercise} has no part {row.part[:60]!r}{nearest(row.part[:60], known)}")
            sheet = sheets.setdefault((student, exercise, seed), {})
            if row.part in sheet:
                raise _Refused(f"repeats {sheet[row.part].source}, which is marked")
        except _Refused as why:
            book.rejected.append(Rejected(row.source, str(why), _as_texts(row)))
            continue
        sheet[row.part] = row
    for done, ((student, exercise, seed), answered) in enumerate(sheets.items(), start=1):
        variant = variants[exercise, seed]
        try:
            marking = variant.grade({part: row.answer for part, row in answered.items()})
        except CourseworkError:
            raise  # the course cannot mark: no row is at fault
        except Exception as fault:  # a sheet that the reader did not foresee costs itself alone
            reason = f"cannot be marked, somebody must look at it ({type(fault).__name__}: {str(fault)[:80]})"
            book.rejected += [Rejected(row.source, reason, _as_texts(row)) for row in answered.values()]
            continue
        marked = tuple(MarkedRow(row, student, seed, marking[part]) for part, row in answered.items())
        book.graded.append(Graded(student, variant, marking, marked))
        progress(done, len(sheets))
    return book


def _as_texts(row: Row) -> dict[str, str]:
    answer = "" if row.answer is None else str(row.answer)
    return {
        "student": row.student,
        "exercise": row.exercise,
        "seed": row.seed,
        "part": row.part,
        "answer": answer,
    }


def marks_table(book: Gradebook) -> Iterator[dict[str, Any]]:
    """The lines of ``marks.csv``."""
    for graded in book.graded:
        for marked in graded.marked:
            mark = marked.mark
            yield {
                "student": marked.student,
                "exercise": graded.variant.exercise.name,
                "seed": marked.seed,
                "part": mark.part,
                "answer": mark.answer,
                "read_as": mark.read_as,
                "verdict": mark.verdict,
                "points": f"{mark.points:g}",
                "out_of": f"{mark.out_of:g}",
                "feedback": mark.feedback,
            }


def rejected_table(book: Gradebook) -> Iterator[dict[str, Any]]:
    """The lines of ``rejected.csv``."""
    for rejected in book.rejected:
        place = {"source": rejected.source, "reason": rejected.reason}
        yield {**dict.fromkeys(COLUMNS, ""), **rejected.row, **place}


def summary_table(book: Gradebook, issued: Issued) -> Iterator[dict[str, Any]]:
    """The lines of ``summary.csv``: every student of the roster and every one who answered.

    Points are out of all that a student was issued, or without a roster of all that they answered to.
    """
    sheets: dict[str, list[Graded]] = {student: [] for student in issued.students}
    issued_to: dict[str, list[tuple[str, int]]] = {}
    for (name, exercise), seed in issued.seeds.items():
        issued_to.setdefault(name, []).append((exercise, seed))
    for graded in book.graded:
        sheets.setdefault(graded.student, []).append(graded)
    for student, mine in sheets.items():
        marks = [m for graded in mine for m in graded.marking.values()]
        handed_in = {graded.variant.exercise.name for graded in mine}
        owed = [
            issued.records[exercise, seed]
            for exercise, seed in issued_to.get(student.casefold(), ())
            if exercise not in handed_in
        ]
        lost = [part for record in owed for part in record["parts"]]
        verdicts = [m.verdict.partition(":")[0] for m in marks]
        out_of = sum(m.out_of for m in marks) + sum(p["points"] for p in lost)
        points = sum(m.points for m in marks)
        yield {
            "student": student,
            "points": f"{points:g}",
            "out_of": f"{out_of:g}",
            "percent": f"{100 * points / out_of:.1f}" if out_of else "",
            "correct": verdicts.count("correct"),
            "mistake": verdicts.count("mistake"),
            "wrong": verdicts.count("wrong"),
            "wrong_unit": verdicts.count("wrong_unit"),
            "unreadable": verdicts.count("unreadable"),
            "missing": verdicts.count("missing") + len(lost),
        }


def feedback_sheet(graded: Graded) -> FeedbackSheet:
    """A student's marks on one exercise, ready to print."""
    from coursework.handout import FeedbackLine, FeedbackSheet
    from coursework.marking import localised

    handout = graded.variant.handout(graded.student)
    lines = tuple(
        FeedbackLine(
            question=question,
            answer=graded.marking[question.id].answer,
            read_as=localised(graded.marking[question.id].read_as, graded.variant.lang),
            verdict=graded.marking[question.id].verdict,
            points=graded.marking[question.id].points,
            out_of=graded.marking[question.id].out_of,
            says=graded.marking[question.id].says,
        )
        for question in handout.questions
    )
    return FeedbackSheet(handout, lines, graded.marking.points, graded.marking.out_of)


def needs_a_look(book: Gradebook) -> int:
    """How many rows somebody must look at: rejected or unreadable."""
    unreadable = sum(m.mark.verdict == "unreadable" for g in book.graded for m in g.marked)
    return len(book.rejected) + unreadable
