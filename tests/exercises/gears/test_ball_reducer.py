"""Ball reducer: answers against exact fractions from the no-slip velocities in space, and the notes'
misprints."""

from fractions import Fraction
from functools import cache

import mpmath
import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.figures import contact, line, point, trace, wheel
from coursework.scenes.animation import Animation

EXERCISE = coursework.open_course()["ball_reducer"]
MOTIONS = ("30", "31", "32")
ALL = tuple(part.quantity for part in EXERCISE.judged_parts)
GIVEN = {"R": 60.0, "r": 20.0, "psi_dot": -80.0, "psi_ddot": -40.0}


def cross(u, v):
    return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]


def no_slip(R, r, psi_dot, wx, wy, wz, phi_dot, theta_dot):
    """The twelve components of the four slips, the ball's rotation vector left general."""
    ball, O3 = [wx, wy, wz], [R + r, 0, 0]
    velocity_of_O3 = cross([0, 0, phi_dot], O3)
    contacts = ((r, 0, 0, 0), (0, 0, -r, 0), (-r, 0, 0, psi_dot), (0, 0, r, theta_dot))
    slips = []
    for x, y, z, rate in contacts:
        place = [O3[0] + x, O3[1] + y, O3[2] + z]
        carried, held = cross(ball, [x, y, z]), cross([0, 0, rate], place)
        slips += [v + c - h for v, c, h in zip(velocity_of_O3, carried, held, strict=True)]
    return slips


def exact(given):
    """The rates as fifty-digit numbers: the only ones that stop all four slips, found by linear algebra."""
    with mpmath.workdps(50):
        R, r, psi_dot, psi_ddot = (mpmath.mpf(given[n]) for n in ("R", "r", "psi_dot", "psi_ddot"))

        def rates(psi_rate):
            at_rest = mpmath.matrix(no_slip(R, r, psi_rate, 0, 0, 0, 0, 0))
            columns = [
                mpmath.matrix(no_slip(R, r, psi_rate, *[int(i == k) for i in range(5)])) - at_rest
                for k in range(5)
            ]
            system = mpmath.matrix([[column[i] for column in columns] for i in range(12)])
            found = mpmath.lu_solve(system, -at_rest)
            assert mpmath.norm(system * found + at_rest) < mpmath.mpf("1e-40")
            return found

        wx, wy, wz, phi_dot, theta_dot = rates(psi_dot)
        phi_ddot = rates(psi_ddot)[3]
        assert abs(wy) < 1e-40
        assert abs(wx - wz) < 1e-40
        place = R + r
        return {
            "omega": wx,
            "phi_dot": phi_dot,
            "theta_dot": theta_dot,
            "rho": theta_dot / psi_dot,
            "v_O3": place * phi_dot,
            "a_O3_x": -place * phi_dot**2,
            "a_O3_y": place * phi_ddot,
            "rolling_D": wx,
            "spin_D": wz - theta_dot,
        }


@each_row("seed", range(10))
def test_answers_are_those_of_the_no_slip_velocities_in_fifty_digits(seed):
    variant = EXERCISE.variant(seed, parts=["all"])
    answers = variant.solution()
    for name, reference in exact(variant.given).items():
        assert abs(mpmath.mpf(float(answers[name])) - reference) < 1e-14 * abs(reference), name


def test_three_independent_conditions_on_four_rates_leave_one_mobility():
    rates = ("psi_dot", "wx", "phi_dot", "theta_dot")

    def slips(psi_dot, wx, phi_dot, theta_dot):
        return no_slip(60, 20, psi_dot, wx, 0, wx, phi_dot, theta_dot)

    columns = [slips(**{n: int(n == name) for n in rates}) for name in rates]
    assert (
        len(rates) - np.linalg.matrix_rank(np.array(columns))
        == EXERCISE.solve(**GIVEN, only=ALL)["mobility"]
        == 1
    )


@each_row("seed", range(10))
def test_the_three_central_axes_and_z_meet_below_the_ball(seed):
    variant = EXERCISE.variant(seed, parts=["all"])
    answers = variant.solution()
    R, r = variant.given["R"], variant.given["r"]
    meeting = np.array([0.0, 0.0, -(R + 2 * r)])
    for motion in MOTIONS:
        place, way = answers[f"axis_{motion}_point"], answers[f"axis_{motion}_dir"]
        off = np.linalg.norm(np.cross(meeting - place, way)) / np.linalg.norm(way)
        assert off < 1e-13 * (R + 2 * r), motion


def test_the_axes_run_along_the_directions_of_the_notes():
    answers = EXERCISE.solve(**GIVEN, only=ALL)
    for motion, rise in zip(MOTIONS, (1, 1 + Fraction(2 * 20, 60), 1 + Fraction(2 * 20, 80)), strict=True):
        assert answers[f"axis_{motion}_dir"] == pytest.approx([1, 0, float(rise)], rel=1e-15)


