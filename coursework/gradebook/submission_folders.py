"""Folders of submissions as platforms arrange them: the name of a folder or file states who submitted, and
when."""

from __future__ import annotations

import re
from collections.abc import Collection
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from coursework.gradebook.rows import PlatformFile, RowOrigin, path_text
from coursework.system.links import open_inside

#: Files in such folders that contain no answers.
SIDE_FILES = frozenset(("timestamp.txt", "submission_secret.txt"))
_LONGEST_TIME = 400  #: bytes of it
_TIME = r"[0-9]{4}-[0-9]{2}-[0-9]{2}[ T_][0-9]{2}[:_][0-9]{2}[:_][0-9]{2}[^+]*"
_EXCHANGE = re.compile(rf"(?P<student>[^+]+)\+(?P<assignment>[^+]+)\+(?P<time>{_TIME})(?:\+.*)?")
_MOODLE = re.compile(r"(?P<student>.+)_(?P<id>[0-9]+)_assignsubmission_(?:file|onlinetext)")
_CANVAS = re.compile(r"(?P<student>[^\W_]+)_(?P<late>LATE_)?(?P<id>[0-9]+)_[0-9]+_.+", re.I)


class SubmittedFile(NamedTuple):
    """Statements of a file's location: its origin, and the platform that wrote it."""

    origin: RowOrigin
    seen: PlatformFile

    @property
    def name(self) -> str:
        """Name of the person who submitted the file."""
        return self.origin.by[-1]


def submitted_file(path: Path) -> SubmittedFile | None:
    """Return the origin of a file, from its folders, else from its name; None if they state nothing."""
    directory = path.resolve().parent
    full_path = Path(path_text(path.resolve()))
    for position, folder in reversed([*enumerate(full_path.parts[:-1])]):
        root = str(Path(*full_path.parts[:position]))
        if match := _EXCHANGE.fullmatch(folder):
            return _submitted_file((match["student"],), match["time"], root, "nbgrader's exchange", directory)
        if match := _MOODLE.fullmatch(folder):
            return _submitted_file(
                (match["student"],), "", root, "Moodle's submissions of an assignment", directory
            )
        if folder == "submitted" and len(full_path.parts) - position > 3:
            return _submitted_file(
                (full_path.parts[position + 1],),
                "",
                str(Path(root, folder)),
                "nbgrader's tree of submissions",
                directory,
            )
    if match := _CANVAS.fullmatch(Path(path_text(path)).name):
        people, root = (match["id"], match["student"]), path_text(path.parent)
        return _submitted_file(people, "", root, "Canvas's submissions", directory)
    return None


def _submitted_file(by: tuple[str, ...], time: str, root: str, platform: str, folder: Path) -> SubmittedFile:
    timestamp = folder / "timestamp.txt"
    if not time:
        with suppress(OSError), open_inside(timestamp, folder) as file:
            time = file.read(_LONGEST_TIME).decode("utf-8", "replace").strip()[:60]
    return SubmittedFile(RowOrigin(by=by, submitted=time), PlatformFile(root, platform, is_tree=True))


def superseded(files: Collection[Path]) -> set[Path]:
    """Return the files of earlier submissions: of each student's submissions of an assignment in an exchange
    folder the last one alone counts, as nbgrader collects them."""
    submissions: dict[tuple[Path, str, str], dict[tuple[str, str], list[Path]]] = {}
    for file in files:
        key, submission = _exchange_submission(file)
        if key is not None:
            submissions.setdefault(key, {}).setdefault(submission, []).append(file)
    return {file for some in submissions.values() for one in sorted(some)[:-1] for file in some[one]}


def _exchange_submission(file: Path) -> tuple[tuple[Path, str, str] | None, tuple[str, str]]:
    """Return the exchange folder, student and assignment of a file, None if it is of no exchange; and the
    time and the folder of its submission."""
    for folder in file.parents:
        if match := _EXCHANGE.fullmatch(folder.name):
            exchange = folder.parent.resolve()
            return (exchange, match["student"], match["assignment"]), (match["time"], folder.name)
    return None, ("", "")
