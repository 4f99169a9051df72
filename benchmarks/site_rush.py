"""A class that comes at one moment: how long it waits, and whether anything is lost or refused that came in
time.

    python benchmarks/site_rush.py                          SQLite with one process, then PostgreSQL with two
    python benchmarks/site_rush.py --only sqlite            or postgres
    python benchmarks/site_rush.py --students 60 --repeat 3 --out FILE.md

Three hundred students open a paper within 20 seconds; two hundred open another one at one moment, open it
again, save what they typed in a box, and hand it in at one moment 6 seconds before it closes. The others
leave what they typed in the boxes. Afterwards the database is asked whether everything that was acknowledged
is there, counts as in time, and is marked, and whether what was left in the boxes was handed in. Nothing is
sent but to the loopback interface; a run takes some two minutes.
"""

import argparse
import asyncio
import os
import random
import signal
import sys
import tempfile
import time
from collections import Counter, defaultdict
from contextlib import ExitStack
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path

import httpx
from site_load import CODE, OWN_BOX, SEAL, begun, machine, postgres, rest
from sqlalchemy import func, select

from coursework import open_course
from coursework.database import tables
from coursework.database.assignments import put_issued
from coursework.database.people import put_account, put_person
from coursework.database.pool import Pooled, put_pooled
from coursework.database.publication import Publication, publish
from coursework.database.sessions import begin_session
from coursework.database.store import Store
from coursework.database.submissions import rows_of
from coursework.issuing.assignment import AskedExercise, Assignment
from coursework.issuing.issued import issued_content
from coursework.issuing.roster import Student as Enrolled
from coursework.issuing.students import folded
from coursework.issuing.variant_assignment import assign_variants
from coursework.site.papers.submission import AS_SAVED
from coursework.system.headers import cookie_name

WITHIN, BEFORE = 20.0, 6.0  #: seconds in which the first paper is opened; before closing, when all hand in
MARKING = 180  #: seconds that marking may take at most
EXERCISES = (
    AskedExercise("slotted_mechanism"),
    AskedExercise("four_bar_positions"),
    AskedExercise("grashof"),
)


def arguments():
    told = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    told.add_argument("--students", type=int, default=300)
    told.add_argument("--repeat", type=int, default=1)
    told.add_argument("--only", choices=("sqlite", "postgres"))
    told.add_argument("--out", type=Path, help="where the tables are written as well")
    found = told.parse_args()
    assert 3 <= found.students <= 1000, "a class, not a crowd: 1000 students at most"
    assert found.repeat <= 5, "five runs at most"
    return found


@dataclass
class Told:
    """What was answered, how fast, and what was acknowledged."""

    seconds: dict[str, list[float]] = field(default_factory=lambda: defaultdict(list))
    faults: Counter = field(default_factory=Counter)
    #: Seconds of processors, of the processes that answer.
    used: dict[str, float] = field(default_factory=dict)
    receipts: dict[str, tuple[int, dict[str, str]]] = field(default_factory=dict)
    saved: dict[tuple[int, str], str] = field(default_factory=dict)
    marked: float = float("nan")  #: seconds after the last receipt until all is marked


class Student:
    """One browser."""

    def __init__(self, number, cookie, told, url):
        self.number, self.told, self.boxes, self.seal = number, told, (), ""
        limits = httpx.Limits(max_connections=1, keepalive_expiry=60)
        self.client = httpx.AsyncClient(
            base_url=url,
            headers={"cookie": cookie, "accept-language": "fr"},
            timeout=120,
            trust_env=False,
            limits=limits,
        )

    async def ask(self, what, method, address, data=None, headers=None):
        begun_at = time.perf_counter()
        try:
            found = await self.client.request(method, address, data=data, headers=headers)
        except httpx.HTTPError as fault:
            self.told.faults[f"{what}: {type(fault).__name__}"] += 1
            return None
        self.told.seconds[what].append(time.perf_counter() - begun_at)
        if found.status_code >= 400:
            self.told.faults[f"{what}: {found.status_code}"] += 1
            return None
        return found

    async def open(self, what, number, after=0.0):
        await asyncio.sleep(after)
        page = await self.ask(what, "GET", f"/assignments/{number}")
        if page is not None:
            self.boxes, self.seal = (
                tuple(dict.fromkeys(OWN_BOX.findall(page.text))),
                SEAL.search(page.text)[1],
            )

    async def save(self, number):
        box, text = self.boxes[0], f"{self.number},5"
        sent = {f"text.{box}": text, f"over.{box}": "0"}
        if await self.ask("save a draft", "POST", f"/assignments/{number}/keep", sent, {"x-seal": self.seal}):
            self.told.saved[self.number, box] = text

    async def hand_in(self, number):
        texts = {box: f"{self.number + k / 10:g}" for k, box in enumerate(self.boxes)}
        taken = await self.ask(
            "hand in",
            "POST",
            f"/assignments/{number}/hand-in",
            {**texts, "_number": "1"},
            {"x-seal": self.seal},
        )
        if taken is not None:
            self.told.receipts[CODE.search(taken.headers["location"])[1]] = (self.number, texts)
            await self.ask("receipt's page", "GET", taken.headers["location"])


