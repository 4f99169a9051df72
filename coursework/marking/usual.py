"""The usual errors that give an answer: which, and their messages."""

from __future__ import annotations

import ast
import math
from collections.abc import Callable, Collection, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from coursework.course.answer_key import Key
from coursework.course.error_values import NEIGHBOUR, TAKEN, UsualError
from coursework.kinds.nearness import gaps
from coursework.language.words import listed, words
from coursework.model import Part
from coursework.parsing.reading import Reading
from coursework.quantities.formula_latex import PrintedName, tree_latex
from coursework.quantities.rounding import half_step
from coursework.quantities.usual_errors import formula_errors

if TYPE_CHECKING:
    from coursework.course.variant import Variant

NAMED = 3  #: errors that fit one answer; of more than these none is named
_SHORT = 2  #: names of a formula that may be printed whole: it is a term of one factor
_LONGEST = 4  #: names of a term that is printed
#: Half-widths from the value that a usual error, or a mistake made elsewhere, gives: of so many some are near
#: to anything.
NEAR = 0.35
NEAR_HERE = 0.7  #: the same of a mistake about the asked quantity itself, of which there are few
NEAR_DEGREES = 0.1  #: the same of a direction, of which fewer are far apart
_LEAST = 0.02  #: half-widths within which rounding on the way brings whoever makes an error
#: Half-widths of a number that all the errors in play may take together: the more there are, the nearer each
#: must be.
_BY_CHANCE = 1.2
_FEW = 3  #: digits of an answer that was rounded
_SAME = 1e-9  #: of a value: what two ways to compute it may differ by


class Fit(NamedTuple):
    """An error that gives an answer."""

    error: UsualError
    reading: int  #: which honest reading it gives
    gap: float  #: in half-widths
    is_here: bool  #: made in this very quantity
    alike: tuple[UsualError, ...]  #: all the errors that give the same value, itself among them


def usual_errors_that_fit(
    key: Key, part: Part, reading: Reading, judged_by: Part, right: Collection[str], answered: Collection[str]
) -> list[Fit]:
    """Return the usual errors that give an answer, of several that give the same value the first.

    None that is made in a quantity which was answered: what follows from that answer is another matter. None
    that would have changed an answer that is ``right``.
    """
    quantity = judged_by.quantity
    if not part.sort.is_scalar or part.judge:
        return []
    errors, values = key.usual_ways(quantity)
    quantities = {p.quantity for p in key.variant.parts}

    def may_be(error: UsualError) -> bool:
        if part.sort.is_exact and error.source != quantity:
            return False  # of whole numbers too many are alike
        if error.kind == NEIGHBOUR:
            return error.source in quantities
        if error.kind in TAKEN:
            return True
        is_elsewhere = error.source != quantity
        return not (is_elsewhere and error.source in answered) and not any(
            _contradicts(key, error, q) for q in right if q != quantity
        )

    return _near(key, part, reading, judged_by, errors, values, may_be)


def own_errors_that_fit(
    key: Key, part: Part, reading: Reading, judged_by: Part, own_answers: Mapping[str, Any]
) -> list[Fit]:
    """Return the usual errors in a quantity's own formula that give an answer from a student's
    ``own_answers`` earlier ones."""
    if not part.sort.is_scalar or part.judge:
        return []
    errors, values = key.usual_ways_from(judged_by.quantity, own_answers)
    return _near(key, part, reading, judged_by, errors, values, lambda _: True, is_own=True)


def _near(
    key: Key,
    part: Part,
    reading: Reading,
    judged_by: Part,
    errors: tuple[UsualError, ...],
    values: np.ndarray,
    may_be: Callable[[UsualError], bool],
    *,
    is_own: bool = False,
) -> list[Fit]:
    """Return the errors near whose values an answer is, of those that may be; of several that give one value
    the first.

    What is computed from a student's own written answers is moved by their rounding.
    """
    hits: dict[tuple[int, float], Fit] = {}
    for reading_index, answer in enumerate(reading.values):
        if part.sort.is_trivial(answer):
            continue  # whatever is left out of a product leads there
        close = _close(part, key, judged_by, values, answer)
        if not len(close):
            continue
        given = values[close]
        away = _gaps(part, key, judged_by, given, answer)
        usual = NEAR_DEGREES if part.sort.turn else NEAR
        apart = max(_LEAST, _BY_CHANCE / max(len(errors), 1))
        near = nearness(part, key, judged_by, answer, usual if is_own else min(usual, apart))
        is_written_so = not part.sort.turn and np.abs(given - answer) <= half_step(given, key.rules.digits)
        for index in np.flatnonzero((away <= near) | (is_written_so & np.isfinite(away))):
            error, same = errors[close[index]], (reading_index, float(f"{float(given[index]):.9g}"))
            if may_be(error):
                is_here = error.source == judged_by.quantity or error.kind in TAKEN
                first = hits.get(same, Fit(error, reading_index, float(away[index]), is_here, ()))
                hits[same] = first._replace(alike=(*first.alike, error))
    return list(hits.values())


