"""Grading of a class: from files of answers to marks, summary, rejected rows and feedback sheets.

The tables appear together, whole, in place of those before, or not at all: none takes its place before all
are written and each is seen to be replaceable.
"""

from __future__ import annotations

import datetime
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from coursework.course.course import Course
from coursework.errors import BadInput, first_few
from coursework.gradebook import book as gradebook
from coursework.gradebook.book import Gradebook, Sitting
from coursework.gradebook.changes import CHANGES_COLUMNS, EarlierMarks, History
from coursework.gradebook.class_marking import marked
from coursework.gradebook.columns import REJECTED_COLUMNS, marks_columns
from coursework.gradebook.decisions import (
    DECISIONS_FILE,
    EDITED_FILE,
    TO_MARK,
    TO_MARK_FILE,
    DecisionFiles,
    Decisions,
    check_steps,
    edited_row,
)
from coursework.gradebook.edited_marks import EditedMarks, differs
from coursework.gradebook.feedback_form import USUAL, FeedbackForm, shows_solutions
from coursework.gradebook.feedback_sheets import renew_feedback
from coursework.gradebook.graded_sheet import Graded
from coursework.gradebook.marks_record import write_record
from coursework.gradebook.placing import Sheets
from coursework.gradebook.platform_files import platform_file_lines
from coursework.gradebook.presence import presence_by_student
from coursework.gradebook.rows import AnswerRow, PlatformFile, Rejected
from coursework.gradebook.sheets_on_disk import placed_on_disk
from coursework.gradebook.submissions import find, read_file
from coursework.gradebook.waiting import margins_of
from coursework.issuing.issued import Issued
from coursework.issuing.questions import PaperQuestions
from coursework.messages import Message
from coursework.system.build_folder import free_name, is_as_written, write_down
from coursework.system.tables import SPREADSHEETS, Spreadsheet
from coursework.system.writing import Progress, TableFile, Tables, write_whole

_WRITTEN = ".marks.json"  #: what was written as marks.csv
#: Largest number of students for which feedback sheets are printed by default.
FEEDBACK_STUDENTS = 1000


def grade_files(
    course: Course,
    submissions: Sequence[Path],
    issued_path: Path,
    out: Path,
    *,
    feedback: bool | None,
    accepted: Path | None = None,
    spreadsheet: Spreadsheet = SPREADSHEETS["point"],
    progress: Progress = lambda done, of: None,
    form: FeedbackForm = USUAL,
    carry: Sequence[str] | None = None,
) -> Gradebook:
    """Mark files and write ``marks.csv``, ``summary.csv``, ``rejected.csv`` and feedback sheets;
    ``decisions.csv`` where answers are marked by a person, whose decisions in an earlier one count.

    If there are earlier marks, ``changes.csv`` lists the differences. ``accepted`` is a file of answers that
    a person accepts, besides ``decisions.csv`` in ``out``. ``feedback`` None prints sheets for a class of
    usual size, with the options of ``form``. ``spreadsheet`` is the program for which the tables are written.
    ``carry`` names columns of the roster that the summary repeats, instead of those of the assignment.

    Raises
    ------
    BadInput
        A file that is not there, or nothing that can be marked, or solutions before their day: then nothing
        is written.
    """
    issued = Issued.read(issued_path)
    issued.carry = issued.carry if carry is None else carry
    shows_solutions(issued, form)
    files = DecisionFiles(out, accepted, issued.renamed)

    def rows() -> Iterator[AnswerRow | Rejected | PlatformFile]:
        for file in find(submissions):
            yield from [file] if isinstance(file, (Rejected, PlatformFile)) else read_file(file, submissions)

    with placed_on_disk(course, issued, rows(), out) as sheets:
        if not sheets.count:
            raise BadInput(nothing_in(submissions, sheets.rejected))
        feedback = usual_feedback(sheets) if feedback is None else feedback
        results = marked(course, issued, sheets)
        return write_marks(
            course,
            issued,
            sheets,
            results,
            out,
            files=files,
            decisions=files.decisions,
            feedback=feedback,
            spreadsheet=spreadsheet,
            progress=progress,
            form=form,
        )


def usual_feedback(sheets: Sheets) -> bool:
    """Return True if feedback sheets are printed by default; add a warning if they are not."""
    count = sheets.students
    if count > FEEDBACK_STUDENTS:
        sheets.warnings.append(
            Message(
                (
                    "no feedback sheets are printed for more than {most:,} students, and {count:,} "
                    "answered: add "
                    "--feedback to print them"
                ),
                count=count,
                most=FEEDBACK_STUDENTS,
            )
        )
    return count <= FEEDBACK_STUDENTS


