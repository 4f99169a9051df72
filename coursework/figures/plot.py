"""Curves over one variable as SVG, one panel each, drawn without a library; the same data give the same
bytes."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from coursework.errors import WrongValue
from coursework.figures.ink import number, pair
from coursework.figures.text import SIZE, LabelText, MeasuredRun, read, words
from coursework.figures.writing import accents, as_outlines
from coursework.language.numbers import localise, significant

_WIDTH, _HEIGHT = 112.0, 26.0  #: of a panel, mm
_LEFT, _RIGHT, _TOP, _BOTTOM, _GAP = 19.0, 5.0, 7.5, 11.5, 9.5
_SMALL = 0.78  #: size of the numbers on the axes, relative to a label
_LEAST = 3  #: numbers on an axis
_LINE = 5.2  #: height of a line of a title, mm
LINE, RIGHT, WRONG, GRID = "#1b3a57", "#1b7a4b", "#b3261e", "#d5d9de"


@dataclass(frozen=True)
class AnswerPoint:
    """Point of somebody's answer beside a curve. ``right`` is None when it is not judged.

    ``written``: the number to print where the point is outside its panel; ``y`` by default.
    """

    x: float
    y: float
    right: bool | None = None
    written: float | None = None


@dataclass(frozen=True)
class Axis:
    """Variable: its LaTeX symbol (or plain words), its printed unit, its values."""

    label: str
    unit: str
    values: np.ndarray

    @property
    def title(self) -> LabelText:
        raised = _RAISED.sub(_exponent, self.unit)
        unit = rf"\ \ [\mathrm{{{raised}}}]" if self.unit else ""
        try:
            # Words stay upright; a symbol that the label's reader does not know is written as it comes.
            symbol = self.label if not _is_words(self.label) else rf"\mathrm{{{_spaced(self.label)}}}"
            return read(symbol + unit)
        except WrongValue:
            return read(rf"\mathrm{{{''.join(c for c in self.label if c.isalnum())}}}" + unit)


_RAISED = re.compile("[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+")
_FIGURES = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")


def _exponent(raised: re.Match[str]) -> str:
    return rf"}}^{{{raised[0].translate(_FIGURES)}}}\mathrm{{"


def _is_words(label: str) -> bool:
    return not any(c in label for c in "\\_^{}") and len(label) > 2


def _spaced(words: str) -> str:
    return words.replace(" ", r"\ ")


class Plot:
    """Panels one above the other, over one variable.

    Parameters
    ----------
    horizontal
        The variable that all panels share.
    panels
        Curves, each with as many values as the variable; NaN where there is none.
    lang
        Language of the numbers on the axes.
    at
        A place on the variable that is marked through all panels.
    spots
        Points beside the curve of each panel, by the panel's place.
    title
        Words above the panels.
    width
        Of a panel, mm.

    Raises
    ------
    WrongValue
        No panel, or a panel of another length than the variable, or without one finite value.
    """

    def __init__(
        self,
        horizontal: Axis,
        panels: Sequence[Axis],
        lang: str = "en",
        at: float | None = None,
        spots: Sequence[Sequence[AnswerPoint]] = (),
        title: str = "",
        width: float = _WIDTH,
    ):
        if not panels:
            raise WrongValue("a plot has one curve at least; found none")
        for panel in panels:
            if np.shape(panel.values) != np.shape(horizontal.values):
                raise WrongValue(
                    "the curve {label} has {count} values, its variable {variable} has {most}",
                    label=panel.label,
                    count=np.size(panel.values),
                    variable=horizontal.label,
                    most=np.size(horizontal.values),
                )
            if not np.isfinite(panel.values).any():
                raise WrongValue("the curve {label} has no finite value", label=panel.label)
        self.horizontal, self.panels, self.lang, self.at = horizontal, tuple(panels), lang, at
        self.title, self.width = title, width
        self.spots = tuple(tuple(s) for s in spots) or ((),) * len(panels)

    @property
    def size(self) -> tuple[float, float]:
        """Width and height, mm."""
        count = len(self.panels)
        return _LEFT + self.width + _RIGHT, _TOP + count * _HEIGHT + (count - 1) * _GAP + _BOTTOM

    @property
    def has_outside(self) -> tuple[bool, ...]:
        """True, by panel, if a point is so far from the curve that an arrow at the edge stands for it."""
        return tuple(
            any(not low <= s.y <= high for s in spots)
            for (low, high), spots in zip(
                map(self._shown_of, range(len(self.panels))), self.spots, strict=True
            )
        )

    def _shown_of(self, position: int) -> tuple[float, float]:
        values = np.asarray(self.panels[position].values, dtype=float)
        return _range(values, [s.y for s in self.spots[position]])

    @cached_property
    def _reach(self) -> tuple[float, float]:
        x = np.asarray(self.horizontal.values, dtype=float)
        low, high = float(np.min(x)), float(np.max(x))
        return (low, high) if high > low else (low - 1, high + 1)

    def _x(self, value: float) -> float:
        low, high = self._reach
        return _LEFT + self.width * (value - low) / (high - low)

    def svg(self) -> str:
        """Return the plot as SVG; letters are outlines, so that it looks the same everywhere."""
        body = [line for k in range(len(self.panels)) for line in self._panel(k)]
        low, high = self._reach
        base = self.size[1] - _BOTTOM
        ticks = _axis_ticks(self.horizontal, low, high, 6)
        body += [self._number(value, complex(self._x(value), base + 4.2), "middle") for value in ticks]
        middle = complex(_LEFT + self.width / 2, base + 9.4)
        body.append(put(self.horizontal.title, middle, "middle"))
        return page(self.size, body, self.title)

    def _panel(self, position: int) -> list[str]:
        panel, spots = self.panels[position], self.spots[position]
        top = _TOP + position * (_HEIGHT + _GAP)
        values = np.asarray(panel.values, dtype=float)
        low, high = self._shown_of(position)

        def y(value: float) -> float:
            inside = min(max(value, low), high)
            return top + _HEIGHT * (high - inside) / (high - low)

        out = [put(panel.title, complex(_LEFT, top - 2.0), "start")]
        across = _axis_ticks(self.horizontal, *self._reach, 6)
        grid = [f"M{number(self._x(t))} {number(top)}v{number(_HEIGHT)}" for t in across]
        ticks = _axis_ticks(panel, low, high, 4)
        grid += [f"M{number(_LEFT)} {number(y(t))}h{number(self.width)}" for t in ticks]
        out.append(f'<path d="{"".join(grid)}" fill="none" stroke="{GRID}" stroke-width="0.2"/>')
        if low < 0 < high:
            out.append(
                f'<path d="M{number(_LEFT)} {number(y(0))}h{number(self.width)}" stroke="#000" '
                'stroke-width="0.25"/>'
            )
        out += [self._number(t, complex(_LEFT - 1.6, y(t) + 1.0), "end") for t in ticks]
        if self.at is not None:
            out.append(
                f'<path d="M{number(self._x(self.at))} {number(top)}v{number(_HEIGHT)}" stroke="#000" '
                'stroke-width="0.3" stroke-dasharray="1.4 1"/>'
            )
        curve = "".join(
            "M" + "L".join(map(pair, _thinned([complex(self._x(a), y(b)) for a, b in run])))
            for run in _runs(np.asarray(self.horizontal.values, dtype=float), values, panel.unit == "°")
        )
        out.append(
            f'<path d="{curve}" fill="none" stroke="{LINE}" stroke-width="0.5" stroke-linejoin="round"/>'
        )
        for s in spots:
            if low <= s.y <= high:
                out.append(_dot(self._x(s.x), y(s.y), s.right))
            else:
                out += self._outside(s, y(s.y), s.y > high)
        return out

    def _outside(self, spot: AnswerPoint, edge: float, is_above: bool) -> list[str]:
        """Return an arrow at the panel's edge with the number of a point outside the panel."""
        x, out = self._x(spot.x), -1 if is_above else 1
        to_left = x > _LEFT + self.width * 0.8
        arrow = (
            f'<path d="M{number(x - 1.4)} {number(edge)}h2.8l-1.4 {number(2.0 * out)}z" '
            f'fill="{RIGHT if spot.right else WRONG}"/>'
        )
        text = spot.y if spot.written is None else spot.written
        at = complex(x - 2.2 if to_left else x + 2.2, edge + (-0.3 if is_above else 1.9))
        return [arrow, self._number(text, at, "end" if to_left else "start")]

    def _number(self, value: float, at: complex, anchor: str) -> str:
        return put(read(localise(significant(value, 6), self.lang)), at, anchor, _SMALL)


