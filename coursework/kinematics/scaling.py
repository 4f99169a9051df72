"""Scaling by exact powers of two: squares of lengths neither overflow nor vanish, and no digit changes."""

from __future__ import annotations

from typing import Any

import numpy as np


def exponent_of(*lengths: Any) -> Any:
    """Return the integer k with the longest of the lengths in [2**(k-1), 2**k), elementwise; 0 if there is
    none.

    Dividing all lengths of a linkage by ``2**k`` is exact, so that a result scaled back is, bit for
    bit, that of the linkage in any other unit that is a power of two of the first.

    Parameters
    ----------
    lengths
        Lengths in one unit, of either sign; scalars or arrays that broadcast.

    Returns
    -------
    The integer, of the broadcast shape; 0 as well where the longest length is not finite.
    """
    longest = np.abs(lengths[0])
    for length in lengths[1:]:
        longest = np.maximum(longest, np.abs(length))
    return np.where(np.isfinite(longest), np.frexp(longest)[1], 0)


def scaled(value: Any, exponent: Any) -> Any:
    """Return ``value * 2**exponent``, exactly; complex values too.

    Parameters
    ----------
    value
        Real or complex numbers; a scalar or an array.
    exponent
        Integers; a scalar or an array that broadcasts.

    Returns
    -------
    Floats or complex numbers, of the broadcast shape.
    """
    value = np.asarray(value)
    if np.iscomplexobj(value):
        result = np.empty(np.broadcast_shapes(value.shape, np.shape(exponent)), dtype=complex)
        result.real, result.imag = np.ldexp(value.real, exponent), np.ldexp(value.imag, exponent)
        return result
    return np.ldexp(value.astype(float, copy=False), exponent)
