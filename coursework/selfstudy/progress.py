"""Progress of a student over all exercises: the format of ``progress.json``.

One JSON object::

    {"format": "coursework progress", "version": 1, "entries": [ENTRY, …]}

An entry is something that happened once and is never changed: ``at`` (UTC, ISO 8601), ``exercise``, ``seed``,
``part`` (a part's id, or another quantity of the solution; empty where it is of the whole variant), and
``what``:

``answer``
    with ``answer`` (as it was written) and, where it was marked, ``verdict`` (as in ``marks.csv``), ``kind``
    (the skill of its kind), ``shown`` (the named errors that it shows were not made)
``prediction``
    with ``answer``
``hint``
    with ``step``, from 1 on
``reveal``
    the step of the solution was shown
``example``
    the variant was shown as a worked example, ``step`` being its level; it counts for nothing any more

What a reader does not know it keeps. Two files are one when the entries of both stand in it once each:
nothing is lost, whoever wrote last. :class:`Progress` reads and writes such texts, :class:`ProgressFile`
keeps them in a file, and a site may keep them elsewhere.
"""

from __future__ import annotations

import itertools
import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from datetime import UTC, datetime, timedelta
from functools import cached_property
from pathlib import Path
from typing import Any, Protocol

from coursework.system.folder_lock import file_lock
from coursework.system.json_files import json_of

FORMAT, VERSION = "coursework progress", 1
ANSWER, PREDICTION, HINT, REVEAL, EXAMPLE = "answer", "prediction", "hint", "reveal", "example"

Entry = Mapping[str, Any]


class NotProgress(ValueError):
    """Text that is not in the progress format."""


class LaterVersion(ValueError):
    """Progress written by a later version, which this version might not preserve."""


class Progress:
    """Entries in the order of their dates, each once."""

    def __init__(self, entries: Iterable[Entry] = ()):
        self._entries = {_identity(entry): entry for entry in entries}

    @cached_property
    def _in_order(self) -> tuple[Entry, ...]:
        return tuple(sorted(self._entries.values(), key=date_of))

    def __iter__(self) -> Iterator[Entry]:
        """Iterate from the earliest entry on; entries of one instant in order of arrival."""
        return iter(self._in_order)

    def __len__(self) -> int:
        return len(self._entries)

    def __or__(self, other: Progress) -> Progress:
        """Return the entries of both."""
        return Progress((*self._entries.values(), *other._entries.values()))

    def of(self, exercise: str) -> Progress:
        """Return the entries of one exercise."""
        return Progress(e for e in self if e["exercise"] == exercise)

    @property
    def exercises(self) -> tuple[str, ...]:
        """Exercises with entries, the earliest begun first."""
        return tuple(dict.fromkeys(str(e["exercise"]) for e in self))

    def text(self) -> str:
        """Return the JSON text, one entry a line."""
        head = f'{{"format": {json.dumps(FORMAT)}, "version": {VERSION}, "entries": ['
        text = head + ",".join(f"\n{_identity(item)}" for item in self) + "\n]}\n"
        return text.encode("utf-8", "replace").decode("utf-8")  # halves of characters stand in no file

    @classmethod
    def read(cls, text: str) -> Progress:
        """Parse a progress text.

        Raises
        ------
        NotProgress
            It holds none.
        LaterVersion
            It was written by a later version.
        """
        try:
            content = json_of(text.encode("utf-8", "replace"), "progress")
            entries = [_checked(entry) for entry in content["entries"]]
            later = content["version"] > VERSION
            is_current = content["format"] == FORMAT
        except (ValueError, TypeError, KeyError, AttributeError, RecursionError) as fault:
            raise NotProgress(str(fault)) from fault
        if not is_current:
            raise NotProgress("no format of ours")
        if later:
            raise LaterVersion(str(content["version"]))
        return cls(entries)


class TooLong(ValueError):
    """Progress with more entries than accepted."""


