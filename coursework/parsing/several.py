"""Several cases among a few, as people tick them: keys, labels, a ticked list, none of them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Any

from coursework.language.words import languages, words
from coursework.parsing.choices import read_choice
from coursework.parsing.reading import Reading, text_of
from coursework.parsing.spelling import shorten, unwrapped

_MOST_PIECES = 40
_MOST = 4000  #: characters of an answer
_TICKED = re.compile(r"^\s*(?:[-*]\s*)?(?:\[\s*([xX✓✗✔*]?)\s*\]|([☑☒✓✔✅])|([☐□⬜]))\s*(.+?)\s*$")
_SEPARATOR = re.compile(r"\s*[,;+&\n|]\s*(?:(?:and|et)\s+)?|\s+(?:and|et|y|und|e)\s+", re.I)


def read_choices(answer: Any, choices: Mapping[str, Sequence[str]]) -> Reading:
    """Return the cases named by an answer; the value is a ``frozenset`` of keys.

    ``a, c``, ``a and c``, labels of any language, lines that begin with ``[x]`` or ``[ ]``, a list, ``none``.
    ``choices`` maps each key to its labels.
    """
    if isinstance(answer, (list, tuple, set, frozenset)):
        items = list(map(text_of, answer))
        items = sorted(items) if isinstance(answer, (set, frozenset)) else items
        answer = "\n".join(items) if items else _none_words()[0]
    text = "" if answer is None else text_of(answer)
    if not text.strip():
        return Reading(text, "missing")
    if len(text) > _MOST:
        return Reading(text, "unreadable", code="too_long", found=shorten(text))
    keys = _keys(_squeezed(unwrapped(text)), choices)
    if isinstance(keys, str):
        return Reading(text, "unreadable", code="not_a_choice", found=shorten(keys))
    order = [key for key in choices if key in keys]
    return Reading(text, "read", (frozenset(keys),), (", ".join(order) or _none_words()[0],))


def _squeezed(text: str) -> str:
    """Return the text without blank lines, and one space for several: patterns would try each of them."""
    lines = (" ".join(line.split()) for line in text.splitlines())
    return "\n".join(line for line in lines if line)


def _keys(text: str, choices: Mapping[str, Sequence[str]]) -> frozenset[str] | str:
    """Return the keys that a text names, or the piece that names none."""
    text = text.strip().strip("[]{}") if "[" not in text.strip()[1:] else text
    if (ticked := _ticked(text)) is not None:
        pieces = ticked
    elif text.strip(" .").casefold() in _none_words():
        return frozenset()
    else:
        return _split(text, choices)
    keys: set[str] = set()
    for piece in pieces:
        piece_keys = _split(piece, choices)
        if isinstance(piece_keys, str):
            return piece_keys
        keys |= piece_keys
    return frozenset(keys)


def _ticked(text: str) -> list[str] | None:
    """Return the ticked lines of a list with boxes; nothing where it is none."""
    lines = [_TICKED.match(line) for line in text.splitlines() if line.strip()]
    if not lines or None in lines:
        return None
    return [line[4] for line in lines if line and (line[1] or line[2])]


@lru_cache(maxsize=1)
def _none_words() -> tuple[str, ...]:
    """Return the words that mean that nothing is ticked, in every language, English first."""
    langs = ("en", *(lang for lang in languages() if lang != "en"))
    return tuple(word.casefold() for lang in langs for word in words(lang)["choices"]["none"])


def _split(text: str, choices: Mapping[str, Sequence[str]]) -> frozenset[str] | str:
    """Return the cases of a text, whose labels may themselves hold commas: the longest piece that is one is
    taken."""
    reading = read_choice(text.strip(" \"'."), choices) if len(text) <= _longest(choices) else None
    if reading is not None and reading.status == "read":
        return frozenset(reading.values)
    ends = [(m.start(), m.end()) for m in _SEPARATOR.finditer(text)][:_MOST_PIECES]
    if not ends and (tokens := text.split()) and set(tokens) <= set(choices):
        return frozenset(tokens)
    keys: set[str] = set()
    start = 0
    for piece, start in _pieces(text, ends, choices):
        if piece is None:
            return text[start:].strip() or text
        keys |= {piece} if piece else set()
    return frozenset(keys) or text  # punctuation alone names no case, and does not say that there is none


def _longest(choices: Mapping[str, Sequence[str]]) -> int:
    """Characters of the longest piece that may name a case, a remark behind it."""
    return 4 * max((len(name) for key, labels in choices.items() for name in (key, *labels)), default=0) + 200


def _pieces(
    text: str, ends: Sequence[tuple[int, int]], choices: Mapping[str, Sequence[str]]
) -> Iterator[tuple[str | None, int]]:
    """Yield the keys of a text from left to right, each with where it starts; None where a piece is no
    case."""
    start, longest = 0, _longest(choices)
    while start < len(text):
        cuts = [(len(text), len(text)), *((a, b) for a, b in reversed(ends) if a >= start)]
        for end, after in cuts:
            piece = text[start:end].strip(" \"'.")
            if len(piece) > longest:
                continue
            reading = read_choice(piece, choices) if piece else None
            if reading is None:
                yield "", start
                start = max(after, start + 1)
                break
            if reading.status == "read":
                yield reading.values[0], start
                start = max(after, start + 1)
                break
        else:
            yield None, start
            return
