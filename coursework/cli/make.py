"""Commands that make what is handed out: build, demo."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from coursework.cli.assignments import build_papers, write_build
from coursework.cli.options import (
    FOLDER,
    LANGUAGE_DEFAULT,
    PATH,
    Lists,
    WholeNumber,
    cluster_option,
    columns_option,
    db_option,
    exercises_argument,
    given_option,
    known_formats,
    known_languages,
    parts_option,
    seed_option,
    spoken,
    unknown_language,
    writes,
)
from coursework.cli.printing import print_table
from coursework.issuing.formats import ADDITIONS
from coursework.messages import Message, localised
from coursework.system.limits import MOST_VARIANTS

# ------------------------------------------------------------------------ build


@click.command()
@exercises_argument
@click.option(
    "--variants",
    "count",
    type=WholeNumber(1, MOST_VARIANTS),
    help="Number of variants of each exercise; a roster has one for each student.",
)
@seed_option
@click.option(
    "--roster",
    type=PATH,
    help=("CSV with a column student, or with surname and first name; a column lang is optional."),
)
@columns_option
@click.option("--formats", type=Lists(known_formats), default="pdf,ipynb,html", show_default=True)
@click.option(
    "--with",
    "additions",
    type=Lists(lambda: ADDITIONS),
    default=(),
    metavar="WHAT,WHAT",
    help="Also: " + "; ".join(f"{name}: {what}" for name, what in ADDITIONS.items()) + ".",
)
@click.option(
    "--lang",
    "langs",
    type=Lists(known_languages, unknown_language),
    callback=spoken,
    help=f"Languages of the sheets: fr, en, or both as fr,en; {LANGUAGE_DEFAULT}. "
    "A student with a language in the roster has that one.",
)
@parts_option
@given_option
@click.option("--out", type=FOLDER, help="Folder to write.")
@click.option(
    "--overwrite",
    is_flag=True,
    help=(
        "Replace what was issued there before. Files that students filled in or that were changed are kept "
        "under other names."
    ),
)
@click.option("--again", multiple=True, metavar="STUDENT", help="Write a lost paper again, as it was issued.")
@click.option(
    "--make-up",
    multiple=True,
    metavar="STUDENT",
    help="Write another paper for a student who sits the exam again.",
)
@click.option(
    "--dry-run",
    is_flag=True,
    help="Write nothing; print how many pages, how white, for how many points, and how many variants are "
    "left.",
)
@db_option
@cluster_option
@click.pass_context
def build(context: click.Context, /, exercises: Sequence[str], **options: Any) -> None:
    """Write sheets, notebooks and pages for a class, with solutions and key for the staff.

    With exercises, each is a paper of its own; with the file of an assignment, such as midterm.toml, one
    paper has several exercises.
    """
    build_papers(context, exercises)


# ------------------------------------------------------------------------- demo


@click.command()
@click.option("--out", type=FOLDER, default="demo", show_default=True)
@click.pass_context
def demo(context: click.Context, out: Path) -> None:
    """Do the whole job for a small class: sheets, answers of all kinds, marks."""
    from coursework.cli.demo import class_of_twelve
    from coursework.cli.mark import grade_with_bar

    writes(context, out)
    rows, lines = class_of_twelve(out, write_build, grade_with_bar)
    print_table(rows, title=localised(Message("Results of the answers")))
    for line in lines:
        click.echo(line)
