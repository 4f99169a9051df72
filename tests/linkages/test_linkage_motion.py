"""Mechanisms stated as files move as their joints say: against differences, virtual work, and the
hand-written solutions."""

import re

import numpy as np
import pytest
from linkage_samples import FOLDER, NAMES, course
from tables import each_row

from coursework import open_course
from coursework.authoring.linkage_files import mechanism_alone
from coursework.scenes.scenes import Scene


def _turns(exercise, given):
    """Angles, distances and coordinates that follow from the driver's angle."""
    names = exercise.solution.graph.names
    return sorted(
        n
        for n in names
        if (n.startswith("theta") or n in _distances(exercise) or (n[0] in "xy" and n[1:2].isupper()))
        and n not in given
    )


def _distances(exercise):
    return {
        n.removesuffix("_dot")
        for n in exercise.solution.graph.names
        if n.endswith("_dot") and not n.startswith("loop_")
    }


def _rate(name, order):
    if name.startswith("theta"):
        return name.replace("theta", ("omega", "alpha")[order - 1], 1)
    if name[0] in "xy" and name[1:2].isupper():
        return f"{'va'[order - 1]}_{name[1:]}_{name[0]}"
    return name + ("_dot", "_ddot")[order - 1]


@each_row("name", NAMES)
@pytest.mark.e2e
def test_rates_and_accelerations_are_the_differences_of_positions(name):
    """Of seven points of a polynomial through positions a third of a degree apart, with the driver at a
    constant rate."""
    exercise = course()[name]
    given = dict(exercise.variant(3).given)
    driver = exercise.spec.driver
    drive = driver.jack or driver
    speed = given[drive.speed]
    given |= {n: 0.0 for n in (drive.acceleration,) if n in given}
    step = 1 / 3
    moved = {**given, driver.moved: given[driver.moved] + step * np.arange(-3, 4)}
    positions = _turns(exercise, given)
    names = exercise.solution.graph.names
    found = exercise.solve(only=positions, **moved)
    wanted = [_rate(n, order) for n in positions for order in (1, 2)]
    rates = exercise.solve(only=[n for n in wanted if n in names], **given)
    first = np.array([-1, 9, -45, 0, 45, -9, 1]) / 60
    second = np.array([2, -27, 270, -490, 270, -27, 2]) / 180
    unit = (speed if driver.jack else np.degrees(speed)) / step  # one step, in steps a second
    checked = 0
    for item in positions:
        along = np.asarray(found[item], dtype=float) * np.ones(7)
        if item.startswith("theta"):
            along = np.unwrap(along, period=360)
        scale = 180 / np.pi if item.startswith("theta") else 1.0
        size = max(np.ptp(along) / scale * unit, 1.0)
        for order, weights in ((1, first), (2, second)):
            rate = _rate(item, order)
            if rate in rates:
                expected = along @ weights * unit**order / scale
                tolerance = 1e-7 * max(abs(expected), size * unit ** (order - 1))
                assert rates[rate] == pytest.approx(expected, abs=tolerance), rate
                checked += 1
    assert checked >= 2


@each_row("name", [n for n in NAMES if n in ("toggle", "slider_crank", "atkinson_engine")])
def test_torques_do_the_work_of_the_load(name):
    """A small turn of the driver: its torque times the angle, and the load times the way of its point or
    body, add up to nothing."""
    exercise = course()[name]
    given = dict(exercise.variant(5).given)
    step = 0.02
    ends = {**given, "theta2": given["theta2"] + step * np.array([-1, 1])}
    torque = exercise.solve(only="torque", **given)["torque"]
    turn = np.radians(2 * step)
    if name == "toggle":
        work = given["M4"] * np.radians(np.ptp(np.sort(exercise.solve(only="theta4", **ends)["theta4"])))
        work *= np.sign(np.diff(exercise.solve(only="theta4", **ends)["theta4"]))[0]
    else:
        point = {"slider_crank": "xB", "atkinson_engine": "xE"}[name]
        work = given["F"] * np.diff(exercise.solve(only=point, **ends)[point])[0] / 1000
    assert torque * turn == pytest.approx(-work, rel=1e-5)


