"""A joint graph of bodies that have no names on the sheet: right up to what a student calls them."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from coursework.kinds.graph import JointGraphKind, _graph
from coursework.parsing.graph_likeness import Compared, compare, held_names, names_that_fit, nearest_names
from coursework.parsing.graphs import Graph, renamed


class UnnamedGraph(JointGraphKind):
    """As :class:`~coursework.kinds.graph.JointGraphKind`; any numbers, letters or words may stand for the
    bodies. Who says which is the frame (``frame``, ``bâti``, 0) must be right in that."""

    name = "unnamed_graph"
    named = False

    def compared(self, value: Any, reference: Any) -> Compared:
        return _compared_best(_graph(value), _graph(reference))


@lru_cache(maxsize=4096)
def _compared_best(value: Graph, reference: Graph) -> Compared:
    """Return the comparison under the renaming of the bodies that suits the answer best."""
    held = held_names(value, reference)
    names = names_that_fit(value, reference, held) or nearest_names(value, reference, held)
    return compare(renamed(value, names), reference)
