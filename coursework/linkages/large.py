"""Group of class III or higher at work: Newton's method on its loops, from one position of the driver to the
next."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from coursework.degrees import from_radians
from coursework.errors import CannotAssemble
from coursework.kinematics.chains import ClosedChain, Pose, Vector
from coursework.messages import as_message
from coursework.quantities.graph import Graph

_MOST_WAYS = 64  #: sets of lengths of which the positions on the way are remembered


class LargePose(NamedTuple):
    """Quantities of the loops in a closed pose: lengths in mm, angles in radians."""

    values: Mapping[str, Any]
    condition: Any

    def degrees(self, name: str) -> Any:
        """Return an angle in degrees."""
        return from_radians(self.values[name])


class LargeGroup:
    """Group of four bodies or more, followed from a rough position of it.

    Parameters
    ----------
    loops
        Vectors of its independent loops.
    unknowns
        Names of the angles of its bodies.
    near
        Their rough values, radians, with the driver at ``near_driver``.
    ends
        Of each loop, the joint that closes it.
    driver
        Name of the driver's angle, degrees, or of its length, mm.
    near_driver
        Degrees, or mm.
    step
        Degrees or mm of the driver from one position to the next, over which Newton's method converges.
    functions
        A function that returns those functions of the module that compute the coordinates of the placed
        points.
    """

    def __init__(
        self,
        loops: Sequence[Sequence[Vector]],
        unknowns: Sequence[str],
        near: Mapping[str, float],
        ends: Sequence[str],
        driver: str,
        near_driver: float,
        step: float,
        functions: Callable[[], Sequence[Callable[..., Any]]],
    ) -> None:
        self.chain = ClosedChain(loops, unknowns)
        self.near, self.driver, self.near_driver, self.step = near, driver, near_driver, step
        self._ends = ends
        self._is_angle = driver.startswith("theta")
        self._functions = functions
        self._ways: dict[tuple, dict[int, Mapping[str, Any]]] = {}
        self._turns = {v.turn for loop in loops for v in loop if isinstance(v.turn, str)}

    @cached_property
    def _graph(self) -> Graph:
        return Graph({f.__name__: f for f in self._functions()})

    def pose(self, given: Mapping[str, Any]) -> LargePose:
        """Return the pose of the group.

        Parameters
        ----------
        given
            Quantities that place the mechanism: the driver's angle in degrees, lengths in mm; scalars or
            arrays that broadcast.

        Returns
        -------
        The pose; NaN in arrays where the group does not close.

        Raises
        ------
        CannotAssemble
            Scalars only: the group does not close, here or on the way from the rough position.
        """
        target = given[self.driver]
        way = np.asarray(target, dtype=float) - self.near_driver
        if self._is_angle:
            way = (way + 180.0) % 360.0 - 180.0
        if any(np.ndim(v) for n, v in given.items() if n != self.driver):
            start = self._followed(given, way)
        elif np.ndim(way):
            start = self._passed_each(given, way)
        else:
            start = self._passed(given, float(way))
        known = self._known(given)
        pose = self._closed(known, start)
        return LargePose({**known, **pose.values}, pose.condition)

    def _followed(self, given: Mapping[str, Any], way: Any) -> Mapping[str, Any]:
        """Return poses a step before those of arrays, each followed on its own way."""
        count = int(np.ceil(np.max(np.abs(way), initial=0.0, where=np.isfinite(way)) / self.step))
        start: Mapping[str, Any] = self.near
        for number in range(count):
            place = self.near_driver + way * number / count
            start = self.chain.solve(self._known({**given, self.driver: place}), start).values
        return start

    def _passed_each(self, given: Mapping[str, Any], way: np.ndarray) -> Mapping[str, Any]:
        """Return the poses at the last whole step before each of several positions; NaN beyond a place that
        cannot be passed."""
        steps = np.where(np.isfinite(way), np.trunc(way / self.step), 0).astype(int)
        poses: dict[int, Mapping[str, Any]] = {}
        for sign in (1, -1):
            for number in range(int(np.max(sign * steps, initial=0)) + 1):
                try:
                    poses[sign * number] = self._passed(given, sign * number * self.step)
                except CannotAssemble:
                    break
        nowhere = dict.fromkeys(self.near, np.nan)
        return {
            n: np.reshape([poses.get(k, nowhere)[n] for k in steps.ravel().tolist()], steps.shape)
            for n in self.near
        }

    def _passed(self, given: Mapping[str, Any], way: float) -> Mapping[str, Any]:
        """Return the pose at the last whole step before a position; steps of one set of lengths are
        remembered."""
        key = tuple((n, float(v)) for n, v in sorted(given.items()) if n != self.driver)
        if len(self._ways) > _MOST_WAYS:
            self._ways.clear()
        poses = self._ways.setdefault(key, {0: self.near})
        sign, count = (1 if way > 0 else -1), int(abs(way) / self.step)
        for number in range(1, count + 1):
            if sign * number not in poses:
                place = self.near_driver + sign * number * self.step
                before = poses[sign * (number - 1)]
                known = self._known({**given, self.driver: place})
                try:
                    poses[sign * number] = self._closed(known, before).values
                except CannotAssemble as fault:
                    raise CannotAssemble(
                        "followed from near, {driver} = {start:.6g} {unit}, they cannot pass {driver} = "
                        "{place:.6g} {unit}: {problem}",
                        unit="deg" if self._is_angle else "mm",
                        driver=self.driver,
                        start=self.near_driver,
                        place=place,
                        problem=as_message(fault),
                    ) from fault
        return poses[sign * count]

    def _closed(self, known: Mapping[str, Any], start: Mapping[str, Any]) -> Pose:
        """Return the pose nearest to another; where it does not close, scalars say at which joint."""
        try:
            return self.chain.solve(known, start)
        except CannotAssemble as fault:
            values = as_message(fault).values
            raise CannotAssemble(
                "a gap of {residual:.3g} mm is left at {joint}; another place in near may close, or none "
                "exists",
                residual=values["residual"],
                joint=self._ends[values["loop"] - 1],
            ) from fault

    def _known(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Return what the loops know with the driver at an angle."""
        graph = self._graph
        names = tuple(n for n in self.chain.known if n in graph.names and n not in values)
        moved = graph.evaluate(names, {n: v for n, v in values.items() if n in graph.leaves}) if names else {}
        merged = {**values, **moved}
        return {n: np.radians(merged[n]) if n in self._turns else merged[n] for n in self.chain.known}

    def rates(self, pose: LargePose, order: int, moving: Mapping[str, Sequence[Any]]) -> Mapping[str, tuple]:
        """Return the time derivatives of the angles of the bodies.

        Parameters
        ----------
        pose
            The pose.
        order
            Highest order of the derivatives, 1 or 2.
        moving
            Derivatives of the coordinates of placed points, mm/s and mm/s^2.

        Returns
        -------
        By name the derivatives of each angle, rad/s and rad/s^2.

        Raises
        ------
        Undefined
            Scalars only: a dead point.
        """
        return self.chain.rates(pose.values, moving, order=order)
