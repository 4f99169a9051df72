"""Complex numbers as people write them: ``3+4i``, ``5∠53,1°``, ``5 e^(i 53.13°)``, a unit behind."""

from __future__ import annotations

import cmath
import math
import re
from typing import Any

import numpy as np

from coursework.language.numbers import MINUS
from coursework.parsing.digits import Amount, in_unit
from coursework.parsing.expressions import plain_expression
from coursework.parsing.numbers import read_amounts, refuse_no_number, target_unit, without_name
from coursework.parsing.reading import MOST_TURNS, Reading, Stop, reading_of, text_of
from coursework.parsing.spelling import shorten
from coursework.parsing.units import Unit, plain_unit
from coursework.parsing.vocabulary import Unreadable

#: With a variable, ``i`` and ``j`` are the imaginary unit to the reader of formulas.
_IMAGINARY = ("imaginary_one",)
_ANGLE_SIGN = re.compile(r"\\angle(?![A-Za-z])|∠|∟|/_|(?<=[\d\s)])<(?=\s*[-+\d])")
_PAIR = re.compile(r"\(\s*([^();]+?)\s*;\s*([^();]*(?:°|deg|degr\w+|rad)\s*)\)\s*(.*)", re.I)
_PREFIXED = re.compile(r"(?<![A-Za-z0-9_.])([ij])\s*(?=\d)")
_GLUED_E = re.compile(r"(?<=[0-9)])e(?=\s*(?:\^|\*\*))")  #: 50e^(0.9i)
_UNIT_START = re.compile(r"(?<![^\W\d_])[^\W\d_]|[°%]")
_MAX_PIECES = 8
_BRACKETED = re.compile(r"[(\[]\s*([^()\[\]]*[∠<°][^()\[\]]*)\s*[)\]]\s*(.*)")


def read_complex(answer: Any, unit: str) -> Reading:
    """Return a complex number in ``unit``; the values are Python's complex numbers.

    Sums ``3+4i``, ``3 + j4``, exponentials ``5 e^{i 53.13°}``, moduli with their angles ``5∠53,1°``, and
    ``(5 ; 53.13°)``, where the unit of the second tells that it is an angle. After ``∠`` an angle without a
    unit is in degrees; in an exponent it is in radians. A pair ``(3 ; 4)`` may be either, and is
    ``two_values``.
    """
    if isinstance(answer, (np.ndarray, np.generic)) and np.size(answer) == 1:
        answer = answer.reshape(-1)[0].item() if isinstance(answer, np.ndarray) else answer.item()
    if isinstance(answer, (int, float, complex)) and not isinstance(answer, bool):
        return _from_number(answer)
    if isinstance(answer, (list, tuple)):
        text = text_of(answer)
        return Reading(text, "unreadable", code="two_values", found=shorten(text))
    target = target_unit(unit)
    return reading_of(answer, lambda plain: _read(plain, answer, target))


def _from_number(answer: complex) -> Reading:
    try:
        value = complex(answer)
    except OverflowError:
        value = complex(math.inf)
    if not cmath.isfinite(value):
        text = text_of(answer)
        return Reading(text, "unreadable", code="not_finite", found=shorten(text))
    return Reading(str(answer).strip("()"), "read", (value,), (spelled(value),))


def spelled(value: complex, digits: int = 7) -> str:
    """Return a complex number as it is echoed: ``3 + 4i``, ``3 − 4i``, ``-2i``, ``5``."""
    real, imaginary = f"{value.real:.{digits}g}", f"{abs(value.imag):.{digits}g}"
    below = value.imag < 0
    if float(imaginary) == 0:
        return real
    if float(real) == 0:
        return f"{'-' if below else ''}{imaginary}i"
    return f"{real} {MINUS if below else '+'} {imaginary}i"


def _read(plain: str, text: Any, target: Unit) -> Reading:
    plain = without_name(plain)
    refuse_no_number(plain, target)
    polar = _polar(plain, target)
    if polar is not None:
        values, echo, given = polar
        return Reading(text, "read", (values,), (echo,), given)
    if ";" in plain:
        raise Stop("two_values", plain)
    return _formula(plain, text, target)


