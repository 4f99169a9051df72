"""Grading with a database: new files become submissions, changed sheets are marked, and the results cover all
submissions so far."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from sqlalchemy import Connection

from coursework.course.course import Course
from coursework.database.assignments import issued_of
from coursework.database.coded import by_code, coded_graded, coded_sheets, codes_of
from coursework.database.decisions import read_decisions, remember_written, store_new_decisions
from coursework.database.marking import Judged, MarkedNow, Work, mark_and_store
from coursework.database.publication import late_penalties
from coursework.database.store import Store
from coursework.database.submissions import Submission, insert_submission
from coursework.errors import BadInput
from coursework.gradebook.book import Gradebook
from coursework.gradebook.class_marking import rejecting
from coursework.gradebook.decisions import DecisionFiles, Decisions
from coursework.gradebook.feedback_form import USUAL, FeedbackForm, shows_solutions
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.grading import nothing_in, usual_feedback, write_marks
from coursework.gradebook.rows import Rejected, path_text
from coursework.gradebook.submissions import find, read_file
from coursework.system.tables import SPREADSHEETS, Spreadsheet
from coursework.system.writing import Progress


@dataclass
class GradedNow:
    """Result of a grading run: submissions, new decisions, and marks."""

    submissions: list[Submission]
    decided: int  #: decisions that are new in files
    marked: MarkedNow
    work: Work

    @property
    def new(self) -> int:
        return sum(submission.is_new for submission in self.submissions)


def grade_new(
    course: Course,
    store: Store,
    assignment_id: int,
    submissions: Sequence[Path],
    *,
    accepted: Path | None = None,
    out: Path | None = None,
    form: FeedbackForm = USUAL,
    replaces: bool = False,
) -> GradedNow:
    """Store new files and new decisions, and mark the sheets that changed.

    ``accepted`` and the files in ``out`` are those of :func:`coursework.gradebook.grading.grade_files`. A
    file that ``replaces`` takes the place of its earlier version.

    Raises
    ------
    BadInput
        A file that is not there, nothing that can be marked, more points than there are, solutions before
        their day; then nothing is kept.
    """
    with store.begin() as connection:
        issued = issued_of(connection, assignment_id)
        files = DecisionFiles(out, accepted, issued.renamed)
        shows_solutions(issued, form)
        submitted = _store_submissions(connection, assignment_id, submissions, replaces=replaces)
        work = Work(course, store, assignment_id, within=connection)
        if not work.last and not work.sheets.sheets:
            raise BadInput(nothing_in(submissions, work.sheets.rejected))
        decided = store_new_decisions(connection, assignment_id, files)
        work.decisions = read_decisions(connection, assignment_id)
    mark_and_store(work)
    return GradedNow(submitted, decided, work.summary(), work)


def _store_submissions(
    connection: Connection, assignment_id: int, submissions: Sequence[Path], *, replaces: bool
) -> list[Submission]:
    """Store each file as a submission, unless an equal one is stored already."""
    received_at = datetime.now(UTC)
    submitted = []
    for file in find(submissions):
        rows = [file] if isinstance(file, Rejected) else list(read_file(file, submissions))
        source = file.source if isinstance(file, Rejected) else path_text(file)
        submitted.append(
            insert_submission(
                connection, assignment_id, rows, source=source, received_at=received_at, replaces=replaces
            )
        )
    return submitted


def write_standing(
    course: Course,
    store: Store,
    work: Work,
    out: Path,
    *,
    accepted: Path | None = None,
    feedback: bool | None = None,
    spreadsheet: Spreadsheet = SPREADSHEETS["point"],
    progress: Progress = lambda done, of: None,
    form: FeedbackForm = USUAL,
) -> Gradebook:
    """Write the files that :func:`coursework.gradebook.grading.grade_files` would write for all submissions
    so far: of an anonymous assignment by codes, as long as an answer waits."""
    with store.reading() as connection:
        decisions = read_decisions(connection, work.assignment_id)
        charged = late_penalties(connection, work.assignment_id)
    issued, sheets = work.issued, work.sheets
    results: Iterable[Judged] = work.results()
    if (codes := codes_of(issued)) and _waits(work, decisions):
        results = [
            (
                (codes.get(key[0], key[0]), *key[1:]),
                coded_graded(one, codes) if isinstance(one, Graded) else one,
            )
            for key, one in results
        ]
        results.sort(key=lambda judged: judged[0][0])
        issued, charged = issued.by_codes(codes), by_code(charged, codes)
        sheets = coded_sheets(
            sheets, codes, lambda row: work.issued.student(row.row.get("student", "")) or ""
        )
        decisions = decisions.renamed(issued.renamed)
    book = write_marks(
        course,
        issued,
        sheets,
        rejecting(sheets, results),
        out,
        files=DecisionFiles(out, accepted, issued.renamed),
        decisions=decisions,
        feedback=usual_feedback(work.sheets) if feedback is None else feedback,
        charged=charged,
        spreadsheet=spreadsheet,
        progress=progress,
        form=form,
    )
    with store.begin() as connection:
        remember_written(connection, work.assignment_id, DecisionFiles(out, renamed=work.issued.renamed))
    return book


def _waits(work: Work, decisions: Decisions) -> bool:
    """Return True if something of an assignment waits for a person."""
    return bool(work.sheets.rejected) or any(
        isinstance(one, str) or decisions.apply(one).open for _, one in work.results()
    )
