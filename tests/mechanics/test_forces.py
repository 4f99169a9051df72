"""Forces are those of equilibrium, whichever way they are found, on every mechanism of the course."""

from __future__ import annotations

import numpy as np
import pytest
from exact_mechanics import ExactMechanics
from sweeps import sampled, seeds
from tables import each_row

import coursework
from coursework.errors import BadCourse
from coursework.mechanics import GROUND, Body, Gear, Load, Mechanism, Slide
from coursework.mechanics.equilibrium import Equilibrium
from coursework.mechanics.linkage import BodyPoint, Linkage
from coursework.mechanics.rates import Stance
from coursework.mechanics.wrenches import inertia_at_rate, inertia_at_start, weight
from coursework.scenes.added import BodyMass, SceneData
from coursework.scenes.scenes import Scene

COURSE = coursework.open_course()
DRIVEN = [
    name
    for name in COURSE
    if COURSE[name].spec.driver is not None and COURSE[name].solution.mechanism is not None
]
every_mechanism = pytest.mark.parametrize("name", DRIVEN)
#: Those whose formulas place the mechanism for an angle of the driver at any number of digits, with all that
#: rubs.
EXACT = {
    "slider_crank_torque": ("B",),
    "four_bar_motion": (),
    "slotted_mechanism": ("A",),
    "quick_return_shaper": ("A", "C"),
    "quick_return_whitworth": ("A", "C"),
    "slider_extras": ("P",),
    "two_loop_linkage": (),
    "three_loop_shaper": ("E", "G"),
}
ALL = ("load", "gravity", "inertia", "friction")


def weighed(name, rng, pins=True):
    """Every body a mass, a centre off its origin and an inertia; a load on its last point; friction
    everywhere."""
    stated = COURSE[name].solution.mechanism
    bodies = {
        body: BodyMass(
            rng.uniform(0.5, 5), rng.uniform(0.005, 0.05), complex(rng.uniform(-30, 60), rng.uniform(-20, 20))
        )
        for body in stated.names
        if stated.body(body).angle is not None
    }
    friction = {slide: float(rng.uniform(0.02, 0.12)) for slide in EXACT.get(name, ())}
    if pins:
        joints = [p.at for p in stated.pins if sum(q.at == p.at for q in stated.pins) == 1]
        friction |= {
            at: (float(rng.uniform(0.02, 0.1)), float(rng.uniform(3, 8)))
            for at in joints
            if at not in friction
        }
    point = list(stated.bodies[-1].places)[-1]
    load = Load(point, force=float(rng.uniform(50, 400)), angle=float(rng.uniform(0, 360)))
    return SceneData(bodies, (load,), friction)


def scene_of(name, seed, effects, **added):
    rng = np.random.default_rng(seed)
    exercise = COURSE[name]
    data = weighed(name, rng, **added)
    return Scene(exercise, exercise.variant(seed).used, effects, (), data)


def instants(scene, count=24):
    q = (np.arange(count) + 0.37) * (2 * np.pi / count)
    return q, np.full(count, scene._speed or 3.0), np.full(count, scene._acceleration or 7.0)


@every_mechanism
def test_one_degree_of_freedom_as_the_exercise_counts_it(name):
    exercise = COURSE[name]
    assert exercise.solution.mechanism.mobility == 1
    if "mobility" in exercise.solution.graph.quantities:
        assert exercise.solve(only="mobility")["mobility"] == 1


@every_mechanism
@seeds(3, 20)
def test_loops_close_and_rates_are_those_of_the_solution(name, seeds):
    """The rates follow from the joints alone; the solution has its own formulas for them."""
    for seed in seeds:
        loops_close(name, seed)


