"""Formulas as one line of plain text."""

from __future__ import annotations

import re
from collections.abc import Mapping

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
from coursework.markup.formulas import SUBSCRIPTS, SUPERSCRIPTS, number_text
from coursework.markup.number_holes import once_for_all_numbers
from coursework.markup.spoken import is_simple


@once_for_all_numbers
def to_line(tex: str, lang: str) -> str:
    """Return the formula as one line of plain text, for a terminal: ``θ₄ = arctan(y/x)``."""
    return re.sub(r"  +", " ", _line(parse(tex), lang)).strip()


_LINE_ACCENTS = {"dot": "\u0307", "ddot": "\u0308", "vec": "\u20d7", "overline": "\u0305", "bar": "\u0304"}


def _grouped(node: Node, lang: str) -> str:
    text = _line(node, lang).strip()
    return text if is_simple(node) else f"({text})"


def _raised(text: str, table: Mapping[int, int], mark: str) -> str:
    """Return the text in small Unicode characters where all exist, else the mark and the text."""
    if all(ord(c) in table for c in text):
        return text.translate(table)
    return mark + (text if len(text) == 1 else f"({text})" if mark == "^" else text)


def _line(node: Node, lang: str) -> str:
    def of(n: Node) -> str:
        return _line(n, lang)

    match node:
        case Symbol(text, "relation" | "binary"):
            return f" {text} "
        case Symbol(",", _):
            return ", "
        case Symbol(text, _) | FormulaText(text):
            return text
        case Num(negative, digits, exponent):
            return number_text(
                ("-" if negative else "") + digits + (f"e{exponent}" if exponent else ""), lang
            )
        case Name(text, _):
            return f"{text} "
        case Space(width):
            return " " if width > 0 else ""
        case FormulaRow(items):
            return "".join(map(of, items)).replace(" (", "(") if items else ""
        case Styled(_, body):
            return of(body)
        case Fraction(above, below, _):
            return f"{_grouped(above, lang)}/{_grouped(below, lang)}"
        case Root(body, index):
            return (of(index).translate(SUPERSCRIPTS) if index else "") + f"√{_grouped(body, lang)}"
        case Accent(name, body):
            mark = _LINE_ACCENTS.get(name)
            text = of(body).strip()
            return "".join(c + mark for c in text) if mark else f"{text}{_TEXT_ACCENTS.get(name, '')}"
        case Script(base, below, above, primes):
            low = _raised(of(below).replace(" ", ""), SUBSCRIPTS, "_") if below else ""
            if isinstance(above, Symbol) and above.text in "∘′":
                high = "°" if above.text == "∘" else "′"
            else:
                high = _raised(of(above).replace(" ", ""), SUPERSCRIPTS, "^") if above else ""
            return f"{of(base).rstrip()}{low}{'′' * primes}{high}{' ' if isinstance(base, Name) else ''}"
        case Fence(left, body, right):
            return f"{left}{of(body).strip()}{right}"
        case Grid("aligned", rows):
            return "\n".join("".join(map(of, row)).strip() for row in rows)
        case Grid(kind, rows):
            inner = "; ".join(", ".join(of(cell).strip() for cell in row) for row in rows)
            return "{ " + inner + " }" if kind == "cases" else f"[{inner}]"
    raise TypeError(node)


_TEXT_ACCENTS = {"overrightarrow": "\u20d7", "hat": "\u0302", "tilde": "\u0303", "dddot": "\u20db"}
