"""Offset slider-crank: against fifty digits, over a swept turn, and where a crank does not turn fully."""

import mpmath
import numpy as np
import pytest
from swept_turn import TURN, assert_answers, times
from tables import each_row

import coursework
from coursework.errors import CannotAssemble

EXERCISE = coursework.open_course()["quick_return_offset"]
PLAIN = {"r2": 50.0, "r3": 140.0, "e": 35.0, "theta2": 40.0, "omega2": 6.0}


def exact(r2, r3, e, theta2, omega2):
    """Fifty digits: the piston on its line by |AC| = r3, its velocity by A's rigid rod, dead centres on
    circles."""
    with mpmath.workdps(50):
        r2, r3, e, omega2 = map(mpmath.mpf, (r2, r3, e, omega2))
        A = r2 * mpmath.expjpi(mpmath.mpf(theta2) / 180)

        def right_of(point, length):
            return mpmath.re(point) + mpmath.sqrt(length**2 - (e - mpmath.im(point)) ** 2) + 1j * e

        C = right_of(A, r3)
        # Rigid rod: both ends have the same velocity along it.
        along, v_A = C - A, 1j * omega2 * A
        v_C = mpmath.re(v_A * mpmath.conj(along)) / mpmath.re(along)
        # Along the rod, C accelerates as A does, but for what turns towards A.
        a_A = -(omega2**2) * A
        a_C = (mpmath.re(a_A * mpmath.conj(along)) - abs(v_C - v_A) ** 2) / mpmath.re(along)
        near, far = right_of(mpmath.mpc(0), r3 - r2), right_of(mpmath.mpc(0), r3 + r2)
        # The crank points to the far end, and away from the near one.
        arc = mpmath.degrees(abs(mpmath.arg(far / -near)))
        return {
            "xC": mpmath.re(C),
            "v_C": v_C,
            "a_C": a_C,
            "stroke": mpmath.re(far - near),
            **times(arc, omega2),
        }


@each_row("seed", range(12))
def test_answers_are_those_of_the_loop_in_fifty_digits(seed):
    assert_answers(EXERCISE.variant(seed), exact, 1e-13)


@each_row("change", [{"e": 1e-9}, {"r2": 1e-6}, {"r3": 85.0 + 1e-12}, {"e": -90 * (1 - 1e-13)}, {"r3": 1e6}])
def test_the_strokes_keep_their_digits_where_the_formulas_lose_them(change):
    """A piston nearly in line, a tiny crank, a rod nearly square to its line: stroke and asymmetry both."""
    given = {**PLAIN, **change}
    found, reference = EXERCISE.solve(**given, only=TURN), exact(**given)
    for name in TURN:
        assert found[name] == pytest.approx(float(reference[name]), rel=1e-14), name


def test_the_side_of_the_line_and_the_sense_of_rotation_change_no_duration():
    here = EXERCISE.solve(**PLAIN)
    for change in ({"e": -35.0}, {"omega2": -6.0}):
        there = EXERCISE.solve(**{**PLAIN, **change})
        assert {n: there[n] for n in TURN} == {n: here[n] for n in TURN}
    mirrored = EXERCISE.solve(**{**PLAIN, "e": -35.0, "theta2": -40.0, "omega2": -6.0})
    assert mirrored == pytest.approx(here, rel=1e-14)


def test_the_piston_rests_at_both_ends_of_its_stroke():
    ends = EXERCISE.solve(**PLAIN, only=("x1", "x2"))
    for name, beyond in (("x1", 180.0), ("x2", 0.0)):
        towards = np.degrees(np.arctan2(PLAIN["e"], ends[name])) + beyond
        there = EXERCISE.solve(**{**PLAIN, "theta2": towards}, only=("xC", "v_C"))
        assert there["xC"] == pytest.approx(ends[name], rel=1e-13)
        assert there["v_C"] == pytest.approx(0, abs=1e-11)


def test_a_crank_that_does_not_turn_has_no_strokes_while_the_instant_has_its_answers():
    short = {**PLAIN, "r3": 80.0}
    for name in TURN:
        with pytest.raises(CannotAssemble, match=r"longer than r2 \+ \|e\| = 85; it is 80 \(gap 5\)"):
            EXERCISE.solve(**short, only=name)
    assert np.isfinite(EXERCISE.solve(**short, only="v_C")["v_C"])
    with pytest.raises(CannotAssemble, match="rod reaches only"):
        EXERCISE.solve(**{**short, "theta2": -90}, only="xC")
    # A rod much shorter than the crank has no position in line either, though the squares would have roots.
    row = EXERCISE.solve(**{**PLAIN, "r3": np.array([80.0, 10.0, 140.0])}, only=(*TURN, "x1", "phi1"))
    for name, values in row.items():
        assert np.isnan(values).tolist() == [True, True, False], name


def test_the_sign_of_the_notes_sends_the_piston_the_other_way():
    for variant in EXERCISE.variants(range(20)):
        mark = variant.grade({"v_C": -variant.solution()["v_C"]})["v_C"]
        assert "velocity_sign" in mark.mistakes


def test_lines_above_and_below_the_pivot_are_both_issued():
    above = [v.given["e"] > 0 for v in EXERCISE.variants(range(300))]
    assert 0.35 < np.mean(above) < 0.65
