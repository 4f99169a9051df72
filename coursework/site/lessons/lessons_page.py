"""Lessons: a page for each, in steps, whose worked examples have blanks that are marked."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from hashlib import sha256
from itertools import pairwise
from typing import Any, NamedTuple

from markupsafe import Markup
from starlette.responses import HTMLResponse, Response

from coursework.database.permissions import Permission
from coursework.markup import markdown
from coursework.rendering.lesson_steps import SteppedLesson
from coursework.selfstudy.progress import is_blank
from coursework.selfstudy.worked import BlankMark
from coursework.sheets.book import BlanksPiece
from coursework.site.frame.budgets import BOXES
from coursework.site.frame.drafts import LONGEST
from coursework.site.frame.requests import HTTPException, Request, Route
from coursework.site.frame.responses import opens_offline, redirect
from coursework.site.lessons.lesson_content import (
    WHOLE,
    example_of,
    exercises_of,
    lesson_address,
    lesson_lang,
    lesson_of,
)
from coursework.site.lessons.places import boxes_of, keep_blanks, keep_place, kept_blanks, places
from coursework.site.practice.contents import exercise_title, titles

_BOX = "blank-"  #: before the names of the boxes of blanks
_PART = 80_000  #: letters of HTML after which the steps go on in another file: about 12 kB on the line
_KEPT = f"private, max-age={365 * 24 * 3600}, immutable"


class LessonExercise(NamedTuple):
    """Exercise at the end of a lesson."""

    name: str
    title: str


class CheckedBlank(NamedTuple):
    """Mark of a blank, with the number of its question."""

    number: int
    mark: BlankMark
    html: Markup


class CheckedExample(NamedTuple):
    """Blanks of an example as they were checked last: the texts by field, and the marks of those that are not
    blank."""

    texts: Mapping[str, str]
    marks: tuple[CheckedBlank, ...]

    @property
    def is_complete(self) -> bool:
        return len(self.marks) == len(self.texts) and all(one.mark.is_right for one in self.marks)


def lesson(request: Request) -> Response:
    """Return the page of a lesson, whose steps are files that browsers keep unless all are asked for; a form
    checks the blanks of one of its examples, or keeps the place of its reader."""
    name = _name(request)
    if request.is_post and "place" in request.form.texts:
        return keep_place(request, name)
    lang = lesson_lang(request.site, name, request.lang)
    opened = lesson_of(request.site, name, lang)
    if request.is_post:
        number, blanks = _example(request, opened)
        texts = {key: _typed(request, key) for _, key, _ in blanks.questions}
        keep_blanks(request, name, blanks, texts)
        if request.is_fragment:
            return request.render(
                "site/student/_lesson_checked", checked=_checked(request, lang, blanks, texts)
            )
        return redirect(f"{lesson_address(name)}?{WHOLE}&example={number}#blanks-{number}")
    folder = request.site.course.folder
    order = folder.lessons
    after = order[order.index(name) + 1] if name != order[-1] else ""
    page = request.render(
        "site/student/lesson",
        lesson=opened,
        name=name,
        lesson_lang=lang,
        address=lesson_address(name),
        steps_files=() if WHOLE in request.query_params else _steps_files(request, name),
        place=places(request).get(name, ""),
        number=1 + order.index(name),
        chapter=next((c for c in titles(request.site, request.lang) if _has(c, name)), None),
        exercises=_exercises(request, name),
        after=_after(request, after),
        box=_BOX,
        checked=_checked_before(request, name, lang, opened),
    )
    return opens_offline(page)


def _has(chapter: Any, lesson_name: str) -> bool:
    return any(group.lesson == lesson_name for group in chapter.groups)


def _name(request: Request) -> str:
    """Return the name of the lesson of the address. Raises HTTPException: there is none."""
    name = str(request.path_params["lesson"])
    if name not in request.site.course.folder.lessons:
        raise HTTPException("page", 404)
    return name


def _exercises(request: Request, name: str) -> list[LessonExercise]:
    lang = lesson_lang(request.site, name, request.lang)
    course = request.site.course
    return [
        LessonExercise(each, exercise_title(course[each], request.lang))
        for each in exercises_of(request.site, name, lang)
    ]


def _after(request: Request, name: str) -> tuple[str, str] | None:
    """Return the address and the title of the next lesson; None after the last."""
    groups = (group for chapter in titles(request.site, request.lang) for group in chapter.groups)
    title = next((group.title for group in groups if group.lesson == name), name)
    return (lesson_address(name), title) if name else None


# --------------------------------------------------------------------- steps


def _parts(request: Request, name: str, lang: str) -> list[str]:
    """Return the steps of a lesson for readers of a language, in parts. They are the same for everybody: the
    page has the CSRF token."""
    opened = lesson_of(request.site, name, lesson_lang(request.site, name, lang))
    begins, size = [0], 0
    for number, step in enumerate(opened.steps):
        if size > _PART:
            begins.append(number)
            size = 0
        size += len(step.html) + len(step.below)
    ranges = pairwise([*begins, len(opened.steps)])
    return [_steps_html(request, name, lang, opened, *these) for these in ranges]


def _steps_html(request: Request, name: str, lang: str, opened: SteppedLesson, first: int, end: int) -> str:
    names = {
        "lesson": opened,
        "address": lesson_address(name),
        "box": _BOX,
        "first": first,
        "end": end,
        "checked": {},
        "csrf_token": "",
    }
    return request.site.pages.page("site/student/_lesson_steps", lang, names)


def _digests(request: Request, name: str, lang: str) -> list[str]:
    def made() -> list[str]:
        return [sha256(part.encode()).hexdigest()[:16] for part in _parts(request, name, lang)]

    digests: list[str] = request.site.cache.get(("steps", name, lang), made)
    return digests


def _steps_files(request: Request, name: str) -> list[str]:
    return [f"{lesson_address(name)}/steps/{digest}" for digest in _digests(request, name, request.lang)]


def steps(request: Request) -> Response:
    """Return a part of the steps of a lesson; the address changes with them."""
    name, wanted = _name(request), str(request.path_params["steps"])
    for lang in dict.fromkeys((request.lang, *request.site.languages)):
        if wanted in (digests := _digests(request, name, lang)):
            part = _parts(request, name, lang)[digests.index(wanted)]
            return HTMLResponse(part, headers={"cache-control": _KEPT})
    raise HTTPException("page", 404)


# -------------------------------------------------------------------- blanks


def _example(request: Request, opened: SteppedLesson) -> tuple[int, BlanksPiece]:
    """Return the blanks that a form fills in, with the number of their step. Raises HTTPException: the step
    has no blanks: nothing but the lesson says which variant is marked."""
    stated = request.form.text("example")
    number = int(stated) if stated.isdecimal() and len(stated) < 6 else 0
    blanks = opened.steps[number - 1].blanks if 0 < number <= len(opened.steps) else None
    if blanks is None:
        raise HTTPException("bad_request", 400)
    return number, blanks


def _typed(request: Request, key: str) -> str:
    return ", ".join(request.form.texts.get(f"{_BOX}{key}", ()))[:LONGEST]


def _checked(request: Request, lang: str, blanks: BlanksPiece, texts: Mapping[str, str]) -> CheckedExample:
    """Return the marks of texts in the blanks of an example, from a cache."""

    def marked() -> Iterator[CheckedBlank]:
        example = example_of(request.site, blanks, lang)
        marks = example.marks({key: text for key, text in texts.items() if not is_blank(text)})
        for place, key, _ in blanks.questions:
            if key in marks:
                yield CheckedBlank(place, marks[key], Markup(markdown.html_inline(marks[key].sentence, lang)))

    key = "blanks", lang, blanks.exercise, blanks.seed, blanks.level, blanks.parts, tuple(texts.items())
    marks = request.site.cache.get(key, lambda: tuple(marked()))
    return CheckedExample({_BOX + name: text for name, text in texts.items()}, marks)


def _checked_before(
    request: Request, name: str, lang: str, opened: SteppedLesson
) -> dict[int, CheckedExample]:
    """Return the examples of a lesson that the person checked before, by the number of their step, and the
    one that a form led from, even if nothing is in its blanks."""
    found, asked = {}, request.query_params.get("example", "")
    kept = kept_blanks(request, name)
    for number, step in enumerate(opened.steps, 1):
        if step.blanks and (
            str(number) == asked or any(kept.get(box) for box in boxes_of(step.blanks).values())
        ):
            texts = {key: kept.get(box, "") for key, box in boxes_of(step.blanks).items()}
            found[number] = _checked(request, lang, step.blanks, texts)
    return found


# ------------------------------------------------------------------- drawings


def figure(request: Request) -> Response:
    """Return a drawing of a lesson; its name changes with its content."""
    name, wanted = _name(request), str(request.path_params["figure"])
    folder = request.site.course.folder
    langs = dict.fromkeys(lesson_lang(request.site, name, lang) for lang in (request.lang, *folder.languages))
    for lang in langs:
        if (svg := lesson_of(request.site, name, lang).figures.get(wanted)) is not None:
            return Response(svg, headers={"cache-control": _KEPT}, media_type="image/svg+xml; charset=utf-8")
    raise HTTPException("page", 404)


ROUTES = (
    Route("/lessons/{lesson}", lesson, Permission.OWN, takes_forms=True, budget=BOXES),
    Route("/lessons/{lesson}/steps/{steps}", steps, Permission.OWN),
    Route("/lessons/{lesson}/figures/{figure}", figure, Permission.OWN),
)
