"""Somebody who draws a vector polygon by hand: their own pole and scale, points a third of a millimetre off,
each vector laid off and each line drawn from their own points. Nothing here knows the package's polygons."""

from __future__ import annotations

import cmath
import math
import random


class Student:
    """A sheet of paper, a scale in mm/s or mm/s^2 for a mm, and an unsteady hand."""

    def __init__(self, chance: random.Random, longest: float, noise: float = 0.3):
        self.chance = chance
        self.scale = float(f"{longest / chance.uniform(60, 110):.3g}")
        self.noise = noise
        self.at = {"p": complex(chance.uniform(-60, 60), chance.uniform(-60, 60))}

    def _put(self, z: complex) -> complex:
        return z + cmath.rect(self.noise * self.chance.random(), self.chance.uniform(0, 2 * math.pi))

    def lay_off(self, new: str, start: str, vector: complex) -> None:
        """A known vector from a point."""
        self.at[new] = self._put(self.at[start] + vector / self.scale)

    def cross(self, new: str, start: str, way: complex, other: str, other_way: complex) -> None:
        """Where two lines of known direction meet."""
        z, w = self.at[start], self.at[other]
        slope = (way.conjugate() * other_way).imag
        self.at[new] = self._put(z + way * ((w - z).conjugate() * other_way).imag / slope)

    def enlarge(self, new: str, pole: str, of: str, ratio: float) -> None:
        """The image of a point of the same bar, in proportion."""
        self.at[new] = self._put(self.at[pole] + ratio * (self.at[of] - self.at[pole]))

    def vector(self, start: str, end: str) -> complex:
        """As read at the scale."""
        return (self.at[end] - self.at[start]) * self.scale

    def measured(self, start: str, end: str) -> str:
        return f"{abs(self.at[end] - self.at[start]):.1f}"

    def points(self) -> dict[str, str]:
        """To the tenth of a millimetre."""
        return {name: f"({z.real:.1f} ; {z.imag:.1f})" for name, z in self.at.items()}


def rounded(value: float) -> str:
    return f"{value:.3g}"
