"""Shaper that cuts: what torque turns its crank, and what flywheel keeps the crank nearly steady?"""

import math

import numpy as np

from coursework.degrees import asin
from coursework.figures import Figure, vector
from coursework.model import Driver, Exercise, Part, drawn

from ._slotted_ram import C, P, arm, crank_off_the_axes
from .quick_return_shaper import (
    MISTAKES,
    lowest_P,
    pins_can_be_told_apart_on_paper,
    ram_away_from_the_y_axis,
    ram_moves_visibly,
    rod_never_in_line_with_the_guide,
    rod_reaches_with_room,
)
from .quick_return_shaper import figure as _shaper

STEP = 5  #: degrees between the crank angles of the table
TOLD = 30  #: degrees between the bounds that the statement tells: the middle of so many is seldom right


def speeds(r1, r2, r4, r5, h):
    """How far the ram goes to the left per radian of the crank, from a tenth of a degree before to a tenth
    after, at crank angles along a first axis: every 5 degrees from -90 to 270, over the stroke that a radian
    has on average."""
    theta = np.arange(-90.0, 271.0, STEP).reshape((-1,) + (1,) * np.ndim(r1))
    before, after = (C(P(arm(r1, r2, at), r4), r5, h + 0 * at).real for at in (theta - 0.1, theta + 0.1))
    return (before - after) / np.radians(0.2) * math.pi * r1 / (r4 * r2)


def tells(r1, r2, r4, r5, h):
    """Bounds within which the torque rises above its mean, and falls below it, as the ram goes to the left
    faster than on average, or not."""
    above = speeds(r1, r2, r4, r5, h) > 1
    rise, fall = -90 + STEP * np.flatnonzero(above[1:] != above[:-1])
    return {"rise": _bounds(int(rise)), "fall": _bounds(int(fall))}


def _bounds(step):
    """Of the step of the table that begins here."""
    low = step // TOLD * TOLD
    return low, low + TOLD


def crank_on_the_working_stroke(theta2, r1, r2):
    """The guide turns the same way as the crank, and the ram is well away from where it turns back."""
    swing = asin(r2 / r1)
    return (theta2 > 8 - swing) & (theta2 < 172 + swing)


def torque_crosses_its_mean_twice(speeds):
    above = speeds > 1
    return (above[1:] != above[:-1]).sum(axis=0) == 2


def crossings_lie_within_their_steps(speeds):
    """By a twentieth at least, so that nobody doubts which step it is."""
    before, after = speeds[:-1] - 1, speeds[1:] - 1
    share = before / (before - after)
    return ~((before * after < 0) & ((share < 0.05) | (share > 0.95))).any(axis=0)


def torque_is_not_near_its_mean(torque, mean_torque):
    return abs(torque / mean_torque - 1) > 0.08


def figure(arm, P, C, r1, r2, r4, theta2, omega2):
    """The force on the ram besides, as it moves to the left."""
    shaper = _shaper(arm, P, C, r1, r2, r4, theta2, omega2)
    half_rail = 0.3 * r2 + 0.05 * r4
    return Figure(*shaper.elements, vector(C + 1.1 * half_rail, 1.3 * half_rail, "F"))


EXERCISE = Exercise(
    given={
        "r1": drawn(200, 400, step=5, unit="mm"),
        "r2": drawn(lambda r1: 0.25 * r1, lambda r1: 0.6 * r1, step=5, unit="mm", positive=True),
        "r4": drawn(lambda r1: 1.5 * r1, lambda r1: 2.2 * r1, step=5, unit="mm", positive=True),
        "r5": drawn(120, 300, step=5, unit="mm"),
        "h": drawn(lambda r4: r4 - 40, lambda r4: r4, step=5, unit="mm", positive=False),
        "theta2": drawn(-30, 210, step=5, unit="deg"),
        "omega2": drawn(5, 14, step=0.5, unit="rad/s"),
        "F": drawn(500, 2500, step=50, unit="N"),
        "delta": drawn(0.03, 0.08, step=0.005),
    },
    helpers=(
        arm,
        P,
        C,
        lowest_P,
        speeds,
    ),
    constraints=(
        rod_reaches_with_room,
        rod_never_in_line_with_the_guide,
        pins_can_be_told_apart_on_paper,
        crank_off_the_axes,
        crank_on_the_working_stroke,
        torque_crosses_its_mean_twice,
        crossings_lie_within_their_steps,
        ram_away_from_the_y_axis,
        ram_moves_visibly,
        torque_is_not_near_its_mean,
        *MISTAKES,
    ),
    parts=(
        Part("v_C", unit="mm/s", points=2),
        Part("torque", unit="N*m", points=2),
        Part("work", unit="J", points=1),
        Part("mean_torque", unit="N*m", points=1),
        Part("power", unit="W", points=1),
        Part("theta_rise", unit="deg", kind="angle", points=2),
        Part("theta_fall", unit="deg", kind="angle", points=2),
        Part("excess", unit="J", points=2),
        Part("J", unit="kg*m^2", points=1),
    ),
    symbols={
        "torque": r"\Gamma",
        "work": "W",
        "mean_torque": r"\Gamma_m",
        "power": "P_m",
        "theta_rise": r"\theta_2'",
        "theta_fall": r"\theta_2''",
        "excess": r"\Delta E",
        "delta": r"\delta",
    },
    effects=("load",),
    tells=tells,
    figure=figure,
    driver=Driver("theta2", "omega2", effort="torque", output="v_C"),
)
