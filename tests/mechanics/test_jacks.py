"""A jack as a driver: its thrust and its motion by other roads, what it refuses, and every exercise that
states one."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import mpmath
import numpy as np
import pytest
from exact_mechanics import ExactMechanics
from sweeps import sampled
from tables import each_row

import coursework
from coursework.cli import run
from coursework.errors import BadCourse, BadInput, WrongValue
from coursework.mechanics.statement import Load
from coursework.scenes.added import BodyMass, Flywheel, SceneData
from coursework.scenes.scene_files import read_scene
from coursework.scenes.scenes import Scene

COURSE = coursework.open_course()
ROOT = Path(__file__).resolve().parents[2]
JACK = COURSE["jack_mechanism"]
STATED = [n for n in COURSE if (driver := COURSE[n].spec.driver) is not None and driver.jack is not None]
BODIES = {
    "4": BodyMass(900.0, 60.0, "G"),
    "3": BodyMass(21.0, 0.8, -150 + 4j),
    "2": BodyMass(34.0, 1.7, 220 - 6j),
}
LOAD = Load("G", force=1500.0, angle=-70.0)
FRICTION = {"A": 0.11, "O": (0.08, 40.0), "B": (0.06, 30.0)}
G = 9.81


def scene(seed, *effects, show=(), **changes):
    data = SceneData(BODIES, (LOAD,), FRICTION)
    return Scene(JACK, {**JACK.variant(seed).used, **changes}, effects, show, data)


# ------------------------------------------------------------------ the registry


def test_every_exercise_whose_driver_moves_by_a_length_is_a_scene():
    """A driver whose rate is given in mm/s is a jack, and says so; its scene closes from end to end in every
    draw."""
    faults = []
    for name in COURSE:
        exercise = COURSE[name]
        driver, units = exercise.spec.driver, exercise.units
        rates = {n for n in exercise.spec.given if units.get(n) == "mm/s"}
        if driver is None or not (rates or driver.jack):
            continue
        if driver.jack is None:
            faults.append(f"{name}: {rates} moves it, and its driver states no jack")
            continue
        jack, mechanism = driver.jack, exercise.solution.mechanism
        named = (jack.length, jack.speed, jack.acceleration, *jack.limits)
        if [units.get(n) for n in named if n in exercise.spec.given] != ["mm", "mm/s", "mm/s^2", "mm", "mm"]:
            faults.append(f"{name}: {named} are given in {[units.get(n) for n in named]}")
        if mechanism is None or not mechanism.pushed:
            faults.append(f"{name}: its MECHANISM is pushed along no slide")
            continue
        for variant in exercise.variants(range(31)):
            faults += _open(variant)
    assert not faults
    assert STATED == ["jack_mechanism"]


def _open(variant):
    exercise, given = variant.exercise, variant.used
    jack = exercise.spec.driver.jack
    bodies = {body: BodyMass(2.0, 0.1) for body in exercise.solution.mechanism.names}
    wanted = ("position", "velocity", "acceleration", "coriolis", "gravity", "inertia")
    table = Scene(exercise, given, wanted, ("drive_thrust",), SceneData(bodies)).over_cycle(12)
    empty = [n for n, column in table.columns.items() if not np.isfinite(column).all()]
    ends = table.columns[jack.length][[0, -1]].tolist()
    if empty or ends != [given[n] for n in jack.limits] or len(table.notes) != 1:
        yield f"{exercise.name}, seed {variant.seed}: {empty} empty, {ends}, {table.notes}"


# ------------------------------------------------------------------ motion


@pytest.mark.parametrize("seed", sampled(range(31), range(4)))
def test_the_scene_shows_the_answers_of_the_exercise_at_every_length(seed):
    """By the exercise's formulas one length at a time, and by the joints alone for the points."""
    kinds = ("position", "velocity", "acceleration", "coriolis")
    asked = [p.quantity for p in JACK.spec.parts if not p.by_request]
    by_formulas = Scene(JACK, JACK.variant(seed).used, kinds, tuple(asked)).over_cycle(8)
    assert set(asked) <= by_formulas.columns.keys()
    points = ("velocity G", "acceleration G", "coriolis A", "position G")
    by_joints = Scene(JACK, JACK.variant(seed).used, (), points).over_cycle(8)
    for row, length in enumerate(by_formulas.columns["L"]):
        right = JACK.solve(**{**JACK.variant(seed).used, "L": float(length)}, only=tuple(asked))
        for name in asked:
            assert by_formulas.columns[name][row] == pytest.approx(right[name], rel=1e-13), name
        for name, other in (("v_G", "v_G"), ("a_G", "a_G"), ("yG", "y_G"), ("a_coriolis", "a_coriolis_A")):
            assert by_joints.columns[other][row] == pytest.approx(right[name], rel=1e-10), name


