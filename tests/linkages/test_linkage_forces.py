"""Torques, thrusts and advantages of mechanisms stated as files, against Lagrange's multipliers of their joints.

The test places each body by three coordinates of its own, closes its joints by Newton's method from a pose that is off, and asks
the multiplier of what drives: it shares no formula with the package but what the file's entries say.
"""

import re

import numpy as np
import pytest
from linkage_samples import FOLDER, NAMES
from tables import each_row

from coursework import open_course
from coursework.degrees import acos, asin, atan2, cos, sin, sqrt, tan
from coursework.linkages.compiled import compiled
from coursework.linkages.entries import GROUND

KNOWN = {"np": np, "abs": abs, **{f.__name__: f for f in (acos, asin, atan2, cos, sin, sqrt, tan)}}
WITHOUT_ONE = ("planet_wheel",)  #: nothing but wheels, whose angles a pose off the right one leaves open
QUICK = ("slider_crank", "scotch_yoke", "tipper", "crossed_slides")


class Machine:
    """Bodies and joints of a file, with numbers: three coordinates a body, in mm and radians."""

    def __init__(self, linkage, values):
        self.linkage, self.values = linkage, values
        self.names = [*linkage.bodies, *filter(None, [linkage.drive.rod])]
        self.local = {
            (b, p): self.number(place.x) + 1j * self.number(place.y)
            if place.radius is None
            else self.number(place.radius) * np.exp(1j * np.radians(self.number(place.angle)))
            for b, points in [(GROUND, linkage.ground), *((n, e.points) for n, e in linkage.bodies.items())]
            for p, place in points.items()
        }
        if linkage.jack:  # its cylinder and its rod have one pin each
            start, end = linkage.bodies[linkage.jack].points
            del self.local[linkage.jack, end]
            self.local |= {(linkage.jack, start): 0j, (linkage.drive.rod, end): 0j}

    def number(self, expression):
        return float(eval(expression.code, KNOWN, dict(self.values)))

    def frame(self, q, body):
        k = 3 * self.names.index(body) if body != GROUND else None
        return (0j, 0.0) if k is None else (q[k] + 1j * q[k + 1], q[k + 2])

    def place(self, q, body, point):
        origin, turn = self.frame(q, body)
        return origin + self.local[body, point] * np.exp(1j * turn)

    def gaps(self, q, start):
        """What is 0 where the joints hold, and last what the drive sets; ``start`` of angles that a slide keeps apart."""
        linkage, found = self.linkage, []
        holders = {}
        for body, point in self.local:
            holders.setdefault(point, []).append(body)
        for point, bodies in holders.items():
            for other in bodies[1:]:
                gap = self.place(q, other, point) - self.place(q, bodies[0], point)
                found += [gap.real, gap.imag]
        driven = []
        slides = [
            (s.at, s.of, s.on, self.track(s), self.number(s.along), s.distance)
            for s in linkage.slides.values()
        ]
        if linkage.jack:
            end = [*linkage.bodies[linkage.jack].points][1]
            slides.append((end, linkage.drive.rod, linkage.jack, 0j, 0.0, linkage.moved))
        for at, of, on, through, along, distance in slides:
            origin, turn = self.frame(q, on)
            way = np.exp(1j * (turn + np.radians(along)))
            apart = (self.place(q, of, at) - origin - through * np.exp(1j * turn)) / way
            kept = self.frame(start, of)[1] - self.frame(start, on)[1]
            found += [apart.imag, 100 * (self.frame(q, of)[1] - turn - kept)]
            if distance == linkage.moved:
                driven.append(apart.real - self.values[linkage.moved])
        for gear in linkage.gears:
            one, other, carrier = (
                self.frame(q, b)[1] - self.frame(start, b)[1] for b in (gear.first, gear.second, gear.carrier)
            )
            sense = -1 if gear.inner else 1
            found.append(
                self.number(gear.radii[0]) * (one - carrier)
                + sense * self.number(gear.radii[1]) * (other - carrier)
            )
        if linkage.drive.kind == "turn":
            driven.append(self.frame(q, linkage.driver)[1] - np.radians(self.values[linkage.moved]))
        return np.array([*found, *driven])

    def track(self, slide):
        place = slide.through
        if place.radius is not None:
            return self.number(place.radius) * np.exp(1j * np.radians(self.number(place.angle)))
        return self.number(place.x) + 1j * self.number(place.y)

    def slopes(self, function, q):
        """The derivatives of a function, by steps into the complex numbers' place: central differences of a small step."""
        steps = 1e-4 * np.where(np.arange(len(q)) % 3 == 2, 0.01, 1.0)
        return np.stack(
            [
                (
                    8 * (function(q + h * e) - function(q - h * e))
                    - function(q + 2 * h * e)
                    + function(q - 2 * h * e)
                )
                / (12 * h)
                for h, e in zip(steps, np.eye(len(q)), strict=True)
            ],
            -1,
        )

    def effort(self, start, powers, off=1.0):
        """The pose near one, sought from a place that is off it, and the multiplier of what drives: N mm of an angle, N of a
        length. ``powers``: the loads' work."""
        q = start.copy()
        for number in range(len(q)):
            q[number] += off * (0.02 if number % 3 == 2 else 0.7) * (-1) ** number
        kept = start.copy()
        for _ in range(30):
            step = np.linalg.solve(self.slopes(lambda z: self.gaps(z, kept), q), self.gaps(q, kept))
            q = q - step
            if np.max(abs(step)) < 1e-10:
                break
        slopes = self.slopes(lambda z: self.gaps(z, kept), q)
        return q, -np.linalg.solve(slopes.T, self.slopes(lambda z: np.array([powers(z)]), q)[0])[-1]


