"""Pools: variants of exercises or of an assignment, from which a platform draws."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import chain, islice
from pathlib import Path
from typing import Any, TypeVar

from coursework.course.course import Course
from coursework.course.exercise import CourseExercise
from coursework.course.secrecy import Secret
from coursework.course.variant import Variant
from coursework.errors import BadInput
from coursework.issuing.assignment import AskedExercise, Assignment, text_in
from coursework.issuing.flaws import try_judges
from coursework.issuing.issuing import Issue, chosen_parts, distinct_variants, drawn_by
from coursework.issuing.variant_assignment import keyed, with_points
from coursework.language.words import words
from coursework.markup.markdown import plain_line
from coursework.platforms.items import MadeItem, Pool, section
from coursework.platforms.platform import Platform, made_items
from coursework.rendering.renderer import renderer_of
from coursework.system.processes import Task, in_turn, workers

_TRIED = 24  #: variants in the sample that finds the most frequent parts
_CHUNK = 16  #: variants per task of a process
_WORTH_PROCESSES = 40  #: variants; fewer are made faster than a process starts
_USUAL = 1 / 3  #: least share of them with the same parts, if the pool uses those parts

T = TypeVar("T", bound=Any)


class DrawnPool:
    """Variants of a pool, drawn once and presented in each language."""

    def __init__(
        self,
        course: Course[Any],
        exercises: Sequence[AskedExercise],
        count: int,
        *,
        first_seed: int = 0,
        langs: Sequence[str],
        assignment: Assignment | None = None,
        secret: Secret | None = None,
    ):
        #: Stored in ``issued.json`` if the assignment's file has none.
        self.secret = secret if assignment and assignment.secret is None else None
        own_secret = assignment.secret or secret if assignment else None
        self._key = keyed(own_secret, assignment) if assignment and own_secret else None
        self.course, self.assignment, self.langs = course, assignment, tuple(langs)
        for exercise in exercises:
            _check_languages(course[exercise.name], langs)
        self.variants = [
            self._drawn(course[asked_exercise.name], asked_exercise, count, first_seed)
            for asked_exercise in exercises
        ]

    @property
    def name(self) -> str:
        """Return the prefix of the identifiers."""
        label = self.assignment.name if self.assignment else "coursework"
        return re.sub(r"[^A-Za-z0-9_-]+", "-", label).strip("-") or "coursework"

    def _drawn(
        self, exercise: CourseExercise[Any], asked_exercise: AskedExercise, count: int, first_seed: int
    ) -> list[Any]:
        """Return variants that ask the same parts, all different while such variants last."""
        lang = self.langs[0]
        fixed_seed, stated = asked_exercise.fixed_seed(exercise), asked_exercise.given
        if fixed_seed is not None:
            variants: list[Any] = [
                exercise.variant(fixed_seed, lang, asked_exercise.parts, self._key, stated)
            ]
        else:
            fits = alike(exercise, first_seed, asked_exercise.parts)
            if self.assignment is None:
                variants = distinct_variants(
                    exercise, first_seed, count, lang, parts=asked_exercise.parts, fits=fits
                )
            else:
                places = [f"pool {index}" for index in range(count)]
                drawn, _ = drawn_by(
                    self.assignment.name,
                    exercise,
                    places,
                    lang,
                    asked_exercise.parts,
                    fits=fits,
                    secret=self._key,
                    stated=stated,
                )
                variants = [drawn[index] for index in places]
        try_judges(variants[0].key)
        return [with_points(variant, asked_exercise) for variant in variants]

    @property
    def issues(self) -> tuple[Issue, ...]:
        """Return every variant, without owner."""
        return tuple(
            Issue("", variant, self.langs, f"{variant.seed:05d}")
            for variants in self.variants
            for variant in variants
        )

    def pool(
        self, lang: str, platform: Platform, progress: Callable[[MadeItem], None] = lambda made: None
    ) -> Pool:
        """Return the pool in a language, as a platform's files hold it."""
        made = self._made(lang, platform, progress)
        return Pool(
            self.name,
            self._title(lang),
            lang,
            tuple(section(list(islice(made, len(some)))) for some in self.variants),
            renderer_of(self.course.folder).template_folders,
            Path(self.course.folder.root),
            self.assignment,
        )

    def _made(
        self, lang: str, platform: Platform, progress: Callable[[MadeItem], None]
    ) -> Iterator[MadeItem]:
        """Yield each variant as it is made, by as many processes as are worth it; nothing else of it is
        kept."""
        chunks = [some[at : at + _CHUNK] for some in self.variants for at in range(0, len(some), _CHUNK)]
        tasks = (
            Task(
                f"{chunk[0].exercise.name} {chunk[0].seed}",
                made_items,
                (platform.name, [variant.in_language(lang) for variant in chunk], self.name),
            )
            for chunk in chunks
        )
        count = workers(sum(map(len, chunks)), _WORTH_PROCESSES)
        results = in_turn(tasks, count) if count > 1 else (task.function(*task.arguments) for task in tasks)
        for made in chain.from_iterable(results):
            progress(made)
            yield made

    def _title(self, lang: str) -> str:
        heading = text_in(self.assignment.title, lang) or self.assignment.name if self.assignment else ""
        return heading or plain_line(self.course.folder.title(lang), lang)


