"""What people do on the site from beginning to end, in Chromium: a student practises, hands in and comes
back; an instructor publishes, looks on, brings in and takes away; names as people have them; a keyboard
alone."""

import csv
import re
from dataclasses import replace
from datetime import timedelta

import pytest
from site_assignments import ASSIGNMENT, USUAL, code_of, dealt, handed_in, right
from site_browser import chromium, context_of, low, serious, served, too_wide, watched
from site_people import MAX, TEACHER, ZOE, Class
from site_practising import right_answer

from coursework.database.people import put_account, put_person
from coursework.database.submissions import submissions_of
from coursework.issuing.students import folded
from coursework.site.people import accounts

pytestmark = pytest.mark.e2e

HARD = ("Zoé D’Arc-O'Neil", "محمد العلي", "🦊 Renard <b>", "Nguyễn Thị Mai-Anh de la Très Longue Ascendance")
SAVED = "#state >> text=/^(Saved|Enregistré)\\.$/"
KEPT = "[data-kept] >> text=/is kept|est gardé/"

in_both = pytest.mark.parametrize(
    ("lang", "size"), [("fr", "telephone"), pytest.param("en", "desk", marks=pytest.mark.slow)]
)


@pytest.fixture(scope="module")
def room(tmp_path_factory):
    """A class behind a server, and a browser."""
    class_ = Class(f"sqlite:///{tmp_path_factory.mktemp('flows')}/site.db")
    with chromium() as browser, served(class_) as address:
        yield class_, address, browser


@pytest.fixture
def window(room):
    """Makes a window of somebody at an address; nothing may go wrong behind it while it has a line."""
    class_, address, browser = room
    opened = []

    def open_(name, place, lang="en", size="telephone", has_line=True):
        context = context_of(browser, class_, address, name, lang, size)
        page = context.new_page()
        opened.append((context, watched(page) if has_line else []))
        page.goto(address + place)
        return page

    yield open_
    for context, _ in opened:
        context.close()
    assert [fault for _, faults in opened for fault in faults] == []


@pytest.fixture
def handed_out(room, request):
    """Deals an assignment of the test's own, open for a day; gives its number."""

    def deal(names=(ZOE, MAX), **more):
        at = room[0].at
        dates = replace(USUAL, opens=at - timedelta(hours=1), closes=at + timedelta(days=1))
        own = replace(ASSIGNMENT, name=request.node.name)
        return dealt(room[0], replace(dates, **more), names, own)

    return deal


def fine(page):
    assert (too_wide(page), serious(page)) == (0, [])


# ---------------------------------------------------------------------- students


@in_both
def test_an_exercise_is_practised_to_its_end(room, window, lang, size):
    page = window({"fr": ZOE, "en": MAX}[lang], "/practice/grashof", lang, size)
    variant = room[0].site.variant("grashof", int(page.url.rpartition("/")[2]), lang)
    boxes = [part for part in variant.parts if part.sort.is_number and not part.choices]
    first = boxes[0]
    page.fill(f"#answer-a-{first.id}", right_answer(variant, first))
    page.wait_for_selector(f"#read-a-{first.id} >> text=/read as|lu/")
    page.locator(f"#below-a-{first.id} button[name=check]").click()
    page.wait_for_selector(f"#told-a-{first.id} .right")
    page.locator(f"#below-a-{first.id} button[name=hint]").click()
    page.wait_for_selector(f"#hints-a-{first.id} .hinted")
    for part in variant.parts:
        answer = right_answer(variant, part)
        if part.choices:
            for letter in answer.split(", "):
                page.check(f"input[name='a-{part.id}'][value='{letter}']")
        elif not part.sort.is_open:
            page.fill(f"#answer-a-{part.id}", answer)
    page.locator(".practice-bar button[name=check]").click()
    page.wait_for_selector("#summary >> text=/Everything is right|Tout est juste/")
    fine(page)
    sheet = page.url.split("#")[0]
    page.locator("button[name=go][value=fresh]").click()
    page.wait_for_url(lambda url: url.split("#")[0] != sheet and "/practice/grashof/" in url)
    page.locator("button[name=go][value=solution]").click()
    page.wait_for_url("**/solution")
    page.locator("main form button.main").click()
    page.wait_for_load_state()
    fine(page)
    page.goto(f"{room[1]}/progress")
    asked = sum(not part.sort.is_open for part in variant.parts)
    assert f"{asked} " in page.locator("li", has=page.locator("a[href='/practice/grashof']")).inner_text()


