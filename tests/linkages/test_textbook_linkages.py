"""Linkages of textbooks that do not come with the package, from the text of a file to marks, motion and
efforts.

Positions, rates, accelerations and efforts are compared with the joints alone, closed by Newton's method, and
with what the books print: R. L. Norton, *Design of Machinery*, tables P4-1 to P4-3, row a; and with what is
known of the curve or of the ratio.
"""

import re

import numpy as np
import pytest
from linkage_machine import Machine, efforts, pose
from tables import each_row

from coursework import open_course
from coursework.authoring.checks import check
from coursework.errors import Starved
from coursework.issuing.issuing import distinct_variants
from coursework.linkages.compiled import compiled
from coursework.messages import localised

HEAD = """title = {{ fr = "Mécanisme", en = "Mechanism" }}
[given]
{given}
[ground]
{ground}
[bodies]
{bodies}
"""
FOUR = (
    '2 = { at = "O", angle = "theta2", points = { A = "r2" } }\n3 = { points = { A = "0 mm", B = "r3" } }\n'
    '4 = { at = "C", points = { B = "r4" } }'
)
GROUND_OC = 'O = ["0 mm", "0 mm"]\nC = ["r1", "0 mm"]'
TURN = 'theta2 = { from = "0 deg", to = "355 deg", step = "5 deg" }\nomega2 = "3 rad/s"\nalpha2 = "5 rad/s^2"'
ASK = """[ask]
mobility = true
positions = ["theta3", "theta4", "B"]
velocities = ["omega3", "omega4", "V_B"]
accelerations = ["alpha4", "a_B"]
torque = { load = { on = "4", moment = "9 N*m" } }
"""


def file_of(given, ground, bodies, *rest):
    return HEAD.format(given=given, ground=ground, bodies=bodies) + "\n".join(rest)


def bar(r1, r2, r3, r4, side="left", *rest):
    given = f'r1 = "{r1} mm"\nr2 = "{r2} mm"\nr3 = "{r3} mm"\nr4 = "{r4} mm"\n{TURN}'
    return file_of(given, GROUND_OC, FOUR, f'[assembly]\nB = "{side} of A -> C"', *(rest or [ASK]))