# ------------------------------------------------------------------------ polar


def _polar(plain: str, target: Unit) -> tuple[complex, str, bool] | None:
    """Return the value of a modulus and an angle, its echo, whether a unit is written; nothing where it is
    none."""
    unit = ""
    if match := _BRACKETED.fullmatch(plain):
        plain, unit = (match[1], match[2]) if ";" not in match[1] else (plain, "")
    if match := _PAIR.fullmatch(plain):
        modulus, angle, unit = match[1], match[2], match[3]
    elif _ANGLE_SIGN.search(plain):
        modulus, angle = _ANGLE_SIGN.split(plain, maxsplit=1)
    else:
        return None
    angle, unit = _angle_and_unit(angle.strip(), unit.strip(" *"))
    size = _first(read_amounts(f"{modulus.strip()} {unit}".strip(), target))
    turned = _first(read_amounts(angle, target_unit("deg"), thousands=False))
    if abs(turned.value) > MOST_TURNS * 360.0:
        raise Stop("too_many_turns", plain)
    value = cmath.rect(size.value, math.radians(turned.value))
    angle_echo = turned.echo if turned.unit else f"{turned.echo} °"
    return value, f"{size.echo} ∠ {angle_echo}", bool(size.unit)


def _angle_and_unit(angle: str, unit: str) -> tuple[str, str]:
    """``53,1° V`` is an angle and the unit of the modulus."""
    match = re.fullmatch(r"(.*?(?:°|deg(?:re+s?)?|degrés?|rad|[\d)]))\s*\*?\s*([^\W\d_].*)?", angle, re.I)
    if unit or match is None or not match[2] or plain_unit(match[2]) is None:
        return angle, unit
    if target_unit("deg").dimension == plain_unit(match[2]).dimension:  # type: ignore[union-attr]
        return angle, unit
    return match[1], match[2]


def _first(amounts: list[Amount]) -> Amount:
    return amounts[0]


# --------------------------------------------------------------------- formulas


def _formula(plain: str, text: Any, target: Unit) -> Reading:
    """Return a sum, a product or an exponential, with or without a unit behind it; the longest unit that
    leaves a formula is taken."""
    first: Unreadable | None = None
    starts = [
        m.start() for m in _UNIT_START.finditer(plain) if m.start() > 0 and len(plain) - m.start() <= 60
    ]
    for start in [*starts[-_MAX_PIECES:], len(plain)]:
        behind = plain[start:]
        unit = plain_unit(behind) if behind else None
        if (behind and unit is None) or (unit is not None and unit.is_angle):
            continue
        try:
            value = _value(_without(behind, plain[:start].rstrip("* ")))
        except Unreadable as error:
            first = first or error
            continue
        scale = in_unit(1.0, unit, target) if unit is not None else 1.0
        echo = f"{spelled(value)} {behind.strip()}".strip()
        if unit is not None and spelled(value).count(" "):
            echo = f"({spelled(value)}) {behind.strip()}"
        return Reading(text, "read", (value * scale,), (echo,), unit is not None)
    assert first is not None  # the last start leaves no unit: the whole text is a formula, or stops
    raise first


def _without(unit: str, formula: str) -> str:
    """Return a formula without the unit that stands behind its other terms as well: ``3 V + 4i V``."""
    pattern = re.escape(unit.strip())
    return re.sub(rf"(?<=[0-9ij)])\s*{pattern}(?=\s*[-+])", "", formula) if pattern else formula


def _value(formula: str) -> complex:
    """Return the value of a formula with ``i`` or ``j``. Raises Unreadable: it is none."""
    spaced = _GLUED_E.sub(" e", _PREFIXED.sub(r"\1*", formula))
    value = complex(plain_expression(spaced, _IMAGINARY).evaluate())
    if not cmath.isfinite(value):
        raise Unreadable(f"{shorten(formula)!r} has no finite value", code="not_finite", piece=formula)
    return value