def test_the_ball_turns_about_its_axes_without_moving_along_them():
    """At any point of a central axis the velocity is zero: a rotation, not a helical motion."""
    answers = EXERCISE.solve(**GIVEN, only=ALL)
    O3 = np.array([80.0, 0.0, 0.0])
    ball = answers["omega"] * np.array([1.0, 0.0, 1.0])
    shafts = {"30": 0.0, "31": GIVEN["psi_dot"], "32": answers["theta_dot"]}
    for motion, rate in shafts.items():
        for far in (0.0, 1.0, -37.0):
            place = answers[f"axis_{motion}_point"] + far * answers[f"axis_{motion}_dir"]
            velocity = np.cross(ball, place - O3) - np.cross([0, 0, rate], place)
            velocity[1] += answers["v_O3"]
            assert abs(velocity).max() < 1e-11
        assert answers[f"nature_{motion}"] == "rotation"


def test_any_point_of_an_axis_and_any_multiple_of_its_direction_is_right():
    variant = EXERCISE.variant(3, parts=["all"])
    answers = variant.solution()
    for motion in MOTIONS:
        place, way = answers[f"axis_{motion}_point"], answers[f"axis_{motion}_dir"]
        told = {
            f"axis_{motion}_point": " ; ".join(map(repr, (place - 25.0 * way).tolist())),
            f"axis_{motion}_dir": " ; ".join(map(repr, (-3.0 * way).tolist())),
        }
        marks = variant.grade(told)
        assert [marks[part].verdict for part in told] == ["correct", "correct"]


@each_row(
    ("part", "text", "verdict"),
    [
        ("no_slip_A", "(R+r)*phi_dot = -r*omega", "correct"),
        ("no_slip_C", "R*psi_dot = (R+r)*phi_dot - r*omega", "correct"),
        ("no_slip_D", "theta_dot*(R+r) = (R+r)*phi_dot - r*omega", "correct"),
        ("no_slip_A", "(R+r)*phi_dot = r*omega", "mistake:omega_sign"),
        ("no_slip_D", "R*theta_dot = (R+r)*phi_dot - r*omega", "mistake:D_at_radius_R"),
        ("no_slip_A", "R*phi_dot + r*omega = 0", "wrong"),
    ],
)
def test_no_slip_equations_are_judged_as_equations(part, text, verdict):
    assert EXERCISE.variant(0, parts=["all"]).grade({part: text})[part].verdict == verdict


def test_no_slip_equations_hold_for_the_answers():
    from coursework.parsing.equations import parse_equation

    variant = EXERCISE.variant(0, parts=["all"])
    answers = variant.solution()
    symbols = EXERCISE.spec.part("no_slip_A").variables
    values = {n: variant.given.get(n, answers.get(n)) for n in symbols}
    for place in "ABCD":
        equation = parse_equation(answers[f"no_slip_{place}"], symbols)
        assert abs(equation.difference(values)) < 1e-9


def test_misprints_of_the_notes_move_what_they_touch():
    right = EXERCISE.solve(**GIVEN, only=ALL)

    def mistaken(name, quantity):
        return EXERCISE.solution.mistaken(name).evaluate((quantity,), GIVEN)[quantity]

    # The circle of O3 has radius R + r = 80, not R = 60; phi_ddot = -15 is not phi_dot = -30.
    assert (right["v_O3"], mistaken("radius_R", "v_O3")) == (-2400, -1800)
    assert (right["a_O3_x"], mistaken("radius_R", "a_O3_x")) == (-72000, -54000)
    assert (right["a_O3_y"], mistaken("notes_phi_dot_for_ddot", "a_O3_y")) == (-1200, -2400)


def test_the_condition_at_B_is_the_one_at_A_and_no_other():
    variant = EXERCISE.variant(0, parts=["all"])
    right = {
        place: EXERCISE.solution.graph.evaluate((f"no_slip_{place}",), {})[f"no_slip_{place}"]
        for place in "ABCD"
    }
    verdicts = {p: variant.grade({"no_slip_B": text})["no_slip_B"].verdict for p, text in right.items()}
    assert {p for p, verdict in verdicts.items() if verdict == "correct"} == {"A", "B"}


