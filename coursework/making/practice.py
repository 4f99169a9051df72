"""What to try after an exercise: another variant, and the lesson that teaches it."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from contextlib import suppress
from copy import copy
from typing import Any

from coursework.course.builtin import builtin_root
from coursework.course.course import Course
from coursework.course.exercise import CourseExercise
from coursework.course.lessons import taught_by
from coursework.errors import BadCourse, CourseworkError, Starved, nearest
from coursework.making.issued import Issued
from coursework.making.issuing import distinct_variants
from coursework.sheets.handout import handout
from coursework.sheets.sheet import Lesson, Practice, Question

_TRIES = 40  #: variants that are looked at for one that was not issued

Given = Mapping[str, Any]


class PracticeOf:
    """Finds what to try next for the students of one build, each exercise's variant once.

    A variant that nobody was issued is offered, or where all were issued one that the student was not; which one
    hangs on what was issued alone. A course that states ``practice = false`` in ``[feedback]`` offers none.
    """

    def __init__(self, course: Course, issued: Issued) -> None:
        self._course, self._issued = course, issued
        self._offers = offers_practice(course)
        self._fresh: dict[str, int | None] = {}
        self._lessons: dict[tuple[str, str], tuple[Lesson, ...]] = {}
        self._questions: dict[tuple[str, int, str], tuple[Question, ...]] = {}

    def after(self, exercise: str, student: str, lang: str) -> Practice:
        """What ``student`` may try after an exercise, told in a language."""
        own = self._course[exercise]
        root = own.folder.root
        seed = self._seed(own, student) if self._offers else None
        return Practice(
            exercise,
            own.version,
            "" if root == builtin_root().resolve() else root.name,
            seed,
            self._taught(own, lang),
            () if seed is None else self._asked(exercise, seed, lang),
        )

    def of_student(self, issued: Issued) -> PracticeOf:
        """The same for one student, of whose part of what was issued alone it holds: little to send elsewhere."""
        own = copy(self)
        for exercise in issued.exercises if self._offers else ():
            with suppress(CourseworkError):  # told where it is asked for
                self._of_nobody(self._course[exercise])
        own._issued, own._fresh = issued, self._fresh
        return own

    def _taught(self, exercise: CourseExercise, lang: str) -> tuple[Lesson, ...]:
        place = exercise.name, lang
        if place not in self._lessons:
            self._lessons[place] = taught_by(exercise.folder, exercise.name, lang)
        return self._lessons[place]

    def _asked(self, exercise: str, seed: int, lang: str) -> tuple[Question, ...]:
        """The questions of a variant, which may ask other parts than the student's own."""
        place = exercise, seed, lang
        if place not in self._questions:
            self._questions[place] = handout(self._course[exercise].variant(seed, lang)).questions
        return self._questions[place]

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
    """The first seed worth issuing, from 1 on, whose variant is none of the records; None where none is found."""
    given = [record.get("given") for record in records.values()]
    lang, seed = exercise.languages[0], _first_free(1, records)
    try:
        for _ in range(_TRIES):
            (variant,) = distinct_variants(exercise, seed, 1, lang)
            if variant.seed not in records and variant.record["given"] not in given:
                return int(variant.seed)
            seed = _first_free(variant.seed + 1, records)
    except Starved:
        pass
    return None


def _first_free(seed: int, taken: Collection[int]) -> int:
    while seed in taken:
        seed += 1
    return seed


_SETTINGS = ("practice",)


def offers_practice(course: Course) -> bool:
    """Whether feedback offers another variant: unless ``[feedback]`` in ``course.toml`` says ``practice = false``.

    Raises
    ------
    BadCourse
        ``[feedback]`` says what makes no sense.
    """
    stated = course.folder.settings.get("feedback", {})
    source = "exercises/course.toml: [feedback]"
    if not isinstance(stated, Mapping):
        raise BadCourse(f"{source} is a table: practice = false")
    for key in stated:
        if key not in _SETTINGS:
            raise BadCourse(f"{source} has no {key!r}{nearest(str(key), _SETTINGS)}")
    offers = stated.get("practice", True)
    if not isinstance(offers, bool):
        raise BadCourse(f"{source}: practice is true or false; found {offers!r}")
    return offers
