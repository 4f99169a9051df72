"""Scans on the desk: sent, read, typed card by card, marked; their pictures are the staff's alone."""

from __future__ import annotations

import html
import io
import re
import zipfile

import pytest
from desk_class import EXERCISE, OTHER, STUDENTS, DeskClass, field, told
from desk_scans import as_png, picture, send, told_by_pictures
from site_people import TEACHER, ZOE
from sqlalchemy import select

from coursework.database.assignments import issued_content, put_issued
from coursework.database.erasing import erase
from coursework.database.scans import pages_scanned, typed_texts
from coursework.database.tables import person
from coursework.site.desk import scan_jobs
from coursework.site.desk.class_cache import class_now


@pytest.fixture
def desk(tmp_path, monkeypatch):
    """A class that wrote on paper; pictures tell what is on them."""
    told_by_pictures(monkeypatch)
    return DeskClass(f"sqlite:///{tmp_path}/site.db", {})


def fill(desk, end, who=TEACHER, **texts):
    return desk.browser(who).fill(f"/desk/{desk.number}/scans{end}", texts)


def ids(desk):
    with desk.site.store.reading() as connection:
        return [one.page for one in pages_scanned(connection, desk.number)]


def marks(desk, student):
    now = class_now(desk.site, desk.number)
    return {
        part: (mark.answer, mark.points)
        for one in now.graded.values()
        if one.student == student
        for part, mark in one.lines.items()
    }


def test_what_is_sent_is_read_typed_and_marked(desk):
    right = desk.at_margin("rA", 0)
    reply = send(desk, ("ada.png", picture(desk, "Ada", rA=right, theta4="~104.6")))
    assert "Read. New pages: 1." in reply.text
    assert "could not be read with certainty: 1" in reply.text
    card = desk.page(TEACHER, "/scans/queue")
    assert 'value="104.6"' in card.text
    assert "Enter confirms" in card.text
    assert not marks(desk, "Ada"), "nothing is marked before it is handed over"
    done = fill(
        desk, "/queue", card=field(card, "card"), do="confirm", answer=desk.at_margin("theta4", 0) + "°"
    )
    assert "sent to be marked" in told(done)
    found = marks(desk, "Ada")
    assert found["rA"] == (right, 1)
    assert found["theta4"][1] == 1


def test_what_nobody_has_typed_yet_is_no_missing_answer_and_after_the_exam_says_so(desk):
    """Marked early, or taken back later, it waits for a person and its mark is provisional."""

    def state():
        now = class_now(desk.site, desk.number)
        [theta4] = [one.lines["theta4"] for one in now.graded.values() if one.student == "Ada"]
        return theta4.verdict, now.results["Ada"].open, "typed: 1" in desk.page(TEACHER, "/after").text

    send(desk, ("ada.png", picture(desk, "Ada", rA=desk.at_margin("rA", 0), theta4="~104.6")))
    after = desk.page(TEACHER, "/after").text
    assert "to be typed: 1" in after
    assert "not everything read on scans is marked yet" in after.lower()
    fill(desk, "", do="hand over")
    assert state() == ("to_mark", 1, True)
    assert "is marked yet" not in desk.page(TEACHER, "/after").text
    card = desk.page(TEACHER, "/scans/queue")
    fill(desk, "/queue", card=field(card, "card"), do="confirm", answer=desk.at_margin("theta4", 0) + "°")
    assert state() == ("correct", 0, False)
    fill(desk, "/queue", do="undo")
    assert state() == ("to_mark", 1, True)
    assert "is marked yet" not in desk.page(TEACHER, "/after").text


def test_an_answer_that_is_typed_anew_takes_the_place_of_the_one_before(desk):
    send(desk, ("a.png", picture(desk, "Ada", rA="1")))
    assert "sent to be marked" in told(fill(desk, "", do="hand over"))
    assert marks(desk, "Ada")["rA"] == ("1", 0)
    send(desk, ("b.png", picture(desk, "Ada", rA=desk.at_margin("rA", 0))))
    card = desk.page(TEACHER, "/scans/queue")
    assert "Two scans of this page differ" in card.text
    fill(desk, "/queue", card=field(card, "card"), do="confirm", answer=desk.at_margin("rA", 0))
    assert marks(desk, "Ada")["rA"] == (desk.at_margin("rA", 0), 1)


