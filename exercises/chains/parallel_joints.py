"""Two joints between the same two bodies: static unknowns, mobility, and the joint that replaces both."""

import numpy as np

from coursework.figures.perspective import in_perspective
from coursework.model import Exercise, Part
from coursework.solids import EQUIVALENTS, each_distinct

from ._solids import WITH_DIRECTION, WITH_LINE, axis_parts, combined, table, two_joints


def _of_signs(joint_1, direction_1, joint_2, direction_2, x, y, z):
    return combined("parallel", (joint_1, direction_1, 0, 0, 0), (joint_2, direction_2, x, y, z))


def _rank(*row):
    return _of_signs(*row).rank.value


def _name(*row):
    return _of_signs(*row).equivalent.name


def moves(joint_1, direction_1, joint_2, direction_2, x2, y2, z2):
    """Fewer than six independent components."""
    pattern = [np.not_equal(c, 0) for c in (x2, y2, z2)]
    return each_distinct(_rank, joint_1, direction_1, joint_2, direction_2, *pattern) < 6


def has_direction(joint_1, direction_1, joint_2, direction_2, x2, y2, z2):
    return _name(joint_1, direction_1, joint_2, direction_2, x2 != 0, y2 != 0, z2 != 0) in WITH_DIRECTION


def has_line(joint_1, direction_1, joint_2, direction_2, x2, y2, z2):
    return _name(joint_1, direction_1, joint_2, direction_2, x2 != 0, y2 != 0, z2 != 0) in WITH_LINE


def tells(joint_1, direction_1, joint_2, direction_2, x2, y2, z2):
    return {
        "rows": table(
            ((1, 2), joint_1, direction_1, (0, 0, 0)),
            ((1, 2), joint_2, direction_2, (x2, y2, z2)),
        )
    }


def figure(joint_1, direction_1, joint_2, direction_2, x2, y2, z2):
    rows = tells(joint_1, direction_1, joint_2, direction_2, x2, y2, z2)["rows"]
    return in_perspective(rows)


EXERCISE = Exercise(
    given=two_joints(),
    keep=(moves,),
    parts=(
        Part("Ns", kind="integer", points=1),
        Part("rs", kind="integer", points=2),
        Part("h", kind="integer", points=1),
        Part("m", kind="integer", points=1),
        Part("equivalent", kind="choice", choices=EQUIVALENTS, ordered=True, points=2),
        *axis_parts(has_direction, has_line),
    ),
    tells=tells,
    figure=figure,
    symbols={
        "joint_1": "L_1",
        "joint_2": "L_2",
        "direction_1": r"\vec{u}_1",
        "direction_2": r"\vec{u}_2",
        "Ns": "N_s",
        "rs": "r_s",
        "axis_dir": r"\vec{u}",
        "axis_point": "P",
    },
)
