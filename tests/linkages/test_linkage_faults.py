"""A mechanism's file that makes no sense ends in one line: file, line, what was found, what would do."""

import re
import shutil

import numpy as np
import pytest
from linkage_samples import FOLDER, course
from tables import each_row

from coursework import open_course
from coursework.authoring.linkage_editing import questions
from coursework.authoring.linkage_files import mechanism_alone
from coursework.errors import BadCourse, BadInput, CannotAssemble, Starved
from coursework.linkages.compiled import compiled
from coursework.linkages.meeting import meeting
from coursework.messages import localised

TOGGLE = (FOLDER / "exercises" / "toggle.toml").read_text("utf-8")

#: What is changed in a right file: the text, what replaces it, the line that is named, a piece of the
#: message.
FAULTS = [
    (
        "[given]",
        '[[known]]\ngiven = { r9 = "3 mm" }\ngives = { theta3 = "1 deg" }\n[given]',
        3,
        "no quantity 'r9'",
    ),
    ("[given]", '[[known]]\ngiven = { r2 = "50 mm" }\ngives = { theta3 = "1 rad" }\n[given]', 3, "1 deg"),
    ('title = { fr = "Genouillère", en = "Toggle" }', "title = 3", 1, "title = {"),
    ("[ground]", "[grund]", 12, "did you mean 'ground'"),
    ('r1 = "180 mm"', "r1 = 180", 4, '"180 mm"'),
    ('r4 = "150 mm"', 'r4 = "150"', 7, "needs a unit"),
    ('r4 = "150 mm"', 'r4 = "150 N"', 7, "r4 is a value in mm"),
    ('omega2 = "12 rad/s"', 'omega2 = "12 rad/parsec"', 9, "parsec"),
    ('from = "40 mm", to = "70 mm"', 'from = "70 mm", to = "40 mm"', 5, "smaller value"),
    ('to = "70 mm", step = "5 mm"', 'to = "70 mm", step = "0 mm"', 5, "above 0"),
    ('to = "70 mm", step', 'to = "70 mm", stp', 5, "did you mean 'step'"),
    ('omega2 = "12 rad/s"', 'w = "12 rad/s"', 27, "omega2 ="),
    ('"r2 < r4"', '"r2 < theta2"', 10, "r2 is in mm, theta2 in deg: they cannot be compared"),
    ('"r2 < r4"', '"r2 < r9"', 10, "no quantity 'r9'"),
    ('"is_crank(2)"', '"is_crank(4)"', 10, "is_crank(2)"),
    ("transmission_angle(B)", "transmission_angle(A)", 10, "inner joint: B"),
    ('C = ["r1", "0 mm"]', 'c = ["r1", "0 mm"]', 14, "capital letter"),
    (
        'at = "O", angle = "theta2"',
        'at = "O", angle = "theta2 + 10 deg"',
        17,
        "given quantity such as theta2",
    ),
    ('at = "O", angle = "theta2", ', 'at = "O", ', 16, "there is no driver"),
    ('4 = { at = "C", ', '4 = { at = "C", angle = "theta2", ', 19, "two bodies are driven, 2 and 4"),
    (
        '4 = { at = "C", points = { B = "r4" } }',
        '4 = { points = { D = "0 mm", E = "r4" } }',
        19,
        "in the air",
    ),
    (
        '4 = { at = "C", points = { B = "r4" } }',
        '4 = { points = { D = "0 mm", B = "r4" } }',
        19,
        "hangs on B alone",
    ),
    ('3 = { points = { A = "0 mm", B = "r3" } }', "", 19, "hangs on C alone"),
    (
        '4 = { at = "C", points = { B = "r4" } }',
        '4 = { at = "C", points = { B = "r4", E = "r3" } }\n5 = { at = "O", points = { B = "r1", E = '
        '"r2" } }',
        16,
        "degrees of freedom",
    ),
    (
        '3 = { points = { A = "0 mm", B = "r3" } }',
        '3 = { points = { A = "0 mm", B = "r3" }, mass = "3 kg" }',
        18,
        "no key 'mass'",
    ),
    (
        '3 = { points = { A = "0 mm", B = "r3" } }',
        '3 = { points = { A = "r2", B = "r3" } }',
        18,
        "where its frame begins",
    ),
    ('B = "left of A -> C"', "", 21, 'B = "left of A -> C"'),
    ('B = "left of A -> C"', 'B = "above A"', 22, '"left of A -> C"'),
    ('B = "left of A -> C"', 'B = "left of A -> O"', 22, "A -> C"),
    ('B = "left of A -> C"', 'B = "ahead of A"', 22, "left or right"),
    ('B = "left of A -> C"', 'B = "left of A -> C"\nK = "left of A -> C"', 23, "no point 'K'"),
    ('["theta3", "theta4", "B"]', '["theta3", "theta9", "B"]', 26, "no quantity 'theta9'"),
    ('["theta3", "theta4", "B"]', '["theta3", "theta3"]', 24, "asked twice"),
    ('["I13", "I24"]', '["I13", "I77"]', 30, "instant centre"),
    ("mobility = true", "mobilty = true", 25, "did you mean 'mobility'"),
    ('{ on = "4", moment', '{ on = "Q", moment', 32, "a moment acts on a body"),
    ("advantage = true", 'advantage = "2"', 31, "on the ground: 3, 4"),
    ('polygon = ["velocity"', 'polygon = ["jerk"', 29, "'jerk'"),
    ('r1 = "180 mm"', 'r1 = "180,5 mm"', 4, "a decimal point, not a comma: '180.5 mm'"),
    ('from = "40 mm"', 'from = "40,5 mm"', 5, "a decimal point"),
    ('C = ["r1", "0 mm"]', 'C = ["r1", "0,5 mm"]', 14, "a decimal point"),
    ('r1 = "180 mm"', "r1 = “180 mm”", 4, "straight quotation marks"),
    ('r1 = "180 mm"', 'r1 = "180 mm', 4, "one line"),
    ('r1 = "180 mm"', 'r1 = "180 mm"\nr1 = "90 mm"', 5, "a name stands here twice"),
    ('omega2 = "12 rad/s"', 'omega2 = "12 mm/s"', 9, "a value in rad/s"),
    ("advantage = true", "advantage = true\npoints = { theta7 = 3 }", 32, "no question 'theta7'"),
    ('r4 = "150 mm"', 'r4 = "-150 mm"', 7, "a length above 0; found '-150 mm'"),
    ('r4 = "150 mm"', 'r4 = ["150 mm", "160 mm"]', 7, '"180 mm", or { from'),
    ('r4 = "150 mm"', 'r4 = "150 mm"\nversion = 2', 8, "write it above [given]"),
    ('r4 = "150 mm"', "r4 = true", 7, '"180 mm", or { from'),
    ('r4 = "150 mm"', 'r4 = "1e999 mm"', 7, "too large"),
    ('r4 = "150 mm"', 'r4 = "150 mm + x"', 7, "no quantity 'x'"),
    ('to = "70 mm", step = "5 mm"', 'to = "70 mm", step = "500 mm"', 5, "choose a smaller step"),
    (
        'to = "70 mm", step = "5 mm"',
        'to = "70 deg", step = "5 mm"',
        5,
        "'70 deg' is in deg, where a value in mm stands",
    ),
    ('C = ["r1", "0 mm"]', 'C = ["r1", "0 mm", "0 mm"]', 14, 'a place is "r2", ["x", "y"]'),
    ('C = ["r1", "0 mm"]', 'C = ["r1 * r1", "0 mm"]', 14, "is in mm^2, where a value in mm stands"),
    (
        '4 = { at = "C", points = { B = "r4" } }',
        'ground = { at = "C", points = { B = "r4" } }',
        19,
        "found 'ground'",
    ),
    (
        '4 = { at = "C", points = { B = "r4" } }',
        '4 = { at = "C", points = { B = "r4", C = "r2" } }',
        19,
        "begins at C",
    ),
    (
        '4 = { at = "C", points = { B = "r4" } }',
        '4 = { at = "C", points = ["B", "r4"] }',
        19,
        'points = { A = "0 mm"',
    ),
    ('"r2 < r4"', '"r2 = r4"', 10, 'a condition compares, such as "r2 < r4"'),
    ('"r2 < r4"', '"r2 < 40 apples"', 10, "apples"),
    ("mobility = true", 'mobility = "yes"', 25, "mobility = true; found 'yes'"),
    ('["theta3", "theta4", "B"]', '"theta3"', 26, "a list of names"),
    ('moment = "20 N*m"', 'moment = "20 N*m", force = "3 N"', 32, 'or { on = "B", force'),
    ('moment = "20 N*m"', 'moment = "20 N"', 32, "where a value in N*m stands"),
    ('moment = "20 N*m"', 'moment = "20 N*m", angle = "3 deg"', 32, "no key 'angle' in load"),
    (
        '3 = { points = { A = "0 mm", B = "r3" } }',
        '3 = { points = { A = "0 mm", B = "0 mm" } }',
        18,
        "in one place",
    ),
    ('to = "70 mm", step', 'to = "0.4 * r3", step', 5, "r3 stands no earlier than r2"),
    ('omega2 = "12 rad/s"', 'omega2 = "0 rad/s"', 27, "a driver that moves; found omega2 = 0"),
    ('4 = { at = "C", ', '4 = { at = "D", ', 19, "begins at D, a point of no other body"),
    (
        '["theta3", "theta4", "B"]',
        '["theta2", "B"]',
        26,
        "theta2 is given; what follows can be asked: theta3",
    ),
    ('velocities = ["omega3"', 'velocities = ["V_C"', 27, "C is a fixed point; what follows"),
    ('B = "left of A -> C"', 'B = "left of A -> C"\nA = "left of O -> B"', 23, "two ways have B"),
    ('B = "left of A -> C"', 'B = "left of A -> C"\nnear = { angle = "20 deg" }', 23, "leave it out"),
]


