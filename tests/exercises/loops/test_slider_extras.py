"""Six-bar linkage with a slider, against fifty digits and against the misprints of the notes."""

import mpmath
import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.errors import CannotAssemble

EXERCISE = coursework.open_course()["slider_extras"]
LENGTHS = {"r1": 120.0, "r2": 40.0, "r3": 120.0, "r4": 200.0, "r5": 320.0, "theta2": 20.0, "omega2": 15.0}
RATES = ("omega3", "omega4", "omega5", "r6_dot")
ACCELERATIONS = ("alpha3", "alpha4", "alpha5", "r6_ddot")


def exact(given):
    """Everything in fifty digits: B by the angle at A, rates by derivatives of the positions themselves."""
    with mpmath.workdps(50):
        r1, r2, r3, r4, r5, theta2, omega2 = (mpmath.mpf(given[n]) for n in LENGTHS)
        turn = -1 if given["mode"] == "crossed" else 1

        def pose(time):
            A = mpmath.mpc(0, r1) + r2 * mpmath.expj(theta2 * mpmath.pi / 180 + omega2 * time)
            at_A = mpmath.acos((r3**2 + abs(A) ** 2 - r4**2) / (2 * r3 * abs(A)))
            coupler = -r3 * A / abs(A) * mpmath.expj(turn * at_A)
            B = A + coupler
            rod = mpmath.mpc(-mpmath.sqrt(r5**2 - mpmath.im(B) ** 2), mpmath.im(B))
            return coupler, B, rod, mpmath.re(B - rod)

        now = pose(mpmath.mpf(0))
        found = {"r6": now[3]}
        for name, vector in zip(("theta3", "theta4", "theta5"), now, strict=False):
            found[name] = mpmath.degrees(mpmath.arg(vector))
        for index, (rate, acceleration) in enumerate(zip(RATES, ACCELERATIONS, strict=True)):

            def turned(time, index=index):
                vector = pose(time)[index]
                return vector if index == 3 else mpmath.arg(vector / now[index])

            # Taylor's first coefficients by a wide stencil: 1e-12 in steps leaves 30 digits.
            h = mpmath.mpf("1e-12") / abs(omega2)
            before, here, after = turned(-h), turned(mpmath.mpf(0)), turned(h)
            found[rate] = (after - before) / (2 * h)
            found[acceleration] = (after - 2 * here + before) / h**2
        crank = mpmath.mpc(0, r1) + r2 * mpmath.expjpi(theta2 / 180)
        found["a"], found["b"] = 2 * r3 * mpmath.re(crank), 2 * r3 * mpmath.im(crank)
        found["c"] = r4**2 - r3**2 - abs(crank) ** 2
        found["B"], found["C"] = -2 * mpmath.re(now[1]), r4**2 - r5**2
        return found


@each_row("seed", range(10))
def test_answers_are_those_of_the_loop_equations_in_fifty_digits(seed):
    variant = EXERCISE.variant(seed)
    answers = variant.solution()
    for name, reference in exact(variant.given).items():
        difference = mpmath.mpf(float(answers[name])) - reference
        assert abs(difference) < 1e-11 * abs(reference), name


def test_the_two_modes_are_mirrored_in_the_line_from_A_to_D():
    modes = [EXERCISE.solve(**LENGTHS, mode=mode) for mode in ("open", "crossed")]
    A = 120j + 40 * np.exp(1j * np.radians(20))
    first, second = (200 * np.exp(1j * np.radians(m["theta4"])) for m in modes)
    assert first / A == pytest.approx(np.conj(second / A), rel=1e-12)
    assert (first / A).imag < 0  # left of A -> D is right of D -> A


def test_the_slider_takes_the_larger_root_when_the_rod_is_the_shorter():
    found = EXERCISE.solve(**{**LENGTHS, "r5": 195.0}, mode="open", only=("r6", "theta4"))
    x, y = 200 * np.cos(np.radians(found["theta4"])), 200 * np.sin(np.radians(found["theta4"]))
    assert found["r6"] == pytest.approx(x + np.sqrt(195.0**2 - y**2), rel=1e-12)


def test_the_slider_keeps_its_digits_near_D():
    """Rod and rocker nearly equal, B beyond D: r6 is the small root of a sum, not a difference of lengths."""
    given = {"r4": 200.0, "r5": 200.0 + 1e-9, "theta4": 150.0}
    found = EXERCISE.solve(**given, only="r6")["r6"]
    with mpmath.workdps(50):
        x, y = 200 * mpmath.cospi(mpmath.mpf(5) / 6), mpmath.mpf(100)
        right = x + mpmath.sqrt(mpmath.mpf(given["r5"]) ** 2 - y**2)
    assert found == pytest.approx(float(right), rel=1e-14)


@each_row(
    ("change", "words"),
    [({"r3": 20.0}, "coupler and rocker"), ({"r4": 400.0}, "coupler and rocker"), ({"r5": 90.0}, "rod")],
)
def test_what_cannot_close_is_said_of_its_own_loop(change, words):
    with pytest.raises(CannotAssemble, match=words):
        EXERCISE.solve(**{**LENGTHS, **change}, mode="open")


