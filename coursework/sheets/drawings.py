"""Drawings of a solution: its own figure, and the polygons that it states."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from coursework.errors import BadCourse, BrokenFunction
from coursework.figures.polygons.construction import Construction
from coursework.figures.polygons.polygon import Polygon
from coursework.quantities.graph import call_on_quantities, graph_of

if TYPE_CHECKING:
    from coursework.course.variant import Variant
    from coursework.figures import Figure
    from coursework.figures.polygons.own_drawing import OwnDrawing


def solution_figure(variant: Variant) -> Figure | None:
    solution = variant.exercise.solution
    if solution.figure is None:
        return None
    figure: Figure = call_on_quantities(solution.figure, _quantities(variant, solution.figure))
    return figure.labelled(variant.exercise.symbols(variant.lang))


def stated_overlay(variant: Variant, answers: Mapping[str, Any]) -> OwnDrawing | None:
    """Return what the solution lays over its own construction: the drawing of these answers, by part as a
    judge has them; None where there is nothing to show."""
    overlay = variant.exercise.solution.overlay
    if overlay is None:
        return None
    drawing: OwnDrawing | None = call_on_quantities(overlay, _quantities(variant, overlay, answers=answers))
    return drawing


def _quantities(variant: Variant, function: Any, **more: Any) -> dict[str, Any]:
    """Return the quantities of a variant's solution, and those besides that a function of the solution
    needs."""
    values = dict(variant.walk) | more
    others = tuple(n for n in graph_of(function).node(function.__name__).arguments if n not in values)
    return {**values, **variant.quantities(others)}


@lru_cache(maxsize=16)  # a variant is rendered in every format before the next
def stated_polygons(variant: Variant) -> tuple[Construction, ...]:
    """Return the polygons that the solution states, less those in which nothing moves.

    Raises
    ------
    BadCourse
        It states something else, or a polygon that cannot be drawn.
    """
    solution = variant.exercise.solution
    if solution.polygons is None:
        return ()
    values = _quantities(variant, solution.polygons)
    try:
        stated = call_on_quantities(solution.polygons, values)
    except BrokenFunction:  # it names its file itself
        raise
    except BadCourse as fault:
        raise BadCourse(f"{solution.source}: {fault}") from fault
    if not isinstance(stated, (tuple, list)) or not all(isinstance(p, Polygon) for p in stated):
        raise BadCourse(
            f"{solution.source}: polygons(…) returns a tuple of Polygon; found {str(stated)[:60]}"
        )
    return tuple(Construction(p, variant.lang) for p in stated if p.size > 0)
