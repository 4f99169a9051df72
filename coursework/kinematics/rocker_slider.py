"""A slider moved by the rocker of a four-bar: where it turns back, over a whole turn of the crank.

The crank turns about O = (0, 0) and moves the rocker by the coupler; the rocker turns about D, which lies at
``ground`` from O in the direction ``ground_angle``. A rod joins the inner joint B to the slider C, to the right of B on
the line y = ``line``. The slider turns back where the rocker does, crank and coupler in line, and wherever the
rod lines up with the rocker: two, four or more times a turn.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from coursework.errors import CannotAssemble
from coursework.kinematics.cycle import turning_points
from coursework.kinematics.dyads import rrr
from coursework.kinematics.margins import grashof_margins
from coursework.kinematics.vectors import cross


class RockerSlider(NamedTuple):
    """One such mechanism, or an array of them: numbers that broadcast.

    Lengths are positive, in one common unit, ``line`` of either sign; angles radians. ``side`` is +1 where B lies left of the
    line from the crank pin to D, -1 where right: it stays so over the turn.
    """

    ground: Any
    ground_angle: Any
    crank: Any
    coupler: Any
    rocker: Any
    side: Any
    rod: Any
    line: Any

    def rocker_vectors(self, crank_angles: Any) -> np.ndarray:
        """The vector D -> B, complex, for crank angles along a last axis: shape ``(..., k)``, k angles each.

        NaN where the loop does not close.
        """
        linkage = [np.asarray(value)[..., None] for value in self[:6]]
        return _rocker_and_coupler(np.asarray(crank_angles), *linkage)[0]

    def turning_points(self) -> np.ndarray:
        """The crank angles at which the slider turns back.

        Radians, shape ``(..., k)``, k at least 2: those of each mechanism in the order of the turn, then NaN.

        Raises
        ------
        CannotAssemble
            Scalars only: the crank does not turn fully, or the rod does not reach its line all turn; says by how
            much. NaN throughout in arrays.

        Source
        ------
        Changes of sign of the slider's velocity, refined to neighbouring doubles (:mod:`cycle`).
        """
        given = np.broadcast_arrays(*self)
        shape = given[0].shape
        flat = [np.atleast_1d(np.asarray(value, dtype=float)).ravel() for value in given]
        crank, rod = _margins(*flat)
        if not shape:
            _refuse_negative(crank[0], rod[0])
        angles = turning_points(_advance_of_slider, flat)
        angles[~((crank > 0) & (rod > 0))] = np.nan
        return angles.reshape(*shape, angles.shape[1])


def _refuse_negative(crank: float, rod: float) -> None:
    if not crank > 0:
        raise CannotAssemble(
            f"the crank does not turn fully: the linkage lacks {-crank:.3g} to close at every angle"
        )
    if not rod > 0:
        raise CannotAssemble(f"the rod does not reach its line all turn: it is too short by {-rod:.3g}")


def _margins(
    ground: Any, ground_angle: Any, crank: Any, coupler: Any, rocker: Any, side: Any, rod: Any, line: Any
) -> tuple[np.ndarray, np.ndarray]:
    """By how much the crank turns fully, and the rod reaches its line, at every crank angle; shape ``(n,)`` each."""
    stretched, folded = grashof_margins(ground, crank, coupler, rocker)
    turns = np.minimum(stretched, folded) / (ground + crank + coupler + rocker)
    linkage = (ground, ground_angle, crank, coupler, rocker, side)
    at_ends = turning_points(_rise_of_joint, linkage)
    with np.errstate(invalid="ignore"):
        arm = _rocker_and_coupler(at_ends, *[value[:, None] for value in linkage])[0]
        rise = abs((line - ground * np.sin(ground_angle))[:, None] - arm.imag)
    return turns, rod - np.where(np.isnan(rise), 0.0, rise).max(axis=1)


def _rocker_and_coupler(
    angle: Any, ground: Any, ground_angle: Any, crank: Any, coupler: Any, rocker: Any, side: Any
) -> tuple[Any, Any, Any]:
    """Vectors DB, AB and OA."""
    pin, pivot = crank * np.exp(1j * angle), ground * np.exp(1j * ground_angle)
    joint = rrr(pin, pivot, coupler, rocker, side)
    return joint - pivot, joint - pin, pin


def _rocker_ratio(rocker: Any, coupler: Any, crank: Any) -> Any:
    """Angular velocity of the rocker over that of the crank, of the three vectors: along the coupler both ends
    move alike."""
    return cross(coupler, crank) / cross(coupler, rocker)


def _rise_of_joint(angle: Any, *linkage: Any) -> Any:
    """Derivative of B's ordinate with respect to the crank angle."""
    vectors = _rocker_and_coupler(angle, *linkage)
    return _rocker_ratio(*vectors) * vectors[0].real


def _advance_of_slider(angle: Any, *mechanism: Any) -> Any:
    """Derivative of the slider's abscissa with respect to the crank angle: no velocity of C across its line."""
    ground, ground_angle, *_, rod, line = mechanism
    vectors = rocker, *_ = _rocker_and_coupler(angle, *mechanism[:6])
    rise = line - ground * np.sin(ground_angle) - rocker.imag
    with np.errstate(invalid="ignore"):
        run = np.sqrt((rod - rise) * (rod + rise))
    return _rocker_ratio(*vectors) * (rocker.real * rise / run - rocker.imag)
