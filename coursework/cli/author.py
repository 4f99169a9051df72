"""Commands of an author: check, new."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click

from coursework.cli.options import DONE, FOUND, Whole, exercise_names, exercises_argument, json_option, opened
from coursework.cli.printing import print_json, print_note, print_table, progress_bar
from coursework.errors import BadInput

# ------------------------------------------------------------------------ check


@click.command()
@exercises_argument
@click.option("--variants", "count", type=Whole(1), default=200, show_default=True)
@json_option
@click.pass_context
def check(context: click.Context, exercises: Sequence[str], count: int, as_json: bool) -> int:
    """Prove the promises of every exercise of the course; status 1 when one is broken."""
    from coursework.authoring import check_report, checks

    course = opened(context)
    names = exercise_names(course, exercises)
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
                click.echo(f"{report.name}: and {len(report.failures) - 20} more")
    return DONE if all(r.passed for r in reports) else FOUND


# -------------------------------------------------------------------------- new


@click.command()
@click.argument("folder", type=click.Path(path_type=Path, file_okay=False))
@click.argument("exercise", required=False)
@click.argument("asked", nargs=-1)
@click.pass_context
def new(context: click.Context, folder: Path, exercise: str | None, asked: Sequence[str]) -> None:
    """Write a working course folder, or a working exercise in one; or an assignment of exercises:
    new assignment FILE.toml EXERCISE…"""
    from coursework.authoring.scaffold import new_course, new_exercise

    if str(folder) == "assignment" and exercise is not None and exercise.endswith(".toml"):
        _new_assignment(context, Path(exercise), asked)
        return
    if asked:
        raise BadInput(f"one exercise at a time: coursework new {folder} {exercise}")
    made = new_exercise(folder, exercise) if exercise else new_course(folder)
    for path in made:
        click.echo(f"wrote {path}")
    click.echo(f"try: coursework --course {folder} check")


def _new_assignment(context: click.Context, path: Path, asked: Sequence[str]) -> None:
    from coursework.authoring.new_assignment import new_assignment

    course = opened(context)
    langs = course[asked[0]].languages if asked else ()
    made = new_assignment(path, course, asked, langs)
    own = f"--course {context.obj} " if context.obj else ""
    click.echo(f"wrote {made}")
    click.echo(f"try: coursework {own}build {made}")
