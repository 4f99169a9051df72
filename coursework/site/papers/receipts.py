"""Receipts of submissions: a code, a time, a digest, and the submitted answers."""

from __future__ import annotations

import json
from collections.abc import Sequence
from datetime import timedelta
from typing import Any

from sqlalchemy import Connection

from coursework.database.areas import may_for
from coursework.database.audit import note
from coursework.database.deliveries import Delivery, answers_of
from coursework.database.desk import people_of
from coursework.database.permissions import Permission
from coursework.language.words import words
from coursework.site.frame.moments import exact_text, length_text, zone_name
from coursework.site.frame.visits import Page, Refused, Reply, Visit
from coursework.site.papers.handing_in import digest, receipt_called


def told_of(connection: Connection, row: Any, assignment: str, student: str) -> dict[str, Any]:
    """Return the content of a submission's receipt."""
    handed = answers_of(connection, row.id)
    return {
        "receipt": row.receipt,
        "assignment": assignment,
        "student": student,
        "number": row.number,
        "handed_in": row.came.isoformat(timespec="seconds"),
        "late_seconds": row.late,
        "answered": sum(bool(one[3].strip()) for one in handed),
        "asked": len(handed),
        "sha256": digest(handed),
        "answers": handed,
    }


def as_text(visit: Visit, told: dict[str, Any], row: Any) -> str:
    """Return a receipt as text."""
    said = words(visit.lang, "site")["receipts"]
    lines = [
        said["title"], "",
        f"{said['code']}: {told['receipt']}",
        f"{said['assignment']}: {told['assignment']}",
        f"{said['student']}: {told['student']}",
        f"{said['came']}: {exact_text(row.came, visit.lang)} ({zone_name(row.came)})",
        *([f"{said['late']}: {length_text(timedelta(seconds=row.late), visit.lang)}"] if row.late else []),
        f"{said['answered']}: {told['answered']} / {told['asked']}",
        f"SHA-256: {told['sha256']}", "",
        *(f"{exercise} {seed} {part}: {' '.join(answer.split())}" for exercise, seed, part, answer in told["answers"]),
        "", said["how"], "",
    ]  # fmt: skip
    return "\n".join(lines)


def find(done: Sequence[Delivery], code: str) -> Delivery:
    """Return the submission with a receipt among a person's own.

    Raises
    ------
    Refused
        There is none: it may be somebody else's.
    """
    for one in done:
        if one.receipt and one.receipt == code.strip().upper():
            return one
    raise Refused("own", 404)


def file(visit: Visit) -> Reply:
    """Return a receipt as a file, as text or as JSON."""
    with visit.site.store.reading() as connection:
        row = receipt_called(connection, str(visit.path["code"]), int(visit.path["number"]))
        if row is None or row.person_id != visit.who.id:
            raise Refused("own", 404)
        told = told_of(connection, row, row.assignment, row.student)
    if visit.path["ending"] == "json":
        data = json.dumps(told, ensure_ascii=False, indent=1).encode("utf-8", "backslashreplace")
        return Reply(kind="application/json", data=data, file=f"receipt-{row.receipt}.json")
    if visit.path["ending"] != "txt":
        raise Refused("page", 404)
    data = as_text(visit, told, row).encode("utf-8", "backslashreplace")
    return Reply(kind="text/plain; charset=utf-8", data=data, file=f"receipt-{row.receipt}.txt")


def verify(visit: Visit) -> Reply:
    """Return the submission of a receipt, for staff: look up its code, and compare a digest."""
    code, told_digest = visit.query.get("code", "")[:40], visit.query.get("digest", "").strip().lower()[:80]
    row = told = None
    if code:
        with visit.site.store.begin() as connection:
            row = receipt_called(connection, code)
            if row is not None and not _is_theirs(visit, connection, row):
                row = None
            note(connection, visit.at, visit.actor, "receipt looked up", code=code, found=row is not None)
            told = None if row is None else told_of(connection, row, row.assignment, row.student)
    names: dict[str, Any] = {"code": code, "row": row, "told": told, "digest": told_digest}
    if row is not None:
        names |= {"came": exact_text(row.came, visit.lang), "zone": zone_name(row.came)}
        names["late"] = length_text(timedelta(seconds=row.late), visit.lang) if row.late else ""
    return visit.page("site_receipt_check", **names)


def _is_theirs(visit: Visit, connection: Connection, row: Any) -> bool:
    """Return whether who asks may look up a receipt of this student."""
    number, issued_to = row.assignment_id, people_of(connection, row.assignment_id).items()
    names = [name for name, person in issued_to if person == row.person_id] or [row.student]
    return any(may_for(connection, visit.who, Permission.RECEIPTS_CHECK, number, name) for name in names)


PAGES = (
    Page("/assignments/{number:int}/receipts/{code}.{ending}", file, Permission.OWN, limit="paper"),
    Page("/desk/receipts", verify, Permission.RECEIPTS_CHECK),
)
