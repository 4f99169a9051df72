"""Cases of a choice as people name them: labels, numbers, letters, formulas, a remark behind them."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping, Sequence
from functools import lru_cache
from numbers import Real
from typing import Any

from coursework.language.words import languages, words
from coursework.reading.reading import Reading, Stop, bare_value, reading_of
from coursework.reading.spelling import primes_as_dots, shorten, spelled_out, unwrapped

# --- choices ----------------------------------------------------------------------------

_SIGN = re.compile(r"(^|[=<>(+])\s*[-‐‑‒–—−]\s*(?=[0-9])")
_PLUS = re.compile(r"(^|[=<>(])\s*\+\s*(?=[0-9])")
_ANY_MINUS = re.compile("[-‐‑‒–—−]")


_LOOSE_COMMA = re.compile(r",(?![0-9])|(?<![0-9]),")


@lru_cache(maxsize=4096)
def _folded(text: str) -> str:
    """A label without case, accents, markup and punctuation; a formula without spaces, its signs kept."""
    text = _PLUS.sub(r"\1", _SIGN.sub(r"\1−", text.strip("$ ")))
    if "=" in text:
        text = re.sub(r"[\s_*·{}\\]", "", _ANY_MINUS.sub("−", text))
    text = re.sub(r"\\(?:mathrm|text|mathit|vec|overrightarrow)(?![A-Za-z])|\\[,;! ]", " ", text)
    text = unicodedata.normalize("NFKD", text).casefold()
    text = "".join(" " if c in "-_‐‑–—'’/" else c for c in text if not unicodedata.combining(c))
    text = _LOOSE_COMMA.sub(" ", re.sub(r"[^\w\s+−<>=%°.,]", " ", text))
    return " ".join(text.split()).strip(" .,")


_AFTER_HEAD = re.compile(r"\s*(?:[(,;]|:\s).*", re.DOTALL)


def head(label: str) -> str:
    """A label as people shorten it: ``isostatic`` of "isostatic, all actions can be computed"."""
    return _AFTER_HEAD.sub("", label.replace("\u202f", " "))


def _by_label(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """The choices that are called so: by their key, else by a whole label, else by the head of one."""
    folded = _folded(text)
    if not folded:
        return []
    keys = [key for key in choices if _folded(key) == folded]
    keys = keys or [key for key, labels in choices.items() if any(_is_called(text, s) for s in labels)]
    return keys or [k for k, labels in choices.items() if any(_is_called(text, head(s)) for s in labels)]


def _is_called(text: str, label: str) -> bool:
    """Whether a text is a label; one that is a formula is told from others by its operators too, not by its spaces."""
    if _IN_WORDS.search(_COMMANDS.sub("", label)):
        return _folded(text) == _folded(label)
    if _squeezed(text) != _squeezed(label):
        return False
    written, offered = _operators(text), _operators(label)
    return written in ("", offered) or "/" not in written + offered


_COMMANDS = re.compile(r"\\[A-Za-z]+")
_IN_WORDS = re.compile(r"[^\W\d_]{3,}")


@lru_cache(maxsize=4096)
def _squeezed(formula: str) -> str:
    """A formula without its spaces and bars, Greek letters and dots spelled."""
    return _folded(primes_as_dots(spelled_out(formula.strip("$ "))).replace("*", " ")).replace(" ", "")


@lru_cache(maxsize=4096)
def _operators(formula: str) -> str:
    """The signs of product and quotient of a formula, in order."""
    formula = re.sub(r"\\(?:cdot|times)(?![A-Za-z])|[×·⋅]", "*", formula)
    return re.sub(r"[^*/]", "", formula)


def _by_value(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """The choices of whose formula this is the right-hand side: ``-1`` where ``w = -1`` is offered."""
    value = _folded(f"= {text.strip('()[] ')}").removeprefix("=").strip()
    found = [key for key, labels in choices.items() for s in labels if "=" in s and _value_of(s) == value]
    return list(dict.fromkeys(found)) if value else []


@lru_cache(maxsize=4096)
def _value_of(label: str) -> str:
    return _folded(label).rpartition("=")[2].strip()


_BEFORE = re.compile(
    r"^\s*(?:(?:c['’]est|il|elle|it is|it|un|une|des|le|la|les|an|a|the)\s+|l['’]\s*)(?=\S)", re.I
)  #: what people put before a label, and no label needs


@lru_cache(maxsize=1)
def _numerals() -> Mapping[str, int]:
    """Numbers as labels have them: digits, Roman numerals, words of any language; folded."""
    roman = ("i", "ii", "iii", "iv", "v", "vi", "vii", "viii", "ix", "x")
    found = {str(n): n for n in range(100)} | {name: n for n, name in enumerate(roman, start=1)}
    for lang in languages():
        for n, names in enumerate(words(lang)["study"]["reads"]["numbers"]):
            found |= {_folded(name): n for name in names.split("|")}
    return found


@lru_cache(maxsize=1)
def _nouns() -> tuple[str, ...]:
    """What labels are called together, ``class``; folded, the longest first."""
    found = {_folded(noun) for lang in languages() for noun in words(lang)["choices"]["nouns"]}
    return tuple(sorted(found, key=len, reverse=True))


@lru_cache(maxsize=4096)
def _without_noun(text: str) -> str:
    """A folded label without what all of its kind are called: ``classe III`` is ``iii``, ``rigid joint`` ``rigid``."""
    folded = _folded(text)
    for noun in _nouns():
        if folded.startswith(f"{noun} "):
            return folded[len(noun) + 1 :]
        if folded.endswith(f" {noun}") and len(folded) - len(noun) > _SMALL_WORD:
            return folded[: -len(noun) - 1]
    return folded


_SMALL_WORD = 4  #: letters of a word and its space that say too little alone: ``no joint`` is not ``no``


def _by_core(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """The choices that are called so but for a noun that all of their kind share: ``pivot``."""
    core = _without_noun(text)
    plain = {key: [head(s) for s in labels if not s.startswith("$")] for key, labels in choices.items()}
    return [key for key, heads in plain.items() if core and any(_without_noun(s) == core for s in heads)]


@lru_cache(maxsize=4096)
def _beginnings(label: str) -> frozenset[str]:
    """What a label begins with, two words or more, folded; ``and`` and ``or`` are not left to follow."""
    pieces = [] if "=" in label or label.startswith("$") else label.split()
    ends = (n for n in range(2, len(pieces)) if _folded(pieces[n]) not in _conjunctions())
    return frozenset(_folded(" ".join(pieces[:n])) for n in ends)


@lru_cache(maxsize=1)
def _conjunctions() -> frozenset[str]:
    return frozenset(
        _folded(words(lang)["marking"][joint]) for lang in languages() for joint in ("and", "or")
    )


def _by_beginning(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """The choices whose label begins so: ``double balancier``, ``cas limite``; a word with a hyphen is one."""
    folded = _folded(text)
    if " " not in folded:
        return []
    return [key for key, labels in choices.items() if any(folded in _beginnings(s) for s in labels)]


_REMARK = re.compile(r"(?P<said>[^()]+?)\s*\((?P<remark>[^()]+)\)\s*")


def _by_remark(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """The choices that stand before a remark in brackets which names no other: ``oscille (r2 < r1)``."""
    found = _REMARK.fullmatch(text)
    if found is None:
        return []
    keys = _called(found["said"], choices)
    if len(keys) != 1 or any(key not in keys for key in _called(found["remark"], choices)):
        return []
    remark = f" {_folded(found['remark'])} "
    others = (
        s for key, labels in choices.items() if key not in keys for s in (key, *labels, *map(head, labels))
    )
    return [] if any(f" {_folded(s)} " in remark for s in others if _folded(s)) else keys


@lru_cache(maxsize=4096)
def _numbered(text: str) -> tuple[int | None, str]:
    """The number that a label begins with, and what follows: ``deux paires`` is 2, ``paires``."""
    first, _, rest = _without_noun(text).partition(" ")
    return _numerals().get(first), rest


def _by_number(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """The choice whose label begins with this number, however it is written, where the numbers tell choices apart."""
    number, rest = _numbered(text.strip("()[] "))
    if number is None:
        return []
    found = {}
    for key, labels in choices.items():
        heads = [_numbered(head(label)) for label in labels]
        if numbers := {n for n, _ in heads if n is not None}:
            found[key] = numbers, {follows for n, follows in heads if n == number}
    every = [n for numbers, _ in found.values() for n in numbers]
    if len(found) < 2 or len(set(every)) < len(every):
        return []
    return [key for key, (ns, follows) in found.items() if number in ns and (not rest or rest in follows)]


_MARKED = re.compile(r"[(\[]?\s*(?P<mark>[a-z]|[0-9]{1,2})\s*(?:[)\]:]|\.(?![0-9]))\s*(?P<label>\S.*)", re.I)
_WHOLE = re.compile(r"^\s*([0-9]+)[.,]0+\s*$")  #: what a table makes of a whole number


def _choice(text: str, choices: Mapping[str, Sequence[str]]) -> Reading:
    text = _WHOLE.sub(r"\1", unwrapped(text))
    keys = _by_label(text, choices)
    if not keys and (marked := _MARKED.fullmatch(text.strip())):  # b) crossed
        keys = list(dict.fromkeys((*_called(marked["label"], choices), *_by_number(marked["mark"], choices))))
    keys = keys or _called(text, choices)
    if len(keys) != 1:
        raise Stop("two_values" if keys else "not_a_choice", text)
    return Reading(text, "read", (keys[0],), (keys[0],))


def _called(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """The choices that a text may mean, its article left out if need be; the surest way to call one first."""
    said = _BEFORE.sub("", text)
    for words_said in dict.fromkeys((text, said)):
        keys = _by_label(words_said, choices) or _by_core(words_said, choices)
        keys = keys or list(
            dict.fromkeys((*_by_number(words_said, choices), *_by_value(words_said, choices)))
        )
        if keys:
            return keys
    return _by_beginning(said, choices) or _by_remark(text, choices)


def read_choice(text: Any, choices: Mapping[str, Sequence[str]]) -> Reading:
    """The key of a choice, given by its key, a label of any language, its head or beginning, or the number there.

    ``choices`` maps each key to its labels. A letter or a number never counts places: no sheet prints any.
    """
    text = bare_value(text)
    if isinstance(text, Real) and not isinstance(text, (bool, float)):
        text = str(text)
    if not (text is None or isinstance(text, str)):
        return Reading(str(text), "unreadable", code="not_a_choice", found=shorten(str(text)))
    return reading_of(text, lambda _: _choice(str(text), choices))
