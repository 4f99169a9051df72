"""Ohm's law with complex numbers: inductances are in mH and capacitances in µF, whence the powers of ten."""

import numpy as np

from coursework.degrees import angle, sqrt
from coursework.quantities.columns import cases
from coursework.solution import given, mistake

UNITS = {"X_L": "ohm", "X_C": "ohm"}


def X_L(f, L):
    return 2 * np.pi * f * L / 1000


def X_C(f, C):
    return 1000000 / (2 * np.pi * f * C)


def Z(R, X_L, X_C):
    return R + 1j * (X_L - X_C)


def I(U, Z):
    return U / abs(Z)


def phi(Z):
    return angle(Z)


def f_0(L, C):
    return 1 / (2 * np.pi * sqrt(L * C / 1000000000))


def Q(R, L, C):
    return sqrt(1000 * L / C) / R


def holds(f, U, X_L, X_C, I, f_0):
    return cases(inductive=X_L > X_C, capacitive=X_L < X_C, below=f < f_0, magnified=X_C * I > U)


@mistake("Z", kind="exchanged")
def reactances_exchanged(R, X_L, X_C):
    return R + 1j * (X_C - X_L)


@mistake("Z")
def reactances_added(R, X_L, X_C):
    return R + 1j * (X_L + X_C)


@mistake("X_L", "X_C")
def frequency_for_pulsation(f, L, C):
    return f * L / 1000, 1000000 / (f * C)


@mistake("I")
def sizes_added(U, R, X_L, X_C):
    return U / (R + abs(X_L - X_C))


@mistake("f_0", kind="constant")
def pulsation_for_frequency(f_0):
    return 2 * np.pi * f_0


@mistake("Q", kind="inverse")
def quality_turned_over(Q):
    return 1 / Q


def residual(U, f, R, L, C, Z, I, phi, f_0, Q):
    """Voltages in quadrature, the phase from its tangent, reactances that cancel at resonance, energy stored
    in a coil."""
    coil, capacitor = 2e-3 * np.pi * f * L * I, I / (2e-6 * np.pi * f * C)
    resonant = 2e-3 * np.pi * f_0 * L
    return (
        ((R * I) ** 2 + (coil - capacitor) ** 2) / U**2 - 1,
        ((Z - R) * I - 1j * (coil - capacitor)) / (coil + capacitor),
        (abs(Z) * I) / U - 1,
        (phi - angle(R * I + 1j * (coil - capacitor))) / 360,
        resonant * 2e-6 * np.pi * f_0 * C - 1,
        Q * R / resonant - 1,
    )


#: By hand at 1000 rad/s, where 50 mH and 50 µF have 50 and 20 ohms; the triangles are 3, 4, 5. In the second
#: the coil has more than the voltage of the source, and the capacitor less.
KNOWN = (
    given(U=10, f=500 / np.pi, R=40, L=50, C=50).gives(
        Z=40 + 30j, I=0.2, phi="36.870", f_0="100.658", Q="0.7906"
    ),
    given(U=10, f=500 / np.pi, R=40, L=100, C=50).gives(holds="inductive"),
    given(U=10, f=500 / np.pi, R=15, L=80, C=10).gives(
        Z=15 - 20j, I=0.4, phi="-53.130", f_0="177.941", Q="5.963"
    ),
    given(U=10, f=500 / np.pi, R=15, L=80, C=10).gives(holds="capacitive below magnified"),
)
