"""Havens planetary gear, constructed: solution. Each vector follows from those before it; so it is judged."""

import numpy as np

from coursework.degrees import polar
from coursework.figures import Figure, circle, contact, ground_pivot, link, pin, slot_link, vector
from coursework.figures.polygons.hand_drawn import LEAST_MM, MOST_MM, TOLERANCE_MM, on_paper, vector_fault
from coursework.figures.polygons.own_drawing import DrawnStroke, OwnDrawing
from coursework.marking.drawn_polygons import read_off, scale_for, to_paper
from coursework.solution import Judged, given, judge, mistake, stable

from ._havens import *

VECTORS = ("v10", "v40", "v14", "v24", "v20", "v30")
_NAMES = {name: rf"\vec V_{{{name[1]}/{name[2]}}}" for name in VECTORS}
_WIDTH = 2 * TOLERANCE_MM


def _pose(d, r2, r3, b, theta1):
    """Unit vectors of the crank and of the guide; distances O4A1 and O4B2; unit vector from B2 to I. From O1,
    mm."""
    crank = polar(1.0, theta1)
    arm = d + (r2 + r3) * crank
    along = arm / abs(arm)
    line = r3 * crank - (r2 + r3) * crank - b * along
    return crank, along, abs(arm), abs(arm) + b, line / abs(line)


def _images(_pose, r2, r3, omega1):
    """The six velocities, complex, mm/s."""
    v10 = 1j * omega1 * (r2 + r3) * _pose[0]
    v40 = _guide_part(_pose, v10)
    v14 = v10 - v40
    v20 = _of_B2(_pose, v40, v14)
    # I is on S2, which turns with the guide; projected on B2 I, its velocity would have few digits where that
    # is the crank.
    omega2 = (v40 / (1j * _pose[1])).real / _pose[2]
    return v10, v40, v14, v14, v20, v10 - 1j * r2 * omega2 * _pose[0]


def _guide_part(pose, v10):
    """The projection on the perpendicular to the guide."""
    across = 1j * pose[1]
    return across * (v10 / across).real


def _of_B2(pose, v40, v24):
    """The guide carries B2 as it carries A1, in proportion to the distances; the slide comes on top."""
    return v24 + v40 * pose[3] / pose[2]


def _of_I(pose, v20):
    """Square to the crank, with the projection on B2 I of the velocity of B2."""
    across, line = 1j * pose[0], pose[4]
    return across * (v20 / line).real / (across / line).real


def kv(_images):
    """A round scale at which the arrows fit the box."""
    return scale_for(*_images)


def v10(_images, kv):
    return to_paper(_images[0], kv)


def v40(_images, kv):
    return to_paper(_images[1], kv)


def v14(_images, kv):
    return to_paper(_images[2], kv)


def v24(_images, kv):
    return to_paper(_images[3], kv)


def v20(_images, kv):
    return to_paper(_images[4], kv)


def v30(_images, kv):
    return to_paper(_images[5], kv)


def why_v40():
    return "fixed_pivot"


def why_v14():
    return "slot"


def why_v24():
    return "translation"


def why_v20():
    return "composition"


def why_v30():
    return "equiprojectivity"


def rA(d, r2, r3, _pose):
    """Measured on the figure, or by the law of cosines."""
    return _pose[2]


def l4(_images, _pose, kv):
    """The arrow of the guide's point on paper, positive 90 degrees anticlockwise from O4A1."""
    return (_images[1] / (1j * _pose[1])).real / kv


def omega4(kv, l4, rA):
    return kv * l4 / rA


@stable(lambda omega1, r2, r3, _lag, kv: omega1 * (r3 + r2 * _lag) / kv)
def l3(_images, _pose, kv):
    """The arrow of I on paper, positive 90 degrees anticlockwise from O1I."""
    return (_images[5] / (1j * _pose[0])).real / kv


def omega3(kv, l3, r3):
    return kv * l3 / r3


