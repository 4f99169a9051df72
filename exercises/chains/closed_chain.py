"""A closed chain of four joints: loops, ranks, mobility and static indeterminacy."""

import numpy as np

from coursework.figures.perspective import in_perspective
from coursework.model import Exercise, Part

from ._solids import (
    IN_CHAINS,
    coordinate,
    direction,
    evenly,
    freedoms_of,
    joint_kind,
    mobility_of_loop,
    table,
)


def tells(
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
    return {
        "rows": table(
            ((0, 1), joint_1, direction_1, (0, 0, 0)),
            ((1, 2), joint_2, direction_2, (x2, y2, z2)),
            ((2, 3), joint_3, direction_3, (x3, y3, z3)),
            ((3, 0), joint_4, direction_4, (x4, y4, z4)),
        )
    }


def figure(
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
    rows = tells(
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
    )["rows"]
    return in_perspective(rows, bodies=((1, 1, 2), (2, 2, 3), (3, 3, 4), (0, 4, 1)), tall=26)


def no_body_passes_through_another_joint(x2, y2, z2, x3, y3, z3, x4, y4, z4):
    """A line between two neighbours would hide the joint that it passes through."""
    zero = 0 * x2
    points = [np.stack(p, axis=-1) for p in ((zero, zero, zero), (x2, y2, z2), (x3, y3, z3), (x4, y4, z4))]
    hidden = np.zeros(np.shape(x2), dtype=bool)
    for k in range(4):
        p, q = points[k], points[(k + 1) % 4]
        for other in (points[(k + 2) % 4], points[(k + 3) % 4]):
            a, b = other - p, other - q
            hidden |= np.all(np.cross(a, b) == 0, axis=-1) & (np.sum(a * b, axis=-1) < 0)
    return ~hidden


def mobility(
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
    """Of the whole chain, at the given position."""
    return mobility_of_loop(
        (joint_1, joint_2, joint_3, joint_4),
        (direction_1, direction_2, direction_3, direction_4),
        ((0, 0, 0), (x2, y2, z2), (x3, y3, z3), (x4, y4, z4)),
    )


def moves(mobility):
    return mobility >= 1


def mobility_is_small(mobility):
    return mobility <= 3


#: Share of the draws of each rank that are let through: of 6 most are drawn, and who writes 6 everywhere
#: would be right in most.
LET_THROUGH = {6: 0.2, 5: 0.5, 4: 0.8}


def ranks_are_mixed(
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
    mobility,
):
    joints = (joint_1, joint_2, joint_3, joint_4)
    rank = sum(freedoms_of(joint) for joint in joints) - mobility
    share = np.select([rank == n for n in LET_THROUGH], list(LET_THROUGH.values()), 1.0)
    directions = (direction_1, direction_2, direction_3, direction_4)
    return evenly(*joints, *directions, x2, y2, z2, x3, y3, z3, x4, y4, z4) < share


EXERCISE = Exercise(
    given={
        "joint_1": joint_kind(IN_CHAINS),
        "direction_1": direction(),
        "joint_2": joint_kind(IN_CHAINS),
        "direction_2": direction(),
        "joint_3": joint_kind(IN_CHAINS),
        "direction_3": direction(),
        "joint_4": joint_kind(IN_CHAINS),
        "direction_4": direction(),
        **{f"{axis}{k}": coordinate() for k in (2, 3, 4) for axis in "xyz"},
    },
    helpers=(mobility,),
    constraints=(
        no_body_passes_through_another_joint,
        moves,
        mobility_is_small,
        ranks_are_mixed,
    ),
    parts=(
        Part("gamma", kind="integer", points=1, by_request=True),  # one loop, always
        Part("Nc", kind="integer", points=1),
        Part("rc", kind="integer", points=5),
        Part("m", kind="integer", points=0.5),
        Part("Ns", kind="integer", points=0.5),
        Part("rs", kind="integer", points=0.5),
        Part("h", kind="integer", points=1),
        Part("i", kind="integer", points=0.5),
        Part("m_internal", kind="integer", points=1),
        Part("m_useful", kind="integer", points=1),
        Part("statics", kind="choice", choices=("isostatic", "hyperstatic"), points=1),
    ),
    tells=tells,
    version=2,
    figure=figure,
    symbols={
        **{f"joint_{k}": f"L_{k}" for k in (1, 2, 3, 4)},
        **{f"direction_{k}": rf"\vec{{u}}_{k}" for k in (1, 2, 3, 4)},
        "Nc": "N_c",
        "rc": "r_c",
        "Ns": "N_s",
        "rs": "r_s",
        "m_internal": "m_i",
        "m_useful": "m_u",
    },
)
