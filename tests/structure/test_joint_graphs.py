"""Joint graphs: what is counted, whatever way the list is written; cycles; what is refused."""

from __future__ import annotations

import random
from itertools import combinations

import numpy as np
import pytest
from tables import each_row

from coursework.errors import WrongValue
from coursework.structure import LIBRARY, Counts, JointGraph, grow
from coursework.structure.growing import NumberStream, relabelled


def pivot(*bodies, at=None):
    return {"between": list(bodies), "kind": "revolute", **({"at": at} if at else {})}


def slide(one, other):
    return {"between": [one, other], "kind": "prismatic"}


def contact(one, other):
    return {"between": [one, other], "kind": "higher"}


def mechanisms(count):
    """Grown ones, all kinds of groups."""
    menu = ("dyad", "triad", "tetrad", "follower", "stiffener")
    for number in range(count):
        choices = NumberStream(number, "tests")
        groups = ["dyad", *(choices.one_of(menu) for _ in range(choices.below(4)))]
        yield grow(number, groups, drivers=1 + choices.below(2))


@each_row(
    ("figure", "counts"),
    [
        # n, b, h, w, L, N, gamma: the notes print w of Figures 3, 7, 13, 14 and gamma of Figure 14.
        ("figure_3", (3, 4, 0, 1, 4, 4, 1)),
        ("figure_6_cam", (2, 2, 1, 1, 3, 3, 1)),
        ("figure_8a_motor", (1, 1, 0, 1, 1, 2, 0)),
        ("figure_13", (5, 7, 0, 1, 7, 6, 2)),
        ("figure_14", (7, 10, 0, 1, 10, 8, 3)),
        ("figure_26b", (5, 7, 0, 1, 7, 6, 2)),
        ("figure_27", (5, 7, 0, 1, 7, 6, 2)),
    ],
)
def test_figures_count_as_the_course_counts_them(figure, counts):
    assert LIBRARY[figure].counts == Counts(*counts)


def test_figure_13_has_two_cycles_where_the_notes_print_three():
    graph = LIBRARY["figure_13"]
    assert graph.counts.gamma == 2
    # The notes list OABCO, CDEFC and OABDEFO: the third is the sum of the two others.
    loops = [(1, 2, 3, 4), (1, 4, 5, 6), (1, 2, 3, 4, 5, 6)]
    assert _rank(graph, loops) == 2


def test_every_figure_of_the_library_moves_by_one():
    assert {graph.counts.w for graph in LIBRARY.values()} == {1}


@each_row("kind", range(4))
def test_a_shared_pivot_counts_alike_however_it_is_written(kind):
    writings = (
        [pivot(2, 3, 4, at="A")],
        [pivot(2, 3, at="A"), pivot(3, 4, at="A")],
        [pivot(4, 2, at="A"), pivot(2, 3, at="A")],
        [pivot(3, 4, at="A"), pivot(2, 4, at="A")],
    )
    rest = [pivot(1, 2, at="O"), pivot(1, 3, at="B"), slide(4, 1)]
    graph = JointGraph.of([*writings[kind], *rest])
    assert graph == JointGraph.of([*rest, *writings[0]])
    assert graph.counts == Counts(n=3, b=5, h=0, w=-1, L=5, N=4, gamma=2)


def test_answers_do_not_depend_on_order():
    for grown in mechanisms(60):
        shuffle = random.Random(len(grown.joints))
        joints = [{**r, "between": shuffle.sample(r["between"], len(r["between"]))} for r in grown.joints]
        shuffle.shuffle(joints)
        assert JointGraph.of(joints) == grown.graph


def test_counts_do_not_depend_on_numbering():
    for number, grown in enumerate(mechanisms(60)):
        assert relabelled(number + 7, grown.graph.joints).graph.counts == grown.graph.counts


def test_numbers_of_numpy_are_numbers():
    assert JointGraph.of([pivot(np.int64(1), np.int64(2))]) == JointGraph.of([pivot(1, 2)])


def _rank(graph, cycles):
    """Of cycles as vectors over the pairs, modulo 2 (each cycle's steps are taken by any pair there is)."""
    pairs = graph.pairs()
    rows = []
    for cycle in cycles:
        row = 0
        for one, other in zip(cycle, (*cycle[1:], cycle[0]), strict=True):
            row ^= 1 << pairs.index(tuple(sorted((one, other))))
        rows.append(row)
    rank = 0
    while rows:
        pivot_row = rows.pop()
        if pivot_row:
            rank += 1
            low = pivot_row & -pivot_row
            rows = [row ^ pivot_row if row & low else row for row in rows]
    return rank


def test_grown_mechanisms_count_as_their_groups_say():
    """A driver adds one freedom, a bar takes one away, the other groups none; nothing is held twice."""
    for number in range(60):
        choices = NumberStream(number, "count by groups")
        groups = [choices.one_of(("dyad", "triad", "tetrad", "follower")) for _ in range(3)]
        bars = choices.below(2)
        grown = grow(number, groups + ["stiffener"] * bars, drivers=1 + number % 2)
        graph = grown.graph
        assert graph.counts.w == 1 + number % 2 - bars
        assert grown == grow(number, groups + ["stiffener"] * bars, drivers=1 + number % 2)
        if not graph.counts.h and not bars:
            for size in (2, 3):
                for some in combinations(graph.moving, size):
                    inside = sum(max(len(set(j.bodies) & {1, *some}) - 1, 0) for j in graph.joints)
                    assert 3 * size - 2 * inside >= 0


@each_row(
    ("joints", "message"),
    [
        ([], "the list is empty"),
        ("joints", "list of records"),
        ({"between": [1, 2]}, "list of records"),
        ([(1, 2)], "joint 1 of the list must be a record"),
        ([{"kind": "revolute"}], "lacks 'between'"),
        ([{"between": [1, 2]}], "lacks 'kind'"),
        ([{"between": [1, 2], "kind": "pivot"}], "no kind 'pivot'"),
        ([{"between": [1, 2], "kind": "revolut"}], "did you mean 'revolute'"),
        ([{"between": [1, 2], "kind": "revolute", "att": "A"}], "did you mean 'at'"),
        ([{"between": [1], "kind": "revolute"}], "different bodies, two at least"),
        ([{"between": [2, 2], "kind": "revolute"}], "different bodies"),
        ([{"between": [1, 1, 2], "kind": "revolute"}], "different bodies"),
        ([{"between": [1, 2.5], "kind": "revolute"}], "whole number"),
        ([{"between": [0, 1], "kind": "revolute"}], "whole number from 1"),
        ([{"between": "12", "kind": "revolute"}], "must list bodies"),
        ([{"between": [1, True], "kind": "revolute"}], "whole number"),
        ([{"between": [1, 2, 3], "kind": "prismatic"}], "only a pivot"),
        ([pivot(1, 2), pivot(2, 4)], "body 3 has no joint"),
        ([pivot(2, 3)], "the frame, 1, has no joint"),
        ([pivot(1, 2), pivot(3, 4)], r"bodies \[3, 4\] are not linked"),
        ([pivot(1, 2, at="A"), pivot(3, 4, at="A"), pivot(2, 3)], "share no body"),
        ([pivot(1, 10**9)], "body 2 has no joint"),
    ],
)
def test_what_is_no_mechanism_is_refused_with_a_reason(joints, message):
    with pytest.raises(WrongValue, match=message):
        JointGraph.of(joints)
