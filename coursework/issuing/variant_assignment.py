"""Assignment of variants to students.

A variant depends on the assignment's secret and name, the exercise and the student, never on the position in
the roster. Issued variants stay: a longer roster adds papers and changes no other.
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
from coursework.errors import BadInput, counted, first_few, nearest
from coursework.issuing.assignment import AskedExercise, Assignment
from coursework.issuing.exam_columns import room_of, seat_of
from coursework.issuing.flaws import try_judges
from coursework.issuing.issued import CODES, items_of_papers, secret_of
from coursework.issuing.issuing import Issue, check_languages, drawn_by, reservations, whose_languages
from coursework.issuing.roster import Student
from coursework.issuing.students import file_stems, folded, student_named
from coursework.messages import Message
from coursework.model import Part

V = TypeVar("V", bound=Variant)

_STEP = Fraction(1, 4)  #: of points that are distributed


@dataclass
class AssignedVariants:
    """Assigned variants, with notes for the user."""

    issues: list[Issue]
    notes: list[str] = field(default_factory=list)
    secret: Secret | None = None  #: to be stored if the assignment's file has none
    is_new: bool = False  #: the secret was created now


def assign_variants(
    course: Course[Any],
    assignment: Assignment,
    students: Sequence[Student],
    langs: Sequence[str],
    before: Mapping[str, Any] | None = None,
    make_up: Sequence[str] = (),
    secret: Secret | None = None,
) -> AssignedVariants:
    """Assign a paper to each student, and a further one to students who make up; ``before`` is the content of
    ``issued.json``.

    Draws are keyed by the secret of the assignment's file, else by that of ``before``, else by ``secret``,
    else by a new one. Variants that were issued before without a secret stay as they are.

    Raises
    ------
    BadInput
        Other exercises were issued before, an exercise has no text in one of the languages, or a student who
        makes up is unknown.
    Starved
        An exercise has no variant that is worth issuing.
    """
    assigner = _Assigner(course, assignment, langs, before, secret)
    everybody = assigner.everybody(students)
    sittings = [(student, 1) for student in everybody]
    sittings += [(student, n) for student in everybody for n in range(2, assigner.sittings(student.name) + 1)]
    for name in make_up:
        student = _named(name, everybody)
        sittings.append((student, assigner.sittings(student.name) + 1))
    versions = assigner.versions([student for student, n in sittings if n == 1], students)
    papers: dict[tuple[str, int], list[Any]] = {(assigner.of(s), n): [] for s, n in sittings}
    for asked_exercise in assignment.exercises:
        for sheet, variant in zip(papers, assigner.variants(asked_exercise, sittings, versions), strict=True):
            papers[sheet].append(variant)
    codes = assigner.codes(everybody) if assignment.anonymous else {}
    stems = dict(zip(map(assigner.of, everybody), assigner.stems(everybody, codes), strict=True))
    issues = []
    for (student, sitting), (sheet, variants) in zip(sittings, papers.items(), strict=True):
        student_langs = (student.lang,) if student.lang else tuple(langs)
        stem = stems[sheet[0]] if sitting == 1 else f"{stems[sheet[0]]}.sitting-{sitting}"
        version = versions.get(sheet[0], "") if sitting == 1 else ""
        issues += [
            Issue(
                student.name,
                v.in_language(student_langs[0]),
                student_langs,
                stem,
                sitting,
                version,
                student.columns,
                codes.get(student.name, ""),
            )
            for v in variants
        ]
    stored_secret = None if assignment.secret is not None else assigner.secret
    return AssignedVariants(issues, assigner.notes, stored_secret, assigner.is_new)


#: Signs of codes: none that is taken for another in handwriting, and no vowel, so that no code is a word.
_SIGNS = "2345679CDFHJKMNPRTVWXY"


def _code(digest: bytes) -> str:
    """Return a code of six signs, ``K7M-3XP``."""
    number = int.from_bytes(digest[:16], "little")
    signs = "".join(_SIGNS[number // len(_SIGNS) ** k % len(_SIGNS)] for k in range(6))
    return f"{signs[:3]}-{signs[3:]}"


def _named(name: str, students: Sequence[Student]) -> Student:
    match = student_named(name, (s.name for s in students))
    if match is None:
        raise BadInput(
            "no student {name!r} was issued a paper{near}",
            name=name,
            near=nearest(name, [s.name for s in students]),
        )
    return next(s for s in students if s.name == match)


class _Assigner:
    """Assignment of the variants of one assignment."""

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
        self._columns = dict((before or {}).get("students", {}))
        self._codes: Mapping[str, str] = (before or {}).get(CODES) or {}
        self._unnamed: dict[int, str] = {}
        stated = (before or {}).get("assignment")
        if before is not None and (
            stated is None or list(stated.get("exercises", ())) != list(assignment.names)
        ):
            raise BadInput(
                (
                    "{assignment} has changed since it was issued there, and issued papers do not "
                    "change; choose another "
                    "--out, or --overwrite to issue new ones"
                ),
                assignment=assignment.name,
            )
        self._records: dict[tuple[str, str, int], Mapping[str, Any]] = {}
        self._letters: dict[str, str] = {}
        self._sittings: dict[str, int] = {}
        for number, items in enumerate(items_of_papers(before or {"issued": ()})):
            name, sitting = str(items[0].get("student", "")) or f"#{number}", int(items[0].get("sitting", 1))
            self._records |= {(name, str(i["record"]["exercise"]), sitting): i["record"] for i in items}
            self._sittings[name] = max(sitting, self.sittings(name))
            if version := items[0].get("version"):
                self._letters[name] = str(version)

    @property
    def _key(self) -> Secret:
        """Return the secret of the draws of this assignment; create it with the first draw if there is
        none."""
        if self.secret is None:
            self.secret, self.is_new = Secret.new(), True
        return keyed(self.secret, self.assignment)

    def of(self, student: Student) -> str:
        """Return the key of a student: the name, or the position of a paper without a name."""
        return student.name or self._unnamed[id(student)]

    def everybody(self, students: Sequence[Student]) -> list[Student]:
        """Return the students with issued papers, then the new ones; students who left the roster stay, with
        a note."""
        for number, student in enumerate(students):
            if not student.name:
                self._unnamed[id(student)] = f"#{number}"
        issued = list(dict.fromkeys(name for name, _, _ in self._records if not name.startswith("#")))
        there = {folded(s.name): s for s in students}
        gone = [name for name in issued if folded(name) not in there]
        known = set(map(folded, issued))
        late = [s for s in students if s.name and folded(s.name) not in known]
        if issued and gone:
            self.notes.append(
                Message(
                    "papers kept although no longer on the roster: {names}",
                    names=first_few(gone, 5),
                )
            )
        if issued and late:
            self.notes.append(
                Message(
                    "{papers} issued before stay as they are; added: {names}",
                    papers=counted(len(issued), "paper"),
                    names=first_few([s.name for s in late], 5),
                )
            )
        result = [
            replace(there[folded(name)], name=name)
            if folded(name) in there
            else Student(name, columns=self._columns.get(name, {}))
            for name in issued
        ]
        result += late
        return result + [s for s in students if not s.name]

    def sittings(self, name: str) -> int:
        return self._sittings.get(name, 1)

    def codes(self, everybody: Sequence[Student]) -> dict[str, str]:
        """Return the code of each student: as issued, else drawn by the secret; all differ."""
        names = {student.name for student in everybody}
        codes = {name: code for name, code in self._codes.items() if name in names}
        used = set(codes.values())
        for student in (s for s in everybody if s.name and s.name not in codes):
            tries = (_code(self._key.digest("code", student.draw_key, str(k))) for k in range(1000))
            codes[student.name] = next(code for code in tries if code not in used)
            used.add(codes[student.name])
        return codes

    def stems(self, everybody: Sequence[Student], codes: Mapping[str, str]) -> list[str]:
        """Return the stems of file names: by the student's code or name, as before; papers without a name are
        numbered."""
        digits = max(2, len(str(len(everybody))))
        named = file_stems(codes.get(s.name, s.name) for s in everybody)
        return [stem or f"paper-{number:0{digits}}" for number, stem in enumerate(named, start=1)]

    # --------------------------------------------------------------- versions

    def versions(self, everybody: Sequence[Student], roster: Sequence[Student]) -> dict[str, str]:
        """Return a letter per student if versions are used: neighbours in the roster and in the room get
        different ones."""
        count = self.assignment.versions
        if count is None or count == 1:
            return {}
        letters = [chr(ord("A") + n) for n in range(count)]
        letter_of = dict(self._letters)
        used = Counter(letter_of.values())
        order = [self.of(s) for s in everybody]
        neighbours = _neighbours([s for s in roster if s.name] or everybody, self.of)
        places = {folded(self.of(s)): k for k, s in reversed([*enumerate(roster)])}
        for student in sorted(order, key=lambda name: places.get(folded(name), len(roster))):
            if student in letter_of:
                continue
            near = {letter_of.get(other) for other in neighbours.get(student, ())}
            free = [letter for letter in letters if letter not in near] or letters
            digests = {letter: self._key.digest("version", student, letter) for letter in free}
            letter_of[student] = min(free, key=lambda letter: (used[letter], digests[letter]))
            used[letter_of[student]] += 1
        return letter_of

    # --------------------------------------------------------------- variants

    def variants(
        self,
        asked_exercise: AskedExercise,
        sittings: Sequence[tuple[Student, int]],
        versions: Mapping[str, str],
    ) -> list[Any]:
        """Return the variant of each sitting: as issued before, else drawn."""
        exercise = self.course[asked_exercise.name]
        self._check_languages(exercise, [s for s, _ in sittings])
        by_sitting: dict[int, Any] = {}
        for k, (student, sitting) in enumerate(sittings):
            record = self._records.get((self.of(student), asked_exercise.name, sitting))
            if record is not None:
                by_sitting[k] = exercise.from_record(record)
        missing = {k: self._who(*sittings[k], versions) for k in range(len(sittings)) if k not in by_sitting}
        drawn = self._shared(asked_exercise, sittings, versions, by_sitting)
        fixed_seed = asked_exercise.fixed_seed(exercise)
        if fixed_seed is not None and (
            unassigned := {w for k, w in missing.items() if sittings[k][1] == 1} - {*drawn}
        ):
            fixed_variant = with_points(
                exercise.variant(
                    fixed_seed, self.langs[0], asked_exercise.parts, self._key, asked_exercise.given
                ),
                asked_exercise,
            )
            if asked_exercise.given:
                self.notes += reservations(exercise, fixed_variant)
            drawn |= dict.fromkeys(unassigned, fixed_variant)
        left = [person for person in dict.fromkeys(missing.values()) if person not in drawn]
        drawn |= self._drawn(exercise, asked_exercise, left, by_sitting.values()) if left else {}
        by_sitting |= {k: drawn[person] for k, person in missing.items()}
        if by_sitting:
            try_judges(by_sitting[0].key)
        return [by_sitting[k] for k in range(len(sittings))]

    def _shared(
        self,
        asked_exercise: AskedExercise,
        sittings: Sequence[tuple[Student, int]],
        versions: Mapping[str, str],
        issued: Mapping[int, Any],
    ) -> dict[str, Any]:
        """Return the variants that several students share, as issued to the first of them; later students get
        them too."""
        shared: dict[str, Any] = {}
        for k, variant in issued.items():
            student, sitting = sittings[k]
            if sitting == 1 and (self.assignment.versions == 1 or versions.get(self.of(student))):
                shared.setdefault(self._who(student, 1, versions), variant)
        fixed_seed = asked_exercise.fixed_seed(self.course[asked_exercise.name])
        fixed = [v for k, v in issued.items() if sittings[k][1] == 1 and v.seed == fixed_seed]
        if fixed:
            for student, sitting in sittings:
                if sitting == 1:
                    shared.setdefault(self._who(student, 1, versions), fixed[0])
        return shared

    def _who(self, student: Student, sitting: int, versions: Mapping[str, str]) -> str:
        """Return the key of a draw."""
        if sitting > 1:
            return f"{student.draw_key or self.of(student)} sitting {sitting}"
        if self.assignment.versions == 1:
            return "everybody"
        letter = versions.get(self.of(student))
        return f"version {letter}" if letter else student.draw_key if student.name else self.of(student)

    def _check_languages(self, exercise: CourseExercise[Any], students: Iterable[Student]) -> None:
        check_languages(exercise, self.langs)
        check_languages(exercise, *whose_languages(list(students)))

    def _drawn(
        self,
        exercise: CourseExercise[Any],
        asked_exercise: AskedExercise,
        people: Sequence[str],
        issued: Iterable[Any],
    ) -> dict[str, Any]:
        """Return a variant for each person, all different while variants last."""
        given_by_seed = {variant.seed: tuple(variant.given.values()) for variant in issued}
        variants, shared = drawn_by(
            self.assignment.name,
            exercise,
            people,
            self.langs[0],
            asked_exercise.parts,
            set(given_by_seed.values()),
            secret=self._key,
            issued_values=given_by_seed,
            stated=asked_exercise.given,
        )
        if shared:
            self.notes.append(
                Message(
                    (
                        "{exercise}: {count} of {papers} share a variant with another, as there are "
                        "not enough different ones"
                    ),
                    exercise=exercise.name,
                    count=len(shared),
                    papers=counted(len(people), "paper"),
                )
            )
        return {person: with_points(variant, asked_exercise) for person, variant in variants.items()}


def keyed(secret: Secret, assignment: Assignment) -> Secret:
    """Return the key of the draws of an assignment; assignments that share a secret get different keys."""
    return secret.under("assignment", assignment.name)


def with_points(variant: V, asked_exercise: AskedExercise) -> V:
    """Return the variant with the points of the assignment."""
    if asked_exercise.points is None:
        return variant
    if isinstance(asked_exercise.points, Mapping):
        points = {p.id: asked_exercise.points.get(p.id, p.points) for p in variant.parts}
    else:
        points = distributed_points(asked_exercise.points, variant.parts)
    parts = [p if p.points == points[p.id] else replace(p, points=points[p.id]) for p in variant.parts]
    return variant.asking(parts)


def distributed_points(total: float, parts: Sequence[Part]) -> dict[str, float]:
    """Return points for all parts in proportion to their own, in quarters if the total allows it; they sum to
    the total."""
    total_of_parts = sum(Fraction(p.points) for p in parts)
    exact = {p.id: Fraction(total) * Fraction(p.points) / total_of_parts for p in parts}
    quarters = Fraction(total) / _STEP
    if quarters.denominator != 1 or quarters < len(parts):
        return {i: float(x) for i, x in exact.items()}
    counts = {i: max(1, int(x / _STEP)) for i, x in exact.items()}
    while sum(counts.values()) > quarters:
        most = max(counts, key=lambda i: counts[i] * _STEP - exact[i])
        counts[most] -= 1
    while sum(counts.values()) < quarters:
        least = max(counts, key=lambda i: exact[i] - counts[i] * _STEP)
        counts[least] += 1
    return {i: float(n * _STEP) for i, n in counts.items()}


# ------------------------------------------------------------------------- room


def _neighbours(roster: Sequence[Student], of: Any) -> dict[str, set[str]]:
    """Return the neighbours of each student: by position in the roster, and by seat if the roster has seats,
    ``B12``."""
    neighbours: dict[str, set[str]] = {of(s): set() for s in roster}

    def beside(student_before: Student, other: Student) -> None:
        neighbours[of(student_before)].add(of(other))
        neighbours[of(other)].add(of(student_before))

    for student_before, other in pairwise(roster):
        beside(student_before, other)
    seats = {seat: s for s in roster if (seat := _seat(s)) is not None}
    for (room, row, number), student in seats.items():
        for there in ((room, row, number + 1), (room, row + 1, number)):
            if there in seats:
                beside(student, seats[there])
    return neighbours


def _seat(student: Student) -> tuple[str, int, int] | None:
    """Return room, row and number of ``B12`` or ``2-12``."""
    match = re.fullmatch(r"([A-Za-z]|\d+)\s*[-. ]?\s*(\d+)", seat_of(student.columns))
    if match is None:
        return None
    row = int(match[1]) if match[1].isdigit() else ord(match[1].upper()) - ord("A")
    return folded(room_of(student.columns)), row, int(match[2])
