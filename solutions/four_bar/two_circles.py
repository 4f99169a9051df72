"""Two circles: solution. B is at r3 from A and at r4 from C; both points where the circles meet close the
linkage.

The judge takes B1 and B2 in either order; the angles of index 1 are those of the point that the student calls
B1.
"""

import cmath
from collections.abc import Mapping
from itertools import chain
from typing import NamedTuple

import numpy as np

from coursework.degrees import from_radians, polar, wrap
from coursework.figures import Figure, circle, ground_pivot, line, link, pin
from coursework.figures.polygons import Polygon, Side
from coursework.figures.polygons.hand_drawn import TOLERANCE_MM, on_paper
from coursework.figures.polygons.own_drawing import DrawnStroke, OwnDrawing
from coursework.kinematics.angles import Degrees
from coursework.kinematics.four_bar import FourBar
from coursework.marking.drawn_polygons import (
    DrawingParts,
    drawn,
    read_off,
    scale_for,
    to_paper,
    turned,
    verdicts,
)
from coursework.solution import Judged, given, judge, mistake

from ..polygons._drawn_start import *

ANGLES = {"1": ("theta3_open", "theta4_open"), "2": ("theta3_crossed", "theta4_crossed")}
_WIDTH = 2 * TOLERANCE_MM  #: by which a length on paper may be off
#: Degrees by which an angle may be off: on one's own drawing, and from the right one.
_MEASURED, _DRAWN = (
    1.0,
    2.0,
)
_ASKED = DrawingParts(
    scale="kl",
    points={"p": "o", "a": "a", "c": "c"},
    lengths={},
    reads={},
    sides={("o", "a"): "a", ("o", "c"): "c"},
)


def _open(r1, r2, r3, r4, theta2):
    """The linkage at its crank angle, by the numeric core."""
    return FourBar(r1, r2, r3, r4, "open").at(Degrees(theta2))


def _crossed(r1, r2, r3, r4, theta2):
    return FourBar(r1, r2, r3, r4, "crossed").at(Degrees(theta2))


def _images(r1, r2, r3, theta2, _open, _crossed):
    """A, C, B1 and B2, complex, mm from O."""
    A = polar(r2, theta2)
    pins = (A + r3 * np.exp(1j * pose.coupler_angle) for pose in (_open, _crossed))
    return A, r1 + 0 * A, *pins


def kl(_images):
    """A round scale at which the mechanism fits its box."""
    return scale_for(*_images)


def a(_images, kl):
    return to_paper(_images[0], kl)


def c(_images, kl):
    return to_paper(_images[1], kl)


def b1(_images, kl):
    return to_paper(_images[2], kl)


def b2(_images, kl):
    return to_paper(_images[3], kl)


def theta3_open(_open):
    """Measured on the drawing."""
    return from_radians(_open.coupler_angle)


def theta4_open(_open):
    return from_radians(_open.rocker_angle)


def theta3_crossed(_crossed):
    return from_radians(_crossed.coupler_angle)


def theta4_crossed(_crossed):
    return from_radians(_crossed.rocker_angle)


# ------------------------------------------------------------------------- the judge


class _Drawn(NamedTuple):
    """A student's drawing, mm on paper: what the two circles start from, and the pins B of each index."""

    scale: float
    O: complex
    A: complex
    C: complex
    r3: float
    r4: float
    B: Mapping[str, complex]

    def side(self, B):
        """Of the line from A to C on which a point lies: +1 on its left, as with the open assembly."""
        return np.sign(((self.C - self.A).conjugate() * (B - self.A)).imag)

    def on_circles(self, B, center=None, radii=None):
        """Whether a point is on the circle about A, and on that about C or another center."""
        r3, r4 = radii or (self.r3, self.r4)
        center = self.C if center is None else center
        return abs(abs(B - self.A) - r3) <= _WIDTH, abs(abs(B - center) - r4) <= _WIDTH

    def directions(self, index):
        """Those of AB and of CB, degrees, as drawn; none where B is not."""
        if index not in self.B:
            return None
        return tuple(_direction(self.B[index] - start) for start in (self.A, self.C))