def write_marks(
    course: Course,
    issued: Issued,
    sheets: Sheets,
    results: Iterable[Graded],
    out: Path,
    *,
    files: DecisionFiles,
    decisions: Decisions,
    feedback: bool,
    charged: Mapping[Sitting, float] | None = None,
    spreadsheet: Spreadsheet = SPREADSHEETS["point"],
    progress: Progress = lambda done, of: None,
    form: FeedbackForm = USUAL,
) -> Gradebook:
    """Write the files of :func:`grade_files` for sheets that are marked on demand, with the ``decisions``
    that count; ``charged`` contains the penalties of late submissions as shares of the points."""
    before = EarlierMarks(out / "marks.csv", issued.renamed)
    history = History(out, _day(form), issued.renamed, is_adjusted=bool(decisions.steps))
    check_steps(decisions.standing_steps, issued)
    adjustments = decisions.adjustments
    book = Gradebook(adjustments.on(issued), sheets.rows_in, sheets.blanks, sheets.rejected, sheets.warnings)
    book.seen, book.charged = platform_file_lines(sheets.seen), charged or {}
    book.presence = presence_by_student(out, issued)
    sheets_shown: list[Graded] = []
    with Tables(out, spreadsheet) as tables:
        marks = tables.open("marks.csv", marks_columns(issued, submitted=sheets.is_dated))
        rejected = tables.open("rejected.csv", REJECTED_COLUMNS)
        standing = _standing(results, files, decisions)
        if adjustments:  # these need all sheets of a student
            standing = iter(adjustments.applied(standing, issued, margins_of(course, issued)))
        for done, graded in enumerate(standing, start=1):
            book.add(graded)
            for row in gradebook.marks_rows(graded):
                marks.write(row)
                if before.exists and (change := before.changed(row)) is not None:
                    history.add(change)
                    book.changes += 1
            if feedback:
                sheets_shown.append(graded)
            progress(done, sheets.count)
        for change in before.gone():
            history.add(change)
            book.changes += 1
        book.faults, notes = files.unfollowed(issued, dict.fromkeys(s for s, _ in book.students))
        book.warnings += notes
        book.waiting, book.on_scans = files.waiting, files.on_scans
        _write_decisions(files, tables, book)
        _write_counts(book, tables, rejected, history if before.exists else None)
        stood = files.is_edited or (out / EDITED_FILE).exists()
        edited = not is_as_written(out / _WRITTEN, marks.path) and before.edited(out / "summary.csv")
        if book.changes and (stood or edited):
            book.warnings.insert(0, _kept_copy(out / "marks.csv"))
        if feedback:
            renew_feedback(course, book, sheets_shown, out, progress, form, tables.check)
        tables.check()
        # Stopped halfway, these are not marks that a hand changed.
        write_down(out / _WRITTEN, marks.path, marks.part, *([] if edited else [marks.path]))
        tables.commit()
    _remove_earlier_files(out)
    write_record(out, book, PaperQuestions.of(course, issued))
    return book


def _standing(results: Iterable[Graded], files: DecisionFiles, decisions: Decisions) -> Iterator[Graded]:
    """Yield the sheets with the decisions on answers; note which lines of the files are about them."""
    for graded in results:
        files.follow(graded, decisions)
        yield decisions.apply(graded)


def _day(form: FeedbackForm) -> str:
    return (form.today or datetime.date.today()).isoformat()


def _write_counts(book: Gradebook, tables: Tables, rejected: TableFile, history: History | None) -> None:
    columns, rows = gradebook.summary_table(book)
    summary = tables.open("summary.csv", columns)
    for row in rows:
        summary.write(row)
    if history is not None:
        # Opened last, it is replaced first: stopped after the summary, the marks before would be gone.
        changes = tables.open("changes.csv", CHANGES_COLUMNS)
        for change in history.rows(rows):
            changes.write(change)
    for row in gradebook.rejected_rows(book.rejected):
        rejected.write({**row, "student": book.issued.renamed(row["student"])})


