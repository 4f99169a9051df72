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
from coursework.database.decisions import Decisions
from coursework.database.deliveries import rows_of
from coursework.database.desk import About, Came, Placed, Stamp, came_of, listed, placings, stamp, unmarked
from coursework.database.publication import charges
from coursework.database.standing import lines_of, machine_marks, stood
from coursework.database.store import Store
from coursework.errors import closest
from coursework.gradebook.book import Gradebook, Result, Sitting, results
from coursework.gradebook.class_marking import rejecting
from coursework.gradebook.graded import Graded
from coursework.gradebook.placing import SheetPlace, Sheets, placed
from coursework.gradebook.rows import Rejected
from coursework.gradebook.waiting import SHOWN_ON_REQUEST, Group, Measure, Waits, groups, measures
from coursework.making.assignment import text_in
from coursework.making.issued import Issued
from coursework.making.students import namesakes
from coursework.site.frame.requests import HTTPException, Request, Response
from coursework.site.frame.settings import Site
from coursework.site.papers.submission import mark, pass_dates

_MARKING = timedelta(minutes=1)  #: after which nobody marks a hand-in any more who began to


@dataclass(frozen=True)
class RejectedRow:
    """A row that could not be placed."""

    id: str  #: digest of what it says and where
    row: Rejected
    student: str  #: whom it names, as issued; empty for a stranger
    near: str  #: whose name is like the one that it tells, where it names a stranger
    became: Placed | None

    @property
    def waits(self) -> bool:
        """Return True if a person must still look at the row."""
        return self.became is None


@dataclass(frozen=True)
class Open:
    """Group of answers, with those of its members that still wait for a person."""

    group: Group
    members: tuple[Waits, ...]

    @property
    def why(self) -> str:
        return self.group.why


