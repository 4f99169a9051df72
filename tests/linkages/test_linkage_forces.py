"""Torques, thrusts and advantages of mechanisms stated as files, against Lagrange's multipliers of their
joints."""

import re

import numpy as np
import pytest
from linkage_machine import efforts
from linkage_samples import FOLDER, NAMES
from tables import each_row

from coursework import open_course
from coursework.linkages.compiled import compiled

WITHOUT_ONE = ("planet_wheel",)  #: nothing but wheels, whose angles a pose off the right one leaves open
QUICK = ("slider_crank", "scotch_yoke", "tipper", "crossed_slides")


def loaded(name, folder):
    """The file of a mechanism, with a moment on a body and forces at two points; what acts, and the
    exercise."""
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
