"""Drawing of a student: the text that the drawing surface stores, and the same as a figure.

The text is JSON of at most 20 kB::

    {"v": 1,
     "items": [
       {"k": "point", "id": 1, "x": 12.3, "y": 45.6, "n": "p"},
       {"k": "line", "id": 2, "x": 12.3, "y": 45.6, "a": 127.4},
       {"k": "circle", "id": 3, "x": 12.3, "y": 45.6, "r": 60},
       {"k": "point", "id": 5, "x": 40, "y": 60},
       {"k": "vector", "id": 4, "from": 1, "to": 5, "n": "v10"},
       {"k": "body", "id": 6, "x": 20, "y": 30, "n": "1"},
       {"k": "body", "id": 7, "x": 60, "y": 30, "n": "2"},
       {"k": "joint", "id": 8, "of": [6, 7], "t": "revolute"}
     ],
     "scale": 5,
     "view": [-9, -6, 172]}

Lengths are mm on paper, ``x`` to the right and ``y`` upwards; angles (``a``) are degrees from the x axis,
anticlockwise. ``id`` is a positive whole number, each once. ``n``, where present, is the part that asks for
the point or the vector, or the name of a body. A line passes through its point and has no ends. A ``joint``
connects two bodies or more and states its kind in ``t``, a word or nothing. ``scale`` is the chosen scale, or
null; ``view`` is the left, lower corner and the width of what was seen.

The text comes from a browser and may be anything: whatever departs from this is refused.
"""

from __future__ import annotations

import cmath
import json
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from coursework.errors import BadInput
from coursework.figures.base import Element
from coursework.figures.elements import link, pin, point
from coursework.figures.figure import Figure
from coursework.figures.marks import circle, line, note, vector

MOST_CHARACTERS = 20_000
_MOST_ITEMS = 500
_FARTHEST = 1e5  #: mm
_NAME = re.compile(r"[^\W]{1,60}")
_EDGE_MM = 10.0  #: by which lines go beyond the points
_NUMBERS: Mapping[str, tuple[str, ...]] = {
    "point": ("x", "y"),
    "line": ("x", "y", "a"),
    "circle": ("x", "y", "r"),
    "vector": (),
    "body": ("x", "y"),
    "joint": (),
}
_ENDS = {"vector": "point", "joint": "body"}  #: kind of the items to which an item refers


@dataclass(frozen=True)
class DrawnItem:
    """One item of a drawing."""

    kind: str
    id: int
    name: str = ""  #: of a part, or of a body
    at: complex = 0j  #: mm on paper
    size: float = 0.0  #: radius of a circle in mm, direction of a line in degrees
    ends: tuple[int, ...] = ()  #: items that a vector or a joint connects
    joint: str = ""  #: kind of a joint