@each_row("name", ["tipper", "piston_engine", "digger_arm"])
def test_driven_lengths_push_what_the_scene_says_and_does_the_work_of_the_load(name):
    """The thrust by the powers is that by the forces of the joints, which know nothing of it; a small way of
    the driver does work."""
    exercise = course()[name]
    given, driver = dict(exercise.variant(1).given), exercise.spec.driver
    thrust = exercise.solve(only="thrust", **given)["thrust"]
    length, step = given[driver.moved], 0.01
    table = Scene(
        exercise,
        {**given, driver.jack.limits[0]: length - step, driver.jack.limits[1]: length + step},
        ("load",),
    ).over_cycle(2)
    assert table.columns["drive_thrust"][1] == pytest.approx(thrust, rel=1e-9)
    ends = {**given, driver.moved: length + np.array([-step, step])}
    if name == "tipper":
        work = given["F"] * -np.diff(exercise.solve(only="yG", **ends)["yG"])[0]
    else:
        body, moment = ("theta2", "M") if name == "piston_engine" else ("theta6", "M")
        work = 1000 * given[moment] * np.radians(np.diff(exercise.solve(only=body, **ends)[body]))[0]
    assert thrust * 2 * step == pytest.approx(-work, rel=1e-6)


def test_the_tipper_stated_as_a_file_agrees_with_the_one_written_by_hand():
    theirs, mine = open_course()["jack_mechanism"], course()["tipper"]
    shared = ("a", "xC", "yC", "L", "L_dot", "L_ddot")
    for variant in theirs.variants(range(60)):
        given = {n: variant.given[n.replace("C", "B")] for n in shared}
        rest = {n: mine.variant(0).given[n] for n in ("x_G_4", "y_G_4", "F", "L_min", "L_max")}
        names = ["theta4", "theta2", "omega4", "omega2", "alpha4", "alpha2"]
        found, right = mine.solve(only=names, **given, **rest), theirs.solve(only=names, **variant.given)
        for name in names:
            assert found[name] == pytest.approx(right[name], rel=1e-11, abs=1e-12), name


def _both(name, other, arguments, answers, renamed=None, count=300):
    """Return the answers of a file and of the hand-written solution for the variants of the latter."""
    theirs = open_course()[other]
    variants = theirs.variants(range(count))
    given = {n: np.array([v.given[n] for v in variants]) for n in arguments}
    sides = {n: np.array([v.given[n] for v in variants]) for n in (renamed or {})}
    own = {n: v for n, v in given.items() if n in course()[name].quantity_names}
    own |= {(renamed or {})[n]: np.where(v == "open", "left", "right") for n, v in sides.items()}
    mine = course()[name].solve(only=list(answers), **own)
    right = theirs.solve(only=list(answers.values()), **given, **sides)
    return [(mine[a], right[b], a) for a, b in answers.items()]


@each_row(
    "name, other, arguments, answers, renamed",
    [
        (
            "four_bar",
            "four_bar_motion",
            ("r1", "r2", "r3", "r4", "theta2", "omega2", "alpha2"),
            {n: n for n in ("theta3", "theta4", "omega3", "omega4", "alpha3", "alpha4")},
            {"mode": "mode_B"},
        ),
        (
            "slider_crank",
            "slider_crank",
            ("r2", "r3", "e", "theta2", "omega2", "alpha2"),
            {
                "theta3": "theta3",
                "x": "r1",
                "omega3": "omega3",
                "x_dot": "r1_dot",
                "alpha3": "alpha3",
                "x_ddot": "r1_ddot",
            },
            {},
        ),
        (
            "slotted_lever",
            "slotted_mechanism",
            ("r1", "r2", "theta2", "omega2", "alpha2"),
            {
                "theta4": "theta4",
                "r4": "rA",
                "omega4": "omega4",
                "r4_dot": "rA_dot",
                "alpha4": "alpha4",
                "r4_ddot": "rA_ddot",
            },
            {},
        ),
        (
            "two_loops",
            "two_loop_linkage",
            ("xC", "yC", "xF", "yF", "r2", "r3", "r4", "r5", "beta", "r6", "r7", "theta2", "omega2"),
            {f"{s}{k}": f"{s}{k}" for s in ("theta", "omega", "alpha") for k in (3, 4, 6, 7)},
            {"mode_1": "mode_B", "mode_2": "mode_E"},
        ),
    ],
)
def test_files_agree_with_the_solutions_written_by_hand(name, other, arguments, answers, renamed):
    for mine, right, answer in _both(name, other, arguments, answers, renamed):
        apart = np.asarray(mine) - right
        if answer.startswith("theta"):
            apart = (apart + 180) % 360 - 180
        size = np.max(np.abs(right))
        assert np.max(np.abs(apart)) <= 1e-12 * size, answer


