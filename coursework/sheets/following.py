"""What a quantity follows from, as the solution's formula has it: names, and no value."""

from __future__ import annotations

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


_MOST = 7  #: names that a sentence lists


def follows_from(variant: Variant, quantity: str) -> str:
    """What a quantity follows from, as Markdown: by symbol what is given, by question what is asked before.

    Nothing where it takes none of these, or so many that a list of them says nothing.
    """
    asked = {part.quantity: number for number, part in enumerate(variant.parts, start=1)}
    needed = [name for name in needs(variant, quantity) if name != quantity]
    given = [_symbol(variant, name) for name in needed if name in variant.given]
    before = [(name, asked[name]) for name in needed if name in asked and name not in variant.given]
    between = [
        _symbol(variant, name)
        for name in needed
        if name not in asked
        and name not in variant.given
        and isinstance(variant.walk.get(name), (int, float, complex))
    ]
    if not 0 < len(given) + len(before) + len(between) <= _MOST:
        return ""
    said, lang = words(variant.lang)["feedback"]["follows"], variant.lang
    noun = words(lang)["sheet"]["question"]["one"]
    pieces = [said["many_given" if len(given) > 1 else "given"].format(listed(given, lang))] if given else []
    pieces += [_asked(variant, name, f"{noun} {number}") for name, number in before]
    pieces += [said["between"].format(listed(between, lang))] if between else []
    return str(said["from"]).format(f"{words(lang)['sheet']['separator']} ".join(pieces))


def _asked(variant: Variant, name: str, question: str) -> str:
    """What an earlier question asks: its symbol and its number, or its number alone where no symbol says anything."""
    part = next(p for p in variant.parts if p.quantity == name)
    return f"{_symbol(variant, name)} ({question})" if part.sort.is_called_by_symbol else question


def _symbol(variant: Variant, name: str) -> str:
    """A quantity's symbol as Markdown."""
    return f"${variant.exercise.solution.symbols.get(name) or variant.exercise.symbol(name)}$"
