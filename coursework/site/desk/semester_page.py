"""Marks of a semester on one page: all assignments that the user marks, their weights, and the weighted
averages."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import NamedTuple
from urllib.parse import urlencode

from starlette.responses import Response

from coursework.database.areas import group_of, groups_known
from coursework.database.instructor_queries import AssignmentOverview
from coursework.database.permissions import Permission, group_key
from coursework.errors import BadInput
from coursework.gradebook import semester
from coursework.gradebook.class_points import Scored
from coursework.gradebook.presence import PRESENT
from coursework.gradebook.semester import Assessed, SemesterLine
from coursework.issuing.identity import identifies
from coursework.issuing.students import folded
from coursework.language.numbers import localise, typed_number
from coursework.language.words import words
from coursework.site.desk.class_cache import CLASS_GROUP, assignments_marked
from coursework.site.desk.class_table import ClassTable, class_tables
from coursework.site.desk.files import spreadsheet_of
from coursework.site.frame.paging import page_of
from coursework.site.frame.requests import Request, Route
from coursework.site.frame.responses import Download
from coursework.system.tables import csv_file

_WEIGHT, _ABSENT = "weight.", "absent"
_MOST_WEIGHT = 1000.0


class WeighedAssignment(NamedTuple):
    """Assignment with its weight, as the form shows it."""

    id: int
    name: str
    title: str
    weight: str
    is_hidden: bool = False  #: its names are hidden as long as an answer waits


class SemesterTable(NamedTuple):
    """Semester as the query states it."""

    assignments: Sequence[WeighedAssignment]
    read: Sequence[Assessed]
    lines: Sequence[SemesterLine]
    absence: str
    groups: dict[str, str]
    group: str


def semester_page(request: Request) -> Response:
    """Return the page of the semester."""
    table = _table(request)
    sign = "," if request.lang == "fr" else "."
    lines = [*semester.rows(table.lines, table.read, table.absence, sign)]
    averages = [semester.average(line, table.read, table.absence) for line in table.lines]
    found = [float(average) for average in averages if average is not None]
    page = page_of(request, lines, lambda row: f"{row['student']} {row['number']}")
    often = Counter(one.title for one in table.assignments)
    titles = {
        one.name: one.title if often[one.title] == 1 else f"{one.title} ({one.name})"
        for one in table.assignments
    }
    for row, line in zip(lines, table.lines, strict=True):
        row["status"] = _status(request, titles, semester.unsettled(line, table.read))
    return request.render(
        "site/instructor/semester",
        table=table,
        page=page,
        rows=page.rows,
        titles=titles,
        worths=semester.WORTH,
        columns=semester.columns_of(table.lines, table.read),
        class_groups=lambda: table.groups,
        class_group=table.group,
        mean=localise(f"{sum(found) / len(found):.2f}", request.lang) if found else "",
        of=semester.OF,
        query=_query(request),
        number=lambda cell: (
            localise(f"{cell:.10g}", request.lang) if isinstance(cell, (int, float)) else cell
        ),
    )


def _status(request: Request, titles: Mapping[str, str], unsettled: Mapping[str, Sequence[str]]) -> str:
    """Return what keeps a line from being final in the words of the page: ``absent: Midterm``."""
    texts, colon = request.words["semester"]["results"], words(request.lang)["sheet"]["colon"]
    parts = (
        f"{texts[s]}{colon} {', '.join(map(titles.__getitem__, names))}" for s, names in unsettled.items()
    )
    return "; ".join(parts) or str(texts[semester.FINAL])


def semester_file(request: Request) -> Response:
    """Return the semester as a table, as ``coursework semester`` writes it."""
    table, spreadsheet = _table(request), spreadsheet_of(request)
    rows = semester.rows(table.lines, table.read, table.absence, spreadsheet.decimal)
    data = csv_file(rows, semester.columns_of(table.lines, table.read), spreadsheet)
    return Download(data, "text/csv; charset=utf-8", "semester.csv")


def _query(request: Request) -> str:
    """Return what the query chooses, for the file."""
    items = request.query_params.multi_items()
    return urlencode([(k, text) for k, text in items if k.startswith(_WEIGHT) or k in (_ABSENT, CLASS_GROUP)])


def _table(request: Request) -> SemesterTable:
    """Return the semester that the query states. Raises BadInput: a weight is not a number."""
    absence = request.query_params.get(_ABSENT, semester.WORTH[0])
    group = group_key(request.query_params.get(CLASS_GROUP, ""))
    with request.site.store.reading() as connection:
        theirs = assignments_marked(request, connection)[::-1]
        groups = groups_known(connection)
    weights = {about.id: _weight(request, about) for about, _ in theirs}
    tables = class_tables(request.site, [about for about, _ in theirs if weights[about.id]])
    assignments, read = [], []
    for about, students in theirs:
        table, weight = tables.get(about.id), weights[about.id]
        is_hidden = table is not None and bool(about.stated.get("anonymous")) and table.waiting > 0
        text = localise(f"{weight:g}", request.lang) if weight else ""
        title = about.title(request.lang)
        assignments.append(WeighedAssignment(about.id, about.name, title, text, is_hidden))
        if table is not None and not is_hidden:
            read.append(_assessed(table, students, weight))
    semester.check_names(read)
    lines = semester.semester(read)
    groups = {
        key: name for key, name in groups.items() if any(group_key(line.group) == key for line in lines)
    }
    if group:
        lines = [line for line in lines if group_key(line.group) == group]
    absence = absence if absence in semester.WORTH else semester.WORTH[0]
    return SemesterTable(assignments, read, lines, absence, groups, group)


def _weight(request: Request, about: AssignmentOverview) -> float:
    """Return the weight of an assignment: as stated, 0 for none; before anything is stated, 1 for what was
    answered."""
    params = request.query_params
    if not any(name.startswith(_WEIGHT) for name in params):
        return 1.0 if about.last is not None else 0.0
    text = params.get(f"{_WEIGHT}{about.id}", "").strip()
    weight = typed_number(text) if text else 0.0
    if not (math.isfinite(weight) and 0 <= weight <= _MOST_WEIGHT):
        raise BadInput(request.words["semester"]["no_weight"].format(text[:20]))
    return weight


def _assessed(table: ClassTable, students: frozenset[str] | None, weight: float) -> Assessed:
    """Return the marks of a class, or of some of its students."""
    scored, groups, handed_in = [], {}, {}
    roster: Mapping[str, Mapping[str, str]] = json.loads(table.about.columns or "{}")
    for row in table.rows:
        if students is not None and row.student not in students:
            continue
        columns = roster.get(row.student, {})
        ids = tuple((title, value) for title, value in columns.items() if value and identifies(title))
        percent = 100 * row.counts / row.out_of if row.out_of else 0.0
        points = (row.mark or "0") if table.of else f"{percent:.10g}"
        scored.append(
            Scored(row.student, ids, points, "", row.has_answered, str(row.open or ""), row.presence)
        )
        groups[folded(row.student)] = group_of(columns)
        if row.on_site:
            handed_in[folded(row.student)] = PRESENT
    return Assessed(table.about.name, weight, scored, table.of or 100.0, groups, handed_in)


ROUTES = (
    Route("/desk/semester", semester_page, Permission.MARKS_READ),
    Route("/desk/semester.csv", semester_file, Permission.MARKS_EXPORT),
)