def written(text: str) -> LabelText:
    """Return words that anybody wrote, in upright letters."""
    return words(text, MeasuredRun)


def page(size: tuple[float, float], body: Sequence[str], title: str = "") -> str:
    """Return an SVG of this size, mm, with a title above it on as many lines as it takes."""
    lines = _title_lines(title, size[0] - 2) if title else []
    if above := _LINE * len(lines) + 1 if lines else 0.0:
        body = [f'<g transform="translate(0 {number(above)})">', *body, "</g>"]
    titles = [
        put(written(line), complex(size[0] / 2, _LINE * (k + 0.8)), "middle") for k, line in enumerate(lines)
    ]
    width, height = number(size[0]), number(size[1] + above)
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}mm" height="{height}mm" '
            f'viewBox="0 0 {width} {height}" role="img">',
            f'<rect width="{width}" height="{height}" fill="#fff"/>',
            *titles,
            *body,
            "</svg>\n",
        ]
    )


def _title_lines(title: str, room: float) -> list[str]:
    """Break a title into lines that fit; a word longer than a line is cut."""
    lines = [""]
    for word in title.split(" "):
        longer, rest = f"{lines[-1]} {word}".strip(), word
        if _fits(longer, room):
            lines[-1] = longer
            continue
        lines += [""] if lines[-1] else []
        while not _fits(rest, room):
            size = max((n for n in range(1, len(rest)) if _fits(rest[:n], room)), default=len(rest))
            lines[-1], rest = rest[:size], rest[size:]
            lines.append("")
        lines[-1] = rest
    return lines


