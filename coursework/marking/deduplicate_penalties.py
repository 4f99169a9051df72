"""One error costs once: which answers show an error that an earlier answer has paid for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations
from typing import TYPE_CHECKING

from coursework.language.words import words
from coursework.marking.feedback import Sentence, questions
from coursework.marking.mark import Mark
from coursework.model import Part
from coursework.quantities.graph import Graph

if TYPE_CHECKING:
    from coursework.course.variant import Variant

_SEVERAL = 4  #: quantities at least that formulas of one equation take


def signs_counted_once(variant: Variant, marks: Mapping[str, Mark], share: float) -> dict[str, Mark]:
    """Return the marks where turning every sign of an equation is one error: of quantities that a formula
    takes together, all with the opposite sign, the first alone pays."""
    turned = {i for i, mark in marks.items() if _is_turned(variant, mark)}
    if len(turned) < 2:
        return dict(marks)
    parts = {part.id: part for part in variant.parts}
    first_by_group: dict[str, Mark] = {}
    for group in _taken_together(variant, parts):
        first, *others = group
        if turned.issuperset(group):
            for i in others:
                note = words(variant.lang)["marking"]["sign_with"]
                message = Sentence(note, {"first": questions(variant, [first], "and")})
                mark = marks[i]._replace(verdict="follow_through", points=share * marks[i].out_of)
                first_by_group[i] = mark.saying(*message.texts(variant.lang))
    return {**marks, **first_by_group}


def _is_turned(variant: Variant, mark: Mark) -> bool:
    kind, _, name = mark.verdict.partition(":")
    if kind == "mistake":
        return variant.key.solution.mistakes[name].kind == "sign" and "slip:sign" in mark.matches
    return mark.verdict == "slip:sign"


def _taken_together(variant: Variant, parts: Mapping[str, Part]) -> Iterator[list[str]]:
    """Asked numbers of one unit that a formula takes, all that it takes, or that are computed from nearly the
    same: ids of two parts at least. No angles: one of the opposite sign is another direction."""
    graph = variant.exercise.solution.graph.textbook
    number_parts = {
        p.quantity: p for p in parts.values() if p.sort.is_number and not p.sort.turn and not p.judge
    }
    yield from _computed_alike(graph, number_parts, parts)
    seen: set[tuple[str, ...]] = set()
    for name in graph.quantities:
        by_unit: dict[str, list[str]] = {}
        for argument in graph.node(name).arguments:
            if argument in number_parts:
                by_unit.setdefault(number_parts[argument].unit, []).append(number_parts[argument].id)
        for group in by_unit.values():
            ids = sorted(group, key=list(parts).index)
            if len(ids) > 1 and tuple(ids) not in seen:
                seen.add(tuple(ids))
                yield ids


def _computed_alike(
    graph: Graph, number_parts: Mapping[str, Part], parts: Mapping[str, Part]
) -> Iterator[list[str]]:
    """Pairs of one unit whose formulas take the same but for a quantity each: the two rates of a loop."""
    needs = {q: frozenset(graph.node(q).arguments) for q in number_parts if q in graph.names}
    for (earlier, first), (other, second) in combinations(needs.items(), 2):
        if (
            len(first) >= _SEVERAL
            and len(first ^ second) <= 2
            and number_parts[earlier].unit == number_parts[other].unit
        ):
            yield sorted((number_parts[earlier].id, number_parts[other].id), key=list(parts).index)
