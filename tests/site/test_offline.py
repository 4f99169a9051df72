"""What opens without a network: pages that their person has seen, and nothing of anybody after they went."""

import time
from dataclasses import replace
from datetime import timedelta

import pytest
from site_assignments import USUAL, dealt, handed_in
from site_browser import chromium, context_of, served
from site_people import MAX, TEACHER, ZOE, Class, signed_in
from site_server import until
from site_walk import Filled, filled, fillings

from coursework.site.application import ROUTES
from coursework.site.frame.cookies import COOKIE

EXERCISE, LESSON = "slotted_mechanism", "mobility_and_groups"


@pytest.mark.e2e
def test_only_pages_to_study_and_open_papers_are_marked(tmp_path):
    site = Filled(f"sqlite:///{tmp_path}/site.db")
    places, marked = fillings(site), set()
    for name in (ZOE, TEACHER):
        browser = site.browser(name)
        for route in ROUTES:
            reply = browser.get(filled(route.path, places[route.path].own)) if route.has_page else None
            if reply is not None and "offline-until" in reply.headers:
                assert (reply.status_code, reply.headers["x-person"]) == (200, str(site.ids[name]))
                marked.add(route.path)
    assert marked <= {
        "/practice",
        "/practice/{exercise}/{seed}",
        "/assignments/{number:int}",
        "/lessons/{lesson}",
    }
    assert marked >= {"/practice", "/practice/{exercise}/{seed}"}


def test_a_paper_is_marked_until_it_closes_and_not_before_it_opens_nor_after(class_of_three):
    number = dealt(class_of_three)
    address = f"/assignments/{number}"
    class_of_three.at = USUAL.opens - timedelta(seconds=1)
    assert "offline-until" not in class_of_three.browser(ZOE).get(address).headers
    class_of_three.at = USUAL.opens
    page = class_of_three.browser(ZOE).get(address)
    left = int(page.headers["offline-until"]) - _now()
    assert abs(left - (USUAL.closes - class_of_three.at).total_seconds()) < 60
    reply = handed_in(class_of_three.browser(ZOE), number, {"e1-rA": "1"})
    assert "offline-until" not in class_of_three.browser(ZOE).get(reply.headers["location"]).headers
    class_of_three.at = USUAL.closes + timedelta(seconds=1)
    assert "offline-until" not in class_of_three.browser(ZOE).get(address).headers


def _now():
    return int(time.time())


# --------------------------------------------------------------------- in a browser


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    class_ = Class(f"sqlite:///{tmp_path_factory.mktemp('site')}/site.db")
    with served(class_) as address, chromium() as browser:
        yield class_, address, browser


def opened(place, name, path="/practice"):
    """A window whose worker has begun, at a page that it has stored."""
    class_, address, browser = place
    page = context_of(browser, class_, address, name).new_page()
    for _ in range(2):  # loaded before the worker was there, and with it
        page.goto(address + path)
        page.evaluate("navigator.serviceWorker.ready.then(() => 0)")
    until(
        lambda: page.evaluate(
            "caches.keys().then((names) => names.some((name) => name.startsWith('pages ')))"
        )
    )
    return page


def of_person(page):
    """How many pages of anybody this device holds."""
    return page.evaluate(
        "caches.keys().then((names) => Promise.all(names.filter((n) => n.startsWith('pages ')).map((n) "
        "=> caches.open(n).then((c) => c.keys()))))"
        ".then((all) => all.flat().length)"
    )


def offline_text(page, address):
    page.context.set_offline(True)
    page.goto(address)
    text = page.inner_text("main")
    page.context.set_offline(False)
    return text


@pytest.mark.e2e
def test_a_seen_page_opens_without_a_network_and_what_is_typed_goes_when_it_is_back(place):
    page = opened(place, ZOE, f"/practice/{EXERCISE}")
    address = page.url
    page.fill("#answer-a-rA", "77")
    page.fill("#answer-a-theta4", "88")
    page.wait_for_selector("[data-kept]:has-text('Saved')")
    until(lambda: page.evaluate("() => caches.match(location.pathname + '?saved').then(Boolean)"))
    page.context.set_offline(True)
    page.goto(address)
    # Saved after it was opened.
    until(lambda: page.evaluate("document.querySelector('#answer-a-theta4').value === '88'"))
    page.fill("#answer-a-rA", "123")
    page.wait_for_selector("[data-kept]:has-text('No connection')")
    page.goto(address)
    page.goto(f"{place[1]}/practice/grashof")
    assert "No network" in page.inner_text("main")
    page.click(f"[data-kept-pages] a[href='{address}']")
    page.wait_for_url(address)
    page.context.set_offline(False)
    page.goto(address)
    assert page.input_value("#answer-a-rA") == "123"
    assert page.locator(".other-page:not(:empty)").count() == 0  # its own text is no other page's
    path = address.removeprefix(place[1])
    until(lambda: 'value="123"' in place[0].browser(ZOE).get(path).text)  # another device has it
    page.context.close()


