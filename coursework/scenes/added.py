"""Data that a scene adds to the mechanism of its exercise: masses, loads, friction, a flywheel, gravity."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from coursework.errors import WrongValue, unknown
from coursework.mechanics.statement import Body, Load, Mechanism, Place
from coursework.mechanics.wrenches import GRAVITY
from coursework.messages import Message


@dataclass(frozen=True)
class BodyMass:
    """Mass (kg), moment of inertia about the centre (kg m^2), and centre of a body: one of its points, or a
    position in its frame, mm.

    None leaves the exercise's value.
    """

    mass: float | None = None
    inertia: float | None = None
    centre: str | complex | None = None


@dataclass(frozen=True)
class Flywheel:
    """Flywheel on the driver's shaft, by its moment of inertia (kg m^2) or by the allowed unevenness.

    The unevenness is (largest - least speed) / mean speed, over a cycle at the given speed.
    """

    inertia: float | None = None
    unevenness: float | None = None

    def __post_init__(self) -> None:
        if self.unevenness is not None and not 0 < self.unevenness < 1:
            raise WrongValue(
                "a coefficient of fluctuation lies between 0 and 1, 0.02 for 2 %; found {unevenness:g}",
                unevenness=self.unevenness,
            )
        if self.inertia is not None and not 0 < self.inertia < 1e12:
            raise WrongValue(
                "the inertia of a flywheel is above 0; found {inertia:g} kg*m^2", inertia=self.inertia
            )


@dataclass(frozen=True)
class Motor:
    """Drive in time: a torque at rest (N m), falling linearly to 0 at the no-load speed (rad/s); constant
    without that speed."""

    torque: float
    no_load_speed: float | None = None

    def __post_init__(self) -> None:
        if self.no_load_speed is not None and not self.torque * self.no_load_speed > 0:
            raise WrongValue(
                "a motor turns the way that its torque pulls: torque and no_load_speed have one sign "
                "and are not 0; found {torque:g} N*m and {no_load_speed:g} rad/s",
                torque=self.torque,
                no_load_speed=self.no_load_speed,
            )

    def at(self, speed: float) -> float:
        """Return the torque at a speed of the driver."""
        return self.torque * (1.0 - speed / self.no_load_speed) if self.no_load_speed else self.torque


@dataclass(frozen=True)
class SceneData:
    """Data that a scene adds to its exercise.

    ``friction``: by joint, a coefficient for a slide, a pair of coefficient and radius of the journal (mm)
    for a pin; ``lengths``: of slides that bear on both edges, mm; ``gravity``: its acceleration, m/s^2,
    complex.
    """

    bodies: Mapping[str, BodyMass] = field(default_factory=dict)
    loads: tuple[Load, ...] = ()
    friction: Mapping[str, Any] = field(default_factory=dict)
    lengths: Mapping[str, float] = field(default_factory=dict)
    flywheel: Flywheel | None = None
    gravity: complex = -1j * GRAVITY

    @property
    def is_own(self) -> bool:
        """True if the scene has data that the exercise does not know."""
        return (
            bool(self.bodies or self.loads or self.friction or self.lengths) or self.gravity != -1j * GRAVITY
        )

    def to(self, mechanism: Mechanism) -> Mechanism:
        """Return the mechanism with the added data.

        Raises
        ------
        UnknownName
            A body, a point or a slide that the mechanism does not have.
        """
        for name in self.bodies:
            if name not in mechanism.names:
                raise unknown("body", name, mechanism.names, Message("the mechanism"))
        points = [slide.at for slide in mechanism.slides]
        for name, length in self.lengths.items():
            if name not in points:
                raise unknown("slide", name, points, Message("the mechanism"))
            if length < 0:
                raise WrongValue(
                    "the length of slide {name} is not negative; found {length:g}", name=name, length=length
                )
        return dataclasses.replace(
            mechanism,
            bodies=tuple(_weighed(body, self.bodies.get(body.name)) for body in mechanism.bodies),
            slides=tuple(
                dataclasses.replace(slide, length=self.lengths.get(slide.at, slide.length))
                for slide in mechanism.slides
            ),
            loads=(*mechanism.loads, *self.loads),
            friction={**mechanism.friction, **self.friction},
        )


def _weighed(body: Body, mass: BodyMass | None) -> Body:
    if mass is None:
        return body
    changes: dict[str, Any] = {
        k: v for k, v in (("mass", mass.mass), ("inertia", mass.inertia)) if v is not None
    }
    for name, value in changes.items():
        if value < 0:
            raise WrongValue(
                "the {name} of body {body} is not negative; found {value:g}",
                name=Message(name),
                body=body.name,
                value=value,
            )
    if isinstance(mass.centre, str):
        if mass.centre not in body.places:
            raise unknown("point", mass.centre, body.places, Message("body {body}", body=body.name))
        changes["centre"] = mass.centre
    elif mass.centre is not None:
        name = f"G{body.name}"
        points: dict[str, Place | Callable[..., Any]] = {**body.points, name: mass.centre}
        changes |= {"points": points, "centre": name}
    return dataclasses.replace(body, **changes)