def read_brought(data: bytes, most: int) -> tuple[type[ValueError] | None, tuple[Entry, ...]]:
    """Return the entries of an uploaded file, or the class of the error for which it is refused.

    An entry with a number that no JSON database accepts is dropped.
    """
    try:
        result = Progress.read(data.decode("utf-8-sig"))
        json.dumps([dict(item) for item in result], allow_nan=False)
    except LaterVersion:
        return LaterVersion, ()
    except ValueError:
        return NotProgress, ()
    return (TooLong, ()) if len(result) > most else (None, tuple(result))


def entry(at: datetime, exercise: str, seed: int, part: str, what: str, **more: Any) -> dict[str, Any]:
    """Return an entry for an event, as it is stored."""
    text = at.astimezone(UTC).isoformat(timespec="microseconds").replace("+00:00", "Z")
    return {"at": text, "exercise": exercise, "seed": seed, "part": part, "what": what, **more}


def date_of(item: Entry) -> datetime:
    """Return the date of an entry."""
    return datetime.fromisoformat(str(item["at"]).replace("Z", "+00:00"))


def _checked(item: Any) -> Entry:
    """Return an entry if it is valid. Raises ValueError, TypeError, KeyError: it lacks what every entry
    has."""
    if date_of(item).tzinfo is None:
        raise ValueError(item["at"])
    for number in (item["seed"], item.get("step", 1)):
        if isinstance(number, bool) or not isinstance(number, int) or number < 0:
            raise ValueError(number)
    if not all(isinstance(item[name], str) for name in ("exercise", "part", "what")):
        raise ValueError("an entry names its exercise, its part and what it is")
    if not all(isinstance(item.get(name, ""), str) for name in ("verdict", "kind")):
        raise ValueError("a verdict and a kind are texts")
    return item


def _identity(item: Entry) -> str:
    return json.dumps(item, ensure_ascii=False, sort_keys=True, default=str)


FILE = "progress.json"  #: of all the exercises of a folder

Clock = Callable[[], datetime]

_KINDS = {"answers": ANSWER, "predictions": PREDICTION}
_WAIT = 5.0  #: seconds for another notebook to finish


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


class ProgressFile:
    """Progress file of a folder, read when opened and again before each write, so that two open notebooks
    lose nothing.

    ``trouble`` says why nothing is written, or why a file was set aside; it is empty when all is well, and
    ``troubled`` is the name of that file.
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
            self._report("later")
        except (OSError, NotProgress, UnicodeDecodeError):
            self._set_aside()
        return Progress()

    def refresh(self) -> None:
        """Read the entries that another notebook has written since."""
        if self._is_kept:
            self.progress = self._read() | self.progress

    def _set_aside(self) -> None:
        """Rename a damaged file to an unused name."""
        names = (self.path.with_suffix(f".damaged{n or ''}.json") for n in itertools.count())
        self._report("damaged")
        try:
            self.path.replace(next(name for name in names if not name.exists()))
        except OSError:
            self._is_kept = False
            self._report("unwritable")

    def _report(self, why: str) -> None:
        self.trouble, self.troubled = why, self.path.name

    def add(self, entries: Iterable[Entry]) -> None:
        """Store new entries."""
        new = Progress(entries)
        if not len(new):
            return
        if not self._is_kept:
            self.progress |= new
            return
        try:
            self.path.parent.stat()  # a lock would make the folder
            with file_lock(self.path.with_suffix(".lock"), _WAIT):
                self.progress = self._read() | self.progress | new
                part = self.path.with_suffix(".part")
                part.write_text(self.progress.text(), "utf-8")
                part.replace(self.path)
        except OSError:
            self.progress |= new
            self._report("unwritable")


class ExerciseStore:
    """Stored data of one exercise: answers and predictions by seed, and all events.

    A blank never replaces an earlier answer.
    """

    def __init__(self, file: ProgressStore, exercise: str):
        self.exercise, self.file = exercise, file

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


def is_blank(text: Any) -> bool:
    """Return whether an answer is empty."""
    return text is None or (isinstance(text, str) and not text.strip())
