"""The figures of lessons show mechanisms that close, move as rigid bodies and are what they are called."""

from __future__ import annotations

import re
from itertools import pairwise

import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.figures.elements import bar, pin, point
from coursework.figures.marks import circle, line, note
from coursework.language.words import languages
from coursework.structure.grashof import linkage_type
from coursework.structure.library import LIBRARY
from coursework.structure.spatial_chains import FREEDOMS

FOLDER = coursework.open_course().folder
PLANE, MOBILITY, GRASHOF = (
    FOLDER.lesson_module(name)
    for name in ("plane_mechanisms", "mobility_and_groups", "grashof_and_coupler_curves")
)
LINKAGES = (
    "crank_rocker",
    "double_crank",
    "double_rocker",
    "triple_rocker",
    "coupler_moving",
    "film_advance",
    "cloth_cutter",
    "pedal",
    "straight_line",
)


def _sides(figure):
    """The lengths of the sides of each bar or plate, mm, in the order in which they are drawn."""
    bars = [element for element in figure.elements if isinstance(element, bar)]
    return np.array([abs(q - p) for one in bars for p, q in pairwise((*one.points, one.points[0]))])


def _place(figure, label):
    return next(e.p for e in figure.elements if isinstance(e, (pin, point)) and e.label == label)


@each_row("name", LINKAGES)
def test_bars_keep_their_lengths_in_motion(name):
    frames = getattr(GRASHOF, name)()
    sides = np.array([_sides(frame) for frame in frames])
    assert np.ptp(sides, axis=0) == pytest.approx(0.0, abs=1e-9)


@each_row("name", LINKAGES)
def test_a_moving_figure_has_no_jump(name):
    """From instant to instant, and from the last to the first, no pin goes far."""
    frames = getattr(GRASHOF, name)()
    ways = np.array([[_place(frame, label) for label in "AB"] for frame in (*frames, frames[0])])
    size = np.ptp(ways.real) + np.ptp(ways.imag)
    assert abs(np.diff(ways, axis=0)).max() < 0.15 * size


@each_row(
    ("name", "kind"),
    [
        ("crank_rocker", "crank-rocker"),
        ("rocker_crank", "rocker-crank"),
        ("double_crank", "double-crank"),
        ("double_rocker", "double-rocker"),
    ],
)
def test_each_of_the_four_types_is_what_it_is_called(name, kind):
    bars, _ = GRASHOF.CASES[name]
    assert linkage_type(*bars) == kind
    assert sorted(bars) == [26.0, 46.0, 60.0, 70.0]


def test_the_triple_rocker_breaks_the_rule():
    assert linkage_type(*GRASHOF.TRIPLE) == "triple-rocker"


def test_the_pedal_breaks_the_rule():
    assert linkage_type(*GRASHOF.PEDAL) == "triple-rocker"


def test_full_circles_are_drawn_where_a_pin_goes_round():
    """One in each of the two first drawings, two in that of the double crank, none in the last."""
    circles = [element.center for element in GRASHOF.four_types().elements if isinstance(element, circle)]
    assert len(circles) == 4
    left, right = GRASHOF.FAR[2], GRASHOF.FAR[3]
    assert sum(left <= center.real < right for center in circles) == 2


def test_the_flat_triangles_have_the_sides_of_the_rule():
    bars = GRASHOF.CHAIN
    pins = [e.p for e in GRASHOF.flat_crank().elements if isinstance(e, pin)]
    away, towards = (abs(A - C) for A, C in ((pins[0], complex(bars[0])), (pins[2], complex(bars[0] + 96))))
    assert (away, towards) == pytest.approx((bars[0] + bars[1], bars[0] - bars[1]))


def test_the_film_goes_one_way_by_one_pitch():
    """Of the holes of the strip, one moves on by the pitch while the claw is in, and none goes back."""
    angles = np.arange(0.0, 361.0)
    tip = np.array([complex(GRASHOF._claw(float(t))[4]) for t in angles])
    inside = (angles >= GRASHOF.CLAW_IN) & (angles <= GRASHOF.CLAW_OUT)
    assert (np.diff(tip[inside].imag) < 0).all()
    assert tip[inside].real.min() >= tip[~inside].real.max() - 0.2
    assert np.ptp(tip[inside].imag) == pytest.approx(26.7, abs=0.4)


