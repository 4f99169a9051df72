"""Mobility: lists of joints given by hand, variants, and the mistakes that the course's notes make."""

import json

import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.errors import WrongValue
from coursework.rendering.renderer import renderer_of
from coursework.structure import LIBRARY, JointGraph

EXERCISE = coursework.open_course()["mobility"]
SOLUTION = EXERCISE.solution


def test_a_list_of_joints_answers_under_the_asked_names():
    joints = [
        {"between": [1, 2], "kind": "revolute"},
        {"between": [2, 3], "kind": "higher"},
        {"between": [1, 3], "kind": "prismatic"},
    ]
    assert EXERCISE.solve(joints=joints) == {"n": 2, "b": 2, "h": 1, "w": 1, "L": 3, "N": 3, "gamma": 1}
    assert EXERCISE.solve(joints=tuple(reversed(joints)), only="w") == {"w": 1}
    assert EXERCISE.solve(joints=json.dumps(joints), only="gamma") == {"gamma": 1}


@each_row("joints", [[], 3, "four-bar", [[1, 2]], None, np.arange(3.0)])
def test_what_is_no_list_of_joints_is_refused(joints):
    with pytest.raises(WrongValue):
        EXERCISE.solve(joints=joints)


def test_the_notes_count_a_cycle_too_many_on_figure_13():
    given = {"joints": LIBRARY["figure_13"].records()}
    assert SOLUTION.mistaken("notes_N_without_frame").evaluate(("gamma",), given) == {"gamma": 3}
    assert SOLUTION.graph.evaluate(("gamma",), given) == {"gamma": 2}


def test_mistakes_flow_on_to_what_depends_on_them():
    given = {"joints": LIBRARY["figure_27"].records()}  # three bodies on one pivot

    def wrong(name):
        return SOLUTION.mistaken(name).evaluate(("n", "b", "w", "gamma"), given)

    assert wrong("multiple_pivot_once") == {"n": 5, "b": 6, "w": 3, "gamma": 1}
    assert wrong("multiple_pivot_as_many_as_bodies") == {"n": 5, "b": 8, "w": -1, "gamma": 3}
    assert wrong("frame_counted") == {"n": 6, "b": 7, "w": 4, "gamma": 2}


def test_variants_are_of_every_sort():
    found = [(v.solution(), v) for v in EXERCISE.variants(range(200))]
    assert {s["w"] for s, _ in found} == {0, 1, 2}
    assert {s["h"] > 0 for s, _ in found} == {True, False}
    assert {s["gamma"] for s, _ in found} >= {1, 2, 3, 4}
    shared = [any(len(j["between"]) > 2 for j in v.printed["joints"]) for _, v in found]
    assert 0.2 < np.mean(shared) < 0.8


def test_the_words_of_the_figure_list_the_joints_that_are_solved_and_the_statement_does_not():
    """Who sees the scheme counts on it; who does not has every joint in words."""
    for variant in EXERCISE.variants(range(20), "en"):
        graph = JointGraph.of(variant.printed["joints"])
        assert EXERCISE.solve(joints=graph.records()) == variant.solution()
        assert "|" not in variant.text.opening
        words = variant.text.section("figure").text
        for joint in variant.printed["joints"]:
            *others, last = joint["between"]
            kind = {"revolute": "revolute", "prismatic": "prismatic", "higher": "contact"}[joint["kind"]]
            assert f"{kind} between {', '.join(map(str, others))} and {last}" in words
        assert words.count(" between ") == len(graph.joints)


def test_the_number_of_the_mechanism_is_in_the_record_and_not_on_the_sheet():
    variant = EXERCISE.variant(5, "en")
    assert variant.handout().given == ()
    assert variant.record["given"]["mechanism"]["value"] == variant.given["mechanism"]
    assert (
        f"{variant.given['mechanism']:g}"
        not in renderer_of(variant.exercise.folder).html(variant.handout()).split("</main>")[0]
    )


def test_what_a_request_gets_is_its_own():
    mine = EXERCISE.solve(mechanism=4321, only="joints")["joints"]
    mine[0]["between"].clear()
    mine[1].clear()
    assert EXERCISE.solve(mechanism=4321, only="w")["w"] in (0, 1, 2)
