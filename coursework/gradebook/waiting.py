"""Answers that only a person can judge, grouped by equal content.

An answer waits if it is unreadable, is the picture of a scan, is to be marked by a person, lacks its unit, is
wrong by little, or is a wrong answer that many students gave and nothing explains. An answer that is right by
little does not wait, and is shown on request.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from hashlib import sha256
from typing import NamedTuple

from coursework.course.course import Course
from coursework.course.key_batch import keys_of
from coursework.course.marking_rules import Rules
from coursework.course.variant import Variant
from coursework.gradebook.adjustments import NEUTRAL, Margins
from coursework.gradebook.class_marking import rules_of
from coursework.gradebook.decisions import Decisions
from coursework.gradebook.graded_sheet import Graded
from coursework.issuing.issued import Issued
from coursework.issuing.questions import PaperQuestions, Question
from coursework.marking.margins import half_widths_off
from coursework.marking.mark import Mark
from coursework.parsing.scanned import names_pictures
from coursework.parsing.spelling import plain_spelling, unwrapped

NEAR = 2.0  #: accepted margins up to which a wrong answer is near the margin
JUST = 0.9  #: of the accepted margin, beyond which a right answer is just inside it
OFTEN = 3  #: students who wrote the same wrong answer, before it waits
OFTEN_SHARE = 0.1  #: of those who answered the question
LONGEST = 2000  #: characters by which texts are compared

SheetOfStudent = tuple[str, str, int, int]  #: student, exercise, seed and sitting

SCANNED = "scanned"  #: the picture of an answer, which is marked once somebody has typed it
#: Why an answer may be looked at, in the order in which they are shown.
WHY = ("unreadable", SCANNED, "drawn", "open", "unit", "near", "often", "just")
SHOWN_ON_REQUEST = ("just",)  #: these need no review


class AnswerToReview(NamedTuple):
    """Answer that a person may review."""

    sheet: Graded
    mark: Mark
    margin: float | None  #: its distance from the reference in accepted half-widths

    @property
    def student(self) -> str:
        return self.sheet.student


@dataclass(frozen=True)
class AnswerGroup:
    """Answers to one question with equal content, judged against the same reference."""

    id: str
    why: str
    exercise: str
    part: str
    members: tuple[AnswerToReview, ...]

    @property
    def first(self) -> AnswerToReview:
        return self.members[0]


class OpenGroup(NamedTuple):
    """Group of answers, with those of its members that still wait for a person."""

    group: AnswerGroup
    members: tuple[AnswerToReview, ...]

    @property
    def why(self) -> str:
        return self.group.why


class Measure(NamedTuple):
    """Values by which the answers of a sheet are compared: margins and references, by part."""

    margins: Mapping[str, float]
    references: Mapping[str, str]


NOTHING = Measure({}, {})
_MEASURED = frozenset(("correct", "wrong", "missing_unit"))


def measures(course: Course, issued: Issued, graded: Sequence[Graded]) -> Iterator[Measure]:
    """Yield the values by which the answers of each sheet are compared."""
    for graded_sheet, variant in _with_variants(course, graded, rules_of(course, issued)):
        lines = {p: m for p, m in graded_sheet.lines.items() if m.verdict in _MEASURED}
        parts = [part for part in variant.parts if part.id in lines]
        margins = {part.id: half_widths_off(variant, part, lines[part.id].answer) for part in parts}
        references = {
            part.id: repr(variant.key.reference.get(part.quantity))
            for part in parts
            if lines[part.id].verdict != "correct"
        }
        yield Measure(_known(margins), references)


def margins_of(course: Course, issued: Issued) -> Margins:
    """Return the function that measures the answers of sheets for a wider margin."""

    def margins(sheets: Sequence[Graded], digits: int | None) -> Iterator[Mapping[str, float]]:
        rules = rules_of(course, issued)
        if digits is not None:
            rules = replace(rules or course.folder.rules, digits=digits)
        for graded, variant in _with_variants(course, sheets, rules):
            yield _known(
                {
                    part.id: half_widths_off(variant, part, graded.lines[part.id].answer)
                    for part in variant.parts
                    if part.id in graded.lines and graded.lines[part.id].points < graded.lines[part.id].out_of
                }
            )

    return margins


def _with_variants(
    course: Course, sheets: Sequence[Graded], rules: Rules | None
) -> Iterator[tuple[Graded, Variant]]:
    """Return sheets with their variants, whose keys are computed together."""
    variants = [course[graded.exercise].from_record(graded.record) for graded in sheets]
    for name in dict.fromkeys(graded.exercise for graded in sheets):
        keys_of(course[name], [v for v in variants if v.exercise.name == name], rules)
    return zip(sheets, variants, strict=True)


def _known(margins: Mapping[str, float | None]) -> dict[str, float]:
    return {part: margin for part, margin in margins.items() if margin is not None}


def groups(
    graded: Iterable[Graded],
    measured: Mapping[SheetOfStudent, Measure],
    questions: PaperQuestions,
    course: Course,
) -> list[AnswerGroup]:
    """Return the answers that may be reviewed, question by question, then by reason, the largest groups
    first."""
    by_person = _by_person(course, questions)
    members_by_key: dict[tuple[str, ...], list[AnswerToReview]] = {}
    answered: dict[tuple[str, str], set[str]] = {}
    for graded_sheet in graded:
        measure = measured.get(sheet_of_student(graded_sheet), NOTHING)
        for part, mark in graded_sheet.lines.items():
            if mark.verdict == "missing":
                continue
            answered.setdefault((graded_sheet.exercise, part), set()).add(graded_sheet.student)
            if (key := key_of(graded_sheet, mark, measure, by_person)) is not None:
                members_by_key.setdefault(key, []).append(
                    AnswerToReview(graded_sheet, mark, measure.margins.get(part))
                )
    positions = {question: number for number, question in enumerate(questions)}
    answer_groups = [
        _group(key, members) for key, members in members_by_key.items() if _waits(key, members, answered)
    ]
    return sorted(
        answer_groups,
        key=lambda g: (
            positions.get((g.exercise, g.part), len(positions)),
            WHY.index(g.why),
            -len(g.members),
        ),
    )


def _by_person(course: Course, questions: PaperQuestions) -> dict[Question, str]:
    """Return the reason of a review of the questions that a person marks: a drawing, or a text."""
    return {
        (exercise, name): "drawn" if part.sort.box in ("blank", "millimetre") else "open"
        for exercise, name in questions
        if exercise in course
        if (part := course[exercise].spec.part(name)) and part.sort.is_open
    }


def undecided(
    groups: Iterable[AnswerGroup], decisions: Decisions, current: Mapping[SheetOfStudent, Graded]
) -> Iterator[OpenGroup]:
    """Yield groups with those of their answers whose mark a person may still change; none of a question that
    counts for nobody.

    ``current`` are the sheets with the decisions and adjustments applied: an answer that a wider margin or
    another price gave all its points waits no more.
    """
    statuses = decisions.adjustments.statuses
    for group in groups:
        if statuses.get((group.exercise, group.part)) == NEUTRAL:
            continue
        members = tuple(
            answer
            for answer in group.members
            if decisions.standing(answer.sheet, answer.mark) is None
            and not _is_made_good(answer, current[sheet_of_student(answer.sheet)])
        )
        if members:
            yield OpenGroup(group, members)


def sheet_of_student(graded: Graded) -> SheetOfStudent:
    """Return student, exercise, seed and sitting, by which sheets are found again."""
    return graded.student, graded.exercise, graded.seed, graded.sitting


def _is_made_good(answer: AnswerToReview, now: Graded) -> bool:
    line = now.lines[answer.mark.part]
    return answer.mark.points < answer.mark.out_of and (
        line.verdict == "accepted" or 0 < line.out_of <= line.points
    )


def key_of(
    graded: Graded, mark: Mark, measure: Measure, by_person: Mapping[Question, str]
) -> tuple[str, ...] | None:
    """Return the common values of the answers of one group, beginning with the reason for a review; None for
    an answer that nobody reviews."""
    margin = measure.margins.get(mark.part)
    if (why := _why(mark, margin, by_person.get((graded.exercise, mark.part), ""))) is None:
        return None
    return why, graded.exercise, mark.part, mark.verdict, written(mark), measure.references.get(mark.part, "")


def _why(mark: Mark, margin: float | None, by_person: str) -> str | None:
    if mark.verdict == "to_mark":
        return by_person or (SCANNED if names_pictures(mark.answer) else "open")
    if mark.verdict == "unreadable":
        return "unreadable"
    if mark.verdict == "missing_unit":
        return "unit"
    if mark.verdict == "correct":
        return "just" if margin is not None and JUST < margin <= 1 else None
    if mark.verdict != "wrong":
        return None
    return "near" if margin is not None and margin <= NEAR else "often"


def _waits(
    key: tuple[str, ...], members: Sequence[AnswerToReview], answered: Mapping[tuple[str, str], set[str]]
) -> bool:
    """Return True if a group waits: a wrong answer without an explanation waits if many students wrote it;
    all others wait."""
    if key[0] != "often":
        return True
    students = len({answer.student for answer in members})
    return students >= max(OFTEN, OFTEN_SHARE * len(answered[key[1], key[2]]))


def written(mark: Mark) -> str:
    """Return an answer in one spelling: its reading, else its text without differences of spelling."""
    text = mark.read_as or plain_spelling(unwrapped(mark.answer[:LONGEST]))
    return " ".join(text.casefold().split()).rstrip(" .!;,")


def name_of(key: Sequence[str]) -> str:
    """Return the name of a group: a digest of what its answers have in common."""
    return sha256("\0".join(key).encode("utf-8", "backslashreplace")).hexdigest()[:16]


def _group(key: tuple[str, ...], members: Sequence[AnswerToReview]) -> AnswerGroup:
    return AnswerGroup(name_of(key), key[0], key[1], key[2], tuple(members))
