"""Words of a session: errors in its language, and answers in words of any language of the engine."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from functools import cache
from numbers import Integral
from typing import Any

from coursework.errors import BadInput, UnknownName, bare_letters, closest
from coursework.language.words import languages, words
from coursework.parsing.numbers import read_number

_DASHES = str.maketrans("−–—‐‑", "-----")
_ROMAN = {"i": 1, "ii": 2, "iii": 3, "iv": 4}
_ORDINAL = re.compile(r"([1-4])(?:e|eme|er|ere|re|nd|nde|d|st|rd|th)")
_UNITS = ("deg", "mm", "rad/s", "rad/s^2", "mm/s", "mm/s^2", "N", "N*m", "mm^2", "1")


def unwrapped(value: Any) -> Any:
    """Return a value as plain Python: numpy numbers as numbers, arrays as lists, anything else as its
    text."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [unwrapped(item) for item in value]
    return value if value is None or isinstance(value, (str, int, float)) else str(value)


def folded(text: Any) -> str:
    """Return a text without case, accents and closing punctuation."""
    bare = bare_letters(str(text).translate(_DASHES))
    return " ".join(bare.strip(" .!,;").split())


@cache
def _spellings(category: str) -> frozenset[str]:
    return frozenset(folded(w) for lang in languages() for w in words(lang)["study"]["reads"][category])


def _one_of(text: str, kinds: tuple[str, ...]) -> str:
    return next((kind for kind in kinds if text in _spellings(kind)), "")


def sign(text: Any) -> str:
    """Return ``+`` or ``-``; empty where neither or both are stated."""
    wording = folded(text)
    if match := re.fullmatch(r"([+-])\s*(?:[\d.,]*|\([^()]*\))|([<>])\s*0", wording):
        return match[1] or {">": "+", "<": "-"}[match[2]]
    return {"positive": "+", "negative": "-"}.get(_one_of(wording, ("positive", "negative")), "")


def comparison(text: Any) -> str:
    """Return ``>``, ``<`` or ``=``; empty where none is stated."""
    wording = folded(text)
    if match := re.fullmatch(r"([<>=])[^<>=]*", wording):
        return match[1]
    wording = re.split(r" (?:que|qu'|than|to|a) ?", wording, maxsplit=1)[0]
    return {"larger": ">", "smaller": "<", "equal": "="}.get(
        _one_of(wording, ("larger", "smaller", "equal")), ""
    )


def quadrant(text: Any) -> int | None:
    """Return 1 to 4 from a digit, a Roman numeral or an ordinal, in figures or words."""
    wording = re.sub(
        r"\b(?:quadrant|le|la|l'|dans|in|the|q|n°)(?![a-z])|(?<=\bq)(?=[1-4]$)|^q(?=[1-4]$)",
        " ",
        folded(text),
    )
    wording = wording.strip()
    if match := _ORDINAL.fullmatch(wording):
        return int(match[1])
    if wording in _ROMAN:
        return _ROMAN[wording]
    number = next(
        (
            n
            for n, kind in enumerate(("first", "second", "third", "fourth"), 1)
            if wording in _spellings(kind)
        ),
        None,
    )
    number = count(wording) if number is None else number
    return number if number in (1, 2, 3, 4) else None


def count(text: Any) -> int | None:
    """Return a whole number from 0 on, in figures or words, with or without ``times``."""
    wording = folded(text)
    for times in sorted(_spellings("times"), key=len, reverse=True):
        wording = wording.removesuffix(f" {times}")
    if re.fullmatch(r"\+?\d{1,6}(?:[.,]0*)?", wording):
        return int(float(wording.replace(",", ".")))
    for lang in languages():
        table = words(lang)["study"]["reads"]
        for names in (table["numbers"], table["often"]):
            groups = [[folded(w) for w in group.split("|")] for group in names]
            if results := [n for n, group in enumerate(groups) if wording in group]:
                return results[0]
    return None


def truth(text: Any) -> bool | None:
    """Return True for a yes, False for a no, None for neither."""
    if isinstance(text, bool):
        return text
    return {"yes": True, "no": False}.get(_one_of(folded(text), ("yes", "no")))


def numbers(text: Any) -> tuple[tuple[float, ...], bool]:
    """Return the possible readings of a number, with or without a unit, in the course's unit; and whether it
    is in degrees."""
    if isinstance(text, str):
        if (full := count(text)) is not None:
            return (float(full),), False
        text = without_about(text)
    for unit in _UNITS:
        reading = read_number(text, unit)
        if reading.status == "read":
            return tuple(reading.values), unit == "deg" and reading.unit_given
    return (), False


def without_about(text: Any) -> Any:
    """Return an angle or a number without a word for "about"."""
    return (
        re.sub(r"^\s*(?:vers|autour de|towards|near|around)\b", "", text, flags=re.I)
        if isinstance(text, str)
        else text
    )


def expect(lang: str, kind: str, name: object, names: Collection[str]) -> None:
    """Refuse a name that is not one of the known ones.

    ``kind`` says of what: ``exercise``, ``question``, ``prediction``, ``curve`` or ``effect``.

    Raises
    ------
    UnknownName
        The name is none of them; the message has the nearest, or all.
    """
    if not (isinstance(name, str) and name in names):
        raise stranger(lang, kind, name, names)


def stranger(lang: str, kind: str, name: object, names: Collection[str]) -> UnknownName:
    """Return the error for a name that is none of the known ones."""
    texts = words(lang)["study"]["refused"]
    return UnknownName(f"{texts[kind].format(name=name)} {would_do(lang, str(name), names)}")


def would_do(lang: str, name: str, names: Collection[str]) -> str:
    """Return the nearest known name, or all."""
    texts = words(lang)["study"]["refused"]
    near = closest(name, names)
    if near is not None:
        return texts["near"].format(name=near)
    return texts["known"].format(names=", ".join(names)) if names else texts["none"]


class UnknownMethod(UnknownName, AttributeError):
    """Method that a session does not have."""


def no_method(lang: str, name: str, names: Collection[str]) -> UnknownMethod:
    """Return the error for an unknown method."""
    texts = words(lang)["study"]["refused"]["method"].format(name=name)
    return UnknownMethod(f"{texts} {would_do(lang, name, names)}")


def by_name(lang: str, call: str, text: object) -> Mapping[str, Any]:
    """Return the argument of a call as a dictionary by name.

    Raises
    ------
    BadInput
        It is not a dictionary.
    """
    if not isinstance(text, Mapping):
        raise refused(lang, "mapping", call=call, found=f"{text!r:.60}")
    return text


def counted(lang: str, why: str, text: object, most: int | None = None) -> int:
    """Return a whole number from 1 to ``most``.

    Raises
    ------
    BadInput
        Anything else.
    """
    if isinstance(text, bool) or not isinstance(text, Integral) or text < 1 or (most and int(text) > most):
        raise refused(lang, why, found=repr(text), most=most)
    return int(text)


def refused(lang: str, why: str, **text: object) -> BadInput:
    """Return the error for another invalid argument."""
    return BadInput(words(lang)["study"]["refused"][why].format(**text))