def test_the_same_file_once_more_changes_nothing(desk):
    file = ("a.png", picture(desk, "Ada", rA="12"))
    send(desk, file)
    assert "New pages: 0" in send(desk, file).text
    assert len(ids(desk)) == 1


def test_files_that_cannot_be_read_are_told_and_cost_no_other(desk):
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as archive:
        archive.writestr("bo.png", picture(desk, "Bo", rA="12"))
    name = "<img src=x onerror=alert(1)>.pdf"
    reply = send(desk, (name, b"%PDF-1.4 nothing"), ("class.zip", made.getvalue()))
    assert "Rejected (1)" in reply.text
    assert "<img src=x" not in reply.text
    assert "onerror=alert(1)" in html.unescape(reply.text)
    assert "class.zip/bo.png" in {p.file for p in pages(desk)}


def pages(desk):
    with desk.site.store.reading() as connection:
        return pages_scanned(connection, desk.number)


def test_a_page_without_a_code_is_told_whose_it_is(desk):
    send(desk, ("coffee.png", as_png(b"\xff" * 2000 + b"coffee" * 30)))
    card = desk.page(TEACHER, "/scans/queue")
    code = re.search(r'<option value="(\w+)">Cy', card.text)[1]
    assert (
        "Choose the paper"
        in fill(desk, "/queue", card=field(card, "card"), do="confirm", paper="", number="1").text
    )
    fill(desk, "/queue", card=field(card, "card"), do="confirm", paper=code, number="1")
    later = desk.page(TEACHER, "/scans/queue")
    assert "Cy" in re.search(r'class="tags">(.*?)</p>', later.text, re.DOTALL)[1]
    assert [one.student for one in pages(desk)] == ["Cy"], "what is kept of Cy holds it, and goes with Cy"


def test_marks_go_when_it_is_taken_back_whose_page_it_is(desk):
    send(desk, ("coffee.png", as_png(b"\xff" * 2000 + b"coffee" * 30)))
    card = desk.page(TEACHER, "/scans/queue")
    code = re.search(r'<option value="(\w+)">Cy', card.text)[1]
    fill(desk, "/queue", card=field(card, "card"), do="confirm", paper=code, number="1")
    while "Nothing waits" not in desk.page(TEACHER, "/scans").text:
        card = desk.page(TEACHER, "/scans/queue")
        fill(desk, "/queue", card=field(card, "card"), do="confirm", answer="1")
    assert marks(desk, "Cy")["rA"][0] == "1"
    while "nothing to undo" not in told(fill(desk, "/queue", do="undo")):
        pass
    assert not marks(desk, "Cy")
    assert "whose page" in desk.page(TEACHER, "/scans/queue").text.lower()


def test_two_who_look_at_one_card_decide_once(desk):
    send(desk, ("a.png", picture(desk, "Ada", rA="~12", theta4="~1")))
    card = field(desk.page(TEACHER, "/scans/queue"), "card")
    fill(desk, "/queue", card=card, do="confirm", answer="12")
    assert "already dealt with" in told(fill(desk, "/queue", OTHER, card=card, do="confirm", answer="13"))


def values(page, name):
    return re.findall(rf'name="{name}"[^>]* value="([^"]*)"', page.text.partition("beside-together")[0])


def typed(desk):
    with desk.site.store.reading() as connection:
        return {(one.student, one.part): one.answer for one in typed_texts(connection, desk.number)}


