"""Statement of a mechanism: its bodies, the position of each one's frame, and the joints.

A place is a quantity's name, a number, or a function of quantities: mm in the frame of the body that holds
it, complex where it does not lie on the frame's x axis. Places do not move within their body.
"""

from __future__ import annotations

import inspect
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias

from coursework.errors import BadCourse, nearest

GROUND = "ground"

#: What gives a number: a quantity, a number, a function.
Place: TypeAlias = str | complex | Callable[..., Any]


@dataclass(frozen=True)
class Body:
    """Moving body.

    Attributes
    ----------
    name
        What the course calls it: ``"3"``.
    angle
        The quantity that says how its frame is turned, degrees; a number for a body that never turns; None
        for a wheel whose marks nobody looks at: only its rate counts, and a gear gives it.
    at
        The point where its frame has its origin, one of another body or of the ground.
    points
        Its other points, by name.
    mass, inertia
        kg, and kg m^2 about the centre of mass; by default none.
    centre
        The point that is its centre of mass; by default the origin of its frame.
    origin
        For a body that slides alone hold, such as a Scotch yoke: where the origin of its frame lies in the
        ground's, mm, a place that moves with the driver. ``at`` is then its own name of that point, which no
        other body holds.
    """

    name: str
    angle: str | float | None
    at: str
    points: Mapping[str, Place] = field(default_factory=dict)
    mass: Place = 0.0
    inertia: Place = 0.0
    centre: str = ""
    origin: Place | None = None

    @property
    def places(self) -> Mapping[str, Place]:
        """Points of the body with their positions, the origin first."""
        return {self.at: 0.0, **self.points}


@dataclass(frozen=True)
class Slide:
    """Body that slides on another along a line of it: at a point, in a direction of the guide's frame
    (degrees).

    The two are turned alike. ``length`` (mm): a long slide bears on both of its edges; one without length at
    its point.
    """

    at: str
    of: str
    on: str = GROUND
    along: Place = 0.0
    length: Place = 0.0


@dataclass(frozen=True)
class Gear:
    """Gear of two round wheels that roll on each other without slip, their centres held by a carrier.

    ``inner``: the second one has internal teeth. ``radii`` in mm. ``centres`` name the points in the middle
    of the wheels: by default the origins of their frames; required for a wheel fixed to the ground.
    """

    first: str
    second: str
    carrier: str
    radii: tuple[Place, Place]
    inner: bool = False
    centres: tuple[str, str] = ("", "")


@dataclass(frozen=True)
class Load:
    """Load on a point (``force``, N) or on a body (``moment``, N m): a quantity of the exercise, or a number.

    Where bodies share the point, the last of them bears the force: the piston, not the rod; ``body`` may name
    another. A force points along ``angle``, degrees from the ground's x axis; or, ``against`` the motion, the
    other way than its point moves, and a moment the other way than its body turns. ``during``: ``"always"``,
    on the ``"working stroke"`` (the slower one) or the ``"return stroke"`` of what it acts on. ``table``:
    pairs of what ``by`` names, the driver's angle or a position of the exercise, and of the load; between
    them it goes straight, by the angle around the turn.
    """

    on: str
    force: Place = 0.0
    moment: Place = 0.0
    angle: Place = 0.0
    against: bool = False
    during: str = "always"
    by: str = ""
    table: tuple[tuple[float, float], ...] = ()
    body: str = ""


@dataclass(frozen=True)
class Pin:
    """Joint that follows from a point shared by two bodies."""

    at: str
    of: str
    on: str


