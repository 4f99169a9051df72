"""Cam with a flat-faced follower: lift, rates, where the faces touch, and how small the cam may be."""

import numpy as np

from coursework.degrees import polar, wrap
from coursework.figures import (
    Figure,
    angle_mark,
    circle,
    contact,
    ground_pivot,
    line,
    link,
    profile,
    rail,
    rotation_arrow,
    slider,
)
from coursework.kinematics.cams import rise_345, rise_dwell_return
from coursework.model import Driver, Exercise, Part, drawn

DWELL = 40  #: degrees at the top
_AROUND = np.arange(0, 360, 3)


def law(h, theta, beta):
    """Lift and its derivative by the cam angle, which is how far to the side the follower is touched."""
    share, way = rise_dwell_return(wrap(theta) / beta, DWELL / beta, 360 / beta)
    lift, slope, _ = rise_345(share)
    return h * lift, way * h * slope / np.radians(beta)


def least(h, beta):
    """The least of the lift and its second derivative together, on a grid."""
    u = np.linspace(0, 1, 101)
    lift, _, bend = rise_345(u)
    radians = np.radians(np.asarray(beta, dtype=float))[..., None]
    return h * (lift + bend / radians**2).min(axis=-1)


def cam_is_in_its_rise(u):
    return (u > 0.1) & (u < 0.9) & (abs(u - 0.5) > 0.03)


def cam_is_tightest_elsewhere(u):
    return abs(u - 0.78) > 0.08


def cam_bulges_all_around(Rb, least):
    return Rb + least > 4


def lift_is_visible(s, h):
    return s > 0.05 * h


def cam_is_no_larger_than_need_be(Rb, least):
    return Rb + least < 45


def follower_goes_round_with_the_cam_in_sight(q, h):
    return abs(q) > 0.15 * h


def law_bends_visibly(s2, h):
    return abs(s2) > 0.2 * h


def _outline(h, beta, Rb):
    """The cam at the angle 0, where its rise begins on top."""
    lift, slope = law(h, _AROUND, beta)
    return (slope + 1j * (Rb + lift)) * polar(1, -_AROUND)


def figure(law, h, beta, Rb, theta, omega):
    O, face = 0j, 1j * float(Rb + law[0])
    half = 1.1 * 15 * h / (8 * np.radians(beta))
    stem, length = 0.5 * Rb + 1.3 * h, 1.3 * Rb + 2.2 * h
    low, high = 1j * (Rb + h + 0.45 * stem), 1j * (Rb + h + 0.45 * stem + 0.6 * Rb)
    turn = -1 if omega < 0 else 1
    start = polar(Rb, 90 + theta)
    return Figure(
        profile(tuple(map(complex, _outline(h, beta, Rb) * polar(1, theta)))),
        circle(O, Rb, dashed=True),
        line(O, 1j * (Rb + 0.3 * h), dashed=True),
        line(O, start, dashed=True),
        angle_mark(O, 90, 90 + theta, r"\theta", radius=0.55 * Rb),
        link(face - half, face + half),
        link(face, face + 1j * length),
        slider((low + high) / 2, 90),
        rail(low, high),
        rail(high, low),
        contact(face + float(law[1]), "P"),
        rotation_arrow(O, Rb + 1.35 * h, 200 - 25 * turn, 200 + 25 * turn, r"\omega"),
        ground_pivot(O, "O", toward=-45),
        paper_mm=(110, 95),
    )


EXERCISE = Exercise(
    given={
        "h": drawn(8, 30, step=1, unit="mm"),
        "beta": drawn(60, 110, step=5, unit="deg"),
        "Rb": drawn(20, 110, step=1, unit="mm"),
        "rho_min": drawn(4, 15, step=1, unit="mm", shown=("Rb_min",)),
        "theta": drawn(5, 105, step=1, unit="deg"),
        "omega": drawn(-60, 60, unit="rad/s", nonzero=True),
    },
    helpers=(law, least),
    constraints=(
        cam_is_in_its_rise,
        cam_is_tightest_elsewhere,
        cam_bulges_all_around,
        cam_is_no_larger_than_need_be,
        lift_is_visible,
        follower_goes_round_with_the_cam_in_sight,
        law_bends_visibly,
    ),
    parts=(
        Part("s", unit="mm", points=1),
        Part("q", unit="mm", points=1),
        Part("v", unit="mm/s", points=1),
        Part("a", unit="mm/s^2", points=1),
        Part("q_max", unit="mm", points=1),
        Part("rho", unit="mm", points=1),
        Part("theta_c", unit="deg", points=2),
        Part("Rb_min", unit="mm", points=2),
    ),
    figure=figure,
    symbols={
        "Rb": "R_b",
        "rho_min": r"\rho_{\min}",
        "q_max": r"q_{\max}",
        "theta_c": r"\theta_c",
        "Rb_min": r"R_{b,\min}",
    },
    driver=Driver("theta", "omega", output="v"),
)
