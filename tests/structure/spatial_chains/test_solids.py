"""Chains of solids: identities of the course, mechanisms whose mobility is known, invariance, recognition."""

import math

import numpy as np
import pytest
from sweeps import slow
from tables import each_row

from coursework.errors import CannotTell, UnknownName, WrongValue
from coursework.structure.spatial_chains import (
    FREEDOMS,
    JOINTS,
    Chain,
    PlanarChain,
    in_parallel,
    in_series,
    joint_of,
    planar_kind,
    rank_of,
)

X, Y, Z, O = (1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, 0)
AXES = np.eye(3)


def joint(name, axis=X, point=O, normal=None, **more):
    """A joint with every key; a normal square to the axis unless told."""
    if normal is None:
        normal = axis if "axis" not in joint_keys(name) else np.roll(np.asarray(axis, float), 1)
    return {
        "joint": name,
        "axis": list(axis),
        "normal": list(normal),
        "point": list(point),
        "pitch": 5.0,
    } | more


def joint_keys(name):
    return ("normal",) if name in ("planar", "point_contact") else ("axis", "normal")


def drawn_joint(rng, between=(0, 1)):
    names = [n for n in JOINTS if n not in ("rigid", "free")]
    axis, normal = AXES[rng.permutation(3)[:2]]
    point = 20.0 * rng.integers(-3, 4, size=3)
    return joint(names[rng.integers(len(names))], axis, point, normal, between=list(between))


def drawn_ring(rng, size):
    """A closed chain of so many joints."""
    return [drawn_joint(rng, (k, (k + 1) % size)) for k in range(size)]


def moved(joints, rotation, shift, scale=1.0):
    """A rigidly moved copy, its lengths in another unit."""
    return [
        j
        | {
            "axis": rotation @ np.asarray(j["axis"], float),
            "normal": rotation @ np.asarray(j["normal"], float),
            "point": scale * (rotation @ np.asarray(j["point"], float) + shift),
            "pitch": scale * j["pitch"],
        }
        for j in joints
    ]


def drawn_rotation(rng):
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return q * np.linalg.det(q)


def numbers(chain):
    return chain.gamma, chain.Nc, chain.rc, chain.Ns, chain.rs, chain.m, chain.h, chain.i


# ------------------------------------------------------------------- one joint


@each_row("name", JOINTS)
def test_a_joint_is_recognised_as_itself(name):
    rng = np.random.default_rng(3)
    for _ in range(5):
        rotation, shift = drawn_rotation(rng), rng.normal(size=3) * 100
        (given,) = moved([joint(name, X, (10, 20, 30))], rotation, shift)
        for combined in (
            in_parallel([given]),
            in_series([given]),
            in_parallel([given] * 2),
            in_series([given] * 2),
        ):
            found = combined.equivalent
            assert found.name == name
            true = joint_of(given)
            if found.direction is not None:
                np.testing.assert_allclose(np.cross(found.direction, true.frame[0]), 0, atol=1e-12)
            if found.name == "line_contact":
                np.testing.assert_allclose(np.cross(found.normal, true.frame[1]), 0, atol=1e-12)
                off = np.asarray(found.point) - true.point
                assert abs(off @ np.asarray(true.frame[2])) < 1e-10
            elif found.point is not None:
                off = np.asarray(found.point) - true.point
                along = true.frame[0] if found.name not in ("spherical", "spherical_pin", "annular") else O
                assert np.linalg.norm(off - (off @ np.asarray(along)) * np.asarray(along)) < 1e-10
            if name == "helical":
                assert found.pitch == pytest.approx(5.0, rel=1e-12)


@each_row("name", JOINTS)
def test_a_joint_with_itself(name):
    """In parallel every action is shared, in series every motion is twofold."""
    given, f = joint(name, X, (10, 20, 30)), FREEDOMS[name]
    side, row = in_parallel([given, given]), in_series([given, given])
    assert (side.Ns, side.rs, side.h, side.m) == (2 * (6 - f), 6 - f, 6 - f, f)
    assert (row.Nc, row.m, row.m_useful, row.m_internal, row.h) == (2 * f, 2 * f, f, f, 0)


