"""Four-bar positions, against fifty digits, at dead points, and against the misprints of the notes."""

import mpmath
import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.errors import CannotAssemble, Undefined
from coursework.kinematics.margins import exact_sum, grashof_margins

EXERCISE = coursework.open_course()["four_bar_positions"]
MODES = ("open", "crossed")


def exact(given):
    """The linkage in fifty digits: B from the angle at A, on either side of AC, checked to close."""
    with mpmath.workdps(50):
        r1, r2, r3, r4, theta2 = (mpmath.mpf(given[n]) for n in ("r1", "r2", "r3", "r4", "theta2"))
        crank = r2 * mpmath.expjpi(theta2 / 180)
        line = r1 - crank
        at_A = mpmath.acos((r3**2 + abs(line) ** 2 - r4**2) / (2 * r3 * abs(line)))
        found = {}
        for mode, side in zip(MODES, (1, -1), strict=True):
            coupler = r3 * line / abs(line) * mpmath.expj(side * at_A)
            rocker = crank + coupler - r1
            assert abs(abs(rocker) - r4) < mpmath.mpf("1e-45")
            found[f"theta3_{mode}"] = mpmath.degrees(mpmath.arg(coupler))
            found[f"theta4_{mode}"] = mpmath.degrees(mpmath.arg(rocker))
        found["mu"] = mpmath.degrees(abs(mpmath.arg(coupler / rocker)))
        found["a"] = 2 * r3 * (mpmath.re(crank) - r1)
        found["b"] = 2 * r3 * mpmath.im(crank)
        found["c"] = r4**2 - r3**2 - abs(line) ** 2
        return found


def off(value, reference, is_angle):
    difference = mpmath.mpf(float(value)) - reference
    if is_angle:
        return float(abs(difference - 360 * mpmath.nint(difference / 360)) / 180)
    return float(abs(difference) / abs(reference))


@each_row("seed", range(10))
def test_answers_are_those_of_the_loop_equations_in_fifty_digits(seed):
    variant = EXERCISE.variant(seed)
    answers = variant.solution()
    for name, reference in exact(variant.given).items():
        assert off(answers[name], reference, name.startswith("theta")) < 1e-14, name


@each_row("short", [1e-2, 1e-6, 1e-9, 1e-12])
def test_nothing_is_lost_near_a_dead_point(short):
    """Crank-rocker stretched out at theta2 = 180: its lengths leave only ``short`` to spare."""
    given = {"r1": 100.0, "r2": 50.0, "r3": 70.0, "r4": 80.0 + short, "theta2": 180.0}
    answers = EXERCISE.solve(**given)
    for name, reference in exact(given).items():
        if name != "b":
            assert off(answers[name], reference, name.startswith("theta")) < 2e-15, name


def test_coupler_and_rocker_in_line_at_a_change_point():
    given = {"r1": 100.0, "r2": 50.0, "r3": 70.0, "r4": 80.0}
    at_it = EXERCISE.solve(**given, theta2=180.0)
    assert at_it["mu"] == 180.0
    assert at_it["theta3_open"] == at_it["theta3_crossed"] == 0.0
    assert EXERCISE.solve(**given, theta2=179.9999999)["mu"] < 180.0


def test_two_equal_assemblies_are_told_apart_beside_a_kite_s_fold():
    """r1 = r2 and theta2 near 0: A is near C and the coupler's direction still follows the crank's half."""
    for theta2 in (1e-3, 1e-7):
        answers = EXERCISE.solve(r1=100.0, r2=100.0, r3=60.0, r4=60.0, theta2=theta2)
        # The triangle ABC is isosceles, its axis square to AC, which is at 90 + theta2 / 2 from C to A.
        assert answers["theta3_open"] == pytest.approx(theta2 / 2 - answers["mu"] / 2, abs=1e-12)
        half = np.radians(answers["mu"]) / 2
        assert np.sin(half) == pytest.approx(100 / 60 * np.sin(np.radians(theta2) / 2), rel=1e-13)


def test_a_on_c_leaves_the_coupler_undetermined():
    kite = {"r1": 100.0, "r2": 100.0, "r3": 60.0, "r4": 60.0, "theta2": 0.0}
    with pytest.raises(Undefined, match="far pins coincide"):
        EXERCISE.solve(**kite, only="theta3_open")
    assert EXERCISE.solve(**kite, only="mu")["mu"] == 0.0


def test_what_does_not_close_is_refused_alone_and_is_nan_in_a_row():
    given = {"r1": 200.0, "r2": 100.0, "r3": 80.0, "r4": 90.0}
    with pytest.raises(CannotAssemble):
        EXERCISE.solve(**given, theta2=180.0)
    row = EXERCISE.solve(**given, theta2=np.array([0.0, 180.0]))
    for name in ("theta3_open", "theta4_crossed", "mu"):
        assert np.isnan(row[name]).tolist() == [False, True], name
    assert np.isfinite(row["c"]).all()


def test_b_is_zero_when_the_crank_lies_along_the_frame():
    """The notes say that a, b and c are never zero."""
    answers = EXERCISE.solve(r1=100.0, r2=40.0, r3=60.0, r4=60.0, theta2=np.array([0.0, 180.0]), only="b")
    assert answers["b"].tolist() == [0.0, 0.0]


