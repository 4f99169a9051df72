"""Four-bar linkage: positions, velocities and accelerations at one instant (Figures 18, 19 and 23)."""

from coursework.figures import Figure, angle_mark, ground_pivot, line, link, pin
from coursework.model import Driver, Exercise, Part, chosen, detectable, drawn, loop_equations

from ._crank_rocker import (
    bars,
    crank_off_the_frame,
    crank_turns,
    crank_turns_visibly,
    transmission_angle_from_30_to_150,
)


def crank_accelerates(alpha2):
    return alpha2 != 0


def links_turn_visibly(omega3, omega4, omega2):
    return (abs(omega3) > 0.05 * abs(omega2)) & (abs(omega4) > 0.05 * abs(omega2))


def links_accelerate_visibly(alpha3, alpha4, omega2):
    return (abs(alpha3) > 0.03 * omega2**2) & (abs(alpha4) > 0.03 * omega2**2)


RATES = ("omega3", "omega4", "v_BA", "v_B", "a_BA_n", "alpha3", "alpha4", "a_B")


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
        angle_mark(O, 0, theta2, r"\theta_2"),
    )


EXERCISE = Exercise(
    given={
        "r1": drawn(120, 260, step=5, unit="mm"),
        "r2": drawn(30, 90, step=5, unit="mm"),
        "r3": drawn(120, 260, step=5, unit="mm"),
        "r4": drawn(80, 200, step=5, unit="mm"),
        "theta2": drawn(-175, 180, step=5, unit="deg"),
        "omega2": drawn(-20, 20, unit="rad/s"),
        "alpha2": drawn(-40, 40, unit="rad/s^2", default=0),
        "mode": chosen("open", "crossed"),
    },
    helpers=(bars,),
    constraints=(
        crank_turns,
        transmission_angle_from_30_to_150,
        crank_off_the_frame,
        crank_turns_visibly,
        crank_accelerates,
        links_turn_visibly,
        links_accelerate_visibly,
        *(
            detectable(mistake, *RATES)
            for mistake in (
                "alpha2_left_out",
                "no_normal_terms",
                "omega_exchanged",
                "sum_in_denominator",
                "other_mode",
            )
        ),
    ),
    parts=(
        Part("theta3", unit="deg", kind="angle", points=2),
        Part("theta4", unit="deg", kind="angle", points=1),
        Part("omega3", unit="rad/s", points=1),
        Part("omega4", unit="rad/s", points=1),
        Part("alpha3", unit="rad/s^2", points=2),
        Part("alpha4", unit="rad/s^2", points=2),
        Part("v_B", unit="mm/s", points=1),
        Part("a_B", unit="mm/s^2", points=1),
        Part("v_BA", unit="mm/s", points=1),
        Part("a_BA_n", unit="mm/s^2", points=1),
        Part("a_BA_t", unit="mm/s^2", points=1),
        *loop_equations(
            "loop_1",
            ("r1", "r2", "theta2", "r3", "theta3", "r4", "theta4"),
            rates=("omega2", "omega3", "omega4"),
            second_rates=("alpha2", "alpha3", "alpha4"),
        ),
    ),
    figure=figure,
    symbols={
        "v_B": "v_B",
        "v_BA": "v_{BA}",
        "a_BA_n": "a_{BA}^n",
        "a_BA_t": "a_{BA}^t",
    },
    driver=Driver("theta2", "omega2", "alpha2", output="omega4"),
)
