"""Marks of a class as columns, read from its tables."""

from __future__ import annotations

import csv
from array import array
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from operator import itemgetter
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from coursework.errors import BadInput, counted, first_few, reason_of
from coursework.gradebook.columns import PRESENCE, SITTING, VERDICTS
from coursework.gradebook.presence import AWAY
from coursework.messages import Message
from coursework.system.links import check_inside
from coursework.system.tables import as_written, delimiter_of, duplicate_column, open_csv

MOST_POINTS = 1e9  #: more is not a number of points

_MARKS = ("student", "exercise", "part", "verdict", "points", "out_of")
_REJECTED = ("source", "reason")
_SUMMARY = ("student", "unreadable", "out_of", "missing")


# ---------------------------------------------------------------------- reading


@dataclass(frozen=True)
class Marks:
    """Lines of ``marks.csv`` as columns, each of shape (lines,), with the data of the other files."""

    students: tuple[str, ...]  #: those with a line, then those of the summary without
    parts: tuple[tuple[str, str], ...]  #: exercise and part
    verdicts: tuple[str, ...]
    student: np.ndarray  #: index into students
    part: np.ndarray  #: index into parts
    verdict: np.ndarray  #: index into verdicts
    points: np.ndarray
    out_of: np.ndarray
    issued: np.ndarray  #: points that each student could have, shape (students,)
    without_line: int  #: answers asked for that no line holds
    rejected: int  #: rows that could not be marked
    unread: int  #: students who handed in, and nothing that could be marked

    @property
    def exercises(self) -> tuple[str, ...]:
        """Names of the exercises, in order of appearance."""
        return tuple(dict.fromkeys(exercise for exercise, _ in self.parts))


class _Numbered(dict):
    """Numbering of texts in order of appearance."""

    def __missing__(self, key: Any) -> int:
        self[key] = number = len(self)
        return number


class _Decimals(dict):
    """Conversion of texts to points, each text read once; a decimal comma is accepted, as some spreadsheets
    write it."""

    def __missing__(self, text: str) -> float:
        value = float(text.strip().replace(",", "."))
        if not abs(value) <= MOST_POINTS:
            raise ValueError(text)
        self[text] = value
        return value


def read(folder: Path) -> Marks:
    """Read a folder of marks: ``marks.csv``, and ``summary.csv`` and ``rejected.csv`` if they are there.

    Points come from ``marks.csv`` alone, so that a mark mended by hand there counts. Questions that do not
    count, out of 0, are left out. Of a student with several sittings the one counts that the summary names.

    Raises
    ------
    BadInput
        No ``marks.csv``, a column that is missing, or a line that holds no mark.
    """
    path = folder / "marks.csv"
    for name in ("marks.csv", "summary.csv", "rejected.csv"):
        check_inside(folder / name, folder)
    if not path.is_file():
        raise _no_marks(folder)
    decimals = _Decimals()
    lines = _Columns(line for line in _counting(folder, decimals) if line[5] != 0)
    _check_verdicts(path, lines.verdicts)
    if lines.out_of and min(lines.out_of) < 0:
        raise BadInput(
            "{path}: a line is out of {out_of:g} points; every part must have some",
            path=path,
            out_of=min(lines.out_of),
        )
    rejected = folder / "rejected.csv"
    count = sum(1 for _ in _lines(rejected, _REJECTED)) if rejected.is_file() else 0
    return lines.marks(_summary(folder / "summary.csv", decimals), count)


Line = tuple[str, str, str, str, float, float]  #: student, exercise, part, verdict, points, out of


class StudentSummary(NamedTuple):
    """Summary of a student."""

    out_of: float
    missing: int  #: answers
    unreadable: bool  #: something of theirs could not be read
    is_away: bool = False  #: absent or excused, where somebody stated it


def marks_of(lines: Iterable[Line], entries: Mapping[str, StudentSummary], rejected: int = 0) -> Marks:
    """Return the columns of a class's marks, with the summary of each student; without lines that are out of
    nothing."""
    return _Columns(line for line in lines if line[5] > 0).marks(entries, rejected)


