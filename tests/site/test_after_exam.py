"""The page of the evening after an exam: a change is seen before it counts, kept with who made it, and taken
back."""

import re

import pytest
from desk_class import EXERCISE, STUDENTS, DeskClass
from site_people import TEACHER

from coursework.database.assignments import issued_content, put_issued
from coursework.database.decisions import read_decisions
from coursework.site.desk import after_exam
from coursework.site.desk.class_cache import class_now

QUESTION = f"{EXERCISE}/rA"


@pytest.fixture
def desk(tmp_path):
    found = DeskClass(f"sqlite:///{tmp_path}/desk.db", {})
    right, wrong = found.at_margin("rA", 0.1), "777"
    written = {name: {"rA": right if k < 3 else wrong} for k, name in enumerate(STUDENTS)}
    written["Ada"]["theta4"] = "pas su"
    written["Bo"]["theta4"] = "12 or 13"
    found.hand_in(written)
    return found


def steps_of(desk):
    with desk.site.store.reading() as connection:
        return read_decisions(connection, desk.number).standing_steps


def points(desk):
    return {name: (r.points, r.out_of) for name, r in class_now(desk.site, desk.number).results.items()}


def test_a_change_is_previewed_kept_and_taken_back(desk):
    before = points(desk)
    asked = {"kind": "weight", "question": QUESTION, "points": "9", "why": "announced <b>so</b>"}
    page = desk.page(TEACHER, "/after", **asked)
    assert "Question 1.1: out of 9" in page.text
    assert "Rise: 3" in page.text
    assert "<b>so" not in page.text
    assert (points(desk), steps_of(desk)) == (before, ())
    browser = desk.browser(TEACHER)
    reply = browser.fill(f"/desk/{desk.number}/after", {"do": "confirm", **asked})
    assert "Saved. Question 1.1: out of 9" in reply.text
    (step,) = steps_of(desk)
    assert (step.student, step.kind, step.points, step.by, step.reason) == (
        "",
        "weight",
        9,
        TEACHER,
        asked["why"],
    )
    now = points(desk)
    assert now["Ada"][1] == now["Flo"][1] > before["Ada"][1]
    assert now["Ada"][0] - before["Ada"][0] == now["Ada"][1] - before["Ada"][1]
    assert now["Flo"][0] == before["Flo"][0]
    browser.fill(f"/desk/{desk.number}/after", {"do": "undo", "undo": step.id})
    assert (points(desk), steps_of(desk)) == (before, ())


def test_symbols_of_questions_are_typeset_as_students_see_them(desk):
    for end in ("/after", "/questions"):
        table = desk.page(TEACHER, end).text.rpartition("<tbody>")[2]
        assert table.count("<math") >= len(class_now(desk.site, desk.number).questions) - 1, end
        assert "r_A" not in table
        assert "…" in table


def test_several_changes_are_taken_back_at_once_unless_others_stand_by_then(desk):
    before, browser, path = points(desk), desk.browser(TEACHER), f"/desk/{desk.number}/after"
    for asked in ({"kind": "weight", "points": "9"}, {"kind": "bonus"}, {"kind": "neutral"}):
        browser.fill(path, {"do": "confirm", "question": QUESTION, **asked})
    weight, bonus, neutral = (one.id for one in steps_of(desk))
    page = desk.page(TEACHER, "/after", undo=f"{bonus},{neutral}")
    undone = [page.text.index(f"To undo: Question 1.1: {text}") for text in ("neutralised", "a bonus")]
    assert undone == sorted(undone)
    assert "Undone" not in page.text
    assert len(steps_of(desk)) == 3
    for stale in ("", "-1", "x", f"{bonus},x"):
        browser.fill(path, {"do": "undo", "undo": stale})
    assert len(steps_of(desk)) == 3
    browser.fill(path, {"do": "undo", "undo": bonus})  # in the middle
    assert [one.id for one in steps_of(desk)] == [weight, neutral]
    assert "is taken back already" in browser.fill(path, {"do": "undo", "undo": f"{bonus},{neutral}"}).text
    browser.fill(path, {"do": "undo", "undo": neutral})
    assert points(desk)["Ada"][1] > before["Ada"][1]
    browser.fill(path, {"do": "undo", "undo": weight})
    assert (points(desk), steps_of(desk)) == (before, ())


