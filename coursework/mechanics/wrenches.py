"""Wrenches on the bodies: a force and a moment about the origin of each body's frame, at every instant.

Newtons and newton metres. Inertia is one of them, by d'Alembert's principle, and comes in two: for one rad/s
of the driver squared, and for one rad/s^2.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from coursework.mechanics.linkage import BodyPoint, SlideJoint
from coursework.mechanics.rates import Stance

GRAVITY = 9.81  #: m/s^2, unless a scene says another


@dataclass
class BodyWrenches:
    """Forces, complex, and moments about the frames' origins, shape ``(bodies + 1, n)``; the ground's
    last."""

    stance: Stance
    forces: np.ndarray
    moments: np.ndarray

    @staticmethod
    def none(stance: Stance) -> BodyWrenches:
        """Return wrenches that are zero.

        Parameters
        ----------
        stance
            The mechanism at ``n`` instants.

        Returns
        -------
        New wrenches, to which forces and moments may be added.
        """
        return BodyWrenches(stance, np.zeros(stance.turns.shape, dtype=complex), np.zeros(stance.turns.shape))

    def push(self, body_point: BodyPoint, force: np.ndarray | complex) -> BodyWrenches:
        """Add a force at a position of a body.

        Parameters
        ----------
        body_point
            The position.
        force
            N, complex; a scalar or shape ``(n,)``.

        Returns
        -------
        These wrenches.
        """
        return self.push_at(body_point.body, self.stance.arm(body_point), force)

    def push_at(self, body: int, arm: np.ndarray, force: np.ndarray | complex) -> BodyWrenches:
        """Add a force at an arm from the origin of a body.

        Parameters
        ----------
        body
            Index of the body; -1 for the ground.
        arm
            Metres, complex, shape ``(n,)``.
        force
            N, complex; a scalar or shape ``(n,)``.

        Returns
        -------
        These wrenches.
        """
        self.forces[body] += force
        self.moments[body] += (np.conj(arm) * force).imag
        return self

    def turn(self, body: int, moment: np.ndarray | float) -> BodyWrenches:
        """Add a moment on a body.

        Parameters
        ----------
        body
            Index of the body; -1 for the ground.
        moment
            N m; a scalar or shape ``(n,)``.

        Returns
        -------
        These wrenches.
        """
        self.moments[body] += moment
        return self

    def rub(self, slide: SlideJoint, force: np.ndarray | complex) -> BodyWrenches:
        """Add a force on a sliding body at its point, and its opposite on the guide there.

        Parameters
        ----------
        slide
            The slide.
        force
            N, complex; a scalar or shape ``(n,)``.

        Returns
        -------
        These wrenches.
        """
        under = self.stance.place(slide.of) - self.stance.origins[slide.on]
        return self.push(slide.of, force).push_at(slide.on, under, -force)

    @property
    def effort(self) -> np.ndarray:
        """Effort of the drive along its angle that balances the wrench, by virtual power: N m, shape
        ``(n,)``."""
        power = (np.conj(self.forces) * self.stance.origin_rates).real + self.moments * self.stance.rates
        return -power.sum(axis=0)

    @property
    def size(self) -> float:
        """Magnitude of the effort if its parts did not cancel: forces on arms as long as the mechanism is
        large."""
        stance = self.stance
        reach = np.abs(stance.origin_rates) + stance.size * np.abs(stance.rates)
        parts = np.abs(self.forces) * reach + np.abs(self.moments * stance.rates)
        return float(np.nanmax(parts.sum(axis=0), initial=0.0))

    def __mul__(self, factor: np.ndarray | float) -> BodyWrenches:
        return BodyWrenches(self.stance, self.forces * factor, self.moments * factor)

    def __add__(self, other: BodyWrenches) -> BodyWrenches:
        return BodyWrenches(self.stance, self.forces + other.forces, self.moments + other.moments)


def weight(stance: Stance, downwards: complex = -1j * GRAVITY) -> BodyWrenches:
    """Return the weights of the bodies.

    Parameters
    ----------
    stance
        The mechanism at ``n`` instants.
    downwards
        Acceleration of gravity, m/s^2, complex.

    Returns
    -------
    The wrenches, N and N m.

    Source
    ------
    The mass times the acceleration of gravity, at the centre of mass.
    """
    wrench = BodyWrenches.none(stance)
    for mass in stance.linkage.masses:
        wrench.push(BodyPoint(mass.body, mass.centre), mass.mass * downwards)
    return wrench


def inertia_at_rate(stance: Stance) -> BodyWrenches:
    """Return the inertia forces for a driver at a constant 1 rad/s.

    Parameters
    ----------
    stance
        The mechanism at ``n`` instants.

    Returns
    -------
    The wrenches, N and N m; times the square of the speed for another one.

    Source
    ------
    ``-m a`` at the centre of mass and ``-J alpha`` for the acceleration a and the angular acceleration alpha.
    """
    return _inertia(stance, stance.bend, stance.bends)


def inertia_at_start(stance: Stance) -> BodyWrenches:
    """Return the inertia forces for a driver at rest that accelerates by 1 rad/s^2.

    Parameters
    ----------
    stance
        The mechanism at ``n`` instants.

    Returns
    -------
    The wrenches, N and N m; times the acceleration for another one. Their effort is the generalised inertia,
    kg m^2.

    Source
    ------
    As :func:`inertia_at_rate`.
    """
    return _inertia(stance, stance.rate, stance.rates)


def _inertia(stance: Stance, motion: Callable[[BodyPoint], np.ndarray], turning: np.ndarray) -> BodyWrenches:
    """Return the inertia forces for accelerations of positions and of the bodies' angles."""
    wrench = BodyWrenches.none(stance)
    for mass in stance.linkage.masses:
        body_point = BodyPoint(mass.body, mass.centre)
        wrench.push(body_point, -mass.mass * motion(body_point)).turn(
            mass.body, -mass.inertia * turning[mass.body]
        )
    return wrench
