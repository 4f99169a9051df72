"""Aggregates for the instructor's pages: totals by student, current answers, counts by assignment.

A transaction that changes marks, decisions, submissions, papers or rules also records which aggregates become outdated
(:mod:`coursework.database.outdated`). :func:`refresh` computes these again from the other tables, with the code that writes
``summary.csv``, a few hundred students at a time. Two concurrent refreshes do no harm: the one that no longer finds its note
discards its results.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from sqlalchemy import Connection, case, delete, func, insert, select, update

from coursework.course.course import Course
from coursework.database.class_state import ClassState, Facts, read_rows, read_students
from coursework.database.class_tables import answers_waiting
from coursework.database.instructor_queries import AssignmentOverview, listed_assignments
from coursework.database.outdated import EVERYBODY, ROWS, STUDENT, outdate
from coursework.database.store import Store, insert_unless_there
from coursework.database.tables import (
    answer_now,
    assignment,
    assignment_total,
    dealt,
    delivery,
    mark,
    marking,
    outdated,
    rejected,
    student_total,
    unplaced,
    variant,
)
from coursework.gradebook.columns import own_columns
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.rows import Rejected
from coursework.gradebook.scale import mark_of
from coursework.gradebook.waiting import (
    NOTHING,
    key_of,
    name_of,
    written,
)
from coursework.issuing.students import folded
from coursework.marking.mark import Mark

CHUNK = 200  #: students that are computed at once
_WRITTEN = 2000  #: rows that are written at once
_STRANGERS = 10**10  #: places of who is on no roster begin here
_WAIT = ("unreadable", "to_mark")


def outstanding(connection: Connection, assignment_id: int | None = None) -> dict[int, int]:
    """Return the number of students with outdated aggregates, by assignment; if all are outdated, the number
    of its variants."""
    noted = select(
        outdated.c.assignment_id, outdated.c.kind, func.count(outdated.c.student.distinct())
    ).group_by(outdated.c.assignment_id, outdated.c.kind)
    if assignment_id is not None:
        noted = noted.where(outdated.c.assignment_id == assignment_id)
    counts: dict[int, int] = {}
    for number, kind, count in connection.execute(noted).all():
        if kind == EVERYBODY:
            count = _how_many(connection, number)
        elif kind == ROWS:
            count = 1 if not _has_files(connection, number) else _how_many(connection, number)
        counts[number] = max(counts.get(number, 0), count)
    return counts


def _how_many(connection: Connection, number: int) -> int:
    query = select(func.count(variant.c.id)).where(variant.c.assignment_id == number)
    return int(connection.execute(query).scalar() or 0) or 1


def refresh(course: Course, store: Store, assignment_id: int, most: int | None = None) -> bool:
    """Compute the outdated aggregates of an assignment, at most for the given number of students; return
    False if some remain.

    Raises
    ------
    CourseworkError
        The course cannot mark what was issued; nothing of it is computed then.
    """
    done = 0
    while most is None or done < most:
        count = _step(course, store, assignment_id)
        if count is None:
            return True
        done += count
    with store.reading() as connection:
        return not connection.execute(
            select(outdated.c.id).where(outdated.c.assignment_id == assignment_id).limit(1)
        ).first()


def _step(course: Course, store: Store, number: int) -> int | None:
    """Process one batch of notes; return its number of students, or None if no note is left."""
    with store.reading() as connection:
        notes = _notes(connection, number)
        if notes is None:
            return None
        about = next(iter(listed_assignments(connection, number)), None)
        if about is None:
            return None
        computed = _computed(connection, course, about, notes)
    with store.begin() as connection:
        row = select(assignment.c.id).where(assignment.c.id == number)
        connection.execute(row.with_for_update(key_share=True))
        if _are_deleted(connection, notes.ids):
            computed.write(connection)
    return len(notes.students) or 1


class _Notes(NamedTuple):
    """Notes of outdated aggregates that are processed together."""

    kind: str
    ids: Sequence[int]
    students: frozenset[str]


def _notes(connection: Connection, number: int) -> _Notes | None:
    """Return the notes to process next: those about everybody, then those about rows, then those of some
    students."""
    of_assignment = outdated.c.assignment_id == number
    for kind in (EVERYBODY, ROWS):
        ids = (
            connection.execute(select(outdated.c.id).where(of_assignment, outdated.c.kind == kind))
            .scalars()
            .all()
        )
        if ids:
            return _Notes(kind, ids, frozenset())
    first = (
        select(outdated.c.student)
        .where(of_assignment, outdated.c.kind == STUDENT)
        .group_by(outdated.c.student)
        .order_by(func.min(outdated.c.id))
        .limit(CHUNK)
    )
    names = connection.execute(first).scalars().all()
    if not names:
        return None
    theirs = select(outdated.c.id).where(
        of_assignment, outdated.c.kind == STUDENT, outdated.c.student.in_(names)
    )
    return _Notes(STUDENT, connection.execute(theirs).scalars().all(), frozenset(names))


def _are_deleted(connection: Connection, ids: Sequence[int]) -> bool:
    """Delete notes; return False if another process has processed one of them meanwhile."""
    gone = 0
    for start in range(0, len(ids), _WRITTEN):
        some = outdated.c.id.in_(ids[start : start + _WRITTEN])
        gone += connection.execute(delete(outdated).where(some)).rowcount
    return gone == len(ids)


class _Computed:
    """Computed aggregates of an assignment, ready to be written."""

    def __init__(self, about: AssignmentOverview):
        self.about = about
        self.outdate: Collection[str] = ()  #: students who are noted
        self.away: Collection[str] = ()  #: students whose rows are deleted
        self.totals: list[dict[str, Any]] = []
        self.answers: list[dict[str, Any]] = []
        self.unplaced: list[dict[str, Any]] | None = None
        self.facts: Facts | None = None

    def write(self, connection: Connection) -> None:
        number = self.about.id
        away = list(self.away)
        for table in (answer_now, student_total):
            for start in range(0, len(away), _WRITTEN):
                names = table.c.student.in_(away[start : start + _WRITTEN])
                connection.execute(delete(table).where(table.c.assignment_id == number, names))
        if self.unplaced is not None:
            connection.execute(delete(unplaced).where(unplaced.c.assignment_id == number))
            _insert(connection, unplaced, self.unplaced)
        _insert(connection, student_total, self.totals)
        _insert(connection, answer_now, self.answers)
        outdate(connection, number, self.outdate)
        write_total(connection, number, self.facts)


def _insert(connection: Connection, table: Any, rows: Sequence[Mapping[str, Any]]) -> None:
    for start in range(0, len(rows), _WRITTEN):
        connection.execute(insert(table), list(rows[start : start + _WRITTEN]))


def _computed(connection: Connection, course: Course, about: AssignmentOverview, notes: _Notes) -> _Computed:
    computed = _Computed(about)
    if notes.kind == EVERYBODY:
        computed.outdate = _everybody(connection, about)
    elif notes.kind == ROWS:
        _unplaced(connection, course, about, computed)
    else:
        _students(connection, course, about, notes.students, computed)
    return computed


# ----------------------------------------------------------------------- students


def _everybody(connection: Connection, about: AssignmentOverview) -> list[str]:
    """Return every name of a student: issued, marked, or computed before."""
    number = about.id
    issued = select(dealt.c.student).join(variant).where(variant.c.assignment_id == number)
    marked = select(marking.c.student).where(marking.c.assignment_id == number)
    computed = select(student_total.c.student).where(student_total.c.assignment_id == number)
    unplaced_names = select(unplaced.c.student).where(unplaced.c.assignment_id == number)
    names = dict.fromkeys(connection.execute(issued.union(marked, computed, unplaced_names)).scalars())
    return [name for name in (*names, *(about.columns if _is_pool(connection, number) else ())) if name]


def _is_pool(connection: Connection, number: int) -> bool:
    return bool(connection.execute(select(assignment.c.is_pool).where(assignment.c.id == number)).scalar())


def _students(
    connection: Connection,
    course: Course,
    about: AssignmentOverview,
    noted: Collection[str],
    computed: _Computed,
) -> None:
    """Compute some students; names are resolved to those as issued."""
    students = _as_issued(connection, about, noted)
    computed.away = frozenset(students) | frozenset(noted)
    facts = facts_of(connection, about.id)
    if facts.as_json() != _facts_before(connection, about.id):
        computed.facts = facts
        computed.outdate = [name for name in _everybody(connection, about) if name not in computed.away]
    if not students:
        return
    query = select(unplaced).where(unplaced.c.assignment_id == about.id, unplaced.c.student.in_(students))
    lost = [
        Rejected(row.source, row.reason, row.said)
        for row in connection.execute(query.order_by(unplaced.c.id))
    ]
    now = read_students(connection, course, about, students, lost, facts)
    places = _places(connection, about, now)
    cells = _cells(now)
    computed.totals = [
        _total(now, student, places[student], cells.get(student, {})) for student in now.results
    ]
    computed.answers = list(_answers(now, cells))


def _as_issued(connection: Connection, about: AssignmentOverview, noted: Collection[str]) -> frozenset[str]:
    """Return the students with the given names, whatever their spelling."""
    issued = select(dealt.c.student).join(variant).where(variant.c.assignment_id == about.id)
    marked = select(marking.c.student).where(marking.c.assignment_id == about.id)
    unplaced_names = select(unplaced.c.student).where(
        unplaced.c.assignment_id == about.id, unplaced.c.student != ""
    )

    def among(*more: Any) -> set[str]:
        query = issued.where(*(dealt.c.student.in_(names) for names in more)).union(
            marked.where(*(marking.c.student.in_(names) for names in more)),
            unplaced_names.where(*(unplaced.c.student.in_(names) for names in more)),
        )
        return {name for name in connection.execute(query).scalars() if name}

    students = among(list(noted)) | {name for name in noted if name in about.columns}
    if strangers := {folded(name) for name in noted if name not in students}:
        students |= {name for name in among() if folded(name) in strangers}
    return frozenset(students)


def _places(connection: Connection, about: AssignmentOverview, now: ClassState) -> dict[str, int]:
    """Return the position of each student in the class: the order of issue, then the order of arrival."""
    names = list(now.results)
    order = (
        select(dealt.c.student, func.min(dealt.c.place))
        .join(variant)
        .where(variant.c.assignment_id == about.id, dealt.c.student.in_(names))
        .group_by(dealt.c.student)
    )
    positions: dict[str, int] = {row[0]: row[1] for row in connection.execute(order)}
    listed_at = {name: position for position, name in enumerate(about.columns)} if now.issued.is_pool else {}
    first_markings: dict[str, int] = {}
    for sheet, first in now.firsts.items():
        first_markings[sheet[0]] = min(first_markings.get(sheet[0], first), first)
    for name in names:
        if name not in positions:
            at = listed_at.get(name)
            positions[name] = (
                _STRANGERS + first_markings.get(name, _STRANGERS) if at is None else _STRANGERS // 2 + at
            )
    return positions


_Cells = dict[tuple[str, str], Graded]


def _cells(now: ClassState) -> dict[str, _Cells]:
    """Return the sheet of each question in a student's line of the class table."""
    cells: dict[str, _Cells] = {}
    for sheet in now.graded.values():
        if sheet.sitting == now.results[sheet.student].sitting:
            student_cells = cells.setdefault(sheet.student, {})
            student_cells.update({(sheet.exercise, part): sheet for part in sheet.lines})
    return cells