@each_row(
    ("answer", "verdict", "points"),
    [
        ("S0-S1 pivot, S0-S2 pivot, S0-S3 ponctuelle ×2, S1-S3 ponctuelle, S2-S3 ponctuelle", "correct", 2),
        (
            "0/1 R; 0/2 R; 3/0 contact en A; 3/0 contact en B; 3/1 contact en C; 3/2 contact en D",
            "correct",
            2,
        ),
        ("bâti-1 pivot, bâti-2 pivot, 3-bâti RSG, 3-bâti RSG, 3-1 RSG, 3-2 RSG", "correct", 2),
        (
            "0-1 pivot, 0-2 pivot, 0-3 ponctuelle, 1-3 ponctuelle, 2-3 ponctuelle",
            "mistake:contacts_with_the_frame_as_one",
            2 * 5 / 6,
        ),
        (
            "0-1 pivot, 1-2 pivot, 0-3 ponctuelle, 0-3 ponctuelle, 1-3 ponctuelle, 2-3 ponctuelle",
            "mistake:shafts_on_one_another",
            2 * 4 / 6,
        ),
        (
            "0-1 pivot, 0-2 pivot, 0-3 rotule, 0-3 ponctuelle, 1-3 ponctuelle, 2-3 ponctuelle",
            "partial",
            2 * 5.5 / 6,
        ),
    ],
)
def test_the_joint_graph_has_two_contacts_of_ball_and_frame(answer, verdict, points):
    mark = EXERCISE.variant(0, "fr", ["all"]).grade({"graph": answer})["graph"]
    assert (mark.verdict, mark.points) == (verdict, pytest.approx(points))


# ------------------------------------------------------------------------ film
#
# What follows is read from the drawn elements: where a body is, its marks say.


@cache
def drawn(seed, count=360):
    """The film of a variant in time: the driver's angles, the elements at each instant, the places of A_3."""
    film = Animation(EXERCISE.variant(seed), count=count)
    order = list(film.order)
    return film.angles[order], [film.frames[k] for k in order], film.points["A_3"].position[order]


def named(elements, kind, label):
    (found,) = [e for e in elements if type(e) is kind and e.label == label]
    return found


def places(frames, kind, label):
    return np.array([named(elements, kind, label).p for elements in frames])


def shaft_angles(frames, label):
    """How far a shaft has turned since the start, by its marked spoke, radians."""
    spokes = np.array([named(elements, line, label).q for elements in frames])
    return np.unwrap(np.angle(spokes / spokes[0]))


def space(z):
    return np.stack([z.real, z.imag, 0 * z.real], axis=-1)


def ball_attitudes(frames, A_3):
    """The rotation of the ball since the start, 3 by 3 matrices: from its seam, whose upper half is drawn,
    and from A_3, which lies on it."""
    found = []
    for elements, mark in zip(frames, A_3, strict=True):
        ball = max((e for e in elements if type(e) is wheel), key=lambda e: abs(e.center))
        (seam,) = [e for e in elements if type(e) is trace]
        *_, ways = np.linalg.svd(np.array([raised(z - ball.center, ball.radius)[0] for z in seam.points]))
        normal = ways[2]  # of a great circle, which has two: the one nearest to that just before
        if found:
            normal = normal * np.sign(normal @ found[-1][0])
        # A_3 is on the upper half of the ball or on the lower one.
        place = min(raised(mark - ball.center, ball.radius), key=lambda way: abs(way @ normal))
        assert abs(place @ normal) < 1e-6
        found.append([normal, place, np.cross(normal, place)])
    axes = np.swapaxes(np.array(found), 1, 2)
    return axes @ np.linalg.inv(axes[0])


def raised(flat, radius):
    """Unit vectors from the centre of a ball to the two points of it that are seen at one place."""
    up = np.sqrt(max(radius**2 - abs(flat) ** 2, 0.0))
    return [np.array([flat.real, flat.imag, z]) / radius for z in (up, -up)]


def turned_between(attitudes):
    """The rotation vector from each attitude to the next, at the attitudes' own middle, radians."""
    steps = attitudes[1:] @ np.linalg.inv(attitudes[:-1])
    skew = (steps - np.swapaxes(steps, 1, 2)) / 2
    vector = np.stack([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]], axis=-1)
    sine = np.linalg.norm(vector, axis=-1, keepdims=True)
    return vector * np.arcsin(sine) / sine


# The input turns one way, the other way.
FILMS = pytest.mark.parametrize("seed", [1, pytest.param(3, marks=pytest.mark.slow)])


@FILMS
@pytest.mark.e2e
def test_in_the_film_the_drawn_ball_slips_at_none_of_its_four_contacts(seed):
    _, frames, A_3 = drawn(seed)
    given = EXERCISE.variant(seed).given
    R, r = given["R"], given["r"]
    O3 = places(frames, point, "O_3")
    moved, rolled = space(np.diff(O3)), turned_between(ball_attitudes(frames, A_3))
    middle = (O3[1:] + O3[:-1]) / 2
    out = space(middle / abs(middle))
    up = np.array([0.0, 0.0, 1.0])
    shafts = {label: np.diff(shaft_angles(frames, label)) for label in ("S_1", "S_2")}
    contacts = (
        (r * out, np.zeros(len(moved))),
        (-r * up, np.zeros(len(moved))),
        (-r * out, shafts["S_1"]),
        (r * up, shafts["S_2"]),
    )
    step = R * abs(shafts["S_1"]).max()
    for across, turned in contacts:
        place = space(middle) + across
        slip = (
            moved
            + np.cross(rolled, np.broadcast_to(across, moved.shape))
            - turned[:, None] * np.cross(up, place)
        )
        assert np.linalg.norm(slip, axis=-1).max() < 1e-4 * step


