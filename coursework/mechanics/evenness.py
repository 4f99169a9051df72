"""Evenness of rotation: the mean effort of a turn, the energy that a flywheel stores, and its size."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from coursework.errors import Undefined


@dataclass(frozen=True)
class Evenness:
    """Effort of a drive over a turn at a constant rate.

    Parameters
    ----------
    efforts
        Effort at equal steps of the turn, N m, shape ``(n,)``.
    speed
        Rate of the driver, rad/s.

    Raises
    ------
    Undefined
        The effort does not exist somewhere on the turn.

    Source
    ------
    The energy that a drive of constant torque lacks and has in excess is kept by the flywheel; for a small
    unevenness (largest - least speed) / mean speed it is J (mean speed)^2 times the unevenness.
    """

    efforts: np.ndarray
    speed: float

    def __post_init__(self) -> None:
        if (missing := np.isnan(self.efforts)).any():
            at = 360.0 * np.flatnonzero(missing)[0] / len(self.efforts)
            raise Undefined(
                "a flywheel is sized over a whole turn; here the drive's effort does not exist at "
                "{missing} of {count} angles, first at {at:g} degrees",
                missing=int(missing.sum()),
                count=len(missing),
                at=at,
            )

    @property
    def mean_torque(self) -> float:
        """Mean torque of the drive over a turn, N m."""
        return float(np.mean(self.efforts))

    @cached_property
    def excess_energy(self) -> float:
        """Largest energy that a flywheel stores and returns over a turn at the mean torque, J."""
        step = 2 * np.pi / len(self.efforts)
        return float(np.ptp(np.cumsum(self.mean_torque - self.efforts) * step))

    def inertia_for(self, unevenness: float) -> float:
        """Return the moment of inertia of the flywheel for an unevenness.

        Parameters
        ----------
        unevenness
            Ratio without unit, positive; a scalar or an array.

        Returns
        -------
        The moment of inertia, kg m^2, of the same shape.
        """
        return self.excess_energy / (unevenness * self.speed**2)

    def unevenness_of(self, inertia: float) -> float:
        """Return the unevenness with a flywheel.

        Parameters
        ----------
        inertia
            Moment of inertia of the flywheel, kg m^2, positive; a scalar or an array.

        Returns
        -------
        The ratio, without unit, of the same shape.
        """
        return self.excess_energy / (inertia * self.speed**2)
