"""Comparison of joint graphs: joint by joint where the bodies are named, up to renaming where they are
not."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations, islice, product

from coursework.parsing.graph_tokens import FRAME
from coursework.parsing.graphs import Edge, Graph, bodies_of, edge, natural, renamed

_STEPS = 20_000  #: of the search for names that fit
_SPANNED = 64  #: ways in which shared pivots may be written as pairs that are tried
_ROUNDS = 40  #: of exchanging names
_STARTS = 8  #: of such rounds
_CONTACTS = {
    "higher": ("higher", "point_contact", "line_contact"),
    "point_contact": ("higher", "point_contact"),
    "line_contact": ("higher", "line_contact"),
}


def same_kind(kind: str, wanted: str) -> bool:
    """Return whether a kind of joint is the wanted one; any contact is a higher pair of the plane."""
    return kind in _CONTACTS.get(wanted, (wanted,))


@dataclass
class Compared:
    """The joints of an answer, by what is to be said of them; those that are right are counted in pairs."""

    total: int  #: pairs of the reference
    right: int = 0
    kind: list[Edge] = field(default_factory=list)  #: the right bodies, not of that kind
    no_kind: list[Edge] = field(default_factory=list)
    none: list[Edge] = field(default_factory=list)  #: bodies that are not joined
    double: list[Edge] = field(default_factory=list)
    #: One pair too many of a pivot that several bodies share.
    shared: list[Edge] = field(default_factory=list)
    not_shared: list[Edge] = field(default_factory=list)
    unknown: list[Edge] = field(default_factory=list)

    @property
    def halves(self) -> int:
        """Pairs of which the kind is wrong or missing."""
        return sum(joint.pairs for joint in (*self.kind, *self.no_kind))

    @property
    def beside(self) -> int:
        """Pairs that are none."""
        lists = (self.none, self.double, self.shared, self.not_shared, self.unknown)
        return sum(joint.pairs for joints in lists for joint in joints)

    @property
    def missing(self) -> int:
        return self.total - self.right - self.halves

    @property
    def is_right(self) -> bool:
        return self.right == self.total and not self.beside

    @property
    def share(self) -> float:
        """A joint right gives its share, one of another kind half of it, one that is none takes as much away;
        0 at least."""
        return max(0.0, (self.right + 0.5 * self.halves - self.beside) / self.total)


class _Pivot:
    """A pivot that several bodies share, and how its bodies are held together so far."""

    def __init__(self, joint: Edge):
        self.joint = joint
        self.groups = [{body} for body in joint.bodies]

    def joins(self, bodies: Sequence[str]) -> bool:
        """Join these bodies at the pivot, and return True, if they belong to it and are not joined there
        yet."""
        touched = [group for group in self.groups if group & set(bodies)]
        if len(touched) != len(bodies) or not set(bodies) <= set(self.joint.bodies):
            return False
        self.groups = [g for g in self.groups if g not in touched] + [set().union(*touched)]
        return True


def compare(answer: Graph, reference: Graph) -> Compared:
    """Return the joints of an answer against those of a mechanism with the same names."""
    result = Compared(sum(joint.pairs for joint in reference))
    bodies = set(bodies_of(reference))
    pairs: dict[tuple[str, ...], list[str]] = {}
    for joint in reference:
        if joint.pairs == 1:
            pairs.setdefault(joint.bodies, []).append(joint.kind)
    pivots = [_Pivot(joint) for joint in reference if joint.pairs > 1]
    rest = _record_of_all(answer, pivots, bodies, result)
    rest = [joint for joint in rest if not _is_right(joint, pairs, pivots, result)]
    for joint in rest:
        _record_fault(joint, pairs, pivots, reference, result)
    return result


def _record_of_all(answer: Graph, pivots: Sequence[_Pivot], bodies: set[str], result: Compared) -> list[Edge]:
    """Record unknown bodies, and pivots written with all their bodies; return the joints that are left to
    compare."""
    rest = []
    for joint in sorted(answer, key=lambda joint: -joint.pairs):
        if not bodies.issuperset(joint.bodies):
            result.unknown.append(joint)
        elif joint.pairs == 1:
            rest.append(joint)
        elif (pivot := next((p for p in pivots if p.joins(joint.bodies)), None)) is None:
            result.not_shared.append(joint)
        else:
            _count(joint, pivot.joint.kind, result)
    return rest


def _count(joint: Edge, kind: str, result: Compared) -> None:
    if same_kind(joint.kind, kind):
        result.right += joint.pairs
    else:
        (result.kind if joint.kind else result.no_kind).append(joint)


def _is_right(
    joint: Edge, pairs: Mapping[tuple[str, ...], list[str]], pivots: Sequence[_Pivot], result: Compared
) -> bool:
    wanted = pairs.get(joint.bodies, [])
    same = next((kind for kind in sorted(wanted, key=joint.kind.__ne__) if same_kind(joint.kind, kind)), None)
    if same is not None:
        wanted.remove(same)
    elif not any(same_kind(joint.kind, p.joint.kind) and p.joins(joint.bodies) for p in pivots):
        return False
    result.right += 1
    return True


def _record_fault(
    joint: Edge,
    pairs: Mapping[tuple[str, ...], list[str]],
    pivots: Sequence[_Pivot],
    reference: Graph,
    result: Compared,
) -> None:
    """Record why a pair is not right: its kind is another, it is written once too often, or its bodies are
    not joined."""
    if pairs.get(joint.bodies):
        _count(joint, pairs[joint.bodies].pop(), result)
    elif any(p.joins(joint.bodies) for p in pivots):
        (result.kind if joint.kind else result.no_kind).append(joint)
    elif any(set(joint.bodies) <= set(p.joint.bodies) for p in pivots):
        result.shared.append(joint)
    elif any(joint.bodies == other.bodies for other in reference):
        result.double.append(joint)
    else:
        result.none.append(joint)


# --- up to names ------------------------------------------------------------------------


def names_that_fit(answer: Graph, reference: Graph, known: Mapping[str, str]) -> dict[str, str] | None:
    """For each body of an answer the one that it stands for, such that all joints are right; None where there
    are none.

    ``known`` are names that are given. A shared pivot may be written as pairs in any way that spans it.
    """
    if len(bodies_of(answer)) != len(bodies_of(reference)):
        return None
    mine = _Pairs([pair for joint in answer for pair in next(_spanned(joint))])
    for ways in islice(product(*map(_spanned, reference)), _SPANNED):
        for names in _alike(mine, _Pairs([pair for pairs in ways for pair in pairs]), known):
            if compare(renamed(answer, names), reference).is_right:
                return names
    return None


def nearest_names(answer: Graph, reference: Graph, known: Mapping[str, str]) -> dict[str, str]:
    """Names by which much of an answer is right: the best that exchanging two at a time leads to, from some
    starts."""
    mine, theirs = (_by_joints(graph) for graph in (answer, reference))
    free = [body for body in mine if body not in known]
    open_to = [body for body in theirs if body not in known.values()]
    open_to += [f"?{n}" for n in range(len(free) - len(open_to))]
    starts = min(_STARTS, len(open_to) or 1)
    tried = [_climbed(answer, reference, known, free, [*open_to[n:], *open_to[:n]]) for n in range(starts)]
    return max(tried, key=lambda names: compare(renamed(answer, names), reference).share)


def _climbed(
    answer: Graph, reference: Graph, known: Mapping[str, str], free: Sequence[str], open_to: Sequence[str]
) -> dict[str, str]:
    names = {**known, **dict(zip(free, open_to, strict=False))}
    spare = list(open_to[len(free) :])
    first = compare(renamed(answer, names), reference)
    best = 2 * first.right + first.halves
    for _ in range(_ROUNDS):
        better = next(_better(answer, reference, names, free, spare, best), None)
        if better is None:
            break
        names, best, spare = better
    return names


def _better(
    answer: Graph,
    reference: Graph,
    names: dict[str, str],
    free: Sequence[str],
    spare: Sequence[str],
    best: int,
) -> Iterator[tuple[dict[str, str], int, list[str]]]:
    """Names that two bodies exchange, or that one takes of those to spare, if more is right by them."""
    tried = [({**names, a: names[b], b: names[a]}, list(spare)) for a, b in combinations(free, 2)]
    tried += [({**names, a: new}, [*(s for s in spare if s != new), names[a]]) for a in free for new in spare]
    for other, left in tried:
        result = compare(renamed(answer, other), reference)
        if (right := 2 * result.right + result.halves) > best:
            yield other, right, left


def _by_joints(graph: Graph) -> list[str]:
    """Return the bodies, those with most joints first."""
    counts = Counter(body for joint in graph for body in joint.bodies)
    return sorted(counts, key=lambda body: (-counts[body], natural(body)))


class _Pairs:
    """Pairs of bodies as each body sees them, for the search of names."""

    def __init__(self, pairs: Sequence[Edge]):
        self.kinds: dict[str, dict[str, list[str]]] = {}
        for pair in pairs:
            for bodies, other in (pair.bodies, pair.bodies[::-1]):
                kinds = self.kinds.setdefault(bodies, {}).setdefault(other, [])
                kinds.append("higher" if pair.kind in _CONTACTS else pair.kind)
                kinds.sort()

    def seen(self, body: str) -> list[list[str]]:
        return sorted(self.kinds[body].values())


def _alike(mine: _Pairs, theirs: _Pairs, known: Mapping[str, str]) -> Iterator[dict[str, str]]:
    """Names by which pairs are the same, found body by body along the joints; no more than so many steps."""
    order = _along(mine)
    steps = 0

    def search(names: dict[str, str]) -> Iterator[dict[str, str]]:
        nonlocal steps
        if len(names) == len(order):
            yield dict(names)
            return
        body = order[len(names)]
        for other in [known[body]] if body in known else sorted(theirs.kinds, key=natural):
            steps += 1
            if steps > _STEPS:
                return
            if other in names.values() or mine.seen(body) != theirs.seen(other):
                continue
            if all(mine.kinds[body].get(b) == theirs.kinds[other].get(n) for b, n in names.items()):
                yield from search({**names, body: other})

    if (
        len(mine.kinds) == len(theirs.kinds)
        and set(known) <= set(order)
        and set(known.values()) <= set(theirs.kinds)
    ):
        yield from search({})


def _along(pairs: _Pairs) -> list[str]:
    """Return the bodies, each after a neighbour where it has one."""
    order: list[str] = []
    while rest := [body for body in sorted(pairs.kinds, key=natural) if body not in order]:
        order.append(next((b for b in rest if any(o in order for o in pairs.kinds[b])), rest[0]))
    return order


def _spanned(joint: Edge) -> Iterator[list[Edge]]:
    """Yield the ways to hold k bodies together by k - 1 pairs: k to the power k - 2 of them, by their Prüfer
    sequences."""
    bodies = joint.bodies
    for sequence in product(bodies, repeat=len(bodies) - 2):
        degrees = Counter([*bodies, *sequence])
        pairs = []
        for body in sequence:
            leaf = next(b for b in bodies if degrees[b] == 1)
            pairs.append(edge((leaf, body), joint.kind))
            degrees[leaf] -= 1
            degrees[body] -= 1
        last = [b for b in bodies if degrees[b] == 1]
        yield [*pairs, edge(last, joint.kind)]


def held_names(answer: Graph, reference: Graph) -> dict[str, str]:
    """Return the frame, where an answer calls a body so."""
    return {FRAME: bodies_of(reference)[0]} if FRAME in bodies_of(answer) else {}
