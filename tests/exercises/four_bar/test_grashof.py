"""Grashof's rule: sums, types drawn, what is refused."""

import numpy as np
import pytest

import coursework
from coursework.errors import WrongValue
from coursework.structure.grashof import TYPES

EXERCISE = coursework.open_course()["grashof"]


def test_every_type_is_handed_out_and_none_is_most_of_them():
    kinds = [v.solution()["linkage_type"] for v in EXERCISE.variants(range(400))]
    shares = {kind: kinds.count(kind) / len(kinds) for kind in TYPES}
    assert min(shares.values()) > 0
    assert max(shares.values()) < 0.35


def test_sums_are_those_of_the_ordered_bars():
    for variant in EXERCISE.variants(range(50)):
        s, p, q, l = sorted(variant.given.values())
        found = variant.solution()
        assert (found["s_plus_l"], found["p_plus_q"]) == (s + l, p + q)


def test_type_agrees_with_the_exercise_on_positions():
    positions = coursework.open_course()["four_bar_positions"]
    for variant in EXERCISE.variants(range(100)):
        there = positions.solve(**variant.given, only="linkage_type")
        assert there["linkage_type"] == variant.solution()["linkage_type"]


def test_lengths_in_other_units_and_in_arrays():
    kind = EXERCISE.solve(r1="9 cm", r2="0.05 m", r3=90, r4="50 mm")["linkage_type"]
    assert kind == "change-point"
    column = EXERCISE.solve(r1=np.array([0.3, 0.6]), r2=0.1, r3=np.array([0.4, 0.2]), r4=np.array([0.6, 0.3]))
    assert column["linkage_type"].tolist() == ["change-point", "impossible"]


def test_a_bar_has_a_length():
    with pytest.raises(WrongValue, match="positive"):
        EXERCISE.solve(r1=100, r2=0, r3=50, r4=60)
