"""Formulas as LaTeX for any document with amsmath and amssymb, with numbers written out.

The source is written from the tree, not copied: what the tree does not hold does not reach the file.
"""

from __future__ import annotations

import re
import unicodedata
from functools import lru_cache

from coursework.language.numbers import localise
from coursework.language.typography import typeset
from coursework.markup.formula_tree import (
    BARS,
    BIG,
    BINARY,
    CLOSING,
    LETTERS,
    OPENING,
    ORDINARY,
    RELATIONS,
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
    tokens,
)
from coursework.markup.formulas import check_formula

# The first name of each character is the one written.
_MATH = {
    char: f"\\{name}"
    for table in (LETTERS, ORDINARY, BINARY, RELATIONS, BIG)
    for name, char in reversed(table.items())
} | {"−": "-", "∗": "*", "<": "<", ">": ">", "°": r"{}^{\circ}", "|": "|", "‖": r"\Vert"}
_DELIMITERS = {
    char: name if name.startswith(("\\", "[", "]")) else f"\\{name}"
    for name, char in ({**OPENING, **CLOSING, **BARS} | {"[": "[", "]": "]"}).items()
} | {"|": "|", "‖": r"\Vert", "(": "(", ")": ")", "[": "[", "]": "]"}
_STYLES = {
    "bold": r"\mathbf{%s}",
    "slanted bold": r"\boldsymbol{%s}",
    "blackboard": r"\mathbb{%s}",
    "calligraphic": r"\mathcal{%s}",
    "display": r"{\displaystyle %s}",
}
_FRACTIONS = {None: "frac", True: "dfrac", False: "tfrac"}
_NAMES = frozenset(
    (
        "sin",
        "cos",
        "tan",
        "cot",
        "arcsin",
        "arccos",
        "arctan",
        "sinh",
        "cosh",
        "tanh",
        "exp",
        "ln",
        "log",
        "det",
        "dim",
        "arg",
        "max",
        "min",
        "lim",
        "sup",
        "inf",
    )
)

# -- plain text -------------------------------------------------------------------------------------

_MARKS = {
    "\\": r"\textbackslash{}",
    "^": r"\textasciicircum{}",
    "~": r"\textasciitilde{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    '"': r"\textquotedbl{}",
    "`": r"\textasciigrave{}",
    "'": r"\textquotesingle{}",
    "[": "{[}",
    "]": "{]}",
    "*": "{*}",
    "-": "{-}",
    ",": "{,}",
    **{mark: f"\\{mark}" for mark in "{}$&#_%"},
    "\N{NO-BREAK SPACE}": "~",
    "\N{NARROW NO-BREAK SPACE}": r"\,",
    "\t": " ",
    "–": r"\textendash{}",
    "—": r"\textemdash{}",
    "…": r"\dots{}",
    "‘": r"\textquoteleft{}",
    "’": r"\textquoteright{}",
    "“": r"\textquotedblleft{}",
    "”": r"\textquotedblright{}",
    "•": r"\textbullet{}",
    "€": r"\texteuro{}",
    "√": r"\ensuremath{\surd}",
    "∞": r"\ensuremath{\infty}",
    **{
        raised: rf"\textsuperscript{{{digit}}}"
        for raised, digit in zip("⁰⁴⁵⁶⁷⁸⁹⁺⁻", "0456789+-", strict=True)
    },
    **{low: rf"\textsubscript{{{digit}}}" for low, digit in zip("₀₁₂₃₄₅₆₇₈₉", "0123456789", strict=True)},
    "⁻": r"\textsuperscript{\textminus}",
    "−": r"\textminus{}",
}
#: What the T1 and TS1 fonts draw: Latin letters of western and central Europe, and signs.
_DRAWN = re.compile(
    "[ -~\n\u00a1-\u00ac\u00ae-\u0125\u0128-\u0137\u0139-\u013e\u0141-\u0148\u014a-\u0165\u0168-\u017e]"
)
SUBSTITUTE = r"\ensuremath{\square}"  #: stands for a character that these fonts do not draw


def plain_latex(text: str) -> str:
    """Return text as LaTeX that prints exactly these characters, without the language's own spaces."""
    return "".join(map(_character, unicodedata.normalize("NFC", text)))


def latex_text(text: str, lang: str) -> str:
    """Return plain text as LaTeX that prints exactly these characters."""
    return plain_latex(typeset(text, lang))


@lru_cache(maxsize=1024)
def _character(char: str) -> str:
    if char in _MARKS:
        return _MARKS[char]
    if _DRAWN.match(char):
        return char
    if char in _MATH:
        return rf"\ensuremath{{{_MATH[char]}}}"
    return "" if unicodedata.category(char) in ("Cc", "Cf", "Mn") else SUBSTITUTE


