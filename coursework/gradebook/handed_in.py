"""What one student handed in on a platform that says who it is: marked, a sheet for each exercise that was issued."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from coursework.course.course import Course
from coursework.gradebook.class_marking import marked
from coursework.gradebook.graded import Graded
from coursework.gradebook.notebooks import NO_NAME
from coursework.gradebook.placing import placed
from coursework.gradebook.rows import Rejected, Row
from coursework.making.issued import Issued
from coursework.making.students import folded
from coursework.marking.marking import mark


class HandedIn(NamedTuple):
    """What became of it: a sheet an exercise, that of nothing where none was handed in."""

    sheets: tuple[Graded, ...]
    rejected: tuple[Rejected, ...] = ()
    notes: tuple[str, ...] = ()  #: what is to be known and is no error


def handed_in(course: Course, issued: Issued, student: str, rows: Iterable[Row | Rejected]) -> HandedIn:
    """The marks of a student whom the platform names, whatever name the answers bear.

    The variant is the one that was issued to the student: answers that say they are of another are rejected. A stranger to
    the roster has the sheets of nothing.

    Raises
    ------
    CourseworkError
        The course cannot mark: no solutions, an exercise that the records do not fit.
    """
    notes: list[str] = []
    sheets = placed(course, issued, _of(issued, student, rows, notes))
    found: dict[str, Graded] = {}
    for graded in marked(course, issued, sheets):
        found.setdefault(graded.exercise, graded)
    whole = [found.get(e) or _blank(course, issued, student, e) for e in issued.exercises]
    return HandedIn(tuple(whole), tuple(sheets.rejected), (*notes, *sheets.warnings))


def _of(
    issued: Issued, student: str, rows: Iterable[Row | Rejected], notes: list[str]
) -> Iterator[Row | Rejected]:
    """The rows as the student's own; another name in them is told once."""
    for row in rows:
        if isinstance(row, Rejected):
            yield row
            continue
        named = issued.student(row.student) if issued.has_roster and row.student else None
        if named not in (None, student) and (told := f"the answers bear the name of {named}") not in notes:
            notes.append(told)
        yield row._replace(student=student, warning=row.warning.replace(NO_NAME, "").strip("; "))


def _blank(course: Course, issued: Issued, student: str, exercise: str) -> Graded:
    """The marks of nothing, on the student's variant; on the first where none is theirs."""
    own = issued.student(student) or student
    seeds = issued.seeds_of(own, exercise) or [s for e, s in issued.records if e == exercise][:1]
    record = issued.record_of(own, exercise, seeds[-1])
    return Graded(own, exercise, seeds[-1], dict(mark(course[exercise].from_record(record), {})), (), record)


_NAMES = re.compile(r"(has no part '[^']*').*", re.DOTALL)


def for_student(reason: str) -> str:
    """Why something was rejected, without the names of other parts: they may tell what is asked."""
    return _NAMES.sub(r"\1", reason)


# ------------------------------------------------------------------ whose it is

_TITLES = frozenset(
    "number id email mail e-mail username login user account sis matricule ine numero identifiant courriel".split()
)


def student_known_by(issued: Issued, *called: str) -> str | None:
    """The student of the roster whom a platform calls so: by an e-mail, a number or an account in the roster's columns,
    else by the name; by the first of the names ``called`` that is one student's and no other's."""
    for name in filter(None, map(folded, called)):
        exact = [s for s in issued.students if name in _accounts(issued, s)]
        if len(exact) == 1:
            return exact[0]
        if not exact and (named := issued.student(name) if issued.has_roster else None):
            return named
        local = [
            s for s in issued.students if name in {one.partition("@")[0] for one in _accounts(issued, s)}
        ]
        if not exact and len(local) == 1:
            return local[0]
    return None


def _accounts(issued: Issued, student: str) -> set[str]:
    """What the roster says of a student that stands for nobody else: e-mails, and columns whose titles say so."""
    columns = issued.columns.get(student, {})
    return {
        folded(value)
        for title, value in columns.items()
        if value
        and ("@" in value or _TITLES & set(folded(title).replace("é", "e").replace("_", " ").split()))
    }