def loaded(name, folder):
    """The file of a mechanism, with a moment on a body and forces at two points; what acts, and the exercise."""
    text = (FOLDER / "exercises" / f"{name}.toml").read_text("utf-8")
    linkage = compiled(FOLDER / "exercises" / f"{name}.toml").linkage
    turning = [
        b
        for b in linkage.bodies
        if b not in (linkage.driver, linkage.jack) and len(linkage.bodies[b].points) > 1
    ]
    points = [
        p for b in turning or linkage.bodies for p in linkage.bodies[b].points if p not in linkage.ground
    ]
    loads = [(points[-1], 70.0, 20.0), (points[0], -40.0, 75.0)]
    moment = [(turning[-1], 9.0)] if turning else []
    said = [f'{{ on = "{p}", force = "{f} N", angle = "{a} deg" }}' for p, f, a in loads]
    said += [f'{{ on = "{b}", moment = "{m} N*m" }}' for b, m in moment]
    key = "torque" if linkage.drive.kind == "turn" else "thrust"
    text = re.sub(r"(?m)^(torque|thrust|advantage|polygon) = .*$", "", text)
    if not linkage.speed:
        pytest.skip("no speed")
    text = text.replace("[ask]", f"[ask]\n{key} = {{ load = [{', '.join(said)}] }}", 1)
    (folder / f"{name}.toml").write_text(text, "utf-8")
    return loads, moment, key


def pose(machine, made, exercise, given):
    """The bodies' coordinates by the package, from which the test's own are sought."""
    linkage, turns = machine.linkage, made.formulas.turns
    names = [n for n in exercise.solution.graph.names if n[0] in "xy" or n.startswith("theta")]
    found = {**exercise.solve(only=[n for n in names if n not in given], **given), **given}
    q = []
    for body in machine.names:
        turn = turns[linkage.jack if body == linkage.drive.rod else body]
        angle = found[turn] if turn in found else float(eval(turn, KNOWN, dict(found)))
        point, away = next((p, z) for (b, p), z in machine.local.items() if b == body)
        there = machine.local.get((GROUND, point))
        there = complex(found[f"x{point}"], found[f"y{point}"]) if there is None else there
        origin = there - away * np.exp(1j * np.radians(angle))
        q += [origin.real, origin.imag, float(np.radians(angle))]
    return np.array(q)


def efforts(exercise, made, given, forces, moments, key, off=1.0):
    """The test's own pose and the package's; the effort of the drive by either."""
    machine = Machine(made.linkage, given)
    start = pose(machine, made, exercise, given)

    def work(q):
        total = sum(1000 * m * machine.frame(q, b)[1] for b, m in moments)
        for point, size, angle in forces:
            body = next(b for b, p in machine.local if p == point)
            total += size * (machine.place(q, body, point) * np.exp(-1j * np.radians(angle))).real
        return total

    q, found = machine.effort(start, work, off)
    return q, start, found / (1000 if key == "torque" else 1), exercise.solve(only=key, **given)[key]


