"""Faded examples: the worked solution of another variant with blanks, more of them at each level."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from typing import TYPE_CHECKING, Any

from coursework.errors import Starved
from coursework.issuing.issuing import distinct_variants
from coursework.rendering.views import chain_on_lines
from coursework.selfstudy import hints
from coursework.selfstudy.theory import unchanging
from coursework.sheets.answer_sheet import answer_sheet, question_called

if TYPE_CHECKING:
    from coursework.course.variant import Variant
    from coursework.model import Part
    from coursework.sheets.sheet import Step

_ANNOUNCES = re.compile(r"[^.!?]*:")  # nothing but what comes next

LEVELS = 4
WITH_FORMULA = 2  #: levels up to which a blank still shows its formula
_FAR = 100_000  #: seeds away from those of fresh variants, so that no example is one of them
_APART = 1_000  #: seeds between levels


def example_variant(variant: Variant, base: int, level: int) -> Variant:
    """Return the variant for an example of a level, different from the attempted ones and from those of other
    levels.

    Raises
    ------
    Starved
        The exercise has no other variant.
    """
    first = base + _FAR + _APART * level
    others = distinct_variants(variant.exercise, first, 2, variant.lang)
    other = next((v for v in others if v.given != variant.given), None)
    if other is None:
        raise Starved(variant.exercise.name)
    return other


def has_example(variant: Variant) -> bool:
    """Return whether the solution has something to leave blank."""
    return bool(blanks(variant, 1))


def blanks(variant: Variant, level: int, *, in_lesson: bool = False) -> tuple[Part, ...]:
    """Return the questions left blank at a level: the last one, a third, two thirds, all; in the order of the
    solution.

    A study session excludes a question with the same answer in every variant, since it would give away the
    attempted one, and parts that are judged together. A lesson may leave both blank: parts judged together
    count as one question.
    """
    places = {step.name: k for k, step in enumerate(_steps(variant))}
    may_be = _may_be_blank_in_lesson if in_lesson else _may_be_blank
    requested = _together([p for p in variant.parts if p.quantity in places and may_be(variant, p)], places)
    count = (1, math.ceil(len(requested) / 3), math.ceil(2 * len(requested) / 3), len(requested))[level - 1]
    return tuple(chain.from_iterable(requested[max(0, len(requested) - count) :]))


def _may_be_blank_in_lesson(variant: Variant, part: Part) -> bool:
    return not part.sort.is_open


def _may_be_blank(variant: Variant, part: Part) -> bool:
    if part.sort.is_open or part.judge or part.loop:
        return False
    return part.id not in unchanging(variant.exercise)


def _together(parts: Iterable[Part], places: Mapping[str, int]) -> list[list[Part]]:
    """Group the parts that are judged together, in the order of the solution, at the position of the first."""
    groups: dict[tuple[str, str], list[Part]] = {}
    for part in sorted(parts, key=lambda p: places[p.quantity]):
        judge = part.judge or part.loop
        groups.setdefault((judge, "" if judge else part.id), []).append(part)
    return list(groups.values())


def _steps(variant: Variant) -> Sequence[Step]:
    return answer_sheet(variant, polygons=False).steps


def _blank(variant: Variant, part: Part, step: Step, keys: Mapping[str, str], text: Any) -> str:
    """Return the room for an answer, after its symbol, or after the number of its question where no symbol
    names it."""
    form = text["blank" if part.sort.has_symbol else "unnamed"]
    question, key = question_called(variant, part), f"`{keys[part.id]}`"
    return str(form.format(symbol=f"${step.symbol}$", question=question, key=key))


def told_steps(
    variant: Variant,
    level: int,
    left: Sequence[Part],
    keys: Mapping[str, str],
    text: Any,
    *,
    in_lesson: bool = False,
) -> str:
    """Return the steps of the solution as Markdown: complete up to the first blank, without numbers from
    there on.

    A study session leaves out steps with the same answer in every variant, since they are asked.
    """
    by_quantity = {p.quantity: p for p in left}
    shared = () if in_lesson else unchanging(variant.exercise)
    hidden = {p.quantity for p in variant.parts if p.id in shared}
    lines: list[str] = []
    is_whole = True
    for step in _steps(variant):
        if step.name in hidden:
            continue
        part = by_quantity.get(step.name)
        is_whole = is_whole and part is None
        if is_whole:
            pieces = [step.words, f"$${chain_on_lines(step)}$$" if step.value else ""]
        else:
            formula = hints.formula(variant, step.name) if level <= WITH_FORMULA or part is None else ""
            if not (part or formula) and _ANNOUNCES.fullmatch(step.words.strip()):
                continue
            blank = _blank(variant, part, step, keys, text) if part else ""
            pieces = [hints.words_of(variant, step.name), formula, blank]
        if any(pieces):
            lines.append("\n\n".join(filter(None, pieces)))
    return "\n\n".join(lines)
