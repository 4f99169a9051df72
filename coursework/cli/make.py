"""Commands that make what is handed out: build, demo."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from coursework.cli.assignments import build_papers, write_build
from coursework.cli.options import (
    UNLESS_TOLD,
    FilePath,
    Lists,
    WholeNumber,
    cluster_option,
    columns_option,
    db_option,
    exercises_argument,
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
    help="Languages of the sheets: fr, en, or both as fr,en. A student whose roster line says lang has that one. "
    f"Unless told, {UNLESS_TOLD}.",
)
@parts_option
@click.option("--out", type=FilePath(path_type=Path, file_okay=False), help="Folder to write.")
@click.option(
    "--overwrite",
    is_flag=True,
    help="Replace what was issued there before. Files that were filled in or changed are set aside, not lost.",
)
@click.option(
    "--again", multiple=True, metavar="STUDENT", help="Write a lost paper once more, as it was issued."
)
@click.option("--make-up", multiple=True, metavar="STUDENT", help="Another paper for who makes up.")
@db_option
@cluster_option
@click.pass_context
def build(context: click.Context, /, exercises: Sequence[str], **options: Any) -> None:
    """Make sheets, notebooks and pages for a class, with the staff's half beside them.

    Of exercises, each on a paper of its own; or of an assignment, a file such as midterm.toml, which makes one paper of several
    exercises.
    """
    build_papers(context, exercises)


# ------------------------------------------------------------------------- demo


@click.command()
@click.option("--out", type=FilePath(path_type=Path, file_okay=False), default="demo", show_default=True)
@click.pass_context
def demo(context: click.Context, out: Path) -> None:
    """Do the whole job on a small class: sheets, answers of all kinds, marks."""
    from coursework.cli.demo import class_of_twelve
    from coursework.cli.mark import grade_with_bar

    writes(context, out)
    rows, lines = class_of_twelve(out, write_build, grade_with_bar)
    print_table(rows, title=localised(Message("What became of the answers")))
    for line in lines:
        click.echo(line)
