"""A rush before an assignment closes: what arrived in time is taken, whatever waits before it; it is marked
beside the requests."""

import asyncio
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from datetime import timedelta
from threading import Event

import httpx
import pytest
from postgres_server import running
from site_assignments import CLOSES, USUAL, code_of, dealt, handed_in, right
from site_people import HOME, MAX, ZOE, Class, count_of, seal_of, signed_in, statements
from sqlalchemy import func, insert, select
from starlette.concurrency import run_in_threadpool

from coursework.database import tables
from coursework.database.jobs import MARK, MOST_TRIES, put_job, take_job, waiting
from coursework.database.people import put_account, put_person
from coursework.database.publication import record_passed_date
from coursework.database.submissions import submissions_of
from coursework.database.tables import job, mark, marking
from coursework.issuing.students import folded
from coursework.site.frame import arrivals
from coursework.site.frame.cookies import COOKIE
from coursework.site.papers import submission
from coursework.site.worker import SETTLES, Worker

pytestmark = pytest.mark.e2e

SECOND = timedelta(seconds=1)
CROWD = tuple(f"Student {k}" for k in range(40))


@pytest.fixture(params=["sqlite", "postgresql"])
def site_class(request, tmp_path):
    """A class whose site has a worker, on both databases."""
    if request.param == "sqlite":
        one = Class(f"sqlite:///{tmp_path}/site.db")
        one.site.has_worker = True
        yield one
        one.site.store.close()
        return
    with running() as server:
        one = Class(server.database())
        one.site.has_worker = True
        yield one
        one.site.store.close()


@pytest.fixture
def served(class_of_three):
    class_of_three.site.has_worker = True
    return class_of_three


def with_crowd(one, publication=USUAL):
    """Enrol a crowd, and deal it an assignment."""
    with one.site.store.begin() as connection:
        for name in CROWD:
            one.ids[name] = put_person(connection, folded(name), name, "", {})
            put_account(connection, one.ids[name], f"{folded(name).replace(' ', '')}@example.org", "student")
    return dealt(one, publication, CROWD)


def form_of(one, name, number="1"):
    return {**dict.fromkeys(right(one, name), "12,5"), "_number": number}


def worked_off(one):
    """Let a worker do all that waits."""
    worker = Worker(one.site, "test")
    one.at += 3 * SECOND  # the rush is over
    while worker.work_once():
        pass


def marks_of(one, number):
    with one.site.store.reading() as connection:
        of_it = select(func.count()).select_from(marking).where(marking.c.assignment_id == number)
        return connection.execute(of_it).scalar()


def delivered(one, number, name=ZOE):
    with one.site.store.reading() as connection:
        return submissions_of(connection, number, one.ids[name])


def test_all_who_hand_in_before_it_closes_are_taken_while_every_thread_is_busy(served, monkeypatch):
    """The threads of pages are all taken, the marking is slow, and the clock goes on while the crowd
    waits."""
    number = with_crowd(served)
    served.at = CLOSES - 6 * SECOND
    headers = {name: headers_of(served, name) for name in CROWD}
    release = Event()

    def slow(*told):
        served.at += SECOND

    monkeypatch.setattr(submission, "mark_submission", slow)
    connect = served.site.store.begin

    def begin():
        served.at += SECOND  # who waits for the database waits a second
        return connect()

    monkeypatch.setattr(served.site.store, "begin", begin)

    async def rush():
        busy = [asyncio.ensure_future(run_in_threadpool(release.wait, 60)) for _ in range(60)]
        await asyncio.sleep(0.2)
        try:
            return await asyncio.wait_for(
                asyncio.gather(*(sent(served, number, name, headers[name]) for name in CROWD)), 50
            )
        finally:
            release.set()
            await asyncio.gather(*busy)

    replies = asyncio.run(rush())
    assert [one.status_code for one in replies] == [303] * len(CROWD)
    monkeypatch.undo()
    for name in CROWD:
        (made,) = delivered(served, number, name)
        assert (made.received_at, made.late) == (CLOSES - 6 * SECOND, 0)


