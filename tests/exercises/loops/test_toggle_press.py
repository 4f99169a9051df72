"""Toggle press: against five bodies in fifty digits, where the toggle is nearly in line, and near the crank's
dead point."""

import mpmath
import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.errors import CannotAssemble, Undefined
from coursework.scenes.scenes import Scene

EXERCISE = coursework.open_course()["toggle_press"]
ASKED = (
    "psi",
    "yC",
    "theta2",
    "theta3",
    "v_C",
    "mechanical_advantage",
    "F_5",
    "N_guide",
    "F_4",
    "torque",
)
FORCES = ("F_3", "F_4", "F_5", "N_guide", "torque")
PLAIN = {
    "r2": 50.0,
    "r3": 220.0,
    "r4": 200.0,
    "r5": 240.0,
    "yO": -150.0,
    "xO": -260.0,
    "phi": 8.0,
    "A_side": "left",
    "omega2": -4.0,
    "F": 20000.0,
}

every_seed = pytest.mark.parametrize("seed", range(20))


class Press:
    """The press in millimetres and fifty digits: A from the two circles about O and B, then B from those
    about A and D as the crank turns, C on its line below B."""

    def __init__(self, given):
        g = {n: v if n == "A_side" else mpmath.mpf(v) for n, v in given.items()}
        self.given, self.O = g, mpmath.mpc(g["xO"], g["yO"])
        knee = -1j * g["r4"] * mpmath.expj(-g["phi"] * mpmath.pi / 180)
        self.A0 = self._joint(self.O, knee, g["r2"], g["r3"], {"left": 1, "right": -1}[g["A_side"]])
        self.side = mpmath.sign(mpmath.im(mpmath.conj(-self.A0) * (knee - self.A0)))

    @staticmethod
    def _joint(p, q, p_length, q_length, side):
        line = q - p
        along = (p_length**2 + abs(line) ** 2 - q_length**2) / (2 * abs(line))
        return p + line / abs(line) * (along + 1j * side * mpmath.sqrt(p_length**2 - along**2))

    def A(self, turned):
        return self.O + (self.A0 - self.O) * mpmath.expj(turned)

    def B(self, turned):
        return self._joint(self.A(turned), mpmath.mpf(0), self.given["r3"], self.given["r4"], self.side)

    def C(self, turned):
        B = self.B(turned)
        return 1j * (mpmath.im(B) - mpmath.sqrt(self.given["r5"] ** 2 - mpmath.re(B) ** 2))


def five_bodies(press):
    """Forces and moments of crank, coupler, upper bar, lower bar and ram: a linear system.

    Unknown, two components each: of the frame on the crank at O, crank on coupler at A, coupler on upper bar
    and lower bar on upper bar at B, frame on upper bar at D, ram on lower bar at C; then the guide's force
    and the torque.
    """
    zero = mpmath.mpf(0)
    O, A, B, C, F = press.O, press.A(zero), press.B(zero), press.C(zero), press.given["F"]
    places = {"O": O, "A": A, "coupler": B, "lower": B, "D": mpmath.mpf(0), "C": C}
    names = list(places)
    acts = {
        "crank": {"O": 1, "A": -1},
        "coupler": {"A": 1, "coupler": -1},
        "upper": {"coupler": 1, "lower": 1, "D": 1},
        "lower bar": {"lower": -1, "C": 1},
    }
    rows, right = [], []
    for body, pins in acts.items():
        for part in range(3):
            row = [zero] * 14
            for pin, sign in pins.items():
                column, place = 2 * names.index(pin), places[pin]
                row[column], row[column + 1] = (
                    (sign, zero),
                    (zero, sign),
                    (-sign * mpmath.im(place), sign * mpmath.re(place)),
                )[part]
            if body == "crank" and part == 2:
                # O is not the origin: the torque is a couple, N*m in N*mm.
                row[13] = mpmath.mpf(1000)
            rows.append(row)
            right.append(zero)
    for part in range(2):
        row = [zero] * 14
        row[2 * names.index("C") + part] = mpmath.mpf(-1)
        row[12] = mpmath.mpf(1 - part)
        rows.append(row)
        right.append(-F * part)
    x = mpmath.lu_solve(mpmath.matrix(rows), mpmath.matrix(right))
    force = {name: mpmath.mpc(x[2 * k], x[2 * k + 1]) for k, name in enumerate(names)}

    def push(force, along):
        return mpmath.re(force * mpmath.conj(along) / abs(along))

    return {
        "F_3": push(force["coupler"], B - A),
        "F_4": push(force["D"], B),
        "F_5": push(force["C"], B - C),
        "N_guide": x[12],
        "torque": x[13],
    }


