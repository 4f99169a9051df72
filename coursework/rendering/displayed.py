"""Objects that a notebook's cell displays: a mechanism in motion, a polygon under construction."""

from __future__ import annotations

from functools import lru_cache

from coursework.course.variant import Variant
from coursework.figures.polygons.construction import Construction
from coursework.rendering.renderer import builtin_renderer, renderer_of
from coursework.scenes.animation import Animation
from coursework.sheets.drawings import stated_polygons


class DisplayedAnimation(Animation):
    """An animation with its page."""

    def html(self, *, is_answered: bool = True) -> str:
        """Return one page with a handle and a slider for the driver's angle: it fetches nothing, and without
        script stands still. Before the questions are answered it shows the figure alone."""
        return renderer_of(self.variant.exercise.folder).motion_html(self, is_answered=is_answered)


class DisplayedConstruction(Construction):
    """A polygon with its piece of a page."""

    def html(self) -> str:
        """Equations, table, steps and whole drawing, as a piece of a web page."""
        return builtin_renderer().construction_html(self)

    def _repr_html_(self) -> str:
        return self.html()


@lru_cache(maxsize=16)
def displayed_polygons(variant: Variant) -> tuple[DisplayedConstruction, ...]:
    """Return the polygons that the solution of a variant states, drawn to scale.

    Raises
    ------
    NoSolution
        The course folder has no solutions.
    """
    return tuple(DisplayedConstruction(c.polygon, c.lang) for c in stated_polygons(variant))
