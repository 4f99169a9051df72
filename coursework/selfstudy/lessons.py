"""What lessons show: predictions beside what came out, and curves."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from coursework.figures.plot import Axis, Plot
from coursework.language import localise, significant, words
from coursework.rendering.shown import Picture, Shown
from coursework.selfstudy.kept import is_blank


def compare(predicted: Mapping[str, Any], found: Mapping[str, Any], lang: str = "fr") -> Shown:
    """Predictions beside what came out, as a notebook's cell shows them.

    Numbers agree within a tenth; texts and truths when they are the same. A prediction that is None or blank is
    shown as not made.

    >>> print(compare({"a": 2, "b": None}, {"a": 2.1, "b": 5}, "en"))
    - ✓ a: predicted 2, found 2.1
    - · b: no prediction, found 5
    """
    said = words(lang)["study"]
    lines = []
    for name, value in found.items():
        guess = predicted.get(name)
        mark = "·" if is_blank(guess) else "✓" if _agree(guess, value) else "✗"
        line = said["not_predicted"] if is_blank(guess) else said["predicted"]
        lines.append(f"- {mark} {line.format(name=name, said=_told(guess, lang), found=_told(value, lang))}")
    return Shown(lang, "\n".join(lines))


def _agree(guess: Any, value: Any) -> bool:
    if isinstance(value, (bool, np.bool_, str)) or isinstance(guess, (bool, str)):
        return str(guess).strip().casefold() == str(value).strip().casefold()
    try:
        return abs(float(guess) - float(value)) <= 0.1 * abs(float(value))
    except (TypeError, ValueError):
        return False


def _told(value: Any, lang: str) -> str:
    said = words(lang)["study"]
    if isinstance(value, (bool, np.bool_)):
        return said["yes"] if value else said["no"]
    if isinstance(value, (int, float, np.number)):
        return localise(significant(value), lang)
    return str(value)


def plot(
    over: tuple[str, str, Any],
    curves: Mapping[str, tuple[str, Any]],
    *,
    lang: str = "fr",
    at: float | None = None,
) -> Shown:
    r"""Curves over one variable, a panel each, as a notebook's cell shows them.

    Parameters
    ----------
    over
        The variable: LaTeX symbol or words, unit, values: ``(r"\theta_2", "°", np.arange(361))``.
    curves
        By LaTeX symbol or words, the unit and as many values as the variable has; NaN where there is none.
    lang
        Language of the numbers.
    at
        A place on the variable that is marked.

    Raises
    ------
    WrongValue
        No curve, or one of another length.
    """
    symbol, unit, values = over
    panels = [Axis(label, of, np.asarray(y, dtype=float)) for label, (of, y) in curves.items()]
    drawn = Plot(Axis(symbol, unit, np.asarray(values, dtype=float)), panels, lang, at)
    return Shown(lang, Picture(drawn.svg(), f"{', '.join(curves)} / {symbol}"))
