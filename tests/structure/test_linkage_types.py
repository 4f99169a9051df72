"""Grashof types against the motion of the linkage itself, in fractions."""

from __future__ import annotations

from fractions import Fraction
from itertools import product

import numpy as np

from coursework.structure.grashof import TYPES, linkage_type


def by_motion(*printed):
    """From who can turn fully about whom, in exact fractions of the printed decimals."""
    r1, r2, r3, r4 = (Fraction(str(r)) for r in printed)
    s, p, q, l = sorted((r1, r2, r3, r4))
    if l >= s + p + q:
        return "impossible"

    def turns(bar, beside, one, other):
        """Both aligned positions of two neighbours close with the two others."""
        return bar + beside < one + other and abs(bar - beside) > abs(one - other)

    def limit(bar, beside, one, other):
        return bar + beside == one + other or abs(bar - beside) == abs(one - other)

    quarters = ((r2, r1, r3, r4), (r4, r1, r3, r2), (r2, r3, r1, r4))
    if any(limit(*quarter) for quarter in quarters):
        return "change-point"
    given_in, given_out, inside = (turns(*quarter) for quarter in quarters)
    if given_in and given_out:
        return "double-crank"
    if given_in or given_out:
        return "crank-rocker" if given_in else "rocker-crank"
    return "double-rocker" if inside else "triple-rocker"


def test_types_are_those_of_the_motion_on_every_small_linkage():
    met = set()
    for lengths in product(range(1, 8), repeat=4):
        kind = str(linkage_type(*map(float, lengths)))
        assert kind == by_motion(*lengths), lengths
        met.add(kind)
    assert met == set(TYPES)


def test_decimals_that_doubles_miss_are_decided_as_printed():
    tenths = np.array(list(product([0.1, 0.2, 0.3, 0.4, 0.6, 0.7, 1.1], repeat=4)))
    kinds = linkage_type(*tenths.T)
    assert kinds.tolist() == [by_motion(*row) for row in tenths.tolist()]
    # Without that care some would come out otherwise.
    plain = np.sort(tenths, axis=1) @ [1, -1, -1, 1] == 0
    assert np.any(plain != (kinds == "change-point"))


def test_scale_does_not_matter():
    for scale in (1e-6, 1e6):
        for lengths in ((100, 40, 80, 70), (90, 50, 90, 50), (200, 60, 60, 80), (100, 50, 60, 70)):
            assert linkage_type(*(float(f"{x * scale:.12g}") for x in lengths)) == linkage_type(*lengths)
