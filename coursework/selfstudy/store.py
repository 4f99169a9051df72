"""Storage of a student's answers and events in one small file beside the notebooks, for all exercises."""

from __future__ import annotations

import itertools
import os
import re
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any, Protocol

from coursework.selfstudy.progress import (
    ANSWER,
    PREDICTION,
    Entry,
    LaterVersion,
    NotProgress,
    Progress,
    date_of,
    entry,
)
from coursework.system.json_files import json_of

FILE = "progress.json"  #: of all the exercises of a folder
EARLIER = ".study.json"  #: ending of the files of one exercise that earlier versions kept

Clock = Callable[[], datetime]

_KINDS = {"answers": ANSWER, "predictions": PREDICTION}
_WAIT, _STALE = 5.0, 30.0  #: seconds for another notebook to finish; age of a lock whose owner is gone


def now() -> datetime:
    return datetime.now(UTC)


class ProgressStore(Protocol):
    """Interface of a progress store: a file beside notebooks, or another one."""

    progress: Progress
    clock: Clock
    trouble: str
    troubled: str

    def refresh(self) -> None:
        """Read the entries added by others since."""

    def add(self, entries: Iterable[Entry]) -> None:
        """Store new entries."""

    def take_over(self, exercise: str) -> None:
        """Import the entries of an exercise from an earlier version's file, if there is one."""


class ProgressFile:
    """Progress file of a folder, read when opened and again before each write, so that two open notebooks
    lose nothing.

    ``trouble`` says why nothing is written, or why an older file was set aside; it is empty when all is well, and ``troubled`` is the
    name of that file.
    """

    def __init__(self, folder: Path, clock: Clock = now):
        self.path = folder / FILE
        self.clock = clock
        self.trouble = self.troubled = ""
        self._is_kept = True
        self.progress = self._read()

    def _read(self) -> Progress:
        """Return the content of the file; one that cannot be read is set aside."""
        try:
            return Progress.read(self.path.read_text("utf-8"))
        except FileNotFoundError:
            return Progress()
        except LaterVersion:
            self._is_kept = False
            self._report("later", self.path)
        except (OSError, NotProgress, UnicodeDecodeError):
            self.set_aside("damaged", self.path)
        return Progress()

    def refresh(self) -> None:
        """Read the entries that another notebook has written since."""
        if self._is_kept:
            self.progress = self._read() | self.progress

    def set_aside(self, why: str, path: Path) -> None:
        """Rename a damaged file to an unused name."""
        names = (path.with_suffix(f".damaged{n or ''}.json") for n in itertools.count())
        self._report(why, path)
        try:
            path.replace(next(name for name in names if not name.exists()))
        except OSError:
            self._is_kept = path != self.path
            self._report("unwritable", path)

    def _report(self, why: str, path: Path) -> None:
        self.trouble, self.troubled = why, path.name

    def add(self, entries: Iterable[Entry]) -> None:
        """Store new entries."""
        new = Progress(entries)
        if not len(new):
            return
        if not self._is_kept:
            self.progress |= new
            return
        try:
            with _alone(self.path):
                self.progress = self._read() | self.progress | new
                part = self.path.with_suffix(".part")
                part.write_text(self.progress.text(), "utf-8")
                part.replace(self.path)
        except OSError:
            self.progress |= new
            self._report("unwritable", self.path)

    def take_over(self, exercise: str) -> None:
        """Import ``EXERCISE.study.json``, the file of an earlier version beside this one, unless entries of
        the exercise exist.

        A file that cannot be read is set aside.
        """
        path = self.path.parent / f"{exercise}{EARLIER}"
        if not path.exists():
            return
        existing = {(e["seed"], e["part"], e["what"]) for e in self.progress.of(exercise)}
        result = self._of_earlier(path, exercise)
        self.add(e for e in result if (e["seed"], e["part"], e["what"]) not in existing)

    def _of_earlier(self, path: Path, exercise: str) -> list[dict[str, Any]]:
        try:
            content = json_of(path.read_bytes(), str(path))
            variants = {
                _seed(seed): {kind: dict(texts) for kind, texts in kinds.items()}
                for seed, kinds in content["variants"].items()
            }
        except (OSError, ValueError, TypeError, KeyError, AttributeError, RecursionError):
            self.set_aside("damaged", path)
            return []
        if content.get("exercise", exercise) != exercise:
            self.set_aside("other", path)
            return []
        at = datetime.fromtimestamp(path.stat().st_mtime, UTC)
        return [
            entry(at, exercise, seed, str(name), _KINDS[kind], answer=text)
            for seed, kinds in variants.items()
            for kind, texts in kinds.items()
            if kind in _KINDS
            for name, text in texts.items()
            if not is_blank(text)
        ]


