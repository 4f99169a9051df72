"""Every page of the site, every exercise and every lesson on the narrowest screen, and with letters of twice
the size: nothing stands out of the page."""

import pytest
from site_browser import chromium, context_of, cut_at_side, enlarge_letters, served, too_wide
from site_lived import STUDENT, Lived, shown

import coursework

pytestmark = [pytest.mark.e2e, pytest.mark.sweep]
COURSE = coursework.open_course()

#: Lets all steps of a lesson be seen at once, each in its width.
ALL_STEPS = "document.querySelectorAll('.step').forEach((one) => one.classList.add('shown'))"


@pytest.fixture(scope="module")
def lived(tmp_path_factory):
    """The class of twelve behind a server, and a browser."""
    site = Lived(tmp_path_factory.mktemp("narrow"))
    with chromium() as browser, served(site) as address:
        yield site, address, browser


@pytest.mark.parametrize("lang", ["fr", "en"])
def test_nothing_is_wider_than_a_screen_of_320_pixels_with_letters_of_twice_their_size(lived, lang):
    site, address, browser = lived
    places = [(one.name, one.address) for one in shown(site)]
    places += [(STUDENT, f"/practice/{name}") for name in COURSE.names]
    places += [(STUDENT, f"/lessons/{name}") for name in COURSE.folder.lessons]
    pages, wrong = {}, {}
    for who, place in places:
        if who not in pages:
            pages[who] = context_of(browser, site, address, who, lang).new_page()
            pages[who].set_viewport_size({"width": 320, "height": 640})
        page = pages[who]
        enlarge_letters(page, 100)
        page.goto(address + place)
        if place.startswith("/lessons/"):
            page.locator(".lesson.stepped").wait_for()
            page.evaluate(ALL_STEPS)
        for letters in (100, 200):
            enlarge_letters(page, letters)
            if found := [*filter(None, [too_wide(page)]), *cut_at_side(page)]:
                wrong[letters, place] = found
    for page in pages.values():
        page.context.close()
    assert wrong == {}
