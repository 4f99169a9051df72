"""Coupler curve: where is a point of the coupler, how fast and which way does it go, and which curve does it
draw?"""

from itertools import permutations

import numpy as np

from coursework.degrees import polar
from coursework.figures import Figure, angle_mark, ground_pivot, line, link, note, pin, trace
from coursework.kinematics.dyads import rrr, side_of
from coursework.model import Driver, Exercise, Part, chosen, drawn

from ._crank_rocker import (
    bars,
    crank_off_the_frame,
    crank_turns,
    crank_turns_visibly,
    transmission_angle_from_30_to_150,
)

TURN = np.arange(0, 360, 5)
DRAWINGS = ("I", "II", "III", "IV")


def P(bars, r3, AP, beta):
    return bars[0] + polar(AP, beta) * bars[1] / r3


def curves(r1, r2, r3, r4, AP, beta, mode):
    """P's own curve, and those of other points: beta on the other side, the other mode, laid off at B.

    Shape (..., 4, crank angles).
    """
    r1, r2, r3, r4, AP, beta, side = (
        np.asarray(x)[..., None] for x in (r1, r2, r3, r4, AP, beta, side_of(mode))
    )
    A = polar(r2, TURN)
    along, mirrored = ((rrr(A, r1 + 0j, r3, r4, s) - A) / r3 for s in (side, -side))
    arm = polar(AP, beta)
    drawn_by = arm * along, arm.conjugate() * along, arm * mirrored, (r3 - arm) * along
    return np.stack([A + point for point in drawn_by], axis=-2)


def _outlines(curves):
    """Return the distances from the middle of its box to each curve, in directions 15 degrees apart."""
    middle = sum(
        unit * (part.max(axis=-1) + part.min(axis=-1)) / 2
        for unit, part in ((1, curves.real), (1j, curves.imag))
    )
    shifted = curves - middle[..., None]
    return np.stack([(shifted * polar(1, -way)).real.max(axis=-1) for way in range(0, 360, 15)], axis=-1)


def beta_makes_a_triangle(beta):
    return (abs(beta) >= 15) & (abs(abs(beta) - 90) >= 5)


def P_away_from_the_axes(P, r2):
    return (abs(P.real) > 0.3 * r2) & (abs(P.imag) > 0.3 * r2)


def curves_differ_visibly(curves):
    """Each two differ in their reach in some direction by a tenth of the larger one's size."""
    reach = _outlines(curves)
    apart = [
        abs(reach[..., one, :] - reach[..., other, :]).max(axis=-1)
        > 0.12 * np.maximum(reach[..., one, :].max(axis=-1), reach[..., other, :].max(axis=-1))
        for one in range(4)
        for other in range(one)
    ]
    return np.all(apart, axis=0)


def coupler_turns_visibly(omega3, omega2):
    return abs(omega3) > 0.08 * abs(omega2)


def P_moves_visibly_both_ways(v_P_x, v_P_y, r2, omega2):
    least = 0.12 * r2 * abs(omega2)
    return (abs(v_P_x) > least) & (abs(v_P_y) > least)


def _drawings(curves, arrangement, corner, width):
    """The four curves under the linkage, two by two and at one scale, each with its name on the left."""
    order = list(permutations(range(4)))[int(arrangement) - 1]
    sizes = [complex(np.ptp(c.real), np.ptp(c.imag)) for c in curves]
    widest, highest = max(z.real for z in sizes), max(z.imag for z in sizes)
    scale = min(0.38 * width / widest, 0.34 * width / highest)
    found = []
    for place, own in enumerate(order):
        row, column = divmod(place, 2)
        at = corner + (0.29 + 0.5 * column) * width - 1j * (0.5 + 1.25 * row) * scale * highest
        low, high = (complex(f(curves[own].real), f(curves[own].imag)) for f in (np.min, np.max))
        shown = [complex(z) for z in at + scale * (curves[own] - (low + high) / 2)]
        found.append(trace((*shown, shown[0]), dotted=False))
        found.append(note(at - 0.25 * width, rf"\mathrm{{{DRAWINGS[place]}}}"))
    return found


def figure(bars, P, curves, arrangement, r1, r2, r4, theta2, mode):
    O, A, C = 0j, complex(bars[0]), complex(r1)
    B, P = A + complex(bars[1]), complex(P)
    width = 1.25 * (r1 + r2)
    lowest = -0.2 * width - max(r2, -curves[0].imag.min(), r4 if mode == "crossed" else 0.0)
    return Figure(
        line(O, C, dashed=True, label="r_1"),
        link(O, A, label="r_2"),
        link(A, B, P),
        link(C, B, label="r_4"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        pin(P, "P"),
        angle_mark(O, 0, theta2, r"\theta_2"),
        *_drawings(curves, arrangement, (r1 - r2 - width) / 2 + 1j * lowest, width),
        paper_mm=(120, 120),
    )


EXERCISE = Exercise(
    given={
        "r1": drawn(120, 260, step=5, unit="mm"),
        "r2": drawn(30, 90, step=5, unit="mm"),
        "r3": drawn(100, 240, step=5, unit="mm"),
        "r4": drawn(80, 200, step=5, unit="mm"),
        "AP": drawn(lambda r3: 0.4 * r3, lambda r3: 1.2 * r3, step=5, unit="mm", positive=True),
        "beta": drawn(-80, 80, step=5, unit="deg"),
        "theta2": drawn(-175, 180, step=5, unit="deg"),
        "omega2": drawn(-20, 20, unit="rad/s"),
        "mode": chosen("open", "crossed"),
        "arrangement": drawn(1, 24, default=1, shown=False),
    },
    helpers=(bars, P, curves),
    constraints=(
        crank_turns,
        transmission_angle_from_30_to_150,
        crank_off_the_frame,
        crank_turns_visibly,
        beta_makes_a_triangle,
        P_away_from_the_axes,
        curves_differ_visibly,
        coupler_turns_visibly,
        P_moves_visibly_both_ways,
    ),
    parts=(
        Part("theta3", unit="deg", kind="angle", points=1),
        Part("xP", unit="mm", points=1),
        Part("yP", unit="mm", points=1),
        Part("omega3", unit="rad/s", points=1),
        Part("v_P_x", unit="mm/s", points=1),
        Part("v_P_y", unit="mm/s", points=1),
        Part("v_P", unit="mm/s", points=1),
        Part("direction", unit="deg", kind="angle", points=1),
        Part("curve", kind="choice", choices=DRAWINGS, points=2),
    ),
    figure=figure,
    symbols={
        "AP": "AP",
        "xP": "x_P",
        "yP": "y_P",
        "v_P_x": "v_{Px}",
        "v_P_y": "v_{Py}",
        "direction": r"\varphi_P",
        "arrangement": r"\mathrm{drawing}",
        "curve": r"\mathrm{curve}",
    },
    driver=Driver("theta2", "omega2", output="omega3"),
    surface_mm=(500, 400),
)