def exact(given):
    with mpmath.workdps(50):
        press, zero = Press(given), mpmath.mpf(0)
        g = press.given
        A, B, C = press.A(zero), press.B(zero), press.C(zero)
        v_C = g["omega2"] * mpmath.im(mpmath.diff(press.C, zero))
        return {
            "psi": mpmath.degrees(mpmath.atan2(-mpmath.re(B), mpmath.im(B) - mpmath.im(C))),
            "yC": mpmath.im(C),
            "theta2": mpmath.degrees(mpmath.arg(A - press.O)),
            "theta3": mpmath.degrees(mpmath.arg(B - A)),
            "v_C": v_C,
            "mechanical_advantage": g["r2"] * abs(g["omega2"] / v_C),
            **five_bodies(press),
        }


def errors(found, reference):
    """Relative; of a direction, relative to a turn."""
    size = {n: 360 if n in ("theta2", "theta3") else abs(v) for n, v in reference.items()}
    return {name: abs(float((found[name] - reference[name]) / size[name])) for name in found}


@every_seed
def test_answers_are_those_of_five_bodies_in_fifty_digits(seed):
    variant = EXERCISE.variant(seed)
    answers = variant.solution()
    assert set(answers) == set(ASKED)
    assert max(errors(answers, exact(variant.given)).values()) < 1e-12
    assert answers["v_C"] < 0


@each_row("phi", [1.0, 1e-3, 1e-6, 1e-9, 1e-12])
@each_row("A_side", ["left", "right"])
def test_no_digit_is_lost_where_the_toggle_is_nearly_in_line(phi, A_side):
    given = {**PLAIN, "phi": phi, "A_side": A_side}
    found = EXERCISE.solve(**given, only=(*ASKED, "F_3"), effects=("load",))
    assert max(errors(found, exact(given)).values()) < 5e-13


def test_in_line_the_ram_is_at_rest_and_needs_no_torque():
    straight = {**PLAIN, "phi": 0.0}
    found = EXERCISE.solve(**straight, only=("v_C", "torque", "F_3", "F_4", "F_5"), effects=("load",))
    assert (found["v_C"], found["torque"], found["F_3"]) == (0, 0, 0)
    assert found["F_4"] == pytest.approx(20000)
    with pytest.raises(Undefined, match="ram is at rest"):
        EXERCISE.solve(**straight, only="mechanical_advantage")
    row = EXERCISE.solve(**{**PLAIN, "phi": np.array([0.0, 8.0])}, only="mechanical_advantage")
    assert np.isnan(row["mechanical_advantage"]).tolist() == [True, False]


def test_the_advantage_grows_as_the_toggle_straightens():
    phi = np.array([1e-10, 1e-8, 1e-6])
    found = EXERCISE.solve(**{**PLAIN, "phi": phi}, only="mechanical_advantage")["mechanical_advantage"]
    np.testing.assert_allclose(found * phi, found[0] * phi[0], rtol=1e-6)


