"""Answers that a program gives: whatever they are, only plain values are looked into.

What a call hands over may be anything of Python's, also what raises where it is printed, compared or counted.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np

MOST_NESTED = 16  #: lists within lists
MOST_ITEMS = 10_000  #: of a list with all that it holds

_PLAIN = frozenset((str, int, float, complex, bool, type(None), Fraction))
_BASES: tuple[Any, ...] = (str, int, float, complex)
_SAME: Mapping[type, Any] = {
    str: str.__str__,
    int: int.__pos__,
    float: float.__pos__,
    complex: complex.__pos__,
}
_SERIES = (list, tuple, set, frozenset)


class Strange:
    """Value that is not an answer, printed as the name of its type."""

    def __init__(self, answer: object) -> None:
        self._name = str(type(answer).__name__)

    def __repr__(self) -> str:
        return self._name


def plain_answer(answer: Any) -> Any:
    """Return the answer, of Python's own types alone: numbers, texts, and lists, sets and mappings of them;
    of NumPy's values, Python's. Anything else is :class:`Strange`, and so is what is nested or filled beyond
    all measure.
    """
    if type(answer) in _PLAIN:
        return answer  # nearly all of them
    try:
        return _plain(answer, [MOST_ITEMS], MOST_NESTED)
    except Exception:  # a class of somebody's may raise anything
        return Strange(answer)


def _plain(value: Any, left: list[int], nesting: int) -> Any:
    left[0] -= 1
    if left[0] < 0 or nesting < 0:
        raise OverflowError
    if type(value) in _PLAIN:
        return value
    if isinstance(value, (np.ndarray, np.generic)):
        return _of_numpy(value, left, nesting)
    if isinstance(value, Decimal):
        return Decimal.__str__(value)  # its digits as they stand
    if isinstance(value, Mapping):
        keys = _each(value, left, nesting)
        return dict(zip(keys, _each((value[key] for key in value), left, nesting), strict=True))
    base = next((base for base in _BASES if isinstance(value, base)), None)
    if base is not None:
        return _SAME[base](value)
    series = next((series for series in _SERIES if isinstance(value, series)), None)
    return Strange(value) if series is None else series(_each(value, left, nesting))


def _of_numpy(value: Any, left: list[int], nesting: int) -> Any:
    if value.size > left[0]:
        raise OverflowError
    plain = value.tolist()
    if isinstance(plain, np.floating):  # longer than Python's
        return float(plain)
    return Strange(value) if isinstance(plain, np.generic) else _plain(plain, left, nesting)


def _each(values: Iterable[Any], left: list[int], nesting: int) -> list[Any]:
    return [_plain(value, left, nesting - 1) for value in values]
