"""The usual errors that give an answer: which, and how they are told."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from coursework.course.answer_key import Key
from coursework.course.error_values import NEIGHBOUR, TAKEN, UsualError
from coursework.language.words import listed, words
from coursework.marking.feedback import symbol
from coursework.model import Part
from coursework.quantities.formula_latex import Told, tree_latex
from coursework.quantities.rounding import half_step
from coursework.quantities.usual_errors import formula_errors
from coursework.reading.reading import Reading

if TYPE_CHECKING:
    from coursework.course.variant import Variant

NAMED = 3  #: errors that fit one answer; of more than these none is named
NEAR = 0.35  #: half-widths from the value that a usual error gives, for an answer of more digits than a few
_FEW = 3  #: digits of an answer that was rounded
_SAME = 1e-9  #: of a value: what two ways to compute it may differ by


class Fit(NamedTuple):
    """An error that gives an answer."""

    error: UsualError
    reading: int  #: which honest reading it gives
    gap: float  #: in half-widths
    is_here: bool  #: made in this very quantity


def usual_errors_that_fit(
    key: Key, part: Part, reading: Reading, judged_by: Part, right: Collection[str], answered: Collection[str]
) -> list[Fit]:
    """The usual errors that give an answer, of several that give the same value the first.

    None that is made in a quantity which was answered: what follows from that answer is another matter. None that
    would have changed an answer that is ``right``.
    """
    quantity = judged_by.quantity
    if not part.sort.is_scalar or part.judge:
        return []
    errors, values = key.usual_ways(quantity)
    asked = {p.quantity for p in key.variant.parts}
    found: list[Fit] = []
    given_by: set[tuple[int, float]] = set()
    for place, answer in enumerate(reading.values):
        if part.sort.is_trivial(answer):
            continue  # whatever is left out of a product leads there
        gaps = _gaps(part, key, judged_by, values, answer)
        for index in np.flatnonzero(gaps <= _nearness(part, key, judged_by, answer)):
            error, value = errors[index], float(values[index])
            is_here = error.source == quantity or error.kind in TAKEN
            if part.sort.is_exact and error.source != quantity:
                continue  # of whole numbers too many are alike
            if not is_here and error.source in answered:
                continue
            if error.kind == NEIGHBOUR and error.source not in asked:
                continue
            if (same := (place, _rounded(value))) in given_by:
                continue
            if error.kind not in TAKEN and any(_contradicts(key, error, q) for q in right if q != quantity):
                continue
            given_by.add(same)
            found.append(Fit(error, place, float(gaps[index]), is_here))
    return found


def _nearness(part: Part, key: Key, judged_by: Part, answer: float) -> float:
    """How near to an error's value an answer must be, in half-widths: among so many errors some are near to anything.

    An answer of few digits may be off by half of the last.
    """
    width = key.half_width(judged_by)
    if not width or float(f"{answer:.{_FEW}g}") != answer:
        return NEAR
    return min(1.0, max(NEAR, float(half_step(answer, _FEW)) / width))


def _rounded(value: float) -> float:
    return float(f"{value:.9g}")


def _gaps(part: Part, key: Key, judged_by: Part, values: np.ndarray, answer: float) -> np.ndarray:
    """How far an answer is from each value, in the half-widths that such a value would have."""
    reference = key.reference[judged_by.quantity]
    with np.errstate(all="ignore"):
        gap = np.abs(values - answer)
        if turn := part.sort.turn:
            gap = np.abs(gap - turn * np.rint(gap / turn))
        width = np.full_like(gap, key.half_width(judged_by))
        if not turn and reference:
            # Rounding moves what is small as little, and what is large by its own digits.
            width = width * np.minimum(np.abs(values / reference), 1.0)
            if part.has_margin:
                width = np.maximum(width, half_step(values, key.rules.digits))
        # Where the reference is the same value, the answer is right or wrong for another reason.
        is_other = np.abs(values - reference) > _SAME * abs(reference)
        gaps = np.where(gap == 0, 0.0, gap / width)
    return np.where(is_other & np.isfinite(gaps), gaps, np.inf)


def _contradicts(key: Key, error: UsualError, quantity: str) -> bool:
    """Whether an answer that is right shows that an error was not made."""
    part = next((p for p in key.variant.parts if p.quantity == quantity), None)
    if part is None or not part.sort.is_scalar or part.judge or not part.sort.disproves:
        return False
    errors, values = key.usual_ways(quantity)
    if error not in errors:
        return False
    value = float(values[errors.index(error)])
    if not np.isfinite(value):
        return False
    width = key.envelope.get(quantity, 0.0)
    return part.sort.apart(part, value, key.reference[quantity], None, width) > 1


# ---------------------------------------------------------------------------- told


def why(variant: Variant, error: UsualError, quantity: str) -> str:
    """How an error is told, Markdown: ``the term $r_2^2$ is left out``."""
    table = words(variant.lang)["marking"]["usual"]
    if error.kind in TAKEN:
        asked = [n for n, p in enumerate(variant.parts, start=1) if p.quantity == error.source]
        form = table["taken_asked"] if asked else table["taken"]
        number = asked[0] if asked else 0
        return str(form.format(term=f"${symbol(variant, error.source)}$", number=number))
    node = variant.exercise.solution.graph.textbook.node(error.source)
    found = formula_errors(node.function)[error.place]
    shown = {
        name: Told(symbol(variant, name), False, "angle" if variant.exercise.units.get(name) == "deg" else "")
        for name in found.formula.names
    }
    term = "" if found.about is None else tree_latex(found.about, shown, found.formula.space)
    form = table[error.kind] if term or found.about is None else table["unnamed"]
    told = str(form.format(term=f"${term}$"))
    if error.source == quantity:
        return told
    return str(table["elsewhere"].format(where=f"${symbol(variant, error.source)}$", why=told))


def whys(variant: Variant, errors: Collection[UsualError], quantity: str) -> str:
    """How one error is told, or one of several."""
    told = list(dict.fromkeys(why(variant, error, quantity) for error in errors))
    if len(told) == 1:
        return told[0]
    return str(words(variant.lang)["marking"]["usual"]["several"].format(listed(told, variant.lang, "or")))
