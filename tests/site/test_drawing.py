"""A drawing is stored with the draft, and stands on no page but as text: on sheets to practise and on
papers."""

import json
import re
from dataclasses import replace
from html import unescape
from urllib.parse import unquote

from site_assignments import ASSIGNMENT, USUAL, dealt
from site_people import MAX, TEACHER, ZOE
from site_practising import Practising
from sqlalchemy import select

from coursework.database.drafts import drafts
from coursework.database.erasing import erase
from coursework.database.personal_data import identifiers_of, personal_data
from coursework.database.publication import AT_ONCE
from coursework.database.submissions import answers_of, drawings_of, submissions_of
from coursework.database.tables import drawing
from coursework.figures.student_drawing import MOST_CHARACTERS
from coursework.issuing.assignment import AskedExercise

DRAWN = replace(ASSIGNMENT, exercises=(AskedExercise("grashof"), AskedExercise("two_circles")))
TEXT = json.dumps({"v": 1, "items": [{"k": "point", "id": 1, "x": 12.5, "y": 30, "n": "p"}], "scale": None})
HOSTILE = '</textarea></script><script>alert(1)</script>{"v": 1, "items": "<b onclick=x>"}'


def shown(page, name):
    """What stands in the text area of a drawing."""
    found = re.search(rf'<textarea hidden name="{name}"[^>]*>(.*?)</textarea>', page, re.DOTALL)
    return unescape(found[1]).strip()


def test_a_drawing_is_stored_and_shown_to_its_author_alone(class_of_three):
    zoe, max_ = (Practising(class_of_three, class_of_three.browser(n), "two_circles") for n in (ZOE, MAX))
    reply = zoe.browser.fill(f"{zoe.address}/draft", {"text.drawing": TEXT, "over.drawing": "0"})
    assert reply.json()["versions"] == {"drawing": 1}
    assert shown(zoe.page(), "a-drawing") == TEXT
    assert shown(max_.page(), "a-drawing") == ""
    page = zoe.send(**{"a-drawing": TEXT.replace("12.5", "13.5")}).text  # a form without a script
    assert shown(page, "a-drawing") == shown(zoe.page(), "a-drawing") == TEXT.replace("12.5", "13.5")


def test_the_solution_of_practice_shows_what_was_drawn_over_the_right_construction(class_of_three):
    zoe = Practising(class_of_three, class_of_three.browser(ZOE), "two_circles")
    points = {"p": "(80; 30)", "a": "(95; 40)", "c": "(120; 30)", "b1": "(90; 70)"}
    zoe.send({"kl": "2", **points}, check="")
    zoe.browser.fill(f"{zoe.address}/solution")
    page = zoe.browser.get(f"{zoe.address}/solution").text
    assert page.count("Your drawing over the right construction") == 2  # to see, and to hear
    fresh = Practising(class_of_three, class_of_three.browser(MAX), "two_circles")
    fresh.browser.fill(f"{fresh.address}/solution")
    page = fresh.browser.get(f"{fresh.address}/solution").text
    assert "Worked solution" in page
    assert "Your drawing" not in page


def test_a_drawing_opens_no_element_and_has_its_size(class_of_three):
    zoe = Practising(class_of_three, class_of_three.browser(ZOE), "joint_graph")
    store = f"{zoe.address}/draft"
    assert zoe.browser.fill(store, {"text.drawing": HOSTILE, "over.drawing": "0"}).status_code == 200
    assert shown(zoe.page(), "a-drawing") == HOSTILE
    assert "<script>alert" not in zoe.page()
    long = {"text.drawing": "x" * (MOST_CHARACTERS + 1), "over.drawing": "1"}
    assert zoe.browser.fill(store, long).status_code == 413
    assert zoe.browser.fill(store, {"text.graph": "x" * 4001, "over.graph": "0"}).status_code == 413
    other = Practising(class_of_three, class_of_three.browser(ZOE), "grashof")
    reply = other.browser.fill(f"{other.address}/draft", {"text.drawing": TEXT, "over.drawing": "0"})
    assert reply.status_code == 400


def test_a_paper_keeps_its_drawings_beside_what_is_handed_in(class_of_three):
    number = dealt(class_of_three, assignment=DRAWN)
    browser, address = class_of_three.browser(ZOE), f"/assignments/{number}"
    page = browser.get(address).text
    assert "drawing_paper.js" in page
    assert re.findall(r'<textarea hidden name="([^"]+)"', page) == ["e2-drawing"]
    texts = {"text.e2-drawing": TEXT, "over.e2-drawing": "0", "text.e2-kl": "1", "over.e2-kl": "0"}
    told = browser.fill(f"{address}/keep", texts).json()
    assert told["versions"] == {"e2-drawing": 1, "e2-kl": 1}
    assert set(told["read"]) == {"e2-kl"}
    assert shown(browser.get(address).text, "e2-drawing") == TEXT
    assert (
        browser.fill(f"{address}/keep", {"text.e9-drawing": TEXT, "over.e9-drawing": "0"}).status_code == 400
    )
    read_back = browser.fill(
        address, {"e2-drawing": HOSTILE, "e2-kl": "2", "_versions": json.dumps({"e2-drawing": 1})}
    )
    assert read_back.status_code == 200
    assert "alert(1)" not in read_back.text
    assert shown(browser.get(address).text, "e2-drawing") == HOSTILE
    browser.fill(f"{address}/hand-in", {"_number": "1", "e2-kl": "2"})
    with class_of_three.site.store.reading() as connection:
        (submission,) = submissions_of(connection, number, class_of_three.ids[ZOE])
        answers = answers_of(connection, submission.id)
        kept = drafts(connection, class_of_three.ids[ZOE], f"assignment/{number}")
    assert not any("drawing" in part or "alert" in text for *_, part, text in answers)
    assert kept["e2-drawing"].text == HOSTILE


