"""Lessons of a course: texts that become notebooks."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from coursework.course.folder import Folder
from coursework.errors import BadCourse, nearest, unknown
from coursework.rendering.renderer import renderer_of
from coursework.sheets.sheet import Lesson


def lessons(folder: Folder) -> tuple[str, ...]:
    """Names of the lessons, ``exercises/lessons/NAME.LANG.md``, in alphabetical order."""
    return tuple(sorted({p.name.split(".")[0] for p in _place(folder).glob("*.*.md")}))


def _place(folder: Folder) -> Path:
    return folder.root / "exercises" / "lessons"


def lesson(folder: Folder, name: str, lang: str) -> str:
    """A lesson as a notebook (JSON).

    Raises
    ------
    UnknownName
        No such lesson.
    BadCourse
        The lesson is not written in this language.
    """
    known = lessons(folder)
    if name not in known:
        raise unknown("lesson", name, known, folder.label)
    path = _place(folder) / f"{name}.{lang}.md"
    if not path.exists():
        raise BadCourse(f"the lesson {name} has no text in {lang!r}: {path.name} is missing")
    return renderer_of(folder).lesson(name, path.read_text("utf-8"), lang, folder.install)


# ------------------------------------------------------------------ what teaches

_FORM = 'NAME = { lesson = "mechanisms", sections = [1, 2] }'
_TITLE = re.compile(r"^# +(.+?) *$", re.MULTILINE)
_SECTION = re.compile(r"^## +((\d+)\..*?) *$", re.MULTILINE)


def taught_by(folder: Folder, exercise: str, lang: str) -> tuple[Lesson, ...]:
    """The lessons that teach an exercise, in a language: those that ``[lessons]`` of ``course.toml`` names for it.

    ``coriolis = { lesson = "mechanisms", sections = [8] }``, or a list of these; a bare ``"mechanisms"`` is a whole
    lesson. Sections are told by the numbers of their headings, ``## 8. …``. A lesson that is not written in the
    language is left out.

    Raises
    ------
    BadCourse
        It names an exercise, a lesson or a section that there is not.
    """
    stated = folder.settings.get("lessons", {})
    if not isinstance(stated, Mapping):
        raise BadCourse(f"{_SOURCE} is a table: {_FORM}")
    known = folder.names if stated else ()
    for name in stated:
        if name not in known:
            raise BadCourse(f"{_SOURCE} names no exercise {name!r}{nearest(name, known)}")
    return tuple(_taught(folder, exercise, stated.get(exercise, []), lang))


_SOURCE = "exercises/course.toml: [lessons]"


def _taught(folder: Folder, exercise: str, stated: Any, lang: str) -> Iterator[Lesson]:
    known = lessons(folder)
    for one in stated if isinstance(stated, list) else [stated]:
        table = {"lesson": one} if isinstance(one, str) else one
        if not isinstance(table, Mapping) or not {"lesson"} <= set(table) <= {"lesson", "sections"}:
            raise BadCourse(f"{_SOURCE}: {exercise}: write {_FORM}; found {one!r}")
        name = table["lesson"]
        if name not in known:
            raise BadCourse(f"{_SOURCE}: {exercise}: no lesson {name!r}{nearest(str(name), known)}")
        path = _place(folder) / f"{name}.{lang}.md"
        if path.exists():
            title, headings = _headings(path, path.stat().st_mtime_ns)
            yield Lesson(name, title, _sections(exercise, name, table.get("sections", []), headings))


def _sections(exercise: str, lesson: str, asked: Any, headings: Mapping[int, str]) -> tuple[str, ...]:
    asked = asked if isinstance(asked, list) else [asked]
    for number in asked:
        if number not in headings:
            there = ", ".join(map(str, headings)) or "none"
            raise BadCourse(
                f"{_SOURCE}: {exercise}: the lesson {lesson} has no section {number!r}; there is {there}"
            )
    return tuple(headings[number] for number in asked)


@lru_cache(maxsize=64)
def _headings(path: Path, changed: int) -> tuple[str, Mapping[int, str]]:
    """The title of a lesson, and the headings of its numbered sections."""
    text = path.read_text("utf-8-sig")
    title = _TITLE.search(text)
    return title[1] if title else path.name.split(".")[0], {
        int(n): said for said, n in _SECTION.findall(text)
    }
