"""Loads of a scene at every instant of a turn: size, direction and stroke."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from coursework.errors import WrongValue, unknown
from coursework.mechanics.linkage import BodyPoint, Linkage
from coursework.mechanics.rates import Stance, no_rounding
from coursework.mechanics.statement import Load, Place
from coursework.mechanics.wrenches import BodyWrenches
from coursework.messages import Message

STROKES = ("always", "working stroke", "return stroke", "forward", "backward")
_EVEN = math.radians(0.05)  #: two strokes whose lengths differ by less are as long as each other

#: A position of the exercise at driver's angles, radians, in its unit.
By = Callable[[str, np.ndarray], np.ndarray]


@dataclass(frozen=True)
class AppliedLoad:
    """Load of a mechanism.

    Its force is a *pull* of 1 N (or 1 N m) along a line that varies smoothly over the turn, times a size. For
    a load against the motion the line is that of the motion, and the sign of its ``pace`` gives the direction
    of the pull.

    Raises
    ------
    UnknownName
        A point, a body or a stroke does not exist.
    WrongValue
        A force on a body, a moment on a point, a stroke of a point that goes along no line.
    """

    linkage: Linkage
    load: Load
    by: By | None = None

    def __post_init__(self) -> None:
        load, mechanism = self.load, self.linkage.mechanism
        known_names = (*mechanism.points, *mechanism.names)
        if load.on not in known_names:
            raise unknown("point or body", load.on, known_names, Message("the mechanism"))
        if load.during not in STROKES:
            raise unknown("stroke", load.during, STROKES, Message("the load on {place}", place=load.on))
        if load.force and load.on not in mechanism.points:
            raise WrongValue(
                "a force acts on a point, {place} is a body; points are {points}",
                place=load.on,
                points=", ".join(mechanism.points),
            )
        if load.moment and load.on not in mechanism.names:
            raise WrongValue(
                "a moment acts on a body, {place} is a point; bodies are {names}",
                place=load.on,
                names=", ".join(mechanism.names),
            )
        if load.body and load.body not in mechanism.holders(load.on):
            raise unknown(
                "body",
                load.body,
                mechanism.holders(load.on),
                Message("those that hold {place}", place=load.on),
            )
        if load.during != "always" and load.against and not self.is_moment and self._guide is None:
            raise WrongValue(
                "{place} has no strokes: it neither slides on the ground nor turns about a fixed "
                "point; a load on it acts always, or along an angle of its own",
                place=load.on,
            )

    @property
    def is_moment(self) -> bool:
        """True if the load turns a body."""
        mechanism = self.linkage.mechanism
        return bool(self.load.moment) or (
            self.load.on in mechanism.names and self.load.on not in mechanism.points
        )

    @property
    def turns_over(self) -> bool:
        """True if the load reverses with the motion."""
        return self.load.against

    @property
    def _size(self) -> Place:
        """Size in newtons or newton metres, without a table: a number, or a quantity that may move with the
        driver."""
        return self.load.moment if self.is_moment else self.load.force

    @property
    def follows(self) -> str:
        """Quantity that gives the size over the turn; empty for a number or a table by the driver's angle."""
        if self.load.table:
            return "" if self.is_by_angle else self.load.by
        return self._size if isinstance(self._size, str) else ""

    @cached_property
    def constant(self) -> float | None:
        """Size, if it is the same all over the turn; otherwise None."""
        return None if self.load.table or self.follows else float(self.linkage.number(self._size))

    def followed(self, driver: np.ndarray) -> np.ndarray:
        """Return the values of the followed quantity.

        Parameters
        ----------
        driver
            Angles of the driver, radians, of any shape.

        Returns
        -------
        N or N m, or the unit of the quantity by which a table goes, of the same shape.
        """
        return self._at(self.follows, driver)

    def _at(self, name: str, driver: np.ndarray) -> np.ndarray:
        assert self.by is not None  # who names quantities says how they are found
        return np.broadcast_to(self.by(name, driver), np.shape(driver))

    @property
    def _body_point(self) -> BodyPoint:
        """Point of application."""
        body = self.load.body or self.linkage.mechanism.holders(self.load.on)[-1]
        return self.linkage.body_point(self.load.on, body)

    # ---------------------------------------------------------------------- line

    @property
    def _guide(self) -> complex | BodyPoint | None:
        """Path of the loaded point: a direction, or the arm from a fixed point about which it turns."""
        body_point = self._body_point
        for slide in self.linkage.slides:
            if slide.on == -1 and slide.of.body == body_point.body:
                return slide.along
        if body_point.body != -1 and self.linkage.origins[body_point.body].body == -1 and body_point.place:
            return body_point
        return None

    def _line(self, stance: Stance) -> np.ndarray | complex:
        """Return the direction of the pull: a unit vector."""
        if not self.load.against:
            angle = self.load.angle
            if isinstance(angle, str):
                return np.exp(1j * np.radians(self._at(angle, stance.turns[self.linkage.driven])))
            return complex(np.exp(1j * math.radians(self.linkage.number(angle))))
        guide = self._guide
        if isinstance(guide, BodyPoint):
            arm = stance.arm(guide)
            return 1j * arm / np.abs(arm)
        if guide is not None:
            return guide
        rate = stance.rate(self._body_point)
        with np.errstate(all="ignore"):
            return np.where(rate == 0, 0, rate / np.abs(rate))

    def pull(self, stance: Stance) -> BodyWrenches:
        """Return the unit pull along the line.

        Parameters
        ----------
        stance
            The mechanism at ``n`` instants.

        Returns
        -------
        The wrench of 1 N, or of 1 N m.
        """
        if self.is_moment:
            return BodyWrenches.none(stance).turn(self.linkage.index[self.load.on], 1.0)
        return BodyWrenches.none(stance).push(self._body_point, self._line(stance))

    def pace(self, stance: Stance) -> np.ndarray:
        """Return the rate of the loaded point or body along the line for unit speed of the driver.

        Parameters
        ----------
        stance
            The mechanism at ``n`` instants.

        Returns
        -------
        m/rad for a force, rad/rad for a moment, shape ``(n,)``, with rounding errors set to 0.
        """
        if self.is_moment:
            return no_rounding(stance.rates[self.linkage.index[self.load.on]], 1.0)
        return no_rounding((np.conj(self._line(stance)) * stance.rate(self._body_point)).real, stance.size)

    # ---------------------------------------------------------------------- size

    @property
    def is_by_angle(self) -> bool:
        """True if the table goes by the driver's angle."""
        return bool(self.load.table) and self.load.by in ("", self.linkage.driver)

    def sizes(self, driver: np.ndarray, here: np.ndarray | None = None) -> np.ndarray:
        """Return the size along the line, with no regard to stroke and direction.

        Parameters
        ----------
        driver
            Angles of the driver, radians, of any shape.
        here
            Values of the followed quantity (:meth:`followed`), of the same shape, if known.

        Returns
        -------
        N or N m, of the same shape.

        Source
        ------
        A table is interpolated linearly: by the driver's angle around the turn, by another quantity with its
        end values beyond.
        """
        if self.follows and here is None:
            here = self._at(self.follows, driver)
        if not self.load.table:
            return np.full(np.shape(driver), float(self.linkage.number(self._size))) if here is None else here
        at, size = (np.array(column, dtype=float) for column in zip(*self.load.table, strict=True))
        if here is not None:
            return np.interp(here, at, size)
        if at[-1] - at[0] < 360.0:  # straight on to the first value of the next turn
            at, size = np.append(at, at[0] + 360.0), np.append(size, size[0])
        return np.interp(at[0] + np.mod(np.degrees(driver) - at[0], 360.0), at, size)

    @property
    def knots(self) -> list[float]:
        """Driver's angles, radians, at which a table by the angle has a corner."""
        return [math.radians(at) for at, _ in self.load.table] if self.is_by_angle else []


