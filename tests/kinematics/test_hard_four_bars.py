"""Four-bars where textbook formulas lose their digits, against fifty digits. Lengths: ground, crank,
coupler, rocker."""

import math

import numpy as np
import pytest
from reference import away, four_bar, mp, relative
from tables import each_row

from coursework.errors import CannotAssemble, Undefined, WrongValue
from coursework.kinematics.angles import Degrees
from coursework.kinematics.four_bar import FourBar
from coursework.kinematics.margins import exact_sum

EPS = 2.0**-52
CHANGE_POINT = (100.0, 50.0, 70.0, 80.0)
PARALLELOGRAM = (100.0, 40.0, 100.0, 40.0)
KITE = (60.0, 60.0, 100.0, 100.0)
NEAR = (1e-4, 1e-6, 1e-8, 1e-9, 1e-12)


def position_error(lengths, theta, side=1, **policy):
    """Error of the joint B over the longest link, through the points and through the angles."""
    linkage = FourBar(*lengths, side, **policy)
    coupler, rocker, joint = four_bar(*lengths, theta, side)
    longest = max(lengths)
    found = linkage.pins(theta)[1]
    angles = linkage.angles(theta)
    by_point = abs(mp.mpc(found) - joint) / longest
    by_angles = lengths[2] * away(angles[0], coupler), lengths[3] * away(angles[1], rocker)
    return max(float(by_point), max(by_angles) / longest)


@each_row("near", NEAR)
@each_row("side", [1, -1])
def test_the_change_point_costs_no_digit_of_position(near, side):
    # No term is a difference of nearly equal lengths: 4 ulp of the longest link, as anywhere else.
    assert position_error(CHANGE_POINT, math.pi - near, side) <= 4 * EPS
    assert position_error(CHANGE_POINT, math.pi + near, side) <= 4 * EPS


@each_row("near", NEAR)
@each_row("side", [1, -1])
def test_rates_keep_their_limits_at_the_change_point(near, side):
    # rho = sin/S is a quotient of two numbers that are each right to the last digits.
    theta = math.pi - near
    (coupler, rocker), (coupler_2, rocker_2) = FourBar(*CHANGE_POINT, side).coefficients(theta, order=2)
    for found, found_2, angle in ((coupler, coupler_2, 0), (rocker, rocker_2, 1)):
        with mp.workdps(80):
            slope = [
                mp.diff(lambda t, i=angle: four_bar(*CHANGE_POINT, t, side)[i], mp.mpf(theta), n)
                for n in (1, 2)
            ]
        assert relative(found, slope[0]) < 8 * EPS
        assert relative(found_2, slope[1]) < 32 * EPS


def test_the_two_policies_at_a_change_point():
    kept, smooth = FourBar(*CHANGE_POINT), FourBar(*CHANGE_POINT, smooth=True)
    before, after = math.pi - 1e-9, math.pi + 1e-9
    # The one-sided limits of the rocker's rate ratio in the two modes.
    assert kept.coefficients(before)[0][1] == pytest.approx(0.774292, abs=1e-6)
    assert kept.coefficients(after)[0][1] == pytest.approx(-0.107625, abs=1e-6)
    assert smooth.coefficients(before)[0][1] == pytest.approx(0.774292, abs=1e-6)
    assert smooth.coefficients(after)[0][1] == pytest.approx(0.774292, abs=1e-6)
    half_turn = Degrees(180)
    (at,), (left,), (right,) = (smooth.coefficients(theta) for theta in (half_turn, before, after))
    assert at == pytest.approx(left, rel=1e-8)
    assert at == pytest.approx(right, rel=1e-8)


def test_rates_at_a_change_point_do_not_exist_when_the_mode_is_kept():
    kept, half_turn = FourBar(*CHANGE_POINT), Degrees(180)
    assert np.isfinite(kept.angles(half_turn)).all()
    with pytest.raises(Undefined, match="in line"):
        kept.motion(half_turn, order=1)
    rates = kept.coefficients(Degrees(np.array([90.0, 180.0, 270.0])))[0]
    assert np.array_equal(np.isnan(rates), [[False, True, False]] * 2)


def test_a_smooth_change_point_linkage_comes_back_after_two_turns():
    smooth = FourBar(*CHANGE_POINT, smooth=True)
    open_, crossed = FourBar(*CHANGE_POINT), FourBar(*CHANGE_POINT, "crossed")
    first, second = Degrees(140), Degrees(140 + 360)
    assert smooth.angles(first) == pytest.approx(open_.angles(first), abs=1e-14)
    assert smooth.angles(second) == pytest.approx(crossed.angles(second), abs=1e-14)
    assert smooth.angles(Degrees(140 + 720)) == smooth.angles(first)