class _Columns:
    """Lines of marks as columns."""

    def __init__(self, lines: Iterable[Line]):
        self.students, self.parts, self.verdicts = _Numbered(), _Numbered(), _Numbered()
        self.student, self.part, self.verdict = (array("i") for _ in range(3))
        self.points, self.out_of = array("d"), array("d")
        for subject, exercise, requested, judged, got, of in lines:
            self.student.append(self.students[subject])
            self.part.append(self.parts[exercise, requested])
            self.verdict.append(self.verdicts[judged])
            self.points.append(got)
            self.out_of.append(of)

    def marks(self, entries: Mapping[str, StudentSummary], rejected: int) -> Marks:
        """Return the marks, with the summaries."""
        student, part, verdict = (
            np.array(c, dtype=np.int64) for c in (self.student, self.part, self.verdict)
        )
        blank = np.array([family_of(v) == "missing" for v in self.verdicts], dtype=bool)
        # The form of the class has a line for whoever is away, too.
        stated = [name in entries and entries[name].is_away for name in self.students]
        away = np.array(stated, dtype=bool)
        away[student[~blank[verdict]]] = False
        students, kept = _Numbered(), ~away[student]
        for name, is_away in zip(self.students, away.tolist(), strict=True):
            if not is_away:
                students[name]
        marked = len(students)
        student, part, verdict = (np.cumsum(~away) - 1)[student[kept]], part[kept], verdict[kept]
        points, out_of = (np.array(c, dtype=float)[kept] for c in (self.points, self.out_of))
        entries = {name: entry for name, entry in entries.items() if not entry.is_away or name in students}
        unread = [name for name, entry in entries.items() if entry.unreadable]
        for name in entries:
            students[name]
        issued = np.bincount(student, out_of, minlength=len(students))
        issued = np.maximum(issued, [entries[s].out_of if s in entries else 0.0 for s in students])
        asked_blank = sum(entry.missing for entry in entries.values())
        without_line = max(0, asked_blank - int(np.count_nonzero(blank[verdict])))
        return Marks(
            tuple(students),
            tuple(self.parts),
            tuple(self.verdicts),
            student,
            part,
            verdict,
            points,
            out_of,
            issued,
            without_line if entries else 0,
            rejected,
            sum(1 for name in unread if students[name] >= marked),
        )


def unlike_summary(folder: Path, marks: Marks) -> list[str]:
    """Return the students whose points in the marks differ from those of the summary, edited by hand in one
    of the two."""
    path = folder / "summary.csv"
    if not path.is_file() or "points" not in _header(path):
        return []
    sums = np.bincount(marks.student, marks.points, minlength=len(marks.students))
    results = dict(zip(marks.students, sums.tolist(), strict=True))
    text = list(_lines(path, ("student", "points", "out_of"), _Decimals()))
    unlike = {n for n, points, _ in text if abs(results.get(n, 0.0) - points) > 1e-5 * max(1.0, points)}
    if unlike:  # points of a bonus are not points of a question
        results = dict.fromkeys(unlike, 0.0)
        for name, _, _, _, points, _ in _counting(folder, _Decimals()):
            if name in unlike:
                results[name] += points
    return [
        name
        for name, points, _ in text
        if name in unlike and abs(results[name] - points) > 1e-5 * max(1.0, points)
    ]


def _counting(folder: Path, decimals: _Decimals) -> Iterator[tuple[Any, ...]]:
    """Yield the lines of the marks; for a student with several sittings only those of the one that counts."""
    path, summary = folder / "marks.csv", folder / "summary.csv"
    if not (summary.is_file() and SITTING in _header(path) and SITTING in _header(summary)):
        yield from _lines(path, _MARKS, decimals)
        return
    counts = dict(_lines(summary, ("student", SITTING)))
    for sitting, subject, *mark in _lines(path, (SITTING, *_MARKS), decimals):
        if counts.get(subject, sitting) == sitting:
            yield subject, *mark


def _header(path: Path) -> list[str]:
    try:
        with open_csv(path) as file:
            line = file.readline()
    except OSError as fault:
        raise BadInput("{path} cannot be read: {strerror}", path=path, strerror=reason_of(fault)) from fault
    return [name.strip().strip('"').casefold() for name in line.split(delimiter_of(line))]


def _summary(path: Path, decimals: _Decimals) -> dict[str, StudentSummary]:
    """Return the summary of each student."""
    if not path.is_file():
        return {}
    away = dict(_lines(path, ("student", PRESENCE))) if PRESENCE in _header(path) else {}
    return {
        name: StudentSummary(
            out_of, round(missing), unreadable.strip() not in ("", "0"), away.get(name) in AWAY
        )
        for name, unreadable, out_of, missing in _lines(path, _SUMMARY, decimals)
    }


