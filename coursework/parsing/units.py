"""Units: read by dimension and prefix, never from a list of spellings.

A unit is an exact rational factor, a power of pi, and a dimension. Angle is a dimension of
its own, so that a length is never taken for an angle; where one of two units leaves the
angle out (``1/s`` for ``rad/s``), it is in radians. A level in decibels is one too: it is not a ratio.

``K`` and ``°C`` alone are temperatures, each counted from its own zero: 20 °C is 293.15 K. In a product or a
quotient (``W/(m^2*K)``), and as ``delta_K``, they are differences: 20 °C is 20 K.

The factors are exact: those of the SI brochure (BIPM, 9th edition, 2019), and the international yard and
pound (1959) with standard gravity for ``in ft lb lbf psi``.
"""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

from coursework.errors import BadCourse, WrongUnit
from coursework.messages import Message
from coursework.parsing.spelling import plain_spelling, shorten

#: What the entries of a dimension count. A cycle is a count (1 Hz is one a second) that is a turn
#: where an angle is expected.
DIMENSIONS = (
    "length",
    "mass",
    "time",
    "angle",
    "current",
    "cycle",
    "temperature",
    "amount",
    "light",
    "level",
)
_ANGLE, _CYCLE = DIMENSIONS.index("angle"), DIMENSIONS.index("cycle")

_MAX_LENGTH = 80
_MAX_POWER = 9
_MAX_DECADES = 100


class UnknownUnit(WrongUnit):
    """A text that is not a unit; ``found`` is the piece that is not known."""

    def __init__(self, template: str, piece: str = "", **values: object) -> None:
        super().__init__(template, **({"piece": piece, **values} if values else {}))
        self.found = piece


@dataclass(frozen=True)
class Unit:
    """A unit: ``ratio`` times pi to the power ``pi`` base units (m, kg, s, rad, A, K, mol, cd), and its
    dimension.

    ``zero`` is where a scale of temperatures begins, in K; None for a unit that measures differences.
    """

    text: str
    ratio: Fraction
    pi: int
    dimension: tuple[int, ...]
    zero: Fraction | None = None

    @property
    def factor(self) -> float:
        """One of this unit in base units."""
        return float(self.ratio) * math.pi**self.pi

    @property
    def is_angle(self) -> bool:
        """Return whether the unit measures an angle and nothing else."""
        return self.dimension == _ANGLE_ALONE


def _dimension(**powers: int) -> tuple[int, ...]:
    return tuple(powers.get(name, 0) for name in DIMENSIONS)


_NONE = _dimension()
_ANGLE_ALONE = _dimension(angle=1)


# --- what is known: symbols, prefixes, words --------------------------------------------

_PREFIXES = {
    "": 0,
    "f": -15,
    "p": -12,
    "n": -9,
    "μ": -6,
    "u": -6,
    "m": -3,
    "c": -2,
    "d": -1,
    "da": 1,
    "h": 2,
    "k": 3,
    "M": 6,
    "G": 9,
    "T": 12,
}
_PREFIX_WORDS = {
    "": 0,
    "nano": -9,
    "micro": -6,
    "milli": -3,
    "centi": -2,
    "deci": -1,
    "kilo": 3,
    "mega": 6,
    "giga": 9,
}


def _unit(ratio: str | int | Fraction, pi: int = 0, **powers: int) -> Unit:
    return Unit("", Fraction(ratio), pi, _dimension(**powers))


def _scale_of(zero: str, ratio: str = "1") -> Unit:
    """Return a scale of temperatures that begins at so many K."""
    return Unit("", Fraction(ratio), 0, _dimension(temperature=1), Fraction(zero))


_INCH, _POUND, _GRAVITY = Fraction("0.0254"), Fraction("0.45359237"), Fraction("9.80665")


