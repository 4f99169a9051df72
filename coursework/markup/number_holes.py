"""Cache of printed formulas with holes in place of their numbers.

The formulas of a class differ in their numbers alone. Each formula is printed once with holes; a student's
numbers are then filled in.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import lru_cache, wraps

from coursework.errors import BadStatement
from coursework.language.numbers import localise

#: Characters that stand for the digits of a number, the first for the first; they mean nothing else to
#: Unicode.
FIRST_HOLE, LAST_HOLE = "\ue000", "\uf8ff"
_MOST = ord(LAST_HOLE) - ord(FIRST_HOLE)

#: An exponent is not a number of a student's.
_DIGITS = re.compile(r"(?<!\^\{)(\\num\{[+-]?)(\d+(?:\.\d+)?)(?=(?:[eE][+-]?\d+)?\})")
_HOLE = re.compile(f"([{FIRST_HOLE}-{LAST_HOLE}])")
_SAMPLES = ("12.5", "1")

Turn = Callable[[str, str], str]


def once_for_all_numbers(turn: Turn) -> Turn:
    """Return a cached version of a formula printer, which parses a formula once for all its numbers.

    Where ``turn`` makes more of a number's digits than to print them (small ones of an index, say), it is
    called for each formula.
    """

    @lru_cache(maxsize=4096)
    def pieces(holed: str, lang: str) -> tuple[str, ...] | None:
        """Return text and holes in turn; nothing where a hole does not stand for what would be printed."""
        count = len(_HOLE.findall(holed))
        try:
            cut = tuple(_HOLE.split(turn(holed, lang)))
            for sample in _SAMPLES:
                if _filled(cut, [localise(sample, lang)] * count) != turn(_HOLE.sub(sample, holed), lang):
                    return None
        except BadStatement:
            return None  # said of the formula as it is written
        return cut

    turned = lru_cache(maxsize=4096)(turn)

    @wraps(turn)
    def of(tex: str, lang: str) -> str:
        holed, numbers = _holed(tex, lang)
        cut = pieces(holed, lang) if 0 < len(numbers) < _MOST else None
        return turned(tex, lang) if cut is None else _filled(cut, numbers)

    return of


@lru_cache(maxsize=1024)
def _holed(tex: str, lang: str) -> tuple[str, tuple[str, ...]]:
    """Return a formula with holes, and the numbers of the holes as the language prints them."""
    parts = _DIGITS.split(tex)  # text, what opens a number and its digits, in turn
    numbers = tuple(localise(digits, lang) for digits in parts[2::3])
    parts[2::3] = (chr(ord(FIRST_HOLE) + at) for at in range(len(numbers)))
    return "".join(parts), numbers


def _filled(cut: tuple[str, ...], numbers: Sequence[str]) -> str:
    parts = list(cut)
    parts[1::2] = [numbers[ord(hole) - ord(FIRST_HOLE)] for hole in cut[1::2]]
    return "".join(parts)
