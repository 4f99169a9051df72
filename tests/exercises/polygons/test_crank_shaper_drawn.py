"""Crank and slotted lever on paper: two drawings as a student makes them, the second from the speeds read off
the first."""

import cmath
import math
import random

import mpmath
import pytest
from paper_student import Student, rounded
from tables import each_row

import coursework

COURSE = coursework.open_course()
EXERCISE = COURSE["crank_shaper_drawn"]
FIRST, SECOND = ("p", "a", "b", "d", "e"), ("q", "a2", "k", "n", "b2", "d2", "m", "e2")
#: Points of the second drawing that bear letters of the first.
NAMES = {
    "p": "q",
    "a": "a2",
    "b": "b2",
    "d": "d2",
    "e": "e2",
}


def told(given):
    """The mechanism as the statement tells it: vectors CP, OP, OD, DE."""
    crank = cmath.rect(given["r2"], math.radians(given["theta2"]))
    arm = 1j * given["r1"] + crank
    theta4 = math.radians(round(math.degrees(cmath.phase(arm)), 1))
    rise = given["h"] - given["r4"] * (arm / abs(arm)).imag
    theta5 = math.radians(round(math.degrees(math.asin(rise / given["r5"])), 1))
    return (
        crank,
        cmath.rect(float(f"{abs(arm):.4g}"), theta4),
        given["r4"] / abs(arm),
        cmath.rect(given["r5"], theta5),
    )


def velocities(given, chance, ratio_of_image=None):
    crank, arm, ratio, rod = told(given)
    velocity = 1j * given["omega2"] * crank
    student = Student(chance, abs(velocity) * max(1.0, ratio))
    student.lay_off("a", "p", velocity)
    student.cross("b", "a", arm, "p", 1j * arm)
    student.enlarge("d", "p", "b", ratio_of_image or ratio)
    student.cross("e", "d", 1j * rod, "p", 1 + 0j)
    return student


def accelerations(given, chance, first, side=1):
    """With the speeds read off the first drawing, to the millimetres that it has."""
    crank, arm, ratio, rod = told(given)
    along, omega2 = arm / abs(arm), given["omega2"]
    omega4 = (first.vector("p", "b") / (1j * arm)).real
    sliding = (first.vector("b", "a") / along).real
    omega5 = (first.vector("d", "e") / (1j * rod)).real
    student = Student(chance, 1.2 * max(abs(omega2**2 * crank), abs(2 * omega4 * sliding)))
    student.lay_off("a", "p", -(omega2**2) * crank)
    student.lay_off("k", "a", -side * 2j * omega4 * sliding * along)
    student.lay_off("n", "p", -(omega4**2) * arm)
    student.cross("b", "k", along, "n", 1j * along)
    student.enlarge("d", "p", "b", ratio)
    student.lay_off("m", "d", -(omega5**2) * rod)
    student.cross("e", "m", 1j * rod, "p", 1 + 0j)
    return student


def handed_in(given, first, second):
    _, arm, _, _ = told(given)
    v_E = first.vector("p", "e").real
    swing = math.degrees(math.asin(given["r2"] / given["r1"]))
    alpha = round(180 + 2 * swing + 0.6)
    return {
        **first.points(),
        "kv": rounded(first.scale),
        "pv_b": first.measured("p", "b"),
        "pv_e": first.measured("p", "e"),
        "omega4": rounded((first.vector("p", "b") / (1j * arm)).real),
        "v_C": rounded(v_E),
        **{NAMES.get(n, n): text for n, text in second.points().items()},
        "ka": rounded(second.scale),
        "pa_e": second.measured("p", "e"),
        "a_C": rounded(second.vector("p", "e").real),
        "alpha": str(alpha),
        "beta": str(360 - alpha),
        "Q": rounded(alpha / (360 - alpha)),
        "mechanical_advantage": rounded(given["r2"] * abs(given["omega2"] / v_E)),
    }


