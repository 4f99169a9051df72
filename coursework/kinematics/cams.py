"""Cam laws: how a follower rises from rest to rest, and where over a turn it does.

Numbers, arrays and numbers of mpmath; a lift is a share of the whole rise.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from coursework.degrees import cos, sin

#: From the roughest to the smoothest.
LAWS = ("parabolic", "harmonic", "cycloidal", "polynomial_345", "polynomial_4567")


def rise_345(u: Any) -> tuple[Any, Any, Any]:
    """Return the lift, 0 to 1 as ``u`` goes from 0 to 1, and its first and second derivatives by ``u``; at
    rest outside.

    Parameters
    ----------
    u
        Cam angle as a share of the angle of the rise; a scalar or an array.

    Returns
    -------
    The lift as a share of the whole rise, its first and its second derivative, of the same shape.

    Source
    ------
    ``10 u^3 - 15 u^4 + 6 u^5``, in factors that keep the digits near both ends.
    """
    u = np.minimum(np.maximum(u, 0.0), 1.0)
    left = 1.0 - u
    return u**3 * (10.0 - 15.0 * u + 6.0 * u**2), 30.0 * (u * left) ** 2, 60.0 * u * left * (1.0 - 2.0 * u)


def rise_dwell_return(u: Any, dwell: Any, turn: Any) -> tuple[Any, Any]:
    """Return how far a follower's rise has come at the cam angle ``u``, 0 to 1, and +1 while it rises or -1
    while it returns.

    It rises while u goes from 0 to 1, stays up during the dwell, returns as it rose, and stays down for the
    rest of the turn.

    Parameters
    ----------
    u
        Cam angle in units of the angle of a rise, no more than a turn from 0 either way; a scalar or an
        array.
    dwell
        Angle of the upper dwell in the same unit; a scalar or an array that broadcasts.
    turn
        Angle of a whole turn in the same unit, longer than ``2 + dwell``; a scalar or an array that
        broadcasts.

    Returns
    -------
    The share of the rise's angle, from 0 to 1, of which the law gives the lift, and +1 or -1, of the
    broadcast shape.

    Source
    ------
    The motion is symmetric about the middle of the dwell.
    """
    after = u - 1.0 - dwell / 2.0  # the middle of the dwell, about which all is symmetric
    away = np.minimum(abs(after), abs(turn - abs(after)))
    rising = (u >= 0) & (u <= 1)
    share = np.where(rising, u, 1.0 + dwell / 2.0 - away)[()]
    before = (after <= 0) == (abs(after) <= turn / 2.0)
    return np.minimum(np.maximum(share, 0.0), 1.0), np.where(before, 1.0, -1.0)[()]


def _cycloidal(u: Any) -> Any:
    """Return ``u - sin(2 pi u) / (2 pi)``, by its series where both are nearly equal."""
    x = 2.0 * np.pi * u
    small = np.minimum(x, 1.0) ** 2
    series = 0.0 * small
    for n in range(18, 0, -2):  # x^2/3! - x^4/5! + …, from the inside
        series = small / (n * (n + 1)) * (1.0 - series)
    return np.where(x < 1.0, u * series, u - sin(360.0 * u) / (2.0 * np.pi))[()]


def rise(law: Any, u: Any) -> tuple[Any, Any, Any, Any]:
    """Return the lift by one of the :data:`LAWS` and its first three derivatives by ``u``; at rest outside 0
    to 1.

    Parameters
    ----------
    law
        Name of the law; a text or an array of texts that broadcasts.
    u
        Cam angle as a share of the angle of the rise; a scalar or an array.

    Returns
    -------
    The lift as a share of the whole rise, its first, second and third derivatives, of the broadcast shape.
    Where a derivative jumps, at both ends it is that of the rest.
    """
    moving = (u > 0) & (u < 1)
    u = np.minimum(np.maximum(u, 0.0), 1.0)
    left = 1.0 - u
    both, odd, pi = u * left, 1.0 - 2.0 * u, np.pi + 0.0 * u
    half, turn = 180.0 * u, 360.0 * u
    # The second half of each lift is its first one, turned: there no digit is lost near the end.
    low = np.minimum(u, left)
    laws = {
        "parabolic": (2.0 * low**2, 4.0 * np.minimum(u, left), 4.0 * np.sign(odd), 0.0 * u),
        "harmonic": (
            sin(90.0 * low) ** 2,
            pi / 2.0 * sin(half),
            pi**2 / 2.0 * cos(half),
            -(pi**3) / 2.0 * sin(half),
        ),
        "cycloidal": (_cycloidal(low), 2.0 * sin(half) ** 2, 2.0 * pi * sin(turn), 4.0 * pi**2 * cos(turn)),
        "polynomial_345": (rise_345(low)[0], *rise_345(u)[1:], 60.0 - 360.0 * both),
        "polynomial_4567": (
            low**4 * (35.0 - 84.0 * low + 70.0 * low**2 - 20.0 * low**3),
            140.0 * both**3,
            420.0 * both**2 * odd,
            840.0 * both * (1.0 - 5.0 * both),
        ),
    }
    found: list[Any] = [0.0 * u] * 4
    for name, values in laws.items():
        found = [np.where(law == name, value, other)[()] for value, other in zip(values, found, strict=True)]
    lift, slope, *bends = found
    lift = np.where(u > 0.5, 1.0 - lift, lift)[()]
    return lift, slope, np.where(moving, bends[0], 0.0 * u)[()], np.where(moving, bends[1], 0.0 * u)[()]
