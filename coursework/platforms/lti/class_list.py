"""A platform's roster as the CSV that ``coursework build --roster`` reads."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from coursework.issuing.students import folded
from coursework.platforms.lti.roles import Role
from coursework.platforms.lti.services import Member
from coursework.system.tables import csv_text

COLUMNS = ("student", "email", "number", "lti_user_id")


def students(members: Iterable[Member]) -> list[Member]:
    """Return the active students of a roster, sorted by name."""
    active = [member for member in members if member.role is Role.STUDENT and member.active]
    return sorted(active, key=lambda member: (folded(member.name), member.person))


def as_csv(members: Iterable[Member]) -> str:
    """Return the class list as CSV, one line per student; two students of one name are distinguished by
    e-mail, number or identifier."""
    active = students(members)
    alike = Counter(folded(member.name) for member in active)
    rows = []
    for member in active:
        apart = member.email or member.number or member.person
        name = (
            member.name
            if member.name and alike[folded(member.name)] == 1
            else f"{member.name} ({apart})".strip()
        )
        rows.append(dict(zip(COLUMNS, (name, member.email, member.number, member.person), strict=True)))
    return csv_text(rows, COLUMNS)
