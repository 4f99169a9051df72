"""Marks of ``marks.csv``, possibly edited by hand: read again, so that summary and feedback agree with them.

The answers are marked once more for what is said of them and for what the hand changed; verdict and points
are those of the file.
"""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from coursework.course.course import Course
from coursework.errors import BadInput, nearest
from coursework.gradebook.changes import lines_of, rows_of
from coursework.gradebook.class_marking import marked
from coursework.gradebook.columns import MARKS_COLUMNS, REJECTED_COLUMNS, SITTING, VERDICTS
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.placing import Sheets, placed_sheets
from coursework.gradebook.rows import AnswerRow, Rejected, RowOrigin
from coursework.issuing.identity import identifies
from coursework.issuing.issued import Issued
from coursework.issuing.students import folded
from coursework.language.numbers import typed_number
from coursework.marking.mark import Mark
from coursework.messages import Message
from coursework.system.tables import as_written, delimiter_of, open_csv

_NEEDED = tuple(c for c in MARKS_COLUMNS if c not in ("read_as", "feedback"))


class _MarksLine(NamedTuple):
    """Line of ``marks.csv``."""

    location: str  #: file and line
    verdict: str
    points: str
    out_of: str
    feedback: str | None  #: None where the file has no such column


class EditedMarks:
    """Marks of a file, sheet by sheet.

    Raises
    ------
    BadInput
        A line that states no mark, is about nothing that was issued, or repeats another; the message names
        the line.
    """

    def __init__(self, course: Course, issued: Issued, path: Path) -> None:
        self.path = path
        self._course, self._issued = course, issued
        self._lines: dict[str, _MarksLine] = {}
        rows: Iterable[AnswerRow] = self._rows()
        if issued.is_pool:
            rows = _with_origins(issued, list(rows))
            _add_identity(issued, path.with_name("summary.csv"))
        self.sheets: Sheets = placed_sheets(course, issued, rows)
        self.refuse(self.sheets.rejected)
        if not self.sheets.sheets:
            raise BadInput(
                "{file} contains no mark, so nothing is written; 'coursework grade' writes it", file=path
            )
        self.sheets.rejected += _rejected_before(path.with_name("rejected.csv"))

    def refuse(self, rejected: list[Rejected]) -> None:
        """Raise an error if lines could not be read again; it states the reason of the first."""
        if rejected:
            first = rejected[0]
            if len(rejected) == 1:
                raise BadInput("{file}: {reason}; nothing is written", file=first.place, reason=first.reason)
            raise BadInput(
                "{file}: {reason} (and {count} line{count:|s} more); nothing is written",
                file=first.place,
                reason=first.reason,
                count=len(rejected) - 1,
            )

    def marked(self) -> list[Graded]:
        """Mark the answers of the file again. Raises BadInput: a sheet cannot be marked."""
        earlier = len(self.sheets.rejected)
        machine = list(marked(self._course, self._issued, self.sheets))
        self.refuse(self.sheets.rejected[earlier:])
        return machine

    def _rows(self) -> Iterator[AnswerRow]:
        met: dict[tuple[str, ...], str] = {}
        for number, row in _table(self.path):
            location = Message("{file}, line {line}", file=self.path, line=number)
            sitting = row.get(SITTING, "")
            named = folded(row["student"]), row["exercise"], row["seed"], row["part"], sitting
            if named in met:
                raise BadInput(
                    "{place}: repeats {line}; keep one mark for each answer", place=location, line=met[named]
                )
            met[named] = f"line {number}"
            _check_verdict(location, row["verdict"])
            self._lines[location] = _MarksLine(
                location, row["verdict"], row["points"], row["out_of"], row.get("feedback")
            )
            origin = RowOrigin(sitting=int(sitting) if sitting.isdecimal() and len(sitting) < 10 else 0)
            names = row["student"], row["exercise"], row["seed"], row["part"]
            yield AnswerRow(*names, row["answer"], location, origin=origin if self._issued.is_pool else None)

    def of(self, graded: Graded) -> Graded:
        """Return the sheet with the marks of the file.

        Raises
        ------
        BadInput
            Points that are not a number from 0 to those of the part, or another number to have than was
            issued.
        """
        sheets, key = self.sheets.sheets, graded[:3]
        rows = sheets[(*key, graded.sitting)] if (*key, graded.sitting) in sheets else sheets[(*key, 0)]
        changed = {
            part: _edited_mark(graded.lines[part], self._lines[row.source]) for part, row in rows.items()
        }
        return graded._replace(lines={**graded.lines, **changed})


