"""Figures of the lesson on chains of bodies: torsors at a point, joints, graphs, loops, a universal joint."""

import numpy as np

from coursework.degrees import polar
from coursework.figures import (
    Figure,
    angle_mark,
    centre_line,
    contact,
    ground_pivot,
    line,
    link,
    note,
    pin,
    point,
    rail,
    rotation_arrow,
    slider,
    slot_link,
    trace,
    vector,
)
from coursework.figures.perspective import in_perspective

from ._joint_graphs import bodies, joint
from ._panels import moved

_APART = 21.0  #: between two joints of the gallery, mm
_LARGER = 1.1  #: how much larger they are drawn than in a chain
_BETA = 35.0  #: between the shafts of the universal joint, degrees
_TURN = tuple(range(0, 360, 10))


def twist_at_two_points():
    """A body that turns about P: at each point the same rotation, and a velocity of its own."""
    P, A, B = 0j, complex(38, 10), complex(52, 40)
    outline = [complex(26, -2), complex(60, 4), complex(66, 44), complex(44, 50), complex(24, 14)]
    turn = 0.42j
    return Figure(
        trace((*outline, outline[0]), dotted=False),
        line(P, A, dashed=True),
        line(P, B, dashed=True),
        line(A, B),
        vector(A, turn * A, r"V_A"),
        vector(B, turn * B, r"V_B"),
        rotation_arrow(P, 8, 20, 130, r"\Omega"),
        contact(P, "P", toward=-150),
        point(A, "A", toward=-60),
        point(B, "B", toward=-20),
        paper_mm=(92, 46),
    )


def wrench_at_two_points():
    """A force along a line: no moment at A, on the line, and F times d at B."""
    A, B, force = 0j, complex(44, 30), polar(30.0, 20)
    along = force / abs(force)
    foot = A + ((B - A) / along).real * along
    return Figure(
        line(A - 14 * along, A + 64 * along, dashed=True),
        vector(A, force, "F"),
        line(B, foot, label="d"),
        rotation_arrow(B, 8, 150, 30, "M_B"),
        point(A, "A", toward=110),
        contact(B, "B", toward=-20),
        paper_mm=(92, 42),
    )


def _gallery(letters, *names, plan=()):
    """Symbols in a row, the letter of each below it, and below that its symbol in a plane where there is
    one."""
    found = []
    for number, (letter, name) in enumerate(zip(letters, names, strict=True)):
        alone = in_perspective([{"joint": name, "along": "z", "point": (0.0, 0.0, 0.0)}])
        base = [e for e in alone.elements if isinstance(e, vector)] if not number else []
        symbol = [e for e in alone.elements if not isinstance(e, (vector, point))]
        below = plan[number](-19j) if number < len(plan) else []
        found += moved([*base, *symbol, note(-11j, f"({letter})"), *below], complex(_APART * number))
    return Figure(*found, scale=_LARGER)


def _pin_in_plane(p):
    return [link(p - 6, p), link(p, p + 6), pin(p)]


def _slide_in_plane(p):
    return [rail(p - 7, p + 7), slider(p, 0.0)]


def joints_of_few_freedoms():
    """From one to two freedoms, each with its axis upwards; two of them are joints of plane mechanisms."""
    names = ("revolute", "prismatic", "helical", "cylindrical", "spherical_pin")
    return _gallery("abcde", *names, plan=(_pin_in_plane, _slide_in_plane))


def joints_of_more_freedoms():
    """From three to five freedoms."""
    return _gallery("fghij", "spherical", "planar", "annular", "line_contact", "point_contact")


def joints_to_be_named():
    """Six joints in an order that says nothing."""
    names = ("annular", "cylindrical", "point_contact", "revolute", "planar", "spherical")
    return _gallery("abcdef", *names)


def parallel_graph():
    """Several joints between two bodies, and the one that does as much."""
    one, two = {"1": 0j, "2": complex(50)}, {"1": complex(86), "2": complex(124)}
    return Figure(
        *bodies(one),
        *bodies(two),
        *joint(one["1"], one["2"], "L_1", 13),
        *joint(one["1"], one["2"], "L_2", 5),
        *joint(one["1"], one["2"], "L_n", -9),
        *joint(two["1"], two["2"], "L"),
        paper_mm=(130, 44),
    )