# ------------------------------------------------------------------------ set up


def set_up(store, count):
    """People with their cookies, and two papers that are published: their numbers."""
    course, ids, now = open_course(), [], datetime.now(UTC)
    people = [Enrolled(f"Student {number}") for number in range(count)]
    numbers = []
    with store.begin() as connection:
        for one in people:
            ids.append(put_person(connection, folded(one.name), one.name, "fr", {}))
            put_account(connection, ids[-1], f"{folded(one.name).replace(' ', '')}@example.org", "student")
        for name in course:
            put_pooled(connection, name, course[name].version, Pooled(are_all=True))  # nobody practises here
    for name in ("first", "second"):
        paper = Assignment(name, EXERCISES)
        with store.begin() as connection:
            content = issued_content(assign_variants(course, paper, people, ["fr"]).issues, paper)
            numbers.append(put_issued(connection, content, name))
            publish(connection, numbers[-1], Publication(now - timedelta(hours=1), now + timedelta(hours=2)))
    with store.begin() as connection:
        tokens = {one: begin_session(connection, one, "", now) for one in ids}
    return {one: f"{cookie_name(False)}={token}" for one, token in tokens.items()}, numbers


def answering(pid):
    """Seconds of processors of the processes that answer requests."""
    used = 0.0
    for one in (pid, *children(pid)):
        try:
            told = Path(f"/proc/{one}/stat").read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if one == pid or int(told[16]) == os.getpriority(os.PRIO_PROCESS, 0):
            used += (int(told[11]) + int(told[12])) / os.sysconf("SC_CLK_TCK")
    return used


def children(pid):
    return [
        int(n) for place in Path(f"/proc/{pid}/task").glob("*/children") for n in place.read_text().split()
    ]


# ------------------------------------------------------------------------- the rush