def last_digit(part: Part, answer: Any) -> float:
    """Half of the last digit of an answer of few digits, in its unit: by so much it may be off; 0 for one of
    more."""
    if not part.sort.is_number or float(f"{answer:.{_FEW}g}") != answer:
        return 0.0
    return float(half_step(answer, _FEW))


def nearness(part: Part, key: Key, judged_by: Part, answer: Any, usual: float) -> float:
    """Return the distance in half-widths within which an answer is taken for a value: the usual one, or what
    its last digit allows."""
    width = key.half_width(judged_by)
    return min(1.0, max(usual, last_digit(part, answer) / width)) if width else usual


def _close(part: Part, key: Key, judged_by: Part, values: np.ndarray, answer: float) -> np.ndarray:
    """Return the places of the values within whose widest margin an answer lies: few, whose distances are
    then computed."""
    width = key.half_width(judged_by)
    with np.errstate(all="ignore"):
        digit = 0.0 if part.sort.turn else 10.0 ** (1 - key.rules.digits) * np.abs(values)
        return np.flatnonzero(gaps(values, answer, part.sort.turn) <= width + digit)


def _gaps(part: Part, key: Key, judged_by: Part, values: np.ndarray, answer: float) -> np.ndarray:
    """Return the distance of an answer from each value, in the half-widths that such a value would have."""
    reference = key.reference[judged_by.quantity]
    with np.errstate(all="ignore"):
        gap = gaps(values, answer, part.sort.turn)
        width = np.full_like(gap, key.half_width(judged_by))
        if not part.sort.turn and reference:
            # Rounding moves what is small as little, and what is large by its own digits.
            width = width * np.minimum(np.abs(values / reference), 1.0)
            if part.has_margin:
                width = np.maximum(width, half_step(values, key.rules.digits))
        # Where the reference is the same value, the answer is right or wrong for another reason.
        is_other = np.abs(values - reference) > _SAME * abs(reference)
        distances = np.where(gap == 0, 0.0, gap / width)
    return np.where(is_other & np.isfinite(distances), distances, np.inf)


def _contradicts(key: Key, error: UsualError, quantity: str) -> bool:
    """Return whether a right answer proves that an error was not made."""
    part = next((p for p in key.variant.parts if p.quantity == quantity), None)
    if part is None or not part.sort.is_scalar or part.judge or not part.sort.disproves:
        return False
    value = key.usual_value(error, quantity)
    if not math.isfinite(value):
        return False
    width = key.envelope.get(quantity, 0.0)
    return part.sort.apart(part, value, key.reference[quantity], None, width) > 1


# ------------------------------------------------------------------------ messages


def why(variant: Variant, error: UsualError, quantity: str) -> str:
    """Return the text of an error, Markdown: ``the term $r_2^2$ is left out``.

    Symbols that stand on no sheet of the exercise are not printed, and of a formula never the whole.
    """
    table = words(variant.lang)["marking"]["usual"]
    seen = {*variant.given, *(part.quantity for part in variant.exercise.spec.parts)}
    if error.kind in TAKEN:
        numbers = [n for n, p in enumerate(variant.parts, start=1) if p.quantity == error.source]
        if not numbers and error.source not in seen:
            return str(table["taken_hidden"])
        form = table["taken_asked"] if numbers else table["taken"]
        number = numbers[0] if numbers else 0
        return str(form.format(term=f"${variant.solution_symbol(error.source)}$", number=number))
    node = variant.exercise.solution.graph.textbook.node(error.source)
    usual_error = formula_errors(node.function)[error.place]
    about = usual_error.about
    if about is not None and not _may_be_shown(about, usual_error.formula.names, seen):
        sentence = str(table["hidden"][error.kind])
    else:
        printed_names = {
            name: PrintedName(
                variant.solution_symbol(name),
                False,
                "angle" if variant.exercise.units.get(name) == "deg" else "",
            )
            for name in usual_error.formula.names
        }
        term = "" if about is None else tree_latex(about, printed_names, usual_error.formula.space)
        form = table[error.kind] if term or about is None else table["unnamed"]
        sentence = str(form.format(term=f"${term}$"))
    if error.source == quantity:
        return sentence
    if error.source not in seen:
        return str(table["elsewhere_hidden"].format(why=sentence))
    return str(table["elsewhere"].format(where=f"${variant.solution_symbol(error.source)}$", why=sentence))


def _may_be_shown(about: ast.expr, formula: Collection[str], seen: Collection[str]) -> bool:
    """Return whether a term holds only symbols that the student knows, and not all of a formula of
    several."""
    names = {node.id for node in ast.walk(about) if isinstance(node, ast.Name)} & {*formula}
    return (
        names <= {*seen} and (len(names) < len(formula) or len(formula) <= _SHORT) and len(names) <= _LONGEST
    )


def whys(variant: Variant, errors: Collection[UsualError], quantity: str) -> tuple[str, bool]:
    """Return the words for errors that cannot be distinguished, and whether there is only one."""
    sentences = list(dict.fromkeys(why(variant, error, quantity) for error in errors))
    return listed(sentences, variant.lang, "or"), len(sentences) == 1
