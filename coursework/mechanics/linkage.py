"""Mechanism with its numbers: positions in metres as complex numbers, bodies by index.

The ground stands last in every list of bodies, so that its index is -1. Coordinates are the driver's angle,
index 0, and the angles that follow from it, from 1 on; a body that never turns has none.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from coursework.errors import BadCourse
from coursework.mechanics.statement import GROUND, Mechanism, Pin, number

MM = 1e-3
NONE = -1  #: the coordinate of what never turns


class BodyPoint(NamedTuple):
    """Position in a body's frame."""

    body: int
    place: complex


class PinJoint(NamedTuple):
    """Pin: its position on either body; ``closes`` where the frames do not already hold it together."""

    name: str
    of: BodyPoint
    on: BodyPoint
    closes: bool


class SlideJoint(NamedTuple):
    """Slide: its point on the sliding body, the guide, the direction in the guide's frame (unit vector), its
    length."""

    name: str
    of: BodyPoint
    on: int
    along: complex
    length: float


class GearJoint(NamedTuple):
    """Gear: two wheels, the carrier of their centres, their radii (the second negative for internal teeth),
    and their centres."""

    name: str
    first: int
    second: int
    carrier: int
    radii: tuple[float, float]
    centres: tuple[BodyPoint, BodyPoint]


class Mass(NamedTuple):
    """Mass of a body, kg, its moment of inertia about the centre, kg m^2, and the position of the centre."""

    body: int
    mass: float
    inertia: float
    centre: complex


