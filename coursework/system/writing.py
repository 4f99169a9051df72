"""Files and tables that take their places together, whole or not at all."""

from __future__ import annotations

import csv
import pickle
import shutil
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from coursework.errors import BadInput
from coursework.system.blocks import processors
from coursework.system.build_folder import place
from coursework.system.processes import processes, workers
from coursework.system.tables import SPREADSHEETS, Spreadsheet


@dataclass(frozen=True)
class File:
    """One file of the result: its path below the output folder, and how to make its bytes, if any.

    ``anywhere`` says that another process may make it: ``make`` and all that it holds can be pickled.
    """

    path: Path
    make: Callable[[], bytes | None]
    anywhere: bool = False


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
    count = workers(len(elsewhere))
    if len(elsewhere) < WORTH_PROCESSES or count < 2:
        elsewhere = []
    here = [file for file in wanted if not (elsewhere and file.anywhere)]
    with ExitStack() as pools:
        threads = pools.enter_context(ThreadPoolExecutor(processors()))
        tasks = [(threads.submit(_write_all, out, [file]), [file]) for file in here]
        # What threads share they wait for: the interpreter, and what the typesetter remembers.
        if elsewhere:
            submit = pools.enter_context(processes(count))
            chunks = (elsewhere[start : start + _CHUNK] for start in range(0, len(elsewhere), _CHUNK))
            tasks += [(submit(_write_sent, out, pickle.dumps(chunk)), chunk) for chunk in chunks]
        try:
            for task, chunk in tasks:
                task.result()
                for file in chunk:
                    progress(file.path)
        finally:
            for task, _ in tasks:
                task.cancel()


def _write_sent(out: Path, files: bytes) -> None:
    """In another process. The files come as bytes, so that a course that cannot be opened there is told as such."""
    _write_all(out, pickle.loads(files))


def _write_all(out: Path, files: Sequence[File]) -> None:
    for file in files:
        data = file.make()
        if data is not None:
            write_whole(out / file.path, data)


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
        part.write_bytes(data)
        part.replace(path)


#: Called with how many are done, and of how many.
Progress = Callable[[int, int], None]


class Table:
    """A CSV file being written, beside the one whose place it is to take; with the mark that Excel wants at its head."""

    def __init__(self, path: Path, columns: Sequence[str], spreadsheet: Spreadsheet) -> None:
        self.path, self.part = path, path.with_name(path.name + ".part")
        self.file = self.part.open("w", encoding="utf-8", newline="")
        self.file.write("\ufeff")
        self._writer = csv.writer(self.file, delimiter=spreadsheet.delimiter)
        self._cells = spreadsheet.cells
        self._columns = tuple(columns)
        self._writer.writerow(self._columns)
        self.rows = 0

    def write(self, row: dict[str, Any]) -> None:
        self._writer.writerow(self._cells(row, self._columns))
        self.rows += 1


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

    def keep(self) -> None:
        """Let the tables take their places: all are whole, and can, before the first does."""
        for table in self._tables:
            table.file.close()
            _check_replaceable(table.path)
        for table in self._tables:
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
