"""Every exercise on the narrowest screen, and with letters of twice the size: nothing stands out of the page."""

import pytest
from site_browser import chromium, context_of, served, too_wide
from site_people import ZOE, Class

import coursework

pytestmark = [pytest.mark.e2e, pytest.mark.sweep]


@pytest.mark.parametrize("lang", ["fr", "en"])
def test_no_exercise_is_wider_than_a_screen_of_320_pixels_with_letters_of_twice_their_size(tmp_path, lang):
    class_, wrong = Class(f"sqlite:///{tmp_path}/site.db"), []
    with served(class_) as address, chromium() as browser:
        page = context_of(browser, class_, address, ZOE, lang).new_page()
        page.set_viewport_size({"width": 320, "height": 568})
        for name in coursework.open_course().names:
            page.goto(f"{address}/practice/{name}")
            found = [too_wide(page)]
            page.add_style_tag(content="html { font-size: 200% }")
            found.append(too_wide(page))
            if any(wide > 0 for wide in found):
                wrong.append((name, found))
    assert not wrong