def headers_of(one, name):
    cookie = signed_in(one.site.store, one.ids[name])
    return {"cookie": f"{COOKIE}={cookie}", "x-seal": seal_of(one.site, cookie)}


async def sent(one, number, name, headers=None):
    headers = headers or headers_of(one, name)
    transport = httpx.ASGITransport(one.app)
    async with httpx.AsyncClient(transport=transport, base_url=HOME, headers=headers, timeout=60) as client:
        return await client.post(f"/assignments/{number}/hand-in", data=form_of(one, name))


def test_what_arrives_after_it_closed_is_refused(served):
    number = dealt(served)
    served.at = CLOSES + SECOND
    assert asyncio.run(sent(served, number, ZOE)).status_code == 409


@pytest.mark.parametrize(
    ("begins", "ends", "status"),
    [
        (-1, -1, 303),
        (-1, 3, 303),  # the line was slow
        (-1, 10, 409),  # it trickled
        (-300, 1, 303),  # slow, and within the grace after all
        (-300, 6, 409),
        (1, 1, 409),
    ],
)
def test_a_body_that_trickles_buys_no_time_beyond_the_grace(served, begins, ends, status):
    """The form's first bytes and its last arrive so many seconds after it closes."""
    number = dealt(served)
    data = httpx.QueryParams(form_of(served, ZOE))

    async def send():
        body = str(data).encode()

        async def pieces():
            served.at = CLOSES + begins * SECOND
            yield body[:7]
            await asyncio.sleep(0.05)
            served.at = CLOSES + ends * SECOND
            yield body[7:]

        served.at = CLOSES + begins * SECOND
        headers = {
            **headers_of(served, ZOE),
            "content-length": str(len(body)),
            "content-type": "application/x-www-form-urlencoded",
        }
        async with httpx.AsyncClient(
            transport=httpx.ASGITransport(served.app), base_url=HOME, headers=headers
        ) as client:
            return await client.post(f"/assignments/{number}/hand-in", content=pieces())

    assert asyncio.run(send()).status_code == status


def test_a_date_that_is_written_down_meanwhile_refuses_nobody_who_was_in_time(served, monkeypatch):
    number = dealt(served)
    served.at = CLOSES - SECOND
    lock = submission.lock_person

    def late(connection, person):
        """The worker writes the date down while this one waits."""
        served.at = CLOSES + SECOND
        lock(connection, person)
        record_passed_date(connection, number, served.at)

    monkeypatch.setattr(submission, "lock_person", late)
    assert asyncio.run(sent(served, number, ZOE)).status_code == 303
    assert delivered(served, number)[0].late == 0


def test_what_was_rescued_does_not_stand_for_what_arrived_in_time_and_waited(served):
    number = dealt(served, replace(USUAL, takes_saved=True, tries=1))
    served.browser(ZOE).fill(f"/assignments/{number}/keep", {"text.e1-rA": "5", "over.e1-rA": "0"})
    served.at = CLOSES + SETTLES + 2 * SECOND
    Worker(served.site, "test").close()
    assert [one.source for one in delivered(served, number)] == [submission.AS_SAVED]
    token = arrivals._arrival.set(arrivals.Arrival(lambda: CLOSES - SECOND, {}))
    try:
        assert asyncio.run(sent_from_queue(served, number)).number == 2
    finally:
        arrivals._arrival.reset(token)


async def sent_from_queue(one, number):
    """What a thread does with a form that arrived in time, long after."""
    from coursework.database.publication import student_assignments
    from coursework.site.papers.student_paper import student_paper

    with one.site.store.reading() as connection:
        (place,) = student_assignments(connection, one.ids[ZOE], number)
        paper = student_paper(connection, one.site.course, place, one.ids[ZOE], "en")
    texts = dict.fromkeys(paper.fields, "7")
    return submission.submit(
        one.site, place, paper, one.ids[ZOE], texts, 1, CLOSES - SECOND, "site"
    ).submission