@dataclass(frozen=True)
class StudentDrawing:
    """Drawing of a student, as its items by their numbers."""

    items: Mapping[int, DrawnItem]
    scale: float | None = None

    @classmethod
    def parse(cls, text: str) -> StudentDrawing:
        """Read a stored drawing; an empty text is an empty drawing.

        Parameters
        ----------
        text
            JSON as described in :mod:`coursework.figures.student_drawing`.

        Raises
        ------
        BadInput
            The text is too long, or is no such drawing.
        """
        if len(text) > MOST_CHARACTERS:
            raise BadInput(
                "a drawing has at most {most} characters; found {count}",
                most=MOST_CHARACTERS,
                count=len(text),
            )
        if not text.strip():
            return cls(MappingProxyType({}))
        try:
            stored = json.loads(text)
        except (ValueError, RecursionError):
            raise BadInput("the drawing is not JSON") from None
        if not isinstance(stored, dict) or stored.get("v") != 1 or not isinstance(stored.get("items"), list):
            raise BadInput("the drawing has no items, or is of another version")
        if len(stored["items"]) > _MOST_ITEMS:
            raise BadInput(
                "a drawing has at most {most} items; found {count}",
                most=_MOST_ITEMS,
                count=len(stored["items"]),
            )
        items = [_item(entry) for entry in stored["items"]]
        by_id = {item.id: item for item in items}
        if len(by_id) < len(items):
            raise _refused("id", "twice")
        for item in items:
            if any(end not in by_id or by_id[end].kind != _ENDS[item.kind] for end in item.ends):
                raise _refused(item.kind, item.ends)
        scale = stored.get("scale")
        return cls(MappingProxyType(by_id), None if scale is None else _number("scale", scale))

    @property
    def points(self) -> dict[str, complex]:
        """Named points, mm on paper, by the part that asks for each."""
        return {item.name: item.at for item in self.items.values() if item.kind == "point" and item.name}

    @property
    def arrows(self) -> dict[str, tuple[complex, complex]]:
        """Start and end of the named vectors, mm on paper, by the part that asks for each."""
        return {i.name: self._ends(i) for i in self.items.values() if i.kind == "vector" and i.name}

    def figure(self, labels: Mapping[str, str] | None = None) -> Figure | None:
        """Return the drawing as a figure of true size; None for an empty one.

        Parameters
        ----------
        labels
            LaTeX by part, for named points and vectors; those without a label are drawn without a name.
        """
        names = labels or {}
        elements = [element for item in self.items.values() for element in self._elements(item, names)]
        extent = [z for element in elements for z in element.reach()]
        if not any(abs(z - extent[0]) > 0.1 for z in extent):
            return None
        is_graph = any(item.kind == "body" for item in self.items.values())
        return Figure(*elements) if is_graph else Figure(*elements, scale=1)

    def svg(self, labels: Mapping[str, str] | None = None) -> str:
        """Return the drawing as SVG, its letters as outlines; empty for an empty drawing.

        Parameters
        ----------
        labels
            LaTeX by part, as for :meth:`figure`.
        """
        figure = self.figure(labels)
        return figure.outlined_svg() if figure else ""

    def _ends(self, item: DrawnItem) -> tuple[complex, complex]:
        start, end = (self.items[i].at for i in item.ends)
        return start, end

    def _elements(self, item: DrawnItem, labels: Mapping[str, str]) -> tuple[Element, ...]:
        label = labels.get(item.name)
        match item.kind:
            case "point":
                return (point(item.at, label),)
            case "line":
                return self._line(item)
            case "circle":
                return (circle(item.at, item.size, dashed=True),)
            case "vector":
                start, end = self._ends(item)
                return (vector(start, end - start, label),) if abs(end - start) > 0.01 else ()
            case "body":
                return pin(item.at), note(item.at, item.name)
        bodies = [self.items[i].at for i in item.ends]
        middle = sum(bodies) / len(bodies)
        if len(bodies) == 2:
            return (link(*bodies),) if abs(bodies[1] - bodies[0]) > 0.01 else ()
        return tuple(link(middle, body) for body in bodies if abs(body - middle) > 0.01)

    def _line(self, item: DrawnItem) -> tuple[Element, ...]:
        """Return a line as far as the points and circles of the drawing reach along it."""
        along = cmath.rect(1.0, math.radians(item.size))
        reach = [item.at]
        for other in self.items.values():
            if other.kind in ("point", "circle"):
                reach += [other.at - along * other.size, other.at + along * other.size]
        places = [((z - item.at) * along.conjugate()).real for z in reach]
        start, end = (item.at + along * s for s in (min(places) - _EDGE_MM, max(places) + _EDGE_MM))
        return (line(start, end),)


def is_drawn(text: str) -> bool:
    """Return whether a text is a drawing with at least one item."""
    try:
        return bool(StudentDrawing.parse(text).items)
    except BadInput:
        return False


def _item(entry: Any) -> DrawnItem:
    kind = entry.get("k") if isinstance(entry, dict) else None
    if not isinstance(kind, str) or kind not in _NUMBERS:
        raise _refused("k", kind)
    number, name = entry.get("id"), entry.get("n", "")
    if isinstance(number, bool) or not isinstance(number, int) or not 0 < number < 1_000_000:
        raise _refused("id", number)
    if not isinstance(name, str) or (name and not _NAME.fullmatch(name)) or (kind == "body" and not name):
        raise _refused("n", name)
    x, y, size = [*(_number(key, entry.get(key)) for key in _NUMBERS[kind]), 0.0, 0.0, 0.0][:3]
    if kind == "circle" and not size > 0:
        raise _refused("r", size)
    ends: Any = (
        [entry.get("from"), entry.get("to")]
        if kind == "vector"
        else entry.get("of", ())
        if kind == "joint"
        else ()
    )
    is_list = isinstance(ends, (list, tuple)) and all(type(end) is int for end in ends)
    if not is_list or (kind == "joint" and not 2 <= len(set(ends)) <= 20):
        raise _refused("of", ends)
    joint = entry.get("t", "")
    if not isinstance(joint, str) or (joint and not _NAME.fullmatch(joint)):
        raise _refused("t", joint)
    return DrawnItem(kind, number, name, complex(x, y), size, tuple(ends), joint)


def _number(key: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) <= _FARTHEST:
        raise _refused(key, value)
    return float(value)


def _refused(key: str, value: Any) -> BadInput:
    return BadInput("the drawing has an item with {key} = {value!r}", key=key, value=str(value)[:40])
