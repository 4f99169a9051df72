"""Linkage of two loops: against fifty digits, against Newton's method on both loops, and the misprint of the
notes."""

import mpmath
import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.errors import CannotAssemble
from coursework.kinematics.chains import ClosedChain, Vector
from coursework.parsing.equations import parse_equation

EXERCISE = coursework.open_course()["two_loop_linkage"]
PLAIN = {
    "xC": 200.0,
    "yC": -10.0,
    "xF": 390.0,
    "yF": -20.0,
    "r2": 35.0,
    "r3": 145.0,
    "r4": 140.0,
    "r5": 65.0,
    "beta": -65.0,
    "r6": 155.0,
    "r7": 105.0,
    "theta2": 60.0,
    "omega2": 8.0,
    "mode_1": "open",
    "mode_2": "open",
}
ANGLES = ("theta3", "theta4", "theta6", "theta7")
RATES = ("omega3", "omega4", "omega6", "omega7")
ACCELERATIONS = ("alpha3", "alpha4", "alpha6", "alpha7")


def exact(given):
    """Fifty digits: each pin by the angle at the pin before it, rates by differences of the positions in
    time."""
    with mpmath.workdps(50):
        lengths = {n: mpmath.mpf(v) for n, v in given.items() if not n.startswith("mode")}
        C, F = mpmath.mpc(lengths["xC"], lengths["yC"]), mpmath.mpc(lengths["xF"], lengths["yF"])
        turns = [1 if given[mode] == "open" else -1 for mode in ("mode_1", "mode_2")]

        def meet(start, end, first, second, turn):
            line = end - start
            corner = mpmath.acos((first**2 + abs(line) ** 2 - second**2) / (2 * first * abs(line)))
            return first * line / abs(line) * mpmath.expj(turn * corner)

        def pose(time):
            turned = mpmath.expjpi(lengths["theta2"] / 180) * mpmath.expj(lengths["omega2"] * time)
            A = lengths["r2"] * turned
            AB = meet(A, C, lengths["r3"], lengths["r4"], turns[0])
            CB = A + AB - C
            CD = CB / lengths["r4"] * lengths["r5"] * mpmath.expjpi(lengths["beta"] / 180)
            DE = meet(C + CD, F, lengths["r6"], lengths["r7"], turns[1])
            return AB, CB, DE, C + CD + DE - F

        h = mpmath.mpf("1e-12") / abs(lengths["omega2"])
        before, now, after = pose(-h), pose(mpmath.mpf(0)), pose(h)
        found = {}
        for index in range(4):
            back, ahead = (mpmath.arg(there[index] / now[index]) for there in (before, after))
            found[ANGLES[index]] = mpmath.degrees(mpmath.arg(now[index]))
            found[RATES[index]] = (ahead - back) / (2 * h)
            found[ACCELERATIONS[index]] = (ahead + back) / h**2
        return found


@each_row("seed", range(10))
def test_answers_are_those_of_the_loop_equations_in_fifty_digits(seed):
    variant = EXERCISE.variant(seed)
    answers = variant.solution()
    for name, reference in exact(variant.given).items():
        size = 180 if name in ANGLES else abs(reference)
        assert abs(mpmath.mpf(float(answers[name])) - reference) < 1e-12 * size, name


def test_newton_on_both_loops_at_once_finds_the_same_angles_and_rates_all_around():
    crank = np.radians(np.arange(0.0, 360.0, 7.5))
    found = EXERCISE.solve(**{**PLAIN, "theta2": np.degrees(crank)}, only=(*ANGLES, *RATES))
    start = {name: np.radians(found[name]) + 0.02 for name in ANGLES}
    chain = ClosedChain(
        [
            [
                Vector(35.0, "theta2"),
                Vector(145.0, "theta3"),
                Vector(140.0, "theta4", -1),
                Vector(abs(200 - 10j), np.angle(200 - 10j), -1),
            ],
            [
                Vector(65.0, "theta4", turn=np.radians(-65)),
                Vector(155.0, "theta6"),
                Vector(105.0, "theta7", -1),
                Vector(abs(190 - 10j), np.angle(190 - 10j), -1),
            ],
        ],
        ANGLES,
    )
    pose = chain.solve({"theta2": crank}, start)
    assert np.all(pose.converged)
    for name in ANGLES:
        apart = np.exp(1j * (pose.values[name] - np.radians(found[name]))) - 1
        assert abs(apart).max() < 1e-12, name
    turn = np.cumsum([0, *[7.5] * 48])
    for angle, rate in zip(ANGLES, RATES, strict=True):
        # Over a turn, each of these links comes back: its rate has no mean.
        around = EXERCISE.solve(**{**PLAIN, "theta2": turn}, only=rate)[rate][:-1]
        assert abs(around.mean()) < 1e-6 * abs(around).max(), angle


def test_modes_are_the_sides_of_B_and_of_E():
    for mode_1 in ("open", "crossed"):
        for mode_2 in ("open", "crossed"):
            found = EXERCISE.solve(**{**PLAIN, "mode_1": mode_1, "mode_2": mode_2}, only=ANGLES)
            at = {n: np.exp(1j * np.radians(v)) for n, v in found.items()}
            A, C, F = 35 * np.exp(1j * np.pi / 3), 200 - 10j, 390 - 20j
            D = C + 65 * at["theta4"] * np.exp(-1j * np.radians(65))
            assert ((np.conj(C - A) * at["theta3"]).imag > 0) == (mode_1 == "open")
            assert ((np.conj(F - D) * at["theta6"]).imag > 0) == (mode_2 == "open")


