"""What the command line prints: JSON, tables, and a bar while it works."""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

import click


def print_json(content: Any) -> None:
    """One line of JSON."""
    import json

    click.echo(json.dumps(content, ensure_ascii=False))


def print_table(rows: Sequence[Mapping[str, Any]], title: str = "") -> None:
    """A table, a column a key of the first row; nothing where there is no row."""
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text  # as it is: brackets are not markup

    if not rows:
        return
    table = Table(title=title or None, title_justify="left")
    for column in rows[0]:
        right = all(isinstance(r[column], (int, float)) for r in rows)
        table.add_column(Text(str(column)), justify="right" if right else "left", overflow="fold")
    for row in rows:
        table.add_row(*[Text(str(v)) for v in row.values()])
    console = Console()
    # Piped into a file there is no width to fit: nothing is cut.
    Console(width=None if console.is_terminal else 200).print(table)


def print_note(text: str) -> None:
    """A line of words; on a terminal wrapped to its width, the lines after the first indented."""
    from rich.console import Console

    console = Console()
    click.echo(textwrap.fill(text, console.width, subsequent_indent="  ") if console.is_terminal else text)


@contextmanager
def progress_bar(what: str, total: int | None) -> Iterator[Callable[..., None]]:
    """A progress bar on a terminal; nothing elsewhere."""
    if not sys.stderr.isatty():
        yield lambda *_: None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(what, total=total)

        def advance(*progress: Any) -> None:
            """One more, or so many of so many."""
            if len(progress) == 2:
                bar.update(task, completed=progress[0], total=progress[1])
            else:
                bar.advance(task)

        yield advance
