"""Four-bar linkage in motion: against fifty digits, near its dead points, and in its two modes."""

import mpmath
import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.errors import CannotAssemble, Undefined

EXERCISE = coursework.open_course()["four_bar_motion"]
ASKED = tuple(part.quantity for part in EXERCISE.spec.parts if not part.by_request)
PLAIN = {
    "r1": 200.0,
    "r2": 60.0,
    "r3": 180.0,
    "r4": 150.0,
    "theta2": 50.0,
    "omega2": 7.0,
    "alpha2": -20.0,
    "mode": "open",
}


def exact(r1, r2, r3, r4, theta2, omega2, alpha2, mode):
    """Fifty digits: the positions, and their derivatives by differences in time."""
    with mpmath.workdps(50):
        r1, r2, r3, r4, omega2, alpha2 = map(mpmath.mpf, (r1, r2, r3, r4, omega2, alpha2))
        start, turn = mpmath.mpf(theta2) / 180, {"open": 1, "crossed": -1}[mode]

        def pose(time):
            A = r2 * mpmath.expjpi(start + (omega2 * time + alpha2 * time**2 / 2) / mpmath.pi)
            AC = r1 - A
            at_A = mpmath.acos((r3**2 + abs(AC) ** 2 - r4**2) / (2 * r3 * abs(AC)))
            return A, A + r3 * AC / abs(AC) * mpmath.expj(turn * at_A)

        h = mpmath.mpf("1e-13") / (abs(omega2) + 1)
        before, now, after = pose(-h), pose(mpmath.mpf(0)), pose(h)
        coupler, rocker = now[1] - now[0], now[1] - r1

        def turned(pins):
            return mpmath.arg((pins[1] - pins[0]) / coupler), mpmath.arg((pins[1] - r1) / rocker)

        omega3, omega4 = ((x - y) / (2 * h) for x, y in zip(turned(after), turned(before), strict=True))
        alpha3, alpha4 = ((x + y) / h**2 for x, y in zip(turned(after), turned(before), strict=True))
        velocities = [(x - y) / (2 * h) for x, y in zip(after, before, strict=True)]
        accelerations = [(x - 2 * m + y) / h**2 for x, m, y in zip(after, now, before, strict=True)]
        a_BA = (accelerations[1] - accelerations[0]) * r3 / coupler
        return {
            "theta3": mpmath.degrees(mpmath.arg(coupler)),
            "theta4": mpmath.degrees(mpmath.arg(rocker)),
            "omega3": omega3,
            "omega4": omega4,
            "alpha3": alpha3,
            "alpha4": alpha4,
            "v_B": abs(velocities[1]),
            "a_B": abs(accelerations[1]),
            "v_BA": abs(velocities[1] - velocities[0]),
            "a_BA_n": -mpmath.re(a_BA),
            "a_BA_t": mpmath.im(a_BA),
        }


def assert_agrees(answers, reference, digits=1e-11):
    for name, value in reference.items():
        assert abs(float(answers[name] - value)) < digits * abs(value), name


@each_row("seed", range(10))
def test_answers_are_those_of_the_loop_equations_in_fifty_digits(seed):
    variant = EXERCISE.variant(seed)
    assert set(variant.solution()) == set(ASKED)
    assert_agrees(variant.solution(), exact(**variant.given))


#: s + l = p + q in decimals that are doubles: crank and frame line up with coupler and rocker at 180 degrees.
CHANGE_POINT = {**PLAIN, "r1": 100.0, "r2": 50.0, "r3": 70.0, "r4": 80.0}


@each_row("away", [1e-2, 1e-5, 1e-8])
@each_row("mode", ["open", "crossed"])
def test_rates_keep_their_digits_next_to_a_change_point(away, mode):
    given = {**CHANGE_POINT, "theta2": 180.0 - away, "mode": mode}
    names = tuple(n for n in ASKED if not n.startswith("theta"))
    answers, reference = EXERCISE.solve(**given, only=names), exact(**given)
    assert_agrees(answers, {name: reference[name] for name in names}, 1e-13)


def test_next_to_a_change_point_both_modes_have_their_own_rate():
    near = {**CHANGE_POINT, "theta2": 180.0 - 1e-7, "omega2": 1.0}
    found = [
        EXERCISE.solve(**{**near, "mode": mode}, only="omega4")["omega4"] for mode in ("open", "crossed")
    ]
    assert sorted(found) == pytest.approx([-0.107625, 0.774292], abs=1e-6)


def test_a_dead_point_has_a_position_and_no_rates():
    dead = {**CHANGE_POINT, "theta2": 180.0}
    assert EXERCISE.solve(**dead, only=("theta3", "theta4")) == {"theta3": 0.0, "theta4": 180.0}
    for name in ("omega3", "alpha4", "a_B"):
        with pytest.raises(Undefined, match="in line"):
            EXERCISE.solve(**dead, only=name)
    row = EXERCISE.solve(**{**dead, "theta2": np.array([180.0, 90.0])}, only=("theta3", "omega4", "alpha3"))
    assert np.isfinite(row["theta3"]).all()
    assert np.isnan(row["omega4"]).tolist() == np.isnan(row["alpha3"]).tolist() == [True, False]


