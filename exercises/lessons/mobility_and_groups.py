"""Figures of the lesson on mobility: joint graphs, cycles, Assour groups and the mechanisms that they
make."""

import numpy as np

from coursework.degrees import angle, polar
from coursework.figures import (
    Figure,
    contact,
    ground_pivot,
    line,
    link,
    note,
    pin,
    rail,
    rotation_arrow,
    slider,
    slot_link,
    vector,
    wheel,
)
from coursework.structure.library import LIBRARY
from coursework.structure.scheme import kinematic_scheme

from ._machines import counted, rows_of, scheme, unlettered
from ._panels import closed, graph, moved, panels

WIDE = (150, 75)


def _scheme(name, driver=2):
    """The elements of a mechanism of the course's figures, mm on paper."""
    return list(kinematic_scheme(LIBRARY[name], driver=(1, driver) if driver else ()).elements)


def _beside(scheme, places, joints, at):
    """A scheme and its joint graph."""
    return Figure(*scheme, *moved(graph(places, joints), at), paper_mm=(158, 80))


# ------------------------------------------------------------------ joint graphs

_RING = {1: 0j, 2: -20 + 18j, 3: 0 + 36j, 4: 20 + 18j}


def four_bar_graph():
    """The four-bar linkage and its joint graph: one cycle."""
    joints = [((1, 2), "O"), ((2, 3), "A"), ((3, 4), "B"), ((1, 4), "C")]
    return _beside(_scheme("figure_3"), _RING, joints, 112 + 2j)


def slider_crank_graph():
    """The slider-crank has the same graph."""
    joints = [((1, 2), "O"), ((2, 3), "A"), ((3, 4), "B"), ((1, 4), "P")]
    return _beside(_scheme("figure_4"), _RING, joints, 118 - 8j)


_PLACES_13 = {1: 0 - 4j, 2: -28 + 10j, 3: -20 + 34j, 4: 0 + 22j, 5: 20 + 34j, 6: 28 + 10j}
_JOINTS_13 = [
    ((1, 2), "O"),
    ((2, 3), "A"),
    ((3, 4), "B"),
    ((1, 4), "C"),
    ((4, 5), "D"),
    ((5, 6), "E"),
    ((1, 6), "F"),
]


def figure_13():
    """The mechanism of Figure 13 and its joint graph: two cycles that share the edge C."""
    return _beside(_scheme("figure_13"), _PLACES_13, _JOINTS_13, 142 + 2j)


_PLACES_14 = {
    1: 0 - 8j,
    2: -34 + 0j,
    3: -24 + 26j,
    4: -8 + 14j,
    5: 24 + 20j,
    6: 2 + 38j,
    7: 46 + 20j,
    8: 36 - 4j,
}
_JOINTS_14 = [
    ((1, 2), "O"),
    ((2, 3), "A"),
    ((3, 4), "B"),
    ((1, 4), "C"),
    ((3, 6), "E"),
    ((5, 6), "E'"),
    ((1, 5), "D"),
    ((5, 7), "F"),
    ((7, 8), "G"),
    ((1, 8), "G'"),
]


def figure_14():
    """The mechanism of Figure 14."""
    return Figure(*_scheme("figure_14"), paper_mm=(125, 75))


def figure_14_graph():
    """Its joint graph: eight bodies, ten pairs, three cycles."""
    return Figure(*graph(_PLACES_14, _JOINTS_14), paper_mm=(110, 70))


def spanning_tree():
    """The same graph: a tree that ties all bodies to the frame, and the three edges that close a cycle,
    dashed."""
    closing = ((3, 4), (5, 6), (1, 8))
    kept = [(bodies, "") for bodies, _ in _JOINTS_14 if bodies not in closing]
    dashed = []
    for number, (one, other) in enumerate(closing, start=1):
        p, q = _PLACES_14[one], _PLACES_14[other]
        way = (q - p) / abs(q - p) * 5.1
        dashed.append(line(p + way, q - way, dashed=True, label=rf"\gamma_{number}"))
    return Figure(*graph(_PLACES_14, kept), *dashed, paper_mm=(110, 70))


