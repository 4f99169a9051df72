"""Drills of a lesson: each can be worked out again from what it gives, in three grades, and nothing of a
class is in it."""

from __future__ import annotations

import cmath
import math
import re
from collections import Counter

import pytest
from pdf_text import page_texts

import coursework
from coursework.course.lessons import taught_by
from coursework.errors import BadCourse
from coursework.rendering.renderer import renderer_of
from coursework.selfstudy.workbook.binding import bound
from coursework.selfstudy.workbook.drills import MOST, drills_of, judgements_of
from coursework.sheets.book import LessonText


def turned(r, theta):
    """Return a vector of the plane; the angle is in degrees."""
    return r * cmath.rect(1, math.radians(theta))


def drilled(course, name, number=5, lang="en", seed=0):
    """Return the groups of drills of a lesson, and its drills."""
    groups = drills_of(course, LessonText(name, number, lang, "", (), ()), seed)
    return groups, [drill for group in groups for drill in group.drills]


def test_drills_are_answered_from_what_they_give(course):
    """By another way than the solution's: a vector equation in place of its closed form."""
    groups, drills = drilled(course, "velocities")
    assert len(drills) <= MOST
    assert [drill.number for drill in drills] == [f"5.{k}" for k in range(1, len(drills) + 1)]
    for group in groups:
        assert [drill.grade for drill in group.drills] == sorted(drill.grade for drill in group.drills)
    checked = 0
    for drill in drills:
        v = {**drill.values, drill.quantity: drill.result}
        if drill.exercise == "coupler_curve" and {"v_P", "v_P_x"} <= {*v}:
            assert v["v_P"] == pytest.approx(abs(complex(v["v_P_x"], v["v_P_y"])), rel=1e-3)
        elif drill.exercise == "four_bar_motion" and {"omega2", "omega3", "theta4"} <= {*v}:
            # B moves across CB: along CB the velocities of A and of B about A cancel.
            along = (v[f"r{k}"] * v[f"omega{k}"] * turned(1j, v[f"theta{k}"] - v["theta4"]) for k in (2, 3))
            assert sum(along).real == pytest.approx(0, abs=1e-3 * abs(v["r2"] * v["omega2"]))
        elif drill.exercise == "slotted_mechanism" and {"rA_dot", "omega2", "theta4"} <= {*v}:
            of_the_pin = 1j * v["omega2"] * turned(v["r2"], v["theta2"] - v["theta4"])
            assert v["rA_dot"] == pytest.approx(of_the_pin.real, rel=1e-3)
        else:
            continue
        checked += 1
    assert checked >= 5


def test_a_drill_has_the_grade_that_is_stated(course):
    """A sum has one dot, also backwards; a case or an angle to choose two at least; backwards one more."""
    _, drills = drilled(course, "grashof_and_coupler_curves")
    sums = {drill.number for drill in drills if "sum $" in drill.text}
    assert {drill.number for drill in drills if drill.grade == 1} == sums
    assert any("what is" in drill.text for drill in drills if drill.number in sums)
    _, drills = drilled(course, "velocities")
    of_a_bar = [drill for drill in drills if "$v_{BA}$" in drill.text]
    assert {(drill.asked.rpartition(" ")[2], drill.grade) for drill in of_a_bar} >= {
        ("False", 1),
        ("True", 2),
    }
    assert all(drill.grade >= 2 for drill in drills if drill.quantity in ("theta3", "theta4"))