def test_the_boxes_that_a_record_tells_are_those_of_the_page(served):
    from coursework.database.publication import student_assignments
    from coursework.site.papers.student_paper import student_paper

    number = dealt(served)
    for name in (ZOE, MAX):
        with served.site.store.reading() as connection:
            (place,) = student_assignments(connection, served.ids[name], number)
            paper = student_paper(connection, served.site.course, place, served.ids[name], "fr")
        told = {
            box.name: (box.variant.exercise.name, box.variant.seed, box.part.id, box.variant.lang)
            for box in paper.boxes.values()
        }
        assert {key: tuple(one) for key, one in paper.fields.items()} == told


# ---------------------------------------------------------------------- the worker


def test_it_says_that_it_is_being_marked_and_then_shows_the_result(served):
    number = dealt(served, replace(USUAL, feedback="at_once"))
    for lang, says in (("en", "are being marked"), ("fr", "en cours de correction")):
        browser = served.browser({"en": ZOE, "fr": MAX}[lang], lang)
        reply = handed_in(browser, number, right(served, {"en": ZOE, "fr": MAX}[lang]))
        address = reply.headers["location"]
        assert says in browser.get(address).text
        assert browser.get(f"/assignments/{number}/feedback").headers["location"] == address
    assert marks_of(served, number) == 0
    worked_off(served)
    assert marks_of(served, number) == 4
    assert says not in browser.get(address).text
    assert browser.get(f"/assignments/{number}/feedback").status_code == 200


def test_a_job_that_its_worker_left_is_taken_again_and_nothing_is_marked_twice(site_class):
    one, number = site_class, None
    number = dealt(one)
    handed_in(one.browser(ZOE), number, right(one, ZOE))
    with one.site.store.begin() as connection:
        assert take_job(connection, "first", one.at) is not None  # and it is killed
    with one.site.store.begin() as connection:
        assert take_job(connection, "other", one.at + SECOND) is None
        again = take_job(connection, "first", one.at + SECOND)
        assert again.tries == 2
    one.at += timedelta(minutes=5)
    with one.site.store.begin() as connection:
        assert take_job(connection, "other", one.at).tries == 3
    with one.site.store.begin() as connection:
        assert take_job(connection, "other", one.at + SECOND) is None  # it is given up: it ends its workers
        given_up = connection.execute(select(job.c.submission_id).where(job.c.fault != "")).scalars().all()
        assert given_up == [delivered(one, number)[0].id]
        connection.execute(job.update().values(fault="", tries=0))
    worked_off(one)
    worked_off(one)
    assert marks_of(one, number) == 2
    with one.site.store.reading() as connection:
        assert waiting(connection)[0] == 0


def test_two_workers_never_take_the_same_job(site_class):
    one = site_class
    number = dealt(one)
    handed_in(one.browser(ZOE), number, right(one, ZOE))
    with one.site.store.begin() as connection:
        made = connection.execute(select(tables.submission.c.id)).scalar()
        connection.execute(job.delete())
        for _ in range(20):
            put_job(connection, MARK, number, one.at, submission=made)

    def taken(name):
        found = []
        while True:
            with one.site.store.begin() as connection:
                mine = take_job(connection, f"{name} {len(found)}", one.at)
            if mine is None:
                return found
            found.append(mine.id)

    with ThreadPoolExecutor(4) as threads:
        found = [number for some in threads.map(taken, "abcd") for number in some]
    assert len(found) == len(set(found)) == 20


def test_a_job_that_always_fails_is_given_up_and_told(served, monkeypatch, caplog):
    number = dealt(served, replace(USUAL, feedback="at_once"))
    browser = served.browser(ZOE)
    address = handed_in(browser, number, right(served, ZOE)).headers["location"]
    handed_in(served.browser(MAX), number, right(served, MAX))
    bad = delivered(served, number)[0].id
    from coursework.site import worker

    whole, tried = worker.mark_submission, []

    def falls(course, store, made):
        tried.append(made)
        return 1 / 0 if made == bad else whole(course, store, made)

    monkeypatch.setattr(worker, "mark_submission", falls)
    worked_off(served)
    assert tried.count(bad) == MOST_TRIES
    assert marks_of(served, number) == 2  # the others' are marked
    assert f"submission {bad}" in caplog.text
    assert "could not be marked" in browser.get(address).text
    with served.site.store.reading() as connection:
        faults = connection.execute(select(job.c.fault).where(job.c.fault != "")).scalars().all()
        assert faults == ["ZeroDivisionError"]


