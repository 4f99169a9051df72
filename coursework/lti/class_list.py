"""A platform's roster as the CSV that ``coursework build --roster`` reads."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from coursework.lti.roles import Role
from coursework.lti.services import Member
from coursework.making.students import folded
from coursework.system.tables import csv_text

COLUMNS = ("student", "email", "number", "lti_user_id")


def students(members: Iterable[Member]) -> list[Member]:
    """Return the active students of a roster, sorted by name."""
    found = [one for one in members if one.role is Role.STUDENT and one.active]
    return sorted(found, key=lambda one: (folded(one.name), one.person))


def as_csv(members: Iterable[Member]) -> str:
    """Return the class list as CSV, one line per student; two students of one name are distinguished by
    e-mail, number or identifier."""
    found = students(members)
    alike = Counter(folded(one.name) for one in found)
    rows = []
    for one in found:
        apart = one.email or one.number or one.person
        name = one.name if one.name and alike[folded(one.name)] == 1 else f"{one.name} ({apart})".strip()
        rows.append(dict(zip(COLUMNS, (name, one.email, one.number, one.person), strict=True)))
    return csv_text(rows, COLUMNS)
