"""Quantities from which another follows, by the solution's formula: names, and no value."""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import TYPE_CHECKING

from coursework.language.words import listed, words

if TYPE_CHECKING:
    from coursework.course.variant import Variant


def needs(variant: Variant, quantity: str) -> tuple[str, ...]:
    """Return the quantities that a quantity's textbook formula takes, hidden ones seen through."""
    graph = variant.exercise.solution.graph
    names: dict[str, None] = {}

    def visit(name: str) -> None:
        node = graph.node(name)
        for argument in node.arguments:
            if argument in node.defaults and argument not in variant.effects:
                continue
            if argument.startswith("_"):
                visit(argument)
            else:
                names.setdefault(argument)

    visit(quantity)
    return tuple(names)


def _on_the_sheet(variant: Variant, quantity: str, asked_quantities: Collection[str]) -> list[str]:
    """Return the given or asked quantities from which a quantity is computed; intermediate ones of the
    solution stand on no sheet."""
    names: dict[str, None] = {}
    met: set[str] = set()

    def visit(name: str) -> None:
        for needed in needs(variant, name):
            if needed in variant.given or (needed in asked_quantities and needed != quantity):
                names.setdefault(needed)
            elif needed not in met and needed in variant.exercise.solution.graph.names:
                met.add(needed)
                visit(needed)

    visit(quantity)
    return list(names)


_MOST = 7  #: names that a sentence lists


def follows_from(variant: Variant, quantity: str) -> str:
    """Return the quantities from which a quantity follows, as Markdown: given ones by symbol, those asked
    before by question.

    What is given as a case, such as an assembly mode, has no symbol and is left out. Nothing where it takes
    none of these, so many that a list of them says nothing, or numbers that stand elsewhere than among the
    data.
    """
    places = {part.quantity: number for number, part in enumerate(variant.parts, start=1)}
    numbers = {name: number for name, number in places.items() if number < places.get(quantity, math.inf)}
    needed = _on_the_sheet(variant, quantity, numbers)
    given = [_symbol(variant, name) for name in variant.stated if name in needed]
    before = [(name, numbers[name]) for name in needed if name in numbers and name not in variant.given]
    numbers_given = (name for name in needed if not isinstance(variant.given.get(name, ""), str))
    if not 0 < len(given) + len(before) <= _MOST or not {*numbers_given} <= variant.stated.keys():
        return ""
    texts, lang = words(variant.lang)["feedback"]["follows"], variant.lang
    noun = words(lang)["sheet"]["question"]["one"]
    pieces = [texts["many_given" if len(given) > 1 else "given"].format(listed(given, lang))] if given else []
    pieces += [_question_words(variant, name, f"{noun} {number}") for name, number in before]
    return str(texts["from"]).format(f"{words(lang)['sheet']['separator']} ".join(pieces))


def _question_words(variant: Variant, name: str, question: str) -> str:
    """Return the symbol and the number of an earlier question, or its number alone where no symbol says
    anything."""
    part = next(p for p in variant.parts if p.quantity == name)
    return f"{_symbol(variant, name)} ({question})" if part.sort.is_called_by_symbol else question


def _symbol(variant: Variant, name: str) -> str:
    """Return a quantity's symbol as Markdown."""
    return f"${variant.symbol(name)}$"
