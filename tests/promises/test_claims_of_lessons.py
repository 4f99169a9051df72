"""What a lesson claims in words, a bound, a count or a condition, is what a computation finds."""

from __future__ import annotations

import re
from itertools import product

import numpy as np
import pytest
from tables import each_row

from coursework.course.lessons import lesson_file
from coursework.structure.spatial_chains import Chain, in_series

CLAIMS = []
TURN = np.arange(0.25, 360.0, 0.5)


def claim(lesson, en, fr):
    """Register a check of a sentence; ``en`` and ``fr`` are the words that it would make false."""

    def kept(check):
        CLAIMS.append(pytest.param(lesson, {"en": en, "fr": fr}, check, id=f"{lesson}-{check.__name__}"))
        return check

    return kept


@each_row(("lesson", "said", "check"), CLAIMS)
def test_a_claim_of_a_lesson_is_true(course, lesson, said, check):
    for lang, words in said.items():
        text = re.sub(r"\s+", " ", lesson_file(course.folder, lesson, lang).read_text("utf-8"))
        assert words in text, lang
    check(course)


def changes_of_sign(values):
    return int((np.sign(values) != np.sign(np.roll(values, 1))).sum())


# -- accuracy ----------------------------------------------------------------------------------------------


def corner(gamma):
    """How far along a line its crossing with another may be off, both lines being off by 1."""
    along, normal = np.array([1.0, 0.0]), np.array([0.0, 1.0])
    other = np.array([-np.sin(gamma), np.cos(gamma)])
    corners = [np.linalg.solve([normal, other], shifts) for shifts in product((-1, 1), repeat=2)]
    return max(abs(at @ along) for at in corners)


@claim("accuracy", r"\delta\cot\frac{\gamma}{2}$ along either", r"\delta\cot\frac{\gamma}{2}$ près le long")
def both_lines_count(course):
    for gamma in np.radians([16.0, 40.0, 80.0, 90.0]):
        assert corner(gamma) == pytest.approx(1 / np.tan(gamma / 2))


@claim("accuracy", "off by seven times as much as its lines", "peut atteindre sept fois celle de ses droites")
def at_16_degrees_seven_times(course):
    assert round(corner(np.radians(16.0))) == 7


@claim("accuracy", "exact for a parabola: what it misses begins with the third", "dérivée troisième de")
def the_error_of_a_centred_difference_goes_with_the_square_of_the_step(course):
    bars = {"r1": 100.0, "r2": 50.0, "r3": 70.0, "r4": 80.0, "mode": "open", "omega2": 1.0, "alpha2": 0.0}
    solve = course["four_bar_motion"].solve
    right = solve(**bars, theta2=120.0, only="omega3")["omega3"]

    def error(step):
        before, after = (solve(**bars, theta2=120.0 + s, only="theta3")["theta3"] for s in (-step, step))
        return (after - before) / (2 * step) - right

    assert error(1.0) / error(0.1) == pytest.approx(100, rel=0.01)


@claim("accuracy", "divides by the length $r_A$ instead", "divise, lui, par la longueur $r_A$")
def a_slotted_mechanism_is_ill_conditioned_where_the_block_is_near_the_pivot(course):
    def gain(theta2):
        sizes = {"r1": 100.0, "theta1": 90.0, "r2": 99.0, "omega2": 1.0, "alpha2": 0.0}
        found = course["slotted_mechanism"].solve(**sizes, theta2=theta2, only=("rA", "omega4"))
        return found["rA"], abs(found["omega4"])

    (near, fast), (far, slow) = gain(-90.0), gain(90.0)
    assert near == pytest.approx(1.0)
    assert fast / slow == pytest.approx(far / near)


@claim(
    "accuracy", "added alone to the load, changes the mean", "ajouté seul à la charge, change le couple moyen"
)
def alone_with_the_load_only_friction_changes_the_mean_torque(course):
    load = mean_torque(course, "load")
    assert abs(mean_torque(course, "load", "gravity") - load) < 1e-9
    assert abs(mean_torque(course, "load", "inertia") - load) < 1e-9
    assert mean_torque(course, "load", "friction") > load + 0.1


# -- slider_crank_analysis ---------------------------------------------------------------------------------

ENGINE = {"r2": 60.0, "r3": 180.0, "e": 20.0, "omega2": 10.0, "alpha2": 0.0}