POLYGON = json.dumps(
    {
        "v": 1,
        "items": [
            {"k": "point", "id": 1, "x": 12.5, "y": 30, "n": "O2"},
            {"k": "point", "id": 2, "x": 60, "y": 41},
            {"k": "circle", "id": 3, "x": 60, "y": 41, "r": 20},
            {"k": "vector", "id": 4, "from": 1, "to": 2},
        ],
        "scale": None,
    }
)


def handed_in(site, text):
    """An open question and two circles, handed in by Zoé with a drawing; the number of the assignment."""
    number = dealt(site, publication=replace(USUAL, feedback=AT_ONCE), assignment=DRAWN)
    browser = site.browser(ZOE)
    browser.get(f"/assignments/{number}")
    browser.fill(f"/assignments/{number}/keep", {"text.e2-drawing": text, "over.e2-drawing": "0"})
    browser.fill(f"/assignments/{number}/hand-in", {"_number": "1", "e2-kl": "what is this"})
    return number


def drawn_curves(page):
    """The outlines of the drawings on a page, without its other figures."""
    return re.findall(r"<details[^>]*><summary>[^<]*(?:drawing|Your drawing).*?</details>", page, re.DOTALL)


def test_staff_and_author_see_what_was_drawn_when_it_was_handed_in(class_of_three):
    number = handed_in(class_of_three, POLYGON)
    zoe, ada = class_of_three.browser(ZOE), class_of_three.browser(TEACHER)
    # What is drawn afterwards is of a later attempt.
    later = POLYGON.replace('"r": 20', '"r": 44')
    zoe.fill(f"/assignments/{number}/keep", {"text.e2-drawing": later, "over.e2-drawing": "1"})
    with class_of_three.site.store.reading() as connection:
        assert drawings_of(connection, number, ZOE) == {(1, "two_circles"): POLYGON}
        assert drawings_of(connection, number, MAX) == {}
    pages = {
        "queue": ada.get(f"/desk/{number}/queue?why=unreadable"),
        "student": ada.get(f"/desk/{number}/student?name={ZOE}"),
        "feedback": zoe.get(f"/assignments/{number}/feedback"),
    }
    pictures = {}
    for name, reply in pages.items():
        (found,) = drawn_curves(reply.text)
        (picture,) = re.findall(r'data:image/svg\+xml,([^"]+)"', found)
        pictures[name] = unquote(picture)
    assert len(set(pictures.values())) == 1
    assert pictures["queue"].count("<circle") >= 1
    assert drawn_curves(class_of_three.browser(MAX).get(f"/assignments/{number}").text) == []


def test_a_drawing_that_is_none_is_shown_to_nobody_and_costs_no_answer(class_of_three):
    number = handed_in(class_of_three, HOSTILE)
    with class_of_three.site.store.reading() as connection:
        assert drawings_of(connection, number, ZOE) == {}
        assert len(submissions_of(connection, number, class_of_three.ids[ZOE])) == 1
    assert "alert(1)" not in class_of_three.browser(TEACHER).get(f"/desk/{number}/student?name={ZOE}").text


def test_a_drawing_is_among_the_data_of_a_person_and_goes_with_them(class_of_three):
    handed_in(class_of_three, POLYGON)
    store, zoe = class_of_three.site.store, class_of_three.ids[ZOE]
    with store.begin() as connection:
        (row,) = personal_data(connection, identifiers_of(connection, zoe))["drawing"]
        assert row["text"] == POLYGON
        assert erase(connection, zoe)["drawing"] == 1
        assert connection.execute(select(drawing)).all() == []


def test_the_longest_page_to_draw_on_weighs_120_kb_with_all_its_files_and_20_the_next_time(class_of_three):
    browser = class_of_three.browser(ZOE, "fr")

    def fetched(address):
        reply = browser.get(address, headers={"accept-encoding": "gzip"})
        head = sum(len(name) + len(value) + 4 for name, value in reply.headers.items())
        return reply.text, head + int(reply.headers["content-length"])

    page, weight = fetched(browser.get("/practice/crank_shaper_drawn").headers["location"])
    files = {file: fetched(file) for file in re.findall(r'"(/static/[^"]+)"', page)}
    look = next(text for file, (text, _) in files.items() if "look.css" in file)
    fonts = [fetched(file)[1] for file in re.findall(r'url\("(/static/[^"]+)"', look)]
    assert (len(files), len(fonts)) == (5, 4)
    assert weight <= 20_000
    assert weight + sum(size for _, size in files.values()) + sum(fonts) <= 120_000
