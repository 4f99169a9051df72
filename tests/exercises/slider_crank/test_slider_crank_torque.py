"""Torque of a slider-crank, against energies in fifty digits, against a linear system, and at the edge of
jamming."""

import mpmath
import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.errors import CannotAssemble, MissingQuantity, Undefined, UnknownName

EXERCISE = coursework.open_course()["slider_crank_torque"]
EFFECTS = ("load", "gravity", "inertia", "friction")
ANSWERS = ("torque", "N_guide", "R_A", "R_B", "R_O")
ACCELERATIONS = {"alpha3", "r1_ddot", "a_G_x", "a_G_y"}
UPRIGHT = {"r2": 30.0, "r3": 50.0, "theta2": 90.0}

every_seed = pytest.mark.parametrize("seed", range(10))


class Motion:
    """The mechanism in metres and fifty digits, from the two circles alone, as functions of the time."""

    def __init__(self, given):
        self.given = {name: mpmath.mpf(value) for name, value in given.items()}

    def angle(self, t):
        g = self.given
        return g["theta2"] * mpmath.pi / 180 + g["omega2"] * t + g["alpha2"] * t**2 / 2

    def A(self, t):
        return self.given["r2"] / 1000 * mpmath.expj(self.angle(t))

    def B(self, t):
        A, e = self.A(t), self.given["e"] / 1000
        return mpmath.re(A) + mpmath.sqrt((self.given["r3"] / 1000) ** 2 - (e - mpmath.im(A)) ** 2) + 1j * e

    def G(self, t):
        return self.A(t) + self.given["s3"] * (self.B(t) - self.A(t))

    def rod_angle(self, t):
        return mpmath.arg(self.B(t) - self.A(t))

    def energy(self, t):
        """Kinetic and potential."""
        g = self.given

        def rate(function):
            return abs(mpmath.diff(function, t)) ** 2

        kinetic = (
            g["J2"] * rate(self.angle)
            + g["m3"] * rate(self.G)
            + g["J3"] * rate(self.rod_angle)
            + g["m4"] * rate(self.B)
        ) / 2
        heights = g["m3"] * mpmath.im(self.G(t)) + g["m4"] * mpmath.im(self.B(t))
        return kinetic + mpmath.mpf("9.81") * heights


def given_of(seed):
    return dict(EXERCISE.variant(seed).given)


@every_seed
def test_without_friction_the_drive_and_the_load_supply_what_the_energy_gains(seed):
    given = given_of(seed)
    torque = EXERCISE.solve(**given, effects=EFFECTS[:3], only="torque")["torque"]
    with mpmath.workdps(50):
        motion = Motion(given)
        power = mpmath.diff(motion.energy, 0) - motion.given["F"] * mpmath.re(mpmath.diff(motion.B, 0))
        assert torque == pytest.approx(float(power / motion.given["omega2"]), rel=1e-12)


def bodies(given, f):
    """Newton and Euler for crank, rod and piston, each about its own centre of mass: a linear system.

    Unknown: the forces at O (frame on crank), A (crank on rod), B (rod on piston), N_guide and the torque.
    With friction, one system for each side of the guide; the consistent ones are returned.
    """
    with mpmath.workdps(40):
        motion = Motion(given)
        A, B, G = (complex(point(0)) for point in (motion.A, motion.B, motion.G))
        a_B, a_G = (complex(mpmath.diff(point, 0, 2)) for point in (motion.B, motion.G))
        alpha3 = float(mpmath.diff(motion.rod_angle, 0, 2))
        speed = float(mpmath.re(mpmath.diff(motion.B, 0)))
    found = []
    for side in (1, -1):
        along = -f * side * np.sign(speed)  # friction per unit of N
        matrix = np.zeros((8, 8))
        right = np.zeros(8)
        Ox, Oy, Ax, Ay, Bx, By, N, torque = range(8)
        matrix[0, [Ox, Ax]] = 1, -1
        matrix[1, [Oy, Ay]] = 1, -1
        matrix[2, [torque, Ax, Ay]] = 1, A.imag, -A.real
        right[2] = given["J2"] * given["alpha2"]
        matrix[3, [Ax, Bx]] = 1, -1
        right[3] = given["m3"] * a_G.real
        matrix[4, [Ay, By]] = 1, -1
        right[4] = given["m3"] * (a_G.imag + 9.81)
        to_A, to_B = A - G, B - G
        matrix[5, [Ay, Ax, By, Bx]] = to_A.real, -to_A.imag, -to_B.real, to_B.imag
        right[5] = given["J3"] * alpha3
        matrix[6, [Bx, N]] = 1, along
        right[6] = given["m4"] * a_B.real - given["F"]
        matrix[7, [By, N]] = 1, 1
        right[7] = given["m4"] * 9.81
        x = np.linalg.solve(matrix, right)
        if np.sign(x[N]) == side:
            norms = [np.hypot(x[i], x[i + 1]) for i in (Ax, Bx, Ox)]
            found.append(dict(zip(ANSWERS, [x[torque], x[N], *norms], strict=True)))
    return found


