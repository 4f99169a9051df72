"""Where a slider that a rocker moves turns back, against fifty digits and by symmetry."""

from __future__ import annotations

import math

import numpy as np
import pytest
from reference import exact, four_bar, mp, relative
from tables import each_row

from coursework.errors import CannotAssemble
from coursework.kinematics.rocker_slider import RockerSlider

EPS = 2.0**-52
ORDINARY = RockerSlider(80.0, math.radians(30), 20.0, 70.0, 70.0, 1, 300.0, 100.0)
#: The rod lines up with the rocker within its swing, so that the slider turns back four times.
FOUR_TIMES = RockerSlider(80.0, math.radians(60), 30.0, 90.0, 60.0, 1, 100.0, 60.0)


def position(mechanism, crank_angle):
    """The slider's abscissa."""
    ground, turn, crank, coupler, rocker, _, rod, line = exact(*mechanism)
    joint = four_bar(ground, crank, coupler, rocker, mp.mpf(crank_angle) - turn, mechanism.side)[2] * mp.expj(
        turn
    )
    return mp.re(joint) + mp.sqrt(rod**2 - (line - mp.im(joint)) ** 2)


def turned_back(mechanism, near):
    """The crank angle at which it stands still."""
    return mp.findroot(
        lambda angle: mp.diff(lambda t: position(mechanism, t), angle), mp.mpf(near), tol=1e-40
    )


def spread(angle):
    return math.remainder(angle, 2 * math.pi)


@each_row(("mechanism", "count"), [(ORDINARY, 2), (FOUR_TIMES, 4)])
@each_row("side", [1, -1])
def test_the_slider_stands_still_there_and_nowhere_else(mechanism, count, side):
    mechanism = mechanism._replace(side=side)
    found = mechanism.turning_points()
    assert found.shape == (count,)
    assert mechanism.times_turned() == count
    for angle in found:
        assert abs(turned_back(mechanism, angle) - angle) < 1e-12
    # Between them it moves one way: as many changes of sense in a plain sweep.
    swept = [float(position(mechanism, angle)) for angle in np.arange(0, 2 * math.pi, 0.02)]
    sense = np.sign(np.diff([*swept, swept[0]]))
    assert (sense != np.roll(sense, 1)).sum() == count


def test_without_a_rod_in_line_it_turns_back_where_crank_and_coupler_are_in_line():
    """Triangles 50-70-80 folded, with 60 degrees at O, and 90-70-80 stretched, with cosine 2/3."""
    found = sorted(spread(angle) for angle in ORDINARY.turning_points())
    stretched = math.radians(30) + math.acos(2 / 3)
    folded = spread(math.radians(30) + math.radians(60) + math.pi)
    assert found == pytest.approx(sorted([stretched, folded]), abs=1e-13)


@each_row("mechanism", [ORDINARY, FOUR_TIMES])
def test_upside_down_it_turns_back_at_the_opposite_angles(mechanism):
    mirrored = mechanism._replace(
        ground_angle=-mechanism.ground_angle, side=-mechanism.side, line=-mechanism.line
    )
    found = sorted(spread(angle) for angle in mechanism.turning_points())
    seen = sorted(-spread(angle) for angle in mirrored.turning_points())
    assert seen == pytest.approx(found, abs=1e-13)


@each_row("size", [1e-3, 7.0, 1e5])
def test_its_size_does_not_matter(size):
    lengths = {
        n: size * getattr(FOUR_TIMES, n) for n in ("ground", "crank", "coupler", "rocker", "rod", "line")
    }
    larger = FOUR_TIMES._replace(**lengths)
    assert larger.turning_points() == pytest.approx(FOUR_TIMES.turning_points(), abs=1e-12)


