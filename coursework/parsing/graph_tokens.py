"""The words of a joint graph as people write it: bodies, kinds of joints, links, separators."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Collection, Iterator, Mapping, Sequence
from difflib import get_close_matches
from functools import lru_cache
from typing import NamedTuple

from coursework.errors import bare_letters
from coursework.language.words import languages, words
from coursework.parsing.reading import Stop
from coursework.parsing.spelling import tidy

_LETTERS = {"R": "revolute", "P": "prismatic", "H": "higher", "G": "prismatic"}
FRAME = "frame"  #: what the frame is called before its number is known


def folded(text: str) -> str:
    """Words without case, accents, hyphens and the s of a plural."""
    words = filter(None, re.split(r"[\s'_-]+", bare_letters(text)))
    return " ".join(w[:-1] if len(w) > 3 and w.endswith("s") else w for w in words)


@lru_cache(maxsize=1)
def _kinds() -> Mapping[str, str]:
    """Return the kind of each name that a joint has in any language."""
    tables = [words(lang)["graph"]["kinds"] for lang in languages()]
    kinds = {folded(kind): kind for table in tables for kind in table}
    return kinds | {folded(name): kind for table in tables for kind, names in table.items() for name in names}


@lru_cache(maxsize=4)
def _words_of(category: str) -> frozenset[str]:
    return frozenset(folded(word) for lang in languages() for word in words(lang)["graph"][category])


@lru_cache(maxsize=1)
def _longest() -> int:
    return max(len(name.split()) for name in _kinds())


def kind_named(text: str) -> str | None:
    """Return the kind of a name or a letter, if it is one."""
    return _LETTERS.get(text.strip().upper()) or _kinds().get(folded(text))


# --- tokens -----------------------------------------------------------------------------


class Token(NamedTuple):
    """``body``, ``kind``, ``link``, ``comma``, ``stop`` or ``times``, what it stands for, and as it was
    written."""

    sort: str
    said: str = ""
    text: str = ""


_ARROWS = re.compile(r"<?[-=]+>|<[-=]+|[←→↔⟵⟶⟷⇔⇒↦]|\\(?:left)?(?:right)?arrow\b|--+|[_~]{2,}")
_NAME = r"[A-Za-z]{0,2}[0-9]+"
_QUOTED = re.compile(r"(?<!\w)['\"]([^'\"\n]*)['\"](?!\w)")
#: ``1) 1-2 pivot``, ``L1: 1-2 pivot``: the number of a joint in a list
_NUMBERING = re.compile(
    r"(?im)(^|[;,])[^\S\n]*+(?:[0-9]++[^\S\n]*+\)|(?:joint|liaison|[lj])?+[^\S\n]*+[0-9]++[^\S\n]*+:)"
    r"(?=[^,;\n]*[0-9]\s*+[-/]\s*+[a-z]{0,2}[0-9])"
)  # nothing is given back: blank lines would be tried in all their ways
_TUPLE = re.compile(
    rf"[(\[{{]\s*({_NAME})\s*[,;]\s*({_NAME})\s*(?:[,;]\s*({_NAME})\s*)?(?:[,;]\s*([^\W\d_][^,"
    rf";()\[\]{{}}]*))?[)\]}}]"
)
_PIECE = re.compile(
    r"(?P<times>(?:[*×]|\bx)\s*(?P<n>[2-9])\b|\b(?P<m>[2-9])\s*(?:[*×]|x\b))|(?P<stop>[;\n]|\.(?=\s|$))"
    r"|(?P<comma>[,&+])"
    r"|(?P<link>[-/])|(?P<name>[A-Za-z]{0,2}[0-9]+)|(?P<word>[^\W\d_]+)|(?P<rest>[:=()\[\]{}|'\"*.°→_]|\s)"
)


def plain(text: str) -> str:
    """One spelling of dashes, digits and lines; LaTeX and arrows left out."""
    lines = [tidy(line) for line in text.replace("\\\\", "\n").splitlines()]
    text = unicodedata.normalize("NFKC", "\n".join(lines))
    text = re.sub(r"\\(?:text|mathrm|mathit)|[$\\{}]|(?<=[A-Za-z])_(?=\{?[0-9])", "", _ARROWS.sub("-", text))
    text = _QUOTED.sub(r"\1", _NUMBERING.sub(r"\1", text))
    return _TUPLE.sub(_untupled, text)


def _untupled(match: re.Match[str]) -> str:
    bodies = "-".join(filter(None, match.groups()[:3]))
    return f";{bodies} {match[4]};" if match[4] else f" {bodies} "


def tokens_of(text: str, bodies: Collection[str], named: bool) -> Iterator[Token]:
    """Yield the tokens of a plain text, its filling left out."""
    pieces = [m for m in _PIECE.finditer(text) if not m["rest"]]
    if stray := _PIECE.sub("", text).strip():
        raise Stop("no_joint", stray)
    index = 0
    while index < len(pieces):
        token, used = _next_tokens(pieces, index, bodies, named)
        yield from token
        index += used


def _next_tokens(
    pieces: Sequence[re.Match[str]], index: int, bodies: Collection[str], named: bool
) -> tuple[list[Token], int]:
    """Return the tokens of the next piece or pieces, and of how many."""
    piece = pieces[index]
    sort, text = str(piece.lastgroup), piece[0]
    if piece["times"]:
        return [Token("times", piece["n"] or piece["m"], text)], 1
    if sort in ("stop", "comma", "link"):
        return [Token(sort, "", text)], 1
    if sort == "name":
        return _numbered(text, _is_linked(pieces, index), bodies), 1
    for length in range(min(_longest(), len(pieces) - index), 0, -1):
        group = pieces[index : index + length]
        if all(p.lastgroup in ("word", "link") for p in group) and group[-1].lastgroup == "word":
            phrase = " ".join(p[0] for p in group if p.lastgroup == "word")
            if (kind := kind_named(phrase)) is not None and (length > 1 or not _is_label(pieces, index)):
                return [Token("kind", kind, phrase)], length
    return _worded(pieces, index, named), 1


def _is_linked(pieces: Sequence[re.Match[str]], index: int) -> bool:
    around = pieces[max(0, index - 1) : index + 2]
    return any(p.lastgroup == "link" for p in around)


def _is_beside_number(pieces: Sequence[re.Match[str]], index: int) -> bool:
    """Return whether a hyphen joins a piece to a number: ``0-a``."""
    return any(
        0 <= index + 2 * step < len(pieces)
        and pieces[index + step].lastgroup == "link"
        and pieces[index + 2 * step].lastgroup == "name"
        for step in (-1, 1)
    )


def _is_label(pieces: Sequence[re.Match[str]], index: int) -> bool:
    """Return whether a letter is the name of a point, ``en P``, ``pivot R``, and not that of a kind."""
    if len(pieces[index][0]) > 1 or not index:
        return False
    before = pieces[index - 1]
    if before.lastgroup != "word":
        return False
    word = before[0]
    return folded(word) in _words_of("at") or (len(word) > 1 and kind_named(word) is not None)


def _numbered(text: str, is_linked: bool, names: Collection[str]) -> list[Token]:
    """Return a body of a number, ``12`` as two bodies where there is none of that number; ``R12`` says its
    kind as well."""
    letters = text.rstrip("0123456789")
    number = text[len(letters) :]
    tokens = []
    if letters in _LETTERS:
        tokens = [Token("kind", _LETTERS[letters], letters)]
    elif letters and letters.casefold() not in ("s", "l", "c") and not is_linked:
        return []  # a point's name
    if number not in names and len(number) > 1 and not is_linked and set(number) <= set(names):
        bodies = [Token("body", digit, text) for digit in number]
        return tokens + [t for body in bodies for t in (Token("link"), body)][1:]
    return [*tokens, Token("body", str(int(number)), text)]


def _worded(pieces: Sequence[re.Match[str]], index: int, named: bool) -> list[Token]:
    text = pieces[index][0]
    plain = folded(text)
    if plain in _words_of("frame"):
        return [Token("body", FRAME, text)]
    if (not named and _is_linked(pieces, index)) or (
        text.isascii() and len(text) == 1 and _is_beside_number(pieces, index)
    ):
        return [Token("body", text.casefold(), text)]
    if plain in _words_of("and"):
        return [Token("comma", "", text)]
    if plain in _words_of("filling") | _words_of("at"):
        return []
    if _is_linked(pieces, index):
        return [Token("body", text.casefold(), text)]
    near = get_close_matches(plain, _kinds(), 1, 0.8) if len(plain) > 4 else ()
    if near:
        return [Token("kind", _kinds()[near[0]], text)]
    if len(text) < 3:
        return []  # the name of a point, of an axis
    if not named:
        return [Token("body", text.casefold(), text)]
    raise Stop("unknown_joint", text)
