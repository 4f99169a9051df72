"""Submission of answers: stored once, even if a form is sent twice, opened twice, or sent again after a lost
connection.

A form contains the number of the submission that it is to become. A form with a number already in use
repeats that submission and makes no other. A row lock on the person serialises concurrent submissions.
"""

from __future__ import annotations

import hashlib
import json
import logging
from collections.abc import Callable, Sequence
from datetime import datetime
from typing import Any, NamedTuple

from sqlalchemy import Connection, func, select
from sqlalchemy.exc import DBAPIError
from sqlalchemy.exc import TimeoutError as NoConnection

from coursework.database.drafts import drafts
from coursework.database.jobs import MARK, drop_jobs, put_job
from coursework.database.marking import mark_submission
from coursework.database.people import lock_person
from coursework.database.prepared import drop_prepared
from coursework.database.publication import (
    Phase,
    StudentAssignment,
    is_over,
    passing,
    publications_of,
    published,
    record_passed_date,
    running,
    student_assignments,
)
from coursework.database.submissions import (
    Submission,
    answers_of,
    attempts_used,
    insert_submission,
    next_number,
    put_drawings,
    submissions_of,
)
from coursework.database.tables import draft, issue, person, submission, variant
from coursework.errors import CourseworkError
from coursework.figures.student_drawing import is_drawn
from coursework.gradebook.rows import AnswerRow, RowOrigin
from coursework.site.frame.clock import is_steady
from coursework.site.frame.requests import HTTPException
from coursework.site.frame.settings import Site
from coursework.site.papers.student_paper import StudentPaper, Texts, student_paper

LOG = logging.getLogger("coursework.site")
ON_THE_PAGE, IN_A_FILE, AS_SAVED = "site", "site: a file", "site: as saved when it closed"


class SubmissionResult(NamedTuple):
    """Result of a submitted form."""

    submission: Submission
    is_new: bool
    differs: bool = False  #: its answers differ from those submitted under its number


def sheet_of(assignment: StudentAssignment, paper: StudentPaper) -> str:
    """Return the key under which drafts of the paper are stored."""
    return (
        f"assignment/{assignment.id}" if paper.sitting == 1 else f"assignment/{assignment.id}/{paper.sitting}"
    )


def submit(
    site: Site,
    assignment: StudentAssignment,
    paper: StudentPaper,
    person_id: int,
    texts: Texts,
    number: int,
    at: datetime,
    source: str,
) -> SubmissionResult:
    """Submit the texts under the number that the form states.

    Raises
    ------
    HTTPException
        The assignment is not open, or no attempt is left.
    """
    with site.store.begin() as connection:
        lock_person(connection, person_id)
        (fresh,) = student_assignments(connection, person_id, assignment.id)
        result = store_submission(connection, site, fresh, paper, person_id, texts, number, at, source)
    if result.is_new:
        mark(site, result.submission.id)
    return result


def store_submission(
    connection: Connection,
    site: Site,
    assignment: StudentAssignment,
    paper: StudentPaper,
    person_id: int,
    texts: Texts,
    number: int,
    at: datetime,
    source: str,
) -> SubmissionResult:
    """Store a submission, in a transaction that locked the person's row before it read place and paper.

    Raises
    ------
    HTTPException
        The assignment is not open, or no attempt is left.
    """
    done = submissions_of(connection, assignment.id, person_id)
    before = done[number - 1] if number <= len(done) else None
    if before is not None:
        is_same = holds(connection, before, paper, texts)
        if is_same or before.source != AS_SAVED or not _takes(assignment, at, site.clock()):
            return SubmissionResult(before, False, not is_same)
    if done and holds(connection, done[-1], paper, texts):
        return SubmissionResult(done[-1], False)  # equal answers cost no attempt
    now = _check(connection, assignment, person_id, at, site.clock(), done)
    stored = _submit(connection, assignment, paper, person_id, texts, now, source)
    put_job(connection, MARK, assignment.id, site.clock(), submission=stored.id)
    return SubmissionResult(stored, True)


def holds(connection: Connection, stored: Submission, paper: StudentPaper, texts: Texts) -> bool:
    """Return True if a submission consists of these texts, by box."""
    return answers_of(connection, stored.id) == content_of(paper, texts)


def _takes(assignment: StudentAssignment, arrived: datetime, clock: datetime) -> bool:
    publication = assignment.publication
    return (
        publication is not None
        and assignment.own_publication.phase(publication.counted(arrived, clock)).takes
    )


