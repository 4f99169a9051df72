"""All data about one person, by table: for export and for erasure."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from sqlalchemy import ColumnElement, Connection, Select, Table, exists, or_, select

from coursework.database.people import person_by_id
from coursework.database.tables import (
    account,
    answer,
    area,
    assignment,
    audit,
    decision,
    draft,
    drawing,
    extension,
    identity,
    issue,
    lti_launch,
    lti_session,
    mark,
    marking,
    paper_start,
    person,
    prepared,
    progress,
    rejected,
    scanned,
    session,
    submission,
    typed,
    variant,
)
from coursework.issuing.identity import identifies
from coursework.issuing.students import folded

#: Columns that concern the database alone, or nobody.
_HIDDEN = {
    "account": {"secret", "invitation"},
    "session": {"digest"},
    "submission": {"digest"},
    "progress": {"digest"},
    "marking": {"state"},
    "prepared": {"state", "head", "body"},  # the paper may not be open yet; ``issue`` contains it
    "lti_session": {"digest"},
    "lti_launch": {"link"},
}


class PersonIdentifiers(NamedTuple):
    """Identifiers of a person in the tables."""

    person: int
    name: str
    students: frozenset[tuple[int, str]]  #: assignments, and what the person is called there
    words: frozenset[str]  #: names, logins, numbers, e-mails

    def answers_to(self, number: int, student: str) -> bool:
        """Return True if a student of an assignment is this person."""
        return (number, folded(student)) in self.students


def identifiers_of(connection: Connection, number: int) -> PersonIdentifiers | None:
    """Return the identifiers of a person; None if there is no such person.

    In an assignment with a roster, the students are those to whom the person's variants were issued; in one
    without, everybody who gave the person's name, as long as no other person has it.
    """
    mine = person_by_id(connection, number)
    if mine is None:
        return None
    issued = (
        select(variant.c.assignment_id, issue.c.student)
        .join(variant)
        .where(issue.c.person_id == number)
        .distinct()
    )
    students = {(row.assignment_id, folded(row.student)) for row in connection.execute(issued)}
    names = list(connection.execute(select(person.c.name)).scalars())
    if mine.name and sum(folded(name) == folded(mine.name) for name in names) == 1:
        free = select(assignment.c.id).where(assignment.c.has_roster.is_(False))
        students |= {
            (assignment_id, folded(mine.name)) for assignment_id in connection.execute(free).scalars()
        }
    return PersonIdentifiers(number, mine.name, frozenset(students), _words(connection, mine, issued))


def _words(connection: Connection, mine: Any, issued: Any) -> frozenset[str]:
    logins = connection.execute(select(account.c.login).where(account.c.person_id == mine.id)).scalars()
    subjects = connection.execute(select(identity.c.subject).where(identity.c.person_id == mine.id)).scalars()
    words = [mine.name, *logins, *subjects]
    if not (
        mine.who.isalpha() and mine.who == folded(mine.name)
    ):  # else it is the name, written as any other word
        words.append(mine.who)
    words += [str(value) for title, value in (mine.columns or {}).items() if identifies(title)]
    words += [row.student for row in connection.execute(issued)]
    return frozenset(word.strip() for word in words if word and word.strip())


def conditions(
    connection: Connection, known_as: PersonIdentifiers
) -> dict[str, tuple[Table, ColumnElement[bool]]]:
    """Return the condition that selects the person's rows of each table, in an order in which they can be
    deleted."""
    submissions = select(submission.c.id).where(submission.c.person_id == known_as.person)
    markings = ids_of(connection, marking, known_as)
    own_answers = or_(
        answer.c.submission_id.in_(submissions), answer.c.id.in_(_answers(connection, known_as))
    )
    return {
        "mark": (mark, mark.c.marking_id.in_(markings)),
        "marking": (marking, marking.c.id.in_(markings)),
        "decision": (decision, decision.c.id.in_(ids_of(connection, decision, known_as))),
        "answer": (answer, own_answers),
        "drawing": (drawing, drawing.c.submission_id.in_(submissions)),
        "rejected": (rejected, rejected.c.id.in_(_rejected(connection, known_as))),
        "submission": (submission, submission.c.person_id == known_as.person),
        "scanned": (scanned, scanned.c.id.in_(ids_of(connection, scanned, known_as))),
        "typed": (typed, typed.c.id.in_(ids_of(connection, typed, known_as))),
        "issue": (
            issue,
            or_(
                issue.c.person_id == known_as.person,
                issue.c.id.in_(_assigned(connection, known_as)),
            ),
        ),
        "extension": (extension, extension.c.person_id == known_as.person),
        "paper_start": (paper_start, paper_start.c.person_id == known_as.person),
        "draft": (draft, draft.c.person_id == known_as.person),
        "prepared": (prepared, prepared.c.person_id == known_as.person),
        "progress": (progress, progress.c.person_id == known_as.person),
        "lti_session": (lti_session, launch_sessions(known_as.person)),
        "lti_launch": (lti_launch, lti_launch.c.person_id == known_as.person),
        "identity": (identity, identity.c.person_id == known_as.person),
        "session": (session, session.c.person_id == known_as.person),
        "area": (area, area.c.person_id == known_as.person),
        "account": (account, account.c.person_id == known_as.person),
        "person": (person, person.c.id == known_as.person),
    }


def launch_sessions(person_id: int) -> ColumnElement[bool]:
    """Return the condition that selects the sessions of a person in frames of platforms."""
    mine = identity.c.issuer == lti_session.c.issuer, identity.c.subject == lti_session.c.subject
    return exists().where(identity.c.person_id == person_id, *mine)


def ids_of(connection: Connection, table: Table, known_as: PersonIdentifiers) -> list[int]:
    """Return the ids of the person's rows in a table with the columns assignment and student."""
    numbers = {number for number, _ in known_as.students}
    query = select(table.c.id, table.c.assignment_id, table.c.student).where(
        table.c.assignment_id.in_(numbers)
    )
    return _named(connection, query, known_as)


