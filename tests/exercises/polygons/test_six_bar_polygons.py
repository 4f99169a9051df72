"""Drawn polygons of six links: as a student draws them, against the computed motion."""

import cmath
import math
import random

import mpmath
import pytest
from paper_student import Student, rounded
from tables import each_row

import coursework

COURSE = coursework.open_course()
VELOCITY, ACCELERATION = COURSE["velocity_polygon_six_bar"], COURSE["acceleration_polygon_six_bar"]


def told(variant):
    """Vectors OA, AB, DB, BC, the last three in the directions that the statement tells."""
    given, motion = variant.given, COURSE["slider_extras"].solve(**variant.given)
    # The statement's theta5 is from B to the slider, the other exercise's from the slider to B.
    angles = motion["theta3"], motion["theta4"], (motion["theta5"] + 180 + 180) % 360 - 180
    told_ = (round(float(angle), 1) for angle in angles)
    crank = cmath.rect(given["r2"], math.radians(given["theta2"]))
    bars = (cmath.rect(given[r], math.radians(t)) for r, t in zip(("r3", "r4", "r5"), told_, strict=True))
    return crank, *bars


def drawn_velocities(variant, chance):
    crank, coupler, rocker, rod = told(variant)
    velocity = 1j * variant.given["omega2"] * crank
    student = Student(chance, 1.3 * abs(velocity))
    student.lay_off("a", "p", velocity)
    student.cross("b", "a", 1j * coupler, "p", 1j * rocker)
    student.cross("c", "b", 1j * rod, "p", 1 + 0j)
    return {
        **student.points(),
        "kv": rounded(student.scale),
        "ab": student.measured("a", "b"),
        "pv_b": student.measured("p", "b"),
        "bc": student.measured("b", "c"),
        "pv_c": student.measured("p", "c"),
        "omega3": rounded((student.vector("a", "b") / (1j * coupler)).real),
        "omega4": rounded((student.vector("p", "b") / (1j * rocker)).real),
        "omega5": rounded((student.vector("b", "c") / (1j * rod)).real),
        "r6_dot": rounded(student.vector("p", "c").real),
    }


def drawn_accelerations(variant, chance, rod_normal=1.0):
    crank, coupler, rocker, rod = told(variant)
    motion = COURSE["slider_extras"].solve(**variant.given)
    omega3, omega4, omega5 = (float(motion[n]) for n in ("omega3", "omega4", "omega5"))
    student = Student(chance, 1.3 * abs(variant.given["omega2"] ** 2 * crank))
    student.lay_off("a", "p", -(variant.given["omega2"] ** 2) * crank)
    student.lay_off("n", "a", -(omega3**2) * coupler)
    student.lay_off("m", "p", -(omega4**2) * rocker)
    student.cross("b", "n", 1j * coupler, "m", 1j * rocker)
    student.lay_off("f", "b", -rod_normal * omega5**2 * rod)
    student.cross("c", "f", 1j * rod, "p", 1 + 0j)
    return {
        **student.points(),
        "ka": rounded(student.scale),
        "bb_t": student.measured("n", "b"),
        "pa_c": student.measured("p", "c"),
        "alpha3": rounded((student.vector("n", "b") / (1j * coupler)).real),
        "r6_ddot": rounded(student.vector("p", "c").real),
    }


@each_row(("exercise", "drawn"), [(VELOCITY, drawn_velocities), (ACCELERATION, drawn_accelerations)])
def test_a_careful_student_has_every_point_of_the_drawing(exercise, drawn):
    chance = random.Random(12)
    for variant in exercise.variants(range(40)):
        answers = drawn(variant, chance)
        marking = variant.grade(answers)
        assert {n: marking[n].verdict for n in answers} == dict.fromkeys(answers, "correct"), variant.seed


def test_a_normal_part_laid_off_backwards_is_told_and_the_slider_follows():
    told_so = 0
    for variant in ACCELERATION.variants(range(20)):
        answers = drawn_accelerations(variant, random.Random(2), rod_normal=-1.0)
        marking = variant.grade(answers)
        told_so += marking["f"].verdict == "mistake:f_sense"
        assert marking["f"].points < marking["f"].out_of
        assert marking["b"].verdict == "correct"
        assert marking["c"].verdict == "follow_through"
    assert told_so == 20


@each_row("seed", range(10))
def test_both_are_those_of_the_computed_motion(seed):
    names = {VELOCITY: ("omega3", "omega4", "omega5", "r6_dot"), ACCELERATION: ("alpha3", "r6_ddot")}
    for exercise, asked in names.items():
        variant = exercise.variant(seed)
        found = variant.solution()
        for name, value in COURSE["slider_extras"].solve(**variant.given, only=asked).items():
            assert found[name] == pytest.approx(value, rel=1e-9)


@each_row("seed", range(6))
def test_the_slider_is_that_of_fifty_digits(seed):
    variant = ACCELERATION.variant(seed)
    mp = mpmath.MPContext()
    mp.dps = 50
    r1, r2, r3, r4, r5, theta2, omega2 = (
        mp.mpf(variant.given[n]) for n in ("r1", "r2", "r3", "r4", "r5", "theta2", "omega2")
    )
    side = 1 if variant.given["mode"] == "open" else -1

    def abscissa(t):
        A = mp.mpc(0, r1) + r2 * mp.expj(mp.radians(theta2) + omega2 * t)
        corner = mp.acos((abs(A) ** 2 + r3**2 - r4**2) / (2 * abs(A) * r3))
        B = A - r3 * A / abs(A) * mp.expj(side * corner)
        return B.real + mp.sqrt(r5**2 - B.imag**2)

    assert float(variant.solution()["r6_ddot"]) == pytest.approx(float(mp.diff(abscissa, 0, 2)), rel=1e-10)
    first = VELOCITY.solve(**variant.given, only=("r6_dot",))["r6_dot"]
    assert float(first) == pytest.approx(float(mp.diff(abscissa, 0, 1)), rel=1e-11)
