"""Commands that make what is handed out: build, demo."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from coursework.cli.assignments import (
    build_assignment,
    check_scan,
    codes_ready,
    for_practice,
    is_assignment,
    say_staff_half,
)
from coursework.cli.database import keeping
from coursework.cli.options import (
    UNLESS_TOLD,
    FilePath,
    Lists,
    WholeNumber,
    cluster_option,
    columns_option,
    db_option,
    decimal_option,
    exercise_names,
    exercises_argument,
    known_formats,
    known_languages,
    needing_extra,
    opened,
    parts_option,
    print_notes,
    seed_option,
    shared_by_cluster,
    split_list,
    spoken,
    unknown_language,
    writes,
)
from coursework.cli.printing import print_table, progress_bar, say
from coursework.errors import BadInput, counted
from coursework.messages import Message, localised
from coursework.system.limits import MOST_VARIANTS

if TYPE_CHECKING:
    from coursework.course.course import Course
    from coursework.issuing.roster import Student


# ------------------------------------------------------------------------ build


@click.command()
@exercises_argument
@click.option(
    "--variants",
    "count",
    type=WholeNumber(1, MOST_VARIANTS),
    help="How many variants; with a roster, one a student.",
)
@seed_option
@click.option(
    "--roster",
    type=FilePath(path_type=Path),
    help="CSV with a column student, or surname and first name, and, if wanted, lang.",
)
@columns_option
@click.option("--formats", type=Lists(known_formats), default="pdf,ipynb,html", show_default=True)
@click.option(
    "--lang",
    "langs",
    type=Lists(known_languages, unknown_language),
    callback=spoken,
    help="Languages of the sheets: fr, en, or both as fr,en. A student whose roster line says lang has that one. "
    f"Unless told, {UNLESS_TOLD}.",
)
@parts_option
@click.option("--practice", is_flag=True, help="Self-study notebooks, which check answers.")
@click.option(
    "--paper",
    type=click.Choice(["a4", "letter"]),
    default="a4",
    show_default=True,
    help="Paper of the sheets.",
)
@click.option("--booklet", is_flag=True, help="Also all students' sheets in one PDF, to print at once.")
@click.option(
    "--scan",
    is_flag=True,
    is_eager=True,
    callback=needing_extra(codes_ready),
    help="Answer pages behind the statements, which coursework scan reads; in the PDFs. Print at 100 %, not fitted to the page.",
)
@click.option(
    "--polygons/--no-polygons",
    default=True,
    help="Velocity and acceleration polygons in the worked solutions; without them a build takes half to two thirds of the time.",
)
@click.option("--out", type=FilePath(path_type=Path, file_okay=False), help="Folder to write.")
@decimal_option
@click.option(
    "--overwrite",
    is_flag=True,
    help="Replace what was issued there before. Files that were filled in or changed are set aside, not lost.",
)
@click.option(
    "--again",
    multiple=True,
    metavar="STUDENT",
    help="Of an assignment: write a lost paper once more, as it was.",
)
@click.option(
    "--make-up", multiple=True, metavar="STUDENT", help="Of an assignment: another paper for who makes up."
)
@db_option
@click.option(
    "--name",
    default="",
    help="What it is called in the database; the assignment's name, or that of the folder, unless told.",
)
@cluster_option
@click.pass_context
def build(
    context: click.Context,
    exercises: Sequence[str],
    count: int | None,
    seed: int,
    roster: Path | None,
    columns: Mapping[str, str] | None,
    formats: Sequence[str],
    langs: Sequence[str],
    parts: str,
    practice: bool,
    paper: str,
    booklet: bool,
    scan: bool,
    polygons: bool,
    out: Path | None,
    decimal: str,
    overwrite: bool,
    again: Sequence[str],
    make_up: Sequence[str],
    db: str | None,
    name: str,
    cluster: str | None,
) -> None:
    """Make sheets, notebooks and pages for a class, with the staff's half beside them.

    Of exercises, or of an assignment: a file such as midterm.toml, which makes one paper of several exercises.
    """
    if name and db is None:
        raise BadInput("--name is what it is called in a database: --db URL")
    if is_assignment(exercises):
        build_assignment(context, Path(exercises[0]), again=again, make_up=make_up, overwrite=overwrite)
        return
    if again or make_up:
        raise BadInput("--again and --make-up are of an assignment: coursework build FILE.toml …")
    if out is None:
        raise BadInput("no folder to write: --out DIR")
    from coursework.issuing.roster import read_roster

    if roster and count:
        raise BadInput("--variants and --roster exclude each other: a roster has one variant a student")
    if scan:
        check_scan(formats, booklet=booklet)
    course = opened(context)
    names = exercise_names(course, exercises)
    writes(context, out)
    notes: list[str] = []
    students = read_roster(roster, notes.append, columns) if roster else []
    with_language = sum(bool(student.lang) for student in students)
    if with_language and not _is_untold(context, "langs"):
        notes.append(
            f"the roster says the language of {with_language} of its {counted(len(students), 'student')}, which counts; "
            f"--lang {','.join(langs)} is for those of whom it says none"
        )
    print_notes(notes)
    shared_by_cluster(context, cluster)
    written = build_files(
        course,
        names,
        count or 1,
        seed,
        students,
        formats,
        langs,
        out,
        parts=split_list(parts) or None,
        practice=practice,
        paper=paper,
        booklet=booklet,
        scan=scan,
        polygons=polygons,
        decimal=decimal,
        overwrite=overwrite,
        store=keeping(context, db, name or out.resolve().name, course.folder.root.name),
    )
    if roster:
        print_notes([for_practice(langs[0])])
    say(
        "{files} in {out}: handouts/ to give away, issued.json and answers.csv to keep"
        if set(formats) - {"nbgrader"}
        else "{files} in {out}: issued.json and answers.csv to keep",
        files=counted(written, "file"),
        out=out,
    )
    say_staff_half(out, names[0] if "nbgrader" in formats else "")


def _is_untold(context: click.Context, option: str) -> bool:
    return context.get_parameter_source(option) is click.core.ParameterSource.DEFAULT


def build_files(
    course: Course,
    names: Sequence[str],
    count: int,
    seed: int,
    students: Sequence[Student],
    formats: Sequence[str],
    langs: Sequence[str],
    out: Path,
    *,
    parts: Sequence[str] | None = None,
    practice: bool = False,
    paper: str = "a4",
    booklet: bool = False,
    scan: bool = False,
    polygons: bool = True,
    decimal: str = "point",
    overwrite: bool = False,
    store: Callable[[Mapping[str, Any]], None] = lambda content: None,
) -> int:
    """Issue and write a build; return how many files were written. ``store`` is handed what ``issued.json`` says, before
    anything is written."""
    from coursework.issuing import build as building
    from coursework.issuing.issued import issued_content
    from coursework.issuing.issuing import issue
    from coursework.issuing.letters import unprinted_names
    from coursework.rendering.renderer import renderer_of
    from coursework.system.tables import SPREADSHEETS, json_text
    from coursework.system.writing import write_tree

    issues = issue(course, names, first_seed=seed, count=count, langs=langs, roster=students, parts=parts)
    content = issued_content(issues)
    text = json_text(content)
    before = out / "issued.json"
    if not overwrite and before.is_file() and not _goes_on(before, text):
        raise BadInput(
            "{before} holds other variants, issued before; choose another --out, or --overwrite to replace them (files that were filled in or changed are set aside, not lost)",
            before=before,
        )
    wanted = list(
        building.files(
            course,
            issues,
            formats,
            practice=practice,
            paper=paper,
            booklet=booklet,
            scan=scan,
            polygons=polygons,
            spreadsheet=SPREADSHEETS[decimal],
        )
    )
    if "nbgrader" in formats:
        from coursework.nbgrader import tree as nbgrader

        wanted[:0] = nbgrader.files(course, issues, None, out)
    store(content)
    with progress_bar("building", len(wanted)) as advance:
        notes = write_tree(out, wanted, advance, anew=overwrite)
    if booklet or "pdf" in formats:
        notes += unprinted_names(renderer_of(course.folder), (pair.student for pair in issues))
    print_notes(notes)
    return len(wanted)


def _goes_on(before: Path, issued: str) -> bool:
    """Return whether every sheet that was issued before is unchanged in the new record, which may have more
    students."""
    from coursework.issuing.issued import Issued

    old, new = _by_place(Issued.read_previous(before)), _by_place(json.loads(issued))
    return all(new.get(index) == record for index, record in old.items())


def _by_place(content: Mapping[str, Any]) -> dict[tuple[Any, ...], Any]:
    """Return the records by student, exercise and seed."""
    records = ((item.get("student", ""), item["record"]) for item in content["issued"])
    return {(student, record["exercise"], record["seed"]): record for student, record in records}


# ------------------------------------------------------------------------- demo


@click.command()
@click.option("--out", type=FilePath(path_type=Path, file_okay=False), default="demo", show_default=True)
@click.pass_context
def demo(context: click.Context, out: Path) -> None:
    """Do the whole job on a small class: sheets, answers of all kinds, marks."""
    from coursework.cli.demo import class_of_twelve
    from coursework.cli.mark import grade_with_bar

    writes(context, out)
    rows, lines = class_of_twelve(out, build_files, grade_with_bar)
    print_table(rows, title=localised(Message("What became of the answers")))
    for line in lines:
        click.echo(line)
