"""A closed chain of four joints: the conditions on answers that a variant must satisfy."""

import numpy as np

from ...exercises.chains._solids import freedoms_of
from ._mobility_keep import evenly, mobility_of_loop

__all__ = ["HELPERS", "KEEP"]


def mobility(
    joint_1, direction_1, joint_2, direction_2, joint_3, direction_3, joint_4, direction_4,
    x2, y2, z2, x3, y3, z3, x4, y4, z4,
):  # fmt: skip
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


#: Share of the draws of each rank that are let through: of 6 most are drawn, and who writes 6 everywhere would be right in most.
LET_THROUGH = {6: 0.2, 5: 0.5, 4: 0.8}


def ranks_are_mixed(
    joint_1, direction_1, joint_2, direction_2, joint_3, direction_3, joint_4, direction_4,
    x2, y2, z2, x3, y3, z3, x4, y4, z4, mobility,
):  # fmt: skip
    joints = (joint_1, joint_2, joint_3, joint_4)
    rank = sum(freedoms_of(joint) for joint in joints) - mobility
    share = np.select([rank == n for n in LET_THROUGH], list(LET_THROUGH.values()), 1.0)
    directions = (direction_1, direction_2, direction_3, direction_4)
    return evenly(*joints, *directions, x2, y2, z2, x3, y3, z3, x4, y4, z4) < share


HELPERS = (mobility,)
KEEP = (moves, mobility_is_small, ranks_are_mixed)