def graded(variant, chance, ratio_of_image=None, side=1):
    first = velocities(variant.given, chance, ratio_of_image)
    second = accelerations(variant.given, chance, first, side)
    answers = handed_in(variant.given, first, second)
    marking = variant.grade(answers)
    return {name: marking[name].verdict for name in answers}


def test_a_careful_student_has_both_drawings_and_the_ram():
    chance = random.Random(4)
    for variant in EXERCISE.variants(range(40)):
        found = graded(variant, chance)
        assert found == dict.fromkeys(found, "correct"), variant.seed


def test_coriolis_on_the_wrong_side_is_told_and_costs_one_point_of_the_drawing():
    chance = random.Random(5)
    for variant in EXERCISE.variants(range(20)):
        found = graded(variant, chance, side=-1)
        assert found.pop("k") == "mistake:coriolis_sense", variant.seed
        assert set(found.values()) <= {"correct", "follow_through"}, variant.seed
        assert found["b2"] == found["e2"] == "follow_through"
        assert {found[n] for n in (*FIRST, "a2", "n")} == {"correct"}


def test_accelerations_from_ones_own_wrong_velocities_follow():
    """D taken for P on the first drawing: the rod's rate is wrong, and the second drawing right from
    there."""
    chance, told_so = random.Random(6), 0
    for variant in EXERCISE.variants(range(20)):
        found = graded(variant, chance, ratio_of_image=1.0)
        assert found.pop("d") == "mistake:image_length", variant.seed
        assert set(found.values()) <= {"correct", "follow_through"}, (variant.seed, found)
        assert found["e"] == "follow_through"
        told_so += found["m"] == "follow_through"
    assert told_so > 5


@each_row("seed", range(6))
def test_the_ram_is_that_of_fifty_digits(seed):
    """Its abscissa as a function of the crank angle, differentiated numerically."""
    variant = EXERCISE.variant(seed)
    mp = mpmath.MPContext()
    mp.dps = 50
    r1, r2, r4, r5, h, theta2, omega2 = (
        mp.mpf(variant.given[n]) for n in ("r1", "r2", "r4", "r5", "h", "theta2", "omega2")
    )

    def abscissa(t):
        arm = mp.mpc(0, r1) + r2 * mp.expj(mp.radians(theta2) + omega2 * t)
        D = r4 * arm / abs(arm)
        return D.real + mp.sqrt(r5**2 - (h - D.imag) ** 2)

    found = variant.solution()
    assert float(found["v_C"]) == pytest.approx(float(mp.diff(abscissa, 0, 1)), rel=1e-11)
    assert float(found["a_C"]) == pytest.approx(float(mp.diff(abscissa, 0, 2)), rel=1e-10)


@each_row("seed", range(8))
def test_velocity_and_time_ratio_are_those_of_the_computed_shaper(seed):
    variant = EXERCISE.variant(seed)
    found = variant.solution()
    names = ("v_C", "alpha", "beta", "Q")
    for name, value in COURSE["quick_return_shaper"].solve(**variant.given, only=names).items():
        assert found[name] == pytest.approx(value, rel=1e-10)


def test_the_data_of_the_notes_can_be_drawn():
    """Crank 105, lever 420, rod 165 at 9.42 rad/s: every condition of a variant holds, at the height and
    frame of this layout."""
    given = {"r1": 210.0, "r2": 105.0, "r4": 420.0, "r5": 165.0, "h": 400.0, "theta2": 30.0, "omega2": 9.42}
    found = EXERCISE.solve(**given)
    other = COURSE["quick_return_shaper"].solve(**given, only=("v_C", "Q"))
    assert found["v_C"] == pytest.approx(other["v_C"], rel=1e-12)
    assert found["Q"] == pytest.approx(2.0)
    ranges = EXERCISE.variants(range(60))
    assert {v.given["r2"] for v in ranges} & {105.0}
