"""Torque of a shaper: against powers and areas in fifty digits, where the guide hardly swings, and where it
has no two crossings."""

import mpmath
import numpy as np
import pytest
from sweeps import sampled
from tables import each_row

import coursework
from coursework.errors import CannotAssemble, Undefined
from coursework.scenes.scenes import Scene

EXERCISE = coursework.open_course()["shaper_torque"]
ASKED = tuple(part.quantity for part in EXERCISE.spec.parts)
OF_THE_TURN = ("work", "mean_torque", "power", "theta_rise", "theta_fall", "excess", "J")
PLAIN = {
    "r1": 250.0,
    "r2": 110.0,
    "r4": 450.0,
    "r5": 200.0,
    "h": 430.0,
    "theta2": 25.0,
    "omega2": 6.0,
    "F": 900.0,
    "delta": 0.05,
}

every_seed = pytest.mark.parametrize("seed", sampled(range(20), range(2)))


def zero(function, low, high):
    """By halving, to fifty digits; the signs at the ends differ."""
    is_low = function(low) > 0
    for _ in range(190):
        middle = (low + high) / 2
        low, high = (middle, high) if (function(middle) > 0) == is_low else (low, middle)
    return low


def exact(r1, r2, r4, r5, h, theta2, omega2, F, delta):
    """Fifty digits: C from the circle about P, its velocity by differences, what the flywheel gives as an
    area."""
    with mpmath.workdps(50):
        r1, r2, r4, r5, h, omega2, F, delta = map(mpmath.mpf, (r1, r2, r4, r5, h, omega2, F, delta))
        start, swing = mpmath.mpf(theta2) * mpmath.pi / 180, mpmath.acos(mpmath.sqrt(r1**2 - r2**2) / r1)

        def ram(theta):
            A = 1j * r1 + r2 * mpmath.expj(theta)
            P = r4 * A / abs(A)
            return mpmath.re(P) + mpmath.sqrt(r5**2 - (h - mpmath.im(P)) ** 2)

        def needed(theta):
            """The torque, by the power of the force, on the working stroke."""
            return -F / 1000 * mpmath.diff(ram, theta)

        mean = mpmath.quad(needed, [-swing, mpmath.pi / 2, mpmath.pi + swing]) / (2 * mpmath.pi)

        def beyond(theta):
            return needed(theta) - mean

        rise, fall = (zero(beyond, end, mpmath.pi / 2) for end in (-swing, mpmath.pi + swing))
        excess = mpmath.quad(beyond, [rise, mpmath.pi / 2, fall])
        return {
            "v_C": omega2 * mpmath.diff(ram, start),
            "torque": needed(start),
            "work": 2 * mpmath.pi * mean,
            "mean_torque": mean,
            "power": mean * omega2,
            "theta_rise": mpmath.degrees(rise),
            "theta_fall": mpmath.degrees(fall),
            "excess": excess,
            "J": excess / (delta * omega2**2),
        }


def errors(found, reference):
    """Relative; of an angle, relative to a turn."""
    size = {name: 360 if name.startswith("theta") else abs(value) for name, value in reference.items()}
    return {name: abs(float((found[name] - reference[name]) / size[name])) for name in found}


@every_seed
def test_answers_are_those_of_powers_and_areas_in_fifty_digits(seed):
    variant = EXERCISE.variant(seed)
    answers = variant.solution()
    assert set(answers) == set(ASKED)
    assert max(errors(answers, exact(**variant.given)).values()) < 1e-12


@each_row("change", [{"r2": 1e-6}, {"r2": 225.0, "r5": 400.0, "h": 300.0}, {"r5": 2e4}])
def test_crossings_and_excess_keep_their_digits(change):
    """A guide that hardly swings, one that swings far, a very long rod."""
    given = {**PLAIN, **change}
    found = EXERCISE.solve(**given, only=OF_THE_TURN)
    assert max(errors(found, exact(**given)).values()) < 1e-11


def test_many_variants_at_once_have_the_crossings_that_each_has_alone():
    variants = EXERCISE.variants(range(200))
    row = {name: np.array([v.given[name] for v in variants]) for name in PLAIN}
    together = EXERCISE.solve(**row, only=OF_THE_TURN)
    for place in range(0, 200, 10):
        alone = EXERCISE.solve(**variants[place].given, only=OF_THE_TURN)
        for name in OF_THE_TURN:
            assert together[name][place] == pytest.approx(alone[name], rel=1e-13, abs=1e-12), name
    grid = EXERCISE.solve(**{**PLAIN, "r5": np.full((3, 2), 200.0)}, only="excess")["excess"]
    np.testing.assert_allclose(grid, EXERCISE.solve(**PLAIN, only="excess")["excess"], rtol=1e-13)
    assert grid.shape == (3, 2)


