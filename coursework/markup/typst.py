"""Formulas as Typst mathematics."""

from __future__ import annotations

from collections.abc import Iterable

from coursework.language.numbers import MINUS, localise
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

# -- Typst ------------------------------------------------------------------------------------------

_TYPST_SPECIAL = set("#$&/_^'\"\\;,:()[]{}|!.<>~@`*-=")
_TYPST_STYLES = {
    "bold": "upright(bold({}))",
    "slanted bold": "bold({})",
    "blackboard": "bb({})",
    "calligraphic": "cal({})",
    "display": "display({})",
}
_TYPST_ACCENTS = {
    "dot": "dot",
    "ddot": "dot.double",
    "dddot": "dot.triple",
    "vec": "arrow",
    "overrightarrow": "arrow",
    "overline": "overline",
    "bar": "macron",
    "hat": "hat",
    "tilde": "tilde",
    "underline": "underline",
}
_TYPST_GRIDS = {"pmatrix": '"("', "bmatrix": '"["', "vmatrix": '"|"', "matrix": "#none"}


@once_for_all_numbers
def to_typst(tex: str, lang: str) -> str:
    """Return the formula as Typst math, without the dollars."""
    return _typst(parse(tex), lang)


def _typst_join(parts: Iterable[str]) -> str:
    """Join parts without blanks beside quoted text, where Typst would print them."""
    joined = ""
    for part in filter(None, parts):
        touch = not joined or joined.endswith('"') or part.startswith('"')
        joined += part if touch else " " + part
    return joined


def _typst_string(text: str) -> str:
    return '"' + text.replace("\\", r"\\").replace('"', r"\"") + '"'


def _typst_char(text: str) -> str:
    return "\\" + text if text in _TYPST_SPECIAL else text


def _typst_num(num: Num, lang: str) -> str:
    parts = [MINUS if num.negative else "", _typst_string(localise(num.digits, lang))]
    if num.exponent:
        power = _typst_string(localise(str(int(num.exponent)), lang))
        parts += ["×", f'attach("10", t: {power})']
    return _typst_join(parts)


def _typst(node: Node, lang: str) -> str:
    def of(n: Node) -> str:
        return _typst(n, lang)

    match node:
        case Symbol(text, "bar"):
            return f'class("normal", {_typst_char(text)})'
        case Symbol("|" | "‖" as text, kind):
            return f'class("{kind}", {_typst_char(text)})'
        case Symbol(text, _):
            return _typst_char(text)
        case Num():
            return _typst_num(node, lang)
        case Name(text, limits):
            return f"op({_typst_string(text)}{', limits: #true' if limits else ''})"
        case FormulaText(text):
            return _typst_string(text)
        case Space(width):
            return f"#h({width / 18:.4f}em)"
        case FormulaRow(items):
            return _typst_join(map(of, items))
        case Styled(style, body):
            return _TYPST_STYLES[style].format(of(body))
        case Fraction(above, below, display):
            drawn = f"frac({of(above)}, {of(below)})"
            return drawn if display is None else f"{'display' if display else 'inline'}({drawn})"
        case Root(body, index):
            return f"sqrt({of(body)})" if index is None else f"root({of(index)}, {of(body)})"
        case Accent(name, body):
            return f"{_TYPST_ACCENTS[name]}({of(body)})"
        case Script(base, below, above, primes):
            top = _typst_join(["′" * primes, of(above) if above else ""])
            scripts = [f"b: {of(below)}" if below else "", f"t: {top}" if top else ""]
            return f"attach({', '.join(filter(None, [of(base) or 'zws', *scripts]))})"
        case Fence(left, body, right):
            return f"lr({_typst_join([left and _typst_char(left), of(body), right and _typst_char(right)])})"
        case Grid("aligned", rows):
            return " \\ ".join(" & ".join(map(of, row)) for row in rows)
        case Grid("cases", rows):
            return f"cases({', '.join(' & '.join(map(of, row)) for row in rows)})"
        case Grid(kind, rows):
            return f"mat(delim: {_TYPST_GRIDS[kind]}, {'; '.join(', '.join(map(of, row)) for row in rows)})"
    raise TypeError(node)
