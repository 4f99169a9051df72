"""Drawings of a student, as the marker read them, over the right constructions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from coursework.figures.polygons.own_drawing import OwnDrawing, drawn_polygon
from coursework.marking.answers import read
from coursework.marking.judges import best_judged, is_scale, judges_of
from coursework.marking.mark import Mark
from coursework.sheets.drawings import stated_overlay, stated_polygons

if TYPE_CHECKING:
    from coursework.course.variant import Variant

_RIGHT = ("correct", "accepted", "follow_through")


def own_drawings(variant: Variant, marks: Mapping[str, Mark]) -> tuple[OwnDrawing, ...]:
    """Return the student's constructions over the right ones: what the solution lays over its own, else each
    polygon.

    Parameters
    ----------
    variant
        The variant, with a solution.
    marks
        The marks of the student's answers, by part.
    """
    if not any(part.judge and part.kind == "point" for part in variant.parts):
        return ()
    values = dict(_values(variant, marks))
    if variant.exercise.solution.overlay is None:
        return tuple(_polygons(variant, values))
    drawing = stated_overlay(variant, values)
    if drawing is None:
        return ()
    drawn = [replace(s, is_right=s.part in marks and marks[s.part].verdict in _RIGHT) for s in drawing.drawn]
    return (replace(drawing, drawn=drawn),)


def _values(variant: Variant, marks: Mapping[str, Mark]) -> Iterator[tuple[str, Any]]:
    """Yield the values of the answers to judged parts, of each the reading that the judge took."""
    readings = {part.id: read(variant, part, marks[part.id].answer) for part in variant.parts if part.judge}
    for name, _ in judges_of(variant):
        for part, verdict in best_judged(variant, name, readings).items():
            if readings[part].status == "read":
                yield part, readings[part].values[verdict.reading]


def _polygons(variant: Variant, values: Mapping[str, Any]) -> Iterator[OwnDrawing]:
    polygons = [construction.polygon for construction in stated_polygons(variant)]
    for polygon, parts in zip(polygons, _by_polygon(variant, len(polygons)), strict=True):
        symbols = {
            part.id: variant.exercise.spec.symbol(part.quantity) for part in parts if part.kind == "point"
        }
        points = {
            symbols[i]: complex(*values[i]) for i in symbols if i in values and symbols[i] in polygon.points
        }
        scales = [values[part.id] for part in parts if is_scale(part) and part.id in values]
        drawing = drawn_polygon(polygon, points, scales[0] if scales else None)
        if drawing:
            yield drawing


def _by_polygon(variant: Variant, count: int) -> list[list[Any]]:
    """Return the parts of each polygon: the scale and the points of one stand before those of the next."""
    groups: list[list[Any]] = [[] for _ in range(count)]
    place = 0
    for part in variant.parts:
        place += is_scale(part)
        if 0 < place <= count:
            groups[place - 1].append(part)
    return groups
