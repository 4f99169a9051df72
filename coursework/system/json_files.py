"""JSON files that are read back: content that our files never hold is refused, with its path in the file."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NoReturn

from coursework.errors import BadInput, reason_of
from coursework.messages import Message

_DIGITS = 300  #: of an integer; a float has no more before its point
_EXCERPT = 40  #: characters of a faulty text in a message


def read_json(path: Path) -> Any:
    """Return the content of a JSON file, as :func:`json_of`.

    Raises
    ------
    BadInput
        It cannot be read, or holds what :func:`json_of` refuses.
    """
    try:
        data = path.read_bytes()
    except OSError as fault:
        raise BadInput("{file} cannot be read: {reason}", file=path, reason=reason_of(fault)) from fault
    return json_of(data, str(path))


def json_of(data: bytes, source: str) -> Any:
    """Return the content of JSON bytes; numbers are finite, and texts hold whole characters and no NUL.

    Raises
    ------
    BadInput
        They are not JSON, are nested too deep, or hold a number or a text that no file of ours does.
    """
    try:
        text = data.decode("utf-8-sig")
        value = json.loads(text, parse_int=_integer, parse_float=_decimal, parse_constant=_constant)
    except RecursionError as fault:
        raise BadInput("{source} cannot be read: its JSON is nested too deep", source=source) from fault
    except ValueError as fault:
        raise BadInput("{source} is not JSON: {problem}", source=source, problem=str(fault)[:100]) from fault
    if "\\u0000" in text or "\\ud" in text.casefold():
        _check_texts(value, source)
    return value


def _integer(digits: str) -> int:
    if len(digits) > _DIGITS:
        _refuse(digits, f"of {len(digits)} digits")
    return int(digits)


def _decimal(digits: str) -> float:
    value = float(digits)
    if not math.isfinite(value):
        _refuse(digits, "too great")
    return value


def _constant(name: str) -> NoReturn:
    _refuse(name, "that is none")


def _refuse(written: str, problem: str) -> NoReturn:
    raise ValueError(f"a number {problem}, {written[:_EXCERPT]}{'…' if len(written) > _EXCERPT else ''}")


def _check_texts(value: Any, source: str) -> None:
    for path, text in _texts(value, ""):
        if "\0" in text or (not text.isprintable() and any("\ud800" <= c <= "\udfff" for c in text)):
            problem = Message("a NUL") if "\0" in text else Message("half a character")
            raise BadInput(
                "{source}: {place} holds {problem}: {text!r}",
                source=source,
                place=path.lstrip(".") or Message("a text"),
                problem=problem,
                text=text[:_EXCERPT],
            )


def _texts(content: Any, path: str) -> Iterator[tuple[str, str]]:
    """Yield every text with its path."""
    if isinstance(content, str):
        yield path, content
    elif isinstance(content, dict):
        for key, value in content.items():
            yield path, key
            yield from _texts(value, f"{path}.{ascii(key[:_EXCERPT])[1:-1]}")
    elif isinstance(content, list):
        for number, value in enumerate(content):
            yield from _texts(value, f"{path}[{number}]")