def _no_marks(folder: Path) -> BadInput:
    if folder.is_file():
        return BadInput(
            "{folder} is a file; give the folder written by 'coursework grade', with marks.csv in it",
            folder=folder,
        )
    if not folder.is_dir():
        return BadInput(
            "there is no folder {folder}; give the one written by 'coursework grade'", folder=folder
        )
    results = sorted(p.name for p in folder.iterdir())
    found = Message("found {names}", names=first_few(results, 6)) if results else Message("it is empty")
    below = sorted(p.parent for p in folder.glob("*/marks.csv"))
    would_do = (
        Message("did you mean {inside}?", inside=below[0])
        if below
        else Message("give the folder written by 'coursework grade'")
    )
    return BadInput(
        "{folder} contains no marks.csv ({found}); {would_do}", folder=folder, found=found, would_do=would_do
    )


def _check_verdicts(path: Path, verdicts: Mapping[str, int]) -> None:
    for verdict in verdicts:
        if family_of(verdict) not in VERDICTS:
            raise BadInput(
                "{path}: no verdict {verdict!r}; available: {verdicts}",
                path=path,
                verdict=verdict[:40],
                verdicts=", ".join(VERDICTS),
            )


def family_of(verdict: str) -> str:
    return verdict.partition(":")[0]


def columns_of(path: Path, columns: Sequence[str]) -> Iterator[tuple[str, ...]]:
    """Return the named columns of a table of marks, line by line, as texts.

    Raises
    ------
    BadInput
        A column that is missing, or a line that lacks cells.
    """
    return _lines(path, columns)


def _lines(
    path: Path, columns: Sequence[str], decimals: _Decimals | None = None
) -> Iterator[tuple[Any, ...]]:
    """Yield the named columns of a CSV, line by line; with ``decimals``, the last two of them as floats."""
    try:
        with open_csv(path) as file:
            delimiter = delimiter_of(file.readline())
            file.seek(0)
            reader = csv.reader(file, delimiter=delimiter)
            places = _places(path, next(reader, []), columns)
            named = itemgetter(*places)
            for cells in reader:
                try:
                    row = named(cells)
                    row = tuple(map(as_written, row)) if any("'" in cell for cell in row) else row
                    yield row if decimals is None else (*row[:-2], decimals[row[-2]], decimals[row[-1]])
                except (IndexError, ValueError) as fault:
                    if any(c.strip() for c in cells):
                        raise _bad_line(path, reader.line_num, cells, columns, fault) from fault
    except OSError as fault:
        raise BadInput("{path} cannot be read: {strerror}", path=path, strerror=reason_of(fault)) from fault
    except csv.Error as fault:
        raise BadInput("{path} is not CSV: {fault}", path=path, fault=fault) from fault


def _places(path: Path, header: Sequence[str], columns: Sequence[str]) -> list[int]:
    names = [h.strip().casefold() for h in header]
    missing = [c for c in columns if c not in names]
    if missing:
        result = ", ".join(n[:30] for n in names if n) or "nothing"
        raise BadInput(
            "{path} needs the columns {columns}; {missing} missing, found {result}; 'coursework grade' "
            "writes them",
            path=path,
            columns=", ".join(columns),
            missing=", ".join(missing),
            result=result,
        )
    if twice := duplicate_column(header, columns):
        raise BadInput("{path}: {twice}", path=path, twice=twice)
    return [names.index(c) for c in columns]


def _bad_line(
    path: Path, line: int, cells: Sequence[str], columns: Sequence[str], fault: Exception
) -> BadInput:
    if isinstance(fault, IndexError):
        return BadInput(
            "{path}, line {line}: {cells}, too few for {columns}",
            path=path,
            line=line,
            cells=counted(len(cells), "cell"),
            columns=", ".join(columns),
        )
    return BadInput(
        "{path}, line {line}: {first} and {second} must be numbers up to {most:g}; found {found!r}",
        path=path,
        line=line,
        first=columns[-2],
        second=columns[-1],
        most=MOST_POINTS,
        found=",".join(cells)[:60],
    )
