"""Cases of a choice as people name them: by the letter that the sheet prints, by place, in words, ticked
among others."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import lru_cache
from numbers import Real
from types import MappingProxyType
from typing import Any

from coursework.language.words import languages, words
from coursework.parsing.labels import by_label, counts, in_words, is_verbatim, names_any, numbers_of
from coursework.parsing.reading import Reading, Stop, bare_value, reading_of, text_of
from coursework.parsing.spelling import shorten, unwrapped

Choices = Mapping[str, Sequence[str]]  #: labels by key
Letters = Mapping[str, str]  #: letters by key, in the order printed

_ASKS = re.compile(r"[?\uff1f]")  #: who asks, ``hinge?``, has not answered: a person looks
_WHOLE = re.compile(r"^\s*([0-9]+)[.,]0+\s*$")  #: what a table makes of a whole number


def read_choice(text: Any, choices: Choices, letters: Letters = MappingProxyType({})) -> Reading:
    """Return the key of a choice, given by its key, a label of any language, its head or beginning, or the
    number there.

    ``choices`` maps each key to its labels, ``letters`` to the letter that the sheet printed, in the order
    printed: then the letter, the place and a ticked one among others are read too, and what says two things
    is not read. Without letters none is read, and no number counts places: the sheet printed none.
    """
    text = bare_value(text)
    if isinstance(text, Real) and not isinstance(text, (bool, float)):
        text = text_of(text)
    if not (text is None or isinstance(text, str)):
        text_read = text_of(text)
        return Reading(text_read, "unreadable", code="not_a_choice", found=shorten(text_read))
    return reading_of(text, lambda _: _choice(str(text), choices, letters))


def _choice(text: str, choices: Choices, letters: Letters) -> Reading:
    text = _WHOLE.sub(r"\1", unwrapped(text))
    if _ASKS.search(text):
        raise Stop("not_a_choice", text)
    keys = _on_lettered(text, choices, letters) if letters else in_words(text, choices)
    if len(keys) != 1:
        raise Stop("two_values" if keys else "not_a_choice", text)
    return Reading(text, "read", (keys[0],), (keys[0],))


# --- letters ----------------------------------------------------------------------------

_ALONE = re.compile(r"[(\[]?\s*(?P<letter>[a-z])\s*[)\].:;,]*", re.I)
#: A letter, and words behind it: ``b) oscillates``, ``b: oscillates``, ``b (oscillates)``, ``b oscillates``.
_BEFORE = re.compile(
    r"(?P<bracket>[(\[])?\s*(?P<letter>[a-z])\s*"
    r"(?:(?P<mark>[)\].:,;=\u2013\u2014-])\s*[:\u2013\u2014-]?|(?<=\s)|(?=\())\s*(?P<said>\S.*)",
    re.I | re.S,
)
#: Words, and a letter behind them: ``oscillates (b)``, ``oscillates, b``.
_BEHIND = re.compile(
    r"(?P<said>.*?\S)\s*(?:[(\[]\s*(?P<inner>[a-z])\s*[)\]]|[,"
    r":;\u2013\u2014-]\s*(?P<bare>[a-z])\s*\)?)\s*\.?",
    re.I | re.S,
)
_IN_BRACKETS_ANYWHERE = re.compile(r"[(\[]([^()\[\]]{1,80})[)\]]")
_LETTER_IN_REMARK = re.compile(
    r"([a-z])|[^<>=+*/]*[\s'’]([a-z])\W*|([a-z])\s+(?:is|was|est|était|n['’]est|non|not|aussi|too|also)\b.*",
    re.I | re.S,
)
_IN_BRACKETS = re.compile(r"\(([^()]+)\)\s*\.?")
#: A formula, ``f(x)``, ``f(theta)``: no letter and its remark.
_CALL = re.compile(r"[a-z]\(\s*\w{1,6}\s*\)\s*\.?", re.I)


def _on_lettered(text: str, choices: Choices, letters: Letters) -> list[str]:
    """Return the choices that a text may mean on a sheet that prints letters, all that it says taken
    together."""
    text = _without_answer(_ticked(text))
    keys = _said_with_letters(text, choices, letters)
    if not keys or is_verbatim(text, choices):
        return keys
    remarks = _IN_BRACKETS_ANYWHERE.findall(text)
    return _together(
        keys, *(_of_letter(letter, letters) for r in remarks for letter in _letters_of_remark(r))
    )


def _letters_of_remark(remark: str) -> list[str]:
    """Return the letters that a remark in brackets speaks of: alone, at its end, ``not c``, or as its
    subject, ``c is wrong``."""
    match = _LETTER_IN_REMARK.fullmatch(remark.strip())
    return [letter for letter in match.groups() if letter] if match else []


def _said_with_letters(text: str, choices: Choices, letters: Letters) -> list[str]:
    if alone := _ALONE.fullmatch(text):
        return _together(_of_letter(alone["letter"], letters), by_label(text, choices))
    if is_verbatim(text, choices):  # "A and B are at rest" begins with no letter of a choice
        return in_words(text, choices)
    if (match := _BEFORE.fullmatch(text)) and (keys := _of_letter(match["letter"], letters)):
        if match["mark"] == "=" and _ALONE.fullmatch(match["said"]):
            return []  # a = a says nothing of b
        if named := _named_by(match["said"], choices, letters):
            return _together(keys, named)
        if (remark := _IN_BRACKETS.fullmatch(match["said"])) and not names_any(remark[1], choices):
            return [] if _CALL.fullmatch(text) else keys  # b (r2 < r1)
        if match["bracket"] or match["mark"]:
            return []
    if match := _BEHIND.fullmatch(text):
        keys = _of_letter(match["inner"] or match["bare"], letters)
        named = _named_by(match["said"], choices, letters) if keys else []
        if named:
            return _together(keys, named)
    return in_words(text, choices) or _by_place(text, choices, letters)


def _together(*named: Sequence[str]) -> list[str]:
    return list(dict.fromkeys(key for keys in named for key in keys))


def _of_letter(letter: str, letters: Letters) -> list[str]:
    return [key for key, printed in letters.items() if printed == letter.lower()]


def _named_by(text: str, choices: Choices, letters: Letters) -> list[str]:
    """Return the texts that stand beside a letter, in brackets or not: the words of a choice, or one more
    letter."""
    inner = _IN_BRACKETS.fullmatch(text)
    text = inner[1] if inner else text
    alone = _ALONE.fullmatch(text)
    return (_of_letter(alone["letter"], letters) if alone else []) or in_words(text, choices)


@lru_cache(maxsize=1)
def _answer_words() -> re.Pattern[str]:
    nouns = "|".join(re.escape(noun) for lang in languages() for noun in words(lang)["choices"]["answers"])
    before = r"(?:(?:c['’]est|it is|it['’]s|la|le|the)\s+|l['’]\s*)*"
    return re.compile(rf"\s*{before}(?:(?:{nouns})\b\s*(?:n\s*°|no\.)?\s*[:=]?\s*)?(?=\S)", re.I)


def _without_answer(text: str) -> str:
    """Return a letter or a number without what says that it is the answer: ``réponse b``, ``it is 2``."""
    rest = _answer_words().sub("", text, count=1).strip()
    return rest if any(form.fullmatch(rest) for form in (_ALONE, _PLACE, _BEFORE)) else text.strip()


# --- places -----------------------------------------------------------------------------

_PLACE = re.compile(r"[(\[#]?\s*(?:n\s*°\s*)?(?P<number>[0-9]{1,2})\s*[)\].:]?", re.I)


def _by_place(text: str, choices: Choices, letters: Letters) -> list[str]:
    """Return the choice at a place: ``2``. Where labels begin with numbers, a number is one of these, or it
    is two things."""
    match = _PLACE.fullmatch(text)
    if match is None:
        return []
    number = int(match["number"])
    keys = [*letters][number - 1 : number] if number else []
    if not any(counts(labels) for labels in choices.values()):
        return keys
    named = [key for key, labels in choices.items() if number in numbers_of(labels)]
    return _together(named, keys) if named else []


# --- boxes ------------------------------------------------------------------------------

_BOX = re.compile(
    r"\[\s*(?P<square>[xX✓✔*])\s*\]|(?P<sign>[☒☑✓✔])|(?<!\S)\(\s*(?P<round>[xX✓✔])\s*\)(?=\s)"
    r"|\[[\s_]*\]|[☐□]|(?<!\S)\(\s*\)(?=\s)"
)


def _ticked(text: str) -> str:
    """Return the ticked choice of a list, ``b`` of ``☐ a ☒ b ☐ c``; return the text itself where nothing is
    ticked.

    Boxes stand before all that they belong to, or behind it all; one alone belongs to what it touches.
    """
    boxes = list(_BOX.finditer(text))
    ticks = [any(box.groups()) for box in boxes]
    if True not in ticks:
        return text
    ends = [0, *(end for box in boxes for end in box.span()), len(text)]
    pieces = [text[a:b] for a, b in zip(ends[::2], ends[1::2], strict=True)]
    if not pieces[0].strip():
        texts = pieces[1:]
    elif not pieces[-1].strip():
        texts = pieces[:-1]
    else:
        texts = [_touched(*pieces)] if len(boxes) == 1 else []
    ticked = [piece.strip(" \t\r\n,;|/") for piece, tick in zip(texts, ticks, strict=False) if tick]
    if len(ticked) != 1:
        raise Stop("two_values" if ticked else "not_a_choice", text)
    return ticked[0]


def _touched(before: str, behind: str) -> str:
    """Of what stands about a box, the piece that is nearer; none where both are as near: ``a [x] b``."""
    left, right = before[len(before.rstrip()) :], behind[: len(behind) - len(behind.lstrip())]
    nearness = [("\n" in gap, len(gap) > 0) for gap in (left, right)]
    if nearness[0] == nearness[1]:
        return ""
    if nearness[0] < nearness[1]:
        return re.split(r"\n" if "\n" in before.strip() else r"\s", before.strip())[-1]
    return re.split(r"\n" if "\n" in behind.strip() else r"\s", behind.strip())[0]
