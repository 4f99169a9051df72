"""Repetition of the sheets of an earlier build, and further sheets for students who make up."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from coursework.course.course import Course
from coursework.errors import BadInput
from coursework.issuing.issued import Issued
from coursework.issuing.issuing import Issue, check_languages, drawn_by
from coursework.issuing.students import file_stems


def issued_again(course: Course, issued: Issued, langs: Sequence[str] = ()) -> list[Issue]:
    """Return the issued variants to write them again, without drawing; in the language of each record by
    default.

    Raises
    ------
    BadInput
        The record is of an assignment or a pool, has a later version, or an exercise has no text in a
        language.
    UnknownName
        The course lacks an exercise.
    """
    if issued.assignment is not None or issued.is_pool:
        raise BadInput(
            "the folder has the papers of an assignment or a pool: name its file, or another --out"
        )
    stems = dict(zip(issued.students, file_stems(issued.students), strict=True))
    issues = []
    for key in issued.records:
        exercise, seed = key
        for student in issued.owners.get(key, ("",)):
            variant = course[exercise].from_record(issued.record_of(student, exercise, seed))
            student_langs = tuple(langs) or (variant.lang,)
            check_languages(course[exercise], student_langs)
            sitting = issued.sitting_of(student, exercise, seed)
            stem = _stem(stems.get(student, f"{seed:05d}"), sitting)
            columns = issued.columns.get(student, {})
            variant = variant.in_language(student_langs[0])
            issues.append(Issue(student, variant, student_langs, stem, sitting, columns=columns))
    return issues


def made_up(course: Course, issues: Sequence[Issue], students: Sequence[str], first_seed: int) -> list[Issue]:
    """Return for each exercise another variant of each of the students, for their next sitting.

    Raises
    ------
    Starved
        An exercise has not enough different variants.
    """
    further = []
    for name in dict.fromkeys(issue.variant.exercise.name for issue in issues):
        of_exercise: list[Any] = [issue for issue in issues if issue.variant.exercise.name == name]
        last = {issue.student: issue for issue in of_exercise if issue.student in students}
        people = {f"{student} sitting {issue.sitting + 1}": issue for student, issue in last.items()}
        used = {tuple(issue.variant.given.values()) for issue in of_exercise}
        parts = tuple(part.id for part in of_exercise[0].variant.parts)
        lang = of_exercise[0].langs[0]
        drawn, _ = drawn_by(str(first_seed), course[name], list(people), lang, parts, used)
        for person, before in people.items():
            sitting = before.sitting + 1
            stem = _stem(before.stem.removesuffix(f".sitting-{before.sitting}"), sitting)
            variant = drawn[person].in_language(before.langs[0])
            further.append(
                Issue(before.student, variant, before.langs, stem, sitting, columns=before.columns)
            )
    return further


def _stem(stem: str, sitting: int) -> str:
    return stem if sitting == 1 else f"{stem}.sitting-{sitting}"
