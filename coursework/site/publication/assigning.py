"""Jobs that assign variants to a class, in a separate process so that no student waits for them."""

from __future__ import annotations

import secrets
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from sqlalchemy import update

from coursework.course.course import opened
from coursework.course.variant import Variant
from coursework.database.assignments import put_issued
from coursework.database.audit import note
from coursework.database.tables import assignment
from coursework.issuing.assignment import assignment_of
from coursework.issuing.issued import SECRET, issued_content
from coursework.issuing.roster import Student
from coursework.issuing.variant_assignment import assign_variants
from coursework.messages import localised
from coursework.site.frame import jobs
from coursework.site.frame.jobs import Job
from coursework.site.frame.settings import Site
from coursework.site.papers.opening import prepare_soon

_ALONE = 40  #: sheets that are assigned faster than a process starts


@dataclass(frozen=True)
class AssignmentRequest:
    """Request to assign variants: an assignment as its file states it, and the students."""

    name: str
    table: Mapping[str, Any]
    students: Sequence[Student]
    lang: str
    before: Mapping[str, Any] | None = None  #: content issued before
    make_up: Sequence[str] = ()

    @property
    def papers(self) -> int:
        return len(self.students) * len(self.table.get("exercises", ()))


@dataclass
class _Outcome:
    content: dict[str, Any] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)


def holders(content: Mapping[str, Any]) -> list[Student]:
    """Return the students to whom something was issued, with the columns of their roster."""
    names = dict.fromkeys(str(item.get("student", "")) for item in content["issued"])
    return [Student(name, columns=content.get("students", {}).get(name, {})) for name in names if name]


def begin(site: Site, wanted: AssignmentRequest, by: str, event: str) -> str:
    """Start to assign variants for the person ``by``, with ``event`` in the audit; return the job's token at
    the end or after a short wait."""
    token = secrets.token_hex(8)
    jobs.begin(site, _key(token), wanted.name, wanted.papers, partial(_run, site, wanted, by, event))
    return token


def assigning_job(site: Site, token: str) -> Job | None:
    """Return the state of a job, whose result is the id of the assignment; None for an unknown one."""
    return jobs.stored_job(site, _key(token))


def _key(token: str) -> str:
    return f"dealing {token[:40]}"


def _run(site: Site, wanted: AssignmentRequest, by: str, event: str) -> tuple[int, tuple[str, ...]]:
    root = str(site.course.folder.root)
    outcome = _assigned(root, wanted) if wanted.papers <= _ALONE else jobs.apart(_assigned, root, wanted)
    return _store(site, wanted, outcome, by, event), tuple(map(localised, outcome.notes))


def _assigned(root: str, wanted: AssignmentRequest) -> _Outcome:
    course = opened(root, Variant)
    definition = assignment_of(wanted.name, wanted.table, course)
    assigned = assign_variants(
        course, definition, wanted.students, [wanted.lang], wanted.before, wanted.make_up
    )
    return _Outcome(
        issued_content(assigned.issues, definition, definition.secret or assigned.secret), assigned.notes
    )


def _store(site: Site, wanted: AssignmentRequest, outcome: _Outcome, by: str, event: str) -> int:
    """Store all issued variants in one transaction; return the assignment's id."""
    with site.store.begin() as connection:
        number = put_issued(connection, outcome.content, wanted.name)
        # It has its own column.
        definition = {key: value for key, value in wanted.table.items() if key != SECRET}
        connection.execute(update(assignment).where(assignment.c.id == number).values(asked=definition))
        prepare_soon(site, connection, number)
        note(
            connection,
            site.clock(),
            by,
            event,
            assignment=wanted.name,
            students=len(wanted.students),
            make_up=list(wanted.make_up),
        )
    return number
