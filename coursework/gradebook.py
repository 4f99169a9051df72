"""Marking a class: rows of answers against what was issued. Pure; :mod:`coursework.grading` writes the files.

Every row in comes out once, as a marked row or as a rejected one, or is counted where it is blank beside another to the
same part. Sheets are marked by the hundred, so that
what their variants share is computed once; many of them by several processes.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

from coursework.course import Course, open_course
from coursework.errors import CourseworkError, NoSolution, UnknownName, nearest
from coursework.issued import Issued
from coursework.key import keys_of
from coursework.language import words
from coursework.marking import Mark, mark
from coursework.model import Part
from coursework.plainly import plainly_right
from coursework.processes import processes, workers
from coursework.submissions import Rejected, Row
from coursework.telling import plain_line, right_feedback
from coursework.variant import Variant

_LISTED = 8  #: names that a message lists
CHUNK = 500  #: sheets marked together
WORTH_PROCESSES = 20_000  #: answers; fewer are marked before a process has started


class Line(NamedTuple):
    """A mark as plain data: what a line of ``marks.csv`` and a feedback sheet say."""

    part: str
    answer: str
    read_as: str
    verdict: str
    points: float
    out_of: float
    says: str  #: Markdown
    feedback: str  #: one line of plain text
    matches: tuple[str, ...]

    @staticmethod
    def of(mark: Mark, *, printed: bool) -> Line:
        """``printed``: with the Markdown that a feedback sheet needs. What could not be read is said to wait."""
        says, feedback = mark.says if printed else "", mark.feedback
        if mark.verdict == "unreadable":
            waits = words(mark.lang)["marking"]["waits"]
            says, feedback = f"{says} {waits}", f"{feedback} {plain_line(waits, mark.lang)}"
        return Line(
            mark.part, mark.answer, mark.read_as, mark.verdict, mark.points, mark.out_of,
            says, feedback, mark.matches,
        )  # fmt: skip


class Graded(NamedTuple):
    """One student's marked sheet: a line for each part asked; ``answered`` names those that came."""

    student: str
    exercise: str
    seed: int
    lines: Mapping[str, Line]
    answered: tuple[str, ...]
    record: Mapping[str, Any]  #: what was issued, in the language of the sheet that came back
    unanswered: tuple[str, ...] = ()  #: parts accepted by hand that no row answers

    @property
    def points(self) -> float:
        return sum(line.points for line in self.lines.values())

    @property
    def out_of(self) -> float:
        return sum(line.out_of for line in self.lines.values())


@dataclass
class Sheets:
    """Rows of answers in their places, before they are marked."""

    sheets: dict[tuple[str, str, int], dict[str, Row]] = field(default_factory=dict)
    rejected: list[Rejected] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    rows_in: int = 0
    blanks: int = 0  #: rows without an answer where another row answers to the same part, or is blank too
    langs: dict[tuple[str, str, int], str] = field(default_factory=dict)  #: of the sheets that tell theirs

    @property
    def answers(self) -> int:
        return sum(map(len, self.sheets.values()))


# ------------------------------------------------------------------------ placing


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
        raise _Refused(
            f"no exercise {row.exercise!r} was issued{_near_or_all(row.exercise, issued.exercises)}"
        )
    mine = issued.seeds.get((student, row.exercise))
    if not row.seed and mine is not None:
        return student, row.exercise, mine
    if not re.fullmatch(r"[0-9]{1,30}(\.0)?", row.seed):
        raise _Refused(f"a seed is a whole number; found {row.seed[:40]!r}")
    seed = int(row.seed.removesuffix(".0"))
    theirs = f"; {student} has seed {mine}" if mine is not None else f"; {student} was issued none"
    theirs = theirs if issued.has_roster else ""
    if (row.exercise, seed) not in issued.records:
        raise _Refused(f"seed {seed} of {row.exercise} was not issued{theirs}")
    if issued.has_roster and mine != seed:
        raise _Refused(f"seed {seed} of {row.exercise} is another student's{theirs}")
    return student, row.exercise, seed


def _near(name: str, known: Iterable[str]) -> str:
    hint = nearest(name[:60], known)
    return hint if "did you mean" in hint else ""


def _near_or_all(name: str, known: Sequence[str]) -> str:
    if hint := _near(name, known):
        return hint
    return f"; issued: {', '.join(known[:_LISTED])}{', …' if len(known) > _LISTED else ''}"


