"""Progress of a student over all exercises: the format of ``progress.json``.

One JSON object::

    {"format": "coursework progress", "version": 1, "entries": [ENTRY, …]}

An entry is something that happened once and is never changed: ``at`` (UTC, ISO 8601), ``exercise``, ``seed``, ``part``
(a part's id, or another quantity of the solution; empty where it is of the whole variant), and ``what``:

``answer``
    with ``answer`` (as it was written) and, where it was marked, ``verdict`` (as in ``marks.csv``), ``kind`` (the skill of its
    kind), ``shown`` (the named errors that it shows were not made)
``prediction``
    with ``answer``
``hint``
    with ``step``, from 1 on
``reveal``
    the step of the solution was shown
``example``
    the variant was shown as a worked example, ``step`` being its level; it counts for nothing any more

What a reader does not know it keeps. Two files are one when the entries of both stand in it once each: nothing is lost, whoever
wrote last. This room reads and writes such texts; :mod:`coursework.selfstudy.store` keeps them in a file, and a site may keep
them elsewhere.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from datetime import UTC, datetime
from functools import cached_property
from typing import Any

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
    """Return an entry if it is valid.

    Raises
    ------
    ValueError, TypeError, KeyError
        It lacks what every entry has.
    """
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
