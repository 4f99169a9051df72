"""Figures of the lesson on Grashof's rule and coupler curves: the four types, why the rule holds, what curves
do."""

from itertools import pairwise

import numpy as np

from coursework.degrees import angle, polar
from coursework.figures import (
    Figure,
    angle_mark,
    arc,
    circle,
    contact,
    dimension,
    ground_pivot,
    line,
    link,
    note,
    pin,
    point,
    rail,
    trace,
)
from coursework.kinematics.dyads import rrr

from ._machines import box, capsule, rows_of, unlettered
from ._panels import TURN, closed, moved

FINE = np.arange(0.0, 360.0, 3.0)


def _linkage(bars, theta2, side=1):
    """O, A, B, C for bars r1, r2, r3, r4 and a crank angle in degrees."""
    r1, r2, r3, r4 = bars
    A = polar(float(r2), theta2)
    C = r1 + 0 * A
    return 0 * A, A, rrr(A, C, r3, r4, side), C


def _drawn(O, A, B, C, numbers=True, more=()):
    """The linkage in one position, the frame dashed."""
    O, A, B, C = map(complex, (O, A, B, C))
    names = ("2", "3", "4") if numbers else (None,) * 3
    return [
        line(O, C, dashed=True),
        *more,
        link(O, A, label=names[0]),
        link(A, B, label=names[1]),
        link(C, B, label=names[2]),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
    ]


# ------------------------------------------------------------------ the rule

CHAIN = (70.0, 26.0, 60.0, 46.0)  # the lesson's bars: s + l = 96, p + q = 106


def bars():
    """A four-bar linkage, its bars named by length: s, l, p, q."""
    O, A, B, C = map(complex, _linkage(CHAIN, 70.0))
    return Figure(
        line(O, C, dashed=True, label="l"),
        link(O, A, label="s"),
        link(A, B, label="p"),
        link(C, B, label="q"),
        ground_pivot(O),
        ground_pivot(C),
        pin(A),
        pin(B),
        paper_mm=(90, 60),
    )


def flat_crank():
    """The two triangles that a full turn must pass: the crank against the frame and along it."""
    found = []
    for shift, theta2, letter in ((0.0, 180.0, "a"), (96.0, 0.0, "b")):
        O, A, B, C = map(complex, _linkage(CHAIN, theta2))
        found += moved(
            [
                line(O, C, dashed=True),
                link(O, A, label="r_2"),
                link(A, B, label="r_3"),
                link(C, B, label="r_4"),
                ground_pivot(O, "O"),
                ground_pivot(C, "C"),
                pin(A, "A"),
                pin(B, "B"),
                dimension(A, C, "r_1+r_2" if theta2 else "r_1-r_2", offset=-13),
            ],
            shift,
        )
        found.append(note(shift + CHAIN[0] / 2 - 28j, f"({letter})"))
    return Figure(*found, paper_mm=(158, 75))


# ------------------------------------------------------------------ the four types


def four_types():
    """Figure 10: the bars 26, 46, 60, 70 with each of them as the frame, and what their pins describe."""
    drawings = [_with_paths(*case) for case in CASES.values()]
    found = []
    for number, elements in enumerate(drawings):
        origin = complex(FAR[number], 0.0)
        found += moved(elements, origin)
        found.append(note(origin + 30 - 80j, f"({'abcd'[number]})"))
    return Figure(*found, paper_mm=(165, 70))


FAR = (0.0, 130.0, 310.0, 460.0)  #: where the four types stand, from left to right

#: Frame, input, coupler, output; where the input is drawn. The shortest bar beside the frame, beside it, as
#: it, opposite it.
CASES = {
    "crank_rocker": ((70.0, 26.0, 60.0, 46.0), 70.0),
    "rocker_crank": ((60.0, 46.0, 70.0, 26.0), 68.0),
    "double_crank": ((26.0, 60.0, 46.0, 70.0), 75.0),
    "double_rocker": ((46.0, 60.0, 26.0, 70.0), 84.0),
}


def _with_paths(bars, theta2):
    """A linkage with the full circle or the arc of each of its two moving pins."""
    O, A, B, C = map(complex, _linkage(bars, theta2))
    way_A, way_B = _paths(bars)
    full = [abs(way[0] - way[-1]) < 8 and _turns(way, pivot) for way, pivot in ((way_A, O), (way_B, C))]
    paths = [
        circle(pivot, abs(way[0] - pivot), dashed=True) if turns else trace(tuple(way))
        for way, pivot, turns in zip((way_A, way_B), (O, C), full, strict=True)
    ]
    return _drawn(O, A, B, C, more=paths)