def _check(
    connection: Connection,
    assignment: StudentAssignment,
    person_id: int,
    arrived: datetime,
    clock: datetime,
    done: Sequence[Submission],
) -> datetime:
    """Return the effective time, after a check that a submission is accepted then.

    A submission made automatically at the closing time costs no attempt, since an earlier one may still be
    waiting for the database.
    """
    if assignment.publication is None:
        raise HTTPException("own", 404)
    rules, now = assignment.own_publication, assignment.publication.counted(arrived, clock)
    if not rules.phase(now).takes:
        raise HTTPException("not_open", 409)
    rescued = sum(submission.source == AS_SAVED for submission in done)
    if (
        rules.tries is not None
        and attempts_used(connection, person_id, {assignment.id: done})[assignment.id] - rescued
        >= rules.tries
    ):
        raise HTTPException("no_try_left", 409)
    return now


def _submit(
    connection: Connection,
    assignment: StudentAssignment,
    paper: StudentPaper,
    person_id: int,
    texts: Texts,
    received_at: datetime,
    source: str,
) -> Submission:
    number = next_number(connection, assignment.id, person_id, paper.student)
    late = assignment.own_publication.late_seconds(received_at)
    rows = rows_for(paper, texts, number, received_at, source)
    stored = insert_submission(
        connection,
        assignment.id,
        rows,
        source=source,
        received_at=received_at,
        person_id=person_id,
        number=number,
        late=late,
    )
    if stored.is_new and paper.drawn:
        boxes = drafts(connection, person_id, sheet_of(assignment, paper))
        texts = {exercise: boxes[name].text for name, exercise in paper.drawn.items() if name in boxes}
        put_drawings(connection, stored, {name: text for name, text in texts.items() if is_drawn(text)})
    return stored


def mark(site: Site, submission_id: int, *, at_once: bool = False) -> None:
    """Mark a submission, unless a worker does; even then if its marks are wanted ``at_once``. The submission
    is already stored: after a fault, it is marked later."""
    if site.has_worker and not at_once:
        return
    try:
        mark_submission(site.course, site.store, submission_id)
        with site.store.begin() as connection:
            drop_jobs(connection, submission_id)
    except Exception as fault:  # the submission is confirmed even if marking fails
        LOG.error("submission %d is not marked yet: %s", submission_id, type(fault).__name__)


def rows_for(
    paper: StudentPaper, texts: Texts, number: int, received_at: datetime, source: str
) -> list[AnswerRow]:
    """Return a row for every question, including blank ones, so that the submission records the questions
    left blank."""
    origin = RowOrigin(sitting=number, submitted=received_at.isoformat(timespec="seconds"))
    return [
        AnswerRow(
            paper.student,
            field.exercise,
            str(field.seed),
            field.part,
            texts.get(name, ""),
            source,
            lang=field.lang,
            origin=origin,
        )
        for name, field in paper.fields.items()
    ]


# ---------------------------------------------------------------------- content


def content_of(paper: StudentPaper, texts: Texts) -> list[list[str]]:
    """Return the answers in the form of :func:`coursework.database.submissions.answers_of`."""
    return [
        [field.exercise, str(field.seed), field.part, texts.get(name, "")]
        for name, field in paper.fields.items()
    ]


def digest(answers: Sequence[Sequence[str]]) -> str:
    """Return the SHA-256 digest of the answers as compact JSON, which anybody can recompute."""
    text = json.dumps([list(answer) for answer in answers], ensure_ascii=False, separators=(",", ":"))
    return hashlib.sha256(text.encode("utf-8", "backslashreplace")).hexdigest()


# ----------------------------------------------------------------- closing time


def pass_dates(site: Site, at: datetime, *numbers: int) -> bool:
    """Record the passed dates of assignments, and submit saved answers at the closing time if the
    publication requires it; return True if a date had passed.

    If the site has a worker, the worker does this instead, even without any request.
    """
    if site.has_worker or not is_steady(site.clock):
        return False
    with site.store.reading() as connection:
        publications = publications_of(connection, numbers)
        passed = passing(connection, publications, dict.fromkeys(publications, at))
    for number in passed:
        close_passed(site, number, at)
    return bool(passed)