@each_row("name", JOINTS)
def test_no_transmitted_action_works_in_a_free_motion(name):
    given = joint_of(joint(name, (1, 2, 2), (10, -20, 30), (0, 1, -1)))
    twists = np.array(given.twists((5.0, 4.0, 3.0), 7.0)).reshape(-1, 6)
    wrenches = np.array(given.wrenches((5.0, 4.0, 3.0), 7.0)).reshape(-1, 6)
    assert len(twists) == FREEDOMS[name] == 6 - len(wrenches)
    np.testing.assert_allclose(twists @ wrenches.T, 0, atol=1e-14)


def test_the_point_of_a_turning_body_that_is_on_the_axis_stays():
    """Velocity at the origin of a rotation at rate 1 about the z axis through (2, 0, 0): minus y."""
    (row,) = joint_of(joint("revolute", Z, (2, 0, 0))).twists(O, 1.0)
    assert row == [0, 0, 1, 0, -2, 0]


def test_a_right_handed_screw_advances_along_its_axis():
    (row,) = joint_of(joint("helical", Z, O, pitch=2 * math.pi)).twists(O, 1.0)
    assert row == pytest.approx([0, 0, 1, 0, 0, 1])


# ------------------------------------------------------- parallel and in series


@each_row(
    ("joints", "expected", "direction", "point", "h"),
    [
        # Two journal bearings, one of which holds the shaft along it: a hinge, once too stiff in two ways.
        ([joint("spherical", X, O), joint("annular", X, (80, 0, 0))], "revolute", X, O, 0),
        ([joint("revolute", X, O), joint("revolute", X, (80, 0, 0))], "revolute", X, O, 5),
        ([joint("annular", X, O), joint("annular", X, (80, 0, 0))], "cylindrical", X, O, 0),
        ([joint("spherical", X, O), joint("point_contact", Y, (80, 0, 0))], "spherical_pin", None, O, 0),
        # A table on three points, and on four.
        ([joint("point_contact", Z, p) for p in ((0, 0, 0), (9, 0, 0), (0, 9, 0))], "planar", Z, None, 0),
        (
            [joint("point_contact", Z, p) for p in ((0, 0, 0), (9, 0, 0), (0, 9, 0), (9, 9, 0))],
            "planar",
            Z,
            None,
            1,
        ),
        ([joint("planar", Z), joint("planar", Y)], "prismatic", X, None, 1),
        ([joint("planar", Z), joint("line_contact", X, O, Y)], "prismatic", X, None, 0),
        ([joint("planar", Z), joint("point_contact", Y, O)], "other", None, None, 0),
        ([joint("point_contact", Z, O), joint("point_contact", Z, (9, 0, 0))], "line_contact", X, O, 0),
        ([joint("point_contact", Z, O), joint("point_contact", Y, O)], "annular", X, O, 0),
        ([joint("revolute", X, O), joint("prismatic", X)], "rigid", None, None, 4),
        ([joint("helical", X, O), joint("prismatic", Y)], "rigid", None, None, 4),
        ([joint("helical", X, O), joint("cylindrical", X, (5, 0, 0))], "helical", X, O, 4),
        ([joint("point_contact", Z, O), joint("free")], "point_contact", Z, O, 0),
    ],
)
def test_joints_in_parallel(joints, expected, direction, point, h):
    found = in_parallel(joints)
    assert (found.equivalent.name, found.h) == (expected, h)
    _check_line(found.equivalent, direction, point)


