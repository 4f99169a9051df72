"""Files and tables that take their places together, whole or not at all."""

from __future__ import annotations

import csv
import shutil
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from coursework.errors import BadInput, CourseworkError
from coursework.system.blocks import processors
from coursework.system.build_folder import place
from coursework.system.processes import Task, in_turn, workers
from coursework.system.tables import SPREADSHEETS, Spreadsheet, inert


@dataclass(frozen=True)
class File:
    """One file of the result: its path below the output folder, and how to make its bytes, if any.

    ``anywhere`` says that another process may make it: ``make`` and all that it holds can be pickled. ``failed`` is told why
    it cannot be made, where that is to cost no other.
    """

    path: Path
    make: Callable[[], bytes | None]
    anywhere: bool = False
    failed: Callable[[CourseworkError], None] | None = None


WORTH_PROCESSES = 150  #: files; fewer are made before a process has started
_CHUNK = 8  #: files that a process is sent at once


def write_tree(
    out: Path,
    wanted: Sequence[File],
    progress: Callable[[Path], None] = lambda path: None,
    *,
    anew: bool = False,
) -> list[str]:
    """Make and write a build: it appears whole, in place of the one before, or not at all.

    What somebody changed or put there is not lost, and ``anew`` is as in :func:`coursework.system.build_folder.place`; gives
    notes to tell.

    Raises
    ------
    BadInput
        The folder cannot be written, or a file that no build wrote stands in the way.
    """
    staging = out / ".building"
    shutil.rmtree(staging, ignore_errors=True)
    try:
        with writing(out):
            (staging / "new").mkdir(parents=True)
        write(staging / "new", wanted, progress)
        with writing(out):
            return place(staging, out, anew=anew)
    finally:
        shutil.rmtree(staging, ignore_errors=True)


@contextmanager
def writing(place: Path) -> Iterator[None]:
    """What the system says against writing, told with the place that was asked for and what would do."""
    try:
        yield
    except OSError as fault:
        raise BadInput(
            f"{place} cannot be written: {fault.strerror or fault}; name another folder, or make this one writable"
        ) from fault


def write(out: Path, wanted: Sequence[File], progress: Callable[[Path], None] = lambda path: None) -> None:
    """Make and write files, on all processors; each appears whole or not at all.

    Raises
    ------
    ValueError
        Two files of the same path.
    """
    if len({f.path for f in wanted}) != len(wanted):
        raise ValueError("two files of a build have the same path")
    for folder in {out / f.path.parent for f in wanted}:
        folder.mkdir(parents=True, exist_ok=True)
    elsewhere = [file for file in wanted if file.anywhere]
    count = workers(len(elsewhere), WORTH_PROCESSES)
    here = [file for file in wanted if count < 2 or not file.anywhere]
    with ThreadPoolExecutor(processors()) as threads:
        tasks = [threads.submit(_write_one, out, file) for file in here]
        # What threads share they wait for: the interpreter, and what the typesetter remembers.
        try:
            if count > 1:
                for chunk, made in _from_elsewhere(elsewhere, count):
                    for file, found in zip(chunk, made, strict=True):
                        _put(out, file, found)
                        progress(file.path)
                    _raise_early(tasks)
            for file, task in zip(here, tasks, strict=True):
                task.result()
                progress(file.path)
        finally:
            for task in tasks:
                task.cancel()


_Sent = tuple[Callable[[], bytes | None], bool]  #: how to make a file, and whether it may fail


def _sent(file: File) -> _Sent:
    return file.make, file.failed is not None


def _from_elsewhere(files: Sequence[File], count: int) -> Iterator[tuple[Sequence[File], list[Any]]]:
    """Some files after others, and what other processes made of them."""
    chunks = [files[start : start + _CHUNK] for start in range(0, len(files), _CHUNK)]
    tasks = (Task(str(chunk[0].path), _all_made, ([_sent(file) for file in chunk],)) for chunk in chunks)
    yield from zip(chunks, in_turn(tasks, count), strict=True)


def _all_made(files: Sequence[_Sent]) -> list[bytes | CourseworkError | None]:
    return [_made(file) for file in files]