def shared_pivot():
    """Three bodies on one pivot, B: two pairs."""
    places = {1: 0 - 6j, 2: -30 + 6j, 3: -22 + 30j, 4: 0 + 12j, 5: 22 + 30j, 6: 30 + 6j}
    hub = 0 + 30j
    joints = [((1, 2), "O"), ((2, 3), "A"), ((1, 4), "D"), ((5, 6), "C"), ((1, 6), "C'")]
    arms = [
        line(p + (hub - p) / abs(hub - p) * 5.1, hub, thin=False) for p in (places[3], places[4], places[5])
    ]
    found = [*graph(places, joints), *arms, contact(hub, "B")]
    return Figure(*_scheme("figure_27"), *moved(found, 136), paper_mm=(158, 80))


# ------------------------------------------------------------------ what the formula does not see

_SHORT, _LONG, _LEAN = 26.0, 66.0, 62.0


def five_bars():
    """A parallelogram with a third crank, parallel to the two others: w = 0, and it moves."""
    up = complex(polar(_SHORT, _LEAN))
    feet = (0j, complex(_LONG / 2), complex(_LONG))
    cranks = [link(foot, foot + up, label=str(n)) for foot, n in zip(feet, (2, 5, 4), strict=True)]
    return Figure(
        *cranks,
        link(up, up + _LONG, label="3"),
        *[ground_pivot(foot, name) for foot, name in zip(feet, "OEC", strict=True)],
        *[pin(foot + up, name) for foot, name in zip(feet, "AFB", strict=True)],
        paper_mm=(105, 55),
    )


def roller_follower():
    """A cam with a roller: w = 2, since the roller may turn on itself to no effect."""
    phi = np.arange(0, 360, 3.0)
    radius = 18 - 7 * np.cos(np.radians(phi - 90))
    profile = polar(radius, phi)
    roller = 6.0
    # The roller's centre is on the axis x = 0, a roller's radius off the nearest point of the profile.
    centre = 1j * max(
        z.imag + np.sqrt(roller**2 - z.real**2)
        for z in profile.tolist()
        if abs(z.real) < roller and z.imag > 0
    )
    touch = min(profile.tolist(), key=lambda z: abs(z - centre))
    return Figure(
        closed(profile),
        wheel(centre, roller, "3"),
        link(centre, centre + 36j),
        rail(centre + 14j, centre + 32j),
        rail(centre + 32j, centre + 14j),
        slider(centre + 23j, 90, "4"),
        note(6 - 12j, "2"),
        ground_pivot(0j, "O"),
        pin(centre, "A"),
        contact(touch, "I"),
        rotation_arrow(centre, 9, 150, 215),
        paper_mm=(60, 95),
    )


# ------------------------------------------------------------------ groups

_P = {"O": 0j, "A": 14 + 24j, "B": 58 + 38j, "C": 66 + 0j}


