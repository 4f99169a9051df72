"""Figures of the lesson on plane mechanisms: what they are, what they are made of, how one comes from
another."""

import numpy as np

from coursework.degrees import angle, polar
from coursework.figures import (
    Figure,
    angle_mark,
    arc,
    axes,
    centre_line,
    contact,
    dimension,
    ground_pivot,
    line,
    link,
    note,
    pin,
    rail,
    rotation_arrow,
    slider,
    slot_link,
    trace,
    vector,
    wheel,
)
from coursework.kinematics.dyads import rrp, rrr

from ._panels import TURN, arrows_both, closed, gear, moved, panels

WIDE = (150, 70)

# The four-bar linkage that the lesson follows: frame, crank, coupler, rocker in mm, and the crank's angle.
R1, R2, R3, R4, THETA2 = 70.0, 26.0, 60.0, 46.0, 70.0


def _pins(theta2=THETA2, r1=R1, r2=R2, r3=R3, r4=R4):
    """O, A, B, C of the four-bar linkage."""
    O, C = 0j, complex(r1)
    A = polar(r2, theta2)
    return O, complex(A), complex(rrr(A, C, r3, r4)), C


# ------------------------------------------------------------------ 1. what a plane mechanism is


def parallel_planes():
    """Three points of a four-bar linkage, each in its own plane, with its path; and the one drawing of them
    all."""
    O, A, B, C = _pins()
    P = A + (B - A) * (0.5 + 0.5j)
    paths = [
        [_pins(t)[1] for t in range(0, 360, 5)],
        [_pins(t)[2] for t in range(0, 360, 5)],
        [_coupler_point(t) for t in range(0, 360, 5)],
    ]
    elements = []
    for level, (path, here, name) in enumerate(zip(paths, (A, B, P), "ABP", strict=True)):
        up = 46j * (level + 1)
        elements += [*_plane(up, rf"\Pi_{level + 1}"), closed(_tilted(path, up)), pin(_seen(here, up), name)]
        elements.append(line(_seen(here, up), _seen(here, 0j), dashed=True))
    shadow = [closed(_tilted(path, 0j)) for path in paths]
    elements += [*_plane(0j, r"\Pi"), *shadow, link(_flat(A), _flat(P), _flat(B))]
    elements += [link(_flat(O), _flat(A)), link(_flat(C), _flat(B))]
    elements += [pin(_flat(z)) for z in (A, B, P)] + [ground_pivot(_flat(z)) for z in (O, C)]
    elements.append(vector(_seen(-40 - 30j, 0j), 30j, r"\vec{z}"))
    return Figure(*elements, paper_mm=(120, 58))


def _coupler_point(theta2):
    _, A, B, _ = _pins(theta2)
    return A + (B - A) * (0.5 + 0.5j)


def _seen(z, up):
    """A point of a level plane, seen from in front and above."""
    return complex(z.real + 0.45 * z.imag, 0.42 * z.imag) + up


def _flat(z):
    return _seen(z, 0j)


def _tilted(path, up):
    return tuple(_seen(z, up) for z in path)


def _plane(up, label):
    corners = [_seen(z, up) for z in (-40 - 34j, 100 - 34j, 100 + 74j, -40 + 74j)]
    return [closed(corners), note(corners[2] - 11 - 4j, label)]


# ------------------------------------------------------------------ 2. pairs


def freedoms():
    """A free body: two coordinates of a point and an angle."""
    A, B = 34 + 22j, 74 + 44j
    return Figure(
        axes(0j, 84),
        link(A, B, 48 + 52j, label="2"),
        line(A, complex(0, A.imag), dashed=True),
        line(A, complex(A.real, 0), dashed=True),
        pin(A, "A"),
        dimension(0j, complex(A.real, 0), "x_A", offset=-9),
        dimension(0j, complex(0, A.imag), "y_A", offset=9),
        angle_mark(A, 0, float(angle(B - A)), r"\theta_2", radius=24),
        paper_mm=(95, 62),
    )


def plane_pairs():
    """Pivot, slide, point contact; what each leaves free."""
    return Figure(*panels(_pivot(), _slide(), _contact(), across=66, down=30), paper_mm=WIDE)