@claim("slider_crank_analysis", "at four crank angles here", "pour quatre angles de la manivelle, ici")
def the_rod_forgotten_in_the_velocity_of_the_piston_does_no_harm_at_four_angles(course):
    speed = course["slider_crank"].solve(**ENGINE, theta2=TURN, only="r1_dot")["r1_dot"]
    assert changes_of_sign(speed + 60 * 10 * np.sin(np.radians(TURN))) == 4


@claim(
    "slider_crank_analysis",
    "A long rod makes the two ends alike",
    "Une bielle longue rend les deux bouts semblables",
)
def the_longer_the_rod_the_more_alike_are_the_accelerations_at_both_ends(course):
    solve = course["slider_crank"].solve
    for r3 in (120.0, 240.0, 2400.0):
        in_line = ENGINE | {"r3": r3, "e": 0.0}
        outer, inner = (solve(**in_line, theta2=at, only="r1_ddot")["r1_ddot"] for at in (0.0, 180.0))
        assert abs(outer) / abs(inner) == pytest.approx((r3 + 60) / (r3 - 60))


# -- mechanical_advantage_and_dead_points ------------------------------------------------------------------

MACHINE = {
    "r2": 60.0,
    "r3": 200.0,
    "e": 0.0,
    "alpha2": 0.0,
    "s3": 0.4,
    "F": -200.0,
    "f": 0.1,
    "m3": 1.2,
    "J3": 0.004,
    "m4": 0.8,
    "J2": 0.002,
}


def mean_torque(course, *effects, omega2=30.0):
    asked = MACHINE | {"omega2": omega2, "theta2": np.arange(0.0, 360.0)}
    return float(
        np.mean(course["slider_crank_torque"].solve(**asked, only="torque", effects=effects)["torque"])
    )


@claim(
    "mechanical_advantage_and_dead_points",
    "*as long as nothing rubs*, never",
    "*tant que rien ne frotte*, jamais",
)
def weights_and_inertia_change_the_mean_torque_by_friction_alone(course):
    everything = ("load", "gravity", "inertia")
    for omega2 in (30.0, 120.0):
        assert abs(mean_torque(course, *everything, omega2=omega2) - mean_torque(course, "load")) < 1e-9
    rubbing = mean_torque(course, "load", "friction")
    assert mean_torque(course, "load", "friction", "inertia", omega2=120.0) > 2 * rubbing
    assert mean_torque(course, "load", "friction", "inertia", omega2=60.0) < rubbing, "less, or more"


@claim(
    "mechanical_advantage_and_dead_points",
    "if Grashof's rule is strictly met",
    "si la loi de Grashof est strictement vérifiée",
)
def coupler_and_rocker_come_into_line_in_a_whole_turn_at_a_change_point_only(course):
    def flattest(**bars):
        found = course["four_bar_motion"].solve(
            **bars, mode="open", omega2=1.0, alpha2=0.0, theta2=180.0 - 1e-6, only=("theta3", "theta4")
        )
        return abs(np.sin(np.radians(found["theta4"] - found["theta3"])))

    assert flattest(r1=100.0, r2=50.0, r3=70.0, r4=80.0) < 1e-6
    assert flattest(r1=100.0, r2=49.0, r3=70.0, r4=80.0) > 0.1


@claim(
    "mechanical_advantage_and_dead_points",
    "never longer than the shorter of $DB$ and $DP$",
    "jamais la plus courte des longueurs $DB$ et $DP$",
)
def the_arm_of_a_jack_is_greatest_where_it_is_perpendicular_to_the_shorter(course):
    DP, DB = abs(45 - 55j), 95.0  # those of the figure
    opened = np.radians(np.linspace(1, 179, 1781))
    jack = np.sqrt(DB**2 + DP**2 - 2 * DB * DP * np.cos(opened))
    arm = DB * DP * np.sin(opened) / jack
    assert arm.max() == pytest.approx(DP, rel=1e-4)
    at = np.argmax(arm)
    assert DP**2 + jack[at] ** 2 == pytest.approx(DB**2, rel=0.01), "a right angle at P"


@claim(
    "mechanical_advantage_and_dead_points",
    "Where both are zero, at a change point",
    "Là où tous deux sont nuls, à un point de changement",
)
def at_a_change_point_the_coupler_is_in_line_with_both_its_neighbours(course):
    bars = {"r1": 100.0, "r2": 50.0, "r3": 70.0, "r4": 80.0, "mode": "open", "omega2": 1.0, "alpha2": 0.0}
    found = course["four_bar_motion"].solve(**bars, theta2=180.0 - 1e-6, only=("theta3", "theta4"))
    for angle in (found["theta4"] - found["theta3"], 180.0 - found["theta3"]):
        assert abs(np.sin(np.radians(angle))) < 1e-6


