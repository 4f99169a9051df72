"""Coulomb friction in slides and pins: the bearing side of a guide, and jamming.

What rubs is a *contact*: a slide at its point, the two edges of a long slide, or a pin's journal. A contact
bears a normal force s; friction there has the size f |s| (f rho |s|, as a moment, in a pin of radius rho),
against the motion. Without friction the contacts bear s0; with it

    s = s0 - C w,    w = sign of the motion * f * |s|,

where C says what unit friction at one contact changes at another. The solution wanted is the one that grows
out of s0 as friction grows from nothing: it ends where the equations become singular. There, and beyond, the
mechanism jams.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from coursework.errors import WrongValue, unknown
from coursework.mechanics.equilibrium import Equilibrium
from coursework.mechanics.linkage import MM, Linkage, PinJoint, SlideJoint
from coursework.mechanics.rates import Stance, no_rounding, solved
from coursework.mechanics.wrenches import BodyWrenches
from coursework.messages import Message

_STEPS = 4  #: in which friction grows to what it is
_ROUNDS = 40  #: of Newton's method at a step; sides and magnitudes settle in a few


@dataclass(frozen=True)
class Contact:
    """Contact with friction.

    ``reads`` gives its normal forces from the joints' unknowns: one row for a slide or an edge, two for a
    pin; ``size`` is the coefficient, in a pin times its radius in metres.
    """

    joint: PinJoint | SlideJoint
    size: float
    reads: tuple[Mapping[str, float], ...]

    def rubs(self, stance: Stance) -> BodyWrenches:
        """Return the unit friction opposite to a motion in the joint's direction.

        Parameters
        ----------
        stance
            The mechanism at ``n`` instants.

        Returns
        -------
        The wrench of 1 N on the sliding body, or of 1 N m on the pinned body, and its opposite on the other.
        """
        wrench = BodyWrenches.none(stance)
        if isinstance(self.joint, SlideJoint):
            return wrench.rub(self.joint, -stance.direction(self.joint))
        return wrench.turn(self.joint.of.body, -1.0).turn(self.joint.on.body, 1.0)

    def rate(self, stance: Stance) -> np.ndarray:
        """Return the sliding rate of the joint for unit speed of the driver.

        Parameters
        ----------
        stance
            The mechanism at ``n`` instants.

        Returns
        -------
        m/rad in a slide, rad/rad in a pin, shape ``(n,)``, with rounding errors set to 0.
        """
        if isinstance(self.joint, SlideJoint):
            return no_rounding(stance.sliding(self.joint), stance.size)
        return no_rounding(stance.rates[self.joint.of.body] - stance.rates[self.joint.on.body], 1.0)


def contacts(linkage: Linkage, friction: Mapping[str, Any]) -> tuple[Contact, ...]:
    """Return the contacts of a mechanism.

    Parameters
    ----------
    linkage
        Its numbers.
    friction
        By joint, a coefficient for a slide, a pair of coefficient and journal radius (mm) for a pin; each a
        number, a quantity or a function of quantities.

    Returns
    -------
    The contacts that have friction: one a pin or a short slide, two a long slide.

    Raises
    ------
    UnknownName
        A joint that the mechanism does not have.
    WrongValue
        A coefficient or a radius that is negative, a pin without its radius, or a point at which several
        bodies are pinned, without the one that is meant.
    """
    slides = {joint.name: joint for joint in linkage.slides}
    pins = {joint.name: joint for joint in linkage.pins}
    results: list[Contact] = []
    for name, given in friction.items():
        if isinstance(given, (tuple, list)):
            if several := [n for n in pins if n.startswith(f"{name} ")]:
                raise WrongValue(
                    "at {name} several bodies are pinned; name one of their joints: {several}",
                    name=name,
                    several=", ".join(several),
                )
            if name not in pins:
                raise unknown("pin", name, pins, Message("the mechanism"))
            coefficient, radius = (float(linkage.number(value)) for value in given)
            if coefficient < 0 or radius < 0:
                raise WrongValue(
                    "the friction of pin {name} is not negative; found {coefficient:g} and {radius:g} mm",
                    name=name,
                    coefficient=coefficient,
                    radius=radius,
                )
            size = coefficient * radius * MM
            results.append(Contact(pins[name], size, ({f"{name}_x": 1.0}, {f"{name}_y": 1.0})))
        elif f"{name} slide" in slides or name in slides:
            coefficient = float(linkage.number(given))
            if coefficient < 0:
                raise WrongValue(
                    "the friction of slide {name} is not negative; found {coefficient:g}",
                    name=name,
                    coefficient=coefficient,
                )
            results += _of_slide(slides.get(f"{name} slide") or slides[name], coefficient)
        elif name in pins:
            raise WrongValue(
                "{name} is a pin: its friction has the radius of its journal, too: {name} = {{ "
                'coefficient = {given}, radius = "10 mm" }}',
                name=name,
                given=given,
            )
        else:
            raise unknown("slide", name, [n.removesuffix(" slide") for n in slides], Message("the mechanism"))
    return tuple(contact for contact in results if contact.size)


def _of_slide(slide: SlideJoint, size: float) -> list[Contact]:
    normal, moment = f"{slide.name}_n", f"{slide.name}_m"
    if not slide.length:
        return [Contact(slide, size, ({normal: 1.0},))]
    edges = [({normal: 0.5, moment: side / slide.length},) for side in (1.0, -1.0)]
    return [Contact(slide, size, edge) for edge in edges]


class Rubbing:
    """Contacts of a mechanism, with the map from joint unknowns to normal forces.

    Attributes
    ----------
    owner
        The contact that each normal force belongs to, shape ``(k,)``: two in a row for a pin.
    """

    def __init__(self, contacts: Sequence[Contact]) -> None:
        self.contacts = tuple(contacts)
        rows = [(number, row) for number, contact in enumerate(contacts) for row in contact.reads]
        self.owner = np.array([number for number, _ in rows], dtype=int)
        self._rows = [row for _, row in rows]
        self.sizes = np.array([contact.size for contact in contacts])

    def reading(self, equations: Equilibrium) -> np.ndarray:
        """Return the matrix from the unknowns of the equations to the normal forces.

        Parameters
        ----------
        equations
            Equilibrium equations of the mechanism.

        Returns
        -------
        Shape ``(k, unknowns)``: without unit for forces, 1/m for moments of long slides.
        """
        result = np.zeros((len(self._rows), len(equations.names)))
        for number, row in enumerate(self._rows):
            for name, share in row.items():
                result[number, equations.column(name)] = share
        return result

    def magnitudes(self, normals: np.ndarray) -> np.ndarray:
        """Return the magnitude of each contact's normal force.

        Parameters
        ----------
        normals
            Normal forces, N, shape ``(n, k)``.

        Returns
        -------
        |s|, N, shape ``(n, contacts)``.
        """
        squares = np.zeros((len(normals), len(self.contacts)))
        np.add.at(squares.T, self.owner, (normals**2).T)
        return np.sqrt(squares)

    def _slopes(self, normals: np.ndarray) -> np.ndarray:
        """Return the derivatives of the magnitudes, shape ``(n, contacts, k)``: signs for slides, unit
        vectors for pins."""
        magnitudes = self.magnitudes(normals)[:, self.owner]
        with np.errstate(all="ignore"):
            share = np.where(magnitudes > 0, normals / magnitudes, 0.0)
        result = np.zeros((len(normals), len(self.contacts), len(self.owner)))
        result[:, self.owner, np.arange(len(self.owner))] = share
        return result

    def one(
        self, free: np.ndarray, spread: np.ndarray, strength: np.ndarray, near: np.ndarray | None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the friction and the normal forces at one instant.

        Parameters
        ----------
        free
            Normal forces without friction, N, shape ``(k,)``.
        spread
            What unit friction at each contact takes from them, N per N or N m, shape ``(k, contacts)``.
        strength
            Sizes of the contacts with the signs of the motions, shape ``(contacts,)``: without unit for a
            slide, m for a pin.
        near
            Normal forces of the previous instant, N, shape ``(k,)``, from which Newton's method needs a step
            or two; None without. If it does not converge from them, friction is increased from 0.

        Returns
        -------
        Friction of the contacts, N or N m, shape ``(contacts,)``, and normal forces, N, shape ``(k,)``; NaN
        where the mechanism jams.
        """
        normals = free if near is None else near
        unit = np.eye(len(free))
        for _ in range(8):
            magnitudes = np.sqrt(np.bincount(self.owner, normals * normals, len(self.contacts)))
            lacking = normals - free + spread @ (strength * magnitudes)
            forces = magnitudes[self.owner]
            slopes = np.divide(normals, forces, out=np.zeros(len(normals)), where=forces > 0)
            slope = unit + (spread * strength)[:, self.owner] * slopes
            size = np.abs(free).max() + np.abs(normals).max()
            if np.abs(lacking).max() <= 1e-14 * size and np.linalg.det(slope) > 0:
                return strength * magnitudes, normals
            try:
                normals = normals - np.linalg.solve(slope, lacking)
            except np.linalg.LinAlgError:
                break
        grown = self._grown(free[None], spread[None], strength[None])
        return (strength * self.magnitudes(grown))[0], grown[0]

    def balanced(self, free: np.ndarray, spread: np.ndarray, sense: np.ndarray) -> np.ndarray:
        """Return the friction w of the contacts.

        Parameters
        ----------
        free
            Normal forces without friction, N, shape ``(n, k)``.
        spread
            What unit friction at each contact takes from them, N per N or N m, shape ``(n, k, contacts)``.
        sense
            Signs of the motions, shape ``(n, contacts)``.

        Returns
        -------
        N for a slide, N m for a pin, shape ``(n, contacts)``; NaN where the mechanism jams.
        """
        strength = sense * self.sizes
        return strength * self.magnitudes(self._grown(free, spread, strength))

    def _grown(self, free: np.ndarray, spread: np.ndarray, strength: np.ndarray) -> np.ndarray:
        """Return the normal forces as friction increases from 0 to its full strength; NaN where the mechanism
        jams."""
        normals = free
        for step in range(1, _STEPS + 1):
            normals, good = self._settled(free, spread, strength * (step / _STEPS), normals)
            normals = np.where(good[:, None], normals, np.nan)
        return normals

    def _settled(
        self, free: np.ndarray, spread: np.ndarray, strength: np.ndarray, start: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the result of Newton's method from a solution for a little less friction, and a mask of
        convergence."""
        normals, item = start, np.eye(free.shape[1])
        size = np.abs(free).max(axis=1) + np.abs(start).max(axis=1)
        for _ in range(_ROUNDS):
            lacking = normals - free + np.einsum("nkc,nc->nk", spread, strength * self.magnitudes(normals))
            slope = item + np.einsum("nkc,nc,ncj->nkj", spread, strength, self._slopes(normals))
            step = solved(slope, lacking[..., None])[..., 0]
            normals = normals - step
            if not np.any(np.abs(step).max(axis=1) > 1e-14 * size):
                break
        lacking = normals - free + np.einsum("nkc,nc->nk", spread, strength * self.magnitudes(normals))
        slope = item + np.einsum("nkc,nc,ncj->nkj", spread, strength, self._slopes(normals))
        with np.errstate(all="ignore"):
            good = (np.linalg.det(slope) > 0) & (np.abs(lacking).max(axis=1) <= 1e-9 * size + 1e-300)
        return normals, good
