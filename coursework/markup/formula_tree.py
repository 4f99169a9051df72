"""Parser from the LaTeX of a statement to a small tree.

Every back end writes from this one tree, so a formula that is read here prints everywhere.
Only the macros listed below are read; any other is refused by its name.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeAlias

from coursework.errors import BadStatement, nearest
from coursework.markup.number_holes import FIRST_HOLE, LAST_HOLE

# Each symbol is its Unicode character and what it is, for spacing.
LETTERS = {
    "alpha": "α",
    "beta": "β",
    "gamma": "γ",
    "delta": "δ",
    "epsilon": "ϵ",
    "varepsilon": "ε",
    "zeta": "ζ",
    "eta": "η",
    "theta": "θ",
    "vartheta": "ϑ",
    "iota": "ι",
    "kappa": "κ",
    "lambda": "λ",
    "mu": "μ",
    "nu": "ν",
    "xi": "ξ",
    "pi": "π",
    "rho": "ρ",
    "sigma": "σ",
    "tau": "τ",
    "upsilon": "υ",
    "phi": "ϕ",
    "varphi": "φ",
    "chi": "χ",
    "psi": "ψ",
    "omega": "ω",
    "Gamma": "Γ",
    "Delta": "Δ",
    "Theta": "Θ",
    "Lambda": "Λ",
    "Xi": "Ξ",
    "Pi": "Π",
    "Sigma": "Σ",
    "Upsilon": "Υ",
    "Phi": "Φ",
    "Psi": "Ψ",
    "Omega": "Ω",
    "partial": "∂",
    "ell": "ℓ",
}
ORDINARY = {
    "infty": "∞",
    "circ": "∘",
    "prime": "′",
    "angle": "∠",
    "degree": "°",
    "ldots": "…",
    "dots": "…",
    "cdots": "⋯",
    "emptyset": "∅",
    "forall": "∀",
    "exists": "∃",
    "%": "%",
}
BINARY = {
    "cdot": "⋅",
    "times": "×",
    "pm": "±",
    "mp": "∓",
    "wedge": "∧",
    "cap": "∩",
    "cup": "∪",
    "oplus": "⊕",
    "div": "÷",
}
RELATIONS = {
    "neq": "≠",
    "ne": "≠",
    "le": "≤",
    "leq": "≤",
    "ge": "≥",
    "geq": "≥",
    "ll": "≪",
    "gg": "≫",
    "lt": "<",
    "gt": ">",
    "approx": "≈",
    "simeq": "≃",
    "sim": "∼",
    "equiv": "≡",
    "to": "→",
    "rightarrow": "→",
    "mapsto": "↦",
    "Rightarrow": "⇒",
    "Leftrightarrow": "⇔",
    "iff": "⇔",
    "in": "∈",
    "notin": "∉",
    "subset": "⊂",
    "parallel": "∥",
    "perp": "⟂",
    "propto": "∝",
}
BIG = {"int": "∫", "sum": "∑", "prod": "∏", "oint": "∮"}
OPENING = {"lvert": "|", "lVert": "‖", "{": "{", "langle": "⟨", "lfloor": "⌊", "lceil": "⌈", "lbrack": "["}
CLOSING = {"rvert": "|", "rVert": "‖", "}": "}", "rangle": "⟩", "rfloor": "⌋", "rceil": "⌉", "rbrack": "]"}
BARS = {"vert": "|", "Vert": "‖", "|": "‖", "mid": "|"}
FUNCTIONS = (
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
    "rank",
    "arg",
)
LIMITS = ("max", "min", "lim", "sup", "inf")
SPACES = {",": 3, ":": 4, ";": 5, "!": -3, " ": 4, "quad": 18, "qquad": 36}  #: eighteenths of an em
ACCENTS = {
    "dot": "˙",
    "ddot": "¨",
    "dddot": "⃛",
    "vec": "→",
    "overrightarrow": "→",
    "overline": "‾",
    "bar": "‾",
    "hat": "^",
    "tilde": "~",
    "underline": "_",
}
STYLES = {
    "mathrm": "upright",
    "mathbf": "bold",
    "boldsymbol": "slanted bold",
    "mathbb": "blackboard",
    "mathcal": "calligraphic",
}
FRACTIONS = {"frac": None, "dfrac": True, "tfrac": False}
GRIDS = ("cases", "aligned", "pmatrix", "bmatrix", "vmatrix", "matrix")
STRUCTURE = ("sqrt", "operatorname", "text", "num", "left", "right", "begin", "end", "displaystyle")

_SYMBOLS: dict[str, tuple[str, str]] = {
    name: (char, kind)
    for kind, table in (
        ("letter", LETTERS),
        ("ordinary", ORDINARY),
        ("binary", BINARY),
        ("relation", RELATIONS),
        ("big", BIG),
        ("opening", OPENING),
        ("closing", CLOSING),
        ("bar", BARS),
    )
    for name, char in table.items()
}
#: Every macro a statement may use, without its backslash.
MACROS = frozenset((*_SYMBOLS, *FUNCTIONS, *LIMITS, *SPACES, *ACCENTS, *STYLES, *FRACTIONS, *STRUCTURE, "\\"))

_CHARACTERS = {
    "+": ("+", "binary"),
    "-": ("−", "binary"),
    "*": ("∗", "binary"),
    "/": ("/", "ordinary"),
    "=": ("=", "relation"),
    "<": ("<", "relation"),
    ">": (">", "relation"),
    ":": (":", "relation"),
    "(": ("(", "opening"),
    "[": ("[", "opening"),
    ")": (")", "closing"),
    "]": ("]", "closing"),
    "|": ("|", "bar"),
    ",": (",", "punctuation"),
    ";": (";", "punctuation"),
    ".": (".", "punctuation"),
    "!": ("!", "closing"),
    "?": ("?", "closing"),
    "°": ("°", "ordinary"),
    "·": ("⋅", "binary"),
}


@dataclass(frozen=True)
class Symbol:
    """Character and its kind: letter, digits, binary, relation, opening, ..."""

    text: str
    kind: str


@dataclass(frozen=True)
class Num:
    """Number printed in the language's own way: sign, digits with a point, power of ten."""

    negative: bool
    digits: str
    exponent: str