def _pivot():
    A = 26 + 4j
    return [
        link(A, A - 24 - 10j, label="1"),
        link(A, A + 22 + 12j, label="2"),
        pin(A, "A"),
        rotation_arrow(A, 12, -150, 20, r"\theta"),
    ]


def _slide():
    p = 26 + 0j
    way = polar(1.0, 20.0)
    return [
        slot_link(p - 24 * way, p + 26 * way, label="1"),
        slider(p, 20),
        link(p, p + 22j * way, label="2"),
        *arrows_both(p - 12 * way + 8j * way, 8 * way, "s"),
    ]


def _contact():
    I = 26 - 4j
    return [
        wheel(I + 14j, 14, label="2"),
        link(I - 24, I + 26, label="1"),
        contact(I, "I"),
        centre_line(I - 8j, I + 36j, "n"),
        *arrows_both(I - 6j, 9, "s"),
        rotation_arrow(I + 14j, 18, 60, 140, r"\theta"),
    ]


# ------------------------------------------------------------------ 3. elements


def binary_elements():
    """Figure 1 of the notes: two pivots, a pivot and a slide, two slides."""
    return Figure(
        *panels(_two_pivots(), _pivot_and_slide(), _two_slides(), across=72, down=34), paper_mm=WIDE
    )


def _two_pivots():
    A, B = 4 - 12j, 48 + 16j
    return [link(A, B), pin(A, "A"), pin(B, "B"), dimension(A, B, "r", offset=10)]


def _pivot_and_slide():
    A = 14 + 16j
    way = polar(1.0, 12.0)
    foot = A - 1j * way * 28
    block = foot + 26 * way
    return [
        link(A, foot + 4 * way, block, weld=True),
        centre_line(foot - 14 * way, foot + 44 * way, r"\Delta"),
        slider(block, 12),
        pin(A, "A"),
        dimension(A, foot, "e", offset=-8),
        line(foot - 9 * way, foot, thin=True),
    ]


def _two_slides():
    corner = 10 - 16j
    first, second = polar(1.0, 8.0), polar(1.0, 63.0)
    p, q = corner + 34 * first, corner + 32 * second
    return [
        link(p, corner, q, weld=True),
        centre_line(corner - 8 * first, corner + 50 * first, r"\Delta_1"),
        centre_line(corner - 8 * second, corner + 46 * second, r"\Delta_2"),
        slider(p, 8),
        slider(q, 63),
        angle_mark(corner, 8, 63, r"\alpha", radius=20),
    ]


def ternary_element():
    """A plate of three pivots: two lengths and an angle."""
    A, B = 0j, 60 + 8j
    E = A + polar(46.0, float(angle(B - A)) + 52)
    return Figure(
        link(A, B, E),
        pin(A, "A"),
        pin(B, "B"),
        pin(E, "E"),
        dimension(A, B, "r_3", offset=-9),
        dimension(A, E, "r_6", offset=9),
        angle_mark(A, float(angle(B - A)), float(angle(E - A)), r"\beta", radius=18),
        paper_mm=(85, 60),
    )


# ------------------------------------------------------------------ 4. parameters


def parameters():
    """Figure 2 of the notes: the fixed lengths, the varying angles."""
    O, A, B, C = _pins()
    return Figure(
        line(O, C, dashed=True, label="r_1"),
        link(O, A, label="r_2"),
        link(A, B, label="r_3"),
        link(C, B, label="r_4"),
        angle_mark(O, 0, THETA2, r"\theta_2", radius=12),
        angle_mark(A, 0, float(angle(B - A)), r"\theta_3", radius=22),
        angle_mark(C, 0, float(angle(B - C)), r"\theta_4", radius=12),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        paper_mm=(105, 70),
    )


# ------------------------------------------------------------------ 5. inversions of the four-bar


def inversions():
    """One chain, each of its four bars held in turn."""
    return Figure(
        *panels(*[_held(bar) for bar in (1, 2, 3, 4)], across=96, down=24),
        paper_mm=(165, 60),
    )


