"""Receipts of submissions: a code, a time, a digest, and the submitted answers."""

from __future__ import annotations

import json
from collections.abc import Sequence
from datetime import timedelta
from typing import Any, NamedTuple

from sqlalchemy import Connection
from starlette.responses import Response

from coursework.database.areas import may_for
from coursework.database.instructor_queries import people_of
from coursework.database.jobs import job_of, jobs_before
from coursework.database.permissions import Permission
from coursework.database.submissions import Submission, answers_of
from coursework.language.words import words
from coursework.site.frame.requests import HTTPException, Request, Route
from coursework.site.frame.responses import Download
from coursework.site.frame.times import exact_text, length_text, zone_name
from coursework.site.papers.submission import digest, submission_of_receipt


def receipt_content(connection: Connection, row: Any, assignment: str, student: str) -> dict[str, Any]:
    """Return the content of a submission's receipt."""
    handed = answers_of(connection, row.id)
    return {
        "receipt": row.receipt,
        "assignment": assignment,
        "student": student,
        "number": row.number,
        "handed_in": row.received_at.isoformat(timespec="seconds"),
        "late_seconds": row.late,
        "answered": sum(bool(answer[3].strip()) for answer in handed),
        "asked": len(handed),
        "sha256": digest(handed),
        "answers": handed,
    }


def as_text(request: Request, content: dict[str, Any], row: Any) -> str:
    """Return a receipt as text."""
    texts = words(request.lang, "site")["receipts"]
    lines = [
        texts["title"],
        "",
        f"{texts['code']}: {content['receipt']}",
        f"{texts['assignment']}: {content['assignment']}",
        f"{texts['student']}: {content['student']}",
        f"{texts['came']}: {exact_text(row.received_at, request.lang)} ({zone_name(row.received_at)})",
        *([f"{texts['late']}: {length_text(timedelta(seconds=row.late), request.lang)}"] if row.late else []),
        f"{texts['answered']}: {content['answered']} / {content['asked']}",
        f"SHA-256: {content['sha256']}",
        "",
        *(
            f"{exercise} {seed} {part}: {' '.join(answer.split())}"
            for exercise, seed, part, answer in content["answers"]
        ),
        "",
        texts["how"],
        "",
    ]
    return "\n".join(lines)


def find(done: Sequence[Submission], code: str) -> Submission:
    """Return the submission with a receipt among a person's own.

    Raises
    ------
    HTTPException
        There is none, or it belongs to another person.
    """
    for submission in done:
        if submission.receipt and submission.receipt == code.strip().upper():
            return submission
    raise HTTPException("own", 404)


#: Seconds until a page reloads: minimum, addition for each earlier submission, maximum.
_SOON, _EACH, _LONGEST = (3.0, 0.2, 60.0)


class PendingMarking(NamedTuple):
    """Submission without marks."""

    message: str
    seconds: int  #: until the page reloads; 0 if reloading is useless
    ahead: int = 0  #: submissions that are marked before


def pending_marking(request: Request, submission: int) -> PendingMarking | None:
    """Return the message for a submission that waits for its marks; None if it is marked."""
    messages = request.words["assignments"]
    with request.site.store.reading() as connection:
        job = job_of(connection, submission)
        if job is None or not request.site.has_worker:
            return None
        if job.fault:
            return PendingMarking(str(messages["not_marked"]), 0)
        ahead = jobs_before(connection, job)
    seconds = round(min(_LONGEST, _SOON + _EACH * ahead))
    message = str(messages["being_marked"]).format(length_text(timedelta(seconds=seconds), request.lang))
    return PendingMarking(message, seconds, ahead)


def file(request: Request) -> Response:
    """Return a receipt as a file, as text or as JSON."""
    with request.site.store.reading() as connection:
        row = submission_of_receipt(
            connection, str(request.path_params["code"]), int(request.path_params["number"])
        )
        if row is None or row.person_id != request.user.id:
            raise HTTPException("own", 404)
        content = receipt_content(connection, row, row.assignment, row.student)
    if request.path_params["ending"] == "json":
        data = json.dumps(content, ensure_ascii=False, indent=1).encode("utf-8", "backslashreplace")
        return Download(data, "application/json", f"receipt-{row.receipt}.json")
    if request.path_params["ending"] != "txt":
        raise HTTPException("page", 404)
    data = as_text(request, content, row).encode("utf-8", "backslashreplace")
    return Download(data, "text/plain; charset=utf-8", f"receipt-{row.receipt}.txt")


def verify(request: Request) -> Response:
    """Return the submission of a receipt, for staff: look up its code, and compare a digest."""
    code, content_digest = (
        request.query_params.get("code", "")[:40],
        request.query_params.get("digest", "").strip().lower()[:80],
    )
    row = content = None
    if code:
        with request.site.store.begin() as connection:
            row = submission_of_receipt(connection, code)
            if row is not None and not _is_theirs(request, connection, row):
                row = None
            request.note(connection, "receipt looked up", code=code, found=row is not None)
            content = None if row is None else receipt_content(connection, row, row.assignment, row.student)
    names: dict[str, Any] = {"code": code, "row": row, "content": content, "digest": content_digest}
    if row is not None:
        names |= {"came": exact_text(row.received_at, request.lang), "zone": zone_name(row.received_at)}
        names["late"] = length_text(timedelta(seconds=row.late), request.lang) if row.late else ""
    return request.render("site/student/receipt_check", **names)


def _is_theirs(request: Request, connection: Connection, row: Any) -> bool:
    """Return True if the current user may look up receipts of the student."""
    number, issued_to = row.assignment_id, people_of(connection, row.assignment_id).items()
    names = [name for name, person in issued_to if person == row.person_id] or [row.student]
    return any(may_for(connection, request.user, Permission.RECEIPTS_CHECK, number, name) for name in names)


ROUTES = (
    Route("/assignments/{number:int}/receipts/{code}.{ending}", file, Permission.OWN, limit="paper"),
    Route("/desk/receipts", verify, Permission.RECEIPTS_CHECK),
)