@each_row("seed", range(10))
def test_the_notes_sign_of_r1_squared_moves_every_position(seed):
    given = {name: np.array([value]) for name, value in EXERCISE.variant(seed).given.items()}
    right = EXERCISE.solution.graph.evaluate(("c", "theta3_open"), given)
    wrong = EXERCISE.solution.mistaken("notes_c_sign").evaluate(("c", "theta3_open"), given)
    assert wrong["c"] - right["c"] == pytest.approx(2 * given["r1"] ** 2)
    assert not abs(wrong["theta3_open"] - right["theta3_open"]) < 2  # it may not close at all


@each_row(
    ("lengths", "kind"),
    [
        ((250, 60, 80, 90), "impossible"),
        ((230, 60, 80, 90), "impossible"),
        ((200, 60, 80, 90), "triple-rocker"),
        ((0.6, 0.1, 0.3, 0.4), "change-point"),
        ((0.7, 0.1, 0.6, 0.2), "change-point"),
        ((100, 100, 100, 100), "change-point"),
        ((120, 40, 100, 90), "crank-rocker"),
        ((100, 120, 90, 40), "rocker-crank"),
        ((40, 120, 90, 100), "double-crank"),
        ((120, 90, 40, 100), "double-rocker"),
    ],
)
def test_linkage_type_is_decided_on_the_printed_lengths(lengths, kind):
    given = dict(zip(("r1", "r2", "r3", "r4"), map(float, lengths), strict=True))
    assert EXERCISE.solve(**given, only="linkage_type")["linkage_type"] == kind
    row = {name: np.array([value]) for name, value in given.items()}
    assert EXERCISE.solve(**row, only="linkage_type")["linkage_type"].tolist() == [kind]


def test_several_types_of_linkage_are_drawn():
    types = {v.solution()["linkage_type"] for v in EXERCISE.variants(range(200))}
    assert types == set(EXERCISE.spec.part("linkage_type").choices)


def test_exact_sum_loses_nothing_to_cancellation_in_arrays():
    terms = (1e16, 1.0, -1e16, 1e-8)
    assert exact_sum(*terms) == 1.00000001
    assert exact_sum(*[np.array([t, 2 * t]) for t in terms]).tolist() == [1.00000001, 2.00000002]


def test_margins_are_zero_only_where_the_bars_line_up():
    assert grashof_margins(100.0, 50.0, 70.0, 80.0)[0] == 0.0
    stretched, folded = grashof_margins(np.array([100.0, 60.0]), 50.0, 70.0, np.array([80.0 + 1e-13, 60.0]))
    assert stretched[0] == pytest.approx(300 * (80.0 + 1e-13 - 80.0), rel=1e-12)
    assert folded[1] == 0.0


def test_a_linkage_that_just_cannot_close_is_impossible_in_every_order_of_its_bars(course):
    """l = s + p + q on the printed decimals, whose doubles do not add up."""
    import itertools

    solve = course["four_bar_positions"].solve
    for lengths in ((0.1, 0.2, 0.3, 0.6), (8.93, 9.8, 28.61, 9.88), (0.7, 0.1, 0.1, 0.5)):
        for order in itertools.permutations(lengths):
            given = dict(zip(("r1", "r2", "r3", "r4"), order, strict=True))
            assert solve(**given, only="linkage_type") == {"linkage_type": "impossible"}


def test_coupler_and_rocker_far_shorter_than_crank_and_frame_keep_their_digits():
    """A is near C; the margin (r3 + r4)^2 - AC^2 is then no difference of squares of long bars."""
    given = {"r1": 100.0, "r2": 100.0, "r3": 3e-5, "r4": 2e-5, "theta2": 2e-5}
    answers = EXERCISE.solve(**given)
    for name, reference in exact(given).items():
        assert off(answers[name], reference, name.startswith("theta")) < 1e-14, name


def test_a_students_own_coefficients_count():
    given = EXERCISE.variant(3).given
    right = EXERCISE.solve(**given, only=("c", "psi", "theta3_open"))
    own = EXERCISE.solve(**given, c=1.01 * right["c"], only=("psi", "theta3_open"))
    assert own["psi"] != right["psi"]
    assert own["theta3_open"] - right["theta3_open"] == pytest.approx(right["psi"] - own["psi"], abs=1e-9)


def test_one_answer_that_fits_the_other_assembly_by_chance_exchanges_nothing(course):
    """Of four answers one is right in its box: had the groups been exchanged, another would fit instead and
    none more."""
    variant = course["four_bar_positions"].variant(3, "en")
    right = {part.id: variant.solution()[part.quantity] for part in variant.parts}
    pairs = variant.exercise.spec.either_order
    boxes = [box for group in pairs for box in group]
    far = {box: f"{right[box] + 37:.1f}" for box in boxes}
    for mine, its in ((pairs[0], pairs[1]), (pairs[1], pairs[0])):
        marking = variant.grade({**far, mine[0]: f"{right[its[0]]:.2f}"})
        assert not any(marking[box].in_other_order for box in boxes)
        assert marking[mine[0]].verdict != "correct"
        exchanged = {mine[0]: right[its[0]], mine[1]: right[its[1]], its[0]: right[mine[0]]}
        marking = variant.grade({**far, **{box: f"{value:.2f}" for box, value in exchanged.items()}})
        assert all(marking[box].verdict == "correct" for box in exchanged)
