"""A closed chain taken as plane: the conditions on answers that a variant must satisfy."""

from ._mobility_keep import mobility_of_loops

__all__ = ["HELPERS", "KEEP"]


def mobility(
    joint_1, direction_1, joint_2, direction_2, joint_3, direction_3, joint_4, direction_4,
    x2, y2, x3, y3, x4, y4,
):  # fmt: skip
    """In the plane, at the given position."""
    return mobility_of_loops(
        [[1]] * 4,
        (joint_1, joint_2, joint_3, joint_4),
        (direction_1, direction_2, direction_3, direction_4),
        ((0, 0, 0), (x2, y2, 0), (x3, y3, 0), (x4, y4, 0)),
        in_plane=True,
    )


def moves(mobility):
    return mobility >= 1


def mobility_is_small(mobility):
    return mobility <= 3


HELPERS = (mobility,)
KEEP = (moves, mobility_is_small)
