"""Lessons of the site: rendered once for each language, in a process of their own, since their cells run
code; and which section helps with what."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from coursework.course.lessons import Lesson, lesson_sections, lesson_title, practised, taught_by
from coursework.errors import BadCourse, CourseworkError
from coursework.markup.links import TextLink
from coursework.rendering.html import environment_of
from coursework.rendering.lesson_steps import SteppedLesson, stepped
from coursework.selfstudy.workbook.lessons import explained_mistakes, lesson_text
from coursework.selfstudy.worked import WorkedExample, worked
from coursework.site.frame.budgets import MEGABYTE
from coursework.system.processes import Exceeded, ResourceLimits, confined

if TYPE_CHECKING:
    from coursework.course.course import Course
    from coursework.sheets.book import BlanksPiece
    from coursework.site.frame.settings import Site

WHOLE = "whole"  #: in the address of a lesson that comes with all its steps
_LIMITS = ResourceLimits(60.0, 1536 * MEGABYTE, niceness=0)  #: of the process that runs a lesson's cells


class LessonLink(NamedTuple):
    """Link to a lesson or to a section of one."""

    address: str
    title: str  #: Markdown
    number: str = ""  #: of a section; empty for a lesson


def lesson_lang(site: Site, name: str, lang: str) -> str:
    """Return the language in which a lesson is shown: the wanted one if it is written in it."""
    folder = site.course.folder
    written = [
        each for each in (lang, *site.languages) if (folder.lesson_place / f"{name}.{each}.md").exists()
    ]
    return written[0] if written else lang


def lesson_of(site: Site, name: str, lang: str) -> SteppedLesson:
    """Return a lesson in steps, rendered at the first request for it in a process.

    Raises
    ------
    BadCourse
        It cannot be read, drawn or run.
    """
    key = "lesson", name, lang
    rendered = site.ahead(key, partial(_rendered, site.course, name, lang))
    try:
        lesson: SteppedLesson = rendered.result()
    except CourseworkError:
        site.cache.drop(("ahead", key))  # it may succeed another time
        raise
    return lesson


def _rendered(course: Course[Any], name: str, lang: str) -> SteppedLesson:
    try:
        lesson: SteppedLesson = confined(_LIMITS, render_lesson, course, name, lang)
    except Exceeded as fault:
        raise BadCourse(f"the lesson {name} takes more {fault.resource} than it may") from fault
    return lesson


def render_lesson(course: Course[Any], name: str, lang: str) -> SteppedLesson:
    """Return a lesson in steps; its cells are run in this process."""
    folder = course.folder
    text = lesson_text(course, name, lang)
    return stepped(environment_of(folder.template_folders, lang), text, _address, f"/lessons/{name}/figures")


def _address(link: TextLink) -> str:
    if link.kind == "exercise":
        return f"/practice/{link.name}"
    return lesson_address(link.name, link.anchor)


def lesson_address(name: str, anchor: str = "") -> str:
    """Return the address of a lesson, or of a section or figure in it, which without a script only the whole
    lesson has."""
    return f"/lessons/{name}?{WHOLE}#{anchor}" if anchor else f"/lessons/{name}"


def example_of(site: Site, blanks: BlanksPiece, lang: str) -> WorkedExample:
    """Return the worked example of some blanks, from a cache."""
    made = partial(worked, site.course, blanks.exercise, blanks.seed, lang, blanks.level, blanks.parts)
    key = "example", blanks.exercise, blanks.seed, blanks.level, blanks.parts, lang
    example: WorkedExample = site.cache.get(key, made)
    return example


def lessons_for(site: Site, exercise: str, lang: str) -> tuple[Lesson, ...]:
    """Return the lessons that teach an exercise, from a cache."""
    lessons: tuple[Lesson, ...] = site.cache.get(
        ("lessons", exercise, lang), lambda: taught_by(site.course.folder, exercise, lang)
    )
    return lessons


def section_links(lesson: Lesson) -> tuple[LessonLink, ...]:
    """Return the links to the sections of a lesson that teach an exercise; to the lesson where the whole of
    it does."""
    sections = tuple(
        LessonLink(lesson_address(lesson.name, f"section-{number}"), title, number)
        for number, title in lesson.places
    )
    return sections or (LessonLink(lesson_address(lesson.name), lesson.title),)


def linked_lessons(site: Site, exercise: str, lang: str) -> list[tuple[Lesson, tuple[LessonLink, ...]]]:
    """Return the lessons that teach an exercise, each with the links to its sections."""
    return [(lesson, section_links(lesson)) for lesson in lessons_for(site, exercise, lang)]


def help_with_mistake(site: Site, exercise: str, mistake: str, lang: str) -> LessonLink | None:
    """Return the link to the section of a lesson that explains a named mistake; None where none does."""
    sections: Mapping[tuple[str, str], tuple[str, int]] = site.cache.get(
        ("explained mistakes", lang), lambda: explained_mistakes(site.course, lang)
    )
    if (exercise, mistake) not in sections:
        return None
    name, number = sections[exercise, mistake]
    folder = site.course.folder
    heading = lesson_sections(folder, name, lang).get(number, "").partition(". ")[2]
    title = heading or lesson_title(folder, name, lang)
    return LessonLink(
        lesson_address(name, f"section-{number}" if number else ""), title, str(number) if heading else ""
    )


def exercises_of(site: Site, name: str, lang: str) -> tuple[str, ...]:
    """Return the exercises of a lesson in the order of study, from a cache."""
    names: tuple[str, ...] = site.cache.get(
        ("practised", name, lang), lambda: practised(site.course.folder, name, lang)
    )
    return names
