"""Drawn shapes in mm on paper, y up: paths, discs and arcs, with their SVG."""

from __future__ import annotations

import cmath
import math
import operator
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import lru_cache, reduce
from typing import TypeVar

from coursework.language.numbers import rounded

BAR, EDGE, THIN = 0.6, 0.35, 0.2  #: line widths, mm
DASHED, CHAIN, DOTTED = "1.6 1", "4 1 0.6 1", "0.8 0.8"
HEAD = 2.2  #: length of an arrow head, mm
FONT = "Libertinus Serif"
WHITE, TINT, BLACK, NONE = "#fff", "#e4e4e4", "#000", "none"

#: Shades of the parts of a drawn machine.
SHADES = {
    "none": NONE,
    "white": WHITE,
    "light": TINT,
    "mid": "#c6c6c6",
    "dark": "#8f8f8f",
    "black": "#333",
    "glass": "#dcebf5",
}

INSIDE, NAMES, ANGLES, SIDES = range(4)  #: ranks of labels: those with least choice first

# From the bottom to the top of the pile.
FILLS, LINES, GUIDES, BLOCKS, BARS, PINS, MARKS = range(7)

Place = Callable[[complex], complex]
Number = TypeVar("Number", float, complex)


def number(x: float) -> str:
    """Format a length in mm, to the hundredth at most, without trailing zeros."""
    text = f"{rounded(x, 2):.2f}".rstrip("0").rstrip(".")
    return text


def pair(z: complex) -> str:
    return f"{number(z.real)} {number(z.imag)}"


def added(numbers: Iterable[Number]) -> Number | float:
    """Sum the numbers from left to right; the rounding of ``sum`` depends on the version of Python."""
    return reduce(operator.add, numbers, 0.0)


def turn(degrees: float) -> complex:
    """Return the unit vector at an angle in degrees."""
    return cmath.rect(1.0, math.radians(degrees))


@lru_cache(maxsize=64)
def _round(sides: int) -> tuple[complex, ...]:
    """Return the unit vectors to the corners of a regular polygon, the first one repeated at the end."""
    return tuple(turn(360 * k / sides) for k in range(sides + 1))


@lru_cache(maxsize=256)
def _paint(width: float, fill: str, dash: str = "") -> str:
    stroke = f' stroke-width="{number(width)}"' if width else ' stroke="none"'
    filled = f' fill="{fill}"' if fill != NONE else ""
    return stroke + filled + (f' stroke-dasharray="{dash}"' if dash else "")


@dataclass(frozen=True)
class Path:
    """Polyline, or polygon when closed."""

    points: tuple[complex, ...]
    width: float = EDGE
    fill: str = NONE
    dash: str = ""
    closed: bool = False
    layer: int = LINES
    solid: bool = False  #: no label may lie inside

    def outline(self) -> tuple[complex, ...]:
        return (*self.points, self.points[0]) if self.closed else self.points

    def svg(self, position: Place) -> str:
        direction = "L".join(pair(position(z)) for z in self.points) + ("Z" if self.closed else "")
        return f'<path d="M{direction}"{_paint(self.width, self.fill, self.dash)}/>'


@dataclass(frozen=True)
class Disc:
    """Circle, filled or not."""

    center: complex
    radius: float
    width: float = EDGE
    fill: str = NONE
    dash: str = ""
    layer: int = LINES
    solid: bool = False

    def outline(self) -> tuple[complex, ...]:
        sides = max(8, min(72, round(4 * self.radius)))
        return tuple(self.center + self.radius * direction for direction in _round(sides))

    def svg(self, position: Place) -> str:
        center = position(self.center)
        at = f'cx="{number(center.real)}" cy="{number(center.imag)}" r="{number(self.radius)}"'
        return f"<circle {at}{_paint(self.width, self.fill, self.dash)}/>"


@dataclass(frozen=True)
class Arc:
    """Arc from one angle to another, degrees, counter-clockwise when the second is larger."""

    center: complex
    radius: float
    start: float
    end: float
    width: float = EDGE
    dash: str = ""
    layer: int = LINES
    solid: bool = False

    def at(self, degrees: float) -> complex:
        return self.center + self.radius * turn(degrees)

    def outline(self) -> tuple[complex, ...]:
        steps = max(2, round(abs(self.end - self.start) / 6))
        return tuple(self.at(self.start + (self.end - self.start) * k / steps) for k in range(steps + 1))

    def svg(self, position: Place) -> str:
        # SVG draws nothing between two equal points, so a long arc goes by thirds.
        stops = [self.start + (self.end - self.start) * k / 3 for k in range(4)]
        direction = self.end < self.start
        radius = number(self.radius)
        legs = "".join(
            f"A{radius} {radius} 0 0 {int(direction)} {pair(position(self.at(a)))}" for a in stops[1:]
        )
        return (
            f'<path d="M{pair(position(self.at(self.start)))}{legs}"{_paint(self.width, NONE, self.dash)}/>'
        )


Ink = Path | Disc | Arc
