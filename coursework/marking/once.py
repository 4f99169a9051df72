"""One error costs once: which answers show an error that an earlier answer has paid for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from coursework.language.words import words
from coursework.marking.explaining import Explanation
from coursework.marking.feedback import Said, questions
from coursework.marking.mark import Mark
from coursework.model import Part
from coursework.quantities.usual_errors import ALL_DEGREES, DEGREES

if TYPE_CHECKING:
    from coursework.course.variant import Variant

_OF_UNIT = ("unit", "radians", "turns_a_minute")  #: made alike wherever a unit is written


def identity(explanation: Explanation) -> str:
    """What two answers have in common that show one error; empty where each is an error of its own."""
    kind, _, name = explanation.verdict.partition(":")
    if kind == "mistake":
        return explanation.verdict
    if explanation.error is not None:
        if explanation.error.kind in (DEGREES, ALL_DEGREES):
            return ALL_DEGREES  # the calculator is set so for all formulas
        return "/".join(map(str, explanation.error))
    return name if name in _OF_UNIT else ""


def signs_counted_once(variant: Variant, marks: Mapping[str, Mark], share: float) -> dict[str, Mark]:
    """Marks where turning every sign of an equation is one error: of quantities that a formula takes together, all
    with the opposite sign, the first alone pays."""
    turned = {i for i, mark in marks.items() if _is_turned(variant, mark)}
    if len(turned) < 2:
        return dict(marks)
    parts = {part.id: part for part in variant.parts}
    told: dict[str, Mark] = {}
    for group in _taken_together(variant, parts):
        first, *others = group
        if turned.issuperset(group):
            for i in others:
                note = words(variant.lang)["marking"]["sign_with"]
                said = Said(note, {"first": questions(variant, [first], "and")})
                mark = marks[i]
                told[i] = mark._replace(
                    verdict="follow_through", points=share * mark.out_of, told=(*mark.told, said)
                )
    return {**marks, **told}


def _is_turned(variant: Variant, mark: Mark) -> bool:
    kind, _, name = mark.verdict.partition(":")
    if kind == "mistake":
        return variant.key.solution.mistakes[name].kind == "sign" and "slip:sign" in mark.matches
    return mark.verdict == "slip:sign"


def _taken_together(variant: Variant, parts: Mapping[str, Part]) -> Iterator[list[str]]:
    """Asked numbers of one unit that a formula takes, all that it takes: ids of two parts at least."""
    graph = variant.exercise.solution.graph.textbook
    asked = {p.quantity: p for p in parts.values() if p.sort.is_number and not p.judge}
    seen: set[tuple[str, ...]] = set()
    for name in graph.quantities:
        by_unit: dict[str, list[str]] = {}
        for argument in graph.node(name).arguments:
            if argument in asked:
                by_unit.setdefault(asked[argument].unit, []).append(asked[argument].id)
        for group in by_unit.values():
            ids = sorted(group, key=list(parts).index)
            if len(ids) > 1 and tuple(ids) not in seen:
                seen.add(tuple(ids))
                yield ids
