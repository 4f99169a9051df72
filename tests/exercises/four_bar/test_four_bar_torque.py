"""Torque of a four-bar linkage: against three bodies in fifty digits, and near a dead point and a change
point."""

import itertools

import mpmath
import numpy as np
import pytest
from sweeps import sampled
from tables import each_row

import coursework
from coursework.errors import CannotAssemble, MissingQuantity, UnknownName
from coursework.scenes.scenes import Scene

EXERCISE = coursework.open_course()["four_bar_torque"]
EFFECTS = ("load", "gravity", "inertia")
ANSWERS = ("torque", "R_A", "R_B", "R_C", "R_O")
ACCELERATIONS = {"alpha3", "alpha4", "a_G3_x", "a_G3_y", "a_G4_x", "a_G4_y"}
PLAIN = {
    "r1": 400.0,
    "r2": 120.0,
    "r3": 380.0,
    "r4": 300.0,
    "theta2": 50.0,
    "omega2": 8.0,
    "alpha2": -20.0,
    "mode": "open",
    "m2": 9.0,
    "J2": 0.3,
    "s3": 0.4,
    "m3": 8.0,
    "J3": 0.15,
    "s4": 0.55,
    "m4": 11.0,
    "J4": 0.14,
    "M": 45.0,
}
LENGTHS = {name: PLAIN[name] for name in ("r1", "r2", "r3", "r4", "theta2", "mode")}

every_seed = pytest.mark.parametrize("seed", sampled(range(20), range(6)))


class Motion:
    """The mechanism in metres and fifty digits, from the two circles alone, as functions of the time."""

    def __init__(self, given):
        g = {n: v if n == "mode" else mpmath.mpf(v) for n, v in given.items()}
        self.given, self.side = g, {"open": 1, "crossed": -1}[g["mode"]]
        self.C = g["r1"] / 1000

    def angle(self, t):
        g = self.given
        return g["theta2"] * mpmath.pi / 180 + g["omega2"] * t + g["alpha2"] * t**2 / 2

    def A(self, t):
        return self.given["r2"] / 1000 * mpmath.expj(self.angle(t))

    def B(self, t):
        A, r3, r4 = self.A(t), self.given["r3"] / 1000, self.given["r4"] / 1000
        line = self.C - A
        along = (r3**2 + abs(line) ** 2 - r4**2) / (2 * abs(line))
        return A + line / abs(line) * (along + 1j * self.side * mpmath.sqrt(r3**2 - along**2))

    def G3(self, t):
        return self.A(t) + self.given["s3"] * (self.B(t) - self.A(t))

    def G4(self, t):
        return self.C + self.given["s4"] * (self.B(t) - self.C)

    def coupler(self, t):
        return mpmath.arg((self.B(t) - self.A(t)) / (self.B(0) - self.A(0)))

    def rocker(self, t):
        return mpmath.arg((self.B(t) - self.C) / (self.B(0) - self.C))


def moments(arm):
    """The moment of a force at the end of an arm, as factors of its two components."""
    return [-mpmath.im(arm), mpmath.re(arm)]


def three_bodies(given, effects):
    """Newton and Euler for crank, coupler and rocker, each about its own centre of mass: a linear system.

    Unknown: the forces at O (of the frame on the crank), A (crank on coupler), B (coupler on rocker), C
    (frame on rocker), two components each, and the torque.
    """
    with mpmath.workdps(50):
        motion = Motion(given)
        g, now = motion.given, mpmath.mpf(0)
        A, B, G3, G4 = (point(now) for point in (motion.A, motion.B, motion.G3, motion.G4))
        weight = mpmath.mpf("9.81") if "gravity" in effects else 0
        moved = 1 if "inertia" in effects else 0
        a_3, a_4 = (moved * mpmath.diff(point, now, 2) for point in (motion.G3, motion.G4))
        turn_3, turn_4 = (moved * mpmath.diff(angle, now, 2) for angle in (motion.coupler, motion.rocker))
        sense = mpmath.sign(mpmath.diff(motion.rocker, now))
        resisting = -g["M"] * sense if "load" in effects else 0

        zero, one = [0, 0], [[1, 0], [0, 1]]
        rows, right = [], []

        def balance(O, A, B, C, torque, value):
            rows.append([*O, *A, *B, *C, torque])
            right.append(value)

        def minus(row):
            return [-x for x in row]

        for i, unit in enumerate(one):
            balance(unit, minus(unit), zero, zero, 0, i * g["m2"] * weight)
            balance(zero, unit, minus(unit), zero, 0, g["m3"] * ((a_3.real, a_3.imag)[i] + i * weight))
            balance(zero, zero, unit, unit, 0, g["m4"] * ((a_4.real, a_4.imag)[i] + i * weight))
        balance(zero, minus(moments(A)), zero, zero, 1, moved * g["J2"] * g["alpha2"])
        balance(zero, moments(A - G3), minus(moments(B - G3)), zero, 0, g["J3"] * turn_3)
        balance(zero, zero, moments(B - G4), moments(motion.C - G4), 0, g["J4"] * turn_4 - resisting)
        x = mpmath.lu_solve(mpmath.matrix(rows), mpmath.matrix(right))
        norms = {f"R_{pin}": mpmath.hypot(x[2 * k], x[2 * k + 1]) for k, pin in enumerate("OABC")}
        return {"torque": x[8], **norms}


