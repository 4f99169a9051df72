"""Points of a class from the ``summary.csv`` of its marks, with the identifiers of each student."""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from coursework.errors import BadInput, nearest
from coursework.gradebook.changes import rows_of
from coursework.gradebook.columns import LATE, PRESENCE, PROVISIONAL, VERDICTS
from coursework.gradebook.marks_record import read_record
from coursework.gradebook.presence import PRESENT
from coursework.gradebook.scale import exact
from coursework.issuing.identity import Ids, identifies
from coursework.language.numbers import typed_number
from coursework.system.links import check_inside

SCORES = ("points", "mark", "percent")


class Scored(NamedTuple):
    """Points of one student."""

    name: str
    ids: Ids
    points: str  #: as in the file, with a decimal point
    out_of: str  #: of which they are; empty of what has its own scale
    has_answered: bool = True
    open: str = ""  #: number of answers that wait for a person; until then the points are provisional
    presence: str = ""  #: where somebody stated it

    @property
    def is_marked(self) -> bool:
        """True if the points are a mark: something was answered, or somebody present answered nothing."""
        return self.has_answered or self.presence == PRESENT

    def of(self, most: float | None) -> str:
        """Return the points scaled to another total, rounded half up to hundredths; unchanged if the total is
        the same or unknown."""
        if most is None or not self.out_of or exact(typed_number(self.out_of)) == exact(most):
            return self.points
        total = exact(typed_number(self.out_of))
        hundredths = (
            math.floor(exact(typed_number(self.points)) * exact(most) * 100 / total + Fraction(1, 2))
            if total
            else 0
        )
        return f"{hundredths / 100:.10g}"


def class_points(marks: Path, score: str) -> list[Scored]:
    """Return the students of a folder of marks, or of its ``summary.csv``.

    Raises
    ------
    BadInput
        There is none, or a line of it holds no number.
    """
    path = marks / "summary.csv" if marks.is_dir() else marks
    if path != marks:
        check_inside(path, marks)
    if not path.is_file():
        raise BadInput("no {file}: name the folder of marks that 'coursework grade' wrote", file=path)
    if (record := read_record(path.parent)) and record.by_codes:
        raise BadInput(
            "{file}: students go by codes; 'coursework grade … --names' puts names in place of them "
            "once nothing waits",
            file=path,
        )
    scored = list(_scored(path, score))
    if not scored:
        raise BadInput("{file} has no student", file=path)
    return scored


def _scored(path: Path, score: str) -> Iterator[Scored]:
    for number, row in enumerate(rows_of(path), start=2):
        if score not in row or "student" not in row or "out_of" not in row:
            columns = [name for name in SCORES if name in row]
            raise BadInput(
                "{file} has no column {score!r}{nearest}; 'coursework grade' writes it",
                file=path,
                score=score,
                nearest=nearest(score, columns),
            )
        points, out_of, cells = (row.get(c, "").replace(",", ".") for c in (score, "out_of", LATE))
        for column, text in ((score, points), ("out_of", out_of), (LATE, cells)):
            if text and not math.isfinite(typed_number(text)):
                raise BadInput(
                    "{file}, line {number}: {column} of {student} must be a number; found {found!r}",
                    file=path,
                    number=number,
                    column=column,
                    student=row["student"],
                    found=text[:40],
                )
        if score == "points" and (late := typed_number(cells or "0")):
            points = f"{float(exact(typed_number(points)) - exact(late)):.10g}"
        if not points and score != "points":
            points = "0"
        if math.isnan(typed_number(points)):
            raise BadInput(
                "{file}, line {number}: {column} of {student} must be a number; found {found!r}",
                file=path,
                number=number,
                column=score,
                student=row["student"],
                found=points[:40],
            )
        ids = tuple((title, value) for title, value in row.items() if value and identifies(title))
        total = {"points": out_of, "percent": "100"}.get(score, "")
        answered = any(row.get(verdict, "0") != "0" for verdict in VERDICTS if verdict != "missing")
        yield Scored(
            row["student"], ids, points, total, answered, row.get(PROVISIONAL, ""), row.get(PRESENCE, "")
        )
