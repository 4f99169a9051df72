"""Twists and wrenches of joints: moments and velocities follow from one point to another, then components add
up."""

import numpy as np

from coursework.errors import WrongValue
from coursework.quantities.columns import each, vector
from coursework.solution import given, mistake
from coursework.structure.spatial_chains import (
    aligned,
    each_distinct,
    joints_of,
    moved,
    twist_components,
    wrench_components,
)
from coursework.structure.spatial_chains.torsors import TWIST, WRENCH

from ._solids import _in_parallel

STRUCTURES = ("joints",)

_ORIGIN = (0.0, 0.0, 0.0)


def _pair(joint_1, direction_1, joint_2, direction_2, x2, y2, z2):
    return aligned(joint_1, direction_1), aligned(joint_2, direction_2, (x2, y2, z2))


def joints(joint_1, direction_1, joint_2, direction_2, x2, y2, z2):
    """The first at A1, the origin; the second at A2."""
    return each_distinct(_pair, joint_1, direction_1, joint_2, direction_2, x2, y2, z2)


def _known(joints):
    return each(joints_of, joints)


def twist_1(_known):
    """At its own point."""
    return each(lambda pair: twist_components(pair[0], pair[0].point or _ORIGIN), _known, dtype=str)


def twist_1_at_2(joints, _known):
    """The velocities of its rotations are added."""
    return each(lambda two, pair: twist_components(pair[0], _second(two)), joints, _known, dtype=str)


def wrench_1_at_2(joints, _known):
    """The moments of its forces are added."""
    return each(lambda two, pair: wrench_components(pair[0], _second(two)), joints, _known, dtype=str)


def _second(joints):
    """A2, whether or not the point counts for the joint there."""
    if len(joints) < 2 or "point" not in joints[1]:
        raise WrongValue(
            "A2 is the 'point' of the second joint of the list, which a joint without a point of its "
            "own has too; "
            f"found {len(joints)} joints"
        )
    x, y, z = joints[1]["point"]
    return float(x), float(y), float(z)


def wrench_both(_known):
    """One joint that can transmit a component is enough."""
    return each(lambda pair: wrench_components(_in_parallel(pair), _ORIGIN), _known, dtype=str)


def twist_both(_known):
    """The motions that both joints leave free."""
    return each(lambda pair: twist_components(_in_parallel(pair), _ORIGIN), _known, dtype=str)


def _unit(text):
    whole = np.array([int(x) for x in text.split()], dtype=float)
    return whole / np.linalg.norm(whole)


def _e(axis):
    """The direction of the cylindrical joint."""
    if not isinstance(axis, np.ndarray):
        return _unit(axis)
    return np.array([_unit(str(text)) for text in axis.ravel()]).reshape(*axis.shape, 3)


def _f(hinge):
    """The direction of the hinge."""
    return np.stack([np.asarray(hinge) == letter for letter in "xyz"], axis=-1) * 1.0


def _torsor(resultant, moment):
    return np.concatenate(np.broadcast_arrays(resultant, moment), axis=-1)


def V_10(omega1, v1, _e, x2, y2, z2):
    """Velocity at A1 along the axis, and what the rotation adds at A2."""
    turn = np.asarray(omega1)[..., None] * _e
    slide = np.asarray(v1)[..., None] * _e
    return _torsor(turn, moved(turn, slide, -vector(x2, y2, z2)))


def V_20(omega1, v1, _e, omega2, _f, x2, y2, z2):
    """Both twists at A1: that of the hinge is carried there from A2."""
    turn = np.asarray(omega1)[..., None] * _e
    slide = np.asarray(v1)[..., None] * _e
    second = np.asarray(omega2)[..., None] * _f
    return _torsor(turn + second, moved(second, slide, vector(x2, y2, z2)))


def V_plane(omega2, x2, y2):
    return vector(-omega2 * y2, omega2 * x2, omega2)


def W(X1, Y1, Z1, X2, Y2, Z2, x2, y2, z2):
    """Both forces, and the moment at A1 of that at A2."""
    first, second = vector(X1, Y1, Z1), vector(X2, Y2, Z2)
    return _torsor(first + second, moved(second, 0.0 * first, vector(x2, y2, z2)))


@mistake("twist_1_at_2")
def the_same_at_every_point(twist_1):
    return twist_1


@mistake("wrench_1_at_2")
def what_is_not_free(twist_1_at_2):
    """The components that the twist lacks at this point; that is right at the joint's own point alone."""
    return each(lambda names: _lacking(str(names)), twist_1_at_2, dtype=str)


def _lacking(names):
    partners = dict(zip((*TWIST[3:], *TWIST[:3]), WRENCH, strict=True))
    return " ".join(partners[name] for name in partners if name not in names.split()) or "0"


@mistake("twist_both")
def twists_added(_known):
    def one(pair):
        found = {name for joint in pair for name in twist_components(joint, _ORIGIN).split()}
        return " ".join(name for name in TWIST if name in found) or "0"

    return each(one, _known, dtype=str)


@mistake("wrench_both")
def common_actions_alone(_known):
    def one(pair):
        first, second = (wrench_components(joint, _ORIGIN).split() for joint in pair)
        return " ".join(name for name in first if name in second) or "0"

    return each(one, _known, dtype=str)


@mistake("V_10", kind="other_point")
def velocity_of_A1(omega1, v1, _e):
    return _torsor(np.asarray(omega1)[..., None] * _e, np.asarray(v1)[..., None] * _e)


