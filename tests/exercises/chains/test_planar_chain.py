"""Plane chains: the answers against exact motions of the bodies in the plane and in space, and the course's
table."""

import numpy as np
import pytest
from exact_chains import freedoms, hindered
from tables import each_row

import coursework
from coursework.errors import CannotTell, WrongValue
from coursework.structure.spatial_chains import aligned

EXERCISE = coursework.open_course()["planar_chain"]
BETWEEN = [(0, 1), (1, 2), (2, 3), (3, 0)]
Z = (0, 0, 1)

#: The reminder of the course: what a joint is in the plane xy, by its direction.
IN_PLANE = {
    **{(name, "z"): "revolute" for name in ("revolute", "cylindrical", "annular")},
    **{("spherical", along): "revolute" for along in "xyz"},
    **{(name, along): "prismatic" for name in ("prismatic", "cylindrical", "planar") for along in "xy"},
    ("line_contact", "x"): "prismatic",
    ("line_contact", "z"): "point_contact",
    **{(name, along): "point_contact" for name in ("annular", "point_contact") for along in "xy"},
    # What the course does not say: nothing is hindered.
    ("planar", "z"): "free",
    ("point_contact", "z"): "free",
}
#: A direction in the plane that is neither x nor y is as x is, a line of contact with its normal in the
#: plane.
INCLINED = ("3 4 0", "4 -3 0")
IN_PLANE |= {
    (name, way): kind for (name, along), kind in IN_PLANE.items() if along == "x" for way in INCLINED
}
HINDERED_IN_PLANE = {"revolute": 2, "prismatic": 2, "point_contact": 1, "free": 0}


def joints_of(given):
    points = [(0, 0, 0)] + [(int(given[f"x{k}"]), int(given[f"y{k}"]), 0) for k in (2, 3, 4)]
    return [(given[f"joint_{k}"], given[f"direction_{k}"], point) for k, point in enumerate(points, start=1)]


def in_plane(rows):
    """Of what a joint forbids, what bears on rotation z and velocities x and y alone."""
    return [[row[2], row[3], row[4]] for row in rows if any((row[2], row[3], row[4]))]


def test_inclined_joints_are_drawn_and_upright_ones_too():
    found = [v.given["direction_2"] in INCLINED for v in EXERCISE.variants(range(100))]
    assert min(found.count(False), found.count(True)) >= 10


def wedge(slope):
    """A slide along x pushes one along y up a slope, a vector in the plane."""
    slides = [(1, 0, 0), slope, (0, 1, 0)]
    return [{"between": [k, (k + 1) % 3], "joint": "prismatic", "axis": a} for k, a in enumerate(slides)]


def test_a_chain_of_three_joints_is_solved_whole():
    """What is asked of a fourth joint is empty; everything else is told."""
    found = EXERCISE.solve(joints=wedge((1, 1, 0)))
    assert [found[f"planar_{k}"] for k in (1, 2, 3, 4)] == ["prismatic", "prismatic", "prismatic", ""]
    assert (found["Nc"], found["rc"], found["m"]) == (3, 2, 1)


def test_a_wedge_is_a_plane_chain_whatever_its_slope():
    for slope in ((3, 4, 0), (1, 0.1, 0), (-1e-3, 1, 0), (1e6, 1, 0)):
        found = EXERCISE.solve(joints=wedge(slope), only=("planar_2", "Nc", "rc", "m", "h", "h_space"))
        assert found == {"planar_2": "prismatic", "Nc": 3, "rc": 2, "m": 1, "h": 1, "h_space": 4}
    with pytest.raises(CannotTell):
        EXERCISE.solve(
            joints=[*wedge((1, 0, 0))[:2], {"between": [2, 0], "joint": "prismatic", "axis": (1, 1e-9, 0)}],
            only="m",
        )


def gears(normal, contact=(40, 0, 0)):
    return [
        {"between": [0, 1], "joint": "revolute", "axis": Z, "point": (0, 0, 0)},
        {"between": [1, 2], "joint": "point_contact", "normal": normal, "point": contact},
        {"between": [2, 0], "joint": "revolute", "axis": Z, "point": (100, 0, 0)},
    ]


