"""Scenes as files: what they say is what runs, and what they get wrong is told with its line."""

from __future__ import annotations

import csv
import json

import numpy as np
import pytest

from coursework.cli import run
from coursework.errors import BadInput
from coursework.mechanics.statement import Load
from coursework.scenes.added import BodyMass, Flywheel, Motor, SceneData
from coursework.scenes.scene_files import read_scene
from coursework.scenes.scenes import Scene
from coursework.system.toml_files import line_of

SCENE = """\
exercise = "three_loop_shaper"
seed = 7
effects = ["load", "gravity", "inertia", "friction", "flywheel"]
show = ["drive_torque", "reaction D", "d5"]
steps = 24

[given]
omega2 = "4 rad/s"

[bodies.8]
mass = "12 kg"

[bodies.5]
mass = "4000 g"
inertia = "0.02 kg*m^2"
centre = ["6 cm", "0 mm"]

[[loads]]
on = "G"
force = "0,8 kN"
against = "motion"
during = "working stroke"

[[loads]]
on = "8"
moment = "2 N*m"

[friction]
G = 0.12
D = { coefficient = 0.08, radius = "10 mm" }

[slides.G]
length = "80 mm"

[flywheel]
unevenness = "2 %"
"""


@pytest.fixture
def write(tmp_path):
    def written(text, name="scene.toml"):
        path = tmp_path / name
        path.write_text(text, "utf-8")
        return path

    return written


def test_a_file_is_the_scene_that_it_says(course, write):
    read = read_scene(write(SCENE), course)
    exercise = course["three_loop_shaper"]
    loads = (Load("G", force=800.0, against=True, during="working stroke"), Load("8", moment=2.0))
    added = SceneData(
        {"8": BodyMass(12.0), "5": BodyMass(4.0, 0.02, 60 + 0j)},
        loads,
        {"G": 0.12, "D": (0.08, 10.0)},
        {"G": 80.0},
        Flywheel(unevenness=0.02),
    )
    assert read.scene.added == added
    given = {**exercise.variant(7).used, "omega2": 4.0}
    wanted = Scene(
        exercise,
        given,
        ("load", "gravity", "inertia", "friction", "flywheel"),
        ("drive_torque", "reaction D", "d5"),
        added,
    )
    found, right = read.scene.over_cycle(read.steps), wanted.over_cycle(24)
    assert list(found.columns) == list(right.columns)
    for name, column in right.columns.items():
        np.testing.assert_array_equal(found.columns[name], column)


def test_a_motion_in_time_has_a_drive_and_a_duration(course, write):
    text = (
        'exercise = "four_bar_motion"\neffects = ["inertia"]\nduration = "500 ms"\n'
        'drive = { torque = "20 N*m", no_load_speed = "300 rpm" }\n[bodies.4]\ninertia = "0.3 kg*m^2"\n'
    )
    read = read_scene(write(text), course)
    assert read.duration == 0.5
    assert isinstance(read.drive, Motor)
    assert (read.drive.torque, read.drive.no_load_speed) == (20.0, pytest.approx(300 * 2 * np.pi / 60))