def grade_edited_marks(
    course: Course,
    marks: Path,
    issued_path: Path,
    out: Path,
    *,
    feedback: bool | None,
    spreadsheet: Spreadsheet = SPREADSHEETS["point"],
    progress: Progress = lambda done, of: None,
    form: FeedbackForm = USUAL,
    carry: Sequence[str] | None = None,
) -> Gradebook:
    """Write ``summary.csv``, ``rejected.csv`` and feedback sheets for the marks in a file.

    ``changes.csv`` lists the marks that differ from the marking, since they were edited. They are also stored
    in ``decisions.csv``, so that a later marking knows them. The file itself remains unchanged.

    Raises
    ------
    BadInput
        A line that holds no mark of what was issued, or solutions before their day; then nothing is written.
    """
    issued = Issued.read(issued_path)
    issued.carry = issued.carry if carry is None else carry
    shows_solutions(issued, form)
    decisions = DecisionFiles(marks.parent, renamed=issued.renamed).decisions
    files = DecisionFiles(out, renamed=issued.renamed)
    standing = EditedMarks(course, issued, marks)
    sheets = standing.sheets
    feedback = usual_feedback(sheets) if feedback is None else feedback
    machine = standing.marked()
    check_steps(decisions.standing_steps, issued)
    adjustments = decisions.adjustments
    book = Gradebook(adjustments.on(issued), sheets.rows_in, 0, sheets.rejected, sheets.warnings)
    book.presence = presence_by_student(out, issued)
    sheets_shown = []
    history = History(out, _day(form), issued.renamed)
    with Tables(out, spreadsheet) as tables:
        rejected = tables.open("rejected.csv", REJECTED_COLUMNS)
        edited = []
        decided = adjustments.applied(map(decisions.apply, machine), issued, margins_of(course, issued))
        for graded, marked_now in zip(machine, decided, strict=True):
            sheets_shown.append(standing.of(marked_now))
            book.add(sheets_shown[-1])
            files.follow(graded, files.decisions)
            for change in differs(marked_now, sheets_shown[-1]):
                history.add(change)
                edited.append(edited_row(change))
        book.changes = len(edited)
        book.waiting = sum(
            line.verdict == TO_MARK for graded_sheet in sheets_shown for line in graded_sheet.lines.values()
        )
        _write_decisions(files, tables, book, edited)
        _write_counts(book, tables, rejected, history)
        if feedback:
            renew_feedback(course, book, sheets_shown, out, progress, form, tables.check)
        tables.commit()
    _remove_earlier_files(out)
    if marks.resolve() != (out / "marks.csv").resolve():
        write_whole(out / "marks.csv", marks.read_bytes())
    write_record(out, book, PaperQuestions.of(course, issued))
    return book


def _write_decisions(
    files: DecisionFiles, tables: Tables, book: Gradebook, edited: Sequence[dict[str, Any]] = ()
) -> None:
    """Write ``decisions.csv``, if there is something to state. Points for answers that are missing or have
    changed are kept in a copy, with a warning."""
    rows, replaced = [*files.rows(), *edited], files.replaced
    if replaced is not None and (lost := files.lost):
        copy = free_name(replaced)
        write_whole(copy, replaced.read_bytes())
        book.warnings += [*lost, Message("the earlier {file} is now {copy}", file=replaced.name, copy=copy)]
    if files.path is not None and (rows or replaced is not None):
        table = tables.open(files.path.name, files.columns)
        for row in rows:
            table.write({**dict.fromkeys(files.columns, ""), **row})


def _remove_earlier_files(out: Path) -> None:
    """Remove the files of earlier versions whose content ``decisions.csv`` has now."""
    for name in (TO_MARK_FILE, EDITED_FILE):
        (out / name).unlink(missing_ok=True)


def _kept_copy(marks: Path) -> str:
    """Copy marks that were edited and are about to be replaced; return a warning."""
    copy = free_name(marks)
    write_whole(copy, marks.read_bytes())
    return Message(
        (
            "{file} had been edited and is written again: the edited file is now {copy}; to change a "
            "mark for "
            "good, name it in {accepted}"
        ),
        file=marks.name,
        copy=copy,
        accepted=marks.with_name(DECISIONS_FILE),
    )


def nothing_in(submissions: Sequence[Path], rejected: Sequence[Rejected]) -> str:
    """Return the message that nothing can be marked, with the reason."""
    where = first_few([*map(str, submissions)], 3)
    message = Message("nothing in {where} can be marked, so nothing is written", where=where)
    if not rejected:
        return Message(
            "{nothing}; a file of answers has a line of headings, then one line for each answer",
            nothing=message,
        )
    first = rejected[0]
    if len(rejected) == 1:
        return Message("{nothing}: {file}: {reason}", nothing=message, file=first.place, reason=first.reason)
    return Message(
        "{nothing} ({count} row{count:|s} rejected; the first one): {file}: {reason}",
        nothing=message,
        count=len(rejected),
        file=first.place,
        reason=first.reason,
    )
