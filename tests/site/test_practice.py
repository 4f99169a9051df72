"""Practice with plain forms: a variant of one's own, answers read and checked, hints, solutions, drafts."""

import json
import re
from datetime import UTC, datetime
from html import unescape

import pytest
from course_of_every_kind import write_course
from site_people import MAX, TEACHER, ZOE, count_of, statements
from site_practising import BOX, Practising, right_answer, words_of
from sqlalchemy import insert
from tables import each_row

from coursework import open_course
from coursework.course.lessons import taught_by
from coursework.database import tables
from coursework.database.progress import PersonProgress
from coursework.scenes.animation import shown_by_motion
from coursework.selfstudy.mastery import outings

COURSE = open_course()
EXERCISE = "slotted_mechanism"


@pytest.fixture
def zoe(class_of_three):
    return Practising(class_of_three, class_of_three.browser(ZOE), EXERCISE)


def entries(class_, name=ZOE):
    return [dict(e) for e in PersonProgress(class_.site.store, class_.ids[name]).progress]


def test_the_course_stands_in_its_order(class_of_three, course):
    page = class_of_three.browser(ZOE).get("/practice").text
    assert tuple(re.findall(r'<li class="new"><a href="/practice/(\w+)">', page)) == course.folder.in_order
    assert re.findall(r"<h3>(\w+)\. ", page) == [*map(str, range(1, len(course.folder.chapters))), "A"]


def test_what_is_said_of_a_question_leads_to_the_lesson_that_teaches_it(zoe):
    leads = {}
    for part in ("rA", "omega4", "alpha4"):
        page = zoe.send({part: "12345"}, check=part, hint=part).text
        for place in ("told", "hints"):
            found = re.search(rf'<div id="{place}-{BOX}{part}".*?href="(/lessons/\w+)', page, re.DOTALL)
            leads[part, place] = found and found[1].rpartition("/")[2]
    lessons = {"rA": "positions", "omega4": "velocities", "alpha4": "accelerations"}
    assert leads == {(part, place): lessons[part] for part, place in leads}


def test_lessons_name_questions_of_their_exercises():
    for name in COURSE.names:
        named = [part for lesson in taught_by(COURSE.folder, name, "en") for part in lesson.parts]
        assert set(named) <= {part.id for part in COURSE[name].spec.parts}, name
        assert len(set(named)) == len(named), name


def test_a_page_and_a_checked_answer_take_few_statements(zoe, class_of_three):
    part = next(p for p in zoe.variant.parts if not p.choices)
    store = class_of_three.site.store
    zoe.page()
    form = {"_seal": zoe.seal, "versions": "{}", "check": part.id}
    with statements(store) as to_show:
        zoe.page()
    with statements(store) as to_check:
        checked = zoe.browser.post(zoe.address, data={**form, BOX + part.id: "17"}).headers["location"]
    page = zoe.browser.get(checked).text
    with statements(store) as by_script:
        zoe.browser.post(zoe.address, data={**form, BOX + part.id: "18"}, headers={"hx-request": "true"})
    assert zoe.told(page, part.id)
    assert [e["answer"] for e in entries(class_of_three)] == ["17", "18"]
    assert [count_of(found) for found in (to_show, to_check, by_script)] == [(3, 0), (5, 1), (3, 1)]


# --------------------------------------------------------------------- whose variant


def test_a_variant_hangs_on_the_person_and_the_exercise(class_of_three):
    exercises = ("grashof", "coriolis", "two_circles", "velocity_polygon")
    own = {
        name: [Practising(class_of_three, class_of_three.browser(name), e).address for e in exercises]
        for name in (ZOE, MAX)
    }
    again = [Practising(class_of_three, class_of_three.browser(ZOE), e).address for e in exercises]
    assert own[ZOE] == again != own[MAX]


