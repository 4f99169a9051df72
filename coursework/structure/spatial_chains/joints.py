"""Joints of the course: their free motions and transmitted actions, at each joint's own point.

A joint has a right-handed frame (u, v, w) of unit vectors: u is its axis, or its normal where it has no axis;
v is the normal of a contact along a line. In that frame each joint but the helical one leaves some of the
six elementary motions free and transmits the actions that go with the others.

Twists are written (rotation, velocity) and wrenches (moment, force) at one point, lengths divided by a length
of the mechanism's size; the power of a wrench in a twist is then their plain scalar product.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

from coursework.errors import WrongValue, unknown
from coursework.messages import Message

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class JointKind:
    """Row of the joint table: free rotations and translations by the letters of the frame, and the required
    keys."""

    rotations: str
    translations: str
    needs: tuple[str, ...] = ()


_KINDS: Mapping[str, JointKind] = {
    "rigid": JointKind("", ""),
    "revolute": JointKind("u", "", ("axis", "point")),
    "prismatic": JointKind("", "u", ("axis",)),
    "helical": JointKind("u", "", ("axis", "point", "pitch")),
    "cylindrical": JointKind("u", "u", ("axis", "point")),
    "spherical_pin": JointKind("vw", "", ("axis", "point")),
    "spherical": JointKind("uvw", "", ("point",)),
    "planar": JointKind("u", "vw", ("normal",)),
    "annular": JointKind("uvw", "u", ("axis", "point")),
    "line_contact": JointKind("uv", "uw", ("axis", "normal", "point")),
    "point_contact": JointKind("uvw", "vw", ("normal", "point")),
    "free": JointKind("uvw", "uvw"),
}

JOINTS: tuple[str, ...] = tuple(_KINDS)  #: the names, from the fewest freedoms of a family to the most
FREEDOMS: Mapping[str, int] = {name: len(k.rotations) + len(k.translations) for name, k in _KINDS.items()}

_SQUARE = 1e-9  #: largest cosine between the line and the normal of a contact that are perpendicular


def cross(a: Sequence[float], b: Sequence[float]) -> Vector:
    """Return the vector product a × b.

    Parameters
    ----------
    a, b
        Vectors of three numbers, in any units.

    Returns
    -------
    The vector, in the product of their units.
    """
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a: Sequence[float], b: Sequence[float]) -> float:
    """Return the scalar product.

    Parameters
    ----------
    a, b
        Vectors of three numbers, in any units.

    Returns
    -------
    A number, in the product of their units.
    """
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def unit(a: Sequence[float]) -> Vector:
    """Return the unit vector along a vector.

    Parameters
    ----------
    a
        Vector of three numbers other than zero, in any unit.

    Returns
    -------
    Three numbers without unit.
    """
    size = math.hypot(*a)
    return (a[0] / size, a[1] / size, a[2] / size)


@lru_cache(maxsize=1024)
def frame_about(u: Vector) -> tuple[Vector, Vector, Vector]:
    """Return a right-handed frame about a direction.

    Parameters
    ----------
    u
        Unit vector.

    Returns
    -------
    Unit vectors u, v, w; v is near the coordinate axis most perpendicular to u.
    """
    least = min(range(3), key=lambda i: abs(u[i]))
    w = unit(cross(u, tuple(float(i == least) for i in range(3))))
    return u, cross(w, u), w


@dataclass(frozen=True)
class Joint:
    """Joint at its position. ``frame`` holds u, v, w; ``point`` is None where the position does not
    matter."""

    name: str
    frame: tuple[Vector, Vector, Vector]
    point: Vector | None = None
    pitch: float = 0.0  #: advance a turn, in the unit of the points
    between: tuple[int, int] = (0, 1)

    @property
    def freedoms(self) -> int:
        """Number of free rates."""
        return FREEDOMS[self.name]

    @property
    def kind(self) -> JointKind:
        return _KINDS[self.name]

    @cached_property
    def _free(self) -> tuple[list[Vector], list[Vector]]:
        return _named(self.frame, self.kind.rotations), _named(self.frame, self.kind.translations)

    @property
    def turns(self) -> list[Vector]:
        """Unit vectors along the axes of its free rotations."""
        return self._free[0]

    @property
    def moments(self) -> list[Vector]:
        """Unit vectors along the moments that the joint transmits without a force."""
        return _named(self.frame, _others(self.kind.rotations))

    @property
    def slides(self) -> list[Vector]:
        """Unit vectors along the free translations; the helical joint has none, since its translation follows
        its rotation."""
        return self._free[1]

    def twists(self, origin: Vector, length: float) -> list[list[float]]:
        """Return the free twists at a point.

        Parameters
        ----------
        origin
            The point, in the unit of the joint's point.
        length
            Length that divides velocities, in the same unit.

        Returns
        -------
        ``freedoms`` rows of 6 numbers, rotation before velocity; rotations, and the velocities of free
        translations, are unit vectors.

        Source
        ------
        ``V(O) = OP × u + p u / (2 pi)`` for a rotation u at P with the advance p a turn.
        """
        arm = self.arm(origin, length)
        advance = self.pitch / (2 * math.pi * length) if self.name == "helical" else 0.0
        rotations, translations = self._free
        rows = []
        for turn in rotations:
            x, y, z = cross(arm, turn)
            rows.append([*turn, x + advance * turn[0], y + advance * turn[1], z + advance * turn[2]])
        return rows + [[0.0, 0.0, 0.0, *along] for along in translations]

    def wrenches(self, origin: Vector, length: float) -> list[list[float]]:
        """Return the transmitted wrenches at a point.

        Parameters
        ----------
        origin
            The point, in the unit of the joint's point.
        length
            Length that divides moments, in the same unit.

        Returns
        -------
        ``6 - freedoms`` rows of 6 numbers, moment before force; forces, and moments that come without one,
        are unit vectors.

        Source
        ------
        ``M(O) = OP × F``, less ``p u / (2 pi)`` for the force along the axis u of a helical joint.
        """
        arm = self.arm(origin, length)
        moments = _named(self.frame, _others(self.kind.rotations))
        forces = _named(self.frame, _others(self.kind.translations))
        rows = [[*moment, 0.0, 0.0, 0.0] for moment in moments]
        rows += [[*cross(arm, force), *force] for force in forces]
        if self.name == "helical":
            # The force along the axis comes with the moment whose power it makes up for.
            advance = self.pitch / (2 * math.pi * length)
            along = len(moments) + "uvw".index("u")
            for i, x in enumerate(self.frame[0]):
                rows[along][i] -= advance * x
        return rows

    def arm(self, origin: Vector, length: float) -> Vector:
        """Return the vector from a point to the joint's point.

        Parameters
        ----------
        origin
            The point, in the unit of the joint's point.
        length
            Length that divides the vector, in the same unit.

        Returns
        -------
        Three numbers without unit; zeros for a joint whose position does not matter.
        """
        if self.point is None:
            return (0.0, 0.0, 0.0)
        x, y, z = ((p - o) / length for p, o in zip(self.point, origin, strict=True))
        return x, y, z


def _named(frame: Sequence[Vector], letters: str) -> list[Vector]:
    return [frame["uvw".index(letter)] for letter in letters]


def _others(letters: str) -> str:
    return "".join(letter for letter in "uvw" if letter not in letters)


def joint_of(given: Mapping[str, Any]) -> Joint:
    """Return a joint from its mapping; keys that it does not use are ignored.

    Parameters
    ----------
    given
        ``joint``, a name of :data:`JOINTS`, with the keys that it needs and, optionally, ``between``; point
        and pitch in one unit of length, axis and normal of any length.

    Returns
    -------
    The joint.

    Raises
    ------
    UnknownName
        No joint has this name.
    WrongValue
        A key is missing, a vector is not a vector or has no direction, or the line and the normal of a
        contact are not perpendicular.
    """
    if not isinstance(given, Mapping) or "joint" not in given:
        raise WrongValue("a joint is a mapping with a key 'joint'; found {given!r}", given=str(given)[:80])
    name = given["joint"]
    if name not in _KINDS:
        raise unknown("joint", str(name), JOINTS)
    kind = _KINDS[name]
    for key in kind.needs:
        if key not in given:
            raise WrongValue(
                "a joint {name!r} needs {needs}; {key!r} is missing",
                name=name,
                needs=", ".join(kind.needs),
                key=key,
            )
    point = _vector(given, "point") if "point" in kind.needs else None
    pitch = _number(given["pitch"], "pitch") if "pitch" in kind.needs else 0.0
    between = given.get("between", (0, 1))
    if len(between) != 2 or any(isinstance(b, bool) or int(b) != b or b < 0 for b in between):
        raise WrongValue(
            "'between' names two bodies by whole numbers from 0 on; found {between!r}", between=between
        )
    return Joint(name, _frame(given, kind, name), point, pitch, (int(between[0]), int(between[1])))


def joints_of(given: Iterable[Mapping[str, Any]]) -> tuple[Joint, ...]:
    """Return the joints of a list of mappings.

    Parameters
    ----------
    given
        Mappings (:func:`joint_of`), at least one.

    Returns
    -------
    The joints, in order.

    Raises
    ------
    WrongValue, UnknownName
        As :func:`joint_of`; an empty list.
    """
    if isinstance(given, (Mapping, str)) or not isinstance(given, Iterable):
        raise WrongValue("a list of joints is a list of mappings; found {given!r}", given=str(given)[:60])
    joints = tuple(joint_of(item) for item in given)
    if not joints:
        raise WrongValue("a list of joints must hold at least one")
    return joints


def read_joints(given: Iterable[Joint | Mapping[str, Any]]) -> tuple[Joint, ...]:
    """Return a list of joints unchanged, or read it from mappings.

    Parameters
    ----------
    given
        Joints, or mappings (:func:`joint_of`), at least one.

    Returns
    -------
    The joints, in order.

    Raises
    ------
    WrongValue, UnknownName
        As :func:`joints_of`; a mixture of both.
    """
    every: tuple[Any, ...] = tuple(given)
    known_names = tuple(joint for joint in every if isinstance(joint, Joint))
    if known_names and len(known_names) == len(every):
        return known_names
    return joints_of(every)


def _frame(given: Mapping[str, Any], kind: JointKind, name: str) -> tuple[Vector, Vector, Vector]:
    if not {"axis", "normal"} & set(kind.needs):
        return (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
    u = _direction(given, "axis" if "axis" in kind.needs else "normal")
    if not {"axis", "normal"} <= set(kind.needs):
        return frame_about(u)
    n = _direction(given, "normal")
    if abs(dot(u, n)) > _SQUARE:
        raise WrongValue(
            "the axis and the normal of a {name} must be perpendicular; the cosine of their angle is "
            "{cosine:.3g}",
            name=Message(name),
            cosine=dot(u, n),
        )
    w = unit(cross(u, n))
    return u, cross(w, u), w


def _vector(given: Mapping[str, Any], key: str) -> Vector:
    values = given[key]
    if isinstance(values, str) or not hasattr(values, "__len__") or len(values) != 3:
        raise WrongValue("{key!r} is three numbers; found {values!r}", key=key, values=str(values)[:60])
    x, y, z = (_number(value, key) for value in values)
    return x, y, z


def _direction(given: Mapping[str, Any], key: str) -> Vector:
    vector = _vector(given, key)
    largest = max(abs(x) for x in vector)
    if not largest:
        raise WrongValue("{key!r} must have a direction; found (0, 0, 0)", key=key)
    return unit([x / largest for x in vector])


def _number(value: Any, key: str) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not math.isfinite(number):
        raise WrongValue("{key!r} must hold finite numbers; found {value!r}", key=key, value=str(value)[:60])
    return number


_TOGETHER = 1e-12  #: points nearer to one another than that, relative to their coordinates, coincide


@dataclass(frozen=True)
class TwistReference:
    """Origin of twists and unit of their lengths, which make ranks independent of units."""

    origin: Vector
    length: float

    @staticmethod
    def of(joints: Sequence[Joint]) -> TwistReference:
        """Return the reference of some joints.

        Parameters
        ----------
        joints
            Joints with points and pitches in one unit of length.

        Returns
        -------
        The middle of the joints' points and the largest distance from it, in that unit. Where all points
        coincide, the advance a radian of the largest pitch is the only length; where there is none, any
        length does.
        """
        points = [joint.point for joint in joints if joint.point is not None]
        origin: Vector = (0.0, 0.0, 0.0)
        reach = 0.0
        if points:
            first = points[0]
            offsets = [[p - f for p, f in zip(point, first, strict=True)] for point in points]
            mean = [math.fsum(column) / len(points) for column in zip(*offsets, strict=True)]
            x, y, z = (f + m for f, m in zip(first, mean, strict=True))
            origin = x, y, z
            reach = max(math.dist(offset, mean) for offset in offsets)
            if reach <= _TOGETHER * max(max(map(abs, point)) for point in points):
                reach = 0.0
        if reach:
            return TwistReference(origin, reach)
        advance = max((abs(joint.pitch) for joint in joints), default=0.0)
        size = max(map(abs, origin))
        return TwistReference(origin, advance / (2 * math.pi) or size or 1.0)
