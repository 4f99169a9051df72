"""Handing in by a real browser without the site's script; with it: test_in_browser_flows.py and
test_keeping_browser.py."""

from dataclasses import replace

import pytest
from site_assignments import USUAL, dealt
from site_browser import chromium, context_of, served, too_wide
from site_people import ZOE

from coursework.database.submissions import submissions_of

pytestmark = [pytest.mark.e2e, pytest.mark.slow]


@pytest.fixture(scope="module")
def browser():
    with chromium() as found:
        yield found


@pytest.mark.parametrize(("lang", "size"), [("fr", "telephone"), ("en", "desk")])
def test_a_paper_is_filled_in_read_back_and_handed_in_without_a_script(class_of_three, browser, lang, size):
    number = dealt(class_of_three, replace(USUAL, feedback="at_once"))
    with served(class_of_three) as address:
        page = context_of(browser, class_of_three, address, ZOE, lang, size, script=False).new_page()
        page.goto(f"{address}/assignments")
        with page.expect_navigation():
            page.click(".card .main")
        page.fill("[name=e1-rA]", "319,8")
        page.check("[name=e2-linkage_type] >> nth=0")
        for _ in range(2):  # read back, then confirmed
            assert too_wide(page) <= 0
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
