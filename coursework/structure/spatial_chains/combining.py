"""Joints in parallel, between the same two bodies, and joints in series."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from coursework.structure.spatial_chains.joints import Joint, TwistReference, Vector, read_joints
from coursework.structure.spatial_chains.poses import all_free_at_every_pose
from coursework.structure.spatial_chains.ranks import Rank, decompose
from coursework.structure.spatial_chains.recognition import Equivalent, recognise

#: What joints in parallel demand of their makers: nothing, parallel or square directions, distances and
#: centres, or both.
CONDITIONS = ("none", "directions", "positions", "both")


def in_parallel(joints: Iterable[Joint | Mapping[str, Any]]) -> Parallel:
    """Combine joints between the same two bodies: each constraint and each transmitted action of any joint
    remains.

    Parameters
    ----------
    joints
        Joints, or their mappings; points and pitches in one unit of length.

    Returns
    -------
    The combination, whose numbers are computed on first use.

    Raises
    ------
    WrongValue, UnknownName
        As :func:`~coursework.structure.spatial_chains.joints.joint_of`; an empty list.
    """
    return Parallel(read_joints(joints))


def in_series(joints: Iterable[Joint | Mapping[str, Any]]) -> Series:
    """Combine joints in a row: their free motions add up.

    Parameters
    ----------
    joints
        Joints, or their mappings; points and pitches in one unit of length.

    Returns
    -------
    The combination, whose numbers are computed on first use.

    Raises
    ------
    WrongValue, UnknownName
        As :func:`in_parallel`.
    """
    return Series(read_joints(joints))


@dataclass(frozen=True)
class _Combined:
    """Several joints as one. Each number is computed on first use."""

    joints: tuple[Joint, ...]

    @cached_property
    def measure(self) -> TwistReference:
        return TwistReference.of(self.joints)

    @cached_property
    def _spaces(self) -> tuple[Rank, np.ndarray, np.ndarray]:
        """Rank, basis of the twists left free, and basis of the wrenches transmitted."""
        raise NotImplementedError

    def _spanned(
        self, rows_of: Callable[[Joint, Vector, float], list[list[float]]], subject: str
    ) -> tuple[Rank, np.ndarray, np.ndarray]:
        """Return the rank of the rows of all joints, and bases of what they span and of what is perpendicular
        to it."""
        at = self.measure
        rows = [row for joint in self.joints for row in rows_of(joint, at.origin, at.length)]
        matrix = np.array(rows).reshape(-1, 6)
        return decompose(matrix / np.linalg.norm(matrix, axis=1, keepdims=True), subject)

    @property
    def rank(self) -> Rank:
        return self._spaces[0]

    @property
    def turns(self) -> int:
        """Number of independent rotation vectors of the last body with respect to the first."""
        twists = self._spaces[1]
        return int(np.linalg.matrix_rank(twists[:, :3], tol=1e-9)) if len(twists) else 0

    @cached_property
    def equivalent(self) -> Equivalent:
        _, twists, wrenches = self._spaces
        return recognise(twists, wrenches, self.measure)


class Parallel(_Combined):
    """Joints in parallel."""

    @cached_property
    def _spaces(self) -> tuple[Rank, np.ndarray, np.ndarray]:
        rank, wrenches, twists = self._spanned(Joint.wrenches, "the transmitted actions")
        return rank, twists, wrenches

    @property
    def Ns(self) -> int:
        """Number of unknown components of the actions of all the joints."""
        return sum(6 - joint.freedoms for joint in self.joints)

    @property
    def rs(self) -> int:
        """Number of those unknowns that the six equilibrium equations determine."""
        return self.rank.value

    @property
    def h(self) -> int:
        return self.Ns - self.rs

    @property
    def m(self) -> int:
        return 6 - self.rs

    @cached_property
    def angular(self) -> int:
        """Number of redundant unknowns that moments alone balance: conditions on directions."""
        moments = [row for joint in self.joints for row in joint.moments]
        rows = np.array(moments).reshape(-1, 3)
        return len(rows) - decompose(rows, "the transmitted moments", 1.0)[0].value

    @property
    def linear(self) -> int:
        """Number of conditions on positions: the other redundant unknowns, which forces balance."""
        return self.h - self.angular

    @property
    def condition(self) -> str:
        """Geometric condition for the joints to fit together, one of :data:`CONDITIONS`."""
        if self.angular:
            return "both" if self.linear else "directions"
        return "positions" if self.linear else "none"


class Series(_Combined):
    """Joints in series."""

    @cached_property
    def _spaces(self) -> tuple[Rank, np.ndarray, np.ndarray]:
        return self._spanned(Joint.twists, "the free motions")

    @property
    def Nc(self) -> int:
        """Number of free rates of all the joints."""
        return sum(joint.freedoms for joint in self.joints)

    @property
    def m(self) -> int:
        return self.Nc

    @property
    def m_useful(self) -> int:
        """Freedoms of the last body with respect to the first."""
        return self.rank.value

    @property
    def m_internal(self) -> int:
        """Freedoms that remain when the last body is held to the first."""
        return self.Nc - self.m_useful

    @property
    def h(self) -> int:
        """Static indeterminacy, 0: each joint's action equals that of the whole, so it is known."""
        return 0

    @cached_property
    def equivalent(self) -> Equivalent:
        """Equivalent joint: ``free`` only where all six freedoms exist at every pose; where they exist at
        this pose alone, ``other``."""
        if self.m_useful == 6 and not all_free_at_every_pose(self.joints):
            return Equivalent("other")
        return super().equivalent
