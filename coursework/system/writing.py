"""Files and tables that appear together, complete or not at all."""

from __future__ import annotations

import csv
import shutil
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

from coursework.errors import BadInput, CourseworkError, reason_of
from coursework.system.blocks import processors
from coursework.system.build_folder import install
from coursework.system.processes import Task, in_turn, workers
from coursework.system.tables import SPREADSHEETS, Spreadsheet, inert

Content: TypeAlias = bytes | Iterable[bytes]


@dataclass(frozen=True)
class File:
    """File of the result: its path below the output folder, and a function that returns its bytes, in pieces
    if they are many, or None for no file.

    ``anywhere`` lets another process make it: ``make`` and all that it holds can be pickled. ``failed``, if
    given, receives the error, and the other files are still written.
    """

    path: Path
    make: Callable[[], Content | None]
    anywhere: bool = False
    failed: Callable[[CourseworkError], None] | None = None


WORTH_PROCESSES = 150  #: files; fewer are made faster than a process starts
_CHUNK = 8  #: files per task of a process


def write_tree(
    out: Path,
    wanted: Sequence[File],
    progress: Callable[[Path], None] = lambda path: None,
    *,
    anew: bool = False,
) -> list[str]:
    """Make and write a build: it replaces the one before completely, or not at all.

    Files that somebody changed or added are not lost; ``anew`` is as in
    :func:`coursework.system.build_folder.install`. Return notes for the user.

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
            return install(staging, out, anew=anew)
    finally:
        shutil.rmtree(staging, ignore_errors=True)


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Turn an error of the system on writing into a message with the path and the remedy."""
    try:
        yield
    except OSError as fault:
        raise BadInput(
            "{file} cannot be written: {reason}; name another folder, or make this one writable",
            file=path,
            reason=reason_of(fault),
        ) from fault


def write(out: Path, wanted: Sequence[File], progress: Callable[[Path], None] = lambda path: None) -> None:
    """Make and write files on all processors; each appears complete or not at all.

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
        # Threads wait for each other: for the interpreter, and for the typesetter's cache.
        try:
            if count > 1:
                for chunk, results in _from_elsewhere(elsewhere, count):
                    for file, content in zip(chunk, results, strict=True):
                        _put(out, file, content)
                        progress(file.path)
                    _raise_early(tasks)
            for file, task in zip(here, tasks, strict=True):
                task.result()
                progress(file.path)
        finally:
            for task in tasks:
                task.cancel()


_Sent = tuple[Callable[[], Content | None], bool]  #: how to make a file, and whether it may fail


def _sent(file: File) -> _Sent:
    return file.make, file.failed is not None


def _from_elsewhere(files: Sequence[File], count: int) -> Iterator[tuple[Sequence[File], list[Any]]]:
    """Yield groups of files with their contents, computed by other processes."""
    chunks = [files[start : start + _CHUNK] for start in range(0, len(files), _CHUNK)]
    tasks = (Task(str(chunk[0].path), _contents, ([_sent(file) for file in chunk],)) for chunk in chunks)
    yield from zip(chunks, in_turn(tasks, count), strict=True)


def _contents(files: Sequence[_Sent]) -> list[Content | CourseworkError | None]:
    return [_content(file) for file in files]


def _content(file: _Sent) -> Content | CourseworkError | None:
    """Return the bytes of a file, or the error if the caller handles it."""
    make, may_fail = file
    try:
        return make()
    except CourseworkError as fault:
        if may_fail:
            return fault
        raise


def _write_one(out: Path, file: File) -> None:
    _put(out, file, _content(_sent(file)))


def _put(out: Path, file: File, content: Content | CourseworkError | None) -> None:
    if isinstance(content, CourseworkError):
        assert file.failed is not None
        file.failed(content)
    elif content is not None:
        write_whole(out / file.path, content)


def _raise_early(tasks: Iterable[Future[Any]]) -> None:
    """Raise the error of a finished task before the other tasks are done."""
    for task in tasks:
        if task.done():
            task.result()


@contextmanager
def removed_on_failure(part: Path) -> Iterator[None]:
    """Remove a partly written file if the context raises."""
    try:
        yield
    except BaseException:
        with suppress(OSError):
            part.unlink(missing_ok=True)
        raise


def write_whole(path: Path, data: Content) -> None:
    """Write a file that appears complete or not at all.

    Raises
    ------
    BadInput
        It cannot be written.
    """
    part = path.with_name(path.name + ".part")
    with writing(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        with removed_on_failure(part):
            with part.open("wb") as file:
                file.writelines([data] if isinstance(data, bytes) else data)
            part.replace(path)


#: Called with the number of finished items and their total.
Progress = Callable[[int, int], None]


class TableFile:
    """CSV file that is written under a temporary name, with the byte-order mark that Excel needs."""

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
        """Write the rest to the disk and close the file."""
        with writing(self.path):
            self.file.close()


class Tables:
    """Tables of one folder that appear together at :meth:`commit`; without it they leave nothing behind.

    Raises
    ------
    BadInput
        A table cannot be replaced; checked before the first is written, and again before the first
        replacement.
    """

    def __init__(self, folder: Path, spreadsheet: Spreadsheet = SPREADSHEETS["point"]) -> None:
        self._folder = folder
        self._spreadsheet = spreadsheet
        self._tables: list[TableFile] = []

    def __enter__(self) -> Tables:
        self._folder.mkdir(parents=True, exist_ok=True)
        return self

    def __exit__(self, *_: object) -> None:
        for table in self._tables:
            with suppress(OSError):  # a full disk has been reported
                table.file.close()
            table.part.unlink(missing_ok=True)

    def open(self, name: str, columns: Sequence[str]) -> TableFile:
        path = self._folder / name
        _check_replaceable(path)
        self._tables.append(TableFile(path, columns, self._spreadsheet))
        return self._tables[-1]

    def check(self) -> None:
        """Raise if a table is not complete or cannot be replaced."""
        for table in self._tables:
            table.close()
            _check_replaceable(table.path)

    def commit(self) -> None:
        """Replace the tables, after checking all of them.

        The table opened first is replaced last: a marking that stops in between still compares with the
        earlier marks when it is repeated.
        """
        self.check()
        for table in reversed(self._tables):
            with _replacement_errors(table.path):
                table.part.replace(table.path)


def _check_replaceable(path: Path) -> None:
    with _replacement_errors(path):
        if path.exists():
            path.open("ab").close()


@contextmanager
def _replacement_errors(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as fault:
        raise BadInput(
            (
                "{file} cannot be written ({reason}); close the program that has it open, move the "
                "file, or choose "
                "another --out"
            ),
            file=path,
            reason=reason_of(fault),
        ) from fault
