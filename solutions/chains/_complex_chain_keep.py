"""A mechanism of several loops: the conditions on answers that a variant must satisfy."""

import numpy as np

from ...exercises.chains._complex import DIRECTIONS, LAYOUTS, points_of
from ._mobility_keep import mobility_of_loops

__all__ = ["HELPERS", "KEEP"]


def mobility(
    layout, joint_1, joint_2, joint_3, joint_4, joint_5, joint_6, joint_7, joint_8,
    xA, yA, xB, yB, xC, xD, yD, xE, yE,
):  # fmt: skip
    """Of the whole chain, at the given position."""
    joints = (joint_1, joint_2, joint_3, joint_4, joint_5, joint_6, joint_7, joint_8)
    points = points_of(xA, yA, xB, yB, xC, xD, yD, xE, yE)
    layout = np.atleast_1d(layout)
    found = np.zeros(layout.shape, dtype=int)
    for name, kind in LAYOUTS.items():
        rows = layout == name
        count = len(kind.between)
        found[rows] = mobility_of_loops(
            kind.senses,
            [np.atleast_1d(joint)[rows] for joint in joints[:count]],
            DIRECTIONS[:count],
            [[np.broadcast_to(c, layout.shape)[rows] for c in point] for point in points[:count]],
        )
    return found


def mobility_is_small(mobility):
    return mobility <= 3


HELPERS = (mobility,)
KEEP = (mobility_is_small,)
