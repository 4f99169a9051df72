"""Lesson as a notebook, with embedded pictures, collapsed answers, and links to the notebooks beside it."""

from __future__ import annotations

import base64
from collections.abc import Collection, Mapping
from typing import Any
from urllib.parse import quote

from coursework.course.course import Course
from coursework.course.lessons import lesson_sections, practised
from coursework.language.words import words
from coursework.markup.links import TERM, TextLink, relinked
from coursework.markup.markdown import to_notebook_markdown
from coursework.rendering.renderer import renderer_of
from coursework.sheets.book import DrawnPiece
from coursework.workbook import lesson_source as source
from coursework.workbook.lessons import opened
from coursework.workbook.pictures import drawn

_PPI = 150


def notebook_name(name: str, lang: str) -> str:
    """Return the file name of a lesson's or an exercise's notebook."""
    return f"{name}.{lang}.ipynb"


def lesson_notebook(
    course: Course[Any], name: str, lang: str, neighbours: Collection[str] | None = None
) -> str:
    """Return a lesson as a notebook (JSON, nbformat 4.5).

    Parameters
    ----------
    course, name, lang
        An open course, a lesson of it, a language.
    beside
        The lessons and exercises whose notebooks stand beside it: links lead to these alone. All of the course unless told.

    Raises
    ------
    UnknownName
        No such lesson.
    BadCourse
        It is not written in this language, or a picture or a link leads nowhere.
    """
    folder = course.folder
    there = {*folder.lessons, *folder.names} if neighbours is None else neighbours
    pieces: list[str] = []
    pictures: dict[str, Mapping[str, str]] = {}
    for block in opened(course, name, lang).blocks:
        if isinstance(block, source.LessonImage):
            displayed = drawn(course, name, block, lang)
            file = f"picture-{len(pictures) + 1}.{'svg' if displayed.svg else 'png'}"
            pictures[file] = _attached(displayed)
            pieces.append(_picture(file, displayed, lang))
        else:
            pieces.append(_written(course, block, lang, there))
    text = "\n\n".join([*pieces, *_practise(course, name, lang, there)]) + "\n"
    return renderer_of(folder).lesson(name, text, lang, folder.install, pictures)


def _written(
    course: Course[Any],
    block: source.LessonProse | source.CodeCell | source.LessonAnswer,
    lang: str,
    there: Collection[str],
) -> str:
    if isinstance(block, source.CodeCell):
        return f"```python\n{block.code}\n```"
    text = to_notebook_markdown(_linked(course, block.text, lang, there), lang)
    if isinstance(block, source.LessonAnswer):
        return f"<details><summary>{words(lang)['lesson']['answer']}</summary>\n\n{text}\n\n</details>"
    return text


def _linked(course: Course[Any], text: str, lang: str, there: Collection[str]) -> str:
    """Return the text with links to the notebooks beside this one, and with terms in italics."""

    def write(link: TextLink) -> str:
        if link.kind == TERM:
            return f"*{link.said}*"
        if link.name not in there:
            return link.said
        position = ""
        if link.section:
            position = "#" + quote(
                lesson_sections(course.folder, link.name, lang)[link.section].replace(" ", "-")
            )
        return f"[{link.said}]({notebook_name(link.name, lang)}{position})"

    return relinked(text, write)


def _attached(displayed: DrawnPiece) -> Mapping[str, str]:
    """Return a picture by MIME type; a moving one is SVG, which moves in a notebook too."""
    if displayed.svg:
        return {"image/svg+xml": base64.b64encode(displayed.svg.encode()).decode()}
    assert displayed.figure is not None  # a picture is one or the other
    return {"image/png": base64.b64encode(displayed.figure.png(ppi=_PPI)).decode()}


def _picture(file: str, displayed: DrawnPiece, lang: str) -> str:
    text = displayed.said.replace("[", "(").replace("]", ")").replace("\n", " ")
    caption = to_notebook_markdown(displayed.caption, lang)
    return f"![{text}](attachment:{file})" + (f"\n\n*{caption}*" if caption else "")


def _practise(course: Course[Any], name: str, lang: str, there: Collection[str]) -> list[str]:
    """Return the exercises of the lesson, each as a link to its notebook."""
    exercises = [item for item in practised(course.folder, name, lang) if item in there]
    if not exercises:
        return []
    lines = [f"- [{course[item].title(lang)}]({notebook_name(item, lang)})" for item in exercises]
    command = f"coursework notebook {' '.join(exercises)} --lang {lang}"
    return [f"## {words(lang)['lesson']['practise']}", "\n".join(lines), f"`{command}`"]
