"""Mechanisms generated from whole numbers: one or two drivers, then groups attached one after another.

Every mechanism grown here can move as its count says: no two of the joints by which a group hangs on what is
placed lie on one body, so nothing is held twice. The same number gives the same mechanism for ever.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from typing import NamedTuple, TypeVar

from coursework.structure.joints import FRAME, JointGraph, PlaneJoint, Record

Item = TypeVar("Item")

DYAD, TRIAD, TETRAD, FOLLOWER, STIFFENER = "dyad", "triad", "tetrad", "follower", "stiffener"
#: How many joints each group hangs on.
_HANGS_ON = {DYAD: 2, TRIAD: 3, TETRAD: 2, FOLLOWER: 2, STIFFENER: 2}


class NumberStream:
    """Reproducible stream of small whole numbers, seeded by a number."""

    def __init__(self, number: int, purpose: str):
        self._bits = self._stream(f"coursework/structure/{purpose}/{number}")

    @staticmethod
    def _stream(key: str) -> Iterator[int]:
        block = 0
        while True:
            digest = hashlib.shake_128(f"{key}/{block}".encode()).digest(256)
            for start in range(0, 256, 4):
                yield int.from_bytes(digest[start : start + 4], "little")
            block += 1

    def below(self, count: int) -> int:
        """Return the next number, below a bound.

        Parameters
        ----------
        count
            The bound, a whole number from 1 to 2^32.

        Returns
        -------
        A number from 0 to ``count - 1``.
        """
        return (next(self._bits) * count) >> 32

    def one_of(self, items: Sequence[Item]) -> Item:
        """Return one of some items, by the next number.

        Parameters
        ----------
        items
            The choices, at least one.

        Returns
        -------
        The item.
        """
        return items[self.below(len(items))]

    def shuffled(self, items: Sequence[Item]) -> list[Item]:
        """Return the items in another order, by as many numbers.

        Parameters
        ----------
        items
            Items of any sort.

        Returns
        -------
        A new list of all of them.
        """
        rest = list(items)
        return [rest.pop(self.below(len(rest))) for _ in items]


class GeneratedMechanism(NamedTuple):
    """Generated mechanism as a list of records, in the order of the statement, and its drivers."""

    joints: tuple[Record, ...]
    drivers: tuple[int, ...]

    @property
    def graph(self) -> JointGraph:
        return JointGraph.of(self.joints)


def grow(number: int, groups: Sequence[str], *, drivers: int = 1) -> GeneratedMechanism:
    """Return the mechanism of a number: groups attached one after another, bodies and joints then shuffled.

    Parameters
    ----------
    number
        Whole number that decides every choice.
    groups
        ``dyad`` (class II), ``triad`` (III), ``tetrad`` (IV: a loop of four bodies), ``follower`` (one body,
        a lower and a higher pair) or ``stiffener`` (a bar, which takes a degree of freedom away), in order.
    drivers
        Number of bodies joined to the frame before the groups.

    Returns
    -------
    The records of its joints and the numbers of its drivers.
    """
    plant = _Plant(NumberStream(number, "grow"), drivers)
    for group in groups:
        plant.attach(group)
    return relabelled(number, plant.joints, tuple(range(2, 2 + drivers)))


def relabelled(number: int, joints: Sequence[PlaneJoint], drivers: Sequence[int] = ()) -> GeneratedMechanism:
    """Return a mechanism with moving bodies renumbered, joints shuffled and lettered A, B, C, … along the
    list.

    Parameters
    ----------
    number
        Whole number that decides the order.
    joints
        Joints of the mechanism; their letters are not kept.
    drivers
        Numbers of the driven bodies in ``joints``.

    Returns
    -------
    The records of its joints and the new numbers of its drivers.
    """
    choices = NumberStream(number, "relabel")
    moving = sorted({body for joint in joints for body in joint.bodies} - {FRAME})
    new = {FRAME: FRAME, **dict(zip(moving, choices.shuffled(moving), strict=True))}
    records = tuple(
        {"between": sorted(new[body] for body in joint.bodies), "kind": joint.kind, "at": _letter(index)}
        for index, joint in enumerate(choices.shuffled(list(joints)))
    )
    return GeneratedMechanism(records, tuple(new[body] for body in drivers))


def _letter(position: int) -> str:
    """Return the label of a joint: A to Z, then A1, B1, …"""
    round_, letter = divmod(position, 26)
    return chr(ord("A") + letter) + (str(round_) if round_ else "")


class _Plant:
    """Mechanism under construction."""

    def __init__(self, choices: NumberStream, drivers: int):
        self.choices = choices
        self.joints: list[PlaneJoint] = []
        self.bodies = [FRAME]
        for _ in range(drivers):
            body = self._new_body()
            self._join(FRAME, body, self._kind(6))
        self._idle = self.bodies[1:]  #: drivers that move nothing yet

    def _new_body(self) -> int:
        self.bodies.append(len(self.bodies) + 1)
        return self.bodies[-1]

    def _kind(self, one_in: int) -> str:
        return "prismatic" if self.choices.below(one_in) == 0 else "revolute"

    def _join(self, first: int, other: int, kind: str) -> None:
        self.joints.append(PlaneJoint(tuple(sorted((first, other))), kind))

    def attach(self, group: str) -> None:
        hosts = self._hosts(_HANGS_ON[group])
        getattr(self, f"_{group}")(hosts)

    def _hosts(self, count: int) -> list[frozenset[int]]:
        """Return the bodies to which a group attaches: single bodies, or now and then an existing pivot with
        all its bodies.

        No body occurs twice, save for the third joint of a group, which may share a body: its loop still
        moves.
        """
        results = [self._first_host()]
        results.append(self._second_host(results[0]))
        occupied = results[0] | results[1]
        if count == 3:
            alone = [host for host in results if len(host) == 1]
            full = len(occupied) == len(self.bodies)
            again = alone and (full or self.choices.below(2) == 0)
            results.append(self.choices.one_of(alone) if again else self._free_host(occupied))
        return results

    def _first_host(self) -> frozenset[int]:
        return frozenset([self._idle.pop()]) if self._idle else self._free_host(frozenset())

    def _second_host(self, first: frozenset[int]) -> frozenset[int]:
        if self._idle:
            return frozenset([self._idle.pop()])
        if len(self.bodies) == 2:
            return frozenset(self.bodies) - first
        return self._free_host(first)

    def _free_host(self, occupied: frozenset[int]) -> frozenset[int]:
        """Return a body, or the bodies of a pivot, that are not taken; at least one other body stays free."""
        pivots = [
            frozenset(joint.bodies)
            for joint in self.joints
            if joint.kind == "revolute"
            and not occupied & set(joint.bodies)
            and len(occupied) + len(joint.bodies) < len(self.bodies)
        ]
        if pivots and self.choices.below(4) == 0:
            return self.choices.one_of(pivots)
        return frozenset([self.choices.one_of([body for body in self.bodies if body not in occupied])])

    def _hang(self, body: int, host: frozenset[int], kind: str) -> None:
        """Join a new body to its host; a host that is a pivot becomes a multiple pivot."""
        if len(host) == 1:
            self._join(body, min(host), kind)
            return
        bodies = tuple(sorted(host))
        position = self.joints.index(PlaneJoint(bodies, "revolute"))
        self.joints[position] = PlaneJoint((*bodies, body), "revolute")

    def _dyad(self, hosts: list[frozenset[int]]) -> None:
        first, other = self._new_body(), self._new_body()
        # At most one of the three joints is a slide.
        slide = self.choices.below(5)
        self._hang(first, hosts[0], "prismatic" if slide == 0 else "revolute")
        self._join(first, other, "prismatic" if slide == 1 else "revolute")
        self._hang(other, hosts[1], "revolute")

    def _triad(self, hosts: list[frozenset[int]]) -> None:
        centre = self._new_body()
        slide = self.choices.below(8)
        for index, host in enumerate(hosts):
            arm = self._new_body()
            self._join(centre, arm, "revolute")
            self._hang(arm, host, "prismatic" if slide == index else "revolute")

    def _tetrad(self, hosts: list[frozenset[int]]) -> None:
        loop = [self._new_body() for _ in range(4)]
        for first, other in zip(loop, [*loop[1:], loop[0]], strict=True):
            self._join(first, other, "revolute")
        self._hang(loop[0], hosts[0], "revolute")
        self._hang(loop[2], hosts[1], "revolute")

    def _follower(self, hosts: list[frozenset[int]]) -> None:
        body = self._new_body()
        self._hang(body, hosts[1], self._kind(3) if len(hosts[1]) == 1 else "revolute")
        self._join(body, min(hosts[0]), "higher")

    def _stiffener(self, hosts: list[frozenset[int]]) -> None:
        body = self._new_body()
        for host in hosts:
            self._hang(body, host, "revolute")
