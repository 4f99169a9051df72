"""Groups of a mechanism in order of assembly, each with its joints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from coursework.errors import CourseworkError
from coursework.linkages.entries import GROUND, GearEntry, LinkageFile, SlideEntry
from coursework.structure.assour import Decomposition, decompose

Joint = str | SlideEntry  #: a point that is a pin, or a slide


@dataclass(frozen=True)
class Dyad:
    """Group of two bodies.

    ``kind``: RRR, RRP, RPR, PRP or RPP, its joints from the outer one of ``p`` over the inner one to the
    outer one of ``q``. In RRP and RPP the slide on what is placed is that of ``q``; in RPR ``p`` is the
    block.
    """

    kind: str
    p: str
    q: str
    outer_p: Joint
    inner: Joint
    outer_q: Joint

    @property
    def bodies(self) -> tuple[str, ...]:
        return self.p, self.q


@dataclass(frozen=True)
class Wheel:
    """Wheel that a gear turns, pinned at a point."""

    body: str
    gear: GearEntry
    at: str

    @property
    def bodies(self) -> tuple[str, ...]:
        return (self.body,)


@dataclass(frozen=True)
class HigherGroup:
    """Group of four bodies or more, of class III or higher."""

    bodies: tuple[str, ...]
    rank: int


Group = Dyad | Wheel | HigherGroup


def group_joints(group: Group, linkage: LinkageFile) -> tuple[str, ...]:
    """Return the points at which the bodies of a group meet: its inner joints, and of a wheel its pin."""
    if isinstance(group, Wheel):
        return (group.at,)
    if isinstance(group, Dyad):
        return (group.inner if isinstance(group.inner, str) else group.inner.at,)
    bodies = {*group.bodies}
    pins = (point for point, held in linkage.pins.items() if len(bodies.intersection(held)) > 1)
    return (*pins, *(s.at for s in linkage.slides.values() if {s.of, s.on} <= bodies))


def groups_of(linkage: LinkageFile) -> tuple[tuple[Group, ...], int]:
    """Return the groups in order of assembly, and the class of the mechanism.

    Parameters
    ----------
    linkage
        The mechanism, of one degree of freedom.

    Returns
    -------
    The groups; the class, 1 for a driver and wheels alone.

    Raises
    ------
    BadInput
        Bodies that are held twice, or a group that cannot move; with the line.
    """
    wheels = _wheels(linkage)
    decomposition = _decomposition(linkage, wheels)
    numbers = _numbers(linkage, wheels)
    names = {number: name for name, number in numbers.items() if name not in wheels}
    placed = [GROUND] if linkage.jack else [GROUND, linkage.driver]
    groups: list[Group] = []
    waiting = list(decomposition.groups) if decomposition else []
    while waiting or wheels:
        ready = next((w for w in wheels.values() if _is_ready(w, placed)), None)
        if ready is not None:
            groups.append(ready)
            placed.append(ready.body)
            del wheels[ready.body]
        elif waiting:
            group = waiting.pop(0)
            bodies = tuple(sorted((names[n] for n in group.bodies), key=list(linkage.bodies).index))
            if group.rank == 2 and len(bodies) == 2:
                groups.append(_dyad(linkage, bodies, placed))
            else:
                groups.append(HigherGroup(bodies, group.rank))
            placed += bodies
        else:
            left = next(iter(wheels.values()))
            raise linkage.refused(
                ("gears",), "the wheel {body} rolls on a body that is placed only after it", body=left.body
            )
    return tuple(groups), decomposition.rank if decomposition else 1


def _is_ready(wheel: Wheel, placed: Sequence[str]) -> bool:
    needed = {wheel.gear.first, wheel.gear.second, wheel.gear.carrier} - {wheel.body}
    return needed <= set(placed)


def _wheels(linkage: LinkageFile) -> dict[str, Wheel]:
    """Return the bodies that gears turn: of each gear the one that neither drives nor is turned by an earlier
    gear."""
    results: dict[str, Wheel] = {}
    for gear in linkage.gears:
        able = [
            b
            for b in (gear.second, gear.first)
            if b not in (GROUND, linkage.driver) and b not in results and gear.carrier != b
        ]
        for body in able:
            at = next(
                (p for p, bodies in linkage.pins.items() if body in bodies and gear.carrier in bodies), ""
            )
            if at:
                results[body] = Wheel(body, gear, at)
                break
        else:
            raise linkage.refused(
                ("gears",),
                "the gear of {first} and {second} turns no body that is pinned to the carrier {carrier}",
                first=gear.first,
                second=gear.second,
                carrier=gear.carrier,
            )
    return results


def _numbers(linkage: LinkageFile, wheels: dict[str, Wheel]) -> dict[str, int]:
    """Return the bodies' numbers in a joint graph, the frame 1; a wheel counts as its carrier, with which it
    is placed."""
    numbers = {GROUND: 1}
    for name in [linkage.driver, *linkage.bodies]:
        if name not in wheels and name not in numbers:
            numbers[name] = len(numbers) + 1
    waiting = dict(wheels)
    while waiting:
        ready = [w for w in waiting.values() if w.gear.carrier in numbers]
        if not ready:
            break
        for wheel in ready:
            numbers[wheel.body] = numbers[wheel.gear.carrier]
            del waiting[wheel.body]
    return numbers


def _decomposition(linkage: LinkageFile, wheels: dict[str, Wheel]) -> Decomposition | None:
    numbers = _numbers(linkage, wheels)
    records = []
    for point, bodies in linkage.pins.items():
        between = sorted({numbers[b] for b in bodies})
        if len(between) > 1:
            records.append({"between": between, "kind": "revolute", "at": point})
    for point, slide in linkage.slides.items():
        records.append(
            {
                "between": sorted((numbers[slide.of], numbers[slide.on])),
                "kind": "prismatic",
                "at": f"slide {point}",
            }
        )
    if max(numbers.values()) == 2:
        return None
    driver = numbers[linkage.driver]
    if linkage.jack:  # a bar of its length, while a crank that moves nothing drives
        driver = max(numbers.values()) + 1
        records.append({"between": [1, driver], "kind": "revolute", "at": "drive"})
    try:
        return decompose(records, (1, driver))
    except CourseworkError as fault:
        raise linkage.refused(("bodies",), str(fault)) from fault


def _dyad(linkage: LinkageFile, bodies: tuple[str, ...], placed: Sequence[str]) -> Dyad:
    """Return a group of two bodies with its joints in the usual order."""
    outer: dict[str, list[Joint]] = {body: [] for body in bodies}
    inner: list[Joint] = []
    for point, holders in linkage.pins.items():
        own = [b for b in bodies if b in holders]
        if any(h in placed for h in holders):
            for body in own:
                outer[body].append(point)
        elif len(own) == 2:
            inner.append(point)
    for slide in linkage.slides.values():
        own = [b for b in bodies if b in (slide.of, slide.on)]
        if len(own) == 2:
            inner.append(slide)
        elif own and {slide.of, slide.on} & set(placed):
            outer[own[0]].append(slide)
    p, q = bodies
    ends, middle = (outer[p][0], outer[q][0]), inner[0]
    if isinstance(middle, SlideEntry):
        if all(isinstance(e, SlideEntry) for e in ends):
            raise linkage.refused(
                ("slides",),
                "bodies {p} and {q} are connected by three slides: they cannot turn, and one slide "
                "is redundant",
                p=p,
                q=q,
            )
        if isinstance(ends[0], SlideEntry) or (all(isinstance(e, str) for e in ends) and middle.of == q):
            p, q, ends = q, p, ends[::-1]
        return Dyad("RPP" if isinstance(ends[1], SlideEntry) else "RPR", p, q, ends[0], middle, ends[1])
    if isinstance(ends[0], SlideEntry) and isinstance(ends[1], str):
        p, q, ends = q, p, ends[::-1]
    kind = (
        f"{'P' if isinstance(ends[0], SlideEntry) else 'R'}R{'P' if isinstance(ends[1], SlideEntry) else 'R'}"
    )
    return Dyad(kind, p, q, ends[0], middle, ends[1])
