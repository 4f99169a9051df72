"""Turning points of smooth periodic functions over one turn, for many variants at once."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

Slope = Callable[..., np.ndarray]

_TURN = 2 * math.pi
_FIRST = 0.1234567  #: where sampling begins: no sample falls on a round angle, where symmetry puts the zeros
_ROWS = 2048  #: variants sampled together, so that memory stays flat
_STEPS = 80  #: a bracket of a degree is halved to nothing in fewer


def turning_points(slope: Slope, parameters: Sequence[Any], *, samples: int = 240) -> np.ndarray:
    """Return the angles of one turn at which a function has a minimum or a maximum.

    Parameters
    ----------
    slope
        ``slope(angle, *parameters)``: the function's derivative, or anything of the same sign, on
        arrays that broadcast. It must be continuous and come back after a turn.
    parameters
        Arrays of shape ``(n,)``, one value a variant.
    samples
        How many angles are looked at first. Two turning points nearer to each other than a sample
        are still found when the slope dips between samples.

    Returns
    -------
    Angles in radians, shape ``(n, k)``, k at least 2; a row holds its own in increasing order from
    0.12 on, less than a turn apart, then NaN. A row whose slope is not finite at some sample
    is NaN throughout.

    Source
    ------
    Changes of sign between samples, refined by Chandrupatla's method (inverse quadratic
    interpolation kept inside the bracket) until the bracket is two neighbouring doubles wide.
    """
    parameters = [np.asarray(p, dtype=float) for p in parameters]
    count = len(parameters[0])
    rows, angles = [np.empty(0, dtype=np.intp)], [np.empty(0)]
    for start in range(0, count, _ROWS):
        points, result = _turning_points(slope, [p[start : start + _ROWS] for p in parameters], samples)
        rows.append(points + start)
        angles.append(result)
    return _in_rows(np.concatenate(rows), np.concatenate(angles), count)


def _turning_points(
    slope: Slope, parameters: list[np.ndarray], samples: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return the row and angle of every turning point."""
    theta = _FIRST + np.arange(samples) * (_TURN / samples)
    with np.errstate(all="ignore"):
        seen = slope(theta, *[p[:, None] for p in parameters])
    seen = np.where(np.isfinite(seen).all(axis=1, keepdims=True), seen, np.nan)
    following = np.roll(seen, -1, axis=1)
    row, column = np.nonzero((seen < 0) & (following >= 0) | (seen >= 0) & (following < 0))
    low, high = theta[column], theta[column] + _TURN / samples
    ends = [(row, low, high, seen[row, column], following[row, column])]
    ends += _dips(slope, parameters, theta, seen)
    row, low, high, at_low, at_high = (np.concatenate(part) for part in zip(*ends, strict=True))
    return row, _zero(lambda angle: slope(angle, *[p[row] for p in parameters]), low, high, at_low, at_high)


def _dips(slope: Slope, parameters: list[np.ndarray], theta: np.ndarray, seen: np.ndarray) -> list[tuple]:
    """Return brackets of two zeros between neighbouring samples of one sign, where the slope crosses zero and
    back."""
    before, after = np.roll(seen, 1, axis=1), np.roll(seen, -1, axis=1)
    sign = np.where(seen < 0, -1.0, 1.0)
    bend = sign * (before + after - 2 * seen)
    with np.errstate(all="ignore"):
        # What a parabola through the three samples would reach.
        bottom = sign * seen - (after - before) ** 2 / (8 * bend)
    lowest = (sign * (before - seen) >= 0) & (sign * (after - seen) >= 0) & (bend > 0)
    one_sign = (sign * before > 0) & (sign * after > 0)
    row, column = np.nonzero(lowest & one_sign & (bottom < 0.5 * abs(seen)))
    if not len(row):
        return []
    sign, step = sign[row, column], _TURN / len(theta)
    row_parameters = [p[row] for p in parameters]
    deepest, depth = _lowest(
        lambda angle: sign * slope(angle, *row_parameters), theta[column] - step, theta[column] + step
    )
    through = depth < 0
    row, column, sign, deepest, depth = (x[through] for x in (row, column, sign, deepest, depth))
    left, right = theta[column] - step, theta[column] + step
    return [
        (row, left, deepest, before[row, column], sign * depth),
        (row, deepest, right, sign * depth, after[row, column]),
    ]


def _lowest(f: Slope, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the abscissa and the minimum of a function with one dip in each bracket, by golden sections."""
    ratio = (math.sqrt(5) - 1) / 2
    left, right = high - ratio * (high - low), low + ratio * (high - low)
    at_left, at_right = f(left), f(right)
    for _ in range(45):
        lower = at_left < at_right
        low, high = np.where(lower, low, left), np.where(lower, right, high)
        stored, at_kept = np.where(lower, left, right), np.where(lower, at_left, at_right)
        new = np.where(lower, high - ratio * (high - low), low + ratio * (high - low))
        at_new = f(new)
        left, right = np.where(lower, new, stored), np.where(lower, stored, new)
        at_left, at_right = np.where(lower, at_new, at_kept), np.where(lower, at_kept, at_new)
    return np.where(at_left < at_right, left, right), np.minimum(at_left, at_right)


def _zero(f: Slope, low: np.ndarray, high: np.ndarray, at_low: np.ndarray, at_high: np.ndarray) -> np.ndarray:
    """Return the zero in each bracket; the function has opposite signs at its ends."""
    a, b, fa, fb = high, low, at_high, at_low
    c, fc = a, fa
    t = np.full(a.shape, 0.5)
    best, done = np.where(abs(fa) < abs(fb), a, b), np.zeros(a.shape, dtype=bool)
    with np.errstate(all="ignore"):
        for _ in range(_STEPS):
            x = a + t * (b - a)
            fx = f(x)
            same = (fx < 0) == (fa < 0)
            c, fc = np.where(same, a, b), np.where(same, fa, fb)
            b, fb = np.where(same, b, a), np.where(same, fb, fa)
            a, fa = x, fx
            # A bracket that is narrow enough keeps its zero, whatever the others still need.
            best = np.where(done, best, np.where(abs(fa) < abs(fb), a, b))
            least = 2 * np.finfo(float).eps * abs(best) / abs(b - a)
            done |= ~(least <= 0.5) | (fa == 0) | (fb == 0)
            if done.all():
                break
            xi, phi = (a - b) / (c - b), (fa - fb) / (fc - fb)
            quadratic = (phi**2 < xi) & ((1 - phi) ** 2 < 1 - xi)
            inverse = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
            least = np.minimum(least, 0.5)
            t = np.clip(np.where(quadratic & np.isfinite(inverse), inverse, 0.5), least, 1 - least)
    return best


def _in_rows(rows: np.ndarray, angles: np.ndarray, count: int) -> np.ndarray:
    """Return the angles as a table, one variant a row, filled up with NaN."""
    angles = np.mod(angles - _FIRST, _TURN) + _FIRST
    order = np.lexsort((angles, rows))
    rows, angles = rows[order], angles[order]
    sizes = np.bincount(rows, minlength=count)
    table = np.full((count, max(2, int(sizes.max(initial=0)))), np.nan)
    table[rows, np.arange(len(rows)) - (np.cumsum(sizes) - sizes)[rows]] = angles
    return table