@judge
def drawing(answers, r1, r2, r3, r4, theta2):
    """O anywhere, any scale; each B from the student's own A and C, each angle from the student's own B."""
    frame = _frame(polar(r2, theta2), r1)
    said = verdicts(answers, frame, _ASKED)
    own = _own_drawing(answers, frame, r3, r4)
    pins = _pins(own) if own else {}
    too_small = any(verdict.mistake == "too_small" for verdict in said.values())
    for index, verdict in pins.items():
        said[f"b{index}"] = Judged(0.0, "too_small") if too_small else _after(verdict, said)
    right = {mode: _right_angles(r1, r2, r3, r4, theta2, mode) for mode in ("open", "crossed")}
    said |= _angles(answers, own, right, said)
    undrawn = [name for index, names in ANGLES.items() if f"b{index}" not in answers for name in names]
    # Where circles meet, a turned drawing is right from its own A and C.
    return read_off(said, "ac", ("kl", *chain(*ANGLES.values())), undrawn)


def _frame(A, r1):
    """Vectors from O known before the construction."""
    return Polygon(
        "position",
        (
            Side("o", "a", r"\overrightarrow{OA}", A, r"\angle \theta_2", "r_2"),
            Side("o", "c", r"\overrightarrow{OC}", r1, r"\parallel Ox", "r_1"),
        ),
    )


def _own_drawing(answers, frame, r3, r4):
    """None where no scale can be told."""
    found = drawn(answers, frame, _ASKED)
    if found is None:
        return None
    judged, _ = found
    here = {**judged.ideal, **judged.points}
    pins = {i: on_paper(*answers[f"b{i}"]) for i in ANGLES if f"b{i}" in answers}
    return _Drawn(judged.scale, here["o"], here["a"], here["c"], r3 / judged.scale, r4 / judged.scale, pins)


def overlay(answers, r1, r2, r3, r4, theta2):
    """What the student drew, from their own O and scale, over both circles and the bars."""
    own = _own_drawing(answers, _frame(polar(r2, theta2), r1), r3, r4)
    if own is None:
        return None
    bars = r1, r2, r3, r4, theta2
    images = _images(r1, r2, r3, theta2, _open(*bars), _crossed(*bars))
    A, C, *pins = (own.O + complex(z) / own.scale for z in images)
    drawn_ = [("a", own.O, own.A), ("c", own.O, own.C)]
    drawn_ += [(f"b{i}", start, B) for i, B in own.B.items() for start in (own.A, own.C)]
    return OwnDrawing(
        [(own.O, A), (own.O, C), *((start, B) for B in pins for start in (A, C))],
        [DrawnStroke(start, end, part) for part, start, end in drawn_ if part in answers],
        {"O": own.O, "A": own.A, "C": own.C, **{f"B_{i}": B for i, B in own.B.items()}},
        [(A, own.r3), (C, own.r4)],
        bars=True,
    )


def _pins(own):
    """A verdict for each B that is drawn."""
    said = {index: _pin(B, own) for index, B in own.B.items()}
    if (
        len(said) == 2
        and all(v.share for v in said.values())
        and len({own.side(B) for B in own.B.values()}) < 2
    ):
        said["2"] = Judged(0.0, "same_point")
    return said


def _pin(B, own):
    on_A, on_C = own.on_circles(B)
    if on_A and on_C:
        return Judged()
    names = []
    if all(own.on_circles(B, radii=(own.r4, own.r3))):
        names.append("radii_exchanged")
    if all(own.on_circles(B, center=own.O)):
        names.append("circle_about_O")
    names.append("off_circle_C" if on_A else "off_circle_A" if on_C else "off_both")
    return Judged(0.0, names[0], also=tuple(names[1:]))


def _after(verdict, said):
    """Right only as it follows, where A or C is wrong."""
    wrong_before = any(said[name].share < 1 for name in "ac" if name in said)
    return Judged(follows=True) if verdict.share and wrong_before else verdict


def _right_angles(r1, r2, r3, r4, theta2, mode):
    pose = FourBar(r1, r2, r3, r4, mode).at(Degrees(theta2))
    return tuple(float(from_radians(angle)) for angle in (pose.coupler_angle, pose.rocker_angle))


def _angles(answers, own, right, said):
    """A verdict for each angle: of the assembly that its index stands for."""
    modes = _modes(answers, own, right)
    found = {}
    for index, names in ANGLES.items():
        drawn_ = own.directions(index) if own else None
        wrong = f"b{index}" in said and (said[f"b{index}"].share < 1 or said[f"b{index}"].follows)
        for k, name in enumerate(names):
            if name in answers:
                others = right[modes["2" if index == "1" else "1"]]
                found[name] = _angle(float(answers[name]), k, right[modes[index]], others, drawn_, wrong)
    return found


