"""Cache of the current state of a class: append-only rows are read once, and a stamp tells if there are new
ones."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from datetime import timedelta
from functools import cache, partial
from threading import Lock, RLock
from typing import Any
from urllib.parse import urlencode
from weakref import WeakKeyDictionary

from sqlalchemy import Connection
from starlette.responses import Response

from coursework.course.course import Course
from coursework.database.areas import group_names, students_in, students_within
from coursework.database.assignments import issued_of
from coursework.database.class_state import ClassState
from coursework.database.current_marks import last_markings, lines_of, machine_marks
from coursework.database.decisions import read_decisions
from coursework.database.instructor_queries import (
    AssignmentOverview,
    Stamp,
    listed_assignments,
    placings,
    site_submissions_of,
    stamp,
    unmarked,
)
from coursework.database.permissions import Permission, group_key, groups_within
from coursework.database.publication import late_penalties
from coursework.database.store import Store
from coursework.database.submissions import rows_of
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.placing import placed_sheets
from coursework.gradebook.waiting import (
    Measure,
    measures,
)
from coursework.issuing.issued import Issued
from coursework.site.frame.requests import HTTPException, Request
from coursework.site.frame.settings import Site
from coursework.site.papers.submission import mark, pass_dates
from coursework.system.garbage import paused_collection

_SHEET = 11_000  #: bytes of a marked sheet with its record, as measured
_MOST = 120_000_000  #: bytes of the classes of a process, besides the one that is asked for
_MARKING = timedelta(minutes=1)  #: after which another process may mark a submission that one began to mark


# ------------------------------------------------------------------------ at hand


@dataclass
class _ClassCache:
    """Cached data of an assignment."""

    lock: Any = field(default_factory=RLock)
    now: ClassState | None = None
    marked: dict[int, Graded | str] = field(default_factory=dict)  #: by the id of the marking
    measured: dict[int, Measure] = field(default_factory=dict)


_class_caches: WeakKeyDictionary[Store, OrderedDict[int, _ClassCache]] = WeakKeyDictionary()
_lock = Lock()


def class_now(site: Site, assignment_id: int) -> ClassState:
    """Return the current state of a class, after saved answers of a closed assignment are submitted and all
    new sheets are marked.

    Raises
    ------
    HTTPException
        There is no such assignment.
    """
    pass_dates(site, site.clock(), assignment_id)
    now = _current_class(site, assignment_id)
    if now.is_marked:
        return now
    with site.store.reading() as connection:
        left = unmarked(connection, assignment_id, site.clock() - _MARKING)
    for number in left:
        mark(site, number)
    return _current_class(site, assignment_id) if left else now


def overview(connection: Connection, assignment_id: int) -> AssignmentOverview:
    """Return what the desk lists of an assignment. Raises HTTPException: there is none."""
    for about in listed_assignments(connection, assignment_id):
        return about
    raise HTTPException("own", 404)


def _current_class(site: Site, assignment_id: int) -> ClassState:
    with _lock:
        caches = _class_caches.setdefault(site.store, OrderedDict())
        cached = caches.setdefault(assignment_id, _ClassCache())
        caches.move_to_end(assignment_id)
        _forget_others(caches)
    with cached.lock, site.store.reading() as connection:
        about = overview(connection, assignment_id)
        at = stamp(connection, assignment_id)
        now = cached.now
        if (
            now is None
            or (now.stamp, now.about.columns) != (at, about.columns)
            or now.course is not site.course
        ):
            with paused_collection():
                now = cached.now = _read(site.course, connection, about, at, cached)
        now.about = about
        return now


def _forget_others(caches: OrderedDict[int, _ClassCache]) -> None:
    """Forget the classes that were used least recently, where all together take too many bytes."""
    total = 0
    for number, cached in reversed([*caches.items()]):
        total += _SHEET * len(cached.marked)
        if total > _MOST and number != next(reversed(caches)):
            del caches[number]


def _read(
    course: Course, connection: Connection, about: AssignmentOverview, at: Stamp, cached: _ClassCache
) -> ClassState:
    before = cached.now if cached.now is not None and cached.now.course is course else None
    decisions, placed_by_hand = read_decisions(connection, about.id), placings(connection, about.id)
    charged = late_penalties(connection, about.id)
    if before is not None and _has_come(before.stamp, before.about) == _has_come(at, about):
        now = replace(
            before, about=about, stamp=at, decisions=decisions, placings=placed_by_hand, charged=charged
        )
        _carry(before.__dict__, now.__dict__, _LASTING)
        if "exam" in before.__dict__:
            _carry(before.exam.__dict__, now.exam.__dict__, _LASTING_OF_EXAM)
            if before.exam.one_sitting:
                _carry(before.exam.__dict__, now.exam.__dict__, ("groups",))
        return now
    is_issued = before is not None and _issued_at(before.stamp, before.about) == _issued_at(at, about)
    issued = before.issued if before is not None and is_issued else issued_of(connection, about.id)
    sheets = placed_sheets(course, issued, rows_of(connection, about.id))
    last = last_markings(connection, about.id)
    unknown = [marking for marking in last.values() if marking.id not in cached.marked]
    for sheet, marked in machine_marks(issued, unknown, lines_of(connection, unknown)):
        cached.marked[last[sheet].id] = marked
    outcomes = {
        sheet: cached.marked[marking.id] for sheet, marking in last.items() if marking.id in cached.marked
    }
    machine = {sheet: marking for sheet, marking in outcomes.items() if not isinstance(marking, str)}
    numbers = {sheet: last[sheet].id for sheet in machine}
    new = [sheet for sheet in machine if numbers[sheet] not in cached.measured]
    cached.measured.update(_measured(course, issued, [machine[p] for p in new], [numbers[p] for p in new]))
    faults = {sheet: marking for sheet, marking in outcomes.items() if isinstance(marking, str)}
    return ClassState(
        course,
        about,
        issued,
        at,
        machine,
        numbers,
        cached.measured,
        sheets,
        faults,
        decisions,
        placed_by_hand,
        site_submissions_of(connection, about.id),
        charged,
    )


def _has_come(at: Stamp, about: AssignmentOverview) -> tuple[Any, ...]:
    """Return the part of a stamp that decisions do not change."""
    return at.markings, at.submissions, *_issued_at(at, about)


def _issued_at(at: Stamp, about: AssignmentOverview) -> tuple[Any, ...]:
    """Return the part of a stamp on which the issued variants depend."""
    return at.issued, about.columns, about.stated


#: Cached properties that decisions do not change; of the groups, where no student has several attempts.
_LASTING, _LASTING_OF_EXAM = ("drawn", "unplaced"), ("questions", "last_sitting", "one_sitting")


def _carry(before: dict[str, Any], now: dict[str, Any], names: Iterable[str]) -> None:
    now.update({name: before[name] for name in names if name in before})


def _measured(
    course: Course, issued: Issued, graded: Sequence[Graded], numbers: Sequence[int]
) -> dict[int, Measure]:
    return dict(zip(numbers, measures(course, issued, graded), strict=True))


CLASS_GROUP = "class_group"  #: parameter of an address that names a group


def class_here(request: Request) -> ClassState:
    """Return the current state of the class that the address names, as far as the user may see it, and of the
    group alone that the query names."""
    number = request.path_params["assignment"]
    return class_within(request.site, number, students_here(request, number))


def class_within(site: Site, number: int, students: frozenset[str] | None) -> ClassState:
    """Return the current state of some of the students of a class; None for all of them."""
    now = class_now(site, number)
    return now if students is None else now.within(students)


def students_here(request: Request, number: int) -> frozenset[str] | None:
    """Return the students of an assignment whom a page shows: those whom the user may see, of the group that
    the query names; None for the whole class."""
    wanted = group_key(request.query_params.get(CLASS_GROUP, ""))
    with request.site.store.reading() as connection:
        within = students_within(connection, request.user, number)
        if not wanted:
            return within
        chosen = students_in(connection, number, {wanted})
    return chosen if within is None else chosen & within


def assignments_marked(
    request: Request, connection: Connection
) -> list[tuple[AssignmentOverview, frozenset[str] | None]]:
    """Return the assignments in which the user marks somebody, the latest first, each with the students
    within whom they may; None for the whole class."""
    found = []
    for about in listed_assignments(connection):
        if request.user.may(Permission.MARKS_READ, about.id):
            within = students_within(connection, request.user, about.id)
            if within is None or within:
                found.append((about, within))
    return found


def _groups_here(request: Request, number: int) -> dict[str, str]:
    """Return the groups that the user may choose, by their keys."""
    with request.site.store.reading() as connection:
        names = group_names(connection, number)
    mine = groups_within(request.user, number)
    return {key: name for key, name in names.items() if mine is None or key in mine}


def class_page_of(request: Request, now: Any, template: str, tab: str, **names: Any) -> Response:
    """Return an instructor's page of one assignment, under its heading; ``now`` is its state or its table.
    Groups are read by the pages that offer them."""
    group = group_key(request.query_params.get(CLASS_GROUP, ""))
    return request.render(
        template,
        now=now,
        tab=tab,
        heading=now.about.title(request.lang),
        class_group=group,
        sees_all=groups_within(request.user, now.about.id) is None,
        class_groups=cache(partial(_groups_here, request, now.about.id)),
        group_query=urlencode({CLASS_GROUP: group}) if group else "",
        **names,
    )
