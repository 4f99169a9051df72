"""Commands of a database of marks, and what build, grade and report do with one."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from coursework.cli.help_pages import HelpfulGroup
from coursework.cli.options import (
    DONE,
    FOLDER,
    FOUND,
    NeedingExtra,
    assignment_option,
    database_ready,
    json_option,
    opened,
    print_notes,
    writes,
)
from coursework.cli.printing import by_reason, print_json, print_table, progress_bar, say, warn_some
from coursework.errors import BadInput, closest, counted
from coursework.messages import Message

if TYPE_CHECKING:
    from coursework.database.grading import GradedNow
    from coursework.database.marking import Change
    from coursework.database.store import Store
    from coursework.gradebook.book import Gradebook
    from coursework.gradebook.feedback_form import FeedbackForm

_MOST_LINES = 10  #: lines that are printed, of however many


def store_at(context: click.Context, url: str, *, new: bool = False) -> Store:
    """Return a database, let go of when the command ends; a file that is not there is made where it may be
    ``new``.

    Raises
    ------
    BadInput
        There is no such database.
    """
    from coursework.database.store import Store, file_of

    file = file_of(url)
    if not new and file is not None and not file.exists():
        raise BadInput(
            "no database {file}{suggestion}; 'coursework build … --db {url}' makes one",
            file=file,
            suggestion=_suggestion(file),
            url=url,
        )
    return context.with_resource(closing(Store(url)))


def _suggestion(file: Path) -> Message | str:
    names = [p.name for p in file.parent.iterdir()] if file.parent.is_dir() else []
    near = closest(file.name, names)
    return Message(" (did you mean {inside}?)", inside=file.with_name(near)) if near else ""


# ------------------------------------------------------------------------ build


def keeping(
    context: click.Context, url: str | None, name: str, course: str
) -> Callable[[Mapping[str, Any]], None]:
    """Return a function that stores an ``issued.json`` in a database, under a name unless it is of an
    assignment; one that does nothing without a database."""
    if url is None:
        return lambda content: None
    store = store_at(context, url, new=True)

    def keep(content: Mapping[str, Any]) -> None:
        from coursework.database.assignments import name_of, put_issued

        with store.begin() as connection:
            put_issued(connection, content, name or name_of(content), course)

    return keep


# ------------------------------------------------------------------------ grade


def grade_stored(
    context: click.Context,
    url: str,
    submissions: Sequence[Path],
    issued: Path | None,
    name: str,
    out: Path | None,
    *,
    feedback: bool | None,
    accepted: Path | None,
    decimal: str,
    form: FeedbackForm,
    replaces: bool,
    writer: Callable[[Gradebook, Path], int],
) -> int:
    """Keep what is new, mark what changed, and write the files where a folder is named; ``writer`` says what
    is in them."""
    course = opened(context)
    store = store_at(context, url, new=issued is not None)
    from coursework.database.assignments import assignment_called, name_of, put_issued
    from coursework.database.grading import grade_new, write_standing
    from coursework.issuing.issued import Issued
    from coursework.system.tables import SPREADSHEETS

    if issued is not None:
        Issued.read(issued)
        content = _json_of(issued)
        with store.begin() as connection:
            assignment = name or name_of(content) or issued.resolve().parent.name
            number = put_issued(connection, content, assignment, course.folder.root.name)
    else:
        with store.reading() as connection:
            number = assignment_called(connection, name)
    now = grade_new(
        course, store, number, submissions, accepted=accepted, out=out, form=form, replaces=replaces
    )
    _tell_new(now)
    if out is None:
        return _tell_changes(now, store, number)
    with progress_bar("writing", None) as advance:
        book = write_standing(
            course,
            store,
            now.work,
            out,
            accepted=accepted,
            feedback=feedback,
            spreadsheet=SPREADSHEETS[decimal],
            progress=advance,
            form=form,
        )
    return writer(book, out)


def _json_of(path: Path) -> Any:
    from coursework.system.json_files import read_json

    return read_json(path)


def _tell_new(now: GradedNow) -> None:
    """Print the submissions that arrived, and how many answers of them were marked."""
    earlier = [delivery for delivery in now.submissions if not delivery.is_new]
    if now.submissions:
        files = counted(now.new, "new file")
        if earlier:
            say("{files}, {count} that came before", files=files, count=len(earlier))
        else:
            say("{files}", files=files)
    if now.decided:
        say("{decisions} taken in", decisions=counted(now.decided, "decision"))
    say(
        "{sheets}: {marked} marked now, {new} of them for the first time",
        sheets=counted(now.marked.sheets, "sheet"),
        marked=now.marked.marked,
        new=now.marked.new,
    )


def _tell_changes(now: GradedNow, store: Store, number: int) -> int:
    """Print the changed marks and the pending decisions."""
    from coursework.database.current_marks import answers_waiting

    for change in now.marked.changes[:_MOST_LINES]:
        click.echo(_change(change))
    if len(now.marked.changes) > _MOST_LINES:
        say(
            "and {count} more; coursework database history lists them all",
            count=len(now.marked.changes) - _MOST_LINES,
        )
    sheets = now.work.sheets
    print_notes(sheets.warnings)
    rejected = by_reason((row.place, row.reason) for row in sheets.rejected)
    warn_some(rejected, Message("what grade --out DIR writes"))
    with store.reading() as connection:
        waits = answers_waiting(connection, number)
    if waits:
        say("{answers} for a person to look at", answers=counted(waits, "answer"))
    return FOUND if waits or rejected else DONE


def _change(change: Change) -> str:
    location = f"{change.student}, {change.exercise}, {change.part}"
    before = f"{change.verdict_before} {change.points_before}".strip() or "nothing"
    now = f"{change.verdict_now} {change.points_now}".strip() or "nothing"
    return f"{location}: {before} before, {now} now"


# ----------------------------------------------------------------------- report


def written_marks(context: click.Context, url: str, name: str, folder: Path, decimal: str) -> None:
    """Write the marks of an assignment as they stand into a folder, and beside it what was issued, for a
    report to read."""
    course = opened(context)
    store = store_at(context, url)
    from coursework.database.assignments import assignment_called, issued_content
    from coursework.database.grading import write_standing
    from coursework.database.marking import Work
    from coursework.system.tables import SPREADSHEETS, json_text
    from coursework.system.writing import write_whole

    with store.reading() as connection:
        number = assignment_called(connection, name)
    work = Work(course, store, number)
    if not work.last:
        raise BadInput("nothing of it is marked yet: coursework grade SUBMISSIONS… --db URL")
    if work.changed:
        print_notes(
            [
                f"{counted(len(work.changed), 'sheet')} came or changed since: coursework grade --db … "
                "marks them"
            ]
        )
    write_standing(course, store, work, folder, feedback=False, spreadsheet=SPREADSHEETS[decimal])
    with store.reading() as connection:
        content = issued_content(connection, number)
    write_whole(folder.parent / "issued.json", json_text(content).encode())


# --------------------------------------------------------------------- database


@click.group(cls=HelpfulGroup)
def database() -> None:
    """Inspect, dump and restore a database of papers, answers, marks and decisions."""


_url_argument = click.argument("url", metavar="URL")


@database.command(cls=NeedingExtra, ready=database_ready)
@_url_argument
@json_option
@click.pass_context
def show(context: click.Context, url: str, as_json: bool) -> None:
    """List the assignments of a database, with how far each is marked."""
    from coursework.database.summary import summaries

    store = store_at(context, url)
    with store.reading() as connection:
        rows = [summary._asdict() for summary in summaries(connection)]
    if as_json:
        print_json(rows)
    elif rows:
        print_table(rows)
    else:
        say("the database contains no assignment")


@database.command(cls=NeedingExtra, ready=database_ready)
@_url_argument
@click.argument("student", required=False)
@click.option("--exercise", default="", help="Show this exercise only.")
@click.option("--part", default="", help="Show this part only.")
@assignment_option
@json_option
@click.pass_context
def history(
    context: click.Context,
    url: str,
    student: str | None,
    exercise: str,
    part: str,
    assignment: str,
    as_json: bool,
) -> None:
    """List every mark of the answers of one student, or of all: when it was given, by whom, and why."""
    from coursework.database.assignments import assignment_called
    from coursework.database.decisions import history as history_of

    store = store_at(context, url)
    with store.reading() as connection:
        number = assignment_called(connection, assignment)
        entries = history_of(connection, number, student, exercise, part)
        if student is not None and not entries:
            _check_student(connection, number, student)
    if as_json:
        rows = (entry._asdict() for entry in entries)
        print_json(
            [
                {"at" if name == "made" else name: v for name, v in row.items()}
                | {"at": row["made"].isoformat()}
                for row in rows
            ]
        )
        return
    if not entries:
        say("nothing was marked")
    for entry in entries:
        about = f"{entry.student}, {entry.exercise} {entry.seed}, {entry.part}"
        click.echo(f"{entry.made.astimezone():%Y-%m-%d %H:%M:%S %Z}  {about}: {_happened(entry)}".rstrip())


def _check_student(connection: Any, number: int, student: str) -> None:
    from coursework.database.assignments import issued_of
    from coursework.errors import nearest

    students = issued_of(connection, number).students
    if students and student not in students:
        raise BadInput(
            "no student {student!r} was issued anything{nearest}",
            student=student,
            nearest=nearest(student, students),
        )


def _happened(entry: Any) -> str:
    points = "" if entry.points is None else f" {entry.points:g}"
    if not entry.by:
        return f"{entry.answer!r} marked {entry.verdict},{points}"
    reason = f": {entry.reason}" if entry.reason else ""
    return f"{entry.kind}{points} by {entry.by}{reason}"


@database.command("new-key", cls=NeedingExtra, ready=database_ready)
@_url_argument
@click.pass_context
def new_key(context: click.Context, url: str) -> None:
    """Replace the key that signs the cookies and forms of a site, if somebody else may have read it.

    Then start the site again.
    """
    store = store_at(context, url)
    from datetime import UTC, datetime

    from coursework.database.audit import note
    from coursework.database.settings import renew_secret, secret

    with store.begin() as connection:
        renew_secret(connection)
        secret(connection)
        note(connection, datetime.now(UTC), "command line", "signing key replaced")
    say("a new key was created: start the site again; open pages with forms must be reloaded")


@database.command("sign-out", cls=NeedingExtra, ready=database_ready)
@_url_argument
@click.argument("login", required=False)
@click.pass_context
def sign_out(context: click.Context, url: str, login: str | None) -> None:
    """End the sessions of a site at once: those of one LOGIN, or all."""
    store = store_at(context, url)
    from datetime import UTC, datetime

    from coursework.database.accounts import account_by_login
    from coursework.database.audit import note
    from coursework.database.sessions import end_all_sessions, end_sessions

    with store.begin() as connection:
        if login is None:
            count = end_all_sessions(connection)
            note(connection, datetime.now(UTC), "command line", "signed out")
            say("{sessions} ended", sessions=counted(count, "session"))
            return
        account = account_by_login(connection, login.strip().casefold())
        if account is None:
            raise BadInput("nobody signs in as {login!r}", login=login)
        end_sessions(connection, account.person_id)
        note(connection, datetime.now(UTC), "command line", "signed out", person=account.person_id)
    say("the sessions of {login} ended", login=login)


@database.command(cls=NeedingExtra, ready=database_ready)
@_url_argument
@click.argument("folder", metavar="DIR", type=FOLDER)
@click.pass_context
def dump(context: click.Context, url: str, folder: Path) -> None:
    """Write a database into the folder DIR as CSV files, one for each table; 'restore' reads them into any
    database."""
    store = store_at(context, url)
    from coursework.database.dump import dump as dump_to

    writes(context, folder)
    rows = dump_to(store, folder)
    say(
        "{rows} of {tables} in {folder}",
        rows=counted(sum(rows.values()), "row"),
        tables=counted(len(rows), "table"),
        folder=folder,
    )


@database.command(cls=NeedingExtra, ready=database_ready)
@click.argument("folder", metavar="DIR", type=FOLDER)
@_url_argument
@click.pass_context
def restore(context: click.Context, folder: Path, url: str) -> None:
    """Read a dump into an empty database of any kind."""
    store = store_at(context, url, new=True)
    from coursework.database.dump import restore as restore_from

    rows = restore_from(folder, store)
    say(
        "{rows} of {tables} from {folder}",
        rows=counted(sum(rows.values()), "row"),
        tables=counted(len(rows), "table"),
        folder=folder,
    )
