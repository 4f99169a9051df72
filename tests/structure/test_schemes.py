"""The kinematic scheme: everything is in it once, and nothing seems joined that is not."""

from __future__ import annotations

import itertools
from collections import Counter

import pytest
from line_crossings import crossings
from sweeps import slow
from tables import each_row

from coursework.figures import Figure, contact, ground_pivot, pin, rail, slider
from coursework.structure import LIBRARY, JointGraph
from coursework.structure.growing import relabelled
from coursework.structure.layout import places
from coursework.structure.library import PLACES
from coursework.structure.likeness import drawn_in_course, likeness
from coursework.structure.numbered import to_count, to_decompose
from coursework.structure.scheme import kinematic_scheme

NUMBERS = range(1000, 1024)
MECHANISMS = [to_count(n) for n in NUMBERS] + [to_decompose(n).joints for n in NUMBERS]


@pytest.fixture(params=[MECHANISMS[1::4], pytest.param(MECHANISMS, marks=slow)], ids=["few", "all"])
def mechanisms(request):
    return request.param


KINDS = {"revolute": (ground_pivot, pin), "prismatic": (slider,), "higher": (contact,)}


def labels(figure: Figure) -> Counter[str]:
    return Counter(part for box in figure.labels() for part in box.label.split(","))


def shown(joints) -> list:
    return list(kinematic_scheme(joints, letters=False).elements)


def distance(z: complex, a: complex, b: complex) -> float:
    along = ((z - a) * (b - a).conjugate()).real / abs(b - a) ** 2
    return abs(z - a - min(1.0, max(0.0, along)) * (b - a))


@each_row("figure", sorted(LIBRARY))
def test_a_scheme_of_the_library_has_each_moving_body_and_each_letter(figure):
    graph = LIBRARY[figure]
    found = labels(kinematic_scheme(graph))
    for body in graph.moving:
        assert found[str(body)] == 1
    assert set(found) == {str(body) for body in graph.moving} | {joint.at for joint in graph.joints}


def test_the_scheme_of_a_grown_mechanism_bears_every_body_and_every_letter_once(mechanisms):
    for joints in mechanisms:
        graph = JointGraph.of(joints)
        blocks = [box.label for box in kinematic_scheme(joints).labels()]
        found = Counter(part for label in blocks for part in label.split(","))
        assert found == Counter([*map(str, graph.moving), *(joint.at for joint in graph.joints)]), joints


def test_each_joint_is_drawn_as_what_it_is_and_where_it_holds_the_frame_there_is_hatching(mechanisms):
    for joints in mechanisms:
        graph, elements = JointGraph.of(joints), shown(joints)
        for kind, symbols in KINDS.items():
            drawn = [e for e in elements if type(e) in symbols]
            assert len(drawn) == sum(joint.kind == kind for joint in graph.joints)
        held = Counter(joint.kind for joint in graph.joints if 1 in joint.bodies)
        assert sum(isinstance(e, ground_pivot) for e in elements) == held["revolute"]
        assert sum(isinstance(e, rail) for e in elements) == held["prismatic"] + held["higher"]


def test_no_bar_comes_near_a_pivot_that_is_not_its_own(mechanisms):
    for joints in mechanisms:
        elements = shown(joints)
        pivots = [e.p for e in elements if isinstance(e, ground_pivot | pin)]
        for a, b in (bar for element in elements for bar in element.bars()):
            for pivot in pivots:
                # At its own pivot a bar ends, or a guide begins in line with it.
                gap = distance(pivot, a, b)
                assert gap < 1e-6 or gap > 5.0, joints


def test_bars_cross_in_few_pictures(mechanisms):
    """Most mechanisms can be drawn without any; what has ends in common does not cross."""
    found = [
        sum(
            crossings([a, b])
            for e, f in itertools.combinations(shown(joints), 2)
            for a in e.bars()
            for b in f.bars()
        )
        for joints in mechanisms
    ]
    assert sum(found) <= len(mechanisms) / 8, found


def test_pivots_are_far_enough_from_each_other_to_be_told_apart(mechanisms):
    for joints in mechanisms:
        apart = set(places(JointGraph.of(joints)))
        assert all(abs(a - b) > 10 for a, b in itertools.combinations(apart, 2)), joints


def test_the_same_mechanism_gives_the_same_scheme_whatever_the_order_of_its_list():
    for number in (1012, 1234):
        joints = to_count(number)
        assert kinematic_scheme(joints).svg() == kinematic_scheme(tuple(reversed(joints))).svg()


def test_a_mechanism_of_the_course_under_other_numbers_is_drawn_as_the_course_draws_it():
    for figure in PLACES:
        graph = LIBRARY[figure]
        other = relabelled(77, graph.joints).graph
        found = drawn_in_course(other)
        assert found is not None, figure
        assert (
            Counter(found[0])
            == Counter(drawn_in_course(graph)[0])
            == Counter(PLACES[figure][joint.at] for joint in graph.joints)
        )


def test_likeness_keeps_every_joint():
    graph = LIBRARY["figure_14"]
    other = relabelled(5, graph.joints).graph
    names = likeness(other, graph)
    renamed = {(tuple(sorted(names[b] for b in j.bodies)), j.kind) for j in other.joints}
    assert renamed == {(j.bodies, j.kind) for j in graph.joints}


def test_mechanisms_with_as_many_joints_of_each_kind_may_be_unlike():
    """The two six-bar chains: the ternary bodies are joined, or they are not."""
    watt, stephenson = (
        LIBRARY["figure_13"],
        JointGraph.of(
            [
                {"between": pair, "kind": "revolute"}
                for pair in ([1, 2], [2, 3], [3, 4], [1, 4], [3, 5], [5, 6], [1, 6])
            ]
        ),
    )
    assert likeness(watt, watt) is not None
    assert likeness(watt, stephenson) is None


def test_an_arrow_shows_what_is_driven():
    found = to_decompose(1003)
    driven = kinematic_scheme(found.joints, driver=found.driver)
    assert len(driven.elements) == len(kinematic_scheme(found.joints).elements) + 1