def loops_close(name, seed):
    exercise, scene = COURSE[name], scene_of(name, seed, ("inertia",))
    q, _, _ = instants(scene)
    stance = scene.pose(q, by_joints=True)
    closes = np.isfinite(stance.turns).all(axis=0)
    size = max(np.abs(stance.origins[:, closes]).max(), 1e-3)
    assert stance.gap[closes].max() < 1e-13 * size
    driver = exercise.spec.driver
    stated = {body.angle: number for number, body in enumerate(exercise.solution.mechanism.bodies)}
    graph = exercise.solution.graph
    rates = {a: "omega" + a.removeprefix("theta") for a in stated if isinstance(a, str) and a != driver.angle}
    wanted = {a: w for a, w in rates.items() if w in graph.quantities}
    if not driver.speed or not wanted:
        return
    given = {**scene._driven(np.degrees(q)), driver.speed: 2.0}
    found = exercise.solve(**given, only=tuple(wanted.values()))
    for angle, rate in wanted.items():
        np.testing.assert_allclose(
            2.0 * stance.rates[stated[angle]][closes],
            np.broadcast_to(found[rate], q.shape)[closes],
            rtol=1e-9,
            atol=1e-11,
        )


@every_mechanism
@seeds(3, 20)
def test_effort_by_virtual_power_is_effort_by_equilibrium(name, seeds):
    for seed in seeds:
        scene = scene_of(name, seed, ("load", "gravity", "inertia"))
        q, speed, acceleration = instants(scene)
        by_power = scene.forces.over(q, speed, acceleration).effort
        borne = scene.forces.over(q, speed, acceleration, joints=True)
        size = np.nanmax(np.abs(np.array([by_power, *borne.joints.values()])), initial=1.0)
        assert np.isfinite(by_power).any()
        np.testing.assert_allclose(borne.effort, by_power, atol=1e-11 * size)


@every_mechanism
def test_what_acts_on_each_body_adds_up_to_nothing_about_any_point(name):
    """The moments about a point far away, of all that acts on each body and of its inertia."""
    scene = scene_of(name, 3, ("load", "gravity", "inertia"))
    q, speed, acceleration = instants(scene)
    stance = scene.pose(q)
    applied = scene.forces.applied(stance, q, speed, acceleration)
    equations = Equilibrium(stance)
    unknowns = equations.under(applied)[:, :, 0]
    rows = np.einsum("nru,nu->nr", equations.matrix, unknowns).reshape(len(q), -1, 3)
    total = rows + equations._rows(applied).reshape(len(q), -1, 3)
    far = 3.0 - 2.0j
    force = total[..., 0] + 1j * total[..., 1]
    moment = total[..., 2] + (np.conj(stance.origins[:-1].T - far) * force).imag
    size = np.nanmax(np.abs(unknowns))
    assert np.nanmax(np.abs(force)) < 1e-11 * size
    assert np.nanmax(np.abs(moment)) < 1e-10 * size


@every_mechanism
def test_a_turn_at_a_constant_rate_costs_no_work_without_friction(name):
    """Gravity and inertia give back what they take; the mean of a periodic function over equal steps is
    spectrally exact."""
    scene = scene_of(name, 5, ("gravity", "inertia"))
    count = 2048
    q = np.arange(count) * (2 * np.pi / count)
    effort = scene.forces.over(q, np.full(count, 4.0), np.zeros(count)).effort
    if np.isfinite(effort).all():
        assert abs(effort.mean()) < 1e-9 * np.abs(effort).max()


@pytest.mark.parametrize("name", EXACT)
@pytest.mark.parametrize("pose", sampled([(0, 33.0), (1, 141.0), (2, 290.0)], [(0, 33.0)]))
def test_all_effects_are_those_of_a_reference_of_many_digits(name, pose):
    seed, angle = pose
    scene = scene_of(name, seed, ALL)
    exercise, mechanism = COURSE[name], scene.mechanism
    speed, acceleration = scene._speed or 3.0, 11.0
    loads = []
    for load in mechanism.loads:
        force = load.force if not isinstance(load.force, str) else scene.given[load.force]
        loads.append((load.on, complex(force * np.exp(1j * np.radians(load.angle)))))
    exact = ExactMechanics(exercise, mechanism, scene.given, angle, speed, acceleration).borne(
        gravity=True, inertia=True, loads=loads, friction=dict(scene.added.friction)
    )
    borne = scene.forces.over(np.radians([angle]), np.array([speed]), np.array([acceleration]), joints=True)
    found = {**borne.joints, "effort": borne.effort}
    size = max(float(abs(value)) for value in exact.values())
    assert set(found) == set(exact)
    for unknown, value in exact.items():
        assert float(found[unknown][0]) == pytest.approx(float(value), abs=3e-12 * size), unknown


