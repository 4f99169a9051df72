"""Loop-closure equations as plain sums in any arithmetic: floats, arrays, complex numbers."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from coursework.kinematics.chains import Vector

Function = Callable[[Any], Any]


class Closure:
    """Projections of the loops on x and y, and their derivatives by the unknowns.

    Lengths in one unit, angles in radians. ``cos`` and ``sin`` decide the arithmetic.
    """

    def __init__(self, loops: Sequence[Sequence[Vector]], unknowns: Sequence[str]) -> None:
        self.loops, self.unknowns = loops, tuple(unknowns)
        self.angles = {a for loop in loops for v in loop for a in (v.angle, v.turn) if isinstance(a, str)}

    def gaps(self, values: Mapping[str, Any], cos: Function = np.cos, sin: Function = np.sin) -> list[Any]:
        """Return the gap of each loop, along x and y in turn."""
        results = []
        for loop in self.loops:
            x = y = 0.0
            for v in loop:
                length, turned = self._polar(v, values)
                x, y = x + length * cos(turned), y + length * sin(turned)
            results += [x, y]
        return results

    def jacobian(
        self, values: Mapping[str, Any], cos: Function = np.cos, sin: Function = np.sin
    ) -> list[list[Any]]:
        """Return the Jacobian: rows as in :meth:`gaps`, a column for each unknown."""
        rows = []
        for loop in self.loops:
            of_x = dict.fromkeys(self.unknowns, 0.0)
            of_y = dict.fromkeys(self.unknowns, 0.0)
            for v in loop:
                length, turned = self._polar(v, values)
                if v.length in of_x:
                    of_x[v.length] = of_x[v.length] + v.sign * cos(turned)
                    of_y[v.length] = of_y[v.length] + v.sign * sin(turned)
                if v.angle in of_x:
                    of_x[v.angle] = of_x[v.angle] - length * sin(turned)
                    of_y[v.angle] = of_y[v.angle] + length * cos(turned)
            rows += [list(of_x.values()), list(of_y.values())]
        return rows

    def newton(self, given: Mapping[str, Any], start: Sequence[Any], steps: int) -> list[Any]:
        """Return the unknowns after a number of Newton steps, on arrays, real or complex."""
        x = list(start)
        for _ in range(steps):
            values = {**given, **dict(zip(self.unknowns, x, strict=True))}
            step = _solved(self.jacobian(values), self.gaps(values))
            x = [old - change for old, change in zip(x, step, strict=True)]
        return x

    @staticmethod
    def _polar(v: Vector, values: Mapping[str, Any]) -> tuple[Any, Any]:
        length = values[v.length] if isinstance(v.length, str) else v.length
        angle = values[v.angle] if isinstance(v.angle, str) else v.angle
        turn = values[v.turn] if isinstance(v.turn, str) else v.turn
        return v.sign * length, angle + turn


def _solved(matrix: list[list[Any]], right: list[Any]) -> list[Any]:
    """Solve many small linear systems: two unknowns by Cramer's rule, more by elimination."""
    if len(right) == 2:
        (a, b), (c, d) = matrix
        inverse = 1.0 / (a * d - b * c)
        return [(right[0] * d - b * right[1]) * inverse, (a * right[1] - right[0] * c) * inverse]
    flat = np.broadcast_arrays(*[entry for row in matrix for entry in row], *right)
    count = len(right)
    stacked = np.stack(flat[: count * count], axis=-1).reshape(*flat[0].shape, count, count)
    try:
        result = np.linalg.solve(stacked, np.stack(flat[count * count :], axis=-1)[..., None])[..., 0]
    except np.linalg.LinAlgError:
        return [np.full_like(right[0], np.nan)] * count
    return [result[..., i] for i in range(count)]
