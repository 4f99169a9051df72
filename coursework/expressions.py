"""Numbers, formulas and equations as people write them, read without ever running them.

A recursive-descent parser over a closed vocabulary: four operations, powers, a few
functions, pi, e, and the variables that the caller names. Every input is bounded in
length, depth and exponent before anything is computed.
"""

from __future__ import annotations

import hashlib
import itertools
import math
import re
import unicodedata
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from coursework.errors import CourseworkError, nearest

MAX_LENGTH = 500
MAX_DEPTH = 30
MAX_EXPONENT = 64
MAX_FOUND = 60

Value = float | complex | np.ndarray


class Unreadable(CourseworkError, ValueError):
    """A text that is no number, formula or equation we can read.

    ``code`` is a short key for the reason, ``found`` the piece that stops the reading.
    """

    def __init__(self, message: str, *, code: str, found: str = "") -> None:
        super().__init__(message)
        self.code = code
        self.found = shorten(found)


def shorten(text: str) -> str:
    """A piece of text short enough for a message."""
    return text if len(text) <= MAX_FOUND else text[: MAX_FOUND - 1] + "…"


# --- characters -------------------------------------------------------------------------

_ALIKE = {
    "*": "×⋅·∙•∗✕",
    "/": "÷∕⁄",
    "-": "−–‐‑‒﹣",
    "'": "’‘′ʹ´",
    '"': "″”“",
    "°": "º˚∘",
    "μ": "µ",
    "Ω": "\N{OHM SIGN}",
    "φ": "ϕ",
    "θ": "ϑ",
    "ε": "ϵ",
    ".": "٫",
    " ": "\t\n\r\v\f\x85\u2028\u2029٬",
    "": "\u200b\u200c\u200d\u2060\ufeff\u00ad",
}
_SUPERSCRIPTS = dict(zip("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻", "0123456789+-", strict=True))
_SUPERSCRIPT_RUN = re.compile(f"[{''.join(_SUPERSCRIPTS)}]+")


class _Characters(dict):
    """Translation table of ``tidy``, filled as characters are met."""

    def __missing__(self, code: int) -> str:
        char = chr(code)
        if 0xFF01 <= code <= 0xFF5E:  # full-width forms of ASCII
            char = chr(code - 0xFEE0)
        elif unicodedata.category(char) == "Nd" or 0x2080 <= code <= 0x2089:  # subscript digits as well
            char = str(unicodedata.digit(char))
        elif unicodedata.category(char) == "Zs":
            char = " "
        self[code] = char
        return char


_TABLE = _Characters({ord(odd): plain for plain, odds in _ALIKE.items() for odd in odds})


def tidy(text: str) -> str:
    """The text with one spelling for each kind of space, sign, digit, dot and quote; ``²`` is ``^(2)``."""
    if text.isascii() and text.isprintable():
        return text.strip()
    text = unicodedata.normalize("NFC", text)
    text = _SUPERSCRIPT_RUN.sub(lambda run: f"^({''.join(_SUPERSCRIPTS[c] for c in run[0])})", text)
    return text.translate(_TABLE).strip()


_LATEX = (
    (re.compile(r"\\(?:left|right|displaystyle|quad|qquad)(?![A-Za-z])"), " "),
    (re.compile(r"\\[,;:! ]|~"), " "),
    (re.compile(r"\{,\}"), ","),
    (re.compile(r"\^\s*\{?\s*\\circ(?![A-Za-z])\s*\}?|\\degree(?![A-Za-z])|\^\s*°"), "°"),
    (re.compile(r"\\(?:cdot|times)(?![A-Za-z])"), "*"),
    (re.compile(r"\\(?:approx|simeq)(?![A-Za-z])"), "≈"),
    (re.compile(r"\\(?:SI|qty)\{([^{}]*)\}\{([^{}]*)\}"), r"\1 \2"),
    (re.compile(r"\\(?:mathrm|mathit|text|operatorname|num|si|unit)\s*\{([^{}]*)\}"), r" \1 "),
    (re.compile(r"\\mu(?![A-Za-z])"), "μ"),
    (re.compile(r"\\Omega(?![A-Za-z])"), "Ω"),
    (re.compile(r"\\%"), "%"),
    (re.compile(r"\^\s*(?:\\prime\s*\\prime|\{\s*(?:\\prime\s*\\prime|'')\s*\})"), "''"),
    (re.compile(r"\^\s*(?:\\prime(?![A-Za-z])|\{\s*(?:\\prime|')\s*\})"), "'"),
    (re.compile(r"\\?\$|\\[()]"), " "),
)


def without_latex(text: str) -> str:
    """A tidy text with the commonest LaTeX spelled plainly; fractions and roots are left to the parser."""
    if "\\" in text or "$" in text or "{" in text or "^" in text:
        for pattern, plain in _LATEX:
            text = pattern.sub(plain, text)
    return text.strip()


