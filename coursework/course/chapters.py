"""In which order a course is learnt: chapters, their sections, and in each a lesson, its exercises, and what
is needed first.

``exercises/course.toml`` states it::

    [[chapters]]
    title = { en = "Positions", fr = "Positions" }

    [[chapters.sections]]
    lesson = "positions"
    needs = ["structure"]
    exercises = ["circles", { name = "linkage", needs = ["bars"] }]

A section has a lesson, whose title it bears, or a ``title`` of its own, or neither. ``appendix = true`` makes
a chapter an appendix of the book. Whatever is needed first stands earlier.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import count, product
from string import ascii_uppercase
from typing import Any

from coursework.errors import BadCourse, nearest

_FORM = (
    '[[chapters]] with title = { en = "…", fr = "…" }, then [[chapters.sections]] with lesson = "…", '
    'exercises = ["…"]'
)


@dataclass(frozen=True)
class ChapterSection:
    """A lesson and the exercises that belong to it, in order; ``needs`` are lessons and exercises, by the
    name of who needs them first: the lesson's own name, or an exercise's."""

    lesson: str
    titles: Mapping[str, str]
    exercises: tuple[str, ...]
    needs: Mapping[str, tuple[str, ...]]

    @property
    def names(self) -> tuple[str, ...]:
        """The lesson, then the exercises."""
        return (*filter(None, [self.lesson]), *self.exercises)

    def needed(self, exercise: str) -> tuple[str, ...]:
        """Return the prerequisites of an exercise of the section: its lesson, then those that are stated."""
        return (*filter(None, [self.lesson]), *self.needs.get(exercise, ()))


@dataclass(frozen=True)
class Chapter:
    """A chapter by its number, from 1 on, with its title by language."""

    number: int
    titles: Mapping[str, str]
    sections: tuple[ChapterSection, ...]
    appendix: str = ""  #: its letter, where it is one

    @property
    def label(self) -> str:
        """Its number, or the letter of an appendix."""
        return self.appendix or str(self.number)

    def title(self, lang: str) -> str:
        """Its title, in another language where it has none in this."""
        return self.titles.get(lang) or next(iter(self.titles.values()))

    @property
    def lessons(self) -> tuple[str, ...]:
        return tuple(s.lesson for s in self.sections if s.lesson)

    @property
    def exercises(self) -> tuple[str, ...]:
        return tuple(name for s in self.sections for name in s.exercises)


def chapters(
    stated: Any, exercises: Sequence[str], lessons: Sequence[str], source: str
) -> tuple[Chapter, ...]:
    """Return the chapters that a course states.

    Parameters
    ----------
    stated
        The value of ``chapters`` in its settings.
    exercises, lessons
        The existing names.
    source
        What messages call the file.

    Raises
    ------
    BadCourse
        It is of another form, names what there is not, places something twice, or before what it needs.
    """
    if not isinstance(stated, list) or not all(isinstance(entry, Mapping) for entry in stated):
        raise BadCourse(f"{source}: chapters: write {_FORM}; found {stated!r}")
    letters = ("".join(row) for size in count(1) for row in product(ascii_uppercase, repeat=size))
    result = tuple(
        _chapter(k, entry, f"{source}: chapter {k}", letters) for k, entry in enumerate(stated, start=1)
    )
    _check_names(result, exercises, lessons, source)
    _check_order(result, source)
    return result


def _chapter(number: int, stated: Mapping[str, Any], where: str, letters: Iterator[str]) -> Chapter:
    _only(stated, {"title", "sections", "appendix"}, where)
    sections = stated.get("sections", [])
    if not isinstance(sections, list) or not all(isinstance(entry, Mapping) for entry in sections):
        raise BadCourse(f"{where}: sections: write {_FORM}; found {sections!r}")
    titles = _titles(stated.get("title"), where)
    if not titles:
        raise BadCourse(f'{where} has no title: write title = {{ en = "…", fr = "…" }}')
    return Chapter(
        number,
        titles,
        tuple(_section(entry, f"{where}, section {k}") for k, entry in enumerate(sections, start=1)),
        next(letters) if stated.get("appendix") else "",
    )


def _section(stated: Mapping[str, Any], where: str) -> ChapterSection:
    _only(stated, {"lesson", "title", "needs", "exercises"}, where)
    lesson = stated.get("lesson", "")
    if lesson and "title" in stated:
        raise BadCourse(f"{where} has a lesson, whose title it bears: leave out title, or lesson")
    placed = [_placed(entry, where) for entry in _list(stated.get("exercises", []), f"{where}: exercises")]
    needs = {name: exercise_needs for name, exercise_needs in placed if exercise_needs}
    if own_needs := _names(stated.get("needs", []), f"{where}: needs"):
        needs[str(lesson)] = own_needs
    return ChapterSection(
        str(lesson), _titles(stated.get("title", {}), where), tuple(name for name, _ in placed), needs
    )


def _placed(stated: Any, where: str) -> tuple[str, tuple[str, ...]]:
    """Return an exercise, and what it needs besides its lesson."""
    if isinstance(stated, str):
        return stated, ()
    if isinstance(stated, Mapping) and {"name"} <= set(stated) <= {"name", "needs"}:
        return str(stated["name"]), _names(stated.get("needs", []), f"{where}: {stated['name']}: needs")
    raise BadCourse(
        f'{where}: an exercise is "NAME" or {{ name = "NAME", needs = ["OTHER"] }}; found {stated!r}'
    )


def _list(stated: Any, where: str) -> list[Any]:
    if not isinstance(stated, list):
        raise BadCourse(f'{where}: write a list, ["…"]; found {stated!r}')
    return stated


def _names(stated: Any, where: str) -> tuple[str, ...]:
    return tuple(str(entry) for entry in _list(stated, where))


def _titles(stated: Any, where: str) -> Mapping[str, str]:
    if stated is None:
        return {}
    if not isinstance(stated, Mapping) or not all(isinstance(title, str) for title in stated.values()):
        raise BadCourse(f'{where}: write title = {{ en = "…", fr = "…" }}; found {stated!r}')
    return dict(stated)


def _only(stated: Mapping[str, Any], keys: set[str], where: str) -> None:
    for name in stated:
        if name not in keys:
            raise BadCourse(f"{where}: no setting {name!r}{nearest(name, sorted(keys))}")


def _check_names(
    course_chapters: Sequence[Chapter], exercises: Sequence[str], lessons: Sequence[str], source: str
) -> None:
    for chapter in course_chapters:
        for kind, named, existing in (
            ("lesson", chapter.lessons, lessons),
            ("exercise", chapter.exercises, exercises),
        ):
            for name in named:
                if name not in existing:
                    raise BadCourse(
                        f"{source}: chapter {chapter.number}: no {kind} {name!r}{nearest(name, existing)}"
                    )


def _check_order(course_chapters: Sequence[Chapter], source: str) -> None:
    """Raise unless everything stands once, and after what it needs."""
    every = [name for section in sections(course_chapters) for name in section.names]
    lessons = {section.lesson for section in sections(course_chapters)}
    for name in (
        exercise for chapter in course_chapters for exercise in chapter.exercises if exercise in lessons
    ):
        raise BadCourse(
            f"{source}: a lesson and an exercise are called {name!r}, and would have one page; rename "
            "one of them"
        )
    seen: set[str] = set()
    for section in sections(course_chapters):
        for name in section.names:
            if name in seen:
                raise BadCourse(f"{source}: {name!r} stands twice in the chapters; keep one of them")
            for needed in section.needs.get(name, ()):
                if needed == name:
                    raise BadCourse(f"{source}: {name} needs itself first; leave it out of its needs")
                if needed not in every:
                    raise BadCourse(
                        f"{source}: {name} needs {needed!r}, which no chapter has{nearest(needed, every)}"
                    )
                if needed not in seen:
                    raise BadCourse(f"{source}: {name} needs {needed!r} first, which comes later")
            seen.add(name)


def sections(course_chapters: Sequence[Chapter]) -> Iterator[ChapterSection]:
    """Yield the sections of chapters, one after another."""
    for chapter in course_chapters:
        yield from chapter.sections
