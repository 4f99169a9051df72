"""Slotted mechanism: where is the block on its guide, and how does the guide turn? (chapter 3, exercise
1)."""

from coursework.degrees import angle, polar
from coursework.figures import Figure, angle_mark, ground_pivot, line, link, note, pin, slider, slot_link
from coursework.model import Driver, Exercise, Part, drawn, fixed, loop_equations


def arm(r1, theta1, r2, theta2):
    return polar(r1, theta1) + polar(r2, theta2)


def crank_unlike_frame(r1, r2):
    return abs(r2 / r1 - 1) > 0.15


def block_away_from_O4(rA, r1, r2):
    return rA > 0.3 * (r1 + r2)


def block_slides_visibly(rA_dot, r2, omega2):
    return abs(rA_dot) > 0.1 * r2 * abs(omega2)


def crank_off_the_axes(theta2):
    return theta2 % 90 >= 5


def guide_turns_visibly(omega4, omega2):
    return abs(omega4) > 0.08 * abs(omega2)


def asks_swing(r1, r2, theta2):
    """Half of the oscillating guides are asked their swing, so that the question tells nothing of the
    type."""
    return r2 < r1 and theta2 % 10 == 0


def asks_guide(r1, r2, theta2):
    return not asks_swing(r1, r2, theta2)


def figure(arm, r1, theta1, r2, theta2):
    O4, O2 = 0, polar(r1, theta1)
    beyond = arm / abs(arm) * (r1 + r2) * 1.1
    return Figure(
        slot_link(O4, beyond),
        line(O4, O2, dashed=True, label="r_1"),
        link(O2, arm, label="r_2"),
        slider(arm, angle(arm), label="A"),
        pin(arm),
        ground_pivot(O4, "O_4"),
        ground_pivot(O2, "O_2"),
        line(O2, O2 + 0.6 * r2, dashed=True),
        note(1.07 * beyond, "4"),
        angle_mark(O2, 0, theta2, r"\theta_2"),
    )


EXERCISE = Exercise(
    given={
        "r1": drawn(100, 300, step=5, unit="mm"),
        "theta1": fixed(90, unit="deg"),
        "r2": drawn(40, 250, step=5, unit="mm"),
        "theta2": drawn(-175, 180, step=5, unit="deg"),
        "omega2": drawn(2, 20, unit="rad/s", positive=False, nonzero=True),
        "alpha2": drawn(-20, 20, unit="rad/s^2", default=0),
    },
    helpers=(arm,),
    constraints=(
        crank_unlike_frame,
        block_away_from_O4,
        block_slides_visibly,
        crank_off_the_axes,
        guide_turns_visibly,
    ),
    parts=(
        Part("rA", unit="mm", points=1),
        Part("theta4", unit="deg", kind="angle", points=1),
        Part("guide", kind="choice", choices=("oscillates", "rotates"), points=1, when=asks_guide),
        Part("swing", unit="deg", points=1, when=asks_swing),
        Part("rA_dot", unit="mm/s", points=1),
        Part("omega4", unit="rad/s", points=1),
        Part("a_centripetal", unit="mm/s^2", points=1),
        Part("a_coriolis", unit="mm/s^2", points=1),
        Part("rA_ddot", unit="mm/s^2", points=1),
        Part("alpha4", unit="rad/s^2", points=1),
        Part("a_tangential", unit="mm/s^2", points=1, by_request=True),
        *loop_equations(
            "loop_1",
            ("r1", "theta1", "r2", "theta2", "rA", "theta4"),
            rates=("omega2", "rA_dot", "omega4"),
            second_rates=("alpha2", "rA_ddot", "alpha4"),
        ),
    ),
    figure=figure,
    symbols={
        "swing": r"\Delta\theta_4",
        "a_radial": "a_r",
        "a_centripetal": "a_n",
        "a_tangential": "a_t",
        "a_coriolis": "a_c",
    },
    driver=Driver("theta2", "omega2", "alpha2", output="omega4"),
)