@every_seed
@each_row("f", [0, 0.35, 0.9])
def test_forces_are_those_of_three_bodies_in_a_linear_system(seed, f):
    given = {**given_of(seed), "f": f} if f else given_of(seed)
    effects = EFFECTS if f else EFFECTS[:3]
    answers = EXERCISE.solve(**given, effects=effects)
    (expected,) = bodies(given, f)
    assert answers == pytest.approx(expected, rel=1e-10)


def test_variants_call_for_every_effect():
    variant = EXERCISE.variant(3)
    (expected,) = bodies(variant.given, variant.given["f"])
    assert variant.solution() == pytest.approx(expected, rel=1e-10)
    assert variant.walk["torque"] == variant.key.reference["torque"]
    assert all(mark.verdict == "correct" for mark in variant.grade(expected).values())


@every_seed
def test_friction_takes_from_the_drive_the_power_that_it_dissipates(seed):
    given = given_of(seed)
    turn = {**given, "theta2": np.arange(0.5, 360.0)}
    asked = ("torque", "N_guide", "r1_dot")
    rubbing = EXERCISE.solve(**turn, effects=EFFECTS, only=asked)
    smooth = EXERCISE.solve(**turn, effects=EFFECTS[:3], only=asked)
    lost = (rubbing["torque"] - smooth["torque"]) * given["omega2"]
    heat = given["f"] * abs(rubbing["N_guide"] * rubbing["r1_dot"]) / 1000
    np.testing.assert_allclose(lost, heat, rtol=1e-9, atol=1e-12 * abs(rubbing["torque"]).max())
    assert (heat > 0).all()


@every_seed
def test_effects_without_friction_add_up(seed):
    given = {**given_of(seed), "theta2": np.linspace(-180, 180, 37)}
    signed = ("torque", "N_guide", "R_A_x", "R_A_y", "R_B_x", "R_B_y")
    alone = [EXERCISE.solve(**given, effects=(e,), only=signed) for e in EFFECTS[:3]]
    together = EXERCISE.solve(**given, effects=EFFECTS[:3], only=signed)
    for name in signed:
        parts = [one[name] for one in alone]
        np.testing.assert_allclose(together[name], sum(parts), atol=1e-12 * sum(map(abs, parts)).max())


@each_row(
    ("effect", "needs", "absent"),
    [
        ("load", {"F"}, {"omega3", "r1_dot", *ACCELERATIONS}),
        ("gravity", {"m3", "m4", "s3"}, {"omega3", "r1_dot", *ACCELERATIONS}),
        ("inertia", {"m3", "J3", "m4", "J2", "s3", "omega2"}, {"r1_dot", "friction", "load"}),
        ("friction", {"f", "omega2"}, ACCELERATIONS),
    ],
)
def test_a_request_evaluates_an_effect_only_when_it_is_called(effect, needs, absent):
    plan = set(EXERCISE.plan(("torque",), effects=(effect,)))
    assert effect in plan
    assert not plan & (absent | set(EFFECTS) - {effect})
    every = {"F": 5, "m3": 1, "m4": 1, "s3": 0.5, "J3": 1, "J2": 1, "f": 0.1, "omega2": 1}
    enough = {name: every[name] for name in needs}
    EXERCISE.solve(**UPRIGHT, **enough, effects=(effect,), only="torque")
    for name in needs:
        fewer = {n: v for n, v in enough.items() if n != name}
        with pytest.raises(MissingQuantity, match=name):
            EXERCISE.solve(**UPRIGHT, **fewer, effects=(effect,), only="torque")


def test_without_effects_nothing_pulls_and_no_mass_is_asked_for():
    assert EXERCISE.solve(**UPRIGHT, only=ANSWERS, effects=()) == dict.fromkeys(ANSWERS, 0)
    row = EXERCISE.solve(r2=30, r3=50, theta2=np.array([10.0, 200.0]), only="torque", effects=())
    assert row["torque"].tolist() == [0, 0]
    with pytest.raises(UnknownName, match="did you mean 'gravity'"):
        EXERCISE.solve(**UPRIGHT, only="torque", effects=("gravitty",))