def test_provisional_marks_are_named_and_left_out_and_non_answers_put_away(desk):
    page = desk.page(TEACHER, "/after", lang="fr")
    assert "Illisibles" in page.text
    assert "provisoire" in desk.page(TEACHER, lang="fr").text
    assert "provisional" in desk.page(TEACHER, "/files/summary.csv").text.splitlines()[0]
    browser = desk.browser(TEACHER)
    book = b"Student,ID,SIS User ID,SIS Login ID,Section,week3 (1)\nAda,1,4000,ada,A,\nCy,3,4002,cy,A,\n"
    sent = {"platform": "canvas", "item": "week3", "score": "points"}
    reply = browser.fill(f"/desk/{desk.number}/gradebook", sent, files={"template": ("book.csv", book)})
    assert re.search(r"2 provisional marks left out.*Ada, Bo", reply.text)
    reply = browser.fill(f"/desk/{desk.number}/after", {"do": "put_away"})
    assert "Saved. Answers that say nothing, put away: 1." in reply.text
    provisional = [name for name, result in class_now(desk.site, desk.number).results.items() if result.open]
    assert provisional == ["Bo"]
    (aside,) = re.findall(
        rf"{TEACHER}: [^<]*put away: 1.*?undo=(\w+)", desk.page(TEACHER, "/after").text, re.DOTALL
    )
    browser.fill(f"/desk/{desk.number}/after", {"do": "undo", "undo": aside})
    assert class_now(desk.site, desk.number).results["Ada"].open


def test_a_change_that_makes_no_sense_changes_nothing(desk):
    browser = desk.browser(TEACHER)
    for asked in (
        {"kind": "weight", "question": QUESTION, "points": "x"},
        {"kind": "weight", "question": "elsewhere/rA", "points": "2"},
        {"kind": "withdrawn", "question": QUESTION},
        {"kind": "neutral", "question": ""},
        {"kind": "price", "question": QUESTION, "points": "3", "answer": "slip"},
        {"kind": "curve", "answer": "5:1 2:9"},
    ):
        assert desk.page(TEACHER, "/after", **asked).status_code == 200
        assert browser.fill(f"/desk/{desk.number}/after", {"do": "confirm", **asked}).status_code == 200
    assert steps_of(desk) == ()


def test_a_forged_form_changes_nothing(desk):
    browser = desk.browser(TEACHER)
    asked = {"do": "confirm", "kind": "neutral", "question": QUESTION}
    assert browser.post(f"/desk/{desk.number}/after", data=asked).status_code == 403
    assert steps_of(desk) == ()


def test_nothing_waits_in_a_question_that_counts_for_nobody(desk):
    browser, asked = desk.browser(TEACHER), {"kind": "neutral", "question": f"{EXERCISE}/theta4"}
    before = class_now(desk.site, desk.number).waiting
    browser.fill(f"/desk/{desk.number}/after", {"do": "confirm", **asked})
    assert class_now(desk.site, desk.number).waiting == before - 2
    assert {entry.group.part for entry in class_now(desk.site, desk.number).open.values()} == {"rA"}
    browser.fill(f"/desk/{desk.number}/after", {"do": "undo", "undo": steps_of(desk)[0].id})
    assert class_now(desk.site, desk.number).waiting == before


def test_what_a_wider_margin_makes_right_waits_no_more(tmp_path):
    """Of two answers near the margin, the one that the wider margin takes in; both are back when it is taken
    back."""
    desk = DeskClass(f"sqlite:///{tmp_path}/desk.db", {})
    desk.hand_in({"Ada": {"rA": desk.at_margin("rA", 1.3)}, "Bo": {"rA": desk.at_margin("rA", 1.8)}})

    def waiting():
        now = class_now(desk.site, desk.number)
        on_page = now.exam.open
        assert [members for _, members in on_page] == [found.members for found in now.open.values()]
        return {answer.student for found in now.open.values() for answer in found.members}

    assert waiting() == {"Ada", "Bo"}
    asked = {"do": "confirm", "kind": "tolerance", "question": QUESTION, "points": "1.5"}
    desk.browser(TEACHER).fill(f"/desk/{desk.number}/after", asked)
    assert waiting() == {"Bo"}
    desk.browser(TEACHER).fill(f"/desk/{desk.number}/after", {"do": "undo", "undo": steps_of(desk)[0].id})
    assert waiting() == {"Ada", "Bo"}