def test_arrays_are_nan_where_a_scalar_does_not_close():
    r3 = np.array([120.0, 20.0, 130.0])
    found = EXERCISE.solve(**{**LENGTHS, "r3": r3}, mode="open", only=("theta3", "r6", "alpha5"))
    for values in found.values():
        assert np.isnan(values).tolist() == [False, True, False]


def test_the_angle_at_B_stays_between_30_and_150_degrees_over_the_turn():
    crank = np.arange(0.0, 360.0, 1.0)
    for variant in EXERCISE.variants(range(200)):
        given = {n: variant.given[n] for n in ("r1", "r2", "r3", "r4", "mode")}
        found = EXERCISE.solve(**given, theta2=crank, only=("theta3", "theta4"))
        at_B = abs((found["theta3"] - found["theta4"] + 180) % 360 - 180)
        assert at_B.min() > 29.99
        assert at_B.max() < 150.01


def test_misprints_of_the_notes_move_what_they_touch():
    """Each on the variant of the notes' layout that hand computation settles: B = (-56, 192)."""
    given = {**LENGTHS, "theta2": 0.0, "mode": "crossed"}

    def mistaken(name, quantity):
        return EXERCISE.solution.mistaken(name).evaluate((quantity,), given)[quantity]

    # theta4 + theta3 stands below instead of theta4 - theta3: sines 3/5, 4/5, 24/25, 7/25 of the triangles.
    assert mistaken("sum_in_denominator", "omega4") == pytest.approx(15 * 40 * -3 / 5 / (200 * -117 / 125))
    assert mistaken("sum_in_denominator", "omega3") == pytest.approx(15 * 40 * -24 / 25 / (120 * -117 / 125))
    assert mistaken("notes_c", "c") == 200**2 - 40**2 - 120**2
    assert EXERCISE.solve(**given, only="c")["c"] == 200**2 - 40**2 - 120**2 - 120**2
    assert mistaken("notes_eq7", "r6_dot") == pytest.approx(3 * 192 + 21 / 32 * 192)
    right = EXERCISE.solve(**given, only="theta5")["theta5"]
    assert mistaken("arctan_no_quadrant", "theta5") == pytest.approx(right - 180)
    assert mistaken("notes_r1_called_r6", "loop_1_y") != EXERCISE.solve(**given, only="loop_1_y")["loop_1_y"]


def test_the_loop_equations_hold_for_the_positions_and_fail_for_those_of_the_mistakes():
    from coursework.parsing.equations import parse_equation

    variant = EXERCISE.variant(0)
    answers = variant.solution()
    symbols = EXERCISE.spec.part("loop_1_x").variables
    lengths = {n: variant.given.get(n, answers.get(n)) for n in symbols}
    values = {n: np.radians(v) if n.startswith("theta") else v for n, v in lengths.items()}
    wrong = {name: EXERCISE.solution.mistaken(name) for name in EXERCISE.solution.mistakes}
    for part in ("loop_1_x", "loop_1_y", "loop_2_x", "loop_2_y"):
        assert abs(parse_equation(answers[part], symbols).difference(values)) < 1e-9
        for name, graph in wrong.items():
            if part in EXERCISE.solution.mistakes[name].targets:
                text = graph.evaluate((part,), dict(variant.given))[part]
                assert abs(parse_equation(text, symbols).difference(values)) > 1, name


@each_row("beside", [1e-1, 1e-4, 1e-7])
@each_row("mode", ["open", "crossed"])
def test_nothing_is_lost_beside_a_change_point(beside, mode):
    """r1 + r2 = r3 + r4: crank and frame stretch coupler and rocker out where the crank points down."""
    given = {**LENGTHS, "r1": 120.0, "r2": 40.0, "r3": 70.0, "r4": 90.0, "r5": 300.0, "mode": mode}
    given["theta2"] = 90.0 - beside
    reference, answers = exact(given), EXERCISE.solve(**given)
    # The rocker points up there: what hangs on its cosine is left out, since theta4 in degrees cannot say it.
    for name in ("theta3", "theta4", "omega3", "omega4", "alpha3", "alpha4", "a", "b", "c", "r6"):
        scale = {"theta": 180, "alpha": given["omega2"] ** 2}.get(name[:5], abs(reference[name]))
        assert abs(mpmath.mpf(float(answers[name])) - reference[name]) < 2e-14 * scale, name


def test_a_near_D_keeps_the_digits_of_b():
    given = {**LENGTHS, "r1": 100.0, "r2": 100.0, "theta2": -90.0 + 1e-5}
    with mpmath.workdps(50):
        right = 2 * mpmath.mpf(120) * 100 * (1 + mpmath.sin(mpmath.mpf(given["theta2"]) * mpmath.pi / 180))
    assert EXERCISE.solve(**given, only="b")["b"] == pytest.approx(float(right), rel=1e-10)
