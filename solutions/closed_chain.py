"""Closed chain: the rank of the loop equations at the given position, and what follows by counting."""

import numpy as np

from coursework.solids import aligned, each_distinct, joint_of
from coursework.solution import mistake

from ._solids import _chain, _chain_of, _each

STRUCTURES = ("joints",)

SYMBOLS = {"input_body": "b_e", "output_body": "b_s"}


def _ring(
    joint_1, direction_1, joint_2, direction_2, joint_3, direction_3, joint_4, direction_4,
    x2, y2, z2, x3, y3, z3, x4, y4, z4,
):  # fmt: skip
    return (
        aligned(joint_1, direction_1, between=(0, 1)),
        aligned(joint_2, direction_2, (x2, y2, z2), (1, 2)),
        aligned(joint_3, direction_3, (x3, y3, z3), (2, 3)),
        aligned(joint_4, direction_4, (x4, y4, z4), (3, 0)),
    )


def joints(
    joint_1, direction_1, joint_2, direction_2, joint_3, direction_3, joint_4, direction_4,
    x2, y2, z2, x3, y3, z3, x4, y4, z4,
):  # fmt: skip
    """The four joints in order around the loop."""
    return each_distinct(
        _ring,
        joint_1, direction_1, joint_2, direction_2, joint_3, direction_3, joint_4, direction_4,
        x2, y2, z2, x3, y3, z3, x4, y4, z4,
    )  # fmt: skip


def _solids(joints):
    return _chain_of(joints)


def n(_solids):
    """Moving bodies."""
    return _each(lambda one: one.n, _solids)


def gamma(_solids):
    return _each(lambda one: one.gamma, _solids)


def Nc(_solids):
    return _each(lambda one: one.Nc, _solids)


def rc(_solids):
    """The rank of the loop equations."""
    return _each(lambda one: one.rc, _solids)


def m(Nc, rc):
    return Nc - rc


def Ns(_solids):
    return _each(lambda one: one.Ns, _solids)


def rs(n, m):
    return 6 * n - m


def h(m, n, Ns):
    return m - 6 * n + Ns


def i(m, h):
    return m - h


def input_body():
    return 1


def output_body(n):
    return n


def m_internal(_solids, input_body, output_body):
    """The motions with both bodies at rest."""
    if not isinstance(_solids, np.ndarray):
        return _held(_solids, input_body, output_body)
    rows = np.broadcast(_solids, input_body, output_body)
    return np.array([_held(*row) for row in rows]).reshape(rows.shape)


def _held(chain, input_body, output_body):
    return _chain(chain.joints, int(input_body), int(output_body)).m_internal


def m_useful(m, m_internal):
    return m - m_internal


def statics(h):
    return np.where(np.asarray(h) > 0, "hyperstatic", "isostatic")


@mistake("gamma")
def gamma_without_frame(gamma):
    return gamma + 1


@mistake("Nc")
def unknowns_exchanged(Ns):
    return Ns


@mistake("rc")
def six_independent(rc):
    return 6 + 0 * rc


@mistake("n")
def frame_counted(n):
    return n + 1


@mistake("h")
def h_zero(h):
    return 0 * h


@mistake("m_internal")
def internal_forgotten(m_internal):
    return 0 * m_internal


def residual(joints, n, gamma, Nc, rc, m, Ns, rs, h, i, m_internal, m_useful):
    """Rank from the equilibrium of the moving bodies, and every relation of the course."""
    known = [joint_of(joint) for joint in joints]
    blocks = []
    for joint in known:
        actions = np.array(joint.wrenches((7.0, -3.0, 11.0), 20.0)).reshape(-1, 6).T
        column = np.zeros((6 * (n + 1), actions.shape[1]))
        for body, sense in zip(joint.between, (1, -1), strict=True):
            column[6 * body : 6 * body + 6] = sense * actions
        blocks.append(column[6:])
    statics = np.linalg.matrix_rank(np.concatenate(blocks, axis=1))
    return (
        float(rs - statics),
        float(h - (Ns - statics)),
        float(m - h - (6 * n - Ns)),
        float(m - h - (Nc - 6 * gamma)),
        float(i - (Nc - 6 * gamma)),
        float(Nc + Ns - 6 * len(known)),
        float(Nc - rc - m),
        float(m - m_internal - m_useful),
    )


_X, _Y, _Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)


def _revolutes(points, axes):
    size = len(points)
    return [
        {"between": [k, (k + 1) % size], "joint": "revolute", "axis": axes[k], "point": points[k]}
        for k in range(size)
    ]


KNOWN = (
    # A plane four-bar as a mechanism of space: the closure has rank 3.
    (
        {"joints": _revolutes([(0, 0, 0), (0, 40, 0), (100, 80, 0), (120, 0, 0)], [_Z] * 4)},
        {
            "gamma": 1,
            "Nc": 4,
            "rc": 3,
            "m": 1,
            "Ns": 20,
            "rs": 17,
            "h": 3,
            "i": -2,
            "m_internal": 0,
            "m_useful": 1,
        },
    ),
    # Bricard's six hinges along edges of a cube: the count says that nothing moves, and it does.
    (
        {
            "joints": _revolutes(
                [(0, 0, 0), (1, 0, 0), (1, 1, 0), (1, 1, 1), (0, 1, 1), (0, 0, 1)], [_Z, _Y, _X, _Z, _Y, _X]
            )
        },
        {"gamma": 1, "Nc": 6, "rc": 5, "m": 1, "Ns": 30, "h": 1, "i": 0, "statics": "hyperstatic"},
    ),
    # Crank, rod on two balls, rocker: the rod turns about itself.
    (
        {
            "joints": [
                {"between": [0, 1], "joint": "revolute", "axis": _Z, "point": (0, 0, 0)},
                {"between": [1, 2], "joint": "spherical", "point": (30, 10, 0)},
                {"between": [2, 3], "joint": "spherical", "point": (90, 40, 50)},
                {"between": [3, 0], "joint": "revolute", "axis": _X, "point": (90, 0, 0)},
            ]
        },
        {"Nc": 8, "rc": 6, "m": 2, "h": 0, "i": 2, "m_internal": 1, "m_useful": 1, "statics": "isostatic"},
    ),
)
