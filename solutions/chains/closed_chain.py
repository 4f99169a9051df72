"""Closed chain: the rank of the loop equations at the given position, and what follows by counting."""

from functools import lru_cache

import numpy as np

from coursework.quantities.columns import each, each_stacked
from coursework.solution import given
from coursework.structure.spatial_chains import aligned, each_distinct

from ._chains import *
from ._solids import _sum_of

SYMBOLS = {"input_body": "b_e", "output_body": "b_s"}


def _ring(
    joint_1,
    direction_1,
    joint_2,
    direction_2,
    joint_3,
    direction_3,
    joint_4,
    direction_4,
    x2,
    y2,
    z2,
    x3,
    y3,
    z3,
    x4,
    y4,
    z4,
):
    return (
        aligned(joint_1, direction_1, between=(0, 1)),
        aligned(joint_2, direction_2, (x2, y2, z2), (1, 2)),
        aligned(joint_3, direction_3, (x3, y3, z3), (2, 3)),
        aligned(joint_4, direction_4, (x4, y4, z4), (3, 0)),
    )


def joints(
    joint_1,
    direction_1,
    joint_2,
    direction_2,
    joint_3,
    direction_3,
    joint_4,
    direction_4,
    x2,
    y2,
    z2,
    x3,
    y3,
    z3,
    x4,
    y4,
    z4,
):
    """The four joints in order around the loop."""
    return each_distinct(
        _ring,
        joint_1,
        direction_1,
        joint_2,
        direction_2,
        joint_3,
        direction_3,
        joint_4,
        direction_4,
        x2,
        y2,
        z2,
        x3,
        y3,
        z3,
        x4,
        y4,
        z4,
    )


def motions(_solids):
    """Of each joint: its free twists at the origin, as they are printed; how many the ones of the joints
    before it do not give, counted all around the loop, and between the bodies of the input and of the
    output."""
    return each(_twists, _solids)


@lru_cache(maxsize=4096)
def _twists(chain):
    found, met, between, total, total_inside = [], [], [], 0, 0
    for joint in chain.joints:
        twists = joint.twists((0.0, 0.0, 0.0), 1.0)
        met += twists
        more = _rank(met) - total
        total += more
        inside = 0 not in joint.between
        between += twists if inside else []
        more_inside = _rank(between) - total_inside if inside else 0
        total_inside += more_inside
        found.append(
            {
                "twists": [_printed(twist) for twist in twists],
                "count": len(twists),
                "more": more,
                "inside": inside,
                "more_inside": more_inside,
            }
        )
    return tuple(found)


def _rank(twists):
    """Velocities are in mm where lengths are some tens of them."""
    return int(np.linalg.matrix_rank(np.array(twists) / [1, 1, 1, 20, 20, 20])) if twists else 0


def _printed(twist):
    """Rotation and velocity of a twist, LaTeX; a translation either way is one freedom."""
    rotation, velocity = twist[:3], twist[3:]
    if not any(rotation) and sum(velocity) < 0:
        velocity = [-component for component in velocity]
    return rf"\left({_vector(rotation)};\ {_vector(velocity)}\right)"


def _vector(components):
    return _sum_of(zip(components, (r"\vec x", r"\vec y", r"\vec z"), strict=True)) or r"\vec 0"


def input_body():
    return 1


def output_body(_solids):
    """The last one."""
    return each_stacked(lambda one: one.n, _solids)


_X, _Y, _Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)


def _revolutes(points, axes):
    size = len(points)
    return [
        {"between": [k, (k + 1) % size], "joint": "revolute", "axis": axes[k], "point": points[k]}
        for k in range(size)
    ]


KNOWN = (
    # A plane four-bar as a mechanism of space: the closure has rank 3.
    given(joints=_revolutes([(0, 0, 0), (0, 40, 0), (100, 80, 0), (120, 0, 0)], [_Z] * 4)).gives(
        gamma=1,
        Nc=4,
        rc=3,
        m=1,
        Ns=20,
        rs=17,
        h=3,
        i=-2,
        m_internal=0,
        m_useful=1,
    ),
    # Bricard's six hinges along edges of a cube: the count says that nothing moves, and it does.
    given(
        joints=_revolutes(
            [(0, 0, 0), (1, 0, 0), (1, 1, 0), (1, 1, 1), (0, 1, 1), (0, 0, 1)], [_Z, _Y, _X, _Z, _Y, _X]
        ),
    ).gives(gamma=1, Nc=6, rc=5, m=1, Ns=30, h=1, i=0, statics="hyperstatic"),
    # Crank, rod on two balls, rocker: the rod turns about itself.
    given(
        joints=[
            {"between": [0, 1], "joint": "revolute", "axis": _Z, "point": (0, 0, 0)},
            {"between": [1, 2], "joint": "spherical", "point": (30, 10, 0)},
            {"between": [2, 3], "joint": "spherical", "point": (90, 40, 50)},
            {"between": [3, 0], "joint": "revolute", "axis": _X, "point": (90, 0, 0)},
        ],
    ).gives(Nc=8, rc=6, m=2, h=0, i=2, m_internal=1, m_useful=1, statics="isostatic"),
)
