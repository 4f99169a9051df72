"""Two circles: B by ruler and compass, in either order, at any scale and origin, judged from the student's
own points."""

import cmath
import math
import random

import mpmath
from tables import each_row

import coursework

COURSE = coursework.open_course()
EXERCISE = COURSE["two_circles"]
POINTS = ("p", "a", "c", "b1", "b2")
ANGLES = ("theta3_open", "theta4_open", "theta3_crossed", "theta4_crossed")
EXCHANGED = {
    "b1": "b2",
    "b2": "b1",
    "theta3_open": "theta3_crossed",
    "theta4_open": "theta4_crossed",
    "theta3_crossed": "theta3_open",
    "theta4_crossed": "theta4_open",
}


def compass(center, radius, other, other_radius):
    """Where two circles meet, by the law of cosines, on the left and on the right of the line of centres."""
    way = other - center
    corner = math.acos((abs(way) ** 2 + radius**2 - other_radius**2) / (2 * abs(way) * radius))
    return [center + cmath.rect(radius, cmath.phase(way) + side * corner) for side in (1, -1)]


def student(given, chance, scale=None, turned_A=0.0, noise=0.3):
    """Somebody with pencil and compass: their own scale and origin, every point ``noise`` mm off at most."""

    def put(z):
        return z + cmath.rect(noise * chance.random(), chance.uniform(0, 2 * math.pi))

    scale = scale or max(given[n] for n in ("r1", "r2")) / chance.uniform(35, 60)
    O = complex(chance.uniform(-80, 80), chance.uniform(-80, 80))
    A = put(O + cmath.rect(given["r2"] / scale, math.radians(given["theta2"] + turned_A)))
    C = put(O + given["r1"] / scale)
    B1, B2 = map(put, compass(A, given["r3"] / scale, C, given["r4"] / scale))
    angles = [math.degrees(cmath.phase(B - start)) for B in (B1, B2) for start in (A, C)]
    return dict(zip(POINTS, (O, A, C, B1, B2), strict=True)), dict(zip(ANGLES, angles, strict=True)), scale


def handed_in(points, angles, scale):
    """To the tenth of a millimetre, the half of a degree."""
    told = {n: f"({z.real:.1f} ; {z.imag:.1f})" for n, z in points.items()}
    return {**told, **{n: f"{round(2 * v) / 2}°" for n, v in angles.items()}, "kl": f"{scale:.6g}"}


def verdicts(marking):
    return {name: marking[name].verdict for name in (*POINTS, *ANGLES, "kl")}


@each_row("in_order", [True, False])
def test_a_careful_student_is_right_in_either_order(in_order):
    chance = random.Random(3)
    for variant in EXERCISE.variants(range(40)):
        answers = handed_in(*student(variant.given, chance))
        if not in_order:
            answers = {EXCHANGED.get(name, name): text for name, text in answers.items()}
        marking = variant.grade(answers)
        assert marking.points == marking.out_of, {
            n: v for n, v in verdicts(marking).items() if v != "correct"
        }


def test_angles_of_one_order_with_points_of_the_other_are_told():
    for variant in EXERCISE.variants(range(10)):
        points, angles, scale = student(variant.given, random.Random(1))
        swapped = {EXCHANGED[name]: value for name, value in angles.items()}
        found = verdicts(variant.grade(handed_in(points, swapped, scale)))
        assert found["b1"] == found["b2"] == "correct"
        told = [found[n] for n in ANGLES]
        # Where chance has another mistake explain one of the two angles, they count as exchanged boxes.
        assert (
            {"mistake:of_the_other_point"}
            <= set(told)
            <= {
                "mistake:of_the_other_point",
                "correct",
                "mistake:clockwise",
                "mistake:read_backwards",
                "mistake:bars_exchanged",
                "slip:exchanged",
                "follow_through",
            }
        )


def test_angles_alone_are_judged_in_either_order():
    for variant in EXERCISE.variants(range(10)):
        right = {n: variant.solution()[n] for n in ANGLES}
        for answers in (right, {EXCHANGED[n]: v for n, v in right.items()}):
            marking = variant.grade({n: f"{v:.1f}" for n, v in answers.items()})
            assert {marking[n].verdict for n in ANGLES} == {"slip:not_drawn"}


def test_a_crank_drawn_at_another_angle_costs_only_A():
    costs = set()
    for variant in EXERCISE.variants(range(30)):
        try:
            drawing = student(variant.given, random.Random(2), turned_A=15.0)
        except ValueError:  # the circles do not meet from there
            continue
        found = verdicts(variant.grade(handed_in(*drawing)))
        costs.add(found.pop("a"))
        assert set(found.values()) <= {"correct", "follow_through"}
        assert found["b1"] == found["b2"] == "follow_through"
    assert costs == {"mistake:a_direction"}


@each_row("lang", ["fr", "en"])
def test_the_same_point_twice_is_told(lang):
    variant = EXERCISE.variant(4, lang)
    points, angles, scale = student(variant.given, random.Random(5))
    marking = variant.grade(handed_in({**points, "b2": points["b1"]}, angles, scale))
    assert marking["b1"].verdict == "correct"
    assert marking["b2"].verdict == "mistake:same_point"
    assert "AC" in marking["b2"].feedback


@each_row("off", [1.8, 2.6])
def test_a_point_is_on_its_circles_to_two_millimetres(off):
    variant = EXERCISE.variant(7)
    points, angles, scale = student(variant.given, random.Random(5), noise=0.0)
    away = points["b1"] - points["a"]
    # Along the circle of C: off that of A alone.
    along = 1j * (points["b1"] - points["c"]) / abs(points["b1"] - points["c"])
    step = off / abs((along * away.conjugate() / abs(away)).real)
    found = verdicts(variant.grade(handed_in({**points, "b1": points["b1"] + step * along}, angles, scale)))
    assert found["b1"] == ("correct" if off < 2 else "mistake:off_circle_A")


@each_row("seed", range(12))
def test_points_and_angles_are_those_of_fifty_digits(seed):
    variant = EXERCISE.variant(seed)
    found = variant.solution()
    mp = mpmath.MPContext()
    mp.dps = 50
    r1, r2, r3, r4, theta2 = (mp.mpf(variant.given[n]) for n in ("r1", "r2", "r3", "r4", "theta2"))
    A = r2 * mp.expjpi(theta2 / 180)
    way = r1 - A
    corner = mp.acos((abs(way) ** 2 + r3**2 - r4**2) / (2 * abs(way) * r3))
    for index, side, names in (("b1", 1, ANGLES[:2]), ("b2", -1, ANGLES[2:])):
        B = A + r3 * mp.expj(mp.arg(way) + side * corner)
        assert abs(mp.mpc(*map(float, found[index])) * found["kl"] - B) < 1e-11
        for name, vector in zip(names, (B - A, B - r1), strict=True):
            assert abs(mp.mpf(float(found[name])) - mp.degrees(mp.arg(vector))) < 1e-11