# -- forces_by_groups, rolling -----------------------------------------------------------------------------


@claim("forces_by_groups", "It may even fall at first", "Il peut même baisser d'abord")
def with_friction_the_mean_torque_falls_and_then_rises_with_the_speed(course):
    slow, faster, fast = (
        mean_torque(course, "load", "friction", "inertia", omega2=omega2) for omega2 in (30.0, 60.0, 120.0)
    )
    assert faster < slow < mean_torque(course, "load", "friction") < fast


@claim(
    "rolling", "larger than the rolling, here alone", "Le pivotement dépasse le roulement, et ici seulement"
)
def the_ball_spins_more_than_it_rolls_on_the_output_shaft_alone(course):
    R, r, x, z = 40.0, 15.0, np.array([1.0, 0.0]), np.array([0.0, 1.0])
    rotations = {"A": (x + z, x), "B": (x + z, z), "C": (x + (1 + 2 * r / R) * z, x)}
    rotations["D"] = x + (1 + 2 * r / (R + r)) * z, z
    spins = {at: abs(turns @ normal) for at, (turns, normal) in rotations.items()}
    rolls = {at: np.sqrt(turns @ turns - spins[at] ** 2) for at, (turns, _) in rotations.items()}
    assert [at for at in spins if spins[at] > rolls[at] + 1e-9] == ["D"]


# -- grashof_and_coupler_curves ----------------------------------------------------------------------------


@claim("grashof_and_coupler_curves", "at least one of the two triangles", "l'un au moins des deux triangles")
def both_triangles_of_a_parallelogram_and_of_a_kite_are_flat(course):
    for r1, r2, r3, r4 in ((100, 50, 100, 50), (100, 50, 50, 100), (100, 50, 70, 80)):
        flat = [AC in (r3 + r4, abs(r3 - r4)) for AC in (r1 + r2, abs(r1 - r2))]
        assert flat.count(True) == (1 if (r1, r2, r3, r4) == (100, 50, 70, 80) else 2)


@claim(
    "grashof_and_coupler_curves",
    "A coupler point of a crank-rocker is taken at $B$",
    "Un point de bielle d'un manivelle-balancier est pris en $B$",
)
def the_end_of_the_coupler_goes_round_a_circle_in_a_double_crank(course):
    def swing(**bars):
        found = course["four_bar_positions"].solve(**bars, theta2=TURN, only="theta4_open")["theta4_open"]
        return np.ptp(np.unwrap(found, period=360))

    assert swing(r1=60.0, r2=140.0, r3=180.0, r4=200.0) > 355
    assert swing(r1=200.0, r2=60.0, r3=180.0, r4=140.0) < 90


# -- chains_of_bodies --------------------------------------------------------------------------------------


@claim(
    "chains_of_bodies",
    "the offsets along $z$ must add up to nothing",
    "la somme des décalages selon $z$ doit être nulle",
)
def a_slider_crank_in_space_asks_for_two_angles_and_one_offset(course):
    def joint(kind, axis, point, between):
        return {"joint": kind, "axis": axis, "normal": axis, "point": point, "between": between}

    z = (0, 0, 1)
    pivots = [joint("revolute", z, (0, 0, 0), (0, 1)), joint("revolute", z, (20, 40, 0), (1, 2))]
    ends = joint("revolute", z, (120, 10, 0), (2, 3)), joint("prismatic", (1, 0, 0), (120, 10, 0), (3, 0))
    plane = Chain([*pivots, *ends], inputs=1, outputs=3)
    assert (plane.m, plane.h) == (1, 3)
    lost = np.eye(6)[[0, 1, 5]]  # the rotations about x and y, the translation along z
    twists = np.array(
        [[*z, *np.cross(p, z)] for p in ((0, 0, 0), (20, 40, 0), (120, 10, 0))] + [[0, 0, 0, 1, 0, 0]]
    )
    assert np.allclose(lost @ twists.T, 0)
    assert np.linalg.matrix_rank(twists) == 3


@claim(
    "chains_of_bodies", "slides along it and turns about it, which makes two", "ce qui fait deux mobilités"
)
def between_an_annular_and_a_cylindrical_joint_of_one_axis_there_are_two_internal_motions(course):
    joints = [
        {"joint": kind, "axis": (1, 0, 0), "normal": (1, 0, 0), "point": (0, 0, 0), "between": (0, 1)}
        for kind in ("annular", "cylindrical")
    ]
    assert in_series(joints).m_internal == 2