def test_a_guide_that_holds_on_neither_side_is_said_to_jam():
    """Crank upright, tan theta3 = -3/4: driven to the right against the load, it jams from f = 4/3 on."""
    scene = {**UPRIGHT, "F": -400.0, "omega2": -2.0}
    called = {"effects": ("load", "friction"), "only": ("torque", "N_guide")}
    free = EXERCISE.solve(**scene, f=1.33, **called)
    assert free["N_guide"] == pytest.approx(300 / (1 - 0.75 * 1.33))
    for f in (4 / 3 + 1e-9, 2.0):
        with pytest.raises(Undefined, match="jams"):
            EXERCISE.solve(**scene, f=f, **called)
    row = EXERCISE.solve(**scene, f=np.array([0.0, 1.33, 1.34, 2.0]) + 1e-9, **called)
    for name in called["only"]:
        assert np.isnan(row[name]).tolist() == [False, False, True, True]
    # Of such a pose, three bodies in a linear system find no side either.
    masses = {"e": 0.0, "alpha2": 0.0, "s3": 0.5, "m3": 1e-9, "J3": 1e-9, "m4": 1e-9, "J2": 0.0}
    assert bodies({**scene, **masses}, 1.34) == []
    assert len(bodies({**scene, **masses}, 1.32)) == 1


def test_of_two_consistent_sides_the_one_reached_from_no_friction_is_taken():
    scene = {**UPRIGHT, "F": -400.0, "omega2": 2.0}
    row = EXERCISE.solve(**scene, f=np.linspace(0.1, 3, 30), effects=("load", "friction"), only="N_guide")
    assert (row["N_guide"] > 0).all()
    assert (np.diff(row["N_guide"]) < 0).all()


def test_a_crank_at_rest_is_held_without_friction():
    held = EXERCISE.solve(**UPRIGHT, F=-400, f=0.3, omega2=0, effects=("load", "friction"), only="torque")
    assert held["torque"] == pytest.approx(-12)


def test_the_load_alone_is_the_ratio_of_velocities_even_beside_a_dead_centre():
    for theta2 in (1e-7, 30.0, 90.0, 179.0):
        found = EXERCISE.solve(
            r2=40, r3=120, theta2=theta2, omega2=1, F=500, effects=("load",), only=("torque", "r1_dot")
        )
        assert found["torque"] == pytest.approx(-0.5 * found["r1_dot"], rel=1e-13)


def test_what_does_not_close_is_refused_alone_and_is_nan_in_a_row():
    scene = {"r2": 50.0, "r3": 40.0, "F": 10.0}
    with pytest.raises(CannotAssemble, match=r"gap 10"):
        EXERCISE.solve(**scene, theta2=90.0, effects=("load",))
    row = EXERCISE.solve(**scene, theta2=np.array([0.0, 90.0]), effects=("load",), only=ANSWERS)
    for name in ANSWERS:
        assert np.isnan(row[name]).tolist() == [False, True]


@every_seed
@each_row(
    ("mistake", "changed"),
    [
        ("rod_massless", {"m3": 0.0, "J3": 0.0}),
        ("rod_inertia_forgotten", {"J3": 0.0}),
        ("load_sign", lambda given: {"F": -given["F"]}),
        ("crank_inertia_forgotten", {"J2": 0.0}),
    ],
)
def test_a_mistake_is_the_right_answer_to_other_data(seed, mistake, changed):
    given = given_of(seed)
    wrong = EXERCISE.solution.mistaken(mistake).evaluate(ANSWERS, given, EFFECTS)
    other = {**given, **(changed(given) if callable(changed) else changed)}
    assert wrong == pytest.approx(EXERCISE.solution.graph.evaluate(ANSWERS, other, EFFECTS), rel=1e-12)


@every_seed
def test_forgotten_effects_are_requests_that_do_not_call_them(seed):
    given = given_of(seed)
    for mistake, effect in (
        ("friction_forgotten", "friction"),
        ("weights_forgotten", "gravity"),
        ("inertia_forgotten", "inertia"),
    ):
        wrong = EXERCISE.solution.mistaken(mistake).evaluate(ANSWERS, given, EFFECTS)
        rest = tuple(e for e in EFFECTS if e != effect)
        assert wrong == pytest.approx(EXERCISE.solve(**given, effects=rest), rel=1e-12)