#: Stephenson III: a dyad hangs on the coupler of a four-bar linkage.
STEPHENSON = file_of(
    f'r1 = "200 mm"\nr2 = {{ from = "40 mm", to = "60 mm", step = "5 mm" }}\nr3 = "170 mm"\nr4 = "150 '
    f'mm"\n{TURN}\nrequire = "is_crank(2)"',
    f'{GROUND_OC}\nF = ["260 mm", "160 mm"]',
    FOUR.replace('B = "r3"', 'B = "r3", P = { r = "90 mm", angle = "40 deg" }')
    + '\n5 = { points = { P = "0 mm", E = "200 mm" } }\n6 = { at = "F", points = { E = "150 mm" } }',
    '[assembly]\nB = "left of A -> C"\nE = "left of P -> F"',
    """[ask]
mobility = true
class = true
positions = ["theta5", "theta6", "E"]
equations = true
velocities = ["omega6", "V_E"]
accelerations = ["alpha6", "a_E"]
polygon = ["velocity"]
instant_centres = ["I16"]
advantage = true
torque = { load = [{ on = "6", moment = "9 N*m" }, { on = "P", force = "50 N", angle = "70 deg" }] }
""",
)
#: The ends of a bar slide on two lines at right angles; its points go on ellipses. A length drives.
TRAMMEL = file_of(
    'a = "200 mm"\nb = "70 mm"\nx = { from = "30 mm", to = "150 mm", step = "5 mm" }\nx_dot = "80 '
    'mm/s"\nx_ddot = "20 mm/s^2"',
    'O = ["0 mm", "0 mm"]',
    '2 = { points = { A = "0 mm" } }\n3 = { points = { A = "0 mm", B = "a", P = "b" } }\n4 = { points '
    '= { B = "0 mm" } }',
    """[slides]
A = { of = "2", on = "ground", through = "O", along = "0 deg", distance = "x" }
B = { of = "4", on = "ground", through = "O", along = "90 deg", distance = "y" }
[ask]
mobility = true
positions = ["theta3", "y", "P"]
velocities = ["omega3", "y_dot", "V_P"]
accelerations = ["alpha3", "a_P"]
thrust = { load = { on = "B", force = "40 N", angle = "90 deg" } }
""",
)
#: Two shafts that are not in line, and a cross that slides in both: the speeds are equal at every instant.
OLDHAM = file_of(
    f'e = "15 mm"\n{TURN}',
    'O = ["0 mm", "0 mm"]\nQ = ["e", "0 mm"]',
    '2 = { at = "O", angle = "theta2", points = { A = "40 mm" } }\n3 = { points = { K = "0 mm" } }\n4 '
    '= { at = "Q", points = { D = "40 mm" } }',
    """[slides]
K = { of = "3", on = "2", through = "O", along = "0 deg", distance = "u" }
Q = { of = "4", on = "3", through = "K", along = "90 deg", distance = "v" }
[ask]
mobility = true
positions = ["D", "u"]
velocities = ["V_D", "u_dot"]
torque = { load = { on = "4", moment = "9 N*m" } }
""",
)
#: Watt's parallel motion: the middle of the coupler follows a straight line to a thousandth of its length.
WATT = file_of(
    'r2 = "200 mm"\nr3 = "100 mm"\ntheta2 = { from = "-20 deg", to = "20 deg", step = "1 deg" }\n'
    'omega2 = "3 rad/s"\nalpha2 = "5 rad/s^2"',
    'O = ["0 mm", "0 mm"]\nC = ["400 mm", "100 mm"]',
    FOUR.replace('B = "r3"', 'B = "r3", M = "r3 / 2"').replace('B = "r4"', 'B = "r2"'),
    '[assembly]\nB = "left of A -> C"',
    ASK.replace('"B"]', '"M"]'),
)
SLIDER = file_of(
    f'r2 = "35.56 mm"\nr3 = "101.6 mm"\ne = "25.4 mm"\n{TURN}',
    'O = ["0 mm", "0 mm"]',
    '2 = { at = "O", angle = "theta2", points = { A = "r2" } }\n3 = { points = { A = "0 mm", B = "r3" '
    '} }\n4 = { points = { B = "0 mm" } }',
    """[slides]
B = { of = "4", on = "ground", through = ["0 mm", "e"], along = "0 deg", distance = "x" }
[ask]
positions = ["theta3", "x"]
velocities = ["x_dot"]
accelerations = ["x_ddot"]
torque = { load = { on = "B", force = "60 N" } }
""",
)
#: Of Norton's inverted slider-crank the block slides on the bar that is pinned to the ground, at right angles
#: to the arm of 4 in.
INVERTED = file_of(
    f'r1 = "152.4 mm"\nr2 = "50.8 mm"\nr4 = "101.6 mm"\n{TURN}',
    GROUND_OC,
    '2 = { at = "O", angle = "theta2", points = { A = "r2" } }\n3 = { points = { A = "0 mm" } }\n4 = { '
    'at = "C", points = { D = "r4" } }',
    """[slides]
A = { of = "3", on = "4", through = "D", along = "90 deg", distance = "b" }
[ask]
positions = ["theta4", "b"]
velocities = ["omega4", "b_dot"]
accelerations = ["alpha4", "b_ddot"]
torque = { load = { on = "4", moment = "9 N*m" } }
""",
)
#: Hart's inversor: of a crossed parallelogram three points on a parallel to its diagonals are inverse to each
#: other.
HART = file_of(
    'a = { from = "160 mm", to = "180 mm", step = "2 mm" }\nb = "80 mm"\nc = "26 mm"\n'
    'theta2 = { from = "-25 deg", to = "25 deg", step = "1 deg" }\nomega2 = "5 rad/s"\nalpha2 = "5 rad/s^2"',
    'O = ["0 mm", "0 mm"]\nS = ["c", "0 mm"]',
    """2 = { at = "S", angle = "theta2", points = { P = "c" } }
3 = { points = { A = "0 mm", O = "b/4", B = "b" } }
4 = { points = { A = "0 mm", P = "a/4", D = "a" } }
5 = { points = { B = "0 mm", Q = "3*a/4", E = "a" } }
6 = { points = { D = "0 mm", E = "b" } }""",
    '[assembly]\nA = "right of O -> P"\nE = "right of B -> D"',
    ASK.replace('"theta4", "B"]', '"Q"]')
    .replace('"omega4", "V_B"', '"V_Q"')
    .replace('"alpha4", "a_B"', '"a_Q"')
    .replace('moment = "9 N*m"', 'moment = "2 N*m"'),
)
#: A desk lamp of two parallelograms: the plate between them never turns, and a stay lowers the second as the
#: first is raised.
LAMP = file_of(
    'b = "40 mm"\nr2 = { from = "320 mm", to = "380 mm", step = "5 mm" }\nr5 = { from = "280 mm", to = '
    '"340 mm", step = "5 mm" }\n'
    'k = "90 mm"\ntheta2 = { from = "60 deg", to = "110 deg", step = "1 deg" }\nomega2 = "0.5 rad/s"\n'
    'alpha2 = "1 rad/s^2"',
    'O = ["0 mm", "0 mm"]\nC = ["b", "0 mm"]',
    """2 = { at = "O", angle = "theta2", points = { A = "r2", U = "r2 - k" } }
4 = { at = "C", points = { B = "r2" } }
3 = { points = { A = "0 mm", B = "b", E = ["0 mm", "b"] } }
5 = { points = { B = "0 mm", F = "r5", V = "k" } }
8 = { points = { U = "0 mm", V = "150 mm" } }
6 = { points = { E = "0 mm", G = "r5" } }
7 = { points = { F = "0 mm", G = "sqrt(2) * b", H = ["0 mm", "-60 mm"] } }""",
    '[assembly]\nB = "left of A -> C"\nV = "right of U -> B"\nG = "left of F -> E"',
    """[ask]
mobility = true
positions = ["theta5", "H"]
velocities = ["omega5", "V_H"]
accelerations = ["a_H"]
torque = { load = { on = "H", force = "12 N", angle = "-90 deg" } }
""",
)
LINKAGES = {
    "stephenson": STEPHENSON,
    "trammel": TRAMMEL,
    "oldham": OLDHAM,
    "watt": WATT,
    "hart": HART,
    "lamp": LAMP,
    "slider": SLIDER,
    "inverted": INVERTED,
    "four_bar": bar(152.4, 50.8, 177.8, 228.6),
    "parallelogram": bar(200, 60, 200, 60, "left"),
    "kite": bar(200, 80, 80, 200, "left"),
}