@in_both
def test_a_paper_waits_as_it_was_left_and_gives_a_receipt_and_feedback(room, window, handed_out, lang, size):
    number = handed_out(feedback="at_once")
    page = window(ZOE, f"/assignments/{number}", lang, size)
    page.fill("[name=e1-rA]", "319,8 mm")
    page.wait_for_selector(KEPT)
    context = page.context
    page.close()
    page = context.new_page()
    page.goto(f"{room[1]}/assignments/{number}")
    assert page.input_value("[name=e1-rA]") == "319,8 mm"
    for _ in range(2):  # read back, then confirmed
        with page.expect_navigation():
            page.click(".bar .main")
        fine(page)
    assert re.fullmatch("[A-Z2-7-]{10,}", page.locator(".receipt .code").inner_text())
    with page.expect_navigation():
        page.click(".acts a.main")
    fine(page)
    assert "319,8 mm" in page.locator("main").inner_text()


def test_an_hour_without_a_line_loses_nothing(room, window):
    page = window(ZOE, "/practice/two_circles", has_line=False)
    box = page.locator("input[type=text][name]:visible").first
    page.context.set_offline(True)
    box.fill("1.5 mm")
    page.wait_for_selector("#state >> text=No connection")
    room[0].at += timedelta(hours=1)
    box.fill("12.5 mm")
    page.context.set_offline(False)
    page.wait_for_selector(SAVED)
    page.reload()
    assert page.locator("input[type=text][name]:visible").first.input_value() == "12.5 mm"


# ------------------------------------------------------------------- coming in


@in_both
def test_one_comes_in_by_an_invitation_and_goes(room, window, lang, size):
    class_, address, _ = room
    with class_.site.store.begin() as connection:
        link = accounts.invited(class_.site, connection, class_.ids[MAX], "max@example.org", "student")
    page = window(None, f"/invitation/{link.rpartition('/')[2]}", lang, size)
    fine(page)
    page.fill("[name=password]", "three grey gears")
    page.fill("[name=again]", "three grey gears")
    with page.expect_navigation():
        page.click("main button.main")
    assert page.url == f"{address}/practice"
    page.click(".me summary")
    with page.expect_navigation():
        page.click("form[action='/sign-out'] button")
    assert "/sign-in" in page.url
    fine(page)
    page.fill("[name=login]", "max@example.org")
    page.fill("[name=password]", "three grey gears")
    with page.expect_navigation():
        page.keyboard.press("Enter")
    assert page.url == f"{address}/practice"


# ------------------------------------------------------------------ instructors


def test_an_assignment_is_handed_out_published_and_seen_as_a_student_sees_it(room, window):
    _, address, _ = room
    page = window(TEACHER, "/desk/assignments/new", "fr", "desk")
    page.fill("[name=title]", "Contrôle d’été")
    page.fill("[name=name]", "summer")
    page.locator("details", has=page.locator("[value=grashof]")).locator("summary").click()
    page.check("[name=exercise][value=grashof]")
    page.check("[name=accounts]")
    page.click("main form button.main >> nth=0")
    page.wait_for_url(re.compile(r"/desk/assignments/\d+$"), timeout=60_000)
    fine(page)
    page.fill("form[action$='/publish'] [name=closes]", "2030-06-01T18:00")
    with page.expect_navigation():
        page.click("form[action$='/publish'] button.main")
    number = page.url.split("?")[0].rpartition("/")[2]
    page.goto(f"{address}/desk/assignments/{number}/preview")
    assert "Contrôle d’été" in page.locator("h1").inner_text()
    student = window(ZOE, "/assignments", "fr")
    assert "Contrôle d’été" in student.locator("main").inner_text()
    student.goto(f"{address}/assignments/{number}")
    fine(student)


def test_the_class_fills_while_one_looks_at_it(room, window, handed_out):
    class_, _, _ = room
    number = handed_out()
    page = window(TEACHER, f"/desk/{number}", "en", "desk")
    row = page.locator("#marks tbody tr", has_text=ZOE)
    assert "✓" not in row.inner_text()
    handed_in(class_.browser(ZOE), number, right(class_, ZOE))
    page.locator("#marks tbody tr", has_text="✓").wait_for(timeout=15_000)
    assert "✓" in row.inner_text()
    assert page.locator("#news").inner_text().startswith("1 of 2")
    fine(page)


def test_answers_are_brought_in_and_marks_taken_away(room, window, handed_out, tmp_path):
    class_, address, _ = room
    number = handed_out()
    seed = class_.issued.seeds[MAX, "slotted_mechanism"]
    answers = tmp_path / "answers.csv"
    answers.write_text(
        "student,exercise,seed,part,answer\n"
        f"{MAX},slotted_mechanism,{seed},rA,{right(class_, MAX)['e1-rA']}\n"
    )
    page = window(TEACHER, f"/desk/{number}/files", "fr", "desk")
    page.set_input_files("input[name=answers]", str(answers))
    with page.expect_navigation():
        page.click("form[action$='/answers'] button")
    assert re.match(r"Réponses reçues\s:\s1\.", page.locator("main .told").first.inner_text())
    fine(page)
    with page.expect_download() as taken:
        page.click("a[href$='/files/summary.csv'], a[href*='/files/summary.csv?']")
    text = taken.value.path().read_text(encoding="utf-8-sig")
    rows = list(csv.reader(text.splitlines(), delimiter=";" if ";" in text.splitlines()[0] else ","))
    assert any(MAX in row for row in rows)
    page.goto(f"{address}/desk/{number}/regrade")
    assert "Rien ne changerait" in page.locator("main").inner_text()


