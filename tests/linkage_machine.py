"""Mechanisms of files without any formula of the package: three coordinates a body, joints closed by Newton's
method from a pose that is off, and the multiplier of what drives. Of the package it takes what the file's
entries say, and a pose to begin near."""

import numpy as np

from coursework.degrees import acos, asin, atan2, cos, sin, sqrt, tan
from coursework.linkages.entries import GROUND

KNOWN = {"np": np, "abs": abs, **{f.__name__: f for f in (acos, asin, atan2, cos, sin, sqrt, tan)}}


class Machine:
    """Bodies and joints of a file, with numbers: three coordinates a body, in mm and radians."""

    def __init__(self, linkage, values):
        self.linkage, self.values = linkage, values
        self.names = [*linkage.bodies, *filter(None, [linkage.drive.rod])]
        self.local = {
            (b, p): self.number(place.x) + 1j * self.number(place.y)
            if place.radius is None
            else self.number(place.radius) * np.exp(1j * np.radians(self.number(place.angle)))
            for b, points in [(GROUND, linkage.ground), *((n, e.points) for n, e in linkage.bodies.items())]
            for p, place in points.items()
        }
        if linkage.jack:  # its cylinder and its rod have one pin each
            start, end = linkage.bodies[linkage.jack].points
            del self.local[linkage.jack, end]
            self.local |= {(linkage.jack, start): 0j, (linkage.drive.rod, end): 0j}

    def number(self, expression):
        return float(eval(expression.code, KNOWN, dict(self.values)))

    def frame(self, q, body):
        k = 3 * self.names.index(body) if body != GROUND else None
        return (0j, 0.0) if k is None else (q[k] + 1j * q[k + 1], q[k + 2])

    def place(self, q, body, point):
        origin, turn = self.frame(q, body)
        return origin + self.local[body, point] * np.exp(1j * turn)

    def gaps(self, q, start):
        """What is 0 where the joints hold, and last what the drive sets; ``start`` of angles that a slide
        keeps apart."""
        linkage, found = self.linkage, []
        holders = {}
        for body, point in self.local:
            holders.setdefault(point, []).append(body)
        for point, bodies in holders.items():
            for other in bodies[1:]:
                gap = self.place(q, other, point) - self.place(q, bodies[0], point)
                found += [gap.real, gap.imag]
        driven = []
        slides = [
            (s.at, s.of, s.on, self.track(s), self.number(s.along), s.distance)
            for s in linkage.slides.values()
        ]
        if linkage.jack:
            end = [*linkage.bodies[linkage.jack].points][1]
            slides.append((end, linkage.drive.rod, linkage.jack, 0j, 0.0, linkage.moved))
        for at, of, on, through, along, distance in slides:
            origin, turn = self.frame(q, on)
            way = np.exp(1j * (turn + np.radians(along)))
            apart = (self.place(q, of, at) - origin - through * np.exp(1j * turn)) / way
            kept = self.frame(start, of)[1] - self.frame(start, on)[1]
            found += [apart.imag, 100 * (self.frame(q, of)[1] - turn - kept)]
            if distance == linkage.moved:
                driven.append(apart.real - self.values[linkage.moved])
        for gear in linkage.gears:
            one, other, carrier = (
                self.frame(q, b)[1] - self.frame(start, b)[1] for b in (gear.first, gear.second, gear.carrier)
            )
            sense = -1 if gear.inner else 1
            found.append(
                self.number(gear.radii[0]) * (one - carrier)
                + sense * self.number(gear.radii[1]) * (other - carrier)
            )
        if linkage.drive.kind == "turn":
            driven.append(self.frame(q, linkage.driver)[1] - np.radians(self.values[linkage.moved]))
        return np.array([*found, *driven])

    def track(self, slide):
        place = slide.through
        if place.radius is not None:
            return self.number(place.radius) * np.exp(1j * np.radians(self.number(place.angle)))
        return self.number(place.x) + 1j * self.number(place.y)

    def slopes(self, function, q):
        """The derivatives of a function, by steps into the complex numbers' place: central differences of a
        small step."""
        steps = 1e-4 * np.where(np.arange(len(q)) % 3 == 2, 0.01, 1.0)
        return np.stack(
            [
                (
                    8 * (function(q + h * e) - function(q - h * e))
                    - function(q + 2 * h * e)
                    + function(q - 2 * h * e)
                )
                / (12 * h)
                for h, e in zip(steps, np.eye(len(q)), strict=True)
            ],
            -1,
        )

    def settled(self, start, off=1.0):
        """The pose near one, by Newton's method from a place that is off it."""
        q = start.copy()
        for number in range(len(q)):
            q[number] += off * (0.02 if number % 3 == 2 else 0.7) * (-1) ** number
        kept = start.copy()
        for _ in range(30):
            step = np.linalg.solve(self.slopes(lambda z: self.gaps(z, kept), q), self.gaps(q, kept))
            q = q - step
            if np.max(abs(step)) < 1e-10:
                break
        return q

    def effort(self, start, powers, off=1.0):
        """The pose near one, and the multiplier of what drives: N mm of an angle, N of a length. ``powers``:
        the loads' work."""
        q, kept = self.settled(start, off), start
        slopes = self.slopes(lambda z: self.gaps(z, kept), q)
        return q, -np.linalg.solve(slopes.T, self.slopes(lambda z: np.array([powers(z)]), q)[0])[-1]


def pose(machine, made, exercise, given):
    """The bodies' coordinates by the package, from which the test's own are sought."""
    linkage, turns = machine.linkage, made.formulas.turns
    names = [n for n in exercise.solution.graph.names if n[0] in "xy" or n.startswith("theta")]
    found = {**exercise.solve(only=[n for n in names if n not in given], **given), **given}
    q = []
    for body in machine.names:
        turn = turns[linkage.jack if body == linkage.drive.rod else body]
        angle = found[turn] if turn in found else float(eval(turn, KNOWN, dict(found)))
        point, away = next((p, z) for (b, p), z in machine.local.items() if b == body)
        there = machine.local.get((GROUND, point))
        there = complex(found[f"x{point}"], found[f"y{point}"]) if there is None else there
        origin = there - away * np.exp(1j * np.radians(angle))
        q += [origin.real, origin.imag, float(np.radians(angle))]
    return np.array(q)


def efforts(exercise, made, given, forces, moments, key, off=1.0):
    """The test's own pose and the package's; the effort of the drive by either."""
    machine = Machine(made.linkage, given)
    start = pose(machine, made, exercise, given)

    def work(q):
        total = sum(1000 * m * machine.frame(q, b)[1] for b, m in moments)
        for point, size, angle in forces:
            body = next(b for b, p in machine.local if p == point)
            total += size * (machine.place(q, body, point) * np.exp(-1j * np.radians(angle))).real
        return total

    q, found = machine.effort(start, work, off)
    return q, start, found / (1000 if key == "torque" else 1), exercise.solve(only=key, **given)[key]
