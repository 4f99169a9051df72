"""Assour groups against a search through all subsets, the figures of the course, and what has no groups."""

from __future__ import annotations

from itertools import combinations, permutations

import pytest
from tables import each_row

from coursework.errors import Undefined, WrongValue
from coursework.structure import LIBRARY, JointGraph, decompose, grow
from coursework.structure.assour import drivers, longest_loop, roman
from coursework.structure.growing import NumberStream, relabelled
from coursework.structure.numbered import to_decompose

MENU = ("dyad", "dyad", "triad", "tetrad")


def grown(count):
    for number in range(count):
        choices = NumberStream(number, "decomposition tests")
        yield grow(number, [choices.one_of(MENU) for _ in range(1 + choices.below(2))])


def held(graph, some, placed):
    """Pairs of some bodies among themselves and with what is placed, joint by joint."""
    total = 0
    for joint in graph.joints:
        taking_part = [b for b in joint.bodies if b in some]
        if taking_part:
            total += len(taking_part) - (not any(b in placed for b in joint.bodies))
    return total


def by_all_subsets(graph, driver):
    """The definition, word by word: the smallest set of k bodies with 3 k = 2 b, again and again."""
    placed, rest, found = {1, driver}, set(graph.moving) - {driver}, []
    while rest:
        some = next(
            set(s)
            for size in range(1, len(rest) + 1)
            for s in combinations(sorted(rest), size)
            if 3 * size == 2 * held(graph, s, placed)
        )
        found.append((tuple(sorted(some)), class_by_orders(graph, some, placed)))
        placed |= some
        rest -= some
    return found


def class_by_orders(graph, some, placed):
    """Corners, and loops by trying every order of every subset."""
    used = [
        set(j.bodies)
        for j in graph.joints
        if len(set(j.bodies) & (some | placed)) > 1 and set(j.bodies) & some
    ]
    used = [u for u in used if len(u & some) + bool(u & placed) > 1]
    corners = max(sum(b in u for u in used) for b in some)
    touching = {frozenset(p) for u in used for p in combinations(sorted(u & some), 2)}
    loops = [0]
    for size in range(3, len(some) + 1):
        for subset in combinations(sorted(some), size):
            inside = {p for p in touching if p <= set(subset)}
            if len(inside) != size or any(set(subset) <= u for u in used):
                continue  # a chord, or one pivot that they all share
            first, *others = subset
            if any(
                all(frozenset(p) in inside for p in zip((first, *o), (*o, first), strict=True))
                for o in permutations(others)
            ):
                loops.append(size)
    return max(corners, *loops)


def test_groups_are_those_of_a_search_through_all_subsets():
    for mechanism in grown(80):
        graph = mechanism.graph
        found = decompose(graph, [1, mechanism.drivers[0]])
        assert [(g.bodies, g.rank) for g in found.groups] == by_all_subsets(graph, mechanism.drivers[0])


def test_so_they_are_with_any_driver():
    tried = 0
    for mechanism in grown(80):
        graph = mechanism.graph
        for body in drivers(graph):
            try:
                found = decompose(graph, [1, body])
            except Undefined:
                continue
            assert [(g.bodies, g.rank) for g in found.groups] == by_all_subsets(graph, body)
            tried += body not in mechanism.drivers
    assert tried > 30


def test_groups_are_those_that_the_mechanism_was_grown_from():
    ranks = {"dyad": 2, "triad": 3, "tetrad": 4}
    for number in range(150):
        choices = NumberStream(number, "grown from")
        groups = [choices.one_of(MENU) for _ in range(1 + choices.below(3))]
        mechanism = grow(number, groups)
        found = decompose(mechanism.joints, [1, mechanism.drivers[0]])
        assert sorted(g.rank for g in found.groups) == sorted(ranks[g] for g in groups)
        assert found.rank == max(ranks[g] for g in groups)


def test_groups_do_not_depend_on_numbering():
    for number, mechanism in enumerate(grown(60)):
        other = relabelled(number + 5, mechanism.graph.joints, mechanism.drivers)
        one = decompose(mechanism.joints, [1, mechanism.drivers[0]])
        two = decompose(other.joints, [1, other.drivers[0]])
        assert sorted((len(g.bodies), g.rank) for g in one.groups) == sorted(
            (len(g.bodies), g.rank) for g in two.groups
        )


def test_a_shared_pivot_may_be_written_as_any_chain_of_pairs():
    tried = 0
    for mechanism in grown(60):
        split = []
        for record in mechanism.joints:
            last, *others = reversed(record["between"])
            split += [{**record, "between": [last, other]} for other in others]
        tried += len(split) > len(mechanism.joints)
        driver = [1, mechanism.drivers[0]]
        assert decompose(split, driver) == decompose(mechanism.joints, driver)
    assert tried > 10