_DOTS = re.compile(r"\\(d?dot)\s*(?:\{([^{}]*)\}|(\\[A-Za-z]+|[^\W\d_]))")
_PRIMES = re.compile(r"([A-Za-z][A-Za-z0-9_]*)('{1,2}|\")(?!')")
_SUBSCRIPT = re.compile(r"\s*_\s*\{\s*([A-Za-z0-9_]*)\s*\}")
_COMMAND = re.compile(r"\\(?!frac|dfrac|tfrac)([A-Za-z]+)")


def _greek(char: str) -> str:
    """ASCII name of a Greek letter, ``θ`` -> ``theta``; of the dots above a letter; else the character."""
    if char == "\u0307":
        return "_dot"
    if char == "\u0308":
        return "_ddot"
    name = unicodedata.name(char, "").split()
    if len(name) == 4 and name[0] == "GREEK" and name[2] == "LETTER":
        letter = name[3].lower().replace("lamda", "lambda")
        return " " + (letter.capitalize() if name[1] == "CAPITAL" else letter)
    return char


def _spelled_out(text: str) -> str:
    """A text in which every name is ASCII: ``ψ̇``, ``\\dot\\psi`` -> ``psi_dot``, ``θ_{2}`` -> ``theta_2``."""
    text = _DOTS.sub(lambda m: f"{m[2] or m[3]}_{m[1]}", text)
    text = _SUBSCRIPT.sub(r"_\1", text)
    text = _COMMAND.sub(r" \1", text)
    if not text.isascii():
        text = "".join(map(_greek, unicodedata.normalize("NFD", text)))
    return text.replace("**", "^")


def _primes_as_dots(text: str) -> str:
    """A text with ASCII names in which ``phi'`` and ``r1\"`` are ``phi_dot`` and ``r1_ddot``."""
    return _PRIMES.sub(lambda m: m[1] + ("_dot" if m[2] == "'" else "_ddot"), text)


# --- vocabulary -------------------------------------------------------------------------


def _atan2(y: Value, x: Value) -> Value:
    """The angle of a point of the plane; there is none for complex coordinates."""
    if np.iscomplexobj(y) or np.iscomplexobj(x):
        return np.real(y + x) * math.nan
    return np.arctan2(y, x)


_FUNCTIONS: Mapping[str, Callable] = {
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "atan2": _atan2,
    "sqrt": np.sqrt,
    "exp": np.exp,
    "abs": np.abs,
    "ln": np.log,
}
_ALIASES = {
    "arcsin": "asin", "arccos": "acos", "arctan": "atan", "arctan2": "atan2", "tg": "tan", "arctg": "atan",
}  # fmt: skip
_INVERSE = ("asin", "acos", "atan", "atan2")
_DEGREE_WORDS = ("deg", "degree", "degrees", "degré", "degrés")


_VARIANT = re.compile(r"var(?=phi|theta|epsilon|rho|sigma|kappa)")


def _key(name: str) -> str:
    """What all spellings of one name share: no underscore, the dots of a derivative last, one ``phi``."""
    name = _VARIANT.sub("", name.replace("_", ""), count=1)
    for dots in ("ddot", "dot"):
        if dots in name and name != dots:
            return name.replace(dots, "", 1) + dots
    return name


class _Vocabulary:
    """The names that may occur, by any spelling."""

    def __init__(self, variables: tuple[str, ...]) -> None:
        self.variables = {_key(v): v for v in variables}
        self.complex = bool(variables)

    def find(self, run: str) -> tuple[str, str] | None:
        """Kind and canonical name of one complete spelling."""
        if (name := self.variables.get(_key(run))) is not None:
            return "variable", name
        low = run.lower()
        low = _ALIASES.get(low, low)
        if low in _FUNCTIONS:
            return "function", low
        if low == "pi":
            return "constant", "pi"
        if run == "e":
            return "constant", "e"
        if run in ("i", "j") and self.complex:
            return "constant", "i"
        return ("degree", "deg") if low in _DEGREE_WORDS else None

    def first(self, run: str) -> tuple[int, str, str] | None:
        """The first name of a run of letters such as ``r2cos``: its length, kind and canonical name."""
        dead: set[int] = set()

        def fits(start: int) -> bool:
            return start == len(run) or (start not in dead and piece(start) is not None)

        def piece(start: int) -> tuple[int, str, str] | None:
            for end in range(len(run), start, -1):
                known = self.find(run[start:end])
                if known is None or (run[start:end] == "e" and len(run) > 1):
                    continue
                rest = end
                while rest < len(run) and known[0] == "function" and run[rest].isdigit():
                    rest += 1  # cos2theta: the digits belong to the argument
                if rest < len(run) and run[rest] == "_":
                    continue
                if rest < len(run) and run[rest].isdigit():
                    continue
                if fits(rest):
                    return end - start, *known
            dead.add(start)
            return None

        return piece(0) if len(run) <= MAX_FOUND else None


