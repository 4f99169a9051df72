"""Commands that mark: grade, report."""

from __future__ import annotations

import datetime
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from coursework.cli.options import (
    DONE,
    EXISTING_FILE,
    FOLDER,
    FOUND,
    PATH,
    Lists,
    assignment_option,
    cluster_option,
    db_option,
    decimal_option,
    json_option,
    lang_option,
    opened,
    shared_by_cluster,
    split_list,
    writes,
)
from coursework.cli.printing import by_reason, print_json, progress_bar, say, warn, warn_some
from coursework.errors import BadInput, counted, first_few
from coursework.messages import Message, localised
from coursework.system.extras import libraries
from coursework.system.visible import one_line

if TYPE_CHECKING:
    from coursework.course.course import Course
    from coursework.gradebook.book import Gradebook
    from coursework.gradebook.feedback_form import FeedbackForm


# ------------------------------------------------------------------------ grade


@click.command()
@click.argument("submissions", nargs=-1, type=PATH)
@click.option("--issued", type=PATH, help="The issued.json of the build; with --db only the first time.")
@db_option
@assignment_option
@click.option(
    "--replace",
    is_flag=True,
    help=("With --db: a file replaces the earlier one of the same name, for a corrected or a new export."),
)
@click.option(
    "--out", type=FOLDER, help="Folder to write; by default marks/ beside issued.json, and none with --db."
)
@click.option(
    "--feedback/--no-feedback",
    default=None,
    help=("Write a feedback sheet for each student; by default for classes of up to 1000 students."),
)
@click.option(
    "--formats",
    type=Lists(lambda: ("pdf", "html", "ipynb")),
    default="pdf",
    show_default=True,
    help="Formats of the feedback sheets: pdf, html, ipynb.",
)
@click.option(
    "--with-solutions",
    is_flag=True,
    help=(
        "Add the worked solution of the student's own variant to the feedback sheet. If the assignment "
        "states "
        "solutions_after, the solution appears from that day on and never before."
    ),
)
@click.option(
    "--today",
    type=click.DateTime(["%Y-%m-%d"]),
    metavar="DAY",
    help="Date to compare with solutions_after; by default today.",
)
@click.option(
    "--accepted",
    type=EXISTING_FILE,
    help=(
        "CSV of answers accepted by hand: student,exercise,seed,part and optionally points,reason. The "
        "decisions.csv in the folder of the marks is always read."
    ),
)
@click.option(
    "--carry",
    metavar="COLUMN,COLUMN",
    help=(
        "Columns of the roster that summary.csv repeats, such as number,group; by default those of the "
        "assignment, else "
        "all but birth, health and extra time."
    ),
)
@click.option(
    "--names",
    is_flag=True,
    help=(
        "Lift the anonymity of the assignment for good: names take the place of codes in what is "
        "written from now on. "
        "Refused as long as an answer waits."
    ),
)
@decimal_option
@click.option(
    "--from",
    "marks",
    type=EXISTING_FILE,
    help=(
        "Take the marks from a marks.csv that was edited by hand, without SUBMISSIONS; the summary and the "
        "feedback are written from it."
    ),
)
@cluster_option
@click.pass_context
def grade(
    context: click.Context,
    submissions: Sequence[Path],
    issued: Path | None,
    db: str | None,
    assignment: str,
    replace: bool,
    out: Path | None,
    feedback: bool | None,
    formats: Sequence[str],
    with_solutions: bool,
    today: datetime.datetime | None,
    accepted: Path | None,
    carry: str | None,
    names: bool,
    decimal: str,
    marks: Path | None,
    cluster: str | None,
) -> int:
    """Mark answers in CSV, JSON, Parquet and notebooks, files or folders of them.

    Exports of platforms are read as they are: the Responses report of a Moodle quiz, Canvas's Student
    Analysis, QTI results, and the folders of nbgrader, Moodle and Canvas. A second run lists what changed and
    for whom.

    With --db the answers are added to a database; only new or changed sheets are marked, and files are
    written only with --out.
    """
    if any(path.suffix.lower() == ".parquet" for path in submissions):
        libraries(("pyarrow",), "Parquet needs", "parquet")
    if issued is not None and issued.is_dir():
        inside = issued / "issued.json"
        would_do = (
            Message("did you mean {inside}?", inside=inside)
            if inside.exists()
            else Message("name the issued.json of the build")
        )
        raise BadInput(
            "--issued takes a file, and {issued} is a folder: {would_do}", issued=issued, would_do=would_do
        )
    if db is None and issued is None:
        raise BadInput(
            "Missing option '--issued': the issued.json of the build, or --db with a database that has it"
        )
    if db is None and (assignment or replace):
        raise BadInput(
            "{option} needs a database: --db URL", option="--assignment" if assignment else "--replace"
        )
    if db is not None and names:
        raise BadInput("--names applies to files; a database has names")
    if db is not None and carry is not None:
        raise BadInput("--carry applies to files; in a database the assignment states the columns")
    _check_source(submissions, marks, accepted, in_database=db is not None)
    from coursework.gradebook.feedback_form import FeedbackForm

    form = FeedbackForm(formats, with_solutions, today.date() if today else None)
    carried = None if carry is None else split_list(carry)
    shared_by_cluster(context, cluster)
    if db is not None:
        from coursework.cli.database import grade_stored

        if out is not None:
            writes(context, out)

        return grade_stored(
            context,
            db,
            submissions,
            issued,
            assignment,
            out,
            feedback=feedback,
            accepted=accepted,
            decimal=decimal,
            form=form,
            replaces=replace,
            writer=_print_gradebook,
        )
    assert issued is not None
    if marks is not None:
        out = out or marks.parent
        writes(context, out)
        return _print_standing(
            _grade_standing(opened(context), marks, issued, out, feedback, decimal, form, carried), marks, out
        )
    out = out or issued.parent / "marks"
    writes(context, out)

    def graded(*, feedback: bool | None) -> Gradebook:
        return grade_with_bar(
            opened(context),
            submissions,
            issued,
            out,
            feedback=feedback,
            accepted=accepted,
            decimal=decimal,
            form=form,
            carry=carried,
        )

    if names:
        from coursework.gradebook.anonymity import lift

        lift(issued, lambda: graded(feedback=False).review_count, form.today)
    book = graded(feedback=feedback)
    status = _print_gradebook(book, out)
    if book.issued.is_anonymous:
        say("students go by their codes; once nothing waits, --names puts their names in place of them")
    return status


