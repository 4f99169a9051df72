"""The queue: what waits and why, decided for all who wrote the same, once, by whom; what is handed in anew
waits anew."""

import re

import pytest
from desk_class import EXERCISE, OTHER, SEED, STUDENTS, DeskClass, Rejected, field, told
from site_people import TEACHER, ZOE
from tables import each_row

from coursework.database.assignments import issued_content, put_issued
from coursework.database.current_marks import adjusted_sheets
from coursework.database.decisions import read_decisions
from coursework.database.instructor_queries import people_of
from coursework.database.marking import mark_new
from coursework.database.submissions import insert_submission
from coursework.gradebook.feedback_sheets import feedback_paper
from coursework.gradebook.rows import AnswerRow, RowOrigin
from coursework.gradebook.statistics.page import report as class_report
from coursework.issuing.answer_papers import answer_papers
from coursework.issuing.wide_form import wide_form
from coursework.rendering.renderer import renderer_of
from coursework.scanning.page_reading import Papers
from coursework.sheets.paper import Paper, PaperHeading
from coursework.site.desk.class_cache import class_now
from coursework.site.desk.question_page import statistics_of
from coursework.site.papers.student_paper import StudentPaper

WRITTEN = {
    "Ada": {"rA": "trop court", "theta4": "zz"},
    "Bo": {"rA": "Trop  court", "theta4": "12"},
    "Cy": {"rA": "voir feuille", "theta4": "zz"},
}


@pytest.fixture
def desk(tmp_path):
    return DeskClass(f"sqlite:///{tmp_path}/desk.db", WRITTEN)


def press(desk, name, page, do, **more):
    """A button of the page's card."""
    hidden = {k: field(page, k) or "" for k in ("group", "since", "student")}
    return desk.browser(name).fill(f"/desk/{desk.number}/queue", {**hidden, "all": "1", "do": do, **more})


def marks(desk, part="rA"):
    with desk.site.store.reading() as connection:
        return {one.student: one.lines[part] for one in adjusted_sheets(connection, desk.number)[-1]}


def waiting(desk):
    """Why, part and students of each card, in order."""
    now = class_now(desk.site, desk.number)
    return [(one.why, one.group.part, [w.student for w in one.members]) for one in now.open.values()]


def test_what_was_written_the_same_is_one_card_and_questions_follow_the_sheet(desk):
    assert waiting(desk) == [
        ("unreadable", "rA", ["Ada", "Bo"]),
        ("unreadable", "rA", ["Cy"]),
        ("unreadable", "theta4", ["Ada", "Cy"]),
    ]


@pytest.mark.parametrize(
    ("times", "why"), [(0.5, None), (0.95, "just"), (1.5, "near"), (1.99, "near"), (2.1, None)]
)
def test_what_is_near_the_margin_is_told_by_the_margin(tmp_path, times, why):
    desk = DeskClass(f"sqlite:///{tmp_path}/desk.db", {})
    desk.hand_in({"Ada": {"rA": desk.at_margin("rA", times)}})
    assert [one[0] for one in waiting(desk)] == ([why] if why else [])
    assert ("Nothing waits." in desk.page(TEACHER, "/queue").text) == (why != "near")


def test_a_wrong_answer_that_three_wrote_waits_and_one_that_two_wrote_does_not(tmp_path):
    desk = DeskClass(f"sqlite:///{tmp_path}/desk.db", {})
    desk.hand_in({name: {"rA": "777"} for name in ("Ada", "Bo")})
    assert not waiting(desk)
    desk.hand_in({"Cy": {"rA": "777.0"}, "Di": {"rA": "777"}})
    assert [one[0] for one in waiting(desk)] == ["often"]


