"""Motions in time: energy, sticking and leaving, motors, limits; against closed forms and an independent
integration."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tables import each_row

import coursework
from coursework.errors import Undefined, WrongValue
from coursework.mechanics.statement import Body, Load, Mechanism, Slide
from coursework.mechanics.turn_table import TURN, TurnTable
from coursework.scenes.added import BodyMass, Flywheel, Motor, SceneData
from coursework.scenes.scenes import Scene

COURSE = coursework.open_course()
FOUR_BAR = {
    "r1": 200.0,
    "r2": 60.0,
    "r3": 180.0,
    "r4": 140.0,
    "theta2": 0.0,
    "omega2": 0.0,
    "alpha2": 0.0,
    "mode": "open",
}
#: A crank that is a pendulum: the other bodies have no mass.
PENDULUM = {"2": BodyMass(mass=2.0, inertia=0.01, centre=complex(60.0))}
INERTIA = 0.01 + 2.0 * 0.06**2


def pendulum(theta2, omega2=0.0, effects=("gravity", "inertia"), **added):
    given = {**FOUR_BAR, "theta2": theta2, "omega2": omega2}
    return Scene(COURSE["four_bar_motion"], given, effects, (), SceneData(bodies=PENDULUM, **added))


def weight_torque(theta2):
    return 2.0 * 9.81 * 0.06 * math.cos(math.radians(theta2))


def test_a_pendulum_swings_as_one_does():
    """Against the equation of the pendulum, integrated on its own."""
    table = pendulum(20.0).in_time(0.0, 2.0, count=50)
    alone = solve_ivp(
        lambda t, y: [y[1], -2.0 * 9.81 * 0.06 * math.cos(y[0]) / INERTIA],
        (0, 2.0),
        [math.radians(20.0), 0.0],
        rtol=1e-12,
        atol=1e-12,
        dense_output=True,
    )
    found = np.radians(table.columns["theta2"])
    np.testing.assert_allclose(found, alone.sol(table.columns["t"])[0], atol=1e-7)
    assert table.balance < 1e-7


def test_a_constant_torque_on_a_flywheel_alone_gives_a_constant_acceleration():
    scene = Scene(
        COURSE["four_bar_motion"],
        {**FOUR_BAR, "omega2": 3.0},
        ("flywheel",),
        (),
        SceneData(flywheel=Flywheel(inertia=0.5)),
    )
    table = scene.in_time(2.0, 1.0, count=10)
    t = table.columns["t"]
    np.testing.assert_allclose(table.columns["omega2"], 3.0 + 4.0 * t, rtol=1e-12)
    np.testing.assert_allclose(
        np.radians(table.columns["theta2"]), 3.0 * t + 2.0 * t**2, rtol=1e-9, atol=1e-9
    )


def test_a_motor_runs_up_to_where_its_line_meets_the_load():
    """A load of a constant moment on the crank: T (1 - w / w0) = M, approached exponentially."""
    data = SceneData(loads=(Load("2", moment=4.0, against=True),), flywheel=Flywheel(inertia=0.2))
    scene = Scene(COURSE["four_bar_motion"], FOUR_BAR, ("load", "flywheel"), (), data)
    table = scene.in_time(Motor(10.0, 20.0), 3.0, count=30)
    last = 20.0 * (1 - 4.0 / 10.0)
    rate = 10.0 / (20.0 * 0.2)
    np.testing.assert_allclose(
        table.columns["omega2"], last * (1 - np.exp(-rate * table.columns["t"])), atol=1e-6
    )


@pytest.mark.parametrize("angles", [(-90.0, 80.0), pytest.param((30.0, 200.0), marks=pytest.mark.slow)])
def test_at_rest_it_stays_while_the_drive_is_within_what_holds_it(angles):
    """A journal of f r = 1.5 mm bears the weight of the crank: it holds as long as |drive - weight's torque|
    <= f r m g."""
    held = 0.3 * 0.005 * 2.0 * 9.81
    friction = {"O": (0.3, 5.0)}
    for theta2 in angles:
        for excess, way in ((0.999, 0), (-0.999, 0), (1.001, 1), (-1.001, -1)):
            scene = pendulum(theta2, effects=("gravity", "inertia", "friction"), friction=friction)
            drive = weight_torque(theta2) + excess * held
            running = scene.running(Motor(drive))
            low, high = running.holding(math.radians(theta2))
            assert (low, high) == pytest.approx(
                (weight_torque(theta2) - held, weight_torque(theta2) + held), abs=1e-12
            )
            table = scene.in_time(drive, 0.5, count=20)
            moved = table.columns["theta2"][-1] - theta2
            assert np.sign(round(moved, 9)) == way
            assert ("comes to rest at t = 0 s and stays" in " ".join(table.notes)) == (way == 0)


def test_a_run_with_friction_ends_and_says_when():
    """Without a drive the crank comes to rest, within what friction can hold there, and stays for the rest of
    the run."""
    exercise = COURSE["slider_crank_torque"]
    scene = Scene(exercise, exercise.variant(0).used, ("gravity", "inertia", "friction"))
    table = scene.in_time(0.0, 6.0)
    (note,) = [note for note in table.notes if "comes to rest" in note]
    rest = float(note.split("t = ")[1].split(" s")[0])
    after = table.columns["t"] > rest
    assert 0 < rest < 6
    assert after.sum() > 100
    assert (table.columns["omega2"][after] == 0).all()
    assert np.ptp(table.columns["theta2"][after]) == 0
    low, high = scene.running(Motor(0.0)).holding(math.radians(table.columns["theta2"][-1]))
    assert low <= 0 <= high
    assert table.balance < 1e-6


def test_energy_is_lost_to_friction_alone():
    """Kinetic and potential energy, from positions and speeds, fall by the work of the friction force, summed
    apart."""
    exercise = COURSE["slider_crank_torque"]
    given = {**exercise.variant(1).used, "omega2": 20.0}
    scene = Scene(
        exercise, given, ("gravity", "inertia", "friction"), ("kinetic_energy", "reaction B", "velocity B")
    )
    table = scene.in_time(0.0, 0.4, count=4000)
    columns = table.columns
    stance = scene.pose(np.radians(columns["theta2"]))
    height = sum(
        m.mass * (stance.origins[m.body] + m.centre * stance.headings[m.body]).imag
        for m in scene.linkage.masses
    )
    energy = columns["kinetic_energy"] + 9.81 * height
    lost = np.concatenate(
        [[0], np.cumsum(np.diff(columns["t"]) * _middle(columns["T_B"] * columns["v_B_x"] / 1000))]
    )
    assert energy[0] - energy[-1] > 1.0
    np.testing.assert_allclose(energy - energy[0], lost, atol=2e-4 * (energy[0] - energy[-1]))


def _middle(values):
    return 0.5 * (values[1:] + values[:-1])


@pytest.mark.parametrize(
    "name", ["slider_crank_torque", "four_bar_motion", "three_loop_shaper", "quick_return_shaper"]
)
@pytest.mark.parametrize("friction", [False, True])
def test_the_table_moves_as_the_equations_themselves(name, friction):
    """The acceleration read from the table, beside that for which the equilibrium of all bodies gives the
    drive."""
    exercise = COURSE[name]
    mechanism = exercise.solution.mechanism
    rubs = {s.at: 0.1 for s in mechanism.slides} if friction else {}
    rubs |= {mechanism.pins[0].at: (0.1, 6.0)} if friction else {}
    data = SceneData(
        {b: BodyMass(1.5, 0.02) for b in mechanism.names}, (Load(mechanism.bodies[-1].at, force=90.0),), rubs
    )
    effects = ("load", "gravity", "inertia", *(["friction"] if friction else []))
    scene = Scene(exercise, exercise.variant(0).used, effects, (), data)
    running = scene.running(Motor(3.0))
    for angle in (0.4, 1.9, 4.1, 5.5):
        for way in (1, -1):
            found = running.acceleration(angle, way * 6.0, way)
            effort = scene.forces.over(np.array([angle]), np.array([way * 6.0]), np.array([found])).effort[0]
            inertia = float(running.table.at(angle)[0])
            assert effort == pytest.approx(3.0, abs=1e-9 * (3.0 + inertia * abs(found)))


def test_strong_friction_balances_wherever_a_balance_exists():
    """Where corrections by the frictionless inertia lead away from the balance, the guide does not jam."""
    exercise = COURSE["slider_crank_torque"]
    for strength in (0.5, 1.2, 1.5):
        given = {**exercise.variant(0).used, "f": strength}
        scene = Scene(exercise, given, ("load", "inertia", "friction"))
        running = scene.running(Motor(3.0))
        for angle in np.radians(np.arange(0.5, 360.0, 15.0)).tolist():
            found = running.acceleration(angle, 12.0, 1)
            effort = scene.forces.over(np.array([angle]), np.array([12.0]), np.array([found])).effort[0]
            assert effort == pytest.approx(3.0, abs=1e-9 * (3 + abs(found)))


def test_where_the_guide_jams_the_angle_is_told():
    exercise = COURSE["slider_crank_torque"]
    given = {**exercise.variant(0).used, "f": 3.0, "omega2": 12.0}
    with pytest.raises(Undefined, match=r"jams at .* degrees"):
        Scene(exercise, given, ("load", "inertia", "friction")).in_time(3.0, 2.0)


def test_a_load_on_the_working_stroke_works_on_that_stroke_alone():
    exercise = COURSE["quick_return_shaper"]
    given = exercise.variant(0).used
    load = Load("C", force=500.0, against=True, during="working stroke")
    scene = Scene(exercise, given, ("load", "position"), (), SceneData(loads=(load,)))
    count = 3600
    table = scene.over_cycle(count)
    effort = table.columns["drive_torque"] * np.sign(scene._speed)
    works = effort > 1e-9
    longer = exercise.solve(**given, only="alpha")["alpha"] / 360
    assert works[:-1].mean() == pytest.approx(longer, abs=2 / count)
    np.testing.assert_allclose(effort[~works], 0.0, atol=1e-9)
    # The work of a turn is the force over the stroke.
    stroke = exercise.solve(**given, only="stroke")["stroke"] / 1000
    assert effort[:-1].mean() * 2 * math.pi == pytest.approx(500.0 * stroke, rel=1e-3)


def test_a_working_stroke_that_is_as_long_as_the_other_is_refused():
    given = {
        "r2": 30.0,
        "r3": 90.0,
        "e": 0.0,
        "theta2": 20.0,
        "omega2": 2.0,
        "alpha2": 0.0,
        "kv": 1.0,
        "ka": 1.0,
    }
    load = Load("B", force=10.0, against=True, during="working stroke")
    with pytest.raises(WrongValue, match="both take as long; say during = 'forward'"):
        Scene(COURSE["slider_crank"], given, ("load",), (), SceneData(loads=(load,))).over_cycle(12)


def test_loads_by_table_follow_their_angle_or_their_position():
    given = {**FOUR_BAR, "omega2": 2.0}
    by_angle = Load("2", moment=0.0, table=((0.0, 0.0), (90.0, 6.0), (270.0, 0.0)))
    scene = Scene(COURSE["four_bar_motion"], given, ("load",), (), SceneData(loads=(by_angle,)))
    effort = scene.over_cycle(8).columns["drive_torque"]
    np.testing.assert_allclose(effort, [0.0, -3.0, -6.0, -4.5, -3.0, -1.5, 0.0, 0.0, 0.0], atol=1e-12)
    crank = {
        "r2": 30.0,
        "r3": 90.0,
        "e": 0.0,
        "theta2": 20.0,
        "omega2": 2.0,
        "alpha2": 0.0,
        "kv": 1.0,
        "ka": 1.0,
    }
    spring = Load("B", by="r1", table=((60.0, 600.0), (120.0, 0.0)))
    scene = Scene(
        COURSE["slider_crank"], crank, ("load", "position", "velocity"), (), SceneData(loads=(spring,))
    )
    columns = scene.over_cycle(36).columns
    power = (120.0 - columns["r1"]) * 10.0 * columns["r1_dot"] / 1000
    np.testing.assert_allclose(columns["drive_torque"] * 2.0, -power, atol=1e-9)


def test_a_flywheel_is_sized_for_its_unevenness():
    """And keeps it: the motion in time under the mean torque stays within the band, by the linear theory."""
    exercise = COURSE["quick_return_shaper"]
    given = {**exercise.variant(0).used, "omega2": 5.0}
    load = Load("C", force=300.0, against=True, during="working stroke")
    data = SceneData(loads=(load,), flywheel=Flywheel(unevenness=0.05))
    scene = Scene(exercise, given, ("load", "flywheel"), (), data)
    # The excess energy, by a fine sum of the work alone.
    count = 200_000
    q = (np.arange(count) + 0.5) * (TURN / count)
    effort = scene.without("flywheel").forces.over(q, np.full(count, 5.0), np.zeros(count)).effort
    stored = np.cumsum(effort.mean() - effort) * (TURN / count)
    assert scene.evenness.excess_energy == pytest.approx(np.ptp(stored), rel=1e-3)
    table = scene.in_time(scene.evenness.mean_torque, 4.0, count=4000)
    speed = table.columns["omega2"]
    assert np.ptp(speed) / speed.mean() == pytest.approx(0.05, rel=0.05)


def test_dead_centres_are_rows_where_the_output_stands_still():
    exercise = COURSE["three_loop_shaper"]
    mechanism = exercise.solution.mechanism
    data = SceneData({b: BodyMass(1.0, 0.05) for b in mechanism.names})
    scene = Scene(exercise, {**exercise.variant(0).used, "omega2": 12.0}, ("inertia", "velocity"), (), data)
    table = scene.in_time(0.0, 1.0, count=50)
    dead = table.columns["dead_centre"] == 1
    assert dead.sum() >= 3
    assert np.abs(table.columns["x8_dot"][dead]).max() < 1e-5 * np.abs(table.columns["x8_dot"]).max()


def test_a_run_that_would_not_end_is_told(monkeypatch):
    monkeypatch.setattr("coursework.mechanics.running.MOST_WORK", 500)
    with pytest.raises(Undefined, match="evaluations of its equation, by"):
        pendulum(20.0).in_time(5.0, 100.0)


def test_a_mechanism_that_does_not_turn_fully_moves_without_a_table():
    """A double rocker: no table around the turn, the equations themselves; its energy is kept."""
    given = {**FOUR_BAR, "r1": 200.0, "r2": 150.0, "r3": 120.0, "r4": 100.0, "theta2": 40.0}
    scene = Scene(COURSE["four_bar_motion"], given, ("gravity", "inertia"), (), SceneData(bodies=PENDULUM))
    running = scene.running(Motor(0.0))
    assert running.table.steps == 0
    table = scene.in_time(0.5 * weight_torque(40.0), 0.05, count=10)
    assert table.balance < 1e-7


def test_a_table_of_the_turn_is_good_to_rounding():
    def functions(q):
        return np.array([np.cos(q) + 0.3 * np.sin(5 * q), 1 / (1.05 + np.cos(q)), np.full_like(q, 3.0)])

    def measured(function, size=0.0):
        return lambda q: (function(q), np.full(len(function(q)), size))

    table = TurnTable(measured(functions))
    q = np.random.default_rng(0).uniform(-40, 40, 5000)
    right = functions(q)
    size = np.abs(right).max(axis=1)
    assert (np.abs(table.over(q) - right).max(axis=1) < 2e-14 * size).all()
    np.testing.assert_allclose(table.over(q[:20]).T, [table.at(x) for x in q[:20]], rtol=1e-14)
    assert TurnTable(measured(lambda q: np.array([np.where(np.sin(q) > 0, 1.0, np.nan)]))).steps == 0
    assert TurnTable(measured(lambda q: np.array([np.abs(np.sin(q))]))).steps == 0
    noise = np.random.default_rng(1)
    assert TurnTable(measured(lambda q: np.array([1e-16 * noise.normal(size=len(q))]))).steps == 0
    assert TurnTable(measured(lambda q: np.array([1e-16 * noise.normal(size=len(q))]), size=1.0)).steps > 0


# ------------------------------------------------------------------- what goes wrong without a word

CRANK = {"r2": 30.0, "r3": 90.0, "e": 0.0, "theta2": 20.0, "omega2": 2.0, "alpha2": 0.0, "kv": 1.0, "ka": 1.0}


@each_row("omega2", [2.0, -2.0])
@each_row(("during", "way"), [("forward", 1), ("backward", -1)])
def test_forward_is_as_the_point_really_goes(omega2, during, way):
    load = Load("B", force=100.0, against=True, during=during)
    given = {**CRANK, "omega2": omega2}
    scene = Scene(COURSE["slider_crank"], given, ("load", "velocity"), (), SceneData(loads=(load,)))
    columns = scene.over_cycle(60).columns
    power = columns["drive_torque"] * omega2
    np.testing.assert_allclose(
        power, np.where(columns["r1_dot"] * way > 1e-9, 100.0 * abs(columns["r1_dot"]) / 1000, 0), atol=1e-9
    )
    running = Scene(
        COURSE["slider_crank"],
        given,
        ("load", "flywheel"),
        (),
        SceneData(loads=(load,), flywheel=Flywheel(1.0)),
    ).running(Motor(0.0))
    for angle, rate in zip(columns["theta2"][1:-1:7], columns["r1_dot"][1:-1:7], strict=True):
        loaded = running.acceleration(math.radians(angle), omega2, int(np.sign(omega2))) * omega2 < -1e-9
        assert loaded == (rate * way > 1e-6)


@each_row("seed", range(3))
def test_the_working_stroke_is_the_slower_whichever_way_the_driver_turns(seed):
    exercise = COURSE["quick_return_shaper"]
    load = Load("C", force=500.0, against=True, during="working stroke")
    works = []
    for omega2 in (3.0, -3.0):
        given = {**exercise.variant(seed).used, "omega2": omega2}
        effort = (
            Scene(exercise, given, ("load",), (), SceneData(loads=(load,)))
            .over_cycle(720)
            .columns["drive_torque"]
        )
        works.append(np.abs(effort) > 1e-6)
    np.testing.assert_array_equal(*works)


def test_a_table_over_a_whole_turn_is_read_as_it_stands():
    """At exactly 360 degrees it jumps; a shorter one goes straight on to the next turn."""
    whole = Load("2", table=((0.0, 0.0), (180.0, 100.0), (360.0, 200.0)))
    shorter = Load("2", table=((90.0, 100.0), (270.0, 0.0)))
    for load, right in ((whole, [0.0, 50.0, 100.0, 150.0, 0.0]), (shorter, [50.0, 100.0, 50.0, 0.0, 50.0])):
        scene = Scene(
            COURSE["four_bar_motion"], {**FOUR_BAR, "omega2": 2.0}, ("load",), (), SceneData(loads=(load,))
        )
        np.testing.assert_allclose(-scene.over_cycle(4).columns["drive_torque"], right, atol=1e-12)


def test_a_force_acts_on_a_point_and_a_moment_on_a_body():
    for load, why in ((Load("4", force=800.0), "4 is a body"), (Load("B", moment=5.0), "B is a point")):
        with pytest.raises(WrongValue, match=why):
            Scene(COURSE["four_bar_motion"], FOUR_BAR, ("load",), (), SceneData(loads=(load,))).over_cycle(4)


def test_what_an_exercise_finds_from_its_own_data_is_not_shown_for_others():
    exercise = COURSE["slider_crank_torque"]
    given, data = exercise.variant(0).used, SceneData(bodies={"4": BodyMass(1000.0)})
    with pytest.raises(WrongValue, match="torque follows from the exercise's own data"):
        Scene(exercise, given, ("gravity",), ("torque",), data)
    assert "drive_torque" in Scene(exercise, given, ("gravity",), (), data).over_cycle(4).columns
    wheel = SceneData(flywheel=Flywheel(inertia=100.0))
    spun = Scene(exercise, {**given, "alpha2": 5.0}, ("inertia", "flywheel"), (), wheel).over_cycle(4)
    bare = Scene(exercise, {**given, "alpha2": 5.0}, ("inertia",)).over_cycle(4)
    np.testing.assert_allclose(spun.columns["drive_torque"] - bare.columns["torque"], 500.0, rtol=1e-12)


def test_dead_centres_are_met_each_once_with_friction_too():
    """The driver's angle at them is where crank and rod are in line; between two of them lies one stroke."""
    data = SceneData({"2": BodyMass(inertia=0.05), "4": BodyMass(3.0)}, friction={"B": 0.3})
    for offset in (0.0, 10.0):
        given = {**CRANK, "omega2": 20.0, "e": offset}
        scene = Scene(COURSE["slider_crank"], given, ("inertia", "friction"), (), data)
        table = scene.in_time(1.0, 3.0)
        dead = table.columns["theta2"][table.columns["dead_centre"] == 1]
        far, near = np.degrees(np.arcsin(offset / 120)), 180 + np.degrees(np.arcsin(offset / 60))
        passed = [
            q + 360 * k
            for k in range(40)
            for q in (far, near)
            if 20 < q + 360 * k < table.columns["theta2"][-1]
        ]
        np.testing.assert_allclose(dead, passed, atol=1e-5)


