"""Marked exam in a database, as the evening after it looks at it."""

from __future__ import annotations

from coursework.course.course import Course
from coursework.database.marking import Work
from coursework.database.publication import late_penalties
from coursework.database.store import Store
from coursework.errors import BadInput
from coursework.gradebook.after import Exam
from coursework.gradebook.class_marking import rejecting
from coursework.gradebook.placing import Sheets
from coursework.gradebook.presence import presence_on_roster


def stored_exam(course: Course, store: Store, assignment_id: int) -> Exam:
    """Return an exam with its last markings and all decisions.

    Raises
    ------
    BadInput
        Nothing is marked, or answers came or changed since: these are marked first.
    """
    work = Work(course, store, assignment_id)
    if not work.last:
        raise BadInput("nothing of it is marked yet: coursework grade SUBMISSIONS… --db URL")
    if work.changed:
        raise BadInput(
            "{count} sheet{count:|s} came or changed since the last marking: first coursework grade --db …",
            count=len(work.changed),
        )
    sheets = Sheets(work.sheets.sheets, list(work.sheets.rejected), list(work.sheets.warnings))
    machine = list(rejecting(sheets, work.results()))
    with store.reading() as connection:
        charged = late_penalties(connection, assignment_id)
    presence = presence_on_roster(work.issued)
    return Exam(
        course, work.issued, machine, work.decisions, tuple(sheets.rejected), charged, presence=presence
    )
