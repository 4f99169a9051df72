"""The loads of a scene, at every instant of a turn: how large, which way, and on which stroke."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from coursework.errors import WrongValue, unknown
from coursework.mechanics.linkage import Held, Linkage
from coursework.mechanics.rates import Stance
from coursework.mechanics.statement import Load
from coursework.mechanics.wrenches import Wrench

STROKES = ("always", "working stroke", "return stroke", "forward", "backward")
_EVEN = math.radians(0.05)  #: two strokes whose lengths differ by less are as long as each other

By = Callable[[str, Stance], np.ndarray]  #: a position of the exercise over the instants, in its unit


@dataclass(frozen=True)
class Acting:
    """A load of a mechanism.

    Its force is a *pull* of one newton (or one N m) along a line that goes on smoothly through the turn, times a size. Of a
    load against the motion the line is that of the motion, and its ``pace`` along it tells which way the pull goes.
    """

    linkage: Linkage
    load: Load

    def __post_init__(self) -> None:
        mechanism = self.linkage.mechanism
        known = (*mechanism.points, *mechanism.names)
        if self.load.on not in known:
            raise unknown("point or body", self.load.on, known, "the mechanism")
        if self.load.during not in STROKES:
            raise unknown("stroke", self.load.during, STROKES, f"the load on {self.load.on}")
        if self.load.body and self.load.body not in mechanism.holders(self.load.on):
            raise unknown(
                "body", self.load.body, mechanism.holders(self.load.on), f"those that hold {self.load.on}"
            )

    @property
    def is_moment(self) -> bool:
        """Whether it turns a body."""
        names = self.linkage.mechanism.names
        return self.load.on in names and (
            bool(self.load.moment) or self.load.on not in self.linkage.mechanism.points
        )

    @property
    def turns_over(self) -> bool:
        """Whether it changes its way with that of the motion."""
        return self.load.against

    @property
    def size(self) -> float:
        """Newtons or newton metres, where no table says it."""
        return float(self.linkage.number(self.load.moment if self.is_moment else self.load.force))

    @property
    def _held(self) -> Held:
        """Where its force acts."""
        body = self.load.body or self.linkage.mechanism.holders(self.load.on)[-1]
        return self.linkage.held(self.load.on, body)

    def _line(self, stance: Stance) -> np.ndarray | complex:
        """Of the pull: a unit vector."""
        if not self.load.against:
            return complex(np.exp(1j * math.radians(self.linkage.number(self.load.angle))))
        for slide in self.linkage.slides:
            if (
                slide.on == -1
                and self.load.on in self.linkage.mechanism.body(self._name(slide.of.body)).places
            ):
                return slide.along
        rate = stance.rate(self._held)
        with np.errstate(all="ignore"):
            return np.where(rate == 0, 0, rate / np.abs(rate))

    def _name(self, body: int) -> str:
        return self.linkage.mechanism.names[body]

    def pull(self, stance: Stance) -> Wrench:
        """One newton along the line, or one N m."""
        if self.is_moment:
            return Wrench.none(stance).turn(self.linkage.index[self.load.on], 1.0)
        return Wrench.none(stance).push(self._held, self._line(stance))

    def pace(self, stance: Stance) -> np.ndarray:
        """How fast what it acts on goes along the line, for one of the driver."""
        if self.is_moment:
            return stance.rates[self.linkage.index[self.load.on]]
        line = self._line(stance)
        return (np.conj(line) * stance.rate(self._held)).real

    def sizes(self, stance: Stance, driver: np.ndarray, by: By) -> np.ndarray:
        """How large it is at each instant, along the line; ``driver`` in radians."""
        if not self.load.table:
            return np.full(stance.count, self.size)
        at, size = (np.array(column, dtype=float) for column in zip(*self.load.table, strict=True))
        if self.load.by in ("", self.linkage.driver):
            return np.interp(np.degrees(driver), at, size, period=360.0)
        return np.interp(by(self.load.by, stance), at, size)

    @property
    def knots(self) -> list[float]:
        """Driver's angles, radians, at which a table by the angle has a corner."""
        if not self.load.table or self.load.by not in ("", self.linkage.driver):
            return []
        return [math.radians(at) for at, _ in self.load.table]


@dataclass(frozen=True)
class Strokes:
    """When a load acts: everywhere, or where what it acts on goes forward (+1) or backward (-1) along its line."""

    way: int = 0

    def acts(self, pace_sign: Any) -> Any:
        """1 where it acts, for the sign of the pace with the driver turning forward."""
        return np.ones_like(pace_sign) if not self.way else (pace_sign == self.way) * 1.0


def strokes(acting: Acting, forward: float, backward: float, driver_way: int) -> Strokes:
    """When a load acts, for how much of the driver's turn (radians) its point goes forward and backward.

    ``driver_way``: whether the driver turns forward (1) or backward (-1), as "forward" is seen by the point.

    Raises
    ------
    WrongValue
        A working stroke where neither takes longer.
    """
    during = acting.load.during
    if during == "always":
        return Strokes()
    if during in ("forward", "backward"):
        return Strokes(driver_way if during == "forward" else -driver_way)
    if abs(forward - backward) < _EVEN:
        raise WrongValue(
            f"the load on {acting.load.on} acts during the {during}, the longer one or the other: here both take as long; "
            "say during = 'forward' or 'backward' (along its line)"
        )
    longer = 1 if forward > backward else -1
    return Strokes(longer if during == "working stroke" else -longer)