def test_a_pair_of_gears_turns_along_any_line_of_action_but_through_an_axis():
    for normal in ((0, 1, 0), (0.342020143, 0.939692621, 0), (1, 5, 0)):
        found = EXERCISE.solve(joints=gears(normal), only=("planar_2", "Nc", "rc", "m", "h"))
        assert found == {"planar_2": "point_contact", "Nc": 4, "rc": 3, "m": 1, "h": 0}
    # Along the line of centres the contact hinders nothing that the axes allow: both wheels turn alone.
    assert EXERCISE.solve(joints=gears((1, 0, 0)), only=("rc", "m", "h")) == {"rc": 2, "m": 2, "h": 1}


def from_(place, length, angle):
    """A point at the end of a link, as a complex number."""
    return place + length * np.exp(1j * angle)


def test_the_three_loop_shaper_of_the_notes_is_given_as_it_stands():
    """Figure 14: a four-bar whose coupler ABE drives a block on the bar DF, and by a rod a ram; the bar is at
    any angle."""
    shaper = coursework.open_course()["three_loop_shaper"]
    for seed in range(5):
        variant = shaper.variant(seed)
        g, at = variant.given, variant.quantities(("theta3", "theta4", "theta5", "theta7"))
        along = {k: np.radians(float(at[k])) for k in ("theta3", "theta4", "theta5", "theta7")}

        A, C, D = from_(0, g["r2"], np.radians(g["theta2"])), g["xC"] + 1j * g["yC"], g["xD"] + 1j * g["yD"]
        B, F = from_(C, g["r4"], along["theta4"]), from_(D, g["r5"], along["theta5"])
        E, G = from_(A, g["r6"], along["theta3"] + np.radians(g["beta"])), from_(F, g["r7"], along["theta7"])
        pins = [(0, 1, 0j), (1, 2, A), (2, 3, B), (3, 0, C), (2, 4, E), (5, 0, D), (5, 6, F), (6, 7, G)]
        joints = [
            {"between": [i, j], "joint": "revolute", "axis": Z, "point": (z.real, z.imag, 0)}
            for i, j, z in pins
        ]
        bar = np.exp(1j * along["theta5"])
        joints += [
            {"between": [4, 5], "joint": "prismatic", "axis": (bar.real, bar.imag, 0)},
            {"between": [7, 0], "joint": "prismatic", "axis": (1, 0, 0)},
        ]
        found = EXERCISE.solve(joints=joints, only=("n", "gamma", "Nc", "m", "h"))
        assert found == {"n": 7, "gamma": 3, "Nc": 10, "m": 1, "h": 0}


def test_four_bodies_with_inclined_joints_against_whole_numbers():
    """Plane chains of any slopes and of one loop or two, by exact motions of the bodies."""
    rng = np.random.default_rng(11)
    slopes = ["3 4 0", "4 -3 0", "1 2 0", "5 -12 0", "x", "y", "1 1 0"]
    met = set()
    for _ in range(150):
        size = int(rng.integers(3, 6))
        between = [(k, (k + 1) % size) for k in range(size)] + [(0, 2)] * int(rng.integers(0, 2))
        drawn = []
        for _ in between:
            name = str(
                rng.choice(["revolute", "prismatic", "planar", "point_contact", "annular", "cylindrical"])
            )
            way = "z" if name == "revolute" else str(rng.choice(slopes))
            drawn.append((name, way, (*(20 * int(c) for c in rng.integers(-3, 4, 2)), 0)))
        forbidden = [(b, hindered(*one)) for b, one in zip(between, drawn, strict=True)]
        joints = [aligned(name, way, place, b) for b, (name, way, place) in zip(between, drawn, strict=True)]
        m, Ns = freedoms(size - 1, [(b, in_plane(rows)) for b, rows in forbidden])
        spatial, unknowns = freedoms(size - 1, forbidden)
        found = EXERCISE.solve(joints=joints, only=("m", "Ns", "h", "h_space", "gamma"))
        assert found["m"] == m
        assert found["Ns"] == Ns
        assert found["h"] == Ns - (3 * (size - 1) - m)
        assert found["h_space"] == unknowns - (6 * (size - 1) - spatial)
        met.add((found["gamma"], found["m"]))
    assert len(met) >= 6