def test_a_start_at_a_turning_place_that_comes_to_nothing_is_rest():
    data = SceneData({"2": BodyMass(inertia=0.05), "4": BodyMass(3.0)}, friction={"B": 0.3, "A": (0.2, 8.0)})
    given = {**CRANK, "theta2": 0.0, "omega2": 0.0}
    table = Scene(COURSE["slider_crank"], given, ("gravity", "inertia", "friction"), (), data).in_time(
        0.01, 1.0
    )
    assert np.ptp(table.columns["theta2"]) < 1e-6


def test_a_mechanism_that_rocks_does_not_jam_where_nothing_jams():
    given = {**FOUR_BAR, "r1": 200.0, "r2": 150.0, "r3": 120.0, "r4": 100.0, "theta2": 40.0}
    data = SceneData({b: BodyMass(1.0, 0.01) for b in "234"}, friction=dict.fromkeys("OCB", (0.2, 6.0)))
    scene = Scene(COURSE["four_bar_motion"], given, ("gravity", "inertia", "friction"), (), data)
    low, high = scene.running(Motor(0.0)).holding(math.radians(40.0))
    table = scene.in_time(0.5 * (low + high), 0.2, count=4)
    assert np.ptp(table.columns["theta2"]) == 0
    table = scene.in_time(high + 0.3, 0.05, count=4)
    assert table.columns["theta2"][-1] > 40.0
    assert table.balance < 1e-5