def _total(now: ClassState, student: str, position: int, cells: _Cells) -> dict[str, Any]:
    result, submitted = now.results[student], now.site_submissions.get(student)
    columns = own_columns(now.issued, student)
    titles = (now.issued.assignment or {}).get("identity") or ()
    identity = " ".join(filter(None, (columns.get(folded(str(title)), "") for title in titles)))
    sittings = [n for s, n in now.book.students if s == student] if cells else []
    return {
        "assignment_id": now.about.id,
        "student": student,
        "search": folded(f"{student} {identity}"),
        "identity": identity,
        "place": position,
        "sitting": result.sitting,
        "points": result.points,
        "out_of": result.out_of,
        "charged": result.late,
        "mark": mark_of(now.issued, result.counts, result.out_of),
        "tries": submitted.attempts if submitted else max(sittings, default=0),
        "late": submitted.late if submitted else 0,
        "waits": sum(sheet.lines[part].verdict in _WAIT for (_, part), sheet in cells.items()),
        "handed_in": bool(cells) or submitted is not None,
        "answered": any(graded.student == student for graded in now.machine.values()),
        "verdicts": {name: count for name, count in result.verdicts.items() if count},
        "by_exercise": dict(result.by_exercise),
    }


def _answers(now: ClassState, cells: Mapping[str, _Cells]) -> Iterator[dict[str, Any]]:
    for sheet, machine in now.machine.items():
        graded = now.graded[sheet]
        measure = now.measures.get((*sheet[:3], machine.sitting), NOTHING)
        counts = graded.sitting == now.results[graded.student].sitting
        matters = counts or graded.sitting == now.last_sitting[graded.student]
        listed_parts = {*graded.answered, *graded.unanswered}
        for at, (part, before) in enumerate(machine.lines.items()):
            line = graded.lines[part]
            is_shown = matters and before.verdict != "missing"
            key = key_of(machine, before, measure, now.drawn) if is_shown else None
            yield {
                "assignment_id": now.about.id,
                "marking": now.numbers[sheet],
                "first": now.firsts[sheet],
                "place": at,
                "student": graded.student,
                "exercise": graded.exercise,
                "seed": str(graded.seed),
                "sitting": graded.sitting,
                "part": part,
                "verdict": line.verdict,
                "points": line.points,
                "out_of": line.out_of,
                "by_hand": is_by_hand(before, line),
                "counts": counts,
                "is_cell": cells.get(graded.student, {}).get((graded.exercise, part)) is graded,
                "is_listed": part in listed_parts,
                "is_shown": is_shown,
                "wrote": name_of([written(line)]),
                "why": None if key is None else key[0],
                "card": None if key is None else name_of(key),
                "decided": now.decisions.standing(machine, before) is not None,
            }


