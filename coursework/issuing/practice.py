"""Practice after an exercise: another variant, and the lesson that teaches it."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from copy import copy
from typing import Any

from coursework.course.course import Course
from coursework.course.exercise import CourseExercise
from coursework.course.lessons import check_parts, taught_by
from coursework.course.variant import Variant
from coursework.errors import BadCourse, CourseworkError, Starved, nearest
from coursework.issuing.issued import Issued
from coursework.issuing.issuing import distinct_variants
from coursework.sheets.handout import handout
from coursework.sheets.sheet import Lesson, Practice, Question

Given = Mapping[str, Any]


class PracticeOf:
    """Practice for the students of one build; each exercise's variant is searched once.

    The variant is one that nobody was issued, or, if all were issued, one that the student was not; it
    depends on the issued variants alone. A course with ``practice = false`` in ``[feedback]`` offers none.
    """

    def __init__(self, course: Course, issued: Issued) -> None:
        self._course, self._issued = course, issued
        self._offers = offers_practice(course)
        self._fresh: dict[str, int | None] = {}
        self._lessons: dict[tuple[str, str], tuple[Lesson, ...]] = {}
        self._questions: dict[tuple[str, int, str], tuple[Question, ...]] = {}

    def after(self, exercise: str, student: str, lang: str) -> Practice:
        """Return the practice of ``student`` after an exercise, in a language."""
        course_exercise = self._course[exercise]
        folder = course_exercise.folder
        seed = self._seed(course_exercise, student) if self._offers else None
        return Practice(
            exercise,
            course_exercise.version,
            "" if folder.is_builtin else folder.root.name,
            seed,
            self._taught(course_exercise, lang),
            () if seed is None else self._asked(exercise, seed, lang),
        )

    def of_student(self, issued: Issued) -> PracticeOf:
        """Return the practice of one student, with that student's part of the record alone: little data to
        send to another process."""
        practice = copy(self)
        for exercise in issued.exercises if self._offers else ():
            with suppress(CourseworkError):  # reported when the practice is requested
                self._of_nobody(self._course[exercise])
        practice._issued, practice._fresh = issued, self._fresh
        return practice

    def _taught(self, exercise: CourseExercise, lang: str) -> tuple[Lesson, ...]:
        key = exercise.name, lang
        if key not in self._lessons:
            taught = taught_by(exercise.folder, exercise.name, lang)
            check_parts(exercise, taught)
            self._lessons[key] = taught
        return self._lessons[key]

    def _asked(self, exercise: str, seed: int, lang: str) -> tuple[Question, ...]:
        """Return the questions of a variant, which may ask other parts than the student's own."""
        key = exercise, seed, lang
        if key not in self._questions:
            self._questions[key] = handout(self._course[exercise].variant(seed, lang)).questions
        return self._questions[key]

    def _seed(self, exercise: CourseExercise, student: str) -> int | None:
        name = exercise.name
        if (seed := self._of_nobody(exercise)) is not None:
            return seed
        mine = self._issued.seeds_of(student, name)
        return unissued_seed(exercise, {seed: self._issued.records[name, seed] for seed in mine})

    def _of_nobody(self, exercise: CourseExercise) -> int | None:
        name = exercise.name
        if name not in self._fresh:
            everyones = {seed: r for (e, seed), r in self._issued.records.items() if e == name}
            self._fresh[name] = unissued_seed(exercise, everyones)
        return self._fresh[name]


def unissued_seed(exercise: CourseExercise, records: Mapping[int, Mapping[str, Any]]) -> int | None:
    """Return the first seed worth issuing, from 1 on, whose variant is not in the records; None if none is
    found."""
    given = [record.get("given") for record in records.values()]
    lang = exercise.languages[0]

    def is_new(variant: Variant) -> bool:
        return variant.seed not in records and variant.record["given"] not in given

    for first in (1, max(records, default=0) + 1):
        with suppress(Starved):
            # What was issued is passed over before it is tried, which takes far longer.
            return int(distinct_variants(exercise, first, 1, lang, fits=is_new)[0].seed)
    return None


_SETTINGS = ("practice",)


def offers_practice(course: Course) -> bool:
    """Return whether feedback offers another variant: yes, unless ``[feedback]`` in ``course.toml`` has
    ``practice = false``.

    Raises
    ------
    BadCourse
        A key or value of ``[feedback]`` is wrong.
    """
    stated = course.folder.settings.get("feedback", {})
    source = "exercises/course.toml: [feedback]"
    if not isinstance(stated, Mapping):
        raise BadCourse("{source} is a table: practice = false", source=source)
    for key in stated:
        if key not in _SETTINGS:
            raise BadCourse(
                "{source} has no {key!r}{near}", source=source, key=key, near=nearest(str(key), _SETTINGS)
            )
    offers = stated.get("practice", True)
    if not isinstance(offers, bool):
        raise BadCourse("{source}: practice is true or false; found {offers!r}", source=source, offers=offers)
    return offers