def taken_apart():
    """Figure 7: the whole, the driver with the frame, the group that is left."""
    O, A, B, C = _P.values()
    whole = [
        link(O, A, label="2"),
        link(A, B, label="3"),
        link(C, B, label="4"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        rotation_arrow(O, 8, 95, 175),
    ]
    driver = [link(O, A, label="2"), ground_pivot(O, "O"), pin(A, "A"), rotation_arrow(O, 8, 95, 175)]
    dyad = [
        link(A, B, label="3"),
        link(C, B, label="4"),
        ground_pivot(A, "A"),
        ground_pivot(C, "C"),
        pin(B, "B"),
    ]
    return Figure(
        *moved(whole, 0j),
        *moved(driver, 98),
        *moved(dyad, 118),
        note(33 - 17j, "(a)"),
        note(104 - 17j, "(b)"),
        note(158 - 17j, "(c)"),
        paper_mm=(158, 62),
    )


def dyads():
    """The five forms of the dyad, by what its three joints are."""
    drawings = (_dyad_rrr(), _dyad_rrp(), _dyad_rpr(), _dyad_prp(), _dyad_rpp())
    return Figure(*panels(*drawings, across=62, down=14, columns=3, drop=54), paper_mm=(150, 92))


def _dyad_rrr():
    A, B, C = 2 + 4j, 26 + 24j, 42 + 0j
    return [link(A, B, label="3"), link(C, B, label="4"), ground_pivot(A), ground_pivot(C), pin(B)]


def _dyad_rrp():
    A, B = 4 + 22j, 36 + 4j
    return [link(A, B, label="3"), rail(B - 14, B + 12), slider(B, 0, "4"), ground_pivot(A), pin(B)]


def _dyad_rpr():
    A, C = 40 + 22j, 4 + 0j
    way = (A - C) / abs(A - C)
    return [
        slot_link(C, C + 52 * way, label="4"),
        slider(A, float(angle(way)), "3"),
        ground_pivot(A),
        ground_pivot(C),
    ]


def _dyad_prp():
    p = 24 + 8j
    way = polar(1.0, 60.0)
    return [
        link(p - 22, p),
        slider(p - 16, 0, "3"),
        rail(p - 24, p - 8),
        link(p, p + 26 * way),
        slider(p + 18 * way, 60, "4"),
        rail(p + 10 * way, p + 26 * way),
        pin(p),
    ]


def _dyad_rpp():
    """A block pinned at A that slides in a bar, which slides on the frame."""
    A, foot = 14 + 14j, 14 + 0j
    return [
        slot_link(foot - 3j, A + 14j),
        link(foot, foot + 28, label="4"),
        slider(A, 90, "3"),
        ground_pivot(A),
        rail(foot + 12, foot + 28),
        slider(foot + 20, 0),
    ]


# ------------------------------------------------------------------ Figure 8, class by class


def class_one():
    """A motor and a press: the frame and one body, on a pivot or in a slide."""
    motor = [
        wheel(18 + 18j, 14, "2"),
        ground_pivot(18 + 18j, "O"),
        rotation_arrow(18 + 18j, 18, 40, 130),
    ]
    press = [
        rail(10 + 30j, 10 + 2j),
        rail(10 + 2j, 26 + 2j),
        rail(26 + 2j, 26 + 30j),
        link(18 + 19j, 18 + 46j, label="2"),
        link(6 + 46j, 30 + 46j),
        _piston(18 + 16j, 19, 6),
        vector(18 + 3j, 8j, "p"),
    ]
    return Figure(
        *moved(motor, 0j), *moved(press, 64), note(18 - 14j, "(a)"), note(82 - 14j, "(b)"), paper_mm=(110, 70)
    )


def _piston(p, width, height):
    half = complex(width / 2, height / 2)
    return link(p + half, p + half.conjugate(), p - half, p - half.conjugate())


def class_two():
    """The engine: one dyad."""
    return _parted("figure_4", _dyad_of_engine(), 104, 8)


def _dyad_of_engine():
    A, B = 16 + 20j, 68 + 0j
    return [link(A, B, label="3"), rail(B - 9, B + 9), slider(B, 0, "4"), ground_pivot(A, "A"), pin(B, "B")]


def _parted(name, group, at, low):
    """A mechanism, and its group alone with its outer joints held."""
    return Figure(
        *_scheme(name),
        *moved(group, at),
        note(36 - 1j * (low + 10), "(a)"),
        note(at + 42 - 1j * (low + 10), "(b)"),
        paper_mm=(158, 70),
    )


def class_three():
    """The shaper: one group of four bodies about a plate of three joints."""
    A, B, C, D, E = 8 + 18j, 38 + 30j, 48 + 8j, 28 - 6j, 82 + 0j
    group = [
        link(B, C, E, label="4"),
        link(A, B, label="3"),
        link(D, C, label="5"),
        rail(E - 9, E + 9),
        slider(E, 0, "6"),
        ground_pivot(A, "A"),
        ground_pivot(D, "D"),
        pin(B, "B"),
        pin(C, "C"),
        pin(E, "E"),
    ]
    return _parted("figure_8c_shaper", group, 102, 12)


def class_four():
    """One group of four bodies in a ring of four sides."""
    A, B, C, D, E, F = -6 + 18j, 14 + 42j, 62 + 44j, 58 + 20j, 26 + 20j, 78 + 0j
    group = [
        link(A, B, E, label="3"),
        link(C, D, F, label="5"),
        link(B, C, label="4"),
        link(E, D, label="6"),
        ground_pivot(A, "A"),
        ground_pivot(F, "F"),
        pin(B, "B"),
        pin(C, "C"),
        pin(D, "D"),
        pin(E, "E"),
    ]
    return _parted("figure_8d", group, 104, 8)


def shaper_other_driver():
    """The same shaper driven by its ram: two dyads."""
    return Figure(*_scheme("figure_8c_shaper", driver=6), paper_mm=(120, 60))


# ------------------------------------------------------------------ Figure 14 taken apart

_Q = {
    "O": 0j,
    "A": -12 + 18j,
    "B": 26 + 26j,
    "C": 34 + 0j,
    "E": 14 + 50j,
    "D": -22 + 40j,
    "F": 59 + 62.5j,
    "G": 92 + 54j,
}


def figure_14_groups():
    """Driven by body 2: the driver, then three dyads, each on what is placed before it."""
    O, A, B, C, E, D, F, G = (_Q[name] for name in "OABCEDFG")
    way = (F - D) / abs(F - D)
    driver = [link(O, A, label="2"), ground_pivot(O, "O"), pin(A, "A"), rotation_arrow(O, 8, 20, 90)]
    first = [
        link(A, B, E, label="3"),
        link(C, B, label="4"),
        ground_pivot(A, "A"),
        ground_pivot(C, "C"),
        pin(B, "B"),
        pin(E, "E"),
    ]
    second = [
        slot_link(E - 9 * way, E + 9 * way),
        link(D, E - 9 * way, label="5"),
        link(E + 9 * way, F),
        slider(E, float(angle(way)), "6"),
        ground_pivot(D, "D"),
        ground_pivot(E, "E"),
        pin(F, "F"),
    ]
    third = [link(F, G, label="7"), rail(G - 9, G + 9), slider(G, 0, "8"), ground_pivot(F, "F"), pin(G, "G")]
    return Figure(
        *moved(driver, 14),
        *moved(first, 52),
        *moved(second, 132 - 30j),
        *moved(third, 172 - 34j),
        note(8 - 18j, "(a)"),
        note(66 - 18j, "(b)"),
        note(152 - 18j, "(c)"),
        note(248 - 18j, "(d)"),
        paper_mm=(158, 60),
    )


def figure_14_by_5():
    """Driven by body 5, the bodies 2, 3, 4, 6 are one group about the plate 3."""
    O, A, B, C, E = (_Q[name] for name in "OABCE")
    way = (_Q["F"] - _Q["D"]) / abs(_Q["F"] - _Q["D"])
    return Figure(
        link(A, B, E, label="3"),
        link(O, A, label="2"),
        link(C, B, label="4"),
        line(E - 24 * way, E + 24 * way, dashed=True, label="5"),
        slider(E, float(angle(way)), "6"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        pin(E, "E"),
        paper_mm=(80, 75),
    )


# ------------------------------------------------------------------ schemes to be counted

UNNAMED = (
    ("klann_leg", {"theta2": 115.0}),
    ("class_three_slider", {}),
    ("two_loops", {}),
    ("atkinson_engine", {"theta2": 75.0}),
)


def schemes_to_be_counted():
    """Four schemes without letters."""
    drawings = [unlettered(scheme(name, **changed)[0]) for name, changed in UNNAMED]
    return Figure(*rows_of(drawings, 4, 100 + 90j), paper_mm=(165, 60))


def values():
    """How many bodies move in each of them, and how many lower pairs join them."""
    found = {}
    for letter, (name, _) in zip("abcd", UNNAMED, strict=True):
        bodies, pairs = counted(name)
        found |= {f"{letter}_bodies": f"{bodies}", f"{letter}_pairs": f"{pairs}"}
    return found