@FILMS
@pytest.mark.e2e
def test_in_the_film_contacts_run_equal_arcs_on_the_two_bodies_that_roll(seed):
    _, frames, A_3 = drawn(seed)
    R, r = (EXERCISE.variant(seed).given[n] for n in ("R", "r"))
    O3, attitudes = places(frames, point, "O_3"), ball_attitudes(frames, A_3)

    def run(way):
        return (
            abs(np.diff(way)).sum() if way.ndim == 1 else np.linalg.norm(np.diff(way, axis=0), axis=-1).sum()
        )

    def on_the_ball(z):
        return np.einsum("nji,nj->ni", attitudes, space(z - O3))

    A, C = places(frames, contact, "A"), places(frames, contact, "C")
    assert abs(A) == pytest.approx(np.full(len(A), R + 2 * r))
    assert abs(C) == pytest.approx(np.full(len(C), R))
    on_the_shaft = C * np.exp(-1j * shaft_angles(frames, "S_1"))
    assert run(on_the_ball(A)) == pytest.approx(run(A), rel=1e-3)
    assert run(on_the_ball(C)) == pytest.approx(run(on_the_shaft), rel=1e-3)
    assert run(A) == pytest.approx(2 * np.pi * (R + 2 * r), rel=1e-3)


@FILMS
def test_the_film_shows_one_round_of_the_ball_by_the_exact_ratios(seed):
    angles, frames, _ = drawn(seed, count=72)
    variant = EXERCISE.variant(seed, parts=["all"])
    rates, R, r = exact(variant.given), variant.given["R"], variant.given["r"]
    O3 = places(frames, point, "O_3")
    assert abs(O3) == pytest.approx(np.full(len(O3), R + r))
    phi, theta = np.degrees(np.unwrap(np.angle(O3))), np.degrees(shaft_angles(frames, "S_2"))
    assert np.degrees(shaft_angles(frames, "S_1")) == pytest.approx(angles)
    for turns in (1, 2):
        (k,) = np.flatnonzero(abs(angles) == 360 * turns)
        assert phi[k] == pytest.approx(float(angles[k] * rates["phi_dot"] / variant.given["psi_dot"]))
        assert theta[k] == pytest.approx(float(angles[k] * rates["theta_dot"] / variant.given["psi_dot"]))
    way = np.sign(variant.given["psi_dot"])
    assert (phi[-1], theta[-1]) == pytest.approx((360 * way, 720 * way))


@FILMS
def test_the_point_of_the_ball_that_touches_the_frame_is_then_at_rest(seed):
    _, frames, A_3 = drawn(seed)
    A = places(frames, contact, "A")
    assert A_3[0] == pytest.approx(A[0])
    steps = abs(np.gradient(A_3))
    touching = np.flatnonzero(abs(A_3 - A) < 0.02 * abs(A[0]))
    assert len(touching) > 3
    assert steps[touching].max() < 0.2 * steps.max()


@FILMS
def test_velocities_and_accelerations_in_the_film_are_differences_over_time(seed):
    variant = EXERCISE.variant(seed, parts=["all"])
    psi_dot, psi_ddot = variant.given["psi_dot"], variant.given["psi_ddot"]
    graph = EXERCISE.solution.graph.with_functions({"motion": EXERCISE.solution.motion})
    h, angles = 1e-5, np.arange(0.0, 900.0, 15.0)

    def after(t):
        psi = angles + np.degrees(psi_dot * t + psi_ddot * t**2 / 2)
        return graph.evaluate(("motion",), {**variant.used, "psi": psi})["motion"]

    before, now, later = after(-h), after(0.0), after(h)
    assert {n for n, moving in now.items() if moving.velocity is not None} == {"O_3", "C_1", "D_2"}
    for name, moving in now.items():
        p, q, s = before[name].position, moving.position, later[name].position
        if moving.velocity is not None:
            assert abs((s - p) / (2 * h) - moving.velocity).max() < 1e-5 * abs(moving.velocity).max()
            wanted = (s - 2 * q + p) / h**2
            assert abs(wanted - moving.acceleration).max() < 1e-4 * abs(moving.acceleration).max()
