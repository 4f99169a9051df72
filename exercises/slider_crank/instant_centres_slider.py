"""Instant centres of a slider-crank: one of them is at infinity; piston, rod and a point of it by the
others."""

from coursework.degrees import polar
from coursework.figures import (
    Figure,
    angle_mark,
    dimension,
    ground_pivot,
    line,
    link,
    pin,
    point,
    rail,
    slider,
)
from coursework.model import Driver, Exercise, Part, detectable, drawn, in_turn

from ._slider_crank import largest_offset, offset_is_none_or_visible, rod, rod_turns_visibly
from .mechanical_advantage_slider import crank_off_the_axes, crank_turns_visibly

WHERE = ("along_the_guide", "across_the_guide", "at_the_pin", "at_the_pivot")


def piston_moves_visibly(v_B, r2, omega2):
    return abs(v_B) > 0.15 * r2 * abs(omega2)


def centre_of_the_rod_is_on_the_sheet(y13, r3):
    return abs(y13) < 3 * r3


def centres_are_off_the_pins(y13, y24, e, r2):
    return (abs(y13 - e) > 0.4 * r2) & (abs(y24) > 0.2 * r2) & (abs(y24 - e) > 0.1 * r2)


def figure(rod, r2, e, theta2):
    O, A = 0j, polar(r2, theta2)
    B, half_rail = A + rod, 0.5 * r2
    offset = (dimension(B.real + 1.6 * half_rail, B + 1.6 * half_rail, "e", offset=0),) if e else ()
    return Figure(
        rail(B - half_rail, B + half_rail),
        line(O, B.real + 1.8 * half_rail, dashed=True),
        *offset,
        link(O, A, label="r_2"),
        link(A, B, label="r_3"),
        slider(B),
        ground_pivot(O, "O"),
        pin(A, "A"),
        pin(B, "B"),
        point((A + B) / 2, "M"),
        angle_mark(O, 0, theta2, r"\theta_2"),
    )


def _where(centre):
    return Part(f"where_{centre}", kind="choice", choices=WHERE, shuffled=True, points=1)


EXERCISE = Exercise(
    given={
        "r2": drawn(20, 100, step=5, unit="mm"),
        "r3": drawn(lambda r2: 1.6 * r2, lambda r2: 4 * r2, step=5, unit="mm", positive=True),
        "e": drawn(lambda r2: -largest_offset(r2), largest_offset, step=5, unit="mm"),
        "theta2": drawn(-175, 180, step=5, unit="deg"),
        "omega2": drawn(-60, 60, unit="rad/s"),
    },
    helpers=(rod,),
    constraints=(
        crank_turns_visibly,
        offset_is_none_or_visible,
        crank_off_the_axes,
        rod_turns_visibly,
        piston_moves_visibly,
        centre_of_the_rod_is_on_the_sheet,
        centres_are_off_the_pins,
        *(
            detectable(mistake, "y24", "v_B", "y13", "omega3", "v_M")
            for mistake in (
                "heights_exchanged",
                "heights_from_A",
                "about_O",
                "speed_of_A",
                "about_A",
                "mean_of_the_ends",
            )
        ),
    ),
    parts=(
        *in_turn(1, ("r2", "theta2", "omega2"), _where(14), _where(34), _where(12)),
        Part("y24", unit="mm", points=2),
        Part("v_B", unit="mm/s", points=2),
        Part("y13", unit="mm", points=2),
        Part("omega3", unit="rad/s", points=2),
        Part("v_M", unit="mm/s", points=2),
    ),
    figure=figure,
    symbols={"y24": "y_{24}", "y13": "y_{13}", "v_B": "v_B", "v_M": "v_M"},
    driver=Driver("theta2", "omega2", output="v_B"),
)
