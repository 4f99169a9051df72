"""Exercise that is being edited: its files are watched, and a new process shows each of their states.

A process that has opened a course does not reload files. The next process, ready with all libraries loaded,
therefore reads a saved file.
"""

from __future__ import annotations

import multiprocessing
import os
import threading
from collections.abc import Iterator
from contextlib import suppress
from datetime import datetime
from pathlib import Path
from typing import NamedTuple

from coursework.course.folder import course_folder
from coursework.messages import Message
from coursework.site.preview.previewed import ViewRequest, ViewResult, work

_EVERY = 0.12  #: seconds between two scans of the files
_PAGE_FIRST = 0.6  #: seconds before a check begins
_LONGEST = 60  #: seconds that a view may take
_PLACES = ("exercises", "solutions", "templates")
_SPAWN = multiprocessing.get_context("spawn")

_Files = dict[str, tuple[int, int]]


class View(NamedTuple):
    """Current view, or the last valid one if the current one cannot be made."""

    content: object
    fault: str
    worked: datetime | None  #: time of the content, if it is not current


class _Process:
    """Process that makes views of one state of a course."""

    def __init__(self, folder: str | None, exercise: str):
        self._pipe, other = _SPAWN.Pipe()
        self._process = _SPAWN.Process(target=work, args=(other, folder, exercise), daemon=True)
        self._process.start()
        other.close()
        self._lock = threading.Lock()

    def result(self, request: ViewRequest, seconds: float = _LONGEST) -> ViewResult | None:
        """Return a view; None if the process was ended meanwhile."""
        with self._lock:
            try:
                self._pipe.send(request)
                if not self._pipe.poll(seconds):
                    self.end()
                    return ViewResult(
                        fault=Message(
                            "this took more than {seconds} s and was stopped: perhaps a loop does not end",
                            seconds=f"{seconds:g}",
                        )
                    )
                answer: ViewResult = self._pipe.recv()
                return answer
            except (EOFError, OSError):
                return None

    def end(self) -> None:
        """Kill the process."""
        self._process.kill()
        with suppress(OSError):
            self._pipe.close()


class EditedExercise:
    """Exercise whose files an author is editing."""

    def __init__(self, folder: str | None, exercise: str, variants: int):
        self.exercise = exercise
        self._folder, self._variants = folder, variants
        self._root = course_folder(folder).root
        self._lock = threading.Lock()
        self._good: dict[ViewRequest, tuple[object, datetime]] = {}
        self._spare = [self._begun(), self._begun()]
        self._views = self._checks = self._spare[0]
        self.state = 0
        self.check: ViewResult | None = None  #: None while it is under way
        self._ended = threading.Event()
        self._take()
        threading.Thread(target=self._watch, daemon=True).start()

    def _begun(self) -> _Process:
        return _Process(self._folder, self.exercise)

    # ------------------------------------------------------------------- a state

    @property
    def stamp(self) -> str:
        """Text that changes when there is something new to show."""
        return f"{self.state}.{int(self.check is not None)}"

    def view(self, request: ViewRequest) -> View:
        """Return a view of the current state; if it cannot be made, the last valid one, with the reason."""
        while True:
            state, process = self.state, self._views
            result = process.result(request)
            if result is not None and state == self.state:
                break
            if (
                result is None and process is self._views and not self._ended.is_set()
            ):  # it was stopped, or fell
                self._views = self._begun()
            if self._ended.is_set():
                return View(None, Message("the preview has ended"), None)
        if not result.fault:
            self._good[request] = result.content, datetime.now().astimezone()
            return View(result.content, "", None)
        content, worked = self._good.get(request, (None, None))
        return View(content, result.fault, worked)

    def _take(self) -> None:
        """Start new processes for the current state of the files."""
        with self._lock:
            for process in {self._views, self._checks} - set(self._spare):
                process.end()
            self._views, self._checks = self._spare or [self._begun(), self._begun()]
            self._spare = []
            self.check = None
            self.state += 1
            threading.Thread(target=self._run_check, args=(self.state, self._checks), daemon=True).start()

    def _run_check(self, state: int, process: _Process) -> None:
        """Run the check after a delay, since the page comes first if processors are few."""
        if self._ended.wait(_PAGE_FIRST) or not self._make_ready(state):
            return
        result = process.result(ViewRequest("check", variants=self._variants), 10 * _LONGEST)
        with self._lock:
            if result is not None and state == self.state:
                self.check = result

    def _make_ready(self, state: int) -> bool:
        """Start the processes of the next state; return True if the given state is still current."""
        with self._lock:
            if state == self.state and not self._spare:
                self._spare = [self._begun(), self._begun()]
            return state == self.state

    # --------------------------------------------------------------------- files

    def _watch(self) -> None:
        """Take a new state once its files have not changed for a moment, since an editor may write in
        steps."""
        current = before = self._files()
        while not self._ended.wait(_EVERY):
            now = self._files()
            if now == before and now != current:
                current = now
                self._take()
            before = now

    def _files(self) -> _Files:
        return dict(file for name in _PLACES for file in _files(self._root / name))

    def end(self) -> None:
        self._ended.set()
        with self._lock:
            for process in {self._views, self._checks, *self._spare}:
                process.end()


def _files(folder: Path) -> Iterator[tuple[str, tuple[int, int]]]:
    """Yield the files that a course may read, with date and size, without temporary files of editors."""
    with suppress(OSError):
        for entry in os.scandir(folder):
            if entry.name.startswith((".", "#", "_" * 2 + "pycache")) or entry.name.endswith(
                ("~", ".swp", ".tmp", ".pyc")
            ):
                continue
            with suppress(OSError):
                if entry.is_dir():
                    yield from _files(Path(entry.path))
                else:
                    about = entry.stat()
                    yield entry.path, (about.st_mtime_ns, about.st_size)
