"""Two joints in a row: kinematic unknowns, useful and internal mobility, and the joint that replaces the row."""

from coursework.figures.perspective import in_perspective
from coursework.model import Exercise, Part
from coursework.solids import EQUIVALENTS

from ._solids import WITH_DIRECTION, WITH_LINE, axis_parts, combined, table, two_joints


def _name(joint_1, direction_1, joint_2, direction_2, x2, y2, z2):
    second = (joint_2, direction_2, x2 != 0, y2 != 0, z2 != 0)
    return combined("series", (joint_1, direction_1, 0, 0, 0), second).equivalent.name


def has_direction(joint_1, direction_1, joint_2, direction_2, x2, y2, z2):
    return _name(joint_1, direction_1, joint_2, direction_2, x2, y2, z2) in WITH_DIRECTION


def has_line(joint_1, direction_1, joint_2, direction_2, x2, y2, z2):
    return _name(joint_1, direction_1, joint_2, direction_2, x2, y2, z2) in WITH_LINE


def tells(joint_1, direction_1, joint_2, direction_2, x2, y2, z2):
    return {
        "rows": table(
            ((0, 1), joint_1, direction_1, (0, 0, 0)),
            ((1, 2), joint_2, direction_2, (x2, y2, z2)),
        )
    }


def figure(joint_1, direction_1, joint_2, direction_2, x2, y2, z2):
    rows = tells(joint_1, direction_1, joint_2, direction_2, x2, y2, z2)["rows"]
    return in_perspective(rows, bodies=((1, 1, 2),))


EXERCISE = Exercise(
    given=two_joints(),
    parts=(
        Part("Nc", kind="integer", points=1),
        Part("m", kind="integer", points=1),
        Part("m_useful", kind="integer", points=2),
        Part("m_internal", kind="integer", points=1),
        Part("h", kind="integer", points=1),
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
        "Nc": "N_c",
        "m_useful": "m_u",
        "m_internal": "m_i",
        "axis_dir": r"\vec{e}",
        "axis_point": "P",
    },
)