def given_of(seed):
    return dict(EXERCISE.variant(seed).given)


def largest(found, expected):
    """The largest error, as a share of the largest force or of the torque."""
    forces = max(float(abs(expected[n])) for n in ANSWERS[1:])
    errors = [abs(float(found[n] - expected[n])) / forces for n in ANSWERS[1:]]
    return max(*errors, abs(float((found["torque"] - expected["torque"]) / expected["torque"])))


@every_seed
def test_torque_and_forces_are_those_of_three_bodies_under_every_choice_of_effects(seed):
    given = given_of(seed)
    for count in (1, 2, 3):
        for effects in itertools.combinations(EFFECTS, count):
            found = EXERCISE.solve(**given, effects=effects, only=ANSWERS)
            assert largest(found, three_bodies(given, effects)) < 1e-12, effects


def test_variants_call_for_every_effect():
    variant = EXERCISE.variant(3)
    expected = {name: float(value) for name, value in three_bodies(variant.given, EFFECTS).items()}
    assert variant.solution() == pytest.approx(expected, rel=1e-11)
    assert all(mark.verdict == "correct" for mark in variant.grade(expected).values())


@every_seed
def test_the_stated_mechanism_bears_the_same_over_a_turn(seed):
    """Bodies and joints alone, without any formula of the exercise."""
    given, joints = given_of(seed), "ABCO"
    for effects in (("load",), ("gravity",), EFFECTS):
        scene = Scene(EXERCISE, given, effects, show=("drive_torque", *(f"reaction {pin}" for pin in joints)))
        columns = scene.over_cycle(24).columns
        stated = {f"R_{pin}": np.hypot(columns[f"R_{pin}_x"], columns[f"R_{pin}_y"]) for pin in joints}
        for name, values in {"torque": columns["drive_torque"], **stated}.items():
            found = EXERCISE.solve(**{**given, "theta2": columns["theta2"]}, effects=effects, only=name)[name]
            np.testing.assert_allclose(values, found, atol=1e-11 * abs(found).max())


@each_row("away", [1.0, 1e-3, 1e-6, 1e-9])
def test_the_digits_stay_beside_a_change_point(away):
    """Bars of 50, 70, 80 and 100: at half a turn they lie on one line, where every force grows without
    bound."""
    given = {**PLAIN, "r1": 400.0, "r2": 200.0, "r3": 280.0, "r4": 320.0, "theta2": 180.0 - away}
    for effects in (("load",), ("gravity",), EFFECTS):
        found = EXERCISE.solve(**given, effects=effects, only=ANSWERS)
        assert largest(found, three_bodies(given, effects)) < 1e-12, effects


def test_the_energy_and_the_moment_are_what_the_drive_supplies():
    turn = {**PLAIN, "alpha2": 0.0, "theta2": np.arange(0.0, 360.0)}
    names = ("torque", "omega4")
    load = EXERCISE.solve(**turn, effects=("load",), only=names)
    np.testing.assert_allclose(load["torque"] * turn["omega2"], turn["M"] * abs(load["omega4"]), rtol=1e-12)
    for effect in ("gravity", "inertia"):
        torque = EXERCISE.solve(**turn, effects=(effect,), only="torque")["torque"]
        assert abs(torque.mean()) < 1e-12 * abs(torque).max()


