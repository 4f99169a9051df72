"""One error costs once: which answers show an error that an earlier answer has paid for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations
from typing import TYPE_CHECKING

from coursework.language.words import words
from coursework.marking.feedback import Said, questions
from coursework.marking.mark import Mark
from coursework.model import Part
from coursework.quantities.graph import Graph

if TYPE_CHECKING:
    from coursework.course.variant import Variant

_SEVERAL = 4  #: quantities at least that formulas of one equation take


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
    """Asked numbers of one unit that a formula takes, all that it takes, or that are computed from nearly the same: ids of
    two parts at least. No angles: one of the opposite sign is another direction."""
    graph = variant.exercise.solution.graph.textbook
    asked = {p.quantity: p for p in parts.values() if p.sort.is_number and not p.sort.turn and not p.judge}
    yield from _computed_alike(graph, asked, parts)
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


def _computed_alike(
    graph: Graph, asked: Mapping[str, Part], parts: Mapping[str, Part]
) -> Iterator[list[str]]:
    """Pairs of one unit whose formulas take the same but for a quantity each: the two rates of a loop."""
    needs = {q: frozenset(graph.node(q).arguments) for q in asked if q in graph.names}
    for (one, first), (other, second) in combinations(needs.items(), 2):
        if len(first) >= _SEVERAL and len(first ^ second) <= 2 and asked[one].unit == asked[other].unit:
            yield sorted((asked[one].id, asked[other].id), key=list(parts).index)