@dataclass(frozen=True)
class Strokes:
    """Stroke on which a load acts: always (0), or where its point moves forward (+1) or backward (-1) along
    the line.

    ``really``: for the actual direction of the driver; otherwise for a driver that turns forward.
    """

    way: int = 0
    really: bool = False

    def along(self, size: Any, pace: Any, driver_way: Any, *, against: bool) -> Any:
        """Return a load's size along its line, signed, 0 outside its stroke.

        Parameters
        ----------
        size
            Size of the load, N or N m; a scalar or an array.
        pace
            Sign of its pace for a driver that turns forward; a scalar or an array that broadcasts.
        driver_way
            Direction of the driver: +1, -1, 0 at rest; a scalar or an array that broadcasts.
        against
            Whether the load opposes the motion.

        Returns
        -------
        N or N m, of the broadcast shape.
        """
        if self.way:
            size = size * ((pace * driver_way if self.really else pace) == self.way)
        return -size * pace * driver_way if against else size


def strokes(acting: AppliedLoad, forward: float, backward: float) -> Strokes:
    """Return the strokes of a load.

    Parameters
    ----------
    acting
        The load.
    forward, backward
        Parts of the driver's turn on which its point moves forward and backward along its line, radians.

    Returns
    -------
    The stroke on which it acts.

    Raises
    ------
    WrongValue
        A working or a return stroke where the two differ by less than 0.05 degrees.
    """
    during = acting.load.during
    if during == "always":
        return Strokes()
    if during in ("forward", "backward"):
        return Strokes(1 if during == "forward" else -1, really=True)
    if abs(forward - backward) < _EVEN:
        raise WrongValue(
            "the load on {place} acts during the {during}, the longer one or the other: here both take "
            "as long; say during = 'forward' or 'backward' (along its line)",
            place=acting.load.on,
            during=Message(during),
        )
    longer = 1 if forward > backward else -1
    return Strokes(longer if during == "working stroke" else -longer)
