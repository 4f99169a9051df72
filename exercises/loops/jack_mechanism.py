"""A body that a jack tips: positions, rates and accelerations from the length of the jack, which is the
input."""

import numpy as np

from coursework.degrees import angle, polar
from coursework.errors import CannotAssemble
from coursework.figures import (
    Figure,
    angle_mark,
    arc,
    axes,
    ground_pivot,
    line,
    link,
    pin,
    point,
    slider,
    slot_link,
)
from coursework.model import Driver, Exercise, Jack, Part, drawn, loop_equations


def foot(xB, yB):
    return xB + 1j * yB


def level(a, xB, yB):
    """The jack's length under a body that lies level."""
    return np.hypot(a - xB, yB)


def nearly_level(a, xB, yB):
    return abs(polar(a, 8) - xB - 1j * yB)


def theta4(foot, a, L):
    """The tilt of the body; none where the jack does not reach."""
    return _tilt(foot, a, L)


def _tilt(foot, a, length):
    """By the law of cosines at O; NaN where the jack does not reach."""
    with np.errstate(invalid="ignore"):
        opened = np.arccos((a**2 + abs(foot) ** 2 - length**2) / (2 * a * abs(foot)))
    return angle(foot) + np.degrees(opened)


def tilts(foot, a, L_min, L_max):
    """With the jack closed, and at its full length."""
    return _tilt(foot, a, L_min), _tilt(foot, a, L_max)


def body_lies_low_on_the_closed_jack(tilts):
    return (tilts[0] >= -2) & (tilts[0] <= 10)


def body_tips_far(tilts):
    return (tilts[1] >= 35) & (tilts[1] <= 65)


def jack_stands_between_its_ends(L, L_min, L_max):
    return (1.04 * L_min < L) & (0.97 * L_max > L)


def jack_is_one_stage(L_min, L_max):
    return L_max < 1.75 * L_min


def jack_moves_visibly(L_dot, L_ddot):
    return (abs(L_dot) >= 80) & (abs(L_ddot) >= 20)


def jack_pushes_at_a_good_angle(mu):
    return (mu > 25) & (mu < 155) & (abs(mu - 90) > 10)


def jack_turns_visibly(omega2, omega4):
    return abs(omega2) > 0.1 * abs(omega4)


def body_and_jack_accelerate_visibly(alpha2, alpha4, omega4):
    return (abs(alpha4) > 0.15 * omega4**2) & (abs(alpha2) > 0.1 * omega4**2)


def with_the_body_at(driven, foot, a, L_min, L_max):
    """The jack's length that tips the body so far; none beyond its ends."""
    A = polar(a, driven)
    length, left = abs(A - foot), (foot.conjugate() * A).imag > 0
    at_limit = np.clip(length, L_min, L_max)  # rounding leaves an end where it is
    return {"L": np.where(left & np.isclose(length, at_limit, rtol=1e-12, atol=0), at_limit, np.nan)[()]}


def figure(foot, a, L, c, eta, theta4, L_min, L_max):
    if not L_min <= L <= L_max:
        raise CannotAssemble(f"the jack is between {L_min:g} and {L_max:g} long; found {L:g}")
    theta4 = float(theta4)
    O, A, G = 0j, polar(a, theta4), polar(c, theta4 + eta)
    along = (A - foot) / L
    piston = A - 0.9 * L_min * along
    return Figure(
        axes(O, 0.35 * a),
        line(O, 1.1 * a + 0j, dashed=True),
        link(O, A, G),
        arc(O, a, theta4 - 12, theta4 + 12, dashed=True),
        slot_link(foot, foot + 0.94 * L_min * along, label="2"),
        slider(piston, angle(along)),
        link(piston, A, label="3"),
        ground_pivot(O, "O"),
        ground_pivot(foot, "B"),
        pin(A, "A"),
        point(G, "G"),
        angle_mark(O, 0, theta4, r"\theta_4", radius=0.5 * a),
        angle_mark(foot, 0, angle(along), r"\theta_2", radius=0.3 * L_min),
        paper_mm=(110, 85),
    )


EXERCISE = Exercise(
    given={
        "a": drawn(400, 800, step=5, unit="mm"),
        "xB": drawn(lambda a: 0.3 * a, lambda a: 0.8 * a, step=5, unit="mm", positive=False),
        "yB": drawn(lambda a: -0.6 * a, lambda a: -0.25 * a, step=5, unit="mm", positive=False),
        "L_min": drawn(level, nearly_level, step=5, unit="mm", positive=True),
        "L_max": drawn(
            lambda L_min: 1.4 * L_min, lambda L_min: 1.75 * L_min, step=5, unit="mm", positive=True
        ),
        "L": drawn(lambda L_min: 1.05 * L_min, lambda L_max: 0.96 * L_max, step=1, unit="mm", positive=True),
        "L_dot": drawn(-250, 250, step=5, unit="mm/s", nonzero=True),
        "L_ddot": drawn(-200, 200, step=5, unit="mm/s^2", default=0),
        "c": drawn(lambda a: 0.5 * a, lambda a: 0.9 * a, step=5, unit="mm", positive=True),
        "eta": drawn(15, 40, unit="deg"),
    },
    helpers=(foot, theta4, tilts),
    constraints=(
        jack_is_one_stage,
        body_lies_low_on_the_closed_jack,
        body_tips_far,
        jack_stands_between_its_ends,
        jack_moves_visibly,
        jack_pushes_at_a_good_angle,
        jack_turns_visibly,
        body_and_jack_accelerate_visibly,
    ),
    parts=(
        Part("theta4", unit="deg", kind="angle", points=2),
        Part("theta2", unit="deg", kind="angle", points=1),
        Part("yG", unit="mm", points=1),
        Part("swing", unit="deg", points=1),
        Part("omega4", unit="rad/s", points=2),
        Part("omega2", unit="rad/s", points=1),
        Part("v_G", unit="mm/s", points=1),
        Part("a_coriolis", unit="mm/s^2", points=1),
        Part("alpha4", unit="rad/s^2", points=2),
        Part("alpha2", unit="rad/s^2", points=1),
        Part("a_G", unit="mm/s^2", points=1),
        *loop_equations(
            "loop_1",
            ("xB", "yB", "L", "theta2", "a", "theta4"),
            rates=("L_dot", "omega2", "omega4"),
            second_rates=("L_ddot", "alpha2", "alpha4"),
        ),
    ),
    figure=figure,
    symbols={
        "xB": "x_B",
        "yB": "y_B",
        "L_min": r"L_{\min}",
        "L_max": r"L_{\max}",
        "L_dot": r"\dot{L}",
        "L_ddot": r"\ddot{L}",
        "eta": r"\eta",
        "yG": "y_G",
        "swing": r"\Delta\theta_4",
        "a_coriolis": "a_c",
    },
    driver=Driver(
        "theta4", poses=with_the_body_at, jack=Jack("L", "L_dot", "L_ddot", limits=("L_min", "L_max"))
    ),
)