def test_positions_alone_evaluate_no_rate():
    assert not {"omega4", "alpha4"} & set(scene(0, "position").over_cycle(4).evaluated)


def test_what_moves_with_the_driver_is_no_constant_though_no_effect_names_it():
    columns = scene(0, show=("yG", "swing")).over_cycle(6).columns
    assert len(set(columns["yG"])) == 7
    assert np.ptp(columns["swing"]) == 0


# ------------------------------------------------------------------ thrust


@each_row(("seed", "end"), [(0, 1), (3, 3), (7, 2), (9, 0), (9, 4)])
def test_thrust_and_reactions_are_those_of_a_reference_of_many_digits(seed, end):
    """At a length of the travel, the ends among them, with all effects together."""
    effects = ("load", "gravity", "inertia", "friction")
    own = scene(seed, *effects, show=("drive_thrust", "reaction A", "reaction B", "reaction O"))
    columns = own.over_cycle(4).columns
    force = complex(LOAD.force * np.exp(1j * np.radians(LOAD.angle)))
    with mpmath.workdps(90):
        given = {**own.given, "OB": mpmath.hypot(own.given["xB"], own.given["yB"])}
    exact = ExactMechanics(
        JACK, own.mechanism, given, columns["L"][end], given["L_dot"], given["L_ddot"]
    ).borne(gravity=True, inertia=True, loads=[("G", force)], friction=FRICTION)
    names = {"effort": "drive_thrust", "A slide_n": "N_A", "A slide_m": "M_A"}
    names |= {f"{p}_{axis}": f"R_{p}_{axis}" for p in "AOB" for axis in "xy"}
    assert set(exact) == set(names)
    size = max(abs(value) for value in exact.values())
    for unknown, name in names.items():
        assert float(columns[name][end]) == pytest.approx(float(exact[unknown]), abs=1e-11 * float(size)), (
            name
        )


def energies(given, length):
    """Twice the kinetic energy for 1 m/s of the jack, and what weight and load store, by crossing circles."""

    def poses(at):
        foot = complex(given["xB"], given["yB"])
        along = (given["a"] ** 2 + abs(foot) ** 2 - at**2) / (2 * abs(foot))
        head = foot / abs(foot) * (along + 1j * np.sqrt(given["a"] ** 2 - along**2))
        tip, push = head / abs(head), (head - foot) / at
        centres = (
            given["c"] * np.exp(1j * np.radians(given["eta"])) * tip,
            head + BODIES["3"].centre * push,
            foot + BODIES["2"].centre * push,
        )
        return centres, (tip, push, push)

    step = 1e-3 * length  # of a difference of the eighth order
    weights = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}
    here, turned = poses(length)
    there = {k: poses(length + k * step) for j in weights for k in (j, -j)}

    def slope(read):
        return sum(w * (read(there[k]) - read(there[-k])) for k, w in weights.items()) / step

    inertia = potential = 0.0
    for n, mass in enumerate(BODIES[body] for body in "432"):
        spin = slope(lambda pose, n=n: np.angle(pose[1][n] / turned[n])) * 1000
        inertia += mass.mass * abs(slope(lambda pose, n=n: pose[0][n])) ** 2 + mass.inertia * spin**2
        potential += mass.mass * G * here[n].imag / 1000
    push = LOAD.force * np.exp(1j * np.radians(LOAD.angle))
    return inertia, potential - (np.conj(push) * here[0]).real / 1000


@pytest.mark.parametrize("seed", sampled(range(12), range(3)))
def test_thrust_is_what_energies_say(seed):
    """Lagrange: M L'' + M' L'^2 / 2 + V', M and V of the bodies where two circles cross, slopes by
    differences."""
    own = scene(seed, "load", "gravity", "inertia", show=("drive_thrust", "drive_power", "kinetic_energy"))
    columns, given = own.over_cycle(6).columns, own.given
    pace, gain = given["L_dot"] / 1000, given["L_ddot"] / 1000
    step = 0.2
    for length, thrust, power, kinetic in zip(
        *(columns[n] for n in ("L", "drive_thrust", "drive_power", "kinetic_energy")), strict=True
    ):
        (m0, _), *near = (energies(given, length + k * step) for k in (0, -2, -1, 1, 2))
        slopes = [(a - 8 * b + 8 * c - d) / (12 * step / 1000) for a, b, c, d in zip(*near, strict=True)]
        right = m0 * gain + slopes[0] * pace**2 / 2 + slopes[1]
        assert thrust == pytest.approx(right, rel=1e-7)
        assert power == pytest.approx(thrust * pace, rel=1e-11)
        assert kinetic == pytest.approx(m0 * pace**2 / 2, rel=1e-9)


