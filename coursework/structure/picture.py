"""Joint graph as a figure: a circle for each body, a line for each joint, a dot for a multiple pivot."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Sequence
from itertools import combinations

from coursework.figures import Figure, circle, contact, line, note
from coursework.figures.ink import added
from coursework.structure.joints import FRAME, JointGraph, PlaneJoint, Record

_LETTERS = {"revolute": "R", "prismatic": "P", "higher": "H"}
_RADIUS = 4.5  #: of a body's circle
_RING = 30.0  #: of the circle on which the bodies stand

Line = tuple[complex, complex]


def kinematic_graph(joints: JointGraph | Iterable[Record]) -> Figure:
    """Draw bodies as numbered circles (the frame has a second one), joints as lines with the letter of their
    kind.

    Two joints of the same two bodies are drawn side by side; a pivot of several bodies is a dot with a line
    to each.

    Parameters
    ----------
    joints
        Records or a graph.

    Returns
    -------
    The figure.

    Raises
    ------
    WrongValue
        Records that are not a mechanism (:meth:`JointGraph.of`).
    """
    graph = JointGraph.of(joints)
    places = _places(graph)
    elements = []
    for body, position in places.items():
        elements += [circle(position, _RADIUS), note(position, str(body))]
    elements.append(circle(places[FRAME], _RADIUS * 1.2))
    for joint in graph.joints:
        if len(joint.bodies) > 2:
            hub = _hub(joint, places)
            elements.append(contact(hub, _LETTERS[joint.kind]))
            elements += [line(*_between(places[body], hub, ends=False), thin=False) for body in joint.bodies]
    for bodies in dict.fromkeys(j.bodies for j in graph.joints if len(j.bodies) == 2):
        several = [j for j in graph.joints if j.bodies == bodies]
        p, q = (places[body] for body in bodies)
        for index, joint in enumerate(several):
            aside = 1j * (q - p) / abs(q - p) * 2.5 * (2 * index + 1 - len(several))
            first, other = _between(p, q)
            elements.append(line(first + aside, other + aside, thin=False, label=_LETTERS[joint.kind]))
    return Figure(*elements)


def _between(p: complex, q: complex, *, ends: bool = True) -> Line:
    """Return the line from rim to rim, or from the rim of p to the point q."""
    direction = (q - p) / abs(q - p) * _RADIUS * 1.2
    return p + direction, q - direction if ends else q


def _hub(joint: PlaneJoint, places: dict[int, complex]) -> complex:
    """Return the position of a multiple pivot: the mean of its bodies, drawn towards the middle of the
    figure."""
    return 0.8 * added(places[body] for body in joint.bodies) / len(joint.bodies)


def _places(graph: JointGraph) -> dict[int, complex]:
    """Return positions of the bodies around a circle, the frame below, in an order with few crossings."""
    order = list(graph.moving)
    best = _tangle(graph, order)
    improving = True
    while improving and best:
        improving = False
        for i, j in combinations(range(len(order)), 2):
            other = order[:]
            other[i], other[j] = other[j], other[i]
            crossings = _tangle(graph, other)
            if crossings < best:
                order, best, improving = other, crossings, True
    return _on_circle(order)


def _on_circle(order: Sequence[int]) -> dict[int, complex]:
    count = len(order) + 1
    ring = _RING * max(1.0, count / 8)
    return {
        body: 1.25 * z.real + 1j * z.imag
        for index, body in enumerate((FRAME, *order))
        for z in (cmath.rect(ring, -math.pi / 2 + 2 * math.pi * index / count),)
    }


def _tangle(graph: JointGraph, order: Sequence[int]) -> int:
    """Count crossings of lines, and with weight 3 lines that pass through a foreign circle or dot."""
    places = _on_circle(order)
    lines: list[Line] = []
    for joint in graph.joints:
        if len(joint.bodies) > 2:
            lines += [(places[body], _hub(joint, places)) for body in joint.bodies]
        else:
            lines.append((places[joint.bodies[0]], places[joint.bodies[1]]))
    crossings = sum(_cross(first, other) for first, other in combinations(lines, 2))
    dots = [*places.values(), *(_hub(joint, places) for joint in graph.joints if len(joint.bodies) > 2)]
    return crossings + 3 * sum(_passes(a, b, z) for a, b in lines for z in dots)


def _cross(first: Line, other: Line) -> bool:
    if set(first) & set(other):
        return False

    def side(a: complex, b: complex, c: complex) -> bool:
        return ((b - a).conjugate() * (c - a)).imag > 0

    (a, b), (c, d) = first, other
    return side(a, b, c) != side(a, b, d) and side(c, d, a) != side(c, d, b)


def _passes(a: complex, b: complex, position: complex) -> bool:
    if position in (a, b):
        return False
    along = ((position - a) * (b - a).conjugate()).real / abs(b - a) ** 2
    return 0 < along < 1 and abs(a + along * (b - a) - position) < 1.3 * _RADIUS
