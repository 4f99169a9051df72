"""Common base of the lessons on real machines: mechanisms solved by their files, drawn parts, and a machine
beside its scheme."""

from dataclasses import fields, replace
from functools import cache

import numpy as np

import coursework
from coursework.authoring.linkage_files import LINKAGES
from coursework.degrees import polar
from coursework.figures import Figure, angle_mark, disc, line, note, shape, trace
from coursework.linkages.compiled import compiled
from coursework.quantities.graph import call_on_quantities

from ._panels import TURN, moved

FINE = np.arange(0.0, 360.0, 0.25)  #: a turn of a crank, degrees
ROUND = np.array(TURN, float)  #: the same, as many instants as a figure that moves has


@cache
def machine(name):
    """The mechanism of a file."""
    return coursework.mechanisms()[name]


def data(name, **changed):
    """The given values of a mechanism, some of them changed."""
    return {**machine(name).variant(0).given, **changed}


def given(prefix, name, *names):
    """Given lengths of a mechanism as a lesson's text states them, mm."""
    values = data(name)
    return {f"{prefix}_{n}": f"{values[n]:.5g}" for n in names}


def solved(name, only, **changed):
    """A quantity of a mechanism, or several by name."""
    found = machine(name).solve(only=only, **data(name, **changed))
    return found[only] if isinstance(only, str) else found


def path(name, point, **changed):
    """The places of a point, complex, mm."""
    found = solved(name, (f"x{point}", f"y{point}"), **changed)
    return found[f"x{point}"] + 1j * found[f"y{point}"]


def scheme(name, **changed):
    """The elements of a mechanism's figure, and its points by letter; at a dead point too, where no variant
    asks anything."""
    spec = machine(name).spec
    elements = unnamed(call_on_quantities(spec.figure, data(name, **changed), tuple(spec.helpers)).elements)
    elements = [
        e for e in elements if not isinstance(e, angle_mark) and not (isinstance(e, line) and e.dashed)
    ]
    return elements, {e.label.replace("_", ""): e.p for e in elements if hasattr(e, "toward") and e.label}


def in_motion(name, driven, point="", driver="theta2", **changed):
    """The scheme of a mechanism at values of what drives it, in a cycle, with the path of a point."""
    way = tuple(map(complex, path(name, point, **{driver: driven}, **changed))) if point else ()
    drawn = [trace((*way, way[0]))] if point else []
    return [Figure(*drawn, *scheme(name, **{driver: float(value)}, **changed)[0]) for value in driven]


def to_and_fro(low, high):
    """Values from one end to the other and back, slow at the ends."""
    return (low + high) / 2 - (high - low) / 2 * np.cos(np.radians(np.arange(5.0, 365.0, 10.0)))


def counted(name):
    """The number of moving bodies of a mechanism and that of its lower pairs, a jack taken for two bodies and
    a slide."""
    linkage = compiled(LINKAGES / "exercises" / f"{name}.toml").linkage
    bodies = len(linkage.bodies) + bool(linkage.drive.rod)
    return bodies, (3 * bodies - linkage.mobility) // 2


def swing(angles):
    """The width of a swing, degrees, of angles in order."""
    return float(np.ptp(np.unwrap(angles, period=360)))


def crossing(first, second):
    """The angle between two lines, from 0 to 90 degrees."""
    return 90 - abs((np.asarray(first) - second) % 180 - 90)


def stays(places):
    """The spots of a path that is run both ways, once each, from left to right."""
    return tuple(map(complex, np.asarray(places)[np.argsort(np.real(places))][::16]))


# ------------------------------------------------------------------ parts


def capsule(p, q, r, end=None, shade="light", thin=False):
    """A lever from p to q with round ends of radius r, or r and ``end``."""
    end = r if end is None else end
    turned = np.degrees(np.angle(q - p))
    lean = np.degrees(np.arccos(np.clip((r - end) / abs(q - p), -1, 1)))
    one = [p + polar(r, turned + a) for a in np.linspace(lean, 360 - lean, 19)]
    two = [q + polar(end, turned + a) for a in np.linspace(-lean, lean, 19)]
    return shape(tuple(map(complex, (*one, *two))), shade, thin=thin)