@each_row(
    ("joints", "expected", "direction", "point", "m_internal"),
    [
        ([joint("spherical", X, O), joint("planar", Z)], "point_contact", Z, O, 1),
        ([joint("spherical", X, O), joint("prismatic", X)], "annular", X, O, 0),
        ([joint("cylindrical", X, O), joint("revolute", X, (9, 0, 0))], "cylindrical", X, O, 1),
        ([joint("revolute", X, O), joint("revolute", Y, O)], "spherical_pin", Z, O, 0),
        ([joint("revolute", a, O) for a in (X, Y, Z)], "spherical", None, O, 0),
        ([joint("revolute", Z, p) for p in (O, (9, 0, 0), (0, 9, 0))], "planar", Z, None, 0),
        ([joint("revolute", Z, O), joint("planar", Y)], "line_contact", None, None, 0),
        ([joint("revolute", X, O), joint("revolute", Y, (0, 0, 9))], "other", None, None, 0),
        ([joint("prismatic", X), joint("prismatic", Y)], "other", None, None, 0),
        ([joint("spherical", X, O), joint("spherical", X, (9, 0, 0))], "point_contact", X, O, 1),
        ([joint("spherical", X, p) for p in (O, (9, 0, 0), (0, 9, 0))], "other", None, None, 3),
    ],
)
def test_joints_in_series(joints, expected, direction, point, m_internal):
    found = in_series(joints)
    assert (found.equivalent.name, found.m_internal, found.h) == (expected, m_internal, 0)
    assert found.m == found.m_useful + found.m_internal
    _check_line(found.equivalent, direction, point)


def _check_line(found, direction, point):
    if direction is not None:
        np.testing.assert_allclose(np.abs(found.direction), direction, atol=1e-12)
    if point is not None:
        off = np.asarray(found.point, float) - point
        allowed = np.asarray(found.direction or (0, 0, 0)) if found.name != "spherical_pin" else np.zeros(3)
        np.testing.assert_allclose(off - (off @ allowed) * allowed, 0, atol=1e-11)


def test_in_parallel_is_the_intersection_of_motions():
    """dim(A ∩ B) = dim A + dim B - dim(A + B): the parallel from the series, with other matrices."""
    rng = np.random.default_rng(8)
    for _ in range(60):
        a, b = drawn_joint(rng), drawn_joint(rng)
        both = in_series([a, b])
        assert in_parallel([a, b]).m == both.Nc - both.m_useful


# ---------------------------------------------------------------------- chains


def static_rank(chain):
    """The rank of the equilibrium equations of the moving bodies, computed from the actions themselves."""
    at, blocks = chain.measure, []
    for joint in chain.joints:
        wrenches = np.array(joint.wrenches(at.origin, at.length)).reshape(-1, 6).T
        column = np.zeros((6 * (chain.n + 1), wrenches.shape[1]))
        for body, sense in zip(joint.between, (1, -1), strict=True):
            column[6 * body : 6 * body + 6] = sense * wrenches
        blocks.append(column[6:])
    return rank_of(np.concatenate(blocks, axis=1), "the equations of equilibrium").value


def test_every_identity_of_the_document_holds():
    rng = np.random.default_rng(1)
    for number in range(60):
        size = 3 + number % 4
        joints = drawn_ring(rng, size)
        if number % 2:  # a second loop, and a third
            joints += [drawn_joint(rng, (0, 2)), drawn_joint(rng, (1, 2))]
        chain = Chain(joints, 1, size - 1)
        n = size - 1
        assert chain.gamma == len(joints) - n
        assert chain.m - chain.h == 6 * n - chain.Ns == chain.Nc - 6 * chain.gamma == chain.i
        assert chain.m == chain.Nc - chain.rc == 6 * n - chain.rs
        assert chain.Nc + chain.Ns == 6 * len(joints)
        assert chain.rs == static_rank(chain)
        assert chain.h >= 0 <= chain.m
        assert chain.m == chain.m_useful + chain.m_internal


def test_invariance_under_motion_unit_and_order():
    rng = np.random.default_rng(2)
    for number in range(40):
        joints = drawn_ring(rng, 3 + number % 3)
        true = numbers(Chain(joints))
        for scale in (1e-6, 1.0, 1e6):
            copy = moved(joints, drawn_rotation(rng), 100 * rng.normal(size=3), scale)
            assert numbers(Chain(copy)) == true
        shuffled = [joints[k] for k in rng.permutation(len(joints))]
        assert numbers(Chain(shuffled)) == true
        turned = [j | {"between": j["between"][::-1]} for j in joints]
        assert numbers(Chain(turned)) == true


