"""Joint graph of a plane mechanism: the bodies that each joint connects.

Answers depend on the mechanism alone: not on the order of the list, nor of the bodies in a record, nor on how
a multiple pivot is written (one record of k bodies, or records of the same ``at`` label that share bodies).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from numbers import Integral
from typing import Any, NamedTuple

from coursework.errors import WrongValue, nearest
from coursework.messages import Message

FRAME = 1  #: the number of the frame
KINDS = ("revolute", "prismatic", "higher")
_KEYS = ("between", "kind", "at")

Record = Mapping[str, Any]
Pair = tuple[int, int]


class PlaneJoint(NamedTuple):
    """Bodies joined at one point, in increasing order; only a pivot joins more than two."""

    bodies: tuple[int, ...]
    kind: str
    at: str = ""

    @property
    def pairs(self) -> int:
        """Number of kinematic pairs: a pivot of k bodies counts as k - 1 pairs."""
        return len(self.bodies) - 1


class Counts(NamedTuple):
    """Numbers of bodies and pairs and the mobility count, under the course's letters."""

    n: int  #: moving bodies
    b: int  #: lower pairs
    h: int  #: higher pairs
    w: int  #: 3 n - 2 b - h, the formula's count of degrees of freedom, not the real mobility
    L: int  #: pairs, b + h
    N: int  #: bodies, the frame among them
    gamma: int  #: independent cycles, L - N + 1


@dataclass(frozen=True)
class JointGraph:
    """Joint graph in one canonical order: equal mechanisms are equal values."""

    joints: tuple[PlaneJoint, ...]

    @staticmethod
    def of(records: JointGraph | Iterable[Record | PlaneJoint]) -> JointGraph:
        """Read a list of joint records.

        Parameters
        ----------
        records
            Mappings with ``between``, ``kind`` and, optionally, ``at``, or joints; a graph is returned
            unchanged.

        Returns
        -------
        The graph, its joints in canonical order.

        Raises
        ------
        WrongValue
            A record that is none, a joint that cannot be, bodies that are not numbered from 1 without a gap
            or not linked to the frame; the message names the record or the bodies.
        """
        if isinstance(records, JointGraph):
            return records
        if isinstance(records, (str, Mapping)) or not isinstance(records, Iterable):
            raise WrongValue("joints must be a list of records; found {records!r}", records=str(records)[:60])
        joints = _merged([_joint(record, number) for number, record in enumerate(records, start=1)])
        _check_bodies(joints)
        return JointGraph(tuple(sorted(joints)))

    def records(self) -> tuple[dict[str, Any], ...]:
        """Return the joints as records, a multiple pivot in one of them."""
        return tuple(
            {"between": list(j.bodies), "kind": j.kind, **({"at": j.at} if j.at else {})} for j in self.joints
        )

    @property
    def text(self) -> str:
        """Text of the joints, as an answer of kind ``graph`` has them: ``1-2 revolute, 3-4-5 revolute``."""
        return ", ".join(f"{'-'.join(map(str, joint.bodies))} {joint.kind}" for joint in self.joints)

    @cached_property
    def bodies(self) -> tuple[int, ...]:
        """Bodies from 1, the frame, to N."""
        return tuple(sorted({body for joint in self.joints for body in joint.bodies}))

    @property
    def moving(self) -> tuple[int, ...]:
        return tuple(body for body in self.bodies if body != FRAME)

    @cached_property
    def counts(self) -> Counts:
        """Numbers of bodies and pairs, with the mobility formula of the course."""
        higher = sum(joint.pairs for joint in self.joints if joint.kind == "higher")
        pairs = sum(joint.pairs for joint in self.joints)
        lower, total = pairs - higher, len(self.bodies)
        freedoms = 3 * (total - 1) - 2 * lower - higher
        return Counts(total - 1, lower, higher, freedoms, pairs, total, pairs - total + 1)

    def joints_of(self, body: int) -> tuple[PlaneJoint, ...]:
        """Return the joints that a body takes part in.

        Parameters
        ----------
        body
            Number of the body.

        Returns
        -------
        The joints in the graph's order; none for a number that is not a body.
        """
        return tuple(joint for joint in self.joints if body in joint.bodies)

    def pairs(self) -> tuple[Pair, ...]:
        """Return the kinematic pairs, a multiple pivot as pairs with its lowest body."""
        return tuple(sorted((joint.bodies[0], other) for joint in self.joints for other in joint.bodies[1:]))


