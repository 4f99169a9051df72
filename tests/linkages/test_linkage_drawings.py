"""Polygons asked by a mechanism's file are judged vector by vector, from any pole and at any scale."""

import inspect
import shutil

import numpy as np
import pytest
from linkage_samples import course

from coursework.api import open_course
from coursework.authoring.checks import check_all
from coursework.authoring.linkage_files import LINKAGES, mechanism_alone
from coursework.figures.polygons import Side, polygon_of_velocities
from coursework.figures.polygons.hand_drawn import judge_drawing
from coursework.linkages.compiled import compiled
from coursework.linkages.vectors import PolygonWriter
from coursework.marking.drawn_polygons import scale_for
from coursework.marking.marking import mark

POLE = np.array([31.0, -12.0])


def _drawing(variant, scale=1.25):
    """Right answers to the drawn parts, from another pole and at another scale than the reference's."""
    key = variant.exercise.solve(**variant.given)
    answers = {}
    for letter in "va":
        own = {n: v for n, v in key.items() if n.startswith(f"{letter}_") or n == f"p{letter}"}
        answers |= {n: POLE + np.asarray(v) / scale for n, v in own.items()}
        answers[f"k{letter}"] = key[f"k{letter}"] * scale
    return answers


def _marks(variant, answers):
    texts = {n: f"{v[0]:.9f}; {v[1]:.9f}" if np.ndim(v) else f"{v:.9g}" for n, v in answers.items()}
    return mark(variant, texts)


@pytest.mark.parametrize(("name", "count"), [("four_bar", 11), ("slotted_lever", 11)])
def test_a_right_drawing_gets_full_marks_from_any_pole_and_scale(name, count):
    variant = course()[name].variant(2)
    marks = _marks(variant, _drawing(variant))
    drawn = [n for n in marks if n[:2] in ("v_", "a_", "pv", "pa", "kv", "ka")]
    assert len(drawn) == count
    assert {n: marks[n].points / marks[n].out_of for n in drawn} == dict.fromkeys(drawn, 1.0)


#: Mechanisms by what drives or guides in them: a jack, a slider, a yoke, two crossed guides, wheels, a guide
#: that moves.
DRAWN = ("tipper", "piston_engine", "scotch_yoke", "crossed_slides", "geared_five_bar", "whitworth_on_a_rod")
ON_A_ROD = """
5 = { at = "Q", points = { D = "120 mm" } }
6 = { points = { D = "0 mm" } }
[slides]
D = { of = "6", on = "3", through = "A", along = "20 deg", distance = "s" }
"""


def _stated(name):
    """Return a mechanism's file that asks for both polygons; the last one is a four-bar whose rod guides a
    slider."""
    if name != DRAWN[-1]:
        text = (LINKAGES / "exercises" / f"{name}.toml").read_text("utf-8")
    else:
        text = (LINKAGES / "exercises" / "toggle.toml").read_text("utf-8")
        text = text.replace("[ground]", '[ground]\nQ = ["90 mm", "220 mm"]').replace(
            "\n[assembly]", ON_A_ROD + "[assembly]"
        )
        text = "\n".join(line for line in text.splitlines() if not line.startswith("polygon"))
    return text.replace("[ask]", '[ask]\npolygon = ["velocity", "acceleration"]')


def test_polygons_close_on_the_motion_whatever_drives_or_guides(tmp_path):
    """Both ways to an image point end there, and the image of a joint is its velocity or acceleration."""
    (tmp_path / "exercises").mkdir()
    for name in DRAWN:
        (tmp_path / "exercises" / f"{name}.toml").write_text(_stated(name), "utf-8")
    course = open_course(tmp_path)
    wrong = []
    for name in DRAWN:
        variant = course[name].variant(3)
        for drawn in variant.polygons():
            polygon, points = drawn.polygon, drawn.polygon.points
            gaps = {side.name: points[side.end] - points[side.start] - side.value for side in polygon.sides}
            for image, place in points.items():
                names = tuple(f"{polygon.kind[0]}_{image.upper()}_{axis}" for axis in "xy")
                if set(names) <= set(variant.exercise.solution.graph.names):
                    gaps[image] = place - complex(
                        *variant.exercise.solve(**variant.given, only=names).values()
                    )
            wrong += [(name, n, gap) for n, gap in gaps.items() if abs(gap) > 1e-12 * polygon.size]
    assert not wrong


def test_a_guide_drawn_without_coriolis_costs_the_point_it_leads_to():
    variant = course()["slotted_lever"].variant(2)
    answers = _drawing(variant)
    answers["a_k_4"] = answers["a_a"]
    marks = _marks(variant, answers)
    assert [n for n, m in marks.items() if n in answers and m.points < m.out_of] == ["a_k_4"]


@pytest.mark.parametrize(("point", "mistake"), [("v_a", "pv_a_sense"), ("a_b1", "a_a_b1_sense")])
def test_a_vector_laid_off_backwards_is_named_and_costs_its_end_alone(point, mistake):
    variant = course()["four_bar"].variant(2)
    answers = _drawing(variant)
    start = POLE if point == "v_a" else answers["a_a"]
    answers[point] = 2 * start - answers[point]
    marks = _marks(variant, answers)
    assert marks[point].verdict == f"mistake:{mistake}"
    assert [n for n, m in marks.items() if n in answers and m.points < m.out_of] == [point]


