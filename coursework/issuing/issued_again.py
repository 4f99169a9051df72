"""Repetition of the sheets of an earlier build."""

from __future__ import annotations

from collections.abc import Sequence

from coursework.course.course import Course
from coursework.errors import BadInput
from coursework.issuing.issued import Issued
from coursework.issuing.issuing import Issue, check_languages
from coursework.issuing.students import file_stems


def issued_again(course: Course, issued: Issued, langs: Sequence[str] = ()) -> list[Issue]:
    """Return the issued variants to write them again, without drawing; in the language of each record by
    default.

    Raises
    ------
    BadInput
        The record is of an assignment or a pool, has a later version, or an exercise has no text in a language.
    UnknownName
        The course lacks an exercise.
    """
    if issued.assignment is not None or issued.is_pool:
        raise BadInput(
            "what was issued is of an assignment or a platform's pool, whose papers have several exercises; the command "
            "that made them writes them again"
        )
    stems = dict(zip(issued.students, file_stems(issued.students), strict=True))
    issues = []
    for key in issued.records:
        exercise, seed = key
        for student in issued.owners.get(key, ("",)):
            variant = course[exercise].from_record(issued.record_of(student, exercise, seed))
            student_langs = tuple(langs) or (variant.lang,)
            check_languages(course[exercise], student_langs)
            stem, columns = stems.get(student, f"{seed:05d}"), issued.columns.get(student, {})
            issues.append(
                Issue(student, variant.in_language(student_langs[0]), student_langs, stem, columns=columns)
            )
    return issues