def is_by_hand(before: Mark, now: Mark) -> bool:
    """Return True if a person changed a mark."""
    return before is not now and (before.verdict, before.points) != (now.verdict, now.points)


# -------------------------------------------------------------------------- facts


def facts_of(connection: Connection, number: int) -> Facts:
    """Return the facts about all sheets that affect the points of each one; none in a class with a roster
    whose papers are complete."""
    row = connection.execute(
        select(assignment.c.has_roster, assignment.c.is_pool).where(assignment.c.id == number)
    ).one()
    apart = select(marking.c.id).where(marking.c.assignment_id == number, marking.c.apart.is_(True)).limit(1)
    if row.has_roster and not row.is_pool and connection.execute(apart).first() is None:
        return Facts()
    sheet = (marking.c.student, marking.c.exercise, marking.c.seed, marking.c.attempt)
    last = select(func.max(marking.c.id)).where(marking.c.assignment_id == number).group_by(*sheet)
    is_current = marking.c.id.in_(last), marking.c.state != "", marking.c.fault == ""
    exercises, complete, parts_by_exercise = dict[str, None](), set[str](), dict[str, set[str]]()
    kinds = select(marking.c.exercise, marking.c.apart, func.min(marking.c.id)).where(*is_current)
    for name, is_apart, _ in sorted(
        connection.execute(kinds.group_by(marking.c.exercise, marking.c.apart)),
        key=lambda kind_row: kind_row[2],
    ):
        exercises[name] = None
        if not is_apart:
            complete.add(name)
    parts = (
        select(marking.c.exercise, mark.c.part)
        .join(mark)
        .where(*is_current, marking.c.apart.is_(True))
        .distinct()
    )
    for name, part in connection.execute(parts):
        parts_by_exercise.setdefault(name, set()).add(part)
    return Facts(
        tuple(sorted(exercises)),
        frozenset(complete),
        {name: frozenset(exercise_parts) for name, exercise_parts in parts_by_exercise.items()},
    )