#: Of mechanisms that a length drives: the file, then the same.
LENGTHS = [
    ("tipper", 'length = "L" }', 'length = "a9" }', 16, "length of a jack is a given quantity"),
    ("tipper", 'rod = "3"', 'rod = "4"', 16, "two bodies with names of their own"),
    ("tipper", 'from = "C"', 'from = "D"', 16, "no point 'D'"),
    ("tipper", 'from = "C"', 'from = "B"', 16, "B and B are both points of body 4"),
    (
        "tipper",
        'length = "L" }',
        'length = "L", limits = ["620 mm", "430 mm"] }',
        16,
        "to the greater; found 620 mm, 430 mm",
    ),
    ("tipper", 'on = "G"', 'on = "C"', 27, "a fixed point, where a force does no work"),
    (
        "tipper",
        '"600 mm", step = "5 mm"',
        '"600 mm", step = "5 mm", nonzero = 1',
        6,
        "nonzero = true; found 1",
    ),
    ("tipper", 'to = "B"', 'to = "O"', 16, "C and O are both points of body 1"),
    ("tipper", 'length = "L" }', 'length = "L", limits = ["440 mm"] }', 16, 'limits = ["300 mm", "500 mm"]'),
    ("tipper", 'length = "L" }', 'legnth = "L" }', 16, "a jack is 2 ="),
    (
        "tipper",
        "[assembly]",
        '5 = { from = "C", to = "G", rod = "6", length = "a" }\n[assembly]',
        17,
        "two bodies are driven, 2 and 5",
    ),
    ("tipper", "thrust = {", "torque = {", 27, "of a driven length ask thrust"),
    ("tipper", "L_dot = {", "L_speed = {", 23, 'L_dot = "12 mm/s"'),
    ("digger_arm", "thrust =", 'polygon = ["velocity"]\nthrust =', 23, "one group of class III"),
    ("piston_engine", "mobility = true", 'advantage = "4"', 21, "on the ground: 3, 2; found '4'"),
    (
        "piston_engine",
        'on = "ground", through = ["0 mm", "e"]',
        'on = "2", through = ["0 mm", "e"]',
        17,
        "distance along the slide, which follows",
    ),
    ("klann_leg", 'EF = "57.7 mm"', 'EF = "1 mm"', 17, "EG, EF, FG has no value"),
    ("slider_crank", 'equations = ["x", "y", "complex"]', "equations = [{}]", 21, "a list of x, y, complex"),
    ("digger_arm", 'near = { length = "346 mm"', 'near = { angle = "20 deg"', 16, "length ="),
    (
        "digger_arm",
        'B = ["100 mm", "490 mm"]',
        'Z = ["1 mm", "1 mm"], B = ["100 mm", "490 mm"]',
        16,
        "no point 'Z'",
    ),
    ("digger_arm", "near = {", "far = {", 16, "a way to assemble"),
    ("piston_engine", 'on = "ground", through', 'on = "3", through', 17, "a point of body 3 itself"),
    ("geared_five_bar", 'radii = ["R2", "R5"]', 'radii = ["R2"]', 20, "a gear is G ="),
    ("geared_five_bar", 'radii = ["R2", "R5"]', 'radii = ["R2", "0 mm"]', 20, "a radius is above 0"),
]


