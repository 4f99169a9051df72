"""The job of Monday: files of answers in; marks, summary, rejected rows and feedback sheets out.

The tables appear together, whole, in place of those before, or not at all: none takes its place before all are written
and each is seen to be replaceable.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from coursework.course.course import Course
from coursework.errors import BadInput
from coursework.gradebook import book as gradebook
from coursework.gradebook.accepted import Accepted
from coursework.gradebook.book import Gradebook
from coursework.gradebook.changes import CHANGES_COLUMNS, Before
from coursework.gradebook.class_marking import marked
from coursework.gradebook.columns import REJECTED_COLUMNS, marks_columns, summary_columns
from coursework.gradebook.feedback_form import USUAL, Form, shows_solutions
from coursework.gradebook.feedback_sheets import write_feedback
from coursework.gradebook.graded import Graded
from coursework.gradebook.placing import placed
from coursework.gradebook.platform_files import told_seen
from coursework.gradebook.rows import Rejected, Row, Seen
from coursework.gradebook.standing import Standing, differs
from coursework.gradebook.submissions import find, read_file
from coursework.gradebook.to_mark import TO_MARK, TO_MARK_COLUMNS, ToMark, sorted_rows
from coursework.making.issued import Issued
from coursework.making.students import file_stems
from coursework.system.build_folder import free_name
from coursework.system.tables import SPREADSHEETS, Spreadsheet
from coursework.system.writing import Progress, Table, Tables, write_whole

BY_HAND = "by_hand.csv"  #: marks of the folder that a hand changed
#: For so many students at most, feedback sheets are printed unless told.
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
    form: Form = USUAL,
) -> Gradebook:
    """Mark files and write ``marks.csv``, ``summary.csv``, ``rejected.csv`` and feedback sheets; ``to_mark.csv`` where
    answers are marked by a person, whose points in an earlier one count.

    Where marks were there before, ``changes.csv`` says what differs now. ``accepted`` names answers that
    a person accepts; unless told, those of ``accepted.csv`` in ``out``. ``feedback`` None prints sheets for a
    class of usual size, in the ``form`` that is asked for. ``spreadsheet`` is what the tables are written for.

    Raises
    ------
    BadInput
        A file that is not there, or nothing that can be marked, or solutions before their day: then nothing is written.
    """
    issued = Issued.read(issued_path)
    shows_solutions(issued, form)
    if feedback is None:
        feedback = max(len(issued.students), len(issued.records)) <= FEEDBACK_STUDENTS
    kept = out / "accepted.csv"
    by_hand = Accepted(accepted if accepted is not None else kept if kept.exists() else None)
    by_person = ToMark(out / "to_mark.csv")
    before = Before(out / "marks.csv")

    def rows() -> Iterator[Row | Rejected | Seen]:
        for found in find(submissions):
            yield from [found] if isinstance(found, (Rejected, Seen)) else read_file(found)

    sheets = placed(course, issued, rows())
    if not sheets.sheets:
        raise BadInput(_nothing(submissions, sheets.rejected))
    book = Gradebook(issued, sheets.rows_in, sheets.blanks, sheets.rejected, sheets.warnings)
    book.seen = told_seen(sheets.seen)
    shown: list[Graded] = []
    with Tables(out, spreadsheet) as tables:
        marks = tables.open("marks.csv", marks_columns(issued, submitted=bool(sheets.submitted)))
        summary = tables.open("summary.csv", summary_columns(issued))
        rejected = tables.open("rejected.csv", REJECTED_COLUMNS)
        changes = tables.open("changes.csv", CHANGES_COLUMNS) if before.exists else None
        for done, graded in enumerate(marked(course, issued, sheets, printed=feedback), start=1):
            lang = str(graded.record.get("lang", "fr"))
            graded = by_hand.apply(by_person.apply(graded, lang), lang)
            book.add(graded)
            for row in gradebook.marks_rows(graded):
                marks.write(row)
                if changes is not None and (change := before.changed(row)) is not None:
                    changes.write(change)
            if feedback:
                shown.append(graded)
            progress(done, len(sheets.sheets))
        if changes is not None:
            for change in before.gone():
                changes.write(change)
            book.changes = changes.rows
        book.faults, notes = by_hand.unfollowed(issued, dict.fromkeys(s for s, _ in book.students))
        book.warnings += notes
        book.waiting = by_person.waiting
        _list_to_mark(by_person, tables, book)
        _write_counts(book, summary, rejected)
        stood = (out / BY_HAND).exists()
        if book.changes and (stood or before.edited(out / "summary.csv")):
            book.warnings.insert(0, _kept(out / "marks.csv"))
        tables.keep()
    (out / BY_HAND).unlink(missing_ok=True)
    if feedback:
        made = file_stems(dict.fromkeys((*issued.students, *before.students)))
        write_feedback(course, book, shown, out / "feedback", made, progress, form)
    return book


def _write_counts(book: Gradebook, summary: Table, rejected: Table) -> None:
    for row in gradebook.summary_rows(book):
        summary.write(row)
    for row in gradebook.rejected_rows(book.rejected):
        rejected.write(row)


def grade_standing(
    course: Course,
    marks: Path,
    issued_path: Path,
    out: Path,
    *,
    feedback: bool | None,
    spreadsheet: Spreadsheet = SPREADSHEETS["point"],
    progress: Progress = lambda done, of: None,
    form: Form = USUAL,
) -> Gradebook:
    """Write ``summary.csv``, ``rejected.csv`` and feedback sheets of the marks as they stand in a file.

    ``changes.csv`` says which of them are not what the marking gives: a hand changed them. They are kept in
    ``by_hand.csv`` too, so that a later marking knows of them. The file itself stays as it is.

    Raises
    ------
    BadInput
        A line that holds no mark of what was issued, or solutions before their day; then nothing is written.
    """
    issued = Issued.read(issued_path)
    shows_solutions(issued, form)
    if feedback is None:
        feedback = max(len(issued.students), len(issued.records)) <= FEEDBACK_STUDENTS
    kept = marks.with_name("accepted.csv")
    accepted, by_person = Accepted(kept if kept.exists() else None), ToMark(marks.with_name("to_mark.csv"))
    standing = Standing(course, issued, marks)
    sheets = standing.sheets
    earlier = len(sheets.rejected)
    machine = list(marked(course, issued, sheets, printed=feedback))
    standing.refuse(sheets.rejected[earlier:])
    book = Gradebook(issued, sheets.rows_in, 0, sheets.rejected, sheets.warnings)
    shown = []
    before = Before(out / "marks.csv").students
    with Tables(out, spreadsheet) as tables:
        summary = tables.open("summary.csv", summary_columns(issued))
        rejected = tables.open("rejected.csv", REJECTED_COLUMNS)
        changes, by_hand = (tables.open(name, CHANGES_COLUMNS) for name in ("changes.csv", BY_HAND))
        for graded in machine:
            shown.append(standing.of(graded))
            book.add(shown[-1])
            lang = str(graded.record.get("lang", "fr"))
            for change in differs(accepted.apply(by_person.apply(graded, lang), lang), shown[-1]):
                changes.write(change)
                by_hand.write(change)
        book.changes = changes.rows
        book.waiting = sum(line.verdict == TO_MARK for one in shown for line in one.lines.values())
        _write_counts(book, summary, rejected)
        tables.keep()
    if not book.changes:
        (out / BY_HAND).unlink()
    if marks.resolve() != (out / "marks.csv").resolve():
        write_whole(out / "marks.csv", marks.read_bytes())
    if feedback:
        made = file_stems(dict.fromkeys((*issued.students, *before)))
        write_feedback(course, book, shown, out / "feedback", made, progress, form)
    return book


def _list_to_mark(by_person: ToMark, tables: Tables, book: Gradebook) -> None:
    """Write what a person marks; points for what nobody answered, or answered anew, stay in a copy, and are told."""
    path = by_person.path
    if by_person.loses:
        kept = free_name(path)
        write_whole(kept, path.read_bytes())
        changed = [f"marked by a person, but answered anew since: {place}" for place in by_person.changed]
        unused = [f"marked by a person, but never answered: {place}" for place in by_person.unused]
        book.warnings += [*changed, *unused, f"{path.name} as it was is kept as {kept}"]
    if by_person.rows or path.exists():
        table = tables.open(path.name, TO_MARK_COLUMNS)
        for row in sorted_rows(by_person.rows):
            table.write(row)


def _kept(marks: Path) -> str:
    """Keep marks that were edited, beside those that take their place; says so."""
    kept = free_name(marks)
    write_whole(kept, marks.read_bytes())
    return (
        f"{marks.name} had been edited, and is written anew: the edited one is kept as {kept}; a mark that is to last is "
        f"named in {marks.with_name('accepted.csv')}"
    )


def _nothing(submissions: Sequence[Path], rejected: Sequence[Rejected]) -> str:
    """That nothing can be marked, and why."""
    where = ", ".join(map(str, submissions[:3])) + (", …" if len(submissions) > 3 else "")
    told = f"nothing in {where} can be marked, so nothing is written"
    if not rejected:
        return f"{told}; a file of answers has a line of headings, then a line an answer"
    count = "" if len(rejected) == 1 else f" ({len(rejected)} rows rejected; the first is told)"
    return f"{told}{count}: {rejected[0].source}: {rejected[0].reason}"