@each_row("away", [1.0, 1e-4, 1e-8])
def test_near_a_dead_point_of_the_crank_no_power_is_lost(away):
    """O as far from the knee as crank and coupler reach, but for a little."""
    with mpmath.workdps(30):
        rise = PLAIN["r4"] * mpmath.cos(mpmath.radians(PLAIN["phi"])) + PLAIN["yO"]
        reach = mpmath.mpf(PLAIN["r2"] + PLAIN["r3"] - away)
        xO = float(-PLAIN["r4"] * mpmath.sin(mpmath.radians(PLAIN["phi"])) - mpmath.sqrt(reach**2 - rise**2))
    given = {**PLAIN, "xO": xO}
    found = EXERCISE.solve(**given, only=("torque", "v_C", "theta2", "theta3"), effects=("load",))
    assert found["torque"] * given["omega2"] == pytest.approx(-given["F"] * found["v_C"] / 1000, rel=1e-13)
    reference = exact(given)
    assert errors(found, reference)["torque"] < 1e-13 / away


@every_seed
def test_the_stated_mechanism_bears_the_same_over_a_turn(seed):
    given = dict(EXERCISE.variant(seed).given)
    scene = Scene(EXERCISE, given, ("velocity", "load"), show=("drive_torque", "reaction D", "reaction A"))
    columns = scene.over_cycle(36).columns
    for stated, name in (("drive_torque", "torque"), ("R_D", "F_4"), ("R_A", "F_3")):
        size = abs(columns[name]).max()
        np.testing.assert_allclose(abs(columns[stated]), abs(columns[name]), atol=1e-10 * size)
    np.testing.assert_allclose(columns["drive_torque"], columns["torque"], atol=1e-10 * size)
    assert columns["v_C"].min() < 0 < columns["v_C"].max()


@every_seed
def test_the_crank_turns_the_press_through_one_assembly_with_the_knee_on_the_left(seed):
    given = dict(EXERCISE.variant(seed).given)
    angles = np.linspace(0, 360, 721)
    posed = EXERCISE.solve(**{**given, **EXERCISE.posed(given, angles)}, only=("theta2", "yC", "xB", "v_C"))
    np.testing.assert_allclose(np.cos(np.radians(posed["theta2"] - angles)), 1, atol=1e-12)
    assert (posed["xB"] < 0).all()
    assert abs(np.diff(posed["yC"])).max() < 3 * given["r2"] * np.radians(0.5)


def test_without_a_load_nothing_is_borne():
    found = EXERCISE.solve(**PLAIN, only=FORCES, effects=())
    assert all(value == 0 for value in found.values())
    assert "load" not in EXERCISE.plan(FORCES, effects=())
    assert {"omega4", "v_C"}.isdisjoint(EXERCISE.plan(FORCES, effects=("load",)))


def test_what_does_not_reach_is_refused_alone_and_is_nan_in_a_row():
    with pytest.raises(CannotAssemble, match="does not reach the line of the ram"):
        EXERCISE.solve(**{**PLAIN, "r5": 20.0}, only="psi")
    with pytest.raises(CannotAssemble):
        EXERCISE.solve(**{**PLAIN, "xO": -500.0}, only="theta2")
    row = EXERCISE.solve(**{**PLAIN, "r5": np.array([20.0, 240.0])}, only=ASKED, effects=("load",))
    for name in ("psi", "yC", "v_C", "F_5", "torque"):
        assert np.isnan(row[name]).tolist() == [True, False], name
    row = EXERCISE.solve(**{**PLAIN, "xO": np.array([-500.0, -260.0])}, only=ASKED, effects=("load",))
    for name in ("theta2", "v_C", "torque"):
        assert np.isnan(row[name]).tolist() == [True, False], name


@every_seed
def test_the_other_side_of_A_is_another_crank_on_the_same_knee(seed):
    given = dict(EXERCISE.variant(seed).given)
    wrong = EXERCISE.solution.mistaken("A_other_side").evaluate(ASKED, given, ("load",))
    other = {**given, "A_side": {"left": "right", "right": "left"}[given["A_side"]]}
    assert wrong == pytest.approx(EXERCISE.solution.graph.evaluate(ASKED, other, ("load",)), rel=1e-12)
    assert wrong["F_5"] == EXERCISE.solve(**given, effects=("load",), only="F_5")["F_5"]
