"""Mechanism of three loops: against fifty digits, around its turn, and against the mixed letters of the
notes."""

import mpmath
import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.errors import CannotAssemble
from coursework.kinematics.chains import ClosedChain, Vector
from coursework.parsing.equations import parse_equation

EXERCISE = coursework.open_course()["three_loop_shaper"]
PLAIN = {
    "xC": 195.0,
    "yC": -5.0,
    "xD": 110.0,
    "yD": -150.0,
    "r2": 30.0,
    "r3": 135.0,
    "r4": 145.0,
    "r5": 450.0,
    "r6": 80.0,
    "beta": 40.0,
    "r7": 250.0,
    "d3": 240.0,
    "theta2": 60.0,
    "omega2": 8.0,
    "mode": "open",
}
POSITIONS = ("theta3", "theta4", "theta5", "d5", "theta7", "x8")
RATES = ("omega3", "omega4", "omega5", "d5_dot", "omega7", "x8_dot")
ACCELERATIONS = ("alpha3", "alpha4", "alpha5", "d5_ddot", "alpha7", "x8_ddot")


def exact(given):
    """Fifty digits: pins one after the other, rates by differences of the positions in time."""
    with mpmath.workdps(50):
        of = {n: mpmath.mpf(v) for n, v in given.items() if n != "mode"}
        C, D = mpmath.mpc(of["xC"], of["yC"]), mpmath.mpc(of["xD"], of["yD"])
        turn = 1 if given["mode"] == "open" else -1

        def pose(time):
            A = of["r2"] * mpmath.expjpi(of["theta2"] / 180) * mpmath.expj(of["omega2"] * time)
            line = C - A
            corner = mpmath.acos(
                (of["r3"] ** 2 + abs(line) ** 2 - of["r4"] ** 2) / (2 * of["r3"] * abs(line))
            )
            AB = of["r3"] * line / abs(line) * mpmath.expj(turn * corner)
            DE = A + AB / of["r3"] * of["r6"] * mpmath.expjpi(of["beta"] / 180) - D
            F = D + DE / abs(DE) * of["r5"]
            rise = of["d3"] - mpmath.im(F)
            FG = mpmath.mpc(mpmath.sqrt(of["r7"] ** 2 - rise**2), rise)
            return AB, A + AB - C, DE, abs(DE), FG, mpmath.re(F + FG)

        h = mpmath.mpf("1e-12") / abs(of["omega2"])
        before, now, after = pose(-h), pose(mpmath.mpf(0)), pose(h)
        found = {}
        for index, name in enumerate(POSITIONS):
            if name.startswith("theta"):
                back, here, ahead = (mpmath.arg(p[index] / now[index]) for p in (before, now, after))
                found[name] = mpmath.degrees(mpmath.arg(now[index]))
            else:
                back, here, ahead = (p[index] for p in (before, now, after))
                found[name] = here
            found[RATES[index]] = (ahead - back) / (2 * h)
            found[ACCELERATIONS[index]] = (ahead - 2 * here + back) / h**2
        return found


@each_row("seed", range(10))
def test_answers_are_those_of_the_loop_equations_in_fifty_digits(seed):
    variant = EXERCISE.variant(seed)
    answers, reference = variant.solution(), exact(variant.given)
    sizes = {"theta": 180, "alpha": variant.given["omega2"] ** 2, "omega": abs(variant.given["omega2"])}
    for name, value in reference.items():
        size = sizes.get(
            name[:5], max(abs(value), abs(reference["x8" + name[2:]]) if name[:2] == "d5" else 0)
        )
        assert abs(mpmath.mpf(float(answers[name])) - value) < 2e-12 * size, name


def test_newton_on_the_three_loops_at_once_finds_the_same_positions_all_around():
    theta2 = np.arange(0.0, 360.0, 9.0)
    found = EXERCISE.solve(**{**PLAIN, "theta2": theta2}, only=POSITIONS)
    known = {n: np.radians(v) if n.startswith("theta") else v for n, v in found.items()}
    crank, beta = Vector(30.0, "theta2"), np.radians(40)
    to_C, to_D = 195 - 5j, 110 - 150j
    chain = ClosedChain(
        [
            [
                crank,
                Vector(135.0, "theta3"),
                Vector(145.0, "theta4", -1),
                Vector(abs(to_C), np.angle(to_C), -1),
            ],
            [
                crank,
                Vector(80.0, "theta3", turn=beta),
                Vector("d5", "theta5", -1),
                Vector(abs(to_D), np.angle(to_D), -1),
            ],
            [
                Vector(abs(to_D), np.angle(to_D)),
                Vector(450.0, "theta5"),
                Vector(250.0, "theta7"),
                Vector("x8", 0.0, -1),
                Vector(240.0, np.pi / 2, -1),
            ],
        ],
        POSITIONS,
    )
    pose = chain.solve({"theta2": np.radians(theta2)}, {n: v + 0.01 for n, v in known.items()})
    assert np.all(pose.converged)
    for name, value in known.items():
        gap = (
            np.exp(1j * (pose.values[name] - value)) - 1 if name[0] == "t" else pose.values[name] / value - 1
        )
        assert abs(gap).max() < 1e-12, name


