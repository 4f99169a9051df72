"""Command of a semester: semester."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import click

from coursework.cli.options import DONE, FILE, FOUND, decimal_option, json_option
from coursework.cli.printing import print_json, say, warn
from coursework.errors import BadInput, counted

_STATED = re.compile(r"(?:(?P<name>[^=/\\]+)=)?(?P<folder>.+?)(?::(?P<weight>\d+(?:[.,]\d+)?))?")


@click.command()
@click.argument("assignments", nargs=-1, required=True, metavar="[NAME=]MARKS[:WEIGHT]…")
@click.option("--out", type=FILE, default="semester.csv", show_default=True, help="File to write.")
@click.option(
    "--absent",
    type=click.Choice(("none", "zero", "excused")),
    default="none",
    show_default=True,
    help=(
        "What an absence is worth: none, there is no average; zero; excused, it is left out with its "
        "weight, as excused "
        "absences always are."
    ),
)
@decimal_option
@json_option
def semester(assignments: Sequence[str], out: Path, absent: str, decimal: str, as_json: bool) -> int:
    """Write the marks of all assignments of a semester into one table, with weighted averages out of 20.

    MARKS is a folder made by grade, or the folder of the build above it, with the weight of the assignment
    behind it: midterm:1 final:2. A mark that may still change has a star. Absent is who handed in nothing,
    unless attendance.csv beside the marks says otherwise.
    """
    from coursework.gradebook import semester as table
    from coursework.gradebook.presence import ABSENT
    from coursework.system.tables import SPREADSHEETS, csv_file
    from coursework.system.writing import write_whole

    read = [table.assessed(*_stated(text)) for text in assignments]
    table.check_names(read)
    lines = table.semester(read)
    rows = list(table.rows(lines, read, absent, "." if as_json else SPREADSHEETS[decimal].decimal))
    columns = table.columns_of(lines, read)
    if as_json:
        print_json([{column: row[column] for column in columns} for row in rows])
    else:
        write_whole(out, csv_file(rows, columns, SPREADSHEETS[decimal]))
        say("{students} in {out}", students=counted(len(rows), "student"), out=out)
    statuses = [table.unsettled(line, read) for line in lines]
    waiting = sum(table.PROVISIONAL in status for status in statuses)
    absences = sum(ABSENT in status for status in statuses)
    if absences:
        warn("{students} with an absence", students=counted(absences, "student"))
    if waiting:
        warn("{students} with a provisional mark, starred", students=counted(waiting, "student"))
    return FOUND if waiting else DONE


def _stated(text: str) -> tuple[Path, float, str]:
    """Return the folder, the weight and the name of ``midterm=week7/marks:2``."""
    match = _STATED.fullmatch(text)
    weight = float(((match and match["weight"]) or "1").replace(",", "."))
    if match is None or not 0 < weight < 1e6:
        raise BadInput(
            "{found!r}: name a folder of marks and a weight above 0, such as midterm/marks:2", found=text[:60]
        )
    return Path(match["folder"]), weight, (match["name"] or "").strip()
