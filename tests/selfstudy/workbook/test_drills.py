"""Drills of a lesson: each can be worked out again from what it gives, in three grades, and nothing of a
class is in it."""

from __future__ import annotations

import cmath
import math
from collections import Counter

import pytest
from pdf_text import page_texts

import coursework
from coursework.errors import BadCourse
from coursework.rendering.renderer import renderer_of
from coursework.selfstudy.workbook.binding import bound
from coursework.selfstudy.workbook.drills import GRADES, drills_of, judgements_of
from coursework.sheets.book import LessonText


def turned(r, theta):
    """Return a vector of the plane; the angle is in degrees."""
    return cmath.rect(r, math.radians(theta))


def omega3_of_coupler(v):
    """Return the coupler's rate: the velocity of B is perpendicular to CB."""
    arm = turned(v["r2"], v["theta2"]) + turned(v["r3"], v["theta3"]) - v["r1"]
    along_a = 1j * v["omega2"] * turned(v["r2"], v["theta2"])
    along_ba = 1j * turned(v["r3"], v["theta3"])
    return -(along_a * arm.conjugate()).real / (along_ba * arm.conjugate()).real


def test_drills_are_answered_from_what_they_give(course):
    """By another way than the solution's: a vector equation in place of its closed form."""
    drills = drills_of(course, ("coupler_curve",), 5, "en", 0)
    assert len(drills) == sum(GRADES)
    assert [drill.number for drill in drills] == [f"5.{k}" for k in range(1, 11)]
    assert [drill.grade for drill in drills] == sorted(drill.grade for drill in drills)
    checked = 0
    for drill in drills:
        v = {**drill.values, drill.quantity: drill.result}
        if {"omega3", "r1"} <= {*v}:
            assert v["omega3"] == pytest.approx(omega3_of_coupler(v), rel=1e-3)
            checked += 1
        elif "theta3" in v and (name := next((n for n in ("xP", "yP") if n in v), None)):
            P = turned(v["r2"], v["theta2"]) + turned(v["AP"], v["theta3"] + v["beta"])
            assert v[name] == pytest.approx(P.real if name == "xP" else P.imag, rel=1e-3)
            checked += 1
    assert checked >= 7


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1])
def test_no_lesson_asks_one_formula_more_than_twice_nor_what_it_tells(course, seed):
    for number, section in enumerate(
        (section for chapter in course.folder.chapters for section in chapter.sections), 1
    ):
        drills = drills_of(course, section.exercises, number, "fr", seed)
        kinds = Counter(kind for drill in drills for kind in drill.kinds)
        # From a quantity back to a datum once: the words that a drill asks end with whether it goes back.
        most = {kind: 1 if kind.endswith("True") else 2 for kind in kinds}
        assert not [kind for kind, times in kinds.items() if times > most[kind]], section.lesson
        told = {(d.exercise, d.seed, name) for d in drills for name in d.values if d.quantity != name}
        drawn = {(d.exercise, d.seed): {*course[d.exercise].variant(d.seed).used} for d in drills}
        found = {(d.exercise, d.seed, d.quantity) for d in drills}
        assert not [one for one in told & found if one[2] not in drawn[one[:2]]], section.lesson
        numbers = [d for d in drills if not isinstance(d.result, str)]
        assert not [d.text for d in numbers if d.result in d.values.values()], section.lesson


def test_another_book_has_other_drills_and_both_languages_have_the_same(course):
    first, again = (drills_of(course, ("grashof",), 3, "en", 0) for _ in range(2))
    other, french = drills_of(course, ("grashof",), 3, "en", 1), drills_of(course, ("grashof",), 3, "fr", 0)
    assert first == again
    assert {drill.text for drill in first}.isdisjoint(drill.text for drill in other)
    assert [drill.values for drill in first] == [drill.values for drill in french]
    assert all(drill.seed >= 700_000 for drill in first)


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
