"""The page of the queue, opened from the disk: what is typed there is what the job reads, and what it says
itself."""

from __future__ import annotations

import csv
import io

import pytest
from scanned_class import ScannedClass, answered, queued, rows, save
from site_browser import chromium

from coursework.scanning import queue
from coursework.scanning.scan import scan

pytestmark = pytest.mark.e2e

NAMES = ("Zoé Öztürk", "Max <b>", "=cmd()|x")


@pytest.fixture(scope="module")
def scanned(tmp_path_factory):
    return ScannedClass(tmp_path_factory.mktemp("class"), NAMES, "slotted_mechanism")


@pytest.fixture
def read(pages_are_told, scanned, tmp_path):
    answers = {"rA": "~319.8 mm", "theta4": "~", "guide": "a"}
    for name in NAMES:
        save(tmp_path / "scans" / f"{NAMES.index(name)}.png", scanned.told(name, 1, answers))
    scan(scanned.course, [tmp_path / "scans"], scanned.issued, tmp_path / "read")
    return tmp_path / "read"


@pytest.fixture(scope="module")
def browser():
    with chromium() as one:
        yield one


@pytest.fixture
def opened(browser, read):
    """The page, which tells no fault; it asks nothing of any server."""
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    faults = []
    page.on("pageerror", lambda fault: faults.append(str(fault)))
    page.on("console", lambda said: faults.append(said.text) if said.type == "error" else None)
    page.on(
        "request",
        lambda asked: (
            faults.append(asked.url) if not asked.url.startswith(("file:", "data:", "blob:")) else None
        ),
    )
    page.goto((read / "queue" / "index.html").as_uri())
    yield page
    page.close()
    assert not faults


def saved(page, button, path):
    with page.expect_download() as got:
        page.locator(button).click()
    got.value.save_as(path)
    return path


def cells(path):
    return list(csv.reader(io.StringIO(path.read_text("utf-8-sig"), newline="")))


def test_what_was_read_counts_for_nothing_before_it_is_confirmed(opened, read, tmp_path):
    assert opened.locator(".card input").first.input_value() == "319.8 mm"
    assert len(cells(saved(opened, "#save-typed", tmp_path / "typed.csv"))) == 1
    mine = cells(saved(opened, "#save-answers", tmp_path / "a.csv"))[1:]
    assert sorted(mine) == sorted(line[:5] for line in cells(read / "answers.csv")[1:])


def test_enter_confirms_and_goes_on_and_the_job_reads_what_was_saved(opened, scanned, read, tmp_path):
    cards = queued(read)
    opened.locator(".card input").first.focus()
    for k, _ in enumerate(cards):
        if k == 1:
            opened.keyboard.type("=1+(2|3)")
        opened.keyboard.press("Enter" if cards[k]["candidate"] or k == 1 else "Alt+KeyN")
    assert opened.locator(".card.is-done").count() == len(cards)
    saved(opened, "#save-typed", tmp_path / "typed.csv")
    mine = {tuple(line) for line in cells(saved(opened, "#save-answers", tmp_path / "a.csv"))[1:]}
    book = scan(scanned.course, [], scanned.issued, read, typed=[tmp_path / "typed.csv"])
    assert book.waiting == 0
    assert mine == {tuple(line[:5]) for line in cells(read / "answers.csv")[1:]}
    assert answered(read, cards[1]["student"])["rA"] == "=1+(2|3)"
    assert not [c for line in cells(tmp_path / "typed.csv") for c in line if c.startswith("=") and "(" in c]


def test_enter_alone_does_not_say_that_nothing_is_written(opened, read):
    cards = queued(read)
    place = next(k for k, card in enumerate(cards) if not card["candidate"])
    box = opened.locator(".card input").nth(place)
    box.press("Enter")
    card = opened.locator(".card").nth(place)
    assert "Alt+N" in card.inner_text()
    assert opened.locator(".card.is-done").count() == 0
    box.fill("7")
    box.fill("")  # somebody emptied it, and means it
    box.press("Enter")
    assert opened.locator(".card.is-done").count() == 1


