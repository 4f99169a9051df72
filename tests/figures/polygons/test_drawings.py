"""Polygons as drawings: at a round scale in their box, every label beside its own vector."""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from dataclasses import replace
from itertools import accumulate

import numpy as np
import pytest
from courses_polygons import (
    PLACES,
    constructions,
    every_exercise,
    variants,
)
from drawn_svg import SVG, crossed, kinds, overlapping
from sweeps import sampled

from coursework.figures import Figure, vector
from coursework.figures.polygons.construction import BOX_MM
from coursework.figures.text import SIZE, read
from coursework.rendering.pdf import _letters as letters_to_set


@every_exercise
def test_a_drawing_is_at_its_round_scale_in_its_box(name):
    for drawn in constructions(name):
        decade = drawn.scale / 10 ** math.floor(math.log10(drawn.scale) + 1e-9)
        assert min(abs(decade - k) for k in (1, 2, 5)) < 1e-9
        if drawn.polygon.scale is None:
            width, height = drawn.figure.size_mm
            assert width <= BOX_MM[0]
            assert height <= BOX_MM[1]
        else:
            assert drawn.scale == drawn.polygon.scale
            assert max(drawn.figure.size_mm) <= 170


@every_exercise
def test_a_millimetre_of_the_file_is_a_millimetre_on_paper(name):
    drawn = variants(name)[0].polygons()[0]
    root = ET.fromstring(drawn.svg())
    width, height = drawn.figure.size_mm
    assert root.get("width") == f"{width:g}mm"
    assert root.get("viewBox") == f"0 0 {width:g} {height:g}"
    dots = [complex(float(c.get("cx")), -float(c.get("cy"))) for c in root[1] if c.tag.endswith("circle")]
    longest = max(abs(p - q) for p in dots for q in dots)
    points = list(drawn.polygon.points.values())
    expected = max(abs(p - q) for p in points for q in points) / drawn.scale
    assert longest == pytest.approx(expected, abs=0.3)


@pytest.mark.parametrize("name", sampled(PLACES))
def test_no_label_lies_on_a_line_or_on_another(name):
    for drawn in constructions(name):
        for figure in (drawn.figure, drawn.steps[-1].figure.whole):
            assert overlapping(figure) == []
            assert crossed(figure) == []


def white(label, a, b):
    """Least distance from the box of a label to a segment."""
    gap = a + (b - a) * np.linspace(0, 1, 401) - label.center
    across, up = abs(gap.real) - label.width / 2, abs(gap.imag) - label.height / 2
    return np.hypot(across.clip(0), up.clip(0)).min()


def vectors_and_labels(figure):
    """The vectors of a drawing at true scale, and the labels that name one, each with its place among
    them."""
    at = {k: (one.p, one.p + one.v) for k, one in enumerate(figure.elements) if isinstance(one, vector)}
    placed = zip(figure._layout.labels, figure._layout.named, strict=True)
    return at, [(label, k) for label, k in placed if k in at]


def misread(figure):
    """Labels nearer to another vector than to their own, without a line that leads to it."""
    at, labels = vectors_and_labels(figure)
    whites = {label: {k: white(label, *ends) for k, ends in at.items()} for label, _ in labels}
    return [
        it.label for it, own in labels if not it.leader and min(whites[it].values()) < whites[it][own] - 0.1
    ]


@every_exercise
def test_a_label_without_a_leader_is_nearer_to_its_own_vector_than_to_another(name):
    found = {(drawn.polygon.kind, k): misread(drawn.figure) for k, drawn in enumerate(constructions(name))}
    assert not {which: labels for which, labels in found.items() if labels}


@every_exercise
def test_few_labels_of_vectors_need_a_leader_where_polygons_have_few_vectors(name):
    figures = [drawn.figure for drawn in constructions(name) if len(drawn.polygon.sides) <= 3]
    led = [label.leader is not None for figure in figures for label, _ in vectors_and_labels(figure)[1]]
    assert sum(led) <= 0.2 * len(led)


def test_the_measure_sees_a_label_beside_another_vector():
    figure = constructions("slider_crank")[0].figure
    assert misread(figure) == []
    layout = figure._layout
    (one, _), (other, _) = vectors_and_labels(figure)[1][:2]
    swapped = tuple(
        replace(it, center=other.center, leader=None) if it is one else it for it in layout.labels
    )
    moved = Figure(*figure.elements, scale=1)
    moved.__dict__["_layout"] = replace(layout, labels=swapped)
    assert misread(moved) == [one.label]


def laid(runs):
    """Where runs start when each goes back by what it says, from the start of the first, mm."""
    ends = accumulate(width - back for width, back in runs)
    return [end - width for end, (width, _) in zip(ends, runs, strict=True)]


@every_exercise
def test_labels_stack_index_and_exponent_alike_in_svg_in_outlines_and_in_pdf(name):
    for drawn in variants(name)[0].polygons():
        figure = drawn.figure
        texts = [read(label.label) for label in figure.labels()]
        shown = ET.fromstring(figure.svg()).findall(f".//{SVG}text")
        paths = iter(ET.fromstring(figure.outlined_svg()).findall(f"{SVG}g[2]/{SVG}path[@transform]"))
        for text, element, one in zip(texts, shown, figure.letters(), strict=True):
            index, exponent, _ = kinds(text)
            assert None in (index, exponent) or index == exponent
            widths = [SIZE * run.width for run in text.runs]
            starts = [SIZE * text.start(k) for k in range(len(text.runs))]
            backs = [-float(span.get("dx", 0)) for span in element] or [0]
            assert laid(list(zip(widths, backs, strict=True))) == pytest.approx(starts, abs=0.02)
            backs = [row[4] for row in letters_to_set(one, 0)[2]]
            assert laid(list(zip(widths, backs, strict=True))) == pytest.approx(starts, abs=0.02)
            lefts = []
            for piece in text.runs:
                moves = [next(paths).get("transform") for c in piece.text if not c.isspace()]
                lefts.append(float(re.match(r"translate\((\S+)", moves[0])[1]))
            assert [x - lefts[0] for x in lefts] == pytest.approx(starts, abs=0.02)


@every_exercise
def test_steps_grow_to_the_whole_in_one_frame(name):
    for drawn in variants(name)[0].polygons():
        sizes = {step.figure.size_mm for step in drawn.steps}
        pieces = [
            step.figure.svg().count("<path") + step.figure.svg().count("<circle") for step in drawn.steps
        ]
        assert len(sizes) == 1
        assert pieces == sorted(set(pieces))
        assert drawn.steps[-1].figure.svg() == drawn.steps[-1].figure.whole.svg()
        assert [step.number for step in drawn.steps] == list(range(1, len(pieces) + 1))