@each_row("name, text, other, line, piece", [("toggle", *row) for row in FAULTS] + LENGTHS)
def test_a_fault_is_told_in_one_line_with_its_place(name, text, other, line, piece, tmp_path_factory):
    stated = (FOLDER / "exercises" / f"{name}.toml").read_text("utf-8")
    assert stated.count(text) == 1
    path = tmp_path_factory.mktemp("faults") / "toggle.toml"
    path.write_text(stated.replace(text, other), "utf-8")
    with pytest.raises(BadCourse) as caught:
        compiled(path, "exercises/toggle.toml")
    told = str(caught.value)
    assert "\n" not in told
    assert told.startswith(f"exercises/toggle.toml, line {line}: "), told
    assert piece in told, told
    french = re.fullmatch(rf"exercises/toggle\.toml, ligne {line}\s: (.*)", localised(caught.value, "fr"))
    assert french
    assert french[1] != told.partition(": ")[2]


@each_row(
    ("name", "lengths", "refused"),
    [
        ("toggle", {"r4": "2 mm"}, "bodies 3, 4 meet at B"),
        ("two_loops", {"r6": "14 mm", "r7": "14 mm"}, "bodies 6, 7 meet at E"),
        ("class_three", {"r5": "12 mm"}, "bodies 3, 4, 5, 6 meet at E, F, G"),
    ],
)
def test_an_assembly_that_exists_for_no_draw_names_the_joints_that_stay_open(
    tmp_path, name, lengths, refused
):
    """Of the first group that does not close, and of none that hangs on it."""
    exercises = tmp_path / name / "exercises"
    exercises.mkdir(parents=True)
    text = re.sub(
        r"require = .*|polygon = .*", "", (FOLDER / "exercises" / f"{name}.toml").read_text("utf-8")
    )
    for length, value in lengths.items():
        text = re.sub(rf"^{length} = .*", f'{length} = "{value}"', text, flags=re.MULTILINE)
    (exercises / f"{name}.toml").write_text(text, "utf-8")
    with pytest.raises(Starved) as caught:
        open_course(exercises.parent)[name].variant(0)
    assert re.findall(r"bodies [^(]* meet at [A-Z, ]*[A-Z]", str(caught.value)) == [refused]


