"""All that the database keeps of one person, by table: what is given to them, and what is erased."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from sqlalchemy import ColumnElement, Connection, Table, or_, select

from coursework.database.people import person_by_id
from coursework.database.tables import (
    account,
    answer,
    area,
    assignment,
    audit,
    dealt,
    decision,
    delivery,
    draft,
    extension,
    identity,
    mark,
    marking,
    person,
    prepared,
    progress,
    rejected,
    scanned,
    session,
    typed,
    variant,
)
from coursework.making.identity import identifies
from coursework.making.students import folded

#: What a row holds for the database alone, or for nobody.
_HIDDEN = {
    "account": {"secret", "invitation"},
    "session": {"digest"},
    "delivery": {"digest"},
    "progress": {"digest"},
    "marking": {"state"},
    "prepared": {"state", "head", "body"},  # the paper may be to come; it is told with ``dealt``
}


class Whose(NamedTuple):
    """By what the tables know somebody."""

    person: int
    name: str
    students: frozenset[tuple[int, str]]  #: assignments, and what the person is called there
    words: frozenset[str]  #: names, logins, numbers, e-mails

    def answers_to(self, number: int, student: str) -> bool:
        """Return True if a student of an assignment is this person."""
        return (number, folded(student)) in self.students


def whose(connection: Connection, number: int) -> Whose | None:
    """By what the tables know a person; None for nobody.

    In an assignment with a roster it is who was issued something; in one without, whoever gave the same name, as long as
    nobody else has it.
    """
    mine = person_by_id(connection, number)
    if mine is None:
        return None
    issued = (
        select(variant.c.assignment_id, dealt.c.student)
        .join(variant)
        .where(dealt.c.person_id == number)
        .distinct()
    )
    students = {(row.assignment_id, folded(row.student)) for row in connection.execute(issued)}
    names = list(connection.execute(select(person.c.name)).scalars())
    if mine.name and sum(folded(one) == folded(mine.name) for one in names) == 1:
        free = select(assignment.c.id).where(assignment.c.has_roster.is_(False))
        students |= {(one, folded(mine.name)) for one in connection.execute(free).scalars()}
    return Whose(number, mine.name, frozenset(students), _words(connection, mine, issued))


def _words(connection: Connection, mine: Any, issued: Any) -> frozenset[str]:
    logins = connection.execute(select(account.c.login).where(account.c.person_id == mine.id)).scalars()
    subjects = connection.execute(select(identity.c.subject).where(identity.c.person_id == mine.id)).scalars()
    told = [mine.name, *logins, *subjects]
    if not (
        mine.who.isalpha() and mine.who == folded(mine.name)
    ):  # else it is the name, written as any other word
        told.append(mine.who)
    told += [str(value) for title, value in (mine.columns or {}).items() if identifies(title)]
    told += [row.student for row in connection.execute(issued)]
    return frozenset(one.strip() for one in told if one and one.strip())


def conditions(connection: Connection, who: Whose) -> dict[str, tuple[Table, ColumnElement[bool]]]:
    """Return the condition that selects the person's rows of each table, in an order in which they can be
    deleted."""
    deliveries = select(delivery.c.id).where(delivery.c.person_id == who.person)
    markings = ids_of(connection, marking, who)
    own_answers = or_(answer.c.delivery_id.in_(deliveries), answer.c.id.in_(_answers(connection, who)))
    return {
        "mark": (mark, mark.c.marking_id.in_(markings)),
        "marking": (marking, marking.c.id.in_(markings)),
        "decision": (decision, decision.c.id.in_(ids_of(connection, decision, who))),
        "answer": (answer, own_answers),
        "rejected": (rejected, rejected.c.id.in_(_rejected(connection, who))),
        "delivery": (delivery, delivery.c.person_id == who.person),
        "scanned": (scanned, scanned.c.id.in_(ids_of(connection, scanned, who))),
        "typed": (typed, typed.c.id.in_(ids_of(connection, typed, who))),
        "dealt": (dealt, or_(dealt.c.person_id == who.person, dealt.c.id.in_(_dealt(connection, who)))),
        "extension": (extension, extension.c.person_id == who.person),
        "draft": (draft, draft.c.person_id == who.person),
        "prepared": (prepared, prepared.c.person_id == who.person),
        "progress": (progress, progress.c.person_id == who.person),
        "identity": (identity, identity.c.person_id == who.person),
        "session": (session, session.c.person_id == who.person),
        "area": (area, area.c.person_id == who.person),
        "account": (account, account.c.person_id == who.person),
        "person": (person, person.c.id == who.person),
    }  # fmt: skip


def ids_of(connection: Connection, table: Table, who: Whose) -> list[int]:
    """Return the ids of the person's rows in a table with the columns assignment and student."""
    numbers = {number for number, _ in who.students}
    found = select(table.c.id, table.c.assignment_id, table.c.student).where(
        table.c.assignment_id.in_(numbers)
    )
    return [row.id for row in connection.execute(found) if who.answers_to(row.assignment_id, row.student)]