def _named(connection: Connection, query: Select[Any], known_as: PersonIdentifiers) -> list[int]:
    """Return the ids of the person's rows among those of a query; every name that occurs is compared once."""
    student = query.selected_columns.student
    names = {name for _, name in known_as.students}
    occurring = connection.execute(query.with_only_columns(student).distinct()).scalars()
    theirs = query.where(student.in_([name for name in occurring if folded(name) in names]))
    rows = connection.execute(theirs)
    return [row.id for row in rows if known_as.answers_to(row.assignment_id, row.student)]


def _assigned(connection: Connection, known_as: PersonIdentifiers) -> list[int]:
    """Return the ids of the variants issued under the person's name without a roster."""
    query = (
        select(issue.c.id, issue.c.student, variant.c.assignment_id)
        .join(variant)
        .where(issue.c.person_id.is_(None), issue.c.student != "")
    )
    return _named(connection, query, known_as)


def _answers(connection: Connection, known_as: PersonIdentifiers) -> list[int]:
    numbers = {number for number, _ in known_as.students}
    query = (
        select(answer.c.id, submission.c.assignment_id, answer.c.student)
        .join(submission)
        .where(submission.c.assignment_id.in_(numbers))
    )
    return _named(connection, query, known_as)


def _rejected(connection: Connection, known_as: PersonIdentifiers) -> list[int]:
    """Return the ids of rejected rows that name this person."""
    names = {folded(word) for word in known_as.words}
    ids = []
    for row in connection.execute(select(rejected.c.id, rejected.c.row)):
        cells = row.row.values() if isinstance(row.row, Mapping) else ()
        if any(isinstance(cell, str) and folded(cell) in names for cell in cells):
            ids.append(row.id)
    return ids


def personal_data(connection: Connection, known_as: PersonIdentifiers) -> dict[str, list[dict[str, Any]]]:
    """Return all stored data of a person: the rows of each table, and the audit entries about the person."""
    data, chosen_by = {}, conditions(connection, known_as)
    for name, (table, mine) in reversed(chosen_by.items()):
        columns = [column for column in table.c if column.name not in _HIDDEN.get(name, ())]
        chosen = select(*columns).where(mine).order_by(*table.primary_key)
        data[name] = [dict(row._mapping) for row in connection.execute(chosen)]
    data["issue"] = _papers(connection, chosen_by["issue"][1])
    noted = connection.execute(select(audit).order_by(audit.c.id))
    data["audit"] = [_of_audit(row, known_as) for row in noted if _tells_of(row, known_as)]
    return data


def _of_audit(row: Any, known_as: PersonIdentifiers) -> dict[str, Any]:
    """Return an entry of the audit log; with the address only if the person acted."""
    entry = dict(row._mapping)
    return entry if row.actor == known_as.person else {**entry, "address": None}


def _tells_of(row: Any, known_as: PersonIdentifiers) -> bool:
    about = row.about if isinstance(row.about, Mapping) else {}
    people = about.get("people")
    return (
        (known_as.name != "" and row.by == known_as.name)
        or about.get("person") == known_as.person
        or (isinstance(people, list) and known_as.person in people)
    )


def _papers(connection: Connection, mine: ColumnElement[bool]) -> list[dict[str, Any]]:
    """Return the variants issued to the person, with their given values."""
    query = (
        select(
            assignment.c.id.label("assignment_id"),
            assignment.c.name.label("assignment"),
            issue.c.student,
            issue.c.sitting,
            issue.c.lang,
            variant.c.exercise,
            variant.c.seed,
            variant.c.record,
        )
        .select_from(issue.join(variant).join(assignment))
        .where(mine)
        .order_by(issue.c.id)
    )
    return [dict(row._mapping) for row in connection.execute(query)]
