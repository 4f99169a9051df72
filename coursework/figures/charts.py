"""Charts of tables and measurements by matplotlib, an optional dependency of charts alone."""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from coursework.system.extras import NotAtHand, library

STYLE = {
    "axes.grid": True,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "font.size": 9,
    "grid.linewidth": 0.4,
    "svg.fonttype": "path",
    "svg.hashsalt": "coursework",
}
INK = "#1b3a57"  #: dark enough to stand alone in black and white
_FILLED = 0.97  #: of a chart's width, by a line of its title
_SHORT = 0.3  #: of a chart's width: such a title fits wherever its panel stands
_LINE = 1.3  #: of the size of letters, from a line to the next
LINES = ("-", "--", "-.", ":")  #: told apart in black and white


def _pyplot() -> Any:
    matplotlib: Any = library("matplotlib", "charts need", "charts")
    matplotlib.use("agg")
    return library("matplotlib.pyplot", "charts need", "charts")


def lacking() -> str:
    """Return the reason why no chart can be drawn; empty where matplotlib is installed."""
    try:
        _pyplot()
    except NotAtHand as why:
        return str(why)
    return ""


def curves(
    horizontal: tuple[str, np.ndarray],
    columns: Mapping[str, np.ndarray],
    units: Mapping[str, str],
    title: str,
) -> bytes:
    """Return curves over one variable as SVG, a panel for each unit; the same data give the same bytes."""
    pyplot = _pyplot()
    by_unit: dict[str, list[str]] = {}
    for name in columns:
        by_unit.setdefault(units[name], []).append(name)
    with pyplot.rc_context(STYLE):
        figure, panels = pyplot.subplots(
            len(by_unit),
            1,
            sharex=True,
            squeeze=False,
            figsize=(7.5, 1.2 + 1.9 * len(by_unit)),
            layout="constrained",
        )
        for panel, (unit, names) in zip(panels[:, 0], by_unit.items(), strict=True):
            for number, name in enumerate(names):
                values = _without_jumps(columns[name]) if unit == "deg" else columns[name]
                panel.plot(horizontal[1], values, LINES[number % len(LINES)], label=name, linewidth=1.2)
            panel.set_ylabel(unit)
            panel.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
        panels[-1, 0].set_xlabel(horizontal[0])
        panels[0, 0].set_title(title)
        return _svg(pyplot, figure)


def _without_jumps(degrees: np.ndarray) -> np.ndarray:
    """Return the degrees with a gap (NaN) where a direction passes from 180 to -180."""
    values = np.array(degrees, dtype=float)
    values[1:][np.abs(np.diff(degrees)) > 180] = np.nan
    return values


def _svg(pyplot: Any, figure: Any) -> bytes:
    out = io.BytesIO()
    _fit_title(figure, figure.axes[0])
    figure.savefig(out, format="svg", metadata={"Date": None, "Creator": None})
    pyplot.close(figure)
    return out.getvalue()


def _fit_title(figure: Any, panel: Any) -> None:
    """Replace a title wider than its panel by one over the whole chart, on as many lines as it takes."""
    title, room = panel.title, figure.bbox.width
    if title.get_window_extent(figure.canvas.get_renderer()).width <= _SHORT * room:
        return
    figure.draw_without_rendering()
    if title.get_window_extent().x0 >= 0 and title.get_window_extent().x1 <= room:
        return
    over = figure.suptitle("", fontsize=title.get_fontsize())

    def fits(text: str) -> bool:
        over.set_text(text)
        return over.get_window_extent().width <= _FILLED * room

    lines = _lines(title.get_text(), fits)
    over.set_text("\n".join(lines))
    title.set_text("")
    width, height = figure.get_size_inches()
    figure.set_size_inches(width, height + (len(lines) - 1) * _LINE * title.get_fontsize() / 72)


def _lines(text: str, fits: Callable[[str], bool]) -> list[str]:
    """Break a text into lines that fit; a word longer than a line is cut."""
    lines = [""]
    for word in text.split(" "):
        longer, rest = f"{lines[-1]} {word}".strip(), word
        if fits(longer):
            lines[-1] = longer
            continue
        lines += [""] if lines[-1] else []
        while not fits(rest):
            size = max((n for n in range(1, len(rest)) if fits(rest[:n])), default=len(rest))
            lines[-1], rest = rest[:size], rest[size:]
            lines.append("")
        lines[-1] = rest
    return lines