@pytest.mark.e2e
def test_a_lesson_opens_without_a_network_with_figures_that_nobody_has_looked_at(place):
    page = opened(place, ZOE, f"/lessons/{LESSON}")
    page.locator(".lesson.stepped").wait_for()
    wanted = set(page.locator(".lesson img").evaluate_all("all => all.map((one) => one.src)"))
    held = "caches.open('figures').then((one) => one.keys()).then((keys) => keys.map((key) => key.url))"
    until(lambda: wanted <= set(page.evaluate(held)))
    page.context.set_offline(True)
    page.reload()
    page.locator("[data-go='1']").tap()
    assert page.locator(".step").count() > 10
    sizes = page.evaluate("""Promise.all([...document.querySelectorAll('.lesson img')].map((one) => {
      one.loading = 'eager'; return one.decode().then(() => one.naturalWidth); }))""")
    assert len(sizes) > 3
    assert min(sizes) > 0
    page.context.close()


@pytest.mark.e2e
def test_after_signing_out_nothing_of_the_person_is_there_even_without_a_network(place):
    for is_offline in (False, True):
        page = opened(place, ZOE)
        address = page.url
        assert of_person(page)
        page.context.set_offline(is_offline)
        page.click(".me summary")
        page.click("form[action='/sign-out'] button")
        page.wait_for_timeout(800)
        assert of_person(page) == 0
        assert "No network" in offline_text(page, address)
        page.context.close()


@pytest.mark.e2e
def test_another_person_on_the_device_sees_nothing_of_the_first(place):
    class_, address, _ = place
    page = opened(place, ZOE, f"/practice/{EXERCISE}")
    zoes = page.url
    cookie = signed_in(class_.site.store, class_.ids[MAX])  # without signing out
    page.context.add_cookies([{"name": COOKIE, "value": cookie, "url": address}])
    page.goto(f"{address}/practice")
    page.wait_for_timeout(800)
    assert of_person(page) == 1
    assert "No network" in offline_text(page, zoes)
    page.context.clear_cookies()  # a session that ended elsewhere
    page.goto(f"{address}/practice")
    page.wait_for_timeout(800)
    assert of_person(page) == 0
    page.context.close()


@pytest.mark.e2e
def test_a_paper_is_gone_when_it_closes_and_reviewing_without_a_network_stays(place):
    class_ = place[0]
    number = dealt(class_, replace(USUAL, closes=class_.at + timedelta(seconds=12)))
    page = opened(place, ZOE, f"/assignments/{number}")
    paper = page.url
    page.fill("[name=e1-rA]", "5")
    page.context.set_offline(True)
    page.click(".bar .main")
    page.wait_for_selector("[data-kept]:has-text('nothing was sent')")
    assert (page.url, page.input_value("[name=e1-rA]")) == (paper, "5")
    page.wait_for_timeout(12_500)
    assert "No network" in offline_text(page, paper)
    assert of_person(page) == 0
    page.context.close()


@pytest.mark.e2e
def test_who_presses_without_a_network_is_told_and_presses_again(place):
    """A form, and a page whose pieces come one by one; nothing is told to another page that is open."""
    number = dealt(place[0])
    page = opened(place, MAX, f"/assignments/{number}")
    page.fill("[name=e1-rA]", "5")
    page.click(".bar .main")
    page.wait_for_url("**/read-back")
    other = page.context.new_page()
    other.goto(f"{place[1]}/assignments/{number}")
    page.context.set_offline(True)
    for _ in range(2):
        page.click(".bar .main")
        page.wait_for_selector(".not-sent:has-text('nothing was sent')")
    assert page.locator(".not-sent").count() == 1
    assert "nothing was sent" not in other.inner_text("[data-kept]")
    page.context.set_offline(False)
    page.click(".bar .main")
    page.wait_for_url("**/receipts/*")
    page.goto(f"{place[1]}/explore/four_bar_motion")
    page.context.set_offline(True)
    page.fill("#of-r2", "60")
    page.wait_for_selector("#explore .not-sent")
    page.context.set_offline(False)
    page.fill("#of-r2", "61")
    page.wait_for_selector("#explore .not-sent", state="detached")
    page.context.close()
