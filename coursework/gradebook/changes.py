"""Changes of marks between two markings."""

from __future__ import annotations

import csv
import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from coursework.errors import BadInput, reason_of
from coursework.gradebook.columns import VERDICTS
from coursework.issuing.students import folded
from coursework.language.numbers import typed_number
from coursework.system.limits import check_size
from coursework.system.tables import as_written, delimiter_of, duplicate_column, open_csv

CHANGES_COLUMNS = (
    "date",
    "student",
    "exercise",
    "seed",
    "part",
    "answer",
    "verdict_before",
    "verdict_now",
    "points_before",
    "points_now",
    "mark_before",
    "mark_now",
)
_PLACE = ("student", "exercise", "seed", "part")
_TURN = ("verdict_before", "verdict_now", "points_before", "points_now")
_USUAL_MARK = 20  #: maximum of a mark if no assignment states one


def _number(text: str) -> float:
    """Return the points in a cell of a file that anybody may have edited, 0 in an empty one; NaN if there are
    none."""
    return typed_number(text or "0")


_ROUNDING = 1e-4  #: of points, as both tables print them
#: Verdicts that have a line in the marks for each in the summary.
_IN_BOTH = tuple(v for v in VERDICTS if v not in ("unreadable", "to_mark", "missing"))


def _count(digits: str) -> int:
    """Return a count; -1 if it has too many digits."""
    return int(digits) if len(digits) < 10 else -1


class EarlierMarks:
    """Marks of the previous marking."""

    def __init__(self, path: Path, renamed: Callable[[str], str] = str) -> None:
        self._marks: dict[str, tuple[str, str]] = {}
        self._names: dict[str, str] = {}  #: as they are written
        self._points: dict[tuple[str, str], float] = {}  #: by student and sitting
        self._verdicts: dict[tuple[str, str], Counter[str]] = {}
        self._renamed = renamed
        self.exists = path.exists()
        if self.exists:
            alike: dict[tuple[str, str], tuple[str, str]] = {}
            for row in rows_of(path):
                mark = (row.get("verdict", ""), row.get("points", "").replace(",", "."))
                row["student"] = renamed(row.get("student", ""))
                name = folded(row["student"])
                self._names.setdefault(name, row["student"])
                sitting = name, row.get("sitting", "")
                self._points[sitting] = self._points.get(sitting, 0.0) + _number(mark[1])
                self._verdicts.setdefault(sitting, Counter())[mark[0].partition(":")[0]] += 1
                self._marks[_answer_id(row)] = alike.setdefault(mark, mark)

    @property
    def students(self) -> tuple[str, ...]:
        """Students with marks, in the order of the file."""
        return tuple(self._names.values())

    def edited(self, summary: Path) -> bool:
        """Return True if the marks no longer agree with the summary that was written with them."""
        if not (self.exists and summary.exists()):
            return False
        in_summary: Counter[str] = Counter()
        in_marks: Counter[str] = Counter()
        others = {name for name, sitting in self._points if not sitting}
        for row in rows_of(summary):
            sitting = folded(self._renamed(row.get("student", ""))), row.get("sitting", "")
            others.discard(sitting[0])
            points = self._points.get(sitting, 0.0)
            in_marks.update(self._verdicts.get(sitting, ()))
            if not abs(_number(row.get("points", "")) - points) < _ROUNDING * max(1.0, points):
                return True
            in_summary.update({v: _count(row[v]) for v in _IN_BOTH if row.get(v, "").isdecimal()})
        return bool(others) or any(in_summary[verdict] != in_marks[verdict] for verdict in _IN_BOTH)

    def changed(self, row: Mapping[str, Any]) -> dict[str, Any] | None:
        """Return the change of a row of the new marks; None if there is none."""
        now = (row["verdict"], row["points"])
        before = self._marks.pop(_answer_id(row), ("", ""))
        return None if before == now else _change(row, before, now)

    def gone(self) -> Iterator[dict[str, Any]]:
        """Yield a change for each mark that no longer exists."""
        for key, before in self._marks.items():
            row = dict(zip((*_PLACE, "sitting"), key.split("\0"), strict=False))
            yield _change({**row, "student": self._names[row["student"]], "answer": ""}, before, ("", ""))