def test_a_scale_that_is_not_drawn_is_named_beside_short_vectors():
    """A vector of three millimetres fits any scale, and does not speak for the stated one."""
    sides = (
        Side("p_v", "a", "V_A", 40 + 0j, r"\parallel x", "40"),
        Side("a", "b", "V_B", 30j, r"\parallel y", "30"),
        Side("b", "c", "V_C", 3 + 0j, r"\parallel x", "3"),
    )
    polygon = polygon_of_velocities(sides)
    judged = judge_drawing(polygon, polygon.points, 2.0)
    assert (judged.fits_stated_scale, judged.faults) == (False, {})


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["four_bar", "toggle", "two_loops", "slotted_lever", "scotch_yoke", "geared_five_bar"]
)
def test_the_mechanisms_to_start_from_pass_their_check(name):
    (report,) = check_all(course(), [name], 20, lambda *_: None)
    assert not report.failures


def test_equations_of_a_loop_are_right_in_any_form_and_a_missing_bar_is_named():
    variant = course()["slotted_ram"].variant(1)
    right = {
        "loop_1_x": "s*cos(theta4) = r2*cos(theta2) + e*sin(theta4)",
        "loop_2_y": "h - r6*sin(theta5) - r5*sin(theta4) = 0",
    }
    marks = mark(variant, right)
    assert {n: marks[n].points for n in right} == dict.fromkeys(right, 1.0)
    marks = mark(variant, {"loop_2_x": "r5*cos(theta4) + s_E = 0"})
    assert (marks["loop_2_x"].points, marks["loop_2_x"].verdict) == (0.0, "slip:link_missing")


#: A Whitworth quick return whose ram hangs on the slotted body behind its pivot, on a bar whose length is an
#: expression.
WHITWORTH = """title = { fr = "Whitworth", en = "Whitworth" }
[given]
r1 = "50 mm"
r2 = { from = "90 mm", to = "130 mm", step = "5 mm" }
r5 = "80 mm"
r6 = { from = "200 mm", to = "230 mm", step = "5 mm" }
theta2 = { from = "0 deg", to = "355 deg", step = "5 deg" }
omega2 = { from = "3 rad/s", to = "9 rad/s", step = "1 rad/s" }
[ground]
O = ["0 mm", "0 mm"]
C = ["0 mm", "-r1"]
F = ["260 mm", "r1"]
[bodies]
2 = { at = "O", angle = "theta2", points = { A = "r2" } }
3 = { points = { A = "0 mm" } }
4 = { at = "C", points = { D = "-r5" } }
5 = { points = { D = "0 mm", E = "r6 + r5" } }
6 = { at = "F", points = { E = "200 mm" } }
[slides]
A = { of = "3", on = "4", through = "C", distance = "s" }
[assembly]
E = "left of D -> F"
[ask]
equations = ["x", "x_dot"]
velocities = ["omega6"]
"""


def test_a_bar_behind_a_slot_is_drawn_and_a_length_that_is_an_expression_stands_still(tmp_path):
    path = tmp_path / "whitworth.toml"
    path.write_text(WHITWORTH, "utf-8")
    with mechanism_alone(path, open_course) as (exercise, _):
        variant = exercise.variant(1)
        found = exercise.solve(only=("xD", "yD"), **variant.given)
        ends = {complex(found["xD"], found["yD"]), -1j * variant.given["r1"]}
        bars = [[complex(p) for p in e.points] for e in variant.figure.elements if hasattr(e, "points")]
        assert any(all(min(abs(p - end) for p in bar) < 1e-9 for end in ends) for bar in bars)
        right = "d_CD*omega4*sin(theta4) = d_DE*omega5*sin(theta5) - FE*omega6*sin(theta6)"
        statement = variant.in_language("en").handout().statement
        assert r"\theta_4$ of the first axis of body 4" in statement  # which is not the direction of CD
        assert "CD = -" not in statement
        assert mark(variant, {"loop_2_x_dot": right})["loop_2_x_dot"].points == 1.0


def test_a_scale_fits_vectors_of_which_some_are_the_same_at_all_instants():
    moving = np.array([20 + 40j, 300 - 90j])
    alone = [scale_for(50j, z) for z in moving]
    assert scale_for(50j, moving) == pytest.approx(alone)


def test_no_two_vectors_of_a_polygon_have_one_name_and_relative_ones_name_both_points():
    wrong = {}
    for name in ("tipper", "inverted_slider_crank", "slotted_ram", "crossed_slides", "two_loops"):
        formulas = compiled(LINKAGES / "exercises" / f"{name}.toml").formulas
        for kind in ("velocity", "acceleration"):
            polygon = PolygonWriter(formulas, kind)
            names = [side.name for side in polygon.sides]
            if len(names) > len(set(names)):
                wrong[name, kind] = names
            # A chain of one body's vectors that begins at another image than the pole is of a motion relative
            # to that point.
            starts = {side.end: side for side in polygon.sides if "'" in side.end}
            bare = [
                side.name
                for side in polygon.sides
                if starts.get(side.start, side).start != polygon.pole and "/" not in side.name
            ]
            if bare:
                wrong[name, kind, "relative"] = bare
    assert wrong == {}


def _foreign_lines(course, name):
    """Names of the quantities whose lines are those of another function, or of none."""
    graph = course[name].solution.graph
    functions = {n: graph.node(n).function for n in graph.quantities if not n.startswith("loop_")}
    return [n for n, function in functions.items() if f"def {n}(" not in inspect.getsource(function)]


def test_files_of_one_name_in_two_courses_print_their_own_formulas(tmp_path):
    """Formulas are printed from the lines of functions, which a file of the same name elsewhere must not
    replace."""
    shutil.copytree(LINKAGES, tmp_path / "other")
    exercises = tmp_path / "other" / "exercises"
    shutil.copy(exercises / "slider_crank.toml", exercises / "four_bar.toml")
    first, other = open_course(LINKAGES), open_course(tmp_path / "other")
    assert [_foreign_lines(c, "four_bar") for c in (first, other, first)] == [[], [], []]
