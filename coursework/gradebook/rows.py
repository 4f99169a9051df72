"""Rows of submissions, and rejected rows."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from coursework.issuing.identity import Ids
from coursework.messages import Message
from coursework.system.tables import decode

#: Titles of the columns of answers, which a file may have in any language.
TITLES = {
    "student": Message("student"),
    "exercise": Message("exercise"),
    "seed": Message("seed"),
    "part": Message("part"),
    "answer": Message("answer"),
}


class RowOrigin(NamedTuple):
    """Statements of a platform about the sheet of an answer."""

    ids: Ids = ()  #: of the student: e-mail, number
    by: tuple[str, ...] = ()  #: who handed it in, as folders and files name them
    sitting: int = 0  #: attempt of the student; 0 if unknown
    submitted: str = ""  #: when, as the platform writes it
    version: str = ""  #: of the exercise
    apart: bool = False  #: the platform asks part by part, each of a variant of its own


class PlatformFile(NamedTuple):
    """File or tree of files that a platform wrote."""

    source: str
    what: str
    is_tree: bool = False  #: counted for each file


class AnswerRow(NamedTuple):
    """One answer as received."""

    student: str
    exercise: str
    seed: str
    part: str  #: empty if no part has an answer
    answer: Any  #: a text, a number, or None
    source: str  #: file and place, for reports
    warning: str = ""
    lang: str = ""  #: of the sheet with the answer, if it is stated
    origin: RowOrigin | None = None  #: where a platform collected it


#: English place of an answer in a file. A file of a million rows states one in each: as a message each would
#: cost more.
_PLACE = re.compile(r"(?P<file>.*?), (?P<unit>line|row|item) (?P<number>\d+)(?P<rest>(?:, .*)?)", re.DOTALL)
_UNITS = {"line": "{file}, line {line}", "row": "{file}, row {line}", "item": "{file}, item {line}"}


@dataclass(frozen=True)
class Rejected:
    """Row or file that cannot be marked, with the reason."""

    source: str
    reason: str
    row: dict[str, str] = field(default_factory=dict)

    @property
    def place(self) -> str:
        """``source`` as a message that can be translated."""
        found = None if isinstance(self.source, Message) else _PLACE.fullmatch(self.source)
        if found is None:
            return self.source
        place = Message(_UNITS[found["unit"]], file=found["file"], line=found["number"])
        return Message("{place}{rest}", place=place, rest=found["rest"]) if found["rest"] else place


def path_text(path: Path) -> str:
    """Return a path as tables can contain it: a byte that is not UTF-8 is written ``\\xe9``."""
    return os.fsencode(path).decode("utf-8", "backslashreplace")


def decoded_text(data: bytes, source: str) -> tuple[str, str]:
    """Return the text, and a warning that names its file."""
    text, warning = decode(data)
    return text, Message("{place}: {note}", place=source, note=warning) if warning else ""


def _storable_text(text: str) -> str:
    """Return the text without lone surrogates and NUL, which no file or database can store."""
    return text.encode("utf-8", "replace").decode("utf-8").replace("\0", "\ufffd")


_QUOTED = 200  #: characters of what is rejected


def quoted(text: str) -> str:
    """Return the beginning of a text that could not be read, as a table can contain it."""
    return _storable_text(text.strip()[:_QUOTED])


class _DictWithRepeats(dict):
    """JSON object, with the pairs that repeat a key, and the texts found where nothing is read, with a
    reason."""

    repeats: tuple[tuple[Any, Any], ...] = ()
    unread: tuple[tuple[Any, str, str], ...] = ()


def load_json(text: str) -> Any:
    """Return parsed JSON whose objects keep repeated keys; numbers of absurd length remain texts."""
    return json.loads(text, object_pairs_hook=object_once, parse_int=_integer_or_text)


def _integer_or_text(digits: str) -> Any:
    return int(digits) if len(digits) < 400 else digits


def object_once(pairs: list[tuple[Any, Any]]) -> dict[Any, Any]:
    first: dict[Any, Any] = {}
    repeats = []
    for key, value in pairs:
        if key in first:
            repeats.append((key, value))
        else:
            first[key] = value
    if not repeats:
        return first
    merged = _DictWithRepeats(first)
    merged.repeats = tuple(repeats)
    return merged


def with_unread(
    pairs: dict[Any, Any], unread: list[tuple[Any, str, str]], instead: Collection[Any]
) -> dict[Any, Any]:
    """Return the answers without the keys ``instead``, for which texts were found where nothing is read: key,
    text, reason."""
    merged = _DictWithRepeats({key: value for key, value in pairs.items() if key not in instead})
    merged.repeats, merged.unread = getattr(pairs, "repeats", ()), tuple(unread)
    return merged


def sheet_rows(
    about: dict[str, Any], answers: dict[Any, Any], location: str, warning: str
) -> Iterator[AnswerRow | Rejected]:
    names = {c: name_in(about.get(c)) for c in ("student", "exercise", "seed")}
    if not answers and not getattr(answers, "unread", ()):
        yield Rejected(location, Message("the sheet contains no answer"), {**names, "part": "", "answer": ""})
    for key, text, why in getattr(answers, "unread", ()):
        row = {**names, "part": name_in(key), "answer": quoted(text)}
        where = f"{location}, part {name_in(key)[:40]}" if key else location
        yield Rejected(where, why, row)
    for key, value in [*answers.items(), *getattr(answers, "repeats", ())]:
        part, answer = name_in(key), as_answer(value)
        where = f"{location}, part {part[:40]}"
        if isinstance(answer, (dict, set, bytes)):
            row = {**names, "part": part, "answer": quoted(_text_of(answer))}
            yield Rejected(where, Message("an answer is a text or a number"), row)
            continue
        lang = name_in(about.get("lang"))
        yield AnswerRow(
            names["student"], names["exercise"], names["seed"], part, answer, where, warning, lang
        )


def as_answer(answer: Any) -> Any:
    """Return an answer as it is marked: coordinates joined, and numbers with too many digits as texts."""
    if isinstance(answer, (list, tuple)):
        return "; ".join(_text_of(a) for a in answer)
    if isinstance(answer, str):
        return _storable_text(answer)
    if isinstance(answer, int) and not isinstance(answer, bool) and abs(answer) >= 10**400:
        return _text_of(answer)
    return answer


def _text_of(value: Any) -> str:
    try:
        return _storable_text(str(value))
    except ValueError:  # an integer of too many digits
        return "a number of very many digits"


def joined_by_and(items: Iterable[object]) -> Message:
    """Return ``5 and 7``."""
    first, *others = items
    joined = Message("{item}", item=first)
    for item in others:
        joined = Message("{first} and {second}", first=joined, second=item)
    return joined


def name_in(value: Any) -> str:
    return "" if value is None else _text_of(value).strip()


def short_fault(fault: BaseException) -> str:
    return str(fault).split("\n")[0][:120]
