"""Who gets which variant: distinct draws, what was issued, and the key to it."""

from __future__ import annotations

import hashlib
import math
from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol, Self, TypeVar

from coursework.course import draws
from coursework.course.answer_key import Key
from coursework.course.asked import Asked
from coursework.course.course import Course
from coursework.course.exercise import ALL, USUAL, CourseExercise
from coursework.course.secrecy import Secret
from coursework.course.variant import Variant
from coursework.errors import BadInput, NoSolution, Starved, counted, unknown
from coursework.kinds.kind import Asking
from coursework.making.flaws import try_judges
from coursework.making.protection import worthy
from coursework.making.roster import Student
from coursework.making.students import file_stems
from coursework.sheets.sheet import AnswerSheet, Handout, StudySheet

V = TypeVar("V", bound=Variant)


def distinct_variants(
    exercise: CourseExercise[V],
    first_seed: int,
    count: int,
    lang: str,
    refused: Counter[str] | None = None,
    parts: Sequence[str] | None = None,
    fits: Callable[[V], bool] | None = None,
) -> list[V]:
    """``count`` variants of different given values that are worth issuing, from the first seed on.

    ``parts`` are the ids of those to ask; a variant that asks none of them is passed over, and so is one that
    does not fit, where ``fits`` is told.

    Equal ones are passed over, and so are those that mark badly (:mod:`coursework.making.flaws`); ``refused`` counts
    these by their flaw.

    Raises
    ------
    NoSolution
        The course folder is a students' copy, which cannot tell those that mark badly.
    Starved
        Fewer exist, or so few that they are not found; says how many, and what refuses most.
    """
    _check_can_tell(exercise)
    found: dict[tuple, V] = {}
    refused = Counter() if refused is None else refused
    seed = first_seed
    limit = first_seed + 100 * count + 1000
    while len(found) < count and seed < limit:
        # As many as are missing, should as many of these be good as of those before.
        good = (len(found) + 1) / (seed - first_seed + 1)
        batch = range(seed, min(limit, seed + max(16, math.ceil((count - len(found)) / good))))
        drawn = exercise.variants(batch, lang, parts)
        asking = _that_ask(drawn, fits)
        if len(asking) < len(drawn):
            refused["asks none of the parts" if fits is None else "asks other parts"] += len(drawn) - len(
                asking
            )
            drawn = asking
        for variant in worthy(exercise, drawn, refused):
            found.setdefault(tuple(variant.given.values()), variant)
            if len(found) == count:
                break
        seed = batch.stop
    if len(found) < count:
        exist = draws.population(exercise.drawing)
        told = f"{len(found)} found" if exist is None or refused else f"only {exist} exist"
        flaws = ", ".join(f"{flaw} ({counted(n, 'time')})" for flaw, n in refused.most_common(3))
        told += f"; passed over as {flaws}" if flaws else ""
        raise Starved(
            f"{exercise.name}: {counted(count, 'different variant')} asked, {told}; "
            "ask for fewer, widen a range or make a step finer"
        )
    return list(found.values())


def _check_can_tell(exercise: CourseExercise[Any]) -> None:
    """A students' copy would issue what the full course passes over, and so others than it does."""
    if not exercise.folder.has_solutions:
        raise NoSolution(
            f"{exercise.name}: {exercise.folder.label} has no solutions/, as a students' copy, and cannot tell which "
            "variants the full course passes over; 'coursework build --issued issued.json' writes the sheets of what was "
            "issued: ask the teacher for that file, or for the sheets"
        )


def _that_ask(variants: Sequence[V], fits: Callable[[V], bool] | None) -> list[V]:
    """Those that ask something, and fit."""
    return [v for v in variants if v.parts and (fits is None or fits(v))]


SEEDS = 1_000_000  #: seeds that are drawn by student have six digits at most
_ROUNDS = 1000  #: draws for one student before variants are said to be used up
_ALIKE = 60  #: the same where all that they draw has been dealt already
_TOGETHER = 256  #: draws that are tried together