def test_hoekens_point_keeps_to_a_line():
    bars, AP, beta = GRASHOF.STRAIGHT
    P = GRASHOF._coupler_point(bars, AP, beta, np.linspace(80.0, 280.0, 401))
    assert np.ptp(P.imag) < 0.01 * bars[1]
    assert np.ptp(P.real) > 4 * bars[1]


@each_row("number", [13, 14])
def test_a_joint_graph_is_that_of_its_mechanism(number):
    drawn = [bodies for bodies, _ in getattr(MOBILITY, f"_JOINTS_{number}")]
    assert sorted(drawn) == sorted(LIBRARY[f"figure_{number}"].pairs())


def test_the_tree_has_an_edge_less_than_bodies_and_three_edges_close_it():
    lines = [element for element in MOBILITY.spanning_tree().elements if isinstance(element, line)]
    assert sum(not one.dashed for one in lines) == 7
    assert sum(one.dashed for one in lines) == LIBRARY["figure_14"].counts.gamma


def test_the_third_crank_is_parallel_to_the_others():
    cranks = [e for e in MOBILITY.five_bars().elements if isinstance(e, bar)][:3]
    assert (
        len({complex(round((q - p).real, 9), round((q - p).imag, 9)) for p, q in (c.points for c in cranks)})
        == 1
    )


def test_the_trammels_point_is_on_its_ellipse():
    for figure in PLANE.trammel():
        P = next(e.p for e in figure.elements if getattr(e, "label", "") == "P")
        assert (P.real / 64) ** 2 + (P.imag / 24) ** 2 == pytest.approx(1.0)


def test_the_teeth_of_the_gears_do_not_overlap():
    """No corner of one outline is inside the other by more than a hair."""
    small, large = (np.array(e.points) for e in PLANE._gears()[:2])
    assert max(_depth(small, large), _depth(large, small)) < 0.25


def _depth(corners, outline):
    """How deep the deepest corner lies inside a polygon, mm."""
    p, q = outline[:-1], outline[1:]
    deepest = 0.0
    for z in corners:
        crosses = (p.imag > z.imag) != (q.imag > z.imag)
        with np.errstate(divide="ignore", invalid="ignore"):
            at = p.real + (q.real - p.real) * (z.imag - p.imag) / (q.imag - p.imag)
        if np.count_nonzero(crosses & (at > z.real)) % 2:
            side = q - p
            along = np.clip(((z - p) * side.conj()).real / np.maximum(abs(side) ** 2, 1e-12), 0, 1)
            deepest = max(deepest, abs(p + along * side - z).min())
    return deepest


@pytest.mark.parametrize("lang", languages())
def test_each_joint_that_is_drawn_has_its_letter_its_name_and_its_freedoms_in_the_table(lang):
    """The table has the joints in the order of the figures, by the same letters."""
    drawn, rows = {}, {}
    chains = FOLDER.lesson_module("chains_of_bodies")
    gallery = chains._gallery
    chains._gallery = lambda letters, *names, **more: (
        drawn.update(zip(letters, names, strict=True)) or gallery(letters, *names, **more)
    )
    try:
        figures = chains.joints_of_few_freedoms(), chains.joints_of_more_freedoms()
    finally:
        chains._gallery = gallery
    notes = [e.label for figure in figures for e in figure.elements if isinstance(e, note)]
    assert notes == [f"({letter})" for letter in drawn]
    text = (FOLDER.root / f"exercises/lessons/chains_of_bodies.{lang}.md").read_text("utf-8")
    for letter, name, free in re.findall(r"^\| \((\w)\) \| ([^|]+) \| ([^|]+) \|", text, re.MULTILINE):
        assert name
        free = re.sub("(with|avec).*", "", free)
        rows[letter] = len(re.findall(r"\\omega_\w|v_\w", free))
    assert rows == {letter: FREEDOMS[joint] for letter, joint in drawn.items()}