def _with_origins(issued: Issued, rows: Sequence[AnswerRow]) -> list[AnswerRow]:
    """Return the rows of a pool with their origins: a sheet with fewer rows than its variant has parts comes
    from a platform that asks part by part."""
    counts = Counter(_sheet_of(row) for row in rows)
    part_counts = {(e, str(seed)): len(record["parts"]) for (e, seed), record in issued.records.items()}

    def origin(row: AnswerRow) -> RowOrigin | None:
        is_apart = counts[_sheet_of(row)] < part_counts.get((row.exercise, row.seed), 0)
        return row.origin and row.origin._replace(apart=is_apart)

    return [row._replace(origin=origin(row)) for row in rows]


def _sheet_of(row: AnswerRow) -> tuple[Any, ...]:
    return folded(row.student), row.exercise, row.seed, row.origin


def _add_identity(issued: Issued, summary: Path) -> None:
    """Add the identifiers of the students of a pool without a roster, from the summary of the platform's
    report."""
    if not issued.has_roster and summary.exists():
        with open_csv(summary) as file:
            delimiter = delimiter_of(file.readline())
            file.seek(0)
            for row in csv.DictReader(file, delimiter=delimiter):
                cells = {as_written(title): as_written(cell) for title, cell in row.items() if title and cell}
                identifiers = {title: cell for title, cell in cells.items() if identifies(title)}
                issued.columns.setdefault(cells.get("student", ""), identifiers)


def _table(path: Path) -> Iterator[tuple[int, Mapping[str, str]]]:
    """Yield the lines that are not empty, with their numbers; the cells by column."""
    header: list[str] = []
    for number, row, _ in lines_of(path, None, MARKS_COLUMNS):
        if not any(row.values()):
            continue
        header = header or list(row)
        if missing := [c for c in _NEEDED if c not in header]:
            raise BadInput(
                "{file} needs the columns {needed}; {missing} missing, found {found}",
                file=path,
                needed=", ".join(_NEEDED),
                missing=", ".join(missing),
                found=(", ".join(filter(None, header)) or "nothing")[:200],
            )
        if len(row) < len(header):
            raise BadInput(
                "{file}, line {line}: {cells} cell{cells:|s} where the header has {most}",
                file=path,
                line=number,
                cells=len(row),
                most=len(header),
            )
        yield number, row


def _check_verdict(location: str, verdict: str) -> None:
    family = verdict.partition(":")[0]
    if family not in VERDICTS:
        raise BadInput(
            "{place}: no verdict {verdict!r}{nearest}",
            place=location,
            verdict=verdict[:40],
            nearest=nearest(family, VERDICTS),
        )


def _edited_mark(mark: Mark, line: _MarksLine) -> Mark:
    """Return the mark with the verdict, the points and the feedback of the file."""
    if typed_number(line.out_of) != float(f"{mark.out_of:g}"):
        raise BadInput(
            "{place}: {part} is out of {out_of:g} points, as issued; found out of {found!r}",
            place=line.location,
            part=mark.part,
            out_of=mark.out_of,
            found=line.out_of[:40],
        )
    points = mark.points
    if line.points.replace(",", ".") != f"{points:g}":
        points = typed_number(line.points)
        if not 0 <= points <= mark.out_of:
            raise BadInput(
                "{place}: points of {part} are a number from 0 to {out_of:g}; found {found!r}",
                place=line.location,
                part=mark.part,
                out_of=mark.out_of,
                found=line.points[:40],
            )
    says, feedback = mark.says, mark.feedback
    if line.feedback is not None and line.feedback != " ".join(mark.feedback.split()):
        says, feedback = _verbatim(line.feedback), line.feedback
    return mark._replace(verdict=line.verdict, points=points, says=says, feedback=feedback)


def _verbatim(text: str) -> str:
    """Return Markdown that prints a text unchanged."""
    return re.sub(r"([\\`*_\[\]<>$#])", r"\\\1", text)


def _rejected_before(path: Path) -> list[Rejected]:
    """Return the rejected rows of the previous marking."""
    if not path.exists():
        return []
    columns = [c for c in REJECTED_COLUMNS if c not in ("source", "reason")]
    return [
        Rejected(row.get("source", ""), row.get("reason", ""), {c: row.get(c, "") for c in columns})
        for row in rows_of(path)
    ]


def differs(machine: Graded, changed: Graded) -> Iterator[dict[str, Any]]:
    """Yield the lines of ``changes.csv``: the marks edited by hand."""
    for part in changed.answered:
        before, now = machine.lines[part], changed.lines[part]
        was, is_now = (before.verdict, f"{before.points:g}"), (now.verdict, f"{now.points:g}")
        if was != is_now:
            yield {
                "student": changed.student,
                "exercise": changed.exercise,
                "seed": changed.seed,
                "part": part,
                "sitting": changed.sitting,
                "answer": now.answer,
                "verdict_before": was[0],
                "verdict_now": is_now[0],
                "points_before": was[1],
                "points_now": is_now[1],
            }
