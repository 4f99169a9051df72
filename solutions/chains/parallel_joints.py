"""Joints between the same two bodies: their actions add up, so the ranks are those of the added actions."""

import numpy as np

from coursework.quantities.columns import each, each_stacked
from coursework.solution import explained_after, given, mistake
from coursework.structure.spatial_chains import FREEDOMS, each_distinct, joint_of

from ._solids import _direction, _lines, _parallel_of, _point_of_axis, _row_of, _stiffest

STRUCTURES = ("joints", "transmitted")


def _together(*given):
    return _row_of(lambda number: (0, 1), *given)


def joints(
    arrangement,
    tilt,
    inclined,
    joint_1,
    direction_1,
    joint_2,
    direction_2,
    x2,
    y2,
    z2,
    joint_3,
    direction_3,
    x3,
    y3,
    z3,
    joint_4,
    direction_4,
    x4,
    y4,
    z4,
):
    """Those of the arrangement, the first at A1, the origin."""
    return each_distinct(
        _together,
        arrangement,
        tilt,
        inclined,
        joint_1,
        direction_1,
        joint_2,
        direction_2,
        x2,
        y2,
        z2,
        joint_3,
        direction_3,
        x3,
        y3,
        z3,
        joint_4,
        direction_4,
        x4,
        y4,
        z4,
    )


def _combined(joints):
    return _parallel_of(joints)


def transmitted(_combined):
    """One by one, at A1: a line of the table each, and how it adds up from those before, where it does."""
    return each(lambda whole: _lines(whole.joints, "wrenches"), _combined)


def Ns(transmitted):
    """Six less the freedoms, joint by joint."""
    return each_stacked(len, transmitted)


@explained_after("transmitted")
def rs(_combined):
    """The rank of all the transmitted actions at one point."""
    return each_stacked(lambda one: one.rs, _combined)


def h(Ns, rs):
    return Ns - rs


def m(rs):
    return 6 - rs


def equivalent(_combined):
    return each_stacked(lambda one: one.equivalent.name, _combined)


@explained_after("equivalent")
def turns(_combined):
    """Of the independent motions, those that differ in their rotation vectors."""
    return each_stacked(lambda one: one.turns, _combined)


def slides(m, turns):
    """The others can be taken without any rotation."""
    return m - turns


def axis_dir(_combined):
    """Along the axis, or along the normal of a joint without axis."""
    return each_stacked(_direction, _combined)


def axis_point(_combined):
    return each_stacked(_point_of_axis, _combined)


def condition(_combined):
    """Kind of the redundant constraints: held by moments, by forces, or by both."""
    return each_stacked(lambda one: one.condition, _combined)


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


@mistake("condition")
def directions_alone(condition):
    return np.where(np.asarray(condition) == "both", "directions", condition)


@mistake("condition")
def positions_alone(condition):
    return np.where(np.asarray(condition) == "both", "positions", condition)


@mistake("condition")
def nothing_to_make(condition):
    return np.where(np.asarray(condition) == "none", condition, "none")


def residual(joints, Ns, rs, h, m, equivalent, condition):
    """Mobility from the motions: those that all joints leave free, as solutions of one linear system. The
    conditions from the actions that balance one another."""
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
    # Actions of the joints that balance one another: those without any force are held by moments.
    held = [np.array(joint.wrenches((0.0, 0.0, 0.0), 20.0)).reshape(-1, 6) for joint in known]
    rows = np.concatenate(held)
    balanced = np.linalg.svd(rows.T)[2][np.linalg.matrix_rank(rows) :]
    ends = np.cumsum([len(w) for w in held])[:-1]
    forces = [c @ w[:, 3:] for c, w in zip(np.split(balanced, ends, axis=1), held, strict=True)]
    linear = np.linalg.matrix_rank(np.hstack(forces), tol=1e-9) if h else 0
    expected = {(0, 0): "none", (1, 0): "directions", (0, 1): "positions", (1, 1): "both"}
    agrees = expected[int(h > linear), int(linear > 0)] == condition
    return (
        float(not agrees),
        float(m - free),
        float(named - m),
        float(Ns - statics),
        float(m - h - (6 - Ns)),
        float(rs + m - 6),
    )


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
        Ns=10, rs=5, h=5, m=1, equivalent="revolute", condition="both"
    ),
    # An inclined shaft on a ball and a ball in a groove along it: nothing need be made exactly.
    given(
        joints=[
            {"joint": "spherical", "point": _O},
            {"joint": "annular", "axis": (0, 3, 4), "point": (0, 300, 400)},
        ]
    ).gives(
        Ns=5, rs=5, h=0, m=1, equivalent="revolute", axis_dir=np.array([0.0, 0.6, 0.8]), condition="none"
    ),
    # Two slides side by side: parallel, and at the right distance.
    given(joints=[{"joint": "prismatic", "axis": (2, 3, 6), "point": p} for p in (_O, (0, 50, 0))]).gives(
        Ns=10,
        rs=5,
        h=5,
        m=1,
        equivalent="prismatic",
        condition="both",
    ),
    # A plate that rests on two planes which meet: they must be square to each other.
    given(joints=[{"joint": "planar", "normal": (0, 3, 4)}, {"joint": "planar", "normal": (0, 4, -3)}]).gives(
        h=1,
        m=1,
        equivalent="prismatic",
        condition="directions",
    ),
    # The table of the course: three legs, then a fourth, whose length matters.
    given(joints=[{"joint": "point_contact", "normal": _Z, "point": p} for p in (_O, _X, _Y)]).gives(
        Ns=3, rs=3, h=0, m=3, equivalent="planar"
    ),
    given(
        joints=[{"joint": "point_contact", "normal": _Z, "point": p} for p in (_O, _X, _Y, (1, 1, 0))]
    ).gives(Ns=4, rs=3, h=1, m=3, equivalent="planar", condition="positions"),
    # Two planes that meet: a slide along their common line.
    given(joints=[{"joint": "planar", "normal": _Z}, {"joint": "planar", "normal": _Y}]).gives(
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
