"""The lessons of a course, as its files name them: titles, headings, and which of them teach an exercise.

A lesson is ``exercises/lessons/NAME.LANG.md``, Markdown whose first heading is its title, and whose numbered
headings, ``## 8. …``, are its sections.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from coursework.course.folder import Folder
from coursework.errors import BadCourse, nearest, unknown

if TYPE_CHECKING:
    from coursework.course.exercise import CourseExercise

_FORM = 'NAME = { lesson = "rods", sections = [1, 2] }'
_SOURCE = "exercises/course.toml: [lessons]"
PAGES = ("index", "symbols", "terms")  #: of a book, besides those of its lessons and exercises
_TITLE = re.compile(r"^# +(.+?) *$", re.MULTILINE)
_SECTION = re.compile(r"^## +((\d+)\..*?) *$", re.MULTILINE)


@dataclass(frozen=True)
class Lesson:
    """A lesson of the course that teaches what an exercise asks."""

    name: str
    title: str
    sections: tuple[str, ...] = ()  #: their headings; none when the whole lesson does
    parts: tuple[str, ...] = ()  #: of the exercise, that this lesson helps with before the first does

    @property
    def places(self) -> tuple[tuple[str, str], ...]:
        """The numbers and the titles of its sections."""
        return tuple((number, title) for number, _, title in (one.partition(". ") for one in self.sections))


def lesson_file(folder: Folder, name: str, lang: str) -> Path:
    """Return the text of a lesson in a language.

    Raises
    ------
    UnknownName
        No such lesson.
    BadCourse
        The lesson is not written in this language, or its name is none that a lesson may have.
    """
    if name not in folder.lessons:
        raise unknown("lesson", name, folder.lessons, folder.label)
    _check_name(folder, name)
    path = folder.lesson_place / f"{name}.{lang}.md"
    if not path.exists():
        raise BadCourse(f"the lesson {name} has no text in {lang!r}: {folder.relative(path)} is missing")
    return path


def _check_name(folder: Folder, name: str) -> None:
    """Check a lesson's name, which is that of a file in books, of a module, and of a target of links."""
    owner = (
        "is an exercise"
        if name in folder.names
        else "is a page of every book"
        if name.lower() in PAGES
        else ""
    )
    if owner:
        raise BadCourse(f"the lesson {name} has a name that {owner} as well; rename its files")
    if not name.isidentifier():
        would = re.sub(r"\W+", "_", name)
        would = would if would.isidentifier() else f"lesson_{would}"
        raise BadCourse(
            f"the lesson {name!r}: a name is letters, digits and _, and begins with a letter; rename "
            f"its files, {would}.LANG.md"
        )


def read_text(path: Path) -> str:
    """Return the text of a lesson's file.

    Raises
    ------
    BadCourse
        It is not UTF-8.
    """
    try:
        return path.read_text("utf-8-sig")
    except UnicodeDecodeError as fault:
        raise BadCourse(
            f"{path.name} is not written in UTF-8, from byte {fault.start} on; save it in UTF-8"
        ) from fault


def lesson_title(folder: Folder, name: str, lang: str) -> str:
    """Return the title of a lesson; its name where it has none."""
    path = lesson_file(folder, name, lang)
    return _headings(path, path.stat().st_mtime_ns)[0]


def lesson_sections(folder: Folder, name: str, lang: str) -> Mapping[int, str]:
    """Return the headings of a lesson's numbered sections, by number."""
    path = lesson_file(folder, name, lang)
    return _headings(path, path.stat().st_mtime_ns)[1]


