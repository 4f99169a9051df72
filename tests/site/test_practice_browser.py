"""Practice in Chromium: what is typed is never lost, pieces come in place, a keyboard and a screen reader suffice."""

import pytest
from site_browser import chromium, context_of, serious, served, too_wide
from site_people import ZOE, Class, signed_in
from site_practising import right_answer

from coursework.site.frame.cookies import COOKIE

pytestmark = pytest.mark.e2e

EXERCISE = "slotted_mechanism"
SAVED = "#state >> text=/^Saved.$/"


@pytest.fixture(scope="module")
def desk(tmp_path_factory):
    """A site behind a server, and a browser."""
    class_ = Class(f"sqlite:///{tmp_path_factory.mktemp('site')}/site.db")
    with served(class_) as address, chromium() as browser:
        yield class_, address, browser


@pytest.fixture
def window(desk):
    """Makes windows of Zoé, each opened at a fresh variant or at an address."""
    class_, address, browser = desk
    opened = []

    def open_(place="", **how):
        context = context_of(browser, class_, address, how.pop("name", ZOE), **how)
        opened.append(context)
        page = context.new_page()
        page.goto(f"{address}/practice/{place or EXERCISE}")
        return page

    yield open_
    for context in opened:
        context.close()


def variant_of(desk, page):
    exercise, seed = page.url.split("#")[0].rsplit("/", 2)[1:]
    return desk[0].site.variant(exercise, int(seed), "en")


def kept(page):
    """What is kept of the page's sheet, as a page without script has it in its boxes."""
    return page.evaluate(
        """async () => { const text = await (await fetch(location.pathname)).text();
        const found = new DOMParser().parseFromString(text, "text/html");
        return Object.fromEntries(Array.from(found.querySelectorAll("input[type=text]"), (box) => [box.name, box.value])); }"""
    )


@pytest.mark.parametrize(
    "exercise",
    [
        "slotted_mechanism",
        "joint_twist",
        *(
            pytest.param(name, marks=pytest.mark.slow)
            for name in ("vocabulary", "velocity_polygon", "joint_graph", "slider_extras")
        ),
    ],
)
@pytest.mark.parametrize(("size", "lang"), [("telephone", "fr"), ("desk", "en")])
def test_a_sheet_fits_its_screen_and_is_read_aloud(window, exercise, size, lang):
    page = window(exercise, size=size, lang=lang)
    assert (too_wide(page), serious(page)) == (0, [])


@pytest.mark.parametrize("place", ["/practice", "/progress"])
def test_the_course_and_the_progress_fit_and_are_read_aloud(desk, window, place):
    page = window()
    page.goto(desk[1] + place)
    assert (too_wide(page), serious(page)) == (0, [])


def test_an_exercise_is_done_by_keyboard_alone(desk, window):
    page = window("coriolis")
    variant = variant_of(desk, page)
    for part in variant.parts:
        answer = right_answer(variant, part)
        if part.choices:
            page.focus(f"input[name='a-{part.id}'][value='{answer}']")
            page.keyboard.press("Space")
            continue
        page.focus(f"#answer-a-{part.id}")
        page.keyboard.type(answer)
        page.wait_for_selector(f"#read-a-{part.id} >> text=read as")
        page.keyboard.press("Enter")
        page.wait_for_selector(f"#told-a-{part.id} .right")
        assert page.evaluate("document.activeElement.id") == f"told-a-{part.id}"
    page.focus(".practice-bar button[name=check]")
    page.keyboard.press("Enter")
    page.wait_for_selector("#summary >> text=All of it is right.")
    assert page.evaluate("document.activeElement.id") == "summary"


def test_a_mechanism_moves_in_its_sheet(window):
    page = window()
    page.click("button[value=motion]")
    page.click("#play")
    places = set()
    for _ in range(20):
        places.add(page.get_attribute("#motion [data-track='1']", "d"))
        page.wait_for_timeout(50)
    assert len(places) > 2


def test_what_is_typed_offline_is_sent_when_the_line_is_back(window):
    page = window("grashof")
    page.context.set_offline(True)
    box = page.locator("input[type=text]").first
    name = box.get_attribute("name")
    box.fill("12.5")
    page.wait_for_selector("#state >> text=No connection")
    page.context.set_offline(False)
    page.wait_for_selector(SAVED)
    assert kept(page)[name] == "12.5"


