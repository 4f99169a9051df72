"""Output of lessons: predictions with their outcomes, and curves."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

import numpy as np

from coursework.figures.plot import Axis, Plot
from coursework.language.numbers import localise, significant
from coursework.language.words import words
from coursework.markup.shown import NotebookDisplay, SvgPicture
from coursework.selfstudy.refusals import would_do
from coursework.selfstudy.store import is_blank
from coursework.selfstudy.word_answers import folded, numbers, truth, unwrapped

_NEAR = 0.1
_NEAR_ANGLE = 10.0  #: degrees
_NEAR_ZERO = 0.02  #: where a tenth would be nothing


class PredictionTable(NotebookDisplay):
    """Predictions with their outcomes; ``outcome`` holds the outcomes alone, for readers on paper."""

    outcome = ""


def compare(
    predicted: Mapping[str, Any],
    results: Mapping[str, Any],
    lang: str = "fr",
    angles: Collection[str] = (),
) -> PredictionTable:
    """Return the predictions with their outcomes, for display in a notebook cell.

    Numbers agree within a tenth, angles within 10°, whole turns apart or not; texts and truths when they are the
    same. Numbers may be texts with a comma and a unit, truths yes and no in any language. A prediction that is None
    or blank is shown as not made, and one under a name that nothing has come out of is told.

    Parameters
    ----------
    predicted, found
        By the same names.
    lang
        Language of what is said.
    angles
        The names of what is an angle in degrees; a prediction in degrees makes it one.

    >>> print(compare({"a": 2, "b": None}, {"a": 2.1, "b": 5}, "en"))
    - ✓ a: predicted 2, found 2.1
    - · b: no prediction, found 5
    """
    texts = words(lang)["study"]
    lines = []
    for name, value in results.items():
        guess = unwrapped(predicted.get(name))
        agrees = not is_blank(guess) and _agree(guess, unwrapped(value), name in angles)
        mark = "·" if is_blank(guess) else "✓" if agrees else "✗"
        line = texts["not_predicted"] if is_blank(guess) else texts["predicted"]
        lines.append(
            f"- {mark} {line.format(name=name, said=_outcome_text(guess, lang), found=_outcome_text(value, lang))}"
        )
    for name, guess in predicted.items():
        if name not in results and not is_blank(guess):
            line = texts["refused"]["lesson_name"].format(name=name, said=_outcome_text(guess, lang))
            lines.append(f"- ? {line} {would_do(lang, str(name), list(results))}")
    displayed = PredictionTable(lang, "\n".join(lines))
    displayed.outcome = "\n".join(
        f"- {name}{words(lang)['sheet']['colon']} {_outcome_text(value, lang)}"
        for name, value in results.items()
    )
    return displayed


def _agree(guess: Any, value: Any, is_angle: bool) -> bool:
    if isinstance(value, bool):
        return truth(guess) is value
    if isinstance(value, str) or isinstance(guess, bool):
        return folded(guess) == folded(value)
    guesses, in_degrees = numbers(guess)
    if not isinstance(value, (int, float)):
        return folded(guess) == folded(value)
    if is_angle or in_degrees:
        return any(abs((g - value + 180.0) % 360.0 - 180.0) <= _NEAR_ANGLE for g in guesses)
    return any(abs(g - value) <= max(_NEAR * abs(value), _NEAR_ZERO) for g in guesses)


def _outcome_text(value: Any, lang: str) -> str:
    texts = words(lang)["study"]
    if isinstance(value, (bool, np.bool_)):
        return texts["yes"] if value else texts["no"]
    if isinstance(value, (int, float, np.number)):
        return localise(significant(float(value)), lang)
    return str(value)


def plot(
    over: tuple[str, str, Any],
    curves: Mapping[str, tuple[str, Any]],
    *,
    lang: str = "fr",
    at: float | None = None,
) -> NotebookDisplay:
    r"""Plot curves over one variable, a panel each, for display in a notebook cell.

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
    return NotebookDisplay(lang, SvgPicture(drawn.svg(), f"{', '.join(curves)} / {symbol}"))
