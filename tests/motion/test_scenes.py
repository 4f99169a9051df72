"""Scenes show the effects called for and compute nothing else."""

from __future__ import annotations

import csv
import json

import numpy as np
import pytest
from scipy.optimize import bisect

from coursework.cli import run
from coursework.errors import BadCourse, Undefined, UnknownName, WrongValue
from coursework.motion.scenes import Scene, _Motion
from coursework.quantities.graph import Replacement

GIVEN = {"r1": 228.6, "r2": 114.3, "theta1": 90.0, "omega2": 5.0, "alpha2": 0.0}


def scene(course, *effects, name="slotted_mechanism", given=GIVEN):
    return Scene(course[name], given, effects)


def test_without_effects_a_scene_shows_positions_alone(course):
    table = scene(course).over_cycle(12)
    assert set(table.columns) == {"theta2", "rA", "theta4"}
    assert "omega4" not in table.evaluated


@pytest.mark.parametrize(
    ("effects", "shown", "absent"),
    [
        (("position",), {"rA", "theta4"}, {"omega4", "rA_dot", "alpha4"}),
        (("velocity",), {"rA_dot", "omega4"}, {"alpha4", "rA_ddot", "a_coriolis"}),
        (("coriolis",), {"a_coriolis"}, {"alpha4", "rA_ddot"}),
        (
            ("position", "acceleration"),
            {"rA", "theta4", "rA_ddot", "alpha4", "a_centripetal", "a_coriolis"},
            set(),
        ),
    ],
)
def test_a_scene_that_calls_for_less_runs_less(course, effects, shown, absent):
    table = scene(course, *effects).over_cycle(12)
    assert set(table.columns) == {"theta2", *shown}
    assert not absent & set(table.evaluated)


def test_the_angles_of_a_cycle_are_exact_multiples_of_the_step(course):
    angle = scene(course).over_cycle(360).columns["theta2"]
    assert angle.tolist() == [float(i) for i in range(361)]


def test_a_cycle_closes_and_agrees_with_the_solver(course):
    table = scene(course, "position", "velocity").over_cycle(8)
    for name in ("rA", "omega4"):
        assert table.columns[name][0] == table.columns[name][-1]
    alone = course["slotted_mechanism"].solve(**GIVEN, theta2=135, only="rA")["rA"]
    assert table.columns["rA"][3] == pytest.approx(alone, rel=1e-14)


def test_speeds_are_the_slopes_of_positions(course):
    """Central differences of a fine cycle against the scene's own rates."""
    table = scene(course, "position", "velocity").over_cycle(3600)
    time = np.radians(0.1) / 5.0
    slope = (table.columns["rA"][2:] - table.columns["rA"][:-2]) / (2 * time)
    np.testing.assert_allclose(slope, table.columns["rA_dot"][1:-1], atol=2e-3)


def test_where_it_does_not_close_cells_are_empty_and_counted(course):
    given = {"r1": 200.0, "r2": 150.0, "r3": 120.0, "r4": 100.0}
    table = scene(course, name="four_bar_positions", given=given).over_cycle(36)
    empty = [row for row in table.rows() if "" in row.values()]
    assert 0 < len(empty) < 37
    assert f"does not close at {len(empty)} of 37" in table.notes[0]


def test_misuse_is_told(course):
    with pytest.raises(UnknownName, match="did you mean 'velocity'"):
        scene(course, "velocitty")
    with pytest.raises(WrongValue, match="no Coriolis"):
        scene(course, "coriolis", name="four_bar_positions")
    with pytest.raises(BadCourse, match="names no driver"):
        scene(course, name="ball_reducer", given={}).over_cycle()
    with pytest.raises(WrongValue, match="needs the effect 'inertia'"):
        scene(course).in_time(5.0, 1.0)


def test_the_command_writes_table_and_plot(tmp_path, capsys):
    arguments = [
        "simulate",
        "slotted_mechanism",
        "--effects",
        "velocity",
        "--set",
        "r1=0.2286 m",
        "--out",
        str(tmp_path),
    ]
    assert run([*arguments, "--steps", "24"]) == 0
    with (tmp_path / "slotted_mechanism-cycle.csv").open(encoding="utf-8-sig") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 25
    assert list(rows[0]) == ["theta2 [deg]", "rA_dot [mm/s]", "omega4 [rad/s]"]
    plot = (tmp_path / "slotted_mechanism-cycle.svg").read_bytes()
    assert run([*arguments, "--steps", "24"]) == 0
    assert (tmp_path / "slotted_mechanism-cycle.svg").read_bytes() == plot
    capsys.readouterr()
    assert run(["simulate", "slotted_mechanism", "--json", "--steps", "4"]) == 0
    assert len(json.loads(capsys.readouterr().out)["rows"]) == 5
    assert run(["simulate", "slotted_mechanism", "--drive", "torque=5"]) == 2


TORQUE = "slider_crank_torque"


def torque_scene(course, *effects, **changes):
    return Scene(course[TORQUE], {**course[TORQUE].variant(3).used, **changes}, effects)


def test_a_scene_of_forces_needs_no_acceleration_unless_inertia_is_called(course):
    light = set(torque_scene(course, "load").over_cycle(4).evaluated)
    assert not {"r1_ddot", "alpha3", "inertia", "gravity", "friction"} & light
    heavy = set(torque_scene(course, "load", "inertia").over_cycle(4).evaluated)
    assert {"r1_ddot", "alpha3", "inertia"} <= heavy
    assert light < heavy