# ------------------------------------------------------------------------- names


@pytest.mark.slow
def test_names_as_people_have_them_stand_on_every_page(room, window, handed_out):
    class_, address, _ = room
    with class_.site.store.begin() as connection:
        for k, name in enumerate(HARD):
            class_.ids[name] = put_person(connection, identifier=folded(name), name=name, lang="", columns={})
            put_account(connection, class_.ids[name], login=f"hard{k}@example.org", role="student")
    number = handed_out(HARD, feedback="at_once")
    codes = {}
    for name in HARD:
        codes[name] = code_of(handed_in(class_.browser(name), number, {"e1-rA": "1"}))
    desk = window(TEACHER, f"/desk/{number}", "fr")
    shown = desk.locator("#marks").inner_text()
    for name in HARD:
        assert name in shown
    fine(desk)
    links = [one.get_attribute("href") for one in desk.locator("#marks tbody th a").all()]
    for name, link in zip(HARD, links, strict=True):
        desk.goto(address + link)
        assert desk.locator("h2").first.inner_text() == name
        fine(desk)
    for name in HARD:
        own = window(name, f"/assignments/{number}/receipts/{codes[name]}", "fr")
        fine(own)
        assert low(own) == []
        own.goto(f"{address}/assignments/{number}/feedback")
        fine(own)
        assert (
            own.locator("b", has_text=name.replace("'", "’")).count()
            or name.replace("'", "’") in own.locator("main").inner_text()
        )
        with own.expect_download() as taken:
            own.evaluate(f"location.href = '/assignments/{number}/paper.pdf'")
        assert taken.value.path().read_bytes()[:4] == b"%PDF"
        own.context.close()


# ---------------------------------------------------------------- keyboard alone

_SEEN = """() => {
  const one = document.activeElement, style = getComputedStyle(one);
  return one === document.body || one.matches(":focus-visible")
    && (style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 1);
}"""


def tabbed(page, selector, most=120):
    """Go on by the key Tab until something has the focus; wherever it stands on the way, that is seen."""
    for _ in range(most):
        page.keyboard.press("Tab")
        assert page.evaluate(_SEEN), page.evaluate("document.activeElement.outerHTML.slice(0, 120)")
        if page.evaluate("s => document.activeElement.matches(s)", selector):
            return
    raise AssertionError(f"no way by the key Tab to {selector}")


def test_a_keyboard_alone_practises(room, window):
    page = window(ZOE, "/practice", size="desk")
    tabbed(page, ".skip")
    page.keyboard.press("Enter")
    tabbed(page, "#chapter-2 summary")
    page.keyboard.press("Enter")
    tabbed(page, "a[href='/practice/coriolis']")
    with page.expect_navigation():
        page.keyboard.press("Enter")
    variant = room[0].site.variant("coriolis", int(page.url.rpartition("/")[2]), "en")
    assert page.evaluate(
        "document.querySelectorAll('[tabindex]').length === "
        'document.querySelectorAll(\'[tabindex="0"], [tabindex="-1"]\').length'
    )
    for part in variant.parts:
        answer = right_answer(variant, part)
        if part.choices:
            tabbed(page, f"input[name='a-{part.id}']")
            letters = [one.get_attribute("value") for one in page.locator(f"input[name='a-{part.id}']").all()]
            for _ in range(letters.index(answer)):
                page.keyboard.press("ArrowDown")
            page.keyboard.press("Space")
            continue
        tabbed(page, f"#answer-a-{part.id}")
        page.keyboard.type(answer)
        page.keyboard.press("Enter")
        page.wait_for_selector(f"#told-a-{part.id} .right")
        assert page.evaluate("document.activeElement.id") == f"told-a-{part.id}"
    tabbed(page, ".practice-bar button[name=check]")
    page.keyboard.press("Enter")
    page.wait_for_selector("#summary >> text=Everything is right.")
    assert page.evaluate("document.activeElement.id") == "summary"


def test_a_keyboard_alone_hands_in(room, window, handed_out):
    class_, _, _ = room
    number = handed_out()
    page = window(ZOE, f"/assignments/{number}", size="desk")
    tabbed(page, "[name=e1-rA]")
    page.keyboard.type("12 mm")
    tabbed(page, "[name=e2-linkage_type]")
    page.keyboard.press("Space")
    for button in (".bar .main", ".bar .main"):
        tabbed(page, button)
        with page.expect_navigation():
            page.keyboard.press("Enter")
    assert page.locator(".receipt .code").count() == 1
    with class_.site.store.reading() as connection:
        assert len(submissions_of(connection, number, class_.ids[ZOE])) == 1
