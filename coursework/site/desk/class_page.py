"""Table of a class: students by questions, totals and marks. A script updates the rows that change."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from starlette.responses import Response

from coursework.database.class_state import ClassState
from coursework.database.instructor_queries import Stamp, students_since
from coursework.database.permissions import Permission
from coursework.gradebook.book import Result
from coursework.gradebook.columns import own_columns
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.scale import mark_of
from coursework.issuing.students import folded
from coursework.language.numbers import localise
from coursework.marking.mark import Mark
from coursework.rendering.feedback import verdict_word
from coursework.site.desk.class_cache import class_here, class_page_of
from coursework.site.desk.question_cards import sign_of
from coursework.site.frame.requests import Request, Route
from coursework.site.frame.responses import redirect

SORTS = ("name", "total", "waits", "late", "tries")


class Cell(NamedTuple):
    """Answer in the table."""

    sign: str  #: full, part, none, wait, missing; empty if the question was not asked
    points: float
    verdict: str
    by_hand: bool


BLANK = Cell("", 0.0, "", False)


@dataclass(frozen=True)
class ClassRow:
    """Student in the table."""

    order: int  #: position in the class
    student: str
    identity: str
    cells: tuple[Cell, ...]
    points: float
    out_of: float
    mark: str
    tries: int
    late: int  #: seconds
    handed_in: bool

    @property
    def waits(self) -> int:
        return sum(cell.sign == "wait" for cell in self.cells)

    @property
    def minutes_late(self) -> int:
        return -(-self.late // 60)


def rows(now: ClassState) -> list[ClassRow]:
    """Return a row for every student of the class, in the order of the roster."""
    counted: dict[str, dict[tuple[str, str], Cell]] = {}
    for sheet, graded in now.graded.items():
        if graded.sitting == now.results[graded.student].sitting:
            counted.setdefault(graded.student, {}).update(_cells(now, now.machine[sheet], graded))
    return [
        _row(now, number, student, result, counted.get(student, {}))
        for number, (student, result) in enumerate(now.results.items())
    ]


def _cells(now: ClassState, machine: Graded, graded: Graded) -> dict[tuple[str, str], Cell]:
    return {
        (graded.exercise, part): Cell(
            sign_of(mark), mark.points, mark.verdict, _by_hand(machine.lines[part], mark)
        )
        for part, mark in graded.lines.items()
    }


def _by_hand(before: Mark, now: Mark) -> bool:
    return before is not now and (before.verdict, before.points) != (now.verdict, now.points)


def _row(
    now: ClassState, number: int, student: str, result: Result, cells: Mapping[tuple[str, str], Cell]
) -> ClassRow:
    columns = own_columns(now.issued, student)
    titles = (now.issued.assignment or {}).get("identity") or ()
    identity = " ".join(filter(None, (columns.get(folded(str(title)), "") for title in titles)))
    submitted = now.site_submissions.get(student)
    tries = (
        submitted.attempts
        if submitted
        else max((n for s, n in now.book.students if s == student), default=0)
        if cells
        else 0
    )
    return ClassRow(
        number, student, identity, tuple(cells.get(question, BLANK) for question in now.questions),
        result.points, result.out_of, mark_of(now.issued, result.counts, result.out_of),
        tries, submitted.late if submitted else 0, bool(cells) or submitted is not None,
    )  # fmt: skip


# ------------------------------------------------------------------------- pages


def class_page(request: Request) -> Response:
    """Return the table of the class."""
    now = class_here(request)
    table_rows = rows(now)
    sort, sought = request.query_params.get("sort", ""), request.query_params.get("find", "").strip()
    selected = sorted((row for row in table_rows if _matches(row, sought)), key=_sorting(now, sort))
    return class_page_of(
        request, now, "site/instructor/class", "class", rows=selected, all_rows=len(table_rows), sort=sort, sought=sought,
        handed_in=sum(row.handed_in for row in table_rows), has_mark=bool((now.issued.assignment or {}).get("mark")),
        has_late=any(row.late for row in table_rows), means=_means(now, table_rows), **_words(request),
    )  # fmt: skip


def news(request: Request) -> Response:
    """Return the rows that changed since a stamp; an empty response if none did."""
    now = class_here(request)
    before = Stamp.read(request.query_params.get("stamp", ""))
    if before == now.stamp:
        return Response(status_code=204)
    table_rows = rows(now)
    if (
        before is None
        or before.rules != now.stamp.rules
        or str(len(table_rows)) != request.query_params.get("rows")
    ):
        return redirect(f"/desk/{now.about.id}")
    with request.site.store.reading() as connection:
        changed = students_since(connection, now.about.id, before)
    return request.render(
        "site/instructor/_news", now=now, rows=[row for row in table_rows if row.student in changed], all_rows=len(table_rows),
        handed_in=sum(row.handed_in for row in table_rows), has_mark=bool((now.issued.assignment or {}).get("mark")),
        has_late=request.query_params.get("late") == "1" or any(row.late for row in table_rows), **_words(request),
    )  # fmt: skip


def _words(request: Request) -> dict[str, Any]:
    """Return the functions that format the cells of a table, with a cache since a table has thousands of
    cells."""
    verdicts: dict[str, str] = {}
    numbers: dict[float, str] = {}

    def word(verdict: str) -> str:
        if verdict not in verdicts:
            verdicts[verdict] = verdict_word(verdict, request.lang)
        return verdicts[verdict]

    def number(value: float) -> str:
        if value not in numbers:
            numbers[value] = localise(f"{round(value, 4):g}", request.lang)
        return numbers[value]

    return {"word": word, "number": number, "decimal": lambda text: localise(text, request.lang)}


def _matches(row: ClassRow, sought: str) -> bool:
    return folded(sought) in folded(f"{row.student} {row.identity}") if sought else True


def _sorting(now: ClassState, sort: str) -> Callable[[ClassRow], Any]:
    """Return the sort key of an order; students without a value are last."""
    by: dict[str, Callable[[ClassRow], Any]] = {
        "name": lambda row: folded(row.student),
        "total": lambda row: (-row.points, row.order),
        "waits": lambda row: (-row.waits, row.order),
        "late": lambda row: (-row.late, row.order),
        "tries": lambda row: (-row.tries, row.order),
    }
    if sort.isdecimal() and len(sort) < 5 and int(sort) < len(now.questions):
        column = int(sort)
        return lambda row: (row.cells[column].sign == "", row.cells[column].points, row.order)
    return by.get(sort, lambda row: row.order)


def _means(now: ClassState, table_rows: Sequence[ClassRow]) -> list[str]:
    """Return the mean of each question over the students who submitted, in percent of its points."""
    most: dict[tuple[str, str], float] = {}
    for (name, _), record in now.issued.records.items():
        most.update({(name, str(p["id"])): float(p["points"]) for p in record["parts"]})
    means = []
    for column, question in enumerate(now.questions):
        had = [row.cells[column].points for row in table_rows if row.cells[column].sign]
        means.append(f"{100 * sum(had) / (len(had) * most[question]):.0f}" if had else "")
    return means


ROUTES = (
    Route("/desk/{assignment:int}", class_page, Permission.MARKS_READ),
    Route("/desk/{assignment:int}/news", news, Permission.MARKS_READ),
)
