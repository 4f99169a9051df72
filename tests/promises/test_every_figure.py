"""Every exercise's figures as sheets show them, over 200 variants: no label on a line, on another label, off
the paper."""

import math
import re
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest
import sweeps
from sweeps import seeds

import coursework
from coursework.figures import Figure, contact, ground_pivot, link, pin, point, wheel
from coursework.rendering import views
from coursework.rendering.renderer import renderer_of
from coursework.sheets.drawings import solution_figure

COURSE = coursework.open_course()
WITH_FIGURE = [n for n in COURSE.names if COURSE[n].spec.figure is not None]
SVG = "{http://www.w3.org/2000/svg}"

_RING = np.exp(2j * np.pi * np.arange(61) / 60)
_THING = re.compile(r'<path d="([^"]*)"|<circle cx="([^"]*)" cy="([^"]*)" r="([^"]*)"')
_STEP = re.compile(r"([MLA])([^MLAZ]*)|Z")


def arc(a, b, radius, clockwise):
    """Points of an SVG arc of less than half a turn, y down."""
    half = abs(b - a) / 2
    up = 1j * (b - a) / abs(b - a) * (1 if clockwise else -1)
    center = (a + b) / 2 + up * math.sqrt(max(0.0, radius**2 - half**2))
    turn = 2 * math.asin(min(1.0, half / radius)) * (1 if clockwise else -1)
    return center + (a - center) * np.exp(1j * turn * np.arange(21) / 20)


def points(way):
    found = []
    for command, text in _STEP.findall(way):
        numbers = [float(x) for x in text.split()]
        if command == "A":
            found += list(arc(found[-1], complex(*numbers[5:]), numbers[0], numbers[4] == 1))
        else:
            found.append(complex(*numbers) if command else found[0])
    return np.array(found)


def strokes(svg):
    """Both ends of every drawn piece of line, mm, y down, read back from the file alone."""
    drawing = svg[: svg.index("</g>")]
    ways = []
    for way, x, y, r in _THING.findall(drawing):
        ways.append(points(way) if way else complex(float(x), float(y)) + float(r) * _RING)
    return np.concatenate([w[:-1] for w in ways]), np.concatenate([w[1:] for w in ways])


def faults(figure):
    """What is wrong with the labels of a figure: pairs that overlap, labels on a line, labels off the
    paper."""
    boxes = figure.labels()
    if not boxes:
        return []
    x, y, width, height = np.array([box[1:] for box in boxes]).T
    low, high = np.stack([x, y]), np.stack([x + width, y + height])
    meets = np.triu((low[:, :, None] < high[:, None, :]).all(axis=0), 1)
    meets &= (low[:, None, :] < high[:, :, None]).all(axis=0)
    found = [f"{boxes[i].label} on {boxes[k].label}" for i, k in np.argwhere(meets)]
    a, b = strokes(figure.svg())
    half_x, half_y = width[:, None] / 2, height[:, None] / 2
    middle = (a + b) / 2 - ((x + width / 2) + 1j * (y + height / 2))[:, None]
    d = (b - a) / 2
    # A box and a segment are apart when some axis parts them: x, y, or square to the segment.
    apart = (abs(middle.real) >= half_x + abs(d.real)) | (abs(middle.imag) >= half_y + abs(d.imag))
    reach = half_x * abs(d.imag) + half_y * abs(d.real)
    apart |= abs(middle.real * d.imag - middle.imag * d.real) >= reach
    found += [f"{boxes[i].label} on a line" for i in np.flatnonzero((~apart).any(axis=1))]
    off = (low < -1e-9).any(axis=0) | (high > np.array(figure.size_mm)[:, None] + 1e-9).any(axis=0)
    return found + [f"{boxes[i].label} off the paper" for i in np.flatnonzero(off)] + mistaken(figure)


def mistaken(figure):
    """Names of points whose box is not nearer to their own point than to any other point that has a name, and
    that no leader ties to it."""
    named = {
        k: complex(it.p) * figure.scale
        for k, it in enumerate(figure.elements)
        if isinstance(it, (ground_pivot, pin, point, contact)) and it.label
    }
    layout, found = figure._layout, []
    for label, k in zip(layout.labels, layout.named, strict=True):
        if k in named and label.leader is None:
            low, high = label.corners
            gap = {z: from_box(z, low, high) for z in named.values()}
            others = [far for z, far in gap.items() if abs(z - named[k]) > 0.2]
            if gap[named[k]] >= min(others, default=math.inf):
                found.append(f"{label.label} nearer to another point")
    return found


def from_box(z, low, high):
    across = max(low.real - z.real, 0, z.real - high.real)
    return math.hypot(across, max(low.imag - z.imag, 0, z.imag - high.imag))