def test_no_variant_of_a_class_is_practised(class_of_three, zoe):
    seed = zoe.variant.seed
    assert zoe.page()
    with class_of_three.site.store.begin() as connection:
        found = connection.execute(
            insert(tables.assignment)
            .values(name="A1", created=datetime.now(UTC))
            .returning(tables.assignment.c.id)
        ).scalar_one()
        record = {"assignment_id": found, "exercise": EXERCISE, "record": zoe.variant.record}
        connection.execute(insert(tables.variant).values(record | {"seed": "77"}))
    assert Practising(class_of_three, class_of_three.browser(ZOE), EXERCISE).variant.seed != seed
    assert class_of_three.browser(ZOE).get(f"/practice/{EXERCISE}/77").status_code == 404
    assert class_of_three.browser(TEACHER).get(f"/practice/{EXERCISE}/77").status_code == 200


@each_row("address", [f"{EXERCISE}/0", f"{EXERCISE}/x", f"{EXERCISE}/-1", "no_such", "no_such/3000000"])
def test_other_addresses_lead_nowhere(class_of_three, address):
    assert class_of_three.browser(ZOE).get(f"/practice/{address}").status_code == 404


def test_one_goes_on_where_one_was_until_all_is_right(zoe, class_of_three):
    parts = zoe.variant.parts
    first = {p.id: right_answer(zoe.variant, p) for p in parts[:3]}
    zoe.send(first, check="")
    assert Practising(class_of_three, zoe.browser, EXERCISE).address == zoe.address
    assert zoe.address in zoe.browser.get("/practice").text
    zoe.send({p.id: right_answer(zoe.variant, p) for p in parts}, check="")
    assert Practising(class_of_three, zoe.browser, EXERCISE).address != zoe.address


# ------------------------------------------------------------------------- checking


def test_one_answer_is_checked_and_the_others_stay_typed(zoe):
    typed = {"rA": right_answer(zoe.variant, zoe.variant.parts[0]), "omega4": "12 apples"}
    page = zoe.send(typed, check="rA").text
    assert zoe.told(page, "rA").endswith("is right.")
    assert zoe.told(page, "omega4") == ""
    assert (zoe.box(page, "rA"), zoe.box(page, "omega4")) == (typed["rA"], typed["omega4"])
    again = zoe.page()
    assert zoe.told(again, "rA").endswith("is right.")
    assert zoe.box(again, "omega4") == "12 apples"


@pytest.mark.parametrize(
    "exercise", ["slotted_mechanism", "joint_twist", "joint_graph", "coupler_curve", "velocity_polygon"]
)
def test_right_answers_are_right(class_of_three, exercise):
    one = Practising(class_of_three, class_of_three.browser(ZOE), exercise)
    typed = {p.id: right_answer(one.variant, p) for p in one.variant.parts}
    page = one.send(typed, check="").text
    assert "Everything is right." in page
    assert "Next:" in page


def test_an_answer_says_what_a_notebook_says(zoe, tmp_path, course):
    import coursework

    page = zoe.send({"rA": "100", "theta4": "abc"}, check="").text
    session = coursework.study(EXERCISE, seed=zoe.variant.seed, folder=tmp_path, lang="en")
    said = str(session.check({"rA": "100", "theta4": "abc"}))
    for part, sentence in (
        ("rA", "is not the right value. It is computed from"),
        ("theta4", "cannot be read as a number"),
    ):
        assert sentence in zoe.told(page, part)
        assert sentence in " ".join(said.split())
    kept = [(e["part"], e["what"], e.get("verdict")) for e in entries(zoe.class_)]
    assert kept == [(e["part"], e["what"], e.get("verdict")) for e in session._store.progress]


def test_no_answer_stands_in_the_page_before_it_is_asked_for(zoe):
    page = zoe.page() + zoe.send({"rA": "100"}, check="rA").text
    for part in zoe.variant.parts:
        if part.sort.is_scalar:
            assert f"{zoe.variant.key.reference[part.quantity]:.5g}" not in page


def test_what_is_read_is_said_before_it_counts(zoe):
    french = Practising(zoe.class_, zoe.class_.browser(ZOE, "fr"), EXERCISE)
    for one, said in ((zoe, "read as 319.8 mm"), (french, "lu : 319,8 mm")):
        reply = one.send({"rA": "319,8"}, "/read", part="rA")
        assert words_of(reply.text) == said
    assert "cannot be read" in zoe.send({"rA": "abc"}, "/read", part="rA").text
    assert zoe.send({"rA": " "}, "/read", part="rA").text == ""
    assert entries(zoe.class_) == []