@each_row(
    ("figure", "driver", "name", "groups"),
    [
        ("figure_3", 2, "II", [(3, 4)]),
        ("figure_3", 4, "II", [(2, 3)]),
        ("figure_8a_motor", 2, "I", []),
        ("figure_8b_engine", 2, "II", [(3, 4)]),
        ("figure_8b_engine", 4, "II", [(2, 3)]),
        ("figure_8c_shaper", 2, "III", [(3, 4, 5, 6)]),
        ("figure_8d", 2, "IV", [(3, 4, 5, 6)]),
        ("figure_13", 2, "II", [(3, 4), (5, 6)]),
        ("figure_14", 2, "II", [(3, 4), (5, 6), (7, 8)]),
        ("figure_14", 4, "II", [(2, 3), (5, 6), (7, 8)]),
        ("figure_14", 5, "III", [(7, 8), (2, 3, 4, 6)]),
        ("figure_26a", 2, "II", [(3, 4)]),
        ("figure_26b", 2, "II", [(3, 4), (5, 6)]),
        ("figure_27", 2, "II", [(3, 4), (5, 6)]),
    ],
)
def test_figures_have_the_groups_that_the_course_gives_them(figure, driver, name, groups):
    found = decompose(LIBRARY[figure], [1, driver])
    assert (found.class_name, [g.bodies for g in found.groups]) == (name, groups)


def test_a_driver_that_shares_its_pivot_with_the_frame_and_others_still_drives():
    shared = [
        {"between": [1, 2, 4], "kind": "revolute", "at": "O"},
        {"between": [2, 3], "kind": "revolute"},
        {"between": [3, 4], "kind": "prismatic"},
    ]
    assert [g.bodies for g in decompose(shared, (1, 2)).groups] == [(3, 4)]
    assert [g.bodies for g in decompose(shared, (4, 1)).groups] == [(2, 3)]


def test_a_long_chain_of_dyads_comes_apart_into_all_of_them():
    mechanism = grow(3, ["dyad"] * 40)
    found = decompose(mechanism.joints, [1, mechanism.drivers[0]])
    assert [len(g.bodies) for g in found.groups] == [2] * 40
    assert found.class_name == "II"


def test_bodies_on_one_pivot_are_no_loop_and_chords_shorten_loops():
    assert longest_loop([{1, 2, 3}], {1, 2, 3}) == 0
    assert longest_loop([{1, 2}, {2, 3}, {1, 3}], {1, 2, 3}) == 3
    square = [{1, 2}, {2, 3}, {3, 4}, {1, 4}]
    assert longest_loop(square, {1, 2, 3, 4}) == 4
    assert longest_loop([*square, {1, 3}], {1, 2, 3, 4}) == 3
    assert longest_loop(square[:3], {1, 2, 3, 4}) == 0


def test_roman_figures():
    assert [roman(n) for n in (1, 2, 3, 4, 5, 9, 14, 29)] == "I II III IV V IX XIV XXIX".split()


def test_handed_out_mechanisms_have_classes_two_to_four_and_some_figures_among_them():
    figures = {graph.counts for graph in (LIBRARY["figure_14"], LIBRARY["figure_13"])}
    classes, seen = set(), set()
    for number in range(1000, 1200):
        asked = to_decompose(number)
        classes.add(decompose(asked.joints, asked.driver).class_name)
        seen.add(JointGraph.of(asked.joints).counts)
        assert asked.body not in asked.driver
    assert classes == {"II", "III", "IV"}
    assert figures <= seen


FOUR_BAR = LIBRARY["figure_3"].records()


@each_row("driver", [(2, 3), (1, 3), (1,), 2, (1, 2, 3), "12", (1, 9), None, (1, 2.5)])
def test_a_driver_is_a_body_joined_to_the_frame(driver):
    with pytest.raises(WrongValue, match="driver"):
        decompose(FOUR_BAR, driver)


@each_row(
    ("joints", "message"),
    [
        (LIBRARY["figure_6_cam"], "lower pairs alone"),
        ([*FOUR_BAR, {"between": [1, 3], "kind": "revolute"}], "w = -1"),
        # Body 3 pinned twice to the driver, body 4 dangling: one freedom in all, and no groups.
        ([{"between": p, "kind": "revolute"} for p in ([1, 2], [2, 3], [2, 3], [1, 4])], "overconstrained"),
        # The driver itself pinned twice to the frame.
        ([{"between": p, "kind": "revolute"} for p in ([1, 2], [1, 2], [2, 3], [3, 4])], "several joints"),
    ],
)
def test_what_has_no_groups_says_why(joints, message):
    with pytest.raises(Undefined, match=message):
        decompose(joints, (1, 2))