class History:
    """Changes of earlier markings of a folder, to which the new ones are added.

    Each has its day, and the student's mark of the summary before and now, out of 20 where no assignment
    states a scale. Of marks with adjustments those are listed too that changed without an answer.
    """

    def __init__(
        self, folder: Path, day: str, renamed: Callable[[str], str] = str, *, is_adjusted: bool = False
    ) -> None:
        self._is_adjusted = is_adjusted
        path, summary = folder / "changes.csv", folder / "summary.csv"
        self._day = day
        earlier = [_plain_row(row) for row in rows_of(path)] if path.exists() else []
        self._earlier = [{**row, "student": renamed(row["student"])} for row in earlier]
        self._last = {_answer_id(row): row for row in self._earlier}
        before = rows_of(summary) if summary.exists() else ()
        self._marks = _marks_in({**row, "student": renamed(row.get("student", ""))} for row in before)
        self._new: list[dict[str, Any]] = []

    def add(self, change: dict[str, Any]) -> None:
        """Add a change, unless the last change of that answer is the same: an interrupted marking has written
        it already."""
        last = self._last.get(_answer_id(change))
        if last is None or any(last[column] != str(change[column]) for column in _TURN):
            self._new.append(change)

    def rows(self, summary: Sequence[Mapping[str, Any]]) -> Iterator[dict[str, Any]]:
        """Yield all changes, the earlier first; ``summary`` contains the rows of the new summary."""
        marks = _marks_in(summary)
        yield from self._earlier
        for change in self._new:
            student = folded(change["student"])
            marks_columns = {"mark_before": self._marks.get(student, ""), "mark_now": marks.get(student, "")}
            yield {"date": self._day, **change, **marks_columns}
        listed = {folded(change["student"]) for change in self._new}
        for row in summary:  # a question or the scale changed, and no answer
            student = folded(str(row.get("student", "")))
            before, now = self._marks.get(student), marks.get(student, "")
            if self._is_adjusted and student not in listed and before not in (None, now):
                cells = {"date": self._day, "student": row["student"], "mark_before": before, "mark_now": now}
                yield {**dict.fromkeys(CHANGES_COLUMNS, ""), **cells}


def _plain_row(row: Mapping[str, str]) -> dict[str, str]:
    """Return an earlier row, its numbers with a decimal point; missing columns are empty."""
    plain = {column: row.get(column, "") for column in CHANGES_COLUMNS}
    for column in ("points_before", "points_now", "mark_before", "mark_now"):
        plain[column] = plain[column].replace(",", ".")
    return plain


def _marks_in(summary: Iterable[Mapping[str, Any]]) -> dict[str, str]:
    """Return the marks of a summary by student."""
    marks = {}
    for row in summary:
        if not (mark := str(row.get("mark", "")).replace(",", ".")):
            points, out_of = _number(str(row.get("points", ""))), _number(str(row.get("out_of", "")))
            mark = f"{_USUAL_MARK * points / out_of:.4g}" if out_of > 0 and math.isfinite(points) else ""
        marks[folded(str(row.get("student", "")))] = mark
    return marks


def _answer_id(row: Mapping[str, Any]) -> str:
    """Return the key of the answer of a row of marks: one text, to save memory in large classes."""
    student, *rest = (str(row.get(c, "")) for c in _PLACE)
    sitting = str(row.get("sitting", ""))
    return "\0".join((folded(student), *rest, *([sitting] if sitting not in ("", "1") else [])))


def _change(row: Mapping[str, Any], before: tuple[str, str], now: tuple[str, str]) -> dict[str, Any]:
    return {
        **{c: row[c] for c in (*_PLACE, "answer")},
        "sitting": row.get("sitting", ""),
        "verdict_before": before[0],
        "verdict_now": now[0],
        "points_before": before[1],
        "points_now": now[1],
    }


def rows_of(path: Path) -> Iterator[dict[str, str]]:
    """Return the rows of a table, by the names of its columns."""
    return (row for _, row, _ in lines_of(path))


def lines_of(
    path: Path, most: int | None = None, once: Sequence[str] = ()
) -> Iterator[tuple[int, dict[str, str], list[str]]]:
    """Yield the rows of a table, each with its line number and the cells without a heading. ``most`` limits
    the size of the file in bytes.

    Raises
    ------
    BadInput
        The file cannot be read, or is larger, or names one of the columns ``once`` twice.
    """
    try:
        if most is not None:
            check_size(str(path), path.stat().st_size, most)
        with open_csv(path) as file:
            delimiter = delimiter_of(next(filter(str.strip, file), ""))
            file.seek(0)
            reader = csv.DictReader(file, delimiter=delimiter)
            reader.fieldnames = next((row for row in reader.reader if any(map(str.strip, row))), [])
            if twice := duplicate_column(reader.fieldnames, once):
                raise BadInput("{file}: {problem}", file=path, problem=twice)
            cells: dict[Any, Any]
            for cells in reader:
                more = cells.pop(None, [])
                row = {
                    as_written((k or "").strip()).casefold(): as_written(v.strip())
                    for k, v in cells.items()
                    if isinstance(v, str)
                }
                further = sum(len(cell.splitlines()) - 1 for cell in row.values() if cell)
                yield reader.line_num - further, row, more
    except OSError as fault:
        raise BadInput("{file} cannot be read: {problem}", file=path, problem=reason_of(fault)) from fault
    except csv.Error as fault:
        raise BadInput("{file} is not CSV: {problem}", file=path, problem=fault) from fault
