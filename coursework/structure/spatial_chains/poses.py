"""Freedoms that an open chain has at every pose, not only at the given one.

Joints are moved without limit. Rotations span all directions at every pose only where one joint has them all:
hinges in a row always come to lie in one plane somewhere. Translations span space at every pose if two sets
of them do, each carried along by joints that do not turn it, whatever the hinges between them do.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from coursework.structure.spatial_chains.joints import Joint, Vector
from coursework.structure.spatial_chains.ranks import decompose

_HALF = math.pi / 2
_SAME = 1e-7  #: angles that differ by less are equal


def all_free_at_every_pose(joints: Sequence[Joint]) -> bool:
    """Return whether the last body of an open chain has six freedoms relative to the first at every pose.

    A joint that turns and slides may carry its slide on either of its bodies: both cases must hold.

    Parameters
    ----------
    joints
        Joints from the first body to the last.

    Returns
    -------
    True or False.

    Raises
    ------
    CannotTell
        Directions of slides are neither surely equal nor surely distinct.
    """
    if not any(len(joint.kind.rotations) == 3 for joint in joints):
        return False
    if any(joint.name == "free" for joint in joints):
        return True
    blocks = _blocks(joints)
    if any(len(block.span) == 3 for block in blocks):
        return True
    return any(_span_together(blocks, first, other) for first, other in combinations(range(len(blocks)), 2))


@dataclass(frozen=True)
class _SlideBlock:
    """Directions of translations that no rotation separates, and the rotations that follow: axes, in order,
    or None for a joint with more than one."""

    span: np.ndarray
    turns: tuple[Vector, ...] | None

    @property
    def normal(self) -> np.ndarray:
        """Normal of a plane of directions."""
        return np.cross(*self.span)


def _blocks(joints: Sequence[Joint]) -> list[_SlideBlock]:
    results: list[_SlideBlock] = []
    slides: list[Vector] = []
    turns: tuple[Vector, ...] | None = ()
    for joint in joints:
        joint_turns = _turns_of(joint)
        if turns != () and (joint.kind.translations or joint_turns is None):
            results.append(_SlideBlock(_spanned(slides), turns))
            slides, turns = [], ()
        if joint_turns is None and joint.kind.translations:
            # It turns its own slide, or not: that is counted on for nothing.
            results.append(_SlideBlock(_spanned(slides), None))
            slides = []
            continue
        slides += joint.slides
        turns = None if joint_turns is None or turns is None else (*turns, *joint_turns)
    return [*results, _SlideBlock(_spanned(slides), ())]


def _turns_of(joint: Joint) -> tuple[Vector, ...] | None:
    """Return the rotation axes of a joint; None for a joint that rotates about more than one."""
    if len(joint.kind.rotations) > 1:
        return None
    return tuple(joint.turns)


def _spanned(slides: Sequence[Vector]) -> np.ndarray:
    return decompose(np.array(slides).reshape(-1, 3), "the directions of the slides", 1.0)[1]


def _span_together(blocks: Sequence[_SlideBlock], item: int, other: int) -> bool:
    """Return whether two blocks span space at every position of the rotations between them."""
    first, last = blocks[item].span, blocks[other].span
    axes: list[Vector] = []
    for block in blocks[item:other]:
        if block.turns is None:
            return False
        axes += block.turns
    if len(first) + len(last) < 3 or 0 in (len(first), len(last)):
        return False
    a = blocks[item].normal if len(first) == 2 else first[0]
    b = blocks[other].normal if len(last) == 2 else last[0]
    low, high = _angles(a, axes, b)
    if len(first) == len(last):  # two planes, which must not coincide
        return low > _SAME and high < math.pi - _SAME
    return high < _HALF - _SAME or low > _HALF + _SAME  # a line, which must not lie in the plane


def _angles(fixed: np.ndarray, axes: Sequence[Vector], turned: np.ndarray) -> tuple[float, float]:
    """Return the least and the largest angle between two directions, one of which is rotated about axes in
    turn."""
    chain = [fixed, *(np.array(axis) for axis in axes), turned]
    low = high = _angle(chain[-1], chain[-2])
    for axis, before in zip(chain[-2:0:-1], chain[-3::-1], strict=True):
        step = _angle(axis, before)
        ends = [abs(low - step), abs(high - step), _folded(low + step), _folded(high + step)]
        reached = low - _SAME <= step <= high + _SAME
        opposite = low - _SAME <= math.pi - step <= high + _SAME
        low, high = 0.0 if reached else min(ends), math.pi if opposite else max(ends)
    return low, high


def _folded(angle: float) -> float:
    return min(angle, 2 * math.pi - angle)


def _angle(a: np.ndarray, b: np.ndarray) -> float:
    return math.atan2(float(np.linalg.norm(np.cross(a, b))), float(a @ b))