def _print_gradebook(book: Gradebook, out: Path) -> int:
    """Say what a folder of marks holds."""
    for line in book.seen:
        click.echo(one_line(localised(line)))
    say(
        "{rows}: {marked} marked, {rejected} rejected{blanks}; see {out}",
        rows=counted(book.rows_in, "row"),
        marked=book.marked,
        rejected=len(book.rejected),
        blanks=Message(", {count} blank beside another", count=book.blanks) if book.blanks else "",
        out=out,
    )
    if book.unreadable:
        say(
            "{answers} to look at: verdict unreadable in {file}",
            answers=counted(book.unreadable, "unreadable answer"),
            file=out / "marks.csv",
        )
    if book.waiting:
        say(
            "{count} answer{count:|s} wait{count:s|} to be marked by a person: give points in {file}, "
            "and grade again",
            count=book.waiting,
            file=out / "decisions.csv",
        )
    if book.on_scans:
        say(
            "{count} of them {count:is|are} on scans: type those that the page of the queue shows",
            count=book.on_scans,
        )
    if book.changes:
        say("{count} mark{count:|s} changed; see {file}", count=book.changes, file=out / "changes.csv")
    _print_warnings(book)
    for fault in book.faults:
        click.echo(f"coursework: {one_line(localised(fault))}", err=True)
    warn_some(by_reason((row.place, row.reason) for row in book.rejected), out / "rejected.csv")
    return FOUND if book.review_count else DONE


