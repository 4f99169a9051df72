"""Functions of the driver's angle as a table over the turn, accurate to rounding: built by Fourier series,
evaluated by polynomials.

What is periodic and smooth is known everywhere once it is known at enough equal steps: the number of steps is
doubled until the series has run out. Between finer steps, values and two derivatives of the series give a
polynomial of the fifth degree, which costs little to read.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

TURN = 2 * math.pi
_FIRST, _MOST = 64, 8192  #: steps at which a series is tried
_RUN_OUT = 1e-13  #: of a function's size: what the last third of its series may hold
_FINEST = 16384  #: steps of the polynomials

#: From angles (n,) in radians to values (m, n), and what each of the m is measured by: the size of the terms
#: that it is made of, so that what is nothing but rounding counts as nothing.
Functions = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


class TurnTable:
    """Tabulated functions of an angle.

    Attributes
    ----------
    steps
        How many steps of the turn the series took; 0 where none was found.
    error
        The largest of what the tails of the series hold, over each function's size.
    """

    def __init__(self, functions: Functions) -> None:
        self.steps, self.error = 0, math.inf
        count = _FIRST
        while count <= _MOST:
            values, sizes = functions(np.arange(count) * (TURN / count))
            if not np.isfinite(values).all():
                return
            series = np.fft.rfft(values, axis=1) / count
            self.error = self._tail(series, np.maximum(sizes, np.abs(values).max(axis=1)))
            if self.error < _RUN_OUT:
                self.steps = count
                self._pieces(series)
                return
            count *= 2

    @staticmethod
    def _tail(series: np.ndarray, size: np.ndarray) -> float:
        tail = np.abs(series[:, 2 * series.shape[1] // 3 :]).max(axis=1)
        return float(np.max(tail / np.where(size > 0, size, 1.0), initial=0.0))

    def _pieces(self, series: np.ndarray) -> None:
        """Compute the polynomials between fine steps, coefficients of shape ``(steps, 6, functions)``."""
        order = np.arange(series.shape[1])
        # The error of a fifth-degree polynomial is its step to the sixth times the sixth derivative over
        # 46080.
        bend = (np.abs(series) * order**6.0).sum(axis=1) / np.maximum(np.abs(series).sum(axis=1), 1e-300)
        wanted = TURN * (float(bend.max(initial=1.0)) / (46080 * 1e-15)) ** (1 / 6)
        count = max(2 * (series.shape[1] - 1), 1 << math.ceil(math.log2(min(max(wanted, 64), _FINEST))))
        self._count, self._step = count, TURN / count
        f, f1, f2 = (self._at_nodes(series * (1j * order) ** k, count) * self._step**k for k in range(3))
        g, g1, g2 = (np.roll(x, -1, axis=1) for x in (f, f1, f2))
        rise, slope, bow = g - f - f1 - f2 / 2, g1 - f1 - f2, g2 - f2
        self._coefficients = np.ascontiguousarray(
            np.stack(
                [
                    f,
                    f1,
                    f2 / 2,
                    10 * rise - 4 * slope + bow / 2,
                    -15 * rise + 7 * slope - bow,
                    6 * rise - 3 * slope + bow / 2,
                ]
            ).transpose(2, 1, 0)
        )

    @staticmethod
    def _at_nodes(series: np.ndarray, count: int) -> np.ndarray:
        padded = np.zeros((series.shape[0], count // 2 + 1), dtype=complex)
        padded[:, : series.shape[1]] = series
        return np.fft.irfft(padded * count, count, axis=1)

    def at(self, angle: float) -> np.ndarray:
        """Return the functions at one angle.

        Parameters
        ----------
        angle
            Radians, on any turn.

        Returns
        -------
        Values in the units of the functions, shape ``(m,)``.
        """
        position = angle / self._step
        full = math.floor(position)
        x = position - full
        xx = x * x
        powers = (1.0, x, xx, xx * x, xx * xx, xx * xx * x)
        return self._coefficients[full % self._count] @ powers

    def over(self, angles: np.ndarray) -> np.ndarray:
        """Return the functions at many angles.

        Parameters
        ----------
        angles
            Radians, on any turn, shape ``(n,)``.

        Returns
        -------
        Values in the units of the functions, shape ``(m, n)``.
        """
        position = angles / self._step
        full = np.floor(position)
        powers = (position - full)[:, None] ** np.arange(6)
        return np.einsum("nmp,np->mn", self._coefficients[full.astype(int) % self._count], powers)


class Untabulated:
    """Functions without a table, with the interface of :class:`TurnTable`: computed at each call."""

    steps = 0

    def __init__(self, functions: Functions) -> None:
        self._functions = functions

    def at(self, angle: float) -> np.ndarray:
        """Return the functions at one angle.

        Parameters
        ----------
        angle
            Radians.

        Returns
        -------
        Values in the units of the functions, shape ``(m,)``.
        """
        return self._functions(np.array([angle]))[0][:, 0]

    def over(self, angles: np.ndarray) -> np.ndarray:
        """Return the functions at many angles.

        Parameters
        ----------
        angles
            Radians, shape ``(n,)``.

        Returns
        -------
        Values in the units of the functions, shape ``(m, n)``.
        """
        return self._functions(angles)[0]


def tabulated(functions: Functions) -> TurnTable | Untabulated:
    """Return a table of functions, if they are periodic and smooth.

    Parameters
    ----------
    functions
        From angles in radians, shape ``(n,)``, to values ``(m, n)`` and the sizes of their terms ``(m,)``, in
        any units.

    Returns
    -------
    The table; otherwise the functions with its interface.
    """
    table = TurnTable(functions)
    return table if table.steps else Untabulated(functions)