def series_graph():
    """An open chain, and the joint that does as much."""
    top = {"0": complex(0, 16), "1": complex(34, 16), "2": complex(68, 16), "n": complex(126, 16)}
    low = {"0": complex(0, -14), "n": complex(126, -14)}
    return Figure(
        *bodies(top),
        *bodies(low),
        *joint(top["0"], top["1"], "L_1"),
        *joint(top["1"], top["2"], "L_2"),
        line(top["2"] + 5.4, top["2"] + 20, thin=False),
        note(complex(98, 16), "..."),
        line(top["n"] - 20, top["n"] - 5.4, thin=False, label="L_n"),
        *joint(low["0"], low["n"], "L"),
        paper_mm=(130, 48),
    )


def closed_graph():
    """A closed chain: n moving bodies, n + 1 joints, what acts at the input and at the output."""
    names = ("0", "1", "2", "n")
    at = {name: polar(26.0, a) for name, a in zip(names, (-90, 180, 90, 0), strict=True)}
    gap = at["n"] - at["2"]
    return Figure(
        *bodies(at),
        *joint(at["0"], at["1"], "L_1"),
        *joint(at["1"], at["2"], "L_2"),
        line(at["2"] + 0.2 * gap, at["2"] + 0.8 * gap, dashed=True),
        *joint(at["n"], at["0"], "L_{n+1}"),
        vector(at["1"] - 24, 18, "E"),
        vector(at["n"] + 24, -18, "S"),
        paper_mm=(100, 48),
    )


def complex_graph():
    """A four-bar linkage with a rod and a slide: two independent cycles."""
    at = {
        "0": 0j,
        "1": complex(-34, 22),
        "2": complex(0, 44),
        "3": complex(34, 22),
        "4": complex(66, 22),
        "5": complex(50, -8),
    }
    return Figure(
        *bodies(at),
        *joint(at["0"], at["1"], "O"),
        *joint(at["1"], at["2"], "A"),
        *joint(at["2"], at["3"], "B"),
        *joint(at["3"], at["0"], "C"),
        *joint(at["3"], at["4"], "D"),
        *joint(at["4"], at["5"], "E"),
        *joint(at["5"], at["0"], "x"),
        paper_mm=(100, 50),
    )


def four_feet():
    """A table on four feet: four contacts in one plane, one more than are needed."""
    corners = ((0.0, 0.0), (0.0, 60.0), (40.0, 60.0), (40.0, 0.0))
    rows = [{"joint": "point_contact", "along": "z", "point": (x, y, 0.0)} for x, y in corners]
    return in_perspective(rows, bodies=((1, 1, 2), (1, 2, 3), (1, 3, 4), (1, 4, 1)), tall=36.0)


def ball_and_sleeve():
    """A shaft in a ball and a ball in a cylinder: an isostatic pivot."""
    rows = [
        {"joint": "spherical", "along": "y", "point": (0.0, 0.0, 0.0)},
        {"joint": "annular", "along": "y", "point": (0.0, 60.0, 0.0)},
    ]
    return in_perspective(rows, bodies=((1, 1, 2),), tall=26.0)


def rod_between_balls():
    """A rod between two balls turns about itself."""
    rows = [
        {"joint": "spherical", "along": "y", "point": (0.0, 0.0, 0.0)},
        {"joint": "spherical", "along": "y", "point": (0.0, 60.0, 20.0)},
    ]
    return in_perspective(rows, bodies=((1, 1, 2),), tall=26.0)


def linear_and_angular():
    """A slotted mechanism, its vectors, and the angles of its bases."""
    O4, O2 = 0j, 40j
    A = O2 + polar(26.0, 25)
    along = A / abs(A)
    return Figure(
        slot_link(O4, A + 16 * along),
        link(O2, A),
        vector(O4, 24 * along, r"\vec{x}_4"),
        vector(O4, 24j * along, r"\vec{y}_4"),
        vector(O4, 24, r"\vec{x}_0"),
        line(O2, O2 + 26, dashed=True),
        angle_mark(O4, 0, float(np.degrees(np.angle(A))), r"\theta_4", radius=13),
        angle_mark(O2, 0, 25, r"\theta_2", radius=13),
        ground_pivot(O4, "O_4"),
        ground_pivot(O2, "O_2"),
        slider(A, float(np.degrees(np.angle(A)))),
        pin(A, "A"),
        paper_mm=(90, 60),
    )