def test_every_drill_stands_under_a_section_that_teaches_it_and_says_what_it_is_of(course):
    """Over all exercises: the words that precede their drills are there in every language, and name every
    section by its number in the lesson."""
    stated = course.folder.book_table("drills")
    alone = {"vocabulary", "havens_construction"}  # whose questions need no words, or are none
    assert [
        name for name in stated if name not in alone and not {*course.folder.languages} <= {*stated[name]}
    ] == []
    groups, _ = drilled(course, "accelerations", 7)
    taught = {
        heading
        for name in course.folder.names
        for lesson in taught_by(course.folder, name, "en")
        if lesson.name == "accelerations"
        for heading in lesson.sections
    }
    assert {group.section for group in groups} <= taught
    assert all(group.setting for group in groups if group.exercise not in alone and groups.index(group) == 0)
    placed = {
        (group.exercise, drill.asked.split()[1]): int(group.section.partition(".")[0])
        for group in groups
        for drill in group.drills
    }
    assert ("coriolis", "relative_motion") not in placed
    wanted = {place: stated[place[0]].get("sections", {}).get(place[1], placed[place]) for place in placed}
    assert placed == wanted
    assert placed["coriolis", "direction"] == 7


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1])
def test_no_lesson_asks_one_formula_more_than_twice_nor_what_it_tells(course, seed):
    for number, name in enumerate(course.folder.lessons, 1):
        groups, drills = drilled(course, name, number, "fr", seed)
        bare = {group.exercise for group in groups if not group.setting}
        assert bare - {group.exercise for group in groups if group.setting} <= {"vocabulary"}, name
        kinds = Counter(kind for drill in drills for kind in drill.kinds)
        # From a quantity back once: the words that a drill asks end with whether it goes back.
        most = {kind: 1 if kind.endswith("True") else 2 for kind in kinds}
        assert not [kind for kind, times in kinds.items() if times > most[kind]], name
        told = {(d.exercise, d.seed, one) for d in drills for one in d.values if d.quantity != one}
        drawn = {(d.exercise, d.seed): {*course[d.exercise].variant(d.seed).used} for d in drills}
        found = {(d.exercise, d.seed, d.quantity) for d in drills}
        assert not [one for one in told & found if one[2] not in drawn[one[:2]]], name
        numbers = [d for d in drills if not isinstance(d.result, str)]
        assert not [d.text for d in numbers if d.result in d.values.values()], name


def test_another_book_has_other_drills_and_both_languages_have_the_same(course):
    name = "grashof_and_coupler_curves"
    (_, first), (_, again), (_, other) = (drilled(course, name, 3, "en", seed) for seed in (0, 0, 1))
    _, french = drilled(course, name, 3, "fr")
    assert first == again
    numbers = {drill.text for drill in first if drill.values}
    assert numbers.isdisjoint(drill.text for drill in other)
    assert [drill.values for drill in first] == [drill.values for drill in french]
    both = [drilled(course, "instant_centres_and_centrodes", 6, lang)[1] for lang in ("en", "fr")]
    assert len({tuple((drill.asked, drill.grade, drill.seed) for drill in drills) for drills in both}) == 1
    assert all(drill.seed >= 700_000 for drill in first)


@pytest.mark.parametrize(
    ("stated", "told"),
    [
        ("[crank_pim]\n", "names no exercise 'crank_pim'; did you mean 'crank_pin'"),
        ("[crank_pin.sections]\nxA = 1\n", "crank_pin has no question 'xA'"),
        ("[crank_pin.sections]\nx = 3\n", "crank_pin: x: no section 3 of the lesson rods teaches it"),
    ],
)
def test_a_table_of_drills_that_names_what_is_not_there_is_refused(small, stated, told):
    (small / "exercises/book/drills.toml").write_text(stated, "utf-8")
    with pytest.raises(BadCourse, match=re.escape(told)):
        drilled(coursework.open_course(small), "rods")


def test_every_lesson_has_sentences_to_judge_in_every_language(course):
    told = {
        lang: [
            [one.is_true for one in judgements_of(course.folder, LessonText(name, 1, lang, "", (), ()))]
            for name in course.folder.lessons
        ]
        for lang in course.folder.languages
    }
    assert told["en"] == told["fr"]
    assert all(set(truths) == {True, False} for truths in told["en"])


@pytest.fixture
def small(small_course):
    settings = small_course / "exercises/course.toml"
    chapters = (
        '\n[[chapters]]\ntitle = { en = "Pins" }\n[[chapters.sections]]\nlesson = "rods"\nexercises = '
        '["crank_pin"]\n'
    )
    settings.write_text(settings.read_text("utf-8") + chapters, "utf-8")
    (small_course / "exercises/lessons").mkdir()
    (small_course / "exercises/lessons/rods.en.md").write_text("# Rods\n\n## 1. One\n\nA rod.\n", "utf-8")
    (small_course / "exercises/book").mkdir()
    sentence = '{ en = "Rods bend.", is_true = false, why = { en = "They are rigid." } }'
    second = '{ en = "Pins turn.", is_true = true, why = { en = "They are round." } }'
    (small_course / "exercises/book/true_or_false.toml").write_text(
        f"[rods]\nsentences = [{sentence}, {second}]\n", "utf-8"
    )
    return small_course


