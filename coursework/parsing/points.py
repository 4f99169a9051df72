"""Points and vectors by their coordinates, with a unit each or one for all."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from numbers import Real
from typing import Any

from coursework.parsing.digits import in_unit, written_amount
from coursework.parsing.expressions import plain_expression
from coursework.parsing.numbers import NAME, RATIO, read_amounts, says_value, target_unit, without_name
from coursework.parsing.reading import Reading, Stop, bare_value, reading_of, text_of
from coursework.parsing.spelling import plain_spelling, shorten, unwrapped
from coursework.parsing.units import Unit, parse_unit, plain_unit, same_dimension
from coursework.parsing.vocabulary import MAX_LENGTH, Unreadable

# --- points -----------------------------------------------------------------------------

_POINT = re.compile(r"(?:[^\W\d_]\w{0,9}\s*)?[(\[{<](?P<inside>.*)[)\]}>]\s*(?P<unit>.*)", re.DOTALL)


#: The name of a base, ``(1, 0, 1)_a``.
_OF_BASE = re.compile(r"(?<=[)\]}])\s*_\s*(?:\{\s*\w{1,2}\s*\}|[^\W\d_](?![^\W_]))")

_SIGNED_AFTER_SPACE = re.compile(r"\d\s+[-+\u2212]\d")


def _splits(text: str) -> Iterable[list[str]]:
    """Ways to cut a text into coordinates, the likelier first."""
    if ";" in text or "|" in text:
        yield re.split(r"[;|]", text)
        return
    commas = text.split(",")
    yield re.split(r",\s+|\s+,\s*", text)
    pieces = text.replace(", ", " ").split()
    yield pieces
    if not any(map(_SIGNED_AFTER_SPACE.search, commas)):  # 21 -18,5: no difference, but two numbers
        yield commas
    if len(commas) % 2 == 0:  # 12,3,4,5: each other comma is decimal
        yield [f"{a},{b}" for a, b in zip(commas[::2], commas[1::2], strict=True)]


def _coordinates(pieces: Sequence[str], unit: str, target: Unit) -> list[tuple[tuple[float, ...], str, bool]]:
    """Return the readings of coordinates, their echo, whether a unit is written; the last one's serves for
    all."""
    pieces = [piece.strip() for piece in pieces]
    columns = [read_amounts(piece, target) for piece in pieces]
    units = {column[0].unit for column in columns}
    if not unit and len(units) == 2 and "" in units:
        unit = plain_spelling((units - {""}).pop())  # it was made to be shown
        columns = [
            column if column[0].unit else read_amounts(f"{without_name(piece)} {unit}", target)
            for piece, column in zip(pieces, columns, strict=True)
        ]
    readings = []
    for which in (0, -1):
        amounts = [column[which] for column in columns]
        echo = "(" + "; ".join(a.echo for a in amounts) + ")"
        readings.append((tuple(a.value for a in amounts), echo, any(a.unit for a in amounts)))
    return readings


class _CutInTwo(Stop):
    """A text that is cut into other coordinates at other places."""


def _bare_point(text: str) -> tuple[str, str]:
    """Return the coordinates inside brackets, and the unit behind the brackets."""
    named = NAME.match(text)
    if named and text.count("=") + text.count(":") == 1:  # A = (1 ; 2), but not x = 1 ; y = 2
        if says_value(named[0]):
            raise Stop("two_values", text)
        text = text[named.end() :]
    match = _POINT.fullmatch(_OF_BASE.sub("", text.rstrip(" .;,"), count=1))
    return (match["inside"], match["unit"].lstrip("*").strip()) if match else (text.rstrip(" .;,"), "")


_AXIS = re.compile(
    r"(?P<sign>[+-]?)\s*(?:(?:l'\s*)?ax(?:e|is)\s+)?(?:\\?(?:vec"
    r"|overrightarrow)\s*)?\{?\s*(?P<letter>[xyz])\u20d7?\s*\}?(?:[ -]axis)?",
    re.I,
)  #: ``y``, ``-z``, ``\\vec y``, ``y axis``


def _axis(text: str, count: int) -> tuple[float, ...] | None:
    """Return the direction of an axis of coordinates that is named, or ``None``."""
    match = _AXIS.fullmatch(text)
    if match is None:
        return None
    index = "xyz".index(match["letter"].lower())
    if index >= count:
        return None
    sign = -1.0 if match["sign"] == "-" else 1.0
    return tuple(sign if k == index else 0.0 for k in range(count))


_VECTOR = re.compile(
    r"\\?(?:vec|overrightarrow)\s*\{?\s*([xyz])\s*\}?(?:\s*_\s*\{?\s*[a-z]\s*\}?)?(?![^\W\d_])"
    r"|(?<![^\W\d_])([xyz])\u20d7?(?:\s*_\s*\{?\s*[a-z]\s*\}?)?(?![^\W_])"
)  #: a vector of the base: ``x``, ``\\vec{x}_a``; with a number, ``x_0``, it is one of another base


_TWO_SIGNS = re.compile(r"[+-]\s*[+-]")
_MULTIPLE = re.compile(r"^(?:\\?(?:omega|lambda)|[ωλk])\s*[.*]?\s*(?=\()")  #: ``ω (x_a + z)``


def _combination(
    text: str, count: int, symbols: Mapping[str, float] | None = None
) -> tuple[float, ...] | None:
    """Return the vector that a sum of vectors of the base is, ``x_a + 1.36 z``, ``(3x - 4y)/5``,
    ``(R + r) x``, or ``None``."""
    names, symbols = tuple("xyz"[:count]), symbols or {}
    bare = _MULTIPLE.sub("", text, count=1)
    spelled = _VECTOR.sub(lambda match: f" {match[1] or match[2]} ", bare)
    if spelled == bare or _TWO_SIGNS.search(bare):
        return None
    try:
        expression = plain_expression(spelled.strip(), (*names, *symbols))
        values = [
            expression.evaluate({**symbols, **dict(zip(names, at, strict=True))}) for at in _trials(count)
        ]
    except Unreadable:
        return None
    *columns, nothing, together = values
    if isinstance(together, complex) or not expression.variables & {*names} or nothing:
        return None
    total = sum(t * c for t, c in zip(_TOGETHER, columns, strict=False))
    return tuple(columns) if math.isclose(together, total, rel_tol=1e-9, abs_tol=1e-12) else None


_TOGETHER = (2.0, 3.0, 5.0)  #: what a square or a product would not pass


def _trials(count: int) -> list[tuple[float, ...]]:
    """Return the points at which a form is tried: each vector of the base, zero, and the sum of all."""
    each = [tuple(float(k == index) for k in range(count)) for index in range(count)]
    return [*each, (0.0,) * count, _TOGETHER[:count]]


def _point(text: str, original: str, target: Unit, count: int) -> Reading:
    stripped = text.rstrip(" .;,")
    if target.dimension == RATIO and (axis := _axis(stripped, count) or _combination(stripped, count)):
        return Reading(original, "read", (axis,), ("(" + "; ".join(f"{c:g}" for c in axis) + ")",))
    inside, unit = _bare_point(text)
    source = target
    if unit:
        stated = plain_unit(unit)
        if stated is None:
            raise Stop("unknown_unit", unit)
        source = stated
        in_unit(0.0, source, target)
    readings: dict[tuple[float, ...], str] = {}
    given = bool(unit)
    stop: Exception | None = None
    for pieces in _splits(inside):
        if len(pieces) != count:
            continue
        try:
            coordinates = _coordinates(pieces, unit, source)
            ways = [tuple(in_unit(v, source, target) for v in values) for values, _, _ in coordinates]
            if readings and not readings.keys() & set(ways):  # 12,3 456: cut in two places
                raise _CutInTwo("two_values", text)
            for values, (_, echo, written) in zip(ways, coordinates, strict=True):
                readings.setdefault(values, written_amount(0.0, echo, unit).echo)
                given = given or written
        except _CutInTwo:
            raise
        except (Stop, Unreadable) as error:
            stop = stop or error
    if not readings:
        raise stop or Stop("wrong_count", text)
    candidates = list(readings.items())[:2]
    return Reading(original, "read", tuple(v for v, _ in candidates), tuple(e for _, e in candidates), given)


def read_point(text: Any, unit: str, count: int) -> Reading:
    """Return the ``count`` coordinates of a point or a vector, each value a tuple of floats in ``unit``; an
    axis is a direction.

    ``(12,3 ; 4,5) mm``, ``12.3, 4.5``, ``[1, 0, 1]``, ``(1 0 1)_a``, ``x = 1; y = 2``, or a list; a direction
    also as a sum, ``x_a + 1.36 z``. A unit behind the brackets or behind the last coordinate serves for all.
    """
    target, text = target_unit(unit), bare_value(text)
    if isinstance(text, (list, tuple)):
        text = "[" + " ; ".join(map(text_of, text[: count + 1])) + "]"
    elif isinstance(text, Real) and not isinstance(text, bool):
        raw = text_of(text)
        return Reading(raw, "unreadable", code="wrong_count", found=shorten(raw))
    return reading_of(text, lambda plain: _point_once(plain, text, target, count))


def worked_out(
    text: Any, unit: str, count: int, symbols: Mapping[str, tuple[float, str]]
) -> tuple[float, ...]:
    """Return the coordinates of a vector of formulas, ``(R + 2r, 0, 0)``, ``(R + 2r) x``, in ``unit``.

    ``symbols`` are those of the statement, each with its value and unit. None where it is not such a vector.
    """
    if isinstance(text, (list, tuple)):
        text = "[" + " ; ".join(map(text_of, text[: count + 1])) + "]"
    if not isinstance(text, str) or len(text) > MAX_LENGTH:
        return ()
    plain, target = plain_spelling(unwrapped(text)).rstrip(" .;,"), parse_unit(unit)
    if (title := NAME.match(plain)) and ":" not in title[0]:  # a colon is not an equals sign: "lambda x: x"
        plain = plain[title.end() :]
    values = {name: _in_unit_of(target, value, parse_unit(own)) for name, (value, own) in symbols.items()}
    try:
        inside, behind = _bare_point(plain)
        stated = plain_unit(behind) if behind else target
        is_same = stated is not None and same_dimension(stated, target)
        found = [_values(pieces, values) for pieces in _splits(inside) if len(pieces) == count and is_same]
    except (Stop, Unreadable):
        found = []
    return next(filter(None, found), ()) or _combination(plain, count, values) or ()


def _in_unit_of(target: Unit, value: float, own: Unit) -> float:
    """Return a given value in the units of length and angle that a formula for a target counts in."""
    if own.is_angle:
        return value * own.factor
    if target.dimension == RATIO:
        return value
    length = target.factor if target.dimension[0] == 1 else 1.0
    return float(value * own.factor / length ** own.dimension[0])


def _values(pieces: Sequence[str], symbols: Mapping[str, float]) -> tuple[float, ...]:
    """Return the values of formulas, and of numbers beside them; nothing where none is a formula."""
    formulas = [plain_expression(piece.strip(), symbols) for piece in pieces]
    values = [formula.evaluate(symbols) for formula in formulas]
    is_real = all(isinstance(value, float) and math.isfinite(value) for value in values)
    return tuple(values) if is_real and any(formula.variables for formula in formulas) else ()


#: Of a class many write the same: each is read once.
_point_once = lru_cache(maxsize=4096)(_point)
