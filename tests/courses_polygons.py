"""The exercises of the course that state polygons, and how their points follow from their positions."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import coursework
from coursework.language.words import languages

COURSE = coursework.open_course()


def polar(r, degrees):
    return r * np.exp(1j * np.radians(degrees))


def still(values):
    """The value of the middle sample, as a constant: a length of a body that does not change."""
    return values[len(values) // 2]


def crank_rod(end):
    def points(v):
        A = polar(v["r2"], v["theta2"])
        found = {"a": A, end: A + v["q"] + 1j * v["p"]}
        return found | ({"g": A + v["s3"] * (found[end] - A)} if "s3" in v else {})

    return points


def four_bar(v):
    A, coupler = polar(v["r2"], v["theta2"]), polar(v["r3"], v["theta3"])
    found = {"a": A, "b": A + coupler}
    return found | ({"g_3": A + v["s3"] * coupler} if "s3" in v else {})


def coupler_curve(v):
    return four_bar(v) | {"p": polar(v["r2"], v["theta2"]) + polar(v["AP"], v["theta3"] + v["beta"])}


def slider_extras(v):
    return four_bar(v) | {"p": v["r6"] + 0j}


def quick_return(v):
    B = four_bar(v)["b"]
    return four_bar(v) | {"c": B + polar(v["r5"], v["theta5"])}


def slotted(v):
    A = polar(v["r1"], v["theta1"]) + polar(v["r2"], v["theta2"])
    return {"a_2": A, "a_4": polar(still(v["rA"]), v["theta4"])}


def curved_slot(v):
    """As seen from D: the lever's point keeps the place on the lever at which the pin is now."""
    DA = polar(v["r2"], v["theta2"]) - v["r1"]
    return {"a": DA, "a_4": still(DA) * polar(1, v["theta4"] - still(v["theta4"]))}


def slotted_ram(v):
    return slotted(v | {"theta1": 90}) | {"p": polar(v["r4"], v["theta4"]), "c": v["xC"] + 1j * v["h"]}


def havens(v):
    A = polar(v["r2"] + v["r3"], v["theta1"])
    turned = v["theta4"] - still(v["theta4"]) + still(v["theta1"])
    return {
        "a_1": A,
        "a_4": polar(still(v["rA"]), v["theta4"]),
        "b_2": A + polar(v["b"], v["theta4"]),
        "i": A - polar(v["r2"], turned),
    }


def two_loops(v):
    D = polar(v["r5"], v["theta5"])
    return four_bar(v) | {"d": D, "e": D + polar(v["r6"], v["theta6"])}


def three_loops(v):
    A = polar(v["r2"], v["theta2"])
    return four_bar(v) | {
        "e": A + polar(v["r6"], v["theta6"]),
        "e_5": polar(still(v["d5"]), v["theta5"]),
        "f": polar(v["r5"], v["theta5"]),
        "g": v["x8"] + 0j,
    }


def toggle_press(v):
    """As seen from O the crank pin, from D the others: neither pivot moves."""
    return {"a": polar(v["r2"], v["theta2"]), "b": polar(v["r4"], v["theta4"]), "c": 1j * v["yC"]}


def jack(v):
    return {"a": polar(v["a"], v["theta4"]), "g": polar(v["c"], v["theta4"] + v["eta"])}


#: The given angle or length that moves the mechanism, that of its drive, the quantities that place it, its
#: points.
PLACES = {
    "slider_crank": ("theta2", "theta2", ("p", "q"), crank_rod("b")),
    "slider_crank_torque": ("theta2", "theta2", ("p", "q"), crank_rod("b")),
    "mechanical_advantage_slider": ("theta2", "theta2", ("p", "q"), crank_rod("b")),
    "quick_return_offset": ("theta2", "theta2", ("p", "q"), crank_rod("c")),
    "four_bar_motion": ("theta2", "theta2", ("theta3",), four_bar),
    "instant_centres": ("theta2", "theta2", ("theta3",), four_bar),
    "instant_centres_slider": ("theta2", "theta2", ("p", "q"), crank_rod("b")),
    "four_bar_torque": ("theta2", "theta2", ("theta3",), four_bar),
    "mechanical_advantage": ("theta2", "theta2", ("theta3",), four_bar),
    "coupler_curve": ("theta2", "theta2", ("theta3",), coupler_curve),
    "slider_extras": ("theta2", "theta2", ("theta3", "r6"), slider_extras),
    "quick_return": ("angle_OAB", "theta2", ("theta2", "theta3", "theta5"), quick_return),
    "toggle_press": ("phi", "theta2", ("theta2", "theta4", "yC"), toggle_press),
    "slotted_mechanism": ("theta2", "theta2", ("rA", "theta4"), slotted),
    "curved_slot": ("theta2", "theta2", ("theta4",), curved_slot),
    "quick_return_whitworth": ("theta2", "theta2", ("rA", "theta4", "xC"), slotted_ram),
    "quick_return_shaper": ("theta2", "theta2", ("rA", "theta4", "xC"), slotted_ram),
    "shaper_torque": ("theta2", "theta2", ("rA", "theta4", "xC"), slotted_ram),
    "havens_planetary": ("theta1", "theta1", ("rA", "theta4"), havens),
    "jack_mechanism": ("L", "L", ("theta4",), jack),
    "two_loop_linkage": ("theta2", "theta2", ("theta3", "theta5", "theta6"), two_loops),
    "three_loop_shaper": ("theta2", "theta2", ("theta3", "theta6", "theta5", "d5", "x8"), three_loops),
}
#: Rate and gain of the drive, where they are not those of crank 2.
DRIVES = {"havens_planetary": ("omega1", "alpha1"), "jack_mechanism": ("L_dot", "L_ddot")}
VARIANTS = 20
every_exercise = pytest.mark.parametrize("name", PLACES)
every_language = pytest.mark.parametrize("lang", languages())


@cache
def variants(name, lang="fr"):
    return COURSE[name].variants(range(VARIANTS), lang)


def constructions(name):
    return [drawn for variant in variants(name) for drawn in variant.polygons()]
