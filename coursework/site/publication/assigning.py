"""Jobs that assign variants to a class, in a separate process so that no student waits for them.

The state of a job is in the database, so that every process of the site can show it.
"""

from __future__ import annotations

import secrets
import threading
from collections.abc import Mapping, Sequence
from contextvars import copy_context
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from typing import Any, NamedTuple

from sqlalchemy import update

from coursework.course.course import opened
from coursework.course.variant import Variant
from coursework.database.assignments import put_issued
from coursework.database.audit import note
from coursework.database.settings import put_value, value_of
from coursework.database.tables import assignment
from coursework.errors import CourseworkError
from coursework.issuing.assignment import assignment_of
from coursework.issuing.issued import SECRET, issued_content
from coursework.issuing.roster import Student
from coursework.issuing.variant_assignment import assign_variants
from coursework.messages import localised
from coursework.site.frame.settings import Site
from coursework.site.papers.opening import prepare_soon
from coursework.system.processes import processes, workers

_ALONE = 40  #: sheets that are assigned faster than a process starts
_PATIENCE = 1.5  #: seconds for which the request waits for the job
_GIVEN_UP = timedelta(minutes=20)  #: after which an unfinished job counts as interrupted
RUNNING, DONE, FAILED = "running", "done", "failed"


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


class AssigningJob(NamedTuple):
    """State of a job that assigns variants."""

    state: str
    name: str
    papers: int
    number: int = 0  #: id of the assignment, at the end
    messages: tuple[str, ...] = ()  #: notes, or reasons of a failure

    @property
    def is_over(self) -> bool:
        return self.state != RUNNING


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
    _store_state(site, token, AssigningJob(RUNNING, wanted.name, wanted.papers))
    # The context has the reader's language, in which faults are stored.
    thread = threading.Thread(
        target=copy_context().run, args=(_run, site, token, wanted, by, event), daemon=True
    )
    thread.start()
    thread.join(_PATIENCE)
    return token


def assigning_job(site: Site, token: str) -> AssigningJob | None:
    """Return the state of a job; None for an unknown one. An interrupted job counts as failed: none of its
    variants were issued."""
    with site.store.reading() as connection:
        stored = value_of(connection, _key(token))
    if stored is None:
        return None
    state, name, papers, number, messages = stored["dealing"]
    job = AssigningJob(state, name, papers, number, tuple(messages))
    if not job.is_over and site.clock() - datetime.fromisoformat(stored["at"]) > _GIVEN_UP:
        return job._replace(state=FAILED)
    return job


def _key(token: str) -> str:
    return f"dealing {token[:40]}"


def _store_state(site: Site, token: str, now: AssigningJob) -> None:
    with site.store.begin() as connection:
        put_value(connection, _key(token), {"dealing": list(now), "at": site.clock().isoformat()})


def _run(site: Site, token: str, wanted: AssignmentRequest, by: str, event: str) -> None:
    begun = AssigningJob(RUNNING, wanted.name, wanted.papers)
    try:
        outcome = _assigned_in_process(site, wanted)
        number = _store(site, wanted, outcome, by, event)
        _store_state(
            site,
            token,
            begun._replace(state=DONE, number=number, messages=tuple(map(localised, outcome.notes))),
        )
    except CourseworkError as fault:
        _store_state(site, token, begun._replace(state=FAILED, messages=(str(fault),)))
    except Exception as fault:  # the page reports it, since nobody waits for this thread
        _store_state(site, token, begun._replace(state=FAILED, messages=(type(fault).__name__,)))


def _assigned_in_process(site: Site, wanted: AssignmentRequest) -> _Outcome:
    """Assign variants, in another process if there are many."""
    root = str(site.course.folder.root)
    if wanted.papers <= _ALONE or workers(2) < 2:
        return _assigned(root, wanted)
    with processes(1) as submit:
        outcome: _Outcome = submit(_assigned, root, wanted).result()
        return outcome


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
        definition = {
            key: value for key, value in wanted.table.items() if key != SECRET
        }  # it has its own column
        connection.execute(update(assignment).where(assignment.c.id == number).values(asked=definition))
        prepare_soon(site, connection, number)
        note(
            connection, site.clock(), by, event, assignment=wanted.name, students=len(wanted.students),
            make_up=list(wanted.make_up),
        )  # fmt: skip
    return number