def _held(bar):
    """The four-bar chain with one bar held: its two pins on the ground."""
    O, A, B, C = _pins()
    ends = {1: (O, C), 2: (O, A), 3: (A, B), 4: (C, B)}
    found = [link(*pair, label=str(n)) for n, pair in ends.items() if n != bar]
    found.append(line(*ends[bar], dashed=True, label=str(bar)))
    for name, place in zip("OABC", (O, A, B, C), strict=True):
        found.append(ground_pivot(place, name) if place in ends[bar] else pin(place, name))
    return found


# ------------------------------------------------------------------ 6. from pivot to slide


def pivot_to_slide():
    """A rocker; a block on an arc about the same centre; a block on a line, the centre at infinity."""
    return Figure(*panels(_rocker(), _curved_slot(), _straight(), across=98, down=40), paper_mm=(160, 66))


_CRANK, _ROD, _ARM, _AT = 18.0, 46.0, 40.0, 60.0


def _rocker():
    C = 52 - 30j
    A = complex(polar(_CRANK, _AT))
    B = complex(rrr(A, C, _ROD, _ARM))
    return [
        arc(C, _ARM, 55, 125, dashed=True),
        *_crank_and_rod(A, B),
        link(C, B, label="4"),
        ground_pivot(C, "C"),
        pin(B, "B"),
    ]


def _curved_slot():
    C = 52 - 30j
    A = complex(polar(_CRANK, _AT))
    B = complex(rrr(A, C, _ROD, _ARM))
    half = 2.9
    heading = float(angle(B - C))
    return [
        _slot_edge(C, _ARM + half, heading),
        _slot_edge(C, _ARM - half, heading),
        line(C, B, dashed=True, label="r_4"),
        *_crank_and_rod(A, B),
        slider(B, heading - 90, "4"),
        pin(B, "B"),
        contact(C, "C"),
    ]


def _slot_edge(center, radius, heading):
    steps = np.linspace(heading - 32, heading + 32, 25)
    return trace(tuple(center + polar(radius, steps)), dotted=False)


def _straight():
    A = complex(polar(_CRANK, _AT))
    B = complex(rrp(A, _ROD, 6.0))
    return [
        *_crank_and_rod(A, B),
        rail(B - 22, B + 16),
        slider(B, 0, "4"),
        pin(B, "B"),
        line(B - 14j, B - 34j, dashed=True),
        vector(B - 30j, -8j, r"C_\infty"),
    ]


def _crank_and_rod(A, B):
    return [link(0j, A, label="2"), link(A, B, label="3"), ground_pivot(0j, "O"), pin(A, "A")]


# ------------------------------------------------------------------ 7. inversions of the slider-crank


def slider_inversions():
    """The slider-crank chain with its line of slide, crank, rod and block held in turn."""
    drawings = (_engine(), _slotted_lever(), _swinging_cylinder(), _pump())
    return Figure(*panels(*drawings, across=122, down=24, columns=2, drop=66), paper_mm=(150, 110))


_O, _A, _B = 0j, complex(polar(20.0, 55.0)), complex(rrp(polar(20.0, 55.0), 58.0, 0.0))


def _engine():
    return [
        link(_O, _A, label="2"),
        link(_A, _B, label="3"),
        rail(_B - 18, _B + 14),
        slider(_B, 0, "4"),
        ground_pivot(_O, "O"),
        pin(_A, "A"),
        pin(_B, "B"),
        rotation_arrow(_O, 9, 100, 200),
    ]


def _slotted_lever():
    """The crank held: the rod turns about A, the guide about O."""
    return [
        slot_link(_O, 1.3 * _B, label="1"),
        link(_A, _B, label="3"),
        slider(_B, 0, "4"),
        line(_O, _A, dashed=True, label="2"),
        ground_pivot(_O, "O"),
        ground_pivot(_A, "A"),
        pin(_B, "B"),
        rotation_arrow(_A, 9, 30, 120),
    ]


def _swinging_cylinder():
    """The rod held: the crank turns about A, the block swings about B, the guide slides in it."""
    return [
        link(_O, 1.35 * _B, label="1"),
        link(_O, _A, label="2"),
        slider(_B, 0, "4"),
        line(_A, _B, dashed=True, label="3"),
        pin(_O, "O"),
        ground_pivot(_A, "A"),
        ground_pivot(_B, "B"),
        rotation_arrow(_A, 9, 60, 150),
    ]


