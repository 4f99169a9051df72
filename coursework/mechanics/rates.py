"""Motion of a mechanism by its driver: positions, with first and second derivatives by the driver's angle.

Angles follow from the exercise; all else from the joints: a pin holds two points together, a slide lets one
go along the guide alone, a gear rolls. The equations are linear in the derivatives, and solved at every
instant at once. Where the exercise has formulas for the rates of all angles, these are taken instead: near a
dead point they keep the digits that a linear system of nearly parallel bars loses.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import TypeAlias

import numpy as np

from coursework.mechanics.linkage import NONE, BodyPoint, GearJoint, Linkage, SlideJoint

#: First (1) or second (2) derivatives of the unknown coordinates by the driver's angle, shape
#: ``(unknowns, n)``, as an exercise's own formulas give them; None where they do not give all.
Stated: TypeAlias = Callable[[int], np.ndarray | None]


class Stance:
    """Mechanism at ``n`` instants.

    Parameters
    ----------
    linkage
        Its numbers.
    turns
        The angle of each body and of the ground, radians, shape ``(bodies + 1, n)``; what never matters is 0.
    stated
        The exercise's own rates; by the joints alone without.
    shifts
        Where the origins of free bodies lie, by body, metres, shape ``(n,)``.

    Lengths are in metres and complex, x to the right and y up; derivatives are by the driver's angle in
    radians, each computed when it is first asked for. NaN where the mechanism does not close or stands in a
    dead point.
    """

    def __init__(
        self,
        linkage: Linkage,
        turns: np.ndarray,
        stated: Stated | None = None,
        shifts: Mapping[int, np.ndarray] | None = None,
    ) -> None:
        self.linkage = linkage
        self.turns = turns
        self._stated = stated
        self._shifts = shifts or {}

    @property
    def count(self) -> int:
        return self.turns.shape[1]

    @cached_property
    def size(self) -> float:
        """Largest distance from the ground's origin to a body's, metres: the reference length."""
        distances = np.abs(self.origins)
        return float(np.max(distances[np.isfinite(distances)], initial=1e-9))

    @cached_property
    def headings(self) -> np.ndarray:
        """Unit vectors of the frames."""
        return np.cos(self.turns) + 1j * np.sin(self.turns)

    @cached_property
    def origins(self) -> np.ndarray:
        """Origins of the frames; the ground's is 0."""
        result = np.zeros(self.turns.shape, dtype=complex)
        for body, body_point in enumerate(self.linkage.origins):
            result[body] = result[body_point.body] + self.arm(body_point) + self._shifts.get(body, 0.0)
        return result

    def arm(self, body_point: BodyPoint) -> np.ndarray:
        """Return the vector from the origin of a body's frame to a position on it.

        Parameters
        ----------
        body_point
            The position.

        Returns
        -------
        Metres, complex, shape ``(n,)``.
        """
        return body_point.place * self.headings[body_point.body]

    def place(self, body_point: BodyPoint) -> np.ndarray:
        """Return where a position on a body lies in the ground's frame.

        Parameters
        ----------
        body_point
            The position.

        Returns
        -------
        Metres, complex, shape ``(n,)``.
        """
        return self.origins[body_point.body] + self.arm(body_point)

    def direction(self, slide: SlideJoint) -> np.ndarray:
        """Return the directions of a slide.

        Parameters
        ----------
        slide
            The slide.

        Returns
        -------
        Unit vectors, complex, shape ``(n,)``.
        """
        return slide.along * self.headings[slide.on]

    # --------------------------------------------------------------- first order

    @cached_property
    def _partials(self) -> np.ndarray:
        """Derivatives of the origins by each coordinate, shape ``(bodies + 1, coordinates, n)``."""
        bodies, n = self.turns.shape
        result = np.zeros((bodies, self.linkage.unknowns + 1, n), dtype=complex)
        for body, body_point in enumerate(self.linkage.origins):
            result[body] = self._partial(body_point, result)
            if (first := self.linkage.free.get(body)) is not None:
                result[body, first], result[body, first + 1] = 1.0, 1j
        return result

    def _partial(self, body_point: BodyPoint, origins: np.ndarray) -> np.ndarray:
        result = origins[body_point.body].copy()
        if (coordinates := self.linkage.coordinates[body_point.body]) != NONE:
            result[coordinates] += 1j * self.arm(body_point)
        return result

    @cached_property
    def _conditions(self) -> np.ndarray:
        """Coefficients of the joint equations, linear in the rates: shape
        ``(conditions, coordinates, n)``."""
        rows = []
        for pin in self.linkage.pins:
            if pin.closes:
                gap = self._partial(pin.of, self._partials) - self._partial(pin.on, self._partials)
                rows += [gap.real, gap.imag]
        for slide in self.linkage.slides:
            rows.append((np.conj(1j * self.direction(slide)) * self._sliding(slide)).real)
        for gear in self.linkage.gears:
            rows.append(self._rolling(gear))
        shape = (len(rows), self.linkage.unknowns + 1, self.count)
        return np.array(rows) if rows else np.zeros(shape)

    def _sliding(self, slide: SlideJoint) -> np.ndarray:
        """Return the motion of a slide's point relative to the guide's point under it, by each coordinate."""
        moved = self._partial(slide.of, self._partials) - self._partials[slide.on]
        if (coordinates := self.linkage.coordinates[slide.on]) != NONE:
            moved[coordinates] -= 1j * (self.place(slide.of) - self.origins[slide.on])
        return moved

    def _rolling(self, gear: GearJoint) -> np.ndarray:
        row = np.zeros((self.linkage.unknowns + 1, self.count))
        first, second = gear.radii
        for body, share in ((gear.first, first), (gear.second, second), (gear.carrier, -first - second)):
            if (coordinates := self.linkage.coordinates[body]) != NONE:
                row[coordinates] += share
        return row

    def _solved(self, right: np.ndarray) -> np.ndarray:
        """Return the rates of the unknown coordinates for right-hand sides ``(conditions, n)``."""
        if not self.linkage.unknowns:
            return np.zeros((0, self.count))
        matrix = np.moveaxis(self._conditions[:, 1:], -1, 0)
        return solved(matrix, right.T[..., None])[..., 0].T

    @cached_property
    def rates(self) -> np.ndarray:
        """Angular rates of the bodies for unit speed of the driver: shape ``(bodies + 1, n)``."""
        return self._by_body(self._coordinate_rates)

    @cached_property
    def _coordinate_rates(self) -> np.ndarray:
        """First derivatives of all coordinates, including the driver's."""
        unknown = self._stated(1) if self._stated else None
        if unknown is None:
            unknown = self._solved(-self._conditions[:, 0])
        return np.concatenate([np.ones((1, self.count)), unknown])

    def _shifted(self, body: int, coordinates: np.ndarray) -> np.ndarray | float:
        """Return the part of a free body's own coordinates in its origin's motion."""
        first = self.linkage.free.get(body)
        return 0.0 if first is None else coordinates[first] + 1j * coordinates[first + 1]

    def _by_body(self, coordinates: np.ndarray) -> np.ndarray:
        nothing = np.zeros(self.count)
        return np.array(
            [nothing if columns == NONE else coordinates[columns] for columns in self.linkage.coordinates]
        )

    @cached_property
    def origin_rates(self) -> np.ndarray:
        """Velocities of the frames' origins for unit speed of the driver."""
        result = np.zeros(self.turns.shape, dtype=complex)
        for body, body_point in enumerate(self.linkage.origins):
            result[body] = result[body_point.body] + 1j * self.rates[body_point.body] * self.arm(body_point)
            result[body] += self._shifted(body, self._coordinate_rates)
        return result

    def rate(self, body_point: BodyPoint) -> np.ndarray:
        """Return the velocity of a position for unit speed of the driver.

        Parameters
        ----------
        body_point
            The position.

        Returns
        -------
        m/rad, complex, shape ``(n,)``.
        """
        return self.origin_rates[body_point.body] + 1j * self.rates[body_point.body] * self.arm(body_point)

    def acceleration(
        self, body_point: BodyPoint, speed: np.ndarray | float, acceleration: np.ndarray | float
    ) -> np.ndarray:
        """Return the acceleration of a position.

        Parameters
        ----------
        body_point
            The position.
        speed, acceleration
            Those of the driver, rad/s and rad/s^2; scalars or shape ``(n,)``.

        Returns
        -------
        m/s^2, complex, shape ``(n,)``.

        Source
        ------
        ``p'' speed^2 + p' acceleration`` for the derivatives p', p'' of the position by the driver's angle.
        """
        return self.bend(body_point) * speed**2 + self.rate(body_point) * acceleration

    def coriolis(self, slide: SlideJoint, speed: np.ndarray | float) -> np.ndarray:
        """Return the Coriolis term of a slide's point.

        Parameters
        ----------
        slide
            The slide.
        speed
            Speed of the driver, rad/s; a scalar or shape ``(n,)``.

        Returns
        -------
        m/s^2, shape ``(n,)``, signed: to the left of the slide's direction.

        Source
        ------
        Twice the angular velocity of the guide times the sliding velocity.
        """
        return 2 * self.rates[slide.on] * self.sliding(slide) * speed**2

    def sliding(self, slide: SlideJoint) -> np.ndarray:
        """Return the speed of a slide along its direction, for unit speed of the driver.

        Parameters
        ----------
        slide
            The slide.

        Returns
        -------
        m/rad, signed, shape ``(n,)``.
        """
        under = self.place(slide.of) - self.origins[slide.on]
        guide = self.origin_rates[slide.on] + 1j * self.rates[slide.on] * under
        return (np.conj(self.direction(slide)) * (self.rate(slide.of) - guide)).real

    # -------------------------------------------------------------- second order

    @cached_property
    def bends(self) -> np.ndarray:
        """Second derivative of each body's angle by the driver's."""
        return self._by_body(self._coordinate_bends)

    @cached_property
    def _coordinate_bends(self) -> np.ndarray:
        """Second derivatives of all coordinates."""
        unknown = self._stated(2) if self._stated else None
        if unknown is None:
            unknown = self._bent()
        return np.concatenate([np.zeros((1, self.count)), unknown])

    def _bent(self) -> np.ndarray:
        """Return the second derivatives of the unknown coordinates from the joint equations."""
        rows = []
        still = np.zeros(self.turns.shape)
        origins = self._origin_bends(still)
        for pin in self.linkage.pins:
            if pin.closes:
                gap = self._bend(pin.of, origins, still) - self._bend(pin.on, origins, still)
                rows += [gap.real, gap.imag]
        for slide in self.linkage.slides:
            under = self.place(slide.of) - self.origins[slide.on]
            guide = origins[slide.on] - self.rates[slide.on] ** 2 * under
            along = self.direction(slide)
            turned = 2j * self.rates[slide.on] * self.sliding(slide) * along
            rows.append((np.conj(1j * along) * (self._bend(slide.of, origins, still) - guide - turned)).real)
        rows += [np.zeros(self.count) for _ in self.linkage.gears]
        return self._solved(-np.array(rows)) if rows else np.zeros((0, self.count))

    def _origin_bends(self, turning: np.ndarray, coordinates: np.ndarray | None = None) -> np.ndarray:
        result = np.zeros(self.turns.shape, dtype=complex)
        for body, body_point in enumerate(self.linkage.origins):
            result[body] = self._bend(body_point, result, turning)
            if coordinates is not None:
                result[body] += self._shifted(body, coordinates)
        return result

    def _bend(self, body_point: BodyPoint, origins: np.ndarray, turning: np.ndarray) -> np.ndarray:
        """Return the second derivative of a position, for second derivatives of the origins and of the
        bodies' angles."""
        return origins[body_point.body] + (
            1j * turning[body_point.body] - self.rates[body_point.body] ** 2
        ) * self.arm(body_point)

    @cached_property
    def origin_bends(self) -> np.ndarray:
        """Second derivative of the frames' origins by the driver's angle."""
        return self._origin_bends(self.bends, self._coordinate_bends)

    def bend(self, body_point: BodyPoint) -> np.ndarray:
        """Return the second derivative of a position by the driver's angle.

        Parameters
        ----------
        body_point
            The position.

        Returns
        -------
        m/rad^2, complex, shape ``(n,)``.
        """
        return self._bend(body_point, self.origin_bends, self.bends)

    # ---------------------------------------------------------------- certificate

    @cached_property
    def gap(self) -> np.ndarray:
        """Largest gap of the pins that close the loops, metres: rounding, for a correct pose."""
        gaps = [abs(self.place(p.of) - self.place(p.on)) for p in self.linkage.pins if p.closes]
        return np.max(gaps, axis=0) if gaps else np.zeros(self.count)


def no_rounding(pace: np.ndarray, size: float) -> np.ndarray:
    """Return the rates with 0 for those that are mere rounding.

    Parameters
    ----------
    pace
        Rates, m/rad or rad/rad, shape ``(n,)``.
    size
        Size of the mechanism, m; 1 for a turning body.

    Returns
    -------
    The rates, in their unit and shape; NaN remains.
    """
    return np.where(np.abs(pace) > 1e-12 * size, pace, np.where(np.isnan(pace), np.nan, 0.0))


def solved(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solve many small linear systems.

    Parameters
    ----------
    matrix
        Matrices, shape ``(n, k, k)``.
    right
        Right-hand sides, shape ``(n, k, columns)``, in the units of the equations.

    Returns
    -------
    The solutions, shape ``(n, k, columns)``; NaN for a singular matrix.
    """
    try:
        return np.linalg.solve(matrix, right)
    except np.linalg.LinAlgError:
        result = np.full(right.shape, np.nan)
        for position in range(len(matrix)):
            try:
                result[position] = np.linalg.solve(matrix[position], right[position])
            except np.linalg.LinAlgError:
                continue
        return result
