"""Slider-crank: piston and rod, their velocities and accelerations, computed and drawn (Figures 20 to 22)."""

import numpy as np

from coursework.degrees import polar
from coursework.figures import Figure, angle_mark, dimension, ground_pivot, line, link, pin, rail, slider
from coursework.model import Driver, Exercise, Part, detectable, drawn, fixed, loop_equations

from ._slider_crank import largest_offset, offset_is_none_or_visible, rod, rod_turns_visibly


def velocity_scale(r2, omega2):
    """So that the velocity of A is 40 to 100 mm long on paper."""
    return _round_scale(r2 * abs(omega2) / 100)


def acceleration_scale(r2, omega2):
    """So that the acceleration of A is 40 to 100 mm long on paper."""
    return _round_scale(r2 * omega2**2 / 100)


def _round_scale(least):
    """The first of 1, 2, 5, 10, 20, 50, … that is not below."""
    decade = 10.0 ** np.ceil(np.log10(np.maximum(least, 1.0)))
    return decade * np.select([5 * least <= decade, 2 * least <= decade], [0.2, 0.5], 1.0)


def crank_turns(omega2):
    return omega2 != 0


def rod_leans_visibly(rod):
    return abs(rod.imag) > 0.03 * abs(rod)


def piston_moves_visibly(r1_dot, r2, omega2):
    return abs(r1_dot) > 0.1 * r2 * abs(omega2)


def rod_accelerates_visibly(alpha3, r3, r2, omega2):
    return r3 * abs(alpha3) > 0.1 * r2 * omega2**2


def piston_accelerates_visibly(r1_ddot, r2, omega2):
    return abs(r1_ddot) > 0.15 * r2 * omega2**2


def asks_drawing(alpha2):
    """The polygons are those of a crank at constant rate."""
    return alpha2 == 0


def figure(rod, r2, e, theta2):
    O, A = 0j, polar(r2, theta2)
    B, half_rail = A + rod, 0.5 * r2
    offset = (dimension(B.real + 1.4 * half_rail, B + 1.4 * half_rail, "e", offset=0),) if e else ()
    return Figure(
        rail(B - half_rail, B + half_rail),
        line(O, B.real + 1.6 * half_rail, dashed=True),
        *offset,
        link(O, A, label="r_2"),
        link(A, B, label="r_3"),
        slider(B),
        ground_pivot(O, "O"),
        pin(A, "A"),
        pin(B, "B"),
        angle_mark(O, 0, theta2, r"\theta_2"),
    )


def _drawn_length(quantity):
    """Measured on paper: a millimetre, or two hundredths of it."""
    return Part(quantity, unit="mm", points=1, atol=1.0, rtol=0.02, when=asks_drawing)


EXERCISE = Exercise(
    given={
        "r2": drawn(20, 100, step=5, unit="mm"),
        "r3": drawn(lambda r2: 2.2 * r2, lambda r2: 4 * r2, step=5, unit="mm", positive=True),
        "e": drawn(lambda r2: -largest_offset(r2), largest_offset, step=5, unit="mm", default=0),
        "theta2": drawn(-175, 180, step=5, unit="deg"),
        "omega2": drawn(-150, 150, step=5, unit="rad/s"),
        "alpha2": fixed(0, unit="rad/s^2"),
        "kv": drawn(
            velocity_scale, velocity_scale, unit="mm/s/mm", positive=True, shown=("pv_a", "pv_b", "ab")
        ),
        "ka": drawn(
            acceleration_scale,
            acceleration_scale,
            unit="mm/s^2/mm",
            positive=True,
            shown=("pa_a", "ab_n", "bb_t", "pa_b"),
        ),
    },
    helpers=(rod,),
    constraints=(
        crank_turns,
        offset_is_none_or_visible,
        rod_leans_visibly,
        rod_turns_visibly,
        piston_moves_visibly,
        rod_accelerates_visibly,
        piston_accelerates_visibly,
        detectable("theta3_sign", "alpha3", "bb_t", "r1_ddot", "pa_b"),
        detectable("rod_forgotten_in_v", "r1_dot", "pv_b"),
        detectable("rod_normal_missing", "r1_ddot", "pa_b"),
    ),
    parts=(
        Part("theta3", unit="deg", kind="angle", points=1),
        Part("r1", unit="mm", points=1),
        Part("omega3", unit="rad/s", points=1),
        Part("r1_dot", unit="mm/s", points=1),
        Part("alpha3", unit="rad/s^2", points=1),
        Part("r1_ddot", unit="mm/s^2", points=1),
        _drawn_length("pv_a"),
        _drawn_length("pv_b"),
        _drawn_length("ab"),
        _drawn_length("pa_a"),
        _drawn_length("ab_n"),
        _drawn_length("bb_t"),
        _drawn_length("pa_b"),
        *loop_equations(
            "loop_1",
            ("r2", "theta2", "r3", "theta3", "r1", "e"),
            rates=("omega2", "omega3", "r1_dot"),
            second_rates=("alpha2", "alpha3", "r1_ddot"),
        ),
    ),
    figure=figure,
    symbols={
        "kv": "k_v",
        "ka": "k_a",
        "pv_a": "p_v a",
        "pv_b": "p_v b",
        "ab": "a b",
        "pa_a": "p_a a",
        "ab_n": "a b'",
        "bb_t": "b' b",
        "pa_b": "p_a b",
    },
    driver=Driver("theta2", "omega2", "alpha2", output="r1_dot"),
)