def close_passed(
    site: Site, number: int, at: datetime, failed: Callable[[int, Exception], None] | None = None
) -> None:
    """Submit the saved answers, then record the passed dates; in this order, so that nothing is lost if the
    process ends in between.

    Parameters
    ----------
    at
        Time up to which dates have passed.
    failed
        Called for each person whose answers could not be submitted; without it the fault is raised.
    """
    if not is_steady(site.clock):
        return
    with site.store.reading() as connection:
        publication = published(connection, number)
        if publication is None or not passing(connection, {number: publication}, {number: at}):
            return
        wrote = unsubmitted_persons(connection, number) if publication.takes_saved else []
        if publication.minutes is not None:  # each closes at another moment: only those that have
            begun = running(connection, {number: publication})[number]
            open_still = {paper.person for paper in begun if paper.end >= at}
            wrote = [person_id for person_id in wrote if person_id not in open_still]
    for person_id in wrote:
        try:
            rescue(site, number, person_id, at)
        except CourseworkError as fault:  # the drafts remain; the other people's are submitted
            if isinstance(fault.__cause__, (DBAPIError, NoConnection)):
                raise  # the database is unavailable: none was submitted
            LOG.error("what person %d saved is not handed in: %s", person_id, type(fault).__name__)
            if failed is not None:
                failed(person_id, fault)
        except Exception as fault:
            if failed is None:
                raise
            failed(person_id, fault)
    with site.store.begin() as connection:
        record_passed_date(connection, number, at)
        if is_over(connection, number, at):
            drop_prepared(connection, number)


def unsubmitted_persons(connection: Connection, number: int) -> list[int]:
    """Return the people with saved answers for an assignment and without a submission."""
    theirs = select(issue.c.person_id).join(variant).where(variant.c.assignment_id == number)
    wrote = select(draft.c.person_id).where(draft.c.sheet.like(f"assignment/{number}%"), draft.c.text != "")
    done = select(submission.c.person_id).where(
        submission.c.assignment_id == number, submission.c.person_id.is_not(None)
    )
    query = theirs.where(issue.c.person_id.in_(wrote), issue.c.person_id.not_in(done)).distinct()
    return list(connection.execute(query.order_by(issue.c.person_id)).scalars())


def rescue(site: Site, number: int, person_id: int, at: datetime) -> Submission | None:
    """Submit the saved answers of a person without a submission, once the assignment has closed for them;
    they are marked later.

    The submission counts from the time of the last draft.
    """
    with site.store.begin() as connection:
        lock_person(connection, person_id)
        stored = _saved(site, connection, number, person_id, at)
        if stored is not None:
            put_job(connection, MARK, number, site.clock(), submission=stored.id)
        return stored


def _saved(
    site: Site, connection: Connection, number: int, person_id: int, at: datetime
) -> Submission | None:
    (assignment,) = student_assignments(connection, person_id, number)
    if (
        assignment.publication is None
        or assignment.own_publication.phase(assignment.publication.now(at)) is not Phase.CLOSED
    ):
        return None
    if submissions_of(connection, number, person_id):
        return None
    lang = str(connection.execute(select(person.c.lang).where(person.c.id == person_id)).scalar() or "")
    paper = student_paper(
        connection, site.course, assignment, person_id, lang if lang in site.languages else site.languages[0]
    )
    boxes = drafts(connection, person_id, sheet_of(assignment, paper))
    texts = {name: box.text for name, box in boxes.items() if name in paper.fields}
    if not any(text.strip() for text in texts.values()):
        return None
    of_it = draft.c.person_id == person_id, draft.c.sheet == sheet_of(assignment, paper)
    changed = connection.execute(select(func.max(draft.c.changed)).where(*of_it)).scalar()
    ends = assignment.own_publication.ends or at
    return _submit(
        connection, assignment, paper, person_id, texts, min(_as_datetime(changed, ends), ends), AS_SAVED
    )


def _as_datetime(value: Any, otherwise: datetime) -> datetime:
    """Return a time that the database computed; ``otherwise`` if it computed none."""
    if isinstance(value, str):
        value = datetime.fromisoformat(value)
    if not isinstance(value, datetime):
        return otherwise
    return value if value.tzinfo else value.replace(tzinfo=otherwise.tzinfo)


# ------------------------------------------------------------------------- papers


def submission_of_receipt(connection: Connection, code: str, number: int | None = None) -> Any | None:
    """Return the submission of a receipt, with its assignment and its person; None for an unknown receipt."""
    from coursework.database.tables import assignment

    query = (
        select(
            submission,
            submission.c.received_at,
            assignment.c.name.label("assignment"),
            person.c.name.label("student"),
        )
        .join(assignment, assignment.c.id == submission.c.assignment_id)
        .join(person, person.c.id == submission.c.person_id)
        .where(submission.c.receipt == code.strip().upper(), submission.c.receipt != "")
    )
    if number is not None:
        query = query.where(submission.c.assignment_id == number)
    return connection.execute(query).first()
