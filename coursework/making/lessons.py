"""Lessons of a course: texts that become notebooks."""

from __future__ import annotations

from pathlib import Path

from coursework.course.folder import Folder
from coursework.errors import BadCourse, unknown
from coursework.rendering.renderer import renderer_of


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