def _paths(bars):
    """All the places of A and of B in one mode of assembly, in the order of the motion."""
    r1, r2, r3, r4 = bars
    with np.errstate(invalid="ignore"):
        _, A, B, _ = _linkage(bars, np.arange(-180.0, 181.0, 2.0))
    if np.isfinite(B).all():
        return A, B
    if min(bars) == r3:
        A, B = _by_coupler(bars, np.arange(0.0, 361.0, 2.0))
        return A[np.argsort(np.angle(A))], r1 + (B - r1)[np.argsort(np.angle(B - r1))]
    good = np.isfinite(B)
    if min(bars) == r4:
        # A rocks while B turns: driven by the output.
        B = r1 + polar(r4, np.arange(-180.0, 181.0, 2.0))
        A = rrr(0 * B, B, r2, r3, 1)
        return A[np.argsort(np.angle(A))], B
    return A[good], B[good]


def _turns(way, pivot):
    """Return whether a path goes all round its pivot."""
    return abs(np.unwrap(np.angle(way - pivot))[[0, -1]] @ [-1, 1]) > 6


def _by_coupler(bars, theta3):
    """A and B of a linkage whose coupler has the angle theta3, degrees."""
    r1, r2, r3, r4 = bars
    arm = polar(float(r3), theta3)
    A = rrr(0 * arm, r1 - arm, r2, r4, 1)
    return A, A + arm


def crank_rocker():
    """A turn of the crank; the arc of the rocker's end."""
    return [_moving(CASES["crank_rocker"][0], t) for t in TURN]


def double_crank():
    """Both bars beside the frame turn."""
    return [_moving(CASES["double_crank"][0], t) for t in TURN]


def _moving(bars, theta2):
    O, A, B, C = map(complex, _linkage(bars, float(theta2)))
    ways = [trace(tuple(way)) for way in _paths(bars)]
    return Figure(*_drawn(O, A, B, C, more=ways), paper_mm=(100, 80))


def double_rocker():
    """The shortest bar is opposite the frame: it turns, its neighbours rock."""
    bars = CASES["double_rocker"][0]
    ways = [trace(tuple(way)) for way in _paths(bars)]
    found = []
    for t in TURN:
        A, B = _by_coupler(bars, float(t))
        found.append(Figure(*_drawn(0j, A, B, bars[0], more=ways), paper_mm=(100, 80)))
    return found


TRIPLE = (80.0, 50.0, 44.0, 60.0)  # s + l = 124, p + q = 110


def triple_rocker():
    """No bar turns: from one dead point to the other in one mode of assembly, and back in the other."""
    r1, r2, r3, r4 = TRIPLE
    limit = float(np.degrees(np.arccos((r1**2 + r2**2 - (r3 + r4) ** 2) / (2 * r1 * r2))))
    found = []
    for t in TURN:
        theta2 = 0.9999 * limit * float(np.cos(np.radians(t)))
        O, A, B, C = map(complex, _linkage(TRIPLE, theta2, 1 if t < 180 else -1))
        way = arc(O, r2, -limit, limit, dashed=True)
        found.append(Figure(*_drawn(O, A, B, C, more=[way]), paper_mm=(100, 95)))
    return found


def change_points():
    """The parallelogram: in any position, flat, and crossed, as it may leave the flat position."""
    r, long = 26.0, 66.0
    up = complex(polar(r, 62.0))
    parallelogram = _drawn(0j, up, up + long, complex(long), numbers=False)
    flat = _drawn(0j, complex(r), complex(r + long), complex(long), numbers=False)
    O, A, B, C = map(complex, _linkage((long, r, long, r), 62.0, -1))
    return Figure(
        *moved(parallelogram, 0j),
        *moved(flat, 104),
        *moved(_drawn(O, A, B, C, numbers=False), 216),
        note(40 - 26j, "(a)"),
        note(150 - 26j, "(b)"),
        note(252 - 26j, "(c)"),
        paper_mm=(160, 50),
    )


# ------------------------------------------------------------------ coupler curves

COUPLER = ((70.0, 26.0, 60.0, 46.0), 44.0, 48.0)  # bars, AP, beta


def _coupler_point(bars, AP, beta, theta2, side=1):
    _, A, B, _ = _linkage(bars, theta2, side)
    return A + (B - A) / bars[2] * polar(float(AP), beta)


def coupler_point():
    """A point of the coupler: its two constants AP and beta, and its curve."""
    bars, AP, beta = COUPLER
    O, A, B, C = map(complex, _linkage(bars, 70.0))
    P = complex(_coupler_point(bars, AP, beta, 70.0))
    turned = float(angle(B - A))
    return Figure(
        closed(_coupler_point(bars, AP, beta, FINE)),
        line(O, C, dashed=True, label="r_1"),
        link(O, A, label="r_2"),
        link(A, B, P),
        link(C, B, label="r_4"),
        angle_mark(A, turned, turned + beta, r"\beta", radius=15),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        pin(P, "P"),
        paper_mm=(110, 90),
    )


