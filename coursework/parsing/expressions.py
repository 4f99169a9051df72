"""Numbers and formulas as people write them, read without ever running them.

A recursive-descent parser over a closed vocabulary: four operations, powers, a few
functions, pi, e, and the variables that the caller names. Every input is bounded in
length, depth and exponent before anything is computed.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from coursework.errors import nearest
from coursework.parsing.spelling import plain_spelling, primes_as_dots, shorten, spelled_out
from coursework.parsing.spoken import with_roots
from coursework.parsing.trees import MAX_EXPONENT, Expression, Operation, compute
from coursework.parsing.vocabulary import (
    FUNCTIONS,
    INVERSE,
    MAX_LENGTH,
    Unreadable,
    Vocabulary,
    vocabulary_of,
)

MAX_DEPTH = 30


# --- parser -----------------------------------------------------------------------------

_NUMBER = re.compile(
    r"(?:[1-9][0-9]{0,2}(?:[ '][0-9]{3})+(?![0-9])|[0-9]+)?(?:\.[0-9]*|,[0-9]+)?"
    r"(?:[eE][+-]?[0-9]+(?![A-Za-z0-9.,]))?"
)
_RUN = re.compile(r"[A-Za-z](?:[A-Za-z0-9]|_(?=[A-Za-z0-9]))*")
_TIMES = re.compile(r"(?<=[0-9)])\s*[xX]\s*(?=[0-9(])|(?<=[0-9A-Za-z)])\s+[xX]\s+(?=[0-9A-Za-z(\\])")
_DOT_OF_PRODUCT = re.compile(r"(?<=[A-Za-z0-9)])\s*\.\s*(?=[A-Za-z(\\√])")  #: r2.cos(theta2)
_NAME = r"\s*(?:\(\s*)?(?P<name{0}>[A-Za-z]\w*)(?:\s*\))?\s*"
_SECOND = r"\s*(?P<second{0}>\^\s*(?:2|\(2\)|\{{2\}}))?"
_DERIVATIVE = re.compile(
    rf"\\[dt]?frac\s*\{{\s*d{_SECOND.format(1)}{_NAME.format(1)}\}}\s*\{{\s*d\s*t(?:\s*\^\s*(?:2|\(2\)|\{{2\}}))?\s*\}}"
    rf"|(?<![A-Za-z0-9_])d{_SECOND.format(2)}{_NAME.format(2)}/\s*d\s*t(?![A-Za-z0-9_])(?:\s*\^\s*(?:2"
    r"|\(2\)))?"
)  #: ``dphi/dt``, ``d(phi)/dt``, ``d^2 phi/dt^2``, ``\\frac{d phi}{dt}``
_FRACTION = re.compile(r"\\[dt]?frac\s*")
_MINUS_ONE = re.compile(r"-\s*1(?![0-9.,])|\(\s*-\s*1\s*\)|\{\s*-\s*1\s*\}")
_GROUPS = {"(": ")", "[": "]", "{": "}"}
_PI = Operation("constant", "pi")


class _Parser:
    """One reading of one text; ``tight`` lets ``2π`` bind before the division in ``1/2π``."""

    def __init__(self, text: str, vocabulary: Vocabulary, *, tight: bool) -> None:
        self.text = text
        self.vocabulary = vocabulary
        self.tight = tight
        self.ambiguous: list[bool] = []  # a quotient of two readings each: whether it is all, and of pi: 1/2π
        self.at = 0
        self.depth = 0
        self.comma_separates = False

    def fail(self, why: str, code: str, piece: str = "") -> Unreadable:
        piece = piece or self.text[self.at :]
        location = f" at {shorten(piece)!r}" if piece else " at its end"
        message = f"cannot read {shorten(self.text)!r}{location}: {why}"
        return Unreadable(message, code=code, piece=piece or self.text)

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

    def whole(self) -> Operation:
        node = self.sum()
        if self.peek():
            raise self.fail("it does not continue a formula", "not_a_number")
        return node

    def deeper(self) -> None:
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise self.fail(f"more than {MAX_DEPTH} levels", "too_complex", self.text)

    def sum(self) -> Operation:
        self.deeper()
        signs, terms = "+", [self.product()]
        while sign := self.take("+-"):
            signs += sign
            terms.append(self.product())
        self.depth -= 1
        if len(terms) == 1:
            return terms[0]
        # A term with a variable may be an angle: theta2 + 90°. An inverse function gives one: 180° -
        # atan(1.6).
        in_degrees = any(term.angle for term in terms)
        if in_degrees and any(term.constant and not (term.angle or term.turns) for term in terms):
            raise self.fail("it adds degrees to a plain number", "mixed_units", self.text)
        return Operation("sum", signs, tuple(terms), in_degrees)

    def product(self) -> Operation:
        signs, factors = "", []
        sign = "*"
        while True:
            chunk = self.chunk()
            if sign == "/" and len(chunk) > 1:
                is_of_pi = len(chunk) == 2 and chunk[0].kind == "number" and chunk[1] == _PI
                self.ambiguous.append(is_of_pi and self.depth == 1)
                if self.tight:
                    chunk = [
                        Operation("product", "*" * len(chunk), tuple(chunk), any(f.angle for f in chunk))
                    ]
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
        node = Operation("product", signs, tuple(factors), balance == 1)
        return Operation("neg", args=(node,), angle=node.angle) if negative else node

    def chunk(self) -> list[Operation]:
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

    def signed(self) -> Operation:
        negative = False
        while sign := self.take("+-"):
            negative ^= sign == "-"
        node = self.power()
        return Operation("neg", args=(node,), angle=node.angle) if negative else node

    def power(self) -> Operation:
        base = self.postfix()
        if not self.take("^"):
            return base
        return self.raised(base, self.exponent())

    def exponent(self) -> Operation:
        self.deeper()
        exponent = self.signed()
        self.depth -= 1
        return exponent

    def raised(self, base: Operation, exponent: Operation) -> Operation:
        imaginary = any((n.kind, n.name) == ("constant", "i") for n in exponent.walk())
        if base == Operation("variable", "e") and imaginary:
            # An offset may be called e, but not under an imaginary exponent.
            base = Operation("constant", "e")
        if exponent.constant and not imaginary:
            with np.errstate(all="ignore"):
                size = abs(compute(exponent, {}))
            if not size <= MAX_EXPONENT:
                why = f"an exponent beyond {MAX_EXPONENT} is not computed"
                raise self.fail(why, "too_complex", self.text)
        return Operation("power", args=(base, exponent))

    def postfix(self) -> Operation:
        node = self.primary()
        if not self.take("°"):
            run = _RUN.match(self.text, self.at)
            if not run or self.vocabulary.find(run[0]) != ("degree", "deg"):
                return node
            self.at = run.end()
        if node.kind == "call" and node.name in INVERSE:  # acos(0.5)° is an angle already
            return replace(node, angle=True)
        return Operation("degree", args=(node,), angle=True)

    def primary(self) -> Operation:
        char = self.peek()
        if not char:
            raise self.fail("something is missing", "not_a_number")
        if char in "0123456789.,":
            return self.number()
        if char in _GROUPS:
            return self.group()
        if self.take("√"):
            self.deeper()
            node = Operation("call", "sqrt", (self.postfix(),))
            self.depth -= 1
            return node
        if fraction := _FRACTION.match(self.text, self.at):
            self.at = fraction.end()
            above, below = self.group(), self.group()
            return Operation("product", "*/", (above, below), above.angle and not below.angle)
        if run := _RUN.match(self.text, self.at):
            return self.named(run[0])
        raise self.fail(f"{char!r} means nothing here", "not_a_number")

    def group(self) -> Operation:
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

    def number(self) -> Operation:
        match = _NUMBER.match(self.text, self.at)
        text = match[0] if match else ""
        if self.comma_separates and "," in text:
            text = text[: text.index(",")]
        digits = text.replace(" ", "").replace("'", "").replace(",", ".")
        if not digits.lstrip(".")[:1].isdigit():
            raise self.fail("a number is missing", "not_a_number")
        self.at += len(text)
        return Operation("number", digits)

    def named(self, run: str) -> Operation:
        leading = self.vocabulary.first(run)
        if leading is None or leading[1] == "degree":
            names = [*self.vocabulary.variables.values(), *FUNCTIONS, "pi"]
            raise self.fail(f"no such symbol{nearest(run, names)}", "unknown_symbol", run)
        length, kind, name = leading
        self.at += length
        return self.call(name) if kind == "function" else Operation(kind, name)

    def call(self, name: str) -> Operation:
        self.deeper()
        exponent = None
        if self.take("^"):
            if inverse := self.inverse_of(name):
                name = inverse
            else:
                exponent = self.exponent_of_function()
        args = self.arguments(name) if self.peek() in ("(", "{") else (self.bare_argument(name),)
        if len(args) != (2 if name == "atan2" else 1):
            raise self.fail(f"{name} does not take {len(args)} arguments", "not_a_number", self.text)
        self.depth -= 1
        node = _cotangent(args) if name == "cot" else Operation("call", name, args)
        return self.raised(node, exponent) if exponent else node

    def inverse_of(self, name: str) -> str:
        """Return the inverse of a function of an angle, as calculators print it: ``sin^-1``, ``cos^(-1)``;
        nothing where none is written."""
        self.peek()
        match = _MINUS_ONE.match(self.text, self.at)
        if match is None or name not in ("sin", "cos", "tan"):
            return ""
        self.at = match.end()
        return f"a{name}"

    def exponent_of_function(self) -> Operation:
        """``cos^2(x)``; a negative one but -1 is refused: it means two things."""
        exponent = self.group() if self.peek() in ("(", "{") else self.number()
        if exponent.kind != "number":
            raise self.fail("this power of a function has two meanings", "not_a_number", self.text)
        return exponent

    def arguments(self, name: str) -> tuple[Operation, ...]:
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
        """Return the text of the brackets that open at ``start``, or all that follows if they never close."""
        level = 0
        for at in range(start, len(self.text)):
            level += (self.text[at] in _GROUPS) - (self.text[at] in ")]}")
            if level == 0:
                return self.text[start:at]
        return self.text[start:]

    def bare_argument(self, name: str) -> Operation:
        """Return the argument of ``cos θ``, ``cos 2θ``, ``sqrt 2``: a factor, with its numeric
        coefficient."""
        argument = self.power()
        if argument.kind != "number" or name == "sqrt":
            return argument
        run = _RUN.match(self.text, self.at) if self.peek() else None
        leading = self.vocabulary.first(run[0]) if run else None
        if leading and leading[1] in ("variable", "constant"):
            return Operation("product", "**", (argument, self.power()))
        return argument


def _rate(found: re.Match[str], vocabulary: Vocabulary) -> str:
    """Return the name of the rate that a quotient of differentials is; itself where there is no such rate."""
    name = f"{found['name1'] or found['name2']}_{'ddot' if found['second1'] or found['second2'] else 'dot'}"
    return f" {name} " if vocabulary.variable(name) else found[0]


def _cotangent(args: tuple[Operation, ...]) -> Operation:
    return Operation("product", "*/", (Operation("call", "cos", args), Operation("call", "sin", args)))


def _parse(text: str, vocabulary: Vocabulary, *, tight: bool) -> tuple[Operation, list[bool]]:
    parser = _Parser(text, vocabulary, tight=tight)
    return parser.whole(), parser.ambiguous


def parse_expression(text: str, variables: Iterable[str] = ()) -> Expression:
    """Read a formula over the given variables.

    Names may be written as people do: ``theta2``, ``θ_2``, ``θ₂``, ``\\theta_{2}``; ``psi_dot``, ``ψ̇``,
    ``ψ'``. With variables, ``i`` is the imaginary unit; ``e`` is Euler's number unless a variable has that
    name.

    Raises
    ------
    Unreadable
        With a ``code``: ``too_long``, ``too_complex``, ``unknown_symbol``, ``mixed_units``, ``not_a_number``.
    """
    if len(text) > MAX_LENGTH:
        message = f"a text of {len(text)} characters is not read; at most {MAX_LENGTH} are"
        raise Unreadable(message, code="too_long", piece=text)
    return plain_expression(plain_spelling(text), variables, text)


def plain_expression(plain: str, variables: Iterable[str] = (), text: str = "") -> Expression:
    """:func:`parse_expression` of a text whose spelling is plain; ``text`` is how it was written."""
    text = text or plain
    vocabulary = vocabulary_of(tuple(variables))
    plain = spelled_out(with_roots(plain))
    if vocabulary.variables and ("'" in plain or '"' in plain):
        plain = primes_as_dots(plain)
    if vocabulary.variables:
        plain = _DERIVATIVE.sub(lambda found: _rate(found, vocabulary), plain)
        plain = _DOT_OF_PRODUCT.sub("*", plain)
    if "x" not in vocabulary.variables:
        plain = _TIMES.sub("*", plain)
    root, ambiguous = _parse(plain, vocabulary, tight=False)
    other = Expression(text, _parse(plain, vocabulary, tight=True)[0]) if ambiguous else None
    return Expression(text, root, other, ambiguous == [True] and root.kind != "sum")
