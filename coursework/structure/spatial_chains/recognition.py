"""Recognition of the joint that has a given space of twists."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coursework.structure.spatial_chains.joints import TwistReference
from coursework.structure.spatial_chains.ranks import decompose, is_zero

EQUIVALENTS: tuple[str, ...] = (
    "rigid",
    "revolute",
    "prismatic",
    "helical",
    "cylindrical",
    "spherical_pin",
    "spherical",
    "planar",
    "annular",
    "line_contact",
    "point_contact",
    "free",
    "other",
)  #: what :func:`recognise` may answer


@dataclass(frozen=True)
class Equivalent:
    """Recognised joint: unit vectors up to sign, a point in the unit of the data; None for an attribute that
    it lacks.

    ``point`` is any point of the axis or of the normal, the centre where the joint has one.
    """

    name: str
    axis: tuple[float, float, float] | None = None
    normal: tuple[float, float, float] | None = None
    point: tuple[float, float, float] | None = None
    pitch: float | None = None

    @property
    def direction(self) -> tuple[float, float, float] | None:
        """Axis, or the normal of a joint that has no axis."""
        return self.normal if self.axis is None else self.axis


def recognise(twists: np.ndarray, wrenches: np.ndarray, measure: TwistReference) -> Equivalent:
    """Return the joint whose free twists are those of the rows.

    Parameters
    ----------
    twists, wrenches
        Orthonormal bases perpendicular to one another, shapes ``(m, 6)`` and ``(6 - m, 6)``: rotation and
        velocity, moment and force at the measure's origin, velocities and moments divided by its length.
    measure
        Origin and length, in the unit of the data.

    Returns
    -------
    The joint, its point and pitch in the unit of the data; ``other`` if the table has none.

    Raises
    ------
    CannotTell
        The nature hangs on digits that the data do not hold.
    """
    return _BY_FREEDOMS[len(twists)](_Space(twists, measure), _Space(wrenches, measure))


class _Space:
    """Space of twists, or of wrenches.

    For twists ``line`` is the rotation and ``rest`` the velocity; for wrenches ``line`` is the force and
    ``rest`` the moment: both are a vector along a line, and what it gives at the origin.
    """

    def __init__(self, rows: np.ndarray, measure: TwistReference):
        self.rows, self.measure = rows, measure

    def of_forces(self) -> _Space:
        return _Space(np.roll(self.rows, 3, axis=1), self.measure)

    def split(self) -> tuple[np.ndarray, np.ndarray]:
        """Return a basis whose first rows have independent lines; pure couples or translations follow."""
        lines = self.rows[:, :3]
        rank, _, _ = decompose(lines, "the directions of the axes", 1.0)
        left, _, _ = np.linalg.svd(lines)
        mixed = left.T @ self.rows
        return mixed[: rank.value], mixed[rank.value :, 3:]

    def place(self, arm: np.ndarray) -> tuple[float, float, float]:
        """Return a point, given as a vector from the origin in lengths, in the unit of the data."""
        result = np.asarray(self.measure.origin) + arm * self.measure.length
        return _tidy(result, max(self.measure.length, *map(abs, self.measure.origin)))


def _tidy(vector: np.ndarray, size: float) -> tuple[float, float, float]:
    """Return the vector with rounding errors replaced by zeros."""
    x, y, z = (0.0 if abs(x) <= 1e-12 * size else float(x) for x in vector)
    return x, y, z


def _along(vector: np.ndarray) -> tuple[float, float, float]:
    """Return the unit vector along the vector, signed so that its first coordinate other than zero is
    positive."""
    x = np.asarray(_tidy(vector / np.linalg.norm(vector), 1.0))
    return tuple((x * np.sign(x[np.flatnonzero(x)[0]]) + 0.0).tolist())


def _foot(line: np.ndarray, rest: np.ndarray) -> np.ndarray:
    """Return the point of the axis of (line, rest) nearest to the origin, where rest = arm × line + a
    pitch."""
    return np.cross(line, rest) / (line @ line)


def _common_point(rows: np.ndarray) -> np.ndarray | None:
    """Return the common point of all axes, each without pitch; None if there is none."""
    system = np.concatenate([_crossing(row[:3]) for row in rows])
    right = np.concatenate([row[3:] for row in rows])
    arm, *_ = np.linalg.lstsq(system, right, rcond=None)
    gap = float(np.linalg.norm(system @ arm - right)) / max(1.0, float(np.linalg.norm(arm)))
    return arm if is_zero(gap, "the axes meet in one point") else None


def _crossing(line: np.ndarray) -> np.ndarray:
    """Return the matrix of arm -> arm × line."""
    x, y, z = line
    return np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])


def _rigid(twists: _Space, wrenches: _Space) -> Equivalent:
    return Equivalent("rigid")


def _one_freedom(twists: _Space, wrenches: _Space) -> Equivalent:
    turning, sliding = twists.split()
    if len(sliding):
        return Equivalent("prismatic", axis=_along(sliding[0]))
    line, rest = turning[0, :3], turning[0, 3:]
    axis, point = _along(line), twists.place(_foot(line, rest))
    pitch = float(line @ rest / (line @ line))
    if is_zero(pitch, "the motion is a rotation"):
        return Equivalent("revolute", axis=axis, point=point)
    return Equivalent("helical", axis=axis, point=point, pitch=2 * np.pi * pitch * twists.measure.length)


def _two(twists: _Space, wrenches: _Space) -> Equivalent:
    turning, sliding = twists.split()
    if len(turning) == 2:
        centre = _common_point(turning)
        if centre is not None:
            normal = np.cross(turning[0, :3], turning[1, :3])
            return Equivalent("spherical_pin", axis=_along(normal), point=twists.place(centre))
    elif len(turning) == 1:
        line, along = turning[0, :3], sliding[0]
        if _are_parallel(line, along):
            return Equivalent(
                "cylindrical", axis=_along(line), point=twists.place(_foot(line, turning[0, 3:]))
            )
    return Equivalent("other")


def _three(twists: _Space, wrenches: _Space) -> Equivalent:
    turning, sliding = twists.split()
    if len(turning) == 3:
        centre = _common_point(turning)
        if centre is not None:
            return Equivalent("spherical", point=twists.place(centre))
    elif len(turning) == 1 and _are_parallel(np.cross(*sliding), turning[0, :3]):
        return Equivalent("planar", normal=_along(turning[0, :3]))
    return Equivalent("other")


def _four(twists: _Space, wrenches: _Space) -> Equivalent:
    forces, couples = wrenches.of_forces().split()
    if len(forces) == 2:
        centre = _common_point(forces)
        if centre is not None:
            along = np.cross(forces[0, :3], forces[1, :3])
            return Equivalent("annular", axis=_along(along), point=wrenches.place(centre))
    elif len(forces) == 1:
        force, moment, couple = forces[0, :3], forces[0, 3:], couples[0] / np.linalg.norm(couples[0])
        square = is_zero(
            float(force @ couple / np.linalg.norm(force)), "the couple is perpendicular to the force"
        )
        if square and is_zero(float(force @ moment / (force @ force)), "the action is a force"):
            return Equivalent(
                "line_contact",
                axis=_along(np.cross(force, couple)),
                normal=_along(force),
                point=wrenches.place(_foot(force, moment - (moment @ couple) * couple)),
            )
    return Equivalent("other")


def _five(twists: _Space, wrenches: _Space) -> Equivalent:
    forces, _ = wrenches.of_forces().split()
    if len(forces):
        force, moment = forces[0, :3], forces[0, 3:]
        if is_zero(float(force @ moment / (force @ force)), "the action is a force"):
            return Equivalent(
                "point_contact", normal=_along(force), point=wrenches.place(_foot(force, moment))
            )
    return Equivalent("other")


def _free(twists: _Space, wrenches: _Space) -> Equivalent:
    return Equivalent("free")


def _are_parallel(a: np.ndarray, b: np.ndarray) -> bool:
    sine = np.linalg.norm(np.cross(a, b)) / (np.linalg.norm(a) * np.linalg.norm(b))
    return is_zero(float(sine), "two directions are parallel")


_BY_FREEDOMS = (_rigid, _one_freedom, _two, _three, _four, _five, _free)
