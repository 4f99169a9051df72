"""A resistor, a coil and a capacitor in series on an alternating voltage: impedance, current, resonance.

The impedance is a complex number, the phase an angle, and one question has several right cases.
"""

import numpy as np

from coursework.figures import Figure, arc, circle, line, note, trace
from coursework.model import Exercise, Part, drawn


def reactance(f, L, C):
    """In ohms: that of the coil less that of the capacitor."""
    pulsation = 2 * np.pi * f
    return pulsation * L / 1000 - 1e6 / (pulsation * C)


def impedance(R, reactance):
    return (R**2 + reactance**2) ** 0.5


def off_resonance(R, reactance):
    """Else the signs that are asked hang on the last digit."""
    return abs(reactance) >= 0.2 * R


def resistance_counts(R, reactance):
    return abs(reactance) <= 5 * R


def capacitor_clearly_above_or_below(f, C, impedance):
    """Keep the capacitor's voltage clear of the source's: the sheet asks which is greater."""
    share = 1e6 / (2 * np.pi * f * C) / impedance
    return abs(share - 1) >= 0.1


def figure():
    """The same for every variant: it names what is given."""
    top, right, bottom = 40j, 100, 6
    corners = (bottom + top, right + top)
    R, L, C = 24 + top, 58 + top, right + 20j
    return Figure(
        circle(bottom + 20j, 6),
        note(bottom + 20j, "U"),
        line(bottom + 26j, corners[0]),
        line(bottom + 14j, bottom),
        line(bottom, right),
        line(corners[0], R - 8),
        trace((R - 8 - 3j, R + 8 - 3j, R + 8 + 3j, R - 8 + 3j, R - 8 - 3j), dotted=False),
        note(R, "R"),
        line(R + 8, L - 12),
        *(arc(L - 9 + 6 * k, 3, 0, 180) for k in range(4)),
        note(L - 5j, "L"),
        line(L + 12, corners[1]),
        line(corners[1], C + 1.5j),
        line(C + 1.5j - 6, C + 1.5j + 6, thin=False),
        line(C - 1.5j - 6, C - 1.5j + 6, thin=False),
        note(C - 11, "C"),
        line(C - 1.5j, right),
    )


EXERCISE = Exercise(
    given={
        "U": drawn(5, 48, step=1, unit="V"),
        "f": drawn(50, 2000, step=10, unit="Hz"),
        "R": drawn(10, 200, step=5, unit="ohm"),
        "L": drawn(5, 200, step=5, unit="mH"),
        "C": drawn(0.5, 50, step=0.5, unit="µF"),
    },
    constraints=(off_resonance, resistance_counts, capacitor_clearly_above_or_below),
    helpers=(reactance, impedance),
    parts=(
        Part("Z", unit="ohm", kind="complex", points=2),
        Part("I", unit="A"),
        Part("phi", unit="deg", kind="angle", points=2),
        Part("f_0", unit="Hz", points=2),
        Part("Q", points=1),
        Part("holds", kind="choices", choices=("inductive", "capacitive", "below", "magnified"), points=2),
    ),
    figure=figure,
)