@each_row("theta", [1e-8, 1e-7, 1e-3, 1.0, math.pi - 1e-7, math.pi, 4.0, 2 * math.pi])
def test_a_smooth_parallelogram_stays_one(theta):
    smooth = FourBar(*PARALLELOGRAM, smooth=True)
    crank_pin, joint = smooth.pins(theta)
    assert abs(joint - crank_pin - 100.0) < 4 * EPS * 100
    coupler, rocker = smooth.coefficients(theta)[0]
    assert abs(coupler) < 4 * EPS
    assert abs(rocker - 1) < 4 * EPS


def test_the_antiparallelogram_has_its_own_rate_at_half_a_turn():
    # -(d - a)/(d + a), from the similar triangles of the crossed position.
    crossed = FourBar(*PARALLELOGRAM, "crossed", smooth=True)
    assert relative(crossed.coefficients(Degrees(180))[0][1], -mp.mpf(60) / 140) < 4 * EPS


def test_a_parallelogram_turned_twice_never_becomes_its_antiparallelogram():
    turned = Degrees(np.arange(720.0))
    crank_pin, joint = FourBar(*PARALLELOGRAM, smooth=True).pins(turned)
    assert abs(joint - crank_pin - 100).max() < 1e-14 * 100
    _, rocker = FourBar(*PARALLELOGRAM, smooth=True).angles(turned)
    assert abs(np.exp(1j * rocker) - (turned.cos + 1j * turned.sin)).max() < 8 * EPS


@each_row("theta", [1e-3, 1e-6, 1e-7, 1e-9])
def test_a_kite_keeps_its_digits_while_the_pins_close_up(theta):
    # AD goes to 0; its square is a product, never a difference.
    assert position_error(KITE, theta) <= 4 * EPS
    (found,) = FourBar(*KITE).coefficients(theta)
    with mp.workdps(80):
        slope = [mp.diff(lambda t, i=i: four_bar(*KITE, t)[i], mp.mpf(theta)) for i in (0, 1)]
    assert max(relative(f, s) for f, s in zip(found, slope, strict=True)) < 16 * EPS


def test_a_kite_with_its_pins_together_is_undefined():
    with pytest.raises(Undefined, match="anywhere"):
        FourBar(*KITE).angles(0.0)
    coupler, rocker = FourBar(*KITE).angles(np.array([0.0, 1e-9]))
    assert np.array_equal(np.isnan([coupler, rocker]), [[True, False], [True, False]])
    rates = FourBar(*KITE).coefficients(np.array([0.0, 1e-3]), order=3)
    assert np.array_equal(np.isnan(rates), [[[True, False]] * 2] * 3)


@each_row("margin", [1e-2, 1e-4, 1e-7, 1e-10, 1e-13, 0.0, 2.0**-46])
def test_the_error_does_not_grow_as_the_margin_shrinks(margin):
    # b + c - a - d = margin: the sum of the four lengths is formed without rounding, once.
    lengths = (100.0 - margin, 50.0, 70.0, 80.0)
    for theta in (math.pi, math.pi - 1e-9, math.pi - 1e-3):
        assert position_error(lengths, theta) <= 4 * EPS


@each_row("beyond", [1, 2, 5, 40])
def test_lengths_of_many_digits_have_an_exact_margin_too(beyond):
    # The ground is a few last digits short of b + c - a, of which no partial sum is exact.
    crank, coupler, rocker = 50.1, 70.3, 80.7
    ground = coupler + rocker - crank
    for _ in range(beyond):
        ground = math.nextafter(ground, 0)
    assert 0 < math.fsum((coupler, rocker, -ground, -crank)) < 1e-12
    for theta in (math.pi, math.pi - 1e-9, math.pi - 1e-7):
        assert position_error((ground, crank, coupler, rocker), theta) <= 4 * EPS
    alone = FourBar(ground, crank, coupler, rocker)
    assert FourBar(np.array([ground, 100.0]), crank, coupler, rocker).margins[0][0] == alone.margins[0]


def test_the_sum_of_an_array_is_as_exact_as_that_of_a_number():
    a, b = 0.1 * np.arange(1, 200), 1e3 / np.arange(1, 200)
    c, d = 1e-17 * np.arange(200, 1, -1), 1e9 * np.sqrt(np.arange(1, 200))
    terms = np.stack([d, a, -b, c, -d, b, -a])
    assert np.array_equal(exact_sum(*terms), [math.fsum(column) for column in terms.T])


