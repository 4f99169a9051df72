"""Commands that make what is learnt from: lessons, self-study notebooks, the workbook."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from coursework.cli.options import (
    DONE,
    FOLDER,
    FOUND,
    LANGUAGE_DEFAULT,
    Lists,
    WholeNumber,
    exercise_names,
    exercises_argument,
    is_typed,
    known_languages,
    lang_option,
    opened,
    print_notes,
    replace_option,
    seed_option,
    spoken,
    unknown_language,
    writes,
)
from coursework.cli.printing import progress_bar, say
from coursework.errors import BadInput, counted, unknown
from coursework.messages import Message
from coursework.system.limits import MOST_SEED

if TYPE_CHECKING:
    from coursework.course.course import Course

# ----------------------------------------------------------------------- lesson


@click.command()
@click.argument("lessons", nargs=-1)
@lang_option
@click.option("--out", type=FOLDER, help="Folder for the notebooks.")
@click.option(
    "--check",
    is_flag=True,
    help=("Read, draw and run the lessons in every language; the exit status is 1 if one fails."),
)
@replace_option
@click.pass_context
def lesson(
    context: click.Context, lessons: Sequence[str], lang: str, out: Path | None, check: bool, overwrite: bool
) -> int:
    """Write the lessons of the course as notebooks; without --out, list them."""
    from coursework.course.lessons import lesson_file

    course = opened(context)
    names = lessons or course.folder.lessons
    if check:
        return _check_lessons(course, lessons)
    _check_language(lang)
    for name in names:
        lesson_file(course.folder, name, lang)
    if out is None:
        for name in names:
            click.echo(name)
        return DONE
    from coursework.selfstudy.workbook.files import lesson_notebook, notebook_name
    from coursework.system.writing import write_whole

    writes(context, out)
    paths = {name: out / notebook_name(name, lang) for name in names}
    _spare(list(paths.values()), overwrite)
    for name, path in paths.items():
        write_whole(path, lesson_notebook(course, name, lang).encode("utf-8"))
        click.echo(str(path))
    return DONE


def _check_language(lang: str) -> None:
    """Check that the language of a lesson or a book is one that the package has words for."""
    if lang not in known_languages():
        raise BadInput(unknown_language(lang))


def _check_lessons(course: Course, chosen: Sequence[str]) -> int:
    from coursework.selfstudy.workbook.lessons import faults, order_faults

    names = chosen or course.folder.lessons
    for name in chosen:
        if name not in course.folder.lessons:
            raise unknown("lesson", name, course.folder.lessons, course.folder.label)
    order = [] if chosen else list(order_faults(course))
    with progress_bar("checking", len(names)) as advance:
        for name in names:
            order += faults(course, name)
            advance()
    for fault in order:
        click.echo(fault)
    if not order:
        say(
            "{lessons} read, drawn and run in {languages}",
            lessons=counted(len(names), "lesson"),
            languages=", ".join(course.folder.languages),
        )
    return FOUND if order else DONE


def _spare(paths: Sequence[Path], overwrite: bool) -> None:
    """Notebooks that somebody may have written in are not replaced unasked."""
    there = [] if overwrite else [path for path in paths if path.exists()]
    if there:
        template = (
            (
                "{path} exists already and may contain somebody's work; choose another --out, or "
                "--overwrite to "
                "replace it"
            )
            if len(there) == 1
            else (
                "{path} and {count} more exist already and may contain somebody's work; choose another "
                "--out, or "
                "--overwrite to replace them"
            )
        )
        raise BadInput(template, path=there[0], count=len(there) - 1)


# --------------------------------------------------------------------- notebook


@click.command()
@exercises_argument
@seed_option
@click.option(
    "--lang",
    "langs",
    type=Lists(known_languages, unknown_language),
    callback=spoken,
    help=f"Languages of the notebooks: fr, en, or both as fr,en; {LANGUAGE_DEFAULT}.",
)
@click.option("--out", type=FOLDER, default="notebooks", show_default=True, help="Folder for the notebooks.")
@replace_option
@click.pass_context
def notebook(
    context: click.Context,
    exercises: Sequence[str],
    seed: int,
    langs: Sequence[str],
    out: Path,
    overwrite: bool,
) -> None:
    """Write self-study notebooks: predictions, instant feedback, hints, plots, fresh variants.

    One for each exercise named, or for every exercise of the course, and the lessons that they refer to.
    """
    from coursework.course.lessons import taught_by
    from coursework.issuing.issuing import distinct_variants
    from coursework.rendering.renderer import renderer_of
    from coursework.selfstudy.workbook.files import lesson_notebook, notebook_name
    from coursework.system.writing import write_whole

    course = opened(context)
    wheel = course.folder.wheel
    writes(context, out)
    names = exercise_names(course, exercises)
    paths = {(name, lang): out / notebook_name(name, lang) for name in names for lang in langs}
    _spare(list(paths.values()), overwrite)
    taught = {
        lang: {exercise.name for name in names for exercise in taught_by(course.folder, name, lang)}
        for lang in langs
    }
    other: dict[str, int] = {}
    for (name, lang), path in paths.items():
        (variant,) = distinct_variants(course[name], seed, 1, lang)
        if variant.seed != seed:
            other[name] = variant.seed
        sheet = variant.study_sheet(beside=taught[lang])
        write_whole(path, renderer_of(course.folder).study(sheet).encode("utf-8"))
        click.echo(str(path))
    for lang, lessons in taught.items():
        for name in sorted(lessons):
            path = out / notebook_name(name, lang)
            if overwrite or not path.exists():  # somebody may have written in one that is there
                write_whole(path, lesson_notebook(course, name, lang, lessons | {*names}).encode("utf-8"))
                click.echo(str(path))
    if is_typed(context, "seed"):
        print_notes(
            [
                Message(
                    "{exercise}: seed {seed} gives no valid variant; the notebook has seed {next}, the "
                    "next that does",
                    exercise=name,
                    seed=seed,
                    next=missing,
                )
                for name, missing in other.items()
            ]
        )
    if wheel is not None:
        write_whole(out / wheel.name, wheel.read_bytes())
        click.echo(str(out / wheel.name))


# --------------------------------------------------------------------- workbook


def _formats() -> tuple[str, ...]:
    from coursework.selfstudy.workbook.files import FORMATS

    return FORMATS


#: Short answers at the end of a book, by the place of its solutions.
_ANSWERS = {"end": "all", "apart": "odd", "none": ""}


@click.command()
@lang_option
@click.option(
    "--seed",
    type=WholeNumber(0, MOST_SEED),
    default=0,
    show_default=True,
    help="Seed of the book: each has its own variants.",
)
@click.option("--chapters", default="", help="Numbers of the chapters, as 1,2; by default all.")
@click.option("--formats", type=Lists(_formats), default="pdf,html,ipynb", show_default=True)
@click.option(
    "--solutions",
    type=click.Choice(["end", "apart", "none"]),
    default="end",
    show_default=True,
    help="Place of the solutions: at the end, in a PDF and pages of their own, or nowhere.",
)
@click.option("--paper", type=click.Choice(["a4", "letter"]), default="a4", show_default=True)
@click.option("--out", type=FOLDER, required=True, help="Folder to write.")
@click.option(
    "--overwrite",
    is_flag=True,
    help="Replace what is there. Files that were changed are kept under other names.",
)
@click.pass_context
def workbook(
    context: click.Context,
    lang: str,
    seed: int,
    chapters: str,
    formats: Sequence[str],
    solutions: str,
    paper: str,
    out: Path,
    overwrite: bool,
) -> None:
    """Bind the course into a book: lessons and exercises in order.

    It is one PDF with contents, index and solutions, web pages, and notebooks with links between them.
    """
    from coursework.selfstudy.workbook.binding import bound, pieces_of
    from coursework.selfstudy.workbook.files import files
    from coursework.system.writing import write_tree

    course = opened(context)
    _check_language(lang)
    wanted = _numbers(chapters)
    writes(context, out)
    with progress_bar("reading", pieces_of(course)) as advance:
        book = bound(
            course,
            lang,
            seed,
            chapters=wanted,
            solved=solutions == "end",
            answers=_ANSWERS[solutions],
            advance=advance,
        )
    written = list(files(course, book, formats, paper=paper, apart=solutions == "apart"))
    with progress_bar("writing", len(written)) as advance:
        notes = write_tree(out, written, advance, anew=overwrite)
    print_notes(notes)
    click.echo(
        f"{counted(len(written), 'file')} in {out}: {', '.join(_first([str(file.path) for file in written]))}"
    )


def _numbers(text: str) -> tuple[int, ...]:
    """Return the chapters asked for."""
    pieces = [piece.strip() for piece in text.split(",") if piece.strip()]
    for piece in pieces:
        if not piece.isdecimal():
            raise BadInput("--chapters takes numbers, as 1,2; found {piece!r}", piece=piece)
    return tuple(map(int, pieces))


def _first(paths: Sequence[str]) -> list[str]:
    """Return the file to open first, of each format."""
    pages = [path for path in paths if path == "pages/index.html"]
    notebooks = ["notebooks/"] if any(path.endswith(".ipynb") for path in paths) else []
    return [*(path for path in paths if path.endswith(".pdf")), *pages, *notebooks]