UNITS = {"rA": "mm", "l4": "mm", "l3": "mm"}
SYMBOLS = {"rA": "r_A", "l4": r"\ell_4", "l3": r"\ell_3"}


@judge
def drawing(answers, d, r2, r3, b, theta1, omega1):
    """Arrows as components on paper, at any scale, each from the student's own ones before it; then what is
    read off them."""
    said = _verdicts(answers, d, r2, r3, b, theta1, omega1)
    of = {"omega4": "v40", "omega3": "v30"}
    # Sums of arrows that are all turned are right from them: those whose direction is laid off tell.
    return read_off(
        said, ("v10", "v40", "v30"), ("kv", *of), [name for name, arrow in of.items() if arrow not in answers]
    )


def _verdicts(answers, d, r2, r3, b, theta1, omega1):
    pose = _pose(d, r2, r3, b, theta1)
    right = dict(zip(VECTORS, _images(pose, r2, r3, omega1), strict=True))
    drawn = {name: on_paper(*answers[name]) for name in VECTORS if name in answers}
    stated = float(answers["kv"]) if "kv" in answers else None
    longest = max(map(abs, right.values()))
    is_scale = stated is not None and stated > 0 and longest <= MOST_MM * stated
    said = {"kv": Judged(1.0 if is_scale else 0.0)} if stated is not None else {}
    if is_scale:
        scale = stated
    elif _WIDTH < abs(drawn.get("v10", 0)) < MOST_MM:
        scale = abs(right["v10"]) / abs(drawn["v10"])
    elif stated is not None and "v10" in drawn:
        scale = scale_for(*right.values())  # nothing tells it; that of the solution is as good as any
    else:  # nothing is drawn: the values that are right are right all the same
        values = _values(answers, pose, right, {}, {}, scale_for(*right.values()), r3)
        return said | {name: verdict for name, verdict in values.items() if verdict.share == 1.0}
    if longest / scale < LEAST_MM:
        return dict.fromkeys(
            ("kv", *drawn) if stated is not None else drawn, Judged(0.0, "too_small")
        ) | _values(answers, pose, right, {}, said, scale, r3)
    for name, vector_ in drawn.items():
        said[name] = _judged(name, vector_, drawn, right[name] / scale, pose, said)
    return said | _values(answers, pose, right, drawn, said, scale, r3)


def overlay(answers, d, r2, r3, b, theta1, omega1, kv):
    """The student's arrows over the right ones, all from one point: what slides along the guide, from what
    turns with it."""
    pose = _pose(d, r2, r3, b, theta1)
    right = dict(zip(VECTORS, _images(pose, r2, r3, omega1), strict=True))
    drawn = {name: on_paper(*answers[name]) for name in VECTORS if name in answers}
    stated = float(answers.get("kv", 0))
    scale = stated if 0 < max(map(abs, right.values())) <= MOST_MM * stated else kv
    right = {name: z / scale for name, z in right.items()}
    if not drawn:
        return None

    def stroke(vectors, name):
        of_guide = vectors.get("v40", right["v40"])
        start = {"v14": of_guide, "v24": of_guide * pose[3] / pose[2]}.get(name, 0j)
        return start, start + vectors[name]

    own = {name: stroke(drawn, name) for name in drawn}
    return OwnDrawing(
        [stroke(right, name) for name in VECTORS],
        [DrawnStroke(*ends, name) for name, ends in own.items()],
        {
            _NAMES[name]: end if name in ("v10", "v40", "v20", "v30") else (start + end) / 2
            for name, (start, end) in own.items()
        },
    )


#: The vectors from which each is constructed.
_FROM = {
    "v10": (),
    "v40": ("v10",),
    "v14": ("v10", "v40"),
    "v24": ("v14",),
    "v20": ("v40", "v24"),
    "v30": ("v20",),
}


