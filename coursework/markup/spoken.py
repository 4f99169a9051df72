"""Formulas in words, to be heard."""

from __future__ import annotations

import re
from collections.abc import Callable

from coursework.language.numbers import MINUS, localise
from coursework.language.words import words
from coursework.markup.formula_tree import (
    Accent,
    Fence,
    FormulaRow,
    FormulaText,
    Fraction,
    Grid,
    Name,
    Node,
    Num,
    Root,
    Script,
    Space,
    Styled,
    Symbol,
    parse,
)
from coursework.markup.number_holes import once_for_all_numbers

# -- words and lines --------------------------------------------------------------------------------


@once_for_all_numbers
def spoken(tex: str, lang: str) -> str:
    """Return the formula in words, to be read aloud: ``θ_4`` is ``theta 4``."""
    texts = _spoken(parse(tex), lang, words(lang)["formula"])
    return re.sub(r"\s+", " ", texts).strip() or words(lang)["formula"]["empty"]


def is_simple(node: Node) -> bool:
    """Return whether the words of a node need no end mark: a symbol, alone or with a subscript."""
    match node:
        case FormulaRow(items):
            return len(items) <= 1 and all(map(is_simple, items))
        case Script(base, _, None, 0):
            return is_simple(base)
        case Accent(_, body):
            return is_simple(body)
    return isinstance(node, (Symbol, Num, Name, FormulaText))


def _spoken(node: Node, lang: str, say: dict) -> str:
    def of(n: Node) -> str:
        return _spoken(n, lang, say)

    def phrase(key: str, *parts: str) -> str:
        return say[key].format(*parts)

    match node:
        case Symbol(text, "letter") if text in say["letters"]:
            return f" {say['letters'][text]} "
        case Symbol(text, _):
            return f" {say['symbols'].get(text, text)} "
        case Num(negative, digits, exponent):
            minus = say["symbols"][MINUS] + " " if negative else ""
            power = phrase("ten_to", localise(str(int(exponent)), lang)) if exponent else ""
            return f" {minus}{localise(digits, lang)} {power} "
        case Name(text, _):
            return f" {say['functions'].get(text, text)} "
        case FormulaText(text):
            return text
        case Space():
            return " "
        case FormulaRow(items):
            return "".join(map(of, items))
        case Styled(_, body):
            return of(body)
        case Fraction(above, below, _):
            simple = is_simple(above) and is_simple(below)
            return phrase("simple_fraction" if simple else "fraction", of(above), of(below))
        case Root(body, index):
            if index is None:
                return phrase("simple_root" if is_simple(body) else "root", of(body))
            return phrase("nth_root", of(index), of(body))
        case Accent(name, body):
            return phrase("accent_" + name, of(body))
        case Script():
            return _spoken_script(node, of, phrase, say)
        case Fence(left, body, right):
            return f" {say['symbols'].get(left, left)} {of(body)} {say['symbols'].get(right, right)} "
        case Grid(kind, rows):
            lines = [
                "; ".join([", ".join(map(of, row)) if kind != "aligned" else " ".join(map(of, row))])
                for row in rows
            ]
            return phrase("grid_" + ("matrix" if kind.endswith("matrix") else kind), "; ".join(lines))
    raise TypeError(node)


def _spoken_script(node: Script, of: Callable[[Node], str], phrase: Callable[..., str], say: dict) -> str:
    text = of(node.base)
    if node.below:
        item = isinstance(node.below, Symbol) and node.below.kind == "digits"
        text = phrase("simple_subscript" if item else "subscript", text, of(node.below))
    text += (" " + say["symbols"]["′"]) * node.primes
    match node.above:
        case None:
            return text
        case Symbol("2" | "3" as power, "digits"):
            return phrase("power_" + power, text)
        case Symbol("∘", _):
            return phrase("degrees", text)
        case Symbol("′", _):
            return f"{text} {say['symbols']['′']} "
    return phrase("power", text, of(node.above))