def test_the_loops_written_from_E_on_say_the_same_as_those_from_D():
    """The notes go to G through A and E, over r5 - d5: the sum of our two other loops."""
    found = EXERCISE.solve(**PLAIN, only=POSITIONS)
    names = EXERCISE.spec.part("loop_1_x").variables
    values = {n: PLAIN.get(n, found.get(n)) for n in names}
    values = {n: np.radians(v) if n.startswith(("theta", "beta")) else v for n, v in values.items()}
    for axis, function, end in (("x", "cos", "x8"), ("y", "sin", "d3")):
        notes = (
            f"r2*{function}(theta2) + r6*{function}(theta3 + beta) + (r5 - d5)*{function}(theta5)"
            f" + r7*{function}(theta7) = {end}"
        )
        assert abs(parse_equation(notes, names).difference(values)) < 1e-9
        for loop in (1, 2, 3):
            text = EXERCISE.solve(**PLAIN, only=f"loop_{loop}_{axis}")[f"loop_{loop}_{axis}"]
            equation = parse_equation(text, names)
            assert abs(equation.difference(values)) < 1e-9
            assert abs(equation.difference({**values, "theta5": 1.0, "theta3": 1.0})) > 1


def test_the_letters_that_the_notes_mix_move_the_answers():
    right = EXERCISE.solve(**PLAIN, only=("theta5", "d5"))
    mixed = EXERCISE.solution.mistaken("r6_is_r5").evaluate(("theta5", "d5"), PLAIN)
    A_and_E = 450 / 80 * (right["d5"] * np.exp(1j * np.radians(right["theta5"])) + 110 - 150j)
    A = 30 * np.exp(1j * np.pi / 3)
    A_and_E += (1 - 450 / 80) * A
    DE = A_and_E - (110 - 150j)
    assert mixed["d5"] == pytest.approx(abs(DE), rel=1e-12)
    assert mixed["theta5"] == pytest.approx(np.degrees(np.angle(DE)), rel=1e-12)
    assert abs(mixed["d5"] - right["d5"]) > 100


@each_row(("change", "words"), [({"r3": 30.0}, "coupler and rocker"), ({"r7": 20.0}, "rod reaches only")])
def test_what_cannot_close_is_said_of_its_own_loop(change, words):
    with pytest.raises(CannotAssemble, match=words):
        EXERCISE.solve(**{**PLAIN, **change}, only="x8_ddot")
    row = {name: np.array([value, PLAIN[name]]) for name, value in change.items()}
    found = EXERCISE.solve(**{**PLAIN, **row}, only=("x8", "x8_ddot", "theta7"))
    for values in found.values():
        assert np.isnan(values).tolist() == [True, False]


def test_the_bar_needs_nothing_of_the_ram():
    assert not {"theta7", "p7", "omega7", "x8"} & set(EXERCISE.plan(("alpha5", "d5_ddot")))
    assert "d5_ddot" not in EXERCISE.plan(("x8_ddot",))


def test_variants_keep_their_blocks_on_the_bar_and_their_rods_low_all_around():
    theta2 = np.arange(0.0, 360.0, 3.0)
    for variant in EXERCISE.variants(range(60)):
        given = {n: v for n, v in variant.given.items() if n not in ("theta2", "omega2")}
        found = EXERCISE.solve(**given, theta2=theta2, only=POSITIONS)
        assert found["d5"].min() > 38
        assert found["d5"].max() < 0.96 * given["r5"]
        assert abs(found["theta7"]).max() < 52
        assert 18 < found["theta5"].min() <= found["theta5"].max() < 162


def test_freedoms_and_cycles_are_those_of_the_graph_of_figure_14():
    from coursework.structure import LIBRARY

    counts = LIBRARY["figure_14"].counts
    found = EXERCISE.solve(**PLAIN, only=("w", "gamma"))
    assert (found["w"], found["gamma"]) == (counts.w, counts.gamma) == (1, 3)


@each_row(
    ("part", "answer", "verdict"),
    [
        ("w", "0", "mistake:block_left_out"),
        ("w", "3", "mistake:one_joint_of_the_block"),
        ("w", "4", "mistake:frame_counted"),
        ("w", "5", "mistake:slides_left_out"),
        ("gamma", "4", "mistake:N_without_frame"),
        ("gamma", "1", "mistake:slides_left_out"),
        ("gamma", "3", "correct"),
    ],
)
def test_counts_that_leave_something_out_are_told(part, answer, verdict):
    assert EXERCISE.variant(0, parts=[part]).grade({part: answer})[part].verdict == verdict