def taught_by(folder: Folder, exercise: str, lang: str) -> tuple[Lesson, ...]:
    """Return the lessons that teach an exercise, in a language: that of its section of the chapters, then
    those that ``[lessons]`` of ``course.toml`` names for it.

    ``crank_pin = { lesson = "rods", sections = [8] }``, or a list of these; a bare ``"rods"`` is a whole
    lesson. Sections are named by the numbers of their headings. Of several lessons the first helps with each
    question that no other names by ``parts = ["r4"]``. A lesson that is not written in the language is left
    out.

    Raises
    ------
    BadCourse
        It names an exercise, a lesson or a section that does not exist.
    """
    stated = folder.settings.get("lessons", {})
    if not isinstance(stated, Mapping):
        raise BadCourse(f"{_SOURCE} is a table: {_FORM}")
    names = folder.names if stated else ()
    for name in stated:
        if name not in names:
            raise BadCourse(f"{_SOURCE} names no exercise {name!r}{nearest(name, names)}")
    section = folder.section_of(exercise)
    stated_names = stated.get(exercise, [])
    listed = stated_names if isinstance(stated_names, list) else [stated_names]
    placed = [section.lesson] if section and section.lesson else []
    if any(_named(lesson) in placed for lesson in listed):
        placed = []  # it says which sections
    return tuple(_taught(folder, exercise, [*placed, *listed], lang))


def check_parts(exercise: CourseExercise[Any], lessons: Sequence[Lesson]) -> None:
    """Check that the ``parts`` that lessons help with are questions of the exercise.

    Raises
    ------
    BadCourse
        One is not.
    """
    ids = [part.id for part in exercise.spec.parts]
    for part in (part for lesson in lessons for part in lesson.parts):
        if part not in ids:
            raise BadCourse(
                f"{_SOURCE}: {exercise.name}: parts: the exercise has no question {part!r}"
                f"{nearest(part, ids)}; available: {', '.join(ids)}"
            )


def practised(folder: Folder, lesson: str, lang: str) -> tuple[str, ...]:
    """Return the exercises that a lesson teaches, in the order in which they are learnt."""
    return tuple(
        name
        for name in folder.in_order
        if any(lesson_name.name == lesson for lesson_name in taught_by(folder, name, lang))
    )


def _named(stated: Any) -> Any:
    return stated.get("lesson") if isinstance(stated, Mapping) else stated


def _taught(folder: Folder, exercise: str, stated: list[Any], lang: str) -> Iterator[Lesson]:
    for lesson in stated:
        table = {"lesson": lesson} if isinstance(lesson, str) else lesson
        if not isinstance(table, Mapping) or not {"lesson"} <= set(table) <= {"lesson", "sections", "parts"}:
            raise BadCourse(f"{_SOURCE}: {exercise}: write {_FORM}; found {lesson!r}")
        name = table["lesson"]
        if name not in folder.lessons:
            raise BadCourse(f"{_SOURCE}: {exercise}: no lesson {name!r}{nearest(str(name), folder.lessons)}")
        path = folder.lesson_place / f"{name}.{lang}.md"
        if path.exists():
            title, headings = _headings(path, path.stat().st_mtime_ns)
            sections = _sections(exercise, name, table.get("sections", []), headings)
            yield Lesson(name, title, sections, _parts(exercise, table.get("parts", [])))


def _parts(exercise: str, stated: Any) -> tuple[str, ...]:
    if not isinstance(stated, list) or not all(isinstance(part, str) for part in stated):
        would = json.dumps([stated if isinstance(stated, str) else "r4"])
        raise BadCourse(
            f"{_SOURCE}: {exercise}: parts is a list of questions; write parts = {would}; found {stated!r}"
        )
    return tuple(stated)


def _sections(exercise: str, lesson: str, wanted: Any, headings: Mapping[int, str]) -> tuple[str, ...]:
    wanted = wanted if isinstance(wanted, list) else [wanted]
    for number in wanted:
        if number not in headings:
            there = ", ".join(map(str, headings)) or "none"
            raise BadCourse(
                f"{_SOURCE}: {exercise}: the lesson {lesson} has no section {number!r}; available: {there}"
            )
    return tuple(headings[number] for number in wanted)


@lru_cache(maxsize=64)
def _headings(path: Path, changed: int) -> tuple[str, Mapping[int, str]]:
    """Return the title of a lesson, and the headings of its numbered sections."""
    text = read_text(path)
    title = _TITLE.search(text)
    return title[1] if title else path.name.split(".")[0], {
        int(n): heading for heading, n in _SECTION.findall(text)
    }