def test_equivalents_are_invariant_too():
    rng = np.random.default_rng(4)
    for _ in range(60):
        a, b = drawn_joint(rng), drawn_joint(rng)
        true = in_parallel([a, b])
        for scale in (1e-6, 1e6):
            copy = in_parallel(moved([b, a], drawn_rotation(rng), 100 * rng.normal(size=3), scale))
            assert (copy.Ns, copy.rs, copy.equivalent.name) == (true.Ns, true.rs, true.equivalent.name)
            if true.equivalent.pitch:
                assert copy.equivalent.pitch == pytest.approx(scale * true.equivalent.pitch, rel=1e-9)


def revolutes(points, axes):
    size = len(points)
    return [
        {"between": [k, (k + 1) % size], "joint": "revolute", "point": p, "axis": a}
        for k, (p, a) in enumerate(zip(points, axes, strict=True))
    ]


def test_a_plane_four_bar_has_three_superfluous_constraints():
    chain = Chain(revolutes([(0, 0, 0), (0, 40, 0), (100, 80, 0), (120, 0, 0)], [Z] * 4), 1, 3)
    assert numbers(chain) == (1, 4, 3, 20, 17, 1, 3, -2)
    assert (chain.m_useful, chain.m_internal) == (1, 0)


def test_the_mobility_jumps_where_a_four_bar_is_flat():
    """A parallelogram that lies on its frame: the rank falls by one there, and only there."""
    for angle, m in ((0.0, 2), (1e-3, 1), (0.7, 1), (math.pi, 2)):
        tip = 40 * np.array([math.cos(angle), math.sin(angle), 0])
        points = [np.zeros(3), tip, tip + 100 * AXES[0], np.array([100, 0, 0])]
        chain = Chain(revolutes(points, [Z] * 4))
        assert (chain.m, chain.h) == (m, m + 2)
        assert PlanarChain(revolutes(points, [Z] * 4)).m == m


def test_a_row_of_parallelograms_gains_a_freedom_each_where_it_is_flat():
    """N rods that link N + 1 equal cranks, tip to tip: mobility 1, and N + 1 with all cranks along the
    rods."""
    for count in (1, 2, 4):
        for angle, m in ((0.6, 1), (0.0, count + 1)):
            tip = 30 * np.array([math.cos(angle), math.sin(angle), 0])
            feet = [np.array([50.0 * k, 0, 0]) for k in range(count + 1)]
            ends = [(0, k + 1, foot) for k, foot in enumerate(feet)]  # bodies 1 … N + 1: the cranks
            for k in range(count):
                rod = count + 2 + k
                ends += [(k + 1, rod, feet[k] + tip), (k + 2, rod, feet[k + 1] + tip)]
            joints = [{"between": [i, j], "joint": "revolute", "axis": Z, "point": p} for i, j, p in ends]
            assert Chain(joints).m == PlanarChain(joints).m == m


def bennett(theta, a=60.0, b=100.0, alpha=0.6):
    """A Bennett linkage from its lengths a, b, twists with sin(alpha)/a = sin(beta)/b, by Denavit and
    Hartenberg."""
    beta = math.asin(b * math.sin(alpha) / a)
    ratio = math.sin((beta + alpha) / 2) / math.sin((beta - alpha) / 2)
    phi = 2 * math.atan(ratio / math.tan(theta / 2))
    place, points, axes = np.eye(4), [], []
    for turn, length, twist in ((theta, a, alpha), (phi, b, beta), (-theta, a, alpha), (-phi, b, beta)):
        points.append(place[:3, 3].copy())
        axes.append(place[:3, 2].copy())
        c, s, ca, sa = math.cos(turn), math.sin(turn), math.cos(twist), math.sin(twist)
        place = place @ np.array(
            [[c, -s * ca, s * sa, length * c], [s, c * ca, -c * sa, length * s], [0, sa, ca, 0], [0, 0, 0, 1]]
        )
    return place, points, axes