@pytest.fixture(scope="module")
def course(tmp_path_factory):
    folder = tmp_path_factory.mktemp("textbook")
    (folder / "exercises").mkdir()
    for name, text in LINKAGES.items():
        (folder / "exercises" / f"{name}.toml").write_text(text, "utf-8")
    return open_course(folder)


@pytest.mark.slow
@each_row("name", ["stephenson", "trammel", "inverted"])
def test_the_file_makes_an_exercise_with_all_promises(name, course):
    assert check(course[name], 2, rendered=1).failures == []


@pytest.mark.slow
@each_row("name", list(LINKAGES))
def test_motion_and_efforts_are_those_of_the_joints_alone(name, course):
    exercise, made = course[name], compiled(course.folder.root / "exercises" / f"{name}.toml")
    linkage, names = made.linkage, exercise.solution.graph.names
    key = "torque" if linkage.drive.kind == "turn" else "thrust"
    step = 0.2  # degrees or mm
    first, second = (
        np.array([-1, 9, -45, 0, 45, -9, 1]) / 60,
        np.array([2, -27, 270, -490, 270, -27, 2]) / 180,
    )
    apart = {}
    for seed in (1, 2):
        given = dict(exercise.variant(seed).given)
        speed, gain = (given[n] for n in linkage.drive.rates)
        rate, growth = (np.degrees(v) if key == "torque" else v for v in (speed, gain))
        machine = Machine(linkage, given)
        start = machine.settled(pose(machine, made, exercise, given))
        poses = []
        for k in range(-3, 4):
            moved = Machine(linkage, {**given, linkage.moved: given[linkage.moved] + k * step})
            poses.append(moved.settled(start, off=0.1))
        for point in (p for p in linkage.points if p not in linkage.ground):
            body = next(b for b, p in machine.local if p == point)
            way = np.array([machine.place(q, body, point) for q in poses])
            slope, bend = (way @ w / step**n for n, w in ((1, first), (2, second)))
            right = {"": way[3], "v": slope * rate, "a": bend * rate**2 + slope * growth}
            for mark, value in right.items():
                axes = {
                    f"{mark}_{point}_{x}" if mark else f"{x}{point}": v
                    for x, v in (("x", value.real), ("y", value.imag))
                }
                found = exercise.solve(only=[n for n in axes if n in names], **given)
                for n, v in found.items():
                    if abs(v - axes[n]) > 1e-6 * max(
                        1.0, abs(value), abs(slope * rate**2) if mark == "a" else 0
                    ):
                        apart[seed, n] = (v, axes[n])
        forces = [(f.on, f.force, f.angle) for f in linkage.loads if f.force is not None]
        forces = [(on, machine.number(size), machine.number(angle)) for on, size, angle in forces]
        moments = [(m.on, machine.number(m.moment)) for m in linkage.loads if m.moment is not None]
        _, _, effort, told = efforts(exercise, made, given, forces, moments, key)
        if abs(told - effort) > 1e-6 * max(1.0, abs(effort)):
            apart[seed, key] = (told, effort)
    assert apart == {}