# -- mobility_and_groups, several_loops --------------------------------------------------------------------


@claim(
    "mobility_and_groups",
    "unless a loop is made of prismatic joints only",
    "à moins qu'une boucle ne soit faite que de glissières",
)
def two_wedges_have_a_varying_parameter_more_than_moving_bodies(course):
    directions = np.array([[1.0, 0.0], [np.cos(0.4), np.sin(0.4)], [0.0, 1.0]])  # ground, slope, guide
    slides = [
        {"between": ends, "kind": "prismatic", "at": f"S{k}"}
        for k, ends in enumerate(([1, 2], [2, 3], [3, 1]))
    ]
    count = course["mobility"].solve(joints=slides, only=("n", "gamma", "w"))
    assert (count["n"], count["w"]) == (2, 0)
    assert len(directions) - np.linalg.matrix_rank(directions) == 1, "they move"


@claim(
    "several_loops",
    "does have $n = 6$, $\\gamma = 2$ and $w = 2$",
    "a bien $n = 6$, $\\gamma = 2$ et $w = 2$",
)
def a_plate_taken_for_two_bars_passes_the_check_of_unknowns(course):
    def count(*pivots):
        joints = [{"between": list(one), "kind": "revolute", "at": f"J{k}"} for k, one in enumerate(pivots)]
        return course["mobility"].solve(joints=joints, only=("n", "gamma", "w"))

    plate = count((1, 2), (2, 3), (3, 4), (4, 1), (4, 5), (5, 6), (6, 1))
    assert plate == {"n": 5, "gamma": 2, "w": 1}
    two_bars = count((1, 2), (2, 3), (3, 4), (4, 1), (7, 1), (7, 5), (5, 6), (6, 1))
    assert two_bars == {"n": 6, "gamma": 2, "w": 2}
    assert two_bars["n"] - 2 * two_bars["gamma"] == two_bars["w"]


# -- positions ---------------------------------------------------------------------------------------------


@claim("positions", r"The uncertainty of $\num{0.19}°$", r"L'incertitude de $\num{0.19}°$")
def at_a_right_angle_the_direction_of_the_coupler_is_off_by_the_error_of_the_other_radius(course):
    r3, r4, error = 90.0, 70.0, 0.3
    bars = {"r1": float(np.hypot(r3, r4)) + 30, "r2": 30.0, "theta2": 0.0}

    def theta3(longer, wider):
        solve = course["four_bar_positions"].solve
        return solve(**bars, r3=r3 + longer, r4=r4 + wider, only="theta3_open")["theta3_open"]

    off = [abs(theta3(*shifts) - theta3(0, 0)) for shifts in product((-error, error), repeat=2)]
    assert round(max(off), 2) == 0.19


# -- quick_returns -----------------------------------------------------------------------------------------


def offset_ratio(mu):
    """The largest time ratio of offset slider-cranks whose transmission angle stays above ``mu``."""
    reach = np.cos(np.radians(mu))  # (r2 + e) / r3
    r2 = np.linspace(0.01, 0.99, 9801) * reach
    e = reach - r2
    r2, e = r2[e < 1 - r2], e[e < 1 - r2]
    lean = np.degrees(np.arcsin(e / (1 - r2)) - np.arcsin(e / (1 + r2))).max()
    return (180 + lean) / (180 - lean)


@claim("quick_returns", r"$Q$ does not exceed $\num{1.29}$", r"$Q$ ne dépasse pas $\num{1.29}$")
def an_offset_slider_crank_that_transmits_well_returns_no_quicker(course):
    assert round(offset_ratio(40.0), 2) == 1.29


@claim(
    "quick_returns",
    r"down to $30^\circ$ it reaches $\num{1.45}$",
    r"jusqu'à $30^\circ$, il atteint $\num{1.45}$",
)
def an_offset_slider_crank_that_transmits_badly_returns_quicker(course):
    assert round(offset_ratio(30.0), 2) == 1.45


