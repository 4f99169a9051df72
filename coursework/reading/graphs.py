"""Joint graphs as people write them: a list of joints, each by its bodies and its kind, in any order and notation."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from difflib import get_close_matches
from functools import lru_cache
from itertools import pairwise
from typing import Any, NamedTuple

from coursework.language.words import languages, words
from coursework.reading.reading import Reading, Stop, text_of
from coursework.reading.spelling import shorten, tidy, unwrapped

_MOST = 4000  #: characters of an answer
_MOST_JOINTS = 60
_LETTERS = {"R": "revolute", "P": "prismatic", "H": "higher", "G": "prismatic"}
LETTER_OF = {"revolute": "R", "prismatic": "P", "higher": "H"}  #: as on the drawn graph
FRAME = "frame"  #: what the frame is called before its number is known


class Edge(NamedTuple):
    """Bodies held together by one joint, in natural order; ``kind`` is empty where none is said."""

    bodies: tuple[str, ...]
    kind: str

    @property
    def pairs(self) -> int:
        """How many pairs it counts: a pivot of k bodies is k - 1."""
        return len(self.bodies) - 1

    def __str__(self) -> str:
        return "–".join(self.bodies)


Graph = tuple[Edge, ...]


def natural(name: str) -> tuple[bool, int, str]:
    """By which bodies are sorted: numbers as numbers, before words."""
    return not name.isdigit(), int(name) if name.isdigit() else 0, name


def edge(bodies: Collection[str], kind: str) -> Edge:
    return Edge(tuple(sorted(bodies, key=natural)), kind)


def in_order(joints: Iterable[Edge]) -> Graph:
    return tuple(sorted(joints, key=lambda joint: ([natural(body) for body in joint.bodies], joint.kind)))


def renamed(graph: Graph, names: Mapping[str, str]) -> Graph:
    """The graph with other names of bodies."""
    return in_order(edge([names.get(b, b) for b in joint.bodies], joint.kind) for joint in graph)


@lru_cache(maxsize=2048)
def graph_of(text: str) -> Graph:
    """A graph as solutions state it: ``1-2 revolute, 3-4-5 revolute, 1-6 prismatic``."""
    joints = (word.split() for word in text.split(","))
    return in_order(edge(bodies.split("-"), kind) for bodies, kind in joints)


def bodies_of(graph: Graph) -> tuple[str, ...]:
    """The names of the bodies, in natural order."""
    return tuple(sorted({body for joint in graph for body in joint.bodies}, key=natural))


def spelled(graph: Graph) -> str:
    """A graph in letters, as a figure bears them: ``1–2 R, 1–4 P``; kinds that have none by their name."""
    return ", ".join(f"{joint} {LETTER_OF.get(joint.kind, joint.kind)}".strip() for joint in graph)


def read_graph(answer: Any, reference: Graph, *, named: bool = True) -> Reading:
    """The joints that an answer lists; the value is a :data:`Graph`, or two where ``P`` may be a pivot or a slide.

    ``1-2 pivot, 2-3 pivot, 1-4 glissière``, ``2/1 R; …``, ``pivot: 1-2, 2-3; slide: 1-4``, ``S1-S2``, ``1 -R- 2``, lines, a
    list of tuples or records; a joint without a kind is read. The bodies of the ``reference`` tell ``12`` from ``1-2``; with
    ``named=False`` any word may be a body.
    """
    if not isinstance(answer, str):
        answer = "" if answer is None else _as_text(answer)
    if not answer.strip():
        return Reading(answer, "missing")
    if len(answer) > _MOST:
        return Reading(answer, "unreadable", code="too_long", found=shorten(answer))
    try:
        tokens = [*_tokens(_plain(unwrapped(answer)), frozenset(bodies_of(reference)), named)]
        values = tuple(_framed(_graph(way), reference, named) for way in _ways(tokens))
    except Stop as stop:
        return Reading(answer, "unreadable", code=stop.code, found=shorten(stop.found))
    return Reading(answer, "read", values, tuple(map(spelled, values)))


def _as_text(answer: Any) -> str:
    """A list of tuples, of records or of texts, as text, a joint a line."""
    if isinstance(answer, Mapping):
        answer = [answer] if "between" in answer else [*answer.items()]
    if not isinstance(answer, (list, tuple, set, frozenset)):
        return text_of(answer)
    if isinstance(answer, (set, frozenset)):
        answer = sorted(answer, key=str)
    return "\n".join(map(_line, answer))


def _line(one: Any) -> str:
    if isinstance(one, Mapping):
        one = (*one.get("between", ()), one.get("kind", ""))
    if not isinstance(one, (list, tuple)):
        return text_of(one)
    flat = [part for item in one for part in (item if isinstance(item, (list, tuple)) else (item,))]
    bodies = [text_of(part) for part in flat if not _is_word(part)]
    return " - ".join(bodies) + " " + " ".join(text_of(part) for part in flat if _is_word(part))


def _is_word(part: Any) -> bool:
    return isinstance(part, str) and kind_named(part) is not None


# --- words ------------------------------------------------------------------------------


def folded(text: str) -> str:
    """Words without case, accents, hyphens and the s of a plural."""
    bare = unicodedata.normalize("NFKD", text.casefold())
    bare = "".join(c for c in bare if not unicodedata.combining(c))
    return " ".join(w[:-1] if len(w) > 3 and w.endswith("s") else w for w in re.split(r"[\s'_-]+", bare) if w)


@lru_cache(maxsize=1)
def _kinds() -> Mapping[str, str]:
    """The kind of each name that a joint has in any language."""
    tables = [words(lang)["graph"]["kinds"] for lang in languages()]
    found = {folded(kind): kind for table in tables for kind in table}
    return found | {folded(name): kind for table in tables for kind, names in table.items() for name in names}


@lru_cache(maxsize=4)
def _said(what: str) -> frozenset[str]:
    return frozenset(folded(word) for lang in languages() for word in words(lang)["graph"][what])


@lru_cache(maxsize=1)
def _longest() -> int:
    return max(len(name.split()) for name in _kinds())


def kind_named(text: str) -> str | None:
    """The kind of a name or a letter, if it is one."""
    return _LETTERS.get(text.strip().upper()) or _kinds().get(folded(text))


# --- tokens -----------------------------------------------------------------------------


class _Token(NamedTuple):
    """``body``, ``kind``, ``link``, ``comma``, ``stop`` or ``times``, what it stands for, and as it was written."""

    sort: str
    said: str = ""
    text: str = ""


_ARROWS = re.compile(r"<?[-=]+>|<[-=]+|[←→↔⟵⟶⟷⇔⇒↦]|\\(?:left)?(?:right)?arrow\b|--+|[_~]{2,}")
_NAME = r"[A-Za-z]{0,2}[0-9]+"
_QUOTED = re.compile(r"(?<!\w)['\"]([^'\"\n]*)['\"](?!\w)")
#: ``1) 1-2 pivot``, ``L1: 1-2 pivot``: the number of a joint in a list
_NUMBERING = re.compile(
    r"(?im)(^|[;,])\s*(?:[0-9]+\s*\)|(?:joint|liaison|[lj])?\s*[0-9]+\s*:)(?=[^,;\n]*[0-9]\s*[-/]\s*[a-z]{0,2}[0-9])"
)
_TUPLE = re.compile(
    rf"[(\[{{]\s*({_NAME})\s*[,;]\s*({_NAME})\s*(?:[,;]\s*({_NAME})\s*)?(?:[,;]\s*([^\W\d_][^,;()\[\]{{}}]*))?[)\]}}]"
)
_PIECE = re.compile(
    r"(?P<times>(?:[*×]|\bx)\s*(?P<n>[2-9])\b|\b(?P<m>[2-9])\s*(?:[*×]|x\b))|(?P<stop>[;\n]|\.(?=\s|$))|(?P<comma>[,&+])"
    r"|(?P<link>[-/])|(?P<name>[A-Za-z]{0,2}[0-9]+)|(?P<word>[^\W\d_]+)|(?P<rest>[:=()\[\]{}|'\"*.°→_]|\s)"
)


def _plain(text: str) -> str:
    """One spelling of dashes, digits and lines; LaTeX and arrows left out."""
    lines = [tidy(line) for line in text.replace("\\\\", "\n").splitlines()]
    text = unicodedata.normalize("NFKC", "\n".join(lines))
    text = re.sub(r"\\(?:text|mathrm|mathit)|[$\\{}]|(?<=[A-Za-z])_(?=\{?[0-9])", "", _ARROWS.sub("-", text))
    text = _QUOTED.sub(r"\1", _NUMBERING.sub(r"\1", text))
    return _TUPLE.sub(_untupled, text)


def _untupled(match: re.Match[str]) -> str:
    bodies = "-".join(filter(None, match.groups()[:3]))
    return f";{bodies} {match[4]};" if match[4] else f" {bodies} "


def _tokens(text: str, known: Collection[str], named: bool) -> Iterator[_Token]:
    """The tokens of a plain text, its filling left out."""
    pieces = [m for m in _PIECE.finditer(text) if not m["rest"]]
    if stray := _PIECE.sub("", text).strip():
        raise Stop("no_joint", stray)
    place = 0
    while place < len(pieces):
        found, used = _taken(pieces, place, known, named)
        yield from found
        place += used


def _taken(
    pieces: Sequence[re.Match[str]], place: int, known: Collection[str], named: bool
) -> tuple[list[_Token], int]:
    """The tokens of the next piece or pieces, and of how many."""
    piece = pieces[place]
    sort, text = str(piece.lastgroup), piece[0]
    if piece["times"]:
        return [_Token("times", piece["n"] or piece["m"], text)], 1
    if sort in ("stop", "comma", "link"):
        return [_Token(sort, "", text)], 1
    if sort == "name":
        return _numbered(text, _is_linked(pieces, place), known), 1
    for length in range(min(_longest(), len(pieces) - place), 0, -1):
        group = pieces[place : place + length]
        if all(p.lastgroup in ("word", "link") for p in group) and group[-1].lastgroup == "word":
            phrase = " ".join(p[0] for p in group if p.lastgroup == "word")
            if (kind := kind_named(phrase)) is not None and (length > 1 or not _is_label(pieces, place)):
                return [_Token("kind", kind, phrase)], length
    return _worded(pieces, place, named), 1


def _is_linked(pieces: Sequence[re.Match[str]], place: int) -> bool:
    around = pieces[max(0, place - 1) : place + 2]
    return any(p.lastgroup == "link" for p in around)


def _is_label(pieces: Sequence[re.Match[str]], place: int) -> bool:
    """Whether a letter is the name of a point, ``en P``, ``pivot R``, and not that of a kind."""
    if len(pieces[place][0]) > 1 or not place:
        return False
    before = pieces[place - 1]
    if before.lastgroup != "word":
        return False
    word = before[0]
    return folded(word) in _said("at") or (len(word) > 1 and kind_named(word) is not None)


def _numbered(text: str, is_linked: bool, known: Collection[str]) -> list[_Token]:
    """A body of a number, ``12`` as two bodies where there is none of that number; ``R12`` says its kind as well."""
    letters = text.rstrip("0123456789")
    number = text[len(letters) :]
    tokens = []
    if letters in _LETTERS:
        tokens = [_Token("kind", _LETTERS[letters], letters)]
    elif letters and letters.casefold() not in ("s", "l", "c") and not is_linked:
        return []  # a point's name
    if number not in known and len(number) > 1 and not is_linked and set(number) <= set(known):
        bodies = [_Token("body", digit, text) for digit in number]
        return tokens + [t for body in bodies for t in (_Token("link"), body)][1:]
    return [*tokens, _Token("body", str(int(number)), text)]


def _worded(pieces: Sequence[re.Match[str]], place: int, named: bool) -> list[_Token]:
    text = pieces[place][0]
    plain = folded(text)
    if plain in _said("frame"):
        return [_Token("body", FRAME, text)]
    if not named and _is_linked(pieces, place):
        return [_Token("body", text.casefold(), text)]
    if plain in _said("and"):
        return [_Token("comma", "", text)]
    if plain in _said("filling") | _said("at"):
        return []
    if _is_linked(pieces, place):
        return [_Token("body", text.casefold(), text)]
    near = get_close_matches(plain, _kinds(), 1, 0.8) if len(plain) > 4 else ()
    if near:
        return [_Token("kind", _kinds()[near[0]], text)]
    if len(text) < 3:
        return []  # the name of a point, of an axis
    if not named:
        return [_Token("body", text.casefold(), text)]
    raise Stop("unknown_joint", text)


# --- joints -----------------------------------------------------------------------------


class _Piece(NamedTuple):
    """What stands between two separators: groups of bodies, and kinds, in the order written."""

    content: tuple[tuple[str, ...] | _Token, ...]
    is_closed: bool  #: a stop follows
    times: int = 1

    @property
    def groups(self) -> list[tuple[str, ...]]:
        return [part for part in self.content if not isinstance(part, _Token)]

    @property
    def kind(self) -> str | None:
        """The kind that is said, in a word before in a letter, which may be the name of a point."""
        kinds = [part for part in self.content if isinstance(part, _Token)]
        kinds.sort(key=lambda token: len(token.text) == 1)
        return kinds[0].said if kinds else None

    @property
    def is_leading(self) -> bool:
        """Whether the kind stands first."""
        return isinstance(self.content[0], _Token)


def _graph(tokens: Sequence[_Token]) -> Graph:
    joints: list[Edge] = []
    waiting: list[tuple[str, ...]] = []
    heading = ""

    def take(groups: Sequence[tuple[str, ...]], kind: str, times: int = 1) -> None:
        joints.extend(joint for group in groups for joint in _joints(group, kind) for _ in range(times))

    for piece in _pieces(tokens):
        groups, kind = piece.groups, piece.kind
        if kind is not None and groups:
            take(waiting, "" if piece.is_leading else kind)
            take(groups, kind, piece.times)
            waiting, heading = [], kind if piece.is_leading else ""
        elif kind is not None:
            take(waiting, kind)
            waiting, heading = [], "" if waiting else kind
        elif heading:
            take(groups, heading, piece.times)
        else:
            waiting += groups * piece.times
        if piece.is_closed and not heading:
            take(waiting, "")
            waiting = []
    take(waiting, "")
    if not joints:
        raise Stop("no_joint", " ".join(token.text for token in tokens))
    if len(joints) > _MOST_JOINTS:
        raise Stop("too_long", "")
    return tuple(joints)


def _joints(group: tuple[str, ...], kind: str) -> Iterator[Edge]:
    """A joint of a group of bodies; one by one along a chain that comes back to a body."""
    if len(group) == 1:
        raise Stop("lone_body", f"{group[0]} {kind}".strip())
    if len(set(group)) == len(group):
        yield edge(group, kind)
        return
    for one, other in pairwise(group):
        if one == other or len(group) == 2:
            raise Stop("one_body", "-".join(group))
        yield edge((one, other), kind)


def _pieces(tokens: Sequence[_Token]) -> Iterator[_Piece]:
    """What stands between separators; of a run without any, ``1-2 pivot 2-3 pivot``, joint by joint."""
    content: list[Any] = []
    singles: list[str] = []
    times, place = 1, 0

    def close() -> None:
        if singles:
            content.append(tuple(singles))
            singles.clear()

    while place < len(tokens):
        token = tokens[place]
        if token.sort == "body":
            chain, used = _chain(tokens, place)
            place += used
            if isinstance(chain, list):  # 1 -R- 2 -P- 3
                yield from (_Piece((pair, kind), False) for pair, kind in chain)
            elif len(chain) == 1:
                singles.append(chain[0])
            else:
                close()
                if _is_full(content):
                    yield _Piece(tuple(content), False, times)
                    content, times = [], 1
                content.append(chain)
            continue
        place += 1
        if token.sort == "kind":
            close()
            if _is_full(content) and isinstance(content[0], _Token) and not _is_point(content[0], token):
                yield _Piece(tuple(content), False, times)
                content, times = [], 1
            content = [part for part in content if not (isinstance(part, _Token) and _is_point(part, token))]
            content.append(token)
        elif token.sort == "times":
            times = int(token.said)
        elif token.sort == "stop" or (token.sort == "comma" and not _goes_on(tokens, place, singles)):
            close()
            if content:
                yield _Piece(tuple(content), token.sort == "stop", times)
            elif token.sort == "stop":
                yield _Piece((), True)
            content, times = [], 1
    close()
    if content:
        yield _Piece(tuple(content), True, times)


def _is_full(content: Sequence[Any]) -> bool:
    return len({isinstance(part, _Token) for part in content}) > 1


def _is_point(letter: _Token, word: _Token) -> bool:
    """Whether a letter that could be a kind is the name of a point, before a kind in words: ``P: 4-5 pivot``."""
    return len(letter.text) == 1 < len(word.text)


def _goes_on(tokens: Sequence[_Token], place: int, singles: Sequence[str]) -> bool:
    """Whether bodies are listed one by one: ``1 and 2``, ``3, 4, 5``."""
    if not singles or place >= len(tokens) or tokens[place].sort != "body":
        return False
    chain, _ = _chain(tokens, place)
    return len(chain) == 1 and not isinstance(chain, list)


def _chain(
    tokens: Sequence[_Token], place: int
) -> tuple[tuple[str, ...] | list[tuple[tuple[str, ...], _Token]], int]:
    """Bodies that are linked, or stand side by side, and of how many tokens; a list of joints where kinds stand between."""
    between, used = _with_kinds_between(tokens, place)
    if between:
        return between, used
    bodies, end, is_linked = [tokens[place].said], place + 1, False
    while end < len(tokens):
        step = 1 if tokens[end].sort == "link" else 0
        if end + step >= len(tokens) or tokens[end + step].sort != "body":
            break
        if not step and (is_linked or _sort(tokens, end + 1) == "link" or tokens[end].said in bodies):
            break  # 1-2 2-3
        is_linked = bool(step)
        bodies.append(tokens[end + step].said)
        end += step + 1
    while _sort(tokens, end) == "link":  # 1-2 - pivot
        end += 1
    return tuple(bodies), end - place


def _sort(tokens: Sequence[_Token], place: int) -> str:
    return tokens[place].sort if place < len(tokens) else ""


def _with_kinds_between(
    tokens: Sequence[_Token], place: int
) -> tuple[list[tuple[tuple[str, ...], _Token]], int]:
    """Joints whose kind stands between their bodies, ``1 -R- 2 -R- 3``, ``1 pivot 2``, and of how many tokens."""
    found: list[tuple[tuple[str, ...], _Token]] = []
    start = place
    while True:
        middle = place + 1 + (_sort(tokens, place + 1) == "link")
        end = middle + 1 + (_sort(tokens, middle + 1) == "link")
        is_bare = end - place == 2
        if _sort(tokens, middle) != "kind" or _sort(tokens, end) != "body":
            break
        if is_bare and (tokens[end].said == tokens[place].said or _sort(tokens, end + 1) in ("link", "body")):
            break
        found.append(((tokens[place].said, tokens[end].said), tokens[middle]))
        place = end
    return found, place + 1 - start


def _framed(graph: Graph, reference: Graph, named: bool) -> Graph:
    """The frame by the number that the reference gives it; 0 is the frame where no other body is called so.

    Where bodies have no names, it is called :data:`FRAME`.
    """
    frame, met = bodies_of(reference)[0] if named else FRAME, set(bodies_of(graph))
    names = {FRAME: frame}
    if not met & {frame, FRAME} and "0" not in bodies_of(reference):
        names["0"] = frame
    return renamed(graph, names)


def _ways(tokens: list[_Token]) -> Iterator[list[_Token]]:
    """The tokens; and with P for a pivot where no pivot is said in another way: G is the slide then, or the answer has both
    honest readings."""
    kinds = [token for token in tokens if token.sort == "kind"]
    if not any(token.text.upper() == "P" for token in kinds) or any(t.said == "revolute" for t in kinds):
        yield tokens
        return
    if not any(token.text.upper() == "G" for token in kinds):
        yield tokens
    yield [t._replace(said="revolute") if t in kinds and t.text.upper() == "P" else t for t in tokens]