@dataclass(frozen=True)
class Name:
    """Named function; with limits, its subscript goes below."""

    text: str
    limits: bool = False


@dataclass(frozen=True)
class FormulaText:
    text: str


@dataclass(frozen=True)
class Space:
    width: int  #: eighteenths of an em


@dataclass(frozen=True)
class FormulaRow:
    items: tuple[Node, ...]


@dataclass(frozen=True)
class Styled:
    style: str
    body: Node


@dataclass(frozen=True)
class Fraction:
    above: Node
    below: Node
    display: bool | None


@dataclass(frozen=True)
class Root:
    body: Node
    index: Node | None


@dataclass(frozen=True)
class Accent:
    name: str
    body: Node


@dataclass(frozen=True)
class Script:
    base: Node
    below: Node | None
    above: Node | None
    primes: int


@dataclass(frozen=True)
class Fence:
    """Delimiters that grow with their content; an empty one is not drawn."""

    left: str
    body: Node
    right: str


@dataclass(frozen=True)
class Grid:
    kind: str
    rows: tuple[tuple[Node, ...], ...]


Node: TypeAlias = (
    Symbol
    | Num
    | Name
    | FormulaText
    | Space
    | FormulaRow
    | Styled
    | Fraction
    | Root
    | Accent
    | Script
    | Fence
    | Grid
)


def _upright(node: Node) -> Node:
    """Return the node with each run of letters as one word: ``mm`` is a unit, not two variables.

    A dot between two units stands as close as their letters.
    """
    if isinstance(node, Symbol) and (node.kind in ("letter", "digits") or node.text == "/"):
        return FormulaText(node.text)
    if node == Symbol(BINARY["cdot"], "binary"):
        return FormulaText("·")
    if isinstance(node, Script):
        return Script(_upright(node.base), node.below, node.above, node.primes)
    if not isinstance(node, FormulaRow):
        return node
    items: list[Node] = []
    for item in map(_upright, node.items):
        if items and isinstance(item, FormulaText) and isinstance(items[-1], FormulaText):
            items[-1] = FormulaText(items[-1].text + item.text)
        else:
            items.append(item)
    return items[0] if len(items) == 1 else FormulaRow(tuple(items))


_TOKEN = re.compile(r"\\(?:[A-Za-z]+|.)|\s+|.", re.DOTALL)
_NUM = re.compile(rf"([+-]?)(\d+(?:\.\d+)?|\.\d+|[{FIRST_HOLE}-{LAST_HOLE}])(?:[eE]([+-]?\d+))?")