def test_a_group_of_class_three_is_followed_over_the_whole_turn():
    """Closed everywhere, and continuous: no jump to another assembly between neighbouring positions."""
    exercise = course()["class_three"]
    given = dict(exercise.variant(0).given)
    turn = np.arange(-180.0, 181.0, 1.0)
    names = ("theta3", "theta4", "theta5", "theta6")
    found = exercise.solve(only=names, **{**given, "theta2": turn})
    for name in names:
        steps = (np.diff(found[name]) + 180) % 360 - 180
        assert np.all(np.isfinite(found[name]))
        assert np.max(np.abs(steps)) < 5, name
    gaps = exercise.solution.residual_graph.evaluate(("residual",), {**given, "theta2": turn})["residual"]
    assert np.max(gaps) < 1e-12


def test_bars_on_a_body_that_slides_alone_hold_agree_with_its_rates(tmp_path):
    """The body of two slides has an origin of its own; what is pinned to it moves as it does."""
    folder = tmp_path / "course"
    (folder / "exercises").mkdir(parents=True)
    text = (FOLDER / "exercises" / "crossed_slides.toml").read_text("utf-8")
    text = text.replace(
        "[slides]",
        '5 = { points = { K = "0 mm", E = "200 mm" } }\n6 = { at = "C", points = { E = "150 mm" } }\n'
        "[slides]",
    )
    text = text.replace("[bodies]", 'C = ["330 mm", "40 mm"]\n[bodies]').replace(
        "[ask]", '[assembly]\nE = "left of K -> C"\n[ask]\nequations = true'
    )
    text = text.replace('"a_B"', '"a_B", "alpha6"').replace('to = "80 deg"', 'to = "60 deg"')
    (folder / "exercises" / "crossed_bars.toml").write_text(text, "utf-8")
    exercise = open_course(folder)["crossed_bars"]
    gaps = exercise.solution.residual_graph.evaluate(("residual",), dict(exercise.variant(1).given))
    assert np.max(gaps["residual"]) < 1e-12


GUIDE_AT_30_DEGREES = """title = { en = "Guide at a fixed angle", fr = "Guide d'angle fixe" }
[given]
r2 = { from = "60 mm", to = "90 mm", step = "5 mm" }
r6 = "200 mm"
theta2 = { from = "10 deg", to = "80 deg", step = "5 deg" }
omega2 = "3 rad/s"
[ground]
O = ["0 mm", "0 mm"]
[bodies]
2 = { at = "O", angle = "theta2", points = { A = "r2", G = ["20 mm", "15 mm"] } }
3 = { points = { A = "0 mm" } }
4 = { angle = "30 deg", points = { B = "0 mm" } }
6 = { points = { G = "0 mm", H = "r6" } }
7 = { points = { H = "0 mm" } }
[slides]
A = { of = "3", on = "4", through = "B", along = "90 deg", distance = "y" }
B = { of = "4", on = "ground", through = "O", along = "0 deg", distance = "x" }
H = { of = "7", on = "4", through = ["11 mm", "7 mm"], along = "40 deg", distance = "z" }
[assembly]
H = "ahead of G"
[ask]
positions = ["z", "theta6"]
equations = true
"""


