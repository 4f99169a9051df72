"""Personal data: export, erasure, and the audit."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Callable, Mapping, Sequence
from datetime import datetime
from typing import Any, NamedTuple
from urllib.parse import urlencode

from sqlalchemy import Connection
from starlette.responses import Response

from coursework.database.accounts import is_last_administrator
from coursework.database.audit import Actor, kinds, note, noted
from coursework.database.erasing import erase
from coursework.database.people import people
from coursework.database.permissions import Permission
from coursework.database.personal_data import identifiers_of, personal_data
from coursework.database.publication import Phase
from coursework.issuing.students import file_stems
from coursework.language.words import words
from coursework.site.frame.requests import HTTPException, Request, Route
from coursework.site.frame.responses import Download, redirect
from coursework.site.papers.assignment_state import published_states
from coursework.site.people import scrubbing
from coursework.site.people.people_page import number, somebody
from coursework.system.tables import csv_text

_READ_ME = {"fr": "LISEZ-MOI.txt", "en": "README.txt"}
_LINES = 100  #: of the audit on a page

Rows = Sequence[Mapping[str, Any]]


# ------------------------------------------------------------------- export


def user_data(request: Request) -> Response:
    """Return all stored data of the current user; content that is not released yet is only mentioned."""
    with request.site.store.reading() as connection:
        return _given(request, connection, request.user.id, release_to(connection, request))


def their_data(request: Request) -> Response:
    """Return all stored data of a person, for staff."""
    with request.site.store.reading() as connection:
        person = somebody(request, connection)
        return _given(request, connection, person.id, full_release)


class Release(NamedTuple):
    """Released content of an assignment."""

    paper: bool = True
    marks: bool = True


def full_release(number: int) -> Release:
    """Return the content that staff may see: all of it."""
    return Release()


def release_to(connection: Connection, request: Request) -> Callable[[int], Release]:
    """Return the function that gives the released content of an assignment to the current user; nothing of an
    unpublished one."""
    if request.user.may(Permission.ASSIGNMENTS_READ):
        return full_release
    # A mark's sentence may say what is right.
    releases = {
        item.assignment.id: Release(
            item.phase is not Phase.TO_COME, item.releases("feedback") and item.releases("answers")
        )
        for item in published_states(request, connection)
    }
    return lambda number: releases.get(number, Release(False, False))


def _given(
    request: Request, connection: Connection, person: int, release_of: Callable[[int], Release]
) -> Response:
    owner = identifiers_of(connection, person)
    if owner is None:
        raise HTTPException("own", 404)
    tables = _withheld(personal_data(connection, owner), release_of)
    name = next(iter(file_stems([owner.name or "me"])))
    return Download(_zip(request, tables, owner.name), "application/zip", f"{name}.zip")


def _withheld(tables: Mapping[str, Rows], release_of: Callable[[int], Release]) -> dict[str, Rows]:
    """Return the tables without the content that is not released yet."""
    markings = {row["id"]: row["assignment_id"] for row in tables["marking"]}
    seen = {
        "issue": [row for row in tables["issue"] if release_of(row["assignment_id"]).paper],
        "marking": [row for row in tables["marking"] if release_of(row["assignment_id"]).marks],
        "mark": [row for row in tables["mark"] if release_of(markings[row["marking_id"]]).marks],
        "decision": [row for row in tables["decision"] if release_of(row["assignment_id"]).marks],
    }
    return {**tables, **seen}


def _zip(request: Request, tables: Mapping[str, Rows], name: str) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for lang in request.site.languages:
            archive.writestr(
                _READ_ME.get(lang, f"README.{lang}.txt"), _explained(tables, lang, name, request.received_at)
            )
        for table, rows in tables.items():
            if rows:
                archive.writestr(f"{table}.csv", _as_csv(rows))
        archive.writestr("everything.json", json.dumps(tables, ensure_ascii=False, indent=1, default=str))
    return buffer.getvalue()


def _explained(tables: Mapping[str, Rows], lang: str, name: str, at: datetime) -> str:
    texts = words(lang, "site")["data"]
    lines = [str(texts["title"]).format(name, f"{at:%Y-%m-%d %H:%M} UTC"), "", str(texts["says"]), ""]
    lines += [
        f"{table}.csv ({len(rows)}): {texts['tables'][table]}" for table, rows in tables.items() if rows
    ]
    return "\r\n".join([*lines, "", str(texts["withheld"]), "", str(texts["hidden"]), ""])


def _as_csv(rows: Rows) -> bytes:
    cells = ({column: _cell(value) for column, value in row.items()} for row in rows)
    return csv_text(cells, tuple(rows[0])).encode("utf-8-sig", "replace")


def _cell(value: Any) -> Any:
    return json.dumps(value, ensure_ascii=False) if isinstance(value, (dict, list)) else value


# -------------------------------------------------------------------- erasing


def erase_person(request: Request) -> Response:
    """Erase a person, after their name has been typed for confirmation."""
    with request.site.store.reading() as connection:
        person = somebody(request, connection)
        owner = identifiers_of(connection, person.id)
        if is_last_administrator(connection, person.id):
            raise HTTPException("last_administrator", 409)
        counts = (
            {table: len(rows) for table, rows in personal_data(connection, owner).items() if rows}
            if owner
            else {}
        )
    typed = " ".join(request.form.text("name").split())
    if not request.is_post or typed != person.name:
        return request.render(
            "site/instructor/erase",
            422 if request.is_post else 200,
            one=person,
            kept=counts,
            mistyped=request.is_post,
            tables=request.words["data"]["tables"],
        )
    with request.site.store.begin() as connection:
        if is_last_administrator(connection, person.id):
            raise HTTPException("last_administrator", 409)
        gone = erase(connection, person.id)
        by = Actor("", 0, request.client_address) if person.id == request.user.id else request.actor
        note(connection, request.received_at, by, "erased", person=person.id, rows=sum(gone.values()))
    if not scrubbing.scrub(request.site):
        scrubbing.scrub_until_done(request.site)
        return redirect("/desk/people?left=1")
    return redirect("/desk/people")


# ---------------------------------------------------------------------- audit


def audit(request: Request) -> Response:
    """Return the audit, the latest entries first, a hundred lines a page; of one person or of one kind, if
    the query names it."""
    filters = {name: request.query_params.get(name, "").strip()[:200] for name in ("by", "what", "of")}
    before, subject = number(request.query_params.get("before", "")), number(filters["of"])
    with request.site.store.reading() as connection:
        lines = noted(
            connection,
            _LINES,
            before,
            by=filters["by"],
            what=[filters["what"]] if filters["what"] else [],
            subject=subject or None,
        )
        names = {line.id: (line.name, line.created) for line in people(connection)}
        event_kinds = kinds(connection)
    rows = [(line, _about(line, names)) for line in lines]
    of = names[subject][0] if subject in names else ""
    more = urlencode({**filters, "before": lines[-1].id}) if len(lines) == _LINES else ""
    return request.render(
        "site/instructor/audit", lines=rows, more=more, asked=filters, kinds=event_kinds, of=of
    )


def _about(line: Any, names: Mapping[int, tuple[str, datetime]]) -> str:
    """Return the description of an audit line, with the names of people who still exist."""
    details = dict(line.about) if isinstance(line.about, Mapping) else {"": line.about}
    people = [*details.pop("people", ()), *([details.pop("person")] if "person" in details else [])]
    mentioned = [names[id_][0] for id_ in people if id_ in names and names[id_][1] <= line.at]
    if len(mentioned) < len(people):
        mentioned.append("…")
    rest = [f"{key} {value}" if key else f"{value}" for key, value in details.items()]
    return ", ".join([*mentioned, *rest])


ROUTES: tuple[Route, ...] = (
    Route("/account/data", user_data, Permission.OWN, limit="upload"),
    Route(
        "/desk/people/{person}/data",
        their_data,
        Permission.PEOPLE_EXPORT,
        limit="upload",
        audit_event="data given",
    ),
    Route("/desk/people/{person}/erase", erase_person, Permission.PEOPLE_ERASE, takes_forms=True),
    Route("/desk/audit", audit, Permission.AUDIT_READ),
)