@lru_cache(maxsize=64)
def _vocabulary(variables: tuple[str, ...]) -> _Vocabulary:
    return _Vocabulary(variables)


# --- trees ------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Node:
    """One operation: ``number constant variable neg sum product power call degree``.

    ``name`` is the number's text, the name, or one sign for each term of a sum or product.
    ``angle``: the value is an angle in radians because a degree sign says so.
    """

    kind: str
    name: str = ""
    args: tuple[_Node, ...] = ()
    angle: bool = False

    def walk(self) -> Iterable[_Node]:
        yield self
        for arg in self.args:
            yield from arg.walk()

    @property
    def constant(self) -> bool:
        return all(node.kind != "variable" for node in self.walk())


def _number(value: object) -> np.ndarray | np.generic:
    array = np.asarray(value)
    return (array if array.dtype.kind == "c" else array.astype(float))[()]


_CONSTANTS = {"pi": _number(math.pi), "e": _number(math.e), "i": _number(1j)}


def _power(base: Value, exponent: Value) -> Value:
    if np.any(np.abs(exponent) > MAX_EXPONENT):
        raise Unreadable(
            f"an exponent beyond {MAX_EXPONENT} is not computed", code="too_complex", found=f"^{exponent}"
        )
    return base**exponent


def _compute(node: _Node, values: Mapping[str, object]) -> Value:
    if node.kind == "number":
        return _number(float(node.name))
    if node.kind == "constant":
        return _CONSTANTS[node.name]
    if node.kind == "variable":
        return _number(values[node.name])
    args = [_compute(arg, values) for arg in node.args]
    if node.kind == "neg":
        return -args[0]
    if node.kind == "degree":
        return args[0] * (math.pi / 180)
    if node.kind == "power":
        return _power(*args)
    if node.kind == "call":
        return _FUNCTIONS[node.name](*args)
    total = args[0]
    for sign, arg in zip(node.name[1:], args[1:], strict=True):
        if sign == "+":
            total = total + arg
        elif sign == "-":
            total = total - arg
        else:
            total = total * arg if sign == "*" else total / arg
    return total


@dataclass(frozen=True)
class Expression:
    """A formula that has been read.

    ``is_angle``: a degree sign makes it an angle, in radians. ``speaks_radians``: pi or an
    inverse trigonometric function says that an angle without unit may be in radians.
    ``other`` is the second honest reading of ``1/2π``, where the product binds first.
    """

    text: str
    root: _Node
    other: Expression | None = None

    @property
    def variables(self) -> frozenset[str]:
        """Canonical names of the variables used."""
        return frozenset(node.name for node in self.root.walk() if node.kind == "variable")

    @property
    def is_angle(self) -> bool:
        return self.root.angle

    @property
    def speaks_radians(self) -> bool:
        return any(
            (node.kind, node.name) == ("constant", "pi") or (node.kind == "call" and node.name in _INVERSE)
            for node in self.root.walk()
        )

    def evaluate(self, values: Mapping[str, object] | None = None) -> Value:
        """The value, of the shape to which the values broadcast; angles in radians.

        Raises
        ------
        Unreadable
            A scalar result that is not finite (an array is NaN or infinite there), an exponent beyond 64.
        """
        with np.errstate(all="ignore"):
            result = _compute(self.root, values or {})
        if np.ndim(result):
            return result
        if not np.isfinite(result):
            message = f"{shorten(self.text)!r} has no finite value"
            raise Unreadable(message, code="not_finite", found=self.text)
        return result.item()


# --- parser -----------------------------------------------------------------------------

_NUMBER = re.compile(
    r"(?:[0-9]{1,3}(?:[ '][0-9]{3})+(?![0-9])|[0-9]+)?(?:[.,][0-9]*)?"
    r"(?:[eE][+-]?[0-9]+(?![A-Za-z0-9.,]))?"
)
_RUN = re.compile(r"[A-Za-z](?:[A-Za-z0-9]|_(?=[A-Za-z0-9]))*")
_TIMES = re.compile(r"(?<=[0-9)])\s*[xX]\s*(?=[0-9(])")
_FRACTION = re.compile(r"\\[dt]?frac\s*")
_GROUPS = {"(": ")", "[": "]", "{": "}"}


