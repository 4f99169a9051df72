"""A draughtsman without a browser: the constructions of ``constructions.py`` on paper, for marks by the
thousand."""

import cmath
import math
import re
from contextlib import suppress
from itertools import combinations

import constructions
from site_pencil import Draughtsman, cis

from coursework.marking.judges import is_scale
from coursework.marking.marking import mark
from coursework.rendering.surface import surface
from coursework.sheets.handout import handout


class PaperHand(Draughtsman):
    """The same hand with the same mistakes, and points that are ``moved``; what the surface would put into
    the boxes is computed.

    ``steps`` are those of the construction in their order: the name, whether two lines meet there, and the
    points before it.
    """

    def __init__(self, variant, mistakes=None):
        self.variant, self.handout, self.mistakes = variant, handout(variant), mistakes or {}
        told = variant.exercise.spec.statement_values(variant.given)
        found = {name: re.search(r"-?\d[\d.]*", str(text)) for name, text in told.items()}
        self.given = {**variant.given, **{name: float(number[0]) for name, number in found.items() if number}}
        self.links = {"x": 0.0} | {
            one.name.replace("_", ""): one.degrees for one in surface(self.handout).links
        }
        self.at, self.scale, self.steps, self.texts, self._touched = {}, 1.0, [], {}, []
        self._scale_part = next((part.id for part in variant.parts if is_scale(part)), "")

    def construct(self):
        """Draw the whole, and return the verdicts by part."""
        with suppress(ValueError, ZeroDivisionError):  # lines or circles that do not meet: it ends there
            getattr(constructions, self.variant.exercise.name)(self)
        return {part: one.verdict for part, one in mark(self.variant, self.texts).items()}

    def sure(self, z):
        self._touched.append(z)

    def tool(self, name):
        pass

    def circle(self, z, radius):
        pass

    def enter(self, name, value):
        if name == "scale":
            self.texts[self._scale_part] = str(value)

    def press(self, selector):
        kind, name = re.search(r"data-([a-z]+)='?([^'\]]*)", selector).groups()
        if kind == "scale":
            self._scale_part = name
        elif kind == "name":
            start, end = self._touched[-2:]
            self._put(name, end - start)

    def set_scale(self, longest, part="", most=75.0):
        self._scale_part = part or self._scale_part
        round_ones = (m * 10.0**k for k in range(-3, 7) for m in (1, 2, 5))
        self.scale = next(k for k in round_ones if longest / k <= most) * self.mistakes.get("scale", 1)
        stated = self.mistakes.get("stated", 1)
        self.enter("scale", f"{1 / self.scale if stated == 'inverse' else self.scale * stated:g}")

    def start(self, z, name):
        self.at[name] = z
        self._put(name, z)

    def crossing(self, z, name=None):
        z += self.mistakes.get(("moved", name), 0)
        if name:
            self.start(z, name)
        return z

    def measure(self, p, q, *parts):
        for part in parts:
            unit = next(one.unit for one in self.variant.parts if one.id == part)
            length = abs(q - p) * (1 if unit == "mm" else self.scale)
            self.texts[part] = f"{math.degrees(cmath.phase(q - p)) if unit == 'deg' else length:.5g}"

    def lay_off(self, start, tool, link, vector, name=None, text=None, step=None):
        self.steps.append((step or name, False, tuple(self.at)))
        if self.mistakes.get(step or name) == "nothing":
            return self.crossing(start, name)
        return super().lay_off(start, tool, link, vector, name, text, step)

    def meet(self, name, *lines):
        self.steps.append((name, True, tuple(self.at)))
        return super().meet(name, *lines)

    def _put(self, name, z):
        self.texts[name] = f"({z.real:.2f}; {z.imag:.2f})"


def one_mistake_each(variant):
    """The mistakes that a hand can make in the construction of a variant, one at a time."""
    hand = PaperHand(variant)
    hand.construct()
    yield from ({"scale": 10}, {"stated": 2}, {"stated": "inverse"}, {"radii": "exchanged"}, {"centre": "p"})
    met = [name for name, meets, _ in hand.steps if meets and name]
    for name, z in hand.at.items():
        ways = {9 * cis(turn) for turn in (20, 110, 200, 290)}
        ways |= {times * (other - z) for other in hand.at.values() for times in (1, 2)}
        if name in met:
            ways |= {p + q - 2 * z for p, q in combinations(hand.at.values(), 2)}
        yield from ({("moved", name): way} for way in ways - {0})
    for name, meets, before in hand.steps:
        others = [other for other in before if other != name]
        if meets:
            yield from ({name: (k, how)} for k in (0, 1) for how in ("direction", "sense", *others))
        else:
            yield from ({name: how} for how in ("sense", "length", "direction", "vector", "nothing", *others))