def test_a_question_has_its_number_on_the_papers_everywhere(tmp_path):
    """Versions that ask a choice or an angle in third place, and others of a bank of questions; the numbers
    are those that the printed papers show."""
    desk, exercises = DeskClass(f"sqlite:///{tmp_path}/desk.db", {}), (EXERCISE, "vocabulary")
    course = desk.site.course
    papers = {
        name: [course[exercise].variant(seed, "fr") for exercise in exercises]
        for name, seed in zip(STUDENTS[:3], (0, 1, 2), strict=True)
    }
    with desk.site.store.begin() as connection:
        content = issued_content(connection, desk.number)
        content |= {
            "assignment": {**content["assignment"], "name": "other", "exercises": list(exercises)},
            "issued": [
                {"student": name, "version": "ABC"[v.seed], "record": v.record}
                for name, variants in papers.items()
                for v in variants
            ],
        }
        number = put_issued(connection, content)
        rows = [
            AnswerRow(name, v.exercise.name, "", part, "zz", "answers.csv")
            for name in papers
            for v in papers[name]
            for part in v.part_ids
        ]
        insert_submission(connection, number, rows, source="answers.csv", received_at=desk.at)
    mark_new(course, desk.site.store, number)
    now, renderer = class_now(desk.site, number), renderer_of(course.folder)
    heading, printed = PaperHeading("fr", "", "", ""), {}
    for name, variants in papers.items():
        asked = [(v.exercise.name, part) for v in variants for part in v.part_ids]
        page = renderer.html(Paper(heading, tuple(v.handout() for v in variants)))
        printed[name] = dict(zip(asked, re.findall(r'class="number">([0-9.]+)[.]<', page), strict=True))
    numbers = {}
    for question in dict.fromkeys(question for asked in printed.values() for question in asked):
        own = {asked[question] for asked in printed.values() if question in asked}
        numbers[question] = "/".join(sorted(own, key=lambda text: [*map(int, text.split("."))]))
    assert any("/" in text for text in numbers.values())
    labels = {
        (exercise, part): f"{text} {part}" if [*numbers.values()].count(text) > 1 else text
        for (exercise, part), text in numbers.items()
    }
    assert len({*labels.values()}) == len(labels)
    assert labels[EXERCISE, "guide"] == "1.3 guide"

    assert dict(now.questions) == dict(Papers(course, content).questions) == numbers
    for name, asked in printed.items():
        on_site = StudentPaper(course, content, name, "fr", {})
        assert [box.number for box in on_site.boxes.values()] == [*asked.values()]
        scanned = next(one for one in answer_papers(content).values() if one.student == name)
        fields = {
            (f.exercise, f.part): f.number for page in scanned.pages(course) for f in page.fields if f.number
        }
        assert fields == asked
        sheets = [graded for graded in now.graded.values() if graded.student == name]
        feedback = renderer.html(feedback_paper(course, now.issued, name, sheets, "fr"))
        assert {*re.findall(r'<strong class="no">([0-9.]+)<', feedback)} == {*asked.values()}
        page = desk.browser(TEACHER, "fr").get(f"/desk/{number}/student", params={"name": name}).text
        assert re.findall(r"<p><strong>([0-9.]+)</strong>", page) == [*asked.values()]
    titles = desk.browser(TEACHER, "fr").get(f"/desk/{number}/files/answers_wide.csv").text.splitlines()[0]
    wide, _ = wide_form(course, content, now.questions)
    assert [title for title in titles.split(";") if "." in title] == wide[2:]
    assert {tuple(title.split()[1:3]): title.split()[0] for title in wide[2:]} == numbers
    table = desk.browser(TEACHER, "fr").get(f"/desk/{number}").text
    assert {*re.findall(r'title="[^"]*">([0-9./]+(?: \w+)?)</a></th>', table)} == {*labels.values()}
    report = renderer.report_html(class_report(course, statistics_of(now), "fr", now.questions))
    assert {*re.findall(r"([0-9./]+) ·", report)} >= {*numbers.values()}
    queue = desk.browser(TEACHER, "fr").get(f"/desk/{number}/queue").text
    listed = re.findall(r'exercise=(\w+)&amp;part=(\w+)">([0-9./]+) ', queue)
    assert listed
    assert all(numbers[exercise, part] == text for exercise, part, text in listed)
    exam = now.exam
    assert {row.number for row in exam.table} == {*numbers.values()}
    assert exam.called("1.3") == [(EXERCISE, "guide"), (EXERCISE, "swing")]
    changed = {"kind": "bonus", "question": f"{EXERCISE}/guide"}
    preview = desk.browser(TEACHER).get(f"/desk/{number}/after", params=changed).text
    assert "Question 1.3 guide:" in preview


