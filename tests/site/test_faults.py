"""Faults of machines and lines: what was acknowledged is kept, nothing counts twice, and a student reads a
sentence."""

import threading
from datetime import timedelta
from pathlib import Path

import httpx
import pytest
from postgres_server import running
from site_assignments import dealt, right
from site_people import MAX, ZOE, Class, seal_of, signed_in
from site_server import Served, kill, until
from sqlalchemy import select

from coursework.database.publication import Publication
from coursework.database.submissions import rows_of, submissions_of
from coursework.database.tables import mark, person
from coursework.database.tables import progress as entries
from coursework.system.headers import cookie_name

pytestmark = pytest.mark.e2e

OPEN = Publication(tries=None)
CLASS = (ZOE, MAX, "Chloé", "David", "Émilie", "Farid")
TRIES = 4
needs_processes = pytest.mark.skipif(
    not Path("/proc/self/stat").exists(), reason="this system does not list processes in /proc"
)


class Students:
    """A class that hands in from telephones: each sends again, as it is, until there is a receipt."""

    def __init__(self, db):
        self.one = Class(db)
        self.number = dealt(self.one, OPEN, CLASS)
        with self.one.site.store.reading() as connection:
            self.ids = {row.name: row.id for row in connection.execute(select(person)) if row.name in CLASS}
        self.receipts, self.sentences = {}, []
        self.url, self.is_over = "", threading.Event()

    def hand_in(self, name):
        cookie = signed_in(self.one.site.store, self.ids[name])
        headers = {
            "cookie": f"{cookie_name(False)}={cookie}",
            "x-seal": seal_of(self.one.site, cookie),
            "accept-language": "fr",
        }
        with httpx.Client(headers=headers, timeout=20, trust_env=False) as client:
            for number in range(1, TRIES + 1):
                texts = dict.fromkeys(right(self.one, name), f"{number},5")
                self.receipts[name, number] = self.insist(client, {**texts, "_number": str(number)})

    def insist(self, client, form):
        while not self.is_over.is_set():
            try:
                reply = client.post(f"{self.url}/assignments/{self.number}/hand-in", data=form)
            except httpx.TransportError:
                self.is_over.wait(0.1)
                continue
            if reply.status_code == 303:
                return reply.headers["location"].rpartition("/")[2].partition("?")[0]
            self.sentences.append((reply.status_code, reply.headers.get("retry-after"), reply.text))
            self.is_over.wait(0.1)
        return None

    def begin(self):
        threads = [threading.Thread(target=self.hand_in, args=(name,)) for name in CLASS]
        for thread in threads:
            thread.start()
        return threads

    def end(self, threads):
        for thread in threads:
            thread.join(90)
        self.is_over.set()
        for thread in threads:
            thread.join()

    def check(self):
        """Everybody's hand-ins are there, each once and whole, under the receipts that were given."""
        store = self.one.site.store
        with store.reading() as connection:
            for name in CLASS:
                done = submissions_of(connection, self.number, self.ids[name])
                assert [one.number for one in done] == list(range(1, TRIES + 1)), name
                assert [one.receipt for one in done] == [self.receipts[name, n] for n in range(1, TRIES + 1)]
                for one in done:
                    answers = {row.answer for row in rows_of(connection, self.number, one.id)}
                    assert answers == {f"{one.number},5"}
        for status, again, text in self.sentences:
            assert (status, int(again) > 0) == (503, True), text
            assert "Traceback" not in text
            assert 'lang="fr"' in text
        store.close()


@pytest.fixture
def students(tmp_path):
    return Students(f"sqlite:///{tmp_path}/site.db")


def some(students, least):
    """Wait for some hand-ins to have been acknowledged, and not all."""
    until(lambda: len(students.receipts) >= least)


@needs_processes
def test_a_process_killed_while_students_hand_in_loses_nothing(students, tmp_path):
    with Served(tmp_path, "serve", "--port", "0", "--workers", "2", "--db", "site.db") as site:
        students.url = site.url
        workers = until(lambda: len(site.workers) == 2 and site.workers)
        threads = students.begin()
        some(students, 2)
        kill(workers[0])
        some(students, 8)
        kill(workers[1])
        students.end(threads)
    students.check()


@pytest.mark.slow
def test_the_only_process_killed_while_students_hand_in_loses_nothing(students, tmp_path):
    threads = []
    for least in (3, 9, None):
        with Served(tmp_path, "serve", "--port", "0", "--db", "site.db") as site:
            students.url = site.url
            threads = threads or students.begin()
            if least is None:
                students.end(threads)
            else:
                some(students, least)
                site.kill()
    students.check()


@pytest.mark.slow
@needs_processes
def test_a_database_killed_while_students_hand_in_loses_nothing(tmp_path):
    with running() as server:
        students = Students(server.database())
        with Served(
            tmp_path, "serve", "--port", "0", "--workers", "2", "--db", students.one.site.store.url
        ) as site:
            students.url = site.url
            threads = students.begin()
            for least in (2, 8):
                some(students, least)
                server.kill()
                until(lambda: students.sentences)
                server.start()
            students.end(threads)
        students.check()


# ------------------------------------------------------------------------- a full disk


