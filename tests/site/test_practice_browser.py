"""Practice in Chromium: a sheet fits its screen, pieces come in place, a page without script does; what is
kept: test_keeping_browser.py."""

import pytest
from site_browser import low, serious, told, too_wide, windows
from site_people import ZOE
from site_practising import right_answer
from site_server import until

pytestmark = pytest.mark.e2e

EXERCISE = "slotted_mechanism"


@pytest.fixture
def window(desk):
    """Makes windows of Zoé, each opened at a fresh variant or at an address."""
    with windows(desk, ZOE) as open_:
        yield lambda place="", **how: open_(f"/practice/{place or EXERCISE}", **how)


def variant_of(desk, page):
    exercise, seed = page.url.split("#")[0].rsplit("/", 2)[1:]
    return desk[0].site.variant(exercise, int(seed), "en")


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


def test_a_mechanism_moves_in_its_sheet(window):
    page = window("four_bar_motion")
    page.click("button[value=motion]")
    page.click("#play")
    places = set()
    for _ in range(20):
        places.add(page.get_attribute("#motion [data-track='1']", "d"))
        page.wait_for_timeout(50)
    assert len(places) > 2


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
    assert low(page) == []


def test_what_a_button_did_not_do_without_a_network_stays_told_until_more_is_typed(desk, window):
    page = window("havens_planetary")
    part = next(p for p in variant_of(desk, page).parts if p.sort.is_number)
    page.context.set_offline(True)
    page.fill(f"#answer-a-{part.id}", "12")
    told(page, "what you type stays")
    page.locator(f"#below-a-{part.id} button[name=check]").click()
    told(page, "nothing was checked")
    tries = []
    page.on("requestfailed", lambda one: tries.append(one.url) if one.url.endswith("/draft") else None)
    page.evaluate("dispatchEvent(new Event('online'))")  # what is kept is tried again, in vain
    until(lambda: page.wait_for_timeout(50) or tries)
    page.wait_for_timeout(300)
    told(page, "nothing was checked")
    page.fill(f"#answer-a-{part.id}", "123")
    told(page, "what you type stays")
