"""Drawn polygons of a slotted mechanism: as a student draws them, against the computed motion, and the
Coriolis side."""

import cmath
import math
import random

import mpmath
import pytest
from paper_student import Student, rounded
from tables import each_row

import coursework

COURSE = coursework.open_course()
VELOCITY, ACCELERATION = COURSE["velocity_polygon_slotted"], COURSE["acceleration_polygon_slotted"]


def motion(given):
    return COURSE["slotted_mechanism"].solve(**given, theta1=90.0, alpha2=0.0)


def told(variant):
    """Positions as the statement tells them, vectors O2A and O4A."""
    crank = cmath.rect(variant.given["r2"], math.radians(variant.given["theta2"]))
    arm = 1j * variant.given["r1"] + crank
    theta4 = round(math.degrees(cmath.phase(arm)), 1)
    return crank, cmath.rect(float(f"{abs(arm):.4g}"), math.radians(theta4))


def drawn_velocities(variant, chance):
    crank, arm = told(variant)
    velocity = 1j * variant.given["omega2"] * crank
    student = Student(chance, abs(velocity))
    student.lay_off("a", "p", velocity)
    student.cross("b", "a", arm, "p", 1j * arm)
    slide = student.vector("b", "a") / (arm / abs(arm))
    return {
        **student.points(),
        "kv": rounded(student.scale),
        "ab": student.measured("b", "a"),
        "pv_b": student.measured("p", "b"),
        "rA_dot": rounded(slide.real),
        "omega4": rounded((student.vector("p", "b") / (1j * arm)).real),
    }


def drawn_accelerations(variant, chance, side=1, factor=2):
    """``side`` -1 lays the Coriolis acceleration off on the other side of a2."""
    crank, arm = told(variant)
    along, found = arm / abs(arm), motion(variant.given)
    omega4, sliding = float(found["omega4"]), float(found["rA_dot"])
    omega2 = variant.given["omega2"]
    student = Student(chance, max(abs(omega2**2 * crank), abs(2 * omega4 * sliding)))
    student.lay_off("a", "p", -(omega2**2) * crank)
    student.lay_off("k", "a", -side * factor * 1j * omega4 * sliding * along)
    student.lay_off("n", "p", -(omega4**2) * arm)
    student.cross("b", "k", along, "n", 1j * along)
    return {
        **student.points(),
        "ka": rounded(student.scale),
        "bk": student.measured("b", "k"),
        "nb_t": student.measured("n", "b"),
        "rA_ddot": rounded((student.vector("b", "k") / along).real),
        "alpha4": rounded((student.vector("n", "b") / (1j * arm)).real),
    }


@each_row(("exercise", "drawn"), [(VELOCITY, drawn_velocities), (ACCELERATION, drawn_accelerations)])
def test_a_careful_student_has_every_point_of_the_drawing(exercise, drawn):
    chance = random.Random(8)
    for variant in exercise.variants(range(40)):
        answers = drawn(variant, chance)
        marking = variant.grade(answers)
        assert {n: marking[n].verdict for n in answers} == dict.fromkeys(answers, "correct"), variant.seed


def test_coriolis_on_the_wrong_side_is_told_and_costs_nothing_after_it():
    chance = random.Random(9)
    for variant in ACCELERATION.variants(range(30)):
        answers = drawn_accelerations(variant, chance, side=-1)
        marking = variant.grade(answers)
        found = {n: marking[n].verdict for n in answers}
        assert found.pop("k") == "mistake:k_sense", variant.seed
        assert set(found.values()) <= {"correct", "follow_through"}
        assert found["b"] == "follow_through"
        assert found["a"] == found["n"] == "correct"


@each_row(("lang", "word"), [("fr", "Coriolis"), ("en", "Coriolis")])
def test_coriolis_without_its_two_and_left_out_are_told(lang, word):
    variant = ACCELERATION.variant(2, lang)
    marking = variant.grade(drawn_accelerations(variant, random.Random(1), factor=1))
    assert marking["k"].verdict == "mistake:k_length"
    assert word in marking["k"].feedback
    right = drawn_accelerations(variant, random.Random(1))
    found = variant.solution()
    wrong = ACCELERATION.solution.mistaken("s_on_a").evaluate(("b",), variant.given)["b"]
    points = {n: found[n] for n in "pakn"} | {"b": wrong}
    sheet = {n: f"{z[0]}; {z[1]}" for n, z in points.items()} | {"ka": found["ka"]}
    marking = variant.grade(sheet)
    assert "s_on_a" in marking["b"].mistakes
    assert marking["k"].verdict == "correct"
    assert right.keys() >= sheet.keys()


@each_row("seed", range(12))
def test_both_are_those_of_the_computed_motion(seed):
    for exercise, names in ((VELOCITY, ("rA_dot", "omega4")), (ACCELERATION, ("rA_ddot", "alpha4"))):
        variant = exercise.variant(seed)
        found, other = variant.solution(), motion(variant.given)
        for name in names:
            assert found[name] == pytest.approx(other[name], rel=1e-10)


@each_row("seed", range(8))
def test_accelerations_are_those_of_fifty_digits(seed):
    """The arm as a function of the crank angle, differentiated numerically."""
    variant = ACCELERATION.variant(seed)
    mp = mpmath.MPContext()
    mp.dps = 50
    r1, r2, theta2, omega2 = (mp.mpf(variant.given[n]) for n in ("r1", "r2", "theta2", "omega2"))
    start = mp.radians(theta2)

    def arm(t):
        return mp.mpc(0, r1) + r2 * mp.expj(start + omega2 * t)

    found = variant.solution()
    second = mp.diff(lambda t: abs(arm(t)), 0, 2)
    alpha4 = mp.diff(lambda t: mp.arg(arm(t) / arm(0)), 0, 2)
    assert float(found["rA_ddot"]) == pytest.approx(float(second), rel=1e-12)
    assert float(found["alpha4"]) == pytest.approx(float(alpha4), rel=1e-12)


@each_row("lang", ["fr", "en"])
def test_the_statement_tells_the_rates_that_the_known_terms_need(lang):
    for variant in ACCELERATION.variants(range(6), lang=lang):
        other = motion(variant.given)
        for name in ("omega4", "rA_dot"):
            printed = variant.printed[name]
            assert float(printed.removeprefix(r"\num{").rstrip("}")) == pytest.approx(other[name], rel=6e-4)
            assert printed in variant.text.opening