def test_what_was_read_has_the_numbers_of_the_readers_language(desk):
    desk.hand_in({"Di": {"rA": desk.at_margin("rA", 1.5) + " mm"}})
    page = desk.browser(TEACHER, "fr").get(f"/desk/{desk.number}/student", params={"name": "Di"})
    assert re.search(r"Lu\s*:\s*\d+,\d+", page.text)


def test_the_card_shows_what_a_person_needs(desk):
    desk.hand_in({"Di": {"rA": desk.at_margin("rA", 1.5)}})
    text = desk.page(TEACHER, "/queue", why="near").text
    for wanted in (
        "1.1 ·",
        "1.5 × the accepted margin",
        "Right answer:",
        "The student’s feedback now",
        ">Di<",
    ):
        assert wanted in text


def test_accepted_for_all_who_wrote_the_same_and_the_next_card_is_there(desk):
    page = press(desk, TEACHER, desk.page(TEACHER, "/queue"), "accept", comment="Look at the sheet")
    assert (told(page), "voir feuille" in page.text) == ("Accepted (2).", True)
    for name in ("Ada", "Bo"):
        assert (marks(desk)[name].verdict, marks(desk)[name].points) == ("accepted", 1)
        assert "Look at the sheet" in marks(desk)[name].feedback
    assert marks(desk)["Cy"].verdict == "unreadable"


def test_one_alone_is_decided_on_where_not_all_are_wanted(desk):
    press(desk, TEACHER, desk.page(TEACHER, "/queue"), "accept", all="")
    assert [marks(desk)[name].verdict for name in ("Ada", "Bo")] == ["accepted", "unreadable"]


def test_points_are_given_up_to_those_of_the_part(desk):
    page = desk.page(TEACHER, "/queue")
    assert "more than the 1" in told(press(desk, TEACHER, page, "give:1.5"))
    assert marks(desk)["Ada"].verdict == "unreadable"
    press(desk, TEACHER, page, "give:0.5")
    assert (marks(desk)["Ada"].verdict, marks(desk)["Ada"].points) == ("partial", 0.5)


@each_row("do", ["give:-1", "give:", "give:nan", "give:x"])
def test_points_that_are_none_decide_nothing(desk, do):
    press(desk, TEACHER, desk.page(TEACHER, "/queue"), do)
    assert marks(desk)["Ada"].verdict == "unreadable"


def test_a_refused_answer_keeps_its_mark_and_leaves_the_queue(desk):
    desk.hand_in({"Di": {"rA": desk.at_margin("rA", 1.5)}})
    before = marks(desk)["Di"]
    press(
        desk, TEACHER, desk.page(TEACHER, "/queue", why="near"), "refuse", comment="Round less.", why="near"
    )
    after = marks(desk)["Di"]
    assert (after.verdict, after.points) == (before.verdict, before.points)
    assert after.feedback.endswith("Round less.")
    assert "near" not in [one[0] for one in waiting(desk)]


def test_the_same_that_cannot_be_read_elsewhere_goes_along_where_that_is_wanted(desk):
    desk.hand_in({"Di": {"rA": "zz"}})
    page = desk.page(TEACHER, "/queue", exercise=EXERCISE, part="theta4")
    assert "and the 1 of other questions" in page.text
    assert told(press(desk, TEACHER, page, "refuse", everywhere="1")) == "0 points given (3)."


def test_undo_is_a_decision_that_brings_the_card_back(desk):
    page = desk.page(TEACHER, "/queue")
    after = press(desk, TEACHER, page, "accept")
    page = press(desk, TEACHER, after, "undo")
    assert (told(page), field(page, "group")) == ("Undone (2).", field(desk.page(TEACHER, "/queue"), "group"))
    assert marks(desk)["Ada"].verdict == "unreadable"
    with desk.site.store.reading() as connection:
        kinds = [one.kind for one in read_decisions(connection, desk.number).on("Ada", EXERCISE, "rA")]
    assert kinds == ["accepted", "withdrawn"]
    assert told(press(desk, TEACHER, page, "undo")) == "You have nothing to undo."


