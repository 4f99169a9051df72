"""Joints along coordinate axes and along vectors of whole numbers, and functions of them on columns of
variants."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from coursework.errors import WrongValue

Whole: TypeAlias = tuple[int, int, int]

_WHOLE: Mapping[str, Whole] = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}
_NEXT = {"x": "y", "y": "z", "z": "x"}


def aligned(
    name: str,
    along: str,
    point: Sequence[float] = (0.0, 0.0, 0.0),
    between: Sequence[int] = (0, 1),
    tilt: str = "",
) -> dict[str, Any]:
    """Return the mapping of a joint along a direction of whole numbers.

    The direction is the axis, the normal of a joint that has no axis, and the line of a contact along a line,
    whose normal is then the direction that follows: y after x, z after y, x after z; of a direction in a
    coordinate plane, what a quarter of a turn in that plane makes of it.

    Parameters
    ----------
    name
        Name of the joint, one of :data:`~coursework.structure.spatial_chains.joints.JOINTS` without a pitch.
    along
        Direction: ``x``, ``y``, ``z``, or three whole numbers such as ``3 4 0``.
    point
        Coordinates of the joint's point, in any unit of length.
    between
        Numbers of its two bodies.
    tilt
        Axis of the origin, ``x``, ``y`` or ``z``, about which the joint is turned with its point by the angle
        of cosine 4/5 and sine 3/5; empty for none.

    Returns
    -------
    The mapping, with unit vectors ``axis`` and ``normal``, and ``point`` in its unit.

    Raises
    ------
    WrongValue
        As :func:`directions_of`.
    """
    axis, after = directions_of(along, tilt)
    x, y, z = point
    return {
        "between": list(between),
        "joint": name,
        "axis": _unit(axis),
        "normal": _unit(after if name == "line_contact" else axis),
        "point": list(placed((float(x), float(y), float(z)), tilt)),
    }


def directions_of(along: str, tilt: str = "") -> tuple[Whole, Whole]:
    """Return a direction and the one that follows it (:func:`aligned`), in whole numbers.

    Parameters
    ----------
    along, tilt
        Direction and axis of the tilt, as in :func:`aligned`.

    Returns
    -------
    Both directions, five times as long with a tilt; the second is (0, 0, 0) for a direction in no coordinate
    plane.

    Raises
    ------
    WrongValue
        ``along`` is neither a letter nor three whole numbers, not all of them 0.
    """
    if along in _WHOLE:
        axis, after = _WHOLE[along], _WHOLE[_NEXT[along]]
    else:
        axis = _three(along)
        position = axis.index(0) if 0 in axis else -1
        about: Whole = tuple(int(k == position) for k in range(3))  # type: ignore[assignment]
        after = _crossed(about, axis)
    return _turned(axis, tilt), _turned(after, tilt)


def placed(point: tuple[float, float, float], tilt: str = "") -> tuple[float, float, float]:
    """Return a point turned by the tilt of :func:`aligned`.

    Parameters
    ----------
    point
        Coordinates, in any unit of length.
    tilt
        Axis of the tilt; empty for none.

    Returns
    -------
    The coordinates, in the same unit.
    """
    x, y, z = (c / (5.0 if tilt else 1.0) for c in _turned(point, tilt))
    return x, y, z


class AlignedJoint(NamedTuple):
    """Arguments of :func:`aligned` for one joint."""

    name: str
    along: str
    point: tuple[float, float, float]
    tilt: str = ""

    def mapping(self, between: Sequence[int] = (0, 1)) -> dict[str, Any]:
        """Return the mapping of the joint between two bodies.

        Parameters
        ----------
        between
            Numbers of the bodies.

        Returns
        -------
        The mapping of :func:`aligned`.
        """
        return aligned(self.name, self.along, self.point, between, self.tilt)


#: How many joints there are, whether all are tilted, and whether the direction of the second is inclined.
ARRANGEMENTS: Mapping[str, tuple[int, bool, bool]] = {
    "two": (2, False, False),
    "two_tilted": (2, True, False),
    "two_inclined": (2, False, True),
    "three": (3, False, False),
    "three_tilted": (3, True, False),
    "four": (4, False, False),
}


def arranged(arrangement: str, tilt: str, inclined: str, *joints: Sequence[Any]) -> tuple[AlignedJoint, ...]:
    """Return the joints of an arrangement at their positions.

    Parameters
    ----------
    arrangement
        Name in :data:`ARRANGEMENTS`.
    tilt
        Axis of the tilt, for an arrangement that is tilted.
    inclined
        Direction of the second joint, for an arrangement in which it is inclined.
    joints
        Name, direction, x, y and z of each joint, mm; those beyond the arrangement's number are ignored.

    Returns
    -------
    The joints, points in mm.
    """
    count, is_tilted, is_inclined = ARRANGEMENTS[arrangement]
    return tuple(
        AlignedJoint(
            name,
            inclined if is_inclined and number == 1 else along,
            (float(x), float(y), float(z)),
            tilt if is_tilted else "",
        )
        for number, (name, along, x, y, z) in enumerate(joints[:count])
    )


def _three(along: str) -> Whole:
    try:
        x, y, z = map(int, along.split())
    except ValueError:
        raise WrongValue(
            "a direction is x, y, z or three whole numbers such as '3 4 0'; found {along!r}", along=along[:40]
        ) from None
    if not (x or y or z):
        raise WrongValue("a direction has a number that is not 0; found '0 0 0'")
    return x, y, z


def _crossed(a: Any, b: Any) -> Any:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def _turned(vector: Any, tilt: str) -> Any:
    """Return five times the vector turned by the tilt; without a tilt the vector itself."""
    if not tilt:
        return vector
    about = _WHOLE[tilt]
    across = _crossed(about, vector)
    along = sum(a * v for a, v in zip(about, vector, strict=True))
    # Rodrigues' formula, five times.
    return tuple(4 * v + 3 * c + along * a for v, c, a in zip(vector, across, about, strict=True))


def _unit(vector: Whole) -> list[float]:
    size = math.sqrt(sum(x * x for x in vector))
    return [x / size for x in vector] if size else [0.0, 0.0, 0.0]


def each_distinct(function: Callable[..., Any], *columns: Any) -> Any:
    """Evaluate a function on each row of some columns, once for each distinct row.

    Parameters
    ----------
    function
        Function of as many scalars as there are columns.
    columns
        Scalars or arrays that broadcast, in the units of the function.

    Returns
    -------
    The results, of the broadcast shape, in an array of objects if they are neither numbers nor truth values;
    the function's own result for scalars.
    """
    if not any(np.ndim(column) for column in columns):
        return function(*columns)
    arrays = np.broadcast_arrays(*[np.asarray(column) for column in columns])
    code = np.zeros(arrays[0].size, dtype=np.int64)
    for array in arrays:
        values, places = np.unique(array.ravel(), return_inverse=True)
        code = code * len(values) + places.ravel()
    _, first, rows = np.unique(code, return_index=True, return_inverse=True)
    flat = [array.ravel() for array in arrays]
    answers = [function(*[column[index].item() for column in flat]) for index in first]
    result = np.empty(len(answers), dtype=object)
    result[:] = answers
    if answers and all(isinstance(answer, (bool, int, float)) for answer in answers):
        result = np.array(answers)
    return result[rows.ravel()].reshape(arrays[0].shape)
