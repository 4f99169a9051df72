"""Reading a sheet in Chromium: keys for a part's signs, figure and data in sight, one question at a time,
dark and printed pages."""

import pytest
from site_browser import chromium, context_of, cut_in_print, serious, served, too_wide
from site_people import ZOE, Class

pytestmark = pytest.mark.e2e


@pytest.fixture(scope="module")
def window(tmp_path_factory):
    """Open a practice page."""
    class_ = Class(f"sqlite:///{tmp_path_factory.mktemp('site')}/site.db")
    with served(class_) as address, chromium() as browser:

        def open_(exercise, **how):
            context = context_of(browser, class_, address, ZOE, is_mobile=how.get("size") != "desk", **how)
            page = context.new_page()
            page.goto(f"{address}/practice/{exercise}")
            return page

        yield open_


def test_a_part_has_keys_for_its_signs_and_a_keyboard_of_numbers(window):
    page = window("slotted_mechanism", lang="fr")
    page.tap("#answer-a-theta4")
    keys = page.locator("#keys button").all_inner_texts()
    assert set("−,()^√π°") <= set("".join(keys))
    assert page.locator("#answer-a-theta4").evaluate("box => box.inputMode") == "decimal"
    for sign in ("−", "√"):
        page.locator("#keys button", has_text=sign).tap()
    page.keyboard.type("2)")
    assert page.input_value("#answer-a-theta4") == "-√(2)"
    page.wait_for_selector("#read-a-theta4:has-text('1,414')")
    page.locator("#keys button", has_text="abc").tap()
    assert page.locator("#answer-a-theta4").evaluate("box => box.inputMode") == "text"
    page = window("ball_reducer", lang="en")
    box = page.locator("input[id^=answer-a-no_slip]").first
    box.tap()
    for sign in ("R", "ω", "="):
        page.locator("#keys button", has_text=sign).first.tap()
    page.keyboard.type("1")
    assert box.input_value() == "R*omega=1"
    page.wait_for_selector("[id^=read-a-no_slip] math")  # typeset, not as it was typed


def test_figure_and_data_stay_in_sight(window):
    page = window("four_bar_motion")
    bar, data = page.locator("[data-bar]"), page.locator(".sheet-data")
    assert not bar.is_visible()
    page.evaluate("document.querySelector('ol.questions > li:nth-child(4)').scrollIntoView()")
    page.wait_for_selector("[data-bar]:visible")
    top = page.evaluate("scrollY")
    bar.locator("button").tap()
    box = data.bounding_box()
    assert (page.evaluate("scrollY"), box["y"] >= 40, box["y"] + box["height"] < 844) == (top, True, True)
    page.keyboard.press("Escape")
    assert data.bounding_box()["y"] < 0
    wide = window("four_bar_motion", size="desk")
    wide.evaluate("document.querySelector('ol.questions > li:nth-child(6)').scrollIntoView()")
    assert wide.locator(".sheet-data figure img").first.bounding_box()["y"] >= 0


def test_one_question_at_a_time_is_a_choice_that_stays(window):
    page = window("four_bar_motion")
    page.tap("[data-one-switch] button")
    page.tap("[data-step='1']")
    shown = page.locator("ol.questions > li:visible")
    assert (shown.count(), shown.locator(".number").inner_text()) == (1, "2.")
    page.reload()
    assert page.locator("ol.questions > li:visible").count() == 1
    assert cut_in_print(page) == (0, [])
    page.emulate_media(media="print")
    assert page.locator("ol.questions > li:visible").count() > 5
    assert page.locator("button:visible:not(.visually-hidden)").count() == 0


def test_dark_pages_are_dark_read_well_and_print_light(window):
    page = window("four_bar_motion", color_scheme="dark")
    ground = "getComputedStyle(document.body).backgroundColor.match(/\\d+/g).map(Number)"
    assert (max(page.evaluate(ground)) < 60, serious(page), too_wide(page)) == (True, [], 0)
    page.emulate_media(media="print", color_scheme="dark")
    assert page.evaluate(ground) == [255, 255, 255]