def test_a_students_volume_has_odd_answers_and_the_teachers_all(small):
    course = coursework.open_course(small)
    renderer = renderer_of(course.folder)
    book = bound(course, "en", solved=False, answers="odd")
    assert book.sections[0].drills
    told, teacher = (
        "".join("".join(page_texts(renderer.book_pdf(book, apart=apart))).split()) for apart in (False, True)
    )
    assert "Answerstooddnumbers" in told
    assert "Theyarerigid." in told
    assert "Theyareround." not in told
    assert "Theyareround." in teacher
    (chapter,) = book.chapters
    assert [one.handout.seed % 1_000 for one in chapter.paper] == [500]
    assert chapter.paper_minutes % 30 == 0
    assert "Examinationpaper,chapter1" in told
    assert "Examinationpaper,chapter1,1." in teacher
    without = "".join("".join(page_texts(renderer.book_pdf(bound(course, "en", solved=False)))).split())
    assert "Theyarerigid." not in without


def test_the_pages_have_the_papers_the_references_of_the_index_and_its_machines(small):
    (small / "exercises/book/glossary.toml").write_text(
        'terms = [{ en = "rod" }]\nsee = [{ en = ["bar", "rod"] }, { en = ["beam", "lost"] }]\n', "utf-8"
    )
    (small / "exercises/book/machines.toml").write_text(
        'machines = [{ en = "pump", exercises = ["crank_pin"] }, { en = "lathe" }]\n', "utf-8"
    )
    course = coursework.open_course(small)
    pages = renderer_of(course.folder).book_pages(bound(course, "en"))
    assert 'href="paper-1.html"' in pages["index.html"]()
    paper, solution = pages["paper-1.html"](), pages["solutions/paper-1.html"]()
    assert paper.count('name="e1-') == len(course["crank_pin"].variant(1).parts)
    assert 'href="solutions/paper-1.html"' in paper
    assert 'href="../paper-1.html"' in solution
    listed = pages["terms.html"]()
    assert '<li id="term-bar">bar: <a href="#term-rod"><em>see rod</em></a></li>' in listed
    assert '<li id="term-pump">pump: exercises <a href="crank_pin.html">1.1</a></li>' in listed
    assert "beam" not in listed
    assert "lathe" not in listed


def test_a_sentence_without_a_reason_is_told(small):
    (small / "exercises/book/true_or_false.toml").write_text(
        '[rods]\nsentences = [{ en = "Rods bend.", is_true = false }]\n', "utf-8"
    )
    folder = coursework.open_course(small).folder
    with pytest.raises(BadCourse, match=r"true_or_false\.toml: rods: a sentence has no 'why'"):
        judgements_of(folder, LessonText("rods", 1, "en", "", (), ()))


def test_a_lesson_without_exercises_has_no_drills_in_its_heading(small):
    settings = small / "exercises/course.toml"
    settings.write_text(settings.read_text("utf-8").replace('exercises = ["crank_pin"]\n', ""), "utf-8")
    course = coursework.open_course(small)
    renderer = renderer_of(course.folder)
    book = bound(course, "en", answers="odd")
    assert "<h2>True or false, lesson 1</h2>" in renderer.book_pages(book)["rods.html"]()
    assert "Drills, lesson" not in "".join(page_texts(renderer.book_pdf(book)))


@pytest.mark.parametrize(("also", "paper"), [("", ["crank_pin"]), ("\nappendix = true", [])])
def test_a_chapter_without_exercises_has_a_paper_of_those_that_its_lessons_name(small, also, paper):
    settings, lesson = small / "exercises/course.toml", small / "exercises/lessons/rods.en.md"
    bare = settings.read_text("utf-8").replace('exercises = ["crank_pin"]\n', "")
    settings.write_text(bare.replace('{ en = "Pins" }', '{ en = "Pins" }' + also), "utf-8")
    lesson.write_text("# Rods\n\n## 1. One\n\nA rod. See [the pin](exercise:crank_pin).\n", "utf-8")
    own, others = bound(coursework.open_course(small), "en").chapters
    assert [one.handout.exercise for one in own.paper] == paper
    assert [one.handout.exercise for one in others.paper] == ["crank_pin"]
