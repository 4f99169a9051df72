"""Who gets which variant of an assignment.

A variant depends on the assignment's secret and name, the exercise and the student, never on a place in the roster. What was issued
stays issued: a longer roster adds who is late, and changes nobody else's paper.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import pairwise
from typing import Any, TypeVar

from coursework.course.course import Course
from coursework.course.exercise import CourseExercise
from coursework.course.secrecy import Secret
from coursework.course.variant import Variant
from coursework.errors import BadInput, counted, nearest
from coursework.making.assignment import AskedExercise, Assignment
from coursework.making.flaws import try_judges
from coursework.making.issued import secret_of
from coursework.making.issuing import Issue, check_languages, drawn_by, whose_languages
from coursework.making.roster import Student
from coursework.making.students import called, file_stems, folded
from coursework.model import Part

V = TypeVar("V", bound=Variant)

_STEP = Fraction(1, 4)  #: of points that are shared out


@dataclass
class Dealt:
    """What was dealt, and what should be known of it."""

    issues: list[Issue]
    notes: list[str] = field(default_factory=list)
    secret: Secret | None = None  #: to be kept where the assignment's file has none
    is_new: bool = False  #: the secret was created now


def deal(
    course: Course[Any],
    assignment: Assignment,
    students: Sequence[Student],
    langs: Sequence[str],
    before: Mapping[str, Any] | None = None,
    make_up: Sequence[str] = (),
    secret: Secret | None = None,
) -> Dealt:
    """A paper for each student, and a second one for who makes up; ``before`` is what ``issued.json`` says.

    Draws are keyed by the secret of the assignment's file, else by that of ``before``, else by ``secret``, else by a
    new one. What was issued before without a secret stays as it is.

    Raises
    ------
    BadInput
        What was issued before was of other exercises, an exercise has no text in one of the languages, or who is to
        make up is not there.
    Starved
        An exercise has no variant that is worth issuing.
    """
    hand = _Hand(course, assignment, langs, before, secret)
    everybody = hand.everybody(students)
    sittings = [(student, 1) for student in everybody]
    sittings += [(student, n) for student in everybody for n in range(2, hand.sittings(student.name) + 1)]
    for name in make_up:
        student = _named(name, everybody)
        sittings.append((student, hand.sittings(student.name) + 1))
    versions = hand.versions([student for student, n in sittings if n == 1], students)
    papers: dict[tuple[str, int], list[Any]] = {(hand.of(s), n): [] for s, n in sittings}
    for asked in assignment.exercises:
        for place, variant in zip(papers, hand.variants(asked, sittings, versions), strict=True):
            papers[place].append(variant)
    stems = dict(zip(map(hand.of, everybody), hand.stems(everybody), strict=True))
    issues = []
    for (student, sitting), (place, variants) in zip(sittings, papers.items(), strict=True):
        own = (student.lang,) if student.lang else tuple(langs)
        stem = stems[place[0]] if sitting == 1 else f"{stems[place[0]]}.sitting-{sitting}"
        version = versions.get(place[0], "") if sitting == 1 else ""
        issues += [
            Issue(student.name, v.in_language(own[0]), own, stem, sitting, version, student.columns)
            for v in variants
        ]
    kept = None if assignment.secret is not None else hand.secret
    return Dealt(issues, hand.notes, kept, hand.is_new)


def _named(name: str, students: Sequence[Student]) -> Student:
    found = called(name, (s.name for s in students))
    if found is None:
        raise BadInput(f"no student {name!r} was issued a paper{nearest(name, [s.name for s in students])}")
    return next(s for s in students if s.name == found)


class _Hand:
    """Deals one assignment."""

    def __init__(
        self,
        course: Course[Any],
        assignment: Assignment,
        langs: Sequence[str],
        before: Mapping[str, Any] | None,
        secret: Secret | None = None,
    ):
        self.course, self.assignment, self.langs = course, assignment, langs
        self.notes: list[str] = []
        self.secret = assignment.secret or secret_of(before) or secret
        self.is_new = False
        self._items = list((before or {}).get("issued", ()))
        self._columns = dict((before or {}).get("students", {}))
        self._unnamed: dict[int, str] = {}
        stated = (before or {}).get("assignment")
        if before is not None and (
            stated is None or list(stated.get("exercises", ())) != list(assignment.names)
        ):
            raise BadInput(
                f"{assignment.name} was not issued there as it is now: what is issued stays issued; choose another --out, or "
                "--overwrite to deal anew"
            )
        self._records: dict[tuple[str, str, int], Mapping[str, Any]] = {}
        self._dealt: dict[str, str] = {}
        for number, item in enumerate(self._items):
            name = str(item.get("student", "")) or f"#{number // max(1, len(assignment.names))}"
            place = name, str(item["record"]["exercise"]), int(item.get("sitting", 1))
            self._records[place] = item["record"]
            if item.get("version"):
                self._dealt[name] = str(item["version"])

    @property
    def _key(self) -> Secret:
        """The secret of the draws of this assignment; created with the first draw where there is none."""
        if self.secret is None:
            self.secret, self.is_new = Secret.new(), True
        return keyed(self.secret, self.assignment)

    def of(self, student: Student) -> str:
        """By what a student is told apart: the name, or the place of a paper that is nobody's."""
        return student.name or self._unnamed[id(student)]

    def everybody(self, students: Sequence[Student]) -> list[Student]:
        """The students that were issued a paper, then those who are late; who left the roster is kept, and told."""
        for number, student in enumerate(students):
            if not student.name:
                self._unnamed[id(student)] = f"#{number}"
        issued = list(dict.fromkeys(name for name, _, _ in self._records if not name.startswith("#")))
        there = {folded(s.name): s for s in students}
        gone = [name for name in issued if folded(name) not in there]
        late = [s for s in students if s.name and folded(s.name) not in set(map(folded, issued))]
        if issued and gone:
            self.notes.append(
                f"kept, though no longer on the roster: {', '.join(gone[:5])}{', …' if len(gone) > 5 else ''}"
            )
        if issued and late:
            names = ", ".join(s.name for s in late[:5])
            more = ", …" if len(late) > 5 else ""
            self.notes.append(
                f"{counted(len(issued), 'paper')} issued before stay as they are; added: {names}{more}"
            )
        found = [
            replace(there[folded(name)], name=name)
            if folded(name) in there
            else Student(name, columns=self._columns.get(name, {}))
            for name in issued
        ]
        found += late
        return found + [s for s in students if not s.name]

    def sittings(self, name: str) -> int:
        return max((n for student, _, n in self._records if student == name), default=1)

    def stems(self, everybody: Sequence[Student]) -> list[str]:
        """What files are called: by name, as they were called before; papers of nobody are numbered."""
        digits = max(2, len(str(len(everybody))))
        named = file_stems(s.name for s in everybody)
        return [stem or f"paper-{number:0{digits}}" for number, stem in enumerate(named, start=1)]

    # --------------------------------------------------------------- versions

    def versions(self, everybody: Sequence[Student], roster: Sequence[Student]) -> dict[str, str]:
        """A letter a student, where versions are dealt out: neighbours in the roster and in the room have others."""
        count = self.assignment.versions
        if count is None or count == 1:
            return {}
        letters = [chr(ord("A") + n) for n in range(count)]
        dealt = dict(self._dealt)
        used = Counter(dealt.values())
        order = [self.of(s) for s in everybody]
        beside = _neighbours([s for s in roster if s.name] or everybody, self.of)
        for student in sorted(order, key=lambda name: _place(name, roster, self.of)):
            if student in dealt:
                continue
            near = {dealt.get(other) for other in beside.get(student, ())}
            free = [letter for letter in letters if letter not in near] or letters
            own = {letter: self._key.digest("version", student, letter) for letter in free}
            dealt[student] = min(free, key=lambda letter: (used[letter], own[letter]))
            used[dealt[student]] += 1
        return dealt

    # --------------------------------------------------------------- variants

    def variants(
        self, asked: AskedExercise, sittings: Sequence[tuple[Student, int]], versions: Mapping[str, str]
    ) -> list[Any]:
        """The variant of each sitting: as issued before, else drawn."""
        exercise = self.course[asked.name]
        self._check_languages(exercise, [s for s, _ in sittings])
        found: dict[int, Any] = {}
        for k, (student, sitting) in enumerate(sittings):
            record = self._records.get((self.of(student), asked.name, sitting))
            if record is not None:
                found[k] = exercise.from_record(record)
        missing = {k: self._who(*sittings[k], versions) for k in range(len(sittings)) if k not in found}
        drawn = self._shared(asked, sittings, versions, found)
        if asked.seed is not None and (
            own := {w for k, w in missing.items() if sittings[k][1] == 1} - {*drawn}
        ):
            one = worth(exercise.variant(asked.seed, self.langs[0], asked.parts, self._key), asked)
            drawn |= dict.fromkeys(own, one)
        left = [who for who in dict.fromkeys(missing.values()) if who not in drawn]
        drawn |= self._drawn(exercise, asked, left, found.values()) if left else {}
        found |= {k: drawn[who] for k, who in missing.items()}
        if self.course.folder.has_solutions and found:
            try_judges(found[0].key)
        return [found[k] for k in range(len(sittings))]

    def _shared(
        self,
        asked: AskedExercise,
        sittings: Sequence[tuple[Student, int]],
        versions: Mapping[str, str],
        issued: Mapping[int, Any],
    ) -> dict[str, Any]:
        """Return what several have the same of, as it was issued to the first of them: later ones have it too."""
        shared: dict[str, Any] = {}
        for k, variant in issued.items():
            student, sitting = sittings[k]
            if sitting == 1 and (self.assignment.versions == 1 or versions.get(self.of(student))):
                shared.setdefault(self._who(student, 1, versions), variant)
        fixed = [v for k, v in issued.items() if sittings[k][1] == 1 and v.seed == asked.seed]
        if fixed:
            for student, sitting in sittings:
                if sitting == 1:
                    shared.setdefault(self._who(student, 1, versions), fixed[0])
        return shared

    def _who(self, student: Student, sitting: int, versions: Mapping[str, str]) -> str:
        """What a draw depends on."""
        if sitting > 1:
            return f"{student.who or self.of(student)} sitting {sitting}"
        if self.assignment.versions == 1:
            return "everybody"
        letter = versions.get(self.of(student))
        return f"version {letter}" if letter else student.who if student.name else self.of(student)

    def _check_languages(self, exercise: CourseExercise[Any], students: Iterable[Student]) -> None:
        check_languages(exercise, self.langs)
        check_languages(exercise, *whose_languages(list(students)))

    def _drawn(
        self,
        exercise: CourseExercise[Any],
        asked: AskedExercise,
        people: Sequence[str],
        issued: Iterable[Any],
    ) -> dict[str, Any]:
        """A variant for each: all different while variants last."""
        known = {variant.seed: tuple(variant.given.values()) for variant in issued}
        found, shared = drawn_by(
            self.assignment.name, exercise, people, self.langs[0], asked.parts, set(known.values()),
            secret=self._key, known=known,
        )  # fmt: skip
        if shared:
            self.notes.append(
                f"{exercise.name}: {len(shared)} of {counted(len(people), 'paper')} share a variant with another; so many "
                "different ones do not exist"
            )
        return {who: worth(variant, asked) for who, variant in found.items()}


