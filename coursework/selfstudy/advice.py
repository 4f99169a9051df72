"""Progress of a student and the recommended next step in words, for notebooks and for the command line."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from datetime import date
from typing import TYPE_CHECKING, Any

from coursework.errors import CourseworkError
from coursework.language.words import words
from coursework.selfstudy.mastery import HELD, Advice, ExerciseProgress, Skill, advised, skills, standings
from coursework.selfstudy.progress import Progress

if TYPE_CHECKING:
    from coursework.course.course import Course
    from coursework.course.exercise import CourseExercise

Called = Callable[["CourseExercise[Any]", str], str]  #: how an exercise is called in a language

_SKILLS = 6  #: that are told, the last lost first


def next_step(
    course: Course[Any], progress: Progress, on: date, order: Sequence[str] | None = None
) -> Advice | None:
    """Return the recommendation for a day; None for a course without exercises. ``order`` is the study order,
    by default the course's."""
    order_known = course.folder.study_order if order is None else order
    return advised(progress, on, order_known, _Errors(course))


class _Errors(Mapping[str, Iterable[str]]):
    """Named errors that each exercise tests, by exercise; a solution is loaded on first use."""

    def __init__(self, course: Course[Any]):
        self._course = course

    def __getitem__(self, exercise: str) -> frozenset[str]:
        try:
            return frozenset(f"mistake:{name}" for name in self._course[exercise].solution.mistakes)
        except CourseworkError:
            return frozenset()

    def __iter__(self) -> Any:
        return iter(self._course.names)

    def __len__(self) -> int:
        return len(self._course.names)


def told_standings(course: Course[Any], progress: Progress, on: date, lang: str) -> str:
    """Return a line for each exercise begun, as a Markdown list; empty where there is none."""
    texts = words(lang)["study"]["progress"]
    return "\n".join(
        _line(course, s, on, lang, texts) for s in standings(progress) if s.tried and s.exercise in course
    )


def _line(course: Course[Any], item: ExerciseProgress, on: date, lang: str, text: Mapping[str, Any]) -> str:
    line = text["line"].format(
        title=title(course[item.exercise], lang),
        variants=item.variants,
        right=item.right,
        of=item.tried,
        clean=item.clean,
    )
    if item.due is None:
        return f"- {line}"
    again = text["due"] if item.due <= on else text["again"].format(day=told_date(item.due, lang))
    return f"- {line} {again}"


def told_skills(course: Course[Any], progress: Progress, lang: str, label: Called | None = None) -> str:
    """Return the skills lost since and those recovered, as Markdown lists; ``label`` as for
    :func:`told_advice`."""
    texts = words(lang)["study"]["progress"]
    lost = sorted(
        (s for s in skills(progress) if s.last_lost), key=lambda s: s.last_lost or date.min, reverse=True
    )
    named = [(s, text) for s in lost if (text := told_skill(course, s.id, s.exercise, lang))]
    pieces = []
    for head, chosen in (
        ("open", [(s, t) for s, t in named if s.is_open]),
        ("held", [(s, t) for s, t in named if not s.is_open]),
    ):
        if chosen:
            pieces.append(
                f"**{texts[head]}**\n\n"
                + "\n".join(_skill(course, s, t, lang, label or title) for s, t in chosen[:_SKILLS])
            )
    return "\n\n".join(pieces)


def _skill(course: Course[Any], skill: Skill, text: str, lang: str, label: Called) -> str:
    texts = words(lang)["study"]["progress"]
    displayed = texts["shown"].format(count=skill.shown, of=HELD) if skill.shown and skill.is_open else ""
    position = "" if skill.id.startswith("kind:") else label(course[skill.exercise], lang)
    heading = texts["separator"].join(filter(None, (position, displayed)))
    return f"- {' '.join(text.split())}{f' ({heading})' if heading else ''}"


def told_skill(course: Course[Any], skill: str, exercise: str, lang: str) -> str:
    """Return the words for a skill; empty where it has no name here."""
    family, _, name = skill.partition(":")
    texts = words(lang)["study"]["skills"]
    if family == "kind":
        return texts["kinds"].get(name, "")
    if family == "slip":
        return texts["slips"].get(name, "")
    if family != "mistake" or exercise not in course:
        return ""
    try:
        return course[exercise].variant(0, lang).told(name)
    except (CourseworkError, KeyError):
        return ""


def told_advice(course: Course[Any], advice: Advice, lang: str, label: Called | None = None) -> str:
    """Return the reason for the recommended exercise, in a sentence or two; ``label`` names an exercise, by
    default by title and name."""
    texts = words(lang)["study"]["next"]
    skill = told_skill(course, advice.skill, advice.exercise, lang) if advice.skill else ""
    why = "new" if advice.why == "skill" and not skill else advice.why
    return texts[why].format(
        title=(label or title)(course[advice.exercise], lang),
        day=told_date(advice.day, lang) if advice.day else "",
        skill=" ".join(skill.split()),
        count=len(advice.parts),
    )


def title(exercise: CourseExercise[Any], lang: str) -> str:
    """Return the title of an exercise with its name."""
    return f"{exercise.title(lang)} (`{exercise.name}`)"


def told_date(day: date, lang: str) -> str:
    return str(words(lang)["study"]["progress"]["date"]).format(day=day.day, month=day.month, year=day.year)
