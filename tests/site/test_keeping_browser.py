"""What is typed is kept, whatever happens to the line, the page and the session: on sheets to practise and on
papers alike."""

import re
from dataclasses import replace

import pytest
from site_assignments import ASSIGNMENT, CLOSES, dealt
from site_browser import context_of, serious, told, too_wide
from site_people import MAX, ZOE, signed_in
from site_server import until

from coursework.database.drafts import drafts
from coursework.site.frame.cookies import COOKIE

pytestmark = pytest.mark.e2e

KEPT = "is kept|Saved"
#: One a test: what one typed is not there for another.
_EXERCISES = iter(
    "slotted_mechanism coriolis two_circles grashof quick_return_design havens_planetary slider_extras "
    "ball_reducer quick_return four_bar_positions crank_rocker_design "
    "mechanical_advantage slider_crank".split()
)
_ON_DEVICE = (
    "Object.entries(localStorage).filter(([key]) => key.startsWith('coursework ')).map(([, text]) => "
    "text).join()"
)


class Device:
    """A browser of Zoé's at one sheet; ``boxes`` are two of its boxes, by the names that they are kept
    under."""

    def __init__(self, desk, kind, name):
        self.class_, self.home, browser = desk
        self.context = context_of(browser, self.class_, self.home, ZOE)
        if kind == "paper":
            number = dealt(self.class_, assignment=replace(ASSIGNMENT, name=name))
            self.sheet, self.own, self.boxes = f"assignment/{number}", "", ("e1-rA", "e1-theta4")
            self.place = f"{self.home}/assignments/{number}"
        else:
            page = self.page(f"{self.home}/practice/{next(_EXERCISES)}")
            self.place, self.own = page.url, "a-"
            names = page.locator("input[type=text][name^=a-]:not([data-cell], [data-form])").evaluate_all(
                "all => all.map((box) => box.name.slice(2))"
            )
            self.boxes = list(dict.fromkeys(names))[:2]
            self.sheet = self.place.removeprefix(f"{self.home}/")
            page.close()

    def page(self, place=None):
        page = self.context.new_page()
        page.goto(place or self.place)
        return page

    def box(self, number=0):
        return f"[name={self.own}{self.boxes[number]}]"

    @property
    def kept(self):
        with self.class_.site.store.reading() as connection:
            found = drafts(connection, self.class_.ids[ZOE], self.sheet)
        return {name: box.text for name, box in found.items()}

    def sign_in(self, name=ZOE):
        value = signed_in(self.class_.site.store, self.class_.ids[name])
        self.context.add_cookies([{"name": COOKIE, "value": value, "domain": "127.0.0.1", "path": "/"}])

    def sign_out(self):
        self.context.clear_cookies(name=COOKIE)


@pytest.fixture(params=["paper", "practice"])
def device(desk, request):
    found = Device(desk, request.param, re.sub(r"\W", "", request.node.name))
    yield found
    found.context.close()


def left(page):
    """What is on the device."""
    return page.evaluate(_ON_DEVICE)


def test_two_pages_without_a_line_overwrite_nothing_of_one_another(device):
    one, other = device.page(), device.page()
    device.context.set_offline(True)
    one.fill(device.box(), "111")
    told(one, "No connection")
    other.fill(device.box(), "222")
    other.fill(device.box(1), "33")
    told(other, "No connection")
    # The page that was typed in last is closed first: what counts is the typing.
    for page in (other, one):
        page.close()
    device.context.set_offline(False)
    page = device.page()
    page.wait_for_selector(".other-page:not(:empty)")
    until(lambda: '"33"' not in left(page))
    # Of two texts none is sent before one is chosen, save by the page that wrote it, as it closes.
    first, second = device.boxes[:2]
    kept = device.kept
    assert kept in ({second: "33"}, *({first: text, second: "33"} for text in ("111", "222")))
    in_box, beside = page.input_value(device.box()), page.locator(".other-page:not(:empty)").inner_text()
    assert in_box == "222" or (in_box, kept.get(first)) == ("111", "222")
    offered = {"111": "222", "222": "111"}[in_box]
    assert offered in beside
    page.fill(device.box(), "2223")
    assert (too_wide(page), serious(page)) == (0, [])
    page.reload()
    assert page.input_value(device.box()) == "2223"
    page.click(f".other-page >> text={offered} >> xpath=following-sibling::button[1]")
    told(page, KEPT)
    assert page.input_value(device.box()) == offered == device.kept[first]
    assert left(page) == ""


def test_of_two_pages_each_is_told_what_the_other_wrote(device):
    one, other = device.page(), device.page()
    one.fill(device.box(), "1")
    told(one, KEPT)
    other.fill(device.box(), "2")
    other.wait_for_selector(".other-page >> text=/Another page wrote\\W* 1|Another page wrote “1”/")
    assert device.kept == {device.boxes[0]: "1"}
    other.click(".other-page >> text=Keep mine")
    told(other, KEPT)
    assert device.kept == {device.boxes[0]: "2"}
    one.fill(device.box(), "3")
    one.wait_for_selector(".other-page >> text=2")
    one.click(".other-page >> text=Take that")
    assert one.input_value(device.box()) == "2"