@claim("quick_returns", r"to $\num{1.32}$ with $40^\circ", r"jusqu'à $\num{1.32}$ avec $40^\circ")
def a_crank_rocker_that_transmits_well_returns_no_quicker(course):
    r2, r3, r4 = (
        axis.ravel()
        for axis in np.meshgrid(
            np.linspace(0.05, 0.6, 111), np.linspace(0.2, 1.2, 121), np.linspace(0.6, 1.6, 101)
        )
    )
    bars = np.array([np.ones_like(r2), r2, r3, r4])
    turns = (r2 == bars.min(0)) & (2 * (r2 + bars.max(0)) < bars.sum(0))
    r2, r3, r4 = r2[turns], r3[turns], r4[turns]
    cosines = [(r3**2 + r4**2 - AC**2) / (2 * r3 * r4) for AC in (1 - r2, 1 + r2)]
    well = np.abs(cosines).max(0) <= np.cos(np.radians(40.0))
    r2, r3, r4 = r2[well], r3[well], r4[well]
    at = [np.degrees(np.arccos((1 + OB**2 - r4**2) / (2 * OB))) for OB in (r3 - r2, r3 + r2)]
    apart = abs(at[0] - at[1]).max()
    assert 1.31 < (180 + apart) / (180 - apart) < 1.325


@claim("quick_returns", "if $r_1^2 + r_2^2 = r_3^2 + r_4^2$", "si $r_1^2 + r_2^2 = r_3^2 + r_4^2$")
def a_crank_rocker_whose_squares_agree_takes_equal_times(course):
    turn = np.arange(0.125, 360.0, 0.25)
    for r4, advance in ((np.sqrt(200.0**2 + 60.0**2 - 180.0**2), 180.0), (140.0, 187.75)):
        asked = {
            "r1": 200.0,
            "r2": 60.0,
            "r3": 180.0,
            "r4": r4,
            "omega2": 10.0,
            "alpha2": 0.0,
            "mode": "open",
        }
        speed = course["four_bar_motion"].solve(**asked, theta2=turn, only="omega4")["omega4"]
        assert changes_of_sign(speed) == 2
        longer = max((speed > 0).mean(), (speed < 0).mean())
        assert abs(360 * longer - advance) < 0.3


@claim(
    "quick_returns",
    "over more than half of it the speed stays within a tenth",
    "sur plus de la moitié, sa vitesse reste à moins d'un dixième",
)
def the_ram_of_the_shaper_is_nearly_as_fast_as_ever_over_half_of_its_working_stroke(course):
    machine = {"r1": 210.0, "r2": 105.0, "r4": 420.0, "r5": 165.0, "h": 450.0, "omega2": 9.42}
    speed = course["quick_return_shaper"].solve(**machine, theta2=TURN, only="v_C")["v_C"]
    working = -speed[speed < 0]
    assert working[working > 0.9 * working.max()].sum() > working.sum() / 2


# -- slider_crank_analysis, the six-bar linkage ------------------------------------------------------------


@claim(
    "slider_crank_analysis",
    "With an offset both ends are still at $r_3 + r_2$",
    "les deux bouts sont toujours à $r_3 + r_2$",
)
def the_ends_of_the_stroke_are_as_far_from_the_crank_s_pivot_with_an_offset(course):
    r1 = course["slider_crank"].solve(**ENGINE, theta2=np.linspace(0, 360, 36001), only="r1")["r1"]
    assert np.hypot(r1.max(), 20.0) == pytest.approx(240, abs=1e-4)
    assert np.hypot(r1.min(), 20.0) == pytest.approx(120, abs=1e-4)


@claim(
    "slider_crank_analysis", "the two roots $r_6$ are then one", "les deux racines $r_6$ se confondent alors"
)
def a_rod_shorter_than_the_rocker_comes_upright(course):
    r4, r5 = 130.0, 100.0
    theta4 = np.arcsin(r5 / r4)
    roots = np.roots([1, -2 * r4 * np.cos(theta4), r4**2 - r5**2])
    assert np.ptp(roots.real) < 1e-3
    assert r4 * np.cos(theta4) == pytest.approx(roots[0].real), "B is straight above P"


# -- conditions, bounds and counts of other lessons --------------------------------------------------------


@claim(
    "accelerations",
    "If it outweighs $s$, as in a quick lift",
    "S'il l'emporte sur $s$, comme dans une levée rapide",
)
def a_cam_is_most_curved_at_its_top_in_a_quick_lift_alone(course):
    u = np.linspace(0, 1, 2001)
    lift, second = u - np.sin(2 * np.pi * u) / (2 * np.pi), 2 * np.pi * np.sin(2 * np.pi * u)  # cycloidal
    for beta, at_the_top in ((np.radians(90), True), (np.radians(180), False)):
        curved = lift + second / beta**2  # less than 0: more than the base circle is
        assert (second[curved.argmin()] < 0 and curved.min() < 0) == at_the_top