class _Parser:
    """One reading of one text; ``tight`` lets ``2π`` bind before the division in ``1/2π``."""

    def __init__(self, text: str, vocabulary: _Vocabulary, *, tight: bool) -> None:
        self.text = text
        self.vocabulary = vocabulary
        self.tight = tight
        self.ambiguous = False
        self.at = 0
        self.depth = 0
        self.comma_separates = False

    def fail(self, why: str, code: str, found: str = "") -> Unreadable:
        found = found or self.text[self.at :]
        place = f" at {shorten(found)!r}" if found else " at its end"
        message = f"cannot read {shorten(self.text)!r}{place}: {why}"
        return Unreadable(message, code=code, found=found or self.text)

    def peek(self) -> str:
        while self.at < len(self.text) and self.text[self.at] == " ":
            self.at += 1
        return self.text[self.at : self.at + 1]

    def take(self, chars: str) -> str:
        char = self.peek()
        if char and char in chars:
            self.at += 1
            return char
        return ""

    def whole(self) -> _Node:
        node = self.sum()
        if self.peek():
            raise self.fail("it does not continue a formula", "not_a_number")
        return node

    def deeper(self) -> None:
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise self.fail(f"more than {MAX_DEPTH} levels", "too_complex", self.text)

    def sum(self) -> _Node:
        self.deeper()
        signs, terms = "+", [self.product()]
        while sign := self.take("+-"):
            signs += sign
            terms.append(self.product())
        self.depth -= 1
        if len(terms) == 1:
            return terms[0]
        # A term with a variable may be an angle: theta2 + 90°.
        if len({term.angle for term in terms if term.angle or term.constant}) > 1:
            raise self.fail("it adds degrees to a plain number", "mixed_units", self.text)
        return _Node("sum", signs, tuple(terms), any(term.angle for term in terms))

    def product(self) -> _Node:
        signs, factors = "", []
        sign = "*"
        while True:
            chunk = self.chunk()
            if sign == "/" and len(chunk) > 1:
                self.ambiguous = True
                if self.tight:
                    chunk = [_Node("product", "*" * len(chunk), tuple(chunk), any(f.angle for f in chunk))]
            signs += sign + "*" * (len(chunk) - 1)
            factors += chunk
            if not (sign := self.take("*/")):
                break
        if len(factors) == 1:
            return factors[0]
        if factors[0].kind == "neg":  # -R/r is the opposite of R/r, and is written so
            factors[0], negative = factors[0].args[0], True
        else:
            negative = False
        balance = sum(1 if s == "*" else -1 for s, f in zip(signs, factors, strict=True) if f.angle)
        node = _Node("product", signs, tuple(factors), balance == 1)
        return _Node("neg", args=(node,), angle=node.angle) if negative else node

    def chunk(self) -> list[_Node]:
        """Factors written side by side."""
        factors = [self.signed()]
        while char := self.peek():
            digit = char in "0123456789.,"
            closed = self.text[: self.at].rstrip()[-1] in ")]}°"
            if digit and not closed:
                break
            if not (digit or char.isalpha() or char in "([{√\\"):
                break
            if char == "e" and self.text[self.at - 1].isdigit():
                break  # 5e is a broken exponent, not five times Euler's number
            if (digit and char in ".,") or (char.isalpha() and not char.isascii()):
                break
            factors.append(self.power())
        return factors

    def signed(self) -> _Node:
        negative = False
        while sign := self.take("+-"):
            negative ^= sign == "-"
        node = self.power()
        return _Node("neg", args=(node,), angle=node.angle) if negative else node

    def power(self) -> _Node:
        base = self.postfix()
        if not self.take("^"):
            return base
        return self.raised(base, self.exponent())

    def exponent(self) -> _Node:
        self.deeper()
        exponent = self.signed()
        self.depth -= 1
        return exponent

    def raised(self, base: _Node, exponent: _Node) -> _Node:
        imaginary = any((n.kind, n.name) == ("constant", "i") for n in exponent.walk())
        if base == _Node("variable", "e") and imaginary:
            base = _Node("constant", "e")  # an offset may be called e, but not under an imaginary exponent
        if exponent.constant and not imaginary:
            with np.errstate(all="ignore"):
                size = abs(_compute(exponent, {}))
            if not size <= MAX_EXPONENT:
                why = f"an exponent beyond {MAX_EXPONENT} is not computed"
                raise self.fail(why, "too_complex", self.text)
        return _Node("power", args=(base, exponent))

    def postfix(self) -> _Node:
        node = self.primary()
        if self.take("°"):
            return _Node("degree", args=(node,), angle=True)
        run = _RUN.match(self.text, self.at)
        if run and self.vocabulary.find(run[0]) == ("degree", "deg"):
            self.at = run.end()
            return _Node("degree", args=(node,), angle=True)
        return node

    def primary(self) -> _Node:
        char = self.peek()
        if not char:
            raise self.fail("something is missing", "not_a_number")
        if char in "0123456789.,":
            return self.number()
        if char in _GROUPS:
            return self.group()
        if self.take("√"):
            self.deeper()
            node = _Node("call", "sqrt", (self.postfix(),))
            self.depth -= 1
            return node
        if fraction := _FRACTION.match(self.text, self.at):
            self.at = fraction.end()
            above, below = self.group(), self.group()
            return _Node("product", "*/", (above, below), above.angle and not below.angle)
        if run := _RUN.match(self.text, self.at):
            return self.named(run[0])
        raise self.fail(f"{char!r} means nothing here", "not_a_number")

    def group(self) -> _Node:
        opening = self.take("([{")
        if not opening:
            raise self.fail("a bracket is missing", "not_a_number")
        separates, self.comma_separates = self.comma_separates, False
        node = self.sum()
        self.close(opening)
        self.comma_separates = separates
        return node

    def close(self, opening: str) -> None:
        if not self.take(_GROUPS[opening]):
            raise self.fail(f"a bracket {opening!r} is not closed", "not_a_number")

    def number(self) -> _Node:
        text = _NUMBER.match(self.text, self.at)[0]
        if self.comma_separates and "," in text:
            text = text[: text.index(",")]
        digits = text.replace(" ", "").replace("'", "").replace(",", ".")
        if not digits.lstrip(".")[:1].isdigit():
            raise self.fail("a number is missing", "not_a_number")
        self.at += len(text)
        return _Node("number", digits)

    def named(self, run: str) -> _Node:
        known = self.vocabulary.first(run)
        if known is None or known[1] == "degree":
            names = [*self.vocabulary.variables.values(), *_FUNCTIONS, "pi"]
            raise self.fail(f"no such symbol{nearest(run, names)}", "unknown_symbol", run)
        length, kind, name = known
        self.at += length
        return self.call(name) if kind == "function" else _Node(kind, name)

    def call(self, name: str) -> _Node:
        self.deeper()
        exponent = self.exponent_of_function() if self.take("^") else None
        args = self.arguments(name) if self.peek() in ("(", "{") else (self.bare_argument(name),)
        if len(args) != (2 if name == "atan2" else 1):
            raise self.fail(f"{name} does not take {len(args)} arguments", "not_a_number", self.text)
        self.depth -= 1
        node = _Node("call", name, args)
        return self.raised(node, exponent) if exponent else node

    def exponent_of_function(self) -> _Node:
        """``cos^2(x)``; a negative one is refused, since ``cos^-1`` means two things."""
        exponent = self.group() if self.peek() in ("(", "{") else self.number()
        if exponent.kind != "number":
            raise self.fail("this power of a function has two meanings", "not_a_number", self.text)
        return exponent

    def arguments(self, name: str) -> tuple[_Node, ...]:
        start = self.at
        opening = self.take("({")
        separates = self.comma_separates
        self.comma_separates = name == "atan2" and ";" not in self.inside(start)
        args = [self.sum()]
        while self.take(",;" if name == "atan2" else ""):
            args.append(self.sum())
        self.close(opening)
        self.comma_separates = separates
        return tuple(args)

    def inside(self, start: int) -> str:
        """The text of the brackets that open at ``start``, or all that follows if they never close."""
        level = 0
        for at in range(start, len(self.text)):
            level += (self.text[at] in _GROUPS) - (self.text[at] in ")]}")
            if level == 0:
                return self.text[start:at]
        return self.text[start:]

    def bare_argument(self, name: str) -> _Node:
        """The argument of ``cos θ``, ``cos 2θ``, ``sqrt 2``: a factor, with its numeric coefficient."""
        argument = self.power()
        if argument.kind != "number" or name == "sqrt":
            return argument
        run = _RUN.match(self.text, self.at) if self.peek() else None
        known = self.vocabulary.first(run[0]) if run else None
        if known and known[1] in ("variable", "constant"):
            return _Node("product", "**", (argument, self.power()))
        return argument


