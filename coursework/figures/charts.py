"""Charts of tables and measurements as SVG: bars, histograms, points on logarithmic axes. The same data give
the same bytes."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from itertools import pairwise

from coursework.figures.ink import number
from coursework.figures.plot import GRID, LINE, RIGHT, WRONG, page, put, round_values, written
from coursework.figures.text import SIZE, LabelText, read

_WIDTH = 150.0  #: of a chart, mm
_TEXT, _SMALL = 0.85, 0.75  #: sizes of letters, relative to those of a figure
_ROW, _BAR = 5.4, 3.4  #: from a bar to the next, and the height of one, mm
_ROOM = 2.0  #: between letters and what they stand beside, mm
_BELOW = 11.5  #: room for the numbers and the title of a horizontal axis, mm
_COLUMNS, _POINTS = 48.0, 72.0  #: heights of the panels of a histogram and of points, mm
_ENTRY = 4.8  #: height of an entry of a legend, mm
_SAMPLE = 9.0  #: length of the line before it, mm

_LETTER = re.compile(r'<path transform="([^"]*)" d="([^"]*)"/>')

#: Series differ without colour, by their marks and dashes.
COLOURS = (LINE, WRONG, RIGHT, "#8a5a00", "#6a3d9a", "#007a87", "#555")
_DASHES = ("", "2 0.8", "2 0.8 0.5 0.8", "0.5 0.7")
_MARKS = (
    "m-1 0a1 1 0 1 0 2 0a1 1 0 1 0 -2 0z",
    "m-.9 -.9h1.8v1.8h-1.8z",
    "m0 -1.3l1.3 1.3l-1.3 1.3l-1.3 -1.3z",
    "m0 -1.2l1.1 2h-2.2z",
    "m0 1.2l1.1 -2h-2.2z",
    "m-1.2 0h2.4m-1.2 -1.2v2.4",
    "m-.9 -.9l1.8 1.8m-1.8 0l1.8 -1.8",
)


def bars(
    rows: Sequence[tuple[LabelText | str, float, str]], title: str, horizontal: str, full: float = 0.0
) -> str:
    """Return a chart of horizontal bars, the first at the top, as SVG.

    A row is a label, a length, and what is written at the bar's end; the axis reaches ``full``, or the
    longest bar.
    """
    texts = [(_text(label), length, written(end)) for label, length, end in rows]
    most = full or max((length for _, length, _ in texts), default=0) or 1
    left = _ROOM + max((_width(label) for label, _, _ in texts), default=0)
    right = 2 * _ROOM + max((_width(end, _SMALL) for _, _, end in texts), default=0)
    scale, height = (_WIDTH - left - right) / most, _ROW * max(3, len(texts))
    ticks = [full * k / 5 for k in range(6)] if full else _whole_values(most)
    body = _grid([f"M{number(left + scale * t)} 0v{number(height)}" for t in ticks])
    for position, (label, length, end) in enumerate(texts):
        middle = _ROW * (position + 0.5)
        body += [
            _box(left, middle - _BAR / 2, scale * length, _BAR),
            put(label, complex(left - 1.5, middle + 1.0), "end", _TEXT),
            put(end, complex(left + scale * length + 1.5, middle + 1.0), "start", _SMALL),
        ]
    body += _foot({left + scale * t: f"{t:g}" for t in ticks}, horizontal, left, _WIDTH - right, height)
    return _page(height + _BELOW, body, title)


def histogram(
    counts: Sequence[int], edges: Sequence[float], title: str, horizontal: str, vertical: str
) -> str:
    """Return a histogram as SVG, with one edge more than counts; each column carries its count."""
    most = 1.12 * max(1, *counts)
    left, right, above = 10.0, _WIDTH - 4.0, 6.0
    across = (right - left) / (edges[-1] - edges[0])

    def x(value: float) -> float:
        return left + across * (value - edges[0])

    def y(value: float) -> float:
        return above + _COLUMNS * (1 - value / most)

    ticks = _whole_values(most)
    body = [put(written(vertical), complex(left, above - 2.5), "start", _TEXT)]
    body += _grid([f"M{number(left)} {number(y(t))}h{number(right - left)}" for t in ticks])
    body += [put(written(f"{t:g}"), complex(left - 1.5, y(t) + 1.0), "end", _SMALL) for t in ticks]
    for (low, high), count in zip(pairwise(edges), counts, strict=True):
        if count:
            body.append(_box(x(low) + 0.3, y(count), x(high) - x(low) - 0.6, y(0) - y(count)))
            at = complex((x(low) + x(high)) / 2, y(count) - 1.2)
            body.append(put(written(str(count)), at, "middle", _SMALL))
    body += _foot({x(e): f"{e:g}" for e in edges}, horizontal, left, right, y(0))
    return _page(y(0) + _BELOW, body, title)


def scatter(
    points: Mapping[str, tuple[Sequence[float], Sequence[float]]],
    title: str,
    horizontal: str,
    vertical: str,
    *,
    integers: bool = False,
) -> str:
    """Return named series of joined points on two logarithmic axes, as SVG; ``integers`` puts whole numbers
    on a linear axis. A point without a logarithm is left out."""

    def along(value: float) -> float:
        return value if integers else math.log10(value)

    series = {
        name: [(along(a), math.log10(b)) for a, b in zip(*both, strict=True) if b > 0 and (integers or a > 0)]
        for name, both in points.items()
    }
    every = [point for run in series.values() for point in run]
    left, above = 14.0, 6.0
    right = _WIDTH - _SAMPLE - 3 * _ROOM - max((_width(written(name), _SMALL) for name in series), default=0)
    height = max(_POINTS, _ENTRY * len(series))
    (low, high), (least, most) = (_reach([point[k] for point in every]) for k in (0, 1))

    def at(point: tuple[float, float]) -> complex:
        x, y = (point[0] - low) / (high - low), (most - point[1]) / (most - least)
        return complex(left + (right - left) * x, above + height * y)

    across = sorted({round(a) for a, _ in every}) if integers else _whole_between(low, high)
    upward = _whole_between(least, most)
    body = [put(written(vertical), complex(left, above - 2.5), "start", _TEXT)]
    body += _grid(
        [f"M{number(at((t, most)).real)} {number(above)}v{number(height)}" for t in across]
        + [f"M{number(left)} {number(at((low, t)).imag)}h{number(right - left)}" for t in upward]
    )
    body += [put(_power(t), at((low, t)) - 1.5 + 1j, "end", _SMALL) for t in upward]
    for position, (name, run) in enumerate(series.items()):
        entry = complex(right + _ROOM, above + _ENTRY * (position + 0.5))
        body += _series(position, [at(point) for point in run])
        body += _series(position, [entry, entry + _SAMPLE], marked=entry + _SAMPLE / 2)
        body.append(put(written(name), entry + _SAMPLE + 1.5 + 1j, "start", _SMALL))
    labels = {at((t, most)).real: f"{t}" if integers else _power(t) for t in across}
    body += _foot(labels, horizontal, left, right, above + height)
    return _page(above + height + _BELOW, body, title)


def _series(position: int, run: Sequence[complex], marked: complex | None = None) -> list[str]:
    """Return the joined points of a series; in a legend, a line with the mark in its middle."""
    colour = COLOURS[position % len(COLOURS)]
    dash = _DASHES[position % len(_DASHES)]
    line = "L".join(f"{number(z.real)} {number(z.imag)}" for z in run)
    dashed = f' stroke-dasharray="{dash}"' if dash else ""
    mark = _MARKS[position % len(_MARKS)]
    fill = colour if position % (2 * len(_MARKS)) < len(_MARKS) else "#fff"
    spots = "".join(
        f"M{number(z.real)} {number(z.imag)}{mark}" for z in (run if marked is None else [marked])
    )
    if not run:
        return []
    return [
        f'<path d="M{line}" fill="none" stroke="{colour}" stroke-width="0.3"{dashed}/>',
        f'<path d="{spots}" fill="{fill}" stroke="{colour}" stroke-width="0.3"/>',
    ]


def _page(height: float, body: Sequence[str], title: str) -> str:
    """Return an SVG in which each letter has its outline once: a report has many charts, as pictures of their
    own."""
    head, svg = page((_WIDTH, height), body, title).split("\n", 1)
    names: dict[str, str] = {}

    def used(letter: re.Match[str]) -> str:
        name = names.setdefault(letter[2], f"g{len(names)}")
        return f'<use href="#{name}" transform="{letter[1]}"/>'

    svg = _LETTER.sub(used, svg)
    outlines = (f'<path id="{name}" d="{outline}"/>' for outline, name in names.items())
    return "\n".join([head, f"<defs>{''.join(outlines)}</defs>", svg])


def _text(label: LabelText | str) -> LabelText:
    return written(label) if isinstance(label, str) else label


def _width(text: LabelText, size: float = _TEXT) -> float:
    return text.width * SIZE * size


def _power(exponent: int) -> LabelText:
    return read(f"10^{{{exponent}}}")


def _reach(values: Sequence[float]) -> tuple[float, float]:
    """Return the range of an axis, with some margin."""
    low, high = min(values, default=0.0), max(values, default=1.0)
    margin = 0.05 * (high - low) or 0.5
    return low - margin, high + margin


def _whole_values(most: float) -> list[float]:
    """Return round whole numbers from 0 on."""
    return [t for t in round_values(0, most, 8) if t == round(t)]


def _whole_between(low: float, high: float) -> list[int]:
    """Return at most nine whole numbers between two."""
    step = max(1, math.ceil((high - low) / 8))
    return [k * step for k in range(math.ceil(low / step), math.floor(high / step) + 1)]


def _grid(lines: Sequence[str]) -> list[str]:
    return [f'<path d="{"".join(lines)}" fill="none" stroke="{GRID}" stroke-width="0.2"/>']


def _box(x: float, y: float, width: float, height: float) -> str:
    return (
        f'<path d="M{number(x)} {number(y)}h{number(width)}v{number(height)}h{number(-width)}z" '
        f'fill="{LINE}"/>'
    )


def _foot(
    ticks: Mapping[float, LabelText | str], title: str, left: float, right: float, base: float
) -> list[str]:
    """Return a horizontal axis with the labels of its ticks, by abscissa, and its title."""
    axis = f'<path d="M{number(left)} {number(base)}H{number(right)}" stroke="#000" stroke-width="0.25"/>'
    below = [put(_text(label), complex(x, base + 4.2), "middle", _SMALL) for x, label in ticks.items()]
    return [axis, *below, put(written(title), complex((left + right) / 2, base + 9.2), "middle", _TEXT)]