def tokens(tex: str) -> tuple[str, ...]:
    """Return the formula cut into macros, runs of blanks and single characters."""
    return tuple(_TOKEN.findall(tex))


@lru_cache(maxsize=4096)
def parse(tex: str) -> FormulaRow:
    """Return the tree of a formula.

    Raises :class:`BadStatement` naming the macro that is not in the list, or what is missing.
    """
    return _FormulaParser(tex).formula()


class _FormulaParser:
    def __init__(self, tex: str) -> None:
        self.tex = tex
        self.tokens: list[str] = []  #: those that are not blank, and an empty one at the end
        self.blanks: list[str] = []  #: what stands before each of them
        blank = ""
        for token in (*tokens(tex), ""):
            if token.isspace():
                blank = token
            else:
                self.tokens.append(token)
                self.blanks.append(blank)
                blank = ""
        self.at = 0

    def refuse(self, why: str) -> BadStatement:
        return BadStatement(f"formula ${self.tex}$: {why}")

    # -- the stream ---------------------------------------------------------------------------
    def peek(self) -> str:
        """Return the next token that is not blank; empty at the end."""
        return self.tokens[self.at]

    def take(self) -> str:
        token = self.tokens[self.at]
        if token:
            self.at += 1
        return token

    def expect(self, token: str, after: str) -> None:
        result = self.take()
        if result != token:
            raise self.refuse(f"{token} expected after {after}, found {result or 'the end'}")

    def raw_group(self, macro: str) -> str:
        """Return the characters between the braces after a macro, unchanged."""
        self.expect("{", macro)
        start = self.at
        depth = 1
        while token := self.take():
            depth += (token == "{") - (token == "}")
            if depth == 0:
                end = self.at - 1
                pieces = zip(self.blanks[start:end], self.tokens[start:end], strict=True)
                return "".join(map("".join, pieces)) + self.blanks[end]
        raise self.refuse(f"the brace after {macro} is not closed")

    # -- the grammar --------------------------------------------------------------------------
    def formula(self) -> FormulaRow:
        row = self.row(())
        if self.peek():
            raise self.refuse(f"{self.peek()} without its beginning")
        if any(isinstance(i, Grid) and i.kind == "aligned" for i in row.items) and len(row.items) > 1:
            raise self.refuse(r"\begin{aligned} stands alone in its formula; \begin{cases} may follow others")
        return row

    def row(self, stops: tuple[str, ...]) -> FormulaRow:
        """Return the items up to one of the stops, which stays in the stream, or to the end."""
        items: list[Node] = []
        closers = ("}", "&", r"\\", r"\right", r"\end")
        while (token := self.peek()) and token not in stops and token not in closers:
            items.append(self.scripted())
        return FormulaRow(tuple(items))

    def scripted(self) -> Node:
        base: Node = FormulaRow(()) if self.peek() in ("^", "_", "'") else self.atom()
        below = above = None
        primes = 0
        while (token := self.peek()) in ("^", "_", "'") and token:
            self.take()
            if token == "'":
                primes += 1
            elif token == "_" and below is None:
                below = self.argument("_")
            elif token == "^" and above is None:
                above = self.argument("^")
            else:
                raise self.refuse(f"two {token} on one base")
        if below is None and above is None and not primes:
            return base
        return Script(base, below, above, primes)

    def argument(self, macro: str) -> Node:
        """Return a group, or a single character or macro as in LaTeX."""
        token = self.peek()
        if token in ("", "}", "&", "^", "_", r"\\", r"\right", r"\end"):
            raise self.refuse(f"nothing after {macro}")
        if token.isdigit():
            self.take()
            return Symbol(token, "digits")
        node = self.atom()
        return node.items[0] if isinstance(node, FormulaRow) and len(node.items) == 1 else node

    def atom(self) -> Node:
        token = self.take()
        if token == "{":
            row = self.row(())
            self.expect("}", "a group")
            return row
        if token.startswith("\\"):
            return self.macro(token)
        if token.isdigit():
            return self.digits(token)
        if token == "~":
            return Space(4)
        if token in _CHARACTERS:
            return Symbol(*_CHARACTERS[token])
        if token.isalpha():
            return Symbol(token, "letter")
        raise self.refuse(f"the character {token!r} is not read in a formula")

    def digits(self, first: str) -> Symbol:
        text = first
        while self.peek().isdigit() and not self.blanks[self.at]:
            text += self.take()
        after = self.tokens[self.at : self.at + 2]
        touch = not any(self.blanks[self.at : self.at + 2])
        if touch and len(after) == 2 and after[0] in ".," and after[1].isdigit():
            written = text + after[0] + after[1]
            raise self.refuse(rf"a decimal number is written \num{{...}}, not {written}...")
        return Symbol(text, "digits")

    def macro(self, token: str) -> Node:
        name = token[1:]
        if name not in MACROS:
            near = nearest(name, sorted(filter(str.isalpha, MACROS))) if name.isalpha() else ""
            hint = near if "did you mean" in near else ""
            raise self.refuse(f"{token} is not a macro that a statement may use{hint}")
        if name in _SYMBOLS:
            return Symbol(*_SYMBOLS[name])
        if name in FUNCTIONS or name in LIMITS:
            return Name(name, name in LIMITS)
        if name in SPACES:
            return Space(SPACES[name])
        if name in ACCENTS:
            return Accent(name, self.argument(token))
        if name == "mathrm":
            return _upright(self.argument(token))
        if name in STYLES:
            return Styled(STYLES[name], self.argument(token))
        if name in FRACTIONS:
            return Fraction(self.argument(token), self.argument(token), FRACTIONS[name])
        return self.structure(name)

    def structure(self, name: str) -> Node:
        match name:
            case "sqrt":
                return self.root()
            case "operatorname":
                return Name(self.words(r"\operatorname"))
            case "text":
                return FormulaText(self.words(r"\text"))
            case "num":
                return self.num()
            case "left":
                return self.fence()
            case "begin":
                return self.grid()
            case "displaystyle":
                return Styled("display", self.row(()))
        raise self.refuse(f"\\{name} without its beginning")

    def words(self, macro: str) -> str:
        text = self.raw_group(macro).replace(r"\%", "%").replace(r"\ ", " ").replace(r"\_", "_")
        if set(text) & set("\\{}$"):
            raise self.refuse(f"{macro} holds plain words only, not {text}")
        return text

    def num(self) -> Num:
        text = self.raw_group(r"\num")
        match = _NUM.fullmatch(text.strip())
        if match is None:
            raise self.refuse(rf"\num{{{text}}} is not a number with a point, such as -1234.5 or 1.2e5")
        sign, digits, exponent = match.groups()
        return Num(sign == "-", "0" + digits if digits.startswith(".") else digits, exponent or "")

    def root(self) -> Root:
        index = None
        if self.peek() == "[":
            self.take()
            index = self.row(("]",))
            self.expect("]", "the index of a root")
        return Root(self.argument(r"\sqrt"), index)

    def delimiter(self, macro: str) -> str:
        token = self.take()
        if token == ".":
            return ""
        char, kind = (
            _SYMBOLS.get(token[1:], ("", "")) if token[:1] == "\\" else _CHARACTERS.get(token, ("", ""))
        )
        if kind not in ("opening", "closing", "bar"):
            raise self.refuse(f"{token or 'the end'} is no delimiter for {macro}")
        return char

    def fence(self) -> Fence:
        left = self.delimiter(r"\left")
        body = self.row(())
        self.expect(r"\right", r"\left")
        return Fence(left, body, self.delimiter(r"\right"))

    def grid(self) -> Grid:
        kind = self.raw_group(r"\begin")
        if kind not in GRIDS:
            raise self.refuse(rf"no \begin{{{kind}}}{nearest(kind, GRIDS)}")
        rows = [tuple(self.cells())]
        while self.peek() == r"\\":
            self.take()
            rows.append(tuple(self.cells()))
        self.expect(r"\end", rf"\begin{{{kind}}}")
        if (end := self.raw_group(r"\end")) != kind:
            raise self.refuse(rf"\begin{{{kind}}} ends as {end}")
        empty = (FormulaRow(()),)
        return Grid(kind, tuple(r for r in rows[:-1]) + (() if rows[-1] == empty else (rows[-1],)))

    def cells(self) -> Iterator[FormulaRow]:
        yield self.row(())
        while self.peek() == "&":
            self.take()
            yield self.row(())