@mistake("V_10", kind="moment_sign")
def product_reversed(omega1, v1, _e, x2, y2, z2):
    turn = np.asarray(omega1)[..., None] * _e
    slide = np.asarray(v1)[..., None] * _e
    return _torsor(turn, moved(turn, slide, vector(x2, y2, z2)))


@mistake("V_20", kind="other_point")
def hinge_left_at_A2(omega1, v1, _e, omega2, _f):
    turn = np.asarray(omega1)[..., None] * _e + np.asarray(omega2)[..., None] * _f
    return _torsor(turn, np.asarray(v1)[..., None] * _e)


@mistake("V_20", kind="moment_sign")
def hinge_moved_the_wrong_way(omega1, v1, _e, omega2, _f, x2, y2, z2):
    turn = np.asarray(omega1)[..., None] * _e
    slide = np.asarray(v1)[..., None] * _e
    second = np.asarray(omega2)[..., None] * _f
    return _torsor(turn + second, moved(second, slide, -vector(x2, y2, z2)))


@mistake("V_20")
def hinge_alone(omega2, _f, x2, y2, z2):
    second = np.asarray(omega2)[..., None] * _f
    return _torsor(second, moved(second, 0.0 * second, vector(x2, y2, z2)))


@mistake("W", kind="other_point")
def forces_added_alone(X1, Y1, Z1, X2, Y2, Z2):
    first, second = vector(X1, Y1, Z1), vector(X2, Y2, Z2)
    return _torsor(first + second, 0.0 * first)


def residual(
    joints, omega1, v1, axis, hinge, omega2, x2, y2, z2, V_10, V_20, V_plane, X1, Y1, Z1, X2, Y2, Z2, W
):
    """Velocities of points by the field of a rigid body: at the ends of the axes what they must be; work by
    forces' points."""
    e, arm = _unit(axis), np.array([x2, y2, z2], dtype=float)
    f = np.array([float(letter == hinge) for letter in "xyz"])
    w, v = V_10[:3], V_10[3:]
    # The points of the axis slide along it; the skew matrix of the rotation, not a cross product.
    skew = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
    at_origin = v + skew @ (0 - arm)
    second = V_20 - np.concatenate([w, at_origin])
    spin = second[:3]
    turning = np.array([[0, -spin[2], spin[1]], [spin[2], 0, -spin[0]], [-spin[1], spin[0], 0]])
    at_hinge = second[3:] + turning @ arm
    # By a unit rotation about each axis through A1.
    work = [np.dot([X2, Y2, Z2], np.cross(np.eye(3)[k], arm)) - W[3 + k] for k in range(3)]
    size = 20 * 200.0
    return (
        *((at_origin - v1 * e) / size),
        *(w / omega1 - e),
        *(at_hinge / size),
        *(spin - omega2 * f),
        *(np.array(work) / size),
        *(W[:3] - np.array([X1 + X2, Y1 + Y2, Z1 + Z2])),
        (V_plane[0] * x2 + V_plane[1] * y2) / size,
        V_plane[2] - omega2,
    )


_DATA = {"axis": "0 3 4", "omega1": 10, "v1": 50, "hinge": "z", "omega2": -2, "x2": 20, "y2": 0, "z2": 40}
_FORCES = {"X1": 10, "Y1": 0, "Z1": -20, "X2": 0, "Y2": 30, "Z2": 0}

KNOWN = (
    # A hinge about z at its own point, then seen from a point off its axis along x.
    given(
        joints=[
            {"joint": "revolute", "axis": (0, 0, 1), "point": (0, 0, 0)},
            {"joint": "revolute", "axis": (0, 0, 1), "point": (40, 0, 0)},
        ]
    ).gives(
        twist_1="wz",
        twist_1_at_2="wz vy",
        wrench_1_at_2="X Y Z L M N",
        wrench_both="X Y Z L M N",
        twist_both="0",
    ),
    # A plate on a plane of normal z and a ball: a hinge about z through the ball.
    given(
        joints=[
            {"joint": "planar", "normal": (0, 0, 1), "point": (0, 0, 0)},
            {"joint": "spherical", "point": (0, 20, 0)},
        ]
    ).gives(
        twist_1="wz vx vy",
        twist_1_at_2="wz vx vy",
        wrench_1_at_2="Z L M",
        wrench_both="X Y Z L M N",
        twist_both="wz vx",
    ),
    # Ball in a groove along x: free at its point but for the forces across; elsewhere these have moments.
    given(
        joints=[
            {"joint": "annular", "axis": (1, 0, 0), "point": (0, 0, 0)},
            {"joint": "annular", "axis": (1, 0, 0), "point": (20, 0, 0)},
        ]
    ).gives(
        twist_1="wx wy wz vx",
        twist_1_at_2="wx wy wz vx vy vz",
        wrench_1_at_2="Y Z M N",
        wrench_both="Y Z M N",
        twist_both="wx vx",
    ),
    # By hand: Omega = (0, 6, 8), V(A1) = (0, 30, 40), A1A2 = (20, 0, 40).
    given(**_DATA).gives(
        V_10=np.array([0, 6, 8, 240, 190, -80]),
        V_20=np.array([0, 6, 6, 0, 70, 40]),
        V_plane=np.array([0, -40, -2]),
    ),
    # M(A1) = A1A2 x (0, 30, 0).
    given(**_DATA, **_FORCES).gives(W=np.array([10, 30, -20, -1200, 0, 600])),
)