@pytest.mark.parametrize(
    "names",
    [QUICK, pytest.param([n for n in NAMES if n not in (*QUICK, *WITHOUT_ONE)], marks=pytest.mark.sweep)],
    ids=["few", "others"],
)
def test_efforts_of_the_drive_are_the_multipliers_of_its_joints(names, tmp_path):
    (tmp_path / "exercises").mkdir()
    said = {name: loaded(name, tmp_path / "exercises") for name in names}
    course, apart = open_course(tmp_path), {}
    for name, (forces, moments, key) in said.items():
        exercise, made = course[name], compiled(tmp_path / "exercises" / f"{name}.toml")
        for seed in (0, 3):
            q, start, effort, right = efforts(
                exercise, made, dict(exercise.variant(seed).given), forces, moments, key
            )
            if not (np.max(abs(q - start)) < 1e-6 and abs(right - effort) <= 1e-6 * max(1.0, abs(effort))):
                apart[name, seed] = (right, effort, np.max(abs(q - start)))
    assert apart == {}


@each_row(
    "name, near",
    [
        (
            "piston_engine",
            {"r2": 50.0, "r3": 150.0, "e": 0.0, "x": 199.99},
        ),  # the crank and the rod in one line
        ("slider_crank", {"r2": 50.0, "r3": 150.0, "e": 0.0, "theta2": 0.01}),
        ("slider_crank", {"r2": 50.0, "r3": 150.0, "e": 0.0, "theta2": 179.99}),
        (
            "four_bar",
            {"r1": 200.0, "r2": 150.0, "r3": 60.0, "r4": 70.0, "theta2": 40.53},
        ),  # the coupler and the output bar
        ("four_bar", {"r1": 200.0, "r2": 50.0, "r3": 120.0, "r4": 200.0, "theta2": 0.01}),
    ],
)
def test_efforts_beside_dead_centres_are_the_multipliers_too(name, near, tmp_path_factory):
    folder = tmp_path_factory.mktemp("near") / "exercises"
    folder.mkdir()
    forces, moments, key = loaded(name, folder)
    exercise, made = open_course(folder.parent)[name], compiled(folder / f"{name}.toml")
    given = {**exercise.variant(0).given, **near}
    q, start, effort, right = efforts(exercise, made, given, forces, moments, key, off=1e-4)
    assert np.max(abs(q - start)) < 1e-5
    assert right == pytest.approx(effort, rel=1e-5)


@each_row(
    "name, ask, effort, load",
    [
        ("slider_crank", 'advantage = "x"\ntorque = { load = { on = "B", force = "70 N" } }', "torque", 70.0),
        ("scotch_yoke", 'advantage = true\ntorque = { load = { on = "B", force = "70 N" } }', "torque", 70.0),
        ("four_bar", 'advantage = true\ntorque = { load = { on = "4", moment = "9 N*m" } }', "torque", 9.0),
        (
            "piston_engine",
            'advantage = "2"\nthrust = { load = { on = "2", moment = "9 N*m" } }',
            "thrust",
            9000.0,
        ),
    ],
)
def test_an_advantage_is_the_load_over_the_effort_that_balances_it(name, ask, effort, load, tmp_path_factory):
    """Of a slide too: a force over a torque in 1/m, a torque over a force in mm."""
    folder = tmp_path_factory.mktemp("advantage") / "exercises"
    folder.mkdir()
    text = re.sub(
        r"(?m)^(torque|thrust) = .*$", "", (FOLDER / "exercises" / f"{name}.toml").read_text("utf-8")
    )
    (folder / f"{name}.toml").write_text(text.replace("[ask]", f"[ask]\n{ask}", 1), "utf-8")
    exercise = open_course(folder.parent)[name]
    given = dict(exercise.variant(1).given)
    found = exercise.solve(only=("advantage", effort), **given)
    assert found["advantage"] == pytest.approx(-load / found[effort])