def test_keys_go_back_take_back_and_say_that_nothing_is_written(opened, read, tmp_path):
    opened.locator(".card input").first.focus()
    opened.keyboard.press("Alt+KeyN")
    opened.keyboard.press("Shift+Enter")
    assert opened.locator(".card.is-done").count() == 1
    (line,) = cells(saved(opened, "#save-typed", tmp_path / "t.csv"))[1:]
    assert line[5] == ""
    opened.locator(".card input").first.focus()
    opened.keyboard.press("Escape")
    assert opened.locator(".card.is-done").count() == 0


def test_what_was_typed_is_there_when_the_page_is_opened_again(opened):
    box = opened.locator(".card input").first
    box.fill("41 mm")
    box.press("Enter")
    opened.locator(".card.is-done").wait_for()
    opened.reload()
    assert opened.locator(".card input").first.input_value() == "41 mm"
    assert opened.locator(".card.is-done").count() == 1


def test_it_speaks_both_languages_and_names_stay_text(opened):
    assert opened.locator("html").get_attribute("lang") == "en"
    opened.locator("[data-lang=fr]").click()
    assert "lu 319,8 mm" in opened.locator(".card").first.inner_text()
    assert "coulisse" in opened.locator("#cards h2").first.inner_text()
    assert opened.locator("h3", has_text="Max <b>").count() > 0
    assert opened.locator("#cards b").count() == 0


@pytest.mark.parametrize("width", [390, 1280])
def test_it_fits_a_telephone_and_a_desk(opened, width):
    opened.set_viewport_size({"width": width, "height": 800})
    assert opened.evaluate("document.documentElement.scrollWidth") <= width
    small = opened.evaluate(
        "[...document.querySelectorAll('.bar button, .card button, .card input')].filter((e) => "
        "e.getBoundingClientRect().height < 40).length"
    )
    assert small == 0


def test_pictures_lie_beside_the_page_where_they_are_too_many_for_it(read, scanned, browser, monkeypatch):
    monkeypatch.setattr(queue, "_EMBEDDED", 10)
    scan(scanned.course, [], scanned.issued, read)
    page = browser.new_page()
    page.goto((read / "queue" / "index.html").as_uri())
    image = page.locator(".crops img").first
    image.scroll_into_view_if_needed()
    page.wait_for_function("document.querySelector('.crops img').naturalWidth > 0")
    assert image.get_attribute("src").startswith("../crops/")
    page.close()
    assert rows(read / "answers.csv")


@pytest.mark.parametrize("width", [390, 1280])
def test_numbers_that_are_probably_read_right_are_confirmed_by_one_tap(
    pages_are_told, browser, scanned, tmp_path, width
):
    for k, name in enumerate(NAMES):
        answers = {"rA": "~" if k == 0 else f"≈12{k} mm", "theta4": f"≈{k}", "omega4": f"≈7.{k}"}
        save(tmp_path / "scans" / f"{k}.png", scanned.told(name, 1, answers))
    scan(scanned.course, [tmp_path / "scans"], scanned.issued, tmp_path / "read")
    page = browser.new_page(viewport={"width": width, "height": 900})
    page.goto((tmp_path / "read" / "queue" / "index.html").as_uri())
    assert page.locator(".likely .card").count() == 8
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    first = page.locator(".likely").first
    first.locator("input").first.fill("99 mm")
    first.locator("> .buttons button").click()
    assert (page.locator(".is-done").count(), first.locator(".is-done").count()) == (1, 1)
    page.locator(".likely > .buttons button").evaluate_all("all => all.forEach((one) => one.click())")
    assert page.locator(".is-done").count() == 7
    typed = cells(saved(page, "#save-typed", tmp_path / "typed.csv"))[1:]
    assert sorted(line[5] for line in typed)[-3:] == ["7.0", "7.1", "7.2"]
    assert "99 mm" not in {line[5] for line in typed}
    page.close()
