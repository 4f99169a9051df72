"""Mechanisms of the course's figures as joint graphs, with the drawn positions of their joints (chapter 3).

Figures 13, 14 and 3, 7, 9, 10, 12 (the four-bar) are as the text and its equations describe them. The
pictures of the others are lost: their structure follows from their titles. In all of them body 1 is the
frame, body 2 the crank; joints bear the letters of the points.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from coursework.structure.joints import JointGraph, PlaneJoint

_KINDS = {"R": "revolute", "P": "prismatic", "H": "higher"}


def _graph(text: str) -> JointGraph:
    """Return the joint graph of a text: ``R1-2:O`` is a pivot of bodies 1 and 2 at O; P a slide, H a higher
    pair."""
    joints = []
    for word in text.split():
        bodies, _, at = word[1:].partition(":")
        joints.append(PlaneJoint(tuple(int(b) for b in bodies.split("-")), _KINDS[word[0]], at))
    return JointGraph.of(joints)


_FOUR_BAR = _graph("R1-2:O R2-3:A R3-4:B R1-4:C")
_SLIDER_CRANK = _graph("R1-2:O R2-3:A R3-4:B P1-4:B")
_SLOTTED = _graph("R1-2:O R2-3:A P3-4:A R1-4:C")
_SHAPER = _graph("R1-2:O R2-3:A P3-4:A R1-4:C R4-5:P R5-6:Q P1-6:Q")

#: By figure. Class, as the course counts it, with body 2 as the driver: see the tests.
LIBRARY: Mapping[str, JointGraph] = MappingProxyType(
    {
        "figure_3": _FOUR_BAR,
        "figure_4": _SLIDER_CRANK,
        "figure_5": _SLOTTED,
        "figure_6_cam": _graph("R1-2:O H2-3:A P1-3:B"),
        "figure_6_gears": _graph("R1-2:O H2-3:A R1-3:B"),
        "figure_7": _FOUR_BAR,
        "figure_8a_motor": _graph("R1-2:O"),
        "figure_8b_engine": _SLIDER_CRANK,
        "figure_8c_shaper": _graph("R1-2:O R2-3:A R3-4:B R4-5:C R1-5:D R4-6:E P1-6:F"),
        "figure_8d": _graph("R1-2:O R2-3:A R3-4:B R4-5:C R5-6:D R3-6:E R1-5:F"),
        "figure_9": _FOUR_BAR,
        "figure_10": _FOUR_BAR,
        "figure_11_film_advance": _FOUR_BAR,
        "figure_11_cloth_cutter": _FOUR_BAR,
        "figure_11_pedal": _FOUR_BAR,
        "figure_12": _FOUR_BAR,
        "figure_13": _graph("R1-2:O R2-3:A R3-4:B R1-4:C R4-5:D R5-6:E R1-6:F"),
        "figure_14": _graph("R1-2:O R2-3:A R3-4:B R1-4:C R3-6:E P5-6:E R1-5:D R5-7:F R7-8:G P1-8:G"),
        "figure_26a": _SLIDER_CRANK,
        "figure_26b": _SHAPER,
        "figure_26c": _SHAPER,
        "figure_27": _graph("R1-2:O R2-3:A R3-4-5:B R1-4:D R5-6:C P1-6:C"),
    }
)

_SHAPER_PLACES = {"O": 30 + 34j, "A": 47 + 44j, "C": 30, "P": 53.2 + 60j, "Q": 80 + 66j}
_FOUR_BAR_PLACES = {"O": 0j, "A": 14 + 24j, "B": 58 + 38j, "C": 66 + 0j}

#: Where a figure's joints are drawn, by letter: mm on paper. A figure like an earlier one is drawn as that
#: one is.
PLACES: Mapping[str, Mapping[str, complex]] = MappingProxyType(
    {
        "figure_3": _FOUR_BAR_PLACES,
        "figure_4": {"O": 0j, "A": 16 + 20j, "B": 68 + 0j},
        "figure_5": {"O": 0 + 26j, "A": 20 + 37j, "C": 0j},
        "figure_6_cam": {"O": 0j, "A": 3 + 14j, "B": 3 + 36j},
        "figure_6_gears": {"O": 0j, "A": 13 + 0j, "B": 33 + 0j},
        "figure_8a_motor": {"O": 0j},
        "figure_8c_shaper": {
            "O": 0j,
            "A": 8 + 18j,
            "B": 38 + 30j,
            "C": 48 + 8j,
            "D": 28 - 6j,
            "E": 82 + 0j,
            "F": 82 + 0j,
        },
        "figure_8d": {
            "O": 0j,
            "A": -6 + 18j,
            "B": 14 + 42j,
            "C": 62 + 44j,
            "D": 58 + 20j,
            "E": 26 + 20j,
            "F": 78 + 0j,
        },
        "figure_13": {
            "O": 0j,
            "A": 10 + 22j,
            "B": 42 + 32j,
            "C": 36 + 0j,
            "D": 58 + 18j,
            "E": 88 + 30j,
            "F": 82 + 0j,
        },
        "figure_14": {
            "O": 0j,
            "A": -12 + 18j,
            "B": 26 + 26j,
            "C": 34 + 0j,
            "E": 14 + 50j,
            "D": -22 + 40j,
            "F": 59 + 62.5j,
            "G": 92 + 54j,
        },
        "figure_26b": _SHAPER_PLACES,
        "figure_27": {
            "O": 0j,
            "A": 8 + 18j,
            "B": 46 + 34j,
            "D": 40 + 0j,
            "C": 86 + 26j,
        },
    }
)

#: Of fixed rails that are not level, by figure and letter: degrees.
RAILS: Mapping[str, Mapping[str, float]] = MappingProxyType({"figure_6_cam": {"B": 90.0}})