def _fits(text: str, room: float) -> bool:
    return written(text).width * SIZE <= room


def _dot(x: float, y: float, right: bool | None) -> str:
    """Return a full disc for a right point, a cross for a wrong one: distinct without colour."""
    if right is False:
        return (
            f'<path d="M{number(x - 1.3)} {number(y - 1.3)}l2.6 2.6m0 -2.6l-2.6 2.6" stroke="{WRONG}" '
            'stroke-width="0.6" stroke-linecap="round"/>'
        )
    fill = RIGHT if right else "#fff"
    return (
        f'<circle cx="{number(x)}" cy="{number(y)}" r="1.3" fill="{fill}" '
        f'stroke="{RIGHT if right else LINE}" stroke-width="0.4"/>'
    )


def put(text: LabelText, at: complex, anchor: str, size: float = 1.0) -> str:
    """Return a text as outlines; ``at`` is its start, middle or end on the baseline."""
    width = text.width * SIZE * size
    start = at - {"start": 0.0, "middle": width / 2, "end": width}[anchor]
    inner = _outlined(text)
    scale = f" scale({number(size)})" if size != 1 else ""
    return (
        f'<g fill="#000" transform="translate({number(start.real)} {number(start.imag)}){scale}">{inner}</g>'
    )


@lru_cache(maxsize=1024)
def _outlined(text: LabelText) -> str:
    middle = SIZE * text.width / 2
    return as_outlines(text, middle) + accents(text, middle)


def _range(values: np.ndarray, others: Sequence[float]) -> tuple[float, float]:
    """Return the range of a panel: all values, and those other points that are not far off."""
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    span = high - low
    if span <= 1e-9 * max(abs(low), abs(high)):
        span = max(abs(high), 1.0)
        low, high = low - span / 2, high + span / 2
    for y in others:
        if low - span < y < high + span:
            low, high = min(low, y), max(high, y)
    margin = 0.06 * (high - low)
    return low - margin, high + margin


def round_values(low: float, high: float, count: int) -> list[float]:
    """Return about ``count`` round values between two."""
    rough = (high - low) / count
    power = 10.0 ** math.floor(math.log10(rough))
    larger = [m * power for m in (1, 2, 5, 10) if m * power >= rough * (1 - 1e-9)]
    # A coarse step may leave two values, which say little of a scale.
    for step in (larger[0], larger[0] / 2):
        first, last = math.ceil(low / step - 1e-6), math.floor(high / step + 1e-6)
        if last - first >= _LEAST - 1:
            break
    return [k * step for k in range(first, last + 1)]


def _axis_ticks(axis: Axis, low: float, high: float, count: int) -> list[float]:
    """Return round values; multiples of 60 or 180 degrees for a direction over a large range."""
    if axis.unit != "°" or high - low < 180:
        return round_values(low, high, count)
    step = 60.0 if count > 4 else 90.0 if high - low < 200 else 180.0
    return [step * k for k in range(math.ceil(low / step - 1e-6), math.floor(high / step + 1e-6) + 1)]


def _runs(x: np.ndarray, y: np.ndarray, turns: bool) -> list[list[tuple[float, float]]]:
    """Return the curve in pieces, cut where there is no value and where a direction passes from 180 to
    -180."""
    runs: list[list[tuple[float, float]]] = []
    before = math.nan
    for a, b in zip(x.tolist(), y.tolist(), strict=True):
        if math.isfinite(b):
            if not math.isfinite(before) or (turns and abs(b - before) > 180):
                runs.append([])
            runs[-1].append((a, b))
        before = b
    return [run for run in runs if len(run) > 1]


_DENSE = 1000  #: points from which on a curve is thinned
_SEEN = 0.01  #: mm by which it may then be off


def _thinned(points: list[complex]) -> list[complex]:
    """Return a dense curve without the points that lie on the line between others."""
    if len(points) <= _DENSE:
        return points
    z, kept, left = np.array(points), {0, len(points) - 1}, [(0, len(points) - 1)]
    while left:
        first, last = left.pop()
        chord, rest = z[last] - z[first], z[first + 1 : last] - z[first]
        off = np.abs((rest * chord.conjugate()).imag) / abs(chord) if chord else np.abs(rest)
        if off.size and off.max() > _SEEN:
            middle = first + 1 + int(off.argmax())
            kept.add(middle)
            left += [(first, middle), (middle, last)]
    return [points[k] for k in sorted(kept)]
