"""Pages of the desk and of a student, by the number of students and assignments: processor seconds, memory,
statements.

    python benchmarks/scale_site.py [STUDENTS] [ASSIGNMENTS] [--db FILE]      5000 students, 20 assignments:
    five minutes

Each page is asked for twice by a process of its own, since what a process has read it keeps; nothing but the
page is timed. Papers are issued, submitted on the site and marked once, with half of the answers right; the
other assignments are copies of it. ``--db`` keeps the database, and takes it if it is there.
"""

from __future__ import annotations

import argparse
import asyncio
import gc
import json
import random
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any, NamedTuple

import httpx
from sqlalchemy import event, func, insert, literal, select
from timing import machine, print_table

from coursework import open_course
from coursework.database import tables
from coursework.database.assignments import put_issued
from coursework.database.marking import mark_new
from coursework.database.people import put_account, put_person
from coursework.database.publication import AT_ONCE, Publication, publish
from coursework.database.sessions import begin_session
from coursework.database.store import Store
from coursework.database.submissions import insert_submission
from coursework.gradebook.rows import AnswerRow, RowOrigin
from coursework.issuing.assignment import AskedExercise, Assignment
from coursework.issuing.issued import issued_content
from coursework.issuing.roster import Student
from coursework.issuing.variant_assignment import assign_variants
from coursework.site.application import application
from coursework.site.frame.settings import Entrance, Site
from coursework.system.headers import cookie_name

ASKED = Assignment("week 1", (AskedExercise("slotted_mechanism", ("rA", "theta4")), AskedExercise("grashof")))
STUDENTS, ASSIGNMENTS = 5000, 20
URL = "http://127.0.0.1:8000"
STAFF, STUDENT = "instructor", "student"
#: Address of each page, with the number of the last assignment.
PAGES: Mapping[str, tuple[str, str]] = {
    "desk, all classes changed": (STAFF, "/desk"),
    "desk": (STAFF, "/desk"),
    "class": (STAFF, "/desk/{0}"),
    "class by total": (STAFF, "/desk/{0}?sort=total"),
    "queue": (STAFF, "/desk/{0}/queue"),
    "questions": (STAFF, "/desk/{0}/questions"),
    "files": (STAFF, "/desk/{0}/files"),
    "student of the class": (STAFF, "/desk/{0}/student?name=Student+1"),
    "list of publications": (STAFF, "/desk/assignments"),
    "publication": (STAFF, "/desk/assignments/{0}"),
    "people": (STAFF, "/desk/people"),
    "a student's assignments": (STUDENT, "/assignments"),
    "a student's practice": (STUDENT, "/practice"),
    "a student's data": (STUDENT, "/account/data"),
}
_COPIED = (tables.variant, tables.issue, tables.submission, tables.answer, tables.marking, tables.mark)


class Measured(NamedTuple):
    """Page asked for twice by a new process."""

    first: float  #: processor seconds
    second: float
    peak: float  #: MB beyond those of the process before
    statements: int  #: of the second time
    kilobytes: float


# ------------------------------------------------------------------------- set up


def put_class(store: Store, students: int, assignments: int) -> None:
    """Store a class with its assignments, each handed in by everybody and marked."""
    course, now = open_course(), datetime.now(UTC)
    people = [Student(f"Student {number}") for number in range(students)]
    issues = assign_variants(course, ASKED, people, ["en"]).issues
    rules = Publication(now - timedelta(days=2), now + timedelta(days=2), tries=2, feedback=AT_ONCE)
    with store.begin() as connection:
        ids = {one.name: put_person(connection, one.name.casefold(), one.name, "en", {}) for one in people}
        for name, person in ids.items():
            put_account(connection, person, f"{name.replace(' ', '').lower()}@example.org", "student")
        teacher = put_person(connection, "teacher", "Teacher", "en", {})
        put_account(connection, teacher, "teacher@example.org", "administrator")
        number = put_issued(connection, issued_content(issues, ASKED), ASKED.name)
        publish(connection, number, rules)
        answers: dict[str, list[AnswerRow]] = {}
        dice, origin = random.Random(0), RowOrigin(sitting=1, submitted=now.isoformat(timespec="seconds"))
        for issue in issues:
            variant = issue.variant
            for part in variant.parts:
                right = variant.key.reference[part.quantity]
                text = f"{right:.6g}" if isinstance(right, float) else str(right)
                text = text if dice.random() < 0.5 else f"{dice.uniform(-500, 500):.5g}"
                where = issue.student, variant.exercise.name, str(variant.seed), part.id
                answers.setdefault(issue.student, []).append(AnswerRow(*where, text, "site", origin=origin))
        for name, rows in answers.items():
            insert_submission(
                connection, number, rows, source="site", received_at=now, person_id=ids[name], number=1
            )
    mark_new(course, store, number)
    with store.begin() as connection:
        many = {one.name: connection.execute(select(func.max(one.c.id))).scalar() for one in _COPIED}
        for copy in range(1, assignments):
            _copy(connection, number, copy, {**many, "assignment": 1})