def _modes(answers, own, right):
    """The assembly that each index stands for: by the pins as drawn, else by the angles themselves."""
    ways = ({"1": "open", "2": "crossed"}, {"1": "crossed", "2": "open"})
    return max(ways, key=lambda way: (_pins_like(own, way), _angles_like(answers, right, way)))


def _pins_like(own, way):
    sides = {"open": 1, "crossed": -1}
    return sum(own.side(B) == sides[way[index]] for index, B in own.B.items()) if own else 0


def _angles_like(answers, right, way):
    return sum(
        _near(float(answers[name]), right[way[index]][k], _DRAWN)
        for index, names in ANGLES.items()
        for k, name in enumerate(names)
        if name in answers
    )


def _angle(found, k, right, others, own, is_wrong):
    """``k`` is 0 of the coupler, 1 of the rocker; ``own`` are the directions as the student drew them."""
    if _near(found, right[k], _DRAWN):
        return Judged()
    if own and _near(found, own[k], _MEASURED):
        return Judged(follows=is_wrong)
    of = [right, *([own] if own else [])]
    names = []
    if any(_near(found, there[k] + 180, _DRAWN) for there in of):
        names.append("read_backwards")
    if any(_near(found, -there[k], _DRAWN) for there in of):
        names.append("clockwise")
    if any(_near(found, there[1 - k], _DRAWN) for there in of):
        names.append("bars_exchanged")
    if _near(found, others[k], _DRAWN):
        names.append("of_the_other_point")
    return Judged(0.0, names[0] if names else "", also=tuple(names[1:]))


def _near(angle, other, width):
    return abs(wrap(angle - other)) <= width


def _direction(vector):
    return float(np.degrees(cmath.phase(vector)))


# ---------------------------------------------------------------------- known mistakes


@mistake("c")
def c_length(p, c):
    return p + 1.35 * (c - p)


@mistake("c")
def c_direction(p, c):
    return turned(p, c, 90)


@mistake("c", kind="sign")
def c_sense(p, c):
    return 2 * p - c


@mistake("c")
def c_vector(p, c):
    return p + 0.6 * (turned(p, c, 75) - p)


def _wrong_circles(images, kl, center, radius_A, radius):
    """Where the circle of a radius about A meets another, on paper: on the left of the line of centres, then
    on its right; the right pins where they do not meet."""
    A, _, *pins = images
    way = center - A
    along = (abs(way) ** 2 + radius_A**2 - radius**2) / (2 * abs(way))
    square = radius_A**2 - along**2
    across = 1j * np.sqrt(np.maximum(square, 0.0))
    found = (A + way / abs(way) * (along + side * across) for side in (1, -1))
    return tuple(to_paper(np.where(square > 0, z, B), kl) for z, B in zip(found, pins, strict=True))


@mistake("b1", "b2", kind="exchanged")
def radii_exchanged(_images, r3, r4, kl):
    """Exchange the radii: the coupler's about C, the rocker's about A."""
    return _wrong_circles(_images, kl, _images[1], r4, r3)


@mistake("b1", "b2")
def circle_about_O(_images, r3, r4, kl):
    """The circle of the rocker drawn about the pivot of the crank."""
    return _wrong_circles(_images, kl, 0 * _images[0], r3, r4)


@mistake("b1", "b2")
def off_circle_A(_images, r3, r4, kl):
    """With another opening of the compass about A."""
    return _wrong_circles(_images, kl, _images[1], 0.85 * r3, r4)


@mistake("b1", "b2")
def off_circle_C(_images, r3, r4, kl):
    return _wrong_circles(_images, kl, _images[1], r3, 0.85 * r4)


def _away(B, a, c):
    """12 mm from a pin, halfway between the two bars or square to that."""
    u, v = ((z[..., 0] + 1j * z[..., 1]) / np.hypot(z[..., 0], z[..., 1]) for z in (B - a, B - c))
    step = np.where(abs(u + v) > abs(u - v), u + v, u - v)
    return B + to_paper(12 * step / abs(step), 1.0)


@mistake("b1", "b2")
def off_both(a, c, b1, b2):
    return _away(b1, a, c), _away(b2, a, c)


@mistake("b2")
def same_point(b1):
    return b1