def _parse(text: str, vocabulary: _Vocabulary, *, tight: bool) -> tuple[_Node, bool]:
    parser = _Parser(text, vocabulary, tight=tight)
    return parser.whole(), parser.ambiguous


def parse_expression(text: str, variables: Iterable[str] = ()) -> Expression:
    """Read a formula over the given variables.

    Names may be written as people do: ``theta2``, ``θ_2``, ``θ₂``, ``\\theta_{2}``; ``psi_dot``, ``ψ̇``, ``ψ'``. With
    variables, ``i`` is the imaginary unit; ``e`` is Euler's number unless a variable has that name.

    Raises
    ------
    Unreadable
        With a ``code``: ``too_long``, ``too_complex``, ``unknown_symbol``, ``mixed_units``, ``not_a_number``.
    """
    if len(text) > MAX_LENGTH:
        message = f"a text of {len(text)} characters is not read; at most {MAX_LENGTH} are"
        raise Unreadable(message, code="too_long", found=text)
    vocabulary = _vocabulary(tuple(variables))
    plain = _spelled_out(without_latex(tidy(text)))
    if vocabulary.variables and ("'" in plain or '"' in plain):
        plain = _primes_as_dots(plain)
    if "x" not in vocabulary.variables:
        plain = _TIMES.sub("*", plain)
    root, ambiguous = _parse(plain, vocabulary, tight=False)
    other = Expression(text, _parse(plain, vocabulary, tight=True)[0]) if ambiguous else None
    return Expression(text, root, other)


