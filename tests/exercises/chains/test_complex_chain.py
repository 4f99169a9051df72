"""Complex chains: the answers against exact motions of the bodies, and known mechanisms of several loops."""

import math

import numpy as np
import pytest
from exact_chains import freedoms, held, hindered

import coursework
from coursework.errors import CannotTell

EXERCISE = coursework.open_course()["complex_chain"]
BETWEEN = {
    "rocker_slider": [(0, 1), (1, 2), (2, 3), (3, 0), (3, 4), (4, 5), (5, 0)],
    "coupler_slider": [(0, 1), (1, 2), (2, 3), (3, 0), (2, 4), (4, 5), (5, 0)],
    "two_guides": [(0, 1), (1, 2), (2, 3), (3, 0), (3, 4), (4, 5), (5, 0), (5, 0)],
    "strut": [(0, 1), (1, 2), (2, 3), (3, 0), (3, 4), (4, 0)],
}
Z = (0, 0, 1)


def exact_joints(given):
    g = {name: int(value) for name, value in given.items() if isinstance(value, float)}
    E = (g["xE"], g["yE"], 0)
    points = [(0, 0, 0), (g["xA"], g["yA"], 0), (g["xB"], g["yB"], 0), (g["xC"], 0, 0), (g["xD"], g["yD"], 0)]
    points += [E, E, (g["xE"] + 60, g["yE"], 0)]
    return [
        (between, hindered(given[f"joint_{k}"], "z" if k <= 6 else "x", point))
        for k, (between, point) in enumerate(zip(BETWEEN[given["layout"]], points, strict=False), start=1)
    ]


def test_answers_are_those_of_exact_motions_of_the_bodies():
    for variant in EXERCISE.variants(range(60)):
        a, joints = variant.solution(), exact_joints(variant.given)
        bodies = max(max(between) for between, _ in joints)
        m, Ns = freedoms(bodies, joints)
        output = 3 if variant.given["layout"] == "strut" else bodies
        internal, _ = freedoms(bodies, [*joints, held(1), held(output)])
        assert (a["n"], a["gamma"]) == (bodies, len(joints) - bodies)
        assert (a["Ns"], a["Nc"]) == (Ns, 6 * len(joints) - Ns)
        assert (a["m"], a["m_internal"], a["m_useful"]) == (m, internal, m - internal)
        assert a["h"] == Ns - (6 * bodies - m)
        assert a["rc"] == a["Nc"] - m
        assert a["i"] == 6 * bodies - Ns == a["Nc"] - 6 * a["gamma"]
        assert a["statics"] == ("hyperstatic" if a["h"] else "isostatic")
        assert a["role"] == {0: "clamp", 1: "transforms"}.get(m - internal, "adjusted")


def test_every_layout_and_every_role_is_met():
    variants = EXERCISE.variants(range(80))
    assert {v.given["layout"] for v in variants} == set(BETWEEN)
    assert {v.solution()["role"] for v in variants} == {"clamp", "transforms", "adjusted"}


def test_the_sheet_lists_no_data_beside_the_table():
    variant = EXERCISE.variant(0)
    assert variant.handout().given == ()
    assert set(variant.record["given"]) == set(EXERCISE.spec.given)


def hinge(one, other, point, axis=Z):
    return {"between": [one, other], "joint": "revolute", "axis": axis, "point": point}


def bennett(first, bodies, alpha=0.5, a=40.0, b=60.0, angle=1.1):
    """Four hinges whose distances are as the sines of their twists: axes found by walking around the loop.

    Links a, b, a, b with twists alpha, beta; the closing angles obey tan(θ/2) tan(φ/2) =
    sin((β+α)/2)/sin((β-α)/2).
    """
    beta = math.asin(b * math.sin(alpha) / a)
    other = 2 * math.atan(math.sin((beta + alpha) / 2) / math.sin((beta - alpha) / 2) / math.tan(angle / 2))
    place, joints = np.eye(4), []
    walk = ((a, alpha, angle), (b, beta, other), (a, alpha, -angle), (b, beta, -other))
    for k, (length, twist, turn) in enumerate(walk):
        one, two = bodies[k], bodies[(k + 1) % 4]
        joints.append(hinge(one, two, tuple(place[:3, 3] + first), tuple(place[:3, 2])))
        c, s, ct, st = math.cos(turn), math.sin(turn), math.cos(twist), math.sin(twist)
        step = np.array(
            [[c, -s * ct, s * st, length * c], [s, c * ct, -c * st, length * s], [0, st, ct, 0], [0, 0, 0, 1]]
        )
        place = place @ step
    return joints, place


def test_two_bennett_loops_one_driving_the_other():
    """Each loop has four hinges against six equations, and moves: rank 3 in each."""
    one, closed = bennett(np.zeros(3), (0, 1, 2, 3))
    assert np.allclose(closed, np.eye(4), atol=1e-12), "the walk around the loop must close"
    two, _ = bennett(np.zeros(3), (0, 3, 4, 5))
    # The second loop turns about the hinge of body 3 on the frame, which both loops share.
    shared = one[3]
    axis_first = two[0]
    moved = _onto(axis_first, shared, two[1:])
    a = EXERCISE.solve(
        joints=[*one, *moved], input_body=1, output_body=5, only=("gamma", "Nc", "rc", "m", "h")
    )
    assert a == {"gamma": 2, "Nc": 7, "rc": 6, "m": 1, "h": 6}


def _onto(source, target, joints):
    """Joints carried by the motion that brings one hinge onto another."""
    u, w = np.array(source["axis"]), np.array(target["axis"])
    side, angle = np.cross(u, w), math.acos(np.clip(u @ w, -1, 1))
    side = side / np.linalg.norm(side)
    k = np.array([[0, -side[2], side[1]], [side[2], 0, -side[0]], [-side[1], side[0], 0]])
    turn = np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * k @ k
    return [
        {
            **joint,
            "axis": tuple(turn @ joint["axis"]),
            "point": tuple(turn @ (np.array(joint["point"]) - source["point"]) + target["point"]),
        }
        for joint in joints
    ]


def test_flat_four_bars_in_a_row_have_a_motion_more():
    """All hinges of the first loop on one line: rank 2 there, a dead point."""
    flat = [
        hinge(0, 1, (0, 0, 0)),
        hinge(1, 2, (40, 0, 0)),
        hinge(2, 3, (140, 0, 0)),
        hinge(3, 0, (90, 0, 0)),
    ]
    rod = [hinge(3, 4, (120, 50, 0)), hinge(4, 5, (250, 20, 0))]
    slide = {"between": [5, 0], "joint": "prismatic", "axis": (1, 0, 0)}
    given = {"input_body": 1, "output_body": 5, "only": ("m", "rc", "h")}
    assert EXERCISE.solve(joints=[*flat, *rod, slide], **given) == {"m": 2, "rc": 5, "h": 7}
    nearly = [*flat[:2], hinge(2, 3, (140, 1e-8, 0)), flat[3]]
    with pytest.raises(CannotTell):
        EXERCISE.solve(joints=[*nearly, *rod, slide], **given)
