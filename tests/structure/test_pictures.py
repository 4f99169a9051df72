"""The joint graph as a figure: everything is in it, and no line seems to end where it only passes."""

from __future__ import annotations

import sweeps
from line_crossings import crossings
from tables import each_row

from coursework.figures import circle, contact, line, note
from coursework.structure import LIBRARY, JointGraph
from coursework.structure.numbered import to_count, to_decompose
from coursework.structure.picture import kinematic_graph


def elements(joints, kind):
    return [e for e in kinematic_graph(joints).elements if isinstance(e, kind)]


@each_row("figure", sorted(LIBRARY))
def test_bodies_joints_and_shared_pivots_are_all_drawn(figure):
    graph = LIBRARY[figure]
    assert sorted(e.label for e in elements(graph, note)) == sorted(map(str, graph.bodies))
    assert len(elements(graph, circle)) == len(graph.bodies) + 1
    shared = [j for j in graph.joints if len(j.bodies) > 2]
    assert len(elements(graph, contact)) == len(shared)
    assert len(elements(graph, line)) == sum(len(j.bodies) if j in shared else 1 for j in graph.joints)
    letters = [e.label for kind in (line, contact) for e in elements(graph, kind) if e.label]
    assert sorted(letters) == sorted(
        {"revolute": "R", "prismatic": "P", "higher": "H"}[j.kind] for j in graph.joints
    )


@sweeps.seeds(4, 60)
def test_no_line_passes_through_a_body_or_a_pivot_that_it_does_not_join(seeds):
    numbers = [1000 + seed for seed in seeds]
    for joints in [*map(to_count, numbers), *(to_decompose(n).joints for n in numbers)]:
        for stroke in elements(joints, line):
            for place in [e.p for kind in (note, contact) for e in elements(joints, kind)]:
                way = stroke.q - stroke.p
                along = ((place - stroke.p) * way.conjugate()).real / abs(way) ** 2
                if 1e-9 < along < 1 - 1e-9:
                    assert abs(stroke.p + along * way - place) > 4.5, joints


def test_lines_of_a_graph_cross_seldom():
    """As the bodies are numbered, three times as often; lines of one body, or side by side, begin near each
    other."""
    graphs = [
        joints for number in range(1000, 1024) for joints in (to_count(number), to_decompose(number).joints)
    ]
    found = [crossings([(e.p, e.q) for e in elements(joints, line)], 6.0) for joints in graphs]
    assert sum(found) <= 2 * len(graphs), found
    assert sum(crossings([(e.p, e.q) for e in elements(LIBRARY[name], line)], 6.0) for name in LIBRARY) <= 4


def test_two_joints_of_the_same_bodies_are_two_lines():
    joints = [{"between": [1, 2], "kind": "revolute"}, {"between": [1, 2], "kind": "higher"}]
    one, other = elements(JointGraph.of(joints), line)
    assert abs(one.p - other.p) > 2


def test_the_same_mechanism_gives_the_same_picture():
    assert kinematic_graph(to_count(1234)).svg() == kinematic_graph(tuple(reversed(to_count(1234)))).svg()
