"""Quantities of a chain of solids: the rank of its loop equations at the given position, and what follows by
counting."""

import numpy as np

from coursework.quantities.columns import each_stacked
from coursework.solution import mistake
from coursework.structure.spatial_chains import joint_of

from ._counts import *
from ._solids import _chain, _chain_of

STRUCTURES = ("joints", "motions")  #: ``motions``, of each chain its own, tell where its rank comes from


def _solids(joints):
    return _chain_of(joints)


def rc(_solids, motions):
    """The rank of the loop equations, after the motions that are told in words."""
    return each_stacked(lambda one: one.rc, _solids)


def rs(n, m):
    return 6 * n - m


def h(m, n, Ns):
    return m - 6 * n + Ns


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
