r"""Velocity and acceleration polygons: vectors laid end to end from a pole; each point is the image of a
mechanism's point.

A solution states its polygons in a function ``polygons`` of its quantities, as data; what is drawn, printed
or marked follows from them::

    def polygons(r2, theta2, omega2, r3, theta3, omega3, r1_dot):
        OA, AB = polar(r2, theta2), polar(r3, theta3)
        return (
            Polygon("velocity", (
                Side("p_v", "a", r"\vec{V}_A", 1j * omega2 * OA, r"\perp OA", r"r_2\,\omega_2"),
                Side("a", "b", r"\vec{V}_{B/A}", 1j * omega3 * AB, r"\perp AB", way=1j * AB),
                Side("p_v", "b", r"\vec{V}_B", r1_dot, r"\parallel Ox", way=1),
            )),
        )

The sides stand in the order of the construction. Of each it is known before anything is drawn: its direction
and its length; its direction alone, so that it lies on a line and its unknown end where a second line crosses
it; or nothing, and then it joins two points that the others have given.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType

from coursework.errors import BadCourse, unknown
from coursework.messages import Message

UNITS = {"velocity": "mm/s", "acceleration": "mm/s^2", "position": "mm"}
_CLOSED = 1e-6  #: of the longest side: what two ways to one point may differ by


@dataclass(frozen=True)
class Side:
    r"""Vector of a polygon, from the image of one point to that of another.

    ``direction`` (``\perp AB``) and ``length`` (``r_2\,\omega_2``) are LaTeX of what is known before the
    drawing; an empty ``length`` is not known, and neither is an empty ``direction``. ``way``, a complex
    number of any length, gives the line of a side of known direction where its value may vanish. ``image``
    names the two points of the polygon of which this side is the vector, in proportion, as a bar's images
    are: see :func:`image`.
    """

    start: str  #: name of an image point, as LaTeX: ``p_v``, ``a``, ``b'``, ``a_4``
    end: str
    name: str  #: LaTeX: ``\vec{V}_{B/A}``, ``\vec{a}^n_{B/A}``
    value: complex  #: mm/s or mm/s^2, x to the right, y up
    direction: str = ""
    length: str = ""
    way: complex | None = None
    image: tuple[str, str] | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "value", complex(self.value))
        if self.image and not self.length:
            raise BadCourse(f"{self}: a side in proportion to another is known; state its length")
        if self.length and not self.direction:
            raise BadCourse(f"{self}: a side of known length is drawn in a known direction; state it")
        if not cmath.isfinite(self.value):
            raise BadCourse(f"{self}: its value is {self.value}, not finite")
        if self.is_line and not abs(self.along) > 0:
            raise BadCourse(f"{self}: its value is 0, so its line has no direction; state way=…")

    def __str__(self) -> str:
        return f"side {self.name} from {self.start} to {self.end}"

    @property
    def is_known(self) -> bool:
        """True if direction and length are known before the drawing."""
        return bool(self.length)

    @property
    def is_line(self) -> bool:
        """True if only the direction is known: a line on which an end is still to be found."""
        return bool(self.direction) and not self.length

    @property
    def is_result(self) -> bool:
        """True if nothing is known: the side joins two points that other sides have given."""
        return not self.direction

    @property
    def along(self) -> complex:
        """Unit vector of the line; 0 for a side that has neither length nor ``way``."""
        direction = self.value if self.way is None else complex(self.way)
        return direction / abs(direction) if direction else 0j


@dataclass(frozen=True)
class Stage:
    """Step of the construction: the sides that it draws, and the points that it finds.

    ``known`` sides are laid off one after another; a ``line`` is drawn through a point, its other end not yet
    found; a ``crossing`` draws the second line and finds the point where it meets the first; a ``result``
    joins two points.
    """

    kind: str  #: known, line, crossing, result
    sides: tuple[Side, ...]  #: of a crossing: the line drawn before, then the one drawn now
    points: tuple[str, ...]  #: those found, in order
    through: str = ""  #: the point through which a line is drawn now


@dataclass(frozen=True)
class Polygon:
    """Velocity or acceleration polygon, or the known part of a mechanism drawn to scale.

    Parameters
    ----------
    kind
        ``velocity`` (mm/s), ``acceleration`` (mm/s^2) or ``position`` (mm).
    sides
        In the order of the construction. The pole is where the first of them starts.
    scale
        mm/s or mm/s^2 for a mm on paper, where the exercise gives it; chosen from 1, 2 and 5 times a power of
        ten otherwise.

    Raises
    ------
    BadCourse
        A side hangs on no point drawn before it, two ways to a point do not meet, or a point lacks its
        second line.
    """

    kind: str
    sides: tuple[Side, ...]
    scale: float | None = None

    def __post_init__(self) -> None:
        if self.kind not in UNITS:
            raise unknown("kind of polygon", self.kind, UNITS)
        if not self.sides:
            raise BadCourse("a polygon has at least one side")
        object.__setattr__(self, "sides", tuple(self.sides))
        self.stages  # noqa: B018  a polygon that cannot be drawn is refused where it is stated

    @property
    def pole(self) -> str:
        """Image of all points at rest."""
        return self.sides[0].start

    @property
    def unit(self) -> str:
        return UNITS[self.kind]

    @cached_property
    def size(self) -> float:
        """Length of the longest side, mm/s or mm/s^2; 0 when nothing moves."""
        return max(abs(side.value) for side in self.sides)

    @property
    def points(self) -> Mapping[str, complex]:
        """The image points in the order in which they are found, mm/s or mm/s^2 from the pole."""
        return MappingProxyType(self._drawn[0])

    @property
    def stages(self) -> tuple[Stage, ...]:
        """The construction, step by step: each uses only points that are found before it."""
        return self._drawn[1]

    @cached_property
    def hangs(self) -> Mapping[str, tuple[Side, ...]]:
        """Sides that determine each point: one known side, or the two lines that cross there."""
        result = (stage for stage in self.stages if stage.points)
        return {
            point: stage.sides if stage.kind == "crossing" else (stage.sides[k],)
            for stage in result
            for k, point in enumerate(stage.points)
        }

    def ratio(self, side: Side) -> complex | None:
        """Return the ratio of a side to the vector that it is proportional to; None if there is none or it
        vanishes.

        Parameters
        ----------
        side
            A side of the polygon.

        Returns
        -------
        A complex number, without unit, or None.
        """
        if side.image is None:
            return None
        of = self.points[side.image[1]] - self.points[side.image[0]]
        return side.value / of if abs(of) > _CLOSED * self.size else None

    def side(self, start: str, end: str) -> Side:
        """Return the side from a point to another.

        Parameters
        ----------
        start, end
            Names of the image points.

        Returns
        -------
        The first side stated between them, in this order.

        Raises
        ------
        UnknownName
            The polygon has no such side.
        """
        for side in self.sides:
            if (side.start, side.end) == (start, end):
                return side
        raise unknown(
            "side", f"{start} {end}", [f"{s.start} {s.end}" for s in self.sides], Message("the polygon")
        )

    @cached_property
    def _drawn(self) -> tuple[dict[str, complex], tuple[Stage, ...]]:
        results: dict[str, complex] = {self.pole: 0j}
        lines: dict[str, Side] = {}
        stages: list[Stage] = []
        for side in self.sides:
            if side.is_result:
                self._check(side, results)
                stages.append(Stage("result", (side,), ()))
                continue
            anchor, target, direction = self._hung(side, results)
            if not all(name in results for name in side.image or ()):
                raise BadCourse(f"{side}: {side.image} are not both found by the sides before it")
            there = results[anchor] + direction * side.value
            if side.is_known:
                results[target] = there
                self._lay_off(stages, side, target)
            elif target not in lines:
                lines[target] = side
                stages.append(Stage("line", (side,), (), anchor))
            else:
                first = lines.pop(target)
                results[target] = there
                for crossing in (first, side):
                    self._check(crossing, results)
                stages.append(Stage("crossing", (first, side), (target,), anchor))
        if lines:
            name, side = next(iter(lines.items()))
            raise BadCourse(f"{side}: {name} lies on one line only; state the second line that finds it")
        return results, tuple(stages)

    @staticmethod
    def _lay_off(stages: list[Stage], side: Side, point: str) -> None:
        """Add a known side, in one stage with the known sides just before it."""
        before = stages.pop() if stages and stages[-1].kind == "known" else Stage("known", (), ())
        stages.append(Stage("known", (*before.sides, side), (*before.points, point)))

    @staticmethod
    def _hung(side: Side, results: Mapping[str, complex]) -> tuple[str, str, int]:
        """Return the known end of a side, the other end, and the sign of the vector between them."""
        if (side.start in results) == (side.end in results):
            fault = "both its ends are" if side.start in results else "neither of its ends is"
            raise BadCourse(f"{side}: {fault} found by the sides before it")
        return (side.start, side.end, 1) if side.start in results else (side.end, side.start, -1)

    def _check(self, side: Side, results: Mapping[str, complex]) -> None:
        """Refuse a side that does not join its points or whose line misses them."""
        missing = [name for name in (side.start, side.end) if name not in results]
        if missing:
            raise BadCourse(f"{side}: {missing[0]} is not found by the sides before it")
        gap = abs(results[side.end] - results[side.start] - side.value)
        across = abs((side.value * side.along.conjugate()).imag) if side.is_line else 0.0
        if max(gap, across) > _CLOSED * self.size:
            raise BadCourse(
                f"{side}: the polygon does not close; {max(gap, across):.3g} {self.unit} are left"
            )

    # ------------------------------------------------------------------------ scale

    def extent(self) -> tuple[complex, complex]:
        """Return the corners of the image points, lower left and upper right, from the pole."""
        xs = [z.real for z in self.points.values()]
        ys = [z.imag for z in self.points.values()]
        return complex(min(xs), min(ys)), complex(max(xs), max(ys))

    def scale_in(self, width: float, height: float) -> float:
        """Return the least of 1, 2 and 5 times a power of ten at which the polygon fits a box.

        Parameters
        ----------
        width, height
            Sides of the box, mm on paper.

        Returns
        -------
        The scale, in the polygon's unit for a mm on paper.

        Raises
        ------
        BadCourse
            Nothing moves: the polygon has no length.
        """
        low, high = self.extent()
        least = max((high - low).real / width, (high - low).imag / height)
        if not least > 0:
            raise BadCourse("nothing moves: a polygon without length has no scale")
        decade = 10.0 ** math.floor(math.log10(least))
        return next(k * decade for k in (1, 2, 5, 10) if k * decade >= least * (1 - 1e-12))

    # -------------------------------------------------------------------- equations

    @property
    def equations(self) -> tuple[str, ...]:
        r"""The vector equation that finds each crossing, LaTeX: ``\vec{V}_B = \vec{V}_A + \vec{V}_{B/A}``."""
        return tuple(self._equation(stage) for stage in self.stages if stage.kind == "crossing")

    def _equation(self, stage: Stage) -> str:
        target = stage.points[0]
        first, second = (list(self._path(side, target)) for side in stage.sides)
        while first[0] == second[0]:
            del first[0], second[0]
        # What a way goes against its arrow stands on the other side of the equation.
        left = [s for s, sign in first if sign > 0] + [s for s, sign in second if sign < 0]
        right = [s for s, sign in second if sign > 0] + [s for s, sign in first if sign < 0]
        if len(right) < len(left):
            left, right = right, left
        return " = ".join(" + ".join(side.name for side in sum_) for sum_ in (left, right)).replace(
            "+ -", "- "
        )

    def _path(self, side: Side, target: str) -> Iterator[tuple[Side, int]]:
        """Yield the sides from the pole to a point, each with its sign; the last one is given."""
        anchor = side.start if side.end == target else side.end
        if anchor != self.pole:
            straight = [s for s in self.sides if (s.start, s.end) == (self.pole, anchor)]
            yield from self._path((straight or self.hangs[anchor])[0], anchor)
        yield side, 1 if side.end == target else -1


# ------------------------------------------------------------------------- usual sides


def turning(
    start: str, end: str, of: str, line: str, vector: complex, omega: float, length: str = ""
) -> Side:
    r"""Return the velocity of a point of a turning bar relative to another: perpendicular to the bar.

    Parameters
    ----------
    start, end
        Names of the image points.
    of
        Name of the velocity: ``B/A``, or ``B`` about a fixed point.
    line
        Name of the bar: ``AB``.
    vector
        Vector of the bar, complex, mm.
    omega
        Rate of the bar, rad/s.
    length
        LaTeX of the length, where it is known before the drawing.

    Returns
    -------
    The side, mm/s.

    Source
    ------
    ``i omega vector``.
    """
    return Side(
        start, end, rf"\vec{{V}}_{{{of}}}", 1j * omega * vector, rf"\perp {line}", length, 1j * vector
    )


def normal(start: str, end: str, of: str, line: str, vector: complex, omega: float, length: str) -> Side:
    """Return the normal acceleration of a bar's point relative to another, along the bar: known once the
    velocities are.

    Parameters
    ----------
    start, end
        Names of the image points.
    of
        Name of the acceleration: ``B/A``, or ``B`` about a fixed point.
    line
        Name of the bar: ``AB``.
    vector
        Vector of the bar, complex, mm.
    omega
        Rate of the bar, rad/s.
    length
        LaTeX of the length.

    Returns
    -------
    The side, mm/s^2.

    Source
    ------
    ``-omega^2 vector``.
    """
    return Side(
        start, end, rf"\vec{{a}}^n_{{{of}}}", -(omega**2) * vector, rf"\parallel {line}", length, -vector
    )


def tangential(
    start: str, end: str, of: str, line: str, vector: complex, alpha: float, length: str = ""
) -> Side:
    """Return the tangential acceleration of a bar's point relative to another, perpendicular to the bar.

    Parameters
    ----------
    start, end
        Names of the image points.
    of
        Name of the acceleration: ``B/A``, or ``B`` about a fixed point.
    line
        Name of the bar: ``AB``.
    vector
        Vector of the bar, complex, mm.
    alpha
        Angular acceleration of the bar, rad/s^2.
    length
        LaTeX of the length, where it is known before the drawing.

    Returns
    -------
    The side, mm/s^2.

    Source
    ------
    ``i alpha vector``.
    """
    return Side(
        start, end, rf"\vec{{a}}^t_{{{of}}}", 1j * alpha * vector, rf"\perp {line}", length, 1j * vector
    )


def image(start: str, end: str, name: str, value: complex, of: tuple[str, str], length: str) -> Side:
    r"""Return the image of a third point of a bar: the vector between two image points, in proportion.

    Parameters
    ----------
    start, end
        Names of the image points.
    name
        LaTeX of the vector.
    value
        The vector, complex, mm/s or mm/s^2.
    of
        Names of the two image points to whose vector it is proportional.
    length
        LaTeX of the proportion, such as ``\frac{OD}{OP}\,p_v p_4``.

    Returns
    -------
    The side, in the unit of the value.
    """
    first, second = of
    return Side(start, end, name, value, rf"\parallel {first} {second}", length, image=of)