def test_loops_through_a_guide_of_fixed_angle_are_met_by_the_positions(tmp_path):
    """The equations that are right answers, with the values of the same solution."""
    (tmp_path / "exercises").mkdir()
    (tmp_path / "exercises" / "guided.toml").write_text(GUIDE_AT_30_DEGREES, "utf-8")
    exercise = open_course(tmp_path)["guided"]
    variant = exercise.variant(0)
    for name in ("loop_1_x", "loop_1_y"):
        equation = variant.solution()[name].replace("°", "")
        names = {*re.findall(r"[a-z]\w*", equation, re.IGNORECASE)} - {"sin", "cos"}
        values = {**exercise.solve(**variant.given, only=tuple(names - {*variant.given})), **variant.given}
        sides = [
            eval(  # an answer of our own, in degrees
                side,
                {"sin": lambda d: np.sin(np.radians(d)), "cos": lambda d: np.cos(np.radians(d)), **values},
            )
            for side in equation.split("=")
        ]
        assert abs(sides[0] - sides[1]) < 1e-9 * abs(sides[0])


def test_a_slide_of_which_a_rate_is_asked_goes_to_and_fro_visibly(tmp_path):
    """Measured over a whole turn, and for dead centres too: at one the slide stands, and moves all the
    same."""
    text = (FOLDER / "exercises" / "slider_crank.toml").read_text("utf-8")
    text = re.sub(r"(?m)^r2 = .*", 'r2 = { from = "0.5 mm", to = "6 mm", step = "0.5 mm" }', text)
    text = re.sub(r"(?m)^theta2 = .*", 'theta2 = { from = "0 deg", to = "355 deg", step = "5 deg" }', text)
    path = tmp_path / "slider_crank.toml"
    path.write_text(text.partition("[ask]")[0] + '[ask]\nvelocities = ["x_dot"]\n', "utf-8")
    turn = {"theta2": np.linspace(-180.0, 180.0, 73)}
    shares, stands = [], False
    with mechanism_alone(path, open_course) as (exercise, _):
        for seed in range(60):
            given = exercise.variant(seed).given
            x = exercise.solve(**given | turn, only=("x",))["x"]
            shares.append(np.ptp(x) / max(given["r2"], given["r3"]))
            stands |= given["theta2"] in (0, 180)
    assert (min(shares) > 0.018, max(shares) < 0.1, stands) == (True, True, True)


def test_a_group_that_does_not_close_is_nan_there_and_says_so_alone():
    from coursework.errors import CannotAssemble

    exercise = course()["four_bar"]
    given = {
        "r1": 200,
        "r2": 150,
        "r3": 60,
        "r4": 60,
        "theta2": 150,
        "omega2": 1,
        "alpha2": 0,
        "mode_B": "left",
    }
    with pytest.raises(CannotAssemble):
        exercise.solve(only="theta3", **given)
    found = exercise.solve(only="theta3", **{**given, "theta2": np.array([10.0, 150.0])})["theta3"]
    assert np.isfinite(found[0])
    assert np.isnan(found[1])


def test_digits_are_kept_beside_dead_centres_and_change_points():
    """As by the solution written by hand, whose closed forms are compared with sixty digits elsewhere."""
    theirs, mine = open_course()["four_bar_motion"], course()["four_bar"]
    offsets = np.array([1e-10, 1e-7, 1e-4, 1e-2])
    for lengths, centre in (
        (
            {"r1": 200.0, "r2": 60.0, "r3": 100.0, "r4": 160.0},
            0.0,
        ),  # all bars in one line at 0: a change point
        ({"r1": 200.0, "r2": 150.0, "r3": 60.0, "r4": 70.0}, 41.0),  # the crank cannot turn round
    ):
        given = {**lengths, "theta2": centre + offsets, "omega2": 3.0, "alpha2": 1.0}
        names = ["theta3", "theta4", "omega3", "omega4", "alpha3", "alpha4"]
        right = theirs.solve(only=names, **given, mode="open")
        found = mine.solve(only=names, **given, mode_B="left")
        for name in names:
            np.testing.assert_allclose(found[name], right[name], rtol=1e-12, err_msg=name)
