"""The chapters of a course: their order, what is needed first, and what is said of a wrong statement."""

from __future__ import annotations

import json
import tomllib

import pytest
from tables import each_row

import coursework
from coursework.cli import run
from coursework.course.chapters import chapters, sections
from coursework.errors import BadCourse
from coursework.language.words import languages

COURSE = coursework.open_course()
EXERCISES, LESSONS = ("one", "two", "three"), ("rods", "slides")

STATED = """
[[chapters]]
title = { en = "First", fr = "Premier" }

[[chapters.sections]]
lesson = "rods"
exercises = ["one", { name = "two", needs = ["one"] }]

[[chapters]]
title = { en = "Second" }

[[chapters.sections]]
lesson = "slides"
needs = ["rods", "two"]
exercises = ["three"]
"""


def read(text: str):
    return chapters(tomllib.loads(text)["chapters"], (*EXERCISES, "slides"), LESSONS, "course.toml")


def test_chapters_are_read_in_their_order():
    first, second = read(STATED)
    assert (first.number, first.title("fr"), second.title("fr")) == (1, "Premier", "Second")
    assert first.lessons == ("rods",)
    assert first.exercises + second.exercises == EXERCISES
    own, other = sections((first, second))
    assert own.needed("two") == ("rods", "one")
    assert other.needed("three") == ("slides",)
    assert other.needs["slides"] == ("rods", "two")


def test_appendices_have_letters_of_their_own_beyond_the_alphabet():
    stated = '[[chapters]]\ntitle = { en = "A" }\nappendix = true\n' * 54
    labels = [chapter.label for chapter in read(stated)]
    assert (labels[0], *labels[25:28], labels[53]) == ("A", "Z", "AA", "AB", "BB")
    assert len(set(labels)) == 54


@each_row(
    ("was", "now", "told"),
    [
        ('"three"', '"tree"', "chapter 2: no exercise 'tree'; did you mean 'three'"),
        ('lesson = "slides"', 'lesson = "slide"', "no lesson 'slide'; did you mean 'slides'"),
        ('needs = ["one"]', 'needs = ["three"]', "two needs 'three' first, which comes later"),
        ('needs = ["one"]', 'needs = ["on"]', "two needs 'on', which no chapter has; did you mean 'one'"),
        ('needs = ["one"]', 'needs = ["two"]', "two needs itself first"),
        ('["three"]', '["three", "one"]', "'one' stands twice"),
        (
            'lesson = "rods"',
            'lesson = "rods"\ntitle = { en = "Rods" }',
            "section 1 has a lesson, whose title it bears",
        ),
        ('["three"]', '["slides"]', "a lesson and an exercise are called 'slides'"),
        ("lesson = ", "lessons = ", "no setting 'lessons'; did you mean 'lesson'"),
        ('title = { en = "Second" }', "", "chapter 2 has no title"),
        ('title = { en = "Second" }', 'title = "Second"', "write title = "),
        ('["three"]', '"three"', "write a list"),
        ('{ name = "two", needs = ["one"] }', "3", "an exercise is"),
        ('{ name = "two", needs = ["one"] }', '{ named = "two" }', "an exercise is"),
    ],
)
def test_what_is_wrong_is_said_with_its_place(was, now, told):
    assert was in STATED
    with pytest.raises(BadCourse, match=r"course\.toml: ") as caught:
        read(STATED.replace(was, now))
    assert told in str(caught.value)


@each_row("stated", [3, [3], {"title": "x"}])
def test_chapters_of_another_form_are_refused(stated):
    with pytest.raises(BadCourse, match=r"\[\[chapters\]\]"):
        chapters(stated, (*EXERCISES, "slides"), LESSONS, "course.toml")


def test_the_built_in_course_places_everything_once():
    placed = [name for section in sections(COURSE.folder.chapters) for name in section.names]
    assert sorted(placed) == sorted([*COURSE.names, *COURSE.folder.lessons])
    assert COURSE.folder.in_order == COURSE.folder.study_order
    for chapter in COURSE.folder.chapters:
        assert set(chapter.titles) == set(languages())


def test_every_section_of_the_built_in_course_has_a_lesson():
    assert all(section.lesson for section in sections(COURSE.folder.chapters))


def test_a_course_without_chapters_has_the_order_of_the_alphabet(small_course, capsys):
    folder = coursework.open_course(small_course).folder
    assert folder.chapters == ()
    assert folder.in_order == folder.names
    assert run(["--course", str(small_course), "list", "--json"]) == 0
    (row,) = json.loads(capsys.readouterr().out)
    assert (row["chapter"], row["lesson"], row["needs"]) == (None, "", [])


def test_what_stands_in_no_chapter_comes_last(small_course):
    settings = small_course / "exercises/course.toml"
    settings.write_text(settings.read_text("utf-8") + '\n[[chapters]]\ntitle = { en = "First" }\n', "utf-8")
    assert coursework.open_course(small_course).folder.in_order == ("crank_pin",)
    assert run(["--course", str(small_course), "list"]) == 0
