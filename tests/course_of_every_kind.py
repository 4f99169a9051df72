"""A small course with a part of every newer kind: electric circuits, a rotation, some theory."""

from __future__ import annotations

EXERCISE = '''
"""A coil on the mains: its impedance, and what follows from it."""

from coursework.model import Exercise, Part, drawn

EXERCISE = Exercise(
    given={
        "R": drawn(10, 50, step=1, unit="ohm"),
        "X": drawn(10, 50, step=1, unit="ohm"),
        "U": drawn(100, 240, step=10, unit="V"),
    },
    parts=(
        Part("Z", unit="ohm", kind="complex", points=2),
        Part("I", unit="A", kind="complex", points=2),
        Part("drops", unit="V", kind="vector", points=3),
        Part("M", unit="ohm", kind="matrix", points=4),
        Part("true_of_it", kind="choices", choices=("lags", "leads", "heats", "stores"), points=2),
        Part("why", kind="text", room=3, points=3),
        Part("sketch", kind="drawing", room=(80, 60), millimetre=True, points=4),
    ),
)
'''

SOLUTION = '''
"""Ohm's law with complex numbers."""

import numpy as np

from coursework.quantities.columns import cases, matrix, vector
from coursework.solution import mistake


def Z(R, X):
    return R + 1j * X


def I(U, Z):
    return U / Z


def drops(R, X, I):
    size = abs(I)
    return vector(R * size, X * size, abs(R + 1j * X) * size)


def M(R, X):
    return matrix([R, -X], [X, R])


def true_of_it(R, X):
    return cases(lags=X > 0, leads=X < 0, heats=R > 0, stores=X != 0)


@mistake("Z", share=0.5)
def capacitor_for_coil(R, X):
    return R - 1j * X


@mistake("M")
def transposed(M):
    return np.swapaxes(M, -1, -2)


def residual(R, X, U, Z, I):
    return abs(Z * I - U) / U, np.angle(Z) - np.arctan2(X, R)


KNOWN = (
    (
        {"R": 30, "X": 40, "U": 100},
        {"Z": 30 + 40j, "I": 1.2 - 1.6j, "drops": (60, 80, 100), "M": ((30, -40), (40, 30))},
    ),
    ({"R": 30, "X": 40, "U": 100}, {"true_of_it": "lags heats stores"}),
)
'''

STATEMENT = {
    "en": """# A coil on the mains

A coil of resistance $R$ and reactance $X$ on a voltage $U$.

## Z
Its impedance.

## I
The current.

## drops
The voltages of the resistance, of the reactance, of both.

## M
The matrix of the impedance as a map of the plane.

## true_of_it
Which are true?
- lags: the current lags
- leads: the current leads
- heats: it heats, and wears
- stores: it stores energy

## why
Why is the power less than $U I$?

## sketch
Draw the vectors of the voltages.
""",
    "fr": """# Une bobine sur le secteur

Une bobine de résistance $R$ et de réactance $X$ sous la tension $U$.

## Z
Son impédance.

## I
Le courant.

## drops
Les tensions de la résistance, de la réactance, des deux.

## M
La matrice de l'impédance comme application du plan.

## true_of_it
Lesquelles sont vraies ?
- lags: le courant est en retard
- leads: le courant est en avance
- heats: elle chauffe, et s'use
- stores: elle emmagasine de l'énergie

## why
Pourquoi la puissance est-elle moindre que $U I$ ?

## sketch
Dessiner les vecteurs des tensions.
""",
}
WORDS = {
    "en": """# A coil

## mistake capacitor_for_coil
That is a capacitor.

## mistake transposed
Rows and columns are exchanged.

## why
The reactance stores energy and gives it back, at $X$ = {{ X }}.
""",
    "fr": """# Une bobine

## mistake capacitor_for_coil
C'est un condensateur.

## mistake transposed
Lignes et colonnes sont échangées.

## why
La réactance emmagasine l'énergie et la rend, pour $X$ = {{ X }}.
""",
}


class Asking:
    """What a kind asks of a variant, of a reference alone."""

    stated = {}  # noqa: RUF012

    def __init__(self, reference):
        self.value = reference

    def reference(self, quantity):
        return self.value

    def labels(self, part):
        return {}

    def letters(self, part):
        return {}


def write_course(root):
    """Write the course; ``coil`` is its exercise."""
    for folder in ("exercises", "solutions"):
        (root / folder).mkdir(parents=True)
    (root / "exercises" / "coil.py").write_text(EXERCISE, "utf-8")
    (root / "solutions" / "coil.py").write_text(SOLUTION, "utf-8")
    for lang in ("fr", "en"):
        (root / "exercises" / f"coil.{lang}.md.j2").write_text(STATEMENT[lang], "utf-8")
        (root / "solutions" / f"coil.{lang}.md.j2").write_text(WORDS[lang], "utf-8")
    return root