def _pump():
    """The block held: the guide slides in it, the rod swings about B."""
    return [
        link(_O - 14, _O, label="1"),
        link(_O, 1.35 * _B),
        link(_O, _A, label="2"),
        link(_A, _B, label="3"),
        slider(_B, 0, "4"),
        pin(_O, "O"),
        pin(_A, "A"),
        ground_pivot(_B, "B"),
    ]


# ------------------------------------------------------------------ 8. other changes of pairs


def slotted_turning():
    """A crank whose block slides in a swinging lever: a turn of it."""
    return [_slotted_at(t) for t in TURN]


def _slotted_at(theta2):
    O, C = 44j, 0j
    A = O + complex(polar(20.0, theta2))
    way = (A - C) / abs(A - C)
    return Figure(
        slot_link(C, C + 74 * way, label="4"),
        link(O, A, label="2"),
        slider(A, float(angle(way)), "3"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        paper_mm=(80, 85),
    )


def scotch_yoke():
    """Two slides that follow each other: the yoke's motion is a sine."""
    return [_yoke_at(t) for t in TURN]


def _yoke_at(theta2):
    A = complex(polar(20.0, theta2))
    x = A.real
    foot = x - 34j
    return Figure(
        slot_link(x - 36j, x + 28j),
        link(foot, foot + 84, label="4"),
        link(0j, A, label="2"),
        slider(A, 90, "3"),
        rail(44 - 34j, 66 - 34j),
        slider(55 - 34j, 0),
        ground_pivot(0j, "O"),
        pin(A, "A"),
        paper_mm=(100, 70),
    )


def trammel():
    """A bar between two slides at right angles: each of its points draws an ellipse."""
    return [_trammel_at(t) for t in TURN]


def _trammel_at(theta):
    B, A = complex(40 * np.cos(np.radians(theta))), 1j * float(40 * np.sin(np.radians(theta)))
    P = A + 1.6 * (B - A)
    steps = np.radians(np.arange(0, 360, 5))
    ellipse = 64 * np.cos(steps) - 24j * np.sin(steps)
    return Figure(
        *[rail(way * a, way * b) for way in (1, 1j) for a, b in ((8, 48), (48, 8), (-48, -8), (-8, -48))],
        closed(ellipse),
        link(A, P, label="3"),
        slider(B, 0, "4"),
        slider(A, 90, "2"),
        pin(A, "A"),
        pin(B, "B"),
        contact(P, "P"),
        paper_mm=(105, 80),
    )


# ------------------------------------------------------------------ 9. higher pairs


def higher_pairs():
    """A cam and its follower; two gears."""
    return Figure(*moved(_cam(0.0), 0j), *moved(_gears(), 96 - 2j), paper_mm=WIDE)


def _cam(turned):
    """An eccentric cam with a pointed follower on the line through its pivot."""
    profile = _profile(turned)
    top = max((z for z in profile if abs(z.real) < 1.2), key=lambda z: z.imag)
    I = complex(0, top.imag)
    return [
        closed(profile),
        link(I, I + 40j),
        rail(I + 16j + 0j, I + 34j),
        rail(I + 34j, I + 16j),
        slider(I + 25j, 90, "3"),
        note(6 - 8j, "2"),
        ground_pivot(0j, "O"),
        contact(I, "I"),
        rotation_arrow(0j, 8, -40, 40),
    ]


def _profile(turned):
    """A heart-like cam: its radius goes smoothly from 11 to 29 mm."""
    phi = np.arange(0, 360, 3.0)
    return tuple(polar(20 - 9 * np.cos(np.radians(phi - 90)), phi + turned).tolist())


def _gears():
    small, large = 18.0, 27.0
    I = complex(small)
    return [
        closed(gear(0j, small, 12, turned=7.5)),
        closed(gear(complex(small + large), large, 18, turned=180 + 10 - 5)),
        ground_pivot(0j, "O_2"),
        ground_pivot(complex(small + large), "O_3"),
        contact(I, "I", toward=90),
        note(-9 + 6j, "2"),
        note(small + large + 12 + 10j, "3"),
    ]
