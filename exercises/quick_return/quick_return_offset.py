"""Quick return of a slider-crank whose piston is out of line with the crank (Figure 26 a, equations 22,
23)."""

from coursework.degrees import angle, polar, wrap
from coursework.figures import (
    Figure,
    angle_mark,
    centre_line,
    circle,
    ground_pivot,
    link,
    note,
    pin,
    rail,
    rotation_arrow,
    slider,
)
from coursework.kinematics.dyads import rrp
from coursework.model import Driver, Exercise, Part, detectable, drawn, loop_equations

from .quick_return import OF_BOTH_STROKES, piston_accelerates_visibly, piston_moves_visibly


def rod(r2, r3, e, theta2):
    """Vector AC."""
    crank = polar(r2, theta2)
    return rrp(crank, r3, e) - crank


def offset_is_visible(e, r2):
    return abs(e) >= 0.4 * r2


def crank_turns_with_room(r2, r3, e):
    return r3 - r2 > 1.2 * abs(e)


def strokes_last_unlike(alpha):
    return alpha > 188


def crank_off_the_axes(theta2):
    return theta2 % 90 >= 5


def stroke_is_not_twice_the_crank(stroke, r2):
    return stroke > 2 * 1.021 * r2


def _clearest(*directions):
    """The direction, by steps of 15 degrees, that is farthest from all of these."""
    return max(range(0, 360, 15), key=lambda way: min(abs(wrap(way - taken)) for taken in directions))


def figure(rod, r2, theta2, omega2):
    O, A = 0j, polar(r2, theta2)
    C = A + rod
    turning = _clearest(0, theta2, 0.5 * theta2, angle(C))
    half_turn = 25 if omega2 > 0 else -25
    return Figure(
        circle(O, r2, dashed=True),
        rotation_arrow(O, 1.3 * r2, turning - half_turn, turning + half_turn, label=r"\omega_2"),
        rail(C - 0.9 * r2, C + 0.9 * r2),
        centre_line(O, C.real + 0.9 * r2, label="x"),
        link(O, A, label="r_2"),
        link(A, C, label="r_3"),
        angle_mark(O, 0, theta2, r"\theta_2"),
        note(C + 0.8 * r2, "y=e"),
        slider(C, 0, label="C"),
        ground_pivot(O, "O"),
        pin(A, "A"),
        pin(C),
    )


EXERCISE = Exercise(
    given={
        "r2": drawn(30, 80, step=5, unit="mm"),
        "r3": drawn(lambda r2: 2 * r2, lambda r2: 3.5 * r2, step=5, unit="mm", positive=True),
        "e": drawn(lambda r2: -0.9 * r2, lambda r2: 0.9 * r2, step=5, unit="mm"),
        "theta2": drawn(-175, 180, step=5, unit="deg"),
        "omega2": drawn(2, 20, unit="rad/s", positive=False, nonzero=True),
    },
    helpers=(rod,),
    constraints=(
        offset_is_visible,
        crank_turns_with_room,
        strokes_last_unlike,
        crank_off_the_axes,
        stroke_is_not_twice_the_crank,
        piston_moves_visibly,
        piston_accelerates_visibly,
        detectable("e_sign", "xC", "v_C"),
        detectable("e_forgotten", "xC", "v_C"),
        detectable("rod_forgotten_in_v", "v_C"),
        detectable("stroke_no_root", "stroke"),
    ),
    parts=(
        Part("xC", unit="mm", points=1),
        Part("v_C", unit="mm/s", points=2),
        Part("a_C", unit="mm/s^2", points=2),
        Part("stroke", unit="mm", points=1),
        Part("alpha", unit="deg", points=2),
        Part("beta", unit="deg", points=1),
        Part("Q", points=1),
        Part("t_advance", unit="s", points=1),
        Part("t_return", unit="s", points=1),
        *loop_equations(
            "loop_1",
            ("r2", "theta2", "r3", "theta3", "xC", "e"),
            rates=("omega2", "omega3", "v_C"),
            second_rates=("alpha3", "a_C"),
        ),
    ),
    symbols=OF_BOTH_STROKES,
    figure=figure,
    version=2,
    driver=Driver("theta2", "omega2", output="v_C"),
)