def test_a_piece_is_told_of_one_question_alone(zoe):
    data = {"_seal": zoe.seal, "check": "rA", "a-rA": "100", "a-theta4": "20"}
    piece = zoe.browser.post(zoe.address, data=data, headers={"hx-request": "true"}).text
    assert re.findall(r'id="(told-[\w-]+)"', piece) == ["told-a-rA"]
    assert "<html" not in piece


@pytest.fixture
def every_kind(class_of_three, tmp_path):
    """An exercise of another course, with ticks, a matrix, words and a drawing."""
    class_of_three.site.course = open_course(write_course(tmp_path / "circuits"))
    (name,) = class_of_three.site.course.names
    return Practising(class_of_three, class_of_three.browser(ZOE), name)


def test_ticks_and_matrices_stay_as_they_were(every_kind):
    one = every_kind
    typed = {p.id: right_answer(one.variant, p) for p in one.variant.parts if not p.sort.is_open}
    page = one.send({**typed, "why": "since the coil\nlags"}, check="").text
    for name in typed:
        assert one.told(page, name).endswith("right."), name
    for html in (page, one.page()):
        ticked = re.findall(r'type="checkbox" name="a-true_of_it" value="(\w)" checked', html)
        assert ", ".join(sorted(ticked)) == ", ".join(sorted(typed["true_of_it"].split(", ")))
        assert unescape(re.search(r'id="answer-a-M"[^>]* value="([^"]*)"', html)[1]) == typed["M"]
        assert "since the coil\nlags</textarea>" in html
    assert 'name="check" value="sketch"' not in page
    assert "Everything is right." in page


def test_what_a_person_would_mark_leads_to_its_model_answer(every_kind):
    page = every_kind.send({"why": "since"}, check="why").text
    assert re.search(r'<button class="plain" name="reveal" value="why why"', page)
    assert "study." not in page


# ------------------------------------------------------------------ hints, solutions


def test_hints_come_one_after_another_and_hold_no_python(zoe):
    for count in (1, 2, 3):
        page = zoe.send(hint="omega4").text
        assert re.findall(r"Hint (\d) of", page) == [str(k + 1) for k in range(count)]
    assert "study." not in page
    assert [e["step"] for e in entries(zoe.class_)] == [1, 2, 3]
    assert "Hint 3 of" in zoe.page()


def test_an_unexplained_wrong_answer_offers_the_first_hint_until_it_was_seen(zoe):
    page = zoe.send({"omega4": "1234.5"}, check="omega4").text
    (asked,) = re.findall(r'name="hint" value="([^"]+)" formaction="[^"]+">See the first hint<', page)
    assert "Hint 1 of" in zoe.send(hint=asked).text
    assert "See the first hint" not in zoe.send({"omega4": "1234.6"}, check="omega4").text
    assert "hint" not in zoe.variant.grade({"omega4": "1234.5"})["omega4"].feedback  # of paper and exams


def test_a_step_on_the_way_is_asked_for_by_a_button(class_of_three, course):
    """The hints of a quantity that is not asked stand below those that name it."""
    one = Practising(class_of_three, class_of_three.browser(ZOE), "coupler_curve")
    for part in one.variant.parts:
        page = one.send(hint=part.id).text
        if found := re.search(
            r'name="hint" value="(\w+ \w+)" formaction', page.split("hinted")[1].split("</div>")[0]
        ):
            break
    assert found, "no question here follows from a step that is not asked"
    below = one.send(hint=found[1]).text
    assert "A step on the way:" in below


def test_a_step_that_is_shown_was_not_found_alone(zoe):
    page = zoe.send(reveal="rA rA").text
    assert "The step, with its value" in page
    zoe.send({"rA": right_answer(zoe.variant, zoe.variant.parts[0])}, check="rA")
    (outing,) = outings(PersonProgress(zoe.class_.site.store, zoe.class_.ids[ZOE]).progress)
    assert (outing.is_right, outing.is_clean) == (True, False)


