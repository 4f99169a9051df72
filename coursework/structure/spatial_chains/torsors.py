"""Twists and wrenches at a point: transport to another point, and their components that may differ from
zero."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from coursework.structure.spatial_chains.combining import Parallel, Series
from coursework.structure.spatial_chains.joints import Joint, Vector
from coursework.structure.spatial_chains.ranks import decompose

#: Components of a twist and of a wrench, resultant before moment.
TWIST = ("wx", "wy", "wz", "vx", "vy", "vz")
WRENCH = ("X", "Y", "Z", "L", "M", "N")

_LENGTH = 20.0  #: by which velocities and moments are divided, so that they compare with rotations and forces
_NOTHING = 1e-9


def moved(resultant: Any, moment: Any, arm: Any) -> Any:
    """Return the moment of a wrench, or the velocity of a twist, at another point.

    Parameters
    ----------
    resultant
        Force or rotation, shape ``(..., 3)``.
    moment
        Moment or velocity at the first point, in the unit of ``resultant`` times ``arm``, shape ``(..., 3)``.
    arm
        Vector from the other point to the first, in any unit of length, shape ``(..., 3)``.

    Returns
    -------
    The moment or the velocity at the other point, in its unit, of the broadcast shape.

    Source
    ------
    ``M(B) = M(A) + BA × R`` and ``V(B) = V(A) + BA × Ω``.
    """
    return np.asarray(moment) + np.cross(arm, resultant)


def twist_components(of: Joint | Parallel | Series, point: Vector) -> str:
    """Return the names of the components of the free twists at a point that may differ from zero.

    Parameters
    ----------
    of
        Joint, or joints combined.
    point
        The point, in the unit of the joints' points.

    Returns
    -------
    Names of :data:`TWIST` with spaces between, ``"wz vx"``; ``"0"`` for none.

    Raises
    ------
    CannotTell
        Joints in parallel whose rank hangs on digits that the data do not hold.
    """
    return _named(_twists(of, point), TWIST)


def wrench_components(of: Joint | Parallel | Series, point: Vector) -> str:
    """Return the names of the components of the transmitted wrenches at a point that may differ from zero.

    Parameters
    ----------
    of
        Joint, or joints combined.
    point
        The point, in the unit of the joints' points.

    Returns
    -------
    Names of :data:`WRENCH` with spaces between, ``"X Y M"``; ``"0"`` for none.

    Raises
    ------
    CannotTell
        Joints in series whose rank hangs on digits that the data do not hold.
    """
    if isinstance(of, Joint):
        rows = np.array(of.wrenches(point, _LENGTH)).reshape(-1, 6)
        return _named(np.roll(rows, 3, axis=1), WRENCH)
    if isinstance(of, Parallel):
        every = [wrench_components(joint, point).split() for joint in of.joints]
        results = {name for names in every for name in names}
        return " ".join(name for name in WRENCH if name in results) or "0"
    return _named(np.roll(_perpendicular(_twists(of, point)), 3, axis=1), WRENCH)


def _twists(of: Joint | Parallel | Series, point: Vector) -> np.ndarray:
    if isinstance(of, Joint):
        return np.array(of.twists(point, _LENGTH)).reshape(-1, 6)
    if isinstance(of, Series):
        return np.concatenate([_twists(joint, point) for joint in of.joints])
    rows = [row for joint in of.joints for row in joint.wrenches(point, _LENGTH)]
    return _perpendicular(np.array(rows).reshape(-1, 6))


def _perpendicular(rows: np.ndarray) -> np.ndarray:
    """Return a basis of the torsors that have no power in any row. Moments pair with rotations, forces with
    velocities."""
    sizes = np.linalg.norm(rows, axis=1, keepdims=True)
    return decompose(rows / np.where(sizes > 0, sizes, 1.0), "the torsors")[2]


def _named(rows: np.ndarray, names: Sequence[str]) -> str:
    sizes = np.max(np.abs(rows), axis=0, initial=0.0)
    return " ".join(name for name, size in zip(names, sizes, strict=True) if size > _NOTHING) or "0"