# --- equations --------------------------------------------------------------------------


@dataclass(frozen=True)
class Equation:
    """Two formulas with an equals sign between them."""

    text: str
    left: Expression
    right: Expression

    @property
    def variables(self) -> frozenset[str]:
        return self.left.variables | self.right.variables

    def difference(self, values: Mapping[str, object]) -> Value:
        """Left side minus right side."""
        return self.left.evaluate(values) - self.right.evaluate(values)

    def gap(self, values: Mapping[str, np.ndarray], count: int) -> tuple[np.ndarray, np.ndarray]:
        """Left side minus right side at points, of shape ``(count,)``, and the sum of their sizes.

        NaN where there is no value.
        """
        with np.errstate(all="ignore"):
            return _sides(self, values, count)

    def in_degrees(self) -> Equation | None:
        """The equation with numbers that stand beside angles taken as degrees: ``sin(theta2 + 90)``.

        None where no such number is.
        """
        sides = [_in_degrees(side.root) for side in (self.left, self.right)]
        if sides == [self.left.root, self.right.root]:
            return None
        return Equation(self.text, *(Expression(self.text, root) for root in sides))


def _in_degrees(node: _Node) -> _Node:
    """A tree in which plain numbers added to angles under a sine, a cosine or a tangent are degrees."""
    args = tuple(map(_in_degrees, node.args))
    if node.kind == "call" and node.name in ("sin", "cos", "tan") and args[0].kind == "sum":
        terms = (
            _Node("degree", args=(term,), angle=True) if term.constant and not term.angle else term
            for term in args[0].args
        )
        args = (replace(args[0], args=tuple(terms)),)
    return replace(node, args=args) if args != node.args else node


def parse_equation(text: str, variables: Iterable[str]) -> Equation:
    """Read an equation over the given variables; there must be exactly one equals sign.

    Raises
    ------
    Unreadable
        As :func:`parse_expression`, and ``no_equals_sign``, ``two_equals_signs``.
    """
    if len(text) > MAX_LENGTH:
        message = f"an equation of {len(text)} characters is not read; at most {MAX_LENGTH} are"
        raise Unreadable(message, code="too_long", found=text)
    sides = tidy(text).strip("$ ").split("=")
    if len(sides) != 2:
        code = "no_equals_sign" if len(sides) == 1 else "two_equals_signs"
        raise Unreadable(
            f"an equation has one equals sign, {shorten(text)!r} has {len(sides) - 1}", code=code, found=text
        )
    variables = tuple(variables)
    left, right = (parse_expression(side, variables) for side in sides)
    return Equation(text, left, right)


@lru_cache(maxsize=1024)
def _points(name: str, count: int) -> np.ndarray:
    """Fixed scattered values in (0.3, 3), the same for ever for a name. Not to be changed."""
    words = np.frombuffer(hashlib.shake_128(name.encode()).digest(8 * count), dtype="<u8")
    values = 0.3 + 2.7 * (words / 2.0**64)
    values.flags.writeable = False
    return values


def _sides(equation: Equation, values: Mapping[str, np.ndarray], count: int) -> tuple[np.ndarray, np.ndarray]:
    """Difference of the sides at each point, and the size against which its rounding counts."""
    left = np.broadcast_to(_quiet(equation.left, values), (count,))
    right = np.broadcast_to(_quiet(equation.right, values), (count,))
    return left - right, np.abs(left) + np.abs(right)


def _quiet(expression: Expression, values: Mapping[str, np.ndarray]) -> Value:
    try:
        return expression.evaluate(values)
    except Unreadable:
        return math.nan


def same_equation(a: Equation, b: Equation, *, parameters: Iterable[str] = (), rng_points: int = 32) -> bool:
    """Whether two equations differ by a factor only, judged by value at scattered points.

    The factor is a number, or an expression in the ``parameters`` alone (lengths, where angles and rates are
    the unknowns): ``omega = -(R + r)*phi_dot/r`` is ``r*omega + (R + r)*phi_dot = 0``. It may also hold what one
    of the two divides by, a tangent's cosine with it, as long as that does not vanish with the equation:
    ``sin(a)/sin(b) = r2/r1`` is ``r1*sin(a) = r2*sin(b)``. Points outside a domain (a negative square root) are
    left out. An equation that holds everywhere says nothing and equals only another such.
    """
    names = sorted(a.variables | b.variables)
    held = [name for name in names if name in set(parameters)]
    draws = 4 if held else 1

    def drawn(draw: int) -> dict[str, np.ndarray]:
        values = {name: _points(name, rng_points) for name in names}
        return values | {name: np.full(rng_points, _points(name, draws)[draw]) for name in held}

    if all(_proportional(a, b, drawn(draw), rng_points) for draw in range(draws)):
        return True
    divisors = [d for d in _divisors(a) + _divisors(b) if not d.variables <= set(held)]
    if not 0 < len(divisors) <= MAX_DIVISORS:
        return False
    points = [drawn(draw) for draw in range(draws)]
    powers = _powers(a, b, divisors, points[0], rng_points)
    if powers is None:
        return False
    divided = [(d, power) for d, power in zip(divisors, powers, strict=True) if power]
    if not all(_proportional(a, b, values, rng_points, divided) for values in points):
        return False
    lines = _Lines(names, held)
    with np.errstate(all="ignore"):
        return _apart([divisor for divisor, _ in divided], (a, b), lines)


