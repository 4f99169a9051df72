"""Slider-crank to be designed: find lengths that give a wanted stroke and time ratio (Figure 26 a,
reversed)."""

from coursework.degrees import asin, polar, sqrt, tan
from coursework.figures import (
    Figure,
    centre_line,
    dimension,
    ground_pivot,
    line,
    link,
    pin,
    point,
    rotation_arrow,
    slider,
)
from coursework.kinematics.dyads import rrp
from coursework.model import Exercise, Part, chosen, drawn


def least_lean(Q):
    """The largest inclination of the rod in the linkage whose rod leans least, for this time ratio."""
    t = tan(90 * (Q - 1) / (Q + 1))
    crank = (sqrt(5 * t**2 + 4) - t) / 2
    offset = (1 - crank**2) / (2 * t)
    return asin((crank + 2 * offset) / sqrt(1 + 2 * offset / t))


def figure():
    """The names of what is sought; the same for every variant."""
    O, A, r2, r3, e = 0j, polar(30, 115), 30.0, 85.0, 20.0
    C = rrp(A, r3, e)
    near, far = (complex(sqrt((r3 + side * r2) ** 2 - e**2), e) for side in (-1, 1))
    return Figure(
        centre_line(O, far.real + 20, label="x"),
        line(near - 12, far + 12, dashed=True),
        dimension(near, far, "s", offset=-32),
        dimension(far.real + 8, far + 8, "e", offset=0),
        link(O, A, label="r_2"),
        link(A, C, label="r_3"),
        rotation_arrow(O, 18, 135, 185),
        ground_pivot(O, "O"),
        pin(A, "A"),
        slider(C, 0, label="C"),
        pin(C),
        point(near, "C_1"),
        point(far, "C_2"),
    )


EXERCISE = Exercise(
    given={
        "stroke": drawn(60, 200, step=5, unit="mm"),
        "Q": drawn(1.1, 1.35, step=0.01),
        "mode": chosen("inward", "outward", shown=("r3", "e")),
        "delta": drawn(lambda Q: least_lean(Q) + 3, 62, step=1, unit="deg", positive=True),
    },
    parts=(
        Part("alpha", unit="deg", points=2),
        Part("r2", unit="mm", points=2, judge="meets_the_demands"),
        Part("r3", unit="mm", points=2, judge="meets_the_demands"),
        Part("e", unit="mm", points=2, judge="meets_the_demands"),
    ),
    symbols={"stroke": "s", "alpha": r"\theta_a"},
    figure=figure,
)