def test_a_page_that_dies_offline_loses_nothing(window):
    page = window("crank_rocker_design")
    page.context.set_offline(True)
    name = page.locator("input[type=text]").first.get_attribute("name")
    page.fill(f"input[name={name}]", "33")
    page.wait_for_selector("#state >> text=No connection")
    context, address = page.context, page.url
    page.close()
    context.set_offline(False)
    again = context.new_page()
    again.goto(address)
    for _ in range(100):  # sent by the page as it dies, or by the next one
        if kept(again).get(name) == "33":
            break
        again.wait_for_timeout(100)
    assert again.input_value(f"input[name={name}]") == "33" == kept(again)[name]


def test_of_two_pages_each_is_told_what_the_other_wrote(window):
    one = window("two_circles")
    other = one.context.new_page()
    other.goto(one.url)
    box = one.locator("input[type=text]").first.get_attribute("name")
    one.fill(f"input[name={box}]", "1")
    one.wait_for_selector(SAVED)
    other.fill(f"input[name={box}]", "2")
    other.wait_for_selector("text=Another page wrote “1” here.")
    assert kept(one)[box] == "1"
    other.click("text=Keep mine")
    other.wait_for_selector(SAVED)
    assert kept(one)[box] == "2"
    one.fill(f"input[name={box}]", "3")
    one.wait_for_selector("text=Another page wrote “2” here.")
    one.click("text=Take that")
    assert one.input_value(f"input[name={box}]") == "2"


def test_a_session_that_ends_offline_costs_nothing(desk, window):
    page = window("quick_return_design")
    context, address = page.context, page.url
    box = page.locator("input[type=text]").first.get_attribute("name")
    cookie = next(one for one in context.cookies() if one["name"] == COOKIE)
    context.clear_cookies(name=COOKIE)
    page.fill(f"input[name={box}]", "44")
    page.wait_for_selector("#state >> text=You are signed out.")
    assert page.get_attribute("#state a", "href") == "/sign-in"
    # Signed in anew, in a session of its own: the open page takes its seal over.
    fresh = signed_in(desk[0].site.store, desk[0].ids[ZOE])
    context.add_cookies([{**{k: cookie[k] for k in ("name", "domain", "path")}, "value": fresh}])
    page.evaluate("window.dispatchEvent(new Event('online'))")
    page.wait_for_selector(SAVED)
    assert kept(page)[box] == "44"
    assert page.url == address


def test_what_one_page_left_is_sent_from_the_course(desk, window):
    page = window("mechanical_advantage")
    context, address = page.context, page.url
    box = page.locator("input[type=text]").first.get_attribute("name")
    context.clear_cookies(name=COOKIE)
    page.fill(f"input[name={box}]", "55")
    page.wait_for_selector("#state >> text=You are signed out.")
    page.close()
    fresh = signed_in(desk[0].site.store, desk[0].ids[ZOE])
    context.add_cookies([{"name": COOKIE, "value": fresh, "domain": "127.0.0.1", "path": "/"}])
    course = context.new_page()
    course.goto(f"{desk[1]}/practice")
    course.wait_for_selector("#state >> text=have been sent")
    course.goto(address)
    assert course.input_value(f"input[name={box}]") == "55"


def test_a_page_without_script_checks_and_keeps_what_is_typed(desk, window):
    page = window("havens_planetary", script=False)
    variant = variant_of(desk, page)
    part, other = [p for p in variant.parts if p.sort.is_number][:2]
    page.fill(f"#answer-a-{other.id}", "12 apples")
    page.fill(f"#answer-a-{part.id}", right_answer(variant, part))
    page.locator(f"#below-a-{part.id} button[name=check]").click()
    assert page.locator(f"#told-a-{part.id} .right").count() == 1
    assert page.url.endswith(f"#told-a-{part.id}")
    assert page.input_value(f"#answer-a-{other.id}") == "12 apples"
    page.goto(page.url.split("#")[0])
    assert page.input_value(f"#answer-a-{other.id}") == "12 apples"


def test_a_thumb_hits_what_there_is(window):
    page = window()
    page.fill("#answer-a-rA", "100")
    page.press("#answer-a-rA", "Enter")
    page.wait_for_selector("#told-a-rA .missed")
    page.click("#below-a-rA button[name=hint]")
    page.wait_for_selector("#hints-a-rA .hint-step")
    low = page.evaluate(
        """() => Array.from(document.querySelectorAll("main button, main input:not([type=hidden]), main select, main summary, .told a, .summary a"))
        .map((one) => [one, (one.closest("fieldset label") || one).getBoundingClientRect()])
        .filter(([one, room]) => room.height > 0 && room.height < 43.5 && !one.closest(".visually-hidden"))
        .map(([one, room]) => one.outerHTML.slice(0, 90) + room.height)"""
    )
    assert low == []
