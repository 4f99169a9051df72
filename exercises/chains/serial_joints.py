"""Two to four joints in a row: kinematic unknowns, useful and internal mobility, and the joint that replaces
the row."""

import hashlib
from functools import lru_cache
from itertools import chain

import numpy as np

from coursework.figures.perspective import in_perspective
from coursework.model import Exercise, Part, in_turn
from coursework.structure.spatial_chains import ARRANGEMENTS, EQUIVALENTS, arranged

from ._solids import (
    WITH_DIRECTION,
    WITH_LINE,
    axis_parts,
    combined,
    freedoms_of,
    of_joints,
    rank_together,
    several_joints,
    table_of,
)

#: The third and the fourth joint: with freer ones nearly every row would leave all six freedoms.
STIFF = ("revolute", "prismatic", "cylindrical", "spherical")


@of_joints
def longer_rows_have_few_freedoms(arrangement, tilt, inclined, *joints):
    """Of three or four joints, seven at most: among them rows with six at this position, and with an inner
    one."""
    counts = np.vectorize(lambda name: ARRANGEMENTS[name][0])(np.atleast_1d(arrangement))
    every = [freedoms_of(name) * (number < counts) for number, (name, *_) in enumerate(joints)]
    return (counts == 2) | (np.sum(every, axis=0) <= 7)


@of_joints
def longer_rows_seldom_have_six(arrangement, tilt, inclined, *joints):
    """Of three or four joints, six freedoms only where the second is a ball."""
    rank = rank_together("series", arrangement, inclined, *joints)
    counts = np.vectorize(lambda name: ARRANGEMENTS[name][0])(np.atleast_1d(arrangement))
    return (counts == 2) | (rank < 6) | (np.atleast_1d(joints[1][0]) == "spherical")


def _name(arrangement, tilt, inclined, *joints):
    return combined("series", *arranged(arrangement, "x", inclined, *joints)).equivalent.name


@of_joints
def has_direction(*given):
    return _name(*given) in WITH_DIRECTION


@of_joints
def has_line(*given):
    return _name(*given) in WITH_LINE


#: Share of the draws of each equivalent joint that are let through: most draws make those.
LET_THROUGH = {"other": 0.25, "point_contact": 0.5}


@of_joints
def equivalents_are_mixed(arrangement, tilt, inclined, *joints):
    """Many draws leave no joint of a name, and who writes that everywhere would be right in most."""
    columns = np.broadcast_arrays(arrangement, inclined, *chain(*joints))
    rows = zip(*(np.atleast_1d(column).tolist() for column in columns), strict=True)
    return np.array([_is_let_through(*row) for row in rows])


@lru_cache(maxsize=65536)
def _is_let_through(arrangement, inclined, *columns):
    key = "/".join(map(str, (arrangement, inclined, *columns))).encode()
    share = int.from_bytes(hashlib.shake_128(key).digest(6), "little") / 2**48
    if share < min(LET_THROUGH.values()):
        return True
    name = _name(arrangement, "x", inclined, *zip(*[iter(columns)] * 5, strict=True))
    return share < LET_THROUGH.get(name, 1.0)


@of_joints
def tells(*given):
    joints = arranged(*given)
    return {"rows": table_of(joints, _bodies(joints))}


def _bodies(joints):
    return [(k, k + 1) for k in range(len(joints))]


@of_joints
def figure(*given):
    joints = arranged(*given)
    inner = [(k, k, k + 1) for k in range(1, len(joints))]
    return in_perspective(table_of(joints, _bodies(joints)), bodies=inner)


EXERCISE = Exercise(
    given=several_joints(STIFF),
    constraints=(longer_rows_have_few_freedoms, longer_rows_seldom_have_six, equivalents_are_mixed),
    parts=(
        Part("Nc", kind="integer", points=1),
        *in_turn(
            1,
            ("arrangement", "joint_1", "joint_2", "direction_2", "x2", "y2"),
            Part("m", kind="integer", points=1),
            Part("h", kind="integer", points=1),
        ),
        Part("m_useful", kind="integer", points=2),
        Part("m_internal", kind="integer", points=1),
        Part("equivalent", kind="choice", choices=EQUIVALENTS, ordered=True, points=2),
        *axis_parts(has_direction, has_line),
    ),
    version=3,
    tells=tells,
    figure=figure,
    symbols={
        "Nc": "N_c",
        "m_useful": "m_u",
        "m_internal": "m_i",
        "axis_dir": r"\vec{e}",
        "axis_point": "P",
        "turns": "n_r",
        "slides": "n_t",
    },
)