@pytest.mark.slow
def test_results_that_books_print_and_theorems_say(course):
    norton = course["four_bar"]
    still = dict(norton.variant(0).given) | {"theta2": 30.0}
    assert [norton.solve(only=n, **still)[n] for n in ("theta3", "theta4")] == pytest.approx(
        [88.8, 117.3], abs=0.06
    )
    slider = course["slider"].solve(
        only=("theta3", "x"), **(dict(course["slider"].variant(0).given) | {"theta2": 45.0})
    )
    assert slider["x"] == pytest.approx(4.99 * 25.4, abs=0.2)
    inverted = course["inverted"].solve(
        only=("theta4", "b"), **(dict(course["inverted"].variant(0).given) | {"theta2": 30.0})
    )
    assert (inverted["theta4"], abs(inverted["b"])) == (
        pytest.approx(142.7, abs=0.06),
        pytest.approx(1.79 * 25.4, abs=0.2),
    )
    oldham, turn = course["oldham"], np.arange(-175.0, 180.0, 5.0)
    found = oldham.solve(only=("D", "V_D"), **(dict(oldham.variant(0).given) | {"theta2": turn}))
    arm = found["D"] - [15.0, 0.0]
    assert found["V_D"] == pytest.approx(3.0 * np.stack([-arm[:, 1], arm[:, 0]], -1), rel=1e-12)
    trammel = course["trammel"]
    given = dict(trammel.variant(0).given) | {"x": np.linspace(10.0, 190.0, 37)}
    P = trammel.solve(only="P", **given)["P"]
    assert (P[:, 0] / 130) ** 2 + (P[:, 1] / 70) ** 2 == pytest.approx(np.ones(37), rel=1e-12)
    watt = course["watt"]
    M = watt.solve(only="M", **(dict(watt.variant(0).given) | {"theta2": np.linspace(-10.0, 10.0, 41)}))["M"]
    assert np.ptp(M[:, 0]) < 1e-3 * np.ptp(M[:, 1])
    given = {"a": 168.0, "b": 80.0, "c": 26.0}
    Q = course["hart"].solve(only="Q", **given, theta2=np.linspace(-25.0, 25.0, 11))["Q"]
    # The inverse of a circle through its centre.
    line = 3 / 16 * (given["a"] ** 2 - given["b"] ** 2) / (2 * given["c"])
    assert Q[:, 0] == pytest.approx(np.full(11, line), rel=1e-12)
    assert np.ptp(Q[:, 1]) > 30


