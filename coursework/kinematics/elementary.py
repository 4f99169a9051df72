"""Tangent and arctangent of small arguments by sums, products and quotients alone.

They are as fast as those on every processor, where numpy computes its own one number at a time unless it has
functions for the vector units. Scalars or arrays; errors are below an ulp and a half of the result, near 0
too.

Each is x + x^3 P / Q of x^2, where polynomials P and Q interpolate the function at Chebyshev's points, but
for 2e-17 of it.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

import numpy as np

#: By powers of x^2 up to (pi / 4)^2; Q ends in 1.
_TANGENT = (
    (-1302.3188441206676, 83.76905249594094, -0.9564360936565884, 6.97815609748647e-05),
    (-3906.9565323620027, 1814.0897704326237, -95.9503493096904),
)
#: By powers of x^2 up to 1.
_ARCTANGENT = (
    (
        -404.44958201411697,
        -905.3726290655958,
        -709.2810809323058,
        -230.9790943899718,
        -28.6344514670043,
        -0.9024525862982413,
    ),
    (
        1213.3487460423516,
        3444.127134821938,
        3674.312918256491,
        1825.9201295139483,
        423.8789826719409,
        39.96465648522898,
    ),
)


def tangent(angle: Any) -> Any:
    """Return the tangent of radians of at most an eighth of a turn, of either sign.

    Parameters
    ----------
    angle
        Radians from -pi / 4 to pi / 4; a scalar or an array.

    Returns
    -------
    The tangent, of the same shape.
    """
    return _plus_cubed(angle, *_TANGENT)


def quotient_arctangent(tangent: Any) -> Any:
    """Return the arctangent in radians of a tangent from -1 to 1.

    Parameters
    ----------
    tangent
        Number from -1 to 1; a scalar or an array.

    Returns
    -------
    Radians from -pi / 4 to pi / 4, of the same shape.
    """
    return _plus_cubed(tangent, *_ARCTANGENT)


def _numpy_has_one() -> bool:
    """Return whether numpy has an arctangent for this processor's vector units."""
    units = np.show_config(mode="dicts").get("SIMD Extensions", {}).get("found", ())
    return sys.platform.startswith("linux") and not {"AVX512_SKX", "X86_V4"}.isdisjoint(units)


#: The faster of the two here.
arctangent = np.arctan if _numpy_has_one() else quotient_arctangent


def _plus_cubed(x: Any, above: Sequence[float], below: Sequence[float]) -> Any:
    """Return x + x^3 P / Q, computed in place so that few long arrays are in the cache."""
    squared = x * x
    result = above[-1] * squared
    result += above[-2]
    result = _horner(result, above[:-2], squared)
    result /= _horner(squared + below[-1], below[:-1], squared)
    result *= squared
    result *= x
    result += x
    return result


def _horner(result: Any, lower: Sequence[float], x: Any) -> Any:
    """Evaluate a polynomial by Horner's rule, from the value of its highest terms and the lower
    coefficients."""
    for coefficient in reversed(lower):
        result *= x
        result += coefficient
    return result