def placed(course: Course, issued: Issued, rows: Iterable[Row | Rejected]) -> Sheets:
    """Rows by sheet; those that belong nowhere are rejected with their reason.

    Raises
    ------
    CourseworkError
        The course cannot mark: no solutions, an exercise that the records do not fit.
    """
    found = Sheets()
    for exercise, one in {key[0]: record for key, record in issued.records.items()}.items():
        if exercise not in course:
            raise UnknownName(
                f"no exercise {exercise!r} in {course.label}, though it was issued: name the course that it was built "
                "from, coursework --course FOLDER grade …"
            )
        _ = course[exercise].solution
        course[exercise].from_record(one)
    asked: dict[tuple[str, int], frozenset[str]] = {}
    places: dict[tuple[str, str, str], tuple[str, str, int] | str] = {}
    for row in rows:
        found.rows_in += 1
        if isinstance(row, Rejected):
            found.rejected.append(row)
            continue
        if row.warning and row.warning not in found.warnings:
            found.warnings.append(row.warning)
        named = row.student, row.exercise, row.seed
        if named not in places:
            try:
                places[named] = _place(issued, row)
            except _Refused as why:
                places[named] = str(why)
        place = places[named]
        reason = place if isinstance(place, str) else ""
        if not reason:
            key = place[1:]
            if key not in asked:
                asked[key] = frozenset(str(part["id"]) for part in issued.records[key]["parts"])
            sheet = found.sheets.setdefault(place, {})
            if row.part not in asked[key]:
                near = nearest(row.part[:60], sorted(asked[key]))
                reason = f"{row.exercise} has no part {row.part[:60]!r}{near}"
            elif row.part in sheet:
                before = sheet[row.part]
                if _is_blank(row):
                    found.blanks += 1
                    continue
                if _is_blank(before):
                    found.blanks += 1
                else:
                    reason = f"repeats {before.source}, which is marked"
        if reason:
            found.rejected.append(Rejected(row.source, reason, _as_texts(row)))
        else:
            sheet[row.part] = row
            if row.lang and place not in found.langs and row.lang in course[place[1]].languages:
                found.langs[place] = row.lang
    found.sheets = {place: sheet for place, sheet in found.sheets.items() if sheet}
    return found


def _is_blank(row: Row) -> bool:
    return row.answer is None or (isinstance(row.answer, str) and not row.answer.strip())


def _as_texts(row: Row) -> dict[str, str]:
    answer = "" if row.answer is None else str(row.answer)
    return {
        "student": row.student,
        "exercise": row.exercise,
        "seed": row.seed,
        "part": row.part,
        "answer": answer,
    }


# ------------------------------------------------------------------------ marking


class _Job(NamedTuple):
    """A sheet to mark: the record it was issued by, and its answers by part."""

    record: Mapping[str, Any]
    answers: Mapping[str, Any]


def marked(course: Course, issued: Issued, sheets: Sheets, *, printed: bool = True) -> Iterator[Graded]:
    """The sheets marked, in their order; ``printed`` where feedback sheets are to be made of them.

    A sheet that cannot be marked costs itself alone: its rows are added to the rejected, and the warnings tell it.

    Raises
    ------
    NoSolution
        The course cannot mark.
    """
    unmarked: Counter[tuple[str, str]] = Counter()
    places = list(sheets.sheets)
    chunks = [places[i : i + CHUNK] for i in range(0, len(places), CHUNK)]

    def record(place: tuple[str, str, int]) -> Mapping[str, Any]:
        issued_as = issued.records[place[1:]]
        return {**issued_as, "lang": sheets.langs[place]} if place in sheets.langs else issued_as

    def jobs(chunk: Sequence[tuple[str, str, int]]) -> list[_Job]:
        return [
            _Job(record(place), {p: row.answer for p, row in sheets.sheets[place].items()}) for place in chunk
        ]

    for chunk, results in zip(
        chunks, _marked_chunks(course, map(jobs, chunks), sheets.answers, printed), strict=True
    ):
        for place, result in zip(chunk, results, strict=True):
            rows = sheets.sheets[place]
            if isinstance(result, str):
                unmarked[place[1], result] += 1
                reason = f"cannot be marked, somebody must look at it ({result})"
                sheets.rejected += [Rejected(row.source, reason, _as_texts(row)) for row in rows.values()]
            else:
                lines = map(Line._make, result)
                yield Graded(*place, {line.part: line for line in lines}, tuple(rows), record(place))
    for (exercise, why), count in unmarked.items():
        what = "1 sheet" if count == 1 else f"{count} sheets"
        sheets.warnings.append(f"{what} of {exercise} cannot be marked, see the rejected rows: {why}")