@dataclass
class ClassNow:
    """An assignment and its class, at one stamp."""

    course: Course
    about: About
    issued: Issued
    stamp: Stamp
    machine: Mapping[SheetPlace, Graded]  #: as the marking gave them
    numbers: Mapping[SheetPlace, int]  #: of the markings
    measured: Mapping[int, Measure]  #: by marking
    sheets: Sheets
    faults: Mapping[SheetPlace, str]
    decisions: Decisions
    placings: Mapping[str, Placed]
    received: Mapping[str, Came]
    charged: Mapping[Sitting, float]  #: shares that are taken off of what came late

    @cached_property
    def is_marked(self) -> bool:
        """Return True if every received sheet is marked or cannot be marked."""
        return self.sheets.sheets.keys() <= self.machine.keys() | self.faults.keys()

    @cached_property
    def graded(self) -> dict[SheetPlace, Graded]:
        """As they stand: what people decided counts."""
        return {place: self.decisions.apply(one) for place, one in self.machine.items()}

    @cached_property
    def book(self) -> Gradebook:
        """The gradebook of the class."""
        sheets = Sheets(self.sheets.sheets, list(self.sheets.rejected), list(self.sheets.warnings))
        book = Gradebook(
            self.issued, self.sheets.rows_in, self.sheets.blanks, sheets.rejected, sheets.warnings
        )
        book.charged = self.charged
        both: dict[SheetPlace, Graded | str] = {**self.graded, **self.faults}
        for one in list(rejecting(sheets, ((p, both[p]) for p in sheets.sheets if p in both))):
            book.add(one)
        return book

    @cached_property
    def results(self) -> dict[str, Result]:
        """Result of each student, of the attempt that counts."""
        return dict(results(self.book))

    @cached_property
    def last_sitting(self) -> dict[str, int]:
        found: dict[str, int] = {}
        for one in self.machine.values():
            found[one.student] = max(found.get(one.student, 0), one.sitting)
        return found

    @cached_property
    def one_sitting(self) -> bool:
        """True if no student has several attempts."""
        sittings: dict[str, int] = {}
        return all(
            sittings.setdefault(one.student, one.sitting) == one.sitting for one in self.machine.values()
        )

    def matters(self, one: Graded) -> bool:
        """Return True if a sheet belongs to the attempt that counts, or to the last one."""
        if self.one_sitting:
            return True
        return one.sitting in (self.results[one.student].sitting, self.last_sitting[one.student])

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
        known = [p.id for p in self.course[name].spec.parts] if name in self.course else []
        return sorted(parts, key=lambda part: known.index(part) if part in known else len(known))

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
        own = [p for name, p in self.questions if name == exercise]
        return f"{names.index(exercise) + 1}.{own.index(part) + 1}"

    # ------------------------------------------------------------------- waiting

    @property
    def groups(self) -> list[Group]:
        """All that a person may look at, decided or not."""
        return self._groups_of_all if self.one_sitting else self._groups_that_matter

    @cached_property
    def _groups_of_all(self) -> list[Group]:
        return self._grouped(self.machine.values())

    @cached_property
    def _groups_that_matter(self) -> list[Group]:
        return self._grouped(one for one in self.machine.values() if self.matters(one))

    def _grouped(self, shown: Iterable[Graded]) -> list[Group]:
        measured = {
            (*place[:3], self.machine[place].sitting): self.measured[number]
            for place, number in self.numbers.items()
            if number in self.measured
        }
        return groups(shown, measured, self.questions, self.drawn)

    @cached_property
    def open(self) -> dict[str, Open]:
        """Groups that wait for a person, by id, in order; including those that are looked at only on request."""
        found = {}
        for group in self.groups:
            members = tuple(one for one in group.members if not self.is_decided(one))
            if members:
                found[group.id] = Open(group, members)
        return found

    def is_decided(self, one: Waits) -> bool:
        return self.decisions.standing(one.sheet, one.mark) is not None

    @property
    def waiting(self) -> int:
        """Number of answers and rows that wait for a person."""
        asked = sum(len(one.members) for one in self.open.values() if one.why not in SHOWN_ON_REQUEST)
        return asked + sum(one.waits for one in self.named)

    @cached_property
    def unplaced(self) -> tuple[tuple[str, Rejected, str, str], ...]:
        """Every row that could not be placed or marked: its digest, whom it names, and whose name is like that."""
        sheets = Sheets(self.sheets.sheets, list(self.sheets.rejected))
        list(rejecting(sheets, self.faults.items()))
        return tuple((row_id(row), row, *self._named_by(row)) for row in sheets.rejected)

    def _named_by(self, row: Rejected) -> tuple[str, str]:
        told = row.row.get("student", "")
        student = self.issued.student(told) if told else None
        is_one = told and student is None and len(namesakes(told, self.issued.students)) < 2
        near = closest(told[:60], self.issued.students) if is_one else None
        return student or "", near or ""

    @cached_property
    def rejected(self) -> tuple[RejectedRow, ...]:
        """Every row that could not be placed, with what became of it."""
        return tuple(RejectedRow(*one, self.placings.get(one[0])) for one in self.unplaced)

    @property
    def of_nobody(self) -> int:
        """Number of waiting rows, on the page of files, that name no student of the class."""
        return sum(one.waits for one in self.rejected) - sum(one.waits for one in self.named)

    @property
    def named(self) -> tuple[RejectedRow, ...]:
        """Those of a student of the class."""
        return tuple(one for one in self.rejected if one.student and one.student in self.issued.students)


def row_id(row: Rejected) -> str:
    """Return the digest that identifies a rejected row."""
    told = "\0".join((row.source, *(f"{k}={v}" for k, v in sorted(row.row.items()))))
    return sha256(told.encode("utf-8", "backslashreplace")).hexdigest()[:32]


# ------------------------------------------------------------------------ at hand


