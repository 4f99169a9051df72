"""Quick return: against fifty digits and the loop equations, over the turn, and where nothing exists."""

import mpmath
import numpy as np
import pytest
from swept_turn import times
from tables import each_row

import coursework
from coursework.course import draws
from coursework.errors import CannotAssemble, Undefined
from coursework.kinematics.dyads import rrr

EXERCISE = coursework.open_course()["quick_return"]
LINKAGE = ("r1", "theta1", "r2", "r3", "r4", "r5", "h", "omega2")
#: A crank-rocker whose rod stays clear of the rocker's direction.
PLAIN = {
    "r1": 200.0,
    "theta1": 0.0,
    "r2": 60.0,
    "r3": 180.0,
    "r4": 160.0,
    "r5": 400.0,
    "h": 100.0,
    "omega2": 9.42,
    "angle_OAB": 110.0,
    "B_side": "left",
    "A_side": "left",
}


def exact(given):
    """All asked quantities in fifty digits, the rates by solving the differentiated loops."""
    with mpmath.workdps(50):
        r1, theta1, r2, r3, r4, r5, h, w2 = (mpmath.mpf(given[n]) for n in LINKAGE)
        corner = mpmath.mpf(given["angle_OAB"])
        B_left = 1 if given["B_side"] == "left" else -1
        A_left = 1 if given["A_side"] == "left" else -1
        D = r1 * mpmath.expjpi(theta1 / 180)

        def opposite(x, y, z):
            return mpmath.acos((x**2 + y**2 - z**2) / (2 * x * y))

        def place(OB):
            """B and C for a distance OB."""
            B = OB * mpmath.expj(mpmath.arg(D) + B_left * opposite(r1, OB, r4))
            return B, mpmath.re(B) + mpmath.sqrt(r5**2 - (h - mpmath.im(B)) ** 2) + 1j * h

        OB = abs(r2 - r3 * mpmath.expjpi(corner / 180))
        B, C = place(OB)
        A = r2 * mpmath.expj(mpmath.arg(B) + A_left * opposite(r2, OB, r3))
        assert abs(abs(B - A) - r3) + abs(abs(B - D) - r4) + abs(abs(C - B) - r5) < mpmath.mpf("1e-44")
        assert abs(mpmath.re((-A / (B - A)) / abs(A / (B - A))) - mpmath.cospi(corner / 180)) < mpmath.mpf(
            "1e-45"
        )
        bars = (B - A, -(B - D), mpmath.mpf(0)), (mpmath.mpf(0), B - D, C - B)

        def rates(first, second):
            """Solve for the three bars and the piston: first + bars = 0, second + bars - piston = 0."""
            rows, right = [], []
            for loop, known, piston in zip(bars, (first, second), (0, -1), strict=True):
                rows.append([mpmath.re(1j * bar) for bar in loop] + [piston])
                rows.append([mpmath.im(1j * bar) for bar in loop] + [0])
                right += [-mpmath.re(known), -mpmath.im(known)]
            return list(mpmath.lu_solve(mpmath.matrix(rows), mpmath.matrix(right)))

        w3, w4, w5, v = rates(1j * w2 * A, 0)
        along = w3**2 * (B - A) - w4**2 * (B - D)
        acceleration = rates(-(w2**2) * A - along, -(w4**2) * (B - D) - w5**2 * (C - B))[3]
        far, near = place(r3 + r2), place(r3 - r2)
        # The crank points along OB when stretched out, the other way when folded back.
        arc = mpmath.degrees(abs(mpmath.arg(far[0] / -near[0])))
        return {
            "theta2": mpmath.degrees(mpmath.arg(A)),
            "theta3": mpmath.degrees(mpmath.arg(B - A)),
            "theta4": mpmath.degrees(mpmath.arg(B - D)),
            "theta5": mpmath.degrees(mpmath.arg(C - B)),
            "xC": mpmath.re(C),
            "omega3": w3,
            "omega4": w4,
            "omega5": w5,
            "v_C": v,
            "a_C": acceleration,
            "stroke": abs(mpmath.re(far[1] - near[1])),
            **times(arc, w2),
            "T": 2 * mpmath.pi / w2,
            "mechanical_advantage": abs(r2 * w2 / v),
        }


