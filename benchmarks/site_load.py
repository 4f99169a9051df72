"""A class that works on the site at the same time: how long answers take, and whether anything is lost.

    python benchmarks/site_load.py                       500 students, ten minutes, SQLite, one process
    python benchmarks/site_load.py --short               50 students, half a minute, each four times as fast
    python benchmarks/site_load.py --postgres --workers 2
    python benchmarks/site_load.py --all --out FILE.md   the class, then PostgreSQL with 1, 2 and 4 processes

Each student opens the course and a sheet, reads, types (what is typed is sent as a draft, and what is read in
it is asked for), checks, thinks, and goes on with the next question; half of the answers are right. Once in
that time each opens the homework, types an answer to each of its questions, reads how they are read, hands
in, and opens the receipt. Nothing is sent but to the loopback interface, and nothing longer than the minutes
that are told. Afterwards every draft, answer and receipt that was acknowledged is looked for in the database.
``--postgres`` starts a server of its own in a temporary folder.
"""

import argparse
import asyncio
import json
import os
import platform
import random
import re
import signal
import sqlite3
import statistics
import subprocess
import sys
import tempfile
import time
from collections import Counter, defaultdict
from contextlib import ExitStack
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from functools import cache
from pathlib import Path
from typing import Any

import httpx
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
from coursework.site.frame.pool import PracticePool
from coursework.system.headers import cookie_name

EXERCISES = ("slotted_mechanism", "four_bar_positions", "slider_extras", "quick_return", "ball_reducer")
READY = 40  #: variants of each that are found before the class comes
HOMEWORK = Assignment(
    "homework", (AskedExercise("slotted_mechanism", ("rA", "theta4")), AskedExercise("grashof"))
)
BEGINNING = 1.5  #: seconds of a processor that each process takes at least to make itself ready
GROWTH = (1, 2, 4)  #: processes with PostgreSQL
SERVE = "import sys; from coursework.cli import run; sys.exit(run(sys.argv[1:]))"
BOX = re.compile(r'<input type="text"[^>]* name="a-([^"]+)"')
OWN_BOX = re.compile(r'<input type="text"[^>]* name="(e\d+-[^"]+)"')
CODE = re.compile(r"/receipts/([A-Z2-7-]+)")
SEAL = re.compile(r'X-Seal": "([^"]+)"')


def arguments():
    told = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    told.add_argument("--students", type=int, default=500)
    told.add_argument("--minutes", type=float, default=10)
    told.add_argument("--pace", type=float, default=1, help="how many times as fast each works")
    told.add_argument("--short", action="store_true", help="50 students, half a minute, pace 4")
    told.add_argument("--workers", type=int, default=1)
    told.add_argument("--postgres", action="store_true")
    told.add_argument("--all", action="store_true", help="as told, then PostgreSQL with 1, 2 and 4 processes")
    told.add_argument("--out", type=Path, help="where the tables are written as well")
    found = told.parse_args()
    if found.short:
        found.students, found.minutes, found.pace = 50, 0.5, 4
    assert found.students <= 1000, "a class, not a crowd: 1000 students at most"
    assert found.minutes <= 15, "15 minutes at most"
    return found


@dataclass(frozen=True)
class Run:
    """One class at work."""

    students: int
    minutes: float
    pace: float
    workers: int = 1
    is_postgres: bool = False

    def __str__(self):
        base = "PostgreSQL" if self.is_postgres else "SQLite"
        processes = "one process" if self.workers == 1 else f"{self.workers} processes"
        pace = "" if self.pace == 1 else f", each {self.pace:g} times as fast"
        return f"{base}, {processes}: {self.students} students, {self.minutes:g} min{pace}"


def runs(asked):
    yield Run(asked.students, asked.minutes, asked.pace, asked.workers, asked.postgres)
    if asked.all:
        for workers in GROWTH:
            yield Run(min(100, asked.students), min(0.5, asked.minutes), 15 * asked.pace, workers, True)


@dataclass
class Told:
    """What was answered, how fast, and what was acknowledged."""

    seconds: dict[str, list[float]] = field(default_factory=lambda: defaultdict(list))
    faults: Counter = field(default_factory=Counter)
    drafts: dict[tuple, str] = field(default_factory=dict)
    checks: set = field(default_factory=set)
    receipts: dict[str, tuple[int, dict[str, str]]] = field(default_factory=dict)
    used: float = 0.0  #: seconds of processors, of all processes that serve

    @property
    def every(self):
        return [one for seconds in self.seconds.values() for one in seconds]


