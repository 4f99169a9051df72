"""Two positions of a coupler: choose the fixed pivots of a four-bar linkage that takes it from one to the
other."""

import numpy as np

from coursework.figures import Figure
from coursework.model import Exercise, Part, detectable, drawn

from ._positions import drawn_positions, placed


def first(x1, y1, phi1, L):
    """A1, B1."""
    return placed(x1, y1, phi1, L)


def second(x2, y2, phi2, L):
    return placed(x2, y2, phi2, L)


def coupler_turns_visibly(phi1, phi2):
    turned = abs(phi2 - phi1)
    return (turned >= 25) & (turned <= 80)


def both_ends_move_visibly(first, second, L):
    return (abs(second[0] - first[0]) > 0.4 * L) & (abs(second[1] - first[1]) > 0.4 * L)


def pole_is_near(x_P, y_P, L):
    return (np.hypot(x_P, y_P) < 6 * L) & (abs(x_P) > 0.1 * L) & (abs(y_P) > 0.1 * L)


def pivots_do(fault):
    """Those of the solution."""
    return fault == "none"


def figure(first, second, L):
    return Figure(*drawn_positions((first, second), L), paper_mm=(110, 75))


def _chosen(quantity):
    return Part(quantity, unit="mm", points=1, judge="passes_both_positions")


EXERCISE = Exercise(
    given={
        "L": drawn(60, 120, step=5, unit="mm"),
        "x1": drawn(-80, 0, step=5, unit="mm"),
        "y1": drawn(40, 140, step=5, unit="mm"),
        "phi1": drawn(-40, 60, step=5, unit="deg"),
        "x2": drawn(20, 140, step=5, unit="mm"),
        "y2": drawn(40, 140, step=5, unit="mm"),
        "phi2": drawn(-80, 60, step=5, unit="deg"),
    },
    helpers=(first, second),
    constraints=(
        coupler_turns_visibly,
        both_ends_move_visibly,
        pole_is_near,
        pivots_do,
        detectable("middle_of_the_path_of_A", "x_P", "y_P"),
    ),
    parts=(
        Part("x_P", unit="mm", points=2),
        Part("y_P", unit="mm", points=2),
        *map(_chosen, ("x_O", "y_O", "x_C", "y_C", "r2", "r4")),
    ),
    symbols={
        "phi1": r"\varphi_1",
        "phi2": r"\varphi_2",
        "x_P": "x_P",
        "y_P": "y_P",
        "x_O": "x_O",
        "y_O": "y_O",
        "x_C": "x_C",
        "y_C": "y_C",
    },
    figure=figure,
)
