"""Trees of submissions as platforms keep them: the folder, or the file's name, says who handed in and when."""

from __future__ import annotations

import re
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from coursework.gradebook.rows import Collected, Seen, path_text
from coursework.system.links import open_inside

#: Files that lie in such trees and hold no answers.
BESIDE = frozenset(("timestamp.txt", "submission_secret.txt"))
_LONGEST_TIME = 400  #: bytes of it
_TIME = r"[0-9]{4}-[0-9]{2}-[0-9]{2}[ T_][0-9]{2}[:_][0-9]{2}[:_][0-9]{2}[^+]*"
_EXCHANGE = re.compile(rf"(?P<student>[^+]+)\+(?P<assignment>[^+]+)\+(?P<time>{_TIME})(?:\+.*)?")
_MOODLE = re.compile(r"(?P<student>.+)_(?P<id>[0-9]+)_assignsubmission_(?:file|onlinetext)")
_CANVAS = re.compile(r"(?P<student>[^\W_]+)_(?P<late>LATE_)?(?P<id>[0-9]+)_[0-9]+_.+", re.I)


class HandedIn(NamedTuple):
    """What a file's place says."""

    origin: Collected
    seen: Seen

    @property
    def name(self) -> str:
        """Who handed it in, as a person reads it."""
        return self.origin.by[-1]


def handed_in(path: Path) -> HandedIn | None:
    """Who handed a file in, by the folders that it lies in, else by its name; None where they say nothing."""
    beside = path.resolve().parent
    whole = Path(path_text(path.resolve()))
    for place, folder in reversed([*enumerate(whole.parts[:-1])]):
        root = str(Path(*whole.parts[:place]))
        if found := _EXCHANGE.fullmatch(folder):
            return _handed((found["student"],), found["time"], root, "nbgrader's exchange", beside)
        if found := _MOODLE.fullmatch(folder):
            return _handed((found["student"],), "", root, "Moodle's submissions of an assignment", beside)
        if folder == "submitted" and len(whole.parts) - place > 3:
            return _handed(
                (whole.parts[place + 1],),
                "",
                str(Path(root, folder)),
                "nbgrader's tree of submissions",
                beside,
            )
    if found := _CANVAS.fullmatch(Path(path_text(path)).name):
        who, root = (found["id"], found["student"]), path_text(path.parent)
        return _handed(who, "", root, "Canvas's submissions", beside)
    return None


def _handed(by: tuple[str, ...], time: str, root: str, what: str, folder: Path) -> HandedIn:
    beside = folder / "timestamp.txt"
    if not time:
        with suppress(OSError), open_inside(beside, folder) as file:
            time = file.read(_LONGEST_TIME).decode("utf-8", "replace").strip()[:60]
    return HandedIn(Collected(by=by, submitted=time), Seen(root, what, is_tree=True))


def latest_first(files: Iterable[Path]) -> list[Path]:
    """The files in their order, but of an exchange what somebody handed in last before what they did earlier: the first that
    is read counts."""
    return sorted(files, key=lambda path: [_turned(part) for part in path.parts])


def _turned(folder: str) -> tuple[str, tuple[int, ...], str]:
    found = _EXCHANGE.fullmatch(folder)
    if found is None:
        return folder, (), ""
    return f"{found['student']}+{found['assignment']}+", tuple(-ord(c) for c in found["time"]), folder