@each_row("seed", range(10))
def test_answers_are_those_of_the_loop_equations_in_fifty_digits(seed):
    variant = EXERCISE.variant(seed)
    answers, reference = variant.solution(), exact(variant.given)
    assert set(answers) == set(reference)
    for name, value in reference.items():
        scale = 180 if name.startswith("theta") else abs(value)
        assert abs(float(answers[name] - value)) / scale < 2e-12, name


def sweep(given, count=20_000):
    """xC over a turn, by plain steps of the crank."""
    side = 1 if EXERCISE.solve(**given, only="mode")["mode"] == "open" else -1
    frame = given["r1"] * np.exp(1j * np.radians(given["theta1"]))
    crank = given["r2"] * np.exp(2j * np.pi * np.arange(count) / count)
    B = rrr(crank, frame, given["r3"], given["r4"], side)
    rise = given["h"] - B.imag
    return B.real + np.sqrt(given["r5"] ** 2 - rise**2), rise / given["r5"]


@each_row("seed", range(20))
def test_stroke_and_arcs_are_those_of_a_swept_turn(seed):
    given = dict(EXERCISE.variant(seed).given)
    position, slope = sweep(given)
    answers = EXERCISE.solve(**given)
    assert np.ptp(position) == pytest.approx(answers["stroke"], abs=1e-4)
    between = abs(int(position.argmax()) - int(position.argmin())) * 360 / len(position)
    assert max(between, 360 - between) == pytest.approx(answers["alpha"], abs=0.1)
    moving = np.sign(np.diff(np.append(position, position[0])))
    assert (moving != np.roll(moving, 1)).sum() == 2
    assert abs(slope).max() < np.sin(np.radians(50))


def test_closed_form_conditions_are_those_of_a_swept_turn():
    """Over raw candidates, turned and moved every way, so that the rod meets the rocker from all sides."""
    words = np.concatenate(
        [draws._words("quick_return", 1, s, 0, len(EXERCISE.spec.given)) for s in range(60)]
    )
    drawn = EXERCISE.draws.candidates(words)
    number = np.arange(len(words))
    drawn |= {"theta1": number * 37.0 % 360 - 180, "h": number * 53.0 % 1000 - 500}
    refused = EXERCISE.draws.refused(drawn)
    turns = ~refused["crank_turns"] & ~refused["transmission_angle_from_30_to_150"]
    counts = []
    for i in np.flatnonzero(turns):
        given = {name: values[i].item() for name, values in drawn.items()}
        with np.errstate(invalid="ignore"):
            position, slope = sweep(given, 1440)
        steepest = abs(slope).max()
        if abs(steepest - np.sin(np.radians(50))) > 1e-3:
            assert refused["rod_stays_flat"][i] == (steepest > np.sin(np.radians(50)))
        if np.isfinite(position).all():
            moving = np.sign(np.diff(np.append(position, position[0])))
            counts.append(((moving != np.roll(moving, 1)).sum(), bool(refused["two_turning_points"][i])))
    assert all(count == 2 for count, is_refused in counts if not is_refused)
    assert sum(count == 2 for count, _ in counts) > 50
    assert sum(count == 4 for count, _ in counts) > 50


def test_the_mirror_image_in_the_x_axis_has_mirrored_answers():
    mirrored = {**PLAIN, "theta1": -20.0, "h": -100.0, "omega2": -9.42, "B_side": "right", "A_side": "right"}
    here, there = EXERCISE.solve(**{**PLAIN, "theta1": 20.0}), EXERCISE.solve(**mirrored)
    for name, value in here.items():
        turned = -1 if name.startswith(("theta", "omega")) else 1
        assert there[name] == pytest.approx(turned * value, rel=1e-12), name


def test_piston_and_rocker_rest_when_crank_and_coupler_are_in_line():
    for angle_OAB in (0.0, 180.0):
        answers = EXERCISE.solve(
            **{**PLAIN, "angle_OAB": angle_OAB}, only=("omega4", "v_C", "theta2", "theta3")
        )
        assert answers["omega4"] == pytest.approx(0, abs=1e-12)
        assert answers["v_C"] == pytest.approx(0, abs=1e-9)


