"""Grashof's rule: solution. The extreme bars against the two others, then the place of the shortest."""

import numpy as np

from coursework.solution import explained_after, given, mistake
from coursework.structure import grashof

UNITS = {"s": "mm", "l": "mm"}


def s(r1, r2, r3, r4):
    """The shortest bar."""
    return grashof.shortest(r1, r2, r3, r4)


def l(r1, r2, r3, r4):  # noqa: E743
    """The longest bar."""
    return grashof.longest(r1, r2, r3, r4)


def s_plus_l(s, l):
    return s + l


def p_plus_q(r1, r2, r3, r4, s_plus_l):
    return r1 + r2 + r3 + r4 - s_plus_l


@explained_after("s_plus_l", "p_plus_q")
def linkage_type(r1, r2, r3, r4):
    """Can the bars close at all; does s + l reach p + q; and if not, which bar is the shortest?"""
    return grashof.linkage_type(r1, r2, r3, r4)


@mistake("s_plus_l", "p_plus_q", "linkage_type")
def fixed_plus_input(r1, r2, r3, r4):
    """The sums taken by place, not by length."""
    one, other = r1 + r2, r3 + r4
    kind = np.select(
        [one == other, one > other],
        ["change-point", "triple-rocker"],
        grashof.type_by_shortest(r1, r2, r3, r4),
    )
    return one, other, kind


@mistake("s_plus_l")
def two_shortest(r1, r2, r3, r4):
    return np.sort(np.stack(np.broadcast_arrays(r1, r2, r3, r4), axis=-1), axis=-1)[..., :2].sum(axis=-1)


@mistake("linkage_type")
def frame_and_coupler_exchanged(linkage_type):
    return _exchanged(linkage_type, "double-crank", "double-rocker")


@mistake("linkage_type", kind="exchanged")
def input_and_output_exchanged(linkage_type):
    return _exchanged(linkage_type, "crank-rocker", "rocker-crank")


def _exchanged(kind, one, other):
    return np.where(kind == one, other, np.where(kind == other, one, kind))


@mistake("linkage_type")
def always_crank_rocker(linkage_type):
    named = ("rocker-crank", "double-crank", "double-rocker")
    return np.where(np.isin(linkage_type, named), "crank-rocker", linkage_type)


@mistake("linkage_type")
def rule_reversed(r1, r2, r3, r4, linkage_type):
    """A triple rocker for every linkage that keeps the rule, and a type by the shortest bar for one that does
    not."""
    by_shortest = grashof.type_by_shortest(r1, r2, r3, r4)
    kept = np.isin(linkage_type, ("triple-rocker", "change-point", "impossible"))
    found = np.where(linkage_type == "triple-rocker", by_shortest, linkage_type)
    return np.where(kept, found, "triple-rocker")


@mistake("linkage_type")
def equality_as_grashof(r1, r2, r3, r4, linkage_type):
    by_shortest = grashof.type_by_shortest(r1, r2, r3, r4)
    return np.where(linkage_type == "change-point", by_shortest, linkage_type)


@mistake("linkage_type")
def impossible_as_triple_rocker(linkage_type):
    return np.where(linkage_type == "impossible", "triple-rocker", linkage_type)


def residual(r1, r2, r3, r4, s_plus_l, p_plus_q, linkage_type):
    """The two sums against the bars in order; the type against the full turns at each end of the frame.

    A bar next to another turns fully about it when the two others reach across both when it lies along that
    bar and when it lies against it.
    """
    ordered = np.sort(np.stack(np.broadcast_arrays(r1, r2, r3, r4), axis=-1), axis=-1)
    total = ordered.sum(axis=-1)

    def turns(bar, beside, one, other):
        return (bar + beside < one + other) & (abs(bar - beside) > abs(one - other))

    shut = total <= 2 * ordered[..., 3]
    flat = ordered[..., 0] + ordered[..., 3] == ordered[..., 1] + ordered[..., 2]
    given_in, given_out = turns(r2, r1, r3, r4), turns(r4, r1, r3, r2)
    expected = np.select(
        [shut, flat, given_in & given_out, given_in, given_out, turns(r2, r3, r1, r4)],
        ["impossible", "change-point", "double-crank", "crank-rocker", "rocker-crank", "double-rocker"],
        "triple-rocker",
    )
    return (
        abs(s_plus_l - ordered[..., 0] - ordered[..., 3]) / total,
        abs(p_plus_q - ordered[..., 1] - ordered[..., 2]) / total,
        np.where(expected == linkage_type, 0.0, 1.0),
    )


KNOWN = (
    # The shortest bar beside the frame, on the other side, as the frame, opposite to it.
    given(r1=100, r2=40, r3=90, r4=80).gives(s_plus_l=140, p_plus_q=170, linkage_type="crank-rocker"),
    given(r1=100, r2=90, r3=80, r4=40).gives(linkage_type="rocker-crank"),
    given(r1=40, r2=90, r3=80, r4=100).gives(linkage_type="double-crank"),
    given(r1=100, r2=90, r3=40, r4=80).gives(linkage_type="double-rocker"),
    given(r1=100, r2=50, r3=60, r4=70).gives(s_plus_l=150, p_plus_q=130, linkage_type="triple-rocker"),
    # A parallelogram, a kite, and an equality that doubles miss: 0.1 + 0.6 = 0.3 + 0.4.
    given(r1=90, r2=50, r3=90, r4=50).gives(s_plus_l=140, linkage_type="change-point"),
    given(r1=90, r2=90, r3=50, r4=50).gives(linkage_type="change-point"),
    given(r1=0.3, r2=0.1, r3=0.4, r4=0.6).gives(linkage_type="change-point"),
    # A bar as long as the three others together, or longer.
    given(r1=200, r2=60, r3=60, r4=80).gives(linkage_type="impossible"),
    given(r1=40, r2=250, r3=60, r4=80).gives(p_plus_q=140, linkage_type="impossible"),
    given(r1=0.6, r2=0.1, r3=0.2, r4=0.3).gives(linkage_type="impossible"),
)
