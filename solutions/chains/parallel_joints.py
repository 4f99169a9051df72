"""Joints between the same two bodies: their actions add up, so the ranks are those of the added actions."""

import numpy as np

from coursework.quantities.columns import each_stacked
from coursework.solids import FREEDOMS, aligned, each_distinct, joint_of
from coursework.solution import given, mistake

from ._solids import _direction, _parallel_of, _point_of_axis, _stiffest

STRUCTURES = ("joints",)


def _pair(joint_1, direction_1, joint_2, direction_2, x2, y2, z2):
    return aligned(joint_1, direction_1), aligned(joint_2, direction_2, (x2, y2, z2))


def joints(joint_1, direction_1, joint_2, direction_2, x2, y2, z2):
    """The first at A1, the origin; the second at A2."""
    return each_distinct(_pair, joint_1, direction_1, joint_2, direction_2, x2, y2, z2)


def _combined(joints):
    return _parallel_of(joints)


def Ns(_combined):
    """Six less the freedoms, joint by joint."""
    return each_stacked(lambda one: one.Ns, _combined)


def rs(_combined):
    """The rank of all the transmitted actions at one point."""
    return each_stacked(lambda one: one.rs, _combined)


def h(Ns, rs):
    return Ns - rs


def m(rs):
    return 6 - rs


def equivalent(_combined):
    return each_stacked(lambda one: one.equivalent.name, _combined)


def axis_dir(_combined):
    """Along the axis, or along the normal of a joint without axis."""
    return each_stacked(_direction, _combined)


def axis_point(_combined):
    return each_stacked(_point_of_axis, _combined)


@mistake("Ns")
def freedoms_for_unknowns(_combined):
    return each_stacked(lambda one: sum(joint.freedoms for joint in one.joints), _combined)


@mistake("rs")
def all_independent(Ns):
    return Ns


@mistake("rs")
def six_equations(rs):
    return 6 + 0 * rs


@mistake("h")
def h_from_six(Ns):
    return Ns - 6


@mistake("m")
def freedoms_added(_combined):
    return each_stacked(lambda one: sum(joint.freedoms for joint in one.joints), _combined)


@mistake("equivalent")
def stiffer_joint_alone(_combined):
    return each_stacked(_stiffest, _combined)


def residual(joints, Ns, rs, h, m, equivalent):
    """Mobility from the motions: those that all joints leave free, as solutions of one linear system."""
    known = [joint_of(joint) for joint in joints]
    twists = [np.array(joint.twists((0.0, 0.0, 0.0), 20.0)).reshape(-1, 6).T for joint in known]
    # A motion is a twist of the first joint that each of the others has as well.
    first, others = twists[0], twists[1:]
    places = np.cumsum([first.shape[1], *(t.shape[1] for t in others)])
    system = np.zeros((6 * len(others), places[-1]))
    for number, other in enumerate(others):
        rows = slice(6 * number, 6 * number + 6)
        system[rows, : places[0]] = first
        system[rows, places[number] : places[number + 1]] = -other
    free = places[-1] - np.linalg.matrix_rank(system) if others else first.shape[1]
    named = FREEDOMS.get(equivalent, m)
    statics = 6 * len(known) - sum(joint.freedoms for joint in known)
    return float(m - free), float(named - m), float(Ns - statics), float(m - h - (6 - Ns)), float(rs + m - 6)


_X, _Y, _Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
_O = (0, 0, 0)

KNOWN = (
    # A shaft in a ball bearing that holds it and one that lets it slide: a hinge, isostatic.
    given(
        joints=[
            {"joint": "spherical", "point": (0, 0, 0)},
            {"joint": "annular", "axis": _X, "point": (200, 0, 0)},
        ]
    ).gives(Ns=5, rs=5, h=0, m=1, equivalent="revolute", axis_dir=np.array([1.0, 0.0, 0.0])),
    # A door on two hinges.
    given(joints=[{"joint": "revolute", "axis": _Z, "point": (0, 0, c)} for c in (300, 1700)]).gives(
        Ns=10, rs=5, h=5, m=1, equivalent="revolute"
    ),
    # The table of the course: three legs, then a fourth.
    given(joints=[{"joint": "point_contact", "normal": _Z, "point": p} for p in (_O, _X, _Y)]).gives(
        Ns=3, rs=3, h=0, m=3, equivalent="planar"
    ),
    given(
        joints=[{"joint": "point_contact", "normal": _Z, "point": p} for p in (_O, _X, _Y, (1, 1, 0))]
    ).gives(Ns=4, rs=3, h=1, m=3, equivalent="planar"),
    # Two planes that meet: a slide along their common line.
    given(joint_1="planar", direction_1="z", joint_2="planar", direction_2="y", x2=0, y2=20, z2=40).gives(
        Ns=6, rs=5, h=1, m=1, equivalent="prismatic", axis_dir=np.array([1.0, 0.0, 0.0])
    ),
    # Maxwell's clamp: three points, two points of a line across, one across both: nothing moves.
    given(
        joints=[
            *[{"joint": "point_contact", "normal": _Z, "point": p} for p in (_O, _X, _Y)],
            *[{"joint": "point_contact", "normal": _Y, "point": p} for p in (_O, _X)],
            {"joint": "point_contact", "normal": _X, "point": _O},
        ]
    ).gives(Ns=6, rs=6, h=0, m=0, equivalent="rigid"),
)
