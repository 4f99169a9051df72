"""Plane chain: joints projected on (rotation z, velocities x and y), and the same chain in space."""

import numpy as np

from coursework.quantities.columns import each_stacked
from coursework.solution import given, mistake
from coursework.structure.spatial_chains import aligned, each_distinct, joints_of, planar_kind

from ._counts import *
from ._solids import _chain_of, _planar_chain_of

STRUCTURES = ("joints",)

SYMBOLS = {"Nc_space": r"N_{c,\mathrm{3D}}", "rc_space": r"r_{c,\mathrm{3D}}"}


def _ring(
    joint_1,
    direction_1,
    joint_2,
    direction_2,
    joint_3,
    direction_3,
    joint_4,
    direction_4,
    x2,
    y2,
    x3,
    y3,
    x4,
    y4,
):
    return (
        aligned(joint_1, direction_1, between=(0, 1)),
        aligned(joint_2, direction_2, (x2, y2, 0), (1, 2)),
        aligned(joint_3, direction_3, (x3, y3, 0), (2, 3)),
        aligned(joint_4, direction_4, (x4, y4, 0), (3, 0)),
    )


def joints(
    joint_1,
    direction_1,
    joint_2,
    direction_2,
    joint_3,
    direction_3,
    joint_4,
    direction_4,
    x2,
    y2,
    x3,
    y3,
    x4,
    y4,
):
    """The four joints in order around the loop."""
    return each_distinct(
        _ring,
        joint_1,
        direction_1,
        joint_2,
        direction_2,
        joint_3,
        direction_3,
        joint_4,
        direction_4,
        x2,
        y2,
        x3,
        y3,
        x4,
        y4,
    )


def _solids(joints):
    return _planar_chain_of(joints)


def _space(joints):
    return _chain_of(joints)


def _kind(chain, number):
    """The joint of the plane that one of the list is; empty where the list is shorter."""
    return planar_kind(chain.joints[number - 1]) if number <= len(chain.joints) else ""


def _kinds(chains, number):
    return each_stacked(lambda one: _kind(one, number), chains)


def planar_1(_solids):
    return _kinds(_solids, 1)


def planar_2(_solids):
    return _kinds(_solids, 2)


def planar_3(_solids):
    return _kinds(_solids, 3)


def planar_4(_solids):
    return _kinds(_solids, 4)


def rs(n, m):
    return 3 * n - m


def h(Ns, rs):
    return Ns - rs


def Nc_space(_space):
    """With all the freedoms, those out of the plane too."""
    return each_stacked(lambda one: one.Nc, _space)


def rc_space(_space):
    return each_stacked(lambda one: one.rc, _space)


def h_space(gamma, rc_space):
    return 6 * gamma - rc_space


def comparison(h, h_space):
    """Conclusion from the plane study about the constraint of the real chain."""
    return np.where(np.asarray(h) > 0, "plane", np.where(np.asarray(h_space) > 0, "hidden", "sound"))


def _misread(kinds, chains, name, is_meant, wrong):
    """The kinds, with those of some joints of a name taken for another."""

    def one(chain, number, kind):
        joint = chain.joints[number - 1]
        return wrong if joint.name == name and is_meant(joint) else kind

    found = []
    for number, kind in enumerate(kinds, start=1):
        if not isinstance(chains, np.ndarray):
            found.append(one(chains, number, kind))
            continue
        pairs = zip(chains.ravel(), np.broadcast_to(kind, chains.shape).ravel(), strict=True)
        found.append(np.array([one(chain, number, str(k)) for chain, k in pairs]).reshape(chains.shape))
    return tuple(found)


def _is_along_z(joint):
    return abs(joint.frame[0][2]) > 0.5


@mistake("planar_1", "planar_2", "planar_3", "planar_4")
def contact_of_normal_z_as_slide(planar_1, planar_2, planar_3, planar_4, _solids):
    return _misread((planar_1, planar_2, planar_3, planar_4), _solids, "planar", _is_along_z, "prismatic")


@mistake("planar_1", "planar_2", "planar_3", "planar_4")
def ball_in_groove_as_pivot(planar_1, planar_2, planar_3, planar_4, _solids):
    kinds = planar_1, planar_2, planar_3, planar_4
    return _misread(kinds, _solids, "annular", lambda joint: not _is_along_z(joint), "revolute")


@mistake("planar_1", "planar_2", "planar_3", "planar_4")
def cylinder_always_pivot(planar_1, planar_2, planar_3, planar_4, _solids):
    kinds = planar_1, planar_2, planar_3, planar_4
    return _misread(kinds, _solids, "cylindrical", lambda joint: not _is_along_z(joint), "revolute")


@mistake("gamma")
def gamma_without_frame(gamma):
    return gamma + 1


@mistake("Nc")
def spatial_freedoms_kept(Nc_space):
    return Nc_space


@mistake("rc")
def three_independent(gamma):
    return 3 * gamma


@mistake("rc")
def six_equations(gamma):
    return 6 * gamma


@mistake("Ns")
def six_less_each_freedom(joints, Nc):
    return 6 * _length(joints) - Nc


def _length(joints):
    return len(joints) if isinstance(joints, tuple) else np.array([len(one) for one in joints])


