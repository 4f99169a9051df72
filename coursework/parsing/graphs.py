"""Joint graphs as people write them: a list of joints, each by its bodies and its kind, in any order and
notation."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from itertools import pairwise
from typing import Any, NamedTuple

from coursework.parsing.graph_tokens import FRAME, Token, kind_named, plain, tokens_of
from coursework.parsing.reading import Reading, Stop, text_of
from coursework.parsing.spelling import shorten, unwrapped

_MOST = 4000  #: characters of an answer
_MOST_JOINTS = 60
_WORD = 3  #: letters of what may be a word of a sentence, ``idem que``, or a unit, ``rad/s``
LETTER_OF = {"revolute": "R", "prismatic": "P", "higher": "H"}  #: as on the drawn graph


class Edge(NamedTuple):
    """Bodies held together by one joint, in natural order; ``kind`` is empty where none is said."""

    bodies: tuple[str, ...]
    kind: str

    @property
    def pairs(self) -> int:
        """Return the number of pairs that the edge counts for: a pivot of k bodies is k - 1."""
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
    """Return the graph with other names of bodies."""
    return in_order(edge([names.get(b, b) for b in joint.bodies], joint.kind) for joint in graph)


@lru_cache(maxsize=2048)
def graph_of(text: str) -> Graph:
    """Return a graph as solutions state it: ``1-2 revolute, 3-4-5 revolute, 1-6 prismatic``."""
    joints = (word.split() for word in text.split(","))
    return in_order(edge(bodies.split("-"), kind) for bodies, kind in joints)


def bodies_of(graph: Graph) -> tuple[str, ...]:
    """Return the names of the bodies, in natural order."""
    return tuple(sorted({body for joint in graph for body in joint.bodies}, key=natural))


def spelled(graph: Graph) -> str:
    """Return a graph in letters, as a figure bears them: ``1–2 R, 1–4 P``; kinds that have none by their
    name."""
    return ", ".join(f"{joint} {LETTER_OF.get(joint.kind, joint.kind)}".strip() for joint in graph)


def read_graph(answer: Any, reference: Graph, *, named: bool = True) -> Reading:
    """Return the joints that an answer lists; the value is a :data:`Graph`, or two where ``P`` may be a pivot
    or a slide.

    ``1-2 pivot, 2-3 pivot, 1-4 glissière``, ``2/1 R; …``, ``pivot: 1-2, 2-3; slide: 1-4``, ``S1-S2``,
    ``1 -R- 2``, lines, a list of tuples or records; a joint without a kind is read. The bodies of the
    ``reference`` tell ``12`` from ``1-2``; with ``named=False`` any word may be a body.
    """
    if not isinstance(answer, str):
        answer = "" if answer is None else _as_text(answer)
    if not answer.strip():
        return Reading(answer, "missing")
    if len(answer) > _MOST:
        return Reading(answer, "unreadable", code="too_long", found=shorten(answer))
    try:
        tokens = [*tokens_of(plain(unwrapped(answer)), frozenset(bodies_of(reference)), named)]
        values = tuple(map(_graph, _ways(_framed(tokens, reference, named))))
        _refuse_strangers(values, reference, named, tokens)
    except Stop as stop:
        return Reading(answer, "unreadable", code=stop.code, found=shorten(stop.found))
    return Reading(answer, "read", values, tuple(map(spelled, values)))


def _refuse_strangers(
    values: Sequence[Graph], reference: Graph, named: bool, tokens: Sequence[Token]
) -> None:
    """Refuse a graph that speaks of none of the mechanism's bodies, ``rad/s``, or of one joint without its
    kind: ``p. 12``.

    Where bodies have no names, words are bodies if something links them: ``not a slider either`` is a
    sentence.
    """
    body_names = {*bodies_of(reference), FRAME}
    has_kind = any(token.sort == "kind" and (len(token.text) > 1 or token.text.isupper()) for token in tokens)
    is_linked = has_kind and any(token.sort == "link" for token in tokens)
    for graph in values:
        bodies = bodies_of(graph)
        is_known = (
            not body_names.isdisjoint(bodies) if named else is_linked or all(len(b) < _WORD for b in bodies)
        )
        if not is_known or (len(graph) == 1 and not has_kind):
            raise Stop("no_joint", spelled(graph))


def _as_text(answer: Any) -> str:
    """Return a list of tuples, of records or of texts, as text, a joint a line."""
    if isinstance(answer, Mapping):
        answer = [answer] if "between" in answer else [*answer.items()]
    if not isinstance(answer, (list, tuple, set, frozenset)):
        return text_of(answer)
    if isinstance(answer, (set, frozenset)):
        answer = sorted(answer, key=text_of)
    return "\n".join(map(_line, answer))


def _line(element: Any) -> str:
    if isinstance(element, Mapping):
        element = (element.get("between", ()), element.get("kind", ""))
    if not isinstance(element, (list, tuple)):
        return text_of(element)
    flat = [part for item in element for part in (item if isinstance(item, (list, tuple)) else (item,))]
    bodies = [text_of(part) for part in flat if not _is_word(part)]
    return " - ".join(bodies) + " " + " ".join(text_of(part) for part in flat if _is_word(part))


def _is_word(part: Any) -> bool:
    return isinstance(part, str) and kind_named(part) is not None


# --- joints -----------------------------------------------------------------------------


class _Piece(NamedTuple):
    """Text between two separators: groups of bodies, and kinds, in the order written."""

    content: tuple[tuple[str, ...] | Token, ...]
    is_closed: bool  #: a stop follows
    times: int = 1

    @property
    def groups(self) -> list[tuple[str, ...]]:
        return [part for part in self.content if not isinstance(part, Token)]

    @property
    def kind(self) -> str | None:
        """The kind that is said, in a word before in a letter, which may be the name of a point."""
        kinds = [part for part in self.content if isinstance(part, Token)]
        kinds.sort(key=lambda token: len(token.text) == 1)
        return kinds[0].said if kinds else None

    @property
    def is_leading(self) -> bool:
        """Return whether the kind stands first."""
        return isinstance(self.content[0], Token)


def _graph(tokens: Sequence[Token]) -> Graph:
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
    return in_order(joints)


def _joints(group: tuple[str, ...], kind: str) -> Iterator[Edge]:
    """Yield a joint of a group of bodies; one by one along a chain that comes back to a body."""
    if len(group) == 1:
        raise Stop("lone_body", group[0])
    if len(set(group)) == len(group):
        yield edge(group, kind)
        return
    for pair, other in pairwise(group):
        if pair == other or len(group) == 2:
            raise Stop("one_body", "-".join(group))
        yield edge((pair, other), kind)


def _pieces(tokens: Sequence[Token]) -> Iterator[_Piece]:
    """Yield the pieces between separators; split a run without any, ``1-2 pivot 2-3 pivot``, joint by
    joint."""
    content: list[Any] = []
    singles: list[str] = []
    times, start = 1, 0

    def close() -> None:
        if singles:
            content.append(tuple(singles))
            singles.clear()

    while start < len(tokens):
        token = tokens[start]
        if token.sort == "body":
            chain, used = _chain(tokens, start)
            start += used
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
        start += 1
        if token.sort == "kind":
            close()
            if _is_full(content) and isinstance(content[0], Token) and not _is_point(content[0], token):
                yield _Piece(tuple(content), False, times)
                content, times = [], 1
            content = [part for part in content if not (isinstance(part, Token) and _is_point(part, token))]
            content.append(token)
        elif token.sort == "times":
            times = int(token.said)
        elif token.sort == "stop" or (token.sort == "comma" and not _goes_on(tokens, start, singles)):
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
    return len({isinstance(part, Token) for part in content}) > 1


def _is_point(letter: Token, word: Token) -> bool:
    """Return whether a letter that could be a kind is the name of a point, before a kind in words: ``P: 4-5
    pivot``."""
    return len(letter.text) == 1 < len(word.text)


def _goes_on(tokens: Sequence[Token], index: int, singles: Sequence[str]) -> bool:
    """Return whether a list of bodies goes on, each by itself: ``1 and 2``, ``3, 4, 5``."""
    if not singles or index >= len(tokens) or tokens[index].sort != "body":
        return False
    chain, _ = _chain(tokens, index)
    return len(chain) == 1 and not isinstance(chain, list)


def _chain(
    tokens: Sequence[Token], index: int
) -> tuple[tuple[str, ...] | list[tuple[tuple[str, ...], Token]], int]:
    """Bodies that are linked, or stand side by side, and of how many tokens; a list of joints where kinds
    stand between."""
    between, used = _with_kinds_between(tokens, index)
    if between:
        return between, used
    bodies, end, is_linked = [tokens[index].said], index + 1, False
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
    return tuple(bodies), end - index


def _sort(tokens: Sequence[Token], index: int) -> str:
    return tokens[index].sort if index < len(tokens) else ""


def _with_kinds_between(
    tokens: Sequence[Token], index: int
) -> tuple[list[tuple[tuple[str, ...], Token]], int]:
    """Joints whose kind stands between their bodies, ``1 -R- 2 -R- 3``, ``1 pivot 2``, and of how many
    tokens."""
    edges: list[tuple[tuple[str, ...], Token]] = []
    start = index
    while True:
        middle = index + 1 + (_sort(tokens, index + 1) == "link")
        end = middle + 1 + (_sort(tokens, middle + 1) == "link")
        is_bare = end - index == 2
        if _sort(tokens, middle) != "kind" or _sort(tokens, end) != "body":
            break
        if is_bare and (tokens[end].said == tokens[index].said or _sort(tokens, end + 1) in ("link", "body")):
            break
        edges.append(((tokens[index].said, tokens[end].said), tokens[middle]))
        index = end
    return edges, index + 1 - start


def _framed(tokens: list[Token], reference: Graph, named: bool) -> list[Token]:
    """Return the frame by the number that the reference gives it; 0 is the frame where no other body is
    called so.

    Where bodies have no names, it is called :data:`FRAME`.
    """
    frame = bodies_of(reference)[0] if named else FRAME
    names = {FRAME: frame}
    if "0" not in bodies_of(reference) and not any(
        t.sort == "body" and t.said in (frame, FRAME) for t in tokens
    ):
        names["0"] = frame
    return [t._replace(said=names.get(t.said, t.said)) if t.sort == "body" else t for t in tokens]


def _ways(tokens: list[Token]) -> Iterator[list[Token]]:
    """Yield the tokens; and with P for a pivot where no pivot is said in another way: G is the slide then, or
    the answer has both honest readings."""
    kinds = [token for token in tokens if token.sort == "kind"]
    if not any(token.text.upper() == "P" for token in kinds) or any(t.said == "revolute" for t in kinds):
        yield tokens
        return
    if not any(token.text.upper() == "G" for token in kinds):
        yield tokens
    yield [t._replace(said="revolute") if t in kinds and t.text.upper() == "P" else t for t in tokens]