WRONG = {
    "exercise = 'four_bar_moton'": ("line 1", "did you mean 'four_bar_motion'"),
    "effects = ['inerta']": ("line 2", "did you mean 'inertia'"),
    "effects = ['clearance']": ("line 2", "impacts and clearances are not simulated"),
    "show = ['reaction Q']": ("line 2", "no joint 'Q'"),
    "show = ['velocity']": ("line 2", "no quantity to show 'velocity'"),
    "[clearance]\nB = 0.1": ("line 2", "impacts and clearances are not simulated"),
    "efects = []": ("line 2", "did you mean 'effects'"),
    "steps = 0": ("line 2", "whole number from 1 on"),
    "duration = '2 s'": ("line 2", "needs a drive"),
    "drive = { torqe = 3 }": ("line 2", "did you mean 'torque'"),
    "drive = { torque = '3 N' }": ("line 2", "a number in N*m"),
    "[given]\nr9 = 3": ("line 3", "no given quantity 'r9'"),
    "[given]\nr1 = '3 kg'": ("line 3", "r1 is in mm"),
    "[bodies.9]\nmass = '1 kg'": ("line 2", "no body '9'"),
    "[bodies.3]\nmas = 1": ("line 3", "did you mean 'mass'"),
    "[bodies.3]\nmass = '-1 kg'": ("line 3", "not negative"),
    "[bodies.3]\ncentre = 'Q'": ("line 3", "no point 'Q'"),
    "[[loads]]\non = 'Q'\nforce = '1 N'\nangle = '0 deg'": ("line 3", "no point or body 'Q'"),
    "[[loads]]\non = 'B'\nforce = '800 N'": ("line 2", 'angle = "180 deg"'),
    "[[loads]]\non = 'B'\ntable = [['0 deg', '1 N'], ['9 deg', '2 N']]": ("line 2", 'against = "motion"'),
    "[bodies.3]\nmass = 2": ("line 3", 'mass = "2 kg"'),
    "[bodies.3]\nmass = '2,5'": ("line 3", 'mass = "2,5 kg"'),
    "[bodies.3]\ncentre = [60, 0]": ("line 3", 'centre = "60 mm"'),
    "[given]\nr1 = 300": ("line 3", 'r1 = "300 mm"'),
    "[[loads]]\non = 'B'": ("line 2", "how large"),
    "[[loads]]\non = 'B'\nforce = '3 mm'": ("line 4", "force is a number in N"),
    "[[loads]]\non = 'B'\nforce = 3\nduring = 'working'": ("line 5", "did you mean 'working stroke'"),
    "[[loads]]\non = 'B'\nforce = '3 N'\nangle = '0 deg'\n[[loads]]\non = 'A'\nforce = 'r1'": (
        "line 8",
        "r1 is in mm",
    ),
    "[[loads]]\non = 'B'\ntable = [['0 deg', '1 N'], ['0 deg', '2 N']]": ("line 4", "must increase"),
    "[[loads]]\non = 'B'\nbody = '2'\nforce = '1 N'\nangle = '0 deg'": ("line 4", "no body '2'"),
    "[friction]\nB = 0.1": ("line 3", "B is a pin: its friction has the radius"),
    "[friction]\nB = { coefficient = -0.1, radius = 3 }": ("line 3", "not negative"),
    "[slides.B]\nlength = '3 mm'": ("line 2", "no slide 'B'"),
    "[flywheel]\ninertia = '1 kg*m^2'\nunevenness = 0.1": ("line 2", 'inertia = "2 kg*m^2", or'),
    "[flywheel]\nunevenness = 0": ("line 3", "between 0 and 1"),
    "[gravity]\nangel = 3": ("line 3", "did you mean 'angle'"),
}


@pytest.mark.parametrize("wrong", WRONG)
def test_what_makes_no_sense_is_told_with_its_line(course, write, wrong):
    text = wrong if wrong.startswith("exercise") else f'exercise = "four_bar_motion"\n{wrong}'
    line, why = WRONG[wrong]
    with pytest.raises(BadInput) as told:
        read_scene(write(text), course)
    assert f"scene.toml{', ' + line if line else ''}" in str(told.value)
    assert why in str(told.value)


def test_a_file_that_is_not_there_or_no_toml_is_told(course, write, tmp_path):
    with pytest.raises(BadInput, match="cannot be read"):
        read_scene(tmp_path / "none.toml", course)
    with pytest.raises(BadInput, match=r"scene.toml: .*end of document"):
        read_scene(write("exercise = "), course)
    with pytest.raises(BadInput, match="names no exercise"):
        read_scene(write("seed = 3"), course)


@pytest.mark.e2e
def test_the_commands_run_a_file(write, tmp_path, capsys):
    path, out = write(SCENE), tmp_path / "out"
    assert run(["simulate", str(path), "--out", str(out)]) == 0
    said = capsys.readouterr().out
    assert "flywheel: " in said
    with (out / "scene-cycle.csv").open(encoding="utf-8-sig") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 25
    assert {"drive_torque [N*m]", "R_D [N]", "d5 [mm]"} <= set(rows[0])
    assert run(["simulate", str(path), "--plan"]) == 0
    assert "equilibrium of 7 bodies" in capsys.readouterr().out
    assert run(["simulate", str(path), "--budget", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert {row["effect"] for row in told["effects"]} == {
        "load",
        "gravity",
        "inertia",
        "friction",
        "flywheel",
    }
    assert run(["simulate", str(path), "--effects", "load"]) == 2
    assert "leave --effects out" in capsys.readouterr().err
    assert (
        run(
            [
                *"simulate slider_crank_torque --effects inertia --drive".split(),
                "torque=5 Nm",
                "--duration",
                "0.1 s",
            ]
        )
        == 0
    )
    assert run(["simulate", "slider_crank_torque", "--effects", "inertia", "--duration", "0.1"]) == 2


def test_lines_are_found_where_keys_stand():
    text = 'a = 1\n[t]\nb = 2\n[[l]]\nc = 3\n[[l]]\n"c" = 4\n[u.v]\nw.x = 5\n'
    assert [
        line_of(text, path)
        for path in (("a",), ("t", "b"), ("l", 0, "c"), ("l", 1, "c"), ("u", "v", "w", "x"))
    ] == [
        1,
        3,
        5,
        7,
        9,
    ]
    assert line_of(text, ("l", 1, "missing")) == 6
    assert line_of(text, ("none",)) == 0