def test_what_remains_of_terms_that_cancel_is_asked_where_enough_digits_are_kept(tmp_path):
    """The acceleration of the point that Hart's inversor leads on a line, which a known curve gives: with
    four digits rounding takes too much of it, and it is said."""
    text = HART.replace('alpha2 = "5 rad/s^2"', "")
    text = re.sub(r"(?m)^theta2 = .*", 'theta2 = { from = "-6 deg", to = "6 deg", step = "1 deg" }', text)
    exercises = {}
    for digits in (4, 6):
        folder = tmp_path / f"{digits}" / "exercises"
        folder.mkdir(parents=True)
        (folder / "hart.toml").write_text(text, "utf-8")
        (folder / "course.toml").write_text(f"[marking]\ndigits = {digits}\n", "utf-8")
        exercises[digits] = open_course(folder.parent)["hart"]
    with pytest.raises(Starved) as few:
        distinct_variants(exercises[4], 0, 12, "en")
    for lang, why in (
        ("en", "rounding on the way may cost a_Q more than 3 %"),
        ("fr", "les arrondis de calcul peuvent coûter plus de 3 % à a_Q"),
    ):
        assert why in localised(few.value, lang)
        assert "digits = 6" in localised(few.value, lang)
    for variant in distinct_variants(exercises[6], 0, 12, "en"):
        given, half = variant.given, np.radians(variant.given["theta2"]) / 2
        line = 3 / 16 * (given["a"] ** 2 - given["b"] ** 2) / (2 * given["c"])  # y = line * tan(half)
        bend = line * given["omega2"] ** 2 / 2 * np.tan(half) / np.cos(half) ** 2
        assert variant.solution()["a_Q"] == pytest.approx([0.0, bend], abs=1e-9 * line * given["omega2"] ** 2)


@pytest.mark.slow
def test_change_points_and_dead_centres_have_a_position_and_no_false_rate(course):
    """In one line the bars have a position; whether a rate exists depends on the way there: a number stands
    only where it does."""
    for name, lengths in (
        ("parallelogram", (200, 60, 200, 60)),
        ("kite", (200, 80, 80, 200)),
        ("four_bar", None),
    ):
        exercise = course[name]
        given = dict(exercise.variant(0).given)
        if lengths is None:  # the crank is stretched with its coupler: the rocker stands still
            r1, r2, r3, r4 = (given[n] for n in ("r1", "r2", "r3", "r4"))
            far = r3 + r2
            given["theta2"] = np.degrees(np.arccos((r1**2 + far**2 - r4**2) / (2 * r1 * far)))
            found = exercise.solve(only=("theta3", "omega4", "omega3"), **given)
            assert found["theta3"] == pytest.approx(given["theta2"], abs=1e-5)
            assert abs(found["omega4"]) < 1e-5
            assert found["omega3"] == pytest.approx(-given["omega2"] * r2 / r3, rel=1e-6)
            continue
        turn = np.array([0.0, 180.0])
        found = exercise.solve(only=("xB", "yB", "omega4"), **(given | {"theta2": turn}))
        gaps = abs(np.hypot(found["xB"] - given["r1"], found["yB"]) - given["r4"])
        assert np.all(gaps < 1e-5), (name, found)
        assert not np.any(np.isinf(found["omega4"])), (name, found)