@each_row("block", range(3))
def test_answers_are_those_of_exact_motions_of_the_bodies(block):
    for variant in EXERCISE.variants(range(60 * block, 60 * block + 60), parts=["all"]):
        a, joints = variant.solution(), joints_of(variant.given)
        kinds = [IN_PLANE[name, along] for name, along, _ in joints]
        assert [a[f"planar_{k}"] for k in (1, 2, 3, 4)] == kinds
        forbidden = [(between, hindered(*joint)) for between, joint in zip(BETWEEN, joints, strict=True)]
        m, Ns = freedoms(3, [(between, in_plane(rows)) for between, rows in forbidden])
        assert Ns == sum(HINDERED_IN_PLANE[kind] for kind in kinds)
        assert (a["gamma"], a["m"], a["Ns"], a["Nc"]) == (1, m, Ns, 12 - Ns)
        assert (a["rc"], a["rs"]) == (12 - Ns - m, 9 - m)
        assert a["h"] == Ns - (9 - m)
        assert a["m"] - a["h"] == 3 * 3 - a["Ns"] == a["Nc"] - 3 * a["gamma"]
        spatial, unknowns = freedoms(3, forbidden)
        assert a["h_space"] == unknowns - (18 - spatial)
        expected = "plane" if a["h"] else "hidden" if a["h_space"] else "sound"
        assert a["comparison"] == expected


def test_every_comparison_is_met():
    found = [v.solution()["comparison"] for v in EXERCISE.variants(range(100))]
    assert min(found.count(case) for case in ("sound", "hidden", "plane")) >= 8


def hinges(points):
    size = len(points)
    return [
        {"between": [k, (k + 1) % size], "joint": "revolute", "axis": Z, "point": (*points[k], 0)}
        for k in range(size)
    ]


def test_a_flat_four_bar_gains_a_motion_and_nearly_flat_it_cannot_be_told():
    wanted = ("Nc", "rc", "m", "h", "h_space")
    open_ = EXERCISE.solve(joints=hinges([(0, 0), (40, 30), (140, 0), (90, 0)]), only=wanted)
    assert open_ == {"Nc": 4, "rc": 3, "m": 1, "h": 0, "h_space": 3}
    flat = EXERCISE.solve(joints=hinges([(0, 0), (40, 0), (140, 0), (90, 0)]), only=wanted)
    assert flat == {"Nc": 4, "rc": 2, "m": 2, "h": 1, "h_space": 4}
    with pytest.raises(CannotTell):
        EXERCISE.solve(joints=hinges([(0, 0), (40, 1e-7), (140, 0), (90, 0)]), only="rc")


def test_loops_in_the_plane_count_three_each():
    """A four-bar that drives a slide by a rod."""
    joints = hinges([(0, 0), (0, 40), (100, 80), (120, 0)])
    joints += [
        {"between": [3, 4], "joint": "spherical", "point": (150, 60, 0)},
        {"between": [4, 5], "joint": "annular", "axis": Z, "point": (300, 0, 0)},
        {"between": [5, 0], "joint": "planar", "normal": (0, 1, 0)},
    ]
    a = EXERCISE.solve(joints=joints, only=("gamma", "Nc", "rc", "m", "Ns", "h", "comparison", "h_space"))
    assert {k: a[k] for k in ("gamma", "Nc", "rc", "m", "Ns", "h")} == {
        "gamma": 2,
        "Nc": 7,
        "rc": 6,
        "m": 1,
        "Ns": 14,
        "h": 0,
    }
    assert a["comparison"] == "hidden"


def test_what_is_no_plane_problem_is_said():
    tilted = [
        *hinges([(0, 0), (40, 30), (140, 0)]),
        {"between": [2, 0], "joint": "prismatic", "axis": (1, 0, 1)},
    ]
    with pytest.raises(WrongValue, match="in the plane xy or along z"):
        EXERCISE.solve(joints=tilted, only="Nc")