def test_the_vector_of_the_rocker_is_that_of_two_circles():
    for side in (1, -1):
        mechanism = ORDINARY._replace(side=side)
        angles = np.array([0.3, 1.7, -2.5])
        pivot = mechanism.ground * np.exp(1j * mechanism.ground_angle)
        for angle, vector in zip(angles, mechanism.rocker_vectors(angles), strict=True):
            ground, turn, crank, coupler, rocker = exact(*mechanism[:5])
            joint = four_bar(ground, crank, coupler, rocker, mp.mpf(angle) - turn, side)[2] * mp.expj(turn)
            assert abs(joint - (vector + pivot)) < 1e-12
            assert abs(vector) == pytest.approx(mechanism.rocker, rel=1e-13)


def test_what_cannot_turn_is_refused_or_nan_in_its_row_alone():
    with pytest.raises(CannotAssemble, match="crank does not turn fully: the linkage lacks"):
        ORDINARY._replace(crank=60.0).turning_points()
    with pytest.raises(CannotAssemble, match="rod does not reach its line all turn"):
        ORDINARY._replace(rod=30.0).turning_points()
    found = ORDINARY._replace(crank=np.array([20.0, 60.0]), rod=np.array([[300.0], [30.0]])).turning_points()
    assert found.shape[:-1] == (2, 2)
    assert np.isnan(found).all(axis=-1).tolist() == [[False, True], [True, True]]
    assert found[0, 0][np.isfinite(found[0, 0])].tolist() == ORDINARY.turning_points().tolist()


def test_a_mechanism_with_fewer_turns_than_its_neighbour_ends_in_nan():
    both = RockerSlider(*(np.array(pair) for pair in zip(ORDINARY, FOUR_TIMES, strict=True)))
    assert np.isfinite(both.turning_points()).sum(axis=-1).tolist() == [2, 4]


#: The frame is the shortest: the rocker turns fully, and crank and coupler are never in line.
DOUBLE_CRANK = RockerSlider(20.0, math.radians(25), 60.0, 50.0, 45.0, 1, 200.0, 30.0)


SHORT = [m._replace(crank=crank) for m in (ORDINARY, FOUR_TIMES) for crank in (1e-3, 1e-6, 1e-9)]


@each_row("mechanism", [ORDINARY, FOUR_TIMES, DOUBLE_CRANK, *SHORT])
@each_row("side", [1, -1])
def test_a_stroke_keeps_its_digits_however_small_the_crank(mechanism, side):
    mechanism = mechanism._replace(side=side)
    # Where the slider stands still, an angle's last digit moves nothing.
    places = [position(mechanism, angle) for angle in mechanism.turning_points()]
    stroke = max(places) - min(places)
    # Where the rod is nearly in line with the rocker, the slider moves less than the crank.
    assert relative(mechanism.stroke(), stroke) < 16 * EPS * max(1, 2 * mechanism.crank / stroke)


def test_strokes_of_a_row_are_those_of_its_mechanisms():
    every = (ORDINARY, FOUR_TIMES, DOUBLE_CRANK, ORDINARY._replace(crank=60.0), ORDINARY._replace(rod=30.0))
    row = RockerSlider(*(np.array(column) for column in zip(*every, strict=True))).stroke()
    assert row[:3].tolist() == [mechanism.stroke() for mechanism in every[:3]]
    assert np.isnan(row[3:]).all()
    assert RockerSlider(
        *(np.array(column) for column in zip(*every, strict=True))
    ).times_turned().tolist() == [2, 4, 2, 0, 0]
    with pytest.raises(CannotAssemble, match="rod does not reach its line all turn"):
        every[4].stroke()


@each_row("near", [1e-2, 1e-4, 1e-6, 1e-8])
def test_two_turns_back_that_are_nearly_one_are_counted(near):
    """The rod folds onto the rocker, in its direction turned by half, just before the rocker turns back, or
    never."""
    end = math.radians(60 + 180) - math.acos((80**2 + 60**2 - 120**2) / (2 * 80 * 60))
    reached = 80 * math.sin(math.radians(60)) - 40 * np.sin(end + near * np.array([-1, 1]))
    assert FOUR_TIMES._replace(line=reached).times_turned().tolist() == [2, 4]