def test_nobody_undoes_what_somebody_else_decided(desk):
    press(desk, OTHER, desk.page(OTHER, "/queue"), "accept")
    press(desk, TEACHER, desk.page(TEACHER, "/queue"), "undo")
    assert marks(desk)["Ada"].verdict == "accepted"


def test_of_two_at_once_the_second_sees_who_decided_and_nothing_counts_twice(desk):
    first, second = desk.page(TEACHER, "/queue"), desk.page(OTHER, "/queue")
    press(desk, TEACHER, first, "accept")
    watched = desk.browser(OTHER).get(
        f"/desk/{desk.number}/queue/watch", params={"group": field(second, "group")}
    )
    assert TEACHER in watched.text
    assert TEACHER in told(press(desk, OTHER, second, "refuse"))
    assert marks(desk)["Ada"].points == 1
    with desk.site.store.reading() as connection:
        assert len(read_decisions(connection, desk.number).on("Ada", EXERCISE, "rA")) == 1


def test_a_press_that_comes_twice_decides_once(desk):
    page = desk.page(TEACHER, "/queue")
    press(desk, TEACHER, page, "accept")
    press(desk, TEACHER, page, "accept")
    with desk.site.store.reading() as connection:
        assert len(read_decisions(connection, desk.number).on("Bo", EXERCISE, "rA")) == 1


def test_an_answer_that_is_handed_in_anew_waits_anew_where_the_decision_was_of_another_text(desk):
    press(desk, TEACHER, desk.page(TEACHER, "/queue"), "accept")
    desk.hand_in({"Ada": {"rA": "trop court"}, "Bo": {"rA": "too short"}}, sitting=2)
    found = [one for one in waiting(desk) if one[1] == "rA"]
    assert ("unreadable", "rA", ["Bo"]) in found
    assert not [one for one in found if "Ada" in one[2]]


def test_a_rejected_row_is_placed_by_hand_and_the_original_is_kept(desk):
    row = {"student": "Di", "exercise": EXERCISE, "seed": "7", "part": "rA", "answer": "319.8 mm"}
    desk.hand_in({}, Rejected("late.csv, line 2", "cells where there are none", row))
    page = desk.page(TEACHER, "/queue", why="rejected")
    name = field(page, "row")
    place = {"row": name, "do": "place", "from": "queue", "question": f"{EXERCISE}/rA"}
    desk.browser(TEACHER).fill(f"/desk/{desk.number}/rejected", {**place, "student": "Nobody"})
    assert "Di" not in marks(desk)
    desk.browser(TEACHER).fill(f"/desk/{desk.number}/rejected", {**place, "student": "Di"})
    assert marks(desk)["Di"].answer == "319.8 mm"
    now = class_now(desk.site, desk.number)
    assert [(one.waits, one.row.row["seed"]) for one in now.rejected] == [(False, "7")]


def test_all_rows_of_a_stranger_are_placed_at_once_and_told_in_french(desk):
    desk.hand_in({"Di": {"omega4": "1"}})
    rows = [
        {"student": "Dii", "exercise": EXERCISE, "part": part, "answer": text}
        for part, text in {"rA": "319.8 mm", "theta4": "9", "omega4": "2", "x": "3"}.items()
    ]
    lost = [Rejected(f"late.csv, line 2, 1.{k} x", "no student", row) for k, row in enumerate(rows)]
    desk.hand_in({}, *lost, Rejected("late.csv, line 3", "no student", {**rows[0], "student": "Who"}))
    page = desk.page(TEACHER, "/files", lang="fr")
    assert "« Dii » n’est personne" in page.text.replace("\u202f", " ").replace("\xa0", " ")
    assert "late.csv, ligne 2, 1.0 x · étudiant <code>Dii</code> · exercice" in page.text
    row = re.search(r'name="row" value="([^"]*)"', page.text)[1]
    asked = {"row": row, "do": "place all", "student": ""}
    desk.browser(TEACHER).fill(f"/desk/{desk.number}/rejected", asked)
    assert len([one for one in class_now(desk.site, desk.number).rejected if one.waits]) == 5
    reply = desk.browser(TEACHER).fill(f"/desk/{desk.number}/rejected", asked | {"student": "Di"})
    assert "Di: rows placed 2, rows that wait on 2." in reply.text
    assert marks(desk)["Di"].answer == "319.8 mm"
    left = [one.row.row["part"] for one in class_now(desk.site, desk.number).rejected if one.waits]
    assert sorted(left) == ["omega4", "rA", "x"]


