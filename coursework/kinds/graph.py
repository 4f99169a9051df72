"""A joint graph as a list of joints, by the names that the bodies have on the sheet."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import lru_cache
from itertools import pairwise
from typing import Any, ClassVar

from coursework.kinds.kind import AnswerSpelling, Asking, Kind, Stated
from coursework.language.words import words
from coursework.parsing.graph_likeness import Compared, compare, names_that_fit
from coursework.parsing.graphs import Edge, Graph, graph_of, read_graph, spelled
from coursework.parsing.reading import Reading

_RENAMED = 0.5  #: share of the points for the right graph under other names


def _graph(value: Any) -> Graph:
    """Return a graph as it was read, or as a solution states it."""
    return graph_of(value) if isinstance(value, str) else value


class JointGraphKind(Kind):
    """The solution returns it as text, ``1-2 revolute, 3-4-5 revolute, 1-6 prismatic``: of bodies that one
    pivot holds together, all in one joint. The frame is the body of the lowest number."""

    name = "graph"
    is_exact = is_text = has_rule = share_stands = True
    has_symbol = is_called_by_symbol = False
    box = "lines"
    field = "written"
    room, most_lines = 3, 20
    family = "graph"
    wrong = "wrong_graph"
    quoted = ("unknown_joint", "one_body", "lone_body")
    faults: ClassVar[dict[str, str]] = {}
    named: ClassVar[bool] = True  #: whether the sheet names the bodies

    def read(self, answer: Any, part: Stated, asking: Asking) -> Reading:
        return read_graph(answer, graph_of(str(asking.reference(part.quantity))), named=self.named)

    def kept(self, read_as: str) -> Any:
        return read_as

    def compared(self, value: Any, reference: Any) -> Compared:
        """Return the comparison of an answer with the reference, joint by joint."""
        return _compared(_graph(value), _graph(reference))

    def distance(
        self, part: Stated, value: Any, reference: Any, along: Any = None, envelope: float = 0.0
    ) -> float:
        return 0.0 if self.compared(value, reference).is_right else math.inf

    def share(self, part: Stated, value: Any, reference: Any) -> float:
        by_joints = self.compared(value, reference).share
        return max(by_joints, _RENAMED) if self._is_renamed(value, reference) else by_joints

    def _is_renamed(self, value: Any, reference: Any) -> bool:
        """Return whether the answer is the right graph under other names of the bodies."""
        return self.named and names_that_fit(_graph(value), _graph(reference), {}) is not None

    def remarks(self, part: Stated, value: Any, reference: Any, lang: str) -> Iterator[tuple[str, str]]:
        if self._is_renamed(value, reference):
            yield words(lang)["marking"]["graph"]["renamed"], ""
            return
        comparison = self.compared(value, reference)
        for remark, sentence in words(lang)["marking"]["graph"].items():
            if remark == "missing" and comparison.missing:
                yield sentence, str(comparison.missing)
            elif joints := getattr(comparison, remark, None):
                yield sentence, ", ".join(dict.fromkeys(map(str, joints)))

    def others(self, part: Stated, value: Any, half_width: float) -> tuple[Any, ...]:
        graph = _graph(value)
        other = "prismatic" if graph[0].kind == "revolute" else "revolute"
        return ((graph[0]._replace(kind=other), *graph[1:]), graph[1:])

    def called(self, case: str, lang: str) -> str:
        return str(words(lang)["graph"]["kinds"][case][0])

    def words(self, value: Any, label: Callable[[str], str]) -> str:
        return ", ".join(
            f"{joint} {label(joint.kind) if joint.kind else ''}".strip() for joint in _graph(value)
        )

    def written(self, value: Any, digits: int, label: Callable[[str], str]) -> str:
        return self.words(value, label)

    def spellings(self, part: Stated, value: Any, label: Callable[[str], str]) -> Iterator[AnswerSpelling]:
        graph = _graph(value)
        back = tuple(joint._replace(bodies=joint.bodies[::-1]) for joint in reversed(graph))
        yield AnswerSpelling("exact", str(value))
        yield AnswerSpelling("printed", self.written(value, 6, label))
        yield AnswerSpelling("letters", spelled(graph))
        yield AnswerSpelling("slashes", "; ".join(f"{'/'.join(j.bodies)} : {label(j.kind)}" for j in back))
        yield AnswerSpelling("lines", "\n".join(f"- {label(j.kind)} {' '.join(j.bodies)}" for j in back))
        yield AnswerSpelling(
            "with S", ", ".join(f"{'-'.join('S' + b for b in j.bodies)} {label(j.kind)}" for j in graph)
        )
        yield AnswerSpelling("by kind", "\n".join(_by_kind(graph, label)))
        yield AnswerSpelling(
            "as pairs", ", ".join(f"{a}-{b} {label(j.kind)}" for j in back for a, b in _chained(j))
        )
        yield AnswerSpelling("records", [{"between": list(j.bodies), "kind": j.kind} for j in graph])
        yield AnswerSpelling("tuples", [(*j.bodies, label(j.kind)) for j in back])


@lru_cache(maxsize=4096)
def _compared(value: Graph, reference: Graph) -> Compared:
    return compare(value, reference)


def _by_kind(graph: Graph, label: Callable[[str], str]) -> Iterator[str]:
    """Yield a line a kind: ``pivot: 1-2, 2-3``."""
    for kind in dict.fromkeys(joint.kind for joint in graph):
        yield f"{label(kind)}: " + ", ".join("-".join(j.bodies) for j in graph if j.kind == kind)


def _chained(joint: Edge) -> Iterator[tuple[str, str]]:
    """Yield a shared pivot as pairs, one body after another."""
    return pairwise(joint.bodies)
