"""Crank-rocker to be designed: find lengths that give a wanted swing and time ratio (quick return,
reversed)."""

from coursework.degrees import angle, polar
from coursework.figures import Figure, angle_mark, ground_pivot, line, link, pin, point, rotation_arrow
from coursework.kinematics.dyads import rrr
from coursework.model import Exercise, Part, drawn


def figure():
    """The names of what is sought; the same for every variant."""
    O, C, r2, r3, r4 = 0j, 100 + 0j, 35.0, 90.0, 80.0
    A = polar(r2, 80)
    B = rrr(A, C, r3, r4, 1)
    first, last = (rrr(O, C, r3 + side * r2, r4, 1) for side in (-1, 1))
    return Figure(
        line(O, C, dashed=True, label="r_1"),
        line(C, first, dashed=True),
        line(C, last, dashed=True),
        angle_mark(C, angle(last - C), angle(first - C), r"\psi", radius=50),
        link(O, A, label="r_2"),
        link(A, B, label="r_3"),
        link(C, B, label="r_4"),
        rotation_arrow(O, 18, 105, 165),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        point(first, "B_1"),
        point(last, "B_2"),
    )


EXERCISE = Exercise(
    given={
        "r4": drawn(60, 200, step=5, unit="mm"),
        "psi": drawn(30, 60, step=5, unit="deg", positive=True),
        "Q": drawn(1.06, 1.25, step=0.01),
        "mu_min": drawn(30, 34, step=1, unit="deg", positive=True),
    },
    parts=(
        Part("alpha", unit="deg", points=2),
        Part("r1", unit="mm", points=2, judge="meets_the_demands"),
        Part("r2", unit="mm", points=2, judge="meets_the_demands"),
        Part("r3", unit="mm", points=2, judge="meets_the_demands"),
    ),
    symbols={"alpha": r"\theta_a", "mu_min": r"\mu_{\min}"},
    figure=figure,
)
