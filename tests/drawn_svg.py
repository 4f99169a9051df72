"""A figure read back from its SVG, without the package's own geometry: its strokes, and what its labels
meet."""

import cmath
import math
import re
import xml.etree.ElementTree as ET
from itertools import pairwise

import numpy as np

SVG = "{http://www.w3.org/2000/svg}"


def arc_points(a, b, radius, clockwise):
    """Points of an SVG arc of less than half a turn, y down."""
    half = abs(b - a) / 2
    up = 1j * (b - a) / abs(b - a) * (1 if clockwise else -1)
    center = (a + b) / 2 + up * math.sqrt(max(0.0, radius**2 - half**2))
    turn = 2 * math.asin(min(1.0, half / radius)) * (1 if clockwise else -1)
    return [center + (a - center) * cmath.exp(1j * turn * k / 20) for k in range(21)]


def path_points(d):
    points = []
    for command, text in re.findall(r"([MLAZ])([^MLAZ]*)", d):
        numbers = [float(x) for x in text.split()]
        if command in "ML":
            points.append(complex(*numbers))
        elif command == "A":
            points += arc_points(points[-1], complex(*numbers[5:]), numbers[0], numbers[4] == 1)
        else:
            points.append(points[0])
    return points


def strokes(figure):
    """Every line of the drawing as a list of points, mm from the top left corner, y down."""
    found = []
    drawing = ET.fromstring(figure.svg()).findall(SVG + "g")[0]
    for item in drawing:
        if item.tag == SVG + "path":
            found.append(path_points(item.get("d")))
        else:
            center, radius = complex(float(item.get("cx")), float(item.get("cy"))), float(item.get("r"))
            found.append([center + radius * cmath.exp(1j * math.tau * k / 90) for k in range(91)])
    return found


def crossed(figure):
    """Labels that a stroke passes through."""
    boxes = figure.labels()
    bad = []
    for points in strokes(figure):
        for a, b in pairwise(points):
            steps = max(1, math.ceil(abs(b - a) / 0.25))
            for k in range(steps + 1):
                z = a + (b - a) * k / steps
                bad += [
                    box.label
                    for box in boxes
                    if 0 < z.real - box.x < box.width and 0 < z.imag - box.y < box.height
                ]
    return bad


def overlapping(figure):
    boxes = figure.labels()
    return [
        (a.label, b.label)
        for k, a in enumerate(boxes)
        for b in boxes[:k]
        if a.x < b.x + b.width and b.x < a.x + a.width and a.y < b.y + b.height and b.y < a.y + a.height
    ]


def white_to_lines(figure):
    """The least white between a label and a line that it does not meet, mm."""
    drawing = ET.fromstring(figure.svg()).findall(SVG + "g")[0]
    found = []
    for item, points in zip(drawing, strokes(figure), strict=True):
        half = float(item.get("stroke-width", 0)) / 2
        for box in figure.labels():
            middle, side = complex(box.x, box.y) + complex(box.width, box.height) / 2, (box.width, box.height)
            corners = [middle + complex(side[0] * x, side[1] * y) / 2 for x in (-1, 1) for y in (-1, 1)]
            ends = np.array(points)
            away = abs(ends.real - middle.real) - side[0] / 2, abs(ends.imag - middle.imag) - side[1] / 2
            found += [np.hypot(*np.maximum(away, 0)).min() - half]
            found += [_distances(corner, ends).min() - half for corner in corners]
    return min(found)


def _distances(point, ends):
    """The distances of a point from the segments between the points of a line, which are arrays."""
    ways = np.diff(ends)
    part = ((point - ends[:-1]) * ways.conj()).real / np.maximum(abs(ways) ** 2, 1e-300)
    return abs(point - ends[:-1] - np.clip(part, 0, 1) * ways)


def white_between_labels(figure):
    """The least white between two labels, across or up, mm."""
    boxes = figure.labels()
    return min(
        max(
            max(a.x, b.x) - min(a.x + a.width, b.x + b.width),
            max(a.y, b.y) - min(a.y + a.height, b.y + b.height),
        )
        for k, a in enumerate(boxes)
        for b in boxes[:k]
    )


def assert_readable(figure):
    assert overlapping(figure) == []
    assert crossed(figure) == []
    width, height = figure.size_mm
    assert width <= figure.paper_mm[0]
    assert height <= figure.paper_mm[1]
    for box in figure.labels():
        assert box.x >= 0
        assert box.y >= 0
        assert box.x + box.width <= width
        assert box.y + box.height <= height


def kinds(text):
    """Where the index and the exponent start, and where the label ends, em."""
    placed = [(run, text.start(k)) for k, run in enumerate(text.runs)]
    index = [x for run, x in placed if run.rise < 0]
    exponent = [x for run, x in placed if run.rise > 0 or set(run.text) == {"′"}]
    return min(index, default=None), min(exponent, default=None), max(x + run.width for run, x in placed)
