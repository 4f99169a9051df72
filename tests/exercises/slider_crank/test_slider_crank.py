"""Slider-crank: against fifty digits, on paper, next to where it stands upright, and against the notes."""

import mpmath
import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.errors import CannotAssemble

EXERCISE = coursework.open_course()["slider_crank"]
MOTION = ("theta3", "r1", "omega3", "r1_dot", "alpha3", "r1_ddot")
DRAWN = ("pv_a", "pv_b", "ab", "pa_a", "ab_n", "bb_t", "pa_b")
PLAIN = {"r2": 40.0, "r3": 130.0, "e": 10.0, "theta2": 50.0, "omega2": 12.0, "alpha2": 30.0}


def exact(r2, r3, e, theta2, omega2, alpha2, kv=1.0, ka=1.0):
    """Fifty digits: the positions, and their derivatives by differences in time of a wide stencil."""
    with mpmath.workdps(50):
        r2, r3, e, omega2, alpha2, kv, ka = map(mpmath.mpf, (r2, r3, e, omega2, alpha2, kv, ka))
        start = mpmath.radians(mpmath.mpf(theta2))

        def pose(time):
            A = r2 * mpmath.expj(start + omega2 * time + alpha2 * time**2 / 2)
            rise = e - mpmath.im(A)
            return A, mpmath.asin(rise / r3), mpmath.re(A) + mpmath.sqrt(r3**2 - rise**2)

        h = mpmath.mpf("1e-12") / (abs(omega2) + 1)
        before, now, after = pose(-h), pose(mpmath.mpf(0)), pose(h)
        rates = [(x - y) / (2 * h) for x, y in zip(after, before, strict=True)]
        accelerations = [(x - 2 * m + y) / h**2 for x, m, y in zip(after, now, before, strict=True)]
        v_A, omega3, r1_dot = rates
        a_A, alpha3, r1_ddot = accelerations
        along = mpmath.expj(now[1])
        # What turning adds to B relative to A, split along the rod and across it.
        v_BA, a_BA = r1_dot - v_A, r1_ddot - a_A
        return {
            "theta3": mpmath.degrees(now[1]),
            "r1": now[2],
            "omega3": omega3,
            "r1_dot": r1_dot,
            "alpha3": alpha3,
            "r1_ddot": r1_ddot,
            "pv_a": abs(v_A) / kv,
            "pv_b": abs(r1_dot) / kv,
            "ab": abs(v_BA) / kv,
            "pa_a": abs(a_A) / ka,
            "ab_n": abs(mpmath.re(a_BA / along)) / ka,
            "bb_t": abs(mpmath.im(a_BA / along)) / ka,
            "pa_b": abs(r1_ddot) / ka,
        }


@each_row("seed", range(10))
def test_answers_are_those_of_the_loop_equations_in_fifty_digits(seed):
    variant = EXERCISE.variant(seed)
    answers, reference = variant.solution(), exact(**variant.given)
    assert set(answers) == set(reference)
    for name, value in reference.items():
        assert abs(float(answers[name] - value)) < 1e-12 * abs(value), name


@each_row("change", [{}, {"alpha2": -400.0}, {"omega2": 0.0}, {"e": -35.0}, {"theta2": -120.0}])
def test_an_accelerated_crank_moves_rod_and_piston_as_its_positions_do(change):
    answers = EXERCISE.solve(**{**PLAIN, **change}, only=MOTION)
    reference = exact(**{**PLAIN, **change})
    for name in MOTION:
        scale = max(abs(reference[name]), mpmath.mpf("1e-6"))
        assert abs(float(answers[name] - reference[name])) < 1e-12 * scale, name


@each_row("theta2", [90 - 1e-9, 90 - 1e-6, 90 + 1e-7, -90 + 1e-8, 89.0])
def test_a_rod_as_long_as_the_crank_keeps_its_digits_where_it_stands_upright(theta2):
    """The triangle is isosceles, r1 = 2 r2 cos theta2 up to 90 degrees, 0 beyond: all digits of a tiny r1."""
    found = EXERCISE.solve(r2=100, r3=100, theta2=theta2, omega2=1, only=("r1", "q"))
    with mpmath.workdps(50):
        expected = 100 * mpmath.cos(mpmath.radians(mpmath.mpf(theta2)))
    assert found["q"] == pytest.approx(float(abs(expected)), rel=1e-14)
    assert found["r1"] == pytest.approx(float(expected + abs(expected)), rel=1e-14)


def test_mirror_image_in_the_x_axis_turns_the_rod_and_keeps_the_piston():
    here = EXERCISE.solve(**PLAIN, only=MOTION)
    mirrored = {n: -v if n in ("e", "theta2", "omega2", "alpha2") else v for n, v in PLAIN.items()}
    there = EXERCISE.solve(**mirrored, only=MOTION)
    for name, value in here.items():
        assert there[name] == pytest.approx(-value if name[-1] == "3" else value, rel=1e-13), name