def test_the_solution_is_shown_once_it_is_said_what_that_means(zoe):
    place = f"{zoe.address}/solution"
    assert "no longer counts" in zoe.browser.get(place).text
    assert entries(zoe.class_) == []
    assert zoe.browser.post(place, data={"_seal": zoe.seal}).headers["location"] == place
    value = f"{zoe.variant.key.reference['omega4']:.3g}"
    assert value in words_of(zoe.browser.get(place).text)
    before = outings(PersonProgress(zoe.class_.site.store, zoe.class_.ids[ZOE]).progress)
    assert len(before) == len(zoe.variant.parts)
    assert not any(o.is_right for o in before)
    zoe.send({"rA": right_answer(zoe.variant, zoe.variant.parts[0])}, check="rA")
    assert outings(PersonProgress(zoe.class_.site.store, zoe.class_.ids[ZOE]).progress) == before
    assert "no longer counts" in zoe.page()


def test_a_fresh_variant_asks_no_theory_again(class_of_three):
    from coursework.selfstudy.worked import theory

    one = Practising(class_of_three, class_of_three.browser(ZOE), "slider_extras")
    known = theory(one.variant.exercise)
    assert known & set(one.variant.part_ids)
    part = next(p for p in one.variant.parts if p.id not in known)
    one.send({part.id: right_answer(one.variant, part)}, check=part.id)
    fresh = one.send(go="fresh").text
    assert one.address not in fresh
    assert not [name for name in known if f'id="told-{BOX}{name}"' in fresh]
    assert f'id="told-{BOX}{next(iter(known))}"' in one.page()


def test_the_motion_shows_paths_vectors_and_values_when_all_is_right(class_of_three):
    zoe = Practising(class_of_three, class_of_three.browser(ZOE), "four_bar_motion")
    place = f"{zoe.address}/motion"
    before = zoe.browser.get(place).text
    assert "data-track" in before
    assert not [told for told in ("data-reading", "data-effect", "data-key", "data-point") if told in before]
    zoe.send({p.id: right_answer(zoe.variant, p) for p in zoe.variant.parts}, check="")
    after = zoe.browser.get(place).text
    assert all(told in after for told in ("data-reading", "data-effect", "data-key", "data-point"))


ANIMATED = [name for name in COURSE.names if COURSE[name].is_animated]


def offers_motion(html):
    return '<button name="go" value="motion"' in html


@pytest.mark.slow
@pytest.mark.parametrize("name", ANIMATED)
def test_a_page_offers_its_motion_or_says_after_which_answers_it_comes(class_of_three, name):
    zoe = Practising(class_of_three, class_of_three.browser(ZOE), name)
    told, piece = set(shown_by_motion(zoe.variant)), {"HX-Request": "true"}
    (moves,) = re.findall(r'<div id="moves".*?</div>', zoe.page(), re.DOTALL)
    named = set(re.findall(rf'href="#below-{BOX}(\w+)"', moves))
    assert offers_motion(moves) == (not told)
    assert named == told or (COURSE[name].film is not None and "every question" in moves)
    if told:
        assert "data-track" not in zoe.browser.get(f"{zoe.address}/motion", headers=piece).text
    typed = {BOX + p.id: right_answer(zoe.variant, p) for p in zoe.variant.parts if p.id in told}
    data = {"versions": "{}", "_seal": zoe.seal, "check": "", **typed}
    checked = zoe.browser.post(zoe.address, data=data, headers=piece).text
    assert offers_motion(checked) == bool(told)  # a script puts it in place of what said that it waits
    assert offers_motion(zoe.page())
    moving = zoe.browser.get(f"{zoe.address}/motion", headers=piece).text
    assert "data-track" in moving
    assert 'id="motion-data"' in moving


@pytest.mark.e2e
def test_a_motion_that_is_itself_an_answer_comes_after_it(class_of_three):
    zoe = Practising(class_of_three, class_of_three.browser(ZOE), "coupler_curve")
    place, (part,) = f"{zoe.address}/motion", [p for p in zoe.variant.parts if p.id == "curve"]
    assert "data-track" not in zoe.browser.get(place).text
    zoe.send({part.id: right_answer(zoe.variant, part)}, check=part.id)
    assert "data-track" in zoe.browser.get(place).text
    given_up = Practising(class_of_three, class_of_three.browser(MAX), "coupler_curve")
    given_up.send({}, reveal="curve")
    assert "data-track" in given_up.browser.get(f"{given_up.address}/motion").text


