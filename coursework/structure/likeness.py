"""Comparison of a mechanism with those of the course, whatever its numbers and letters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from coursework.structure.joints import FRAME, JointGraph
from coursework.structure.library import LIBRARY, PLACES, RAILS

Drawn = tuple[tuple[complex, ...], dict[int, float]]


def drawn_in_course(graph: JointGraph) -> Drawn | None:
    """Return how a figure of the course draws a mechanism.

    Parameters
    ----------
    graph
        Joint graph of the mechanism.

    Returns
    -------
    The position of each joint (complex, mm on paper, y up) and, by index of its joint, the direction in
    degrees of each fixed rail that is not level; None if no drawn figure is isomorphic.
    """
    for figure, mechanism in LIBRARY.items():
        if figure not in PLACES or len(mechanism.joints) != len(graph.joints):
            continue
        bodies = likeness(graph, mechanism)
        if bodies is not None:
            return _drawn(graph, mechanism, bodies, figure)
    return None


def _drawn(graph: JointGraph, mechanism: JointGraph, bodies: Mapping[int, int], figure: str) -> Drawn:
    letters: dict[tuple[tuple[int, ...], str], str] = {(j.bodies, j.kind): j.at for j in mechanism.joints}
    names = [letters[tuple(sorted(bodies[b] for b in j.bodies)), j.kind] for j in graph.joints]
    rails = RAILS.get(figure, {})
    slides = {
        k: rails[at] for k, at in enumerate(names) if graph.joints[k].kind == "prismatic" and at in rails
    }
    return tuple(PLACES[figure][at] for at in names), slides


def likeness(graph: JointGraph, mechanism: JointGraph) -> dict[int, int] | None:
    """Return an isomorphism of two mechanisms.

    The identity is tried first, so a figure of the course maps to itself.

    Parameters
    ----------
    graph, mechanism
        Joint graphs.

    Returns
    -------
    For each body of ``graph`` its counterpart in ``mechanism``, the frame for the frame; None if there is
    none.
    """
    if len(graph.bodies) != len(mechanism.bodies) or _kinds(graph) != _kinds(mechanism):
        return None
    return next(_matched(graph, mechanism, {FRAME: FRAME}), None)


def _kinds(graph: JointGraph) -> list[tuple[str, int]]:
    return sorted((joint.kind, len(joint.bodies)) for joint in graph.joints)


def _matched(graph: JointGraph, mechanism: JointGraph, results: dict[int, int]) -> Iterator[dict[int, int]]:
    body = next((b for b in graph.bodies if b not in results), None)
    if body is None:
        yield results
        return
    for other in sorted(set(mechanism.bodies) - set(results.values()), key=lambda b: (b != body, b)):
        more = {**results, body: other}
        if _seen(graph, body, more) == _seen(mechanism, other, {b: b for b in more.values()}):
            yield from _matched(graph, mechanism, more)


def _seen(graph: JointGraph, body: int, names: Mapping[int, int]) -> list[tuple[str, int, list[int]]]:
    """Return the joints of a body with their kinds, numbers of bodies, and those neighbours that are already
    mapped."""
    return sorted(
        (joint.kind, len(joint.bodies), sorted(names[b] for b in joint.bodies if b in names))
        for joint in graph.joints_of(body)
    )