@contextmanager
def _alone(path: Path) -> Iterator[None]:
    """Hold the advisory lock of a file; a lock that somebody left behind is ignored after a while."""
    lock = path.with_suffix(".lock")
    until = time.monotonic() + _WAIT
    while True:
        try:
            os.close(os.open(lock, os.O_CREAT | os.O_EXCL | os.O_WRONLY))
            break
        except FileExistsError:
            with suppress(OSError):
                if time.time() - lock.stat().st_mtime > _STALE:
                    lock.unlink()
                    continue
            if time.monotonic() > until:
                break
            time.sleep(0.02)
    try:
        yield
    finally:
        lock.unlink(missing_ok=True)


class ExerciseStore:
    """Stored data of one exercise: answers and predictions by seed, and all events.

    A blank never replaces an earlier answer. The file of an earlier version is imported once, with its date,
    and left unchanged.
    """

    def __init__(self, file: ProgressStore, exercise: str):
        self.exercise, self.file = exercise, file
        self.file.take_over(exercise)

    def beside(self, exercise: str) -> ExerciseStore:
        """Return the stored data of another exercise in the same file."""
        return ExerciseStore(self.file, exercise)

    @property
    def progress(self) -> Progress:
        """Progress in every exercise."""
        return self.file.progress

    @property
    def trouble(self) -> str:
        return self.file.trouble

    @property
    def seeds(self) -> tuple[int, ...]:
        """Seeds of the variants with answers or predictions, in order."""
        written = (e for e in self.progress.of(self.exercise) if e["what"] in _KINDS.values())
        return tuple(sorted({int(e["seed"]) for e in written}))

    def of(self, seed: int, kind: str) -> dict[str, Any]:
        """Return the last stored ``answers`` or ``predictions`` for a variant."""
        return {e["part"]: e.get("answer") for e in self.happened(seed) if e["what"] == _KINDS[kind]}

    def happened(self, seed: int) -> tuple[Entry, ...]:
        """Return the events of a variant, in order."""
        return tuple(e for e in self.progress.of(self.exercise) if e["seed"] == seed)

    def add(self, seed: int, kind: str, texts: dict[str, Any]) -> None:
        """Store the texts that are neither blank nor unchanged."""
        events = self.of(seed, kind)
        new = {n: t for n, t in texts.items() if not is_blank(t) and (n not in events or events[n] != t)}
        self.note(seed, [{"part": n, "what": _KINDS[kind], "answer": t} for n, t in new.items()])

    def note(self, seed: int, happened: Iterable[dict[str, Any]]) -> None:
        """Store new events of a variant, dated after all its earlier ones whatever the clock says."""
        before = self.happened(seed)
        at = max([self.file.clock(), *(date_of(e) + timedelta(microseconds=1) for e in before[-1:])])
        self.file.add([entry(at, self.exercise, seed, **each) for each in happened])


def _seed(text: str) -> int:
    """Parse a seed; refuse any other spelling."""
    if not re.fullmatch(r"0|[1-9][0-9]{0,99}", text):
        raise ValueError(text)
    return int(text)


def is_blank(text: Any) -> bool:
    """Return whether an answer is empty."""
    return text is None or (isinstance(text, str) and not text.strip())
