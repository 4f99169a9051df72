"""Formulas of a statement, for every back end.

A formula is LaTeX from a whitelist (:mod:`coursework.markup.formula_tree`), its numbers written
``\\num{-1234.5}``. Here it becomes Typst, MathML, LaTeX for a notebook, one line of text, or words to be
read aloud, each with numbers as the language prints them.
"""

from __future__ import annotations

from coursework.language.numbers import NARROW_SPACE, localise
from coursework.markup.formula_tree import parse

SUPERSCRIPTS = str.maketrans("0123456789-−+()n", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁻⁺⁽⁾ⁿ")
SUBSCRIPTS = str.maketrans("0123456789-−+()", "₀₁₂₃₄₅₆₇₈₉₋₋₊₍₎")
_UNITS_THAT_TOUCH = ("°", "′", "″")


def check_formula(tex: str) -> None:
    """Refuse a formula that a statement may not use; :class:`BadStatement` names what is wrong."""
    parse(tex)


def number_text(number: str, lang: str) -> str:
    """Return a number written with a point, as running text: ``1.2e-5`` is ``1,2 × 10⁻⁵`` in French."""
    mantissa, _, exponent = number.lower().partition("e")
    if not exponent:
        return localise(mantissa, lang)
    power = str(int(exponent)).translate(SUPERSCRIPTS)
    return f"{localise(mantissa, lang)}{NARROW_SPACE}×{NARROW_SPACE}10{power}"


def after_number(unit: str) -> str:
    """Return the unit as printed after a number: degrees without a space, others after a narrow one."""
    return unit if unit in ("", *_UNITS_THAT_TOUCH) else NARROW_SPACE + unit


def quantity_formula(symbol: str, value: str, unit: str, *, is_number: bool = True) -> str:
    """Return LaTeX of ``symbol = value unit``; without a symbol, of the value and its unit."""
    displayed = rf"\num{{{value}}}" if is_number else rf"\text{{{value}}}"
    if unit:
        displayed += ("" if unit in _UNITS_THAT_TOUCH else r"\,") + rf"\text{{{unit}}}"
    return f"{symbol} = {displayed}" if symbol else displayed