@pytest.mark.parametrize("seed", sampled(range(20), range(3)))
@pytest.mark.parametrize("effects", [("load",), ("gravity",), ("inertia",), ALL])
def test_the_slider_crank_agrees_with_its_formulas_on_paper(seed, effects):
    exercise = COURSE["slider_crank_torque"]
    scene = Scene(exercise, exercise.variant(seed).used, effects)
    q, speed, acceleration = instants(scene)
    acceleration[:] = scene._acceleration
    names = ("torque", "N_guide", "R_A", "R_B", "R_O")
    paper = exercise.solve(**scene._driven(np.degrees(q)), only=names, effects=effects)
    borne = scene.forces.over(q, speed, acceleration, joints=True)
    pins = {f"R_{p}": np.hypot(borne.joints[f"{p}_x"], borne.joints[f"{p}_y"]) for p in "ABO"}
    found = {"torque": borne.effort, "N_guide": borne.joints["B slide_n"], **pins}
    for name in names:
        size = np.abs(paper["R_A"]).max()
        np.testing.assert_allclose(found[name], np.broadcast_to(paper[name], q.shape), atol=1e-12 * size)


def test_a_wheel_that_rolls_turns_and_bears_as_its_gear_says():
    """The pinion's rate is the exercise's own; a torque on it comes back to the drive by the ratio."""
    exercise = COURSE["havens_planetary"]
    given = exercise.variant(0).used
    scene = Scene(exercise, given, ("load",), (), SceneData(loads=(Load("3", moment=5.0),)))
    q, speed, acceleration = instants(scene)
    omega3 = exercise.solve(**{**given, "theta1": np.degrees(q)}, only="omega3")["omega3"]
    stance = scene.pose(q)
    np.testing.assert_allclose(stance.rates[2] * scene._speed, omega3, rtol=1e-10)
    borne = scene.forces.over(q, speed, acceleration, joints=True)
    np.testing.assert_allclose(borne.effort, -5.0 * omega3 / scene._speed, rtol=1e-9, atol=1e-10)
    np.testing.assert_allclose(np.abs(borne.joints["3/2_t"]), 5.0 / (given["r3"] / 1000), rtol=1e-9)


def test_points_move_as_the_solution_says():
    """Velocities and accelerations of pins, from the joints, beside those that the animations show."""
    exercise = COURSE["three_loop_shaper"]
    variant = exercise.variant(1)
    points = variant.animation(("velocity",)).points
    angles = np.radians(variant.animation(("velocity",)).angles)
    scene = Scene(exercise, variant.used, ("velocity",))
    stance, speed = scene.pose(angles), scene._speed
    for name, point in points.items():
        held = scene.linkage.owner(name)
        np.testing.assert_allclose(stance.place(held) * 1000, point.position, atol=1e-9)
        np.testing.assert_allclose(stance.rate(held) * speed * 1000, point.velocity, atol=1e-8)
        np.testing.assert_allclose(stance.bend(held) * speed**2 * 1000, point.acceleration, atol=1e-6)
    assert isinstance(held, BodyPoint)


CHANGE = {"r1": 100.0, "r2": 50.0, "r3": 70.0, "r4": 80.0, "omega2": 2.0, "alpha2": 0.0, "mode": "open"}


@each_row("beside", [1.0, 1e-2, 1e-4, 1e-6, 1e-8])
@each_row("side", [-1, 1])
def test_the_effort_keeps_its_digits_beside_a_change_point(beside, side):
    """Stretched out, the four bars lie on one line: the joints' own equations lose the accelerations there, a
    thousandth of a degree away, the formulas of the exercise do not."""
    exercise, angle = COURSE["four_bar_motion"], 180.0 + side * beside
    data = SceneData({b: BodyMass(2.0, 0.01, 20 + 5j) for b in "234"}, (Load("B", force=50.0, angle=30.0),))
    scene = Scene(exercise, {**CHANGE, "theta2": angle}, ("load", "gravity", "inertia"), (), data)
    force = complex(50.0 * np.exp(1j * np.radians(30.0)))
    exact = ExactMechanics(exercise, scene.mechanism, scene.given, angle, 2.0, 3.0).borne(
        gravity=True, inertia=True, loads=[("B", force)]
    )["effort"]
    found = scene.forces.over(np.radians([angle]), np.array([2.0]), np.array([3.0])).effort[0]
    # The driver's angle in radians is rounded once more than in degrees: the effort goes as 1 / distance
    # there.
    allowed = 8 * np.finfo(float).eps * (1 + 180.0 / beside)
    assert found == pytest.approx(float(exact), rel=allowed)


