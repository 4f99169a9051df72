"""Equilibrium of a joint: a shaft on two bearings, what each of them bears, and what a stiffer one would make
of it."""

from coursework.figures import Figure, axes, dimension, ground_pivot, line, link, point, vector
from coursework.model import Exercise, Part, chosen, detectable, drawn

OTHERS = ("ball", "cylindrical", "revolute")


def forces_are_visible(F_x, F_y, F_z):
    return (abs(F_x) >= 100) & (abs(F_y) >= 100) & (abs(F_z) >= 100)


def wheel_is_off_the_bearings(d, b):
    return (abs(d - b) >= 0.15 * b) & (abs(d - b / 2) >= 0.05 * b)


def bearings_bear_visibly(Y_A, Z_A, Y_B, Z_B, F_y, F_z):
    return (abs(Y_A) > 0.15 * abs(F_y)) & (abs(Y_B) > 0.15 * abs(F_y)) & (abs(Z_A) > 0.1 * abs(F_z))


def figure(b, d, R, F_x, F_y):
    A, B, D = 0j, complex(b), complex(d, R)
    size = 0.3 * b / max(abs(F_x), abs(F_y))
    end = max(1.1 * b, 1.15 * d)
    return Figure(
        link(-0.12 * b, end),
        link(complex(d), D),
        line(D - 0.1 * b, D + 0.1 * b, thin=False),
        vector(D, size * F_x, "F_x"),
        vector(D, 1j * size * F_y, "F_y"),
        ground_pivot(A, "A", toward=135),
        ground_pivot(B, "B", toward=135),
        point(D, "D"),
        axes(complex(-0.5 * b, 0), 0.2 * b),
        dimension(A, B, "b", offset=-0.42 * b),
        dimension(A, complex(d), "d", offset=-0.27 * b),
        dimension(complex(d), D, "R", offset=0.17 * b),
        paper_mm=(110, 70),
    )


EXERCISE = Exercise(
    given={
        "b": drawn(100, 300, step=10, unit="mm"),
        "d": drawn(lambda b: 0.25 * b, lambda b: 1.4 * b, step=5, unit="mm", positive=True),
        "R": drawn(30, 90, step=5, unit="mm"),
        "F_x": drawn(-600, 600, step=20, unit="N"),
        "F_y": drawn(-900, 900, step=20, unit="N"),
        "F_z": drawn(-1500, 1500, step=20, unit="N"),
        "other": chosen(*OTHERS, shown=("Ns", "h")),
    },
    constraints=(
        forces_are_visible,
        wheel_is_off_the_bearings,
        bearings_bear_visibly,
        *(
            detectable(mistake, "Y_B", "Z_B", "Y_A", "Z_A", "Gamma")
            for mistake in (
                "axial_force_without_a_moment",
                "axial_moment_reversed",
                "arm_from_the_other_bearing",
                "half_each",
            )
        ),
    ),
    parts=(
        Part(
            "moment_z",
            kind="equation",
            variables=("Y_B", "F_x", "F_y", "b", "d", "R"),
            parameters=("b", "d", "R"),
            points=2,
        ),
        Part(
            "moment_y", kind="equation", variables=("Z_B", "F_z", "b", "d"), parameters=("b", "d"), points=1
        ),
        Part("X", unit="N", points=1),
        Part("Y_B", unit="N", points=1),
        Part("Z_B", unit="N", points=1),
        Part("Y_A", unit="N", points=1),
        Part("Z_A", unit="N", points=1),
        Part("Gamma", unit="N*m", points=1),
        Part("Ns", kind="integer", points=1),
        Part("h", kind="integer", points=1),
    ),
    symbols={"Ns": "N_s", "Gamma": r"\Gamma", "other": "B'"},
    figure=figure,
)
