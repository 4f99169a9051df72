"""Twists and wrenches of joints at a point: against exact fractions, whole numbers, and what students
write."""

from fractions import Fraction
from math import isqrt

import numpy as np
import pytest
from exact_joints import actions, cross, exact_rank, motions

import coursework
from coursework.errors import WrongValue
from coursework.kinds.kind import kind_of
from coursework.structure.spatial_chains import in_series, joints_of, twist_components, wrench_components

EXERCISE = coursework.open_course()["joint_twist"]
VARIANTS = EXERCISE.variants(range(80))

TWIST, WRENCH = kind_of("twist").form.names, kind_of("wrench").form.names


def exact(given):
    """The numerical answers in fractions."""
    whole = [int(x) for x in given["axis"].split()]
    size = isqrt(sum(x * x for x in whole))
    assert size * size == sum(x * x for x in whole), "a unit vector of fractions"
    e = [Fraction(x, size) for x in whole]
    arm = [int(given[c]) for c in ("x2", "y2", "z2")]
    turn, slide = [int(given["omega1"]) * x for x in e], [int(given["v1"]) * x for x in e]
    second = [int(given["omega2"]) * int(letter == given["hinge"]) for letter in "xyz"]
    forces = [[int(given[f"{c}{k}"]) for c in "XYZ"] for k in (1, 2)]
    return {
        "V_10": [*turn, *(v + c for v, c in zip(slide, cross(turn, arm), strict=True))],
        "V_20": [
            *(a + b for a, b in zip(turn, second, strict=True)),
            *(v - c for v, c in zip(slide, cross(second, arm), strict=True)),
        ],
        "V_plane": [-int(given["omega2"]) * arm[1], int(given["omega2"]) * arm[0], int(given["omega2"])],
        "W": [*(a + b for a, b in zip(*forces, strict=True)), *cross(arm, forces[1])],
    }


def shifted(rows, point):
    """Rows (line, moment at the origin) with the moment at a point."""
    found = []
    for row in rows:
        change = cross([-c for c in point], row[:3])
        found.append([*row[:3], *(m + c for m, c in zip(row[3:], change, strict=True))])
    return found


def named(rows, names):
    return " ".join(name for place, name in enumerate(names) if any(row[place] for row in rows)) or "0"


def forces_first(rows):
    return [[*row[3:], *row[:3]] for row in rows]


def left_by(held):
    """The components in which a motion is left that no action of the rows (moment, force) opposes."""
    rank, found = exact_rank(held), []
    for place, name in enumerate(TWIST):
        # One is left with this component exactly if saying that it vanishes takes a freedom away.
        nothing = [int(k == place) for k in range(6)]
        if exact_rank([*held, nothing]) > rank:
            found.append(name)
    return " ".join(found) or "0"


def test_numbers_are_those_of_fractions():
    for variant in VARIANTS:
        answers = variant.solution()
        for name, right in exact(variant.given).items():
            np.testing.assert_allclose(answers[name], [float(x) for x in right], rtol=1e-14, atol=1e-12)


def test_patterns_are_those_of_whole_numbers():
    for variant in VARIANTS:
        g, answers = variant.given, variant.solution()
        place = [int(g[c]) for c in ("x2", "y2", "z2")]
        first, second = (g["joint_1"], g["direction_1"], (0, 0, 0)), (g["joint_2"], g["direction_2"], place)
        assert answers["twist_1"] == named(motions(*first), TWIST)
        assert answers["twist_1_at_2"] == named(shifted(motions(*first), place), TWIST)
        assert answers["wrench_1_at_2"] == named(shifted(forces_first(actions(*first)), place), WRENCH)
        held = actions(*first) + actions(*second)
        assert answers["wrench_both"] == named(forces_first(held), WRENCH)
        assert answers["twist_both"] == left_by(held)


def test_hinges_are_drawn_and_motions_are_left_too():
    names = [variant.given["joint_1"] for variant in VARIANTS]
    left = [variant.solution()["twist_both"] for variant in VARIANTS]
    assert names.count("revolute") >= 5
    assert len(set(names)) >= 7
    assert sum(one != "0" for one in left) >= 40


def test_a_row_of_inclined_joints_has_the_components_of_each():
    row = in_series(
        joints_of(
            [
                {"joint": "revolute", "axis": (0, 3, 4), "point": (0, 0, 0)},
                {"joint": "prismatic", "axis": (1, 0, 0)},
            ]
        )
    )
    assert twist_components(row, (0.0, 0.0, 0.0)) == "wy wz vx"
    assert twist_components(row, (20.0, 0.0, 0.0)) == "wy wz vx vy vz"
    assert wrench_components(row, (0.0, 0.0, 0.0)) == "Y Z L M N"


@pytest.fixture
def variant():
    return EXERCISE.variant(1, lang="en")


def text(value):
    first, second = (" ".join(map(repr, half)) for half in (value[:3].tolist(), value[3:].tolist()))
    return f"{{{first} | {second}}}"


@pytest.mark.parametrize("name", ["V_10", "V_20", "W"])
def test_right_answers_in_other_units_and_slips(variant, name):
    right = variant.solution()[name]
    in_metres = right.copy()
    in_metres[3:] /= 1000
    units = "N, N.m" if name == "W" else "rad/s, m/s"

    def verdict(answer):
        return variant.grade({name: answer})[name].verdict

    assert verdict(text(right)) == "correct"
    assert verdict(f"{text(in_metres)} {units}") == "correct"
    assert verdict(text(in_metres)) == "slip:unit"
    assert verdict(text(-right)) == "slip:sign"
    assert verdict(text(np.roll(right, 3))) == "slip:columns"


def test_mistakes_leave_what_is_right(variant):
    right = variant.solution()
    at_own_point = variant.grade({"twist_1_at_2": right["twist_1"]})["twist_1_at_2"]
    assert at_own_point.verdict == "mistake:the_same_at_every_point"
    assert at_own_point.points == pytest.approx(2 * 2 / 3), "wy and vy of wy, vx, vy"
    off = right["V_10"].copy()
    off[4] += 50
    mark = variant.grade({"V_10": text(off)})["V_10"]
    assert (mark.verdict, mark.points) == ("partial", pytest.approx(3 * 5 / 6))
    assert variant.grade({"V_10": "0 0 0 0 0 0"})["V_10"].points == 0


def test_plane_twists_are_three_numbers_or_a_table(variant):
    vx, vy, wz = variant.solution()["V_plane"].tolist()
    for answer in (f"{vx}; {vy}; {wz}", f"{{- {vx}; - {vy}; {wz} -}}", f"wz = {wz}, vx = {vx}, vy = {vy}"):
        assert variant.grade({"V_plane": answer})["V_plane"].verdict == "correct", answer


def test_a_caller_gives_joints_and_data_of_their_own():
    tilted = [
        {"joint": "cylindrical", "axis": (1, 2, 2), "point": (0, 0, 0)},
        {"joint": "revolute", "axis": (2, -1, 0), "point": (10, 20, 20)},
    ]
    found = EXERCISE.solve(joints=tilted, only=("twist_1", "twist_1_at_2", "twist_both"))
    assert found["twist_1"] == "wx wy wz vx vy vz"
    assert found["twist_1_at_2"] == found["twist_1"], "A2 is on the axis"
    assert found["twist_both"] == "0"
    with pytest.raises(WrongValue, match="second joint"):
        EXERCISE.solve(joints=tilted[:1], only="twist_1_at_2")
