"""Newton's method on closed chains, against closed forms, and what its certificate says."""

import math

import numpy as np
import pytest
from reference import mp
from tables import each_row

from coursework.errors import CannotAssemble, Undefined, WrongValue
from coursework.kinematics.angles import Degrees
from coursework.kinematics.chains import ClosedChain, Vector
from coursework.kinematics.four_bar import FourBar
from coursework.system.blocks import BLOCK, in_blocks

EPS = 2.0**-52
FOUR_BAR = ClosedChain(
    [[Vector("a", "crank"), Vector("b", "coupler"), Vector("c", "rocker", -1), Vector("d", 0.0, -1)]],
    ["coupler", "rocker"],
)
LENGTHS = {"d": 100.0, "a": 40.0, "b": 80.0, "c": 70.0}
NEAR = {"coupler": 0.5, "rocker": 1.5}

# An Assour group of class III: a plate held at its three pins by three bars, the first of them led by a
# crank.
TRIAD = ClosedChain(
    [
        [
            Vector(1.0, "crank"),
            Vector(3.0, "first"),
            Vector(2.0, "plate"),
            Vector(3.0, "second", -1),
            Vector(5.0, 0.0, -1),
        ],
        [
            Vector(1.0, "crank"),
            Vector(3.0, "first"),
            Vector(1.5, "plate", 1, 1.0),
            Vector(3.5, "third", -1),
            Vector(6.0, math.pi / 4, -1),
        ],
    ],
    ["first", "plate", "second", "third"],
)


def test_a_chain_finds_what_the_closed_form_finds():
    crank = np.linspace(0, 2 * math.pi, 400)
    pose = FOUR_BAR.solve(LENGTHS | {"crank": crank}, NEAR)
    coupler, rocker = FourBar(100, 40, 80, 70).angles(crank)
    assert pose.converged.all()
    assert pose.residual.max() < 4 * EPS * 100
    assert abs(np.exp(1j * pose.values["coupler"]) - np.exp(1j * coupler)).max() < 32 * EPS
    assert abs(np.exp(1j * pose.values["rocker"]) - np.exp(1j * rocker)).max() < 32 * EPS
    assert (abs(np.array(list(pose.values.values()))) <= math.pi).all()


def test_rates_of_a_chain_are_those_of_the_closed_form():
    pose = FOUR_BAR.solve(LENGTHS | {"crank": 1.0}, NEAR)
    rates = FOUR_BAR.rates(LENGTHS | {"crank": 1.0} | pose.values, {"crank": (2.0, 3.0, 4.0)}, order=3)
    motion = FourBar(100, 40, 80, 70).motion(1.0, 2.0, 3.0, 4.0, order=3)
    assert rates["coupler"] == pytest.approx(motion[2::2], rel=1e-13)
    assert rates["rocker"] == pytest.approx(motion[3::2], rel=1e-13)


def test_the_start_chooses_the_assembly():
    crossed = FOUR_BAR.solve(LENGTHS | {"crank": Degrees(60)}, {"coupler": -1.0, "rocker": -1.5})
    assert list(crossed.values.values()) == pytest.approx(
        FourBar(100, 40, 80, 70, "crossed").angles(math.pi / 3), abs=1e-14
    )


def triad_gaps(x, crank):
    """The loops once more, in other words: the plate's three pins, each at the end of its bar."""
    first, plate, second, third = x
    gaps = []
    for part, along in ((mp.cos, 1), (mp.sin, 0)):
        pin = part(crank) + 3 * part(first)
        gaps.append(pin + 2 * part(plate) - 5 * along - 3 * part(second))
        pivot = 6 * part(mp.mpf(math.pi / 4))
        gaps.append(pin + mp.mpf(1.5) * part(plate + 1) - pivot - mp.mpf(3.5) * part(third))
    return gaps