def _facts_before(connection: Connection, number: int) -> dict[str, Any]:
    query = select(assignment_total.c.facts).where(assignment_total.c.assignment_id == number)
    return connection.execute(query).scalar() or Facts().as_json()


# --------------------------------------------------------------------------- rows


def _has_files(connection: Connection, number: int) -> bool:
    """Return True if there may be rows of no student: from a file, rejected, or on a sheet that cannot be
    marked."""
    files = select(delivery.c.id).where(delivery.c.assignment_id == number, delivery.c.person_id.is_(None))
    faults = select(marking.c.id).where(marking.c.assignment_id == number, marking.c.fault != "")
    refused = select(rejected.c.id).join(delivery).where(delivery.c.assignment_id == number)
    return any(connection.execute(query.limit(1)).first() is not None for query in (files, faults, refused))


def _unplaced(connection: Connection, course: Course, about: AssignmentOverview, computed: _Computed) -> None:
    """Compute the rows without a sheet; note their students if these have changed."""
    computed.unplaced = []
    if _has_files(connection, about.id):
        now = read_rows(connection, course, about)
        computed.unplaced = [
            {
                "assignment_id": about.id,
                "row": name,
                "student": student,
                "near": near,
                "source": row.source,
                "reason": row.reason,
                "said": dict(row.row),
            }
            for name, row, student, near in now
        ]
    query = select(unplaced.c.row, unplaced.c.student).where(unplaced.c.assignment_id == about.id)
    before = {(row.row, row.student) for row in connection.execute(query)}
    after = {(row["row"], row["student"]) for row in computed.unplaced}
    computed.outdate = {student for _, student in before ^ after if student}


# -------------------------------------------------------------------------- counts


def write_total(connection: Connection, number: int, facts: Facts | None = None) -> None:
    """Write the totals of an assignment, from the aggregates of its students and answers."""
    of_assignment = student_total.c.assignment_id == number
    counted = select(
        func.count(),
        func.coalesce(func.sum(case((student_total.c.handed_in, 1), else_=0)), 0),
        func.coalesce(func.sum(case((student_total.c.answered, 1), else_=0)), 0),
    ).where(of_assignment)
    students, handed_in, answered = connection.execute(counted).one()
    values = {
        "students": students,
        "handed_in": handed_in,
        "answered": answered,
        "waiting": answers_waiting(connection, number),
        **({} if facts is None else {"facts": facts.as_json()}),
    }
    key = {"assignment_id": number}
    usual = {"facts": Facts().as_json(), "version": 0}
    insert_unless_there(connection, assignment_total, {**usual, **values, **key}, ("assignment_id",))
    more = {**values, "version": assignment_total.c.version + 1}
    connection.execute(
        update(assignment_total).where(assignment_total.c.assignment_id == number).values(more)
    )
