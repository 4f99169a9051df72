"""Roles of people on the site, and the permissions of each role.

The roles and permissions are data: :data:`PERMISSIONS` is the whole table. An assistant has the permissions
of the table in named assignments and groups alone (:class:`Area`); everybody else has theirs everywhere.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from typing import NamedTuple, Protocol

STUDENT, ASSISTANT, INSTRUCTOR, ADMINISTRATOR = "student", "assistant", "instructor", "administrator"
ROLES = (STUDENT, ASSISTANT, INSTRUCTOR, ADMINISTRATOR)  #: each with all permissions of those before it
STAFF = frozenset(ROLES) - {STUDENT}


class Permission(StrEnum):
    """Permission that a page requires."""

    PUBLIC = "public"  #: pages that everybody sees, signed in or not
    OWN = "own"  #: practice, one's own papers, account and data
    DESK = "desk.open"  #: the list of assignments that one marks
    MARKS_READ = "marks.read"  #: class, questions, students, statistics
    MARKS_DECIDE = "marks.decide"  #: the queue, decisions on answers, rejected rows
    MARKS_EXPORT = "marks.export"  #: tables, feedback, gradebooks of platforms
    SCANS_READ = "scans.read"  #: scanned pages and their pictures
    SCANS_TYPE = "scans.type"  #: what could not be read on a scan
    RECEIPTS_CHECK = "receipts.check"
    MARKS_REGRADE = "marks.regrade"  #: of a whole class, after a correction
    FILES_BRING = "files.bring"  #: answers, rosters, what was issued elsewhere
    SCANS_BRING = "scans.bring"
    ASSIGNMENTS_READ = "assignments.read"  #: papers, dates, extensions, before and after they open
    ASSIGNMENTS_PUBLISH = "assignments.publish"  #: hand out, publish, extend, make-ups
    PRACTICE_ANY = "practice.any"  #: every variant with its solution, those of exams too
    PLATFORMS_READ = "platforms.read"  #: points on their way to learning platforms
    PEOPLE_READ = "people.read"
    PEOPLE_ADD = "people.add"  #: students, by name or by roster
    PEOPLE_INVITE_STUDENTS = "people.invite_students"  #: links by which a student chooses a password
    PEOPLE_INVITE_STAFF = "people.invite_staff"  #: links by which somebody of the staff does
    PEOPLE_ROLES = "people.roles"  #: another role, groups and assignments of assistants
    PEOPLE_EXPORT = "people.export"  #: all data of a person
    PEOPLE_ERASE = "people.erase"
    AUDIT_READ = "audit.read"


_VISITOR = frozenset({Permission.PUBLIC})
_STUDENT = _VISITOR | {Permission.OWN}
_ASSISTANT = _STUDENT | {
    Permission.DESK,
    Permission.MARKS_READ,
    Permission.MARKS_DECIDE,
    Permission.MARKS_EXPORT,
    Permission.SCANS_READ,
    Permission.SCANS_TYPE,
    Permission.RECEIPTS_CHECK,
}
_INSTRUCTOR = _ASSISTANT | {
    Permission.MARKS_REGRADE,
    Permission.FILES_BRING,
    Permission.SCANS_BRING,
    Permission.ASSIGNMENTS_READ,
    Permission.ASSIGNMENTS_PUBLISH,
    Permission.PRACTICE_ANY,
    Permission.PLATFORMS_READ,
    Permission.PEOPLE_READ,
    Permission.PEOPLE_ADD,
    Permission.PEOPLE_INVITE_STUDENTS,
}

#: The permissions of each role; ``""`` is that of visitors who are not signed in.
PERMISSIONS: Mapping[str, frozenset[Permission]] = {
    "": _VISITOR,
    STUDENT: _STUDENT,
    ASSISTANT: _ASSISTANT,
    INSTRUCTOR: _INSTRUCTOR,
    ADMINISTRATOR: frozenset(Permission),
}


class Area(NamedTuple):
    """Assignment and group in which an assistant works."""

    assignment: int | None = None  #: every one, where none is named
    group: str | None = None  #: the whole class, where none is named; as :func:`group_key` writes it


class PermissionHolder(Protocol):
    """Holder of permissions: a role, with areas for an assistant."""

    @property
    def role(self) -> str: ...

    @property
    def areas(self) -> tuple[Area, ...]: ...  # of an assistant


def group_key(group: str) -> str:
    """Return a group's name in the form in which groups are compared, without differences of case and
    spaces."""
    return " ".join(group.split()).casefold()


def may(
    holder: PermissionHolder | None,
    permission: Permission,
    assignment: int | None = None,
    group: str | None = None,
) -> bool:
    """Return True if somebody has a permission; in a given assignment, for a student of a given group.

    Parameters
    ----------
    holder
        Person who asks; None if nobody is signed in.
    permission
        Permission to check.
    assignment
        Id of the assignment; None for any.
    group
        Group of the student, empty for none; None for any student of the assignment.
    """
    role = "" if holder is None else holder.role
    if permission not in PERMISSIONS.get(role, _STUDENT):
        return False
    if holder is None or role != ASSISTANT or permission in _STUDENT:
        return True
    key = None if group is None else group_key(group)
    return any(
        area.assignment in (None, assignment or area.assignment)
        and (key is None or area.group in (None, key))
        for area in holder.areas
    )


def groups_within(holder: PermissionHolder, assignment: int) -> frozenset[str] | None:
    """Return the groups of an assignment to which somebody is limited; None for the whole class."""
    if holder.role != ASSISTANT:
        return None
    groups = {area.group for area in holder.areas if area.assignment in (None, assignment)}
    return None if None in groups else frozenset(group for group in groups if group is not None)


def is_of_staff(permission: Permission) -> bool:
    """Return True if no student has a permission."""
    return permission not in _STUDENT


def to_invite(role: str) -> Permission:
    """Return the permission required to invite somebody of a role."""
    return Permission.PEOPLE_INVITE_STAFF if role in STAFF else Permission.PEOPLE_INVITE_STUDENTS
