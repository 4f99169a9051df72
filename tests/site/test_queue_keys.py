"""The queue in Chromium: by keys on a desk, by a thumb on a telephone, and without any script."""

import pytest
from desk_class import DeskClass
from desk_scans import picture, send, told_by_pictures
from site_browser import chromium, context_of, serious, served, too_wide
from site_people import TEACHER

from coursework.database.scans import typed_texts
from coursework.site.desk.class_cache import class_now

pytestmark = pytest.mark.e2e

WRITTEN = {"Ada": {"rA": "trop court"}, "Bo": {"rA": "trop court"}, "Cy": {"rA": "zz", "theta4": "zzz"}}


@pytest.fixture(scope="module")
def browser():
    with chromium() as found:
        yield found


@pytest.fixture
def desk(tmp_path):
    return DeskClass(f"sqlite:///{tmp_path}/desk.db", WRITTEN)


@pytest.fixture
def scanned(tmp_path, monkeypatch):
    """Three answer pages on which one number each is doubted."""
    told_by_pictures(monkeypatch)
    found = DeskClass(f"sqlite:///{tmp_path}/scans.db", {})
    send(
        found,
        *(
            (f"{n}.png", picture(found, n, rA=f"~1{k}", theta4="~9"))
            for k, n in enumerate(("Ada", "Bo", "Cy"))
        ),
    )
    return found


def next_card(page, press):
    group = page.locator("#card input[name=group]").input_value()
    press()
    page.wait_for_function(
        "g => { const f = document.querySelector('#card input[name=group]'); return !f || f.value !== g }",
        arg=group,
    )


@pytest.mark.parametrize("lang", ["en", "fr"])
def test_a_class_is_marked_by_keys_alone(browser, desk, lang):
    with served(desk) as address:
        page = context_of(browser, desk, address, TEACHER, lang, "desk").new_page()
        faults = []
        page.on("console", lambda said: faults.append(said.text) if said.type == "error" else None)
        page.goto(f"{address}/desk/{desk.number}/queue")
        for key in ("a", "u", "1", "r"):
            next_card(page, lambda key=key: page.keyboard.press(key))
        page.keyboard.press("c")
        page.keyboard.type("aru")  # in the comment these are letters
        page.keyboard.press("Escape")
        next_card(page, lambda: page.keyboard.press("0"))
        assert not faults
    results = class_now(desk.site, desk.number).results
    assert [results[name].points for name in ("Ada", "Bo", "Cy")] == [1, 1, 0]
    assert class_now(desk.site, desk.number).waiting == 0


@pytest.mark.parametrize("lang", ["en", "fr"])
def test_a_thumb_does_on_a_telephone(browser, desk, lang):
    with served(desk) as address:
        page = context_of(browser, desk, address, TEACHER, lang).new_page()
        page.goto(f"{address}/desk/{desk.number}/student?name=Cy")  # whose mark says why it is provisional
        assert too_wide(page) == 0
        page.goto(f"{address}/desk/{desk.number}/queue")
        assert (too_wide(page), serious(page)) == (0, [])
        boxes = [one.bounding_box() for one in page.locator(".acts button").all()]
        assert all(box["height"] >= 44 and box["y"] + box["height"] <= 844 for box in boxes)
        next_card(page, lambda: page.locator(".acts button.main").tap())
    assert class_now(desk.site, desk.number).results["Bo"].points == 1


@pytest.mark.parametrize("device", ["desk", "telephone"])
def test_pictures_of_a_question_are_confirmed_by_digits_and_enter_and_one_by_one_on_a_telephone(
    browser, scanned, device
):
    with served(scanned) as address:
        page = context_of(browser, scanned, address, TEACHER, "fr", device).new_page()
        page.goto(f"{address}/desk/{scanned.number}/scans/queue")
        assert (too_wide(page), serious(page)) == (0, [])
        assert page.locator(".cells").is_visible() == (device == "desk")
        if device == "desk":
            for key in ("2", "4", "2", "Enter", "Enter"):
                page.keyboard.press(key)
        else:
            page.locator(".beside-together .main").tap()
        page.locator("#card .told").wait_for()
        with scanned.site.store.reading() as connection:
            typed = [one.answer for one in typed_texts(connection, scanned.number)]
        assert typed == (["10", "42", "12"] if device == "desk" else ["10"])
        page.get_by_role("button", name="Annuler").locator("visible=true").click()
        page.get_by_text("Annulé").wait_for()
        with scanned.site.store.reading() as connection:
            assert typed_texts(connection, scanned.number) == []


def test_it_works_without_script(browser, desk):
    with served(desk) as address:
        page = context_of(browser, desk, address, TEACHER, "en", "desk", script=False).new_page()
        page.goto(f"{address}/desk/{desk.number}/queue")
        page.get_by_role("button", name="Accept").click()
        assert "Accepted (2)." in page.locator("#card .told").inner_text()