def test_a_row_that_is_placed_by_hand_is_of_the_very_hand_in(desk):
    with desk.site.store.begin() as connection:
        person = people_of(connection, desk.number)["Di"]
        own = [
            AnswerRow("Di", EXERCISE, str(SEED), part, text, "site", origin=RowOrigin(sitting=1))
            for part, text in (("rA", ""), ("theta4", "9"))
        ]
        insert_submission(
            connection, desk.number, own, source="site", received_at=desk.at, person_id=person, number=1
        )
    row = {"student": "Di", "exercise": EXERCISE, "seed": "7", "part": "rA", "answer": "319.8 mm"}
    desk.hand_in({}, Rejected("late.csv, line 2", "cells where there are none", row))
    name = field(desk.page(TEACHER, "/queue", why="rejected"), "row")
    place = {"row": name, "do": "place", "from": "queue", "student": "Di", "question": f"{EXERCISE}/rA"}
    desk.browser(TEACHER).fill(f"/desk/{desk.number}/rejected", place)
    (one,) = [one for one in class_now(desk.site, desk.number).machine.values() if one.student == "Di"]
    assert (one.sitting, one.lines["rA"].answer, one.lines["theta4"].answer) == (1, "319.8 mm", "9")


def test_a_row_is_not_placed_over_an_answer_that_is_marked(desk):
    row = {"student": "Ada", "exercise": EXERCISE, "seed": str(SEED), "part": "rA", "answer": "1"}
    desk.hand_in({}, Rejected("late.csv, line 2", "why not", row))
    name = field(desk.page(TEACHER, "/queue", why="rejected"), "row")
    place = {"row": name, "do": "place", "from": "queue", "student": "Ada", "question": f"{EXERCISE}/rA"}
    reply = desk.browser(TEACHER).fill(f"/desk/{desk.number}/rejected", place)
    assert "already has a marked answer to question 1.1" in reply.text
    assert marks(desk)["Ada"].answer == "trop court"


@pytest.mark.parametrize("lang", ["en", "fr"])
def test_an_empty_queue_says_what_to_do_next(tmp_path, lang):
    desk = DeskClass(f"sqlite:///{tmp_path}/desk.db", {})
    assert f"/desk/{desk.number}/files" in desk.page(TEACHER, "/queue", lang).text


def test_a_student_sees_nothing_of_it(desk):
    assert desk.page(ZOE, "/queue").status_code == 403


def test_the_number_that_waits_follows_a_decision_without_a_new_page(desk):
    page = desk.browser(TEACHER).get(f"/desk/{desk.number}/queue")
    before = re.search(r'id="waits" class="count">(\d+)<', page.text)[1]
    hidden = {k: field(page, k) or "" for k in ("group", "since", "student")}
    piece = desk.browser(TEACHER).fill(
        f"/desk/{desk.number}/queue", {**hidden, "all": "1", "do": "refuse"}, headers={"hx-request": "true"}
    )
    after = re.search(r'id="waits" class="count" hx-swap-oob="true">(\d+)<', piece.text)[1]
    assert int(after) == int(before) - 2


def test_an_empty_queue_tells_of_rows_that_name_nobody(tmp_path):
    desk = DeskClass(f"sqlite:///{tmp_path}/desk.db", {"Ada": {"rA": "1"}})
    place = f"/desk/{desk.number}/queue"
    assert "files#rejected" not in desk.browser(TEACHER).get(place).text
    desk.hand_in({"Zacharias": {"rA": "1"}})
    assert "files#rejected" in desk.browser(TEACHER).get(place).text