def _check_source(
    submissions: Sequence[Path], marks: Path | None, accepted: Path | None, *, in_database: bool
) -> None:
    """Raise where the source of the marks is not exactly one: submissions, marks as they stand, or a
    database."""
    if marks is not None and in_database:
        raise BadInput(
            (
                "--from takes the marks in {marks}, and --db those of the database, where "
                "decisions.csv changes "
                "marks: use one of them"
            ),
            marks=marks,
        )
    if marks is None and not submissions and not in_database:
        raise BadInput("nothing to mark; name SUBMISSIONS, files or folders of answers, or --from marks.csv")
    if marks is not None and submissions:
        raise BadInput(
            (
                "--from takes the marks in {marks} as they are: omit SUBMISSIONS, or omit --from to "
                "mark them again"
            ),
            marks=marks,
        )
    if marks is not None and accepted is not None:
        raise BadInput(
            (
                "--from takes the marks in {marks} as they are: edit them there, or omit --from to "
                "accept answers"
            ),
            marks=marks,
        )


def _grade_standing(
    course: Course,
    marks: Path,
    issued: Path,
    out: Path,
    feedback: bool | None,
    decimal: str,
    form: FeedbackForm,
    carry: Sequence[str] | None,
) -> Gradebook:
    from coursework.gradebook.grading import grade_edited_marks
    from coursework.system.tables import SPREADSHEETS

    with progress_bar("marking", None) as advance:
        return grade_edited_marks(
            course,
            marks,
            issued,
            out,
            feedback=feedback,
            spreadsheet=SPREADSHEETS[decimal],
            progress=advance,
            form=form,
            carry=carry,
        )


def _print_standing(book: Gradebook, marks: Path, out: Path) -> int:
    say("{marks} taken from {source}; see {out}", marks=counted(book.rows_in, "mark"), source=marks, out=out)
    if book.changes:
        say(
            "{count} mark{count:|s} {count:was|were} changed by hand; see {file}",
            count=book.changes,
            file=out / "changes.csv",
        )
    _print_warnings(book)
    return FOUND if book.review_count else DONE


def _print_warnings(book: Gradebook) -> None:
    for warning in book.warnings:
        warn("note: {note}", note=one_line(localised(warning)))


def grade_with_bar(
    course: Course,
    submissions: Sequence[Path],
    issued: Path,
    out: Path,
    *,
    feedback: bool | None = True,
    accepted: Path | None = None,
    decimal: str = "point",
    form: FeedbackForm | None = None,
    carry: Sequence[str] | None = None,
) -> Gradebook:
    """Mark files and write the tables, with a bar on a terminal."""
    from coursework.gradebook.feedback_form import FeedbackForm
    from coursework.gradebook.grading import grade_files
    from coursework.system.tables import SPREADSHEETS

    with progress_bar("marking", None) as advance:
        return grade_files(
            course,
            submissions,
            issued,
            out,
            feedback=feedback,
            accepted=accepted,
            spreadsheet=SPREADSHEETS[decimal],
            progress=advance,
            form=form or FeedbackForm(),
            carry=carry,
        )


# ----------------------------------------------------------------------- report


@click.command()
@click.argument("folder", metavar="DIR", type=PATH, required=False)
@db_option
@assignment_option
@lang_option
@click.option("--out", type=FOLDER, help="Folder to write; by default DIR/report.")
@decimal_option
@cluster_option
@json_option
@click.pass_context
def report(
    context: click.Context,
    folder: Path | None,
    db: str | None,
    assignment: str,
    lang: str,
    out: Path | None,
    decimal: str,
    cluster: str | None,
    as_json: bool,
) -> None:
    """Write a report on a class from the folder DIR of grade, or from a database: a page (HTML, PDF) and
    tables.

    With --json and without --out nothing is written.
    """
    shared_by_cluster(context, cluster)
    if db is None and folder is not None:
        _report(context, folder, lang, out, decimal, as_json)
        return
    if db is None or folder is not None:
        raise BadInput(
            "a report needs a folder DIR written by grade, or a database, --db URL: name one of them"
        )
    if out is None and not as_json:
        raise BadInput("no folder to write: --out DIR")
    from tempfile import TemporaryDirectory

    from coursework.cli.database import written_marks

    with TemporaryDirectory() as temporary:
        written_marks(context, db, assignment, Path(temporary) / "marks", decimal)
        _report(context, Path(temporary) / "marks", lang, out, decimal, as_json)