def _made(file: _Sent) -> bytes | CourseworkError | None:
    """The bytes of a file, or why it cannot be made, where that is to be told."""
    make, may_fail = file
    try:
        return make()
    except CourseworkError as fault:
        if may_fail:
            return fault
        raise


def _write_one(out: Path, file: File) -> None:
    _put(out, file, _made(_sent(file)))


def _put(out: Path, file: File, made: bytes | CourseworkError | None) -> None:
    if isinstance(made, CourseworkError):
        assert file.failed is not None
        file.failed(made)
    elif made is not None:
        write_whole(out / file.path, made)


def _raise_early(tasks: Iterable[Future[Any]]) -> None:
    """What a task has failed by is raised before all others are done."""
    for task in tasks:
        if task.done():
            task.result()


@contextmanager
def gone_unless_kept(part: Path) -> Iterator[None]:
    """A file that is written beside the one whose place it is to take goes where that is not done, whatever the reason."""
    try:
        yield
    except BaseException:
        with suppress(OSError):
            part.unlink(missing_ok=True)
        raise


def write_whole(path: Path, data: bytes) -> None:
    """Write a file so that it appears whole or not at all.

    Raises
    ------
    BadInput
        It cannot be written.
    """
    part = path.with_name(path.name + ".part")
    with writing(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        with gone_unless_kept(part):
            part.write_bytes(data)
            part.replace(path)


#: Called with how many are done, and of how many.
Progress = Callable[[int, int], None]


class Table:
    """A CSV file being written, beside the one whose place it is to take; with the mark that Excel wants at its head."""

    def __init__(self, path: Path, columns: Sequence[str], spreadsheet: Spreadsheet) -> None:
        self.path, self.part = path, path.with_name(path.name + ".part")
        self.file = self.part.open("w", encoding="utf-8", errors="backslashreplace", newline="")
        self.file.write("\ufeff")
        self._writer = csv.writer(self.file, delimiter=spreadsheet.delimiter)
        self._cells = spreadsheet.cells
        self._columns = tuple(columns)
        self._writer.writerow(map(inert, self._columns))
        self.rows = 0

    def write(self, row: dict[str, Any]) -> None:
        try:
            self._writer.writerow(self._cells(row, self._columns))
        except OSError:
            with writing(self.path):
                raise
        self.rows += 1

    def close(self) -> None:
        """End it; what is not on the disk yet is written."""
        with writing(self.path):
            self.file.close()


class Tables:
    """Tables of one folder that take their places together when they are kept, and leave nothing when they are not.

    Raises
    ------
    BadInput
        One of them cannot take its place; told before the first is written, and again before the first is kept.
    """

    def __init__(self, folder: Path, spreadsheet: Spreadsheet = SPREADSHEETS["point"]) -> None:
        self._folder = folder
        self._spreadsheet = spreadsheet
        self._tables: list[Table] = []

    def __enter__(self) -> Tables:
        self._folder.mkdir(parents=True, exist_ok=True)
        return self

    def __exit__(self, *_: object) -> None:
        for table in self._tables:
            with suppress(OSError):  # a full disk has been told already
                table.file.close()
            table.part.unlink(missing_ok=True)

    def open(self, name: str, columns: Sequence[str]) -> Table:
        path = self._folder / name
        _check_replaceable(path)
        self._tables.append(Table(path, columns, self._spreadsheet))
        return self._tables[-1]

    def ready(self) -> None:
        """See that all are whole, and can take their places."""
        for table in self._tables:
            table.close()
            _check_replaceable(table.path)

    def keep(self) -> None:
        """Let the tables take their places: all are whole, and can, before the first does. The one that was opened first
        does so last, so that a marking that is stopped here compares with the marks of before when it is done again."""
        self.ready()
        for table in reversed(self._tables):
            with _told(table.path):
                table.part.replace(table.path)


def _check_replaceable(path: Path) -> None:
    with _told(path):
        if path.exists():
            path.open("ab").close()


@contextmanager
def _told(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as fault:
        raise BadInput(
            f"{path} cannot be written ({fault.strerror}); close what has it open, move it away, or choose another --out"
        ) from fault