@dataclass
class _ClassCache:
    """Cached data of an assignment."""

    lock: Any = field(default_factory=RLock)
    now: ClassNow | None = None
    marked: dict[int, Graded | str] = field(default_factory=dict)  #: by the marking's number
    measured: dict[int, Measure] = field(default_factory=dict)


_class_caches: WeakKeyDictionary[Store, dict[int, _ClassCache]] = WeakKeyDictionary()
_lock = Lock()


def class_now(site: Site, assignment_id: int) -> ClassNow:
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


def _current_class(site: Site, assignment_id: int) -> ClassNow:
    with _lock:
        kept = _class_caches.setdefault(site.store, {}).setdefault(assignment_id, _ClassCache())
    with kept.lock, site.store.reading() as connection:
        about = next(iter(listed(connection, assignment_id)), None)
        if about is None:
            raise HTTPException("own", 404)
        at = stamp(connection, assignment_id)
        now = kept.now
        if (
            now is None
            or (now.stamp, now.about.columns) != (at, about.columns)
            or now.course is not site.course
        ):
            now = kept.now = _read(site.course, connection, about, at, kept)
        now.about = about
        return now


def _read(course: Course, connection: Connection, about: About, at: Stamp, kept: _ClassCache) -> ClassNow:
    before = kept.now if kept.now is not None and kept.now.course is course else None
    decisions, placed_by_hand = Decisions.read(connection, about.id), placings(connection, about.id)
    charged = charges(connection, about.id)
    if before is not None and _has_come(before.stamp, before.about) == _has_come(at, about):
        now = ClassNow(
            course, about, before.issued, at, before.machine, before.numbers, before.measured, before.sheets,
            before.faults, decisions, placed_by_hand, before.received, charged,
        )  # fmt: skip
        now.__dict__.update({k: before.__dict__[k] for k in _LASTING if k in before.__dict__})
        return now
    issued = issued_of(connection, about.id)
    sheets = placed(course, issued, rows_of(connection, about.id))
    last = stood(connection, about.id)
    unknown = [one for one in last.values() if one.id not in kept.marked]
    for place, marked in machine_marks(issued, unknown, lines_of(connection, unknown)):
        kept.marked[last[place].id] = marked
    found = {place: kept.marked[one.id] for place, one in last.items() if one.id in kept.marked}
    machine = {place: one for place, one in found.items() if not isinstance(one, str)}
    numbers = {place: last[place].id for place in machine}
    new = [place for place in machine if numbers[place] not in kept.measured]
    kept.measured.update(_measured(course, issued, [machine[p] for p in new], [numbers[p] for p in new]))
    faults = {place: one for place, one in found.items() if isinstance(one, str)}
    came_in = came_of(connection, about.id)
    return ClassNow(
        course,
        about,
        issued,
        at,
        machine,
        numbers,
        kept.measured,
        sheets,
        faults,
        decisions,
        placed_by_hand,
        came_in,
        charged,
    )


def _has_come(at: Stamp, about: About) -> tuple[Any, ...]:
    """Return the part of a stamp that decisions do not change."""
    return at.markings, at.deliveries, at.dealt, about.columns, about.stated


#: What decisions do not change.
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
        None: it is no number.
    """
    told = str(request.path_params.get("assignment", ""))
    if not told.isascii() or not told.isdecimal() or len(told) > 9:
        raise HTTPException("own", 404)
    return int(told)


def by_whom(request: Request) -> str:
    """Return the name under which a decision is recorded."""
    return request.user.name or str(request.words["site"]["local"])


def class_page_of(request: Request, now: ClassNow, template: str, tab: str, **names: Any) -> Response:
    """Return an instructor's page of one assignment, under its heading."""
    return request.render(
        template, now=now, tab=tab, heading=assignment_title(now.about, request.lang), **names
    )


def assignment_title(about: About, lang: str) -> str:
    """Return the title of an assignment, or its name if it has none."""
    return text_in((about.stated or {}).get("title") or {}, lang) or about.name