#: Symbols that take a prefix.
_PREFIXED = {
    "m": _unit(1, length=1),
    "g": _unit("1/1000", mass=1),
    "s": _unit(1, time=1),
    "rad": _unit(1, angle=1),
    "N": _unit(1, length=1, mass=1, time=-2),
    "J": _unit(1, length=2, mass=1, time=-2),
    "W": _unit(1, length=2, mass=1, time=-3),
    "Pa": _unit(1, length=-1, mass=1, time=-2),
    "Hz": _unit(1, time=-1, cycle=1),
    "A": _unit(1, current=1),
    "C": _unit(1, current=1, time=1),
    "V": _unit(1, length=2, mass=1, time=-3, current=-1),
    "Ω": _unit(1, length=2, mass=1, time=-3, current=-2),
    "ohm": _unit(1, length=2, mass=1, time=-3, current=-2),
    "F": _unit(1, length=-2, mass=-1, time=4, current=2),
    "H": _unit(1, length=2, mass=1, time=-2, current=-2),
    "S": _unit(1, length=-2, mass=-1, time=3, current=2),
    "T": _unit(1, mass=1, time=-2, current=-1),
    "Wb": _unit(1, length=2, mass=1, time=-2, current=-1),
    "VA": _unit(1, length=2, mass=1, time=-3),
    "var": _unit(1, length=2, mass=1, time=-3),
    "Wh": _unit(3600, length=2, mass=1, time=-2),
    "Ah": _unit(3600, current=1, time=1),
    "eV": _unit("1.602176634e-19", length=2, mass=1, time=-2),
    "bar": _unit(100_000, length=-1, mass=1, time=-2),
    "L": _unit("1/1000", length=3),
    "l": _unit("1/1000", length=3),
    "K": _scale_of("0"),
    "mol": _unit(1, amount=1),
    "cd": _unit(1, light=1),
}
_DEGREE, _GON, _TURN = _unit("1/180", 1, angle=1), _unit("1/200", 1, angle=1), _unit(2, 1, angle=1)
_TURN_A_MINUTE = _unit("2/60", 1, angle=1, time=-1)
#: Symbols that take none.
_PLAIN = {
    "1": _unit(1),
    "%": _unit("1/100"),
    "min": _unit(60, time=1),
    "h": _unit(3600, time=1),
    "t": _unit(1000, mass=1),
    "deg": _DEGREE,
    "°": _DEGREE,
    "grad": _GON,
    "gon": _GON,
    "gr": _GON,
    "tr": _TURN,
    "rev": _TURN,
    "r": _TURN,
    "rpm": _TURN_A_MINUTE,
    "sec": _unit(1, time=1),
    "rd": _unit(1, angle=1),
    "°C": _scale_of("273.15"),
    "degC": _scale_of("273.15"),
    "°F": _scale_of("45967/180", "5/9"),
    "degF": _scale_of("45967/180", "5/9"),
    "dB": _unit(1, level=1),
    "in": _unit(_INCH, length=1),
    "ft": _unit(12 * _INCH, length=1),
    "lb": _unit(_POUND, mass=1),
    "lbf": _unit(_POUND * _GRAVITY, length=1, mass=1, time=-2),
    "psi": _unit(_POUND * _GRAVITY / _INCH**2, length=-1, mass=1, time=-2),
}
#: What a difference of temperatures is stated in.
_DIFFERENCES = {
    f"delta_{name}": _unit(_PLAIN[name].ratio if name in _PLAIN else 1, temperature=1)
    for name in ("K", "degC", "°C", "degF", "°F")
}
#: Words, without accents, any capitals, with or without a plural s; the first group takes prefix words.
_WORDS = {
    "metre": "m",
    "meter": "m",
    "gramme": "g",
    "gram": "g",
    "seconde": "s",
    "second": "s",
    "radian": "rad",
    "newton": "N",
    "joule": "J",
    "watt": "W",
    "pascal": "Pa",
    "hertz": "Hz",
    "volt": "V",
    "ampere": "A",
    "coulomb": "C",
    "ohm": "Ω",
    "degre": "deg",
    "degree": "deg",
    "grade": "gon",
    "tour": "tr",
    "turn": "tr",
    "revolution": "tr",
    "minute": "min",
    "heure": "h",
    "hour": "h",
    "tonne": "t",
    "farad": "F",
    "henry": "H",
    "siemen": "S",
    "tesla": "T",
    "weber": "Wb",
    "kelvin": "K",
    "litre": "L",
    "liter": "L",
    "mole": "mol",
    "candela": "cd",
    "decibel": "dB",
    "electronvolt": "eV",
    "wattheure": "Wh",
    "watthour": "Wh",
    "inch": "in",
    "inche": "in",
    "pouce": "in",
    "foot": "ft",
    "feet": "ft",
    "celsiu": "°C",
}
_ACCENTS = str.maketrans("éèêàç", "eeeac")


def _scaled(unit: Unit, decades: int) -> Unit:
    return Unit("", unit.ratio * Fraction(10) ** decades, unit.pi, unit.dimension, unit.zero)


