"""The words that an expression may use: functions, constants, variables, and how each is spelled."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Callable, Mapping
from functools import lru_cache

import numpy as np

from coursework.errors import CourseworkError
from coursework.parsing.spelling import MAX_FOUND, shorten

MAX_LENGTH = 500

Value = float | complex | np.ndarray


class Unreadable(CourseworkError, ValueError):
    """A text that is not a number, formula or equation we can read.

    ``code`` is a short key for the reason, ``found`` the piece that stops the reading.
    """

    def __init__(self, message: str, *, code: str, piece: str = "") -> None:
        super().__init__(message)
        self.code = code
        self.found = shorten(piece)


# --- vocabulary -------------------------------------------------------------------------


def _atan2(y: Value, x: Value) -> Value:
    """Return the angle of a point of the plane; there is none for complex coordinates."""
    if np.iscomplexobj(y) or np.iscomplexobj(x):
        return np.real(y + x) * math.nan
    return np.arctan2(y, x)


FUNCTIONS: Mapping[str, Callable] = {
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "cot": lambda x: 1 / np.tan(x),
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "atan2": _atan2,
    "sqrt": np.sqrt,
    "exp": np.exp,
    "abs": np.abs,
    "ln": np.log,
}
_ALIASES = {
    "arcsin": "asin",
    "arccos": "acos",
    "arctan": "atan",
    "arctan2": "atan2",
    "tg": "tan",
    "arctg": "atan",
    "cotan": "cot",
    "cotg": "cot",
    "ctg": "cot",
}
INVERSE = ("asin", "acos", "atan", "atan2")
_DEGREE_WORDS = ("deg", "degree", "degrees", "degré", "degrés")


_VARIANT = re.compile(r"var(?=phi|theta|epsilon|rho|sigma|kappa)")


def _key(name: str) -> str:
    """Return the common form of all spellings of one name: no underscore, the dots of a derivative last, one
    ``phi``."""
    name = _VARIANT.sub("", name.replace("_", ""), count=1).replace("point", "dot").replace("dotdot", "ddot")
    for dots in ("ddot", "dot"):
        if dots in name and name != dots:
            return name.replace(dots, "", 1) + dots
    return name


_RATE = re.compile(r"theta(\w*?)(d?dot)")
_LETTERS = {"w": "omega", "teta": "theta"}  #: what is typed for a Greek letter
_MISSPELLED = re.compile(rf"^(?:{'|'.join(_LETTERS)})(?=d?dot|[^a-z]|$)")


class Vocabulary:
    """The names that may occur, by any spelling."""

    def __init__(self, variables: tuple[str, ...]) -> None:
        self.variables = {_key(v): v for v in variables}
        self.complex = bool(variables)
        folded = Counter(key.casefold() for key in self.variables)
        #: names that nothing else is like but for capitals; a letter alone has its case for meaning
        self.any_capitals = {
            key.casefold(): v
            for key, v in self.variables.items()
            if len(key) > 1 and folded[key.casefold()] == 1
        }

    def variable(self, run: str) -> str | None:
        """Return the variable of a spelling: its own, that of a rate by its dots, ``theta2_dot`` for
        ``omega2``, or in other capitals."""
        key = _key(run)
        if (name := self.variables.get(key)) is not None:
            return name
        if (rate := _RATE.fullmatch(key)) is not None:
            return self.variables.get({"dot": "omega", "ddot": "alpha"}[rate[2]] + rate[1])
        if (misspelled := _MISSPELLED.sub(lambda found: _LETTERS[found[0]], key)) != key:
            return self.variable(misspelled)
        return self.any_capitals.get(key.casefold())

    def find(self, run: str) -> tuple[str, str] | None:
        """Kind and canonical name of one complete spelling."""
        if self.complex and (name := self.variable(run)) is not None:
            return "variable", name
        low = run.lower()
        low = _ALIASES.get(low, low)
        if low in FUNCTIONS:
            return "function", low
        if low == "pi":
            return "constant", "pi"
        if run == "e":
            return "constant", "e"
        if run in ("i", "j") and self.complex:
            return "constant", "i"
        return ("degree", "deg") if low in _DEGREE_WORDS else None

    def first(self, run: str) -> tuple[int, str, str] | None:
        """Return the first name of a run of letters such as ``r2cos``: its length, kind and canonical
        name."""
        dead: set[int] = set()

        def fits(start: int) -> bool:
            return start == len(run) or (start not in dead and piece(start) is not None)

        def piece(start: int) -> tuple[int, str, str] | None:
            for end in range(len(run), start, -1):
                name = self.find(run[start:end])
                if name is None or (run[start:end] == "e" and len(run) > 1):
                    continue
                rest = end
                while rest < len(run) and name[0] == "function" and run[rest].isdigit():
                    rest += 1  # cos2theta: the digits belong to the argument
                if rest < len(run) and run[rest] == "_":
                    continue
                if rest < len(run) and run[rest].isdigit():
                    continue
                if fits(rest):
                    return end - start, *name
            dead.add(start)
            return None

        return piece(0) if len(run) <= MAX_FOUND else None


@lru_cache(maxsize=64)
def vocabulary_of(variables: tuple[str, ...]) -> Vocabulary:
    return Vocabulary(variables)
