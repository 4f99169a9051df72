"""Joints in a row: their free motions add up, so the ranks are those of the added motions."""

import numpy as np

from coursework.quantities.columns import each, each_stacked
from coursework.solution import explained_after, given, mistake
from coursework.structure.spatial_chains import FREEDOMS, each_distinct, joint_of

from ._solids import _direction, _freest, _in_parallel, _lines, _point_of_axis, _row_of, _series_of

STRUCTURES = ("joints", "free_motions")


def _in_a_row(*given):
    return _row_of(lambda number: (number, number + 1), *given)


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
        _in_a_row,
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
    return _series_of(joints)


def free_motions(_combined):
    """One by one, at A1: a line of the table each, and how it adds up from those before, where it does."""
    return each(lambda whole: _lines(whole.joints, "twists"), _combined)


def Nc(free_motions):
    """The freedoms, joint by joint."""
    return each_stacked(len, free_motions)


def m(Nc):
    return Nc


@explained_after("free_motions")
def m_useful(_combined):
    """The rank of all the free motions at one point."""
    return each_stacked(lambda one: one.m_useful, _combined)


def m_internal(m, m_useful):
    return m - m_useful


def h():
    return 0


@explained_after("m_useful")
def equivalent(_combined):
    """No joint at all only where all six motions are free at every pose; where they are at this one alone,
    another."""
    return each_stacked(lambda one: one.equivalent.name, _combined)


@explained_after("equivalent")
def turns(_combined):
    """Of the independent motions, those that differ in their rotation vectors."""
    return each_stacked(lambda one: one.turns, _combined)


def slides(m_useful, turns):
    """The others can be taken without any rotation."""
    return m_useful - turns


def axis_dir(_combined):
    """Along the axis, or along the normal of a joint without axis."""
    return each_stacked(_direction, _combined)


def axis_point(_combined):
    return each_stacked(_point_of_axis, _combined)


def _statics(whole):
    """Static unknowns of all the joints."""
    return sum(6 - joint.freedoms for joint in whole.joints)


@mistake("Nc")
def unknowns_for_freedoms(_combined):
    return each_stacked(_statics, _combined)


@mistake("m")
def m_is_useful(m_useful):
    return m_useful


@mistake("m_useful")
def all_useful(Nc):
    return Nc


@mistake("m_useful")
def useful_up_to_six(Nc):
    return np.minimum(Nc, 6)


@mistake("m_useful", "h")
def statics_added(_combined):
    return (
        each_stacked(lambda one: _in_parallel(one.joints).m, _combined),
        each_stacked(lambda one: _in_parallel(one.joints).h, _combined),
    )


@mistake("h")
def h_from_six(_combined):
    return each_stacked(_statics, _combined) - 6


@mistake("equivalent")
def freer_joint_alone(_combined):
    return each_stacked(_freest, _combined)


@mistake("equivalent")
def free_at_this_pose(equivalent, m_useful):
    """Six motions here are taken for six at every pose."""
    return np.where(np.asarray(m_useful) == 6, "free", equivalent)


def residual(joints, Nc, m, m_useful, m_internal, h, equivalent):
    """Mobility from the actions: the last body is free of what not every joint of the row transmits."""
    known = [joint_of(joint) for joint in joints]
    wrenches = [np.array(joint.wrenches((0.0, 0.0, 0.0), 20.0)).reshape(-1, 6).T for joint in known]
    # An action of the whole is an action of the first joint that each of the others transmits as well.
    first, others = wrenches[0], wrenches[1:]
    places = np.cumsum([first.shape[1], *(w.shape[1] for w in others)])
    system = np.zeros((6 * len(others), places[-1]))
    for number, other in enumerate(others):
        rows = slice(6 * number, 6 * number + 6)
        system[rows, : places[0]] = first
        system[rows, places[number] : places[number + 1]] = -other
    shared = places[-1] - np.linalg.matrix_rank(system) if others else first.shape[1]
    named = FREEDOMS.get(equivalent, m_useful)
    freedoms = sum(joint.freedoms for joint in known)
    return (
        float(m_useful - (6 - shared)),
        float(named - m_useful),
        float(Nc - freedoms),
        float(m - m_useful - m_internal),
        float(h),
    )


_X, _Y, _Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
_O = (0, 0, 0)

KNOWN = (
    # A ball in a shoe that slides on a plane: a point contact, and the ball may spin about the normal unseen.
    given(joints=[{"joint": "planar", "normal": _Z}, {"joint": "spherical", "point": _O}]).gives(
        Nc=6,
        m=6,
        m_useful=5,
        m_internal=1,
        h=0,
        equivalent="point_contact",
        axis_dir=np.array([0.0, 0.0, 1.0]),
    ),
    # A universal joint: two hinges whose axes meet at right angles.
    given(joints=[{"joint": "revolute", "axis": axis, "point": _O} for axis in (_X, _Y)]).gives(
        Nc=2,
        m_useful=2,
        m_internal=0,
        equivalent="spherical_pin",
    ),
    # A drawing board's two-hinged arm with a third hinge holds a plane against the board.
    given(
        joints=[{"joint": "revolute", "axis": _Z, "point": p} for p in (_O, (300, 0, 0), (300, 400, 0))],
    ).gives(Nc=3, m_useful=3, m_internal=0, equivalent="planar"),
    # A shaft that turns in a sleeve which turns in the frame about the same axis.
    given(joints=[{"joint": "revolute", "axis": _Y, "point": (5, y, 7)} for y in (0, 30)]).gives(
        Nc=2,
        m=2,
        m_useful=1,
        m_internal=1,
        equivalent="revolute",
    ),
    # A rod between two balls: it pushes along its line and turns about it.
    given(joints=[{"joint": "spherical", "point": p} for p in (_O, (0, 80, 0))]).gives(
        Nc=6,
        m_useful=5,
        m_internal=1,
        equivalent="point_contact",
        axis_dir=np.array([0.0, 1.0, 0.0]),
    ),
    # Three slides and a ball: all six, however far they slide and turn.
    given(
        joints=[
            *({"joint": "prismatic", "axis": a} for a in (_X, (0, 3, 4), (0, 4, -3))),
            {"joint": "spherical", "point": _O},
        ]
    ).gives(
        m_useful=6,
        m_internal=0,
        equivalent="free",
    ),
    # An arm of six hinges: all six here, but not where two of its axes are in line.
    given(
        joints=[
            {"joint": "revolute", "axis": axis, "point": point}
            for axis, point in (
                (_Z, _O),
                (_Y, (0, 0, 300)),
                (_Y, (300, 0, 700)),
                (_X, (800, 0, 300)),
                (_Y, (800, 0, 300)),
                ((3, 0, 4), (800, 0, 300)),
            )
        ]
    ).gives(Nc=6, m_useful=6, m_internal=0, equivalent="other"),
)
