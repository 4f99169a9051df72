"""Commands of an author: check, new."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

import click

from coursework.cli import completion
from coursework.cli.options import (
    DONE,
    FILE,
    FOLDER,
    FOUND,
    Lists,
    WholeNumber,
    cluster_option,
    exercise_names,
    exercises_argument,
    json_option,
    known_languages,
    lang_option,
    opened,
    seed_option,
    shared_by_cluster,
    unknown_language,
    writes,
)
from coursework.cli.printing import print_json, print_note, print_table, progress_bar, say
from coursework.errors import BadInput
from coursework.messages import localised
from coursework.system.limits import MOST_VARIANTS

# ------------------------------------------------------------------------ check


@click.command()
@exercises_argument
@click.option("--variants", "count", type=WholeNumber(1, MOST_VARIANTS), default=200, show_default=True)
@cluster_option
@json_option
@click.pass_context
def check(
    context: click.Context, exercises: Sequence[str], count: int, cluster: str | None, as_json: bool
) -> int:
    """Check every exercise of the course; the exit status is 1 if one fails."""
    from coursework.authoring import check_report, checks

    course = opened(context)
    names = exercise_names(course, exercises)
    shared_by_cluster(context, cluster)
    with progress_bar("checking", len(names)) as advance:
        reports = checks.check_all(course, names, count, advance)
    if as_json:
        for report in reports:
            print_json(report.as_json())
    else:
        print_table(check_report.table(reports))
        for note in check_report.notes(reports):
            print_note(note)
        for report in reports:
            for failure in report.failures[:20]:
                click.echo(f"{report.name}: {failure}")
            if len(report.failures) > 20:
                say("{name}: and {count} more", name=report.name, count=len(report.failures) - 20)
    return DONE if all(r.passed for r in reports) else FOUND


# -------------------------------------------------------------------------- new


@click.command()
@click.argument("folder", type=FOLDER)
@click.argument("exercise", required=False)
@click.argument("asked", nargs=-1)
@click.option(
    "--from",
    "source",
    metavar="EXERCISE",
    shell_complete=completion.exercises,
    help=(
        "Copy this exercise, with all that it needs, from the course of --course or from the built-in one."
    ),
)
@click.option("--as", "renamed", metavar="NAME", help="Name of the copy; by default that of the original.")
@click.option(
    "--lang",
    "langs",
    type=Lists(known_languages, unknown_language),
    help=(
        "Languages of a new course, or of the sheets of a new assignment. By default, a course has the "
        "language of the environment (LANG), or all languages; an assignment has that of its course."
    ),
)
@click.option(
    "--example", metavar="NAME", help="Copy a whole course that comes with the package: engineering."
)
@click.option(
    "--linkage",
    metavar="NAME",
    help="Start from a mechanism's file, without any Python: four_bar, slider_crank, slotted_lever and "
    "others.",
)
@click.option(
    "--from-pylinkage", "pylinkage", type=FILE, help="Start from the mechanism in a JSON file of pylinkage."
)
@click.pass_context
def new(
    context: click.Context,
    folder: Path,
    exercise: str | None,
    source: str | None,
    renamed: str | None,
    langs: Sequence[str] | None,
    asked: Sequence[str],
    example: str | None,
    linkage: str | None,
    pylinkage: Path | None,
) -> None:
    """Create a course folder, an exercise in a course, or a copy of an exercise to change.

    An assignment of exercises is created by: new assignment FILE.toml EXERCISE…
    """
    from coursework.authoring.scaffold import languages_around, new_course, new_exercise

    if str(folder) != "assignment":
        writes(context, folder)
    if example is not None:
        _new_example(folder, example, exercise or source or renamed or langs)
        return
    if str(folder) == "assignment" and exercise is not None and exercise.endswith(".toml"):
        _new_assignment(context, Path(exercise), asked, langs)
        return
    if asked:
        raise BadInput(
            "one exercise at a time: coursework new {folder} {exercise}", folder=folder, exercise=exercise
        )
    if (folder / "exercises").is_dir() and langs:
        raise BadInput(
            "{folder} is already a course, and its course.toml states the languages; omit --lang",
            folder=folder,
        )
    if source is None and renamed is not None:
        raise BadInput("--as names a copy; state the exercise to copy: --from EXERCISE")
    if source is not None and exercise is not None:
        raise BadInput(
            "name the copy with --as: coursework new {folder} --from {source} --as {exercise}",
            folder=folder,
            source=source,
            exercise=exercise,
        )
    spoken = langs or languages_around(os.environ)
    there: list[Path] = []
    if linkage is not None or pylinkage is not None:
        written = _new_linkage(folder, exercise or renamed, linkage, pylinkage, spoken)
    elif source is not None:
        written, there = _copied(context, folder, source, renamed or source, spoken)
    elif exercise is not None:
        written = new_exercise(folder, exercise, spoken)
    else:
        written = new_course(folder, spoken)
    for path in written:
        say("wrote {path}", path=path)
    for path in there:
        say("{path} exists already with the same content", path=path)
    say("try: coursework --course {folder} check", folder=folder)


def _new_linkage(
    folder: Path, name: str | None, linkage: str | None, pylinkage: Path | None, langs: Sequence[str]
) -> list[Path]:
    from coursework.authoring.linkage_files import new_from_pylinkage, new_linkage

    if pylinkage is not None:
        return new_from_pylinkage(folder, pylinkage, name or pylinkage.stem, langs)
    assert linkage is not None
    return new_linkage(folder, linkage, name or linkage, langs)


def _new_example(folder: Path, name: str, more: object) -> None:
    from coursework.authoring.example_courses import new_example

    if more:
        raise BadInput(
            "an example is copied as a whole: coursework new {folder} --example {name}",
            folder=folder,
            name=name,
        )
    for path in new_example(folder, name):
        say("wrote {path}", path=path)
    say("try: coursework --course {folder} check", folder=folder)


def _new_assignment(
    context: click.Context, path: Path, exercises: Sequence[str], langs: Sequence[str] | None
) -> None:
    from coursework.authoring.new_assignment import new_assignment
    from coursework.language.environment import language_of

    written = new_assignment(path, opened(context), exercises, langs, language_of(os.environ))
    course_option = f"--course {context.obj} " if context.obj else ""
    say("wrote {path}", path=written)
    say("try: coursework {option}build {path}", option=course_option, path=written)


def _copied(
    context: click.Context, folder: Path, source: str, renamed: str, langs: Sequence[str]
) -> tuple[list[Path], list[Path]]:
    from coursework.authoring.copying import copy_exercise
    from coursework.course.folder import course_folder

    return copy_exercise(course_folder(context.obj), source, folder, renamed, langs)


# --------------------------------------------------------------------- mechanism


@click.command()
@click.argument("file", type=FILE)
@seed_option
@lang_option
@click.option("--out", type=FOLDER, help="Folder to write the figure (SVG) and the motion (HTML) to.")
@json_option
@click.pass_context
def mechanism(
    context: click.Context, file: Path, seed: int, lang: str, out: Path | None, as_json: bool
) -> None:
    """Show what a mechanism's file states: mobility, groups, class, range of the driver, limits.

    No course and no question is needed. Quantities that are drawn have the values of --seed.
    """
    from coursework.api import open_course
    from coursework.authoring.linkage_files import mechanism_alone, report
    from coursework.system.writing import write_whole

    with mechanism_alone(file, open_course) as (exercise, made):
        rows = report(exercise, made, seed)
        if as_json:
            print_json({str(row["property"]): str(row["value"]) for row in rows})
        else:
            print_table([{key: localised(value) for key, value in row.items()} for row in rows])
        if out is None:
            return
        writes(context, out)
        variant = exercise.variant(seed, lang)
        animation = variant.animation([])
        for ending, text in (("svg", variant.figure.svg()), ("html", animation.html(is_answered=True))):
            write_whole(out / f"{file.stem}.{ending}", text.encode("utf-8"))
            click.echo(f"{out / file.stem}.{ending}")
