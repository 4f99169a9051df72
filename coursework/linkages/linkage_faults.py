"""Faults of a mechanism that its file states in order: what does not hold together, or moves otherwise than
by one driver."""

from __future__ import annotations

from collections.abc import Iterator

from coursework.errors import BadInput, nearest
from coursework.linkages.entries import LinkageFile
from coursework.messages import Message


def linkage_faults(linkage: LinkageFile) -> Iterator[BadInput]:
    """Yield what bodies and joints do not make: what holds each body, and how many ways all of them move.

    Parameters
    ----------
    linkage
        The mechanism.

    Yields
    ------
    Errors with the line.
    """
    geared = {body for g in linkage.gears for body in (g.first, g.second)}
    hold = {
        name: [
            *(p for p in body.points if p in linkage.pins),
            *(s.at for s in linkage.slides.values() if name in (s.of, s.on)),
        ]
        for name, body in linkage.bodies.items()
    }
    for name in (n for n, joints in hold.items() if not joints):
        points = ", ".join(linkage.bodies[name].points)
        yield linkage.refused(
            ("bodies", name),
            "body {name} is in the air: it shares none of its points {points} with another body, and "
            "does not slide",
            name=name,
            points=points,
        )
    for name, joints in hold.items():
        drives = name == linkage.driver and not linkage.jack
        if len(joints) < 2 and not drives and name not in geared:
            yield linkage.refused(
                ("bodies", name),
                "body {name} hangs on {value} alone; a second point that it shares, or a slide, holds it",
                name=name,
                value=joints[0],
            )
    crank = linkage.bodies[linkage.driver]
    if linkage.drive.kind == "turn" and crank.at not in linkage.ground:
        yield linkage.refused(
            ("bodies", crank.name),
            "the driven body {name} turns about a point of the ground; {at} is none",
            name=crank.name,
            at=crank.at,
        )
    if linkage.mobility != 1:
        bodies, pairs, gears = linkage.counts
        if gears:
            count = Message(
                "3 × {bodies} bodies, less 2 × {pairs} pins and slides, less {gears} gears",
                bodies=bodies,
                pairs=pairs,
                gears=gears,
            )
        else:
            count = Message(
                "3 × {bodies} bodies, less 2 × {pairs} pins and slides", bodies=bodies, pairs=pairs
            )
        does = (
            Message("nothing moves; take a bar away, or a pin or slide")
            if linkage.mobility < 1
            else Message("one driver does not settle it; a bar between two points, or a slide, holds it")
        )
        yield linkage.refused(
            ("bodies",),
            "the mechanism has {mobility} degrees of freedom ({count}), a driver moves 1: {does}",
            mobility=linkage.mobility,
            count=count,
            does=does,
        )
    named = {name: (name, entry.start, entry.end) for name, entry in linkage.assembly.items()}
    for name, points_ in {**named, "near": linkage.near.places if linkage.near else ()}.items():
        for point in points_:
            if point and point not in linkage.points:
                yield linkage.refused(
                    ("assembly", name),
                    "no point {point!r}{found}",
                    point=point,
                    found=nearest(point, linkage.points),
                )