def test_predictions_stand_beside_what_came_out(zoe):
    found = re.search(r'<select name="predict-(\w+)">', zoe.page())[1]
    zoe.send({}, **{f"predict-{found}": "+", "predict": "1"})
    part = next(p for p in zoe.variant.parts if p.id == found)
    page = zoe.send({found: right_answer(zoe.variant, part)}, check=found).text
    assert "You said" in zoe.told(page, found)


# --------------------------------------------------------------------------- drafts


def test_two_pages_never_overwrite_one_another_unseen(zoe):
    """Two pages were opened before anything was typed; the second one to write is told what the first
    wrote."""
    draft = f"{zoe.address}/draft"

    def kept(text, over):
        data = {"_seal": zoe.seal, "text.rA": text, "over.rA": str(over)}
        return zoe.browser.post(draft, data=data).json()

    assert kept("1", 0) == {"versions": {"rA": 1}, "others": {}}
    assert kept("2", 0)["others"] == {"rA": {"text": "1", "version": 1}}
    assert zoe.box(zoe.page(), "rA") == "1"
    assert kept("2", 1) == {"versions": {"rA": 2}, "others": {}}
    data = {"_seal": zoe.seal, "versions": "{}", BOX + "rA": "3", "check": "rA"}
    page = zoe.browser.post(zoe.address, data=data).text
    assert "Another page wrote “2” here in the meantime" in words_of(page)
    assert zoe.box(page, "rA") == "3"


def test_drafts_are_those_of_one_person(zoe):
    zoe.send({"rA": "777.30777"}, hint="rA")
    other = zoe.class_.browser(MAX)
    assert "777.30777" not in other.get(zoe.address).text


@each_row("below", ["", "/draft", "/read", "/solution", "/motion"])
def test_nobody_practises_without_a_name(zoe, below):
    stranger = zoe.class_.browser()
    assert stranger.get(zoe.address + below).status_code == 303
    assert stranger.post(zoe.address + below, data={"_seal": stranger.seal}).status_code in (401, 405)
    assert zoe.browser.post(zoe.address + below, data={}).status_code in (403, 405)


# ------------------------------------------------------------------------- progress


def test_progress_goes_to_notebooks_and_comes_back(zoe):
    zoe.send({"rA": "100"}, check="rA")
    zoe.send({"rA": right_answer(zoe.variant, zoe.variant.parts[0])}, check="rA")
    text = zoe.browser.get("/progress/progress.json").text
    files = {"file": ("progress.json", text)}
    other = zoe.class_.browser(MAX)
    page = other.post("/progress", data={"_seal": other.seal}, files=files).text
    assert "New entries: 2." in page
    assert "New entries: 0." in other.post("/progress", data={"_seal": other.seal}, files=files).text
    assert entries(zoe.class_, MAX) == entries(zoe.class_)
    assert "1 of 1 right; comes again on 2026-11-24" in words_of(page)


def test_an_upload_is_no_oracle(zoe):
    """Unmarked answers to any variant may be brought; none comes back with a verdict."""
    one = {
        "at": "2026-01-01T00:00:00Z",
        "exercise": EXERCISE,
        "seed": 5,
        "part": "rA",
        "what": "answer",
        "answer": "1",
    }
    text = json.dumps({"format": "coursework progress", "version": 1, "entries": [one]})
    zoe.browser.post("/progress", data={"_seal": zoe.seal}, files={"file": ("progress.json", text)})
    assert entries(zoe.class_) == [one]


@each_row(
    "text",
    ["", "{}", "[1, 2]", "\x00", '{"format": "coursework progress", "version": 1, "entries": [{"at": NaN}]}'],
)
def test_a_file_that_is_no_progress_is_told_in_a_sentence(zoe, text):
    reply = zoe.browser.post("/progress", data={"_seal": zoe.seal}, files={"file": ("x.json", text)})
    assert (reply.status_code, "x.json contains no progress" in reply.text) == (422, True)
