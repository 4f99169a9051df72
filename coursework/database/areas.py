"""Areas of assistants, by assignment and group, and the students of an assignment within them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import Any

from sqlalchemy import Connection, delete, insert, select

from coursework.database.permissions import (
    ASSISTANT,
    Area,
    Permission,
    PermissionHolder,
    group_key,
    groups_within,
    may,
)
from coursework.database.tables import area, assignment, issue, person, variant
from coursework.errors import bare_letters
from coursework.issuing.identity import GROUP, is_called

_GROUP = (*GROUP, "section")  #: titles of the roster's column of groups


def areas_of(connection: Connection, number: int) -> tuple[Area, ...]:
    """Return the assignments and groups in which a person assists."""
    query = select(area).where(area.c.person_id == number).order_by(area.c.id)
    return tuple(Area(row.assignment_id, row.class_group) for row in connection.execute(query))


def put_areas(connection: Connection, number: int, areas: Iterable[Area]) -> None:
    """Replace the areas in which a person assists."""
    connection.execute(delete(area).where(area.c.person_id == number))
    rows = [
        {"person_id": number, "assignment_id": assigned.assignment, "class_group": assigned.group}
        for assigned in dict.fromkeys(areas)
    ]
    if rows:
        connection.execute(insert(area), rows)


def group_of(columns: Mapping[str, Any] | None) -> str:
    """Return the group in a line of a roster, as it is written; empty if it names none."""
    groups = (
        str(value).strip() for title, value in (columns or {}).items() if value and is_called(title, _GROUP)
    )
    return next(groups, "")


def groups_known(connection: Connection) -> dict[str, str]:
    """Return every group of the rosters as it is written, by its key."""
    groups = [group_of(row.columns) for row in connection.execute(select(person.c.columns))]
    for row in connection.execute(select(assignment.c.columns)):
        groups += [group_of(columns) for columns in (row.columns or {}).values()]
    return {group_key(group): group for group in sorted(groups, reverse=True) if group}


def group_names(connection: Connection, number: int) -> dict[str, str]:
    """Return the groups of an assignment's students as they are written, by their keys, in order."""
    names = {name for name in _groups_as_written(connection, number).values() if name}
    return {group_key(name): name for name in sorted(names, key=lambda name: (bare_letters(name), name))}


def groups_of(connection: Connection, number: int) -> dict[str, str]:
    """Return the key of the group of each student of an assignment: from its own roster, else from the
    columns of the person."""
    return {student: group_key(group) for student, group in _groups_as_written(connection, number).items()}


def _groups_as_written(connection: Connection, number: int) -> dict[str, str]:
    columns = connection.execute(select(assignment.c.columns).where(assignment.c.id == number)).scalar() or {}
    given = (
        select(issue.c.student, person.c.id, person.c.columns)
        .select_from(issue.join(variant).outerjoin(person))
        .where(variant.c.assignment_id == number)
    )
    groups = {row.student: group_of(row.columns) for row in connection.execute(given)}
    for student, student_columns in columns.items():
        groups[student] = group_of(student_columns) or groups.get(student, "")
    return groups


def students_within(connection: Connection, holder: PermissionHolder, number: int) -> frozenset[str] | None:
    """Return the students of an assignment whom a member of the staff may see, by the names as issued; None
    for all of them."""
    groups = groups_within(holder, number)
    if groups is None:
        return None
    return students_in(connection, number, groups)


def may_for(
    connection: Connection, holder: PermissionHolder, permission: Permission, number: int, student: str
) -> bool:
    """Return True if somebody has a permission for a student of an assignment, given by the name as
    issued."""
    if not may(holder, permission, number):
        return False
    within = students_within(connection, holder, number)
    return within is None or student in within


def students_in(connection: Connection, number: int, groups: Collection[str]) -> frozenset[str]:
    """Return the students of an assignment who are in one of the given groups."""
    if not groups:
        return frozenset()
    return frozenset(student for student, group in groups_of(connection, number).items() if group in groups)


def areas_for_role(connection: Connection, number: int, role: str) -> tuple[Area, ...]:
    """Return the areas of a person with a role: those of an assistant, none of others."""
    return areas_of(connection, number) if role == ASSISTANT else ()
