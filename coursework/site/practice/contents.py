"""Contents of the course in the order of study, chapter by chapter, with a person's progress in each
exercise."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from markupsafe import Markup

from coursework.course.chapters import ChapterSection
from coursework.course.lessons import lesson_title
from coursework.errors import BadCourse
from coursework.language.words import words
from coursework.markup import markdown
from coursework.selfstudy.mastery import (
    Advice,
    ExerciseProgress,
    next_step,
    standings,
    told_advice,
    told_date,
)
from coursework.selfstudy.progress import Progress
from coursework.selfstudy.workbook.binding import chapters_of

if TYPE_CHECKING:
    from coursework.site.frame.requests import Request
    from coursework.site.frame.settings import Site


class ExerciseEntry(NamedTuple):
    """Exercise in its chapter."""

    name: str
    title: str
    state: str  #: new, begun, due, again or done
    state_text: str  #: the state in words


class LessonGroup(NamedTuple):
    """Lesson or heading with its exercises."""

    title: str
    is_lesson: bool
    exercises: tuple[ExerciseEntry, ...]


class ChapterEntry(NamedTuple):
    """Chapter with its groups of exercises."""

    number: int
    title: str
    groups: tuple[LessonGroup, ...]

    @property
    def exercises(self) -> tuple[ExerciseEntry, ...]:
        return tuple(entry for group in self.groups for entry in group.exercises)

    @property
    def begun(self) -> int:
        return sum(entry.state != "new" for entry in self.exercises)


def contents(request: Request, progress: Progress) -> list[ChapterEntry]:
    """Return the chapters in the workbook's order, with the person's progress."""
    progress_of = {standing.exercise: standing for standing in standings(progress)}
    return [
        chapter._replace(groups=tuple(_group_state(request, group, progress_of) for group in chapter.groups))
        for chapter in titles(request.site, request.lang)
    ]


def _group_state(
    request: Request, group: LessonGroup, progress_of: Mapping[str, ExerciseProgress]
) -> LessonGroup:
    placed = tuple(_entry(request, entry, progress_of.get(entry.name)) for entry in group.exercises)
    return group._replace(exercises=placed)


def titles(site: Site, lang: str) -> tuple[ChapterEntry, ...]:
    """Return the chapters without anybody's progress, from a cache, since they depend on the course's files
    alone."""
    chapters: tuple[ChapterEntry, ...] = site.cache.get(("contents", lang), lambda: _titles(site, lang))
    return chapters


def _titles(site: Site, lang: str) -> tuple[ChapterEntry, ...]:
    return tuple(
        ChapterEntry(
            chapter.number, chapter.title(lang), tuple(_group(site, s, lang) for s in chapter.sections)
        )
        for chapter in chapters_of(site.course, lang)
    )


def _group(site: Site, section: ChapterSection, lang: str) -> LessonGroup:
    title = section.titles.get(lang, "")
    if section.lesson:
        try:
            title = lesson_title(site.course.folder, section.lesson, lang)
        except BadCourse:  # not written in this language
            title = section.lesson
    state_text = words(lang, "site")["practice"]["states"]["new"]
    placed = (
        ExerciseEntry(name, exercise_title(site.course[name], lang), "new", state_text)
        for name in section.exercises
    )
    return LessonGroup(title, bool(section.lesson), tuple(placed))


def _entry(request: Request, new: ExerciseEntry, stand: ExerciseProgress | None) -> ExerciseEntry:
    if stand is None:
        return new
    name, title, texts = new.name, new.title, request.words["practice"]["states"]
    counts = {"right": stand.right, "of": stand.tried, "variants": stand.variants}
    if stand.due is not None and stand.due <= request.received_at.date():
        return ExerciseEntry(name, title, "due", texts["due"].format(**counts))
    if stand.due is not None:
        day = told_date(stand.due, request.lang)
        return ExerciseEntry(name, title, "again", texts["again"].format(**counts, day=day))
    state = "done" if stand.tried and stand.right == stand.tried else "begun"
    return ExerciseEntry(name, title, state, texts[state].format(**counts))


def exercise_title(exercise: Any, lang: str) -> str:
    """Return the title of an exercise, in a language that it has."""
    return str(exercise.title(lang if lang in exercise.languages else exercise.languages[0]))


class NextStep(NamedTuple):
    """Next step to take, with its reason."""

    exercise: str
    html: Markup
    is_new: bool  #: the exercise was not begun


def next_of(request: Request, progress: Progress) -> NextStep | None:
    """Return the next step for today; None in a course without exercises."""
    site = request.site
    order = site.cache.get("study order", lambda: site.course.folder.study_order)
    advice: Advice | None = next_step(site.course, progress, request.received_at.date(), order)
    if advice is None:
        return None
    text = told_advice(request.site.course, advice, request.lang, exercise_title)
    return NextStep(
        advice.exercise,
        Markup(markdown.html_inline(text, request.lang)),
        advice.exercise not in progress.exercises,
    )