def test_several_contacts_at_an_instant_are_those_of_the_cycle():
    """The quick way of a run, from the sides of an instant ago, beside friction that grows from nothing."""
    exercise = COURSE["three_loop_shaper"]
    mechanism = exercise.solution.mechanism
    rubs = {"E": 0.15, "G": 0.2, "C": (0.1, 8.0), "D": (0.1, 8.0)}
    data = SceneData({b: BodyMass(1.5, 0.02) for b in mechanism.names}, (), rubs, {"G": 60.0})
    scene = Scene(exercise, exercise.variant(0).used, ("gravity", "inertia", "friction"), (), data)
    table = scene.in_time(4.0, 0.6, count=60)
    # At a dead centre the ram stands still, and a cycle shows no friction there.
    moving = (np.abs(table.columns["omega2"]) > 1e-6) & (table.columns["dead_centre"] == 0)
    q, w, a = (table.columns[n][moving] for n in ("theta2", "omega2", "acceleration"))
    effort = scene.forces.over(np.radians(q), w, a).effort
    np.testing.assert_allclose(effort, 4.0, rtol=1e-6)


@each_row(
    ("wrong", "why"),
    [
        (lambda: Motor(5.0, -20.0), "have one sign"),
        (lambda: Flywheel(unevenness=2.0), "between 0 and 1"),
        (lambda: pendulum(1e300).in_time(0.0, 1.0), "no digits left"),
        (lambda: pendulum(20.0).over_cycle(10**30), "from 1 to 1e"),
        (lambda: pendulum(np.array([1.0, 2.0])), "one value of theta2"),
        (lambda: pendulum(20.0, effects=("gravity", "gravity")), "named twice"),
    ],
)
def test_what_no_run_could_use_is_refused(wrong, why):
    with pytest.raises((WrongValue, Undefined), match=why):
        wrong()


