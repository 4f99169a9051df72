"""Mechanical advantage of a four-bar linkage: what force and what torque come out? (equations 19 to 21)."""

import numpy as np

from coursework.figures import Figure, angle_mark, ground_pivot, line, link, pin, vector
from coursework.kinematics.vectors import cross
from coursework.model import Driver, Exercise, Part, chosen, drawn

from ._crank_rocker import (
    bars,
    crank_off_the_frame,
    crank_turns,
    crank_turns_visibly,
    transmission_angle_from_30_to_150,
)


def rates(bars):
    """omega3 and omega4, over omega2."""
    crank, coupler, rocker = bars
    area = cross(rocker, coupler)
    return cross(crank, rocker) / area, cross(crank, coupler) / area


def rates_of_other_mode(bars, r1):
    """B mirrored in the line AC."""
    crank, coupler, _ = bars
    line = r1 - crank
    mirrored = line * (coupler / line).conjugate()
    return rates((crank, mirrored, mirrored - line))


def advantage(rates, r2, r4):
    return r2 / (r4 * abs(rates[1]))


def links_turn_visibly(rates):
    return (abs(rates[0]) > 0.08) & (abs(rates[1]) > 0.08)


def _tells(wrong, right):
    """Whether a mistake moves a value by two tolerances of 1 % and more, or not at all."""
    gap = abs(wrong - right) / abs(0.01 * right)
    return (gap > 2) | (gap < 0.25)


def inverse_tells(advantage, rates):
    return _tells(1 / advantage, advantage) & _tells(abs(rates[1]), 1 / abs(rates[1]))


def velocity_of_the_rod_tells(rates, r3, r4):
    return _tells(r3 * abs(rates[0]), r4 * abs(rates[1]))


def difference_of_the_angles_tells(bars, rates):
    """From their sum, in the sine that divides omega4."""
    _, coupler, rocker = bars
    wrong = rates[1] * cross(coupler, rocker) / cross(coupler.conjugate(), rocker)
    return _tells(wrong, rates[1]) & _tells(abs(wrong), abs(rates[1]))


def mode_tells(rates_of_other_mode, rates):
    wrong, right = rates_of_other_mode[1], rates[1]
    return _tells(wrong, right) & _tells(abs(wrong), abs(right))


def figure(bars, r1, r2, theta2, omega2):
    O, A, C = 0j, bars[0], complex(r1)
    B = A + bars[1]
    push = 1j * np.sign(omega2) * A / r2
    return Figure(
        line(O, C, dashed=True, label="r_1"),
        link(O, A, label="r_2"),
        link(A, B, label="r_3"),
        link(C, B, label="r_4"),
        vector(A, 0.3 * r1 * push, "F_e"),
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
        "mode": chosen("open", "crossed"),
        "F_e": drawn(50, 500, step=10, unit="N"),
    },
    helpers=(bars, rates, rates_of_other_mode, advantage),
    keep=(
        crank_turns,
        transmission_angle_from_30_to_150,
        crank_off_the_frame,
        crank_turns_visibly,
        links_turn_visibly,
        inverse_tells,
        velocity_of_the_rod_tells,
        difference_of_the_angles_tells,
        mode_tells,
    ),
    parts=(
        Part("omega4", unit="rad/s", points=2),
        Part("mechanical_advantage", points=2),
        Part("F_s", unit="N", points=1),
        Part("torque_ratio", points=1),
        Part("Gamma_s", unit="N*m", points=2),
    ),
    figure=figure,
    symbols={
        "mechanical_advantage": r"\lambda",
        "torque_ratio": r"\Gamma_s / \Gamma_e",
        "Gamma_e": r"\Gamma_e",
        "Gamma_s": r"\Gamma_s",
    },
    driver=Driver("theta2", "omega2", output="omega4"),
)