def test_a_file_states_the_least_that_its_own_machine_needs(tmp_path):
    """A jaw crusher hardly turns its jaw: the usual least is told with what states another one."""
    path = tmp_path / "toggle.toml"
    text = re.sub(r"(?m)^polygon = .*|^instant_centres = .*", "", TOGGLE)
    text = re.sub(r"(?m)^r2 = .*", 'r2 = "2 mm"', text)
    path.write_text(text, "utf-8")
    with mechanism_alone(path, open_course) as (exercise, _), pytest.raises(Starved) as caught:
        exercise.variant(0)
    for lang, said in (("en", "states another least"), ("fr", "fixe un autre seuil")):
        told = localised(caught.value, lang)
        assert re.search(rf'require = "abs\(omega3\) > 0.1 rad/s" {said}', told), told
    own = '"abs(omega3) > 0.01 rad/s", "abs(omega4) > 0.01 rad/s"'
    path.write_text(text.replace('"is_crank(2)"', f'"is_crank(2)", {own}'), "utf-8")
    with mechanism_alone(path, open_course) as (exercise, _):
        rates = [exercise.variant(seed).solution() for seed in range(8)]
    assert 0.01 < min(abs(s[n]) for s in rates for n in ("omega3", "omega4")) < 0.02 * 12


