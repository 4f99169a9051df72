"""Counts on a chain of solids, in space or in the plane, and the rank of its loop equations.

A solution that takes these has the hidden ``_solids``: the chain, or an array of chains.
"""

from coursework.quantities.columns import each_stacked


def n(_solids):
    """Moving bodies."""
    return each_stacked(lambda one: one.n, _solids)


def gamma(_solids):
    return each_stacked(lambda one: one.gamma, _solids)


def Nc(_solids):
    return each_stacked(lambda one: one.Nc, _solids)


def rc(_solids):
    """The rank of the loop equations."""
    return each_stacked(lambda one: one.rc, _solids)


def m(Nc, rc):
    return Nc - rc


def Ns(_solids):
    return each_stacked(lambda one: one.Ns, _solids)


def i(m, h):
    return m - h