def _dealt(connection: Connection, who: Whose) -> list[int]:
    """Return the ids of the variants issued under the person's name without a roster."""
    found = (
        select(dealt.c.id, dealt.c.student, variant.c.assignment_id)
        .join(variant)
        .where(dealt.c.person_id.is_(None), dealt.c.student != "")
    )
    return [row.id for row in connection.execute(found) if who.answers_to(row.assignment_id, row.student)]


def _answers(connection: Connection, who: Whose) -> list[int]:
    numbers = {number for number, _ in who.students}
    found = (
        select(answer.c.id, delivery.c.assignment_id, answer.c.student)
        .join(delivery)
        .where(delivery.c.assignment_id.in_(numbers))
    )
    return [row.id for row in connection.execute(found) if who.answers_to(row.assignment_id, row.student)]


def _rejected(connection: Connection, who: Whose) -> list[int]:
    """Return the ids of rejected rows that name this person."""
    own = {folded(word) for word in who.words}
    found = []
    for row in connection.execute(select(rejected.c.id, rejected.c.row)):
        told = row.row.values() if isinstance(row.row, Mapping) else ()
        if any(isinstance(one, str) and folded(one) in own for one in told):
            found.append(row.id)
    return found


def belongings(connection: Connection, who: Whose) -> dict[str, list[dict[str, Any]]]:
    """Return all stored data of a person: the rows of each table, and the audit entries about the person."""
    found = {}
    for name, (table, mine) in reversed(conditions(connection, who).items()):
        columns = [one for one in table.c if one.name not in _HIDDEN.get(name, ())]
        chosen = select(*columns).where(mine).order_by(*table.primary_key)
        found[name] = [dict(row._mapping) for row in connection.execute(chosen)]
    found["dealt"] = _papers(connection, who)
    noted = connection.execute(select(audit).order_by(audit.c.id))
    found["audit"] = [_of_audit(row, who) for row in noted if _tells_of(row, who)]
    return found


def _of_audit(row: Any, who: Whose) -> dict[str, Any]:
    """Return a line of the audit; from where it was done, only where the person did it."""
    told = dict(row._mapping)
    return told if row.actor == who.person else {**told, "address": None}


def _tells_of(row: Any, who: Whose) -> bool:
    about = row.about if isinstance(row.about, Mapping) else {}
    people = about.get("people")
    return (
        (who.name != "" and row.by == who.name)
        or about.get("person") == who.person
        or (isinstance(people, list) and who.person in people)
    )


def _papers(connection: Connection, who: Whose) -> list[dict[str, Any]]:
    """Return the variants issued to the person, with their given values."""
    found = (
        select(
            assignment.c.id.label("assignment_id"), assignment.c.name.label("assignment"), dealt.c.student, dealt.c.sitting,
            dealt.c.lang, variant.c.exercise, variant.c.seed, variant.c.record,
        )
        .select_from(dealt.join(variant).join(assignment))
        .where(conditions(connection, who)["dealt"][1])
        .order_by(dealt.c.id)
    )  # fmt: skip
    return [dict(row._mapping) for row in connection.execute(found)]
