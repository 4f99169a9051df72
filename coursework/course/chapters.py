"""In which order a course is learnt: chapters, their sections, and in each a lesson, its exercises, and what is needed first.

``exercises/course.toml`` states it::

    [[chapters]]
    title = { en = "Positions", fr = "Positions" }

    [[chapters.sections]]
    lesson = "positions"
    needs = ["structure"]
    exercises = ["circles", { name = "linkage", needs = ["bars"] }]

A section has a lesson, whose title it bears, or a ``title`` of its own, or neither. Whatever is needed first stands earlier.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from coursework.errors import BadCourse, nearest

_FORM = '[[chapters]] with title = { en = "…", fr = "…" }, then [[chapters.sections]] with lesson = "…", exercises = ["…"]'


@dataclass(frozen=True)
class Section:
    """A lesson and the exercises that belong to it, in order; ``needs`` are lessons and exercises, by the name of who needs
    them first: the lesson's own name, or an exercise's."""

    lesson: str
    titles: Mapping[str, str]
    exercises: tuple[str, ...]
    needs: Mapping[str, tuple[str, ...]]

    @property
    def names(self) -> tuple[str, ...]:
        """The lesson, then the exercises."""
        return (*filter(None, [self.lesson]), *self.exercises)

    def needed(self, exercise: str) -> tuple[str, ...]:
        """What an exercise of the section needs first: its lesson, then what is stated."""
        return (*filter(None, [self.lesson]), *self.needs.get(exercise, ()))


@dataclass(frozen=True)
class Chapter:
    """A chapter by its number, from 1 on, with its title by language."""

    number: int
    titles: Mapping[str, str]
    sections: tuple[Section, ...]

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
    """The chapters that a course states.

    Parameters
    ----------
    stated
        The value of ``chapters`` in its settings.
    exercises, lessons
        The names that there are.
    source
        What messages call the file.

    Raises
    ------
    BadCourse
        It is of another form, names what there is not, places something twice, or before what it needs.
    """
    if not isinstance(stated, list) or not all(isinstance(one, Mapping) for one in stated):
        raise BadCourse(f"{source}: chapters: write {_FORM}; found {stated!r}")
    found = tuple(_chapter(k, one, f"{source}: chapter {k}") for k, one in enumerate(stated, start=1))
    _check_names(found, exercises, lessons, source)
    _check_order(found, source)
    return found


def _chapter(number: int, stated: Mapping[str, Any], where: str) -> Chapter:
    _only(stated, {"title", "sections"}, where)
    sections = stated.get("sections", [])
    if not isinstance(sections, list) or not all(isinstance(one, Mapping) for one in sections):
        raise BadCourse(f"{where}: sections: write {_FORM}; found {sections!r}")
    titles = _titles(stated.get("title"), where)
    if not titles:
        raise BadCourse(f'{where} has no title: write title = {{ en = "…", fr = "…" }}')
    return Chapter(
        number,
        titles,
        tuple(_section(one, f"{where}, section {k}") for k, one in enumerate(sections, start=1)),
    )


def _section(stated: Mapping[str, Any], where: str) -> Section:
    _only(stated, {"lesson", "title", "needs", "exercises"}, where)
    lesson = stated.get("lesson", "")
    if lesson and "title" in stated:
        raise BadCourse(f"{where} has a lesson, whose title it bears: leave out title, or lesson")
    placed = [_placed(one, where) for one in _list(stated.get("exercises", []), f"{where}: exercises")]
    needs = {name: told for name, told in placed if told}
    if own := _names(stated.get("needs", []), f"{where}: needs"):
        needs[str(lesson)] = own
    return Section(
        str(lesson), _titles(stated.get("title", {}), where), tuple(name for name, _ in placed), needs
    )


def _placed(stated: Any, where: str) -> tuple[str, tuple[str, ...]]:
    """An exercise, and what it needs besides its lesson."""
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
    return tuple(str(one) for one in _list(stated, where))


def _titles(stated: Any, where: str) -> Mapping[str, str]:
    if stated is None:
        return {}
    if not isinstance(stated, Mapping) or not all(isinstance(one, str) for one in stated.values()):
        raise BadCourse(f'{where}: write title = {{ en = "…", fr = "…" }}; found {stated!r}')
    return dict(stated)


def _only(stated: Mapping[str, Any], known: set[str], where: str) -> None:
    for name in stated:
        if name not in known:
            raise BadCourse(f"{where}: no setting {name!r}{nearest(name, sorted(known))}")


def _check_names(
    found: Sequence[Chapter], exercises: Sequence[str], lessons: Sequence[str], source: str
) -> None:
    for chapter in found:
        for kind, named, known in (
            ("lesson", chapter.lessons, lessons),
            ("exercise", chapter.exercises, exercises),
        ):
            for name in named:
                if name not in known:
                    raise BadCourse(
                        f"{source}: chapter {chapter.number}: no {kind} {name!r}{nearest(name, known)}"
                    )


def _check_order(found: Sequence[Chapter], source: str) -> None:
    """Everything once, and after what it needs."""
    every = [name for section in sections(found) for name in section.names]
    lessons = {section.lesson for section in sections(found)}
    for name in (one for chapter in found for one in chapter.exercises if one in lessons):
        raise BadCourse(
            f"{source}: a lesson and an exercise are called {name!r}, and would have one page; rename one of them"
        )
    seen: set[str] = set()
    for section in sections(found):
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


def sections(found: Sequence[Chapter]) -> Iterator[Section]:
    """The sections of chapters, one after another."""
    for chapter in found:
        yield from chapter.sections