def _symbol(name: str) -> Unit | None:
    """Return a symbol with its prefix; a symbol as it stands comes before a prefix (``min`` is no
    milli-inch)."""
    if name in _PLAIN:
        return _PLAIN[name]
    for size in range(3):
        prefix, rest = name[:size], name[size:]
        if prefix in _PREFIXES and rest in _PREFIXED:
            return _scaled(_PREFIXED[rest], _PREFIXES[prefix])
    return None


def _word(name: str) -> Unit | None:
    """Return a unit spelled out, ``millimètres``."""
    low = name.lower().translate(_ACCENTS)
    if len(low) < 4:
        return None
    for prefix, decades in _PREFIX_WORDS.items():
        symbol = _WORDS.get(low.removeprefix(prefix).removesuffix("s")) if low.startswith(prefix) else None
        unit = _symbol(symbol) if symbol and (not prefix or symbol in _PREFIXED) else None
        if unit is not None:
            return _scaled(unit, decades)
    return None


#: Symbols that are known in any capitals, and with a plural s: no other unit is spelled so.
_ANY_CAPITALS = ("rad", "rd", "deg", "grad", "gon", "rev", "tr", "rpm", "min", "sec")


def _capitals(name: str) -> Unit | None:
    """Return a symbol in other capitals, ``RPM``, or with a plural s, ``revs``."""
    low = name.lower()
    for symbol in (low, low.removesuffix("s")):
        if symbol in _ANY_CAPITALS:
            return _symbol(symbol)
    return None


def _moment(name: str) -> Unit | None:
    """``Nm``, ``kNmm``: the one product that is written without a sign."""
    force, newton, arm = name.partition("N")
    if not newton or force not in _PREFIXES or not arm.endswith("m") or arm[:-1] not in _PREFIXES:
        return None
    decades = _PREFIXES[force] + _PREFIXES[arm[:-1]]
    return _scaled(product(_PREFIXED["N"], _PREFIXED["m"], 1), decades)


def product(a: Unit, b: Unit, power: int) -> Unit:
    """Return ``a * b**power``, without a text."""
    dimension = tuple(p + power * q for p, q in zip(a.dimension, b.dimension, strict=True))
    return Unit("", a.ratio * b.ratio**power, a.pi + power * b.pi, dimension)


def _spellings() -> Iterator[str]:
    """Yield the known spellings that a misspelled piece may stand for, for a message."""
    yield from _PLAIN
    for symbol in _PREFIXED:
        for prefix in ("", "m", "c", "k", "μ", "M"):
            yield prefix + symbol
    yield from ("N.m", "N.mm")


# --- reading ----------------------------------------------------------------------------

_TOKEN = re.compile(
    r"\s*(?:(?P<name>° ?[CF](?![^\W\d_])|[^\W\d_]+|[°%](?![^\W\d_]))|(?P<one>1)(?![0-9])"
    r"|(?P<sign>[*./()\[\]]))"
    r"(?P<power>\s*(?:\^|\*\*)\s*(?:[({]\s*(?P<in>[+-]?[0-9])\s*[)}]|(?P<bare>[+-]?[0-9]))"
    r"|(?P<glued>-?[0-9]))?(?![0-9])"
)


_PER = re.compile(r"(?<![^\W\d_])(?:par|per)(?![^\W\d_])", re.I)
_SQUARED = re.compile(r"(?<=[^\W\d_])\s+(?:au carr[ée]|carr[ée]e?s?|squared)(?![^\W\d_])", re.I)
_CELSIUS = re.compile(r"(?:°|deg(?:r[eé]e?)?s?)\s*celsius|deg\.?\s*C(?![^\W\d_])", re.I)
_HYPHEN = re.compile(r"(?<=[^\W\d_])-(?=[^\W\d_])")


class _UnknownPiece(Exception):
    """The piece at which a text stops being a unit."""


def _named(name: str) -> Unit:
    unit = _symbol(name) or _word(name) or _moment(name) or _capitals(name)
    if unit is None:
        raise _UnknownPiece(name)
    return unit


def _may_have_power(token: re.Match[str]) -> bool:
    """Return whether the power of a token, if any, may stand there: ``90°-5`` is a difference, not a
    power."""
    if not token["power"]:
        return True
    return (
        not token["glued"]
        if token["name"] and token["name"][0] in "°%"
        else token["sign"] in (None, ")", "]")
    )


def _tokens(text: str) -> list[tuple[str, int]]:
    """Names, signs and brackets, each with its power (1 unless written)."""
    tokens, at = [], 0
    while at < len(text):
        token = _TOKEN.match(text, at)
        if token is None or not _may_have_power(token):
            raise _UnknownPiece(text[at:].strip())
        power = token["in"] or token["bare"] or token["glued"] or "1"
        name = token["name"] and token["name"].replace("° ", "°")
        tokens.append((name or token["one"] or token["sign"], int(power)))
        at = token.end()
    return tokens


