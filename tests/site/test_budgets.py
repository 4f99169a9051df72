"""What one person may make the site do: bodies, files and requests within stated budgets, refused before they
are read."""

import json
import re
import socket
import threading
import tracemalloc
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from urllib.parse import urlencode, urlsplit

import pytest
from lti_platform import SITE
from site_assignments import dealt, right
from site_browser import served
from site_linked import Linked
from site_people import MAX, TEACHER, ZOE, seal_of, signed_in
from site_server import until
from site_walk import Filled, filled, fillings

from coursework.database.permissions import is_of_staff
from coursework.gradebook.submissions import read_rows
from coursework.site.application import ROUTES
from coursework.site.frame.budgets import ANSWER_FILE, BOXES, HAND_IN, KILOBYTE, MEGABYTE, MOST_ROWS
from coursework.site.frame.limits import ADDRESS, AT_ONCE, BACK, PERSON, Rate
from coursework.site.frame.requests import Response as SiteResponse
from coursework.site.lti.site_host import SiteHost
from coursework.site.papers import assignments
from coursework.system.allowances import Allowances
from coursework.system.headers import cookie_name
from coursework.system.processes import Exceeded, ResourceLimits, confined, processor_time
from coursework.system.request_slots import Crowded, RequestSlots

STUDENTS = [page for page in ROUTES if page.takes_forms and not is_of_staff(page.permission)]
PATIENCE = 60  #: seconds; a test that waits so long has failed
HEADER = "student,exercise,seed,part,answer\n"


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    return Filled(f"sqlite:///{tmp_path_factory.mktemp('budgets')}/site.db")


# ---------------------------------------------------------------------- the table of budgets


def test_each_page_that_takes_something_of_a_student_states_its_budget():
    assert not [page.path for page in STUDENTS if page.budget is None]


def test_no_budget_of_students_is_more_than_is_stated():
    """Bytes of a body; with files, seconds of a processor and memory of who reads them."""
    for page in STUDENTS:
        budget = page.request_budget
        if not budget.files:
            assert budget.largest <= 256 * KILOBYTE, page.path
            continue
        assert budget.largest <= 2 * MEGABYTE + 4 * KILOBYTE, page.path
        assert (budget.files, budget.at_once) == (1, 1), page.path
        assert budget.reading is not None, page.path
        assert budget.reading.seconds <= 4, page.path
        assert budget.reading.memory <= 192 * MEGABYTE, page.path
    assert all(ANSWER_FILE.by_ending[ending] == 256 * KILOBYTE for ending in (".csv", ".json"))


def head(class_, url, path, length, kind="application/x-www-form-urlencoded", name=ZOE):
    """The head of a form's request as a browser of somebody sends it."""
    cookie = signed_in(class_.site.store, class_.ids[name])
    lines = (
        f"POST {path} HTTP/1.1",
        f"Host: {urlsplit(url).netloc}",
        f"Content-Type: {kind}",
        f"Content-Length: {length}",
        f"Cookie: {cookie_name(False)}={cookie}",
        f"X-Seal: {seal_of(class_.site, cookie)}",
        "",
        "",
    )
    return "\r\n".join(lines).encode()


def answered(url, data):
    """The first bytes that come back for what was sent, while the line stays open."""
    parts = urlsplit(url)
    with socket.create_connection((parts.hostname, parts.port), timeout=PATIENCE) as line:
        line.sendall(data)
        return line.recv(65536)


def test_what_is_over_a_budget_is_refused_by_its_head_alone(site):
    """Not a byte of the body is sent: who waits for one never answers."""
    told = {}
    with served(site) as url:
        for page in STUDENTS:
            address = filled(page.path, fillings(site)[page.path].own)
            for kind in ("application/x-www-form-urlencoded", "multipart/form-data; boundary=x"):
                reply = answered(url, head(site, url, address, page.request_budget.largest + 1, kind))
                told[page.path, kind] = reply.split()[1]
    assert {place: status for place, status in told.items() if status != b"413"} == {}