@sweeps.seeds(8, 100)
@pytest.mark.parametrize("name", WITH_FIGURE)
def test_no_label_sits_on_a_line_or_on_another_label_in_statement_or_solution(name, seeds):
    found = {}
    for variant in COURSE[name].variants(seeds):
        room = views.room(variant.handout())
        drawn = (variant.figure, solution_figure(variant))
        figures = [figure.fitted(*room) for figure in drawn if figure is not None]
        found[variant.seed] = [fault for figure in figures for fault in faults(figure)]
        # What fits its room is printed at its own size, so its letters are as large as they are drawn.
        assert all(np.less_equal(figure.size_mm, room).all() for figure in figures)
        # A figure free to grow fills its room in one direction, but for what labels take when they change
        # sides.
        free = [f for f in figures if f.fixed_scale is None and not f.bounded]
        assert all(np.divide(figure.size_mm, room).max() > 0.8 for figure in free)
    assert not {seed: bad for seed, bad in found.items() if bad}


def pages_of(sheet, paper):
    return len(re.findall(rb"/Type ?/Page\b", renderer_of(COURSE.folder).on(paper).pdf(sheet)))


@sweeps.seeds(2, 8)
@pytest.mark.parametrize("lang", ["fr", "en"])
@pytest.mark.parametrize("name", WITH_FIGURE)
def test_the_height_that_questions_leave_to_a_figure_costs_no_page(name, lang, seeds, monkeypatch):
    sheets = [v.in_language(lang).handout("Zoé Martin") for v in COURSE[name].variants(seeds) if v.figure]
    for paper in ("a4", "letter"):
        taken = [pages_of(sheet, paper) for sheet in sheets]
        with monkeypatch.context() as usual:
            usual.setattr(views, "_left", lambda questions, beside: 0.0)
            usual.setattr(views, "_by_paper", lambda paper, letters: 48.0)
            assert taken == [pages_of(sheet, paper) for sheet in sheets]


@pytest.mark.parametrize("name", ["flat_faced_cam", "mechanical_advantage", "coriolis"])
def test_a_slender_figure_is_larger_where_few_or_many_questions_leave_it_height(name):
    variants = [v for v in COURSE[name].variants(range(40)) if v.figure.aspect < 1]
    for variant in variants[:2]:
        room = views.room(variant.handout())
        usual = views.ROOM_BESIDE if room[0] == views.ROOM_BESIDE[0] else views.ROOM_ALONE
        assert variant.figure.fitted(*room).scale > 1.2 * variant.figure.fitted(*usual).scale
    assert variants


@pytest.mark.parametrize("name", WITH_FIGURE)
def test_letters_set_over_a_drawing_are_those_that_it_would_hold(name):
    figure = COURSE[name].variant(0).figure
    held = ET.fromstring(figure.svg()).findall(f".//{SVG}text")
    assert len(held) == len(figure.letters()) > 0
    for element, (x, y, runs) in zip(held, figure.letters(), strict=True):
        assert "".join(element.itertext()) == "".join(run.text for run in runs)
        assert (float(element.get("x")), float(element.get("y"))) == pytest.approx((x, y), abs=0.0051)
    bare = ET.fromstring(figure.bare_svg())
    assert not bare.findall(f".//{SVG}text")
    assert strokes(figure.bare_svg())[0] == pytest.approx(strokes(figure.svg())[0])


@seeds(12, 40)
def test_no_number_of_a_body_lies_on_the_area_of_another(seeds):
    for seed in (511, *seeds):
        figure = COURSE["mobility"].variant(seed).figure
        discs = {k: it for k, it in enumerate(figure.elements) if isinstance(it, wheel) and it.label}
        layout = figure._layout
        for label, k in zip(layout.labels, layout.named, strict=True):
            for other, disc in discs.items():
                inside = abs(label.center - disc.center * figure.scale) < disc.radius * figure.scale
                said = f"{label.label} on {disc.label}, {seed}"
                assert not (inside and k != other and label.leader is None), said


@pytest.mark.parametrize("name", WITH_FIGURE)
def test_a_figure_tells_positions_no_finer_than_tenths_of_a_millimetre_of_paper(name):
    figure = COURSE[name].variant(3).figure
    joints = re.findall(r'<circle cx="([^"]*)" cy="([^"]*)" r="1.1"', figure.svg())
    assert all(re.fullmatch(r"\d+(\.\d)?", number) for place in joints for number in place)
    drawn = [it for it in figure.elements if isinstance(it, (pin, ground_pivot))]
    assert len(joints) >= len({complex(it.p) for it in drawn}) - 1


def test_the_measure_sees_a_name_nearer_to_another_point():
    figure = Figure(pin(0, "O"), pin(30, "A"), scale=1)
    assert faults(figure) == []
    layout = figure._layout
    figure.__dict__["_layout"] = replace(layout, named=layout.named[::-1])
    assert "A nearer to another point" in faults(figure)


def test_the_measure_sees_a_label_on_a_line_and_on_another_label():
    """A label moved onto the bar that it names, and onto its neighbour, is found."""
    figure = Figure(link(0, 100, label="a"), pin(0, "O"))
    assert faults(figure) == []
    layout = figure._layout
    letter, other = sorted(layout.labels, key=lambda label: label.label, reverse=True)
    for center, fault in (
        (60 * layout.scale + 0j, "a on a line"),
        (other.center, "a on O"),
        (-30 + 0j, "a off the paper"),
    ):
        figure.__dict__["_layout"] = replace(layout, labels=(replace(letter, center=center), other))
        assert fault in faults(figure)
