"""Decomposition of a plane mechanism into a driver and Assour groups.

With the driver taken away, the pairs hold the other bodies in place: two conditions a pair, three unknowns a
body. Conditions are given out to the unknowns that they settle; bodies that settle each other, in a ring,
are one group. This finds the smallest sets without trying sets, for any number of bodies.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from coursework.errors import Undefined, WrongValue
from coursework.structure.joints import FRAME, JointGraph, Record

Node = tuple[str, int]  #: ("body", number) or ("pin", index of a joint)


@dataclass(frozen=True)
class AssourGroup:
    """Bodies of an Assour group, in increasing order, and its class, from 2 on."""

    bodies: tuple[int, ...]
    rank: int

    @property
    def class_name(self) -> str:
        return roman(self.rank)


@dataclass(frozen=True)
class Decomposition:
    """Assour groups of a mechanism in order of assembly; of the groups that can be placed, the smallest comes
    first."""

    driver: int
    groups: tuple[AssourGroup, ...]

    @property
    def rank(self) -> int:
        """Class of the mechanism: the highest class of its groups, 1 for a driver alone."""
        return max((group.rank for group in self.groups), default=1)

    @property
    def class_name(self) -> str:
        return roman(self.rank)


def roman(number: int) -> str:
    """Return a small number in Roman figures.

    Parameters
    ----------
    number
        Whole number from 1 to 39.

    Returns
    -------
    Its capital letters: 4 gives ``IV``.
    """
    tens, units = divmod(number, 10)
    return "X" * tens + ("", "I", "II", "III", "IV", "V", "VI", "VII", "VIII", "IX")[units]


def decompose(joints: JointGraph | Iterable[Record], driver: Sequence[int]) -> Decomposition:
    """Return the Assour groups of a mechanism with lower pairs alone.

    Parameters
    ----------
    joints
        Records or a graph.
    driver
        The frame, 1, and the body that is driven, in either order.

    Returns
    -------
    The groups with their classes, in order of assembly.

    Raises
    ------
    Undefined
        A higher pair, a formula's count other than 1, several joints between frame and driver, or bodies that
        have more pairs than conditions to settle.
    WrongValue
        Records that are not a mechanism (:meth:`JointGraph.of`), or a driver that no lower pair joins to the
        frame.

    Source
    ------
    A mechanism with one driver has ``w = 3 n - 2 b = 1``, a group of n bodies and b pairs ``3 n = 2 b``.
    """
    graph = JointGraph.of(joints)
    body = driven_body(graph, driver)
    counts = graph.counts
    if counts.h:
        raise Undefined("Assour groups have lower pairs alone; this mechanism has {h} higher", h=counts.h)
    if counts.w != 1:
        raise Undefined("one driver requires w = 3 n - 2 b = 1; this mechanism has w = {w}", w=counts.w)
    if sum({FRAME, body} <= set(joint.bodies) for joint in graph.joints) > 1:
        raise Undefined(
            "several joints connect body {body} to the frame: as a driver it could not move", body=body
        )
    return Decomposition(body, _ordered(graph, body, _rings(graph, body)))


def driven_body(graph: JointGraph, driver: Sequence[int]) -> int:
    """Return the body of a driver, which a lower pair joins to the frame.

    Parameters
    ----------
    graph
        Joint graph of the mechanism.
    driver
        The frame, 1, and the body, in either order.

    Returns
    -------
    The number of the body.

    Raises
    ------
    WrongValue
        Anything but the frame and a body that a lower pair joins to it.
    """
    try:
        numbers = [int(x) for x in driver]
        wrong = len(numbers) != 2 or FRAME not in numbers or numbers != list(driver)
    except (TypeError, ValueError):
        wrong = True
    if wrong:
        raise WrongValue(
            "driver must be [1, body], a body joined to the frame; found {driver!r}", driver=driver
        )
    body = max(numbers)
    if body not in drivers(graph):
        able = ", ".join(map(str, drivers(graph)))
        raise WrongValue(
            "driver: no lower pair joins body {body} to the frame; bodies that have one: {able}",
            body=body,
            able=able,
        )
    return body


def drivers(graph: JointGraph) -> tuple[int, ...]:
    """Return the bodies that a lower pair joins to the frame.

    Parameters
    ----------
    graph
        Joint graph of the mechanism.

    Returns
    -------
    Their numbers, in increasing order.
    """
    joined = {b for j in graph.joints if FRAME in j.bodies and j.kind != "higher" for b in j.bodies}
    return tuple(sorted(joined - {FRAME}))


# ------------------------------------------------------------------ who settles whom


def _conditions(graph: JointGraph) -> list[tuple[Node, Node]]:
    """Return the two ends of each pair of conditions.

    A pivot of several bodies joins each of them to a pin, a point with two unknowns of its own, so that no
    body is preferred.
    """
    results: list[tuple[Node, Node]] = []
    for index, joint in enumerate(graph.joints):
        if len(joint.bodies) == 2:
            results.append((("body", joint.bodies[0]), ("body", joint.bodies[1])))
        else:
            results += [(("pin", index), ("body", body)) for body in joint.bodies]
    return results


def _rings(graph: JointGraph, driver: int) -> list[tuple[int, ...]]:
    """Return the sets of bodies whose positions determine each other, in no particular order."""
    conditions = _conditions(graph)
    placed = {("body", FRAME), ("body", driver)}
    # The driver's own pair is taken away: it stays among the conditions only in a multiple pivot, where
    # frame and driver may both hold the pin, and one of the two holds is enough.
    conditions = [ends for ends in conditions if not placed.issuperset(ends)]
    hold = _own_hold(graph, driver)
    conditions = [ends for ends in conditions if ends != hold]
    settled = _given_out(conditions, placed)
    arrows: dict[Node, set[Node]] = {node: set() for ends in conditions for node in ends}
    for (first, other), (to_one, to_other) in zip(conditions, settled, strict=True):
        if to_one:
            arrows[other].add(first)
        if to_other:
            arrows[first].add(other)
    components = _components({node: after for node, after in arrows.items() if node not in placed}, placed)
    bodies = (tuple(sorted(n for kind, n in part if kind == "body")) for part in components)
    return [ring for ring in bodies if ring]


def _own_hold(graph: JointGraph, driver: int) -> tuple[Node, Node] | None:
    """Return the condition that joins the driver to a pin shared with the frame."""
    for index, joint in enumerate(graph.joints):
        if len(joint.bodies) > 2 and {FRAME, driver} <= set(joint.bodies):
            return ("pin", index), ("body", driver)
    return None


def _given_out(conditions: Sequence[tuple[Node, Node]], placed: set[Node]) -> list[list[int]]:
    """Return how many of its two conditions each pair gives to its first and to its second end.

    A body takes three, a pin two, what is placed none.
    """
    room = {node: 0 if node in placed else 3 if node[0] == "body" else 2 for e in conditions for node in e}
    # (condition, end) it took, each once.
    held: dict[Node, list[tuple[int, int]]] = {node: [] for node in room}
    shares = [[0, 0] for _ in conditions]

    def settle(number: int, tried: set[Node]) -> bool:
        """Give one more condition of a pair to an end that has room, or makes room."""
        for end, node in enumerate(conditions[number]):
            if node in tried or node in placed:
                continue
            tried.add(node)
            if len(held[node]) < room[node]:
                held[node].append((number, end))
                shares[number][end] += 1
                return True
            for index, (other, its_end) in enumerate(held[node]):
                if other != number and settle(other, tried):
                    shares[other][its_end] -= 1
                    held[node][index] = (number, end)
                    shares[number][end] += 1
                    return True
        return False

    for number, ends in enumerate(conditions):
        for _ in range(2):
            tried: set[Node] = set()
            if not settle(number, tried):
                crowd = sorted(n for kind, n in tried if kind == "body") or [n for _, n in ends]
                raise Undefined(
                    "bodies {crowd} have too many joints to move: part of the mechanism is overconstrained",
                    crowd=crowd,
                )
    return shares


def _components(arrows: dict[Node, set[Node]], left_out: set[Node]) -> list[list[Node]]:
    """Return the strongly connected components of the graph without ``left_out``."""
    back: dict[Node, set[Node]] = {node: set() for node in arrows}
    for node, after in arrows.items():
        for other in after - left_out:
            back[other].add(node)
    order: list[Node] = []
    _visit_all(sorted(arrows), arrows, left_out, order.append)
    parts: list[list[Node]] = []
    seen: set[Node] = set(left_out)
    for node in reversed(order):
        if node not in seen:
            part: list[Node] = []
            _visit(node, back, seen, part.append)
            parts.append(part)
    return parts


def _visit_all(nodes: Iterable[Node], arrows: dict[Node, set[Node]], left_out: set[Node], leave: Any) -> None:
    seen = set(left_out)
    for node in nodes:
        if node not in seen:
            _visit(node, arrows, seen, leave)


def _visit(start: Node, arrows: dict[Node, set[Node]], seen: set[Node], leave: Any) -> None:
    """Traverse depth first, without recursion; call ``leave`` on each node after all its successors."""
    seen.add(start)
    path = [(start, iter(sorted(arrows[start])))]
    while path:
        node, after = path[-1]
        following = next((other for other in after if other not in seen), None)
        if following is None:
            leave(node)
            path.pop()
        else:
            seen.add(following)
            path.append((following, iter(sorted(arrows[following]))))


# ------------------------------------------------------------------ order and classes


def _ordered(graph: JointGraph, driver: int, rings: Sequence[tuple[int, ...]]) -> tuple[AssourGroup, ...]:
    """Return the groups in order of assembly: at each step the smallest set with all its pairs, lowest bodies
    first."""
    placed = {FRAME, driver}
    ready: list[tuple[int, tuple[int, ...]]] = []
    waiting = set(rings)
    results: list[AssourGroup] = []
    while waiting or ready:
        able = [ring for ring in waiting if 2 * _pairs_of(graph, ring, placed) == 3 * len(ring)]
        for ring in able:
            heapq.heappush(ready, (len(ring), ring))
        waiting.difference_update(able)
        _, ring = heapq.heappop(ready)
        results.append(AssourGroup(ring, class_of(graph, ring, placed)))
        placed.update(ring)
    return tuple(results)


def _pairs_of(graph: JointGraph, ring: Sequence[int], placed: set[int]) -> int:
    """Count the pairs of some bodies among themselves and with the bodies placed before."""
    total = 0
    for joint in graph.joints:
        count = len(set(joint.bodies) & set(ring))
        if count:
            total += count if placed & set(joint.bodies) else count - 1
    return total


def class_of(graph: JointGraph, ring: Sequence[int], placed: set[int]) -> int:
    """Return the class of a group.

    Parameters
    ----------
    graph
        Joint graph of the mechanism.
    ring
        Numbers of the group's bodies.
    placed
        Numbers of the bodies placed before the group, the frame among them.

    Returns
    -------
    The class, a whole number.

    Source
    ------
    The larger of the sides of the longest chordless loop and of the most joints on one body; a multiple pivot
    is one corner of each of its bodies.
    """
    bodies = set(ring)
    used = [j for j in graph.joints if len(bodies & set(j.bodies)) + bool(placed & set(j.bodies)) > 1]
    corners = max(sum(body in joint.bodies for joint in used) for body in ring)
    return max(corners, longest_loop([bodies & set(joint.bodies) for joint in used], bodies))


def longest_loop(joined: Sequence[set[int]], bodies: Iterable[int]) -> int:
    """Return the number of sides of the longest chordless loop of bodies.

    Parameters
    ----------
    joined
        Numbers of the bodies of each joint.
    bodies
        Numbers of all bodies, those of the joints among them.

    Returns
    -------
    The number of sides, 3 or more; 0 if there is no loop. Bodies on one common pivot are none.
    """
    neighbours: dict[int, set[int]] = {body: set() for body in bodies}
    for several in joined:
        for body in several:
            neighbours[body] |= several - {body}
    longest = 0

    def extend(path: list[int]) -> None:
        nonlocal longest
        for body in neighbours[path[-1]]:
            if body <= path[0] or body in path:
                continue
            chords = neighbours[body].intersection(path[:-1])
            if not chords:
                extend([*path, body])
            elif chords == {path[0]} and not (len(path) == 2 and _one_joint(joined, {*path, body})):
                longest = max(longest, len(path) + 1)

    for body in neighbours:
        extend([body])
    return longest


def _one_joint(joined: Sequence[set[int]], bodies: set[int]) -> bool:
    return any(bodies <= several for several in joined)