def test_the_cards_of_a_question_are_confirmed_at_once_and_what_was_typed_last_is_undone(desk):
    """Each is a text of its own; an empty box, and a card that another person has typed meanwhile, are left
    alone."""
    students = ("Ada", "Bo", "Cy", "Di")
    send(
        desk,
        *((f"{name}.png", picture(desk, name, rA=f"~1{k}", theta4="~9")) for k, name in enumerate(students)),
    )
    page = desk.page(TEACHER, "/scans/queue")
    cards, answers = values(page, "card"), values(page, "answer")
    assert answers == ["10", "11", "12", "13"], "the cards of one question, and of no other"
    fill(desk, "/queue", OTHER, card=cards[3], do="confirm", answer="5")
    answers[1:3] = ["", "7.5"]
    done = fill(desk, "/queue", card=cards, answer=answers, do="confirm all")
    assert "Kept: 2 answers." in told(done)
    assert "already dealt with" in told(done)
    assert typed(desk) == {("Ada", "rA"): "10", ("Cy", "rA"): "7.5", ("Di", "rA"): "5"}
    undone = fill(desk, "/queue", do="undo")
    assert "Undone (2)" in told(undone)
    assert typed(desk) == {("Di", "rA"): "5"}
    assert values(undone, "card") == cards[:3]
    assert "nothing to undo" in told(fill(desk, "/queue", do="undo"))
    fill(desk, "/queue", OTHER, do="undo")
    assert typed(desk) == {}


@pytest.mark.parametrize("end", ["picture?page={}", "crop?page={}&field=0"])
def test_pictures_are_served_to_the_staff_of_this_assignment_alone(desk, end):
    send(desk, ("a.png", picture(desk, "Ada", rA="~12")))
    address = f"/desk/{desk.number}/scans/" + end.format(ids(desk)[0])
    reply = desk.browser(TEACHER).get(address)
    assert reply.headers["content-type"] in ("image/jpeg", "image/png")
    assert reply.headers["cache-control"] == "no-store"
    assert desk.browser(ZOE).get(address).status_code == 403
    assert desk.browser(None).get(address).status_code == 303
    for other in ("0" * 16 + "-0001", "../../etc/passwd", ids(desk)[0] + "0"):
        assert desk.browser(TEACHER).get(f"/desk/{desk.number}/scans/" + end.format(other)).status_code == 404
    assert (
        desk.browser(TEACHER).get(address.replace(f"/desk/{desk.number}/", "/desk/999/")).status_code == 404
    )


def test_who_is_erased_is_gone_from_the_scans(desk):
    send(desk, ("a.png", picture(desk, "Ada", rA="~12")), ("b.png", picture(desk, "Bo", rA="~12")))
    card = desk.page(TEACHER, "/scans/queue")
    fill(desk, "/queue", card=field(card, "card"), do="confirm", answer="12")
    with desk.site.store.begin() as connection:
        ada = connection.execute(select(person.c.id).where(person.c.name == "Ada")).scalar_one()
        gone = erase(connection, ada)
    assert (gone["scanned"], gone["typed"]) == (1, 1)
    assert [one.student for one in pages(desk)] == ["Bo"]


def test_what_fails_is_told(desk, monkeypatch):
    def broken(*told):
        raise MemoryError

    monkeypatch.setattr(scan_jobs, "read_files", broken)
    assert "Nothing was lost" in send(desk, ("a.png", picture(desk, "Ada", rA="1"))).text


def test_an_answer_that_is_a_picture_is_shown_on_the_desk(desk):
    send(desk, ("a.png", picture(desk, "Ada", rA="12")))
    desk.hand_in({"Ada": {"theta4": f"scan {ids(desk)[0]}/0"}})
    page = desk.page(TEACHER, "/queue", exercise=EXERCISE, part="theta4")
    address = html.unescape(re.search(r'<img src="(/desk/[^"]*crop[^"]*)"', page.text)[1])
    assert desk.browser(TEACHER).get(address).headers["content-type"] == "image/png"


def test_scans_of_an_anonymous_exam_are_told_by_codes(desk):
    """Before anything is marked too: who types an answer does not know whose it is."""
    codes = {name: f"KKK-{k}{k}{k}" for k, name in enumerate(STUDENTS, 2)}
    with desk.site.store.begin() as connection:
        content = issued_content(connection, desk.number)
        stated = {**content["assignment"], "anonymous": True}
        put_issued(connection, {**content, "assignment": stated, "codes": codes})
    send(desk, ("scan.png", picture(desk, "Ada", theta4="~104.6")))
    for page in (desk.page(TEACHER, "/scans"), desk.page(TEACHER, "/scans/queue")):
        text = page.text.replace(TEACHER, "")
        assert not re.search(rf"[>\s](?:{'|'.join(STUDENTS)})\b", text)
        assert "KKK-" in text