def seed_for(stream: str, exercise: str, who: str, round_: int, secret: Secret | None = None) -> int:
    """The seed that somebody draws in a round, the same for ever; with the secret of an assignment, the code."""
    key = f"coursework/assignment/{stream}/{exercise}/{who}/{round_}"
    bits = hashlib.shake_128(key.encode()).digest(8) if secret is None else secret.digest("code", key)[:8]
    return int.from_bytes(bits, "little") % SEEDS


def drawn_by(
    stream: str,
    exercise: CourseExercise[V],
    people: Sequence[str],
    lang: str,
    parts: Sequence[str] | None = None,
    taken: set[tuple[Any, ...]] | None = None,
    fits: Callable[[V], bool] | None = None,
    secret: Secret | None = None,
    known: Mapping[int, tuple[Any, ...]] | None = None,
) -> tuple[dict[str, V], list[str]]:
    """A variant for each of some people that hangs on them and not on their order, and who shares theirs with another.

    All are different, and none has the given values that are ``taken``, while variants last; each ``fits``,
    where that is told. With the ``secret`` of an assignment nobody draws them without it. ``known`` are the given
    values of what was issued by seed, perhaps without the secret: none of these seeds stands for other values.

    Raises
    ------
    NoSolution
        As :func:`distinct_variants`.
    Starved
        No variant that is worth issuing was found for somebody.
    """
    _check_can_tell(exercise)
    taken = set() if taken is None else taken
    known = {} if known is None else known
    found: dict[str, V] = {}
    spare: dict[str, V] = {}  # worth issuing, though somebody has the same
    refused: Counter[str] = Counter()
    waiting = list(people)
    round_, together = 0, 1
    while waiting and round_ < (_ALIKE if spare.keys() >= set(waiting) else _ROUNDS):
        rounds = range(round_, min(round_ + together, _ROUNDS))
        seeds = {(r, who): seed_for(stream, exercise.name, who, r, secret) for r in rounds for who in waiting}
        drawn = _that_ask(exercise.variants(list(dict.fromkeys(seeds.values())), lang, parts, secret), fits)
        drawn = [v for v in drawn if known.get(v.seed, given := tuple(v.given.values())) == given]
        by_seed = {v.seed: v for v in worthy(exercise, drawn, refused)}
        for r in rounds:
            # Who is first where two draw the same hangs on the draw, not on the roster.
            for who in sorted(waiting, key=lambda who: (seeds[r, who], who)):
                variant = by_seed.get(seeds[r, who])
                if variant is not None and (given := tuple(variant.given.values())) not in taken:
                    taken.add(given)
                    found[who] = variant
                elif variant is not None:
                    spare.setdefault(who, variant)
            waiting = [who for who in waiting if who not in found]
        round_ = rounds.stop
        together = max(1, min(2 * together, _TOGETHER // max(1, len(waiting))))
    shared = [who for who in waiting if who in spare]
    found |= {who: spare[who] for who in shared}
    if len(found) < len(people):
        flaws = ", ".join(f"{flaw} ({counted(n, 'time')})" for flaw, n in refused.most_common(3))
        raise Starved(
            f"{exercise.name}: no variant that is worth issuing was found for "
            f"{counted(len(people) - len(found), 'student')}{f'; passed over as {flaws}' if flaws else ''}; "
            "widen a range or make a step finer"
        )
    return found, shared


class Issuable(Asked, Asking, Protocol):
    """A variant that can say what its sheets show."""

    @property
    def key(self) -> Key: ...

    @property
    def seed(self) -> int: ...

    @property
    def record(self) -> dict[str, Any]: ...

    def in_language(self, lang: str) -> Self: ...

    def handout(self, student: str = "") -> Handout: ...

    def answer_sheet(self, student: str = "", *, polygons: bool = True) -> AnswerSheet: ...

    def study_sheet(self, student: str = "") -> StudySheet: ...


@dataclass(frozen=True)
class Issue:
    """One variant for one student, in the languages it is printed in."""

    student: str
    variant: Issuable
    langs: tuple[str, ...]
    stem: str  #: what its files are called
    sitting: int = 1  #: 2 for who makes up
    version: str = ""  #: A to D, where versions are dealt out
    columns: Mapping[str, str] = field(default_factory=dict)  #: of the student's line in the roster


def issue(
    course: Course,
    names: Sequence[str],
    *,
    first_seed: int,
    count: int,
    langs: Sequence[str],
    roster: Sequence[Student] = (),
    parts: Sequence[str] | None = None,
) -> list[Issue]:
    """One variant of each exercise for each student, which hangs on the student and not on a place in the roster; or
    ``count`` variants from the first seed on when there is no roster.

    ``parts`` are ids of parts to ask instead of the usual ones: of each exercise those that it has.

    Raises
    ------
    UnknownName
        A part that none of the exercises has.
    Starved
        An exercise has not enough different variants.
    NoSolution
        The course folder is a students' copy.
    BadInput
        An exercise has no text in one of the languages.
    """
    issues = []
    students = list(roster) or [Student("")] * count
    stems = file_stems(s.name for s in students)
    asked = chosen_parts(course, names, parts)
    for name in names:
        exercise = course[name]
        check_languages(exercise, langs)
        check_languages(exercise, *whose_languages(students))
        variants: list[Any]
        if roster:
            people = [student.who for student in roster]
            drawn, _ = drawn_by(str(first_seed), exercise, people, langs[0], asked[name])
            variants = [drawn[who] for who in people]
        else:
            variants = distinct_variants(exercise, first_seed, len(students), langs[0], parts=asked[name])
        if variants:
            try_judges(variants[0].key)
        for student, stem, variant in zip(students, stems, variants, strict=True):
            own = (student.lang,) if student.lang else tuple(langs)
            stem = stem or f"{variant.seed:05d}"
            issues.append(
                Issue(student.name, variant.in_language(own[0]), own, stem, columns=student.columns)
            )
    return issues


def whose_languages(students: Sequence[Student]) -> tuple[dict[str, str], str]:
    """Return the first student of each language that lines of a roster say, and words that tell whose line it is."""
    first = {student.lang: student.name for student in reversed(students) if student.lang}
    return first, ", which the line of {name} in the roster asks for"


def check_languages(
    exercise: CourseExercise[Any], langs: Collection[str] | Mapping[str, str], whose: str = ""
) -> None:
    """Stop at a language that an exercise has no text in; ``whose`` tells whose ``langs[lang]`` it is.

    Raises
    ------
    BadInput
        Says which it has.
    """
    for lang in langs:
        if lang not in exercise.languages:
            have = ", ".join(exercise.languages) or "none"
            asked = whose.format(name=langs[lang]) if isinstance(langs, Mapping) else ""
            raise BadInput(f"{exercise.name} has no text in {lang!r}{asked}; it has {have}")


def chosen_parts(
    course: Course, names: Sequence[str], parts: Sequence[str] | None
) -> Mapping[str, tuple[str, ...] | None]:
    """For each exercise, those of the parts that it has; None for the usual ones.

    Raises
    ------
    UnknownName
        A part that none of the exercises has.
    BadInput
        An exercise has none of the parts.
    """
    if parts is None:
        return dict.fromkeys(names)
    own = {name: {USUAL, ALL, *(p.id for p in course[name].spec.parts)} for name in names}
    for part in parts:
        if not any(part in ids for ids in own.values()):
            known = dict.fromkeys(p.id for name in names for p in course[name].spec.parts)
            raise unknown("part", part, [*known, USUAL, ALL], ", ".join(names))
    found = {name: tuple(p for p in parts if p in own[name]) for name in names}
    for name, some in found.items():
        if not some:
            raise BadInput(f"{name} has none of the parts {', '.join(parts)}; build it by itself")
    return found