def atlas():
    """Curves of twelve points of one coupler, each drawn where its point is."""
    bars = COUPLER[0]
    O, A, B, C = map(complex, _linkage(bars, 70.0))
    along = (B - A) / abs(B - A)
    places = [along * complex(u, v) for u in (0, 30, 60) for v in (-38, -14, 14, 40)]
    curves = [closed(_coupler_point(bars, abs(z), float(angle(z / along)), FINE)) for z in places]
    return Figure(
        *curves,
        *_drawn(O, A, B, C, numbers=False),
        *[contact(A + z) for z in places],
        paper_mm=(130, 78),
    )


def coupler_moving():
    """The coupler point on its way."""
    bars, AP, beta = COUPLER
    curve = closed(_coupler_point(bars, AP, beta, FINE))
    found = []
    for t in TURN:
        O, A, B, C = map(complex, _linkage(bars, float(t)))
        P = complex(_coupler_point(bars, AP, beta, float(t)))
        plate = [curve, link(A, B, P)]
        found.append(Figure(*_plated(O, A, B, C, P, plate), paper_mm=(105, 90)))
    return found


def _plated(O, A, B, C, P, plate):
    return [
        *plate,
        link(O, A, label="2"),
        link(C, B, label="4"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        pin(P, "P"),
    ]


# ------------------------------------------------------------------ what coupler curves do


# The claw: bars r1 to r4, AP, beta; turned so that the straight side of its curve is upright, and mirrored so
# that it is passed downwards. In and out of the film between these angles of the crank, where the film goes
# with it.
CLAW = ((35.0, 11.0, 25.0, 22.5), 22.0, 70.0)
CLAW_IN, CLAW_OUT, UPRIGHT = 103.0, 258.0, complex(polar(1.0, -154.0))
FRONT, FILM = 9.0, 22.0  #: how far from its edge the film stands as seen from the front, and how wide, mm


def film_advance():
    """The claw goes down in the holes of the film, draws back, and comes up again."""
    return [_film_at(float(t)) for t in range(0, 360, 8)]


def _claw(theta2):
    """O, A, B, C and P of the claw, as they stand on the figure."""
    bars, AP, beta = CLAW
    points = (*_linkage(bars, theta2), _coupler_point(bars, AP, beta, theta2))
    return [np.conj(z * UPRIGHT) for z in points]


def _film_at(theta2):
    O, A, B, C, P = map(complex, _claw(theta2))
    top, bottom = (complex(_claw(t)[4]) for t in (CLAW_IN, CLAW_OUT))
    pitch, gone = (top - bottom).imag, (top - complex(_claw(min(max(theta2, CLAW_IN), CLAW_OUT))[4])).imag
    holes = [top.imag - gone + pitch * k for k in range(-3, 4)]
    window = (bottom.imag - 0.75 * pitch, top.imag + 0.75 * pitch)
    strip = [closed(_piece(top.real, one, other, window)) for other, one in pairwise(holes)]
    return Figure(
        closed(_claw(FINE)[4]),
        *strip,
        *_front(top.real + FRONT, holes, window),
        link(O, A, label="2"),
        link(A, B, P, label="3"),
        link(C, B, label="4"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        point(P, "P"),
        paper_mm=(100, 95),
    )


def _front(left, holes, window):
    """The film seen from the front: its outline, the perforations that the claw enters, and the pictures
    between them."""

    def box(start, end, low, high):
        low, high = (min(max(y, window[0]), window[1]) for y in (low, high))
        start, end = (start, end) if low < high else (0.0, 0.0)  # out of sight, on the outline
        return closed(
            [complex(left + x, y) for x, y in ((start, low), (end, low), (end, high), (start, high))]
        )

    perforations = [box(1.2, 3.6, y - 1.4, y + 1.4) for y in holes]
    pictures = [box(5.0, FILM - 2.0, lower + 1.4, upper - 1.4) for lower, upper in pairwise(holes)]
    return [box(0.0, FILM, *window), *perforations, *pictures]


def _piece(side, upper, lower, window):
    """The film between two holes, seen on its edge; what is outside the window is cut off."""
    hole, thick = 1.8, 1.2
    low, high = (min(max(y, window[0]), window[1]) for y in (lower + hole, upper - hole))
    return [complex(side, low), complex(side + thick, low), complex(side + thick, high), complex(side, high)]


BLADE = ((46.0, 14.0, 40.0, 24.0), 60.0, -60.0, -1)  #: bars, AP, beta, mode of assembly
TILT, CLOTH = complex(polar(1.0, -20.0)), -62.0


def cloth_cutter():
    """The blade comes down through the cloth, goes on with it while it cuts, and comes back above it."""
    bars, AP, beta, side = BLADE
    curve = _coupler_point(bars, AP, beta, FINE, side) * TILT
    through = curve[curve.imag < CLOTH].real
    left, right = float(through.min()) - 4, float(through.max()) + 4
    bed = CLOTH - 2.2
    found = []
    for t in TURN:
        O, A, B, C = (complex(z) * TILT for z in _linkage(bars, float(t), side))
        P = complex(_coupler_point(bars, AP, beta, float(t), side)) * TILT
        found.append(
            Figure(
                closed(curve),
                line(left - 22 + 1j * CLOTH, right + 26 + 1j * CLOTH, thin=False),
                rail(left - 22 + 1j * bed, left + 1j * bed),
                rail(right + 1j * bed, right + 26 + 1j * bed),
                link(O, A, label="2"),
                link(A, B, P, label="3"),
                link(C, B, label="4"),
                ground_pivot(O, "O"),
                ground_pivot(C, "C"),
                pin(A, "A"),
                pin(B, "B"),
                point(P, "P"),
                paper_mm=(105, 90),
            )
        )
    return found


PEDAL = (62.0, 22.0, 58.0, 24.0)  #: no bar can turn fully: s + l = 84, p + q = 82
TREAD, SWING = 95.0, 13.0  #: middle of the pedal's arm and half of its swing, degrees
SHEATH = complex(88, -30)  #: where the cable enters its sheath


def pedal():
    """A pedal, a rod, a lever with a cable: two rockers, and no turn is wanted."""
    return [_pedal_at(TREAD + SWING * float(np.cos(np.radians(t)))) for t in TURN]


def _pedal_at(theta2):
    O, A, B, C = map(complex, _linkage(PEDAL, theta2))
    foot = complex(polar(40.0, theta2 + 62.0))
    end = C + complex(polar(30.0, float(angle(B - C)) - 74.0))
    return Figure(
        capsule(O, foot, 4.0, 2.6),
        capsule(O, A, 4.0, 3.0),
        box(complex(-11, 1), complex(11, 4.5), "dark", at=foot, turned=theta2 - 28.0),
        capsule(C, end, 4.0, 2.6),
        capsule(C, B, 4.0, 3.0),
        capsule(A, B, 2.0, shade="white"),
        line(end, SHEATH, thin=False, label="c"),
        box(complex(-2.2, -12), complex(2.2, 0), at=SHEATH),
        note((A + B) / 2 + 4.5j, "3"),
        note((B + C) / 2 + 5, "4"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        pin(end, "D"),
        note(foot / 2 - 6, "2"),
        paper_mm=(125, 80),
    )


#: 2 : 1 : 2.5 : 2.5, the coupler carried on to twice its length.
STRAIGHT = (
    (28.0, 14.0, 35.0, 35.0),
    70.0,
    0.0,
)


def straight_line():
    """Hoecken's linkage: for half a turn of the crank, P goes along a line, nearly, and nearly at one
    speed."""
    bars, AP, beta = STRAIGHT
    curve = closed(_coupler_point(bars, AP, beta, FINE))
    found = []
    for t in TURN:
        O, A, B, C = map(complex, _linkage(bars, float(t)))
        P = complex(_coupler_point(bars, AP, beta, float(t)))
        found.append(
            Figure(
                curve,
                link(O, A, label="2"),
                link(A, B, label="3"),
                link(B, P),
                link(C, B, label="4"),
                ground_pivot(O, "O"),
                ground_pivot(C, "C"),
                pin(A, "A"),
                pin(B, "B"),
                point(P, "P"),
                paper_mm=(90, 95),
            )
        )
    return found


# ------------------------------------------------------------------ types to be named

#: Frame, input, coupler, output, and the angle of the input in degrees.
UNNAMED = (
    ((46.0, 60.0, 26.0, 70.0), 80.0),
    ((70.0, 26.0, 60.0, 46.0), 60.0),
    ((70.0, 40.0, 70.0, 40.0), 60.0),
    ((80.0, 50.0, 44.0, 60.0), 70.0),
    ((26.0, 46.0, 70.0, 60.0), 75.0),
    ((70.0, 46.0, 60.0, 26.0), 60.0),
)


def types_to_be_named():
    """Six linkages without a name, the input on the left pivot."""
    drawings = [unlettered(_drawn(*_linkage(bars_, at), numbers=False)) for bars_, at in UNNAMED]
    return Figure(*rows_of(drawings, 3, 100 + 80j), paper_mm=(165, 100))