@dataclass(frozen=True)
class Linkage:
    """Numbers of a mechanism of one degree of freedom."""

    mechanism: Mechanism
    values: Mapping[str, Any]
    driver: str  #: the quantity of the driving angle

    # -------------------------------------------------------------------- bodies

    @cached_property
    def index(self) -> dict[str, int]:
        """Bodies by name; the ground is -1."""
        return {**{name: k for k, name in enumerate(self.mechanism.names)}, GROUND: -1}

    @cached_property
    def driven(self) -> int:
        """The body that the drive turns."""
        return self.index[self.mechanism.driven_by(self.driver)]

    @cached_property
    def coordinates(self) -> tuple[int, ...]:
        """Index of the coordinate that turns each body, the ground last."""
        names: dict[Any, int] = {self.driver: 0}
        results = []
        for body in self.mechanism.bodies:
            if isinstance(body.angle, (int, float)):
                results.append(NONE)
                continue
            results.append(names.setdefault(body.angle if body.angle else (body.name,), len(names)))
        return (*results, NONE)

    @cached_property
    def unknown_angles(self) -> tuple[str, ...] | None:
        """Quantities of the coordinates from 1 on; None if one belongs to a wheel or to a free body, which
        have none."""
        if self.free:
            return None
        bodies = zip(self.mechanism.bodies, self.coordinates, strict=False)
        names = {coordinates: body.angle for body, coordinates in bodies if coordinates > 0}
        results = [names[k] for k in range(1, self.unknowns + 1)]
        return tuple(map(str, results)) if all(isinstance(n, str) for n in results) else None

    @cached_property
    def free(self) -> dict[int, int]:
        """Bodies whose origins no pin holds, each with the first of its two position coordinates."""
        bodies = [k for k, body in enumerate(self.mechanism.bodies) if body.origin is not None]
        return {body: max(self.coordinates) + 1 + 2 * number for number, body in enumerate(bodies)}

    @property
    def unknowns(self) -> int:
        """Number of coordinates that follow from the driver's angle."""
        return max(self.coordinates) + 2 * len(self.free)

    @cached_property
    def constant_turns(self) -> np.ndarray:
        """Angle of each body that never turns, radians; 0 for the others."""
        angles = [b.angle for b in self.mechanism.bodies]
        return np.radians([float(a) if isinstance(a, (int, float)) else 0.0 for a in angles] + [0.0])

    # -------------------------------------------------------------------- places

    def number(self, position: Any) -> Any:
        """Return the value of an expression.

        Parameters
        ----------
        position
            A quantity's name, a number, or a function of quantities.

        Returns
        -------
        The number, in the unit that the statement gives it: mm, degrees, kg, kg m^2, N, N m.
        """
        return number(position, self.values)

    def body_point(self, point: str, body: str) -> BodyPoint:
        """Return the position of a point on a body that has it.

        Parameters
        ----------
        point, body
            Their names.

        Returns
        -------
        The index of the body and the place in its frame, metres, complex.
        """
        return BodyPoint(self.index[body], complex(self.number(self.mechanism.place(point, body))) * MM)

    def owner(self, point: str) -> BodyPoint:
        """Return the position of a point on the first body that has it.

        Parameters
        ----------
        point
            Its name.

        Returns
        -------
        The index of the body and the place in its frame, metres, complex.
        """
        return self.body_point(point, self.mechanism.holders(point)[0])

    @cached_property
    def origins(self) -> tuple[BodyPoint, ...]:
        """Position of each body's frame origin on an earlier body or on the ground; a free body's on the
        ground, from where it is shifted."""
        results = []
        for k, body in enumerate(self.mechanism.bodies):
            if body.origin is not None:
                results.append(BodyPoint(-1, 0j))
                continue
            before = [h for h in self.mechanism.holders(body.at) if self.index[h] < k]
            results.append(self.body_point(body.at, before[0]))
        return tuple(results)

    # -------------------------------------------------------------------- joints

    @cached_property
    def pins(self) -> tuple[PinJoint, ...]:
        return tuple(self._pin(pin) for pin in self.mechanism.pins)

    def _pin(self, pin: Pin) -> PinJoint:
        body = self.mechanism.body(pin.of)
        several = len(self.mechanism.holders(pin.at)) > 2
        name = f"{pin.at} {pin.of}" if several else pin.at
        return PinJoint(
            name, self.body_point(pin.at, pin.of), self.body_point(pin.at, pin.on), body.at != pin.at
        )

    @cached_property
    def slides(self) -> tuple[SlideJoint, ...]:
        pinned = {pin.at for pin in self.mechanism.pins}
        return tuple(
            SlideJoint(
                f"{s.at} slide" if s.at in pinned else s.at,
                self.body_point(s.at, s.of),
                self.index[s.on],
                complex(np.exp(1j * math.radians(self.number(s.along)))),
                float(self.number(s.length)) * MM,
            )
            for s in self.mechanism.slides
        )

    @cached_property
    def pushed(self) -> SlideJoint | None:
        """Slide along which the drive pushes; none where it turns a body."""
        pairs = zip(self.mechanism.slides, self.slides, strict=True)
        return next((joint for slide, joint in pairs if slide.at == self.mechanism.pushed), None)

    @cached_property
    def gears(self) -> tuple[GearJoint, ...]:
        results = []
        for gear in self.mechanism.gears:
            first, second = (float(self.number(r)) * MM for r in gear.radii)
            item, other, carrier = (self.index[n] for n in (gear.first, gear.second, gear.carrier))
            radii = (first, -second if gear.inner else second)
            centres = (self._middle(gear.first, gear.centres[0]), self._middle(gear.second, gear.centres[1]))
            results.append(GearJoint(f"{gear.first}/{gear.second}", item, other, carrier, radii, centres))
        return tuple(results)

    def _middle(self, body: str, point: str) -> BodyPoint:
        return self.body_point(point, body) if point else BodyPoint(self.index[body], 0j)

    @cached_property
    def masses(self) -> tuple[Mass, ...]:
        """The bodies that have a mass or an inertia."""
        results = []
        for body in self.mechanism.bodies:
            mass, inertia = float(self.number(body.mass)), float(self.number(body.inertia))
            if mass or inertia:
                results.append(
                    Mass(
                        self.index[body.name],
                        mass,
                        inertia,
                        self.body_point(body.centre or body.at, body.name).place,
                    )
                )
        return tuple(results)

    def check(self) -> None:
        """Refuse a mechanism that does not have one degree of freedom.

        Raises
        ------
        BadCourse
            It counts bodies and joints.
        """
        if self.mechanism.mobility != 1:
            counts = (len(self.mechanism.bodies), len(self.pins) + len(self.slides), len(self.gears))
            raise BadCourse(
                f"MECHANISM has {self.mechanism.mobility} degrees of freedom, a driver moves 1: 3 x "
                f"{counts[0]} bodies, "
                f"less 2 x {counts[1]} pins and slides, less {counts[2]} gears"
            )
