"""Figures of the lesson on several loops: two mechanisms, their vectors, their graphs."""

from coursework.degrees import angle, polar
from coursework.figures import (
    Figure,
    angle_mark,
    centre_line,
    circle,
    dimension,
    ground_pivot,
    line,
    link,
    note,
    pin,
    point,
    rail,
    rotation_arrow,
    slider,
    vector,
)
from coursework.kinematics.dyads import rrp, rrr

from ._panels import graph, panels


def _two_loops():
    """Pins O, A, B, C, D, E, F of the linkage with a plate."""
    O, C, F = 0j, 180 + 0j, 310 + 20j
    A = polar(50, 70)
    B = rrr(A, C, 150, 130, 1)
    D = C + 90 * (B - C) / abs(B - C) * polar(1, -40)
    return O, A, B, C, D, rrr(D, F, 140, 130, 1), F


def two_loops():
    O, A, B, C, D, E, F = _two_loops()
    return Figure(
        link(O, A, label="2"),
        link(A, B, label="3"),
        link(C, B, D, label="4"),
        link(D, E, label="5"),
        link(F, E, label="6"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        ground_pivot(F, "F"),
        *(pin(at, name) for at, name in ((A, "A"), (B, "B"), (D, "D"), (E, "E"))),
    )


def two_loops_vectors():
    O, A, B, C, D, E, F = _two_loops()
    return Figure(
        vector(O, A, "r_2"),
        vector(A, B - A, "r_3"),
        vector(C, B - C, "r_4"),
        vector(O, C, "c"),
        vector(C, D - C, "r_5"),
        vector(D, E - D, "r_6"),
        vector(F, E - F, "r_7"),
        vector(C, F - C, "f"),
        angle_mark(C, angle(B - C), angle(B - C) - 40, r"\beta", radius=30),
        rotation_arrow((O + A + B + C) / 4, 14, 150, -120, "1"),
        rotation_arrow((C + D + E + F) / 4, 14, 150, -120, "2"),
        *(
            point(at, name)
            for at, name in ((O, "O"), (A, "A"), (B, "B"), (C, "C"), (D, "D"), (E, "E"), (F, "F"))
        ),
    )


def _graph(places, joints):
    """Bodies as circles, joints as lines between them; a body is told by its number, a joint by its
    letter."""
    radius = 4.5

    def side(one, other):
        way = places[other] - places[one]
        return places[one] + radius * way / abs(way)

    return Figure(
        *(circle(at, radius) for at in places.values()),
        *(note(at, number) for number, at in places.items()),
        *(line(side(i, j), side(j, i), thin=False, label=name) for i, j, name in joints),
        paper_mm=(95, 50),
    )


def two_loops_graph():
    places = {"1": 50 + 0j, "2": 0 + 15j, "3": 20 + 40j, "4": 50 + 40j, "5": 80 + 40j, "6": 100 + 15j}
    joints = (
        ("1", "2", "O"),
        ("2", "3", "A"),
        ("3", "4", "B"),
        ("4", "1", "C"),
        ("4", "5", "D"),
        ("5", "6", "E"),
        ("6", "1", "F"),
    )
    return _graph(places, joints)


def three_loops_graph():
    places = {
        "1": 60 + 0j,
        "2": 25 + 0j,
        "3": 0 + 25j,
        "4": 35 + 25j,
        "6": 25 + 52j,
        "5": 75 + 52j,
        "7": 115 + 40j,
        "8": 110 + 10j,
    }
    joints = (
        ("1", "2", "O"),
        ("2", "3", "A"),
        ("3", "4", "B"),
        ("4", "1", "C"),
        ("3", "6", "E"),
        ("6", "5", "E'"),
        ("5", "1", "D"),
        ("5", "7", "F"),
        ("7", "8", "G"),
        ("8", "1", "G'"),
    )
    return _graph(places, joints)


BETA, D3 = 55.0, 125.0


def _three_loops():
    """Pins O, A, B, C, E, D, F, G of the shaper; the coupler is the plate A, B, E."""
    O, C, D = 0j, 200 - 40j, 115 - 170j
    A = polar(35, 95)
    B = rrr(A, C, 130, 165, 1)
    E = A + 85 * (B - A) / abs(B - A) * polar(1, BETA)
    F = D + 360 * (E - D) / abs(E - D)
    return O, A, B, C, E, D, F, rrp(F, 170, D3)


def three_loops():
    O, A, B, C, E, D, F, G = _three_loops()
    return Figure(
        rail(G - 50, G + 50),
        link(D, F, label="5"),
        link(O, A, label="2"),
        link(A, B, E, label="3"),
        link(C, B, label="4"),
        slider(E, angle(F - D), label="6"),
        link(F, G, label="7"),
        slider(G, 0, label="8"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        ground_pivot(D, "D"),
        *(pin(at, name) for at, name in ((A, "A"), (B, "B"), (E, "E"), (F, "F"), (G, "G"))),
        paper_mm=(110, 90),
    )


def three_loops_vectors():
    O, A, B, C, E, D, F, G = _three_loops()
    return Figure(
        centre_line(O, G.real + 30, label="x"),
        dimension(G.real, G, "d_3", offset=0),
        vector(O, A, "r_2"),
        vector(A, B - A, "r_3"),
        vector(A, E - A, "r_6"),
        vector(C, B - C, "r_4"),
        vector(O, C, "r_1"),
        vector(O, D, "r_{10}"),
        vector(D, E - D, "d_5"),
        vector(E, F - E, "r_5-d_5"),
        vector(F, G - F, "r_7"),
        angle_mark(A, angle(B - A), angle(B - A) + BETA, r"\beta", radius=38),
        *(
            point(at, name)
            for at, name in (
                (O, "O"),
                (A, "A"),
                (B, "B"),
                (C, "C"),
                (D, "D"),
                (E, "E"),
                (F, "F"),
                (G, "G"),
            )
        ),
        paper_mm=(110, 90),
    )


def graphs_to_be_counted():
    """Four graphs without letters: a ring, two of six bodies that have as many joints, and three loops."""
    square = {1: 0j, 2: 32j, 3: 32 + 32j, 4: 32 + 0j}
    hexagon = {1: 0j, 2: 32j, 3: 28 + 44j, 4: 56 + 32j, 5: 56 + 0j, 6: 28 - 12j}
    parted = {1: 16j, 2: 28 + 44j, 3: 56 + 16j, 4: 44 - 12j, 5: 12 - 12j, 6: 28 + 16j}
    octagon = {k: 28 + 10j + 30 * complex(polar(1, 202.5 - 45 * k)) for k in range(1, 9)}
    chains = (
        (square, [(k, k % 4 + 1) for k in range(1, 5)]),
        (hexagon, [*((k, k % 6 + 1) for k in range(1, 7)), (1, 4)]),
        (parted, [(1, 2), (2, 3), (1, 6), (6, 3), (3, 4), (4, 5), (5, 1)]),
        (octagon, [*((k, k % 8 + 1) for k in range(1, 9)), (1, 4), (5, 8)]),
    )
    drawings = [graph(places, [(pair, "") for pair in pairs], radius=6.5) for places, pairs in chains]
    return Figure(*panels(*drawings, across=80, down=30), paper_mm=(165, 45))
