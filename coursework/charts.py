"""Charts of tables and measurements, by matplotlib: an extra that only charts need."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from coursework.errors import BadInput

STYLE = {
    "axes.grid": True,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "font.size": 9,
    "grid.linewidth": 0.4,
    "svg.fonttype": "path",
    "svg.hashsalt": "coursework",
}
LINES = ("-", "--", "-.", ":")  #: told apart in black and white


def _pyplot() -> Any:
    try:
        import matplotlib
    except ImportError as fault:
        raise BadInput(
            "charts need matplotlib, which is not installed: pip install 'coursework[charts]'"
        ) from fault
    matplotlib.use("agg")
    from matplotlib import pyplot

    return pyplot


def curves(
    horizontal: tuple[str, np.ndarray],
    columns: Mapping[str, np.ndarray],
    units: Mapping[str, str],
    title: str,
) -> bytes:
    """Curves over one variable, a panel for each unit, as SVG; the same data give the same bytes."""
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
    """The line of a direction is cut where it passes from 180 to -180."""
    values = np.array(degrees, dtype=float)
    values[1:][np.abs(np.diff(degrees)) > 180] = np.nan
    return values


def _svg(pyplot: Any, figure: Any) -> bytes:
    out = io.BytesIO()
    figure.savefig(out, format="svg", metadata={"Date": None, "Creator": None})
    pyplot.close(figure)
    return out.getvalue()


def scatter(
    points: Mapping[str, tuple[Sequence[float], Sequence[float]]],
    title: str,
    horizontal: str,
    vertical: str,
    *,
    joined: bool = True,
) -> bytes:
    """Named series of points on two logarithmic axes, as SVG."""
    pyplot = _pyplot()
    marks = "osD^v<>Px*hp+d"
    with pyplot.rc_context(STYLE):
        figure, panel = pyplot.subplots(figsize=(7.5, 4.6), layout="constrained")
        for number, (name, (x, y)) in enumerate(points.items()):
            line = LINES[number % len(LINES)] if joined else ""
            panel.plot(x, y, marks[number % len(marks)] + line, label=name, markersize=5, linewidth=0.9)
        panel.set(xscale="log", yscale="log", xlabel=horizontal, ylabel=vertical, title=title)
        panel.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
        return _svg(pyplot, figure)
