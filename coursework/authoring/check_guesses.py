"""The promise that nobody earns more than half by writing the same on every sheet."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

from coursework.authoring.check_report import CheckReport
from coursework.course.variant import Variant
from coursework.model import Part

FEWEST = 50  #: variants, below which chance says more than the exercise does
MOST = 0.5  #: of the points


class Guess(NamedTuple):
    """The best that one text a part, the same on every sheet, earns: its share of the points, and the texts
    by part."""

    share: float
    texts: dict[str, str]


def best_guess(drawn: Sequence[Variant]) -> Guess:
    """Return the best constant answer to the choices and counts of variants, each part by itself.

    A choice is guessed by its letter. Equations in symbols, measured numbers and what a person marks are not
    guessed.
    """
    guesses: dict[str, Counter[str]] = {}
    total = 0.0
    for variant in drawn:
        for part in variant.parts:
            total += part.points
            if (text := _right(variant, part)) is not None:
                guesses.setdefault(part.id, Counter())[text] += part.points  # type: ignore[assignment]
    best = {part: counter.most_common(1)[0] for part, counter in guesses.items()}
    return Guess(
        sum(points for _, points in best.values()) / total if total else 0.0,
        {part: text for part, (text, _) in best.items()},
    )


def _right(variant: Variant, part: Part) -> str | None:
    """Return the right answer to a part as who guesses may write it; None of what nobody guesses."""
    sort = part.sort
    is_guessed = sort.family in ("choice", "choices", "pattern") or (sort.is_exact and sort.is_scalar)
    if sort.is_open or not is_guessed:
        return None
    value = str(variant.key.reference[part.quantity])
    return variant.letters(part).get(value, value)


def check_guesses(drawn: Sequence[Variant], report: CheckReport) -> None:
    """No constant answer earns more than half, chance allowed for."""
    if len(drawn) < FEWEST:
        return
    guess = best_guess(drawn)
    report.counts["guessed"] += len(drawn)
    if guess.share > MOST + MOST / math.sqrt(len(drawn)):
        answers = ", ".join(f"{part} = {text}" for part, text in guess.texts.items())
        report.fail(
            f"who writes the same on every sheet earns {100 * guess.share:.0f} % of the points, and at most "
            f"{100 * MOST:.0f} % would do: {answers}; vary what is drawn, shuffle cases, or weigh less "
            "what is always the same"
        )
