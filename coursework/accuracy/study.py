"""What a solution states to take part in the measurement of accuracy against time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from coursework.errors import BadCourse
from coursework.kinematics.chains import Vector


@dataclass(frozen=True)
class Motion:
    """A motion in time that is integrated at several tolerances.

    The only effect is ``inertia``, under a constant effort of the driver: then the speed follows from the
    energy at every angle, and the time from an integral, so that there is something exact to compare with.
    ``given`` are values that replace the generic ones; ``duration`` is in seconds.
    """

    effort: float
    duration: float
    given: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Study:
    """Which quantities to compute, where it is easy and where it is hard, and the equations behind them.

    Attributes
    ----------
    given
        The mechanism at generic places, in canonical units, without the driver's angle.
    positions, rates
        Quantities that the driver moves, and their time derivatives in the same order.
    hard
        Values that replace the generic ones at hard places; the driver's angle is a sequence, in degrees.
    loops, unknowns
        The loop-closure equations as for :class:`coursework.kinematics.chains.Chain`, in the names of the
        quantities; the unknowns are among the positions.
    motion
        A motion in time, for exercises whose driver has an effort.
    """

    given: Mapping[str, Any]
    positions: tuple[str, ...] = ()
    rates: tuple[str, ...] = ()
    hard: Mapping[str, Any] = field(default_factory=dict)
    loops: Sequence[Sequence[Vector]] = ()
    unknowns: tuple[str, ...] = ()
    motion: Motion | None = None

    def __post_init__(self) -> None:
        if len(self.rates) not in (0, len(self.positions)):
            raise BadCourse("a study names a rate for each position, in the same order")
        if not set(self.unknowns) <= set(self.positions):
            raise BadCourse("the unknowns of a study's loops are among its positions")