def test_what_cannot_close_is_said_with_the_gap_and_is_nan_in_arrays():
    short = {**PLAIN, "r3": 40.0, "r4": 30.0}
    for name in ("theta3", "theta4", "omega4", "alpha3"):
        with pytest.raises(CannotAssemble, match="gap"):
            EXERCISE.solve(**short, only=name)
    row = EXERCISE.solve(**{**PLAIN, "r3": np.array([40.0, 180.0]), "r4": 80.0}, only=ASKED)
    for values in row.values():
        assert np.isnan(values).tolist() == [True, False]


def test_a_crank_pin_on_the_rockers_pivot_leaves_the_coupler_free():
    with pytest.raises(Undefined, match="far pins coincide"):
        EXERCISE.solve(r1=60, r2=60, r3=90, r4=90, theta2=0, mode="open", only="theta3")


def test_mirror_image_in_the_x_axis_exchanges_the_modes():
    here = EXERCISE.solve(**PLAIN)
    mirrored = {n: -v if n in ("theta2", "omega2", "alpha2") else v for n, v in PLAIN.items()}
    there = EXERCISE.solve(**{**mirrored, "mode": "crossed"})
    for name, value in here.items():
        turns = name.startswith(("theta", "omega", "alpha")) or name == "a_BA_t"
        assert there[name] == pytest.approx(-value if turns else value, rel=1e-12), name


def test_velocities_of_A_and_B_agree_along_the_coupler():
    """Equiprojectivity."""
    for variant in EXERCISE.variants(range(50)):
        given, found = variant.given, variant.solution()
        along = [
            given["r2"] * given["omega2"] * np.sin(np.radians(found["theta3"] - given["theta2"])),
            given["r4"] * found["omega4"] * np.sin(np.radians(found["theta3"] - found["theta4"])),
        ]
        assert along[0] == pytest.approx(along[1], rel=1e-10)


def test_rates_that_are_given_are_those_that_accelerate():
    """The normal terms follow an omega3 and an omega4 from elsewhere, as in the printed formula."""
    right = EXERCISE.solve(**PLAIN)
    omega3, omega4 = 2.0, -1.5
    found = EXERCISE.solve(**PLAIN, omega3=omega3, omega4=omega4, only=("alpha3", "alpha4"))
    r2, r3, r4, omega2, alpha2 = (PLAIN[n] for n in ("r2", "r3", "r4", "omega2", "alpha2"))
    t2, t3, t4 = np.radians([PLAIN["theta2"], right["theta3"], right["theta4"]])
    crank = (1j * alpha2 - omega2**2) * r2 * np.exp(1j * t2)
    left = crank + (1j * found["alpha3"] - omega3**2) * r3 * np.exp(1j * t3)
    assert left == pytest.approx((1j * found["alpha4"] - omega4**2) * r4 * np.exp(1j * t4), rel=1e-12)


def test_the_angle_at_B_stays_between_30_and_150_degrees_over_the_turn():
    crank = np.arange(0.0, 360.0, 1.0)
    for variant in EXERCISE.variants(range(100)):
        given = {n: variant.given[n] for n in ("r1", "r2", "r3", "r4", "mode")}
        found = EXERCISE.solve(**given, theta2=crank, only=("theta3", "theta4"))
        at_B = abs((found["theta3"] - found["theta4"] + 180) % 360 - 180)
        assert at_B.min() > 29.99
        assert at_B.max() < 150.01


def test_mistakes_carry_their_consequences():
    """On the 3-4-5 triangle that is right-angled at B, by hand: theta3 + theta4 has sine 0.28."""
    given = {**EXERCISE.solution.known[1][0]}
    names = ("omega3", "omega4", "v_B", "alpha3", "a_BA_t", "a_BA_n")

    def mistaken(name):
        return EXERCISE.solution.mistaken(name).evaluate(
            names, {k: v if k == "mode" else float(v) for k, v in given.items()}
        )

    summed = mistaken("sum_in_denominator")
    assert summed["omega3"] == pytest.approx(-3 / 0.28)
    assert summed["v_B"] == pytest.approx(90 / 0.28)
    assert summed["alpha3"] == pytest.approx((-240 - 450 - 30 * (3 / 0.28) ** 2) / 40)
    assert mistaken("signs_of_omegas")["omega4"] == 3
    assert mistaken("signs_of_omegas")["alpha3"] == pytest.approx(-24)
    assert mistaken("no_normal_terms")["alpha3"] == pytest.approx(-6)
    assert mistaken("alpha2_left_out")["a_BA_t"] == pytest.approx(-18 * 40)
    assert mistaken("other_mode")["alpha3"] == pytest.approx(12)