@every_seed
def test_effects_add_up(seed):
    given = {**given_of(seed), "theta2": np.linspace(-180, 180, 37)}
    signed = ("torque", "R_A_x", "R_A_y", "R_B_x", "R_B_y", "R_C_x", "R_C_y", "R_O_y")
    alone = [EXERCISE.solve(**given, effects=(e,), only=signed) for e in EFFECTS]
    together = EXERCISE.solve(**given, effects=EFFECTS, only=signed)
    for name in signed:
        parts = [one[name] for one in alone]
        np.testing.assert_allclose(together[name], sum(parts), atol=1e-12 * sum(map(abs, parts)).max())


@each_row(
    ("effect", "needs", "absent"),
    [
        ("load", {"M", "omega2"}, ACCELERATIONS),
        ("gravity", {"m2", "m3", "m4", "s3", "s4"}, {"omega3", "omega4", *ACCELERATIONS}),
        ("inertia", {"J2", "m3", "J3", "s3", "m4", "J4", "s4", "omega2"}, {"load"}),
    ],
)
def test_a_request_evaluates_an_effect_only_when_it_is_called(effect, needs, absent):
    plan = set(EXERCISE.plan(ANSWERS, effects=(effect,)))
    assert effect in plan
    assert not plan & (absent | set(EFFECTS) - {effect})
    enough = {name: PLAIN[name] for name in needs}
    EXERCISE.solve(**LENGTHS, **enough, effects=(effect,), only=ANSWERS)
    for name in needs:
        fewer = {n: v for n, v in enough.items() if n != name}
        with pytest.raises(MissingQuantity, match=name):
            EXERCISE.solve(**LENGTHS, **fewer, effects=(effect,), only=ANSWERS)


def test_the_torque_alone_needs_no_force_of_a_joint():
    plan = EXERCISE.plan(("torque",), effects=EFFECTS)
    assert not [name for name in plan if name.startswith("R_")]


def test_without_effects_nothing_pulls_and_no_mass_is_asked_for():
    assert EXERCISE.solve(**LENGTHS, only=ANSWERS, effects=()) == dict.fromkeys(ANSWERS, 0)
    with pytest.raises(UnknownName, match="did you mean 'gravity'"):
        EXERCISE.solve(**LENGTHS, only="torque", effects=("gravitty",))


def test_a_rocker_at_rest_is_given_no_moment():
    held = EXERCISE.solve(**{**PLAIN, "omega2": 0.0}, effects=("load",), only=ANSWERS)
    assert held == dict.fromkeys(ANSWERS, 0)


def test_what_does_not_close_is_refused_alone_and_is_nan_in_a_row():
    short = {**PLAIN, "r3": 100.0, "r4": 120.0}
    with pytest.raises(CannotAssemble, match="does not close"):
        EXERCISE.solve(**short, effects=EFFECTS)
    row = EXERCISE.solve(**{**short, "r3": np.array([100.0, 380.0])}, effects=EFFECTS, only=ANSWERS)
    for name in ANSWERS:
        assert np.isnan(row[name]).tolist() == [True, False]


@every_seed
@each_row(
    ("mistake", "changed"),
    [
        ("moment_along_the_motion", lambda given: {"M": -given["M"]}),
        ("inertia_torques_forgotten", lambda given: {"J3": 0.0, "J4": 0.0}),
        ("crank_inertia_forgotten", lambda given: {"J2": 0.0}),
        ("other_mode", lambda given: {"mode": {"open": "crossed", "crossed": "open"}[given["mode"]]}),
    ],
)
def test_a_mistake_is_the_right_answer_to_other_data(seed, mistake, changed):
    given = given_of(seed)
    wrong = EXERCISE.solution.mistaken(mistake).evaluate(ANSWERS, given, EFFECTS)
    other = {**given, **changed(given)}
    assert wrong == pytest.approx(EXERCISE.solution.graph.evaluate(ANSWERS, other, EFFECTS), rel=1e-12)


@every_seed
def test_forgotten_effects_are_requests_that_do_not_call_them(seed):
    given = given_of(seed)
    for mistake, effect in (("weights_forgotten", "gravity"), ("inertia_forgotten", "inertia")):
        wrong = EXERCISE.solution.mistaken(mistake).evaluate(ANSWERS, given, EFFECTS)
        rest = tuple(e for e in EFFECTS if e != effect)
        assert wrong == pytest.approx(EXERCISE.solve(**given, effects=rest, only=ANSWERS), rel=1e-12)
