"""Cam with a roller follower: the motion by one of five laws, the pressure angle, the curvature and the
profile."""

import numpy as np

from coursework.degrees import polar, wrap
from coursework.figures import (
    Figure,
    angle_mark,
    circle,
    dimension,
    ground_pivot,
    line,
    link,
    pin,
    profile,
    rail,
    rotation_arrow,
    slider,
    wheel,
)
from coursework.kinematics.cams import LAWS, rise, rise_dwell_return
from coursework.model import Driver, Exercise, Part, chosen, detectable, drawn

SHAPES = ("convex", "concave", "undercut")
ENDS = ("acceleration_jumps", "jerk_jumps", "jerk_begins_at_zero")
_AROUND = np.arange(0, 360, 3)


def lifts(law, h, beta, delta, theta):
    """Lift and its first two derivatives by the cam angle in radians."""
    share, way = rise_dwell_return(wrap(theta) / beta, delta / beta, 360 / beta)
    lift, slope, bend, _ = rise(law, share)
    radians = np.radians(beta)
    return h * lift, way * h * slope / radians, h * bend / radians**2


def tightest(law, h, beta, delta, Rb, Rr, e):
    """The least radius by which the pitch curve is convex, on a grid."""
    law, h, beta, delta, Rb, Rr, e = (np.asarray(x)[..., None] for x in (law, h, beta, delta, Rb, Rr, e))
    s, s1, s2 = lifts(law, h, beta, delta, _AROUND)
    up, aside = np.sqrt((Rb + Rr) ** 2 - e**2) + s, s1 - e
    bend = up**2 + aside**2 + aside * s1 - up * s2
    return np.where(bend > 0, np.hypot(up, aside) ** 3 / np.where(bend > 0, bend, 1.0), np.inf).min(axis=-1)


def rise_dwell_and_return_fit_in_a_turn(beta, delta):
    return 2 * beta + delta <= 330


def follower_moves(theta, beta, delta):
    return (theta < beta) | ((theta > beta + delta) & (theta < 2 * beta + delta))


def follower_is_neither_beginning_nor_halfway(u):
    return (u > 0.1) & (u < 0.9) & (abs(u - 0.5) > 0.04)


def law_bends_visibly(f2, f3, law):
    return (abs(f2) > 0.5) & ((abs(f3) > 3) | (law == "parabolic"))


def offset_is_visible(e):
    return abs(e) >= 5


def pressure_angle_is_usual(phi):
    return (phi > 3) & (phi < 42)


def profile_has_no_cusp(tightest, Rr):
    return tightest > Rr + 4


def larger_roller_is_larger(R2, Rr, rho):
    return (Rr + 4 <= R2) & (abs(R2 / rho - 1) > 0.08)


def cam_is_bent_visibly(rho, rho_c):
    return (abs(rho) < 600) & (abs(rho_c) > 4)


def _outline(law, h, beta, delta, Rb, Rr, e, around):
    """The profile of the cam at the angle 0: the point of contact that each angle has, turned back."""
    s, s1, _ = lifts(law, h, beta, delta, around)
    centre = e + 1j * (np.sqrt((Rb + Rr) ** 2 - e**2) + s)
    inward = s1 - centre
    return (centre + Rr * inward / abs(inward)) * polar(1, -around)


def figure(law, h, beta, delta, Rb, Rr, e, theta, lifts):
    O, C = 0j, complex(e, np.sqrt((Rb + Rr) ** 2 - e**2) + lifts[0])
    cam = _outline(law, h, beta, delta, Rb, Rr, e, _AROUND) * polar(1, theta)
    top = np.sqrt((Rb + Rr) ** 2 - e**2) + h + 1.4 * Rr
    low, high = complex(e, top), complex(e, top + 0.8 * Rb)
    return Figure(
        profile(tuple(map(complex, cam))),
        circle(O, Rb, dashed=True),
        line(O, polar(Rb, 90 + theta), dashed=True),
        line(O, 1j * 0.95 * Rb, dashed=True),
        angle_mark(O, 90, 90 + theta, r"\theta", radius=0.5 * Rb),
        wheel(C, Rr),
        link(C, C + 1j * (h + 1.4 * Rr + 1.1 * Rb)),
        slider((low + high) / 2, 90),
        rail(low, high),
        rail(high, low),
        dimension(high.imag * 1j + 0.45j * Rb, high + 0.45j * Rb, "e", offset=0),
        line(O, 1j * (high.imag + 0.55 * Rb), dashed=True),
        rotation_arrow(O, 0.7 * Rb, 190, 240, r"\omega"),
        ground_pivot(O, "O", toward=-45),
        pin(C, "C"),
        paper_mm=(110, 95),
    )


EXERCISE = Exercise(
    given={
        "law": chosen(*LAWS),
        "h": drawn(12, 30, step=1, unit="mm"),
        "beta": drawn(60, 130, step=5, unit="deg"),
        "delta": drawn(20, 60, step=5, unit="deg"),
        "Rb": drawn(20, 60, step=1, unit="mm"),
        "Rr": drawn(6, 16, step=1, unit="mm"),
        "R2": drawn(lambda Rr: Rr + 4, 60, step=2, unit="mm", shown=("shape",)),
        "e": drawn(-15, 15, step=1, unit="mm"),
        "theta": drawn(5, lambda beta, delta: 2 * beta + delta - 5, step=1, unit="deg", positive=False),
        "omega": drawn(5, 40, unit="rad/s", positive=True),
    },
    helpers=(lifts, tightest),
    constraints=(
        rise_dwell_and_return_fit_in_a_turn,
        follower_moves,
        follower_is_neither_beginning_nor_halfway,
        offset_is_visible,
        profile_has_no_cusp,
        law_bends_visibly,
        pressure_angle_is_usual,
        larger_roller_is_larger,
        cam_is_bent_visibly,
        *(
            detectable(mistake, "s", "v", "a", "phi", "rho", "rho_c")
            for mistake in (
                "return_counted_from_its_beginning",
                "offset_on_the_other_side",
                "offset_left_out_of_the_angle",
                "lift_left_out_of_the_height",
                "radius_of_a_flat_face",
                "roller_added",
            )
        ),
    ),
    parts=(
        Part("ends", kind="choice", choices=ENDS, points=1),
        Part("s", unit="mm", points=1),
        Part("v", unit="mm/s", points=1),
        Part("a", unit="mm/s^2", points=1),
        Part("j", unit="mm/s^3", points=1, when=lambda law: law != "parabolic"),
        Part("jump", unit="mm/s^2", points=1, when=lambda law: law == "parabolic"),
        Part("phi", unit="deg", points=2),
        Part("rho", unit="mm", points=2),
        Part("rho_c", unit="mm", points=1),
        Part("shape", kind="choice", choices=SHAPES, points=1),
        Part("K", unit="mm", kind="vector", points=2),
    ),
    figure=figure,
    symbols={
        "law": "f",
        "Rb": "R_b",
        "Rr": "R_r",
        "R2": "R'_r",
        "rho_c": r"\rho_c",
        "jump": r"\Delta a",
        "phi": r"\varphi",
        "K": r"\overrightarrow{OK}",
    },
    driver=Driver("theta", "omega", output="v"),
)