def _proportional(
    a: Equation,
    b: Equation,
    values: Mapping[str, np.ndarray],
    rng_points: int,
    divided: Iterable[tuple[Expression, int]] = (),
) -> bool:
    """Whether ``a`` and ``b`` times powers of ``divided`` keep one ratio, finite and not zero."""
    with np.errstate(all="ignore"):
        (da, sa), (db, sb) = (_sides(e, values, rng_points) for e in (a, b))
        for divisor, power in divided:
            factor = _quiet(divisor, values) ** float(power)
            db, sb = db * factor, sb * np.abs(factor)
        kept = np.isfinite(da) & np.isfinite(db)
    if kept.sum() < max(2, rng_points // 4):
        return False
    da, sa, db, sb = da[kept], sa[kept], db[kept], sb[kept]
    empty_a, empty_b = (bool(np.all(np.abs(d) <= 1e-12 * s)) for d, s in ((da, sa), (db, sb)))
    if empty_a or empty_b:
        return empty_a and empty_b
    best = int(np.argmax(np.abs(db) / np.where(sb > 0, sb, 1.0)))
    factor = da[best] / db[best]
    close = np.abs(da - factor * db) <= 1e-9 * (sa + np.abs(factor) * sb)
    return bool(factor != 0 and np.all(close))


# --- equations that are divided by something ----------------------------------------------

MAX_DIVISORS = 6
_LINES = 10
_STEPS = 96
_ZOOMS = 9  #: each narrows a place eight times, to about 1e-10
_NEGLIGIBLE = 1e-6  #: what counts as zero, beside the usual size
_ENOUGH = 4  #: zeros on the lines, without which nothing is said

_OfValues = Callable[[Mapping[str, np.ndarray], int], np.ndarray]


def _factors(node: _Node) -> Iterable[_Node]:
    """What a product, a power or an opposite is made of, whatever the powers; a tangent is a quotient."""
    if node.kind == "product":
        for arg in node.args:
            yield from _factors(arg)
    elif node.kind in ("neg", "degree", "power"):
        yield from _factors(node.args[0])
    elif (node.kind, node.name) == ("call", "tan"):
        yield _Node("call", "sin", node.args)
        yield _Node("call", "cos", node.args)
    else:
        yield node


def _divisors(equation: Equation) -> list[Expression]:
    """The factors by which an equation divides: each vanishes only where the equation is not defined."""
    found: dict[_Node, Expression] = {}
    for node in (*equation.left.root.walk(), *equation.right.root.walk()):
        below: list[_Node] = []
        if node.kind == "product":
            below = [arg for sign, arg in zip(node.name, node.args, strict=True) if sign == "/"]
        elif node.kind == "power" and node.args[1].kind == "neg":
            below = [node.args[0]]
        elif node.kind == "call" and node.name == "tan":
            below = [_Node("call", "cos", node.args)]
        for factor in itertools.chain.from_iterable(map(_factors, below)):
            if not factor.constant:
                found.setdefault(factor, Expression(equation.text, factor))
    return list(found.values())


def _powers(
    a: Equation,
    b: Equation,
    divisors: Sequence[Expression],
    values: Mapping[str, np.ndarray],
    rng_points: int,
) -> list[int] | None:
    """The whole powers of the divisors whose product is the ratio of ``a`` to ``b``, if the values allow it.

    A divisor proportional to an earlier one gets the power 0.
    """
    with np.errstate(all="ignore"):
        da, db = (_sides(e, values, rng_points)[0] for e in (a, b))
        ratio = np.log(np.abs(da / db))
        columns = [np.log(np.abs(np.broadcast_to(_quiet(d, values), (rng_points,)))) for d in divisors]
    kept = np.isfinite(ratio) & np.all(np.isfinite(columns), axis=0)
    if kept.sum() < len(divisors) + 4:
        return None
    powers = [0] * len(divisors)
    table = np.array([column[kept] for column in columns]).T
    table, ratio = table - table.mean(axis=0), ratio[kept] - ratio[kept].mean()
    chosen: list[int] = []
    for place, column in enumerate(table.T):
        if all(np.max(np.abs(column - table[:, other])) > 1e-9 for other in chosen):
            chosen.append(place)
    found = np.linalg.lstsq(table[:, chosen], ratio, rcond=None)[0]
    for place, power in zip(chosen, np.rint(found), strict=True):
        if abs(power) > 4:
            return None
        powers[place] = int(power)
    return powers


class _Lines:
    """Fixed scattered lines through the space of the variables, along which a function's zeros are found.

    Parameters keep their value on a line; the other variables run through both signs and some turns.
    """

    def __init__(self, names: Iterable[str], held: Iterable[str]) -> None:
        fixed = set(held)
        self.start = {n: _points(n, _LINES) if n in fixed else _both_signs(f"start of {n}") for n in names}
        self.slope = {n: np.zeros(_LINES) if n in fixed else 2 * _both_signs(f"slope of {n}") for n in names}

    def along(self, function: _OfValues, line: np.ndarray, t: np.ndarray) -> np.ndarray:
        """The size of a function at points of lines, infinite where it has none."""
        values = {name: start[line] + t * self.slope[name][line] for name, start in self.start.items()}
        size = np.abs(function(values, t.size))
        return np.where(np.isnan(size), np.inf, size)

    def zeros(self, function: _OfValues) -> tuple[np.ndarray, np.ndarray, float]:
        """Lines and places of the zeros, also of those where no sign changes; below what a size is zero."""
        grid = np.linspace(-1.0, 1.0, _STEPS)
        line, t = np.repeat(np.arange(_LINES), _STEPS), np.tile(grid, _LINES)
        size = self.along(function, line, t).reshape(_LINES, _STEPS)
        finite = size[np.isfinite(size)]
        inside = size[:, 1:-1]
        smallest = (inside <= size[:, :-2]) & (inside <= size[:, 2:]) & np.isfinite(inside)
        line, place = np.nonzero(smallest)
        t, width = grid[place + 1], grid[1] - grid[0]
        for _ in range(_ZOOMS):
            fan = t[:, None] + width * np.linspace(-1.0, 1.0, 17)
            size = self.along(function, np.repeat(line, 17), fan.ravel()).reshape(fan.shape)
            t = fan[np.arange(t.size), size.argmin(axis=1)]
            width /= 8
        zero = _NEGLIGIBLE * float(np.median(finite)) if finite.size else 0.0
        kept = self.along(function, line, t) <= zero
        return line[kept], t[kept], zero


def _both_signs(name: str) -> np.ndarray:
    return (_points(name, _LINES) - 1.65) * 2.2


def _apart(divisors: Sequence[Expression], equations: Sequence[Equation], lines: _Lines) -> bool:
    """Whether divisors do not vanish at the solutions of the equations, nor the equations where they do.

    An equation without a solution on the lines, or over complex numbers, is not said to be apart.
    """
    gaps = [lambda values, count, e=e: _sides(e, values, count)[0] for e in equations]
    sizes = [lambda values, count, d=d: np.broadcast_to(_quiet(d, values), (count,)) for d in divisors]
    solved, divided = ([(f, *lines.zeros(f)) for f in functions] for functions in (gaps, sizes))
    if any(t.size < _ENOUGH for _, _, t, _ in solved):
        return False
    return not any(
        np.any(lines.along(f, line, t) <= zero)
        for (gap, gap_line, gap_t, gap_zero), (size, size_line, size_t, size_zero) in itertools.product(
            solved, divided
        )
        for f, line, t, zero in ((size, gap_line, gap_t, size_zero), (gap, size_line, size_t, gap_zero))
    )


# --- LaTeX ------------------------------------------------------------------------------

_LATEX_FUNCTIONS = {
    "asin": r"\arcsin", "acos": r"\arccos", "atan": r"\arctan", "atan2": r"\operatorname{atan2}",
}  # fmt: skip
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


def _latex(node: _Node, symbols: Mapping[str, str]) -> str:
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


def _latex_product(node: _Node, args: list[str]) -> str:
    above = [(n, t) for s, n, t in zip(node.name, node.args, args, strict=True) if s == "*"]
    below = [(n, t) for s, n, t in zip(node.name, node.args, args, strict=True) if s == "/"]

    def row(pairs: list[tuple[_Node, str]]) -> str:
        if len(pairs) == 1 and (below or pairs[0][0].kind not in ("sum", "neg")):
            return pairs[0][1]
        return _side_by_side([_bracketed(t) if n.kind in ("sum", "neg") else t for n, t in pairs])

    return rf"\frac{{{row(above)}}}{{{row(below)}}}" if below else row(above)


def _latex_call(node: _Node, args: list[str]) -> str:
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
        A name without a symbol, or a text that is no equation.
    """
    equation = parse_equation(text, symbols)
    return f"{_latex(equation.left.root, symbols)} = {_latex(equation.right.root, symbols)}"