def test_the_drawing_closes():
    """With sides as arrows in the directions the drawing prescribes, both polygons end on the guide."""
    for variant in EXERCISE.variants(range(50)):
        given, found = variant.given, variant.solution()
        crank = np.exp(1j * np.radians(given["theta2"]))
        rod = np.exp(1j * np.radians(found["theta3"]))
        b = 1j * crank * found["pv_a"] * np.sign(given["omega2"])
        b += 1j * rod * found["ab"] * np.sign(found["omega3"])
        assert b == pytest.approx(found["pv_b"] * np.sign(found["r1_dot"]), abs=1e-11)
        b = -crank * found["pa_a"] - rod * found["ab_n"] + 1j * rod * found["bb_t"] * np.sign(found["alpha3"])
        assert b == pytest.approx(found["pa_b"] * np.sign(found["r1_ddot"]), abs=1e-11)


def test_the_drawing_fits_on_a_sheet_and_can_be_read():
    for variant in EXERCISE.variants(range(300)):
        found = variant.solution()
        assert 40 <= found["pv_a"] <= 100
        assert 40 <= found["pa_a"] <= 100
        assert max(found[name] for name in DRAWN) < 150
        for scale in (variant.given["kv"], variant.given["ka"]):
            assert f"{scale:.0e}"[0] in "125"
            assert float(f"{scale:.0e}") == scale


def test_the_drawing_is_asked_of_a_crank_at_constant_rate_only():
    given = {**PLAIN, "kv": 10.0, "ka": 100.0}
    assert set(EXERCISE.solve(**given)) == set(MOTION)
    assert set(EXERCISE.solve(**{**given, "alpha2": 0.0})) == {*MOTION, *DRAWN}
    assert EXERCISE.solve(**{**given, "kv": 5.0}, only=("pv_b",)) == {
        "pv_b": pytest.approx(abs(EXERCISE.solve(**PLAIN, only="r1_dot")["r1_dot"]) / 5)
    }


@each_row("gap", ["1e-2", "1e-4", "1e-6", "1e-8"])
def test_accelerations_of_a_rod_as_long_as_its_crank_keep_their_digits(gap):
    """x = 2 r cos theta there: the rod is the crank's mirror image, and its acceleration that of the
    crank."""
    theta = float(90 - mpmath.mpf(gap))
    found = EXERCISE.solve(r2=70, r3=70, e=0, theta2=theta, omega2=10, alpha2=3, only=("alpha3", "r1_ddot"))
    with mpmath.workdps(50):
        at = mpmath.radians(mpmath.mpf(theta))
        expected = -140 * (3 * mpmath.sin(at) + 100 * mpmath.cos(at))
    assert found["r1_ddot"] == pytest.approx(float(expected), rel=1e-12)
    assert found["alpha3"] == pytest.approx(-3, rel=1e-9)


def test_centred_and_offset_cranks_are_both_issued():
    offsets = np.array([v.given["e"] / v.given["r2"] for v in EXERCISE.variants(range(400))])
    assert 0.4 < (offsets == 0).mean() < 0.75
    assert (offsets > 0.1).sum() > 40
    assert (offsets < -0.1).sum() > 40


def test_a_rod_that_does_not_reach_its_line_is_said_with_the_gap():
    with pytest.raises(CannotAssemble, match=r"40 away from the crank pin.*only 30 \(gap 10\)"):
        EXERCISE.solve(r2=40, r3=30, theta2=90, omega2=1, only="omega3")
    row = EXERCISE.solve(r2=40, r3=30, theta2=np.array([90.0, 20.0]), omega2=1, only=("theta3", "r1_ddot"))
    for values in row.values():
        assert np.isnan(values).tolist() == [True, False]


def test_misprint_of_the_notes_turns_the_piston_round():
    """Upright crank, anticlockwise: the piston goes left at the speed of A; the printed formula sends it
    right."""
    given = {"r2": 30.0, "r3": 50.0, "e": 0.0, "theta2": 90.0, "omega2": 8.0, "alpha2": 0.0}
    wrong = EXERCISE.solution.mistaken("notes_piston_sign").evaluate(("r1_dot",), given)["r1_dot"]
    assert EXERCISE.solve(**given, only="r1_dot")["r1_dot"] == -240
    assert wrong == pytest.approx(240)
    for variant in EXERCISE.variants(range(30)):
        mark = variant.grade({"r1_dot": -variant.solution()["r1_dot"]})["r1_dot"]
        assert "notes_piston_sign" in mark.mistakes
