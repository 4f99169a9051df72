"""Cache of the current state of a class: append-only rows are read once, and a stamp tells if there are new
ones."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import timedelta
from functools import cached_property
from hashlib import sha256
from threading import Lock, RLock
from typing import Any
from weakref import WeakKeyDictionary

from sqlalchemy import Connection

from coursework.course.course import Course
from coursework.database.assignments import issued_of
from coursework.database.current_marks import last_markings, lines_of, machine_marks
from coursework.database.decisions import Decisions
from coursework.database.instructor_queries import (
    AssignmentOverview,
    Placing,
    SiteSubmissions,
    Stamp,
    listed_assignments,
    placings,
    site_submissions_of,
    stamp,
    unmarked,
)
from coursework.database.publication import late_penalties
from coursework.database.store import Store
from coursework.database.submissions import rows_of
from coursework.errors import closest
from coursework.gradebook.book import Gradebook, Result, Sitting, results
from coursework.gradebook.class_marking import rejecting
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.placing import SheetKey, Sheets, placed_sheets
from coursework.gradebook.rows import Rejected
from coursework.gradebook.waiting import (
    SHOWN_ON_REQUEST,
    AnswerGroup,
    AnswerToReview,
    Measure,
    groups,
    measures,
)
from coursework.issuing.assignment import text_in
from coursework.issuing.issued import Issued
from coursework.issuing.students import namesakes
from coursework.messages import localised
from coursework.site.frame.requests import HTTPException, Request, Response
from coursework.site.frame.settings import Site
from coursework.site.papers.submission import mark, pass_dates

_MARKING = timedelta(minutes=1)  #: after which another process may mark a submission that one began to mark


@dataclass(frozen=True)
class RejectedRow:
    """A row that could not be placed."""

    id: str  #: digest of its content and source
    row: Rejected
    student: str  #: name of the student as issued; empty for a stranger
    near: str  #: closest name of a student, if the row names a stranger
    became: Placing | None

    @property
    def waits(self) -> bool:
        """Return True if a person must still look at the row."""
        return self.became is None

    @property
    def reason(self) -> str:
        """Reason of the rejection, in the language of the current messages."""
        return localised(self.row.reason)


@dataclass(frozen=True)
class WaitingGroup:
    """Group of answers, with those of its members that still wait for a person."""

    group: AnswerGroup
    members: tuple[AnswerToReview, ...]

    @property
    def why(self) -> str:
        return self.group.why


@dataclass
class CachedClass:
    """State of an assignment and its class at one stamp."""

    course: Course
    about: AssignmentOverview
    issued: Issued
    stamp: Stamp
    machine: Mapping[SheetKey, Graded]  #: results of the marking, without decisions
    numbers: Mapping[SheetKey, int]  #: ids of the markings
    measured: Mapping[int, Measure]  #: by the id of the marking
    sheets: Sheets
    faults: Mapping[SheetKey, str]
    decisions: Decisions
    placings: Mapping[str, Placing]
    received: Mapping[str, SiteSubmissions]
    charged: Mapping[Sitting, float]  #: penalties for late submissions, as shares of the points

    @cached_property
    def is_marked(self) -> bool:
        """Return True if every received sheet is marked or cannot be marked."""
        return self.sheets.sheets.keys() <= self.machine.keys() | self.faults.keys()

    @cached_property
    def graded(self) -> dict[SheetKey, Graded]:
        """Graded sheets with the decisions of people applied."""
        return {sheet: self.decisions.apply(graded) for sheet, graded in self.machine.items()}

    @cached_property
    def book(self) -> Gradebook:
        """The gradebook of the class."""
        sheets = Sheets(self.sheets.sheets, list(self.sheets.rejected), list(self.sheets.warnings))
        book = Gradebook(
            self.issued, self.sheets.rows_in, self.sheets.blanks, sheets.rejected, sheets.warnings
        )
        book.charged = self.charged
        both: dict[SheetKey, Graded | str] = {**self.graded, **self.faults}
        for graded in list(rejecting(sheets, ((p, both[p]) for p in sheets.sheets if p in both))):
            book.add(graded)
        return book

    @cached_property
    def results(self) -> dict[str, Result]:
        """Result of each student, of the attempt that counts."""
        return dict(results(self.book))

    @cached_property
    def last_sitting(self) -> dict[str, int]:
        last: dict[str, int] = {}
        for graded in self.machine.values():
            last[graded.student] = max(last.get(graded.student, 0), graded.sitting)
        return last

    @cached_property
    def one_sitting(self) -> bool:
        """True if no student has several attempts."""
        sittings: dict[str, int] = {}
        return all(
            sittings.setdefault(graded.student, graded.sitting) == graded.sitting
            for graded in self.machine.values()
        )

    def matters(self, graded: Graded) -> bool:
        """Return True if a sheet belongs to the attempt that counts, or to the last one."""
        if self.one_sitting:
            return True
        return graded.sitting in (self.results[graded.student].sitting, self.last_sitting[graded.student])

    # ----------------------------------------------------------------- questions

    @cached_property
    def questions(self) -> tuple[tuple[str, str], ...]:
        """Exercise and part of every question that was issued, in the order of the sheets."""
        exercises = [str(e) for e in (self.issued.assignment or {}).get("exercises", ())]
        names = dict.fromkeys((*exercises, *self.issued.exercises))
        by_exercise: dict[str, dict[str, None]] = {name: {} for name in names}
        for (name, _), record in self.issued.records.items():
            by_exercise[name].update((str(p["id"]), None) for p in record["parts"])
        return tuple(
            (name, part) for name, parts in by_exercise.items() for part in self._in_order(name, parts)
        )

    def _in_order(self, name: str, parts: Mapping[str, None]) -> list[str]:
        ids = [p.id for p in self.course[name].spec.parts] if name in self.course else []
        return sorted(parts, key=lambda part: ids.index(part) if part in ids else len(ids))

    @cached_property
    def drawn(self) -> frozenset[tuple[str, str]]:
        """The questions that are answered by a drawing."""
        return frozenset(
            (name, part.id)
            for name in self.issued.exercises
            if name in self.course
            for part in self.course[name].spec.parts
            if part.sort.box in ("blank", "millimetre")
        )

    def number(self, exercise: str, part: str) -> str:
        """Return the number of a question on the papers, such as ``2.3``."""
        names = list(dict.fromkeys(name for name, _ in self.questions))
        parts = [p for name, p in self.questions if name == exercise]
        return f"{names.index(exercise) + 1}.{parts.index(part) + 1}"

    # ------------------------------------------------------------------- waiting

    @property
    def groups(self) -> list[AnswerGroup]:
        """Groups of answers for a person to review, decided or not."""
        return self._groups_of_all if self.one_sitting else self._groups_that_matter

    @cached_property
    def _groups_of_all(self) -> list[AnswerGroup]:
        return self._grouped(self.machine.values())

    @cached_property
    def _groups_that_matter(self) -> list[AnswerGroup]:
        return self._grouped(graded for graded in self.machine.values() if self.matters(graded))

    def _grouped(self, graded: Iterable[Graded]) -> list[AnswerGroup]:
        measured = {
            (*sheet[:3], self.machine[sheet].sitting): self.measured[number]
            for sheet, number in self.numbers.items()
            if number in self.measured
        }
        return groups(graded, measured, self.questions, self.drawn)

    @cached_property
    def open(self) -> dict[str, WaitingGroup]:
        """Groups that wait for a person, by id, in order; including those that are looked at only on request."""
        open_groups = {}
        for group in self.groups:
            members = tuple(answer for answer in group.members if not self.is_decided(answer))
            if members:
                open_groups[group.id] = WaitingGroup(group, members)
        return open_groups

    def is_decided(self, answer: AnswerToReview) -> bool:
        return self.decisions.standing(answer.sheet, answer.mark) is not None

    @property
    def waiting(self) -> int:
        """Number of answers and rows that wait for a person."""
        answers = sum(len(item.members) for item in self.open.values() if item.why not in SHOWN_ON_REQUEST)
        return answers + sum(item.waits for item in self.named)

    @cached_property
    def unplaced(self) -> tuple[tuple[str, Rejected, str, str], ...]:
        """Rows that could not be placed or marked: digest, row, student named, and closest name of a
        student."""
        sheets = Sheets(self.sheets.sheets, list(self.sheets.rejected))
        list(rejecting(sheets, self.faults.items()))
        return tuple((row_id(row), row, *self._named_by(row)) for row in sheets.rejected)

    def _named_by(self, row: Rejected) -> tuple[str, str]:
        name = row.row.get("student", "")
        student = self.issued.student(name) if name else None
        is_one = name and student is None and len(namesakes(name, self.issued.students)) < 2
        near = closest(name[:60], self.issued.students) if is_one else None
        return student or "", near or ""

    @cached_property
    def rejected(self) -> tuple[RejectedRow, ...]:
        """Rows that could not be placed, each with the decision on it."""
        return tuple(RejectedRow(*row, self.placings.get(row[0])) for row in self.unplaced)

    @property
    def of_nobody(self) -> int:
        """Number of waiting rows, on the page of files, that name no student of the class."""
        return sum(row.waits for row in self.rejected) - sum(row.waits for row in self.named)

    @property
    def named(self) -> tuple[RejectedRow, ...]:
        """Rejected rows that name a student of the class."""
        return tuple(row for row in self.rejected if row.student and row.student in self.issued.students)


def row_id(row: Rejected) -> str:
    """Return the digest that identifies a rejected row."""
    text = "\0".join((row.source, *(f"{k}={v}" for k, v in sorted(row.row.items()))))
    return sha256(text.encode("utf-8", "backslashreplace")).hexdigest()[:32]


# ------------------------------------------------------------------------ at hand


@dataclass
class _ClassCache:
    """Cached data of an assignment."""

    lock: Any = field(default_factory=RLock)
    now: CachedClass | None = None
    marked: dict[int, Graded | str] = field(default_factory=dict)  #: by the id of the marking
    measured: dict[int, Measure] = field(default_factory=dict)


_class_caches: WeakKeyDictionary[Store, dict[int, _ClassCache]] = WeakKeyDictionary()
_lock = Lock()


def class_now(site: Site, assignment_id: int) -> CachedClass:
    """Return the current state of a class, after saved answers of a closed assignment are submitted and all
    new sheets are marked.

    Raises
    ------
    HTTPException
        There is no such assignment.
    """
    pass_dates(site, assignment_id, site.clock())
    now = _current_class(site, assignment_id)
    if now.is_marked:
        return now
    with site.store.reading() as connection:
        left = unmarked(connection, assignment_id, site.clock() - _MARKING)
    for number in left:
        mark(site, number)
    return _current_class(site, assignment_id) if left else now


def _current_class(site: Site, assignment_id: int) -> CachedClass:
    with _lock:
        cached = _class_caches.setdefault(site.store, {}).setdefault(assignment_id, _ClassCache())
    with cached.lock, site.store.reading() as connection:
        about = next(iter(listed_assignments(connection, assignment_id)), None)
        if about is None:
            raise HTTPException("own", 404)
        at = stamp(connection, assignment_id)
        now = cached.now
        if (
            now is None
            or (now.stamp, now.about.columns) != (at, about.columns)
            or now.course is not site.course
        ):
            now = cached.now = _read(site.course, connection, about, at, cached)
        now.about = about
        return now


def _read(
    course: Course, connection: Connection, about: AssignmentOverview, at: Stamp, cached: _ClassCache
) -> CachedClass:
    before = cached.now if cached.now is not None and cached.now.course is course else None
    decisions, placed_by_hand = Decisions.read(connection, about.id), placings(connection, about.id)
    charged = late_penalties(connection, about.id)
    if before is not None and _has_come(before.stamp, before.about) == _has_come(at, about):
        now = CachedClass(
            course, about, before.issued, at, before.machine, before.numbers, before.measured, before.sheets,
            before.faults, decisions, placed_by_hand, before.received, charged,
        )  # fmt: skip
        now.__dict__.update({k: before.__dict__[k] for k in _LASTING if k in before.__dict__})
        return now
    issued = issued_of(connection, about.id)
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
    came_in = site_submissions_of(connection, about.id)
    return CachedClass(
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
        came_in,
        charged,
    )


def _has_come(at: Stamp, about: AssignmentOverview) -> tuple[Any, ...]:
    """Return the part of a stamp that decisions do not change."""
    return at.markings, at.submissions, at.dealt, about.columns, about.stated


#: Cached properties that decisions do not change.
_LASTING = ("questions", "drawn", "last_sitting", "one_sitting", "_groups_of_all", "unplaced")


def _measured(
    course: Course, issued: Issued, graded: Sequence[Graded], numbers: Sequence[int]
) -> dict[int, Measure]:
    return dict(zip(numbers, measures(course, issued, graded), strict=True))


def assignment_of(request: Request) -> int:
    """Return the id of the assignment that the address names.

    Raises
    ------
    HTTPException
        It is not a number.
    """
    text = str(request.path_params.get("assignment", ""))
    if not text.isascii() or not text.isdecimal() or len(text) > 9:
        raise HTTPException("own", 404)
    return int(text)


def by_whom(request: Request) -> str:
    """Return the name under which a decision is recorded."""
    return request.user.name or str(request.words["site"]["local"])


def class_page_of(request: Request, now: CachedClass, template: str, tab: str, **names: Any) -> Response:
    """Return an instructor's page of one assignment, under its heading."""
    return request.render(
        template, now=now, tab=tab, heading=assignment_title(now.about, request.lang), **names
    )


def assignment_title(about: AssignmentOverview, lang: str) -> str:
    """Return the title of an assignment, or its name if it has none."""
    return text_in((about.stated or {}).get("title") or {}, lang) or about.name