def _report(
    context: click.Context, folder: Path, lang: str, out: Path | None, decimal: str, as_json: bool
) -> None:
    from coursework.gradebook.statistics import measures as statistics
    from coursework.gradebook.statistics import page as statistics_page
    from coursework.gradebook.statistics.marks import read, unlike_summary
    from coursework.language.words import words

    words(lang)  # an unknown language stops here
    course = opened(context)
    marks = read(folder)
    if unlike := unlike_summary(folder, marks):
        path = folder / "marks.csv"
        warn(
            "note: {students} with other points in {path} than in summary.csv ({names}): the report is "
            "of {path}; "
            "'coursework grade --issued … --from {path}' makes summary and feedback agree with it",
            students=counted(len(unlike), "student"),
            path=path,
            names=first_few(unlike, 1),
        )
    measures = statistics.measure(marks, statistics_page.sheet_order(course, marks.exercises))
    if as_json:
        print_json(measures.as_json())
    target = out or folder / "report"
    if out is not None or not as_json:
        writes(context, target)
        _write_report(course, folder, measures, lang, target, decimal)
        _tell_alike(folder, target, decimal)
    if not as_json:
        say(
            "{students}, {answers}, {count} to be looked at; see {stem}.html, .pdf, parts.csv, mistakes.csv",
            students=counted(measures.students, "student"),
            answers=counted(measures.answers, "answer"),
            count=measures.needs_a_look,
            stem=target / "report",
        )


def _tell_alike(folder: Path, out: Path, decimal: str) -> None:
    """Say whose wrong answers are right on another variant; the table of an earlier report goes where there
    are none."""
    from coursework.gradebook.statistics.alike import COLUMNS, alike
    from coursework.system.tables import SPREADSHEETS, csv_file
    from coursework.system.writing import write_whole

    path = out / "alike.csv"
    if not (copied := alike(folder)):
        path.unlink(missing_ok=True)
        return
    write_whole(path, csv_file((pair.row() for pair in copied), COLUMNS, SPREADSHEETS[decimal]))
    warn(
        "note: {sheets} of answers that are right on another student's variant, see {path}",
        sheets=counted(len(copied), "sheet"),
        path=path,
    )


def _write_report(course: Course, folder: Path, measures: Any, lang: str, out: Path, decimal: str) -> None:
    """Everything is made before the first file is written."""
    from coursework.gradebook.marks_record import read_record
    from coursework.gradebook.statistics import measures as statistics
    from coursework.gradebook.statistics import page as statistics_page
    from coursework.rendering.renderer import renderer_of
    from coursework.system.processes import Task, in_turn, is_shared
    from coursework.system.tables import SPREADSHEETS, csv_file
    from coursework.system.writing import write_whole

    record = read_record(folder)
    page = statistics_page.report(course, measures, lang, record and record.questions)
    renderer = renderer_of(course.folder)
    spreadsheet = SPREADSHEETS[decimal]
    mistakes = statistics_page.mistake_rows(course, measures, lang)
    pages = [
        Task("report.html", renderer.report_html, (page,)),
        Task("report.pdf", renderer.report_pdf, (page,)),
    ]
    html, pdf = in_turn(pages, 2) if is_shared() else (task.function(*task.arguments) for task in pages)
    files = {
        "report.html": html.encode("utf-8"),
        "report.pdf": pdf,
        "parts.csv": csv_file((p.row() for p in measures.parts), statistics.PART_COLUMNS, spreadsheet),
        "mistakes.csv": csv_file(mistakes, statistics.MISTAKE_COLUMNS, spreadsheet),
    }
    for name, content in files.items():
        write_whole(out / name, content)