def test_a_load_follows_a_quantity_that_moves():
    """A spring's force named as a quantity of the exercise, and its direction: what the driver moves is
    followed."""
    given = {**CRANK, "omega2": 2.0}
    load = Load("B", force="r1", angle="theta3")
    scene = Scene(COURSE["slider_crank"], given, ("load", "position"), (), SceneData(loads=(load,)))
    columns = scene.over_cycle(24).columns
    power = (
        columns["r1"]
        * np.cos(np.radians(columns["theta3"]))
        * scene.exercise.solve(**{**given, "theta2": columns["theta2"]}, only="r1_dot")["r1_dot"]
        / 1000
    )
    np.testing.assert_allclose(columns["drive_torque"] * 2.0, -power, atol=1e-9)
    with pytest.raises(WrongValue, match="changes with the driver's speed"):
        Scene(
            COURSE["slider_crank"], given, ("load",), (), SceneData(loads=(Load("B", force="r1_dot"),))
        ).over_cycle(4)


def test_a_function_that_the_driver_moves_is_not_frozen_in_a_load():
    load = Load("B", force=lambda r1: 2 * r1)
    scene = Scene(COURSE["slider_crank"], CRANK, ("load",), (), SceneData(loads=(load,)))
    with pytest.raises(WrongValue, match="make it a quantity of the solution"):
        scene.over_cycle(4)


def test_two_slides_at_one_point_both_stay():
    """A length that is given to a point is given to each of them."""
    mechanism = Mechanism({"O": 0}, (Body("2", 0, "O"),), (Slide("O", "2"), Slide("O", "2", along=90.0)))
    assert [slide.length for slide in SceneData(lengths={"O": 60.0}).to(mechanism).slides] == [60.0, 60.0]