def _chain(tokens: list[tuple[str, int]], text: str, depth: int = 0) -> Unit:
    """Units multiplied and divided from left to right, up to the end or a closing bracket; eats tokens."""
    unit, sign, waiting = _PLAIN["1"], 1, True
    if depth > 5:
        raise _UnknownPiece(text)
    while tokens and tokens[0][0] not in (")", "]"):
        piece, power = tokens.pop(0)
        if piece in ("*", ".", "/"):
            if waiting:
                raise _UnknownPiece(text)
            sign, waiting = (-1 if piece == "/" else 1), True
            continue
        if piece in ("(", "["):
            factor = _chain(tokens, text, depth + 1)
            if not tokens:
                raise _UnknownPiece(text)
            power = tokens.pop(0)[1]
        elif piece == "1" and not waiting and (power != 1 or not tokens or tokens[0][0] != "/"):
            raise _UnknownPiece(text)  # rad 1/s is a unit, ° 1-1 is none
        elif piece == "in" and tokens and tokens[0][0] not in ("*", ".", "/", ")", "]"):
            raise _UnknownPiece("in")  # 12 in mm says a unit, and no inch
        else:
            factor = _named(piece)
        unit, sign, waiting = product(unit, factor, sign * power), 1, False
        if abs(unit.pi) + max(map(abs, unit.dimension)) > 4 * _MAX_POWER:
            raise _UnknownPiece(text)
    if waiting:
        raise _UnknownPiece(text)
    return unit


@lru_cache(maxsize=4096)
def _analyse(text: str) -> tuple[Unit | None, str]:
    """Return the unit of a text, or the piece that is not understood."""
    return _analyse_plain(plain_spelling(text) if len(text) <= _MAX_LENGTH else text, text)


@lru_cache(maxsize=4096)
def _analyse_plain(plain: str, text: str) -> tuple[Unit | None, str]:
    if len(text) > _MAX_LENGTH:
        return None, text
    if plain in _DIFFERENCES:
        unit = _DIFFERENCES[plain]
        return Unit(text, unit.ratio, unit.pi, unit.dimension), ""
    try:
        plain = _PER.sub("/", _CELSIUS.sub("°C", _SQUARED.sub("^2", plain)))
        tokens = _tokens(_HYPHEN.sub("*", plain))
        # A temperature stands alone; with anything beside it, it is a difference.
        zero = _named(tokens[0][0]).zero if len(tokens) == 1 and tokens[0][1] == 1 else None
        unit = _chain(tokens, text)
    except _UnknownPiece as piece:
        return None, str(piece)
    size = abs(math.log10(unit.ratio.numerator) - math.log10(unit.ratio.denominator))
    if tokens or size > _MAX_DECADES:
        return None, text
    return Unit(text, unit.ratio, unit.pi, unit.dimension, zero), ""


def find_unit(text: str) -> Unit | None:
    """Return the unit that a text names, or ``None``."""
    return _analyse(text)[0]


def plain_unit(plain: str) -> Unit | None:
    """:func:`find_unit` of a text whose spelling is plain."""
    return _analyse_plain(plain, plain)[0]


def parse_unit(text: str) -> Unit:
    """Return the unit that a text names: ``rad.s-1``, ``N·m``, ``mm/s²``, ``tr/min``; ``1`` is a ratio.

    A product may be written ``. · * × -`` or a space, a power ``^2 ² 2``, a quotient ``/`` or ``per``. Case
    matters, save in ``RPM`` and the like. A quotient binds from left to right, ``mm/s/mm`` is ``(mm/s)/mm``.

    Raises
    ------
    UnknownUnit
        A :class:`WrongUnit` that names the piece that is not known and the nearest that is.
    """
    unit, piece = _analyse(text)
    if unit is None:
        piece = shorten(piece)
        spellings = list(_spellings())
        near = [s for s in spellings if s.casefold() == piece.casefold()]
        near = near or difflib.get_close_matches(piece, spellings, n=1, cutoff=0.5)
        hint = (
            Message("; did you mean {near!r}?", near=near[0])
            if near
            else Message("; units are such as mm, rad/s, N.m, kg.m^2")
        )
        where = Message(" in {where}", where=repr(shorten(text))) if piece != shorten(text) else ""
        raise UnknownUnit("no unit {piece!r}{where}{hint}", piece, where=where, hint=hint)
    return unit


