"""Mechanisms move as they should: every length kept, vectors the slopes of paths."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest
from animations import COURSE, DRIVEN, FILMED, MOVING, WITH_POINTS, animation, points_at

import coursework
from coursework.api import Variant
from coursework.course.exercise import CourseExercise
from coursework.errors import BadCourse, UnknownName, WrongValue
from coursework.rendering.displayed import DisplayedAnimation as Animation
from coursework.scenes.scenes import Scene

#: Moved between the ends of a jack, in every variant, at the jack's own rate: see its tests.
SWINGING = ("jack_mechanism",)


@pytest.fixture
def four_bar_that_swings():
    """Neither bar turns fully: a triple rocker."""
    exercise = COURSE["four_bar_positions"]
    given = {"r1": 200.0, "r2": 100.0, "r3": 90.0, "r4": 80.0, "theta2": 20.0}
    return Animation(coursework.Variant(exercise, 0, given, "en"), count=24)


@pytest.mark.parametrize("name", DRIVEN)
@pytest.mark.parametrize("seed", [0, 5])
def test_every_driven_mechanism_keeps_the_length_of_its_links_over_the_cycle(name, seed):
    moved = animation(name, seed)
    links = [[e for e in elements if hasattr(e, "weld")] for elements in moved.frames]
    assert links[0]
    for one in zip(*links, strict=True):
        sides = np.array([[abs(q - p) for p, q in e.bars()] for e in one])
        assert np.ptp(sides, axis=0) == pytest.approx(0, abs=1e-9 * sides.max())


@pytest.mark.parametrize("name", DRIVEN)
def test_the_sheets_position_comes_first_and_a_loop_ends_where_it_began(name):
    moved = animation(name)
    assert moved.order[0] == moved.order[-1] == moved.first
    assert moved.frames[moved.first] == moved.variant.figure.elements
    angle = moved.variant.exercise.driver_angle(moved.variant.given)
    assert (moved.angles[moved.first] - angle) % 360 == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("name", [name for name in DRIVEN if name not in SWINGING])
def test_a_full_turn_visits_every_angle_once_the_way_the_driver_turns(name):
    moved = next(animation(name, seed) for seed in range(1, 30) if animation(name, seed).turns)
    speed = moved.variant.given.get(moved.variant.exercise.spec.driver.speed, 1.0)
    turned = np.unwrap(moved.angles[list(moved.order)], period=360)
    steps = np.diff(turned) * np.sign(speed)
    assert steps.sum() == pytest.approx(360)
    assert ((steps > 0) & (steps <= 10 + 1e-9)).all()
    # Every tenth degree, and others between them where something goes fast.
    tenths = turned[0] + np.sign(speed) * np.arange(0.0, 361.0, 10.0)
    assert abs(turned[:, None] - tenths).min(axis=0) == pytest.approx(np.zeros(37), abs=1e-6)


def test_a_linkage_that_does_not_turn_fully_swings_between_its_limits_and_back(four_bar_that_swings):
    moved = four_bar_that_swings
    low, high = moved.angles[[0, -1]]
    # Coupler and rocker in line: the triangle O, A, C has sides 200, 100 and 170.
    limit = np.degrees(np.arccos((200**2 + 100**2 - 170**2) / (2 * 200 * 100)))
    assert (low, high) == pytest.approx((-limit, limit), abs=1e-6)
    visited = moved.angles[list(moved.order)]
    assert {visited.max(), visited.min()} == {high, low}
    assert all(abs(a - b) == 1 for a, b in zip(moved.order, moved.order[1:], strict=False))
    assert (np.diff(visited) != 0).all()


def test_a_swing_slows_down_at_its_ends_as_a_pendulum_does(four_bar_that_swings):
    moved = four_bar_that_swings
    timed = [e for e in ET.fromstring(moved.svg()).iter() if e.get("keyTimes")]
    assert timed
    times = np.array([float(t) for t in timed[0].get("keyTimes").split(";")])
    assert (times[0], times[-1]) == (0, 1)
    assert len(times) == len(timed[0].get("values").split(";"))
    assert (np.diff(times) > 0).all()
    half = moved.angles[-1]  # the limits are opposite
    start = np.arcsin(moved.angles[moved.first] / half)
    assert half * np.sin(2 * np.pi * times + start) == pytest.approx(
        moved.angles[list(moved.order)], abs=0.01
    )


def test_paths_are_smooth_up_to_the_limits_of_a_swing(four_bar_that_swings):
    path = four_bar_that_swings.points["B_1"].position
    steps = np.abs(np.diff(path))
    assert max(steps[:10].max(), steps[-10:].max()) < 0.05 * steps.sum()


def motion_at(name, seed, turn, speed, acceleration):
    """The points of a variant, its driver at another angle, turning otherwise."""
    exercise = COURSE[name]
    variant, driver = exercise.variant(seed), exercise.spec.driver
    rates = {
        n: v for n, v in ((driver.speed, speed), (driver.acceleration, acceleration)) if n in variant.used
    }
    return points_at(exercise, {**variant.used, **rates}, exercise.driver_angle(variant.used) + turn)


def test_every_animated_mechanism_states_its_points():
    assert WITH_POINTS == MOVING
    assert set(DRIVEN) | set(FILMED) == set(MOVING)


@pytest.mark.parametrize("name", [n for n in WITH_POINTS if n not in (*FILMED, *SWINGING)])
@pytest.mark.parametrize("seed", [2, 9])
def test_velocities_and_accelerations_are_the_slopes_of_positions(name, seed):
    step, speed, sped_up = 0.01, 3.0, 7.0
    acceleration = sped_up if COURSE[name].spec.driver.acceleration else 0.0
    turns = np.arange(0.0, 360.0, 15.0)
    before, now, after = (motion_at(name, seed, turns + d, speed, acceleration) for d in (-step, 0.0, step))
    for point, moving in now.items():
        p, q, r = (np.asarray(one[point].position) for one in (before, now, after))
        slope, bend = (r - p) / (2 * np.radians(step)), (r - 2 * q + p) / np.radians(step) ** 2
        if moving.velocity is not None:
            wanted = slope * speed
            assert abs(moving.velocity - wanted).max() < 1e-6 * abs(wanted).max()
        if moving.acceleration is not None:
            wanted = bend * speed**2 + slope * acceleration
            assert abs(moving.acceleration - wanted).max() < 1e-5 * abs(wanted).max()


@pytest.mark.parametrize("name", WITH_POINTS)
def test_a_point_of_that_name_is_drawn_where_the_solution_says_that_it_is(name):
    moved = animation(name)
    labels = {getattr(e, "label", "") for e in moved.frames[0]}
    assert labels & moved.points.keys()
    for point in labels & moved.points.keys():
        for k, elements in enumerate(moved.frames):
            at = next(e.p for e in elements if getattr(e, "label", "") == point)
            assert abs(at - moved.points[point].position[k]) <= 1e-9 * abs(at)


@pytest.mark.parametrize(
    ("name", "pivot", "block"),
    [
        ("slotted_mechanism", None, "A"),
        ("quick_return_shaper", None, "A"),
        ("quick_return_whitworth", None, "A"),
        ("three_loop_shaper", ("xD", "yD"), "E"),
    ],
)
def test_a_coriolis_term_is_what_neither_guide_nor_slide_explains(name, pivot, block):
    """In a frame that turns with the guide: a = a of the guide's point + a of the slide + the Coriolis
    term."""
    step, speed = 0.02, 2.0
    turns = np.arange(0.0, 360.0, 15.0)
    given = COURSE[name].variant(2).used
    O4 = complex(*(given[n] for n in pivot)) if pivot else 0j
    arms = [motion_at(name, 2, turns + d, speed, 0.0)[block].position - O4 for d in (-step, 0.0, step)]
    length = np.abs(arms)
    angle = np.unwrap(np.angle(arms), axis=0)
    rate = speed / np.radians(step)
    slide, turning = (length[2] - length[0]) / 2 * rate, (angle[2] - angle[0]) / 2 * rate
    slide_2 = (length[2] - 2 * length[1] + length[0]) * rate**2
    turning_2 = (angle[2] - 2 * angle[1] + angle[0]) * rate**2
    along = np.exp(1j * angle[1])
    A = motion_at(name, 2, turns, speed, 0.0)[block]
    guide = (1j * turning_2 - turning**2) * arms[1]
    assert abs(A.acceleration - guide - slide_2 * along - A.coriolis).max() < 1e-4 * abs(A.acceleration).max()
    assert abs(A.coriolis - 2j * turning * slide * along).max() < 1e-5 * abs(A.coriolis).max()


def test_vectors_have_one_scale_for_the_whole_cycle_and_the_legend_states_it():
    moved = animation("slotted_mechanism", 1, "fr", "all")
    tracks = moved.drawing(("velocity",)).tracks
    scale = moved.drawing(("velocity",)).scale
    head = next(t for t in tracks if t.effect == "velocity" and t.closed and not t.key)
    tail = next(t for t in tracks if t.effect == "velocity" and not t.closed and not t.key)
    drawn = np.hypot(*(head.numbers[:, :2] - tail.numbers[:, :2]).T)
    true = np.abs(moved.points["A"].velocity)
    assert drawn == pytest.approx(true / moved.scales["velocity"] * scale, rel=1e-9)
    key = next(t for t in tracks if t.key and t.closed)
    start = next(t for t in tracks if t.key and not t.closed)
    length = (key.numbers[0, 0] - start.numbers[0, 0]) / scale * moved.scales["velocity"]
    (told,) = moved._keys({"velocity"})
    assert told.words == f"Vitesse : {length:.0f} mm/s"


def test_the_readings_are_the_quantities_of_the_scene():
    moved = animation("slotted_mechanism", 1, "en", "all")
    scene = Scene(COURSE["slotted_mechanism"], moved.variant.used, ("velocity",))
    reading = next(
        r for r in moved.readings if r.symbol == COURSE["slotted_mechanism"].symbol("omega4", "en")
    )
    assert "omega4" in scene.quantities
    assert reading.effects == ("velocity",)
    asked = {**moved.variant.used, "theta2": float(moved.angles[7])}
    alone = COURSE["slotted_mechanism"].solve(**asked, only="omega4")["omega4"]
    assert float(reading.values[7].replace("−", "-")) == pytest.approx(alone, rel=1e-3)


def test_a_crank_angle_that_is_an_answer_is_shown_and_the_assembly_kept():
    """The instant is given by the angle OAB, which takes every value twice a turn, its points on either
    side."""
    exercise = COURSE["quick_return"]
    variant = exercise.variant(3)
    given = variant.used
    assert exercise.driver_angle(given) == pytest.approx(
        exercise.solve(**given, only="theta2")["theta2"], abs=1e-9
    )
    turn = exercise.posed(given, np.arange(0.0, 360.0, 10.0) + 1.0)
    assert set(turn["A_side"]) == {"left", "right"}
    solved = exercise.solve(**{**given, **turn}, only=("theta2", "theta3", "theta4"))
    assert (solved["theta2"] % 360) == pytest.approx(np.arange(0.0, 360.0, 10.0) + 1.0, abs=1e-7)
    # The angle from rod AB to rocker DB keeps its sign: the dyad never passes through a straight line.
    between = np.sin(np.radians(solved["theta4"] - solved["theta3"]))
    assert abs(np.sign(between).sum()) == len(between)
    assert np.abs(np.diff(np.unwrap(solved["theta4"], period=360))).max() < 15


def test_a_driver_angle_that_nothing_says_is_a_fault_of_the_course():
    exercise = CourseExercise("quick_return", COURSE.folder, COURSE, Variant)
    exercise.spec = replace(exercise.spec, driver=replace(exercise.spec.driver, poses=None))
    with pytest.raises(BadCourse, match="theta2 is not a given quantity"):
        exercise.variant(0).animation().svg()


def test_where_nothing_moves_or_an_effect_is_unknown_the_error_says_so():
    with pytest.raises(BadCourse, match="names no driver"):
        COURSE["grashof"].variant(0).animation()
    with pytest.raises(UnknownName, match="velocity"):
        COURSE["slotted_mechanism"].variant(0).animation(("velocty",))
    with pytest.raises(WrongValue, match="no coriolis to show"):
        COURSE["four_bar_motion"].variant(0).animation(("coriolis",))


def test_a_scene_names_no_hidden_quantity():
    scene = Scene(COURSE["slotted_mechanism"], COURSE["slotted_mechanism"].variant(0).used, ("velocity",))
    assert "_arm" in COURSE["slotted_mechanism"].plan(("omega4",))
    assert not [n for n in scene.over_cycle(4).evaluated if n.startswith("_")]
