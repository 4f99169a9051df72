"""Messages to a student about answers: about each, and about answers to another variant."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from coursework.course.variant import Variant
from coursework.language.words import words
from coursework.marking.feedback import part_name
from coursework.marking.mark import Mark, SheetMarks
from coursework.selfstudy import predictions
from coursework.selfstudy.store import ExerciseStore, is_blank


def sign_of(mark: Mark) -> str:
    """Return the symbol of a verdict at the head of a line, distinct without colour."""
    if mark.verdict == "correct":
        return "✓"
    if mark.verdict == "to_mark":
        return "…"
    if mark.verdict in ("unreadable", "missing_unit", "wrong_unit"):
        return "?"
    return "≈" if mark.points else "✗"


def sentence_of(variant: Variant, mark: Mark, reveal: str) -> str:
    """Return the message about an answer; for an answer that nobody will mark, it says what to write instead.

    ``reveal`` is the call that shows the value of an open question.
    """
    if mark.verdict == "to_mark":
        part = next(p for p in variant.parts if p.id == mark.part)
        name, sentence = part_name(variant, part), words(variant.lang)["marking"]["open"]
        return sentence.format(name=name[:1].upper() + name[1:], call=reveal)
    if mark.verdict != "unreadable":
        return mark.says
    table = words(variant.lang)["marking"]["unreadable"]
    part = next(p for p in variant.parts if p.id == mark.part)
    family = part.sort.family
    general = [table["otherwise"]] if family == "number" else [table["otherwise"], table["not_a_number"]]
    if not part.choices and not any(mark.says.endswith(s.rpartition("{found}")[2]) for s in general):
        return mark.says
    colon = words(variant.lang)["sheet"]["colon"]
    name = part_name(variant, part)
    choices = predictions.choices(variant, part)
    return f"{name[:1].upper()}{name[1:]}{colon} " + words(variant.lang)["study"]["not_read"][family].format(
        found=quoted(mark.answer), choices=choices
    )


def same_as_another(
    variant: Variant, stored: ExerciseStore, given: Mapping[str, Any], marking: SheetMarks
) -> tuple[int | None, list[str]]:
    """Return the seed of another variant for which these answers are right, and the parts that are wrong
    here.

    A copy needs at least two numbers that are wrong here and would differ there: an answer that is right in
    both, or a small whole number, may well be the same.
    """
    written = {n: a for n, a in given.items() if not is_blank(a)}
    wrong = [p for p in variant.parts if p.id in written and marking[p.id].verdict != "correct"]
    wrong = [p for p in wrong if not p.is_exact]
    for seed in stored.seeds if len(wrong) > 1 else ():
        theirs = stored.of(seed, "answers")
        if seed == variant.seed or any(theirs.get(n) != a for n, a in written.items()):
            continue
        other = variant.exercise.variant(seed, variant.lang).walk
        here = variant.walk
        differ = [p.id for p in wrong if not _are_same(other.get(p.quantity), here.get(p.quantity))]
        if len(differ) > 1:
            return seed, differ
    return None, []


def _are_same(first: Any, other: Any) -> bool:
    if first is None or other is None:
        return first is other
    return bool(np.array_equal(np.asarray(first), np.asarray(other)))


def is_open(variant: Variant, mark: Mark) -> bool:
    return next(p for p in variant.parts if p.id == mark.part).sort.is_open


def judged_out_of(variant: Variant, marking: SheetMarks) -> float:
    """Return the total points of the parts that are marked here."""
    return sum(m.out_of for m in marking.values() if not is_open(variant, m))


def quoted(text: Any) -> str:
    """Return an answer, shortened, without characters that Markdown takes for markup."""
    wording = "".join(c for c in str(text) if c.isprintable() and c not in "$`*_\\<>[]#|{}")
    return wording if len(wording) <= 60 else f"{wording[:59]}…"
