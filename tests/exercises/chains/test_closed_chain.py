"""Closed chains: the answers against exact ranks of whole numbers, and lists of joints that a caller
gives."""

import numpy as np
import pytest
from exact_joints import exact_rank, motions
from tables import each_row

import coursework
from coursework.errors import CannotTell, WrongValue
from coursework.quantities.graph import Graph

EXERCISE = coursework.open_course()["closed_chain"]


def motions_of(given, number):
    """What a joint of the chain leaves free, in whole numbers."""
    point = [int(given[f"{a}{number}"]) for a in "xyz"] if number > 1 else (0, 0, 0)
    return motions(given[f"joint_{number}"], given[f"direction_{number}"], point)


@each_row("name", ("closed_chain", "complex_chain", "planar_chain"))
def test_the_mobility_by_which_variants_are_drawn_is_that_of_the_solution(name, course):
    candidates = course[name].draws.first_candidates(128)
    helpers = Graph({f.__name__: f for f in course[name].spec.helpers})
    known = {n: v for n, v in candidates.items() if n in helpers.leaves}
    mobility = helpers.evaluate(("mobility",), known)["mobility"]
    np.testing.assert_array_equal(mobility, course[name].solve(**candidates, only="m")["m"])


def test_ranks_are_those_of_whole_numbers():
    for variant in EXERCISE.variants(range(120), parts=["all"]):
        answers = variant.solution()
        parts = [motions_of(variant.given, k) for k in (1, 2, 3, 4)]
        rows = [row for part in parts for row in part]
        rank = exact_rank(rows)
        assert (answers["gamma"], answers["Nc"], answers["rc"]) == (1, len(rows), rank)
        assert answers["m"] == len(rows) - rank
        assert 1 <= answers["m"] <= 3
        assert answers["h"] == 6 - rank  # one loop: each dependent equation is a superfluous constraint
        between = parts[1] + parts[2]  # with S1 and S3 held, S2 moves as both its joints let it
        assert answers["m_internal"] == len(between) - exact_rank(between)
        assert answers["statics"] == ("isostatic" if rank == 6 else "hyperstatic")


def test_the_identities_of_the_course():
    for variant in EXERCISE.variants(range(120), parts=["all"]):
        a = variant.solution()
        assert a["m"] - a["h"] == 6 * 3 - a["Ns"] == a["Nc"] - 6 * a["gamma"] == a["i"]
        assert a["m"] == a["m_useful"] + a["m_internal"]
        assert a["rs"] == 18 - a["m"]


def ring(points, axes):
    size = len(points)
    return [
        {"between": [k, (k + 1) % size], "joint": "revolute", "axis": axes[k], "point": points[k]}
        for k in range(size)
    ]


def test_two_loops_and_the_bodies_of_input_and_output():
    """A four-bar whose rocker drives a slider by a rod: two loops, one freedom."""
    joints = ring([(0, 0, 0), (0, 40, 0), (100, 80, 0), (120, 0, 0)], [(0, 0, 1)] * 4)
    joints += [
        {"between": [3, 4], "joint": "revolute", "axis": (0, 0, 1), "point": (110, 40, 0)},
        {"between": [4, 5], "joint": "revolute", "axis": (0, 0, 1), "point": (250, 10, 0)},
        {"between": [5, 0], "joint": "prismatic", "axis": (1, 0, 0)},
    ]
    a = EXERCISE.solve(joints=joints, only=("gamma", "Nc", "rc", "m", "h", "m_internal", "m_useful"))
    assert (a["gamma"], a["Nc"], a["rc"], a["m"], a["h"]) == (2, 7, 6, 1, 6)
    assert (a["m_internal"], a["m_useful"]) == (0, 1)
    # With a crank that nothing else hangs on, its motion is internal to who looks at the others.
    loose = [*joints, {"between": [0, 6], "joint": "revolute", "axis": (0, 0, 1), "point": (0, 0, 0)}]
    a = EXERCISE.solve(joints=loose, input_body=1, output_body=5, only=("m", "m_internal", "m_useful"))
    assert a == {"m": 2, "m_internal": 1, "m_useful": 1}


def test_what_cannot_be_told_is_said():
    tilted = ring([(0, 0, 0), (0, 40, 0), (100, 80, 0), (120, 0, 0)], [(0, 0, 1)] * 3 + [(1e-9, 0, 1)])
    with pytest.raises(CannotTell, match="loop equations"):
        EXERCISE.solve(joints=tilted, only="m")
    with pytest.raises(WrongValue, match="not linked"):
        EXERCISE.solve(joints=[{"between": [1, 2], "joint": "prismatic", "axis": (1, 0, 0)}], only="m")


def test_all_mobilities_are_met():
    found = {variant.solution()["m"] for variant in EXERCISE.variants(range(60))}
    assert found == {1, 2, 3}
    assert len(np.unique([v.solution()["h"] for v in EXERCISE.variants(range(60))])) > 1


def test_a_choice_is_explained_by_a_mistake_only_where_another_answer_shows_it():
    variant = coursework.open_course()["closed_chain"].variant(29)
    right = {"Nc": "9", "rc": "6", "m": "3"}
    alone = variant.grade({**right, "statics": "hyperstatique"})["statics"]
    assert alone.verdict == "wrong"
    shown = variant.grade({**right, "Nc": "15", "statics": "hyperstatique"})["statics"]
    assert shown.verdict == "mistake:unknowns_exchanged"
