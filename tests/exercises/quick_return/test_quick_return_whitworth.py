"""Whitworth's quick return: against fifty digits, over a swept turn, and where the guide does not turn
fully."""

import mpmath
import numpy as np
import pytest
from swept_turn import TURN, assert_answers, moving, swept, times
from tables import each_row

import coursework
from coursework.errors import CannotAssemble, Undefined

EXERCISE = coursework.open_course()["quick_return_whitworth"]
PLAIN = {"r1": 60.0, "r2": 110.0, "r4": 80.0, "r5": 300.0, "h": 50.0, "theta2": 25.0, "omega2": 6.0}


def exact(r1, r2, r4, r5, h, theta2, omega2):
    """Fifty digits: points by intersecting half-lines, circles and the line; the velocity by differences in
    time."""
    with mpmath.workdps(50):
        r1, r2, r4, r5, h, omega2 = map(mpmath.mpf, (r1, r2, r4, r5, h, omega2))
        O2, start = mpmath.mpc(0, r1), mpmath.mpf(theta2) * mpmath.pi / 180

        def right_of(point, length):
            return mpmath.re(point) + mpmath.sqrt(length**2 - (h - mpmath.im(point)) ** 2)

        def ram(time):
            A = O2 + r2 * mpmath.expj(start + omega2 * time)
            return right_of(r4 * A / abs(A), r5)

        def crank_towards(direction):
            """From O2 to the point of the circle of A on a half-line from O4."""
            away = mpmath.re(O2 * mpmath.conj(direction))
            return (away + mpmath.sqrt(away**2 + r2**2 - r1**2)) * direction - O2

        near, far = (mpmath.mpc(right_of(mpmath.mpc(0), length), h) for length in (r5 - r4, r5 + r4))
        apart = mpmath.degrees(mpmath.arg(crank_towards(-near / abs(near)) / crank_towards(far / abs(far))))
        return {
            **moving(ram),
            "stroke": mpmath.re(far - near),
            **times(abs(apart), omega2),
        }


@each_row("seed", range(12))
def test_answers_are_those_of_the_loops_in_fifty_digits(seed):
    assert_answers(EXERCISE.variant(seed), exact)


@each_row("h", [-219.0, -150.0, 150.0, 219.0])
def test_a_line_far_from_the_pivot_may_make_either_arc_the_longer(h):
    """Low enough, the near and the far end are seen from O4 so differently that the arcs change places."""
    given = {**PLAIN, "h": h, "r1": 10.0}
    found, answers = swept(EXERCISE, given), EXERCISE.solve(**given)
    forward = (found["v_C"] > 0).mean() * 360
    assert max(forward, 360 - forward) == pytest.approx(answers["alpha"], abs=0.03)


@each_row("change", [{"r1": 1e-9}, {"r1": 110 * (1 - 1e-12), "h": 0.0}, {"r5": 130 + 1e-11}, {"r4": 1e-7}])
def test_the_strokes_keep_their_digits_where_the_formulas_lose_them(change):
    """A guide that turns evenly or hardly turns fully, a rod nearly too short, a tiny arm."""
    given = {**PLAIN, **change}
    found, reference = EXERCISE.solve(**given, only=TURN), exact(**given)
    for name in ("stroke", "alpha", "t_advance"):
        assert found[name] == pytest.approx(float(reference[name]), rel=1e-14), name
    assert found["beta"] == pytest.approx(float(reference["beta"]), abs=1e-12)


@each_row("theta2", [-90 + 1e-7, -90 - 1e-9, -89.999])
def test_the_guide_keeps_its_digits_where_the_block_passes_its_pivot(theta2):
    given = {**PLAIN, "r1": 110 * (1 - 1e-7), "theta2": theta2}
    assert EXERCISE.solve(**given, only="v_C")["v_C"] == pytest.approx(float(exact(**given)["v_C"]), rel=1e-7)
    assert EXERCISE.solve(**given, only="omega4")["omega4"] > 1000


def test_the_guide_turns_at_the_crank_s_mean_rate():
    """Its rate over a turn, sampled evenly, averages to that of the crank: spectrally exact for a smooth
    period."""
    theta2 = np.arange(720) / 2
    omega4 = EXERCISE.solve(**{**PLAIN, "theta2": theta2}, only="omega4")["omega4"]
    assert omega4.mean() == pytest.approx(6.0, rel=1e-13)
    assert (omega4 > 0).all()


def test_strokes_of_a_line_through_the_pivot_follow_from_the_two_lengths_alone():
    found = EXERCISE.solve(**{**PLAIN, "h": 0.0, "r1": 55.0})
    assert found["alpha"] == pytest.approx(240, rel=1e-15)
    assert found["stroke"] == pytest.approx(160, rel=1e-15)


def test_a_guide_that_oscillates_has_no_such_strokes_while_the_instant_has_its_answers():
    swings, short = {**PLAIN, "r2": 50.0}, {**PLAIN, "r5": 120.0}
    for name in TURN:
        with pytest.raises(Undefined, match="guide does not turn fully"):
            EXERCISE.solve(**swings, only=name)
        with pytest.raises(CannotAssemble, match=r"longer than r4 \+ \|h\| = 130; it is 120 \(gap 10\)"):
            EXERCISE.solve(**short, only=name)
    for given in (swings, short):
        assert np.isfinite(EXERCISE.solve(**given, only="v_C")["v_C"])
    lengths = {"r2": np.array([50.0, 60.0, 110.0, 110.0]), "r5": np.array([300.0, 300.0, 120.0, 300.0])}
    row = EXERCISE.solve(**{**PLAIN, **lengths}, only=(*TURN, "x1", "x2", "phi1", "psi2"))
    for name, values in row.items():
        assert np.isnan(values).tolist() == [True, True, True, False], name


def test_lines_through_the_pivot_above_and_below_are_all_issued():
    h = np.array([v.given["h"] for v in EXERCISE.variants(range(300))])
    assert 0.3 < (h == 0).mean() < 0.7
    assert (h > 0).sum() > 30
    assert (h < 0).sum() > 30
