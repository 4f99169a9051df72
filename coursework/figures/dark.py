"""Colours of drawings on a dark page: a style sheet gives each colour of the palette its counterpart."""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import product

from coursework.figures.charts import COLOURS as SERIES
from coursework.figures.ink import BLACK, SHADES, TINT, WHITE
from coursework.figures.moving import COLOURS
from coursework.figures.plot import GRID, LINE, RIGHT, WRONG
from coursework.figures.polygons.own_drawing import BENEATH

_USED = re.compile(r'\b(fill|stroke)="(#\w+)"')
_ROOT = re.compile(r"<svg\b[^>]*>")

#: For each colour on white that on a dark page: lines and letters stand out by 4.5 to 1, and hues stay.
DARK = {
    WHITE: "#15181c",
    BLACK: "#e4e6e8",
    TINT: "#363d45",
    SHADES["mid"]: "#4d565f",
    SHADES["dark"]: "#666f79",
    SHADES["black"]: "#7d8690",
    SHADES["glass"]: "#1d3444",
    GRID: "#3c434b",
    LINE: "#a9c9e8",
    RIGHT: "#7fd0a3",
    WRONG: "#ff9d8b",
    COLOURS["velocity"]: "#7fb8ff",
    COLOURS["coriolis"]: "#d79bf0",
    **dict(zip(SERIES[3:], ("#e3b368", "#b9a5f5", "#5fd0dc", "#b6bcc3"), strict=True)),
    BENEATH: "#8f959c",
    # The lines of graph paper, and the ground under a mechanism that is being drawn.
    "#ddd": "#31373e",
    "#ccc": "#3c434b",
    "#b8b8b8": "#4a525b",
    "#999": "#626b75",
    "#777": "#8f959c",
}


def darkened(svg: str) -> str:
    """Return a drawing that goes dark with the page around it; one of other colours as it is."""
    used = sorted(set(_USED.findall(svg)))
    if not used or not {colour for _, colour in used} <= set(DARK):
        return svg
    style = f"<style>@media screen and (prefers-color-scheme:dark){{{_rules(used)}}}</style>"
    return _ROOT.sub(lambda root: root[0] + style, svg, count=1)


def dark_rules() -> str:
    """Return the rules of a style sheet for drawings that are elements of a dark page."""
    return _rules(product(("fill", "stroke"), DARK), "svg ")


def _rules(used: Iterable[tuple[str, str]], before: str = "") -> str:
    return "".join(f'{before}[{paint}="{colour}"]{{{paint}:{DARK[colour]}}}' for paint, colour in used)
