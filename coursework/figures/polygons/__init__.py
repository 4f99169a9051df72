"""Velocity and acceleration polygons: stated by their sides, constructed step by step, judged when drawn by
hand."""

from coursework.figures.polygons.pieces import (
    crank_a,
    crank_v,
    guide_a,
    guide_v,
    polygon_of_accelerations,
    polygon_of_velocities,
    slider_a,
    slider_v,
    two_bars_a,
    two_bars_v,
)
from coursework.figures.polygons.polygon import (
    UNITS,
    Polygon,
    Side,
    Stage,
    image,
    normal,
    tangential,
    turning,
)

__all__ = [
    "UNITS",
    "Polygon",
    "Side",
    "Stage",
    "crank_a",
    "crank_v",
    "guide_a",
    "guide_v",
    "image",
    "normal",
    "polygon_of_accelerations",
    "polygon_of_velocities",
    "slider_a",
    "slider_v",
    "tangential",
    "turning",
    "two_bars_a",
    "two_bars_v",
]