def test_sides_place_a_and_b_as_told():
    for B_side in ("left", "right"):
        for A_side in ("left", "right"):
            got = EXERCISE.solve(
                **{**PLAIN, "h": 0.0, "B_side": B_side, "A_side": A_side}, only=("theta2", "theta4", "phi")
            )
            assert (np.sin(np.radians(got["theta4"])) > 0) == (B_side == "left")
            assert (np.sin(np.radians(got["theta2"] - got["phi"])) > 0) == (A_side == "left")


#: h so low that the rod folds back along the rocker inside its swing.
LINED_UP = {**PLAIN, "h": -208.0}


def test_a_rod_in_line_with_the_rocker_leaves_a_stroke_and_no_arcs():
    position, _ = sweep(LINED_UP)
    assert EXERCISE.solve(**LINED_UP, only="stroke")["stroke"] == pytest.approx(np.ptp(position), abs=1e-4)
    for name in ("alpha", "beta", "Q", "t_return"):
        with pytest.raises(Undefined, match="turns back 4 times"):
            EXERCISE.solve(**LINED_UP, only=name)
    row = {**LINED_UP, "h": np.array([LINED_UP["h"], PLAIN["h"]])}
    got = EXERCISE.solve(**row, only=("stroke", "alpha", "Q", "t_advance"))
    assert np.isfinite(got["stroke"]).all()
    for name in ("alpha", "Q", "t_advance"):
        assert np.isnan(got[name]).tolist() == [True, False], name


def test_a_turn_that_does_not_exist_has_no_stroke_while_the_instant_has_its_answers():
    short = {**PLAIN, "r5": 40.0, "h": 20.0, "angle_OAB": 170.0}
    long_crank = {**PLAIN, "r2": 150.0}
    with pytest.raises(CannotAssemble, match="rod"):
        EXERCISE.solve(**{**PLAIN, "r5": 50.0}, only="stroke")
    with pytest.raises(CannotAssemble, match="crank does not turn fully"):
        EXERCISE.solve(**long_crank, only="alpha")
    assert np.isfinite(EXERCISE.solve(**long_crank, only="theta2")["theta2"])
    with pytest.raises(CannotAssemble, match="rod does not reach"):
        EXERCISE.solve(**short, only="xC")
    row = EXERCISE.solve(**{**PLAIN, "r2": np.array([150.0, 60.0])}, only=("stroke", "alpha", "theta2"))
    assert np.isnan(row["stroke"]).tolist() == np.isnan(row["alpha"]).tolist() == [True, False]
    assert np.isfinite(row["theta2"]).all()


def test_a_crank_stopped_between_two_samples_does_not_turn():
    """r1 + r2 exceeds r3 + r4 by a ten-millionth of a millimetre: the crank misses only a sliver of its
    turn."""
    r2 = np.array([140.0 + 1e-7, 139.9])
    row = EXERCISE.solve(**{**PLAIN, "r2": r2}, only=("stroke", "alpha"))
    assert np.isnan(row["stroke"]).tolist() == np.isnan(row["alpha"]).tolist() == [True, False]


def test_the_advantage_of_a_piston_at_rest_is_undefined():
    with pytest.raises(Undefined, match="at rest"):
        EXERCISE.solve(**PLAIN, v_C=0.0, only="mechanical_advantage")
    row = EXERCISE.solve(**PLAIN, v_C=np.array([0.0, 2.0]), only="mechanical_advantage")
    assert np.isnan(row["mechanical_advantage"]).tolist() == [True, False]


def test_an_instant_computes_nothing_of_the_turn():
    assert "theta2_turns" not in EXERCISE.plan(("v_C", "a_C", "mechanical_advantage"))


def test_an_angle_that_no_triangle_has_is_refused(course):
    exercise = course["quick_return"]
    given = dict(exercise.variant(1).given)
    for angle in (-90, -0.1, 180.1, 200):
        with pytest.raises(Undefined, match="from 0 to 180"):
            exercise.solve(**{**given, "angle_OAB": angle}, only="theta4")
    both = np.array([given["angle_OAB"], 200.0])
    found = exercise.solve(**{**given, "angle_OAB": both}, only=("theta2", "theta3", "v_C"))
    for name, values in found.items():
        np.testing.assert_array_equal(np.isnan(values), [False, True], err_msg=name)
