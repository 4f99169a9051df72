"""Drawn velocity polygons: against the exercises that compute the same motion."""

import cmath
import math
import random

import pytest
from paper_student import Student, rounded
from tables import each_row

import coursework

COURSE = coursework.open_course()
FOUR_BAR, SLIDER = COURSE["velocity_polygon"], COURSE["velocity_polygon_slider"]


@each_row("seed", range(12))
def test_four_bar_is_that_of_the_computed_motion(seed):
    variant = FOUR_BAR.variant(seed)
    found = variant.solution()
    motion = COURSE["four_bar_motion"].solve(**variant.given, alpha2=0.0)
    for name in ("omega3", "omega4", "v_B"):
        assert found[name] == pytest.approx(motion[name], rel=1e-10)
    assert found["ab"] * found["kv"] == pytest.approx(motion["v_BA"], rel=1e-10)


@each_row("seed", range(12))
def test_slider_crank_is_that_of_the_computed_motion(seed):
    variant = SLIDER.variant(seed)
    found = variant.solution()
    motion = COURSE["slider_crank"].solve(**variant.given, only=("omega3", "r1_dot"))
    for name, value in motion.items():
        assert found[name] == pytest.approx(value, rel=1e-10)


@each_row("exercise", [FOUR_BAR, SLIDER])
def test_the_reference_drawing_fits_the_box_and_can_be_measured(exercise):
    for variant in exercise.variants(range(200)):
        found = variant.solution()
        xs, ys = zip(*(found[n] for n in "pab"), strict=True)
        assert max(xs) - min(xs) <= 130 + 1e-9
        assert max(ys) - min(ys) <= 80 + 1e-9
        assert min(found["ab"], found["pv_b"]) > 10


@each_row(
    ("wrong", "verdict"),
    [
        (lambda v: v["v_B"] / v["kv"], "mistake:scale_forgotten"),
        (lambda v: v["v_B"] * 1.3, "wrong"),
        (lambda v: v["v_B"] * 1.01, "correct"),
    ],
)
def test_a_speed_is_read_off_to_what_the_drawing_shows(wrong, verdict):
    variant = FOUR_BAR.variant(3)
    found = variant.solution()
    drawing = {n: f"{found[n][0]}; {found[n][1]}" for n in "pab"} | {"kv": found["kv"]}
    assert variant.grade({**drawing, "v_B": wrong(found)})["v_B"].verdict == verdict


def test_a_value_that_follows_from_ones_own_wrong_length_follows():
    variant = FOUR_BAR.variant(3)
    found = variant.solution()
    long = found["pv_b"] + 15
    points = {n: f"{x}; {y}" for n, (x, y) in ((n, found[n]) for n in "pab")}
    given = {"kv": found["kv"], "pv_b": long, "v_B": long * found["kv"], **points}
    marking = variant.grade(given)
    assert marking["pv_b"].verdict == "wrong"
    assert marking["v_B"].verdict == "follow_through"


def test_a_value_read_off_a_wrong_drawing_is_not_called_right():
    variant = FOUR_BAR.variant(3, "en")
    found = variant.solution()
    points = {n: f"{x + dx}; {y}" for n, dx in zip("pab", (0, 30, -40), strict=True) for x, y in (found[n],)}
    length = found["pv_b"] + 15
    given = {"kv": found["kv"], "pv_b": length, "v_B": length * found["kv"], **points}
    mark = variant.grade(given)["v_B"]
    assert mark.verdict == "slip:not_drawn"
    assert "is right" not in mark.feedback
    assert "is right" in variant.grade({**given, "v_B": found["v_B"]})["v_B"].feedback


def test_a_scale_at_which_no_paper_holds_the_drawing_is_not_called_possible():
    variant = FOUR_BAR.variant(3, "en")
    found = variant.solution()
    points = {n: f"{x}; {dy - y}" for n, dy in zip("pab", (0, 30, -40), strict=True) for x, y in (found[n],)}
    marks = [variant.grade({**points, "kv": scale})["kv"] for scale in (found["kv"], found["kv"] / 1000)]
    assert ["possible scale" in mark.feedback for mark in marks] == [True, False]


def test_a_right_length_on_a_wrong_drawing_is_right_and_one_of_the_drawing_follows():
    variant = FOUR_BAR.variant(5)
    found = variant.solution()
    p, a, b = (found[n] for n in "pab")
    away = b + 0.4 * (b - p)  # on the line of the velocity of B, too far
    drawing = {"p": p, "a": a, "b": away, "kv": found["kv"]}
    given = {n: f"{v[0]}; {v[1]}" if n != "kv" else v for n, v in drawing.items()}
    own = 1.4 * found["pv_b"]
    assert variant.grade({**given, "pv_b": found["pv_b"]})["pv_b"].verdict == "correct"
    marking = variant.grade({**given, "pv_b": own})
    assert marking["pv_b"].verdict == "follow_through"
    assert marking["b"].verdict == "mistake:ba_direction"


def test_most_slider_cranks_are_offset_to_either_side_and_some_are_not():
    for name in ("velocity_polygon_slider", "acceleration_polygon_slider"):
        offsets = [v.given["e"] for v in COURSE[name].variants(range(200))]
        assert 40 < sum(e == 0 for e in offsets) < 120
        assert min(offsets) < -20
        assert max(offsets) > 20


@pytest.mark.parametrize("name", ["velocity_polygon_slider", "acceleration_polygon_slider"])
def test_a_record_of_the_first_version_has_no_offset_and_is_solved(name):
    exercise = COURSE[name]
    variant = next(v for v in exercise.variants(range(20)) if v.given["e"] == 0)
    record = {**variant.record, "version": 1}
    record["given"] = {n: v for n, v in record["given"].items() if n != "e"}
    old = exercise.from_record(record)
    numbers = ("r1_dot", "omega3") if name.startswith("velocity") else ("r1_ddot", "alpha3")
    for quantity in numbers:
        assert old.solution()[quantity] == pytest.approx(variant.solution()[quantity], rel=1e-14)


def test_a_careful_student_has_the_drawing_of_an_offset_slider_crank():
    chance = random.Random(2)
    for variant in SLIDER.variants(range(40)):
        given = variant.given
        crank = cmath.rect(given["r2"], math.radians(given["theta2"]))
        theta3 = math.degrees(math.asin((given["e"] - crank.imag) / given["r3"]))
        rod = cmath.rect(given["r3"], math.radians(round(theta3, 1)))
        student = Student(chance, abs(given["omega2"] * crank))
        student.lay_off("a", "p", 1j * given["omega2"] * crank)
        student.cross("b", "a", 1j * rod, "p", 1 + 0j)
        answers = {
            **student.points(),
            "kv": rounded(student.scale),
            "ab": student.measured("a", "b"),
            "pv_b": student.measured("p", "b"),
            "r1_dot": rounded(student.vector("p", "b").real),
            "omega3": rounded((student.vector("a", "b") / (1j * rod)).real),
        }
        marking = variant.grade(answers)
        assert {n: marking[n].verdict for n in answers} == dict.fromkeys(answers, "correct"), variant.seed