@each_row("theta", [1e-7, 1e-5, 1e-3])
def test_pins_that_almost_meet_cost_no_digit(theta):
    # AD is a hundred thousand times shorter than the bodies it carries.
    assert position_error((60.001, 60.0, 100.0, 100.0005), theta) <= 8 * EPS


DOUBLE_ROCKER = (90.0, 70.0, 40.0, 50.0)


@each_row("near", [1e-3, 1e-6, 1e-9, 1e-12, 1e-15])
def test_near_a_limit_the_loop_closes_and_the_error_is_the_conditioning(near):
    # The position itself moves by eps/sqrt(near): what is asserted is that the loop closes.
    linkage = FourBar(*DOUBLE_ROCKER)
    _, limit = linkage.limits()
    theta = limit - near
    crank_pin, joint = linkage.pins(theta)
    assert abs(crank_pin - mp.mpf(70) * mp.expj(theta)) <= 4 * EPS * 90
    assert abs(abs(joint - crank_pin) - 40) <= 4 * EPS * 90
    assert abs(abs(joint - 90) - 50) <= 4 * EPS * 90
    coupler, rocker = linkage.angles(theta)
    gap = crank_pin + 40 * mp.expj(coupler) - 90 - 50 * mp.expj(rocker)
    assert abs(gap) <= 8 * EPS * 90
    assert linkage.conditioning(theta) == pytest.approx(
        1 / math.sin(linkage.transmission_angle(theta)), rel=1e-6
    )


def test_limits_are_those_of_the_law_of_cosines():
    stretched = FourBar(*DOUBLE_ROCKER).limits()
    d, a, b, c = map(mp.mpf, DOUBLE_ROCKER)
    assert stretched[0] == 0.0
    assert relative(stretched[1], mp.acos((a**2 + d**2 - (b + c) ** 2) / (2 * a * d))) < 4 * EPS
    least, greatest = FourBar(50.0, 40.0, 80.0, 50.0).limits()
    assert greatest == math.pi
    assert relative(least, mp.acos(mp.mpf(40**2 + 50**2 - 30**2) / (2 * 40 * 50))) < 4 * EPS
    assert FourBar(*CHANGE_POINT).limits() == (0.0, math.pi)
    assert np.isnan(FourBar(100.0, 10.0, 10.0, 10.0).limits()).all()
    # So near a change point that cos^2 of half the limit is 1e-14.
    edge = (100.0, 50.0, 70.0, 80.0 - 1e-11)
    d, a, b, c = map(mp.mpf, edge)
    limit = mp.acos((a**2 + d**2 - (b + c) ** 2) / (2 * a * d))
    assert abs((mp.pi - limit) / (mp.pi - FourBar(*edge).limits()[1]) - 1) < 1e-6
    assert not FourBar(*edge).turns_fully()
    assert FourBar(*CHANGE_POINT).turns_fully()


@each_row("shift", [-560, -200, 3, 200, 530])
def test_a_unit_that_is_a_power_of_two_changes_no_bit(shift):
    # Lengths near 1e-170 and 1e160 among them: squares would vanish or overflow.
    theta = np.linspace(-4, 4, 57)
    lengths, scaled = CHANGE_POINT, [math.ldexp(x, shift) for x in CHANGE_POINT]
    for mode in ("open", "crossed"):
        one, other = FourBar(*lengths, mode), FourBar(*scaled, mode)
        assert np.array_equal(
            one.motion(theta, 2.0, 3.0, 4.0, order=3), other.motion(theta, 2.0, 3.0, 4.0, order=3)
        )
        for here, there in zip(one.pins(theta), other.pins(theta), strict=True):
            assert np.array_equal(np.ldexp(here.real, shift), there.real)
            assert np.array_equal(np.ldexp(here.imag, shift), there.imag)


@each_row("unit", [1e160, 1e-170, 1e-6])
def test_any_unit_gives_the_same_digits(unit):
    lengths = [x * unit for x in (100.0, 40.0, 80.0, 70.0)]
    assert position_error(lengths, 1.0) <= 4 * EPS
    found, expected = (FourBar(*x).motion(1.0, 2.0, 3.0)[:6] for x in (lengths, (100, 40, 80, 70)))
    assert found == pytest.approx(expected, rel=1e-14)