def test_bennett_moves_though_the_formula_says_it_is_thrice_locked():
    place, points, axes = bennett(1.1)
    np.testing.assert_allclose(place, np.eye(4), atol=1e-12)  # it does close
    chain = Chain(revolutes(points, axes))
    assert (chain.i, chain.rc, chain.m, chain.h) == (-2, 3, 1, 3)
    # With one axis turned by 1e-3 it is a rigid frame.
    axes[0] = axes[0] + 1e-3 * axes[1]
    assert Chain(revolutes(points, axes)).m == 0


def test_bricard_moves_though_the_formula_says_it_does_not():
    """Plane-symmetric and trihedral: a cube's six edges along which neither diagonal runs."""
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (1, 1, 1), (0, 1, 1), (0, 0, 1)]
    axes = [Z, Y, X, Z, Y, X]
    chain = Chain(revolutes(points, axes))
    assert (chain.i, chain.rc, chain.m, chain.h) == (0, 5, 1, 1)


def test_a_rod_on_two_balls_turns_about_itself():
    """Spatial four-bar crank, rod on two spherical joints, rocker: its rod's own turning is internal."""
    joints = [
        {"between": [0, 1], "joint": "revolute", "axis": Z, "point": (0, 0, 0)},
        {"between": [1, 2], "joint": "spherical", "point": (30, 10, 0)},
        {"between": [2, 3], "joint": "spherical", "point": (90, 40, 50)},
        {"between": [3, 0], "joint": "revolute", "axis": X, "point": (90, 0, 0)},
    ]
    chain = Chain(joints, 1, 3)
    assert (chain.m, chain.h, chain.m_internal, chain.m_useful) == (2, 0, 1, 1)


# ------------------------------------------------------------- at every pose


