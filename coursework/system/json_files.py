"""JSON that is read back: what a file of ours never holds is refused, with its place."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NoReturn

from coursework.errors import BadInput

_DIGITS = 300  #: of a whole number; a float has no more before its point
_SHOWN = 40  #: characters of what was found


def read_json(path: Path) -> Any:
    """What a file of JSON holds, as :func:`json_of`.

    Raises
    ------
    BadInput
        It cannot be read, or holds what :func:`json_of` refuses.
    """
    try:
        data = path.read_bytes()
    except OSError as fault:
        raise BadInput(f"{path} cannot be read: {fault.strerror}") from fault
    return json_of(data, str(path))


def json_of(data: bytes, source: str) -> Any:
    """What some bytes of JSON hold; numbers are finite and texts whole characters without NUL.

    Raises
    ------
    BadInput
        They are no JSON, are nested too deep, or hold a number or a text that no file of ours does.
    """
    try:
        text = data.decode("utf-8-sig")
        found = json.loads(text, parse_int=_whole, parse_float=_decimal, parse_constant=_constant)
    except RecursionError as fault:
        raise BadInput(f"{source} is not JSON that can be read: it is nested too deep") from fault
    except ValueError as fault:
        raise BadInput(f"{source} is not JSON: {str(fault)[:100]}") from fault
    if "\\u0000" in text or "\\ud" in text.casefold():
        _check_texts(found, source)
    return found


def _whole(digits: str) -> int:
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


def _refuse(written: str, what: str) -> NoReturn:
    raise ValueError(f"a number {what}, {written[:_SHOWN]}{'…' if len(written) > _SHOWN else ''}")


def _check_texts(found: Any, source: str) -> None:
    for place, text in _texts(found, ""):
        if "\0" in text or (not text.isprintable() and any("\ud800" <= c <= "\udfff" for c in text)):
            what = "a NUL" if "\0" in text else "half a character"
            raise BadInput(f"{source}: {place.lstrip('.') or 'a text'} holds {what}: {text[:_SHOWN]!r}")


def _texts(found: Any, place: str) -> Iterator[tuple[str, str]]:
    """Every text, with its place."""
    if isinstance(found, str):
        yield place, found
    elif isinstance(found, dict):
        for key, value in found.items():
            yield place, key
            yield from _texts(value, f"{place}.{ascii(key[:_SHOWN])[1:-1]}")
    elif isinstance(found, list):
        for number, value in enumerate(found):
            yield from _texts(value, f"{place}[{number}]")
