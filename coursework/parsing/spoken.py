"""Words that answers hold beside numbers: that nothing is known, that it stands elsewhere, a sign, a sense, a
root."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache

from coursework.errors import bare_letters
from coursework.language.words import languages, words
from coursework.parsing.labels import folded
from coursework.parsing.reading import Stop
from coursework.parsing.spelling import in_brackets, unwrapped
from coursework.parsing.vocabulary import MAX_LENGTH

_LONGEST = 80  #: characters of a text that answers nothing
_MARKS = re.compile(r"[\s?!.…/\\_xX×*∅øØ~=#,;:–—−-]+")
_A_PHRASE = 2  #: words of what says so wherever it stands: ``sorry, I do not know``


@lru_cache(maxsize=8)
def _phrases(category: str) -> tuple[str, ...]:
    """Words of every language, folded, the longest first."""
    phrases = {folded(word) for lang in languages() for word in words(lang)["answers"][category]}
    return tuple(sorted(phrases, key=len, reverse=True))


def says_nothing(text: str) -> bool:
    """Return whether a text says that there is no answer: ``?``, ``NSP``, ``je ne sais pas``, ``no time``."""
    if len(text) > _LONGEST:
        return False
    if _MARKS.fullmatch(text):
        return True
    text_folded = folded(text)
    if text_folded in _phrases("nothing"):
        return True
    phrases = (s for s in _phrases("nothing") if len(s.split()) >= _A_PHRASE)
    return not re.search(r"[0-9]", text_folded) and any(
        f" {phrase} " in f" {text_folded} " for phrase in phrases
    )


def refers_elsewhere(text: str) -> bool:
    """Return whether a text says that the answer stands elsewhere: ``voir feuille``, ``see sheet``."""
    text_folded = folded(text.replace(".", " "))
    return len(text) <= _LONGEST and f"{text_folded} ".startswith(
        tuple(f"{s} " for s in _phrases("elsewhere"))
    )


# ------------------------------------------------------------------- beside a number


_OFFERS_TWO = re.compile(r"\w (?:ou|or|et|and)$")


def _either(category: str) -> str:
    """Return the words of every language as a pattern, their spaces of any length, with accents and
    without; not ``d ou`` for ``d'où``, which offers the choice d or another."""
    phrases = {
        w
        for lang in languages()
        for word in words(lang)["answers"][category]
        for w in (word, bare_letters(word), folded(word))
        if w and not _OFFERS_TWO.match(w)
    }
    return "|".join(re.escape(w).replace(r"\ ", r"[\s-]+") for w in sorted(phrases, key=len, reverse=True))


@lru_cache(maxsize=8)
def _before(category: str) -> re.Pattern[str]:
    return re.compile(rf"(?:{_either(category)})(?![^\W\d_])\s*(?=\S)", re.I)


@lru_cache(maxsize=2)
def _sense(category: str) -> re.Pattern[str]:
    """Words for a sense at the end of a text: ``20,54 rad/s (sens horaire)``, ``201.5 mm/s to the right``."""
    return re.compile(rf"[(\[]?(?<![^\W\d_])(?:{_either(category)})\s{{0,9}}[)\]]?[.!]?$", re.I)


_NAMED = re.compile(r"^[^\W\d_]\w{0,9}\s*[=≈:]\s*(?=[+-]?\s*[0-9])")  #: the name of a number


def _number_before(category: str, text: str) -> str:
    """Return the number that stands before words for a sense; nothing where none does."""
    match = _sense(category).search(text) if len(text) <= _LONGEST else None
    number = _NAMED.sub("", text[: match.start()].strip(" ,;(")) if match else ""
    return number if re.match(r"[+-]?\s*[0-9]", number) else ""


@lru_cache(maxsize=1)
def number_words() -> dict[str, int]:
    """Numbers in words, of every language."""
    tables = (words(lang)["study"]["reads"]["numbers"] for lang in languages())
    return {
        word.casefold(): n for names in tables for n, name in enumerate(names) for word in name.split("|")
    }


