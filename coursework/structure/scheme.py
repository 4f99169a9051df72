"""Kinematic scheme of a mechanism as a figure: bars, plates, blocks and guides, wheels and cams, on a hatched
frame.

Bodies bear their numbers; the frame is what is hatched, and bears none.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Sequence

from coursework.figures import (
    Element,
    Figure,
    ball,
    contact,
    ground_pivot,
    link,
    pin,
    rail,
    rotation_arrow,
    slider,
    slot_link,
    vector,
    wheel,
)
from coursework.figures.base import BLOCK
from coursework.figures.ink import added
from coursework.structure.joints import FRAME, JointGraph, PlaneJoint, Record
from coursework.structure.layout import BEYOND, places, slides
from coursework.structure.likeness import drawn_in_course

_ROTOR = 8.0  #: radius of a body that turns and touches nothing
_NOSE = 2.6  #: radius of the rounded end with which a bar touches another body
_RAIL = 9.0  #: half the length of a fixed guide
_FLAT = 7.0  #: half the length of a fixed profile
_LARGEST = 20.0  #: distance from a wheel's pivot to its contact
_OFF_AXIS = math.radians(35)  #: a wheel's pivot is no farther from the normal of its contact


def kinematic_scheme(
    joints: JointGraph | Iterable[Record], *, letters: bool = True, driver: Sequence[int] = ()
) -> Figure:
    """Draw the kinematic scheme at a scale of its own; lengths do not matter.

    A mechanism of the course's figures is drawn as the course draws it, any other one as it reads best.

    Parameters
    ----------
    joints
        Records or a graph.
    letters
        Whether joints bear the letters of their ``at``.
    driver
        The frame and the body that an arrow shows to be driven, if any.

    Returns
    -------
    The figure.

    Raises
    ------
    WrongValue
        Records that are not a mechanism (:meth:`JointGraph.of`).
    """
    graph = JointGraph.of(joints)
    return _Scheme(graph, letters, max(driver, default=0)).figure()


class _Scheme:
    def __init__(self, graph: JointGraph, letters: bool, driven: int):
        self.graph = graph
        self.letters = letters
        self.driven = driven
        drawing = drawn_in_course(graph)
        self.at, self.rails = drawing if drawing else (places(graph), {})
        self.slides = slides(graph, self.at if drawing else ())
        self.normals = {k: self._normal(j) for k, j in enumerate(graph.joints) if j.kind == "higher"}

    def figure(self) -> Figure:
        elements = [element for body in self.graph.moving for element in self._body(body)]
        # A wheel lies beneath the plate that carries its pivot.
        elements.sort(key=lambda element: not isinstance(element, wheel))
        for index, joint in enumerate(self.graph.joints):
            if joint.kind == "prismatic":
                elements += self._slide(index)
            elif joint.kind == "higher":
                elements += self._contact(index)
        elements += self._pins()
        if self.driven:
            elements += self._arrow()
        # At its own size where there is room for it, smaller where there is not.
        return Figure(*elements, paper_mm=Figure(*elements, scale=1.0).size_mm)

    def _letter(self, joint: PlaneJoint) -> str:
        return joint.at if self.letters else ""

    def _joints_of(self, body: int) -> list[int]:
        return [k for k, joint in enumerate(self.graph.joints) if body in joint.bodies]

    # ---------------------------------------------------------------- bodies

    def _body(self, body: int) -> list[Element]:
        """Return the bar or plate of a body, its wheel, its guides, and its number once: at the block of a
        body without others."""
        rigid, number = self._rigid(body), str(body)
        selected = [k for k in self._joints_of(body) if k in self.slides and self.slides[k].guide == body]
        guides = [self._guide(k, self._base(k, rigid, selected)) for k in selected]
        slots = [self._way_of(k, *guide) for k, guide in zip(selected, guides, strict=True)]
        if len(guides) == 1 and (lever := _straight(rigid, *guides[0])):
            return [*slots, link(*lever[0], label=number), link(*lever[1])]
        corners = [*rigid, *(foot for foot, _ in guides)]
        if len(corners) > 1:
            return [*slots, link(*_around(corners), label=number)]
        disc = self._wheel(body)
        return [wheel(*disc, label=number)] if disc else []

    def _rigid(self, body: int) -> list[complex]:
        """Return the points that a bar or plate of the body connects: pins, blocks, contact noses."""
        results: list[complex] = []
        for k in self._joints_of(body):
            if k in self.slides and self.slides[k].guide == body:
                continue
            position = self.at[k]
            if self.graph.joints[k].kind == "higher":
                if self._wheel(body):
                    continue
                position = self._nose(k, body)
            if all(abs(position - z) > 1e-6 for z in results):
                results.append(position)
        return results

    def _base(self, index: int, rigid: Sequence[complex], guides: Sequence[int]) -> complex:
        """Return the nearest point of the body from which a guide leads to its block."""
        here = self.at[index]
        able = [z for z in rigid if abs(z - here) > 1] or [self.at[k] for k in guides if k != index]
        return min(able, key=lambda z: (z not in self.at, abs(z - here)), default=here - 2 * BEYOND)

    def _way_of(self, index: int, foot: complex, tip: complex) -> Element:
        """Return the slot of a block, or a rod through it where a slot would hide the block's support on the
        frame."""
        fixed = any(
            self._together(index, k) and FRAME in self.graph.joints[k].bodies for k in range(len(self.at))
        )
        return link(foot, tip) if fixed else slot_link(foot, tip)

    def _guide(self, index: int, base: complex) -> tuple[complex, complex]:
        """Return the foot and tip of the slot in which a block slides."""
        here = self.at[index]
        direction = (here - base) / abs(here - base)
        return here - direction * min(BEYOND, 0.5 * abs(here - base)), here + direction * BEYOND

    # ---------------------------------------------------------------- joints

    def _pins(self) -> list[Element]:
        """Return pivots, each with its letter and that of a block on it."""
        results: list[Element] = []
        for k, joint in enumerate(self.graph.joints):
            if joint.kind == "revolute":
                here = [j.at for i, j in enumerate(self.graph.joints) if self._together(i, k)]
                letters = ",".join(dict.fromkeys([joint.at, *here])) if self.letters else ""
                kind = ground_pivot if FRAME in joint.bodies else pin
                results.append(kind(self.at[k], letters.strip(",")))
        return results

    def _together(self, first: int, other: int) -> bool:
        return abs(self.at[first] - self.at[other]) < 1e-6

    def _direction(self, index: int) -> float:
        """Return the direction of a slide in degrees: along its guide; a fixed guide is level, or along the
        contact that pushes a follower."""
        slide = self.slides[index]
        here = self.at[index]
        if slide.guide != FRAME:
            selected = [
                k
                for k in self._joints_of(slide.guide)
                if k in self.slides and self.slides[k].guide == slide.guide
            ]
            return _degrees(here - self._base(index, self._rigid(slide.guide), selected))
        if index in self.rails:
            return self.rails[index]
        others = [k for k in self._joints_of(slide.block) if k != index]
        if len(others) == 1 and self.graph.joints[others[0]].kind == "higher":
            return _degrees(self.at[others[0]] - here)
        if len(others) == 1 and others[0] in self.slides:
            steep = abs((self.at[others[0]] - here).real) > abs((self.at[others[0]] - here).imag)
            return 90.0 if steep else 0.0
        return 0.0

    def _below(self, index: int) -> complex:
        """Return the side of a block on which its fixed guide lies: the side with fewer bars, below if they
        are equal."""
        along = cmath.exp(1j * math.radians(self._direction(index)))
        here, side = self.at[index], -1j * along if along.real >= 0 else 1j * along
        bodies = {
            b for k, j in enumerate(self.graph.joints) if abs(self.at[k] - here) < 1e-6 for b in j.bodies
        }
        ways = [z - here for b in bodies - {FRAME} for z in self._rigid(b) if abs(z - here) > 1]
        crowd = added((direction / abs(direction) / side).real for direction in ways)
        return -side if crowd > 0.3 else side

    def _slide(self, index: int) -> list[Element]:
        """Return the block, labelled by its number if it is a body of its own, else by its letter, and its
        rail on the frame."""
        here, block = self.at[index], self.slides[index].block
        alone = len(self._rigid(block)) == 1
        label = str(block) if alone else self._letter(self.graph.joints[index])
        results: list[Element] = [slider(here, self._direction(index), label or None)]
        if self.slides[index].guide == FRAME:
            along = 1j * self._below(index) * _RAIL
            results.append(rail(here - along, here + along))
        return results

    def _normal(self, joint: PlaneJoint) -> complex:
        """Return the unit normal from the first body of a contact towards the second."""
        first, other = (self._comes_from(body, joint) for body in joint.bodies)
        direction = first - other
        return direction / abs(direction) if abs(direction) > 1e-6 else (first or -other) * 1j

    def _comes_from(self, body: int, joint: PlaneJoint) -> complex:
        """Return a unit vector from a body's other joints to a contact; none for the frame."""
        here = self.at[self.graph.joints.index(joint)]
        others = [self.at[k] for k in self._joints_of(body) if self.graph.joints[k] != joint]
        if body == FRAME or not others:
            return 0j
        direction = here - added(others) / len(others)
        return direction / (abs(direction) or 1.0)

    def _inward(self, index: int, body: int) -> complex:
        """Return the normal from a contact into one of its bodies."""
        first = self.graph.joints[index].bodies[0] == body
        return -self.normals[index] if first else self.normals[index]

    def _nose(self, index: int, body: int) -> complex:
        return self.at[index] + _NOSE * self._inward(index, body)

    def _wheel(self, body: int) -> tuple[complex, float] | None:
        """Return the centre and radius of the disc of a body with one pivot and contacts alone; None for
        another body."""
        joints = self._joints_of(body)
        kinds = sorted(self.graph.joints[k].kind for k in joints)
        if kinds == ["revolute"]:
            return self.at[joints[0]], _ROTOR
        if kinds != ["higher", "revolute"]:
            return None
        index = next(k for k in joints if k in self.normals)
        pivot = self.at[next(k for k in joints if k != index)]
        arm, inward = pivot - self.at[index], self._inward(index, body)
        if abs(arm) > _LARGEST or abs(cmath.phase(arm / inward)) > _OFF_AXIS:
            return None
        radius = abs(arm) * (1.0 if abs(cmath.phase(arm / inward)) < 0.1 else 0.75)
        return self.at[index] + radius * inward, radius

    def _contact(self, index: int) -> list[Element]:
        joint, here = self.graph.joints[index], self.at[index]
        results: list[Element] = []
        for body in joint.bodies:
            if body != FRAME and not self._wheel(body):
                results.append(ball(self._nose(index, body), _NOSE))
            elif body == FRAME:
                inward = self._inward(index, body)
                shift = -inward * (BLOCK.imag + 0.175)
                along = 1j * inward * _FLAT
                results.append(rail(here + shift - along, here + shift + along))
        return [*results, contact(here, self._letter(joint) or None)]

    # ---------------------------------------------------------------- driver

    def _arrow(self) -> list[Element]:
        """Return the arrow of the driver, round the pivot or along the slide between the frame and the driven
        body."""
        for k in self._joints_of(self.driven):
            joint, here = self.graph.joints[k], self.at[k]
            if FRAME not in joint.bodies:
                continue
            if joint.kind == "revolute":
                middle, half = self._gap(here)
                return [rotation_arrow(here, 6.0, middle - half, middle + half)]
            along = 1j * self._below(k)
            crowd = added(((z - here) / along).real for z in self._rigid(self.driven))
            along = -along if crowd > 0 else along
            return [vector(here + 4.5 * along, 7 * along)]
        return []

    def _gap(self, here: complex) -> tuple[float, float]:
        """Return the middle of the widest angle between bars at a pivot, and half the opening of an arrow in
        it."""
        around = [z for b in self.graph.moving for z in self._rigid(b) if here in self._rigid(b)]
        occupied = sorted({_degrees(z - here) for z in around if abs(z - here) > 1} | {-120.0, -60.0})
        gaps = [(b - a, a) for a, b in zip(occupied, [*occupied[1:], occupied[0] + 360], strict=True)]
        width, start = max(gaps, key=lambda gap: round(gap[0], 6))
        return start + width / 2, min(40.0, 0.35 * width)


def _degrees(direction: complex) -> float:
    return math.degrees(cmath.phase(direction))


def _around(points: Sequence[complex]) -> list[complex]:
    """Return the ends of a bar, or the corners of a plate in order round their middle."""
    middle = added(points) / len(points)
    return sorted(points, key=lambda z: cmath.phase(z - middle))


def _straight(rigid: Sequence[complex], foot: complex, tip: complex) -> tuple[tuple[complex, complex], ...]:
    """Return the two bars of a lever whose slot lies between its two pins, in one line with them; nothing for
    another lever."""
    if len(rigid) != 2:
        return ()
    base, other = sorted(rigid, key=lambda z: abs(z - foot))
    direction = (tip - foot) / abs(tip - foot)
    ahead = (other - tip) / direction
    if abs(ahead.imag) > 1 or ahead.real <= 0:
        return ()
    return ((base, foot), (tip, other))
