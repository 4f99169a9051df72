"""Contents of the course in the order of study, chapter by chapter, with a person's progress in each
exercise."""

from __future__ import annotations

import re
from collections.abc import Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Any, NamedTuple

from markupsafe import Markup

from coursework.course.chapters import Chapter, ChapterSection
from coursework.course.lessons import lesson_title
from coursework.errors import BadCourse, CourseworkError
from coursework.figures import Figure
from coursework.language.words import words
from coursework.markup import markdown
from coursework.selfstudy.mastery import (
    Advice,
    ExerciseProgress,
    advice_text,
    date_text,
    next_step,
    standings,
)
from coursework.selfstudy.progress import Progress
from coursework.selfstudy.workbook.binding import chapters_of
from coursework.site.frame.pool import FIRST_SEED

if TYPE_CHECKING:
    from coursework.site.frame.requests import Request
    from coursework.site.frame.settings import Site

_FIGURE_MM = (44.0, 30.0)  #: room of a chapter's figure
_SIZE = re.compile(r'<svg( xmlns="[^"]*")? width="[^"]*" height="[^"]*"')
_PAPER = re.compile(r"<rect[^>]*/>\n?")


class ExerciseEntry(NamedTuple):
    """Exercise in its chapter."""

    name: str
    title: str
    state: str  #: new, begun, due, again or done
    state_text: str  #: the state in words
    is_right: bool = False  #: every question that was tried is right


class LessonGroup(NamedTuple):
    """Lesson or heading with its exercises."""

    title: str
    lesson: str  #: its name; empty for a heading
    exercises: tuple[ExerciseEntry, ...]


class ChapterEntry(NamedTuple):
    """Chapter with its groups of exercises."""

    number: int
    label: str  #: the number, or the letter of an appendix
    title: str
    groups: tuple[LessonGroup, ...]
    figure: Markup = Markup("")  #: a mechanism of the chapter, small

    @property
    def lessons(self) -> tuple[LessonGroup, ...]:
        return tuple(group for group in self.groups if group.lesson)

    @property
    def exercises(self) -> tuple[ExerciseEntry, ...]:
        return tuple(entry for group in self.groups for entry in group.exercises)

    @property
    def begun(self) -> int:
        return sum(entry.state != "new" for entry in self.exercises)

    @property
    def done(self) -> int:
        return sum(entry.is_right for entry in self.exercises)

    @property
    def next(self) -> ExerciseEntry | None:
        """Exercise to go on with: one that is due, or one that is not all right yet; None if there is
        none."""
        left = [entry for entry in self.exercises if not entry.is_right or entry.state == "due"]
        return min(left, key=lambda entry: entry.state != "due", default=None)


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
            chapter.number,
            chapter.label,
            chapter.title(lang),
            tuple(_group(site, s, lang) for s in chapter.sections),
            _figure(site, chapter),
        )
        for chapter in chapters_of(site.course, lang)
    )


def _figure(site: Site, chapter: Chapter) -> Markup:
    """Return the figure of an exercise of a chapter without its letters, as a piece of the page; of one that
    moves if there is one."""
    exercises = [site.course[name] for name in chapter.exercises]
    for exercise in sorted(exercises, key=lambda each: not each.is_animated):
        with suppress(CourseworkError):
            figure = exercise.variant(FIRST_SEED).figure
            if isinstance(figure, Figure):
                return Markup(_drawn_in_line(figure.fitted(*_FIGURE_MM).bare_svg()))
    return Markup("")


def _drawn_in_line(svg: str) -> str:
    """Return a drawing that takes the colours of the page around it."""
    svg = _PAPER.sub("", _SIZE.sub(r"<svg", svg, count=1), count=1)
    return svg.replace('"#000"', '"currentColor"').replace('"#fff"', '"var(--paper, #fff)"')


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
    return LessonGroup(title, section.lesson, tuple(placed))


def _entry(request: Request, new: ExerciseEntry, stand: ExerciseProgress | None) -> ExerciseEntry:
    if stand is None:
        return new
    name, title, texts = new.name, new.title, request.words["practice"]["states"]
    counts = {"right": stand.right, "of": stand.tried, "variants": stand.variants}
    is_right = 0 < stand.tried == stand.right
    if stand.due is not None and stand.due <= request.received_at.date():
        return ExerciseEntry(name, title, "due", texts["due"].format(**counts), is_right)
    if stand.due is not None:
        day = date_text(stand.due, request.lang)
        return ExerciseEntry(name, title, "again", texts["again"].format(**counts, day=day), is_right)
    state = "done" if is_right else "begun"
    return ExerciseEntry(name, title, state, texts[state].format(**counts), is_right)


def exercise_title(exercise: Any, lang: str) -> str:
    """Return the title of an exercise, in a language that it has."""
    return str(exercise.title(lang if lang in exercise.languages else exercise.languages[0]))


class NextStep(NamedTuple):
    """Next step to take, with its reason."""

    exercise: str
    html: Markup
    is_new: bool  #: the exercise was not begun


def next_of(request: Request, progress: Progress, after: str = "") -> NextStep | None:
    """Return the next step for today; None in a course without exercises. ``after`` is the exercise that was
    done: what is new follows it in the order of study."""
    site = request.site
    order = list(site.cache.get("study order", lambda: site.course.folder.study_order))
    if after in order:
        place = 1 + order.index(after)
        order = order[place:] + order[:place]
    advice: Advice | None = next_step(site.course, progress, request.received_at.date(), order)
    if advice is None:
        return None
    text = advice_text(request.site.course, advice, request.lang, exercise_title)
    return NextStep(
        advice.exercise,
        Markup(markdown.html_inline(text, request.lang)),
        advice.exercise not in progress.exercises,
    )