def keyed(secret: Secret, assignment: Assignment) -> Secret:
    """Return what keys the draws of an assignment: a secret that two assignments share keys other papers in each."""
    return secret.under("assignment", assignment.name)


def worth(variant: V, asked: AskedExercise) -> V:
    """The variant with the points that the assignment gives."""
    if asked.points is None:
        return variant
    if isinstance(asked.points, Mapping):
        points = {p.id: asked.points.get(p.id, p.points) for p in variant.parts}
    else:
        points = shared_out(asked.points, variant.parts)
    parts = [p if p.points == points[p.id] else replace(p, points=points[p.id]) for p in variant.parts]
    return variant.asking(parts)


def shared_out(total: float, parts: Sequence[Part]) -> dict[str, float]:
    """Points for all parts, in proportion to their own, by quarters where the total has so many; their sum is the total."""
    whole = sum(Fraction(p.points) for p in parts)
    exact = {p.id: Fraction(total) * Fraction(p.points) / whole for p in parts}
    quarters = Fraction(total) / _STEP
    if quarters.denominator != 1 or quarters < len(parts):
        return {i: float(x) for i, x in exact.items()}
    found = {i: max(1, int(x / _STEP)) for i, x in exact.items()}
    while sum(found.values()) > quarters:
        most = max(found, key=lambda i: found[i] * _STEP - exact[i])
        found[most] -= 1
    while sum(found.values()) < quarters:
        least = max(found, key=lambda i: exact[i] - found[i] * _STEP)
        found[least] += 1
    return {i: float(n * _STEP) for i, n in found.items()}