def test_a_ring_on_the_ground_bears_as_virtual_power_says():
    """A pinion on a crank rolls inside a fixed ring whose centre is not the origin: rates by rolling, forces
    by both ways."""
    mechanism = Mechanism(
        ground={"O": 50 + 20j},
        bodies=(Body("2", "theta2", "O", {"A": "r2"}), Body("3", None, "A", mass=2.0, inertia=0.01)),
        gears=(
            Gear(
                "3", GROUND, carrier="2", radii=("r3", lambda r2, r3: r2 + r3), inner=True, centres=("A", "O")
            ),
        ),
    )
    linkage = Linkage(mechanism, {"r2": 60.0, "r3": 20.0}, "theta2")
    linkage.check()
    q = np.linspace(0.1, 6.0, 9)
    stance = Stance(linkage, np.array([q, 0 * q, 0 * q]))
    np.testing.assert_allclose(stance.rates[1], -60.0 / 20.0, rtol=1e-13)
    total = weight(stance) + inertia_at_start(stance) * 3.0
    total.turn(1, 0.7)
    equations = Equilibrium(stance)
    unknowns = equations.under(total)[:, :, 0]
    np.testing.assert_allclose(unknowns[:, equations.column("effort")], total.effort, rtol=1e-11)


def test_statements_that_cannot_be_are_refused():
    wheel = Body("3", None, "O", {"G": 30.0})
    with pytest.raises(BadCourse, match="has no angle: nothing says where its points G"):
        Mechanism({"O": 0}, (Body("2", "a", "O"), wheel))
    with pytest.raises(BadCourse, match="its middle at a point"):
        Mechanism({"O": 0}, (Body("2", "a", "O"),), gears=(Gear("2", GROUND, "2", (1, 2)),))
    with pytest.raises(BadCourse, match="no body before it holds"):
        Mechanism({"O": 0}, (Body("2", "a", "Q"),))
    with pytest.raises(BadCourse, match="turned alike"):
        Mechanism({"O": 0}, (Body("2", "a", "O"), Body("3", "b", "O")), (Slide("O", "3", on="2"),))


def test_a_body_that_slides_alone_hold_says_where_it_is():
    """A Scotch yoke: x = r cos(theta); by hand its acceleration, and the torque r sin(theta) (m x'' + F)."""
    r, speed, acceleration, force = 0.08, 5.0, 7.0, 40.0
    mechanism = Mechanism(
        ground={"O": 0},
        bodies=(
            Body("2", "theta", "O", {"A": "r"}),
            Body("3", 0, "A"),
            Body("4", 0, "Y", mass=3.0, origin="x"),
        ),
        slides=(Slide("A", "3", on="4", along=90.0), Slide("Y", "4")),
    )
    linkage = Linkage(mechanism, {"r": 1000 * r}, "theta")
    linkage.check()
    q = np.linspace(0.05, 6.2, 25)
    stance = Stance(linkage, np.array([q, 0 * q, 0 * q, 0 * q]), shifts={2: r * np.cos(q)})
    total = inertia_at_rate(stance) * speed**2 + inertia_at_start(stance) * acceleration
    total.push(linkage.owner("Y"), -force)
    x_ddot = -r * np.cos(q) * speed**2 - r * np.sin(q) * acceleration
    by_hand = -r * np.sin(q) * (3.0 * x_ddot + force)
    np.testing.assert_allclose(total.effort, by_hand, atol=1e-12)
    equations = Equilibrium(stance)
    unknowns = equations.under(total)[:, :, 0]
    np.testing.assert_allclose(unknowns[:, equations.column("effort")], by_hand, atol=1e-12)
    np.testing.assert_allclose(
        unknowns[:, equations.column("A slide_n")], -(3.0 * x_ddot + force) * -1, atol=1e-11
    )
