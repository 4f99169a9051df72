"""Result of reading an answer, and the exception that stops a reading."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from numbers import Rational, Real
from typing import Any

import numpy as np

from coursework.parsing.spelling import as_typed, plain_spelling, shorten, unwrapped
from coursework.parsing.vocabulary import MAX_LENGTH, Unreadable


@dataclass(frozen=True)
class Reading:
    """Value, unit and notes that were read in one answer.

    ``status``: ``read``, ``missing``, ``unreadable``, ``wrong_unit``, or ``to_mark`` for one that a person
    reads from its picture. ``values``: one or two honest
    readings in the canonical unit (floats; integers; tuples of floats for a point; a key for a choice; an
    :class:`~coursework.parsing.equations.Equation`), empty unless read. ``read_as``: one echo a value, with a
    decimal point and the unit as written. When it is not read, ``code`` is a short key for the reason and
    ``found`` the piece that stops the reading.
    """

    text: str
    status: str
    values: tuple = ()
    read_as: tuple[str, ...] = ()
    unit_given: bool = False
    code: str = ""
    found: str = ""

    @staticmethod
    def plain(text: str, value: float, digits: str) -> Reading:
        """Return a number in plain digits: most of what comes back, made without the checks of a frozen
        class."""
        reading = Reading.__new__(Reading)
        reading.__dict__.update(
            text=text, status="read", values=(value,), read_as=(digits,), unit_given=False, code="", found=""
        )
        return reading


class Stop(Exception):
    """Why a text is not read."""

    def __init__(self, code: str, piece: str, status: str = "unreadable") -> None:
        super().__init__(code)
        self.code, self.found, self.status = code, piece, status


def text_of(answer: object) -> str:
    """Return an answer as a text; a whole number too long to be written out, by its power of ten."""
    try:
        return str(answer)
    except ValueError:  # Python writes no integer of thousands of digits
        if not isinstance(answer, Rational):
            return type(answer).__name__
    if not isinstance(answer, int):
        return f"{text_of(answer.numerator)}/{text_of(answer.denominator)}"
    exponent = int(math.log10(abs(answer)))
    return f"{'-' if answer < 0 else ''}{abs(answer) // 10 ** (exponent - 6) / 1e6:g}e{exponent}"


def bare_value(answer: Any) -> Any:
    """Return the single number of an array or a list of one, as Python's own number; return any other value
    as it is."""
    if answer.__class__ is str:
        return answer
    for _ in range(_MAX_NESTING):
        if isinstance(answer, (np.ndarray, np.generic)) and answer.size <= _MAX_ITEMS:
            answer = answer.tolist()
        if not isinstance(answer, (list, tuple)) or len(answer) != 1:
            break
        (answer,) = answer
    return answer


#: Of a direction, beyond which it is not an answer: modulo a turn any huge number is near any other.
MOST_TURNS = 100
_MAX_ITEMS, _MAX_NESTING = 100, 4  #: of an array that is looked into


def reading_of(answer: object, read: Callable[[str], Reading]) -> Reading:
    """Return the reading of an answer; for all kinds: what is missing, what is too long, what stops on the
    way."""
    answer = bare_value(answer)
    if answer is None:
        return Reading("", "missing")
    text = answer if isinstance(answer, str) else text_of(answer)
    if isinstance(answer, bool) or not isinstance(answer, (str, Real)):
        return Reading(text, "unreadable", code="not_a_number", found=shorten(text))
    if len(text) > MAX_LENGTH and len(text.strip()) > MAX_LENGTH:
        return Reading(text, "unreadable", code="too_long", found=shorten(text))
    try:
        plain = plain_spelling(unwrapped(text))
        return read(plain) if plain else Reading(text, "missing")
    except Stop as stop:
        piece = as_typed(stop.found or plain, text)
        return Reading(text, stop.status, code=stop.code, found=shorten(piece))
    except Unreadable as error:
        return Reading(text, "unreadable", code=error.code, found=shorten(as_typed(error.found, text)))
