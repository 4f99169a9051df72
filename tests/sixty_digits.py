"""A solution's formulas in sixty digits, and how far the last digit of what is given moves what they give.

The inputs are taken as the exact numbers they are. A formula that loses a dozen digits at a hard place keeps
more than forty.
"""

from __future__ import annotations

import math
from functools import cached_property

import mpmath
import numpy as np

from coursework.errors import CourseworkError, Undefined

mp = mpmath.MPContext()
mp.dps = 60
EPS = 2.0**-52
_STEP = mp.mpf(2) ** -90

#: Drawn constructions measure what another exercise has formulas for: of these names, with this data besides.
SISTERS = {
    "velocity_polygon": ("four_bar_motion", ("v_B", "omega3", "omega4"), {"alpha2": 0.0}),
    "acceleration_polygon": ("four_bar_motion", ("a_B", "alpha3", "alpha4"), {"alpha2": 0.0}),
    "velocity_polygon_slider": ("slider_crank", ("r1_dot", "omega3"), {"alpha2": 0.0}),
    "acceleration_polygon_slider": ("slider_crank", ("r1_ddot", "alpha3"), {"alpha2": 0.0}),
    "velocity_polygon_slotted": ("slotted_mechanism", ("rA_dot", "omega4"), {"alpha2": 0.0, "theta1": 90.0}),
    "acceleration_polygon_slotted": (
        "slotted_mechanism",
        ("rA_ddot", "alpha4"),
        {"alpha2": 0.0, "theta1": 90.0},
    ),
    "velocity_polygon_six_bar": ("slider_extras", ("omega3", "omega4", "omega5", "r6_dot"), {}),
    "acceleration_polygon_six_bar": ("slider_extras", ("alpha3", "r6_ddot"), {}),
    "crank_shaper_drawn": ("quick_return_shaper", ("v_C", "alpha", "beta", "Q"), {}),
    "two_circles": (
        "four_bar_positions",
        ("theta3_open", "theta4_open", "theta3_crossed", "theta4_crossed"),
        {},
    ),
    "havens_construction": ("havens_planetary", ("omega3", "omega4"), {}),
}


#: What an error is the difference of, in its own unit: the structural error of a linkage, of angles of up to
#: a turn.
DIFFERENCES = {"worst": 360.0}


class Formulas:
    """The textbook formulas of an exercise for one variant, and the places where they are tried."""

    def __init__(self, course, name, given):
        self.exercise = course[name]
        sister, names, self.more = SISTERS.get(name, (name, (), {}))
        self.source = course[sister]
        self.effects = self.source.spec.effects
        self.given = {
            n: v
            for n, v in {**self.exercise.intake.defaults, **given}.items()
            if n in self.exercise.quantity_names
        }
        parts = (
            p for p in self.exercise.spec.parts if p.sort.is_scalar and not p.sort.is_open and not p.is_exact
        )
        self.names = [n for n in names or dict.fromkeys(p.quantity for p in parts) if self._is_known(n)]

    def _is_known(self, name):
        try:
            self.exact(self.given, name)
        except CourseworkError:
            return False
        return True

    @cached_property
    def graph(self):
        return self.source.solution.graph.textbook

    def exact(self, given, name):
        """One quantity; numbers that are of mpmath already stay as they are. Errors are those of the
        graph."""
        given = {
            n: mp.mpf(v) if isinstance(v, float) else v
            for n, v in {**given, **self.more}.items()
            if n in self.source.quantity_names
        }
        found = self.graph.evaluate((name,), given, self.effects)[name]
        found = found.item() if isinstance(found, np.ndarray) else found
        if not isinstance(found, mp.mpf):
            raise Undefined(f"{name} is no real number of mpmath")
        return found

    def allowed(self, given, name, value):
        """By how much the last digit of the value, and of each given number, may move it."""
        moved = abs(value) + DIFFERENCES.get(name, 0.0)
        for n, x in given.items():
            if isinstance(x, float) and x:
                near = self.exact({**given, n: mp.mpf(x) * (1 + _STEP)}, name)
                moved += self.apart(name, near, value) / _STEP
        return EPS * moved

    def apart(self, name, found, value):
        gap = abs(mp.mpf(found) - value)
        return min(gap, abs(gap - 360)) if self.exercise.units.get(name) == "deg" else gap

    def found(self, change, name):
        """What the exercise gives there; None where it says that there is none."""
        try:
            return float(
                self.exercise.solve(
                    **{**self.given, **change}, only=name, effects=self.exercise.spec.effects
                )[name]
            )
        except CourseworkError:
            return None

    def excess(self, change, name, as_if=None):
        """The error over what is allowed, at the variant with some values changed; 0 where nothing is to
        compare.

        ``as_if`` are values that mean the same as the changed ones, in fewer digits.
        """
        found = self.found(change, name)
        given = {**self.given, **(change if as_if is None else as_if)}
        try:
            value = self.exact(given, name)
            allowed = self.allowed(given, name, value)
        except CourseworkError:
            return 0.0
        if found is None:
            return 0.0
        gap = self.apart(name, found, value) if math.isfinite(found) else mp.inf
        return float(gap / allowed) if gap else 0.0

    # ------------------------------------------------------------------ places

    def of_unit(self, unit):
        return [
            n for n, v in self.given.items() if isinstance(v, float) and self.exercise.units.get(n) == unit
        ]

    def turned(self, turns):
        """Each angle so many whole turns further."""
        for n in self.of_unit("deg"):
            yield {n: self.given[n] + 360.0 * turns}

    def small(self, share):
        """Each length so small."""
        for n in self.of_unit("mm"):
            yield {n: share * self.given[n]}

    def nearly_equal(self, share):
        """Each length beside each other one."""
        lengths = [n for n in self.of_unit("mm") if self.given[n] > 0]
        for n in lengths:
            yield from ({n: self.given[other] * (1 + share)} for other in lengths if other != n)

    def beside_quarters(self, near):
        """Each angle on both sides of the quarters of a turn."""
        for n in self.of_unit("deg"):
            yield from (
                {n: quarter + side * near}
                for quarter in (-180.0, -90.0, 0.0, 90.0, 180.0)
                for side in (-1, 1)
            )

    def beside_zeros(self, near):
        """Each angle on both sides of where a quantity vanishes or begins to exist."""
        for n in self.of_unit("deg"):
            at = {where for name in self.names for where in self._zeros(n, name)}
            yield from ({n: where + side * near} for where in sorted(at) for side in (-1, 1))

    def _zeros(self, angle, name):
        def sign(where):
            value = self.found({angle: float(where)}, name)
            return 2 if value is None or math.isnan(value) else int(value > 0)

        sampled = np.arange(-180.0, 180.0, 2.0) + 0.123
        try:
            swept = self.exercise.solve(
                **{**self.given, angle: sampled}, only=name, effects=self.exercise.spec.effects
            )[name]
        except CourseworkError:
            return
        swept = np.broadcast_to(np.asarray(swept, dtype=float), sampled.shape)
        signs = np.where(np.isnan(swept), 2, swept > 0)
        for i in np.flatnonzero(np.diff(signs)):
            low, high = sampled[i], sampled[i + 1]
            first = sign(low)
            while high - low > 1e-11:
                middle = (low + high) / 2
                low, high = (middle, high) if sign(middle) == first else (low, middle)
            yield round(low, 10)
