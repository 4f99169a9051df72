"""Slider moved by the rocker of a four-bar: its turning points over a full turn of the crank.

The crank turns about O = (0, 0) and moves the rocker by the coupler; the rocker turns about D, which lies at
``ground`` from O in the direction ``ground_angle``. A rod joins the inner joint B to the slider C, to the
right of B on the line y = ``line``. The slider turns back where the rocker does, crank and coupler in line,
and wherever the rod lines up with the rocker: two, four or more times a turn.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from coursework.errors import CannotAssemble
from coursework.kinematics.cycle import turning_points
from coursework.kinematics.dyads import rrr
from coursework.kinematics.margins import grashof_margins
from coursework.kinematics.triangles import corner
from coursework.kinematics.vectors import cross


class RockerSlider(NamedTuple):
    """Rocker-driven slider mechanism, or an array of them; the numbers broadcast.

    Lengths are positive, in one common unit, ``line`` of either sign; angles radians. ``side`` is +1 where B
    lies left of the line from the crank pin to D, -1 where right: it stays so over the turn.
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
        """Return the vector D -> B for some crank angles.

        Parameters
        ----------
        crank_angles
            Radians, k of them along a last axis, of a shape that broadcasts with the lengths.

        Returns
        -------
        Complex numbers in the mechanism's unit of length, shape ``(..., k)``; NaN where the loop does not
        close.

        Source
        ------
        :func:`dyads.rrr`.
        """
        linkage = [np.asarray(value)[..., None] for value in self[:6]]
        return _rocker_and_coupler(np.asarray(crank_angles), *linkage)[0]

    def turning_points(self) -> np.ndarray:
        """Return the crank angles at which the slider turns back.

        Radians, shape ``(..., k)``, k at least 2: those of each mechanism in the order of the turn, then NaN.

        Raises
        ------
        CannotAssemble
            Scalars only: the crank does not turn fully, or the rod does not reach its line all turn; says by
            how much. NaN throughout in arrays.

        Source
        ------
        Changes of sign of the slider's velocity, refined to neighbouring doubles (:mod:`cycle`).
        """
        shape, flat, closes = self._closed_all_turn()
        angles = turning_points(_advance_of_slider, flat)
        angles[~closes] = np.nan
        return angles.reshape(*shape, angles.shape[1])

    def stroke(self) -> Any:
        """Return the distance between the extreme positions of the slider, however often it turns back.

        A small crank costs no digit: nothing is a difference of two places. Errors as in
        :meth:`turning_points`.

        Source
        ------
        The rocker swings between the directions where crank and coupler are in line; within that arc the
        slider turns back where the rod is in line with the rocker.
        """
        shape, flat, closes = self._closed_all_turn()
        with np.errstate(all="ignore"):
            result = np.where(closes, _stroke(*flat), np.nan)
        return result.reshape(shape) if shape else float(result[0])

    def times_turned(self) -> Any:
        """Count the turning points of the slider in a turn; 0 where the loop does not close all turn.

        Errors as in :meth:`turning_points`.
        """
        shape, flat, closes = self._closed_all_turn()
        with np.errstate(all="ignore"):
            half = _swing(*flat[:6])[1]
            passed = np.isfinite(_in_line(*flat)).sum(axis=0)
        # A rocker that swings passes each direction in the arc twice, and turns back at its ends.
        result = np.where(closes, np.where(half == math.pi, passed, 2 + 2 * passed), 0)
        return result.reshape(shape) if shape else int(result[0])

    def _closed_all_turn(self) -> tuple[tuple[int, ...], list[np.ndarray], np.ndarray]:
        """Return the shape, the numbers of each mechanism, and whether it closes at every crank angle."""
        given = np.broadcast_arrays(*self)
        flat = [np.atleast_1d(np.asarray(value, dtype=float)).ravel() for value in given]
        with np.errstate(all="ignore"):
            crank, rod = _margins(*flat)
        if not given[0].shape:
            _refuse_negative(crank[0], rod[0])
        return given[0].shape, flat, (crank > 0) & (rod > 0)


def _refuse_negative(crank: float, rod: float) -> None:
    if not crank > 0:
        raise CannotAssemble(
            "the crank does not turn fully: the linkage lacks {gap:.3g} to close at every angle", gap=-crank
        )
    if not rod > 0:
        raise CannotAssemble(
            "the rod does not reach its line all turn: it is too short by {gap:.3g}", gap=-rod
        )


