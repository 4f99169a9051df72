"""Commands of gradebooks: gradebook."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from coursework.cli.options import (
    DONE,
    FOUND,
    FilePath,
)
from coursework.cli.printing import say, warn
from coursework.errors import BadInput, counted
from coursework.messages import Message

if TYPE_CHECKING:
    from coursework.gradebook.class_points import Scored
    from coursework.gradebook.filling import Filled

_SIGNS = {"point": ".", "comma": ",", None: ""}


@click.command()
@click.argument("platform", metavar="moodle|canvas|blackboard|sakai")
@click.argument("marks", type=FilePath(path_type=Path))
@click.option(
    "--template",
    type=FilePath(path_type=Path, dir_okay=False),
    help="The gradebook as the platform exports it. Without one, XML for Moodle, which names students by their ID numbers.",
)
@click.option("--item", required=True, help="The item to fill, by its name; for XML its ID number.")
@click.option("--out", type=FilePath(path_type=Path, dir_okay=False), required=True, help="File to write.")
@click.option(
    "--score",
    type=click.Choice(("points", "mark", "percent")),
    default="points",
    show_default=True,
    help="Which column of summary.csv: points and percent are scaled to the item's maximum, a mark is written as it stands.",
)
@click.option(
    "--out-of",
    type=click.FloatRange(min=0, min_open=True),
    help="The item's maximum, where the export does not tell it.",
)
@click.option(
    "--decimal",
    type=click.Choice(("point", "comma")),
    help="Decimal sign of the marks written; that of the file's own marks unless told, for Moodle and Canvas a point.",
)
@click.option(
    "--zeros", is_flag=True, help="Write 0 for who answered nothing, who is left as they are otherwise."
)
def gradebook(
    platform: str,
    marks: Path,
    template: Path | None,
    item: str,
    out: Path,
    score: str,
    out_of: float | None,
    decimal: str | None,
    zeros: bool,
) -> int:
    """Fill a platform's own export of its gradebook with the marks of the folder MARKS that grade wrote.

    One column is touched, byte for byte. Students are found by e-mail or number, then by name. Who is not in the export is told
    and never written; who has no marks is left as they are, and told.
    """
    from coursework.gradebook.class_points import class_points
    from coursework.gradebook.platform_gradebooks import platform_gradebook

    chosen = platform_gradebook(platform)
    scored = class_points(marks, score)
    if template is None:
        if platform != "moodle":
            raise BadInput(
                "--template takes the gradebook as {title_of_platform} exports it: {download}",
                title_of_platform=chosen.title_of_platform,
                download=chosen.download,
            )
        return _write_xml(out, item, [entry for entry in scored if entry.has_answered or zeros], out_of)
    from coursework.gradebook.filling import fill
    from coursework.system.writing import write_whole

    _check_out(out, template)
    filled = fill(chosen, template, item, scored, most=out_of, decimal=_SIGNS[decimal], zeros=zeros)
    write_whole(out, filled.data)
    say(
        "{marks} in the column {column!r} of {out}{total}",
        marks=counted(filled.written, "mark"),
        column=filled.column,
        out=out,
        total=_of(filled, scored),
    )
    return _print_filled(filled, out)


def _check_out(out: Path, template: Path) -> None:
    if out.exists() and template.exists() and out.resolve() == template.resolve():
        raise BadInput(
            "--out is the --template itself, {value}: keep the platform's export as it came, and name another file",
            value=template,
        )


def _of(filled: Filled, scored: Sequence[Scored]) -> str:
    if filled.most is not None:
        return Message(", out of {most:g}", most=filled.most)
    totals = {score.out_of for score in scored if score.out_of}
    if not totals:
        return ""
    return Message(
        ", out of {most}: that must be the item's maximum (--out-of says another)", most=totals.pop()
    )


def _print_filled(filled: Filled, out: Path) -> int:
    """Say who is left as they were, and why; whether somebody must look."""
    for description, names in (
        (Message("marks, but no line in the export, and not written"), filled.strangers),
        (Message("marks, but several lines or none that is surely theirs, and not written"), filled.unclear),
        (Message("no marks, and left as they were"), filled.absent),
        (Message("what stays as the platform has it"), filled.unchanged),
    ):
        if names:
            warn(
                "{students} with {description}: {listed}",
                students=counted(len(names), "student"),
                description=description,
                listed=_listed(names),
            )
    return FOUND if filled.strangers or filled.unclear else DONE


def _listed(names: Sequence[str]) -> str:
    listed = ", ".join(names[:10])
    return (
        Message("{first} and {count} more", first=listed, count=len(names) - 10)
        if len(names) > 10
        else listed
    )


def _write_xml(out: Path, item: str, scored: Sequence[Scored], out_of: float | None) -> int:
    from coursework.gradebook.moodle_xml import moodle_xml
    from coursework.system.writing import write_whole

    data, left = moodle_xml(item, scored, out_of, out.stem)
    write_whole(out, data)
    say(
        "{marks} of the item with ID number {item!r} in {out}",
        marks=counted(len(scored) - len(left), "mark"),
        item=item,
        out=out,
    )
    if left:
        warn(
            "{students} without an ID number, not written: {listed}",
            students=counted(len(left), "student"),
            listed=_listed(left),
        )
    return FOUND if left else DONE
