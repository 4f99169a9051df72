"""Common base of exercises in which a coupler is to pass through given positions."""

import numpy as np

from coursework.degrees import polar
from coursework.figures import axes, line, link, pin


def placed(x, y, phi, L):
    """The ends A and B of the coupler, complex."""
    A = x + 1j * y
    return A, A + polar(L, phi)


def drawn_positions(positions, L):
    """Elements of a figure: the coupler in each of its positions, and the axes."""
    return (
        axes(0j, 0.5 * L),
        *(link(A, B) for A, B in positions),
        *(pin(A, f"A_{k}") for k, (A, _) in enumerate(positions, 1)),
        *(pin(B, f"B_{k}") for k, (_, B) in enumerate(positions, 1)),
    )


def side(A, B, C):
    """+1 where B is on the left of the line from A to C."""
    return np.sign((np.conj(C - A) * (B - A)).imag)


def in_its_place(O, C, A, B):
    """Elements: crank and rocker of one position, thin."""
    return tuple(line(*ends, thin=False) for ends in ((O, A), (A, B), (C, B)))