def _constructed(name, drawn, pose):
    """A vector as it follows from the student's own."""
    match name, [drawn[n] for n in _FROM[name]]:
        case "v40", [v10]:
            return _guide_part(pose, v10)
        case "v14", [v10, v40]:
            return v10 - v40
        case "v24", [v14]:
            return v14
        case "v20", [v40, v24]:
            return _of_B2(pose, v40, v24)
        case _, [v20]:
            return _of_I(pose, v20)


def _judged(name, found, drawn, right, pose, said):
    """Right where it should be; or as it follows from the student's own, which may be wrong."""
    faults = [vector_fault(found, right, _WIDTH)]
    if faults[0] and _FROM[name] and all(n in drawn for n in _FROM[name]):
        # What is off along B2 I is off more across it.
        width = _WIDTH / (abs((1j * pose[0] / pose[4]).real) if name == "v30" else 1.0)
        own = _constructed(name, drawn, pose)
        if abs(own) > _WIDTH:  # nothing follows from arrows that are not drawn
            faults.insert(0, vector_fault(found, own, width))
    if not all(faults):
        wrong_before = any(said[n].share != 1 or said[n].follows for n in _FROM[name] if n in said)
        return Judged(follows=bool(faults[-1]) and wrong_before)
    names = [*_special(name, found, drawn, pose), *(f"vector_{kind}" for kind in faults)]
    names = list(dict.fromkeys(names))
    return Judged(0.0, names[0], also=tuple(names[1:]))


def _special(name, found, drawn, pose):
    """Mistakes of which more can be told."""
    if name == "v20" and "v40" in drawn and abs(found - _of_B2(pose, drawn["v40"], 0)) <= _WIDTH:
        yield "slide_forgotten"
    if (
        name == "v20"
        and {"v24", "v40"} <= drawn.keys()
        and abs(found - drawn["v24"] - drawn["v40"]) <= _WIDTH
    ):
        yield "distance_forgotten"


def _values(answers, pose, right, drawn, said, scale, r3):
    """What is read off: to 2 mm of the drawing, a tenth at most, or from the student's own."""
    found = {}
    for name, of, across, radius in (("omega4", "v40", pose[1], pose[2]), ("omega3", "v30", pose[0], r3)):
        if name not in answers:
            continue
        value = float(answers[name])
        ideal = (right[of] / (1j * across)).real / radius
        near = min(2 * scale / radius, 0.1 * abs(ideal))
        own = (drawn[of] / (1j * across)).real * scale / radius if of in drawn else ideal
        if abs(value - ideal) <= near:
            found[name] = Judged()
        elif of in said and abs(value - own) <= scale / radius + 0.01 * abs(own):
            found[name] = Judged(follows=said[of].share != 1 or said[of].follows)
        elif min(abs(value + ideal), abs(value + own)) <= near:
            found[name] = Judged(0.0, "value_sense")
        elif min(abs(value * scale - ideal), abs(value * scale - own)) <= near:
            found[name] = Judged(0.0, "scale_forgotten")
        else:
            found[name] = Judged(0.0)
    return found


@mistake("why_v24")
def A1_and_B2_of_one_velocity():
    return "fixed_pivot"


@mistake("why_v30")
def no_slip_gives_the_length():
    return "no_slip"


@mistake("v10", "v40", "v14", "v24", "v20", "v30")
def vector_length(v10, v40, v14, v24, v20, v30):
    return 1.6 * v10, v40, v14, v24, v20, v30


@mistake("v10", "v40", "v14", "v24", "v20", "v30")
def vector_direction(v10, v40, v14, v24, v20, v30):
    turned = np.stack([-v40[..., 1], v40[..., 0]], axis=-1)
    return v10, turned, v14, v24, v20, v30


@mistake("v10", "v40", "v14", "v24", "v20", "v30", kind="sign")
def vector_sense(v10, v40, v14, v24, v20, v30):
    return v10, v40, -v14, v24, v20, v30