def test_a_condition_may_name_what_the_solution_has_no_use_for(tmp_path):
    """Such as the limits of a jack, in a file whose variants are tried for the other assembly as well."""
    path = tmp_path / "tipper.toml"
    text = (FOLDER / "exercises" / "tipper.toml").read_text("utf-8")
    path.write_text(text.replace("[given]", '[given]\nrequire = "L_max > 1.01 * L_min"', 1), "utf-8")
    with mechanism_alone(path, open_course) as (exercise, _):
        assert exercise.variant(0).given["L_max"] > 1.01 * exercise.variant(0).given["L_min"]


def _apart(first, last):
    return float(np.hypot(*np.subtract(first, last)))


def _on_circle(radius, degrees):
    return radius * np.cos(np.radians(degrees)), radius * np.sin(np.radians(degrees))


@each_row(
    "name, given, place, gap",
    [
        (
            "toggle",
            {"theta2": 100.0, "r2": 50.0, "r3": 130.0, "r4": 20.0},
            "3, 4 at B",
            _apart(_on_circle(50, 100), (180, 0)) - 150,
        ),
        (
            "slider_crank",
            {"theta2": 90.0, "r2": 60.0, "r3": 45.0, "e": 5.0, "omega2": 12.0},
            "3, 4 at B",
            60 - 5 - 45,
        ),
        ("shaper", {"theta2": 90.0, "r2": 60.0, "h": 800.0, "omega2": 2.0}, "5, 6 at E", 800 - 560 - 180),
        ("class_three", {"theta2": 60.0, "r2": 400.0, "omega2": 1.0}, "3, 4, 5, 6 at E, F, G", None),
    ],
)
def test_numbers_that_do_not_close_name_the_joint_and_what_is_missing(name, given, place, gap):
    """In both languages; of a larger group, which Newton's method leaves open, one of its joints."""
    with pytest.raises(CannotAssemble) as caught:
        course()[name].solve(**dict(course()[name].variant(1).given) | given)
    bodies, joints = place.split(" at ")
    for lang, said, missing in (
        ("en", f"bodies {bodies} do not meet at {joints}: ", r"\(gap ([\d.e+]+) mm\)"),
        ("fr", f"les pièces {bodies} ne se rejoignent pas en {joints}\u202f: ", r"\(écart ([\d.e+]+) mm\)"),
    ):
        told = localised(caught.value, lang)
        assert told.startswith(said)
        if gap is None:
            assert re.search(rf"([\d.]+) mm (?:is left at|en) [{joints}]", told)
        else:
            assert float(re.search(missing, told)[1]) == pytest.approx(gap, rel=5e-3)


def test_one_body_that_does_not_reach_its_joint_is_named_alone():
    with pytest.raises(CannotAssemble) as caught:
        meeting("5", "C", "P", "Q")(_raise)(CannotAssemble("nothing found"))
    assert localised(caught.value, "en").startswith("body 5 does not reach C: ")
    assert localised(caught.value, "fr").startswith("la pièce 5 n’atteint pas C")


def _raise(fault):
    raise fault


def test_a_changed_file_is_compiled_anew(tmp_path):
    folder = tmp_path / "course"
    shutil.copytree(FOLDER, folder)
    path = folder / "exercises" / "toggle.toml"
    before = compiled(path).linkage.given["r1"].value
    path.write_text(TOGGLE.replace('r1 = "180 mm"', 'r1 = "190 mm"'), "utf-8")
    assert (before, compiled(path).linkage.given["r1"].value) == (180.0, 190.0)


