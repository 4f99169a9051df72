"""What a quantity follows from, as the solution's formula has it: names, and no value."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

from coursework.language.words import listed, words

if TYPE_CHECKING:
    from coursework.course.variant import Variant


def needs(variant: Variant, quantity: str) -> tuple[str, ...]:
    """The quantities that a quantity's textbook formula takes, hidden ones seen through."""
    graph = variant.exercise.solution.graph
    found: dict[str, None] = {}

    def visit(name: str) -> None:
        node = graph.node(name)
        for argument in node.arguments:
            if argument in node.defaults and argument not in variant.effects:
                continue
            if argument.startswith("_"):
                visit(argument)
            else:
                found.setdefault(argument)

    visit(quantity)
    return tuple(found)


def _on_the_sheet(variant: Variant, quantity: str, asked: Collection[str]) -> list[str]:
    """What a quantity is computed from, of what is given or asked: what the solution finds on the way stands on no sheet."""
    found: dict[str, None] = {}
    met: set[str] = set()

    def visit(name: str) -> None:
        for needed in needs(variant, name):
            if needed in variant.given or (needed in asked and needed != quantity):
                found.setdefault(needed)
            elif needed not in met and needed in variant.exercise.solution.graph.names:
                met.add(needed)
                visit(needed)

    visit(quantity)
    return list(found)


_MOST = 7  #: names that a sentence lists


def follows_from(variant: Variant, quantity: str) -> str:
    """What a quantity follows from, as Markdown: by symbol what is given, by question what is asked before.

    Nothing where it takes none of these, or so many that a list of them says nothing.
    """
    asked = {part.quantity: number for number, part in enumerate(variant.parts, start=1)}
    needed = _on_the_sheet(variant, quantity, asked)
    given = [_symbol(variant, name) for name in needed if name in variant.given]
    before = [(name, asked[name]) for name in needed if name in asked and name not in variant.given]
    if not 0 < len(given) + len(before) <= _MOST:
        return ""
    said, lang = words(variant.lang)["feedback"]["follows"], variant.lang
    noun = words(lang)["sheet"]["question"]["one"]
    pieces = [said["many_given" if len(given) > 1 else "given"].format(listed(given, lang))] if given else []
    pieces += [_asked(variant, name, f"{noun} {number}") for name, number in before]
    return str(said["from"]).format(f"{words(lang)['sheet']['separator']} ".join(pieces))


def _asked(variant: Variant, name: str, question: str) -> str:
    """What an earlier question asks: its symbol and its number, or its number alone where no symbol says anything."""
    part = next(p for p in variant.parts if p.quantity == name)
    return f"{_symbol(variant, name)} ({question})" if part.sort.is_called_by_symbol else question


def _symbol(variant: Variant, name: str) -> str:
    """A quantity's symbol as Markdown."""
    return f"${variant.exercise.solution.symbols.get(name) or variant.exercise.symbol(name)}$"