def test_an_attempt_that_neither_counts_nor_is_the_last_waits_for_nobody(tmp_path):
    desk = DeskClass(f"sqlite:///{tmp_path}/desk.db", {})
    right = {"rA": desk.at_margin("rA", 0)}
    for sitting, written in enumerate(({"rA": "trop court"}, right, {"theta4": "1°"}), 1):
        desk.hand_in({"Ada": written}, sitting=sitting)
    assert class_now(desk.site, desk.number).waiting == 0
    assert "Nothing waits for anybody." in desk.page(TEACHER, "/after").text
    desk.hand_in({"Ada": {"rA": "too short"}}, sitting=4)
    assert class_now(desk.site, desk.number).waiting == 1
    assert "(cards: 1, answers: 1)" in desk.page(TEACHER, "/after").text


def test_a_scale_gives_marks_to_an_assignment_that_stated_none(desk):
    with desk.site.store.begin() as connection:
        content = issued_content(connection, desk.number)
        stated = {name: value for name, value in content["assignment"].items() if name != "mark"}
        put_issued(connection, {**content, "assignment": stated})
    assert ">Mark<" not in desk.page(TEACHER).text
    desk.browser(TEACHER).fill(f"/desk/{desk.number}/after", {"do": "confirm", "kind": "full", "points": "2"})
    assert ">Mark<" in desk.page(TEACHER).text
    book = b"Student,ID,SIS User ID,SIS Login ID,Section,week3 (1)\nAda,1,4000,ada,A,\nCy,3,4002,cy,A,\n"
    told = {}
    for score in ("points", "mark"):
        sent = {"platform": "canvas", "item": "week3", "score": score, "provisional": "1"}
        files = {"template": ("book.csv", book)}
        reply = desk.browser(TEACHER).fill(f"/desk/{desk.number}/gradebook", sent, files=files)
        told[score] = "only marks count that" in reply.text
    assert told == {"points": True, "mark": False}


def test_a_file_changed_after_issuing_is_told_on_the_page_and_applied_as_one_decision(desk):
    before, browser, path = points(desk), desk.browser(TEACHER), f"/desk/{desk.number}/after"
    file = '[[exercises]]\nname = "slotted_mechanism"\npoints = {{ rA = {0} }}\n[marking]\ndigits = 3\n'
    assert "now differs from the papers" not in desk.page(TEACHER, "/after").text
    for source, done in (
        (file.format(7), "out of 7"),
        ("name =", "week3.toml"),
        (file.format("-1"), "points"),
    ):
        sent = ("week3.toml", source.encode())
        reply = browser.fill(path, {"do": "compare"}, files={"file": sent})
        assert done in reply.text
        assert steps_of(desk) == ()
        browser.fill(path, {"do": "confirm", "kind": "file", "source": source})
        assert {step.kind for step in steps_of(desk)} == ({"weight", "digits"} if "out of" in done else set())
        if steps_of(desk):
            assert points(desk)["Ada"][1] > before["Ada"][1]
            browser.fill(path, {"do": "undo", "undo": steps_of(desk)[0].id})
        assert (points(desk), steps_of(desk)) == (before, ())


def test_the_file_in_the_folder_of_the_course_is_compared_at_every_look(desk, tmp_path, monkeypatch):
    file = tmp_path / "week3.toml"
    file.write_text('[[exercises]]\nname = "slotted_mechanism"\n[marking.prices]\nsign = 0.1\n')
    monkeypatch.setattr(after_exam, "own_file", lambda course, name: file)
    page = desk.page(TEACHER, "/after", lang="fr")
    assert re.search(r"autre chose que les copies.*« Étourderie.*laisse 10 %", page.text, re.DOTALL)
    assert "?kind=file#preview" in page.text


def test_questions_of_a_kind_or_of_an_exercise_change_as_one_decision(desk):
    browser, path, before = desk.browser(TEACHER), f"/desk/{desk.number}/after", points(desk)
    numbers = [p.id for p in desk.variant.parts if p.kind == "number"]
    for place, several in (("number", numbers), (EXERCISE, [p.id for p in desk.variant.parts])):
        reply = browser.fill(path, {"do": "confirm", "kind": "weight", "question": place, "points": "9"})
        assert re.search(r"Saved. Questions 1\.\d, 1\.\d.*: out of 9", reply.text)
        assert [step.part for step in steps_of(desk)] == several
        assert len({step.id for step in steps_of(desk)}) == 1
        browser.fill(path, {"do": "undo", "undo": steps_of(desk)[0].id})
        assert (points(desk), steps_of(desk)) == (before, ())
    assert (
        "of one question"
        in browser.fill(path, {"do": "confirm", "kind": "accepted", "question": "number", "answer": "1"}).text
    )