def wedge():
    """A plane chain without a pivot: two blocks, three slides."""
    incline = polar(1.0, 30)
    low = complex(-24, 0), complex(28, 0), complex(28, 52 * np.tan(np.radians(30)))
    foot = complex(2, 26 * np.tan(np.radians(30)))
    top = (foot, foot + 24, foot + 24 + 30j, foot + 30j)
    top = (foot, foot + 22 * incline / incline.real, foot + 22 + 40j, foot + 40j)
    return Figure(
        trace((*low, low[0]), dotted=False),
        trace((*top, top[0]), dotted=False),
        rail(complex(-30, 0), complex(38, 0)),
        line(top[0] - 0.6, top[3] + 6j),
        line(top[1] + 0.6, top[2] + 0.6 + 6j),
        vector(complex(-44, 6), 16, "v_1"),
        vector(foot + 11 + 46j, 14j, "v_2"),
        note(complex(16, 7), "1"),
        note(foot + 11 + 26j, "2"),
        angle_mark(complex(-24, 0), 0, 30, r"\alpha", radius=14),
        paper_mm=(100, 52),
    )


# The universal joint: shaft 1 along x, shaft 2 in the plane of x and y, both normal to z.


def _seen(place):
    """A point of space as seen from above and aside."""
    x, y, z = place
    about, above = np.radians(-50.0), np.radians(35.0)
    right = -np.sin(about) * x + np.cos(about) * y
    deep = np.cos(about) * x + np.sin(about) * y
    return complex(right, np.cos(above) * z - np.sin(above) * deep)


def _arms(theta1):
    """Directions of both shafts and of both arms of the cross."""
    beta, theta2 = np.radians(_BETA), np.arctan2(np.cos(np.radians(_BETA)) * np.sin(theta1), np.cos(theta1))
    d1, d2, z = np.array([1.0, 0, 0]), np.array([np.cos(beta), np.sin(beta), 0]), np.array([0, 0, 1.0])
    a1 = np.cos(theta1) * z + np.sin(theta1) * np.cross(d1, z)
    a2 = -np.sin(theta2) * z + np.cos(theta2) * np.cross(d2, z)
    return d1, d2, a1, a2


def _yoke(shaft, arm, far=58.0, neck=26.0, half=17.0):
    """A shaft that ends in a fork: its two prongs hold an arm of the cross."""
    prong = [
        (_seen(neck * shaft), _seen(neck * shaft + sign * half * arm), _seen(sign * half * arm))
        for sign in (1, -1)
    ]
    found = [line(_seen(far * shaft), _seen(neck * shaft), thin=False)]
    for one, two, three in prong:
        found += [line(one, two, thin=False), line(two, three, thin=False)]
    return found


def _universal(theta1, *, marks=True):
    d1, d2, a1, a2 = _arms(np.radians(theta1))
    half = 17.0
    ends = [_seen(sign * half * arm) for arm in (a1, a2) for sign in (1, -1)]
    found = [
        centre_line(_seen(-62 * d1), _seen(70 * d1)),
        centre_line(_seen(62 * d2), _seen(-8 * d2)),
        *_yoke(-d1, a1),
        *_yoke(d2, a2),
        line(ends[0], ends[1], thin=False),
        line(ends[2], ends[3], thin=False),
        *(pin(end) for end in ends),
    ]
    if marks:
        found += [
            vector(0j, _seen(half * a1), r"\vec{a}_1"),
            vector(0j, _seen(half * a2), r"\vec{a}_2"),
            vector(0j, _seen(np.array([0, 0, 30.0])), r"\vec{z}"),
            vector(_seen(-62 * d1), _seen(12 * d1), r"\vec{d}_1"),
            vector(_seen(50 * d2), _seen(12 * d2), r"\vec{d}_2"),
            point(0j, "O", toward=-90),
            note(_seen(40 * d1 + 12 * d2), r"\beta"),
        ]
    return found


def universal_joint():
    """Two shafts that meet, and a cross whose arms stay perpendicular."""
    return Figure(*_universal(30), paper_mm=(120, 80))


def universal_joint_turning():
    """One turn of the first shaft."""
    return [Figure(*_universal(a, marks=False), paper_mm=(110, 62)) for a in _TURN]
