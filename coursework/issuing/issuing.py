"""Issuing of variants: distinct draws for students, and the exercises' answer keys."""

from __future__ import annotations

import hashlib
import math
from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol, Self, TypeVar

from coursework.course.answer_key import Key
from coursework.course.asked import KeySource
from coursework.course.course import Course
from coursework.course.draws import NONE_STATED, Stated
from coursework.course.exercise import ALL, USUAL, CourseExercise
from coursework.course.secrecy import Secret
from coursework.course.variant import Variant
from coursework.errors import BadInput, Starved, counted, unknown
from coursework.issuing.flaws import try_judges
from coursework.issuing.protection import valid_variants
from coursework.issuing.roster import Student
from coursework.issuing.students import file_stems
from coursework.kinds.kind import Asking
from coursework.messages import Message, joined_notes
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
    stated: Stated = NONE_STATED,
) -> list[V]:
    """Return ``count`` variants of different given values that are worth issuing, from the first seed on.

    Equal variants are skipped, and so are those that mark badly (:mod:`coursework.issuing.flaws`).

    Parameters
    ----------
    exercise, lang
        The exercise, and the language of the variants.
    first_seed, count
        The first seed to try, and the number of variants.
    refused
        Counter of skipped variants by their flaw, filled in.
    parts
        Ids of the parts to ask; a variant that asks none of them is skipped.
    fits
        Further condition on a variant.
    stated
        Given values that are not drawn.

    Raises
    ------
    Starved
        Too few variants exist or were found; the message gives the number and the most frequent flaws.
    """
    by_values: dict[tuple, V] = {}
    refused = Counter() if refused is None else refused
    seed = first_seed
    limit = first_seed + 100 * count + 1000
    while len(by_values) < count and seed < limit:
        # Enough for the missing ones at the share of good variants so far.
        good = (len(by_values) + 1) / (seed - first_seed + 1)
        batch = range(seed, min(limit, seed + max(16, math.ceil((count - len(by_values)) / good))))
        drawn = exercise.variants(batch, lang, parts, given=stated)
        asking = _that_ask(drawn, fits)
        if len(asking) < len(drawn):
            flaw = Message("asks none of the parts") if fits is None else Message("asks other parts")
            refused[flaw] += len(drawn) - len(asking)
            drawn = asking
        for variant in valid_variants(exercise, drawn, refused):
            by_values.setdefault(tuple(variant.given.values()), variant)
            if len(by_values) == count:
                break
        seed = batch.stop
    if len(by_values) < count:
        exist = exercise.draws.population()
        reason = (
            Message("{count} found", count=len(by_values))
            if exist is None or refused
            else Message("only {count} exist", count=exist)
        )
        raise Starved(
            (
                "{exercise}: {variants} requested, {reason}{flaws}; request fewer, widen a range or "
                "make a step finer{digits}"
            ),
            exercise=exercise.name,
            variants=counted(count, "different variant"),
            reason=reason,
            flaws=_passed_over(refused),
            digits=Message(", or let students keep more digits ([marking], then digits = 6)")
            if any(flaw.startswith("ill-conditioned") for flaw in refused)
            else "",
        )
    return list(by_values.values())


def _passed_over(refused: Counter[str]) -> str:
    """Return the most frequent flaws of the skipped variants, for a message; empty if there is none."""
    if not refused:
        return ""
    flaws = (Message("{flaw} ({number}×)", flaw=f, number=n) for f, n in refused.most_common(3))
    return Message("; skipped: {flaws}", flaws=joined_notes(flaws, ", "))


def _that_ask(variants: Sequence[V], fits: Callable[[V], bool] | None) -> list[V]:
    """Return the variants that ask a part and fit."""
    return [v for v in variants if v.parts and (fits is None or fits(v))]


SEEDS = 1_000_000  #: seeds drawn by student have at most six digits
_ROUNDS = 1000  #: draws for one student before variants count as used up
_ALIKE = 60  #: the same if all their draws are in use already
_TOGETHER = 256  #: draws that are computed together


def seed_for(stream: str, exercise: str, person: str, round_: int, secret: Secret | None = None) -> int:
    """Return the seed of a person in a round, always the same; with the secret of an assignment, a code."""
    key = f"coursework/assignment/{stream}/{exercise}/{person}/{round_}"
    bits = hashlib.shake_128(key.encode()).digest(8) if secret is None else secret.digest("code", key)[:8]
    return int.from_bytes(bits, "little") % SEEDS