def copied(records: Iterable[Record]) -> tuple[dict[str, Any], ...]:
    """Return copies of joint records, which the caller may change.

    Parameters
    ----------
    records
        Mappings with ``between`` at least.

    Returns
    -------
    New mappings with new lists ``between``.
    """
    return tuple({**record, "between": list(record["between"])} for record in records)


def _joint(record: Any, number: int) -> PlaneJoint:
    where = Message("joint {number} of the list", number=number)
    if isinstance(record, PlaneJoint):
        record = {"between": record.bodies, "kind": record.kind, "at": record.at}
    if not isinstance(record, Mapping):
        raise WrongValue(
            "{where} must be a record with 'between' and 'kind'; found {record!r}",
            where=where,
            record=str(record)[:60],
        )
    for key in record:
        if key not in _KEYS:
            raise WrongValue(
                "{where} has a key {key!r}{nearest}", where=where, key=key, nearest=nearest(str(key), _KEYS)
            )
    for key in _KEYS[:2]:
        if key not in record:
            raise WrongValue("{where} lacks {key!r}", where=where, key=key)
    kind = record["kind"]
    if kind not in KINDS:
        raise WrongValue(
            "{where}: no kind {kind!r}{nearest}", where=where, kind=kind, nearest=nearest(str(kind), KINDS)
        )
    bodies = _bodies(record["between"], where)
    if len(bodies) > 2 and kind != "revolute":
        raise WrongValue(
            "{where}: only a pivot joins more than two bodies; found {kind} between {bodies}",
            where=where,
            kind=kind,
            bodies=bodies,
        )
    at = record.get("at")
    return PlaneJoint(bodies, str(kind), "" if at is None else str(at))


def _bodies(between: Any, where: str) -> tuple[int, ...]:
    if not isinstance(between, Sequence) or isinstance(between, str):
        raise WrongValue(
            "{where}: 'between' must list bodies; found {between!r}", where=where, between=between
        )
    for body in between:
        if isinstance(body, bool) or not isinstance(body, Integral) or body < 1:
            raise WrongValue(
                "{where}: a body is a whole number from 1, the frame, on; found {body!r}",
                where=where,
                body=body,
            )
    bodies = tuple(sorted({int(body) for body in between}))
    if len(bodies) < 2 or len(bodies) < len(between):
        raise WrongValue(
            "{where} must join different bodies, two at least; found {between}",
            where=where,
            between=list(between),
        )
    return bodies


def _merged(joints: Sequence[PlaneJoint]) -> list[PlaneJoint]:
    """Return the joints with pivots of one label merged."""
    results = [joint for joint in joints if joint.kind != "revolute" or not joint.at]
    labelled: dict[str, list[PlaneJoint]] = {}
    for joint in joints:
        if joint.kind == "revolute" and joint.at:
            labelled.setdefault(joint.at, []).append(joint)
    return results + [_one_pivot(label, several) for label, several in labelled.items()]


def _one_pivot(label: str, joints: list[PlaneJoint]) -> PlaneJoint:
    together, rest = set(joints[0].bodies), joints[1:]
    while rest:
        touching = [joint for joint in rest if together & set(joint.bodies)]
        if not touching:
            apart = " and ".join(str(list(b)) for b in (sorted(together), rest[0].bodies))
            raise WrongValue(
                "the pivots at {label!r} share no body: {apart}; give them different labels",
                label=label,
                apart=apart,
            )
        together = together.union(*[joint.bodies for joint in touching])
        rest = [joint for joint in rest if joint not in touching]
    return PlaneJoint(tuple(sorted(together)), "revolute", label)


def _check_bodies(joints: Sequence[PlaneJoint]) -> None:
    if not joints:
        raise WrongValue("a mechanism needs joints; the list is empty")
    linked: set[int] = {FRAME}
    rest = list(joints)
    while touching := [joint for joint in rest if linked & set(joint.bodies)]:
        linked = linked.union(*[joint.bodies for joint in touching])
        rest = [joint for joint in rest if joint not in touching]
    bodies = {body for joint in joints for body in joint.bodies}
    missing = next((n for n, body in enumerate(sorted(bodies), start=FRAME) if n != body), None)
    if missing is not None:
        subject = Message("the frame, 1,") if missing == FRAME else Message("body {body}", body=missing)
        raise WrongValue("{subject} has no joint; bodies are numbered from 1 without a gap", subject=subject)
    if bodies - linked:
        raise WrongValue("bodies {bodies} are not linked to the frame, 1", bodies=sorted(bodies - linked))
