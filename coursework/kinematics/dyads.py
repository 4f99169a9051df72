"""Assour groups of two bodies, in closed form.

Points are complex numbers, angles radians, lengths one common unit; every argument is a scalar or
an array and all broadcast. What does not close raises :class:`CannotAssemble` when every argument is
a scalar, and is NaN there and only there in arrays.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from coursework.errors import CannotAssemble

OPEN, CROSSED = 1, -1  #: sides of the inner joint: left of the directed line P -> Q, or right


def side_of(mode: Any) -> Any:
    """+1 for ``open`` (or ``left``), -1 for ``crossed`` (or ``right``); arrays of texts too."""
    if isinstance(mode, str):
        return {"open": OPEN, "left": OPEN, "crossed": CROSSED, "right": CROSSED}[mode]
    return np.where(np.isin(mode, ("open", "left")), OPEN, CROSSED)


def rrr(p: Any, q: Any, p_length: Any, q_length: Any, side: Any = OPEN) -> Any:
    """Inner joint B of the dyad of three revolutes: |B - p| = p_length, |B - q| = q_length.

    Parameters
    ----------
    p, q
        End points, complex.
    p_length, q_length
        Lengths of the bodies pinned at p and at q, positive.
    side
        +1 when B lies left of the directed line p -> q (``open``), -1 when right (``crossed``).

    Returns
    -------
    B, complex, of the broadcast shape.

    Raises
    ------
    CannotAssemble
        Scalars only: the circles do not meet, with the gap in figures.

    Source
    ------
    Intersection of two circles. The triangle's area is the product of its four margins (Heron), so
    that it is exactly zero where the bodies line up.
    """
    line = q - p
    distance = abs(line)
    longer, shorter, inner = (
        p_length + q_length - distance,
        distance - p_length + q_length,
        distance + p_length - q_length,
    )
    product = (p_length + q_length + distance) * longer * shorter * inner
    if isinstance(product, float):
        if distance == 0.0 or product < 0.0:
            raise out_of_reach(distance, p_length, q_length)
        height = math.sqrt(product) / 2
    else:
        with np.errstate(invalid="ignore", divide="ignore"):
            height = np.sqrt(product) / 2
    along = (distance * distance + (p_length - q_length) * (p_length + q_length)) / 2
    with np.errstate(invalid="ignore", divide="ignore"):
        return p + line * (along + 1j * side * height) / (distance * distance)


def out_of_reach(
    distance: float, p_length: float, q_length: float, gap: float | None = None
) -> CannotAssemble:
    """The error for two bodies that do not span the distance between their pins, with the gap."""
    least, most = abs(p_length - q_length), p_length + q_length
    gap = max(distance - most, least - distance) if gap is None else gap
    return CannotAssemble(
        f"the linkage does not close: the pins are {distance:.6g} apart, but the two bodies "
        f"{p_length:.6g} and {q_length:.6g} reach only {least:.6g} to {most:.6g} (gap {gap:.3g})"
    )


def rrp(p: Any, length: Any, y: Any, side: Any = 1) -> Any:
    """Slider pinned to a rod: the point of the horizontal line ``y`` at ``length`` from ``p``.

    ``side`` is +1 when the slider lies to the right of ``p`` (+x), -1 to the left. Complex, of the
    broadcast shape.

    Raises
    ------
    CannotAssemble
        Scalars only: the rod is shorter than the distance of ``p`` from the line.
    """
    px, py = (p.real, p.imag)
    rise = y - py
    product = (length - rise) * (length + rise)
    if isinstance(product, float):
        if product < 0.0:
            raise CannotAssemble(
                f"the linkage does not close: the line is {abs(rise):.6g} away from the pin, but the rod "
                f"reaches only {length:.6g} (gap {abs(rise) - length:.3g})"
            )
        run = math.sqrt(product)
    else:
        with np.errstate(invalid="ignore"):
            run = np.sqrt(product)
    return px + side * run + 1j * y