def test_thrust_by_hand_where_the_jack_stands_square_to_the_level_body():
    """OBA is a 3-4-5 triangle at the shortest length: moments about O, 200 cos 30 deg beside 400; friction in
    the slide bears nothing, a motion the other way changes no sign."""
    given = {
        "a": 400,
        "xB": 400,
        "yB": -300,
        "L_min": 300,
        "L_max": 600,
        "c": 200,
        "eta": 30,
        "L": 310,
        "L_ddot": 0,
    }
    down = SceneData(loads=(Load("G", force=1000.0, angle=-90.0),), friction={"A": 0.3})
    for rate in (120, -120):
        one = Scene(JACK, {**given, "L_dot": rate}, ("load", "friction"), (), down)
        thrust = one.over_cycle(1).columns["drive_thrust"][0]
        assert thrust == pytest.approx(1000 * 200 * np.cos(np.radians(30)) / 400, rel=1e-12)


# ------------------------------------------------------------------ ends, and what needs a crank


def test_the_ends_of_the_travel_are_told():
    (note,) = scene(0).over_cycle(4).notes
    ends = JACK.variant(0).used
    assert f"{ends['L_min']:g} mm (L_min, the jack is shortest)" in note
    assert f"{ends['L_max']:g} mm (L_max, it is longest)" in note
    with pytest.raises(
        WrongValue, match=r"grows from L_min, its shortest, to L_max, its longest; found 395 mm and"
    ):
        scene(0, L_max=100.0).over_cycle()
    with pytest.raises(WrongValue, match="L_max is not given"):
        Scene(JACK, {n: v for n, v in ends.items() if n != "L_max"}).over_cycle()


def test_a_jack_longer_than_its_reach_leaves_cells_empty_and_a_dead_point_is_told():
    """In line with OA it ends: the thrust and the rates do not exist there, and beyond nothing closes."""
    given = {
        "a": 500.0,
        "xB": 300.0,
        "yB": -400.0,
        "L_min": 700.0,
        "c": 250.0,
        "eta": 20.0,
        "L": 800.0,
        "L_dot": 90.0,
    }
    weight = SceneData({"4": BodyMass(100.0, 5.0, "G")})

    def table(longest):
        return Scene(JACK, {**given, "L_max": longest, "L_ddot": 0.0}, ("gravity",), (), weight).over_cycle(
            10
        )

    reached = table(1000.0)
    assert np.isfinite(reached.columns["drive_thrust"]).tolist() == [True] * 10 + [False]
    assert any("dead centre" in note and "L = 1000 mm" in note for note in reached.notes)
    assert "the mechanism does not close at 5 of 11 lengths" in table(1300.0).notes


def test_at_rest_the_thrust_is_that_of_statics():
    """Without a rate, and told: the note names the rate of the jack; gravity alone is the same at any
    rate."""
    at_rest = scene(0, "gravity", "friction")
    at_rest = replace(at_rest, given={n: v for n, v in at_rest.given.items() if n not in ("L_dot", "L_ddot")})
    table = at_rest.over_cycle(4)
    assert any("at rest (L_dot = 0) friction" in note for note in table.notes)
    moving = scene(0, "gravity").over_cycle(4).columns["drive_thrust"]
    np.testing.assert_allclose(table.columns["drive_thrust"], moving, rtol=1e-12)


TURNS = {
    "a flywheel": lambda: Scene(
        JACK, JACK.variant(0).used, ("flywheel",), (), SceneData(flywheel=Flywheel(2.0))
    ),
    "a torque in time": lambda: scene(0, "inertia").in_time(50.0, 1.0),
    "the working stroke": lambda: _loaded("working stroke").over_cycle(4),
    "the return stroke": lambda: _loaded("return stroke").over_cycle(4),
}


def _loaded(during):
    data = SceneData(loads=(Load("G", force=10.0, against=True, during=during),))
    return Scene(JACK, JACK.variant(0).used, ("load",), (), data)


@each_row("what", TURNS)
def test_what_needs_a_crank_says_so(what):
    with pytest.raises(
        WrongValue, match=f"{what} belongs to a crank .* length L of a jack, from L_min to L_max"
    ):
        TURNS[what]()