def test_all_texts_are_shown_where_three_meet(device):
    pages = [device.page() for _ in range(3)]
    pages[0].fill(device.box(), "111")
    told(pages[0], KEPT)
    device.context.set_offline(True)
    for page, text in zip(pages[1:], ("222", "333"), strict=True):
        page.fill(device.box(), text)
        told(page, "No connection")
    for page in pages:
        page.close()
    device.context.set_offline(False)
    page = device.page()
    beside = page.locator(".other-page:not(:empty)").inner_text()
    assert ("111" in beside, "222" in beside, page.input_value(device.box())) == (True, True, "333")
    page.click("text=Keep mine")
    told(page, KEPT)
    assert device.kept == {device.boxes[0]: "333"}


def test_signed_out_while_the_line_was_down_nothing_is_lost(device):
    page = device.page()
    device.context.set_offline(True)
    page.fill(device.box(), "44")
    told(page, "No connection")
    device.sign_out()
    device.context.set_offline(False)
    told(page, "You are signed out.")
    assert page.get_attribute("[data-kept] a", "href") == "/sign-in"
    device.sign_in(MAX)
    page.evaluate("window.dispatchEvent(new Event('online'))")
    page.wait_for_timeout(1500)
    assert (device.kept, "44" in left(page)) == ({}, True)  # what is Zoé's goes to nobody else
    device.sign_in()
    page.evaluate("window.dispatchEvent(new Event('online'))")
    told(page, KEPT)
    assert device.kept == {device.boxes[0]: "44"}
    page.fill(device.box(), "45")
    told(page, KEPT)
    until(lambda: left(page) == "")
    assert device.kept == {device.boxes[0]: "45"}
    device.sign_out()
    page.fill(device.box(), "46")
    told(page, "You are signed out.")
    assert "46" in left(page)


@pytest.mark.parametrize("place", ["/practice", "/assignments"])
def test_what_a_page_left_is_sent_from_the_lists(device, place):
    page = device.page()
    device.context.set_offline(True)
    page.fill(device.box(), "55")
    told(page, "No connection")
    page.close()
    device.context.set_offline(False)
    page = device.page(device.home + place)
    told(page, "have been sent")
    assert (device.kept, left(page)) == ({device.boxes[0]: "55"}, "")


_LOSES_ANSWERS = """() => {
  const send = window.fetch;
  window.loses = true;
  window.fetch = async (address, ...how) => {
    const loses = window.loses && /\\/(keep|draft)$/.test(address), reply = await send(address, ...how);
    if (loses) throw new TypeError("the answer got lost");
    return reply;
  };
}"""


def test_an_answer_that_got_lost_makes_nobody_another_page(device):
    """The server took a text, and its answer never came: what is typed after it is no other page's."""
    page = device.page()
    page.evaluate(_LOSES_ANSWERS)
    page.fill(device.box(), "6")
    told(page, "No connection")
    assert device.kept == {device.boxes[0]: "6"}
    page.evaluate("window.loses = false")
    page.fill(device.box(), "66")
    told(page, KEPT)
    assert device.kept == {device.boxes[0]: "66"}
    assert page.locator(".other-page:not(:empty)").count() == 0


def test_a_text_that_is_too_long_holds_up_no_other(device):
    page = device.page()
    device.context.set_offline(True)
    page.fill(device.box(), "7" * 4001)
    page.fill(device.box(1), "77")
    told(page, "No connection")
    device.context.set_offline(False)
    told(page, "cannot be sent")
    assert device.kept == {device.boxes[1]: "77"}
    assert "7" * 4001 in left(page)


def test_a_browser_that_keeps_nothing_is_told(device):
    device.context.add_init_script("Storage.prototype.setItem = () => { throw new Error('full') }")
    page = device.page()
    page.fill(device.box(), "8")
    told(page, "stores nothing by itself")
    told(page, KEPT)
    device.context.set_offline(True)
    page.fill(device.box(), "88")
    told(page, "leave this page open")
    device.context.set_offline(False)
    told(page, KEPT)
    assert device.kept == {device.boxes[0]: "88"}


@pytest.mark.parametrize("device", ["paper"], indirect=True)
def test_what_comes_after_the_end_is_told_and_stays_on_the_device(device):
    at = device.class_.at
    page = device.page()
    device.context.set_offline(True)
    page.fill(device.box(), "99")
    told(page, "No connection")
    device.class_.at = CLOSES.replace(minute=1)
    try:
        device.context.set_offline(False)
        told(page, "no longer accepted")
        page.close()
        page = device.page(f"{device.home}/assignments")
        told(page, "no longer accepted")
        address = page.locator("[data-kept-left] a").get_attribute("href")
        assert device.home + address == device.place
        assert "99" in left(page)
        assert device.kept == {}
    finally:
        device.class_.at = at