def _copy(connection: Any, number: int, copy: int, many: Mapping[str, int]) -> None:
    """Copy the first assignment with all its rows, of which a table has so many; ids go up by multiples of
    them."""
    row = connection.execute(select(tables.assignment).where(tables.assignment.c.id == number)).one()
    values = {**row._mapping, "id": number + copy, "name": f"week {copy + 1}"}
    connection.execute(insert(tables.assignment).values(values))
    for table in _COPIED:
        columns = []
        for column in table.c:
            of = next((key.column.table.name for key in column.foreign_keys), "")
            step = many[table.name] if column.name == "id" else many.get(of, 0)
            columns.append(column + literal(step * copy) if step else column)
        chosen = select(*columns).where(table.c.id <= many[table.name])
        connection.execute(insert(table).from_select([column.name for column in table.c], chosen))


# ---------------------------------------------------------------------- measured


def page(db: str, who: str, address: str) -> Measured:
    """Ask for a page twice in this process, after one that says nothing of the class."""
    store = Store(db)
    site = Site(open_course(), store, Entrance.ACCOUNTS, URL)
    with store.begin() as connection:
        role = "administrator" if who == STAFF else "student"
        account = select(tables.account.c.person_id).where(tables.account.c.role == role)
        token = begin_session(connection, connection.execute(account).scalar(), "", datetime.now(UTC))
        last = connection.execute(select(func.max(tables.assignment.c.id))).scalar()
    cookie = f"{cookie_name(False)}={token}"
    counted = []
    event.listen(store.engine, "before_cursor_execute", lambda c, cursor, text, *more: counted.append(text))
    return asyncio.run(_asked(application(site), cookie, address.format(last), counted))


async def _asked(app: Any, cookie: str, address: str, counted: list[str]) -> Measured:
    transport = httpx.ASGITransport(app=app)
    async with httpx.AsyncClient(transport=transport, base_url=URL, headers={"cookie": cookie}) as client:
        await client.get("/account")
        gc.collect()
        before, seconds = _memory("VmRSS", reset=True), []
        for _ in range(2):
            counted.clear()
            start = time.process_time()
            reply = await client.get(address)
            seconds.append(time.process_time() - start)
            assert reply.status_code == 200, (address, reply.status_code)
        statements = sum(not text.startswith("BEGIN") for text in counted)
        return Measured(*seconds, _memory("VmHWM") - before, statements, len(reply.content) / 1000)


def _memory(name: str, *, reset: bool = False) -> float:
    """Return a figure of this process in MB; start its peak anew if ``reset``. Not a number where the system
    tells none."""
    if reset:
        with suppress(OSError):
            Path("/proc/self/clear_refs").write_text("5")
    try:
        return int(re.search(rf"{name}:\s*(\d+)", Path("/proc/self/status").read_text())[1]) / 1000
    except OSError:
        return float("nan")


def pages(db: str, chosen: Callable[[str], bool] = lambda name: True) -> dict[str, Measured]:
    """Measure each page in a process of its own."""
    found = {}
    for name, (who, address) in PAGES.items():
        if chosen(name):
            command = [sys.executable, __file__, "--page", who, address, "--db", db]
            done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
            found[name] = Measured(*json.loads(done.stdout))
    return found


def desk(students: int, assignments: int = ASSIGNMENTS, db: str = "") -> dict[str, Measured]:
    """Make a class of a size and measure the pages of the site; take the class of ``db`` if it is there."""
    with tempfile.TemporaryDirectory(prefix="scale-", ignore_cleanup_errors=True) as place:
        path = Path(db or f"{place}/desk.db")
        if not path.exists():
            store = Store(str(path))
            put_class(store, students, assignments)
            store.close()
        return pages(str(path))


def main() -> None:
    told = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    told.add_argument("students", type=int, nargs="?", default=STUDENTS)
    told.add_argument("assignments", type=int, nargs="?", default=ASSIGNMENTS)
    told.add_argument("--db", default="", help="file of the database, kept")
    told.add_argument("--page", nargs=2, help=argparse.SUPPRESS)
    asked = told.parse_args()
    if asked.page:
        print(json.dumps(page(asked.db, *asked.page)))
        return
    found = desk(asked.students, asked.assignments, asked.db)
    print(f"{asked.students} students, {asked.assignments} assignments; {machine()}\n")
    heads = ("page", "processor, s", "again, s", "memory, MB", "statements", "kB")
    rows = [
        (name, f"{m.first:.2f}", f"{m.second:.2f}", f"{m.peak:.0f}", f"{m.statements}", f"{m.kilobytes:.0f}")
        for name, m in found.items()
    ]
    print_table(heads, rows)


if __name__ == "__main__":
    main()