def drawn_by(
    stream: str,
    exercise: CourseExercise[V],
    people: Sequence[str],
    lang: str,
    parts: Sequence[str] | None = None,
    used_values: set[tuple[Any, ...]] | None = None,
    fits: Callable[[V], bool] | None = None,
    secret: Secret | None = None,
    issued_values: Mapping[int, tuple[Any, ...]] | None = None,
    stated: Stated = NONE_STATED,
) -> tuple[dict[str, V], list[str]]:
    """Return a variant for each person, independent of their order, and the people who share theirs.

    Parameters
    ----------
    stream
        Name that separates the draws of different assignments.
    people
        Keys of the people.
    used_values
        Given values that no variant may have; those of the result are added. All variants differ while
        variants last.
    fits
        Further condition on a variant.
    secret
        Secret of an assignment, without which nobody can repeat the draws.
    issued_values
        Given values of earlier variants by seed: none of these seeds is used for other values.
    stated
        Given values that are not drawn.

    Raises
    ------
    Starved
        No variant worth issuing was found for somebody.
    """
    used_values = set() if used_values is None else used_values
    issued_values = {} if issued_values is None else issued_values
    variants: dict[str, V] = {}
    spare: dict[str, V] = {}  # valid, but in use by another student
    refused: Counter[str] = Counter()
    waiting = list(people)
    round_, together = 0, 1
    while waiting and round_ < (_ALIKE if spare.keys() >= set(waiting) else _ROUNDS):
        rounds = range(round_, min(round_ + together, _ROUNDS))
        seeds = {
            (r, person): seed_for(stream, exercise.name, person, r, secret)
            for r in rounds
            for person in waiting
        }
        some = exercise.variants(list(dict.fromkeys(seeds.values())), lang, parts, secret, stated)
        drawn = _that_ask(some, fits)
        drawn = [v for v in drawn if issued_values.get(v.seed, given := tuple(v.given.values())) == given]
        by_seed = {v.seed: v for v in valid_variants(exercise, drawn, refused)}
        for r in rounds:
            # If two draw the same, the draw decides who gets it, not the roster.
            for person in sorted(waiting, key=lambda person: (seeds[r, person], person)):
                variant = by_seed.get(seeds[r, person])
                if variant is not None and (given := tuple(variant.given.values())) not in used_values:
                    used_values.add(given)
                    variants[person] = variant
                elif variant is not None:
                    spare.setdefault(person, variant)
            waiting = [person for person in waiting if person not in variants]
        round_ = rounds.stop
        together = max(1, min(2 * together, _TOGETHER // max(1, len(waiting))))
    shared = [person for person in waiting if person in spare]
    variants |= {person: spare[person] for person in shared}
    if len(variants) < len(people):
        raise Starved(
            (
                "{exercise}: no valid variant was found for {students}{flaws}; widen a range or make a "
                "step finer"
            ),
            exercise=exercise.name,
            students=counted(len(people) - len(variants), "student"),
            flaws=_passed_over(refused),
        )
    return variants, shared


def reservations(exercise: CourseExercise[V], variant: V) -> list[str]:
    """Return a note on a variant of stated values that would not have been drawn; none for any other.

    Raises
    ------
    CannotAssemble, Undefined
        An answer does not exist for these values.
    """
    variant.solution()
    refused = Counter(exercise.draws.refusing(variant.given))
    valid_variants(exercise, [variant], refused)
    if not refused:
        return []
    return [
        Message(
            "{exercise}: a draw would refuse these values, where a wrong answer may pass for right, or "
            "rounding cost a right one: {flaws}",
            exercise=exercise.name,
            flaws=joined_notes(refused, ", "),
        )
    ]


class Issuable(KeySource, Asking, Protocol):
    """Variant that provides the content of its sheets."""

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
    """Variant of one student, in the languages of its sheets."""

    student: str
    variant: Issuable
    langs: tuple[str, ...]
    stem: str  #: stem of the names of its files
    sitting: int = 1  #: 2 for a make-up
    version: str = ""  #: A to D, if there are versions
    columns: Mapping[str, str] = field(default_factory=dict)  #: of the student's row in the roster
    code: str = ""  #: that stands on an anonymous paper in place of the name

    @property
    def shown(self) -> str:
        """Return what stands on the paper: the code, else the name."""
        return self.code or self.student


def issue(
    course: Course,
    names: Sequence[str],
    *,
    first_seed: int,
    count: int,
    langs: Sequence[str],
    roster: Sequence[Student] = (),
    parts: Sequence[str] | None = None,
    given: Mapping[str, Any] | None = None,
    note: Callable[[str], None] = lambda text: None,
) -> list[Issue]:
    """Return one variant of each exercise for each student, by the student and not by the position in the
    roster; without a roster, ``count`` variants from the first seed on.

    ``parts`` are ids of parts to ask instead of the usual ones; each exercise asks those that it has.
    ``given`` states values that are not drawn; each exercise takes those that it has. ``note`` is called with
    notes for the user.

    Raises
    ------
    UnknownName
        A part, or a given quantity, that none of the exercises has.
    Starved
        An exercise has not enough different variants.
    BadInput
        An exercise has no text in one of the languages.
    """
    issues = []
    students = list(roster) or [Student("")] * count
    stems = file_stems(s.name for s in students)
    asked_parts = chosen_parts(course, names, parts)
    values = stated_values(course, names, given or {})
    for name in names:
        exercise = course[name]
        check_languages(exercise, langs)
        check_languages(exercise, *whose_languages(students))
        variants: list[Any]
        stated, some = values[name], asked_parts[name]
        if exercise.draws.is_whole(stated):
            variants = [exercise.variant(first_seed, langs[0], some, given=stated)] * (len(roster) or 1)
            for text in reservations(exercise, variants[0]):
                note(text)
        elif roster:
            people = [student.draw_key for student in roster]
            drawn, _ = drawn_by(str(first_seed), exercise, people, langs[0], some, stated=stated)
            variants = [drawn[person] for person in people]
        else:
            variants = distinct_variants(
                exercise, first_seed, len(students), langs[0], parts=some, stated=stated
            )
        if variants:
            try_judges(variants[0].key)
        for student, stem, variant in zip(students, stems, variants, strict=False):
            student_langs = (student.lang,) if student.lang else tuple(langs)
            stem = stem or f"{variant.seed:05d}"
            issues.append(
                Issue(
                    student.name,
                    variant.in_language(student_langs[0]),
                    student_langs,
                    stem,
                    columns=student.columns,
                )
            )
    return issues


def whose_languages(students: Sequence[Student]) -> tuple[dict[str, str], str]:
    """Return the first student of each language in a roster, and the words of a message that name the
    student's row."""
    first = {student.lang: student.name for student in reversed(students) if student.lang}
    return first, ", which the line of {name} in the roster requests"


def check_languages(
    exercise: CourseExercise[Any], langs: Collection[str] | Mapping[str, str], source: str = ""
) -> None:
    """Raise at a language in which an exercise has no text; ``source`` is the message's text on the origin of
    ``langs[lang]``.

    Raises
    ------
    BadInput
        The message names the languages of the exercise.
    """
    for lang in langs:
        if lang not in exercise.languages:
            have = ", ".join(exercise.languages) or Message("none")
            origin = Message(source, name=langs[lang]) if isinstance(langs, Mapping) else ""
            raise BadInput(
                "{exercise} has no text in {lang!r}{origin}; it has {have}",
                exercise=exercise.name,
                lang=lang,
                origin=origin,
                have=have,
            )


def stated_values(
    course: Course, names: Sequence[str], given: Mapping[str, Any]
) -> Mapping[str, Mapping[str, float | str]]:
    """Return for each exercise those of the values that it has, in canonical units.

    Raises
    ------
    UnknownName
        A quantity that is given in none of the exercises.
    WrongUnit, WrongValue
        No value of the quantity.
    """
    quantities = {name: course[name].spec.given for name in names}
    for quantity in given:
        if not any(quantity in of for of in quantities.values()):
            known = dict.fromkeys(quantity for of in quantities.values() for quantity in of)
            raise unknown("quantity", quantity, known, ", ".join(names))
    return {
        name: course[name].stated({n: value for n, value in given.items() if n in quantities[name]})
        for name in names
    }


def chosen_parts(
    course: Course, names: Sequence[str], parts: Sequence[str] | None
) -> Mapping[str, tuple[str, ...] | None]:
    """Return for each exercise those of the parts that it has; None for the usual ones.

    Raises
    ------
    UnknownName
        A part that none of the exercises has.
    BadInput
        An exercise has none of the parts.
    """
    if parts is None:
        return dict.fromkeys(names)
    ids_of = {name: {USUAL, ALL, *(p.id for p in course[name].spec.parts)} for name in names}
    for part in parts:
        if not any(part in ids for ids in ids_of.values()):
            part_ids = dict.fromkeys(p.id for name in names for p in course[name].spec.parts)
            raise unknown("part", part, [*part_ids, USUAL, ALL], ", ".join(names))
    chosen = {name: tuple(p for p in parts if p in ids_of[name]) for name in names}
    for name, some in chosen.items():
        if not some:
            raise BadInput(
                "{name} has none of the parts {parts}; build it by itself", name=name, parts=", ".join(parts)
            )
    return chosen