def test_the_outer_loop_says_nothing_new():
    """The notes count three loops; the equation of the third is the sum of the two others."""
    found = EXERCISE.solve(**PLAIN, only=("cycles", "mobility", *ANGLES))
    assert (found["cycles"], found["mobility"]) == (2, 1)
    assert EXERCISE.solution.mistaken("notes_N_without_frame").evaluate(("cycles",), {})["cycles"] == 3
    names = EXERCISE.spec.part("loop_1_x").variables
    values = {n: PLAIN.get(n, found.get(n)) for n in names}
    values = {n: np.radians(v) if n.startswith(("theta", "beta")) else v for n, v in values.items()}
    for axis, function in (("x", "cos"), ("y", "sin")):
        equations = EXERCISE.solve(**PLAIN, only=(f"loop_1_{axis}", f"loop_2_{axis}"))
        outer = (
            f"r2*{function}(theta2) + r3*{function}(theta3) - r4*{function}(theta4)"
            f" + r5*{function}(theta4 + beta) + r6*{function}(theta6) = {axis}F + r7*{function}(theta7)"
        )
        for shift in (0.0, 0.3):
            moved = {**values, "theta4": values["theta4"] + shift}
            gaps = [parse_equation(text, names).difference(moved) for text in equations.values()]
            total = parse_equation(outer, names).difference(moved)
            assert total == pytest.approx(sum(gaps), abs=1e-9)
            assert (abs(total) < 1e-9) == (shift == 0)


@each_row(("change", "words"), [({"r3": 30.0}, "coupler and rocker"), ({"r6": 30.0}, "coupler")])
def test_what_cannot_close_is_said(change, words):
    with pytest.raises(CannotAssemble, match=words):
        EXERCISE.solve(**{**PLAIN, **change}, only="theta7")
    row = {name: np.array([value, PLAIN[name]]) for name, value in change.items()}
    found = EXERCISE.solve(**{**PLAIN, **row}, only=("theta7", "alpha6"))
    for values in found.values():
        assert np.isnan(values).tolist() == [True, False]


def test_the_first_loop_stands_alone():
    needed = EXERCISE.plan(("alpha3", "alpha4"))
    assert not {"theta5", "theta6", "omega6", "side_2"} & set(needed)


def test_both_loops_keep_their_transmission_angles_over_the_turn():
    crank = np.arange(0.0, 360.0, 2.0)
    for variant in EXERCISE.variants(range(100)):
        given = {n: v for n, v in variant.given.items() if n not in ("theta2", "omega2")}
        found = EXERCISE.solve(**given, theta2=crank, only=ANGLES)
        at_B = abs((found["theta3"] - found["theta4"] + 180) % 360 - 180)
        at_E = abs((found["theta6"] - found["theta7"] + 180) % 360 - 180)
        assert 29.99 < at_B.min() <= at_B.max() < 150.01
        assert 24.99 < at_E.min() <= at_E.max() < 155.01


@each_row("seed", range(6))
def test_the_outer_loop_is_the_sum_of_the_two_others(seed):
    variant = EXERCISE.variant(seed)
    symbols = EXERCISE.spec.part("loop_3_x").variables
    answers = {**variant.given, **variant.solution()}
    equations = {
        loop: parse_equation(EXERCISE.solution.graph.evaluate((f"{loop}_x",), {})[f"{loop}_x"], symbols)
        for loop in ("loop_1", "loop_2", "loop_3")
    }
    rng = np.random.default_rng(seed)
    for _ in range(5):  # at any values, not only where the loops close
        values = {n: rng.uniform(20, 200) for n in symbols}
        gaps = {loop: equation.difference(values) for loop, equation in equations.items()}
        signed = [
            abs(gaps["loop_3"] - a * gaps["loop_1"] - b * gaps["loop_2"]) for a in (1, -1) for b in (1, -1)
        ]
        assert min(signed) < 1e-9
    turned = {n: np.radians(answers[n]) if n.startswith(("theta", "beta")) else answers[n] for n in symbols}
    assert abs(equations["loop_3"].difference(turned)) < 1e-9


@each_row(
    ("text", "verdict"),
    [
        (
            "r2*cos(theta2) + r3*cos(theta3) - r4*cos(theta4) + r5*cos(theta4+beta) + r6*cos(theta6) - "
            "xF - r7*cos(theta7) = 0",
            "correct",
        ),
        (
            "xF + r7*cos(theta7) - r6*cos(theta6) = r2*cos(theta2) + r3*cos(theta3) - r4*cos(theta4) + "
            "r5*cos(theta4 + beta)",
            "correct",
        ),
        (
            "r2*cos(theta2) + r3*cos(theta3) + r5*cos(theta4 + beta) + r6*cos(theta6) = xF + r7*cos(theta7)",
            "mistake:plate_side_CB_forgotten",
        ),
        (
            "r2*cos(theta2) + r3*cos(theta3) + r4*cos(theta4) + r5*cos(theta4 + beta) + r6*cos(theta6) "
            "= xF + r7*cos(theta7)",
            "slip:link_sign",
        ),
        ("r2*cos(theta2) + r3*cos(theta3) = xC + r4*cos(theta4)", "slip:other_loop"),
    ],
)
def test_the_equation_of_the_outer_loop_is_judged_in_any_form(text, verdict):
    assert EXERCISE.variant(1).grade({"loop_3_x": text})["loop_3_x"].verdict == verdict


def test_who_counts_a_third_independent_loop_is_told():
    mark = EXERCISE.variant(1, "en", ["third_loop"]).grade(
        {"third_loop": "one more equation, which does not follow from (1) and (2)"}
    )
    assert mark["third_loop"].verdict == "mistake:third_loop_counted_as_new"
