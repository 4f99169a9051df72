"""Grashof's rule: sums, types drawn, what is refused."""

import numpy as np
import pytest
from tables import each_row

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


@each_row(
    ("bars", "kind"),
    [
        ((100.0, 50.0, 70.0, 80.0), "change-point"),
        ((100.00000000000001, 50.0, 70.0, 80.0), "triple-rocker"),
        ((99.99999999999999, 50.0, 70.0, 80.0), "crank-rocker"),
        ((100.0, 50.0, 70.0, 80.00000000000001), "crank-rocker"),
        # 0.1 + 0.6 is 0.3 + 0.4, whatever their doubles are; a last digit more, and it is not.
        ((0.3, 0.1, 0.4, 0.6), "change-point"),
        ((0.3, 0.1, 0.4, 0.6000000000000001), "triple-rocker"),
        ((0.3, 0.1, 0.4, 0.5999999999999999), "crank-rocker"),
        ((0.1234567, 0.0234567, 0.1, 0.2), "change-point"),
        ((0.6, 0.1, 0.2, 0.3), "impossible"),
        ((0.6, 0.1, 0.2, 0.30000000000000004), "triple-rocker"),
        ((1e-20, 1e15, 1e15, 1e-20), "change-point"),
        ((2e-20, 1e15, 1e15, 1e-20), "rocker-crank"),
    ],
)
def test_the_last_digit_decides(bars, kind):
    given = dict(zip(("r1", "r2", "r3", "r4"), bars, strict=True))
    assert EXERCISE.solve(**given, only="linkage_type")["linkage_type"] == kind
    positions = coursework.open_course()["four_bar_positions"]
    assert positions.solve(**given, only="linkage_type")["linkage_type"] == kind
    row = {
        name: np.array([value, other])
        for (name, value), other in zip(given.items(), (40, 90, 80, 100), strict=True)
    }
    assert EXERCISE.solve(**row, only="linkage_type")["linkage_type"].tolist() == [kind, "double-crank"]