def scatter(
    points: Mapping[str, tuple[Sequence[float], Sequence[float]]],
    title: str,
    horizontal: str,
    vertical: str,
    *,
    joined: bool = True,
    integers: bool = False,
) -> bytes:
    """Return named series of points on two logarithmic axes, as SVG; ``integers`` puts whole numbers on a linear
    axis."""
    pyplot = _pyplot()
    marks = "osD^v<>Px*hp+d"
    with pyplot.rc_context(STYLE):
        figure, panel = pyplot.subplots(figsize=(7.5, 4.6), layout="constrained")
        for number, (name, (x, y)) in enumerate(points.items()):
            line = LINES[number % len(LINES)] if joined else ""
            panel.plot(x, y, marks[number % len(marks)] + line, label=name, markersize=5, linewidth=0.9)
        across = "linear" if integers else "log"
        panel.set(xscale=across, yscale="log", xlabel=horizontal, ylabel=vertical, title=title)
        if integers:
            panel.set_xticks(sorted({int(v) for x, _ in points.values() for v in x}))
        panel.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
        return _svg(pyplot, figure)


def formula_label(tex: str, otherwise: str) -> str:
    """Return a formula as a chart label; the plain text ``otherwise`` where matplotlib cannot set it."""
    _pyplot()
    from matplotlib.mathtext import MathTextParser

    try:
        MathTextParser("path").parse(f"${tex}$")
    except ValueError:
        return plain_label(otherwise)
    return f"${tex}$"


#: Scripts and signs that the charts' own font draws.
_UNDRAWN = re.compile(
    "[^ -~\u00a0-\u024f\u02b0-\u03ff\u0400-\u045f\u1e00-\u1eff\u2000-\u2040\u2070-\u209f\u20a0-\u20bf"
    "\u2100-\u211e\u2126-\u214f\u2190-\u22ff\u2500-\u25ff\n\t]"
)


def drawable_label(text: str) -> str:
    """Replace each character that the chart font cannot draw by a square."""
    return _UNDRAWN.sub("\N{WHITE SQUARE}", text)


def plain_label(text: str) -> str:
    """Return a text as a chart label, with its dollar signs escaped."""
    return text.replace("$", r"\$")


def bars(rows: Sequence[tuple[str, float, str]], title: str, horizontal: str, full: float = 0.0) -> bytes:
    """Return a chart of horizontal bars, the first at the top, as SVG.

    A row is a label, a length, and what is written at the bar's end; the axis reaches ``full``, or a
    little beyond the longest bar.
    """
    pyplot = _pyplot()
    lengths = [length for _, length, _ in rows]
    with pyplot.rc_context(STYLE):
        figure, panel = pyplot.subplots(figsize=(6.6, 0.85 + 0.2 * max(3, len(rows))), layout="constrained")
        panel.barh(range(len(rows)), lengths, height=0.62, color=INK)
        for index, (_, length, text) in enumerate(rows):
            panel.annotate(text, (length, index), (3, 0), textcoords="offset points", va="center", fontsize=8)
        panel.set_yticks(range(len(rows)), [label for label, *_ in rows])
        panel.set(xlabel=horizontal, title=title, xlim=(0, 1.12 * (full or max(lengths, default=0) or 1)))
        panel.set_ylim(len(rows) - 0.4, -0.6)
        _whole_ticks(panel.xaxis, full)
        panel.tick_params(axis="y", length=0)
        panel.grid(visible=False, axis="y")
        panel.set_axisbelow(True)
        return _svg(pyplot, figure)


def _whole_ticks(axis: Any, full: float) -> None:
    """Set five steps up to ``full``; without it, whole numbers."""
    from matplotlib.ticker import MaxNLocator

    if full:
        axis.set_ticks(np.linspace(0, full, 6))
    else:
        axis.set_major_locator(MaxNLocator(nbins=8, integer=True))


def histogram(
    counts: Sequence[int], edges: Sequence[float], title: str, horizontal: str, vertical: str
) -> bytes:
    """Return a histogram as SVG, with one edge more than counts; each column carries its count."""
    pyplot = _pyplot()
    with pyplot.rc_context(STYLE):
        figure, panel = pyplot.subplots(figsize=(6.6, 2.9), layout="constrained")
        panel.bar(
            edges[:-1], counts, np.diff(edges), align="edge", color=INK, edgecolor="white", linewidth=1.5
        )
        for left, right, count in zip(edges[:-1], edges[1:], counts, strict=True):
            if count:
                panel.annotate(
                    str(count), ((left + right) / 2, count), (0, 2), textcoords="offset points", ha="center"
                )
        panel.set_xticks(edges)
        panel.set(xlabel=horizontal, ylabel=vertical, title=title)
        panel.set_ylim(0, 1.12 * max(1, *counts))
        _whole_ticks(panel.yaxis, 0)
        panel.grid(visible=False, axis="x")
        panel.set_axisbelow(True)
        return _svg(pyplot, figure)
