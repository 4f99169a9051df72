"""Joints in series: the answers against exact ranks, and lists of joints that a caller gives."""

import numpy as np
import pytest
from exact_joints import exact_rank, motions

import coursework
from coursework.solids import FREEDOMS

EXERCISE = coursework.open_course()["serial_joints"]


def test_ranks_are_those_of_whole_numbers():
    for variant in EXERCISE.variants(range(150)):
        g, answers = variant.given, variant.solution()
        place = [int(g[n]) for n in ("x2", "y2", "z2")]
        rows = motions(g["joint_1"], g["direction_1"], (0, 0, 0)) + motions(
            g["joint_2"], g["direction_2"], place
        )
        rank = exact_rank(rows)
        assert (answers["Nc"], answers["m"], answers["h"]) == (len(rows), len(rows), 0)
        assert (answers["m_useful"], answers["m_internal"]) == (rank, len(rows) - rank)
        assert FREEDOMS.get(answers["equivalent"], rank) == rank
        if answers["equivalent"] == "point_contact":
            force = np.array(answers["axis_dir"], float)
            wrench = np.concatenate([np.cross(answers["axis_point"], force), force])
            np.testing.assert_allclose(np.array(rows, float) @ wrench, 0, atol=1e-9)


def test_the_axis_is_asked_where_there_is_one():
    for variant in EXERCISE.variants(range(100)):
        equivalent = variant.solution()["equivalent"]
        assert ("axis_dir" in variant.part_ids) == (
            equivalent not in ("other", "rigid", "spherical", "spherical_pin", "free")
        )
        assert ("axis_point" in variant.part_ids) == (
            equivalent in ("revolute", "helical", "cylindrical", "point_contact")
        )


def test_a_caller_gives_any_joints_in_any_order_of_the_row():
    """A robot's wrist on an arm: six hinges, six freedoms, unless two of them are in line."""

    def arm(wrist):
        return [
            {"joint": "revolute", "axis": axis, "point": point}
            for axis, point in [
                ((0, 0, 1), (0, 0, 0)),
                ((0, 1, 0), (0, 0, 300)),
                ((0, 1, 0), (300, 0, 700)),
                ((1, 0, 0), (800, 0, 300)),
                ((0, 1, 0), (800, 0, 300)),
                (wrist, (800, 0, 300)),
            ]
        ]

    only = ("Nc", "m_useful", "m_internal", "equivalent")
    bent = EXERCISE.solve(joints=arm((0.6, 0, 0.8)), only=only)
    assert bent == {"Nc": 6, "m_useful": 6, "m_internal": 0, "equivalent": "free"}
    straight = EXERCISE.solve(joints=arm((1, 0, 0)), only=only)
    assert (straight["Nc"], straight["m_useful"], straight["m_internal"]) == (6, 5, 1)
    assert EXERCISE.solve(joints=arm((1, 0, 0))[::-1], only=only) == straight


@pytest.mark.parametrize("pitch", [5.0, -12.0])
def test_a_screw_in_a_row_with_itself_stays_a_screw(pitch):
    screw = {"joint": "helical", "axis": [0, 0, 2], "point": [10, 20, 0], "pitch": pitch}
    found = EXERCISE.solve(joints=[screw, {**screw, "point": [10, 20, 70]}])
    assert (found["m_useful"], found["m_internal"], found["equivalent"]) == (1, 1, "helical")
    np.testing.assert_allclose(found["axis_point"][:2], [10, 20], rtol=1e-12)