class Student:
    """One browser, and the hand before it."""

    def __init__(self, number, cookie, told, pace, url, homework):
        self.number, self.told, self.pace, self.homework = number, told, pace, homework
        self.solutions = found_ahead().solutions
        self.due = None  #: when the homework is done
        self.dice = random.Random(f"{number}")
        self.client = httpx.AsyncClient(
            base_url=url, headers={"cookie": cookie, "accept-language": "fr"}, timeout=60, trust_env=False
        )

    async def work(self, first, until):
        self.due = time.monotonic() + self.dice.uniform(0.1, 0.6) * (until - time.monotonic())
        await asyncio.sleep(first)
        names = list(EXERCISES)
        self.dice.shuffle(names)
        async with self.client:
            try:
                await self.ask("course", "GET", "/practice")
                while time.monotonic() < until:
                    for name in names:
                        await self.exercise(name, until)
            except TimeoutError:
                return

    async def exercise(self, name, until):
        moved = await self.ask("begin", "GET", f"/practice/{name}")
        if moved is None or "location" not in moved.headers:
            await self.pause(5, 10, until)
            return
        place = moved.headers["location"]
        page = await self.ask("sheet", "GET", place)
        if page is None:
            return
        seal = {"x-seal": SEAL.search(page.text)[1], "hx-request": "true"}
        await self.pause(20, 50, until)
        versions = {}
        for part in dict.fromkeys(BOX.findall(page.text)):
            if self.due is not None and time.monotonic() > self.due:
                self.due = None
                await self.hand_in(until)
            await self.question(place, name, part, seal, versions, until)

    async def question(self, place, name, part, seal, versions, until):
        text = self.answer(name, place.rpartition("/")[2], part)
        box = f"a-{part}"
        for typed in (text[: len(text) // 2], text):
            if typed:
                sent = {f"text.{part}": typed, f"over.{part}": str(versions.get(part, 0))}
                kept = await self.ask("draft", "POST", f"{place}/draft", sent, seal)
                if kept is not None:
                    versions.update(kept.json()["versions"])
                    self.told.drafts[self.number, place, part] = typed
                await self.pause(2, 4, until)
        await self.ask("read as", "POST", f"{place}/read", {"part": part, box: text}, seal)
        await self.pause(2, 6, until)
        if await self.ask("check", "POST", place, {"check": part, box: text}, seal) is not None:
            self.told.checks.add((self.number, place, part, text))
        await self.pause(12, 36, until)

    async def hand_in(self, until):
        place = f"/assignments/{self.homework}"
        page = await self.ask("paper", "GET", place)
        if page is None:
            return
        seal, texts = {"x-seal": SEAL.search(page.text)[1]}, {}
        for box in dict.fromkeys(OWN_BOX.findall(page.text)):
            await self.pause(5, 15, until)
            text = f"{self.dice.uniform(-500, 500):.5g}"
            sent = {f"text.{box}": text, f"over.{box}": "0"}
            if await self.ask("keep", "POST", f"{place}/keep", sent, seal) is not None:
                texts[box] = self.told.drafts[self.number, place, box] = text
        await self.ask("read back", "POST", place, {**texts, "_versions": self.versions(texts)}, seal)
        await self.pause(5, 10, until)
        taken = await self.ask("hand in", "POST", f"{place}/hand-in", {**texts, "_number": "1"}, seal)
        if taken is not None:
            code = CODE.search(taken.headers["location"])[1]
            self.told.receipts[code] = (self.number, texts)
            await self.ask("receipt", "GET", taken.headers["location"])

    @staticmethod
    def versions(texts):
        return json.dumps(dict.fromkeys(texts, 1))

    def answer(self, name, seed, part):
        right = self.solutions.get((name, int(seed)), {}).get(part)
        if isinstance(right, float) and self.dice.random() < 0.5:
            return f"{right:.6g}"
        return f"{self.dice.uniform(-500, 500):.5g}"

    async def ask(self, what, method, address, data=None, headers=None):
        """An answer; None where there was none, or another than was hoped for."""
        begun = time.perf_counter()
        try:
            found = await self.client.request(method, address, data=data, headers=headers)
        except httpx.HTTPError as fault:
            self.told.faults[f"{what}: {type(fault).__name__}"] += 1
            return None
        self.told.seconds[what].append(time.perf_counter() - begun)
        if found.status_code >= 400:
            self.told.faults[f"{what}: {found.status_code}"] += 1
            return None
        return found

    async def pause(self, least, most, until):
        seconds = self.dice.uniform(least, most) / self.pace
        if time.monotonic() + seconds > until:
            raise TimeoutError
        await asyncio.sleep(seconds)


# ------------------------------------------------------------------------ set up


@dataclass(frozen=True)
class Ahead:
    """What a site that began before the lesson has found: seeds by exercise, right answers, and what was
    dealt."""

    pools: dict[str, Pooled]
    solutions: dict[tuple[str, int], dict[str, Any]]


@cache
def found_ahead():
    course = open_course()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as place:
        store = Store(str(Path(place) / "pool.db"))
        pools = {name: PracticePool(course, store)._extended(name, READY) for name in EXERCISES}
        store.close()
    solutions = {(n, seed): course[n].variant(seed).solution() for n in EXERCISES for seed in pools[n].seeds}
    rest = {name: Pooled(are_all=True) for name in course if name not in pools}  # nobody asks for them here
    return Ahead({name: Pooled(one.seeds, True) for name, one in pools.items()} | rest, solutions)


@cache
def dealt(students):
    """The homework of so many."""
    people = [Enrolled(f"Student {number}") for number in range(students)]
    return issued_content(assign_variants(open_course(), HOMEWORK, people, ["fr"]).issues, HOMEWORK)


def set_up(store, count):
    """People with the cookies by which they are known, variants to practise, a homework that is published:
    its number."""
    course, ids, now = open_course(), [], datetime.now(UTC)
    with store.begin() as connection:
        for number in range(count):
            name = f"Student {number}"
            ids.append(put_person(connection, folded(name), name, "fr", {}))
            put_account(connection, ids[-1], f"student{number}@example.org", "student")
        for name, found in found_ahead().pools.items():
            put_pooled(connection, name, course[name].version, found)
        homework = put_issued(connection, dealt(count), HOMEWORK.name)
        publish(connection, homework, Publication(now - timedelta(hours=1), now + timedelta(hours=2)))
    with store.begin() as connection:
        tokens = {one: begin_session(connection, one, "", now) for one in ids}
    return {one: f"{cookie_name(False)}={token}" for one, token in tokens.items()}, homework


def begun(place, db, workers):
    """The process that serves, and its address."""
    command = [sys.executable, "-c", SERVE, "serve", "--port", "0", "--db", db, "--workers", str(workers)]
    said = place / "said.txt"
    with said.open("w") as out:
        server = subprocess.Popen(command, stdout=out, cwd=place)
    while not (found := re.search(r"(http\S+?)/ ", said.read_text())):
        assert server.poll() is None, "it does not serve"
        time.sleep(0.1)
    return server, found[1]


# ----------------------------------------------------------------------- measured


def processor_seconds(pid):
    """Of a process and those that it began."""
    try:
        tasks = Path(f"/proc/{pid}/task").glob("*/children")  # each thread has its own
        children = [one for task in tasks for one in task.read_text().split()]
        numbers = [
            Path(f"/proc/{one}/stat").read_text().rpartition(")")[2].split() for one in (pid, *children)
        ]
    except OSError:
        return float("nan")
    return sum(int(n[11]) + int(n[12]) for n in numbers) / os.sysconf("SC_CLK_TCK")


def rest(pid, workers):
    """Wait for the server to have made itself ready, as one that began before the lesson."""
    before, quiet, end = 0.0, 0, time.monotonic() + 60
    while quiet < 2 and time.monotonic() < end:
        time.sleep(1.5)
        now = processor_seconds(pid)
        is_quiet = not now - before > 0.1 and not now < BEGINNING * workers
        before, quiet = now, quiet + 1 if is_quiet else 0


def lost(store, told, homework):
    """What was acknowledged and is not in the database, or is there twice."""
    with store.reading() as connection:
        drafts = {
            (row.person_id, place_of(row.sheet), row.box): row.text
            for row in connection.execute(select(tables.draft))
        }
        answers = {
            (row.person_id, f"/practice/{one['exercise']}/{one['seed']}", one["part"], one["answer"])
            for row in connection.execute(select(tables.progress))
            for one in [row.entry]
            if one["what"] == "answer"
        }
        gone = [(*key, text) for key, text in told.drafts.items() if drafts.get(key) != text]
        gone += [key for key in told.checks if key not in answers]
        return gone + list(lost_receipts(connection, told, homework))


def place_of(sheet):
    """The address at which a draft is typed."""
    return f"/{sheet}".replace("/assignment/", "/assignments/")


def lost_receipts(connection, told, homework):
    kept = {row.receipt: row for row in connection.execute(select(tables.submission))}
    for code, (person, texts) in told.receipts.items():
        row = kept.get(code)
        if row is None or row.person_id != person:
            yield "receipt", code
            continue
        rows = Counter(str(one.answer) for one in rows_of(connection, homework, row.id) if one.answer)
        if rows != Counter(texts.values()):
            yield "receipt", code, "holds other answers"
    for person, count in Counter(row.person_id for row in kept.values()).items():
        if count != 1:
            yield "handed in", person, count
    marked = select(func.count(tables.marking.c.student.distinct()))
    if connection.execute(marked).scalar() != len(kept):
        yield "hand-ins without a mark", len(kept)


async def crowd(students, seconds):
    until = time.monotonic() + seconds
    firsts = random.Random(0)
    await asyncio.gather(*(one.work(firsts.uniform(0, seconds / 10), until) for one in students))


def measured(run):
    """What a class was told, and what is lost of it."""
    with ExitStack() as stack:
        place = Path(
            stack.enter_context(tempfile.TemporaryDirectory(prefix="load-", ignore_cleanup_errors=True))
        )
        db = str(place / "load.db")
        if run.is_postgres:
            db = stack.enter_context(postgres().running()).database()
        store = Store(db)
        stack.callback(store.close)
        cookies, homework = set_up(store, run.students)
        server, url = begun(place, db, run.workers)
        try:
            told = Told()
            rest(server.pid, run.workers)
            students = [
                Student(number, cookie, told, run.pace, url, homework) for number, cookie in cookies.items()
            ]
            before = processor_seconds(server.pid)
            asyncio.run(crowd(students, 60 * run.minutes))
            told.used = processor_seconds(server.pid) - before
        finally:
            server.terminate()
            server.wait(60)
        return told, lost(store, told, homework)


def postgres():
    sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
    import postgres_server

    return postgres_server


# -------------------------------------------------------------------------- tables


def percentiles(seconds):
    ordered = sorted(1000 * one for one in seconds)
    at = [ordered[min(len(ordered) - 1, int(share * len(ordered)))] for share in (0.5, 0.95, 0.99)]
    return " | ".join(f"{one:.0f}" for one in (*at, ordered[-1]))


def report(run, told, missing):
    every = told.every
    yield f"### {run}\n"
    yield "| | requests | median, ms | 95 %, ms | 99 %, ms | longest, ms |\n|---|---|---|---|---|---|"
    for what, seconds in (*told.seconds.items(), ("all", every)):
        yield f"| {what} | {len(seconds)} | {percentiles(seconds)} |"
    rate, each = len(every) / (60 * run.minutes), 1000 * told.used / len(every)
    under = sum(one < 0.2 for one in every) / len(every)
    yield (
        f"\n{rate:.1f} requests a second; {each:.1f} ms of processor each; {100 * under:.1f} % under 200 ms;"
    )
    yield f"mean {1000 * statistics.mean(every):.0f} ms; faults: {dict(told.faults) or 'none'}."
    yield (
        f"{len(told.drafts)} boxes typed in, {len(told.checks)} answers checked, {len(told.receipts)} "
        f"handed in: {len(missing)} lost."
    )
    yield from (f"  lost: {key}" for key in missing[:10])
    yield ""


def machine():
    """What it was measured on."""
    try:
        info = Path("/proc/cpuinfo").read_text()
    except OSError:
        info = ""
    model = re.search(r"model name\s*: (.+)", info)
    load = ", ".join(f"{one:.1f}" for one in os.getloadavg()) if hasattr(os, "getloadavg") else "unknown"
    yield f"{model[1] if model else platform.machine()}, {os.cpu_count()} processors, {platform.system()}; "
    yield f"Python {platform.python_version()}, SQLite {sqlite3.sqlite_version}; load before: {load}. "
    yield (
        "The class runs on the same machine: httpx, one process. A commit of SQLite in the temporary folder: "
    )
    yield (
        f"{commits('FULL'):.2f} ms with synchronous=FULL, which the site uses, {commits('NORMAL'):.2f} ms "
        "with NORMAL.\n"
    )


def commits(how, count=200):
    """Milliseconds of a small transaction."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as place:
        one = sqlite3.connect(Path(place) / "x.db", isolation_level=None)
        one.execute("PRAGMA journal_mode = WAL")
        one.execute(f"PRAGMA synchronous = {how}")
        one.execute("CREATE TABLE t (x)")
        begun_at = time.perf_counter()
        for number in range(count):
            one.execute("INSERT INTO t VALUES (?)", (f"{number}" * 50,))
        took = time.perf_counter() - begun_at
        one.close()
    return 1000 * took / count


def main():
    asked = arguments()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # servers end with it
    lines, is_well = ["".join(machine())], True
    print(*lines, sep="\n", flush=True)
    for run in runs(asked):
        if run.is_postgres and postgres().programs() is None:
            found = [f"### {run}\n", "PostgreSQL's programs are not here.\n"]
        else:
            told, missing = measured(run)
            is_well = is_well and not missing and not told.faults
            found = list(report(run, told, missing))
        print(*found, sep="\n", flush=True)
        lines += found
        if asked.out:
            asked.out.write_text("\n".join(lines) + "\n", "utf-8")
    return 0 if is_well else 1


if __name__ == "__main__":
    sys.exit(main())
