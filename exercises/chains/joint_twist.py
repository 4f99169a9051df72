"""Twists and wrenches of joints at a point: which components may differ from zero, carried to another point,
added up."""

import numpy as np

from coursework.figures.perspective import in_perspective
from coursework.model import Exercise, Part, chosen, drawn
from coursework.structure.spatial_chains import AlignedJoint

from ._solids import coordinate, direction, joint_kind, rank_together, table_of, vector_latex

#: Directions whose unit vectors are quotients of whole numbers.
OBLIQUE = ("0 3 4", "4 0 3", "3 -4 0", "1 2 2", "2 -1 2", "2 3 6", "-3 6 2")


def the_point_matters(joint_1, direction_1, x2, y2, z2):
    """The first joint turns, about an axis that does not pass through A2."""
    turning = ~np.isin(joint_1, ("prismatic",))
    along = [np.asarray(direction_1) == letter for letter in "xyz"]
    off = np.sum([(np.asarray(c) != 0) & ~on for c, on in zip((x2, y2, z2), along, strict=True)], axis=0)
    return turning & (off > 0)


def both_leave_something_or_the_first_is_a_hinge(joint_1, direction_1, joint_2, direction_2, x2, y2, z2):
    """The two joints in parallel; a hinge, or one that slides, with another joint is mostly rigid."""
    first, second = (joint_1, direction_1, 0, 0, 0), (joint_2, direction_2, x2, y2, z2)
    rank = rank_together("parallel", "two", "0 3 4", first, second)
    return (rank < 6) | np.isin(joint_1, ("revolute", "cylindrical"))


def the_forces_are_some(X1, Y1, Z1, X2, Y2, Z2):
    """Neither of the two forces vanishes, nor does their sum."""
    first, second = np.abs([X1, Y1, Z1]).sum(axis=0), np.abs([X2, Y2, Z2]).sum(axis=0)
    together = np.abs([X1 + X2, Y1 + Y2, Z1 + Z2]).sum(axis=0)
    return (first > 0) & (second > 0) & (together > 0)


def _pair(joint_1, direction_1, joint_2, direction_2, x2, y2, z2):
    origin = AlignedJoint(joint_1, direction_1, (0.0, 0.0, 0.0))
    return origin, AlignedJoint(joint_2, direction_2, (float(x2), float(y2), float(z2)))


def _rows(*given):
    return table_of(_pair(*given), [(1, 2), (1, 2)])


def tells(joint_1, direction_1, joint_2, direction_2, x2, y2, z2, axis, hinge):
    return {
        "rows": _rows(joint_1, direction_1, joint_2, direction_2, x2, y2, z2),
        "e": vector_latex(tuple(map(int, axis.split()))),
        "f": rf"\vec {hinge}",
    }


def figure(joint_1, direction_1, joint_2, direction_2, x2, y2, z2):
    return in_perspective(_rows(joint_1, direction_1, joint_2, direction_2, x2, y2, z2))


def _force():
    return drawn(-50, 50, step=10, unit="N")


EXERCISE = Exercise(
    given={
        "joint_1": joint_kind(),
        "direction_1": direction(),
        "joint_2": joint_kind(),
        "direction_2": direction(),
        "x2": coordinate(),
        "y2": coordinate(),
        "z2": coordinate(),
        "axis": chosen(*OBLIQUE, shown=False),
        "omega1": drawn(2, 20, step=1, unit="rad/s"),
        "v1": drawn(20, 200, step=10, unit="mm/s"),
        "hinge": direction(),
        "omega2": drawn(-20, 20, step=1, unit="rad/s"),
        **{f"{letter}{k}": _force() for k in (1, 2) for letter in "XYZ"},
    },
    constraints=(the_point_matters, both_leave_something_or_the_first_is_a_hinge, the_forces_are_some),
    parts=(
        Part("twist_1", kind="twist_pattern", points=1),
        Part("twist_1_at_2", kind="twist_pattern", points=2),
        Part("wrench_1_at_2", kind="wrench_pattern", points=2),
        Part("wrench_both", kind="wrench_pattern", points=2),
        Part("twist_both", kind="twist_pattern", points=2),
        Part("V_10", unit="mm/s", kind="twist", points=3),
        Part("V_20", unit="mm/s", kind="twist", points=3),
        Part("V_plane", unit="mm/s", kind="twist", points=1),
        Part("W", unit="N*mm", kind="wrench", points=3),
    ),
    tells=tells,
    figure=figure,
    symbols={
        "omega1": r"\omega_1",
        "omega2": r"\omega_2",
        "twist_1": r"\left\{\mathcal{V}_1\right\}_{A_1}",
        "twist_1_at_2": r"\left\{\mathcal{V}_1\right\}_{A_2}",
        "wrench_1_at_2": r"\left\{\mathcal{T}_1\right\}_{A_2}",
        "wrench_both": r"\left\{\mathcal{T}_{12}\right\}_{A_1}",
        "twist_both": r"\left\{\mathcal{V}_{12}\right\}_{A_1}",
        "V_10": r"\left\{\mathcal{V}(S_1/S_0)\right\}_{A_2}",
        "V_20": r"\left\{\mathcal{V}(S_2/S_0)\right\}_{A_1}",
        "V_plane": r"\left\{\mathcal{V}\right\}",
        "W": r"\left\{\mathcal{T}\right\}_{A_1}",
    },
)
