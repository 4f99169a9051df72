"""Contents of the course in the order of study, chapter by chapter, with a person's progress in each
exercise."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from markupsafe import Markup

from coursework.course.chapters import Section
from coursework.course.lessons import lesson_title
from coursework.errors import BadCourse
from coursework.language.words import words
from coursework.markup import markdown
from coursework.selfstudy.advice import next_step, told_advice, told_date
from coursework.selfstudy.mastery import Advice, ExerciseProgress, standings
from coursework.selfstudy.progress import Progress
from coursework.workbook.binding import chapters_of

if TYPE_CHECKING:
    from coursework.site.frame.requests import Request
    from coursework.site.frame.settings import Site


class Placed(NamedTuple):
    """An exercise in its chapter."""

    name: str
    title: str
    state: str  #: new, begun, due, again or done
    told: str  #: the state in words


class Grouped(NamedTuple):
    """A lesson, or a heading, and its exercises."""

    title: str
    is_lesson: bool
    exercises: tuple[Placed, ...]


class Chaptered(NamedTuple):
    """A chapter with its groups, and how many of its exercises were begun."""

    number: int
    title: str
    groups: tuple[Grouped, ...]

    @property
    def exercises(self) -> tuple[Placed, ...]:
        return tuple(one for group in self.groups for one in group.exercises)

    @property
    def begun(self) -> int:
        return sum(one.state != "new" for one in self.exercises)


def contents(request: Request, progress: Progress) -> list[Chaptered]:
    """Return the chapters in the workbook's order, with the person's progress."""
    stands = {one.exercise: one for one in standings(progress)}
    return [
        chapter._replace(groups=tuple(_standing(request, group, stands) for group in chapter.groups))
        for chapter in titles(request.site, request.lang)
    ]


def _standing(request: Request, group: Grouped, stands: Mapping[str, ExerciseProgress]) -> Grouped:
    placed = tuple(_placed(request, one, stands.get(one.name)) for one in group.exercises)
    return group._replace(exercises=placed)


def titles(site: Site, lang: str) -> tuple[Chaptered, ...]:
    """Return the chapters without anybody's progress, from a cache, since they depend on the course's files
    alone."""
    found: tuple[Chaptered, ...] = site.cache.get(("contents", lang), lambda: _titles(site, lang))
    return found


def _titles(site: Site, lang: str) -> tuple[Chaptered, ...]:
    return tuple(
        Chaptered(chapter.number, chapter.title(lang), tuple(_group(site, s, lang) for s in chapter.sections))
        for chapter in chapters_of(site.course, lang)
    )


def _group(site: Site, section: Section, lang: str) -> Grouped:
    title = section.titles.get(lang, "")
    if section.lesson:
        try:
            title = lesson_title(site.course.folder, section.lesson, lang)
        except BadCourse:  # not written in this language
            title = section.lesson
    said = words(lang, "site")["practice"]["states"]["new"]
    placed = (Placed(name, called(site.course[name], lang), "new", said) for name in section.exercises)
    return Grouped(title, bool(section.lesson), tuple(placed))


def _placed(request: Request, new: Placed, stand: ExerciseProgress | None) -> Placed:
    if stand is None:
        return new
    name, title, said = new.name, new.title, request.words["practice"]["states"]
    counts = {"right": stand.right, "of": stand.tried, "variants": stand.variants}
    if stand.due is not None and stand.due <= request.received_at.date():
        return Placed(name, title, "due", said["due"].format(**counts))
    if stand.due is not None:
        day = told_date(stand.due, request.lang)
        return Placed(name, title, "again", said["again"].format(**counts, day=day))
    state = "done" if stand.tried and stand.right == stand.tried else "begun"
    return Placed(name, title, state, said[state].format(**counts))


def called(exercise: Any, lang: str) -> str:
    """Return the title of an exercise, in a language that it has."""
    return str(exercise.title(lang if lang in exercise.languages else exercise.languages[0]))


class Next(NamedTuple):
    """Next step to take, with its reason."""

    exercise: str
    html: Markup
    is_new: bool  #: nothing of the exercise was begun


def next_of(request: Request, progress: Progress) -> Next | None:
    """Return the next step for today; None in a course without exercises."""
    site = request.site
    order = site.cache.get("study order", lambda: site.course.folder.study_order)
    advice: Advice | None = next_step(site.course, progress, request.received_at.date(), order)
    if advice is None:
        return None
    said = told_advice(request.site.course, advice, request.lang, called)
    return Next(
        advice.exercise,
        Markup(markdown.html_inline(said, request.lang)),
        advice.exercise not in progress.exercises,
    )
