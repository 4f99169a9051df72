"""Numbers and formulas as people write them, read without ever running them.

A recursive-descent parser over a closed vocabulary: four operations, powers, a few
functions, pi, e, and the variables that the caller names. Every input is bounded in
length, depth and exponent before anything is computed.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from coursework.errors import CourseworkError, nearest
from coursework.spelling import MAX_FOUND, primes_as_dots, shorten, spelled_out, tidy, without_latex

MAX_LENGTH = 500
MAX_DEPTH = 30
MAX_EXPONENT = 64

Value = float | complex | np.ndarray


class Unreadable(CourseworkError, ValueError):
    """A text that is no number, formula or equation we can read.

    ``code`` is a short key for the reason, ``found`` the piece that stops the reading.
    """

    def __init__(self, message: str, *, code: str, found: str = "") -> None:
        super().__init__(message)
        self.code = code
        self.found = shorten(found)


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


_RATE = re.compile(r"theta(\w*?)(d?dot)")


class _Vocabulary:
    """The names that may occur, by any spelling."""

    def __init__(self, variables: tuple[str, ...]) -> None:
        self.variables = {_key(v): v for v in variables}
        self.complex = bool(variables)
        folded = Counter(key.casefold() for key in self.variables)
        #: names that nothing else is like but for capitals; a letter alone has its case for meaning
        self.any_capitals = {
            key.casefold(): v
            for key, v in self.variables.items()
            if len(key) > 1 and folded[key.casefold()] == 1
        }

    def variable(self, run: str) -> str | None:
        """The variable of a spelling: its own, that of a rate by its dots, ``theta2_dot`` for ``omega2``, or in other capitals."""
        key = _key(run)
        if (name := self.variables.get(key)) is not None:
            return name
        if (rate := _RATE.fullmatch(key)) is not None:
            return self.variables.get({"dot": "omega", "ddot": "alpha"}[rate[2]] + rate[1])
        return self.any_capitals.get(key.casefold())

    def find(self, run: str) -> tuple[str, str] | None:
        """Kind and canonical name of one complete spelling."""
        if self.complex and (name := self.variable(run)) is not None:
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
class Operation:
    """One operation: ``number constant variable neg sum product power call degree``.

    ``name`` is the number's text, the name, or one sign for each term of a sum or product.
    ``angle``: the value is an angle in radians because a degree sign says so.
    """

    kind: str
    name: str = ""
    args: tuple[Operation, ...] = ()
    angle: bool = False

    def walk(self) -> Iterable[Operation]:
        yield self
        for arg in self.args:
            yield from arg.walk()

    @property
    def constant(self) -> bool:
        return all(node.kind != "variable" for node in self.walk())

    @property
    def speaks_of_pi(self) -> bool:
        return any((node.kind, node.name) == ("constant", "pi") for node in self.walk())

    @property
    def has_inverse(self) -> bool:
        """Whether an inverse trigonometric function gives an angle in it."""
        return any(node.kind == "call" and node.name in _INVERSE for node in self.walk())

    @property
    def turns(self) -> bool:
        """Whether it is an angle in radians by itself: ``acos(0.5)``, or so many times that."""
        if self.kind == "call":
            return self.name in _INVERSE
        if self.kind == "neg":
            return self.args[0].turns
        return self.kind == "product" and [
            s for s, arg in zip(self.name, self.args, strict=True) if arg.turns
        ] == ["*"]


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


def _compute(node: Operation, values: Mapping[str, object]) -> Value:
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


_A_RADIAN = math.degrees(1.0)


def _calculated_in_degrees(node: Operation) -> Operation:
    """A tree whose trigonometric functions take degrees, and whose inverse ones give them unless converted by hand."""
    args = tuple(map(_calculated_in_degrees, node.args))
    if node.kind == "call" and node.name in ("sin", "cos", "tan"):
        return replace(node, args=(Operation("degree", args=args),))
    if node.kind == "call" and node.name in _INVERSE:
        return Operation("product", "**", (replace(node, args=args), Operation("number", repr(_A_RADIAN))))
    if node.kind == "product" and node.turns and _is_conversion(node):
        args = tuple(
            new.args[0] if old.kind == "call" and old.turns else new
            for old, new in zip(node.args, args, strict=True)
        )
    return replace(node, args=args)


def _is_conversion(node: Operation) -> bool:
    """Whether a product of an inverse function makes radians into degrees, ``acos(0.5)*180/3.14``."""
    pairs = [(s, arg) for s, arg in zip(node.name, node.args, strict=True) if not arg.turns]
    if not pairs or not all(arg.constant for _, arg in pairs):
        return False
    signs, args = zip(*pairs, strict=True)
    one = Operation("number", "1")
    with np.errstate(all="ignore"):
        factor = _compute(Operation("product", "*" + "".join(signs), (one, *args)), {})
    return bool(abs(factor / _A_RADIAN - 1) < 0.01)


@dataclass(frozen=True)
class Expression:
    """A formula that has been read.

    ``is_angle``: a degree sign makes it an angle, in radians. ``speaks_radians``: pi or an
    inverse trigonometric function says that an angle without unit may be in radians.
    ``other`` is the second honest reading of ``1/2π``, where the product binds first.
    """

    text: str
    root: Operation
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
        return self.root.speaks_of_pi or self.root.has_inverse

    @property
    def as_calculated_in_degrees(self) -> Expression | None:
        """The formula of who works in degrees, ``180 - atan(1.6)``: its functions take and give them.

        None where no inverse function gives an angle, where pi says that it is in radians, or a degree sign has spoken.
        """
        if (
            not self.root.has_inverse
            or self.root.speaks_of_pi
            or any(node.angle for node in self.root.walk())
        ):
            return None
        return Expression(self.text, _calculated_in_degrees(self.root))

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
_TIMES = re.compile(r"(?<=[0-9)])\s*[xX]\s*(?=[0-9(])|(?<=[0-9A-Za-z)])\s+[xX]\s+(?=[0-9A-Za-z(\\])")
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
        # A term with a variable may be an angle: theta2 + 90°. An inverse function gives one: 180° - atan(1.6).
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
                self.ambiguous = True
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
            base = Operation(
                "constant", "e"
            )  # an offset may be called e, but not under an imaginary exponent
        if exponent.constant and not imaginary:
            with np.errstate(all="ignore"):
                size = abs(_compute(exponent, {}))
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
        if node.kind == "call" and node.name in _INVERSE:  # acos(0.5)° is an angle already
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
        text = _NUMBER.match(self.text, self.at)[0]
        if self.comma_separates and "," in text:
            text = text[: text.index(",")]
        digits = text.replace(" ", "").replace("'", "").replace(",", ".")
        if not digits.lstrip(".")[:1].isdigit():
            raise self.fail("a number is missing", "not_a_number")
        self.at += len(text)
        return Operation("number", digits)

    def named(self, run: str) -> Operation:
        known = self.vocabulary.first(run)
        if known is None or known[1] == "degree":
            names = [*self.vocabulary.variables.values(), *_FUNCTIONS, "pi"]
            raise self.fail(f"no such symbol{nearest(run, names)}", "unknown_symbol", run)
        length, kind, name = known
        self.at += length
        return self.call(name) if kind == "function" else Operation(kind, name)

    def call(self, name: str) -> Operation:
        self.deeper()
        exponent = self.exponent_of_function() if self.take("^") else None
        args = self.arguments(name) if self.peek() in ("(", "{") else (self.bare_argument(name),)
        if len(args) != (2 if name == "atan2" else 1):
            raise self.fail(f"{name} does not take {len(args)} arguments", "not_a_number", self.text)
        self.depth -= 1
        node = Operation("call", name, args)
        return self.raised(node, exponent) if exponent else node

    def exponent_of_function(self) -> Operation:
        """``cos^2(x)``; a negative one is refused, since ``cos^-1`` means two things."""
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
        """The text of the brackets that open at ``start``, or all that follows if they never close."""
        level = 0
        for at in range(start, len(self.text)):
            level += (self.text[at] in _GROUPS) - (self.text[at] in ")]}")
            if level == 0:
                return self.text[start:at]
        return self.text[start:]

    def bare_argument(self, name: str) -> Operation:
        """The argument of ``cos θ``, ``cos 2θ``, ``sqrt 2``: a factor, with its numeric coefficient."""
        argument = self.power()
        if argument.kind != "number" or name == "sqrt":
            return argument
        run = _RUN.match(self.text, self.at) if self.peek() else None
        known = self.vocabulary.first(run[0]) if run else None
        if known and known[1] in ("variable", "constant"):
            return Operation("product", "**", (argument, self.power()))
        return argument


def _parse(text: str, vocabulary: _Vocabulary, *, tight: bool) -> tuple[Operation, bool]:
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
    plain = spelled_out(without_latex(tidy(text)))
    if vocabulary.variables and ("'" in plain or '"' in plain):
        plain = primes_as_dots(plain)
    if "x" not in vocabulary.variables:
        plain = _TIMES.sub("*", plain)
    root, ambiguous = _parse(plain, vocabulary, tight=False)
    other = Expression(text, _parse(plain, vocabulary, tight=True)[0]) if ambiguous else None
    return Expression(text, root, other)