def filled(store):
    """No room for another page: SQLite's own limit stands in for a full disk, and gives the same error."""
    with store.engine.connect() as connection:
        pages = connection.exec_driver_sql("PRAGMA page_count").scalar()
    limit = f"PRAGMA max_page_count = {pages}"

    def set_limit(connection, record, proxy):
        connection.execute(limit)

    from sqlalchemy import event

    event.listen(store.engine, "checkout", set_limit)
    return lambda: event.remove(store.engine, "checkout", set_limit)


def test_a_full_disk_is_told_and_what_was_acknowledged_stays(class_of_three):
    site = class_of_three.site
    number = dealt(class_of_three, OPEN)
    browser = class_of_three.browser(ZOE, "fr")
    box, text = next(iter(right(class_of_three, ZOE).items()))
    kept = browser.fill(f"/assignments/{number}/hand-in", {box: text, "_number": "1"})
    assert kept.status_code == 303
    emptied = filled(site.store)
    for length in (50, 200, 3000):
        refused = browser.fill(f"/assignments/{number}/hand-in", {box: "9" * length, "_number": "2"})
        if refused.status_code != 303:
            break
    else:
        long = dict.fromkeys(right(class_of_three, ZOE), "8" * 190)
        for again in range(3, 60):
            refused = browser.fill(
                f"/assignments/{number}/hand-in", {**long, box: str(again), "_number": str(again)}
            )
            if refused.status_code != 303:
                break
    assert refused.status_code == 503
    assert int(refused.headers["retry-after"]) > 0
    assert 'lang="fr"' in refused.text
    assert browser.get(kept.headers["location"]).status_code == 200
    emptied()
    site.store.close()
    with site.store.reading() as connection:
        before = len(submissions_of(connection, number, class_of_three.ids[ZOE]))
    again = browser.fill(f"/assignments/{number}/hand-in", {box: "77", "_number": str(before + 1)})
    assert again.status_code == 303


# ------------------------------------------------- the line, the clock, two pages at once


def progress(one, name=ZOE):
    with one.site.store.reading() as connection:
        rows = connection.execute(
            select(entries).where(entries.c.person_id == one.ids[name]).order_by(entries.c.id)
        )
        return [row.entry for row in rows]


def checked(browser, place, text):
    return browser.fill(place, {"check": "rA", "a-rA": text}, headers={"hx-request": "true"})


def test_an_answer_that_is_sent_again_since_its_reply_was_lost_counts_once(class_of_three):
    browser = class_of_three.browser(ZOE)
    place = browser.get("/practice/slotted_mechanism").headers["location"]
    replies = [checked(browser, place, "12,5 mm") for _ in range(3)]
    assert [one.status_code for one in replies] == [200, 200, 200]
    assert [one["answer"] for one in progress(class_of_three) if one["what"] == "answer"] == ["12,5 mm"]


def test_answers_checked_from_two_pages_at_once_are_both_kept_and_each_once(class_of_three):
    browsers = [class_of_three.browser(ZOE) for _ in range(2)]
    place = browsers[0].get("/practice/slotted_mechanism").headers["location"]
    texts = ("12,5 mm", "13,5 mm")
    seals = [one.seal for one in browsers]

    def send(k):
        for _ in range(3):
            browsers[k].post(place, data={"_seal": seals[k], "check": "rA", "a-rA": texts[k]})

    threads = [threading.Thread(target=send, args=(k,)) for k in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    found = [one["answer"] for one in progress(class_of_three) if one["what"] == "answer"]
    assert set(found) == set(texts)


@pytest.mark.parametrize("jump", [timedelta(days=-400), timedelta(hours=-1), timedelta(days=400)])
def test_a_clock_that_jumps_loses_no_draft_and_no_answer(class_of_three, jump):
    browser = class_of_three.browser(ZOE)
    place = browser.get("/practice/slotted_mechanism").headers["location"]
    kept = browser.fill(f"{place}/draft", {"text.rA": "12", "over.rA": "0"}).json()["versions"]
    checked(browser, place, "12 mm")
    class_of_three.at += jump
    browser = class_of_three.browser(ZOE)
    later = browser.fill(f"{place}/draft", {"text.rA": "13", "over.rA": str(kept["rA"] + 5)})
    assert later.json()["others"] == {}
    checked(browser, place, "13 mm")
    class_of_three.at -= jump
    assert 'value="13' in class_of_three.browser(ZOE).get(place).text
    assert [one["answer"] for one in progress(class_of_three) if one["what"] == "answer"] == [
        "12 mm",
        "13 mm",
    ]


def test_what_a_process_left_unmarked_is_marked_when_it_is_asked_for(class_of_three, monkeypatch):
    from coursework.database.marking import mark_new
    from coursework.site.papers import submission

    number = dealt(class_of_three, OPEN)
    monkeypatch.setattr(submission, "mark", lambda site, made: None)  # it fell between the two
    texts = right(class_of_three, ZOE)
    reply = class_of_three.browser(ZOE).fill(f"/assignments/{number}/hand-in", {**texts, "_number": "1"})
    assert reply.status_code == 303
    assert mark_new(class_of_three.site.course, class_of_three.site.store, number).marked == 2
    with class_of_three.site.store.reading() as connection:
        assert {row.verdict for row in connection.execute(select(mark))} == {"correct"}