# -- formulas ---------------------------------------------------------------------------------------


@lru_cache(maxsize=4096)
def to_latex(tex: str, lang: str) -> str:
    r"""Return the formula as LaTeX without dollars, its numbers written out: ``4{,}21`` where the language
    has a comma."""
    return _latex(parse(tex), lang)


def _num(num: Num, lang: str, minus: str = "{-}") -> str:
    digits = num.digits.replace(".", "{,}") if localise(".", lang) == "," else num.digits
    power = rf" \times 10^{{{int(num.exponent)}}}" if num.exponent else ""
    # In braces the sign stands close to its number, whatever is before it.
    return (minus if num.negative else "") + digits + power


def _symbol(symbol: Symbol) -> str:
    match symbol:
        case Symbol("|", "opening"):
            return r"\lvert"
        case Symbol("|", "closing"):
            return r"\rvert"
        case Symbol("‖", "opening"):
            return r"\lVert"
        case Symbol("‖", "closing"):
            return r"\rVert"
        case Symbol(text, "opening" | "closing") if text in _DELIMITERS:
            return _DELIMITERS[text]
        case Symbol(text, _) if text in _MATH:
            return _MATH[text]
        case Symbol(text, _) if text.isascii():
            return text
    return rf"\textnormal{{{plain_latex(symbol.text)}}}"


def _latex(node: Node, lang: str) -> str:
    def of(n: Node) -> str:
        return _latex(n, lang)

    match node:
        case Symbol():
            return _symbol(node)
        case Num():
            return _num(node, lang)
        case Name(text, limits):
            star = "*" if limits else ""
            return f"\\{text}" if text in _NAMES else rf"\operatorname{star}{{{plain_latex(text)}}}"
        case FormulaText(text):
            return rf"\textnormal{{{plain_latex(text)}}}"
        case Space(width):
            return rf"\mkern{width}mu"
        case FormulaRow(items):
            return " ".join(map(of, items))
        case Styled(style, body):
            return _STYLES[style] % of(body)
        case Fraction(above, below, display):
            return rf"\{_FRACTIONS[display]}{{{of(above)}}}{{{of(below)}}}"
        case Root(body, index):
            return rf"\sqrt{'' if index is None else f'[{{{of(index)}}}]'}{{{of(body)}}}"
        case Accent(name, body):
            return rf"\{name}{{{of(body)}}}"
        case Script(base, below, above, primes):
            # An operator keeps its limits and its spaces only outside of braces.
            bare = isinstance(base, (Symbol, Name)) and base != Symbol("°", "ordinary")
            top = " ".join([*[r"\prime"] * primes, *([of(above)] if above else [])])
            low = f"_{{{of(below)}}}" if below else ""
            return (of(base) if bare else f"{{{of(base)}}}") + low + (f"^{{{top}}}" if top else "")
        case Fence(left, body, right):
            opening, closing = (_DELIMITERS[mark] if mark else "." for mark in (left, right))
            return rf"\left{opening} {of(body)} \right{closing}"
        case Grid(kind, rows):
            # A bracket at the head of a row would be read as the space before it.
            lines = " \\\\ \\relax ".join(" & ".join(map(of, row)) for row in rows)
            return rf"\begin{{{kind}}} {lines} \end{{{kind}}}"
    raise TypeError(node)


# -- notebooks --------------------------------------------------------------------------------------


def to_notebook(tex: str, lang: str) -> str:
    """Return the formula as MathJax and KaTeX read it: the same LaTeX, with each number written out."""
    check_formula(tex)
    written = re.sub(r"\\num\s*\{([^{}]*)\}", lambda m: _latex_number(m.group(1).strip(), lang), tex)
    written = re.sub(r"\\text\{[^{}]*[⁰¹²³⁴⁵⁶⁷⁸⁹⁻][^{}]*\}", _figures_raised, written)
    written = re.sub(r"(?<!\\)%", r"\\%", written)  # else it would begin a comment
    # A bare < would open a tag in the page that shows the notebook.
    return "".join(r"\lt " if token == "<" else token for token in tokens(written))


def _figures_raised(match: re.Match[str]) -> str:
    r"""Return a text group such as ``\text{rad/s²}`` with its raised digits as exponents, since KaTeX has no
    such glyphs."""
    text = re.sub("[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+", _exponent, match.group())
    return text.replace(r"\text{}", "")


def _exponent(raised: re.Match[str]) -> str:
    figures = raised[0].translate(str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-"))
    return rf"}}^{figures if len(figures) == 1 else f'{{{figures}}}'}\text{{"


def _latex_number(text: str, lang: str) -> str:
    num = next(n for n in parse(rf"\num{{{text}}}").items if isinstance(n, Num))
    return _num(num, lang, minus="-")
