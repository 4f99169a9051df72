"""A closed chain of four joints: the conditions on answers that a variant must satisfy."""

from ._mobility_keep import mobility_of_loop

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


HELPERS = (mobility,)
KEEP = (moves, mobility_is_small)
