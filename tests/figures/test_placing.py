"""Labels and marks find their place: on no line, on no other label, on the side asked for."""

import cmath
import math
import random
import xml.etree.ElementTree as ET
from itertools import pairwise

import pytest
from drawn_svg import SVG, assert_readable, crossed, strokes, white_between_labels, white_to_lines
from figure_samples import SAMPLES, every_sample, four_bar, polar, six_link, slotted
from sweeps import seeds
from tables import each_row

from coursework.figures import (
    Figure,
    circle,
    dimension,
    ground_pivot,
    link,
    pin,
    point,
    rotation_arrow,
    section,
)


def drawn_at_random(kind, seed):
    rng = random.Random(f"{kind} {seed}")
    while True:
        try:
            if kind == "slotted":
                return slotted(rng.uniform(150, 300), rng.uniform(60, 140), rng.randrange(360))
            if kind == "four_bar":
                r1, r2, r3, r4 = (rng.uniform(40, 220) for _ in range(4))
                return four_bar(r1, r2, r3, r4, rng.randrange(360), rng.choice((1, -1)))
            r2, r3, r4 = rng.uniform(25, 60), rng.uniform(80, 160), rng.uniform(70, 130)
            return six_link(rng.uniform(80, 160), r2, r3, r4, rng.uniform(160, 300), rng.randrange(360))
        except ValueError:  # this linkage does not close
            continue


@seeds(10, 34)
@each_row("kind", ["slotted", "four_bar", "six_link"])
def test_no_label_sits_on_a_line_or_on_another_label(kind, seeds):
    for seed in seeds:
        assert_readable(drawn_at_random(kind, seed))


@seeds(10, 34)
@each_row("kind", ["slotted", "four_bar", "six_link"])
def test_there_is_white_between_a_label_and_all_else_that_is_drawn(kind, seeds):
    """A leader ends half a millimetre before its label, along its way: across it is nearer."""
    for figure in (drawn_at_random(kind, seed) for seed in seeds):
        assert white_to_lines(figure) > 0.25
        assert white_between_labels(figure) > 0.49


@every_sample
def test_sample_figures_are_readable_and_print_all_their_labels(name):
    figure = SAMPLES[name]()
    assert_readable(figure)
    printed = ET.fromstring(figure.svg()).findall(f"{SVG}g[2]/{SVG}text")
    assert len(printed) == len(figure.labels()) > 5


@each_row("name", SAMPLES)
def test_there_is_white_between_a_label_and_all_else_of_a_sample(name):
    assert white_to_lines(SAMPLES[name]()) > 0.25
    assert white_between_labels(SAMPLES[name]()) > 0.49


def test_a_label_goes_to_the_side_asked_for():
    for toward in (0, 90, 180, -90):
        figure = Figure(circle(0, 50), point(0, "P", toward=toward))
        box = figure.labels()[0]
        center = [points for points in strokes(figure) if len(points) == 91][-1]
        dot = sum(center[:-1]) / 90
        seen = complex(box.x + box.width / 2, box.y + box.height / 2) - dot
        assert abs(cmath.phase(seen.conjugate() / polar(1, toward))) < 0.05


def test_the_support_of_a_pivot_turns_away_from_a_link_that_hangs():
    def support(end):
        figure = Figure(link(0, end), ground_pivot(0))
        pivot = next(points[0] for points in strokes(figure) if len(points) == 4)
        hatched = [points for points in strokes(figure) if len(points) == 2][1]
        return (sum(hatched) / 2 - pivot).imag  # y down

    assert support(60j) > 1
    assert support(-60j) < -1


def test_a_dimension_line_keeps_clear_of_a_link_on_its_outer_side():
    for side in (1, -1):
        figure = Figure(
            dimension(0, 100, "r_1"),
            link(0, 50 - 30j * side),
            link(50 - 30j * side, 100),
            point(50 + 90j * side),
        )
        drawn = list(zip(strokes(figure), ET.fromstring(figure.svg())[1], strict=True))
        a = next(p[0] for p, _ in drawn if len(p) == 2 and p[0].imag == p[1].imag)
        bars = [p for p, item in drawn if item.get("stroke-width") == "0.6"]
        ends = [z for p in bars for z in p]
        assert len(ends) == 4
        # y down: the link hangs below its pivots for side 1, and the line is above them.
        pivots = ends[0].imag
        assert (pivots - a.imag) * side > 5


def test_a_leader_reaches_a_label_that_has_no_room_nearby():
    def figure(*more):
        fan = [link(0, polar(60, k * 30)) for k in range(12)]
        return Figure(*fan, *more)

    crowded, bare = figure(pin(0, "O")), figure(pin(0))
    assert_readable(crowded)
    assert len(strokes(crowded)) == len(strokes(bare)) + 1


def inside(z, polygon):
    """By the turning number."""
    turns = sum(cmath.phase((b - z) / (a - z)) for a, b in pairwise([*polygon, polygon[0]]))
    return round(turns / math.tau) != 0


def test_hatching_stays_in_its_section_and_clear_of_its_label():
    figure = Figure(section((0, 60, 60 + 20j, 20 + 20j, 20 + 50j, 50j), "S_1"))
    *hatch, outline = strokes(figure)
    assert len(hatch) > 15
    for a, b in hatch:
        assert inside((a + b) / 2, outline[:-1])
        assert inside(a + (b - a) * 0.02, outline[:-1])
        assert inside(a + (b - a) * 0.98, outline[:-1])
        assert cmath.phase(b - a) == pytest.approx(-math.pi / 4, abs=0.1)
    (box,) = figure.labels()
    assert inside(complex(box.x, box.y), outline[:-1])
    assert crossed(figure) == []


def test_the_head_of_a_rotation_points_where_the_rotation_goes():
    def tip_and_base(start, end):
        figure = Figure(rotation_arrow(0, 50, start, end), point(0))
        head, dot = (points for points in strokes(figure) if len(points) in (4, 91))
        center = sum(dot[:-1]) / 90
        return [
            math.degrees(cmath.phase((z - center).conjugate())) for z in (head[0], (head[1] + head[2]) / 2)
        ]

    tip, base = tip_and_base(20, 160)
    assert tip == pytest.approx(160, abs=0.5)
    assert tip - 8 < base < tip - 2
    tip, base = tip_and_base(160, 20)
    assert tip == pytest.approx(20, abs=0.5)
    assert tip + 2 < base < tip + 8