@dataclass(frozen=True)
class Mechanism:
    """Bodies and joints, with the loads and the friction that the exercise itself states.

    ``friction``: by joint (a point), a coefficient, for slides; for a pin, a pair of coefficient and radius
    (mm). ``pushed``: the point of the slide along which a jack drives; without it, the drive turns the body
    of its angle.

    Raises
    ------
    BadCourse
        A point that no body holds, a body of a name that is taken, a slide whose two bodies are not turned
        alike.
    """

    ground: Mapping[str, Place]
    bodies: Sequence[Body]
    slides: Sequence[Slide] = ()
    gears: Sequence[Gear] = ()
    loads: Sequence[Load] = ()
    friction: Mapping[str, Any] = field(default_factory=dict)
    pushed: str = ""

    def __post_init__(self) -> None:
        for fault in self._faults():
            raise BadCourse(f"MECHANISM: {fault}")

    # ------------------------------------------------------------------- look-up

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the moving bodies."""
        return tuple(body.name for body in self.bodies)

    def body(self, name: str) -> Body:
        """Return a moving body.

        Parameters
        ----------
        name
            Its name.

        Returns
        -------
        The body.
        """
        return next(body for body in self.bodies if body.name == name)

    def holders(self, point: str) -> tuple[str, ...]:
        """Return the bodies that have a point.

        Parameters
        ----------
        point
            Its name.

        Returns
        -------
        Their names in order, the ground's first.
        """
        on_ground = (GROUND,) if point in self.ground else ()
        return (*on_ground, *(b.name for b in self.bodies if point in b.places))

    def place(self, point: str, body: str) -> Place:
        """Return the position of a point in a body's frame.

        Parameters
        ----------
        point, body
            Their names; the body may be the ground.

        Returns
        -------
        A quantity, a number or a function of quantities that gives mm, complex off the x axis.
        """
        return self.ground[point] if body == GROUND else self.body(body).places[point]

    @property
    def points(self) -> tuple[str, ...]:
        """Names of all points, each once."""
        return tuple(dict.fromkeys([*self.ground, *(p for b in self.bodies for p in b.places)]))

    @property
    def pins(self) -> tuple[Pin, ...]:
        """Joints of shared points: each body is pinned to the first one that holds the point."""
        shared = ((p, self.holders(p)) for p in self.points)
        return tuple(Pin(point, other, first) for point, (first, *others) in shared for other in others)

    @property
    def mobility(self) -> int:
        """Degrees of freedom by the Chebyshev-Grübler count: 3 a body, less 2 a pin or slide, less 1 a
        gear."""
        return 3 * len(self.bodies) - 2 * (len(self.pins) + len(self.slides)) - len(self.gears)

    @property
    def angles(self) -> tuple[str, ...]:
        """The quantities that turn bodies, each once."""
        return tuple(dict.fromkeys(b.angle for b in self.bodies if isinstance(b.angle, str)))

    def driven_by(self, angle: str) -> str:
        """Return the body that the drive turns.

        Parameters
        ----------
        angle
            Quantity of the driving angle.

        Returns
        -------
        The name of the body.

        Raises
        ------
        BadCourse
            No body is turned by that quantity.
        """
        for body in self.bodies:
            if body.angle == angle:
                return body.name
        raise BadCourse(
            f"MECHANISM: no body is turned by the driver's angle {angle!r}; it has {', '.join(self.angles)}"
        )

    @property
    def named(self) -> tuple[str, ...]:
        """Quantities in positions, masses, loads and friction, each once."""
        places = [*self.unfolded()]
        for load in self.loads:
            places += [load.force, load.moment, load.angle]
        for given in self.friction.values():
            places += given if isinstance(given, (tuple, list)) else (given,)
        return tuple(dict.fromkeys(name for position in places for name in parameters(position)))

    def unfolded(self) -> Iterator[Place]:
        """Yield every expression that must have a value."""
        yield from self.ground.values()
        for body in self.bodies:
            yield from (*body.points.values(), body.mass, body.inertia)
        for slide in self.slides:
            yield from (slide.along, slide.length)
        for gear in self.gears:
            yield from gear.radii

    # -------------------------------------------------------------------- checks

    def _faults(self) -> Iterator[str]:
        twice = [n for n, count in Counter(self.names).items() if count > 1 or n == GROUND]
        yield from (f"two bodies are called {n!r}" for n in twice)
        known_names = set(self.ground)
        for body in self.bodies:
            if body.origin is not None:
                if body.at in known_names:
                    yield (
                        f"body {body.name!r} has an origin of its own, and {body.at!r} is a point of "
                        "another body: a pin"
                    )
            elif body.at not in known_names:
                yield (
                    f"body {body.name!r} has its origin at {body.at!r}, which no body before it holds"
                    f"{nearest(body.at, known_names)}; a body that slides alone hold says where it is: "
                    "Body(…, origin=…)"
                )
            known_names |= set(body.places)
            if body.angle is None and body.points:
                yield (
                    f"body {body.name!r} has no angle: nothing says where its points "
                    f"{', '.join(body.points)} are"
                )
            if body.centre and body.centre not in body.places:
                yield (
                    f"the centre of body {body.name!r} is none of its "
                    f"points{nearest(body.centre, body.places)}"
                )
        for slide in self.slides:
            yield from self._faults_of_slide(slide)
        if self.pushed and self.pushed not in (places := [slide.at for slide in self.slides]):
            yield f"a jack pushes along a slide; none is at {self.pushed!r}{nearest(self.pushed, places)}"
        for gear in self.gears:
            for name in (gear.first, gear.second, gear.carrier):
                if name not in (*self.names, GROUND):
                    yield f"a gear names the body {name!r}{nearest(name, self.names)}"
            for name, centre in zip((gear.first, gear.second), gear.centres, strict=True):
                if name == GROUND and not centre:
                    yield "a wheel on the ground has its middle at a point: Gear(…, centres=(…, …)) names it"
                elif centre and name not in self.holders(centre):
                    yield f"the wheel {name} has no point {centre!r}"

    def _faults_of_slide(self, slide: Slide) -> Iterator[str]:
        for name in (slide.of, slide.on):
            if name not in (*self.names, GROUND):
                yield f"the slide at {slide.at} names the body {name!r}{nearest(name, self.names)}"
                return
        if slide.at not in self.body(slide.of).places:
            yield f"the slide at {slide.at!r}: body {slide.of!r} has no such point"
        turned = [0.0 if n == GROUND else self.body(n).angle for n in (slide.of, slide.on)]
        fixed = [isinstance(t, (int, float)) for t in turned]
        if turned[0] != turned[1] and not all(fixed):
            yield (
                f"the slide at {slide.at}: bodies {slide.of} and {slide.on} are turned alike, so by "
                "one quantity; "
                f"found {turned[0]!r} and {turned[1]!r}"
            )


def parameters(expression: Place) -> tuple[str, ...]:
    """Return the quantities on which an expression depends.

    Parameters
    ----------
    expression
        A quantity's name, a number, or a function of quantities.

    Returns
    -------
    Their names; none for a number.
    """
    if isinstance(expression, str):
        return (expression,)
    return tuple(inspect.signature(expression).parameters) if callable(expression) else ()


def number(expression: Place, values: Mapping[str, Any]) -> Any:
    """Evaluate an expression.

    Parameters
    ----------
    expression
        A quantity's name, a number, or a function of quantities.
    values
        Values of the quantities by name, in the units of the exercise.

    Returns
    -------
    The value, in the unit of the quantity or of what the function gives.
    """
    if isinstance(expression, str):
        return values[expression]
    return expression(*(values[n] for n in parameters(expression))) if callable(expression) else expression