def of_exercises(
    course: Course[Any],
    names: Sequence[str],
    count: int,
    first_seed: int,
    langs: Sequence[str],
    parts: Sequence[str] | None,
) -> DrawnPool:
    """Return a pool of exercises by name, from the first seed on.

    Raises
    ------
    BadInput, Starved, UnknownName
        As :func:`coursework.issuing.issuing.issue`.
    """
    chosen = chosen_parts(course, names, parts)
    exercises = [AskedExercise(name, chosen[name]) for name in names]
    return DrawnPool(course, exercises, count, first_seed=first_seed, langs=langs)


def of_assignment(
    course: Course[Any],
    assignment: Assignment,
    count: int,
    langs: Sequence[str],
    secret: Secret | None = None,
) -> DrawnPool:
    """Return a pool of each exercise of an assignment; ``secret`` keys its draws if the assignment's file has
    none.

    Raises
    ------
    ValueError
        There is no secret at all: public words would draw the pool.
    """
    if secret is None and assignment.secret is None:
        raise ValueError(f"{assignment.name} has no secret")
    return DrawnPool(course, assignment.exercises, count, langs=langs, assignment=assignment, secret=secret)


def alike(
    exercise: CourseExercise[Any], first_seed: int, parts: Sequence[str] | None
) -> Callable[[Variant], bool]:
    """Return whether a variant fits the pool: it asks the most frequent parts, or has the most frequent
    points if parts vary."""
    tried = [v for v in exercise.variants(range(first_seed, first_seed + _TRIED), None, parts) if v.parts]
    if not tried:
        raise BadInput(
            "{exercise}: its variants ask none of the parts; name others, or none", exercise=exercise.name
        )
    usual, often = _most_common(v.part_ids for v in tried)
    if often >= _USUAL * len(tried):
        return lambda variant: variant.part_ids == usual
    points, _ = _most_common(_points(v) for v in tried)
    return lambda variant: _points(variant) == points


def _points(variant: Variant) -> tuple[float, int]:
    """Return the points of a variant and its number of questions."""
    return sum(part.points for part in variant.parts), len(variant.parts)


def _most_common(values: Iterable[T]) -> tuple[T, int]:
    """Return the most frequent value, the largest of several, and its count."""
    counts = Counter(values)
    most = max(counts, key=lambda value: (counts[value], value))
    return most, counts[most]


def _check_languages(exercise: CourseExercise[Any], langs: Sequence[str]) -> None:
    for lang in langs:
        words(lang)
        if lang not in exercise.languages:
            have = ", ".join(exercise.languages) or "none"
            raise BadInput(
                "{exercise} has no text in {lang!r}; it has {have}",
                exercise=exercise.name,
                lang=lang,
                have=have,
            )
