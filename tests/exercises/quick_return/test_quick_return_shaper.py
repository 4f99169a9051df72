"""Shaper: against fifty digits, over a swept turn, where rod and guide line up, and where nothing swings."""

import mpmath
import numpy as np
import pytest
from swept_turn import TURN, assert_answers, moving, swept, times, turns_back
from tables import each_row

import coursework
from coursework.errors import CannotAssemble, Undefined

EXERCISE = coursework.open_course()["quick_return_shaper"]
PLAIN = {"r1": 250.0, "r2": 110.0, "r4": 450.0, "r5": 200.0, "h": 430.0, "theta2": 25.0, "omega2": 6.0}


def exact(r1, r2, r4, r5, h, theta2, omega2):
    """Fifty digits: C from the circle about P; the velocity by differences; the ends by the tangents from
    O4."""
    with mpmath.workdps(50):
        r1, r2, r4, r5, h, omega2 = map(mpmath.mpf, (r1, r2, r4, r5, h, omega2))
        O2, start = mpmath.mpc(0, r1), mpmath.mpf(theta2) * mpmath.pi / 180

        def ram(A):
            P = r4 * A / abs(A)
            return mpmath.re(P) + mpmath.sqrt(r5**2 - (h - mpmath.im(P)) ** 2)

        def at(time):
            return ram(O2 + r2 * mpmath.expj(start + omega2 * time))

        # Points of contact: on the circle about O2 and on the one whose diameter is O4-O2.
        up = (r1**2 - r2**2) / r1
        across = mpmath.sqrt(up * r1 - up**2)
        right, left = mpmath.mpc(across, up), mpmath.mpc(-across, up)
        arc = mpmath.degrees(abs(mpmath.arg((right - O2) / (left - O2))))
        return {
            **moving(at),
            "stroke": ram(right) - ram(left),
            **times(arc, omega2),
        }


@each_row("seed", range(12))
def test_answers_are_those_of_the_loops_in_fifty_digits(seed):
    assert_answers(EXERCISE.variant(seed), exact)


#: The rod lines up with the guide stretched out, near the right end, or folded back, near the left one.
STRETCHED = {"r1": 100.0, "r2": 60.0, "r4": 200.0, "r5": 100.0, "h": 256.0, "theta2": 90.0, "omega2": 1.0}
FOLDED = {"r1": 100.0, "r2": 80.0, "r4": 100.0, "r5": 260.0, "h": -140.0, "theta2": 90.0, "omega2": 1.0}


@each_row("given", [STRETCHED, FOLDED])
def test_a_rod_in_line_with_the_guide_leaves_a_stroke_and_no_arcs(given):
    found = swept(EXERCISE, given)
    assert turns_back(found) == 4
    plain = 2 * given["r4"] * given["r2"] / given["r1"]
    stroke = EXERCISE.solve(**given, only="stroke")["stroke"]
    assert stroke == pytest.approx(np.ptp(found["xC"]), abs=1e-3)
    assert stroke > plain + 0.1
    for name in ("alpha", "beta", "Q", "t_advance", "t_return"):
        with pytest.raises(Undefined, match="lines up with the guide"):
            EXERCISE.solve(**given, only=name)
    row = EXERCISE.solve(**{**given, "r2": np.array([given["r2"], 20.0]), "h": np.array([given["h"], 180.0])})
    assert np.isfinite(row["stroke"]).all()
    for name in ("alpha", "Q", "t_return"):
        assert np.isnan(row[name]).tolist() == [True, False], name


@pytest.mark.parametrize("step", [37.5, pytest.param(12.5, marks=pytest.mark.slow)])
def test_whether_the_rod_lines_up_is_decided_as_a_swept_turn_shows(step):
    """Lines at many heights, so that the rod meets the guide's direction stretched, folded and not at all."""
    counts = []
    for r5 in (130.0, 200.0, 330.0):
        for h in np.arange(-251.0, 450.0, step):
            given = {"r1": 200.0, "r2": 130.0, "r4": 150.0, "r5": r5, "h": h, "theta2": 10.0, "omega2": 1.0}
            row = {name: np.array([value]) for name, value in given.items()}
            alpha, stroke = (EXERCISE.solve(**row, only=n)[n][0] for n in ("alpha", "stroke"))
            found = swept(EXERCISE, given)
            if np.isnan(found["xC"]).any():
                assert np.isnan(stroke)
                continue
            assert stroke == pytest.approx(np.ptp(found["xC"]), abs=1e-3)
            assert np.isnan(alpha) == (turns_back(found) > 2)
            counts.append(turns_back(found))
    assert counts.count(2) > 250 / step
    assert counts.count(4) > 62 / step


@each_row("change", [{"r2": 1e-9}, {"r2": 250 * (1 - 1e-12), "r5": 500.0, "h": 0.0}])
def test_the_strokes_keep_their_digits_where_the_formulas_lose_them(change):
    """A guide that hardly moves, and one that swings by nearly half a turn."""
    given = {**PLAIN, **change}
    found, reference = EXERCISE.solve(**given, only=("stroke", "sigma", "alpha")), exact(**given)
    assert found["alpha"] == pytest.approx(float(reference["alpha"]), rel=1e-14)
    with mpmath.workdps(50):
        sigma = mpmath.degrees(mpmath.asin(mpmath.mpf(given["r2"]) / given["r1"]))
        assert found["sigma"] == pytest.approx(float(sigma), rel=1e-15)
        assert found["stroke"] == pytest.approx(
            float(2 * mpmath.mpf(given["r4"]) * given["r2"] / given["r1"]), rel=1e-15
        )


def test_the_height_of_the_line_and_the_length_of_the_rod_change_no_stroke():
    heights = EXERCISE.solve(**{**PLAIN, "h": np.array([400.0, 420.0, 450.0])}, only=TURN)
    rods = EXERCISE.solve(**{**PLAIN, "r5": np.array([120.0, 250.0, 900.0])}, only=TURN)
    for name in TURN:
        values = np.concatenate([np.broadcast_to(row[name], 3) for row in (heights, rods)])
        np.testing.assert_array_equal(values, values[0])


def test_without_a_swing_or_a_rod_that_reaches_there_are_no_strokes_while_the_instant_has_its_answers():
    turning, short = {**PLAIN, "r2": 260.0, "theta2": 80.0}, {**PLAIN, "r5": 25.0, "theta2": 80.0}
    for name in TURN:
        with pytest.raises(Undefined, match="guide does not oscillate"):
            EXERCISE.solve(**turning, only=name)
        with pytest.raises(CannotAssemble, match=r"does not reach its line all turn: it is .* mm too short"):
            EXERCISE.solve(**short, only=name)
    for given in (turning, short):
        assert np.isfinite(EXERCISE.solve(**given, only="v_C")["v_C"])
    lengths = {"r2": np.array([260.0, 250.0, 110.0, 110.0]), "r5": np.array([200.0, 200.0, 25.0, 200.0])}
    row = EXERCISE.solve(**{**PLAIN, **lengths}, only=TURN)
    for name, values in row.items():
        assert np.isnan(values).tolist() == [True, True, True, False], name