def check_unit(owner: str, text: str) -> None:
    """Refuse a course that states a unit that is none; ``owner`` begins the message."""
    try:
        parse_unit(text)
    except WrongUnit as fault:
        raise BadCourse(f"{owner}: {fault}") from fault


# --- converting -------------------------------------------------------------------------


def _without_angle(dimension: tuple[int, ...]) -> tuple[int, ...]:
    return tuple(p for i, p in enumerate(dimension) if i not in (_ANGLE, _CYCLE))


def _compatible(a: Unit, b: Unit) -> bool:
    if a.dimension == b.dimension:
        return True
    rest = _without_angle(a.dimension)
    # A bare number is not an angle, and an angle no ratio; beside another dimension radians may go unsaid.
    return rest == _without_angle(b.dimension) and any(rest)


def _as_unit(unit: str | Unit) -> Unit:
    return unit if isinstance(unit, Unit) else parse_unit(unit)


def same_dimension(a: str | Unit, b: str | Unit) -> bool:
    """Return whether a value in one unit can be converted to the other."""
    return _compatible(_as_unit(a), _as_unit(b))


def meant_otherwise(unit: Unit, target: Unit) -> bool:
    """Return whether a unit of another dimension is the right one but for its capitals or its degree sign:
    ``3 S`` for seconds, ``20 C`` for a temperature."""
    if unit.text in ("C", "F") and target.dimension == _PLAIN["°C"].dimension:
        return True
    small = find_unit(unit.text.lower()) if unit.text != unit.text.lower() else None
    return small is not None and _compatible(small, target)


@lru_cache(maxsize=4096)
def _scale(source: Unit, target: Unit) -> tuple[Fraction, int]:
    """Return the factor from ``source`` to ``target``, as a rational and a power of pi."""
    ratio, pi = source.ratio / target.ratio, source.pi - target.pi
    turns = source.dimension[_CYCLE] - target.dimension[_CYCLE]
    if turns and source.dimension[_ANGLE] != target.dimension[_ANGLE]:
        ratio, pi = ratio * Fraction(2) ** turns, pi + turns
    return ratio, pi


def convert(value: Any, from_unit: str | Unit, to_unit: str | Unit) -> Any:
    """Return a value, or an array of values, in another unit of the same dimension.

    A temperature is one in another scale, from its own zero. A power of ten costs one rounding at most. A
    unit without angle, where the other has one, is in radians.

    Raises
    ------
    WrongUnit
        The units have different dimensions, or one is unknown.
    """
    source, target = _as_unit(from_unit), _as_unit(to_unit)
    if not _compatible(source, target):
        raise WrongUnit(
            "{found!r} measures {measured}, but {wanted} is expected, as in {unit!r}",
            found=shorten(source.text),
            measured=describe(source),
            wanted=describe(target),
            unit=target.text,
        )
    if source.zero is not None and target.zero is not None and source.zero != target.zero:
        return _on_scale(value, source, target)
    ratio, pi = _scale(source, target)
    if pi == 0 and ratio == 1:
        return value
    if pi == 0 and max(ratio.numerator, ratio.denominator) < 2**53:
        scaled = value * ratio.numerator if ratio.numerator != 1 else value
        return scaled / ratio.denominator if ratio.denominator != 1 else scaled
    return value * (float(ratio) * math.pi**pi)


def _on_scale(value: Any, source: Unit, target: Unit) -> Any:
    """Return a temperature on another scale; exact where the value is."""
    assert source.zero is not None
    assert target.zero is not None
    ratio, shift = source.ratio / target.ratio, (source.zero - target.zero) / target.ratio
    if isinstance(value, (int, Fraction)):
        return value * ratio + shift
    return value * ratio.numerator / ratio.denominator + float(shift)


def describe(unit: Unit) -> Message:
    """Return a unit's dimension in words: ``length/time^2``."""
    pairs = list(zip(DIMENSIONS, unit.dimension, strict=True))
    above = [f"{{{n}}}" if p == 1 else f"{{{n}}}^{p}" for n, p in pairs if p > 0]
    below = [f"{{{n}}}" if p == -1 else f"{{{n}}}^{-p}" for n, p in pairs if p < 0]
    if not above and not below:
        return Message("a ratio")
    text = "*".join(above or ["1"]) + "".join(f"/{b}" for b in below)
    return Message(text, **{name: Message(name) for name, power in pairs if power})
