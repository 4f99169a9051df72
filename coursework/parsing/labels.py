"""Cases of a choice as people call them in words: labels, numbers that labels begin with, formulas, a remark
behind."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping, Sequence
from functools import lru_cache

from coursework.language.words import languages, words
from coursework.parsing.spelling import primes_as_dots, spelled_out

_SIGN = re.compile(r"(^|[=<>(+])\s*[-‐‑‒–—−]\s*(?=[0-9])")
_PLUS = re.compile(r"(^|[=<>(])\s*\+\s*(?=[0-9])")
_ANY_MINUS = re.compile("[-‐‑‒–—−]")


_LOOSE_COMMA = re.compile(r",(?![0-9])|(?<![0-9]),")


@lru_cache(maxsize=4096)
def folded(text: str) -> str:
    """Return a label without case, accents, markup and punctuation; a formula without spaces, its signs
    kept."""
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
    """Return a label as people shorten it: ``isostatic`` of "isostatic, all actions can be computed"."""
    return _AFTER_HEAD.sub("", label.replace("\u202f", " "))


def by_label(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """Return the choices that are called so: by their key, else by a whole label, else by the head of one."""
    plain = folded(text)
    if not plain:
        return []
    keys = [key for key in choices if folded(key) == plain]
    keys = keys or [key for key, labels in choices.items() if any(_is_called(text, s) for s in labels)]
    return keys or [k for k, labels in choices.items() if any(_is_called(text, head(s)) for s in labels)]


def _is_called(text: str, label: str) -> bool:
    """Return whether a text is a label. In a label that is a formula the operators distinguish too, spaces
    never do."""
    if _IN_WORDS.search(_COMMANDS.sub("", label)):
        return folded(text) == folded(label)
    if _squeezed(text) != _squeezed(label):
        return False
    written, offered = _operators(text), _operators(label)
    return written in ("", offered) or "/" not in written + offered


_COMMANDS = re.compile(r"\\[A-Za-z]+")
_IN_WORDS = re.compile(r"[^\W\d_]{3,}")


#: Dots that stand behind their letter where a page was made plain text, ``r˙`` for ``ṙ``.
_DOTS_BEHIND = str.maketrans({"\u02d9": "\u0307", "\u00a8": "\u0308"})


@lru_cache(maxsize=4096)
def _squeezed(formula: str) -> str:
    """Return a formula without its spaces and bars, Greek letters and dots spelled."""
    formula = unicodedata.normalize("NFC", formula.strip("$ ").translate(_DOTS_BEHIND))
    return folded(primes_as_dots(spelled_out(formula)).replace("*", " ")).replace(" ", "")


@lru_cache(maxsize=4096)
def _operators(formula: str) -> str:
    """Return the signs of product and quotient of a formula, in order."""
    formula = re.sub(r"\\(?:cdot|times)(?![A-Za-z])|[×·⋅]", "*", formula)
    return re.sub(r"[^*/]", "", formula)


def _by_value(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """Return the choices of whose formula this is the right-hand side: ``-1`` where ``w = -1`` is offered."""
    value = folded(f"= {text.strip('()[] ')}").removeprefix("=").strip()
    keys = [key for key, labels in choices.items() for s in labels if "=" in s and _value_of(s) == value]
    return list(dict.fromkeys(keys)) if value else []


@lru_cache(maxsize=4096)
def _value_of(label: str) -> str:
    return folded(label).rpartition("=")[2].strip()


_BEFORE = re.compile(
    r"^\s*(?:(?:c['’]est|il|elle|it is|it|un|une|des|le|la|les|an|a|the)\s+|l['’]\s*)(?=\S)", re.I
)  #: what people put before a label, and no label needs


_ROMAN = ("i", "ii", "iii", "iv", "v", "vi", "vii", "viii", "ix", "x")


@lru_cache(maxsize=1)
def _numerals() -> Mapping[str, int]:
    """Numbers as labels have them: digits, Roman numerals, words of any language; folded."""
    numerals = {str(n): n for n in range(100)} | {name: n for n, name in enumerate(_ROMAN, start=1)}
    for lang in languages():
        for n, names in enumerate(words(lang)["study"]["reads"]["numbers"]):
            numerals |= {folded(name): n for name in names.split("|")}
    return numerals


@lru_cache(maxsize=1)
def _nouns() -> tuple[str, ...]:
    """Return the common nouns of labels, such as ``class``, folded, the longest first."""
    nouns = {folded(noun) for lang in languages() for noun in words(lang)["choices"]["nouns"]}
    return tuple(sorted(nouns, key=len, reverse=True))


@lru_cache(maxsize=4096)
def _without_noun(text: str) -> str:
    """Return a plain label without what all of its kind are called: ``classe III`` is ``iii``,
    ``rigid joint`` ``rigid``."""
    plain = folded(text)
    for noun in _nouns():
        if plain.startswith(f"{noun} "):
            return plain[len(noun) + 1 :]
        if plain.endswith(f" {noun}") and len(plain) - len(noun) > _SMALL_WORD:
            return plain[: -len(noun) - 1]
    return plain


_SMALL_WORD = 4  #: letters of a word and its space that say too little alone: ``no joint`` is not ``no``


def _by_core(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """Return the choices that are called so but for a noun that all of their kind share: ``pivot``."""
    core = _without_noun(text)
    plain = {key: [head(s) for s in labels if not s.startswith("$")] for key, labels in choices.items()}
    return [key for key, heads in plain.items() if core and any(_without_noun(s) == core for s in heads)]


@lru_cache(maxsize=4096)
def _beginnings(label: str) -> frozenset[str]:
    """Return the beginnings of a label, of two words or more, folded; none ends with ``and`` or ``or``."""
    pieces = [] if "=" in label or label.startswith("$") else label.split()
    ends = (n for n in range(2, len(pieces)) if folded(pieces[n]) not in _conjunctions())
    return frozenset(folded(" ".join(pieces[:n])) for n in ends)


@lru_cache(maxsize=1)
def _conjunctions() -> frozenset[str]:
    return frozenset(folded(words(lang)["marking"][joint]) for lang in languages() for joint in ("and", "or"))


def _by_beginning(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """Return the choices whose label begins so: ``double balancier``, ``cas limite``; a word with a hyphen is
    one."""
    plain = folded(text)
    if " " not in plain:
        return []
    return [key for key, labels in choices.items() if any(plain in _beginnings(s) for s in labels)]


_REMARK = re.compile(r"(?P<said>[^()]+?)\s*\((?P<remark>[^()]+)\)\s*")


def _by_remark(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """Return the choices that stand before a remark in brackets which neither names another nor is its own:
    ``oscille (r2 < r1)``."""
    match = _REMARK.fullmatch(text)
    if match is None:
        return []
    keys = _meant(match["said"], choices)
    if len(keys) != 1 or any(key not in keys for key in _meant(match["remark"], choices)):
        return []
    remark = f" {folded(match['remark'])} "
    own_remarks, foreign = (
        _remarks(choices, [k for k in choices if (k in keys) == mine]) for mine in (True, False)
    )
    if remark in foreign and remark not in own_remarks:
        return []
    others = (
        s for key, labels in choices.items() if key not in keys for s in (key, *labels, *map(head, labels))
    )
    return [] if any(f" {folded(s)} " in remark for s in others if folded(s)) else keys


def _remarks(choices: Mapping[str, Sequence[str]], keys: Sequence[str]) -> str:
    """Return the words in brackets in the labels of some choices, folded."""
    labels = " ".join(label for key in keys for label in choices[key])
    return f" {' | '.join(map(folded, re.findall(r'[(]([^()]+)[)]', labels)))} "


@lru_cache(maxsize=4096)
def _numbered(text: str) -> tuple[int | None, str]:
    """Return the number that a label begins with, and what follows: ``deux paires`` is 2, ``paires``."""
    first, _, rest = _without_noun(text).partition(" ")
    return _numerals().get(first), rest


#: What makes more than a numeral of one: ``2^``, ``/2``, ``\\vec{v}``, ``the two``; and a vector of a point,
#: ``V(B∈2/0)``.
_NO_NUMERAL = re.compile(r"[\\^]|^\s*/|/\s*$|^\s*(?:les|the)\s+[^\W\d_]{3,}\W*$", re.I)
_OF_POINT = re.compile(r"\s*(?:\\vec\s*\{?\s*)?[ivx]+\s*\}?\([^()]*[∈/,]", re.I)


def _is_no_numeral(text: str) -> bool:
    """Return whether a numeral stands in a text that states no number of a choice."""
    if _OF_POINT.match(text):
        return True
    number, rest = _numbered(_BEFORE.sub("", text))
    return number is not None and not rest and bool(_NO_NUMERAL.search(text))


def _by_number(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """Return the choice whose label begins with this number, however it is written, where the numbers tell
    choices apart."""
    number, rest = _numbered(text.strip("()[] "))
    if number is None:
        return []
    numbered = {}
    for key, labels in choices.items():
        heads = [_numbered(head(label)) for label in labels]
        if numbers := {n for n, _ in heads if n is not None}:
            numbered[key] = numbers, {follows for n, follows in heads if n == number}
    every = [n for numbers, _ in numbered.values() for n in numbers]
    if len(numbered) < 2 or len(set(every)) < len(every):
        return []
    return [key for key, (ns, follows) in numbered.items() if number in ns and (not rest or rest in follows)]


_MARKED = re.compile(
    r"[(\[]?\s*(?P<mark>[a-z]|[0-9]{1,2})\s*(?:[)\]:]|\.(?![0-9]))\s*(?P<label>[^\s.…].*)", re.I
)


def in_words(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """Return the choices that a text may mean, whatever letters a sheet prints; a mark before a label counts
    where it is a number."""
    if _is_no_numeral(text):
        return []
    keys = by_label(text, choices)
    marked = None if keys else _MARKED.fullmatch(text.strip())
    if marked and (
        marked["mark"].isdigit() or len(marked["label"].strip(" .")) > 1
    ):  # b) crossed, and not n.a.
        label = _meant(marked["label"], choices)
        keys = list(dict.fromkeys((*label, *_by_number(marked["mark"], choices)))) if label else []
    return keys or _meant(text, choices)


def _meant(text: str, choices: Mapping[str, Sequence[str]]) -> list[str]:
    """Return the choices that a text may mean, its article left out if need be; the surest way to call one
    first."""
    stripped = _BEFORE.sub("", text)
    for words_said in dict.fromkeys((text, stripped)):
        keys = by_label(words_said, choices) or _by_core(words_said, choices)
        keys = keys or list(
            dict.fromkeys((*_by_number(words_said, choices), *_by_value(words_said, choices)))
        )
        if keys and words_said != text:  # une deux: an article may be a label as well
            keys = list(dict.fromkeys((*keys, *by_label(text.removesuffix(stripped), choices))))
        if keys:
            return keys
    return _by_beginning(stripped, choices) or _by_remark(text, choices)


def is_verbatim(text: str, choices: Mapping[str, Sequence[str]]) -> bool:
    """Return whether a label begins with a text of some words as it is printed, its case and spaces apart."""
    plain = _plain(text)
    begins = re.compile(rf"{re.escape(plain)}(?!\w)")
    return " " in plain and any(begins.match(_plain(s)) for labels in choices.values() for s in labels)


def _plain(text: str) -> str:
    return " ".join(text.casefold().replace("’", "'").split()).rstrip(" .…!")


def names_any(text: str, choices: Mapping[str, Sequence[str]]) -> bool:
    """Return whether a text names a choice."""
    within = f" {folded(text)} "
    names = (s for key, labels in choices.items() for s in (key, *labels, *map(head, labels)))
    return any(f" {folded(s)} " in within for s in names if folded(s))


def numbers_of(labels: Sequence[str]) -> set[int]:
    """Return the numbers that labels begin with, and the values that they state: ``two pairs``, ``class II``,
    ``w = 1``."""
    numbers = set()
    for label in labels:
        number, rest = _numbered(head(label))
        is_letter = _without_noun(head(label)).partition(" ")[0] in _ROMAN and rest  # V_e / V_s
        if number is not None and not is_letter:
            numbers.add(number)
        if "=" in label and _value_of(label).isdecimal():
            numbers.add(int(_value_of(label)))
    return numbers


def counts(labels: Sequence[str]) -> bool:
    """Return whether labels begin with a number: one that is not an article."""
    return not numbers_of(labels) <= {1} or any(
        re.search(r"[0-9]|\bI\b", head(s)) for s in labels if numbers_of([s])
    )
