"""Two to four joints between the same two bodies: static unknowns, mobility, and the joint that replaces
them."""

from coursework.figures.perspective import in_perspective
from coursework.model import Exercise, Part
from coursework.structure.spatial_chains import CONDITIONS, EQUIVALENTS, arranged

from ._solids import (
    WITH_DIRECTION,
    WITH_LINE,
    axis_parts,
    combined,
    of_joints,
    rank_together,
    several_joints,
    table_of,
)

#: The third and the fourth joint: with stiffer ones hardly anything would move.
SOFT = ("planar", "annular", "line_contact", "point_contact")


@of_joints
def moves(arrangement, tilt, inclined, *joints):
    """Fewer than six independent components."""
    return rank_together("parallel", arrangement, inclined, *joints) < 6


def _name(arrangement, tilt, inclined, *joints):
    return combined("parallel", *arranged(arrangement, "x", inclined, *joints)).equivalent.name


@of_joints
def has_direction(*given):
    return _name(*given) in WITH_DIRECTION


@of_joints
def has_line(*given):
    return _name(*given) in WITH_LINE


@of_joints
def tells(*given):
    joints = arranged(*given)
    return {"rows": table_of(joints, [(1, 2)] * len(joints))}


@of_joints
def figure(*given):
    joints = arranged(*given)
    return in_perspective(table_of(joints, [(1, 2)] * len(joints)))


EXERCISE = Exercise(
    given=several_joints(SOFT),
    constraints=(moves,),
    parts=(
        Part("Ns", kind="integer", points=1),
        Part("rs", kind="integer", points=2),
        Part("m", kind="integer", points=1),
        Part("h", kind="integer", points=1),
        Part("equivalent", kind="choice", choices=EQUIVALENTS, ordered=True, points=2),
        *axis_parts(has_direction, has_line),
        Part("condition", kind="choice", choices=CONDITIONS, ordered=True, points=2),
    ),
    version=3,
    tells=tells,
    figure=figure,
    symbols={
        "Ns": "N_s",
        "rs": "r_s",
        "axis_dir": r"\vec{u}",
        "axis_point": "P",
        "turns": "n_r",
        "slides": "n_t",
    },
)
