"""Forces on a mechanism: the drive's effort by virtual power, and joint reactions on request.

Nothing is computed that no effect needs: without inertia no acceleration, without friction no iteration,
without a question about joints no equilibrium.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from coursework.mechanics.equilibrium import PIECE, Equilibrium
from coursework.mechanics.friction import Contact, Rubbing
from coursework.mechanics.linkage import Linkage
from coursework.mechanics.loads import AppliedLoad, Strokes, strokes
from coursework.mechanics.rates import Stance
from coursework.mechanics.wrenches import BodyWrenches, inertia_at_rate, inertia_at_start, weight

Pose = Callable[[np.ndarray], Stance]  #: a mechanism at driver's angles, radians
_STEPS = 1440  #: of a turn, to find how long strokes are


@dataclass(frozen=True)
class ForceResults:
    """Results at ``n`` instants: the drive's effort (N m), and the joint unknowns by name, on request.

    ``rubs``: the friction of each contact, by joint, along its direction.
    """

    effort: np.ndarray
    joints: dict[str, np.ndarray] = field(default_factory=dict)
    rubs: dict[str, np.ndarray] = field(default_factory=dict)


@dataclass(frozen=True)
class Forces:
    """Forces on a mechanism.

    ``downwards``: the acceleration of gravity, m/s^2, complex; 0 without the effect. ``inertia``: whether
    masses count; ``flywheel``: kg m^2 on the driver's shaft.
    """

    linkage: Linkage
    pose: Pose
    downwards: complex = 0j
    inertia: bool = False
    flywheel: float = 0.0
    loads: tuple[AppliedLoad, ...] = ()
    contacts: tuple[Contact, ...] = ()

    @property
    def needs_bends(self) -> bool:
        """True if second derivatives are needed."""
        return self.inertia and bool(self.linkage.masses)

    @property
    def resists(self) -> bool:
        """True if something always opposes the motion, so that the mechanism can stick."""
        return bool(self.contacts) or any(acting.turns_over for acting in self.loads)

    @cached_property
    def rubbing(self) -> Rubbing:
        return Rubbing(self.contacts)

    # --------------------------------------------------------------------- loads

    @cached_property
    def strokes(self) -> tuple[Strokes, ...]:
        """Strokes on which each load acts."""
        if not any(acting.load.during != "always" for acting in self.loads):
            return tuple(Strokes() for _ in self.loads)
        step = 2 * np.pi / _STEPS
        stance = self.pose((np.arange(_STEPS) + 0.5) * step)
        results = []
        for acting in self.loads:
            pace = acting.pace(stance)
            results.append(strokes(acting, *(share_of_turn(direction * pace) for direction in (1.0, -1.0))))
        return tuple(results)

    def load_sizes(
        self, stance: Stance, driver: np.ndarray, direction: np.ndarray | float
    ) -> list[np.ndarray]:
        """Return the size of each load along its line.

        Parameters
        ----------
        stance
            The mechanism at ``n`` instants.
        driver
            Angles of the driver there, radians, shape ``(n,)``.
        direction
            Direction of the driver: +1, -1, 0 at rest; a scalar or shape ``(n,)``.

        Returns
        -------
        For each load, N or N m, shape ``(n,)``.

        Raises
        ------
        WrongValue
            As :func:`~coursework.mechanics.loads.strokes`.
        """
        results = []
        for acting, when in zip(self.loads, self.strokes, strict=True):
            sizes = acting.sizes(driver)
            if acting.turns_over or when.way:
                sizes = when.along(sizes, np.sign(acting.pace(stance)), direction, against=acting.turns_over)
            results.append(sizes)
        return results

    # -------------------------------------------------------------------- totals

    def applied(
        self, stance: Stance, driver: np.ndarray, speed: np.ndarray, acceleration: np.ndarray
    ) -> BodyWrenches:
        """Return the total wrench without friction, joint reactions and the flywheel.

        Parameters
        ----------
        stance
            The mechanism at ``n`` instants.
        driver, speed, acceleration
            Angle, speed and acceleration of the driver there: rad, rad/s, rad/s^2, shape ``(n,)``.

        Returns
        -------
        Loads, weights and inertia forces together, N and N m.

        Raises
        ------
        WrongValue
            As :meth:`load_sizes`.
        """
        total = BodyWrenches.none(stance)
        for acting, size in zip(self.loads, self.load_sizes(stance, driver, np.sign(speed)), strict=True):
            total = total + acting.pull(stance) * size
        if self.downwards:
            total = total + weight(stance, self.downwards)
        if self.needs_bends:
            total = total + inertia_at_rate(stance) * speed**2 + inertia_at_start(stance) * acceleration
        return total

    def over(
        self, driver: np.ndarray, speed: np.ndarray, acceleration: np.ndarray, *, joints: bool = False
    ) -> ForceResults:
        """Compute the forces at ``n`` instants.

        Parameters
        ----------
        driver, speed, acceleration
            Angle, speed and acceleration of the driver: rad, rad/s, rad/s^2, shape ``(n,)``.
        joints
            Whether joint unknowns are wanted; with friction they are computed anyway.

        Returns
        -------
        The effort, N m, and the joint unknowns and friction, N or N m, shape ``(n,)``; NaN where the
        mechanism jams or does not close.

        Raises
        ------
        WrongValue
            As :meth:`load_sizes`.
        """
        results = [
            self._piece(driver[k], speed[k], acceleration[k], joints)
            for k in _pieces(len(driver), PIECE if joints or self.contacts else 16 * PIECE)
        ]
        return ForceResults(
            np.concatenate([f.effort for f in results]),
            {n: np.concatenate([f.joints[n] for f in results]) for n in results[0].joints},
            {n: np.concatenate([f.rubs[n] for f in results]) for n in results[0].rubs},
        )

    def _piece(
        self, driver: np.ndarray, speed: np.ndarray, acceleration: np.ndarray, joints: bool
    ) -> ForceResults:
        stance = self.pose(driver)
        with np.errstate(all="ignore"):
            applied = self.applied(stance, driver, speed, acceleration)
            spun = self.flywheel * acceleration
            if not joints and not self.contacts:
                return ForceResults(applied.effort + spun)
            equations = Equilibrium(stance)
            if not self.contacts:
                return self._borne(equations, equations.under(applied)[:, :, 0], spun)
            under = equations.under(applied, *(c.rubs(stance) for c in self.contacts))
            sense = np.stack([np.sign(c.rate(stance) * speed) for c in self.contacts], axis=-1)
            reading = self.rubbing.reading(equations)
            free, spread = under[:, :, 0] @ reading.T, -np.einsum("ku,nuc->nkc", reading, under[:, :, 1:])
            rubs = self.rubbing.balanced(free, spread, sense)
            borne = self._borne(
                equations, under[:, :, 0] + np.einsum("nuc,nc->nu", under[:, :, 1:], rubs), spun
            )
            return ForceResults(borne.effort, borne.joints, self._by_joint(-rubs))

    def _by_joint(self, rubs: np.ndarray) -> dict[str, np.ndarray]:
        results: dict[str, np.ndarray] = {}
        for contact, moment in zip(self.contacts, rubs.T, strict=True):
            results[contact.joint.name] = results.get(contact.joint.name, 0.0) + moment
        return results

    @staticmethod
    def _borne(equations: Equilibrium, unknowns: np.ndarray, spun: np.ndarray) -> ForceResults:
        joints = dict(zip(equations.names, unknowns.T, strict=True))
        return ForceResults(joints.pop("effort") + spun, joints)


def share_of_turn(pace: np.ndarray) -> float:
    """Return the part of a turn on which a function is positive.

    Parameters
    ----------
    pace
        Values in the middle of equal steps of the turn, in any unit, shape ``(n,)``; NaN counts as not
        positive.

    Returns
    -------
    Radians, 0 to 2 pi.

    Source
    ------
    Zeros are interpolated linearly between the values.
    """
    step, after = 2 * np.pi / len(pace), np.roll(pace, -1)
    with np.errstate(all="ignore"):
        crossing = np.clip(np.where(pace > 0, pace, after) / np.abs(pace - after), 0.0, 1.0)
    shares = np.where((pace > 0) & (after > 0), 1.0, np.where((pace > 0) | (after > 0), crossing, 0.0))
    return float(np.nansum(shares) * step)


def _pieces(count: int, size: int) -> Iterator[slice]:
    for start in range(0, count, size):
        yield slice(start, start + size)
