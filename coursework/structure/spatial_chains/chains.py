"""Closed and complex chains, in space and in a plane: their loops, mobility and static indeterminacy.

Bodies are numbered from 0, the frame, without gaps. Around each loop the twists sum to zero; the joint rates
that satisfy all loops are the motions of the mechanism at the given position.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from coursework.errors import WrongValue
from coursework.messages import Message
from coursework.structure.spatial_chains.joints import Joint, TwistReference, Vector, read_joints
from coursework.structure.spatial_chains.ranks import Rank, rank_of


class _Loops:
    """Common base of chains in space and in a plane: the graph, and the numbers that follow from ranks.

    ``equations`` is the number of equations a loop, or a body, gives.
    """

    equations = 6

    def __init__(
        self,
        joints: Iterable[Joint | Mapping[str, Any]],
        inputs: int | None = None,
        outputs: int | None = None,
    ):
        self.joints = read_joints(joints)
        self.inputs, self.outputs = inputs, outputs
        self._ends = [joint.between for joint in self.joints]
        self.n = max(max(ends) for ends in self._ends)  #: moving bodies
        for first, other in self._ends:
            if first == other:
                raise WrongValue(
                    "a joint lies between two different bodies; found {found}", found=[first, other]
                )
        self._paths = self._walk()
        for name, body in (("input", inputs), ("output", outputs)):
            if body is not None and not 0 < body <= self.n:
                raise WrongValue(
                    "the {name} body is one of 1 to {n}; found {body}",
                    name=Message(name),
                    n=self.n,
                    body=body,
                )

    def _walk(self) -> list[dict[int, int]]:
        """Return for each body the joints from the frame to it, with the sense in which each is crossed: a
        spanning tree."""
        paths: dict[int, dict[int, int]] = {0: {}}
        waiting = [0]
        while waiting:
            body = waiting.pop(0)
            for index, (first, other) in enumerate(self._ends):
                for here, there, sense in ((first, other, 1), (other, first, -1)):
                    if here == body and there not in paths:
                        paths[there] = {**paths[body], index: sense}
                        waiting.append(there)
        lost = [body for body in range(self.n + 1) if body not in paths]
        if lost:
            raise WrongValue(
                "bodies {lost} are not linked to the frame; number the bodies from 0 without a gap", lost=lost
            )
        return [paths[body] for body in range(self.n + 1)]

    @cached_property
    def loops(self) -> list[dict[int, int]]:
        """Independent loops as joints with their senses; each joint outside the spanning tree closes one."""
        in_tree = {index for path in self._paths for index in path}
        results = []
        for index, (first, other) in enumerate(self._ends):
            if index in in_tree:
                continue
            loop = dict(self._paths[first])
            loop[index] = 1
            for joint, sense in self._paths[other].items():
                loop[joint] = loop.get(joint, 0) - sense
            results.append({joint: sense for joint, sense in loop.items() if sense})
        return results

    @cached_property
    def measure(self) -> TwistReference:
        return TwistReference.of(self.joints)

    @cached_property
    def columns(self) -> list[np.ndarray]:
        """Free twists of each joint at one point: shape (freedoms, equations)."""
        raise NotImplementedError

    def _system(self, walks: Sequence[Mapping[int, int]]) -> np.ndarray:
        """Return the twist sums along some walks: shape (equations · walks, Nc)."""
        places = np.cumsum([0, *(len(rows) for rows in self.columns)])
        size = self.equations
        matrix = np.zeros((size * len(walks), places[-1]))
        for number, walk in enumerate(walks):
            for joint, sense in walk.items():
                block = slice(places[joint], places[joint + 1])
                matrix[size * number : size * (number + 1), block] = sense * self.columns[joint].T
        return matrix

    @property
    def gamma(self) -> int:
        """Number of independent loops."""
        return len(self.joints) - self.n

    @property
    def Nc(self) -> int:
        """Number of free rates of all the joints."""
        return sum(len(rows) for rows in self.columns)

    @property
    def Ns(self) -> int:
        """Number of unknown components of the actions of all the joints."""
        return self.equations * len(self.joints) - self.Nc

    @cached_property
    def rank(self) -> Rank:
        """Rank of the loop system at the given position, with its gap."""
        return rank_of(self._system(self.loops), "the loop equations")

    @property
    def rc(self) -> int:
        return self.rank.value

    @property
    def m(self) -> int:
        """Mobility."""
        return self.Nc - self.rc

    @property
    def rs(self) -> int:
        """Rank of the equilibrium equations."""
        return self.equations * self.n - self.m

    @property
    def h(self) -> int:
        """Degree of static indeterminacy."""
        return self.Ns - self.rs

    @property
    def i(self) -> int:
        """Index of mobility, which requires no rank."""
        return self.m - self.h

    @cached_property
    def m_internal(self) -> int:
        """Dimension of the motions with the input and the output body at rest."""
        held = [self._paths[body] for body in (self.inputs, self.outputs) if body is not None]
        if not held:
            raise WrongValue("internal mobility needs an input and an output body")
        return (
            self.Nc
            - rank_of(
                self._system([*self.loops, *held]), "the loop equations with input and output locked"
            ).value
        )

    @property
    def m_useful(self) -> int:
        return self.m - self.m_internal


class Chain(_Loops):
    """Chain in space.

    Parameters
    ----------
    joints
        Mappings with ``between``, or joints.
    inputs, outputs
        Bodies whose motions are transformed; needed for ``m_internal`` and ``m_useful`` only.

    Raises
    ------
    WrongValue, UnknownName
        As :func:`~coursework.structure.spatial_chains.joints.joint_of`; bodies that nothing links to the
        frame.
    CannotTell
        When a number is asked for that hangs on digits which the data do not hold.
    """

    @cached_property
    def columns(self) -> list[np.ndarray]:
        at = self.measure
        return [np.array(j.twists(at.origin, at.length)).reshape(-1, 6) for j in self.joints]


_IN_PLANE = (2, 3, 4)  #: rotation about z, velocities along x and y
_PLANAR = {(0, 0): "rigid", (1, 0): "revolute", (0, 1): "prismatic", (1, 1): "point_contact", (1, 2): "free"}


_IN_PLANE_OR_SQUARE = 1e-9  #: largest component out of the plane, or in it, of a direction that has none


@lru_cache(maxsize=1024)
def _projected(name: str, frame: tuple[Vector, Vector, Vector], pitch: float) -> np.ndarray:
    """Return the free twists of a joint in the plane xy, at its own point: shape (k, 3), read-only. Raises
    WrongValue: its axis or its normal is neither in the plane nor perpendicular to it."""
    for vector in frame[:2]:
        across, along = abs(vector[2]), max(abs(vector[0]), abs(vector[1]))
        if min(across, along) > _IN_PLANE_OR_SQUARE:
            x, y, z = vector
            raise WrongValue(
                "in a plane problem axes and normals lie in the plane xy or along z; that of a {name} "
                "is ({x:.6g}, {y:.6g}, {z:.6g})",
                name=Message(name),
                x=x,
                y=y,
                z=z,
            )
    here = (0.0, 0.0, 0.0)
    rows = np.array(Joint(name, frame, here, pitch).twists(here, 1.0)).reshape(-1, 6)[:, _IN_PLANE]
    turns = bool(np.any(np.abs(rows[:, 0]) > _IN_PLANE_OR_SQUARE))
    slides = [row[1:] for row in rows if np.hypot(*row[1:]) > _IN_PLANE_OR_SQUARE * max(1.0, abs(pitch))]
    result = [[1.0, 0.0, 0.0]] if turns else []
    if len(slides) == 1:
        vx, vy = slides[0] / np.hypot(*slides[0])
        result.append([0.0, vx, vy])
    elif slides:
        result += [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    return np.array(result).reshape(-1, 3)


def planar_kind(joint: Joint) -> str:
    """Return the kind of a joint in the plane xy.

    Parameters
    ----------
    joint
        Joint in space.

    Returns
    -------
    ``rigid``, ``revolute``, ``prismatic``, ``point_contact`` or ``free``.

    Raises
    ------
    WrongValue
        Its axis or its normal is neither in the plane nor perpendicular to it.
    """
    rows = _projected(joint.name, joint.frame, joint.pitch)
    turning = int(np.any(rows[:, 0] != 0))
    return _PLANAR[turning, len(rows) - turning]


class PlanarChain(_Loops):
    """Chain in the plane xy: spatial joints, restricted to their motions in the plane.

    Parameters and errors are those of :class:`Chain`; axes and normals lie in the plane or
    are perpendicular to it.
    """

    equations = 3

    @cached_property
    def columns(self) -> list[np.ndarray]:
        at = self.measure
        results = []
        for joint in self.joints:
            rows = _projected(joint.name, joint.frame, joint.pitch).copy()
            x, y, _ = joint.arm(at.origin, at.length)
            # The velocity at the origin of a rotation about z at (x, y).
            rows[:, 1] += y * rows[:, 0]
            rows[:, 2] -= x * rows[:, 0]
            results.append(rows)
        return results
