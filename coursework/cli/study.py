"""Commands for who studies alone: progress."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import click

from coursework.cli.options import FOLDER, json_option, lang_option, opened, print_notes
from coursework.cli.printing import print_json
from coursework.errors import BadInput


@click.command()
@click.argument("folder", type=FOLDER, default=".")
@click.option(
    "--on", "day", type=click.DateTime(["%Y-%m-%d"]), help="Show what is due on this day; by default today."
)
@lang_option
@json_option
@click.pass_context
def progress(context: click.Context, folder: Path, day: datetime | None, lang: str, as_json: bool) -> None:
    """Show the progress in the self-study notebooks of a folder, and what comes next.

    FOLDER contains their progress.json; by default it is the current one.
    """
    from dataclasses import asdict

    from coursework.language.words import words
    from coursework.markup.shown import NotebookDisplay
    from coursework.selfstudy import mastery
    from coursework.selfstudy.mastery import mark_what_came_unmarked, skills, standings
    from coursework.selfstudy.progress import ProgressFile, now

    course = opened(context)
    if not folder.is_dir():
        raise BadInput("no such folder: {folder}", folder=folder)
    on = now() if day is None else day.replace(tzinfo=UTC)
    file = ProgressFile(folder, lambda: on)
    mark_what_came_unmarked(course, file)
    study_words = words(lang)["study"]
    if file.trouble:
        print_notes([study_words["trouble"][file.trouble].format(file=file.troubled)])
    step = mastery.next_step(course, file.progress, on.date())
    if as_json:
        print_json(
            {
                "exercises": [_plain(asdict(standing)) for standing in standings(file.progress)],
                "skills": [_plain(asdict(standing)) for standing in skills(file.progress)],
                "next": None if step is None else _plain(asdict(step)),
            }
        )
        return
    lines = mastery.standings_text(course, file.progress, on.date(), lang)
    pieces = [lines or study_words["progress"]["nothing"], mastery.skills_text(course, file.progress, lang)]
    if step is not None:
        pieces.append(mastery.advice_text(course, step, lang))
    click.echo(str(NotebookDisplay(lang, *pieces)))


def _plain(fields: dict[str, object]) -> dict[str, object]:
    """Return the same with dates as texts."""
    return {
        name: value.isoformat() if hasattr(value, "isoformat") else value for name, value in fields.items()
    }
