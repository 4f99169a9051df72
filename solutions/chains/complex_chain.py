"""Complex chain: counts on the graph, the rank of all loop equations, and the motions that input and output
do not see."""

import numpy as np

from coursework.errors import WrongValue
from coursework.quantities.columns import each, each_stacked
from coursework.solution import given, mistake
from coursework.structure.spatial_chains import aligned, each_distinct

from ...exercises.chains._complex import DIRECTIONS, LAYOUTS, points_of
from ._chains import *
from ._solids import _planar_chain

SYMBOLS = {"input_body": "b_e", "output_body": "b_s"}


def _linkage(
    layout,
    joint_1,
    joint_2,
    joint_3,
    joint_4,
    joint_5,
    joint_6,
    joint_7,
    joint_8,
    xA,
    yA,
    xB,
    yB,
    xC,
    xD,
    yD,
    xE,
    yE,
):
    names = (joint_1, joint_2, joint_3, joint_4, joint_5, joint_6, joint_7, joint_8)
    points = points_of(xA, yA, xB, yB, xC, xD, yD, xE, yE)
    rows = zip(LAYOUTS[layout].between, names, DIRECTIONS, points, strict=False)
    return tuple(aligned(name, along, point, between) for between, name, along, point in rows)


def joints(
    layout,
    joint_1,
    joint_2,
    joint_3,
    joint_4,
    joint_5,
    joint_6,
    joint_7,
    joint_8,
    xA,
    yA,
    xB,
    yB,
    xC,
    xD,
    yD,
    xE,
    yE,
):
    """The lines of the table."""
    return each_distinct(
        _linkage,
        layout,
        joint_1,
        joint_2,
        joint_3,
        joint_4,
        joint_5,
        joint_6,
        joint_7,
        joint_8,
        xA,
        yA,
        xB,
        yB,
        xC,
        xD,
        yD,
        xE,
        yE,
    )


def motions(_solids):
    """In the plane, then out of it: freedoms of the joints, and the rank of the loop equations. Nothing for
    joints that keep the two together."""
    return each(_apart, _solids)


def _apart(chain):
    plane = _planar_chain(chain.joints)
    try:
        freedoms, rank = plane.Nc, plane.rc
    except WrongValue:
        return ()
    return {"freedoms": freedoms, "rank": rank}, {"freedoms": chain.Nc - freedoms, "rank": chain.rc - rank}


def input_body():
    return 1


def output_body(_solids, layout=""):
    """The body that the statement names; the last one of a list of joints."""
    last = each_stacked(lambda one: one.n, _solids)
    return np.where(np.asarray(layout) == "strut", LAYOUTS["strut"].output, last)[()]


def role(m_useful):
    """Purpose of the mechanism, by its useful mobility."""
    return np.where(
        np.asarray(m_useful) == 0, "clamp", np.where(np.asarray(m_useful) == 1, "transforms", "adjusted")
    )


@mistake("gamma")
def one_loop(gamma):
    """The outer loop alone."""
    return 1 + 0 * gamma


@mistake("m")
def plane_count(n, joints):
    """The plane formula, as if every joint were a lower pair of a plane mechanism."""
    count = len(joints) if isinstance(joints, tuple) else np.array([len(one) for one in joints])
    return 3 * n - 2 * count


@mistake("m")
def index_for_mobility(n, Ns):
    return 6 * n - Ns


_X, _Z = (1, 0, 0), (0, 0, 1)


def _at(one, other, kind, point, axis=_Z):
    return {"between": [one, other], "joint": kind, "axis": axis, "normal": axis, "point": point}


_FOUR_BAR = [
    _at(0, 1, "revolute", (0, 0, 0)),
    _at(1, 2, "revolute", (0, 40, 0)),
    _at(2, 3, "revolute", (100, 80, 0)),
    _at(3, 0, "revolute", (120, 0, 0)),
]

KNOWN = (
    # A four-bar that drives a slide by a rod: plane, six times hyperstatic in space.
    given(
        joints=[
            *_FOUR_BAR,
            _at(3, 4, "revolute", (150, 60, 0)),
            _at(4, 5, "revolute", (300, 0, 0)),
            _at(5, 0, "prismatic", (300, 0, 0), _X),
        ],
        input_body=1,
        output_body=5,
    ).gives(n=5, gamma=2, Nc=7, Ns=35, rc=6, m=1, i=-5, h=6, m_internal=0, m_useful=1, role="transforms"),
    # The coupler on a ball and a cylinder, the rod on two balls: nothing is forced, and the rod turns about
    # itself.
    given(
        joints=[
            _FOUR_BAR[0],
            _at(1, 2, "spherical", (0, 40, 0)),
            _at(2, 3, "cylindrical", (100, 80, 0)),
            _FOUR_BAR[3],
            _at(3, 4, "spherical", (150, 60, 0)),
            _at(4, 5, "spherical", (300, 0, 0)),
            _at(5, 0, "prismatic", (300, 0, 0), _X),
        ],
        input_body=1,
        output_body=5,
    ).gives(Nc=14, rc=12, m=2, m_internal=1, h=0, i=2, m_useful=1, statics="isostatic"),
    # A plane triangle hung on a rocker: nothing moves in the plane.
    given(
        joints=[*_FOUR_BAR, _at(3, 4, "revolute", (150, 60, 0)), _at(4, 0, "revolute", (300, 0, 0))],
        input_body=1,
        output_body=3,
    ).gives(n=4, gamma=2, Nc=6, rc=6, m=0, h=6, m_useful=0, role="clamp"),
    # Two screws in a row between one pair of bodies and a slide beside them: a table that is set by two
    # handles.
    given(
        joints=[
            _at(0, 1, "revolute", (0, 0, 0), _X),
            {**_at(1, 2, "helical", (0, 0, 0), _X), "pitch": 4},
            _at(0, 2, "prismatic", (0, 30, 0), _X),
            _at(2, 3, "revolute", (0, 0, 50), _X),
            {**_at(3, 4, "helical", (0, 0, 50), _X), "pitch": 2},
            _at(2, 4, "prismatic", (0, 30, 50), _X),
        ],
        input_body=1,
        output_body=4,
    ).gives(n=4, gamma=2, Nc=6, rc=4, m=2, h=8, m_internal=0, m_useful=2, role="adjusted"),
)