@each_row("theta", [1e-3, 1.0, 3.0])
def test_very_unequal_lengths_lose_nothing(theta):
    # A Newton step after a closed form is 1e6 times worse here; there is none.
    assert position_error((1.5, 1.0, 1e6, 1e6), theta) <= 4 * EPS


def transmission_of(b, c, m):
    """The law of cosines, on the squared diagonal."""
    return mp.acos((mp.mpf(b) ** 2 + mp.mpf(c) ** 2 - m) / (2 * mp.mpf(b) * mp.mpf(c)))


def test_the_transmission_angle_is_right_when_small():
    lengths = (1 + 1e-9, 1.0, 1.0, 1.0)
    found = FourBar(*lengths).transmission_angle(0.0)
    expected = transmission_of(1, 1, (mp.mpf(lengths[0]) - 1) ** 2)
    assert relative(found, expected) < 4 * EPS


def test_the_sine_of_the_transmission_angle_is_right_near_half_a_turn():
    # f = a + d falls short of b + c by 1e-15.
    lengths = (1.1 - 1e-15, 0.9, 1.0, 1.0)
    linkage, half_turn = FourBar(*lengths), Degrees(180)
    expected = transmission_of(1, 1, (mp.mpf(lengths[0]) + mp.mpf(0.9)) ** 2)
    assert relative(1 / linkage.conditioning(half_turn), mp.sin(expected)) < 4 * EPS
    assert away(linkage.transmission_angle(half_turn), expected) < 2 * EPS


def test_the_transmission_angle_grows_with_the_diagonal():
    theta = np.concatenate([np.geomspace(1e-12, 1e-2, 60), np.linspace(0.02, math.pi, 200)])
    assert (np.diff(FourBar(1 + 1e-12, 1.0, 1.5, 1.5).transmission_angle(theta)) > 0).all()


@each_row("turns", [1, 2, 10**9, 10**13 + 1])
def test_whole_turns_cost_no_digit(turns):
    linkage = FourBar(100, 40, 80, 70)
    assert linkage.angles(Degrees(75.0 + 360 * turns)) == linkage.angles(Degrees(75.0))


def test_large_accelerations_are_right_by_their_conditioning_not_their_size():
    # 1e-6 rad before the limit: the acceleration is 1e9, and right to what the angle's last digit allows.
    linkage = FourBar(*DOUBLE_ROCKER)
    theta = linkage.limits()[1] - 1e-6
    found = linkage.coefficients(theta, order=2)[1]
    with mp.workdps(80):
        slope = [mp.diff(lambda t, i=i: four_bar(*DOUBLE_ROCKER, t)[i], mp.mpf(theta), 2) for i in (0, 1)]
    assert abs(slope[1]) > 1e7
    assert max(relative(f, s) for f, s in zip(found, slope, strict=True)) < 1e-8


def test_what_does_not_close_says_by_how_much():
    with pytest.raises(CannotAssemble, match=r"gap 0\.5"):
        FourBar(0.9 + 0.5, 0.5, 0.2, 0.2).angles(0.0)
    # The gap of an exact margin keeps its digits where the difference of the lengths has none.
    with pytest.raises(CannotAssemble, match=r"gap 1\.42e-14"):
        FourBar(math.nextafter(100, 101), 50.0, 70.0, 80.0).angles(Degrees(180))
    with pytest.raises(CannotAssemble, match=r"gap 4e\+159"):
        FourBar(1e160, 1e160, 8e159, 8e159).angles(Degrees(180))


def test_what_does_not_close_is_nan_there_and_only_there():
    linkage = FourBar(*DOUBLE_ROCKER)
    theta = np.linspace(-math.pi, math.pi, 1001)
    beyond = abs(theta) > linkage.limits()[1]
    motion = linkage.motion(theta, 1.0, 1.0, 1.0, order=3)
    assert beyond.any()
    for quantity in (
        *motion,
        linkage.pins(theta)[1],
        linkage.transmission_angle(theta),
        linkage.conditioning(theta),
    ):
        assert np.array_equal(np.isnan(quantity), beyond)


def test_lengths_that_are_none_are_refused():
    with pytest.raises(WrongValue, match="coupler is -80"):
        FourBar(100, 40, -80, 70)
    with pytest.raises(WrongValue, match="finite"):
        FourBar(100, 40, 80, 70).angles(math.inf)
    found = FourBar(np.array([100, 100.0]), 40, np.array([80, -80.0]), 70).angles(1.0)
    assert np.array_equal(np.isnan(found), [[False, True]] * 2)
