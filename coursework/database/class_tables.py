"""Queries of the instructor's pages on the aggregates: a page of students, the cards of the queue, the
answers to a question. Each takes a fixed number of statements and returns no more rows than a page shows.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from sqlalchemy import (
    CTE,
    ColumnElement,
    Connection,
    Select,
    and_,
    case,
    func,
    literal,
    or_,
    select,
    true,
    update,
)

from coursework.database.tables import (
    answer_now,
    assignment,
    assignment_total,
    mark,
    placing,
    student_total,
    unplaced,
    variant,
)
from coursework.gradebook.waiting import OFTEN, OFTEN_SHARE, SHOWN_ON_REQUEST, WHY
from coursework.issuing.students import folded

PAGE = 100  #: rows of a page
SORTS = ("name", "total", "waits", "late", "tries")

Question = tuple[str, str]  #: exercise and part


@dataclass(frozen=True)
class Scope:
    """Students and assignments that somebody may see; None for all. Every listing of the instructor's pages
    takes one."""

    students: Collection[str] | None = None  #: names as issued
    assignments: Collection[int] | None = None

    @property
    def is_all(self) -> bool:
        return self.students is None and self.assignments is None

    def of_students(self, column: ColumnElement[str]) -> ColumnElement[bool]:
        """Return the condition that a row is of a permitted student."""
        return true() if self.students is None else column.in_(list(self.students))

    def of_assignments(self, column: ColumnElement[int]) -> ColumnElement[bool]:
        """Return the condition that a row is of a permitted assignment."""
        return true() if self.assignments is None else column.in_(list(self.assignments))


ALL = Scope()


# ------------------------------------------------------------------------ outline


class Outline(NamedTuple):
    """Questions of the issued variants, with their points."""

    worth: Mapping[Question, float]  #: points, exercise after exercise as issued

    @property
    def exercises(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(name for name, _ in self.worth))


def outline_stamp(connection: Connection, number: int) -> tuple[int, int]:
    """Return a stamp that changes if the outline of an assignment may change: variants are only added or
    erased."""
    query = select(func.count(), func.coalesce(func.max(variant.c.id), 0)).where(
        variant.c.assignment_id == number
    )
    count, last = connection.execute(query).one()
    return int(count), int(last)


def outline(connection: Connection, number: int) -> Outline:
    """Return the questions of an assignment, from one record for each set of parts with which an exercise was
    issued."""
    text = variant.c.record["parts"].as_string()
    first = (
        select(func.min(variant.c.id).label("id"))
        .where(variant.c.assignment_id == number)
        .group_by(variant.c.exercise, text)
    ).subquery()
    query = select(variant.c.exercise, variant.c.record["parts"].label("parts")).join(
        first, first.c.id == variant.c.id
    )
    worth: dict[Question, float] = {}
    for row in connection.execute(query.order_by(variant.c.id)):
        worth.update({(row.exercise, str(part["id"])): float(part["points"]) for part in row.parts})
    return Outline(worth)


# ----------------------------------------------------------------------- students


class TableRequest(NamedTuple):
    """Request for a page of the class table."""

    sort: str = ""  #: one of :data:`SORTS`, ``EXERCISE/PART``, or empty for the order of the class
    find: str = ""
    page: int = 1
    since: int = 0  #: aggregates that are later than this number alone


class StudentsPage(NamedTuple):
    """Page of students of a class, with their total number."""

    rows: Sequence[Any]  #: of ``student_total``
    cells: Mapping[str, Mapping[Question, Any]]  #: of ``answer_now``, by student
    matches: int  #: students that the search finds, on all pages
    last: int  #: number of the latest aggregate of the class

    @property
    def pages(self) -> int:
        return max(1, -(-self.matches // PAGE))


def students_page(
    connection: Connection,
    number: int,
    request: TableRequest,
    scope: Scope = ALL,
    question: Question | None = None,
) -> StudentsPage:
    """Return a page of the class table; ``question`` is the one by which it is sorted, if any."""
    of_class = and_(student_total.c.assignment_id == number, scope.of_students(student_total.c.student))
    is_found = and_(of_class, _finds(student_total.c.search, request.find))
    if request.since:
        is_found = and_(is_found, student_total.c.id > request.since)
    count = select(func.count()).select_from(student_total).where(is_found).scalar_subquery()
    last = select(func.max(student_total.c.id)).where(of_class).scalar_subquery()
    found_count, latest = connection.execute(select(count, last)).one()
    pages = max(1, -(-int(found_count) // PAGE))
    first = (min(max(request.page, 1), pages) - 1) * PAGE
    ordered = _in_order(select(student_total).where(is_found), number, request.sort, question)
    rows = connection.execute(ordered.offset(first).limit(PAGE)).all()
    return StudentsPage(
        rows, cells_of(connection, number, [row.student for row in rows]), int(found_count), int(latest or 0)
    )


def _finds(column: ColumnElement[str], sought: str) -> ColumnElement[bool]:
    plain = folded(sought[:200])
    return column.contains(plain, autoescape=True) if plain else true()


def _in_order(query: Select[Any], number: int, sort: str, question: Question | None) -> Select[Any]:
    class_order = student_total.c.place, student_total.c.student
    if question is not None:
        cell = and_(
            answer_now.c.assignment_id == number,
            answer_now.c.student == student_total.c.student,
            answer_now.c.exercise == question[0],
            answer_now.c.part == question[1],
            answer_now.c.is_cell.is_(True),
        )
        joined = query.outerjoin(answer_now, cell)
        return joined.order_by(answer_now.c.id.is_(None), answer_now.c.points, *class_order)
    by: dict[str, list[ColumnElement[Any]]] = {
        "name": [student_total.c.search.asc()],
        "total": [student_total.c.points.desc()],
        "waits": [student_total.c.waits.desc()],
        "late": [student_total.c.late.desc()],
        "tries": [student_total.c.tries.desc()],
    }
    return query.order_by(*by.get(sort, []), *class_order)


def cells_of(
    connection: Connection, number: int, students: Collection[str]
) -> dict[str, dict[Question, Any]]:
    """Return the answers of students in the class table."""
    of_students = answer_now.c.assignment_id == number, answer_now.c.student.in_(list(students))
    columns = [
        answer_now.c[name]
        for name in ("student", "exercise", "part", "verdict", "points", "out_of", "by_hand")
    ]
    cells: dict[str, dict[Question, Any]] = {}
    for row in connection.execute(select(*columns).where(*of_students, answer_now.c.is_cell.is_(True))):
        cells.setdefault(row.student, {})[row.exercise, row.part] = row
    return cells


def means(connection: Connection, number: int, scope: Scope = ALL) -> dict[Question, tuple[float, int]]:
    """Return the sum of the points of each question, and the number of students who submitted an answer to
    it."""
    is_cell = answer_now.c.assignment_id == number, answer_now.c.is_cell.is_(True)
    columns = answer_now.c.exercise, answer_now.c.part, func.sum(answer_now.c.points), func.count()
    query = select(*columns).where(*is_cell, scope.of_students(answer_now.c.student))
    rows = connection.execute(query.group_by(answer_now.c.exercise, answer_now.c.part))
    return {(row[0], row[1]): (float(row[2]), int(row[3])) for row in rows}


class Totals(NamedTuple):
    """Totals of a class."""

    students: int = 0
    handed_in: int = 0
    answered: int = 0  #: students of whom a sheet is marked
    waiting: int = 0  #: answers that wait for a person
    rows: int = 0  #: rows of a student of the class that wait
    of_nobody: int = 0  #: rows that wait and name no student of the class
    version: int = 0


def totals(connection: Connection, number: int | None = None, scope: Scope = ALL) -> dict[int, Totals]:
    """Return the totals of all assignments, or of one."""
    query = select(assignment_total).where(scope.of_assignments(assignment_total.c.assignment_id))
    if number is not None:
        query = query.where(assignment_total.c.assignment_id == number)
    rows = _rows_waiting(connection, number)
    return {
        row.assignment_id: Totals(
            row.students,
            row.handed_in,
            row.answered,
            row.waiting,
            *rows.get(row.assignment_id, (0, 0)),
            row.version,
        )
        for row in connection.execute(query)
    }


def _is_named() -> ColumnElement[bool]:
    return and_(unplaced.c.student != "", assignment.c.has_roster.is_(True))


def _waits() -> ColumnElement[bool]:
    became = select(placing.c.id).where(
        placing.c.assignment_id == unplaced.c.assignment_id, placing.c.row == unplaced.c.row
    )
    return ~became.exists()


def _rows_waiting(connection: Connection, number: int | None) -> dict[int, tuple[int, int]]:
    """Return the numbers of waiting rows, by assignment: those of students of the class, and those of
    strangers."""
    named = case((_is_named(), 1), else_=0)
    query = (
        select(unplaced.c.assignment_id, func.sum(named), func.count())
        .join(assignment, assignment.c.id == unplaced.c.assignment_id)
        .where(_waits())
        .group_by(unplaced.c.assignment_id)
    )
    if number is not None:
        query = query.where(unplaced.c.assignment_id == number)
    return {row[0]: (int(row[1]), int(row[2]) - int(row[1])) for row in connection.execute(query)}


# -------------------------------------------------------------------------- cards


def _cards(number: int, order: Sequence[Question] = (), scope: Scope = ALL) -> CTE:
    """Return the groups of answers to review, numbered in their order: by question, then by reason, the
    largest first."""
    at = answer_now.c
    question = at.exercise, at.part
    of_students = and_(at.assignment_id == number, scope.of_students(at.student))
    answered = (
        select(*question, func.count(at.student.distinct()).label("students"))
        .where(of_students, at.is_shown.is_(True))
        .group_by(*question)
        .subquery()
    )
    students = func.count(at.student.distinct())
    grouped = (
        select(
            at.card,
            at.why,
            *question,
            func.count().label("members"),
            func.sum(case((at.decided, 0), else_=1)).label("open"),
            students.label("students"),
            func.min(at.first).label("first"),
        )
        .where(of_students, at.card.is_not(None))
        .group_by(at.card, at.why, *question)
        .having(or_(at.why != "often", students >= OFTEN))
        .subquery()
    )
    same = and_(answered.c.exercise == grouped.c.exercise, answered.c.part == grouped.c.part)
    places = [
        (and_(grouped.c.exercise == exercise, grouped.c.part == part), position)
        for position, (exercise, part) in enumerate(order)
    ]
    rank = case(*places, else_=len(order)) if places else literal(0)
    whys = [(grouped.c.why == name, position) for position, name in enumerate(WHY)]
    why = case(*whys, else_=len(WHY))
    number_of = func.row_number().over(
        order_by=(rank, why, grouped.c.members.desc(), grouped.c.first, grouped.c.card)
    )
    often = or_(grouped.c.why != "often", grouped.c.students >= OFTEN_SHARE * answered.c.students)
    return (
        select(*grouped.c, number_of.label("number"))
        .select_from(grouped.join(answered, same))
        .where(often)
        .cte("cards")
    )


def answers_waiting(connection: Connection, number: int, scope: Scope = ALL) -> int:
    """Return the number of answers that wait for a person, without those that are shown only on request."""
    cards = _cards(number, (), scope)
    query = select(func.coalesce(func.sum(cards.c.open), 0)).where(cards.c.why.not_in(SHOWN_ON_REQUEST))
    return int(connection.execute(query).scalar_one())


class Filter(NamedTuple):
    """Selection of the cards to show."""

    why: str = ""  #: all reasons except those shown on request
    exercise: str = ""
    part: str = ""

    def of(self, cards: CTE) -> ColumnElement[bool]:
        conditions = [cards.c.open > 0]
        conditions.append(cards.c.why == self.why if self.why else cards.c.why.not_in(SHOWN_ON_REQUEST))
        if self.exercise:
            conditions.append(cards.c.exercise == self.exercise)
            conditions += [cards.c.part == self.part] if self.part else []
        return and_(*conditions)


class CardRow(NamedTuple):
    """A card of the queue."""

    id: str
    why: str
    exercise: str
    part: str
    members: int  #: answers, decided or not
    open: int
    number: int  #: its place among all cards, decided or not


class CardQueue:
    """Cards of an assignment, queried a few at a time."""

    def __init__(self, connection: Connection, number: int, order: Sequence[Question], scope: Scope = ALL):
        self._connection, self._number, self._scope = connection, number, scope
        self._cards = _cards(number, order, scope)

    def _select(self) -> Select[Any]:
        at = self._cards.c
        return select(at.card, at.why, at.exercise, at.part, at.members, at.open, at.number)

    def _rows(self, query: Select[Any]) -> list[CardRow]:
        return [CardRow(*row) for row in self._connection.execute(query)]

    def card(self, name: str) -> CardRow | None:
        """Return a card by its name, decided or not."""
        return next(iter(self._rows(self._select().where(self._cards.c.card == name))), None)

    def count(self, selection: Filter) -> int:
        query = select(func.count()).select_from(self._cards).where(selection.of(self._cards))
        return int(self._connection.execute(query).scalar_one())

    def before(self, selection: Filter, number: int) -> int:
        """Return the number of selected cards before a position among all cards."""
        query = select(func.count()).select_from(self._cards)
        conditions = selection.of(self._cards), self._cards.c.number < number
        return int(self._connection.execute(query.where(*conditions)).scalar_one())

    def page(self, selection: Filter, first: int, count: int = PAGE) -> list[CardRow]:
        """Return selected cards, beginning with the card ``first``."""
        query = self._select().where(selection.of(self._cards)).order_by(self._cards.c.number)
        return self._rows(query.offset(first).limit(min(count, PAGE)))

    def after(self, selection: Filter, number: int) -> CardRow | None:
        """Return the first selected card from a position among all cards on; the first of all after the
        last."""
        at = self._cards.c.number
        query = self._select().where(selection.of(self._cards)).order_by(at < number, at)
        return next(iter(self._rows(query.limit(1))), None)

    def by_why(self) -> dict[str, int]:
        """Return the number of waiting cards, by reason."""
        query = select(self._cards.c.why, func.count()).where(self._cards.c.open > 0)
        return {row[0]: int(row[1]) for row in self._connection.execute(query.group_by(self._cards.c.why))}

    def by_question(self, selection: Filter) -> dict[Question, int]:
        """Return the number of waiting cards, by question."""
        question = self._cards.c.exercise, self._cards.c.part
        everywhere = selection._replace(exercise="", part="").of(self._cards)
        query = select(*question, func.count()).where(everywhere).group_by(*question)
        return {(row[0], row[1]): int(row[2]) for row in self._connection.execute(query)}

    def done(self) -> int:
        """Return the number of decided answers of the cards."""
        query = select(func.coalesce(func.sum(self._cards.c.members - self._cards.c.open), 0))
        return int(self._connection.execute(query).scalar_one())

    def alike(self, card: CardRow) -> list[str]:
        """Return the other cards with the same unreadable text."""
        if card.why != "unreadable":
            return []
        at = answer_now.c
        mine = select(at.wrote).where(at.assignment_id == self._number, at.card == card.id)
        same = at.wrote == mine.order_by(at.decided).limit(1).scalar_subquery()
        others = (
            select(at.card)
            .where(at.assignment_id == self._number, at.why == "unreadable", at.card != card.id)
            .where(at.decided.is_(False), same)
            .where(self._scope.of_students(at.student))
            .distinct()
        )
        return list(self._connection.execute(others).scalars())

    # ---------------------------------------------------------------------- members

    def _members(self, names: Collection[str], *columns: Any, open_only: bool) -> Select[Any]:
        at = answer_now.c
        conditions = [
            at.assignment_id == self._number,
            at.card.in_(list(names)),
            self._scope.of_students(at.student),
            *([at.decided.is_(False)] if open_only else []),
        ]
        joined = answer_now.join(mark, and_(mark.c.marking_id == at.marking, mark.c.part == at.part))
        return select(*columns).select_from(joined).where(*conditions).order_by(at.first, at.place)

    def members(self, names: Collection[str], *, open_only: bool, limit: int | None = None) -> list[Any]:
        """Return answers of cards in the order of arrival: id, student, exercise, seed, attempt, part,
        answer."""
        at = answer_now.c
        columns = at.id, at.student, at.exercise, at.seed, at.sitting, at.part, at.decided, mark.c.answer
        return list(
            self._connection.execute(self._members(names, *columns, open_only=open_only).limit(limit))
        )

    def decided(self, name: str, limit: int) -> list[Any]:
        """Return the first decided answers of a card."""
        at = answer_now.c
        columns = at.id, at.student, at.exercise, at.seed, at.sitting, at.part, at.decided, mark.c.answer
        query = self._members([name], *columns, open_only=False).where(at.decided.is_(True))
        return list(self._connection.execute(query.limit(limit)))

    def spellings(self, name: str, limit: int) -> list[str]:
        """Return the first spellings of the answers of a card."""
        at = answer_now.c
        query = self._members([name], mark.c.answer, open_only=False).order_by(None)
        first = query.group_by(mark.c.answer).order_by(func.min(at.first)).limit(limit)
        return list(self._connection.execute(first).scalars())


def mark_decided(connection: Connection, rows: Collection[int], *, decided: bool) -> None:
    """Mark answers as decided or not at once; their points are computed later."""
    numbers = list(rows)
    for start in range(0, len(numbers), 5000):
        some = answer_now.c.id.in_(numbers[start : start + 5000])
        connection.execute(update(answer_now).where(some).values(decided=decided))


# --------------------------------------------------------------------------- rows


class UnplacedTableRow(NamedTuple):
    """Row that belongs to no sheet, as stored."""

    row: str
    student: str  #: of the class; empty for a stranger
    near: str
    source: str
    reason: str
    said: Mapping[str, str]


def rows_page(
    connection: Connection, number: int, first: int = 0, *, named: bool = False, waiting: bool = False, row: str = "",
    student: str | None = None, exercise: str = "", part: str = "", scope: Scope = ALL, count: int = PAGE,
) -> tuple[list[UnplacedTableRow], int]:  # fmt: skip
    """Return rows that could not be placed, beginning with the row ``first``, and their total number."""
    conditions = [unplaced.c.assignment_id == number]
    if scope.students is not None:
        conditions.append(scope.of_students(unplaced.c.student))
    conditions += [_is_named()] if named else []
    conditions += [_waits()] if waiting else []
    conditions += [unplaced.c.row == row] if row else []
    conditions += [unplaced.c.student == student] if student is not None else []
    conditions += [unplaced.c.said["exercise"].as_string() == exercise] if exercise else []
    conditions += [unplaced.c.said["part"].as_string() == part] if part else []
    base = unplaced.join(assignment, assignment.c.id == unplaced.c.assignment_id)
    columns = [unplaced.c[name] for name in UnplacedTableRow._fields]
    query = (
        select(*columns)
        .select_from(base)
        .where(*conditions)
        .order_by(unplaced.c.id)
        .offset(first)
        .limit(count)
    )
    many = select(func.count()).select_from(base).where(*conditions)
    return [UnplacedTableRow(*unplaced_row) for unplaced_row in connection.execute(query)], int(
        connection.execute(many).scalar_one()
    )