def test_effects_add_up_without_friction(course):
    def torque(*effects):
        return torque_scene(course, *effects).over_cycle(24).columns["torque"]

    together = torque("load", "gravity", "inertia")
    np.testing.assert_allclose(together, torque("load") + torque("gravity") + torque("inertia"), atol=1e-10)


def test_an_exercise_that_asks_forces_still_shows_its_positions(course):
    table = torque_scene(course, "position").over_cycle(6)
    assert {"theta3", "r1"} <= set(table.columns)
    assert "torque" not in table.evaluated


@pytest.mark.parametrize(
    "effects", [("inertia",), ("load", "gravity", "inertia"), ("load", "inertia", "friction")]
)
def test_a_motion_in_time_keeps_its_energy_balance(course, effects):
    table = torque_scene(course, *effects).in_time(2.0, 0.15, count=60)
    assert table.balance < 1e-6
    assert (np.diff(table.columns["t"]) > 0).all()


def test_a_free_flywheel_slows_and_speeds_about_the_same_energy_and_positions_close(course):
    """No drive, inertia alone: the kinetic energy is that of the start, and r1 is where the rod reaches."""
    scene = torque_scene(course, "inertia", "position", alpha2=0.0)
    table = scene.in_time(0.0, 0.4, count=80)
    columns, given = table.columns, scene.given
    y = given["e"] - given["r2"] * np.sin(np.radians(columns["theta2"]))
    x = columns["r1"] - given["r2"] * np.cos(np.radians(columns["theta2"]))
    np.testing.assert_allclose(np.hypot(x, y), given["r3"], rtol=1e-12)


def test_dead_centres_are_rows_where_the_piston_stands_still(course):
    scene = torque_scene(course, "inertia", "velocity", omega2=30.0)
    table = scene.in_time(0.0, 0.5, count=40)
    dead = table.columns["dead_centre"] == 1
    assert 3 <= dead.sum() <= 6  # two a turn, about two and a half turns
    fastest = np.abs(table.columns["r1_dot"]).max()
    assert np.abs(table.columns["r1_dot"][dead]).max() < 1e-6 * fastest
    assert table.notes[-1] == f"{dead.sum()} dead centres"
    assert scene.in_time(0.0, 0.15, count=10).notes[-1] == "1 dead centre"


def shaken(motion, units=2):
    """The same motion on a processor that rounds otherwise: each quantity is off by some units in its last place."""
    last, rng = np.finfo(float).eps, np.random.default_rng(0)

    def observe(name, value):
        return value * (1 + last * rng.integers(-units, units + 1)) if isinstance(value, float) else value

    motion.graph = motion.graph.observed(observe)
    return motion


@pytest.mark.parametrize(
    "effects", [("inertia",), ("load", "gravity", "inertia"), ("load", "inertia", "friction")]
)
@pytest.mark.parametrize("speed", [0.0, 30.0])
def test_an_acceleration_does_not_hang_on_a_last_bit(course, effects, speed):
    """Least where it goes through 0 and the terms of the torque cancel: there all that is left is rounding."""
    scene = torque_scene(course, *effects)
    plain, other = _Motion(scene, 0.0), shaken(_Motion(scene, 0.0))
    angles = np.radians(np.arange(0.0, 361.0, 10.0)).tolist()
    found = [plain.acceleration(angle, speed) for angle in angles]
    crossed = [k for k in range(36) if found[k] * found[k + 1] < 0]
    zeros = [bisect(plain.acceleration, angles[k], angles[k + 1], (speed,), xtol=1e-15) for k in crossed]
    assert zeros or (effects == ("inertia",) and not speed), "at rest and without a load it is 0 everywhere"
    for angle in angles + zeros:
        found = plain.acceleration(angle, speed)
        allowed = plain.rounding(angle, speed, found) / plain.inertia(angle)
        assert other.acceleration(angle, speed) == pytest.approx(found, abs=allowed)


@pytest.mark.parametrize("short", [1e-9, 1.0])
def test_a_drive_that_nothing_balances_is_not_taken_for_rounding(course, short):
    """A torque that is never negative, and a drive that is, be it ever so little."""
    motion = _Motion(torque_scene(course, "inertia"), -short)
    motion.graph = motion.graph.replacing(Replacement(("torque",), lambda torque: abs(torque)))
    for angle in range(0, 360, 30):
        with pytest.raises(Undefined, match=f"no acceleration balances the drive at {angle} degrees"):
            motion.acceleration(np.radians(angle), 30.0)


@pytest.mark.parametrize("friction", [0.5, 1.2, 1.5])
def test_strong_friction_balances_wherever_a_balance_exists(course, friction):
    """Against the one root that a search over all accelerations brackets; where corrections by the frictionless inertia
    lead away from it, the guide does not jam."""
    given = {**course[TORQUE].variant(0).used, "f": friction}
    scene = Scene(course[TORQUE], given, ("load", "inertia", "friction"))
    motion = _Motion(scene, 3.0)
    far = 10.0 ** np.arange(-3, 9)
    tried = [*-far[::-1], *far]
    for angle in np.radians(np.arange(0.5, 360.0, 15.0)).tolist():

        def lacking(value, angle=angle):
            return motion.drive - motion.effort(angle, 12.0, value, scene._own)

        signs = np.sign([lacking(value) for value in tried])
        (change,) = np.flatnonzero(signs[1:] != signs[:-1])
        root = bisect(lacking, tried[change], tried[change + 1], xtol=1e-9, rtol=1e-14)
        assert motion.acceleration(angle, 12.0) == pytest.approx(root, rel=1e-9, abs=1e-7)
