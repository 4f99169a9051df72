"""Table of a class: students by questions, totals and marks. A script updates the rows that change."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from starlette.responses import Response

from coursework.database.instructor_queries import Stamp, students_since
from coursework.database.permissions import Permission
from coursework.issuing.students import folded
from coursework.language.numbers import localise
from coursework.rendering.feedback import verdict_word
from coursework.site.desk.class_cache import class_page_of
from coursework.site.desk.class_table import ClassRow, ClassTable, table_here
from coursework.site.frame.paging import page_of
from coursework.site.frame.requests import Request, Route
from coursework.site.frame.responses import redirect

# ------------------------------------------------------------------------- pages


def class_page(request: Request) -> Response:
    """Return the table of the class."""
    now = table_here(request, request.path_params["assignment"])
    table_rows = now.rows
    sort, sought = request.query_params.get("sort", ""), request.query_params.get("find", "").strip()
    selected = sorted((row for row in table_rows if _matches(row, sought)), key=_sorting(now, sort))
    page = page_of(request, selected)
    return class_page_of(
        request,
        now,
        "site/instructor/class",
        "class",
        page=page,
        rows=page.rows,
        all_rows=len(table_rows),
        sort=sort,
        sought=sought,
        handed_in=sum(row.handed_in for row in table_rows),
        has_mark=now.has_mark,
        has_late=any(row.late for row in table_rows),
        means=now.means,
        **_words(request),
    )


def news(request: Request) -> Response:
    """Return the rows that changed since a stamp; an empty response if none did."""
    now = table_here(request, request.path_params["assignment"])
    before = Stamp.read(request.query_params.get("stamp", ""))
    if before == now.stamp:
        return Response(status_code=204)
    table_rows = now.rows
    if (
        before is None
        or before.rules != now.stamp.rules
        or str(len(table_rows)) != request.query_params.get("rows")
    ):
        return redirect(f"/desk/{now.about.id}")
    with request.site.store.reading() as connection:
        changed = students_since(connection, now.about.id, before)
    # A step on no single student may change every row; rows under codes are not named.
    if "" in changed or now.about.stated.get("anonymous"):
        return redirect(f"/desk/{now.about.id}")
    return request.render(
        "site/instructor/_news",
        now=now,
        rows=[row for row in table_rows if row.student in changed],
        all_rows=len(table_rows),
        handed_in=sum(row.handed_in for row in table_rows),
        has_mark=now.has_mark,
        has_late=request.query_params.get("late") == "1" or any(row.late for row in table_rows),
        **_words(request),
    )


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


def _sorting(now: ClassTable, sort: str) -> Callable[[ClassRow], Any]:
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


ROUTES = (
    Route("/desk/{assignment:int}", class_page, Permission.MARKS_READ, by_group=True),
    Route("/desk/{assignment:int}/news", news, Permission.MARKS_READ, by_group=True),
)