@mistake("rs")
def six_for_three(n, m):
    return 6 * n - m


@mistake("n")
def frame_counted(n):
    return n + 1


@mistake("h_space")
def space_as_plane(h):
    return h


@mistake("h_space")
def six_less_plane_rank(gamma, rc):
    return 6 * gamma - rc


def residual(joints, n, gamma, Nc, rc, m, Ns, rs, h, i, rc_space, h_space):
    """Plane statics by the forces that each joint transmits in the plane, and every relation of the
    course."""
    known = joints_of(joints)
    columns = []
    for joint in known:
        x, y, _ = joint.point or (0.0, 0.0, 0.0)
        free = np.array(joint.twists(joint.point or (0.0, 0.0, 0.0), 1.0)).reshape(-1, 6)[:, 2:5]
        # What no motion of the joint makes work: moment about z and forces along x and y, at its point.
        _, sizes, ways = np.linalg.svd(free, full_matrices=True)
        actions = ways[(sizes > 1e-9).sum() :]
        at_origin = actions + np.outer(x * actions[:, 2] - y * actions[:, 1], [1, 0, 0])
        column = np.zeros((3 * (n + 1), len(actions)))
        for body, sense in zip(joint.between, (1, -1), strict=True):
            column[3 * body : 3 * body + 3] = sense * at_origin.T
        columns.append(column[3:])
    statics = np.concatenate(columns, axis=1)
    rank = np.linalg.matrix_rank(statics, tol=1e-9 * max(1.0, abs(statics).max(initial=0.0)))
    return (
        float(Ns - statics.shape[1]),
        float(rs - rank),
        float(m - h - (3 * n - Ns)),
        float(m - h - (Nc - 3 * gamma)),
        float(i - (m - h)),
        float(Nc + Ns - 3 * len(known)),
        float(Nc - rc - m),
        # The plane sees some of the constraints of space: never more of them, never more motions.
        float(max(0, h - h_space)),
        float(max(0, rc - rc_space)),
    )


_X, _Y, _Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)

_POINTS = ((0, 0, 0), (0, 40, 0), (100, 80, 0), (120, 0, 0))


def _loop(*names):
    """A joint a body around the loop, (name, axis), each with the axis as its normal too."""
    return [
        {
            "between": [k, (k + 1) % len(names)],
            "joint": name,
            "axis": axis,
            "normal": axis,
            "point": _POINTS[k],
        }
        for k, (name, axis) in enumerate(names)
    ]


KNOWN = (
    # The four-bar: isostatic in the plane, three times hyperstatic in space.
    given(joints=_loop(*[("revolute", _Z)] * 4)).gives(
        planar_1="revolute",
        gamma=1,
        Nc=4,
        rc=3,
        m=1,
        Ns=8,
        rs=8,
        h=0,
        i=1,
        Nc_space=4,
        h_space=3,
        comparison="hidden",
    ),
    # Its joints loosened until nothing is forced: pivot, ball, ball in a groove along z, pivot.
    given(joints=_loop(("revolute", _Z), ("spherical", _Z), ("annular", _Z), ("revolute", _Z))).gives(
        Nc=4,
        m=1,
        h=0,
        Nc_space=9,
        h_space=0,
        comparison="sound",
    ),
    # Three slides in one plane: any of them could be fixed.
    given(joints=_loop(("prismatic", _X), ("prismatic", _Y), ("prismatic", (1, 0, 0)))).gives(
        gamma=1,
        Nc=3,
        rc=2,
        m=1,
        Ns=6,
        h=1,
        h_space=4,
        comparison="plane",
    ),
    # A cam: pivot, contact at a point, slide.
    given(joints=_loop(("revolute", _Z), ("point_contact", _Y), ("prismatic", _Y))).gives(
        planar_2="point_contact",
        planar_3="prismatic",
        Nc=4,
        rc=3,
        m=1,
        h=0,
        h_space=0,
    ),
    # A wedge: a slide along x, the slope that is common to both bodies, a slide along y.
    given(joints=_loop(("prismatic", _X), ("prismatic", (3, -4, 0)), ("prismatic", _Y))).gives(
        planar_1="prismatic",
        planar_2="prismatic",
        gamma=1,
        Nc=3,
        rc=2,
        m=1,
        Ns=6,
        rs=5,
        h=1,
        comparison="plane",
    ),
    # A pair of gears: two pivots, and a contact whose line of action is inclined.
    given(joints=_loop(("revolute", _Z), ("point_contact", (94, 34, 0)), ("revolute", _Z))).gives(
        planar_2="point_contact",
        gamma=1,
        Nc=4,
        rc=3,
        m=1,
        Ns=5,
        rs=5,
        h=0,
        comparison="sound",
    ),
    # The table of the course: each column one joint.
    given(joints=_loop(("cylindrical", _Z), ("cylindrical", _X), ("annular", _X), ("planar", _Z))).gives(
        planar_1="revolute",
        planar_2="prismatic",
        planar_3="point_contact",
        planar_4="free",
    ),
    given(joints=_loop(("annular", _Z), ("planar", _X), ("point_contact", _X), ("point_contact", _Z))).gives(
        planar_1="revolute",
        planar_2="prismatic",
        planar_3="point_contact",
        planar_4="free",
    ),
)