def test_a_triad_closes_and_moves_as_fifty_digits_say():
    names = ("first", "plate", "second", "third")
    pose = TRIAD.solve({"crank": 1.0}, {"first": 0.8, "plate": 0.0, "second": 2.0, "third": -2.5})
    found = [mp.mpf(pose.values[name]) for name in names]
    assert max(abs(gap) for gap in triad_gaps(found, mp.mpf(1))) < 32 * EPS * 6
    assert 1 < pose.condition < 100
    root = lambda crank: mp.findroot(lambda *x: triad_gaps(x, crank), found)  # noqa: E731
    here = root(mp.mpf(1))
    assert max(abs(f - r) for f, r in zip(found, here, strict=True)) < 32 * EPS * pose.condition
    rates = TRIAD.rates({"crank": 1.0} | pose.values, {"crank": (1.0, 0.0)}, order=2)
    step = mp.mpf(10) ** -12
    before, after = root(1 - step), root(1 + step)
    for i, name in enumerate(names):
        assert rates[name][0] == pytest.approx(float((after[i] - before[i]) / (2 * step)), rel=1e-12)
        assert rates[name][1] == pytest.approx(
            float((after[i] - 2 * here[i] + before[i]) / step**2), rel=1e-11
        )


@each_row("shift", [-500, 3, 500])
def test_a_chain_in_another_unit_changes_no_bit(shift):
    here = FOUR_BAR.solve(LENGTHS | {"crank": 1.0}, NEAR)
    there = FOUR_BAR.solve({k: math.ldexp(v, shift) for k, v in LENGTHS.items()} | {"crank": 1.0}, NEAR)
    assert here.values == there.values
    assert here.condition == there.condition


def test_what_cannot_close_raises_or_is_nan_and_not_converged():
    with pytest.raises(CannotAssemble, match="a gap of"):
        FOUR_BAR.solve(LENGTHS | {"a": 400.0, "crank": 1.0}, NEAR)
    pose = FOUR_BAR.solve(LENGTHS | {"a": np.array([40.0, 400.0, 40.0]), "crank": 1.0}, NEAR)
    assert pose.converged.tolist() == [True, False, True]
    assert np.array_equal(np.isnan(pose.values["coupler"]), [False, True, False])
    assert pose.residual[1] > 100
    assert np.isnan(pose.condition[1])


def test_a_loop_that_misses_by_little_is_not_closed():
    bodies = {"d": 3.0 + 1e-9, "a": 1.0, "b": 1.0, "c": 1.0, "crank": 0.0}
    with pytest.raises(CannotAssemble, match="gap of 1e-09"):
        FOUR_BAR.solve(bodies, {"coupler": 0.01, "rocker": 3.13})


def test_angles_come_out_within_half_a_turn_whatever_the_start():
    far = FOUR_BAR.solve(
        LENGTHS | {"crank": 1.0}, {"coupler": 0.5 + 4 * math.pi, "rocker": 1.5 - 6 * math.pi}
    )
    assert list(far.values.values()) == pytest.approx(FourBar(100, 40, 80, 70).angles(1.0), abs=1e-14)


def test_a_dead_point_shows_in_the_condition_and_has_no_rates():
    # At 1e-6 from its limit a double rocker's bodies are almost in line.
    rocker = FourBar(90, 70, 40, 50)
    crank = rocker.limits()[1] - 1e-6
    start = dict(zip(("coupler", "rocker"), rocker.angles(crank), strict=True))
    pose = FOUR_BAR.solve({"d": 90.0, "a": 70.0, "b": 40.0, "c": 50.0, "crank": crank}, start)
    assert 0.1 < pose.condition / rocker.conditioning(crank) < 10
    square = {"d": 4.0, "a": 1.0, "b": 1.0, "c": 2.0, "crank": Degrees(0), "coupler": 0.0}
    with pytest.raises(Undefined, match="dead point"):
        FOUR_BAR.rates(square | {"rocker": Degrees(180)}, {"crank": (1.0,)})


def test_a_chain_that_is_miscounted_is_refused():
    with pytest.raises(WrongValue, match="2 unknowns; 1"):
        ClosedChain([[Vector("a", "t")]], ["t"])
    with pytest.raises(WrongValue, match="'u'"):
        ClosedChain([[Vector("a", "t")]], ["t", "u"])


@each_row("shape", [(3, 2 * BLOCK + 5), (2 * BLOCK + 5, 3), (5, 7, 1000), (0, 4)])
def test_blocks_cover_every_element_once(shape):
    first = np.arange(math.prod(shape), dtype=float).reshape(shape)
    second = np.arange(shape[-1], dtype=float)
    sizes = []

    def kernel(x, y, z):
        sizes.append(np.broadcast(x, y).size)
        return x + y, x * 1j * z

    found = in_blocks(kernel, first, second, 2.0)
    assert np.array_equal(found[0], first + second)
    assert np.array_equal(found[1], first * 2j)
    assert found[0].dtype == float
    assert max(sizes) <= BLOCK
