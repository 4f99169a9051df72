"""Common base of lesson figures: drawings side by side, joint graphs, and shapes without an element of their
own."""

from dataclasses import fields, replace

import numpy as np

from coursework.degrees import polar
from coursework.figures import circle, line, note, trace, vector

TURN = tuple(range(0, 360, 10))  #: instants of a moving figure, degrees of its driver


def moved(elements, by):
    """The elements shifted by a vector, mm."""
    return [
        replace(
            element,
            **{f.name: _shifted(getattr(element, f.name), by) for f in fields(element) if f.name != "v"},
        )
        for element in elements
    ]


def _shifted(value, by):
    if isinstance(value, complex):
        return value + by
    if isinstance(value, tuple) and value and all(isinstance(z, complex) for z in value):
        return tuple(z + by for z in value)
    return value


def panels(*drawings, across, letters="abcdefgh", down=0.0, columns=None, drop=0.0):
    """Drawings on a grid of columns ``across`` apart (mm of mechanism), a letter under each.

    ``down`` is how far the letters stand below the origin of their drawing, ``drop`` the height of a row.
    """
    columns = columns or len(drawings)
    found = []
    for number, elements in enumerate(drawings):
        origin = complex(across * (number % columns), -drop * (number // columns))
        found += moved(elements, origin)
        if letters:
            found.append(note(origin + complex(0.42 * across, -down), f"({letters[number]})"))
    return found


def graph(places, joints, radius=4.2):
    """A joint graph: bodies as numbered circles at ``places``, the frame 1 with a second one.

    ``joints`` are pairs of bodies, each with the letter of the joint; none where it is empty.
    """
    found = []
    for body, place in places.items():
        found += [circle(place, radius), note(place, str(body))]
    found.append(circle(places[1], 1.2 * radius))
    for bodies, letter in joints:
        p, q = (places[body] for body in bodies)
        way = (q - p) / abs(q - p) * 1.2 * radius
        found.append(line(p + way, q - way, thin=False, label=letter or None))
    return found


def closed(points):
    """A curve through points and back to the first."""
    return trace((*points, points[0]), dotted=False)


def arrows_both(p, v, label=None):
    """A straight motion to and fro about a point."""
    return [vector(p, v, label), vector(p, -v)]


def gear(center, pitch_radius, teeth, turned=0.0, pressure=20.0):
    """The outline of a gear of involute teeth; ``turned`` in degrees, 0 with a tooth along x.

    Source: the involute of the base circle; half a tooth at the pitch circle is a quarter of a pitch.
    """
    module = 2 * pitch_radius / teeth
    base = pitch_radius * np.cos(np.radians(pressure))
    tip, root = pitch_radius + 0.9 * module, pitch_radius - 1.1 * module
    radii = np.linspace(max(base, root), tip, 6)
    half = np.degrees(
        np.pi / (2 * teeth) + _involute(np.radians(pressure)) - _involute(np.arccos(base / radii))
    )
    flank = [polar(root, -180 / teeth * 0.62), *polar(radii, -half)]
    tooth = np.array([*flank, *np.conj(flank)[::-1]])
    return tuple(
        center + z * polar(1.0, turned + 360 * k / teeth) for k in range(teeth) for z in tooth.tolist()
    )


def _involute(angle_):
    return np.tan(angle_) - angle_
