"""Four-bar linkage that generates a function: Freudenstein's equation at three precision points."""

from coursework.degrees import angle, polar
from coursework.figures import Figure, angle_mark, ground_pivot, line, link, pin
from coursework.kinematics.dyads import rrr
from coursework.model import Exercise, Part, chosen, drawn

FUNCTIONS = ("logarithm", "inverse", "sine", "root")


def figure():
    """The names of what is sought; the same for every variant."""
    O, C, r2, r3, r4 = 0j, 100 + 0j, 60.0, 110.0, 75.0
    A, later = polar(r2, 75), polar(r2, 20)
    B, B_later = rrr(A, C, r3, r4, 1), rrr(later, C, r3, r4, 1)
    return Figure(
        line(O, C, dashed=True, label="r_1"),
        line(C, C + 30, dashed=True),
        link(O, later, label="r_2"),
        link(later, B_later, label="r_3"),
        link(C, B_later, label="r_4"),
        line(O, A, dashed=True),
        line(C, B, dashed=True),
        angle_mark(O, 0, 20, r"\theta_2", radius=24),
        angle_mark(C, 0, angle(B_later - C), r"\theta_4", radius=20),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(later, "A"),
        pin(B_later, "B"),
    )


def lengths_are_of_one_size(r1, r2, r3, r4):
    """A quarter to four times the frame."""
    return (
        (r2 > 0.25 * r1) & (r4 > 0.25 * r1) & (r3 > 0.25 * r1) & (r2 < 3 * r1) & (r4 < 3 * r1) & (r3 < 4 * r1)
    )


def it_passes_on_forces(least_transmission):
    return least_transmission > 25


def it_generates_the_function(worst, delta):
    """And leaves room for other linkages that do."""
    return (worst > 0.15) & (worst < 0.8 * delta)


EXERCISE = Exercise(
    given={
        "law": chosen(*FUNCTIONS),
        "r1": drawn(100, 250, step=10, unit="mm"),
        "theta2_0": drawn(30, 130, step=5, unit="deg"),
        "range2": drawn(60, 90, step=10, unit="deg"),
        "theta4_0": drawn(30, 130, step=5, unit="deg"),
        "range4": drawn(40, 70, step=10, unit="deg"),
        "delta": drawn(1.5, 2.5, step=0.5, unit="deg"),
    },
    constraints=(lengths_are_of_one_size, it_passes_on_forces, it_generates_the_function),
    parts=(
        Part("x1", points=1),
        Part("theta2_1", unit="deg", kind="angle", points=1),
        Part("theta4_2", unit="deg", kind="angle", points=1),
        Part("r2", unit="mm", points=2, judge="generates_the_function"),
        Part("r3", unit="mm", points=2, judge="generates_the_function"),
        Part("r4", unit="mm", points=2, judge="generates_the_function"),
        Part("worst", unit="deg", points=2, judge="generates_the_function"),
    ),
    symbols={
        "law": "f",
        "theta2_0": r"\theta_2^0",
        "theta4_0": r"\theta_4^0",
        "range2": r"\Delta\theta_2",
        "range4": r"\Delta\theta_4",
        "x1": "x_1",
        "theta2_1": r"\theta_2^1",
        "theta4_2": r"\theta_4^2",
        "worst": r"\varepsilon_{\max}",
    },
    figure=figure,
)