def bodies(budget):
    """The worst of each type that a form may have, all within the budget."""
    room = budget.largest - 1024
    yield "application/x-www-form-urlencoded", urlencode({"x": "%" * (room // 3 - 10)}).encode()
    fields = "&".join(f"a{k}=" for k in range(budget.fields))[:room]
    yield "application/x-www-form-urlencoded", fields.encode()
    part = b'--x\r\nContent-Disposition: form-data; name="%d"\r\n\r\ny\r\n'
    several = b"".join(part % k for k in range(budget.fields))[: room - 100]
    yield "multipart/form-data; boundary=x", several + b"\r\n--x--\r\n"
    one = b'--x\r\nContent-Disposition: form-data; name="file"; filename="a.ipynb"\r\n\r\n'
    yield "multipart/form-data; boundary=x", one + b"[" * (room - 200) + b"\r\n--x--\r\n"


@pytest.mark.e2e
def test_the_worst_body_within_a_budget_takes_little_memory(site):
    """As much as a form of its size needs, whatever is in it."""
    over = []
    for page in STUDENTS:
        address = filled(page.path, fillings(site)[page.path].own)
        for kind, body in bodies(page.request_budget):
            browser = site.browser(ZOE)
            headers = {"content-type": kind, "x-seal": browser.seal}
            browser.post(address, content=body, headers=headers)
            tracemalloc.start()
            reply = browser.post(address, content=body, headers=headers)
            most = tracemalloc.get_traced_memory()[1]
            tracemalloc.stop()
            if most > 24 * MEGABYTE or reply.status_code >= 500:
                over.append((page.path, kind, len(body), most, reply.status_code))
    assert not over


# ------------------------------------------------------------------------- processor time


def spend(class_, kind, name=ZOE):
    class_.site.limits.add_processor_time(kind, class_.ids[name], AT_ONCE + 12 * BACK)


def test_who_took_much_of_a_processor_waits_and_nobody_else(class_of_three):
    spend(class_of_three, "usual")
    for lang, said in (("en", "Wait {} seconds"), ("fr", "Attendez {} secondes")):
        reply = class_of_three.browser(ZOE, lang).get("/practice")
        after = reply.headers["retry-after"]
        assert (reply.status_code, said.format(after) in reply.text) == (429, True)
        assert 1 <= int(after) <= 12
    assert class_of_three.browser(MAX).get("/practice").status_code == 200


def test_who_took_much_of_a_processor_still_answers_and_hands_in_a_paper(class_of_three):
    """For papers one has an allowance apart; saving and handing in are refused to nobody even where that is
    spent."""
    number = dealt(class_of_three)
    texts = right(class_of_three, ZOE)
    browser = class_of_three.browser(ZOE)
    spend(class_of_three, "usual")
    assert browser.fill(f"/assignments/{number}", texts).status_code == 200
    for kind in ("paper", "hand_in", "upload"):
        spend(class_of_three, kind)
    assert browser.get(f"/assignments/{number}").status_code == 429
    name, text = next(iter(texts.items()))
    assert browser.fill(f"/assignments/{number}/keep", {f"text.{name}": text}).status_code == 200
    reply = browser.fill(f"/assignments/{number}/hand-in", {**texts, "_number": "1"})
    assert (reply.status_code, "/receipts/" in reply.headers["location"]) == (303, True)


def test_the_staff_has_no_allowance_to_spend(class_of_three):
    spend(class_of_three, "usual", TEACHER)
    assert class_of_three.browser(TEACHER).get("/practice").status_code == 200


@pytest.mark.e2e
def test_each_page_of_a_student_is_counted_by_what_it_takes_of_a_processor(site, monkeypatch):
    """Refusals too; what a process beside takes for it counts as well."""
    took = []
    monkeypatch.setattr(
        site.site.limits,
        "add_processor_time",
        lambda kind, person, seconds: took.append((kind, person, seconds)),
    )
    pages = [page for page in ROUTES if not is_of_staff(page.permission)]
    for page in pages:
        site.browser(ZOE).get(filled(page.path, fillings(site)[page.path].own))
    assert [kind for kind, _, _ in took] == [page.limit for page in pages]
    assert {person for _, person, _ in took} == {site.ids[ZOE]}
    assert all(seconds > 0 for _, _, seconds in took)
    before = processor_time()
    assert confined(ResourceLimits(20.0, 64 * MEGABYTE), sum, range(10_000_000)) == 49_999_995_000_000
    assert processor_time() - before >= 0.1


def test_the_documentation_states_the_limits():
    page = (Path(__file__).resolve().parents[2] / "docs/privacy.md").read_text("utf-8")
    rows = re.findall(r"^\| `(\w+)`: [^|]+\| (\d+) ([^|]+) \| (\d+) ([^|]+) \|$", page, re.MULTILINE)
    spans = {"a minute": 1, "in 10 minutes": 10}
    told = {name: ((int(own), spans[span]), (int(all_), spans[of])) for name, own, span, all_, of in rows}
    assert told == {name: (PERSON[name], ADDRESS[name]) for name in PERSON}
    assert f"{AT_ONCE:.0f} seconds of a processor at once, and {BACK} in each second" in page


def test_what_is_spent_comes_back():
    now = [0.0]
    found = Allowances(30.0, 0.125, lambda: now[0])
    assert found.wait("zoe") == 0
    found.spend("zoe", 29.0)
    assert found.wait("zoe") == 0
    found.spend("zoe", 3.0)
    assert (found.wait("zoe"), found.wait("max")) == (16, 0)
    now[0] = 15.0
    assert found.wait("zoe") == 1
    now[0] = 17.0
    assert found.wait("zoe") == 0
    now[0] = 10_000.0
    found.spend("zoe", 29.0)  # no more comes back than was spent
    assert found.wait("zoe") == 0
    found.spend("zoe", 1.0)
    assert found.wait("zoe") > 0


# ------------------------------------------------------------------------------ files


def sent(class_, number, name, data, lang="en", who=ZOE):
    return class_.browser(who, lang).fill(f"/assignments/{number}/file", files={"file": (name, data)})


def test_a_table_larger_than_a_paper_is_refused_and_says_how_large_it_may_be(class_of_three):
    number = dealt(class_of_three)
    large = (HEADER + "Zoé,grashof,1,part,1\n" * 400_000).encode()
    for lang, said in (("en", "The limit is 2 MB"), ("fr", "Le maximum est 2 MB")):
        reply = sent(class_of_three, number, "a.csv", large, lang)
        assert (reply.status_code, said in reply.text) == (413, True)
    for name in ("a.csv", "A.CSV", "a.json"):
        reply = sent(class_of_three, number, name, b" " * (256 * KILOBYTE + 1))
        assert (reply.status_code, "256 kB" in reply.text) == (413, True)


def test_more_rows_than_a_paper_has_are_told_in_the_students_language(class_of_three):
    number = dealt(class_of_three)
    rows = (HEADER + "Zoé,grashof,1,part,1\n" * (MOST_ROWS + 1)).encode()
    for lang, said in (("en", f"more than {MOST_ROWS} rows"), ("fr", f"plus de {MOST_ROWS} lignes")):
        reply = sent(class_of_three, number, "a.csv", rows, lang)
        assert (reply.status_code, said in reply.text) == (422, True)


@pytest.mark.usefixtures("own_process")
def test_a_notebook_with_its_figures_is_taken(class_of_three):
    """An honest file is larger than a table: pictures stand in it."""
    number = dealt(class_of_three)
    notebook = class_of_three.browser(ZOE).get(f"/assignments/{number}/notebook.ipynb").json()
    notebook["cells"].append(
        {
            "cell_type": "markdown",
            "metadata": {},
            "source": ["![](data:image/png;base64," + "A" * 1_500_000 + ")"],
        }
    )
    reply = sent(class_of_three, number, "mine.ipynb", json.dumps(notebook).encode())
    assert reply.status_code == 422  # nothing is answered in it
    assert "contains no answer" in reply.text


@pytest.mark.e2e
def test_a_file_that_takes_too_long_is_ended_and_told(class_of_three, monkeypatch):
    number = dealt(class_of_three)
    monkeypatch.setattr(
        assignments, "ANSWER_FILE", ANSWER_FILE._replace(reading=ResourceLimits(0.0, MEGABYTE))
    )
    monkeypatch.setattr(assignments, "read_rows", for_ever)
    for lang, said in (("en", "too much time"), ("fr", "trop de temps")):
        reply = sent(class_of_three, number, "a.csv", b"x", lang)
        assert (reply.status_code, said in reply.text) == (422, True)


@pytest.mark.e2e
def test_one_person_uploads_one_file_at_a_time_and_others_are_answered(class_of_three, monkeypatch):
    """Ten at once took five gigabytes, and every place of the process: another student's page did not
    come."""
    number = dealt(class_of_three)
    at_once, most, lock, go_on = 0, 0, threading.Lock(), threading.Event()

    def slow(*told):
        nonlocal at_once, most
        with lock:
            at_once += 1
            most = max(most, at_once)
        go_on.wait(PATIENCE)
        with lock:
            at_once -= 1
        return []

    monkeypatch.setattr(assignments, "_of_file", lambda *told: ({"e1-rA": "1", **dict(slow())}, []))
    with served(class_of_three) as url, ThreadPoolExecutor(12) as threads:
        import httpx

        def upload(_):
            browser = class_of_three.browser(ZOE)
            cookies = dict(browser.cookies)
            files = {"file": ("a.csv", HEADER.encode())}
            return httpx.post(
                f"{url}/assignments/{number}/file",
                files=files,
                cookies=cookies,
                headers={"x-seal": browser.seal},
                timeout=PATIENCE,
                trust_env=False,
            ).status_code

        uploads = [threads.submit(upload, k) for k in range(10)]
        try:
            theirs = dict(class_of_three.browser(MAX).cookies)
            for _ in range(3):
                page = httpx.get(f"{url}/assignments", cookies=theirs, timeout=PATIENCE / 2, trust_env=False)
                assert page.status_code == 200
        finally:
            go_on.set()
        assert {one.result() for one in uploads} <= {200, 422}
    assert most == 1


# ------------------------------------------------------------------------ in a process of its own


def for_ever(*told):
    while True:
        pass


@pytest.mark.e2e
def test_what_is_read_apart_is_limited_in_time_and_memory(tmp_path):
    means = ResourceLimits(20.0, 64 * MEGABYTE)
    path = tmp_path / "a.csv"
    path.write_text(HEADER + "Zoé,grashof,1,part,1\n" * 3)
    assert [row.answer for row in confined(means, read_rows, path, 5)] == ["1"] * 3
    with pytest.raises(Exceeded) as fault:
        confined(means, bytes, 100 * MEGABYTE)
    assert fault.value.resource == "memory"
    with pytest.raises(Exceeded) as fault:
        confined(ResourceLimits(0.0, 64 * MEGABYTE), for_ever)
    assert fault.value.resource == "time"


# ---------------------------------------------------------------------- links of learning platforms


@pytest.fixture
def linked(tmp_path):
    return Linked(tmp_path)


def link_addresses(linked, path):
    """Every address of the service that takes something, with a session of a student."""
    session = path.removeprefix("/lti/at/")
    taking = [route for route in linked.lti.routes if "POST" in (route.methods or ())]
    found = [
        "/lti" + re.sub(r"\{session\}", session, re.sub(r"\{path:path\}", "more", r.path)) for r in taking
    ]
    assert {f"/lti/{one}" for one in ("login", "launch")} <= set(found)
    return found


def test_what_is_over_the_budget_of_a_link_is_refused_by_its_head_alone(linked):
    visitor, _, path = linked.enter()
    cookies = "; ".join(f"{one.name}={one.value}" for one in visitor.browser.cookies.jar)
    told = {}
    with served(linked) as url:
        for address in link_addresses(linked, path):
            lines = (
                f"POST {address} HTTP/1.1",
                f"Host: {urlsplit(url).netloc}",
                "Content-Type: application/x-www-form-urlencoded",
                f"Content-Length: {BOXES.largest + 1}",
                f"Cookie: {cookies}",
                "",
                "",
            )
            told[address] = answered(url, "\r\n".join(lines).encode()).split()[1]
    assert set(told.values()) == {b"413"}


@pytest.mark.e2e
def test_the_worst_body_of_a_link_takes_little_memory(linked):
    visitor, _, path = linked.enter()
    kind, room, over = {"content-type": "application/x-www-form-urlencoded"}, BOXES.largest - 1024, []
    worst = urlencode({"x": "%" * (room // 3)}), "&".join(f"a{k}=" for k in range(40_000))[:room], "a" * room
    for address in link_addresses(linked, path):
        for body in worst:
            visitor.browser.post(address, content=body, headers=kind)
            tracemalloc.start()
            reply = visitor.browser.post(address, content=body, headers=kind)
            most = tracemalloc.get_traced_memory()[1]
            tracemalloc.stop()
            if most > 24 * MEGABYTE or reply.status_code not in (400, 403, 413):
                over.append((address, body[:20], most, reply.status_code))
    assert not over


def test_of_one_person_by_a_link_two_requests_are_answered_at_once(linked, monkeypatch):
    """Also where the person opened the link twice."""
    under_way, most, lock, go_on = set(), 0, threading.Lock(), threading.Event()

    def slow(self, visit, form=None):
        nonlocal most
        with lock:
            under_way.add(threading.get_ident())
            most = max(most, len(under_way))
        go_on.wait(PATIENCE)
        with lock:
            under_way.discard(threading.get_ident())
        return SiteResponse("")

    pages = [linked.enter() for _ in range(2)]
    monkeypatch.setattr(SiteHost, "answer", slow)
    with served(linked) as url, ThreadPoolExecutor(12) as threads:
        import httpx

        def asked(k):
            visitor, _, path = pages[k % 2]
            cookies = dict(visitor.browser.cookies)
            return httpx.get(url + path, cookies=cookies, timeout=PATIENCE, trust_env=False).status_code

        many = [threads.submit(asked, k) for k in range(10)]
        try:
            until(lambda: len(under_way) >= BOXES.at_once)
            mine = dict(linked.browser(MAX).cookies)
            page = httpx.get(f"{url}/assignments", cookies=mine, timeout=PATIENCE / 2, trust_env=False)
            assert page.status_code == 200
        finally:
            go_on.set()
        assert {one.result() for one in many} == {200}
    assert most == BOXES.at_once


def test_who_took_much_of_a_processor_by_a_link_waits_and_still_hands_in(linked):
    visitor, page, path = linked.enter(name="Ada Byron")
    who = json.dumps([SITE, "ada"])
    other, _, theirs = linked.enter(sub="max", name="Max")
    for kind in ("paper", "hand_in"):
        linked.site.limits.add_processor_time(kind, who, AT_ONCE + 12 * BACK)
    for lang, said in (("en", "Too many requests"), ("fr", "Trop de demandes")):
        reply = visitor.browser.get(path, headers={"accept-language": lang})
        assert (reply.status_code, said in reply.text) == (429, True)
        assert (
            1 <= int(reply.headers["retry-after"]) <= 600
        )  # with what the opening itself took of a processor
    assert other.browser.get(theirs).status_code == 200
    assert visitor.hand_in(path, page, linked.right("Ada Byron")).status_code == 303


def test_each_page_of_a_link_is_counted_by_what_it_takes_of_a_processor(linked):
    visitor, page, path = linked.enter()
    spent = linked.site.limits._processor._spent
    assert {kind for (kind, _), (seconds, _) in spent.items() if seconds > 0} == {"paper"}
    visitor.hand_in(path, page, {})
    assert {kind for (kind, _), (seconds, _) in spent.items() if seconds > 0} == {"paper", "hand_in"}


def test_links_that_are_opened_without_end_are_refused(tmp_path, monkeypatch):
    """By an address, where nobody is known yet; who is in is counted by person."""
    monkeypatch.setitem(ADDRESS, "usual", Rate(6, 1))
    linked = Linked(tmp_path)
    visitor, _, path = linked.enter()  # a login
    assert [visitor.browser.get("/lti/login").status_code for _ in range(6)] == [403] * 5 + [429]
    assert visitor.browser.get(path).status_code == 200


def test_forged_launches_without_end_are_refused_as_passwords_are(tmp_path, monkeypatch):
    monkeypatch.setitem(ADDRESS, "sign_in", Rate(4, 10))
    linked = Linked(tmp_path)
    visitor, _, path = linked.enter()  # one of the four
    forged = {"state": "x", "id_token": "a.b.c"}
    assert [visitor.returned(forged).status_code for _ in range(6)] == [400] * 3 + [429] * 3
    assert visitor.browser.get(path).status_code == 200


def test_forms_that_one_person_sends_without_end_are_refused_and_pages_are_not(tmp_path, monkeypatch):
    """As submissions on the site; another link of the same person, or another browser, gives no more."""
    monkeypatch.setitem(PERSON, "hand_in", Rate(3, 10))
    linked = Linked(tmp_path)
    (one, page, path), (two, again, theirs) = linked.enter(), linked.enter()
    other, their_page, others = linked.enter(sub="max", name="Max")
    assert [one.hand_in(path, page, {}).status_code for _ in range(2)] == [422] * 2
    assert [two.hand_in(theirs, again, {}).status_code for _ in range(2)] == [422, 429]
    assert one.browser.get(path).status_code == 200
    assert other.hand_in(others, their_page, {}).status_code == 422


def test_the_short_requests_of_links_precede_pages_as_those_of_the_site_do(linked, monkeypatch):
    visitor, page, path = linked.enter()
    lanes = []
    for lane in ("short", "usual"):

        async def seen(function, *arguments, lane=lane):
            lanes.append((lane, function.__name__))
            return function(*arguments)

        monkeypatch.setattr(linked.site.lanes, lane, seen)
    visitor.browser.get(path)
    visitor.hand_in(path, page, {})
    assert lanes == [
        ("usual", "_launch_of"),
        ("usual", "_counted"),
        ("short", "_launch_of"),
        ("short", "_counted"),
    ]


# ---------------------------------------------------------------------------------- places


def run_async(job):
    import asyncio

    return asyncio.run(job())


def test_so_many_of_a_key_are_answered_at_once_in_the_order_in_which_they_came():
    import asyncio

    async def job():
        places, order, at_once = RequestSlots(), [], []

        async def one(k):
            async with places.slot("zoe", 2):
                at_once.append(len(at_once_now) + 1)
                at_once_now.add(k)
                await asyncio.sleep(0.001)
                at_once_now.discard(k)
                order.append(k)

        at_once_now: set[int] = set()
        await asyncio.gather(*(one(k) for k in range(20)))
        async with places.slot("zoe", 1):
            pass
        return order, max(at_once)

    order, most = run_async(job)
    assert (order, most) == (list(range(20)), 2)


def test_too_many_that_wait_are_refused_and_who_gives_up_takes_no_place():
    import asyncio

    async def job():
        places = RequestSlots()
        async with places.slot("zoe", 1):
            waits = asyncio.create_task(_held(places))
            await asyncio.sleep(0)
            with pytest.raises(Crowded):
                await _held(places)
            waits.cancel()
            await asyncio.gather(waits, return_exceptions=True)
        await asyncio.wait_for(_held(places), PATIENCE)  # the place is free again

    async def _held(places):
        async with places.slot("zoe", 1, waiting=1):
            return True

    run_async(job)


def test_handing_in_waits_for_nothing_else_of_the_same_person():
    others = {page.request_budget.name for page in ROUTES if page.request_budget is not HAND_IN}
    assert HAND_IN.name not in others
    assert [page.path for page in ROUTES if page.request_budget is HAND_IN] == [
        "/assignments/{number:int}/hand-in"
    ]
