"""Reference equations as LaTeX."""

from __future__ import annotations

from collections.abc import Mapping

from coursework.parsing.equations import parse_equation
from coursework.parsing.trees import Operation

_LATEX_FUNCTIONS = {
    "asin": r"\arcsin",
    "acos": r"\arccos",
    "atan": r"\arctan",
    "atan2": r"\operatorname{atan2}",
}
_LATEX_CONSTANTS = {"pi": r"\pi", "e": "e", "i": "i"}


def _bracketed(text: str) -> str:
    return rf"\left({text}\right)"


def _side_by_side(pieces: list[str]) -> str:
    """Factors in a row: a space where two letters would meet, a dot before a digit."""
    text = pieces[0]
    for piece in pieces[1:]:
        if piece[0].isdigit() or piece.startswith(r"\num"):
            text += r"\cdot " + piece
        else:
            text += (" " if piece[0].isalpha() else "") + piece
    return text


def _latex(node: Operation, symbols: Mapping[str, str]) -> str:
    if node.kind == "number":
        return node.name if node.name.isdigit() else rf"\num{{{node.name}}}"
    if node.kind == "constant":
        return _LATEX_CONSTANTS[node.name]
    if node.kind == "variable":
        return symbols[node.name]
    args = [_latex(arg, symbols) for arg in node.args]
    if node.kind == "neg":
        return "-" + (_bracketed(args[0]) if node.args[0].kind in ("sum", "neg") else args[0])
    if node.kind == "degree":
        return rf"{args[0]}^\circ"
    if node.kind == "sum":
        return args[0] + "".join(
            f" {sign} " + (_bracketed(text) if arg.kind in ("sum", "neg") else text)
            for sign, text, arg in zip(node.name[1:], args[1:], node.args[1:], strict=True)
        )
    if node.kind == "product":
        return _latex_product(node, args)
    if node.kind == "power":
        simple = node.args[0].kind in ("number", "constant", "variable")
        return f"{args[0] if simple else _bracketed(args[0])}^{{{args[1]}}}"
    return _latex_call(node, args)


def _latex_product(node: Operation, args: list[str]) -> str:
    above = [(n, t) for s, n, t in zip(node.name, node.args, args, strict=True) if s == "*"]
    below = [(n, t) for s, n, t in zip(node.name, node.args, args, strict=True) if s == "/"]

    def row(pairs: list[tuple[Operation, str]]) -> str:
        if len(pairs) == 1 and (below or pairs[0][0].kind not in ("sum", "neg")):
            return pairs[0][1]
        return _side_by_side([_bracketed(t) if n.kind in ("sum", "neg") else t for n, t in pairs])

    return rf"\frac{{{row(above)}}}{{{row(below)}}}" if below else row(above)


def _latex_call(node: Operation, args: list[str]) -> str:
    if node.name == "sqrt":
        return rf"\sqrt{{{args[0]}}}"
    if node.name == "abs":
        return rf"\left|{args[0]}\right|"
    function = _LATEX_FUNCTIONS.get(node.name, "\\" + node.name)
    if node.args[0].kind == "variable" and len(args) == 1:
        return function + (" " if args[0][0].isalpha() else "") + args[0]
    return function + _bracketed(", ".join(args))


def latex_of_equation(text: str, symbols: Mapping[str, str]) -> str:
    """LaTeX of a reference equation, each name written as its symbol.

    ``r2*cos(theta2) = r1`` -> ``r_2\\cos\\theta_2 = r_1``. Numbers that have a fraction are in ``\\num{}``.

    Raises
    ------
    Unreadable
        A name without a symbol, or a text that is not an equation.
    """
    equation = parse_equation(text, symbols)
    return f"{_latex(equation.left.root, symbols)} = {_latex(equation.right.root, symbols)}"