def test_a_load_on_the_way_out_acts_as_the_jack_grows():
    """Of the body that the jack lifts, forward: the thrust is that of a load all the time, or nothing."""
    rising, falling = abs(JACK.variant(0).used["L_dot"]), -abs(JACK.variant(0).used["L_dot"])
    always, forward = _loaded("always"), _loaded("forward")

    def thrust(one, pace):
        return replace(one, given={**one.given, "L_dot": pace}).over_cycle(4).columns["drive_thrust"]

    np.testing.assert_array_equal(thrust(forward, rising), thrust(always, rising))
    assert not thrust(forward, falling).any()


def test_thrust_and_torque_are_shown_where_they_drive():
    with pytest.raises(WrongValue, match="a jack drives the mechanism, not a crank; show drive_thrust"):
        scene(0, show=("drive_torque",))
    crank = COURSE["four_bar_motion"]
    with pytest.raises(WrongValue, match="no jack drives the mechanism; show drive_torque"):
        Scene(crank, crank.variant(0).used, (), ("drive_thrust",))
    with pytest.raises(BadCourse, match="a jack pushes along a slide; none is at 'B'"):
        replace(JACK.solution.mechanism, pushed="B")


# ------------------------------------------------------------------ files

SCENE = """\
exercise = "jack_mechanism"
seed = 3
effects = ["velocity", "load", "gravity", "friction"]
show = ["drive_thrust", "reaction B"]
steps = 24

[given]
L_dot = "{rate}"

[bodies.4]
mass = "900 kg"
centre = "G"

[[loads]]
on = "G"
table = [["0 mm", "0 N"], ["1 m", "{most}"]]
by = "L"
angle = "-90 deg"

[friction]
A = 0.1
"""


@each_row(
    ("lang", "rate", "most", "ends", "refused"),
    [
        (
            "en",
            "0.12 m/s",
            "2.5 kN",
            "(L_min, the jack is shortest)",
            "a flywheel belongs to a crank that turns",
        ),
        (
            "fr",
            "0,12 m/s",
            "2,5 kN",
            "(L_min, vérin au plus court)",
            "un volant d’inertie suppose une manivelle qui tourne",
        ),
    ],
)
def test_a_scene_file_with_a_jack_runs_in_either_language(
    lang, rate, most, ends, refused, tmp_path, monkeypatch, capsys
):
    monkeypatch.setenv("LC_ALL", {"en": "en_US.UTF-8", "fr": "fr_FR.UTF-8"}[lang])
    path = tmp_path / "tip.toml"
    path.write_text(SCENE.format(rate=rate, most=most), "utf-8")
    assert run(["simulate", str(path), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert run(["simulate", str(path)]) == 0
    assert ends in capsys.readouterr().out
    assert run(["simulate", "jack_mechanism", "--effects", "flywheel"]) == 2
    assert refused in capsys.readouterr().err
    given = {**JACK.variant(3).used, "L_dot": 120.0}
    data = SceneData(
        {"4": BodyMass(900.0, None, "G")},
        (Load("G", angle=-90.0, by="L", table=((0.0, 0.0), (1000.0, 2500.0))),),
        {"A": 0.1},
    )
    effects, show = ("velocity", "load", "gravity", "friction"), ("drive_thrust", "reaction B")
    right = Scene(JACK, given, effects, show, data).over_cycle(24).columns["drive_thrust"]
    shown = [row["drive_thrust [N]"] for row in told["rows"]]
    np.testing.assert_allclose(shown, right, rtol=1e-12)


def test_the_scene_of_the_documentation_shows_the_thrust(tmp_path):
    page = ROOT / "docs" / "scenes.md"
    blocks = re.findall(r"```toml\n(.*?)```", page.read_text("utf-8"), re.DOTALL)
    (block,) = [one for one in blocks if "jack_mechanism" in one]
    (tmp_path / "tipping.toml").write_text(block, "utf-8")
    columns = read_scene(tmp_path / "tipping.toml", COURSE).scene.over_cycle(4).columns
    assert {"drive_thrust", "R_B"} <= columns.keys()
    assert np.isfinite(columns["drive_thrust"]).all()


@each_row(
    ("wrong", "line", "what"),
    [
        ('effects = ["flywheel"]', "line 2", "a flywheel"),
        ('effects = ["inertia"]\ndrive = { torque = "5 N*m" }', "line 3", "a torque in time"),
        (
            '[[loads]]\non = "G"\nforce = "9 N"\nagainst = "motion"\nduring = "working stroke"',
            "line 6",
            "the working stroke",
        ),
        ('show = ["drive_torque"]', "line 2", "show drive_thrust"),
    ],
)
def test_what_a_file_asks_of_a_jack_in_vain_is_told_with_its_line(wrong, line, what, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(f'exercise = "jack_mechanism"\n{wrong}\n', "utf-8")
    with pytest.raises(BadInput, match=f"{line}: .*{what}"):
        read_scene(path, COURSE)