def _marked_chunks(
    course: Course, chunks: Iterator[list[_Job]], answers: int, printed: bool
) -> Iterator[list[list[tuple] | str]]:
    """Each chunk marked, in order; by processes where there is much to do."""
    count = workers(answers)
    if answers < WORTH_PROCESSES or count < 2:
        for chunk in chunks:
            yield _mark_chunk(course, chunk, printed)
        return
    with processes(count) as submit:
        waiting: list[Any] = []
        for chunk in chunks:
            waiting.append(submit(_mark_elsewhere, str(course.root), chunk, printed))
            if len(waiting) >= 3 * count:
                yield waiting.pop(0).result()
        for task in waiting:
            yield task.result()


def _mark_elsewhere(root: str, chunk: list[_Job], printed: bool) -> list[list[tuple] | str]:
    return _mark_chunk(open_course(root), chunk, printed)


def _mark_chunk(course: Course, chunk: Sequence[_Job], printed: bool) -> list[list[tuple] | str]:
    """Lines a sheet, or why it cannot be marked."""
    variants = [course[job.record["exercise"]].from_record(job.record) for job in chunk]
    by_exercise: dict[str, list[int]] = {}
    for i, variant in enumerate(variants):
        by_exercise.setdefault(variant.exercise.name, []).append(i)
    right: list[dict[str, str]] = [{} for _ in chunk]
    for name, places in by_exercise.items():
        batch = keys_of(course[name], [variants[i] for i in places])
        if not printed:
            found = plainly_right(course[name], batch, [chunk[i].answers for i in places])
            for i, digits in zip(places, found, strict=True):
                right[i] = digits
    return [
        _mark_sheet(variant, job.answers, own, printed)
        for variant, job, own in zip(variants, chunk, right, strict=True)
    ]


def _mark_sheet(
    variant: Variant, answers: Mapping[str, Any], right: Mapping[str, str], printed: bool
) -> list[tuple] | str:
    """A sheet's lines in the order of its parts, or why it cannot be marked; those that are plainly ``right`` are not
    marked anew."""
    try:
        marking = mark(variant, answers, right) if len(right) < len(variant.parts) else {}
        lines = (
            _right_line(variant, part, answers[part.id], right[part.id])
            if part.id in right
            else Line.of(marking[part.id], printed=printed)
            for part in variant.parts
        )
        return [tuple(line) for line in lines]  # plain tuples pass between processes at half the price
    except NoSolution:
        raise  # no sheet is at fault
    except CourseworkError as fault:
        return " ".join(str(fault).split())
    except Exception as fault:  # what the reader or a judge of the course did not foresee
        return f"{type(fault).__name__}: {' '.join(str(fault).split())[:80]}"


def _right_line(variant: Variant, part: Part, answer: str, read_as: str) -> Line:
    points = float(part.points)
    says = right_feedback(variant, part, read_as)
    return Line(part.id, answer, read_as, "correct", points, points, "", says, ())


# ------------------------------------------------------------------------- tables

MARKS_COLUMNS = (
    "student", "exercise", "seed", "part", "answer", "read_as", "verdict", "points", "out_of", "feedback",
)  # fmt: skip
#: Kinds of verdict, in the order of the summary's columns.
VERDICTS = (
    "correct", "follow_through", "mistake", "slip", "accepted", "wrong", "wrong_unit", "missing_unit",
    "unreadable", "missing",
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

    def add(self, line: Line) -> None:
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
    students: dict[str, Total] = field(default_factory=dict)
    exercises: dict[str, Total] = field(default_factory=dict)  #: of the answers that came
    handed_in: dict[str, set[str]] = field(default_factory=dict)  #: exercises by student
    blank: dict[tuple[str, str], set[str]] = field(default_factory=dict)  #: parts by sheet; see ``unread``
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
        """How many rows somebody must look at: rejected or unreadable."""
        return len(self.rejected) + self.unreadable


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
