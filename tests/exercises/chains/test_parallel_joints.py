"""Joints in parallel: the answers against exact ranks, and lists of joints that a caller gives."""

import numpy as np
import pytest
from exact_joints import actions, exact_rank

import coursework
from coursework.errors import CannotTell, UnknownName, WrongValue
from coursework.solids import FREEDOMS

EXERCISE = coursework.open_course()["parallel_joints"]


def test_ranks_are_those_of_whole_numbers():
    for variant in EXERCISE.variants(range(150)):
        g, answers = variant.given, variant.solution()
        place = [int(g[n]) for n in ("x2", "y2", "z2")]
        rows = actions(g["joint_1"], g["direction_1"], (0, 0, 0)) + actions(
            g["joint_2"], g["direction_2"], place
        )
        rank = exact_rank(rows)
        assert (answers["Ns"], answers["rs"]) == (len(rows), rank)
        assert (answers["h"], answers["m"]) == (len(rows) - rank, 6 - rank)
        assert answers["m"] > 0
        assert FREEDOMS.get(answers["equivalent"], answers["m"]) == answers["m"]
        if "axis_point" in answers and answers["equivalent"] == "revolute":
            turn = np.array(answers["axis_dir"], float)
            twist = np.concatenate([turn, np.cross(answers["axis_point"], turn)])
            np.testing.assert_allclose(np.array(rows, float) @ twist, 0, atol=1e-9)


def test_the_axis_is_asked_where_there_is_one():
    for variant in EXERCISE.variants(range(100)):
        equivalent = variant.solution()["equivalent"]
        assert ("axis_dir" in variant.part_ids) == (
            equivalent not in ("other", "rigid", "spherical", "spherical_pin", "free")
        )
        assert ("axis_point" in variant.part_ids) == (
            equivalent in ("revolute", "helical", "cylindrical", "point_contact")
        )


@pytest.mark.parametrize("kind", [list, tuple])
def test_a_caller_gives_any_joints(kind):
    hinge = {"joint": "revolute", "axis": [0.6, 0.8, 0], "point": [1, 2, 3]}
    found = EXERCISE.solve(joints=kind([hinge, {**hinge, "point": [1.6, 2.8, 3]}]))
    assert (found["Ns"], found["rs"], found["h"], found["m"], found["equivalent"]) == (
        10,
        5,
        5,
        1,
        "revolute",
    )
    np.testing.assert_allclose(found["axis_dir"], [0.6, 0.8, 0], atol=1e-14)
    np.testing.assert_allclose(
        np.cross(found["axis_point"] - np.array([1, 2, 3]), [0.6, 0.8, 0]), 0, atol=1e-14
    )


def test_a_joint_without_axis_has_none():
    found = EXERCISE.solve(joints=[{"joint": "spherical", "point": [1, 2, 3]}])
    assert found["equivalent"] == "spherical"
    assert np.isnan(found["axis_dir"]).all()
    np.testing.assert_allclose(found["axis_point"], [1, 2, 3])


def test_what_makes_no_sense_is_refused():
    with pytest.raises(UnknownName, match="revolute"):
        EXERCISE.solve(joints=[{"joint": "revolut"}])
    for nothing in ([], 3.0, [1.0, 2.0]):
        with pytest.raises(WrongValue, match="joint"):
            EXERCISE.solve(joints=nothing)
    slightly = [{"joint": "prismatic", "axis": a} for a in ([1, 0, 0], [1, 1e-9, 0])]
    with pytest.raises(CannotTell):
        EXERCISE.solve(joints=slightly, only="m")


def test_a_joint_is_known_with_its_article_or_without():
    variant = coursework.open_course()["parallel_joints"].variant(27, lang="fr")
    for said in ("une liaison pivot", "liaison pivot", "Liaison pivot", "a revolute joint", "revolute joint"):
        assert variant.grade({"equivalent": said})["equivalent"].verdict == "correct", said


def test_a_wrong_direction_is_not_told_to_start_from_a_relation():
    said = coursework.open_course()["parallel_joints"].variant(27, lang="en").grade({"axis_dir": "(1; 0; 0)"})
    assert said["axis_dir"].verdict == "wrong"
    assert "the basis of the coordinates" in said["axis_dir"].feedback