def test_what_was_saved_is_handed_in_when_nobody_asks_for_a_page(site_class):
    one = site_class
    number = with_crowd(one, replace(USUAL, takes_saved=True))
    rows = [
        {
            "person_id": one.ids[name],
            "sheet": f"assignment/{number}",
            "box": "e1-rA",
            "text": "5",
            "version": 1,
            "changed": CLOSES - SECOND,
        }
        for name in CROWD
    ]
    from coursework.database.tables import draft

    with one.site.store.begin() as connection:
        connection.execute(insert(draft), rows)
    worker = Worker(one.site, "test")
    one.at = CLOSES + SECOND
    worker.close()
    assert not delivered(one, number, CROWD[0])  # what arrived in time may wait still
    one.at = CLOSES + SETTLES + SECOND
    worker.close()
    worker.close()
    for name in CROWD:
        (made,) = delivered(one, number, name)
        assert (made.source, made.late) == (submission.AS_SAVED, 0)
    worked_off(one)
    assert marks_of(one, number) == 2 * len(CROWD)


def test_one_whose_answers_cannot_be_handed_in_keeps_nobody_elses_back(served, monkeypatch):
    number = dealt(served, replace(USUAL, takes_saved=True))
    for name in (ZOE, MAX):
        served.browser(name).fill(f"/assignments/{number}/keep", {"text.e1-rA": "5", "over.e1-rA": "0"})
    served.at = CLOSES + SETTLES + SECOND
    saved = submission._saved
    with monkeypatch.context() as falling:
        falling.setattr(
            submission,
            "_saved",
            lambda site, connection, number, person, at: (
                1 / 0 if person == served.ids[ZOE] else saved(site, connection, number, person, at)
            ),
        )
        Worker(served.site, "test").close()
    assert (len(delivered(served, number)), len(delivered(served, number, MAX))) == (0, 1)
    worked_off(served)
    assert len(delivered(served, number)) == 1


def test_what_an_older_version_left_unmarked_is_put_in_the_queue(served):
    number = dealt(served)
    handed_in(served.browser(ZOE), number, right(served, ZOE))
    with served.site.store.begin() as connection:
        connection.execute(job.delete())
    served.at += SECOND
    for _ in range(2):
        Worker(served.site, "test").take_over()
    with served.site.store.reading() as connection:
        assert waiting(connection)[0] == 1
    worked_off(served)
    assert marks_of(served, number) == 2


def test_a_receipt_stands_for_what_was_stored_before_anything_is_marked(served):
    number = dealt(served)
    reply = handed_in(served.browser(ZOE), number, right(served, ZOE))
    assert [one.receipt for one in delivered(served, number)] == [code_of(reply)]
    with served.site.store.reading() as connection:
        assert connection.execute(select(func.count()).select_from(mark)).scalar() == 0


def test_a_hand_in_and_its_receipt_take_few_statements(site_class):
    number, store = dealt(site_class), site_class.site.store
    browser = site_class.browser(ZOE)
    form = {"_seal": browser.seal, **form_of(site_class, ZOE)}
    with statements(store) as to_hand_in:
        reply = browser.post(f"/assignments/{number}/hand-in", data=form)
    with statements(store) as to_show:
        page = browser.get(reply.headers["location"])
    assert (reply.status_code, page.status_code) == (303, 200)
    is_sqlite = store.has_one_writer  # where no row needs to be locked
    assert [count_of(found)[0] for found in (to_hand_in, to_show)] == [8 if is_sqlite else 9, 7]