#: What people write about a number beside words: an arrow before it, a sign in brackets, digits that go on, a
#: power of ten in words, a direction up to a turn, to which digit it is rounded, the same in another unit.
_HABITS = (
    (re.compile(r"^~=\s*(?=[+-]?\s*[0-9])"), ""),
    (re.compile(r"^\(\s*([+-])\s*\)\s*(?=[0-9])"), r"\1"),
    (re.compile(r"(?<=[0-9])(?:\.\.\.|…)(?!\s*[0-9+-])"), ""),
    (re.compile(r"(?<=10)\s*(?:exp|puissance|to the power)\s*(?=[+-]?[0-9])", re.I), "^"),
    (
        re.compile(
            r"(?<=\S)\s*(?:\(\s*mod[^()]*\)|\[\s*(?:mod(?:ulo)?\s*)?(?:360\s*°?|2\s*(?:π|pi))\s*\])$", re.I
        ),
        "",
    ),
    (re.compile(r"(?<=\S)[\s,]+\(?à\s+[^\s()]{1,9}(?:\s[^\s()]{1,6})?\s+près\)?$", re.I), ""),
    (re.compile(r"(?<=[^\W_])\s*,?\s+soit\s+(?=[+-]?[0-9])", re.I), " = "),
)


@lru_cache(maxsize=1)
def _remark() -> re.Pattern[str]:
    """Words that say nothing of a value at its end: ``12,5 (arrondi)``, ``2,05 sans unité``."""
    return re.compile(rf"(?<=\S)[\s,]+[(\[]?(?:{_either('remark')})[)\]]?[.!]?$", re.I)


def _plainly(text: str) -> str:
    """Return a number without the habits of people who write it by hand."""
    if len(text) > _LONGEST:
        return text
    for pattern, plain in _HABITS:
        text = pattern.sub(plain, text, count=1)
    return _remark().sub("", text) if re.search(r"[0-9]", text) else text


_ARROW = re.compile(r"(?:[→⇒⟹⟶∴]|[=~-]+>)\s*(?=\S)|[•*]\s+(?=\S)")


def bare(text: str) -> str:
    """Return an answer without what people write about one of any kind: brackets around it all, an arrow, a
    bullet, ``réponse :`` or ``I think it is`` before it, ``(sûr)`` behind it."""
    if len(text) > MAX_LENGTH:
        return text
    text = unwrapped(text).replace("’", "'").rstrip(" .…!")
    text = _remark().sub("", _without(in_brackets(text) or text, (_ARROW, _before("introduction"))))
    return unwrapped(text)


def _without(text: str, openings: Sequence[re.Pattern[str]]) -> str:
    """Return a text without the openings before it, in any order."""
    before = ""
    while before != text:
        before = text
        for opening in openings:
            if match := opening.match(text):
                text = text[match.end() :].lstrip(", :")
    return text


def with_signs(text: str) -> str:
    """Return a number with digits and a sign in place of words: ``moins 18,32``, ``cinq``, ``à peu près 15``.

    A sense in words gives the sign of a number that has none.

    Raises
    ------
    Stop
        The sign is against the words: ``two_values``.
    """
    text = _without(_plainly(text), (_ARROW,))
    if not any(map(str.isalpha, text)):
        return text
    text = _without(text, (_ARROW, _before("introduction"), _before("about")))
    for category, sign in (("minus", "-"), ("plus", "")):
        if match := _before(category).match(text):
            text = sign + text[match.end() :]
    number = number_words().get(text.lstrip("-").casefold())
    if number is not None:
        return f"{'-' if text[0] == '-' else ''}{number}"
    for category in ("positive", "negative"):  # anti-horaire ends as horaire does
        if number_text := _number_before(category, text):
            is_negative = number_text.startswith("-")
            if category == "positive" and is_negative:
                raise Stop("two_values", text)
            return (
                f"-{number_text.lstrip('+ ')}" if category == "negative" and not is_negative else number_text
            )
    return text


def has_sense(text: str) -> bool:
    """Return whether words for its sense follow a number."""
    return any(_number_before(category, text) for category in ("negative", "positive"))


@lru_cache(maxsize=1)
def _root() -> re.Pattern[str]:
    return re.compile(rf"(?<![^\W\d_])(?:{_either('root')})(?![^\W\d_])\s*", re.I)


def with_roots(text: str) -> str:
    """Return a formula with a radical sign in place of the word: ``racine(2)``, ``square root of 2``."""
    return _root().sub("√", text)