def poly(*points, shade="light", thin=False):
    """A part with straight sides."""
    return shape(tuple(map(complex, points)), shade, thin=thin)


def box(low, high, shade="light", at=0.0, turned=0.0, thin=False):
    """A rectangle between two corners, in axes at a point and turned by degrees."""
    corners = (low, complex(high.real, low.imag), high, complex(low.real, high.imag))
    return poly(*(at + z * complex(polar(1.0, turned)) for z in corners), shade=shade, thin=thin)


def open_line(*points, thin=False):
    """A line of a drawn machine."""
    return shape(tuple(map(complex, points)), "none", closed=False, thin=thin)


def sector(center, inner, outer, start, end, shade="white", thin=True):
    """The part of a ring between two angles, degrees."""
    angles = np.linspace(start, end, 37)
    ring = (*(center + polar(outer, angles)), *(center + polar(inner, angles[::-1])))
    return shape(tuple(map(complex, ring)), shade, thin=thin)


def placed(points, at, turned):
    """Points of a body in the drawing: its origin, and the angle of its first axis in degrees."""
    return [at + z * complex(polar(1.0, turned)) for z in points]


def heading(p, q):
    """The angle from p to q, degrees."""
    return float(np.degrees(np.angle(q - p)))


def joints(radii, shade="white"):
    """The pins of a drawn machine with their shafts, from places and radii."""
    return [part for p, r in radii for part in (disc(p, r, shade), disc(p, 0.35 * r, "black"))]


def enlarged(elements, factor):
    """Parts and schemes in another unit of length."""
    return [
        replace(e, **{f.name: _times(getattr(e, f.name), f.name, factor) for f in fields(e)})
        for e in elements
    ]


def _times(value, name, factor):
    if isinstance(value, complex) or (name == "radius" and value is not None):
        return value * factor
    if isinstance(value, tuple) and all(isinstance(z, complex) for z in value):
        return tuple(z * factor for z in value)
    return value


def unlettered(elements):
    """Elements without any name."""
    return [replace(e, label=None) if hasattr(e, "label") else e for e in elements]


def rows_of(drawings, across, room):
    """Drawings of one size, in rows, a letter under each; ``room`` is that of one of them."""
    found = []
    for k, elements in enumerate(drawings):
        low, high = _extent(elements)
        factor = min(room.real / max((high - low).real, 1e-9), room.imag / max((high - low).imag, 1e-9))
        corner = complex(1.25 * room.real * (k % across), -1.5 * room.imag * (k // across))
        middle = corner + complex(room.real / 2, room.imag / 2)
        found += moved(enlarged(elements, factor), middle - factor * (low + high) / 2)
        found.append(note(middle - 0.68j * room.imag, f"({'abcdefgh'[k]})"))
    return found


# ------------------------------------------------------------------ a machine beside its scheme


def beside(real, elements, *, upright=False, gap=0.06, paper_mm=(165, 100)):
    """A drawn machine and its scheme, one beside the other, or one under the other: ``(a)`` and ``(b)``, to
    one scale."""
    low, high = _extent(real)
    low_2, high_2 = _extent(elements)
    room = gap * max((high - low).real, (high - low).imag)
    if upright:
        shift = complex(0.0, low.imag - high_2.imag - 2.4 * room)
        middle = (low + high).real / 2
        feet = (complex(middle, low.imag - room), complex(middle, low_2.imag + shift.imag - room))
    else:
        shift = complex(high.real - low_2.real + 2 * room, 0.0)
        foot = min(low.imag, low_2.imag) - room
        feet = (
            complex((low.real + high.real) / 2, foot),
            complex((low_2.real + high_2.real) / 2 + shift.real, foot),
        )
    letters = [note(feet[0], "(a)"), note(feet[1], "(b)")]
    return Figure(*real, *moved(elements, shift), *letters, paper_mm=paper_mm)


def _extent(elements):
    points = [z for element in elements for z in element.reach()]
    xs, ys = [z.real for z in points], [z.imag for z in points]
    return complex(min(xs), min(ys)), complex(max(xs), max(ys))


def unnamed(elements):
    """Elements without the names of lengths, which stand in a table."""
    return [
        replace(e, label=None) if "label" in {f.name for f in fields(e)} and not hasattr(e, "toward") else e
        for e in elements
    ]
