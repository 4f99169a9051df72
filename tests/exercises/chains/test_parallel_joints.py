"""Joints in parallel: the answers against exact ranks, and lists of joints that a caller gives."""

import numpy as np
import pytest
from exact_joints import COUNTS, FREE, actions, arrangement, exact_rank
from tables import each_row

import coursework
from coursework.errors import CannotTell, UnknownName, WrongValue
from coursework.structure.spatial_chains import FREEDOMS, aligned

EXERCISE = coursework.open_course()["parallel_joints"]


def test_ranks_are_those_of_whole_numbers():
    for variant in EXERCISE.variants(range(150)):
        answers = variant.solution()
        rows = [row for joint in arrangement(variant.given) for row in actions(*joint)]
        rank = exact_rank(rows)
        assert (answers["Ns"], answers["rs"]) == (len(rows), rank)
        assert (answers["h"], answers["m"]) == (len(rows) - rank, 6 - rank)
        assert answers["m"] > 0
        assert FREEDOMS.get(answers["equivalent"], answers["m"]) == answers["m"]
        if "axis_point" in answers and answers["equivalent"] == "revolute":
            turn = np.array(answers["axis_dir"], float)
            twist = np.concatenate([turn, np.cross(answers["axis_point"], turn)])
            np.testing.assert_allclose(np.array(rows, float) @ twist, 0, atol=1e-9)


def test_every_arrangement_is_drawn():
    found = [variant.given["arrangement"] for variant in EXERCISE.variants(range(400))]
    assert all(found.count(name) >= 10 for name in COUNTS)
    assert sum(found.count(name) for name in ("two", "three", "four")) >= 80, "upright ones too"


def conditions(joints):
    """Angular and linear ones of joints in whole numbers: actions that balance one another, without a force
    and with."""
    rows, pure = [], []
    for joint in joints:
        for row in actions(*joint):
            rows.append(row)
            pure += [] if any(row[3:]) else [row[:3]]
    angular = len(pure) - exact_rank(pure)
    return angular, len(rows) - exact_rank(rows) - angular


def test_the_conditions_are_those_of_whole_numbers_and_all_are_met():
    names = {
        (False, False): "none",
        (True, False): "directions",
        (False, True): "positions",
        (True, True): "both",
    }
    met = []
    for variant in EXERCISE.variants(range(200)):
        angular, linear = conditions(arrangement(variant.given))
        assert variant.solution()["condition"] == names[angular > 0, linear > 0]
        met.append((angular > 0, linear > 0))
    assert min(met.count(case) for case in names) >= 8


@each_row(
    ("joints", "condition"),
    [
        # Two sleeves on one shaft: coaxial.
        (
            [{"joint": "cylindrical", "axis": (2, 3, 6), "point": p} for p in ((0, 0, 0), (20, 30, 60))],
            "both",
        ),
        # A plate on two planes that meet: at a right angle or not, one direction.
        ([{"joint": "planar", "normal": n} for n in ((0, 3, 4), (1, 2, 2))], "directions"),
        # A ball in a ball's seat: centres that coincide.
        ([{"joint": "spherical", "point": (7, -3, 2)}] * 2, "positions"),
        # A pin in a groove and a ball: nothing.
        (
            [
                {"joint": "spherical", "point": (0, 0, 0)},
                {"joint": "annular", "axis": (1, 2, 2), "point": (10, 20, 20)},
            ],
            "none",
        ),
        # Two slides anywhere, parallel.
        ([{"joint": "prismatic", "axis": (0, 3, 4)}] * 2, "both"),
        # A fixed plate between two planes that are parallel: a thickness as well.
        ([{"joint": "planar", "normal": (1, 2, 2)}] * 2, "both"),
    ],
)
def test_what_must_be_made_exactly(joints, condition):
    assert EXERCISE.solve(joints=joints, only="condition") == {"condition": condition}


def test_random_inclined_joints_against_whole_numbers():
    """Two to four joints whose axes are any whole numbers in a coordinate plane, at any points."""
    rng = np.random.default_rng(19)
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
            joints=[aligned(*joint) for joint in drawn], only=("Ns", "rs", "h", "m", "condition")
        )
        rows = [row for joint in drawn for row in actions(*joint)]
        rank, (angular, linear) = exact_rank(rows), conditions(drawn)
        assert (found["Ns"], found["rs"], found["h"], found["m"]) == (
            len(rows),
            rank,
            len(rows) - rank,
            6 - rank,
        )
        assert (
            found["condition"]
            == ["none", "directions", "positions", "both"][(angular > 0) + 2 * (linear > 0)]
        )


def test_the_axis_is_asked_where_there_is_one():
    for variant in EXERCISE.variants(range(100)):
        equivalent = variant.solution()["equivalent"]
        assert ("axis_dir" in variant.part_ids) == (
            equivalent not in ("other", "rigid", "spherical", "spherical_pin", "free")
        )
        assert ("axis_point" in variant.part_ids) == (
            equivalent in ("revolute", "helical", "cylindrical", "point_contact")
        )


@each_row("kind", [list, tuple])
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


def hinge(lang):
    """A variant whose joints are together a hinge."""
    seed = next(v.seed for v in EXERCISE.variants(range(100)) if v.solution()["equivalent"] == "revolute")
    return EXERCISE.variant(seed, lang=lang)


def test_a_joint_is_known_with_its_article_or_without():
    variant = hinge("fr")
    for said in ("une liaison pivot", "liaison pivot", "Liaison pivot", "a revolute joint", "revolute joint"):
        assert variant.grade({"equivalent": said})["equivalent"].verdict == "correct", said


def test_a_wrong_direction_is_not_told_to_start_from_a_relation():
    said = hinge("en").grade({"axis_dir": "(1; 2; 3)"})
    assert said["axis_dir"].verdict == "wrong"
    assert "the basis of the coordinates" in said["axis_dir"].feedback