@mistake("theta3_open", "theta4_open", "theta3_crossed", "theta4_crossed", kind="branch")
def read_backwards(theta3_open, theta4_open, theta3_crossed, theta4_crossed):
    """At B, towards A or C."""
    return tuple(wrap(t + 180) for t in (theta3_open, theta4_open, theta3_crossed, theta4_crossed))


@mistake("theta3_open", "theta4_open", "theta3_crossed", "theta4_crossed", kind="sign")
def clockwise(theta3_open, theta4_open, theta3_crossed, theta4_crossed):
    return -theta3_open, -theta4_open, -theta3_crossed, -theta4_crossed


@mistake("theta3_open", "theta4_open", "theta3_crossed", "theta4_crossed", kind="exchanged")
def bars_exchanged(theta3_open, theta4_open, theta3_crossed, theta4_crossed):
    return theta4_open, theta3_open, theta4_crossed, theta3_crossed


@mistake("theta3_open", "theta4_open", "theta3_crossed", "theta4_crossed", kind="exchanged")
def of_the_other_point(b1, b2, theta3_open, theta4_open, theta3_crossed, theta4_crossed):
    """The points stay in their order."""
    return theta3_crossed, theta4_crossed, theta3_open, theta4_open


@mistake("kl", "p", "a", "c", "b1", "b2")
def too_small(kl, p, a, c, b1, b2):
    return 10 * kl, p / 10, a / 10, c / 10, b1 / 10, b2 / 10


@mistake("kl", "p", "a", "c", "b1", "b2", kind="inverse")
def scale_upside_down(kl, p, a, c, b1, b2):
    """The drawing is right."""
    return 1 / kl, p, a, c, b1, b2


@mistake("kl", "p", "a", "c", "b1", "b2")
def scale_not_drawn(kl, p, a, c, b1, b2):
    """Stated at one value, drawn at another."""
    return 2 * kl, p, a, c, b1, b2


def figure(r1, r2, r3, r4, theta2, theta3_open, theta3_crossed):
    """The construction: both circles, and the two pins where they meet."""
    O, A, C = 0j, polar(r2, theta2), complex(r1)
    B1, B2 = A + polar(r3, theta3_open), A + polar(r3, theta3_crossed)
    return Figure(
        circle(A, r3, dashed=True),
        circle(C, r4, dashed=True),
        line(O, C, dashed=True),
        link(O, A, label="r_2"),
        link(A, B1, label="r_3"),
        link(C, B1, label="r_4"),
        line(A, B2, thin=False),
        line(C, B2, thin=False),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B1, "B_1"),
        pin(B2, "B_2"),
    )


def residual(
    r1, r2, r3, r4, theta2, kl, a, c, b1, b2, theta3_open, theta4_open, theta3_crossed, theta4_crossed
):
    """Distances on paper, and the angles that the bars have there."""
    z_a, z_c, *pins = (q[..., 0] + 1j * q[..., 1] for q in (a, c, b1, b2))
    angles = (theta3_open, theta4_open), (theta3_crossed, theta4_crossed)
    found = [abs(z_a * kl / r2 - np.exp(1j * np.radians(theta2))), abs(z_c * kl / r1 - 1)]
    for side, B, (theta3, theta4) in zip((1, -1), pins, angles, strict=True):
        found.append(abs((B - z_a) * kl / r3 - np.exp(1j * np.radians(theta3))))
        found.append(abs((B - z_c) * kl / r4 - np.exp(1j * np.radians(theta4))))
        turned_ = side * (np.conj(z_c - z_a) * (B - z_a)).imag / abs(z_c - z_a) ** 2
        found.append(np.maximum(-turned_, 0))
    return tuple(found)


KNOWN = (
    # A rectangle, and the same turned over about its diagonal: a 7-24-25 triangle.
    given(r1=80, r2=60, r3=80, r4=60, theta2=90).gives(
        kl=1,
        a=(0, 60),
        c=(80, 0),
        b1=(80, 60),
        b2=(22.4, -16.8),
        theta3_open=0,
        theta4_open=90,
        theta3_crossed="-73.7398",
        theta4_crossed="-163.7398",
    ),
    # Crank along the frame and ABC equilateral, of side 60.
    given(r1=100, r2=40, r3=60, r4=60, theta2=0).gives(
        kl=2,
        a=(20, 0),
        c=(50, 0),
        b1=(35, 15 * 3**0.5),
        b2=(35, -15 * 3**0.5),
        theta3_open=60,
        theta4_open=120,
        theta3_crossed=-60,
        theta4_crossed=-120,
    ),
)
