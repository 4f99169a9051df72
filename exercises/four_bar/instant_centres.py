"""Instant centres of a four-bar linkage: by the theorem of three centres, and the velocities that follow from
them."""

from coursework.figures import Figure, angle_mark, ground_pivot, line, link, pin, point
from coursework.model import Driver, Exercise, Part, chosen, detectable, drawn, in_turn

from ._crank_rocker import (
    bars,
    crank_off_the_frame,
    crank_turns,
    crank_turns_visibly,
    transmission_angle_from_30_to_150,
)

LINES = ("lines_12_23_and_14_34", "lines_12_14_and_23_34", "lines_12_34_and_14_23")


def centres_are_on_the_sheet(d13, x24, r1):
    """The longest line of the construction is a few times the frame."""
    return (abs(d13) < 3 * r1) & (abs(x24 - r1 / 2) < 2 * r1)


def centres_are_off_the_pivots(d13, x24, r1, r2):
    """Neither the coupler nor the rocker stands still, and I24 is not beside O or C."""
    return (
        (abs(d13) > 0.3 * r2)
        & (abs(d13 - r2) > 0.4 * r2)
        & (abs(x24) > 0.08 * r1)
        & (abs(x24 - r1) > 0.2 * r1)
    )


def figure(bars, r1, r2, theta2):
    O, A, C = 0j, bars[0], complex(r1)
    B = A + bars[1]
    return Figure(
        line(O, C, dashed=True, label="r_1"),
        link(O, A, label="r_2"),
        link(A, B, label="r_3"),
        link(C, B, label="r_4"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        point((A + B) / 2, "M"),
        angle_mark(O, 0, theta2, r"\theta_2"),
    )


def _lines(centre):
    return Part(f"lines_{centre}", kind="choice", choices=LINES, points=1)


EXERCISE = Exercise(
    given={
        "n": drawn(5, 10, shown=("N",)),
        "r1": drawn(120, 260, step=5, unit="mm"),
        "r2": drawn(30, 90, step=5, unit="mm"),
        "r3": drawn(120, 260, step=5, unit="mm"),
        "r4": drawn(80, 200, step=5, unit="mm"),
        "theta2": drawn(-175, 180, step=5, unit="deg"),
        "omega2": drawn(-20, 20, unit="rad/s"),
        "mode": chosen("open", "crossed"),
    },
    helpers=(bars,),
    constraints=(
        crank_turns,
        transmission_angle_from_30_to_150,
        crank_off_the_frame,
        crank_turns_visibly,
        centres_are_on_the_sheet,
        centres_are_off_the_pivots,
        *(
            detectable(mistake, "d13", "x24", "omega3", "omega4", "v_M")
            for mistake in (
                "other_mode",
                "measured_from_A",
                "I24_measured_from_C",
                "speed_of_A_over_its_distance_to_O",
                "ratio_upside_down",
                "about_A",
                "mean_of_the_ends",
            )
        ),
    ),
    parts=(
        Part("N", kind="integer", points=1),
        *in_turn(1, ("r1", "theta2", "omega2"), _lines(13), _lines(24)),
        Part("x24", unit="mm", points=2),
        Part("omega4", unit="rad/s", points=2),
        Part("d13", unit="mm", points=2),
        Part("omega3", unit="rad/s", points=2),
        Part("v_M", unit="mm/s", points=2),
    ),
    figure=figure,
    symbols={
        "x24": "x_{24}",
        "d13": r"\overline{OI_{13}}",
        "v_M": "v_M",
    },
    driver=Driver("theta2", "omega2", output="omega4"),
)
