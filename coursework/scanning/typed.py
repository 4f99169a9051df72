"""Texts typed by people for unreadable answers: ``typed.csv``, to which each run adds."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from coursework.errors import BadInput, reason_of
from coursework.system.limits import MOST_TABLE_BYTES, check_size
from coursework.system.tables import as_written, csv_file, delimiter_of, duplicate_column, open_csv

COLUMNS = ("student", "exercise", "seed", "part", "coordinate", "answer", "seen")
_NEEDED = ("student", "exercise", "seed", "part", "answer")
NAME, PAGE = "(name)", "(page)"  #: in the place of an exercise: whose a paper is, and which page a picture is


class Typed(NamedTuple):
    """Text typed for one answer, or for one of its coordinates."""

    student: str
    exercise: str
    seed: str
    part: str
    coordinate: str  #: from 1; empty for an answer of one piece
    answer: str
    seen: str  #: the pages that were looked at, parted by spaces; empty for whatever there is

    @property
    def place(self) -> tuple[str, str, str, str, str]:
        return self.student, self.exercise, self.seed, self.part, self.coordinate or "1"

    @property
    def pages(self) -> frozenset[str]:
        return frozenset(self.seen.split())


def read_typed(path: Path) -> list[Typed]:
    """Return the typed texts in a file.

    Raises
    ------
    BadInput
        It cannot be read, or lacks a column.
    """
    return [_typed(row) for row in read_rows(path, _NEEDED, COLUMNS)]


def read_rows(path: Path, needed: Sequence[str], known: Sequence[str]) -> list[dict[str, str]]:
    """Return the rows of a table of a scan's folder, by the names of its columns.

    Parameters
    ----------
    path
        The file, a CSV.
    needed
        Columns that it must have.
    known
        Columns that may not stand there twice.

    Raises
    ------
    BadInput
        It cannot be read, or lacks a column.
    """
    try:
        check_size(str(path), path.stat().st_size, MOST_TABLE_BYTES)
        with open_csv(path) as file:
            lines = list(file)  # which end as CSV has it: an answer may hold other ends of lines
    except OSError as fault:
        raise BadInput("{path} cannot be read: {strerror}", path=path, strerror=reason_of(fault)) from fault
    if not lines:
        return []
    rows = csv.reader(lines, delimiter=delimiter_of(lines[0]))
    try:
        header = [cell.strip().casefold() for cell in next(rows, [])]
        if missing := [c for c in needed if c not in header]:
            raise BadInput(
                "{path}: the header must name {needed}; {missing} missing, found {header}",
                path=path,
                needed=", ".join(needed),
                missing=", ".join(missing),
                header=", ".join(header)[:80],
            )
        if twice := duplicate_column(header, known):
            raise BadInput("{path}: {twice}", path=path, twice=twice)
        return [
            dict(zip(header, map(as_written, row), strict=False))
            for row in rows
            if any(cell.strip() for cell in row)
        ]
    except csv.Error as fault:
        raise BadInput("{path} is not a CSV: {fault}", path=path, fault=fault) from fault


def _typed(values: Mapping[str, str]) -> Typed:
    fields = {c: values.get(c, "").replace("\0", "") for c in COLUMNS}
    stripped = {c: text if c == "answer" else text.strip() for c, text in fields.items()}
    return Typed(**stripped)


def merged(before: Iterable[Typed], more: Iterable[Typed]) -> list[Typed]:
    """Return the earlier and the new typed texts, sorted by place; a new one replaces an earlier one."""
    by_position = {text.place: text for text in (*before, *more)}
    return [by_position[position] for position in sorted(by_position)]


def typed_file(typed: Iterable[Typed]) -> bytes:
    """``typed.csv``."""
    return csv_file((text._asdict() for text in typed), COLUMNS)