# ------------------------------------------------------------------------- room


def _place(name: str, roster: Sequence[Student], of: Any) -> int:
    return next((k for k, s in enumerate(roster) if folded(of(s)) == folded(name)), len(roster))


def _neighbours(roster: Sequence[Student], of: Any) -> dict[str, set[str]]:
    """Who sits or stands beside whom: by place in the roster, and by seat where the roster says seats, ``B12``."""
    found: dict[str, set[str]] = {of(s): set() for s in roster}

    def beside(one: Student, other: Student) -> None:
        found[of(one)].add(of(other))
        found[of(other)].add(of(one))

    for one, other in pairwise(roster):
        beside(one, other)
    seats = {seat: s for s in roster if (seat := _seat(s)) is not None}
    for (row, number), student in seats.items():
        for there in ((row, number + 1), (row + 1, number)):
            if there in seats:
                beside(student, seats[there])
    return found


def _seat(student: Student) -> tuple[int, int] | None:
    """Row and number of ``B12`` or ``2-12``."""
    text = next(
        (v for k, v in student.columns.items() if k.strip().casefold() in ("seat", "place", "siège")), ""
    )
    match = re.fullmatch(r"\s*([A-Za-z]|\d+)\s*[-. ]?\s*(\d+)\s*", text)
    if match is None:
        return None
    row = int(match[1]) if match[1].isdigit() else ord(match[1].upper()) - ord("A")
    return row, int(match[2])
