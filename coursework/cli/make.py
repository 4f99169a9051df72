"""Commands that make what is handed out: build, demo."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from coursework.cli.assignments import build_assignment, is_assignment
from coursework.cli.options import (
    UNLESS_TOLD,
    Lists,
    Whole,
    decimal_option,
    exercise_names,
    exercises_argument,
    known_formats,
    known_languages,
    opened,
    parts_option,
    seed_option,
    split_list,
    spoken,
    tell,
    unknown_language,
)
from coursework.cli.printing import print_table, progress_bar
from coursework.errors import BadInput, counted

if TYPE_CHECKING:
    from coursework.course.course import Course
    from coursework.making.roster import Student


# ------------------------------------------------------------------------ build


@click.command()
@exercises_argument
@click.option("--variants", "count", type=Whole(1), help="How many variants; with a roster, one a student.")
@seed_option
@click.option(
    "--roster",
    type=click.Path(path_type=Path),
    help="CSV with a column student, or surname and first name, and, if wanted, lang.",
)
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
    "--polygons/--no-polygons",
    default=True,
    help="Velocity and acceleration polygons in the worked solutions; without them a build takes half to two thirds of the time.",
)
@click.option("--out", type=click.Path(path_type=Path, file_okay=False), help="Folder to write.")
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
@click.pass_context
def build(
    context: click.Context,
    exercises: Sequence[str],
    count: int | None,
    seed: int,
    roster: Path | None,
    formats: Sequence[str],
    langs: Sequence[str],
    parts: str,
    practice: bool,
    paper: str,
    booklet: bool,
    polygons: bool,
    out: Path | None,
    decimal: str,
    overwrite: bool,
    again: Sequence[str],
    make_up: Sequence[str],
) -> None:
    """Make sheets, notebooks and pages for a class, with the staff's half beside them.

    Of exercises, or of an assignment: a file such as midterm.toml, which makes one paper of several exercises.
    """
    if is_assignment(exercises):
        build_assignment(context, Path(exercises[0]), again=again, make_up=make_up, overwrite=overwrite)
        return
    if again or make_up:
        raise BadInput("--again and --make-up are of an assignment: coursework build FILE.toml …")
    if out is None:
        raise BadInput("no folder to write: --out DIR")
    from coursework.making.roster import read_roster

    if roster and count:
        raise BadInput("--variants and --roster exclude each other: a roster has one variant a student")
    course = opened(context)
    names = exercise_names(course, exercises)
    notes: list[str] = []
    students = read_roster(roster, notes.append) if roster else []
    own = sum(bool(student.lang) for student in students)
    if own and context.get_parameter_source("langs") is not click.core.ParameterSource.DEFAULT:
        notes.append(
            f"the roster says the language of {own} of its {counted(len(students), 'student')}, which counts; "
            f"--lang {','.join(langs)} is for those of whom it says none"
        )
    tell(notes)
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
        polygons=polygons,
        decimal=decimal,
        overwrite=overwrite,
    )
    away = "handouts/ to give away, " if set(formats) - {"nbgrader"} else ""
    click.echo(f"{counted(written, 'file')} in {out}: {away}issued.json and answers.csv to keep")
    if course.folder.has_solutions:
        click.echo(f"worked solutions and the key, for the staff alone: {out / 'instructor'}")
    if "nbgrader" in formats:
        click.echo(f"a course of nbgrader: {out / 'nbgrader'}; how to go on stands there, in {names[0]}.md")


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
    polygons: bool = True,
    decimal: str = "point",
    overwrite: bool = False,
) -> int:
    """Issue and write a build; gives how many files were written."""
    from coursework.making import build as building
    from coursework.making.issued import issued_content
    from coursework.making.issuing import issue
    from coursework.making.letters import unprinted_names
    from coursework.rendering.renderer import renderer_of
    from coursework.system.tables import SPREADSHEETS, json_text
    from coursework.system.writing import write_tree

    issues = issue(course, names, first_seed=seed, count=count, langs=langs, roster=students, parts=parts)
    issued = json_text(issued_content(issues))
    before = out / "issued.json"
    if not overwrite and before.is_file() and not _goes_on(before, issued):
        raise BadInput(
            f"{before} holds other variants, issued before; choose another --out, or --overwrite to replace them "
            "(files that were filled in or changed are set aside, not lost)"
        )
    wanted = list(
        building.files(
            course,
            issues,
            formats,
            practice=practice,
            paper=paper,
            booklet=booklet,
            polygons=polygons,
            spreadsheet=SPREADSHEETS[decimal],
        )
    )
    if "nbgrader" in formats:
        from coursework.nbgrader import tree as nbgrader

        wanted[:0] = nbgrader.files(course, issues, None, out)
    with progress_bar("building", len(wanted)) as advance:
        notes = write_tree(out, wanted, advance, anew=overwrite)
    if booklet or "pdf" in formats:
        notes += unprinted_names(renderer_of(course.folder), (student.name for student in students))
    tell(notes)
    return len(wanted)


def _goes_on(before: Path, issued: str) -> bool:
    """Whether all that was issued before is issued as it was: to a longer roster, say."""
    try:
        items = json.loads(before.read_bytes())["issued"]
        known = {(i["student"], i["record"]["exercise"], i["record"]["seed"]): i["record"] for i in items}
        now = json.loads(issued)["issued"]
    except (ValueError, KeyError, TypeError):
        return False
    found = {(i["student"], i["record"]["exercise"], i["record"]["seed"]): i["record"] for i in now}
    return all(found.get(place) == record for place, record in known.items())


# ------------------------------------------------------------------------- demo


@click.command()
@click.option("--out", type=click.Path(path_type=Path, file_okay=False), default="demo", show_default=True)
def demo(out: Path) -> None:
    """Do the whole job on a small class: sheets, answers of all kinds, marks."""
    from coursework.cli.demo import class_of_twelve
    from coursework.cli.mark import grade_with_bar

    rows, told = class_of_twelve(out, build_files, grade_with_bar)
    print_table(rows, title="What became of the answers")
    for line in told:
        click.echo(line)