def test_the_middle_of_what_is_told_of_a_crossing_is_seldom_right():
    right = 0
    for variant in EXERCISE.variants(range(40)):
        told = variant.exercise.spec.statement_values(variant.given)
        given = {f"theta_{name}": sum(told[name]) / 2 for name in ("rise", "fall")}
        right += sum(variant.grade(given)[i].verdict == "correct" for i in given)
    assert right < 0.15 * 80


@every_seed
def test_the_statement_tells_bounds_of_each_crossing(seed):
    variant = EXERCISE.variant(seed)
    told, found = variant.exercise.spec.statement_values(variant.given), variant.solution()
    for name, quantity in (("rise", "theta_rise"), ("fall", "theta_fall")):
        low, high = told[name]
        assert low + 0.1 < found[quantity] < high - 0.1
        assert high - low == 30
        assert f"{low}^{{\\circ}}" in variant.text.section(quantity).text


def test_an_error_of_a_degree_at_a_crossing_hardly_changes_the_excess():
    variant = EXERCISE.variant(0)
    right = variant.solution()
    off = {"theta_rise": right["theta_rise"] + 1, "theta_fall": right["theta_fall"] - 1}
    excess = EXERCISE.solve(**variant.given, **off, only="excess")["excess"]
    assert 1e-6 < abs(excess / right["excess"] - 1) < 2e-3


@every_seed
def test_the_flywheel_is_balanced_over_the_turn_and_swings_by_the_excess(seed):
    """The torque over the turn, summed at small steps, on the working stroke alone."""
    given = dict(EXERCISE.variant(seed).given)
    theta = np.arange(3600) / 10
    torque = EXERCISE.solve(**{**given, "theta2": theta}, effects=("load",), only="torque")["torque"]
    found = EXERCISE.solve(**given, only=("mean_torque", "excess", "sigma"))
    assert torque.mean() == pytest.approx(found["mean_torque"], rel=1e-6)
    stored = np.cumsum(found["mean_torque"] - torque) * np.radians(0.1)
    assert np.ptp(stored) == pytest.approx(found["excess"], rel=1e-4)
    working = ((theta + found["sigma"]) % 360) < 180 + 2 * found["sigma"]
    assert (torque[~working] == 0).all()
    assert (torque[working] >= 0).all()


@every_seed
def test_the_stated_mechanism_asks_the_same_of_the_drive(seed):
    given = dict(EXERCISE.variant(seed).given)
    columns = Scene(EXERCISE, given, ("load",), show=("drive_torque",)).over_cycle(40).columns
    np.testing.assert_allclose(
        columns["drive_torque"], columns["torque"], atol=1e-11 * columns["torque"].max()
    )


def test_without_the_cut_nothing_is_asked_of_the_drive():
    assert EXERCISE.solve(**PLAIN, only="torque", effects=())["torque"] == 0
    assert "load" not in EXERCISE.plan(("torque",), effects=())
    assert EXERCISE.solve(**PLAIN, effects=("load",), only="torque")["torque"] > 0
    assert set(EXERCISE.plan(("torque",), effects=("load",))).isdisjoint(OF_THE_TURN)


def test_a_ram_that_turns_back_on_the_way_has_no_working_stroke():
    given = {**PLAIN, "r1": 100.0, "r2": 60.0, "r4": 200.0, "r5": 100.0, "h": 256.0, "theta2": 90.0}
    for name in OF_THE_TURN:
        with pytest.raises(Undefined, match="turns back more than twice"):
            EXERCISE.solve(**given, only=name)
    row = EXERCISE.solve(**{**given, "h": np.array([256.0, 180.0])}, only=OF_THE_TURN)
    for name in OF_THE_TURN:
        assert np.isnan(row[name]).tolist() == [True, False], name


def test_a_torque_with_two_humps_has_no_pair_of_crossings():
    """A short and steep rod slows the ram within its stroke."""
    given = {**PLAIN, "r1": 100.0, "r2": 80.0, "r4": 600.0, "r5": 170.0, "h": 436.0, "theta2": 90.0}
    with pytest.raises(Undefined, match="equals its mean at 4 crank angles"):
        EXERCISE.solve(**given, only="theta_rise")


def test_without_a_swing_or_a_rod_that_reaches_there_is_no_work():
    with pytest.raises(Undefined, match="does not oscillate"):
        EXERCISE.solve(**{**PLAIN, "r2": 260.0}, only="work")
    with pytest.raises(CannotAssemble, match="mm too short"):
        EXERCISE.solve(**{**PLAIN, "r5": 15.0}, only="excess")
    row = EXERCISE.solve(**{**PLAIN, "r2": np.array([260.0, 110.0])}, only=OF_THE_TURN)
    for name in OF_THE_TURN:
        assert np.isnan(row[name]).tolist() == [True, False], name
