"""Every exercise keeps its digits at hard places: the error is what the last digits of the given numbers make
anyway.

Against the formulas of its own solution in sixty digits; a new exercise is held to it without a line here.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from sixty_digits import SISTERS, Formulas
from sweeps import sampled
from tables import each_row

import coursework

COURSE = coursework.open_course()
MOST = 8  #: times what the last digits of value and data make
SEEDS = (0, 1)


@cache
def formulas(name, seed):
    return Formulas(COURSE, name, COURSE[name].variant(seed).given)


MEASURED = [name for name in COURSE.names if formulas(name, 0).names]
WITH_ANGLES = [name for name in MEASURED if formulas(name, 0).of_unit("deg")]
FEW = ("slotted_mechanism", "four_bar_motion", "velocity_polygon")
measured = pytest.mark.parametrize("name", sampled(MEASURED, FEW))
with_angles = pytest.mark.parametrize("name", sampled(WITH_ANGLES, FEW[:1]))


def too_far(own, changes):
    """Places and quantities whose error exceeds the bound."""
    tried, found = 0, []
    for change in changes:
        for name in own.names:
            # Textbooks know the stroke of a ram that turns back twice a turn, and of no other.
            if name == "stroke" and "alpha" in own.names and own.found(change, "alpha") is None:
                continue
            tried += 1
            if (excess := own.excess(change, name)) > MOST:
                found.append((name, change, excess))
    assert tried
    return found


def test_every_exercise_with_formulas_for_its_numbers_takes_part():
    assert set(SISTERS) < set(MEASURED)
    assert len(MEASURED) >= 23


@pytest.mark.parametrize("name", WITH_ANGLES)
def test_whole_turns_cost_no_digit(name):
    own = formulas(name, 0)
    turned = [change for turns in (1e3, 1e9, -1e9) for change in own.turned(turns)]
    for change in turned:
        ((angle, _),) = change.items()
        for quantity in own.names:
            if own.found(change, quantity) is not None:
                excess = own.excess(change, quantity, as_if={angle: own.given[angle]})
                assert excess <= MOST, (quantity, change)


def test_whole_turns_in_a_row_change_no_bit():
    exercise = COURSE["three_loop_shaper"]
    given = {n: v for n, v in exercise.variant(0).given.items() if n != "theta2"}
    within = np.array([-170.5, -3.25, 0.0, 71.0, 180.0])
    turned = within + 360.0 * np.array([-(10**9), 7, 10**6, 10**9, 2])
    names = ("theta5", "omega5", "x8_ddot")
    expected, found = (exercise.solve(**given, theta2=theta2, only=names) for theta2 in (within, turned))
    for name in names:
        assert found[name].tolist() == expected[name].tolist(), name


OAB = [{"angle_OAB": near} for near in (1e-3, 1e-6, 1e-9, 180 - 1e-6)]


@each_row("change", OAB)
@each_row("seed", SEEDS)
def test_crank_and_coupler_that_are_nearly_in_line_move_rocker_and_ram_exactly(change, seed):
    own = formulas("quick_return", seed)
    for name in ("omega4", "omega5", "v_C", "mechanical_advantage"):
        assert own.excess(change, name) <= MOST, name


@each_row("r2", [1e-3, 1e-6, 1e-9])
def test_a_small_crank_has_its_small_stroke(r2):
    own = formulas("quick_return", 0)
    assert own.excess({"r2": r2}, "stroke") <= MOST


@each_row("share", [0.0, 1e-9, -1e-9])
@each_row("near", [1e-2, 1e-3, 1e-4, 1e-6])
def test_a_block_beside_its_pivot_slides_by_its_acceleration(share, near):
    own = Formulas(COURSE, "slotted_mechanism", {"r1": 200.0, "theta1": 90.0, "omega2": 10.0, "alpha2": 0.0})
    for side in (-1, 1):
        change = {"r2": 200.0 * (1 + share), "theta2": -90 + side * near}
        for name in ("rA_ddot", "a_coriolis", "alpha4"):
            assert own.excess(change, name) <= MOST, name


@measured
@pytest.mark.parametrize("seed", sampled(SEEDS, SEEDS[:1]))
def test_short_links_cost_no_digit(name, seed):
    own = formulas(name, seed)
    assert too_far(own, [{}, *own.small(1e-3), *own.small(1e-9)]) == []


@measured
@pytest.mark.parametrize("share", [1e-9])
def test_links_that_are_nearly_equal_cost_no_digit(name, share):
    own = formulas(name, 0)
    assert too_far(own, [{}, *own.nearly_equal(share)]) == []


@with_angles
@pytest.mark.parametrize("near", sampled([1e-3, 1e-6, 1e-9], [1e-6]))
def test_angles_beside_the_quarters_cost_no_digit(name, near):
    own = formulas(name, 0)
    assert too_far(own, own.beside_quarters(near)) == []


@with_angles
@pytest.mark.parametrize("near", sampled([1e-3, 1e-6, 1e-9], [1e-6]))
def test_dead_positions_cost_no_digit_on_either_side(name, near):
    own = formulas(name, 0)
    places = own.beside_zeros(near)
    assert too_far(own, [{}, *places]) == []