def turned(axis, angle):
    """The matrix of a rotation."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * skew + (1 - math.cos(angle)) * skew @ skew


def posed(rng, joints):
    """The same row of made joints after each was moved, its own slide before its own turn or after it."""
    turn, shift, found = np.eye(3), np.zeros(3), []
    for one in joints:
        frame = [turn @ np.asarray(u) for u in one.frame]
        point = turn @ np.asarray(one.point or O) + shift
        letters = "uvw"
        own = np.eye(3)
        for letter in rng.permutation(list(one.kind.rotations)):
            own = turned(frame[letters.index(letter)], rng.uniform(-math.pi, math.pi)) @ own
        slide = sum(
            (rng.uniform(-60, 60) * frame[letters.index(c)] for c in one.kind.translations), np.zeros(3)
        )
        carried = frame if rng.random() < 0.5 else [own @ u for u in frame]
        slides = [carried[letters.index(c)] for c in one.kind.translations]
        found.append((one, frame, point, slides))
        shift = point + own @ (shift - point) + slide
        turn = own @ turn
    return found


def least_of_six(rows):
    """How near a row at a pose comes to losing one of six freedoms: its least singular value of six, lengths
    in 100 mm."""
    twists = []
    for one, frame, point, slides in rows:
        for letter in one.kind.rotations:
            axis = frame["uvw".index(letter)]
            twists.append([*axis, *(np.cross(point, axis) / 100)])
        twists += [[0, 0, 0, *way] for way in slides]
    return np.linalg.svd(np.array(twists))[1][5] if len(twists) >= 6 else 0.0


def row_of(*kinds):
    return [joint(name, axis, O) for name, axis in kinds]


S = ("spherical", X)
FREE_ROWS = [
    row_of(("prismatic", X), ("prismatic", Y), ("prismatic", Z), S),
    row_of(S, ("prismatic", X), ("prismatic", (0, 3, 4)), ("prismatic", Z)),
    row_of(("planar", Z), ("prismatic", Z), S),
    row_of(("planar", Z), ("prismatic", (0, 2, 1)), S),  # its line turns about z and stays out of the plane
    row_of(("planar", Z), ("revolute", (0, 1, 3)), ("prismatic", (0, 1, 4)), S),
    row_of(("planar", Z), ("revolute", (0, 1, 1)), ("planar", X), S),
    row_of(("prismatic", X), ("revolute", X), ("prismatic", Y), ("prismatic", Z), S),
    row_of(("cylindrical", Z), ("planar", Z), S),
    row_of(("planar", Z), ("revolute", (0, 1, 1)), ("planar", (0, 1, 1)), S),
]
LOSING_ROWS = [
    row_of(*[("prismatic", a) for a in (X, Y, Z)], *[("revolute", a) for a in (X, Y, Z)]),
    row_of(("prismatic", X), ("revolute", Z), ("prismatic", Y), ("prismatic", Z), S),
    row_of(("prismatic", X), S, ("prismatic", Y), ("prismatic", Z)),
    row_of(("planar", Z), ("revolute", (0, 2, 1)), ("prismatic", (0, 1, 2)), S),
    row_of(
        ("planar", Z), ("revolute", (0, 1, 1)), ("planar", Y), S
    ),  # half a turn lays one plane on the other
]


@pytest.mark.parametrize("poses", [120, pytest.param(500, marks=slow)])
@each_row("joints", FREE_ROWS)
def test_six_freedoms_at_every_pose_are_no_joint(joints, poses):
    assert in_series(joints).equivalent.name == "free"
    rng, made = np.random.default_rng(1), [*map(joint_of, joints)]
    assert min(least_of_six(posed(rng, made)) for _ in range(poses)) > 0.01


@each_row("joints", LOSING_ROWS)
def test_six_freedoms_at_one_pose_alone_are_no_joint_of_the_table(joints):
    found = in_series(joints)
    assert (found.m_useful, found.equivalent.name) == (6, "other")
    rng, made, poses = np.random.default_rng(1), [*map(joint_of, joints)], []
    while len(poses) < 1500 and not (poses and min(poses) < 0.04 * np.median(poses)):
        poses += [least_of_six(posed(rng, made)) for _ in range(100)]
    assert min(poses) < 0.04 * np.median(poses)


def test_two_balls_leave_five_and_three_six_that_are_lost_in_line():
    balls = [joint("spherical", X, p) for p in (O, (40, 0, 0), (40, 30, 0))]
    assert in_series(balls[:2]).equivalent.name == "point_contact"
    assert (in_series(balls).m_useful, in_series(balls).equivalent.name) == (6, "other")
    assert in_series([{"joint": "free"}]).equivalent.name == "free"


# ------------------------------------------------------------------- decisions


def test_axes_off_by_rounding_are_parallel_and_slightly_apart_are_not():
    def tilted(angle):
        axes = [(0.0, 0.0, 1.0)] * 3 + [(math.sin(angle), 0.0, math.cos(angle))]
        return Chain(revolutes([(0, 0, 0), (0, 40, 0), (100, 80, 0), (120, 0, 0)], axes))

    for angle in (0.0, 1e-16, 1e-14, 9e-14):
        assert tilted(angle).m == 1
    for angle in (1e-4, 1e-3, 0.1):
        assert tilted(angle).m == 0
    with pytest.raises(CannotTell, match="singular value"):
        tilted(1e-9).m  # noqa: B018
    assert issubclass(CannotTell, ValueError)


def test_two_coaxial_hinges_off_by_little():
    def two(angle):
        return in_parallel(
            [joint("revolute", X, O), joint("revolute", (math.cos(angle), math.sin(angle), 0), O)]
        )

    assert two(9e-14).equivalent.name == "revolute"
    assert two(1e-4).equivalent.name == "rigid"
    with pytest.raises(CannotTell):
        two(1e-9).m  # noqa: B018


def test_the_gap_of_a_decision_is_reported():
    rank = Chain(revolutes([(0, 0, 0), (0, 40, 0), (100, 80, 0), (120, 0, 0)], [Z] * 4)).rank
    assert rank.value == 3
    assert rank.smallest_kept > 0.01
    assert rank.gap > 1e12


# ---------------------------------------------------------------------- planar


@each_row(
    ("name", "axis", "normal", "kind"),
    [
        ("revolute", Z, X, "revolute"),
        ("cylindrical", Z, X, "revolute"),
        ("annular", Z, X, "revolute"),
        ("spherical", X, X, "revolute"),
        ("prismatic", X, X, "prismatic"),
        ("cylindrical", Y, X, "prismatic"),
        ("planar", X, X, "prismatic"),
        ("line_contact", X, Y, "prismatic"),
        ("line_contact", Y, X, "prismatic"),
        ("annular", X, X, "point_contact"),
        ("line_contact", Z, X, "point_contact"),
        ("point_contact", X, Y, "point_contact"),
        ("revolute", X, X, "rigid"),
        ("prismatic", Z, X, "rigid"),
        ("planar", X, Z, "free"),
        ("line_contact", X, Z, "free"),
        ("point_contact", X, Z, "free"),
    ],
)
def test_what_a_joint_is_in_the_plane(name, axis, normal, kind):
    for point in (O, (20, -40, 0)):
        assert planar_kind(joint_of(joint(name, axis, point, normal))) == kind


def test_identities_in_the_plane():
    rng = np.random.default_rng(5)
    for number in range(60):
        size = 3 + number % 4
        joints = drawn_ring(rng, size) + ([drawn_joint(rng, (0, 2))] if number % 2 else [])
        joints = [j for j in joints if j["joint"] != "helical"] or joints
        try:
            chain = PlanarChain(joints)
        except WrongValue:
            continue  # taking joints out cut the chain
        assert chain.m - chain.h == 3 * chain.n - chain.Ns == chain.Nc - 3 * chain.gamma == chain.i
        assert chain.h >= 0 <= chain.m


def test_a_slider_crank_in_the_plane_and_in_space():
    points = [(0, 0, 0), (20, 30, 0), (90, 0, 0)]
    joints = [
        {"between": [k, k + 1], "joint": "revolute", "axis": Z, "point": p} for k, p in enumerate(points)
    ]
    joints.append({"between": [3, 0], "joint": "prismatic", "axis": X})
    assert numbers(PlanarChain(joints)) == (1, 4, 3, 8, 8, 1, 0, 1)
    assert numbers(Chain(joints)) == (1, 4, 3, 20, 17, 1, 3, -2)


def test_an_inclined_axis_is_no_plane_problem():
    with pytest.raises(WrongValue, match="in the plane xy or along z"):
        planar_kind(joint_of(joint("revolute", (0, 1, 1), O)))


# --------------------------------------------------------------------- refusals


@each_row(
    ("given", "error", "match"),
    [
        ({"joint": "pivot"}, UnknownName, "no joint 'pivot'"),
        ({"joint": "revolute", "axis": X}, WrongValue, "'point' is missing"),
        ({"joint": "prismatic", "axis": (0, 0, 0)}, WrongValue, "direction"),
        ({"joint": "prismatic", "axis": (0, 1)}, WrongValue, "three numbers"),
        ({"joint": "prismatic", "axis": (0, 1, math.nan)}, WrongValue, "finite"),
        ({"joint": "line_contact", "axis": X, "normal": (1, 1, 0), "point": O}, WrongValue, "perpendicular"),
        ({"axis": X}, WrongValue, "'joint'"),
        ("revolute", WrongValue, "mapping"),
    ],
)
def test_refused_joints(given, error, match):
    with pytest.raises(error, match=match):
        in_parallel([given])


def test_refused_chains():
    with pytest.raises(WrongValue, match="at least one"):
        in_series([])
    with pytest.raises(WrongValue, match="not linked"):
        Chain([joint("revolute", between=[0, 1]), joint("revolute", between=[2, 3])])
    with pytest.raises(WrongValue, match="two different bodies"):
        Chain([joint("revolute", between=[1, 1])])
    with pytest.raises(WrongValue, match="input body"):
        Chain([joint("revolute", between=[0, 1])], 4, 1)
