"""Handing in by a real browser: with the site's script and without it; what is typed while the line is down is not lost."""

from dataclasses import replace

import pytest
from site_assignments import USUAL, dealt
from site_browser import WIDTHS, chromium, context_of, serious, served, told, too_wide
from site_people import ZOE

from coursework.database.drafts import drafts
from coursework.database.submissions import submissions_of

pytestmark = [pytest.mark.e2e, pytest.mark.slow]


@pytest.fixture(scope="module")
def browser():
    with chromium() as found:
        yield found


def typed(one, number):
    with one.site.store.reading() as connection:
        return {
            name: box.text for name, box in drafts(connection, one.ids[ZOE], f"assignment/{number}").items()
        }


@pytest.mark.parametrize("script", [True, False])
@pytest.mark.parametrize(("lang", "size"), [("fr", "telephone"), ("en", "desk")])
def test_a_paper_is_filled_in_read_back_and_handed_in(class_of_three, browser, lang, size, script):
    assert size in WIDTHS
    number = dealt(class_of_three, replace(USUAL, feedback="at_once"))
    with served(class_of_three) as address:
        page = context_of(browser, class_of_three, address, ZOE, lang, size, script).new_page()
        page.goto(f"{address}/assignments")
        with page.expect_navigation():
            page.click(".card .main")
        page.fill("[name=e1-rA]", "319,8")
        page.check("[name=e2-linkage_type] >> nth=0")
        for _ in range(2):  # read back, then confirmed
            assert too_wide(page) <= 0
            assert not script or not serious(page)
            with page.expect_navigation():
                page.click(".bar .main")
        assert page.locator(".receipt .code").inner_text()
        page.reload()
        with page.expect_navigation():
            page.click("main a.main")
        assert too_wide(page) <= 0
        page.context.close()
    with class_of_three.site.store.reading() as connection:
        assert len(submissions_of(connection, number, class_of_three.ids[ZOE])) == 1


def test_what_is_typed_without_a_line_is_kept_and_sent_when_it_is_back(class_of_three, browser):
    number = dealt(class_of_three)
    with served(class_of_three) as address:
        context = context_of(browser, class_of_three, address, ZOE)
        page = context.new_page()
        page.goto(f"{address}/assignments/{number}")
        context.set_offline(True)
        page.fill("[name=e1-rA]", "319,8")
        told(page, "No connection")
        assert typed(class_of_three, number) == {}
        context.set_offline(False)
        told(page, "is kept")
        assert typed(class_of_three, number) == {"e1-rA": "319,8"}
        context.set_offline(True)
        page.fill("[name=e1-rA]", "320")
        page.close()
        context.set_offline(False)
        page = context.new_page()
        page.goto(f"{address}/assignments/{number}")
        assert page.input_value("[name=e1-rA]") == "320"
        told(page, "is kept")
        assert typed(class_of_three, number) == {"e1-rA": "320"}
        context.close()


def test_two_tabs_are_asked_which_of_two_texts_stands(class_of_three, browser):
    number = dealt(class_of_three)
    with served(class_of_three) as address:
        context = context_of(browser, class_of_three, address, ZOE)
        one, other = context.new_page(), context.new_page()
        for page in (one, other):
            page.goto(f"{address}/assignments/{number}")
        for page, text in ((one, "1"), (other, "2")):
            page.fill("[name=e1-rA]", text)
            told(page, "is kept|something else")
        assert "Another page wrote: 1" in other.locator(".other-page").inner_text()
        assert typed(class_of_three, number) == {"e1-rA": "1"}
        other.click(".other-page button >> nth=1")
        told(other, "is kept")
        assert typed(class_of_three, number) == {"e1-rA": "2"}
        context.close()
