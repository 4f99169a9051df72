"""Slider-crank: what torque turns the crank, and what do its joints bear?"""

import numpy as np

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
    rotation_arrow,
    slider,
    vector,
)
from coursework.kinematics.dyads import rrp
from coursework.model import Driver, Exercise, Part, detectable, drawn


def rod(r2, r3, e, theta2):
    """Vector AB."""
    crank = polar(r2, theta2)
    return rrp(crank, r3, e) - crank


def load_is_visible(F):
    return abs(F) >= 50


def rod_leans_visibly(rod):
    return abs(rod.imag) > 0.12 * abs(rod)


def piston_moves_visibly(r1_dot, r2, omega2):
    return abs(r1_dot) > 0.1 * r2 * abs(omega2)


def answers_are_no_small_differences(torque, N_guide, R_A, R_B, X3, Y3, X4, Y4, M2, r2):
    forces = np.hypot(X3, Y3) + np.hypot(X4, Y4)
    smallest = np.minimum(abs(N_guide), np.minimum(R_A, R_B))
    return (abs(torque) > 0.1 * (r2 * forces / 1000 + abs(M2))) & (smallest > 0.1 * forces)


def mistake_shows(mistake, *answers):
    """In the answers, by more than what rounding and the usual margin hide."""
    return detectable(mistake, *answers, least=2.2, most=0.2)


def _clear_of(G, r2):
    """A radius for the arc of theta2 that does not pass by G."""
    usual = 0.4 * r2
    if abs(abs(G) - usual) > 0.15 * r2:
        return usual
    return 0.2 * r2 if abs(G) > usual else 0.6 * r2


def figure(rod, r2, e, theta2, omega2, s3, F):
    O, A = 0j, polar(r2, theta2)
    B, G, half_rail = A + rod, A + s3 * rod, 0.5 * r2
    behind, pull = theta2 + 180, 0.65 * r2
    turn = 35 if omega2 > 0 else -35
    to_B, aside = B + 0.4 * r2, B.real + 1.2 * r2
    above = 1j * r2 if e >= 0 else -0.5j * r2
    offset = (dimension(aside, B + 1.2 * r2, "e", offset=0),) if e else ()
    return Figure(
        rail(B - half_rail, B + half_rail),
        line(O, aside + 0.2 * r2, dashed=True),
        *offset,
        link(O, A, label="r_2"),
        link(A, B, label="r_3"),
        slider(B),
        vector(to_B, pull, "F") if F > 0 else vector(to_B + pull, -pull, "F"),
        vector(to_B + 0.4 * r2 + above, -0.5j * r2, "g"),
        ground_pivot(O, "O"),
        pin(A, "A"),
        pin(B, "B"),
        point(G, "G"),
        angle_mark(O, 0, theta2, r"\theta_2", radius=_clear_of(G, r2)),
        rotation_arrow(O, 0.6 * r2, behind - turn, behind + turn, label=r"\omega_2"),
    )


EXERCISE = Exercise(
    given={
        "r2": drawn(100, 250, step=5, unit="mm"),
        "r3": drawn(lambda r2: 2.2 * r2, lambda r2: 3.5 * r2, step=5, unit="mm", positive=True),
        "e": drawn(lambda r2: -0.5 * r2, lambda r2: 0.5 * r2, step=5, unit="mm", default=0),
        "theta2": drawn(-175, 180, step=5, unit="deg"),
        "omega2": drawn(4, 12, unit="rad/s", positive=False),
        "alpha2": drawn(-60, 60, step=5, unit="rad/s^2", default=0),
        "s3": drawn(0.3, 0.45, step=0.05),
        "m3": drawn(8, 18, step=0.5, unit="kg"),
        "J3": drawn(
            lambda m3, r3: 0.1 * m3 * (r3 / 1000) ** 2,
            lambda m3, r3: 0.16 * m3 * (r3 / 1000) ** 2,
            step=0.01,
            unit="kg*m^2",
            positive=True,
        ),
        "m4": drawn(4, 12, step=0.5, unit="kg"),
        "J2": drawn(0.1, 0.6, step=0.05, unit="kg*m^2"),
        "F": drawn(-300, 300, step=10, unit="N"),
        "f": drawn(0.15, 0.35, step=0.05),
    },
    helpers=(rod,),
    constraints=(
        load_is_visible,
        rod_leans_visibly,
        piston_moves_visibly,
        answers_are_no_small_differences,
        *(
            mistake_shows(mistake, "torque", "N_guide", "R_A", "R_B")
            for mistake in (
                "friction_forgotten",
                "friction_wrong_way",
                "rod_weight_forgotten",
                "crank_inertia_forgotten",
            )
        ),
        mistake_shows("rod_inertia_forgotten", "torque", "N_guide"),
    ),
    parts=(
        Part("torque", unit="N*m", points=3),
        Part("N_guide", unit="N", points=2),
        Part("R_A", unit="N", points=1),
        Part("R_B", unit="N", points=1),
        Part("R_O", unit="N", points=1),
    ),
    effects=("load", "gravity", "inertia", "friction"),
    figure=figure,
    symbols={"torque": r"\Gamma", "N_guide": "N"},
    driver=Driver("theta2", "omega2", "alpha2", effort="torque", output="r1_dot"),
)
