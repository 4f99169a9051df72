"""Output of the command line: JSON, tables, and a progress bar."""

from __future__ import annotations

import os
import sys
import textwrap
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import zip_longest
from typing import Any

import click

from coursework.cli.help_pages import placeholders_translated
from coursework.messages import Message, localised
from coursework.system.visible import one_line, plain, visible, visible_streams

_SHOWN = 10  #: lines of a list on the error stream


def print_json(content: Any) -> None:
    """One line of JSON."""
    import json

    click.echo(json.dumps(content, ensure_ascii=False))


def say(template: str, /, **values: Any) -> None:
    """Print a line in the reader's language.

    Parameters
    ----------
    template
        English text with places for the values, the key of its translations.
    values
        Fill the places; messages among them are translated.
    """
    click.echo(localised(Message(template, **values)))


def warn(template: str, /, **values: Any) -> None:
    """Print a line in the reader's language on the error stream, after the name of the program."""
    click.echo(f"coursework: {localised(Message(template, **values))}", err=True)


def problem_of(fault: click.UsageError) -> str:
    """Return what is wrong with the arguments, as a message where :mod:`click` has an English text alone."""
    match fault:
        case click.NoSuchOption():
            near = fault.possibilities[:1] if fault.possibilities else ()
            nearest = Message("; did you mean {near!r}?", near=near[0]) if near else ""
            return Message("no option {option!r}{nearest}", option=fault.option_name, nearest=nearest)
        case click.BadOptionUsage():
            return Message("the option {option!r} needs a value", option=fault.option_name)
        case click.MissingParameter() if fault.param and fault.ctx:
            return Message("{parameter!r} is missing", parameter=_name_of(fault.param, fault.ctx))
        case click.BadParameter() if fault.param and fault.ctx:
            name, problem = _name_of(fault.param, fault.ctx), fault.message
            if isinstance(fault.param.type, click.Choice):
                problem = Message("it is one of {choices}", choices=", ".join(fault.param.type.choices))
            return Message("invalid value for {parameter!r}: {problem}", parameter=name, problem=problem)
    return fault.format_message().rstrip(".")


def _name_of(parameter: click.Parameter, context: click.Context) -> str:
    """Return an option or an argument as the help page shows it."""
    return placeholders_translated(parameter.get_error_hint(context).strip("'"))


def warn_some(lines: Sequence[str], where: object) -> None:
    """Print the first lines on the error stream, and how many more stand where."""
    for line in lines[:_SHOWN]:
        click.echo(f"coursework: {one_line(localised(line))}", err=True)
    if len(lines) > _SHOWN:
        warn("and {count} more in {where}", count=len(lines) - _SHOWN, where=where)


def by_reason(rejected: Iterable[tuple[str, str]]) -> list[str]:
    """Return a line for each reason, such as a misspelt name, with the first place that it holds for and the
    number of others."""
    places: dict[str, list[str]] = {}
    for place, reason in rejected:
        places.setdefault(reason, []).append(place)
    return [
        Message(
            "{source}: {reason}",
            source=Message("{first} and {count} more", first=first, count=len(more)) if more else first,
            reason=reason,
        )
        for reason, (first, *more) in places.items()
    ]


def print_table(rows: Sequence[Mapping[str, Any]], title: str = "") -> None:
    """Print a table with a column for each key of the first row; nothing where there is no row."""
    if not rows:
        return
    cells = [[visible(str(v)) for v in row] for row in (rows[0], *(row.values() for row in rows))]
    right = [all(isinstance(r[column], (int, float)) for r in rows) for column in rows[0]]
    if not _fits_a_terminal() and (lines := _ruled(cells, right, title)):
        click.echo("\n".join(lines))
        return
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text  # as it is: brackets are not markup

    table = Table(title=visible(title) or None, title_justify="left")
    for column, is_right in zip(cells[0], right, strict=True):
        table.add_column(Text(column), justify="right" if is_right else "left", overflow="fold")
    for row in cells[1:]:
        table.add_row(*map(Text, row))
    console = Console(file=plain(sys.stdout))
    # Piped into a file there is no width to fit: nothing is cut.
    Console(file=console.file, width=None if console.is_terminal else _PIPED).print(table)


_PIPED = 200  #: width of a table that no terminal shows

#: Variables by which somebody asks for colours, or for another width, where there is no terminal.
_ASKING = ("FORCE_COLOR", "TTY_COMPATIBLE", "TTY_INTERACTIVE", "JUPYTER_COLUMNS", "PYCHARM_HOSTED")


def _fits_a_terminal() -> bool:
    """Return whether the table needs a layout for the terminal: fitted and coloured, or without Unicode
    lines."""
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    is_forced = any(os.environ.get(name) for name in _ASKING)
    return is_forced or sys.stdout.isatty() or not encoding.lower().startswith("utf")


def _ruled(cells: Sequence[Sequence[str]], right: Sequence[bool], title: str) -> list[str]:
    """Return the lines of a table of plain letters, drawn as on a terminal wide enough, which takes a tenth
    of a second less.

    Nothing where a letter is none of Latin's, whose width is one, or where the table is too wide.
    """
    split = [[cell.split("\n") for cell in row] for row in cells]
    texts = [title, *(line for row in split for cell in row for line in cell)]
    widths = [max(len(line) for row in split for line in row[k]) for k in range(len(right))]
    total = sum(widths) + 3 * len(widths) + 1
    if total > _PIPED or len(title) > total or not all(map(_is_plain, texts)):
        return []

    def rule(left: str, line: str, cross: str, end: str) -> str:
        return left + cross.join(line * (width + 2) for width in widths) + end

    def lines(row: Sequence[Sequence[str]], bar: str) -> list[str]:
        padded = zip_longest(*row, fillvalue="")
        return [
            bar
            + bar.join(
                f" {t.rjust(w) if r else t.ljust(w)} " for t, w, r in zip(line, widths, right, strict=True)
            )
            + bar
            for line in padded
        ]

    head, *body = split
    tall = max(map(len, head))
    head = [[""] * (tall - len(cell)) + cell for cell in head]  # a short heading stands at the foot
    return [
        *([title.ljust(total)] if title else []),
        rule("┏", "━", "┳", "┓"),
        *lines(head, "┃"),
        rule("┡", "━", "╇", "┩"),
        *(line for row in body for line in lines(row, "│")),
        rule("└", "─", "┴", "┘"),
    ]


def _is_plain(text: str) -> bool:
    return text == text.strip() and (not text or (text.isprintable() and max(text) < "\u0300"))


def print_note(text: str) -> None:
    """Print a line of words; on a terminal wrapped to its width, the lines after the first indented."""
    from rich.console import Console

    console = Console()
    click.echo(textwrap.fill(text, console.width, subsequent_indent="  ") if console.is_terminal else text)


@contextmanager
def progress_bar(label: str, total: int | None) -> Iterator[Callable[..., None]]:
    """Provide a progress bar on a terminal; nothing elsewhere."""
    if not sys.stderr.isatty():
        yield lambda *_: None
        return
    from rich.console import Console
    from rich.progress import Progress

    # What is said meanwhile goes through the bar, and from there to the terminal.
    with Progress(console=Console(file=plain(sys.stderr)), transient=True) as bar, visible_streams():
        task = bar.add_task(label, total=total)

        def advance(*progress: Any) -> None:
            """One more, or so many of so many."""
            if len(progress) == 2:
                bar.update(task, completed=progress[0], total=progress[1])
            else:
                bar.advance(task)

        yield advance
