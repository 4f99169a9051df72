"""Scenes show the effects called for and compute nothing else."""

from __future__ import annotations

import csv
import json
from dataclasses import replace

import numpy as np
import pytest
from tables import each_row

from coursework.cli import run
from coursework.cli.move import _budget_rows, _each_effect_once
from coursework.errors import BadCourse, UnknownName, WrongValue
from coursework.mechanics.equilibrium import Equilibrium
from coursework.mechanics.rates import Stance
from coursework.mechanics.statement import Load
from coursework.scenes.added import BodyMass, SceneData
from coursework.scenes.effect_cost import EffectBudget, EffectInfluence, _changes, budget
from coursework.scenes.planning import plan
from coursework.scenes.scenes import Scene, SceneTable

GIVEN = {"r1": 228.6, "r2": 114.3, "theta1": 90.0, "omega2": 5.0, "alpha2": 0.0}


def scene(course, *effects, name="slotted_mechanism", given=GIVEN):
    return Scene(course[name], given, effects)


def test_without_effects_a_scene_shows_positions_alone(course):
    table = scene(course).over_cycle(12)
    assert set(table.columns) == {"theta2", "rA", "theta4"}
    assert "omega4" not in table.evaluated


@each_row(
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
        scene(
            course, "coriolis", name="four_bar_positions", given=course["four_bar_positions"].variant(0).used
        )
    with pytest.raises(BadCourse, match="names no driver"):
        scene(course, name="grashof", given={}).over_cycle()
    with pytest.raises(WrongValue, match="impacts and clearances are not simulated"):
        scene(course, "clearance")
    with pytest.raises(WrongValue, match="needs the effect 'inertia'"):
        scene(course).in_time(5.0, 1.0)


def test_the_command_writes_table_and_plot(tmp_path, capsys):
    arguments = [
        *"simulate slotted_mechanism --effects velocity --set".split(),
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


@each_row("effects", [("inertia",), ("load", "gravity", "inertia"), ("load", "inertia", "friction")])
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


# ---------------------------------------------------------------- what a scene calls for, and no more


def test_lengths_on_paper_and_constants_of_the_cycle_are_in_no_scene_unless_named(course):
    slider = course["slider_crank"]
    table = Scene(slider, slider.variant(0).used, ("position",)).over_cycle(12)
    assert set(table.columns) == {"theta2", "theta3", "r1"}
    assert not {"omega3", "r1_dot", "pv_a"} & set(table.evaluated)
    quick = course["quick_return"]
    given = quick.variant(0).used
    table = Scene(quick, given, ("position",)).over_cycle(12)
    assert not {"stroke", "alpha", "beta", "theta2_turns"} & {*table.columns, *table.evaluated}
    shown = Scene(quick, given, ("position",), ("stroke",)).over_cycle(12)
    assert np.ptp(shown.columns["stroke"]) == 0
    assert shown.columns["stroke"][0] == quick.solve(**given, only="stroke")["stroke"]


def test_a_constant_that_is_named_is_computed_once(course, monkeypatch):
    quick = course["quick_return"]
    seen = []
    solve = type(quick).solve

    def watched(self, *, only=None, **given):
        seen.append((only, max(np.size(v) for v in given.values() if not isinstance(v, tuple))))
        return solve(self, only=only, **given)

    scene = Scene(quick, quick.variant(0).used, ("position",), ("stroke",))
    monkeypatch.setattr(type(quick), "solve", watched)
    scene.over_cycle(12)
    assert [size for only, size in seen if "stroke" in only] == [1]


def test_a_quantity_that_is_shown_is_what_the_solver_gives_at_every_place(course):
    """Of every mechanism that answers place: no answer that moves is taken for a constant of the cycle."""
    faults = []
    for exercise in map(course.__getitem__, course):
        driver = exercise.spec.driver
        if driver is None or driver.poses is None or not exercise.solution.mechanism:
            continue
        given = exercise.variant(2).used
        names = tuple(p.quantity for p in exercise.spec.parts if p.sort.is_number and not p.by_request)
        scene = Scene(exercise, given, (), names)
        columns = scene.over_cycle(3).columns
        for row, at in enumerate(columns[driver.moved]):
            right = exercise.solve(**scene._at(float(at)), only=names, effects=())
            for name in names:
                off = columns[name][row] - right[name]
                if exercise.units[name] == "deg":
                    off = (off + 180) % 360 - 180
                if not abs(off) <= 1e-9 * max(1, abs(right[name])):
                    faults.append(f"{exercise.name}, {name} at {at:g}: {columns[name][row]:g}")
    assert faults == []


@pytest.mark.parametrize(
    "name", ["three_loop_shaper", "quick_return_shaper", "quick_return_whitworth", "havens_planetary"]
)
def test_coriolis_is_there_wherever_a_body_slides_on_one_that_turns(course, name):
    """The acceleration of the pin is that of the guide's point, the sliding one, and Coriolis: by
    differences."""
    exercise = course[name]
    scene = Scene(exercise, exercise.variant(0).used, ("coriolis",))
    (column,) = [c for c in scene.over_cycle(8).columns if c.startswith("a_coriolis")]
    slide = next(s for s in scene.linkage.slides if scene.linkage.coordinates[s.on] != -1)
    step, q, speed = 1e-4, np.radians(45.0), scene._speed
    stance = scene.pose(q + step * np.array([-1.0, 0.0, 1.0]))
    seen = (stance.place(slide.of) - stance.origins[slide.on]) * np.conj(stance.headings[slide.on])
    turned = stance.turns[slide.on]
    sliding = (seen[2] - seen[0]).real / (2 * step) * speed
    rate = np.angle(np.exp(1j * (turned[2] - turned[0]))) / (2 * step) * speed
    found = scene.over_cycle(8).columns[column][1]
    assert found == pytest.approx(2 * rate * sliding * 1000, rel=1e-5)


@pytest.mark.parametrize("name", ["quick_return_offset", "quick_return_whitworth", "quick_return_shaper"])
def test_rams_have_an_acceleration(course, name):
    exercise = course[name]
    given = exercise.variant(0).used
    table = Scene(exercise, given, ("velocity", "acceleration")).over_cycle(7200)
    step = np.radians(0.05) / given["omega2"]
    slope = (table.columns["v_C"][2:] - table.columns["v_C"][:-2]) / (2 * step)
    size = np.abs(slope).max()
    np.testing.assert_allclose(table.columns["a_C"][1:-1], slope, atol=1e-4 * size)


def test_the_advantage_is_shown_over_a_turn(course):
    for name, shown in (("mechanical_advantage", "mechanical_advantage"), ("four_bar_motion", "advantage")):
        exercise = course[name]
        given = exercise.variant(0).used
        table = Scene(exercise, given, ("advantage", "velocity")).over_cycle(36)
        assert np.isfinite(table.columns[shown]).sum() >= 35
    ratio = abs(given["omega2"] / table.columns["omega4"])
    np.testing.assert_allclose(table.columns["advantage"], ratio, rtol=1e-12)


def test_a_mechanism_in_space_is_simulated_by_the_points_that_its_solution_moves(course):
    ball = course["ball_reducer"]
    variant = ball.variant(0)
    table = Scene(ball, variant.used, ("position", "velocity")).over_cycle(24)
    radius = variant.used["R"] + variant.used["r"]
    np.testing.assert_allclose(np.hypot(table.columns["x_O_3"], table.columns["y_O_3"]), radius, rtol=1e-12)
    assert {"omega", "phi_dot", "v_O3"} <= set(table.columns)


def test_the_plan_says_what_is_left_out_and_what_is_not(course):
    shaper = course["three_loop_shaper"]
    given = shaper.variant(0).used
    light = dict(plan(Scene(shaper, given, ("load",), (), SceneData(loads=(Load("G", force=10.0),)))))
    assert "no acceleration" in light
    assert not [line for line in light if "equilibrium" in line or "friction" in line]
    heavy = dict(
        plan(
            Scene(
                shaper,
                given,
                ("load", "inertia", "friction"),
                ("reaction D",),
                SceneData({"8": BodyMass(3.0)}, (Load("G", force=10.0),), {"G": 0.1}),
            )
        )
    )
    assert "equilibrium of 7 bodies, 21 equations an instant" in heavy
    assert "friction by iteration at G" in heavy
    assert heavy["second derivatives of the bodies' angles"] == "the effect inertia"


def test_without_a_question_about_joints_no_equilibrium_is_set_up(course, monkeypatch):
    def refused(self):
        raise AssertionError("no joint was asked for")

    monkeypatch.setattr(Equilibrium, "matrix", property(refused))
    monkeypatch.setattr(Stance, "bends", property(refused))
    shaper = course["three_loop_shaper"]
    added = SceneData({"8": BodyMass(3.0)}, (Load("G", force=10.0),))
    Scene(shaper, shaper.variant(0).used, ("load", "gravity"), (), added).over_cycle(12)


def test_a_budget_says_what_a_scene_could_do_without_and_what_it_lacks(course):
    """A light ram under a heavy load: its inertia does not matter; the friction of its slide does."""
    shaper = course["quick_return_shaper"]
    given = {**shaper.variant(0).used, "omega2": 1.0}
    data = SceneData({"6": BodyMass(0.001)}, (Load("C", force=800.0, against=True),), {"C": 0.3})
    scene = Scene(shaper, given, ("load", "inertia"), (), data)
    found = budget(scene, lambda one: one.over_cycle(90))
    by_effect = {worth.effect: worth for worth in found.worths}
    full = scene.over_cycle(90).columns["drive_torque"]
    bare = scene.without("load").over_cycle(90).columns["drive_torque"]
    (change,) = by_effect["load"].changes
    assert change.largest == np.abs(full - bare).max()
    assert change.rms == pytest.approx(np.sqrt(np.mean((full - bare) ** 2)), rel=1e-12)
    said = " ".join(found.said())
    assert "could do without inertia" in said
    assert "lacks friction, for which it has data" in said
    assert "gravity is left out, rightly" in said
    assert "without load" not in said


def test_a_time_within_its_spread_and_a_rounded_change_are_no_figures():
    noise, cost = EffectInfluence("load", 1e-5, 4e-4, ()), EffectInfluence("inertia", 2e-3, 4e-4, ())
    rows = list(_budget_rows(EffectBudget(1e-2, (noise, cost), (), 0.01)))
    assert [row["time [ms]"] for row in rows] == [None, 2.0]
    assert [row["time [ms]"] for row in _each_effect_once(rows)] == ["< 0.4", "2"]
    whole = SceneTable(
        {"theta": np.array([0.0, 1.0]), "M": np.array([3.0, 4.0])}, {"theta": "deg", "M": "N m"}, ()
    )
    other = replace(whole, columns={**whole.columns, "M": whole.columns["M"] * (1 + 1e-15)})
    assert [change.largest for change in _changes(whole, other)] == [0.0]


def test_an_effect_without_data_is_told(course):
    exercise = course["four_bar_motion"]
    table = Scene(exercise, exercise.variant(0).used, ("load", "gravity", "friction")).over_cycle(6)
    assert [note.split(":")[0] for note in table.notes] == ["load", "gravity", "friction"]
    assert (table.columns["drive_torque"] == 0).all()


def test_what_joints_bear_at_rest_under_friction_is_left_empty(course):
    exercise = course["slider_crank_torque"]
    given = {**exercise.variant(0).used, "omega2": 0.0, "alpha2": 0.0, "theta2": 0.0}
    scene = Scene(exercise, given, ("inertia", "friction"), ("reaction B",))
    table = scene.in_time(0.0, 0.1, count=4)
    assert "stays" in " ".join(table.notes)
    assert np.isnan(table.columns["N_B"]).all()


def test_a_start_from_rest_shows_the_forces_of_its_start(course):
    """Row 0 bears its load and its friction, as the acceleration in it says."""
    exercise = course["slider_crank_torque"]
    given = {**exercise.variant(0).used, "omega2": 0.0, "alpha2": 0.0}
    scene = Scene(exercise, given, ("load", "inertia", "friction"), ("reaction B",))
    columns = scene.in_time(60.0, 0.02, count=200).columns
    for name in ("R_B", "N_B", "T_B"):
        size = np.abs(columns[name]).max()
        assert abs(columns[name][0] - columns[name][1]) < 0.02 * size
    assert abs(columns["T_B"][0]) > 1.0


def test_a_guide_through_its_own_pivot_is_told_as_such(course):
    """And not as a linkage that does not close."""
    given = {**course["slotted_mechanism"].variant(0).given, "r1": 100.0, "r2": 100.0, "theta1": 90.0}
    table = Scene(course["slotted_mechanism"], given).over_cycle(8)
    (note,) = [note for note in table.notes if "270" in note]
    assert "pivot" in note
    assert not any("does not close" in note for note in table.notes)
