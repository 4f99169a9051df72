"""Joint reactions: three equations a body, for every instant at once.

The unknowns are the forces of the pins on the body that they are named for (x and y), of the slides on the
sliding body (across the guide, to the left of its direction, and a moment), of the gears on the first wheel
(along the common tangent, to the left as seen from its centre), and the effort of the drive. Newtons and
newton metres.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from coursework.mechanics.rates import Stance, solved
from coursework.mechanics.wrenches import BodyWrenches

#: Instants whose equations are set up and solved together: fewer calls, and matrices of some 10 MB.
PIECE = 4096


class Equilibrium:
    """Equilibrium equations of a mechanism's bodies at the instants of a stance."""

    def __init__(self, stance: Stance) -> None:
        self.stance = stance
        self.linkage = stance.linkage
        self.bodies = len(self.linkage.origins)
        names: list[str] = []
        for pin in self.linkage.pins:
            names += [f"{pin.name}_x", f"{pin.name}_y"]
        for slide in self.linkage.slides:
            names += [f"{slide.name}_n", f"{slide.name}_m"]
        names += [f"{gear.name}_t" for gear in self.linkage.gears]
        self.names = (*names, "effort")

    def column(self, name: str) -> int:
        """Return the column of an unknown.

        Parameters
        ----------
        name
            One of ``names``.

        Returns
        -------
        Its index in the last axis of the matrix.
        """
        return self.names.index(name)

    @cached_property
    def matrix(self) -> np.ndarray:
        """Matrix of shape ``(n, 3 bodies, unknowns)``; rows are forces along x, along y, and moments about
        the origins."""
        size = 3 * self.bodies
        columns = [*self._of_pins(), *self._of_slides(), *self._of_gears(), self._of_drive()]
        result = np.empty((self.stance.count, size, len(columns)))
        for number, wrench in enumerate(columns):
            result[:, :, number] = self._rows(wrench)
        return result

    def _rows(self, wrench: BodyWrenches) -> np.ndarray:
        """Return a wrench as rows of the equations, shape ``(n, 3 bodies)``, without the ground."""
        parts = (wrench.forces.real[:-1], wrench.forces.imag[:-1], wrench.moments[:-1])
        return np.stack(parts, axis=1).reshape(3 * self.bodies, -1).T

    def _of_pins(self) -> list[BodyWrenches]:
        return [
            BodyWrenches.none(self.stance).push(pin.of, force).push(pin.on, -force)
            for pin in self.linkage.pins
            for force in (1.0, 1j)
        ]

    def _of_slides(self) -> list[BodyWrenches]:
        results = []
        for slide in self.linkage.slides:
            results.append(BodyWrenches.none(self.stance).rub(slide, 1j * self.stance.direction(slide)))
            results.append(BodyWrenches.none(self.stance).turn(slide.of.body, 1.0).turn(slide.on, -1.0))
        return results

    def _of_gears(self) -> list[BodyWrenches]:
        results = []
        for gear in self.linkage.gears:
            first, other = (self.stance.place(centre) for centre in gear.centres)
            line = (other - first) / sum(gear.radii)
            touching, tangent = first + gear.radii[0] * line, 1j * line
            wrench = BodyWrenches.none(self.stance).push_at(
                gear.first, self._arm(gear.first, touching), tangent
            )
            results.append(wrench.push_at(gear.second, self._arm(gear.second, touching), -tangent))
        return results

    def _arm(self, body: int, position: np.ndarray) -> np.ndarray:
        return position - self.stance.origins[body]

    def _of_drive(self) -> BodyWrenches:
        """Return the wrench of a unit effort: a moment on the driven body, or the thrust of a jack with its
        power."""
        none, slide = BodyWrenches.none(self.stance), self.linkage.pushed
        if slide is None:
            return none.turn(self.linkage.driven, 1.0)
        with np.errstate(all="ignore"):
            return none.rub(slide, self.stance.direction(slide) / self.stance.sliding(slide))

    def under(self, *wrenches: BodyWrenches) -> np.ndarray:
        """Return the unknowns under each of some wrenches alone.

        Parameters
        ----------
        wrenches
            Wrenches on the bodies at the instants of the stance, N and N m; the ground's do not matter.

        Returns
        -------
        Forces in N, moments and efforts in N m, shape ``(n, unknowns, wrenches)``; NaN at a dead point.
        """
        right = -np.stack([self._rows(wrench) for wrench in wrenches], axis=-1)
        return solved(self.matrix, right)