def _margins(
    ground: Any, ground_angle: Any, crank: Any, coupler: Any, rocker: Any, side: Any, rod: Any, line: Any
) -> tuple[np.ndarray, np.ndarray]:
    """Return the margins by which the crank turns fully and the rod reaches its line; shape ``(n,)`` each."""
    stretched, folded = grashof_margins(ground, crank, coupler, rocker)
    turns = np.minimum(stretched, folded) / (ground + crank + coupler + rocker)
    middle, half = _swing(ground, ground_angle, crank, coupler, rocker, side)
    up, down = (
        np.where(abs(_turn(direction - middle)) < half, direction, np.nan)
        for direction in (math.pi / 2, -math.pi / 2)
    )
    level = line - ground * np.sin(ground_angle)
    rises = [
        abs(level - rocker * np.sin(direction)) for direction in (middle + half, middle - half, up, down)
    ]
    return turns, rod - np.fmax.reduce(rises)


def _swing(
    ground: Any, ground_angle: Any, crank: Any, coupler: Any, rocker: Any, side: Any
) -> tuple[Any, Any]:
    """Return the middle and the half-width of the arc of the rocker's directions, for a crank that turns
    fully.

    That is half a turn where the rocker turns fully too: then crank and coupler are never in line.
    """
    # Angles at D of the triangles with crank and coupler stretched and folded; their cosines differ by
    # 2 crank coupler / (ground rocker), which is their difference where it is small.
    far, near = corner(ground, rocker, coupler + crank), corner(ground, rocker, abs(coupler - crank))
    mean = (far + near) / 2
    half = np.arcsin(crank * coupler / (ground * rocker * np.sin(mean)))
    half = np.where(half < 0.5, half, (far - near) / 2)
    middle = ground_angle + math.pi - side * np.where(np.isnan(mean), 0.0, mean)
    return middle, np.where(np.isnan(mean), math.pi, half)


def _in_line(
    ground: Any, ground_angle: Any, crank: Any, coupler: Any, rocker: Any, side: Any, rod: Any, line: Any
) -> np.ndarray:
    """Return the angles from the middle of the arc at which rod and rocker are in line, stretched and folded;
    NaN outside it."""
    middle, half = _swing(ground, ground_angle, crank, coupler, rocker, side)
    level = line - ground * np.sin(ground_angle)
    stretched, folded = np.arcsin(level / (rocker + rod)), math.pi - np.arcsin(level / (rocker - rod))
    turned = _turn(np.stack([stretched - middle, folded - middle]))
    return np.where(abs(turned) < half, turned, np.nan)


def _stroke(
    ground: Any, ground_angle: Any, crank: Any, coupler: Any, rocker: Any, side: Any, rod: Any, line: Any
) -> Any:
    level = line - ground * np.sin(ground_angle)
    middle, half = _swing(ground, ground_angle, crank, coupler, rocker, side)
    start = middle + half
    rise = level - rocker * np.sin(start)
    run = np.sqrt((rod - rise) * (rod + rise))
    reached = [np.zeros_like(start)]
    for turn in (-half, *_in_line(ground, ground_angle, crank, coupler, rocker, side, rod, line)):
        by = turn - half
        on = start + 0.5 * by
        rise_there = level - rocker * np.sin(start + by)
        slope = (rise + rise_there) / (run + np.sqrt((rod - rise_there) * (rod + rise_there)))
        # The rocker's pin goes along a chord across the direction half way; the rod's run follows its rise.
        reached.append(2 * rocker * np.sin(0.5 * by) * (slope * np.cos(on) - np.sin(on)))
    return np.fmax.reduce(reached) - np.fmin.reduce(reached)


def _turn(angle: Any) -> Any:
    """Return the angle reduced to [-pi, pi]."""
    return angle - 2 * math.pi * np.rint(angle / (2 * math.pi))


def _rocker_and_coupler(
    angle: Any, ground: Any, ground_angle: Any, crank: Any, coupler: Any, rocker: Any, side: Any
) -> tuple[Any, Any, Any]:
    """Return the vectors DB, AB and OA."""
    pin, pivot = crank * np.exp(1j * angle), ground * np.exp(1j * ground_angle)
    joint = rrr(pin, pivot, coupler, rocker, side)
    return joint - pivot, joint - pin, pin


def _rocker_ratio(rocker: Any, coupler: Any, crank: Any) -> Any:
    """Return the ratio of the angular velocities of rocker and crank: both ends of the coupler have one
    velocity along it."""
    return cross(coupler, crank) / cross(coupler, rocker)


def _advance_of_slider(angle: Any, *mechanism: Any) -> Any:
    """Return the derivative of the slider's abscissa by the crank angle: C has no velocity across its
    line."""
    ground, ground_angle, *_, rod, line = mechanism
    vectors = rocker, *_ = _rocker_and_coupler(angle, *mechanism[:6])
    rise = line - ground * np.sin(ground_angle) - rocker.imag
    with np.errstate(invalid="ignore"):
        run = np.sqrt((rod - rise) * (rod + rise))
    return _rocker_ratio(*vectors) * (rocker.real * rise / run - rocker.imag)