@mistake("v10", "v40", "v14", "v24", "v20", "v30")
def vector_vector(v10, v40, v14, v24, v20, v30):
    turned = np.stack([-v30[..., 1], v30[..., 0]], axis=-1)
    return v10, v40, v14, v24, v20, 1.8 * turned


@mistake("v20")
def slide_forgotten(v20, v24):
    return v20 - v24


@mistake("v20")
def distance_forgotten(v24, v40):
    return v24 + v40


@mistake("kv", "v10", "v40", "v14", "v24", "v20", "v30")
def too_small(kv, v10, v40, v14, v24, v20, v30):
    return 10 * kv, v10 / 10, v40 / 10, v14 / 10, v24 / 10, v20 / 10, v30 / 10


@mistake("omega4", "omega3", kind="sign")
def value_sense(omega4, omega3):
    return -omega4, -omega3


@mistake("omega4", "omega3")
def scale_forgotten(omega4, omega3, kv):
    return omega4 / kv, omega3 / kv


def figure(d, r2, r3, b, theta1, omega1):
    """The six velocities at their points, at one scale."""
    pose = _pose(d, r2, r3, b, theta1)
    crank, along, *_ = pose
    e = r2 + r3
    A1, I = e * crank, r3 * crank
    B2 = A1 + b * along
    v10, v40, v14, v24, v20, v30 = _images(pose, r2, r3, omega1)
    scale = 0.9 * e / max(map(abs, (v10, v40, v20, v30)))
    return Figure(
        slot_link(complex(-d), B2 + 0.25 * e * along),
        circle(0j, r3),
        circle(A1, r2),
        link(0j, A1),
        vector(A1, scale * v10, "V_{1/0}"),
        vector(A1, scale * v40, "V_{4/0}"),
        vector(A1, scale * v14, "V_{1/4}"),
        vector(B2, scale * v24, "V_{2/4}"),
        vector(B2, scale * v20, "V_{2/0}"),
        vector(I, scale * v30, "V_{3/0}"),
        contact(I, "I"),
        ground_pivot(complex(-d), "O_4"),
        ground_pivot(0j, "O_1"),
        pin(A1, "A_1"),
        pin(B2, "B_2"),
        paper_mm=(108, 70),
    )


def residual(d, r2, r3, b, theta1, omega1, kv, v10, v40, v14, v24, v20, v30, omega4, omega3):
    """Wheel 2 as one body that turns as the guide does about A1; no slip at I, by the rates."""
    crank = np.exp(1j * np.radians(theta1))
    A1 = (r2 + r3) * crank
    O4_A1 = d + A1
    B2 = A1 + b * O4_A1 / abs(O4_A1)
    turn = omega1 * (A1 / O4_A1).real
    z10, z40, z14, z24, z20, z30 = ((v[..., 0] + 1j * v[..., 1]) * kv for v in (v10, v40, v14, v24, v20, v30))
    size = (r2 + r3 + b) * abs(omega1)
    return (
        abs(z10 - 1j * omega1 * A1) / size,
        abs(omega4 - turn) / abs(omega1),
        abs(z40 - 1j * turn * O4_A1) / size,
        abs(z40 + z14 - z10) / size,
        abs(z24 - z14) / size,
        abs(z20 - z10 - 1j * turn * (B2 - A1)) / size,
        abs(z30 - z10 + 1j * turn * r2 * crank) / size,
        abs(z30 - 1j * omega3 * r3 * crank) / size,
    )


KNOWN = (
    # Crank upright: O4O1A1 is a 3-4-5 triangle; scale 4 mm/s for 1 mm.
    given(d=30, r2=25, r3=15, b=25, theta1=90, omega1=5).gives(
        kv=5,
        v10=(-40, 0),
        v40=(-25.6, 19.2),
        v14=(-14.4, -19.2),
        v24=(-14.4, -19.2),
        v20=(-52.8, 9.6),
        v30=(-24, 0),
        omega4=3.2,
        omega3=8,
    ),
)
