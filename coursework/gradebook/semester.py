"""Marks of a semester: a line for each student, the marks of all assignments out of 20, and their weighted
average."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

from coursework.errors import BadInput, bare_letters
from coursework.gradebook.changes import rows_of
from coursework.gradebook.class_points import Scored, class_points
from coursework.gradebook.marks_record import read_record
from coursework.gradebook.presence import ABSENT, EXCUSED, PRESENT, presence_near
from coursework.gradebook.scale import USUAL_SCALE, exact
from coursework.issuing.exam_columns import group_of
from coursework.issuing.identity import NUMBER, is_called, same_id
from coursework.issuing.students import folded
from coursework.language.numbers import typed_number
from coursework.messages import Message

OF = 20  #: maximum of marks and averages
PROVISIONAL, FINAL = "provisional", "final"
#: What an absence is worth: nothing that can be averaged, 0, or as if excused.
WORTH = ("none", "zero", "excused")


class Assessed(NamedTuple):
    """Marks of one assignment."""

    name: str
    weight: float
    scored: Sequence[Scored]
    of: float  #: maximum of the marks
    groups: Mapping[str, str]  #: by student
    presence: Mapping[str, str]  #: by student, where somebody stated it

    def result(self, scored: Scored) -> Assessment:
        """Return the result of a student: absent if nothing was handed in, unless the presence is stated."""
        mark = exact(typed_number(scored.points)) * OF / exact(self.of)
        if scored.has_answered:
            return Assessment(mark, PROVISIONAL if scored.open else "")
        status = self.presence.get(folded(scored.name), scored.presence or ABSENT)
        status = "" if status == PRESENT else status
        return Assessment(None if status else mark, status)


class Assessment(NamedTuple):
    """Mark of a student in an assignment, out of :data:`OF`, and what it is if it is not final."""

    mark: Fraction | None
    status: str = ""


@dataclass
class SemesterLine:
    """Results of one student."""

    name: str
    numbers: set[str] = field(default_factory=set)  #: as they are compared
    number: str = ""
    group: str = ""
    results: dict[str, Assessment] = field(default_factory=dict)  #: by assignment


def assessed(marks: Path, weight: float, name: str = "") -> Assessed:
    """Return the marks of a folder that ``grade`` wrote, or of the build above it; ``attendance.csv`` beside
    it is read too.

    Raises
    ------
    BadInput
        There are none, they go by codes, a mark is above the maximum, or a presence is none.
    """
    if (marks / "marks" / "summary.csv").is_file():
        marks = marks / "marks"
    path = marks / "summary.csv" if marks.is_dir() else marks
    record = read_record(path.parent)
    rows = list(rows_of(path)) if path.is_file() else []
    has_mark = any(row.get("mark") for row in rows)
    scored, of = class_points(marks, "mark" if has_mark else "percent"), 100.0
    if has_mark and record is None:
        raise BadInput(
            "{file}: the maximum of its marks is not known; name the folder that 'coursework grade' wrote",
            file=path,
        )
    if has_mark and record is not None:
        of = float((record.scale or USUAL_SCALE)["of"])
    if above := next((entry for entry in scored if typed_number(entry.points) > of), None):
        raise BadInput(
            "{file}: the mark {mark} of {student} is above {of:g}, the best one",
            file=path,
            mark=above.points,
            student=above.name,
            of=of,
        )
    groups = {folded(row["student"]): group for row in rows if (group := group_of(row))}
    folder = marks if marks.is_dir() else marks.parent
    name = name or (folder.resolve().parent if folder.resolve().name == "marks" else folder.resolve()).name
    presence = {folded(student): its for student, its in presence_near(folder).items()}
    return Assessed(name, weight, scored, of, groups, presence)


def semester(assignments: Sequence[Assessed]) -> list[SemesterLine]:
    """Return the students of all assignments in the order of their names; matched by number, else by name."""
    lines: list[SemesterLine] = []
    by_number: dict[str, SemesterLine] = {}
    by_name: dict[str, list[SemesterLine]] = {}
    for assignment in assignments:
        for scored in assignment.scored:
            numbers = {same_id(value) for title, value in scored.ids if is_called(title, NUMBER)}
            line = next((by_number[n] for n in numbers if n in by_number), None) or next(
                (
                    known
                    for known in by_name.get(folded(scored.name), ())
                    if not (known.numbers and numbers) and assignment.name not in known.results
                ),
                None,
            )
            if line is None:
                line = SemesterLine(scored.name)
                lines.append(line)
                by_name.setdefault(folded(scored.name), []).append(line)
            line.numbers |= numbers
            by_number.update(dict.fromkeys(numbers, line))
            line.number = line.number or next((v for t, v in scored.ids if is_called(t, NUMBER)), "")
            line.group = line.group or assignment.groups.get(folded(scored.name), "")
            line.results[assignment.name] = assignment.result(scored)
    return sorted(lines, key=lambda line: bare_letters(line.name))


def average(line: SemesterLine, assignments: Sequence[Assessed], absence: str) -> Fraction | None:
    """Return the weighted average out of :data:`OF`; None where an absence has no worth, or nothing counts.

    An excused absence is left out, with its weight. ``absence`` is one of :data:`WORTH`.
    """
    total = weights = Fraction(0)
    for assignment in assignments:
        result = line.results.get(assignment.name, Assessment(None, ABSENT))
        if result.mark is None and (result.status == EXCUSED or absence == "excused"):
            continue
        if result.mark is None and absence == "none":
            return None
        total += exact(assignment.weight) * (result.mark or 0)
        weights += exact(assignment.weight)
    return total / weights if weights else None


def unsettled(line: SemesterLine, assignments: Sequence[Assessed]) -> dict[str, list[str]]:
    """Return what keeps a line from being final: provisional, absent and excused, with the names of the
    assignments."""
    results = {a.name: line.results.get(a.name, Assessment(None, ABSENT)).status for a in assignments}
    return {
        status: names
        for status in (PROVISIONAL, ABSENT, EXCUSED)
        if (names := [name for name, its in results.items() if its == status])
    }


def status_of(line: SemesterLine, assignments: Sequence[Assessed]) -> str:
    """Return a line's status as ``semester.csv`` has it: ``provisional: final; absent: midterm``; else
    ``final``."""
    parts = [f"{status}: {', '.join(names)}" for status, names in unsettled(line, assignments).items()]
    return "; ".join(parts) or FINAL


def columns_of(lines: Iterable[SemesterLine], assignments: Sequence[Assessed]) -> list[str]:
    """Return the columns of ``semester.csv``."""
    lines = list(lines)
    about = [name for name in ("number", "group") if any(getattr(line, name) for line in lines)]
    return ["student", *about, *(a.name for a in assignments), "average", "status"]


def rows(
    lines: Iterable[SemesterLine], assignments: Sequence[Assessed], absence: str, sign: str = "."
) -> Iterator[dict[str, Any]]:
    """Yield the rows of ``semester.csv``: numbers, and the text ``12.5*``, with this decimal sign, of what
    may still change."""
    for line in lines:
        results = {a.name: line.results.get(a.name, Assessment(None, ABSENT)) for a in assignments}
        waits = any(result.status == PROVISIONAL for result in results.values())
        whole = Assessment(average(line, assignments, absence), PROVISIONAL if waits else "")
        yield {
            "student": line.name,
            "number": line.number,
            "group": line.group,
            **{name: _cell(result, sign) for name, result in results.items()},
            "average": "" if whole.mark is None else _cell(whole, sign),
            "status": status_of(line, assignments),
        }


def _cell(result: Assessment, sign: str) -> float | str:
    """Return a mark, rounded half up to hundredths; as a text with a star if it may still change."""
    if result.mark is None:
        return result.status
    mark = math.floor(result.mark * 100 + Fraction(1, 2)) / 100
    if result.status == PROVISIONAL:
        return f"{mark:.10g}*".replace(".", sign)
    return int(mark) if mark.is_integer() else mark


def check_names(assignments: Sequence[Assessed]) -> None:
    """Raise BadInput where two assignments have one name, or that of another column."""
    names = [assignment.name for assignment in assignments]
    for name in names:
        if names.count(name) > 1 or name in ("student", "number", "group", "average", "status"):
            raise BadInput(
                Message("the name {name!r} cannot be used; give another one: NAME=FOLDER", name=name)
            )
