"""Reading of uploaded files, in a process of limited means; it imports little, since it starts for each
upload."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path
from typing import Any

from coursework.gradebook.filling import Filled, fill
from coursework.gradebook.platform_gradebooks import platform_gradebook
from coursework.gradebook.rows import AnswerRow, PlatformFile, Rejected
from coursework.gradebook.submissions import find, read_file
from coursework.issuing.roster import Student, roster_and_notes
from coursework.messages import Message, as_message
from coursework.system.unzipping import is_zip, unpack

MOST_ROWS = 500_000  #: of one upload


def rows_in(folder: Path) -> list[AnswerRow | Rejected | PlatformFile]:
    """Return the rows of the files below a folder, archives included; one more than the limit if there are
    too many."""
    for path in sorted(folder.glob("*/*")):
        if path.suffix.lower() == ".zip" and is_zip(path.read_bytes()[:4]):
            inside = path.parent / "zip"
            inside.mkdir()
            unpack(path, inside)
            path.unlink()
    return list(islice(_read(folder), MOST_ROWS + 1))


def _read(folder: Path) -> Iterator[AnswerRow | Rejected | PlatformFile]:
    for item in find([folder]):
        rows = [item] if isinstance(item, (Rejected, PlatformFile)) else read_file(item, [folder])
        for row in rows:
            yield _with_short_source(row, folder)


def _with_short_source(
    row: AnswerRow | Rejected | PlatformFile, folder: Path
) -> AnswerRow | Rejected | PlatformFile:
    """Return a row without the temporary folder in its source."""
    paths = re.compile(rf"{re.escape(str(folder))}(?:/\d+/(?:zip/)?)?")

    def shortened(text: str) -> str:
        return paths.sub("", text)

    if isinstance(row, AnswerRow):
        return row._replace(
            source=shortened(row.source), warning=shortened(row.warning) if row.warning else ""
        )
    if isinstance(row, Rejected):
        return Rejected(shortened(row.source), _without(row.reason, paths), row.row)
    return row._replace(source=shortened(row.source))


def _without(text: object, parts: re.Pattern[str]) -> Message:
    """Return a message without the parts that match a pattern, longest first."""
    message = as_message(text)
    for part in sorted(set(parts.findall(message)), key=len, reverse=True):
        message = message.replacing(part, "")
    return message


def roster_in(path: Path) -> tuple[Sequence[Student], list[Message]]:
    """Return the students of a roster, and the messages about it, which name the file alone."""
    students, notes = roster_and_notes(path)
    return students, [as_message(line).replacing(f"{path.parent}/", "") for line in notes]


def filled_in(
    platform: str, path: Path, item: str, scored: Sequence[Any], most: float | None, zeros: bool
) -> Filled:
    return fill(platform_gradebook(platform), path, item, scored, most=most, zeros=zeros)
