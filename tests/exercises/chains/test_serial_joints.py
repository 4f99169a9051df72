"""Joints in series: the answers against exact ranks, and lists of joints that a caller gives."""

import numpy as np
from exact_joints import COUNTS, FREE, arrangement, exact_rank, motions
from sweeps import seeds
from tables import each_row

import coursework
from coursework.structure.spatial_chains import FREEDOMS, aligned

EXERCISE = coursework.open_course()["serial_joints"]


@seeds(50, 150)
def test_ranks_are_those_of_whole_numbers(seeds):
    for variant in EXERCISE.variants(seeds, parts=["usual", "m", "h"]):
        answers = variant.solution()
        rows = [row for joint in arrangement(variant.given) for row in motions(*joint)]
        rank = exact_rank(rows)
        assert (answers["Nc"], answers["m"], answers["h"]) == (len(rows), len(rows), 0)
        assert (answers["m_useful"], answers["m_internal"]) == (rank, len(rows) - rank)
        assert FREEDOMS.get(answers["equivalent"], rank) == rank
        if answers["equivalent"] == "point_contact":
            force = np.array(answers["axis_dir"], float)
            wrench = np.concatenate([np.cross(answers["axis_point"], force), force])
            np.testing.assert_allclose(np.array(rows, float) @ wrench, 0, atol=1e-9)


@seeds(150, 400)
def test_every_arrangement_is_drawn(seeds):
    found = [variant.given["arrangement"] for variant in EXERCISE.variants(seeds)]
    assert all(found.count(name) >= len(found) / 40 for name in COUNTS)
    assert sum(found.count(name) for name in ("two", "three", "four")) >= len(found) / 5, "upright ones too"


def test_random_inclined_joints_against_whole_numbers():
    rng = np.random.default_rng(23)
    ways = ["x", "y", "z", "0 3 4", "4 0 -3", "5 12 0", "1 1 0", "0 2 -1", "3 0 1"]
    for _ in range(200):
        drawn = [
            (
                str(rng.choice(list(FREE))),
                str(rng.choice(ways)),
                [int(c) for c in 10 * rng.integers(-3, 4, 3)],
            )
            for _ in range(rng.integers(2, 5))
        ]
        found = EXERCISE.solve(
            joints=[aligned(*joint) for joint in drawn], only=("Nc", "m_useful", "m_internal")
        )
        rows = [row for joint in drawn for row in motions(*joint)]
        rank = exact_rank(rows)
        assert (found["Nc"], found["m_useful"], found["m_internal"]) == (len(rows), rank, len(rows) - rank)


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
    assert bent == {"Nc": 6, "m_useful": 6, "m_internal": 0, "equivalent": "other"}
    straight = EXERCISE.solve(joints=arm((1, 0, 0)), only=only)
    assert (straight["Nc"], straight["m_useful"], straight["m_internal"]) == (6, 5, 1)
    assert EXERCISE.solve(joints=arm((1, 0, 0))[::-1], only=only) == straight


@each_row("pitch", [5.0, -12.0])
def test_a_screw_in_a_row_with_itself_stays_a_screw(pitch):
    screw = {"joint": "helical", "axis": [0, 0, 2], "point": [10, 20, 0], "pitch": pitch}
    found = EXERCISE.solve(joints=[screw, {**screw, "point": [10, 20, 70]}])
    assert (found["m_useful"], found["m_internal"], found["equivalent"]) == (1, 1, "helical")
    np.testing.assert_allclose(found["axis_point"][:2], [10, 20], rtol=1e-12)