async def rush(store, students, numbers, told, pid):
    first, second = numbers
    dice = random.Random(0)
    some = students[: 2 * len(students) // 3]

    async def together(what, *work):
        before = answering(pid)
        await asyncio.gather(*work)
        told.used[what] = answering(pid) - before
        await asyncio.sleep(1)

    await together(
        "open within 20 s",
        *(one.open("open within 20 s", first, dice.uniform(0, WITHIN)) for one in students),
    )
    await together("open at once", *(one.open("open at once", second) for one in some))
    await together("open again", *(one.open("open again", second) for one in some))
    others = students[len(some) :]
    for one in others:
        await one.open("open, the others", second)
    await asyncio.sleep(6)  # lines rest
    await together("save a draft", *(one.save(second) for one in some))
    for one in others:
        await one.save(second)
    closes = datetime.now(UTC) + timedelta(seconds=BEFORE + 2)
    with store.begin() as connection:
        publish(connection, second, Publication(closes=closes, takes_saved=True))
    await asyncio.sleep(max(0.0, (closes - datetime.now(UTC)).total_seconds() - BEFORE))
    await together("hand in", *(one.hand_in(second) for one in some))
    ended = time.monotonic()
    while not all_done(store, second, len(students)) and time.monotonic() - ended < MARKING:
        await asyncio.sleep(0.5)
    told.marked = time.monotonic() - ended
    for one in students:
        await one.client.aclose()


def all_done(store, number, count):
    with store.reading() as connection:
        made = select(func.count()).where(tables.submission.c.assignment_id == number)
        waits = select(func.count()).select_from(tables.job)
        return connection.execute(made).scalar() == count and not connection.execute(waits).scalar()


def lost(store, told, number, count):
    """What was acknowledged or left in the boxes and is not there, not in time, or not marked."""
    with store.reading() as connection:
        kept = {row.receipt: row for row in connection.execute(select(tables.submission))}
        for code, (person, texts) in told.receipts.items():
            row = kept.get(code)
            if row is None or row.person_id != person:
                yield "receipt", code
            elif row.late:
                yield "late", code, row.late
            elif sorted(
                str(one.answer) for one in rows_of(connection, number, row.id) if one.answer
            ) != sorted(texts.values()):
                yield "other answers", code
        times = Counter(row.person_id for row in kept.values())
        yield from (("handed in", person, n) for person, n in times.items() if n != 1)
        rescued = sum(row.source == AS_SAVED for row in kept.values())
        if rescued != count - len(told.receipts):
            yield "rescued", rescued, "of", count - len(told.receipts)
        drafts = {(r.person_id, r.box): r.text for r in connection.execute(select(tables.draft))}
        yield from (("draft", *key) for key, text in told.saved.items() if drafts.get(key) != text)
        marked = select(func.count(tables.marking.c.student.distinct())).where(
            tables.marking.c.assignment_id == number
        )
        if (found := connection.execute(marked).scalar()) != len(kept):
            yield "marked", found, "of", len(kept)


def measured(is_postgres, count):
    with ExitStack() as stack:
        place = Path(
            stack.enter_context(tempfile.TemporaryDirectory(prefix="rush-", ignore_cleanup_errors=True))
        )
        db = str(place / "rush.db")
        if is_postgres:
            db = stack.enter_context(postgres().running()).database()
        store = Store(db)
        stack.callback(store.close)
        cookies, numbers = set_up(store, count)
        workers = 2 if is_postgres else 1
        server, url = begun(place, db, workers)
        try:
            told = Told()
            rest(server.pid, workers)
            students = [Student(number, cookie, told, url) for number, cookie in cookies.items()]
            asyncio.run(rush(store, students, numbers, told, server.pid))
        finally:
            server.terminate()
            server.wait(60)
        return told, list(lost(store, told, numbers[1], count))


def report(what, told, missing):
    yield f"### {what}\n"
    yield "| | requests | median, s | 95 %, s | longest, s | processor each, ms |\n|---|--:|--:|--:|--:|--:|"
    for name, seconds in told.seconds.items():
        ordered = sorted(seconds)
        shown = [ordered[min(len(ordered) - 1, int(share * len(ordered)))] for share in (0.5, 0.95, 1)]
        used = told.used.get(name)
        each = "" if used is None else f"{1000 * used / len(seconds):.0f}"
        yield f"| {name} | {len(seconds)} | {' | '.join(f'{one:.2f}' for one in shown)} | {each} |"
    yield (
        f"\nFaults: {dict(told.faults) or 'none'}; {len(told.receipts)} receipts, {len(told.saved)} "
        f"drafts: {len(missing)} lost or late;"
    )
    yield f"all marked {told.marked:.0f} s after the last receipt."
    yield from (f"  lost: {one}" for one in missing[:10])
    yield ""


def main():
    asked = arguments()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    lines, is_well = ["".join(machine())], True
    print(*lines, flush=True)
    kinds = [kind for kind in ("sqlite", "postgres") if asked.only in (None, kind)]
    for kind in kinds * asked.repeat:
        what = "PostgreSQL, two processes" if kind == "postgres" else "SQLite, one process"
        if kind == "postgres" and postgres().programs() is None:
            found = [f"### {what}\n", "PostgreSQL's programs are not here.\n"]
        else:
            told, missing = measured(kind == "postgres", asked.students)
            is_well = is_well and not missing and not told.faults
            found = list(report(what, told, missing))
        print(*found, sep="\n", flush=True)
        lines += found
        if asked.out:
            asked.out.write_text("\n".join(lines) + "\n", "utf-8")
    return 0 if is_well else 1


if __name__ == "__main__":
    sys.exit(main())
