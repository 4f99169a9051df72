"""Three positions of a coupler: the fixed pivots of the four-bar linkage that takes it through all of
them."""

import numpy as np

from coursework.figures import Figure
from coursework.model import Exercise, Part, drawn

from ._positions import drawn_positions, placed


def first(x1, y1, phi1, L):
    """A1, B1."""
    return placed(x1, y1, phi1, L)


def second(x2, y2, phi2, L):
    return placed(x2, y2, phi2, L)


def third(x3, y3, phi3, L):
    return placed(x3, y3, phi3, L)


def coupler_turns_visibly(phi1, phi2, phi3):
    return (abs(phi2 - phi1) >= 10) & (abs(phi3 - phi2) >= 10) & (abs(phi3 - phi1) >= 15)


def ends_are_on_clear_circles(first, second, third):
    """The three places of each end make no flat triangle."""
    clear = True
    for p, q, r in zip(first, second, third, strict=True):
        height = abs((np.conj(q - p) * (r - p)).imag) / abs(r - p)
        clear = clear & (height > 0.12 * abs(r - p)) & (abs(q - p) > 20) & (abs(r - q) > 20)
    return clear


def pivots_do(fault):
    """The linkage passes all three positions without being taken apart."""
    return fault == "none"


def figure(first, second, third, L):
    return Figure(*drawn_positions((first, second, third), L), paper_mm=(110, 80))


def _chosen(quantity):
    return Part(quantity, unit="mm", points=1.5 if quantity[0] != "r" else 1, judge="passes_all_positions")


EXERCISE = Exercise(
    given={
        "L": drawn(60, 100, step=5, unit="mm"),
        "x1": drawn(-100, -40, step=5, unit="mm"),
        "y1": drawn(50, 120, step=5, unit="mm"),
        "phi1": drawn(-20, 60, step=5, unit="deg"),
        "x2": drawn(-20, 40, step=5, unit="mm"),
        "y2": drawn(70, 150, step=5, unit="mm"),
        "phi2": drawn(-30, 40, step=5, unit="deg"),
        "x3": drawn(50, 120, step=5, unit="mm"),
        "y3": drawn(50, 120, step=5, unit="mm"),
        "phi3": drawn(-60, 20, step=5, unit="deg"),
    },
    helpers=(first, second, third),
    constraints=(coupler_turns_visibly, ends_are_on_clear_circles, pivots_do),
    parts=tuple(map(_chosen, ("x_O", "y_O", "x_C", "y_C", "r2", "r4"))),
    symbols={
        **{f"phi{k}": rf"\varphi_{k}" for k in (1, 2, 3)},
        "x_O": "x_O",
        "y_O": "y_O",
        "x_C": "x_C",
        "y_C": "y_C",
    },
    figure=figure,
)