@claim("positions", "where $A$ comes to lie on $C$", "si $A$ y vient sur $C$")
def the_circles_of_a_folded_kite_coincide(course):
    kite = {"r1": 100.0, "r2": 100.0, "r3": 70.0, "r4": 70.0, "theta2": 0.0}
    found = course["four_bar_positions"].solve(**kite, only=("a", "b", "c"))
    assert list(found.values()) == [0, 0, 0], "any direction of the coupler"


@claim(
    "grashof_and_coupler_curves",
    "the velocity along the line varies by no more than an eighth",
    "la vitesse le long de la droite ne varie pas de plus d'un huitième",
)
def the_pusher_of_hoecken_is_nearly_straight_and_nearly_uniform(course):
    theta2 = np.linspace(80, 280, 2001)
    bars = {"r1": 2.0, "r2": 1.0, "r3": 2.5, "r4": 2.5}
    theta3 = course["four_bar_positions"].solve(**bars, theta2=theta2, only="theta3_open")["theta3_open"]
    P = np.exp(1j * np.radians(theta2)) + 5 * np.exp(1j * np.radians(theta3))
    assert np.ptp(P.imag) < 0.0101
    assert np.ptp(P.real) > 4
    speed = abs(np.gradient(P.real, theta2))[(theta2 >= 105) & (theta2 <= 255)]
    assert np.ptp(speed) / speed.max() < 1 / 8


@claim("real_machines_levers", "No other lengths help", "Aucune autre longueur n'y remédie")
def with_equal_times_the_least_transmission_angle_is_bounded_by_the_swing(course):
    half = np.radians(55.0)
    for r4, r1 in product(np.linspace(20, 80, 13), np.linspace(60, 900, 29)):
        r2 = r4 * np.sin(half)
        if r1 <= r4:
            continue
        r3 = np.sqrt(r1**2 + r2**2 - r4**2)
        least = np.degrees(np.arccos((r3**2 + r4**2 - (r1 - r2) ** 2) / (2 * r3 * r4)))
        assert least < 35.0


@claim(
    "real_machines_strokes", r"$\lambda/(1 - \lambda) = \num{6.5}$", r"$\lambda/(1 - \lambda) = \num{6.5}$"
)
def a_cross_of_three_slots_is_driven_for_a_sixth_of_the_turn_and_fast(course):
    ratio = np.sin(np.radians(60.0))
    theta = np.linspace(-90, 90, 180001)
    psi = np.degrees(np.arctan2(ratio * np.sin(np.radians(theta)), 1 - ratio * np.cos(np.radians(theta))))
    rates = np.gradient(psi, theta)
    assert round(rates.max(), 1) == 6.5
    assert (rates > 0).mean() * 180 == pytest.approx(60, abs=0.1), (
        "the slot is tangent to the circle at both ends"
    )


@claim(
    "chains_of_bodies", "In the place of the prismatic joint it does not", "À la place de la glissière, non"
)
def a_slider_crank_in_space_becomes_isostatic_by_the_right_joints_alone(course):
    def counted(*kinds):
        places = ((0, 0, 0), (30, 40, 0), (120, 0, 0), (120, 0, 0))
        axes = ((0, 0, 1),) * 3 + ((1, 0, 0),)
        joints = [
            {"joint": kind, "axis": axis, "normal": axis, "point": place, "between": (k, (k + 1) % 4)}
            for k, (kind, axis, place) in enumerate(zip(kinds, axes, places, strict=True))
        ]
        chain = Chain(joints, inputs=1, outputs=3)
        return chain.m, chain.h

    assert counted("revolute", "revolute", "revolute", "prismatic") == (1, 3)
    assert counted("revolute", "revolute", "spherical", "prismatic") == (1, 1)
    assert counted("revolute", "cylindrical", "spherical", "prismatic") == (1, 0)
    assert counted("revolute", "revolute", "spherical", "cylindrical") == (2, 1)


@claim("rolling", "is a multiple of 3, so if $z_s$ is.", "est un multiple de 3, donc si $z_p$ en est un")
def three_planets_fit_at_equal_angles_where_the_teeth_of_sun_and_ring_add_up_to_a_multiple_of_3(course):
    def fits(sun, ring):
        """A planet that goes to the next place meets the teeth of both wheels as the one before did."""
        turned = 360 / 3 * (1 + ring / sun)  # of the sun while the carrier makes a third of a turn
        return abs(turned / (360 / sun) - round(turned / (360 / sun))) < 1e-9

    assert [fits(sun, 3 * sun) for sun in (18, 20, 21, 22)] == [True, False, True, False]