def test_words_of_ones_own_replace_the_generated_ones(tmp_path):
    folder = tmp_path / "course"
    shutil.copytree(FOLDER, folder)
    generated = compiled(folder / "exercises" / "toggle.toml").text("exercises", "en")
    own = folder / "exercises" / "toggle.en.md.j2"
    own.write_text(generated.replace("# Toggle", "# The press in hall 3", 1), "utf-8")
    exercise = open_course(folder)["toggle"]
    assert (exercise.title("en"), exercise.title("fr")) == ("The press in hall 3", "Genouillère")
    assert exercise.variant(1, "en").text.title == "The press in hall 3"


def test_a_file_that_is_not_utf8_is_told_in_a_line(tmp_path):
    path = tmp_path / "toggle.toml"
    path.write_bytes((FOLDER / "exercises" / "toggle.toml").read_text("utf-8").encode("latin-1"))
    with pytest.raises(BadInput, match="is not UTF-8"), mechanism_alone(path, open_course):
        pass


@each_row(
    "theta2, rod, refused",
    [
        ('{ from = "30 deg", to = "150 deg", step = "5 deg" }', "r1", "is zero in all positions"),
        (
            '{ from = "30 deg", to = "150 deg", step = "5 deg" }',
            "1.001 * r1",
            r"has at most [\d.]+ % of the longest vector, and is drawn from 12 % on",
        ),
        ('{ from = "0 deg", to = "355 deg", step = "5 deg" }', "r1", ""),
    ],
)
def test_a_polygon_with_nothing_to_draw_is_refused_when_the_file_is_read_and_not_offered(
    theta2, rod, refused, tmp_path_factory
):
    """A parallelogram's coupler never turns, and one that is nearly its own hardly does; where the crank goes
    round, that of the antiparallelogram does."""
    path = tmp_path_factory.mktemp("still") / "parallelogram.toml"
    text = re.sub(r"theta2 = \{.*", f"theta2 = {theta2}", TOGGLE).replace(
        ', "transmission_angle(B) > 25 deg"', ""
    )
    text = text.replace('B = "r3" }', f'B = "{rod}" }}').replace(
        'C", points = { B = "r4" }', 'C", points = { B = "r2" }'
    )
    path.write_text(text, "utf-8")
    if refused:
        with pytest.raises(BadCourse, match=rf"parallelogram.toml, line \d+: V⃗_B/A {refused}"):
            compiled(path)
        path.write_text(re.sub(r"(?m)^polygon = .*", "", text), "utf-8")
    made = compiled(path)
    assert {"velocity"} - {*made.undrawn} == {
        box.name for box in questions(made).get("polygon", ()) if box.name == "velocity"
    }
    assert bool(refused) == ("velocity" in made.undrawn)


@each_row("name", ["bus_wiper", "peaucellier", "planet_wheel"])
def test_no_box_offers_a_rate_that_is_zero_or_a_centre_at_infinity_in_all_positions(name):
    """Compared with the rates of some variants; a rate that is 0 by its formula can be asked."""
    made, exercise = compiled(FOLDER / "exercises" / f"{name}.toml"), course()[name]
    boxes = {key: {box.name for box in able} for key, able in questions(made).items()}
    bodies = [b for b in made.linkage.bodies if made.formulas.turns[b].startswith("theta")]
    rates = {b: f"omega{b}" for b in bodies}
    found = [exercise.solve(only=tuple(rates.values()), **exercise.variant(seed).given) for seed in range(6)]
    turned = {b: np.array([f[n] for f in found]) for b, n in rates.items()} | {"1": np.zeros(6)}
    alike = {(i, j) for i in turned for j in turned if i < j and np.allclose(turned[i], turned[j], atol=1e-9)}
    assert boxes["instant_centres"] & {f"I{i}{j}" for i, j in alike} == set()
    assert len(boxes["instant_centres"]) >= len(turned) * (len(turned) - 1) // 2 - len(alike)
    still = {f"omega{j}" for i, j in alike if i == "1"}
    assert {rates[b] for b in bodies if b != made.linkage.driver} - boxes["velocities"] == still
