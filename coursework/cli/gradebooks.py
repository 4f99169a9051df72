"""Commands of gradebooks: gradebook."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from coursework.cli.options import DONE, FILE, FOUND, PATH, DecimalNumber
from coursework.cli.printing import say, warn
from coursework.errors import BadInput, counted
from coursework.messages import Message

if TYPE_CHECKING:
    from coursework.gradebook.class_points import Scored
    from coursework.gradebook.filling import Filled

_SIGNS = {"point": ".", "comma": ",", None: ""}


@click.command()
@click.argument("platform", metavar="moodle|canvas|blackboard|sakai")
@click.argument("marks", type=PATH)
@click.option(
    "--template",
    type=FILE,
    help=(
        "The gradebook as the platform exports it. Without it, XML for Moodle is written, in which students "
        "are named by their ID numbers."
    ),
)
@click.option("--item", required=True, help="Name of the item to fill; for XML its ID number.")
@click.option("--out", type=FILE, required=True, help="File to write.")
@click.option(
    "--score",
    type=click.Choice(("points", "mark", "percent")),
    default="points",
    show_default=True,
    help=(
        "Column of summary.csv to copy. Points and percentages are scaled to the maximum of the item; a mark "
        "is written as it is."
    ),
)
@click.option(
    "--out-of",
    type=DecimalNumber(),
    help="Maximum of the item, if the export does not state it.",
)
@click.option(
    "--decimal",
    type=click.Choice(("point", "comma")),
    help=(
        "Decimal sign of the marks. By default a point for Moodle and Canvas, else the sign of the marks in "
        "the file."
    ),
)
@click.option(
    "--provisional",
    is_flag=True,
    help="Write marks of students with answers that wait for a person too; by default these are left out.",
)
@click.option(
    "--zeros",
    is_flag=True,
    help="Write 0 for students without an answer; by default their cells stay as they are.",
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
    provisional: bool,
    zeros: bool,
) -> int:
    """Write the marks of the folder MARKS, made by grade, into a platform's own export of its gradebook.

    Only one column changes; all else keeps its bytes. Students are matched by e-mail address or number, then
    by name. Students who are not in the export are listed and not added; students without marks are listed
    and stay as they are. A mark is provisional while an answer waits for a person: it is named, and left out
    unless --provisional is given.
    """
    from coursework.gradebook.class_points import class_points
    from coursework.gradebook.marks_record import read_record
    from coursework.gradebook.platform_gradebooks import platform_gradebook
    from coursework.gradebook.scale import is_rescaled

    chosen = platform_gradebook(platform)
    scored, status = _final(class_points(marks, score), provisional)
    record = read_record(marks if marks.is_dir() else marks.parent)
    if score != "mark" and record and is_rescaled(record.scale):
        warn("note: the total was scaled after the exam, and only marks count that: --score mark writes them")
    from coursework.gradebook.presence import EXCUSED

    if template is None:
        if platform != "moodle":
            raise BadInput(
                "--template takes the gradebook as {title_of_platform} exports it: {download}",
                title_of_platform=chosen.title_of_platform,
                download=chosen.download,
            )
        final = [entry for entry in scored if entry.is_marked or (zeros and entry.presence != EXCUSED)]
        return max(_write_xml(out, item, final, out_of), status)
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
    return max(_print_filled(filled, marks), status)


def _final(scored: Sequence[Scored], provisional: bool) -> tuple[Sequence[Scored], int]:
    """Return the marks to write, and the status: name those that are provisional, and leave them out unless
    they are wanted."""
    waiting = [entry.name for entry in scored if entry.open]
    if not waiting:
        return scored, DONE
    warn(
        "{marks} provisional, since answers wait for a person, {what}: {listed}",
        marks=counted(len(waiting), "mark"),
        what=Message("written") if provisional else Message("left out; --provisional writes them"),
        listed=_listed(waiting),
    )
    return scored if provisional else [entry for entry in scored if not entry.open], FOUND


def _check_out(out: Path, template: Path) -> None:
    if out.exists() and template.exists() and out.resolve() == template.resolve():
        raise BadInput(
            "--out is the --template itself, {value}: keep the platform's export, and name another file",
            value=template,
        )


def _of(filled: Filled, scored: Sequence[Scored]) -> str:
    if filled.most is not None:
        return Message(", out of {most:g}", most=filled.most)
    totals = {score.out_of for score in scored if score.out_of}
    if not totals:
        return ""
    return Message(
        ", out of {most}: this must be the maximum of the item (--out-of states another)", most=totals.pop()
    )


def _print_filled(filled: Filled, marks: Path) -> int:
    """Say who is left as they were, and why; whether somebody must look."""
    for description, names in (
        (Message("marks but no line in the export; not written"), filled.strangers),
        (Message("marks but no line, or several, that could be theirs; not written"), filled.unclear),
        (Message("no marks; left as they were"), filled.absent),
        (Message("cells that keep the platform's value"), filled.unchanged),
    ):
        if names:
            warn(
                "{students} with {description}: {listed}",
                students=counted(len(names), "student"),
                description=description,
                listed=_listed(names),
            )
    return FOUND if filled.strangers or filled.unclear or _tell_rejected(filled, marks) else DONE


def _tell_rejected(filled: Filled, marks: Path) -> int:
    """Say that somebody without a mark may have answered, in rejected rows; return their number."""
    from coursework.gradebook.changes import rows_of

    path = marks / "rejected.csv"
    count = sum(1 for _ in rows_of(path)) if filled.absent and path.is_file() else 0
    if count:
        warn(
            "{rows} in {file}: somebody without a mark may have answered there",
            rows=counted(count, "row"),
            file=path,
        )
    return count


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
