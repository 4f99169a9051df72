"""Answers that are wrong as they are read and would be right in another honest way to read them: a person
looks."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from coursework.marking.answers import read
from coursework.marking.diagnosis import nearest_reading
from coursework.model import Part
from coursework.parsing.reading import Reading
from coursework.parsing.spelling import shorten, tidy
from coursework.parsing.spoken import has_sense

if TYPE_CHECKING:
    from coursework.course.variant import Variant

_DIGITS = r"[0-9]+(?:[.,][0-9]+)?"
_QUOTIENT = re.compile(rf"([+-]?\s*{_DIGITS}[^/0-9]*)/\s*([+-]?\s*{_DIGITS}\D*)")
_RAISED_DOT = re.compile(r"([+-]?\s*[0-9]+)\s*[·⋅•∙]\s*([0-9]+\D*)")
_LOST_POWER = re.compile(r"([+-]?\s*[0-9]+(?:[.,][0-9]+)?)\s*[.x*]\s*10\s*(-?[0-9]{1,2}(?![0-9]))(\D*)")
_THOUSANDS = re.compile(r"[+-]?\s*[1-9][0-9]{0,2}(?P<mark>[.,])[0-9]{3}(?![0-9.,])\D*")
_DECIMAL = re.compile(r"(?<![0-9.,])[0-9]+([.,])(?:[0-9]{1,2}|[0-9]{4,})(?![0-9.,])")
_ALIKE = 0.015  #: the share by which two numbers differ at most that are one value twice


def settled(
    variant: Variant, readings: Mapping[str, Reading], answers: Mapping[str, Any]
) -> dict[str, Reading]:
    """Return the readings, those of a doubtful answer unreadable: a quotient of two values, a power that lost
    its superscript, a sense in words against the sign, thousands by a mark that the sheet's other numbers do
    not tell."""
    parts = {p.id: p for p in variant.parts}
    return {
        i: _settled(variant, parts[i], reading, answers)
        if reading.status == "read"
        and parts[i].sort.is_number
        and not parts[i].judge
        and isinstance(answers.get(i), str)
        else reading
        for i, reading in readings.items()
    }


def _settled(variant: Variant, part: Part, reading: Reading, answers: Mapping[str, Any]) -> Reading:
    nearest, gap = nearest_reading(part, reading, variant.key, part)
    text = tidy(reading.text)
    if thousands := _THOUSANDS.fullmatch(text):
        return _with_thousands(variant, part, reading, thousands["mark"], nearest, gap, answers)
    if gap <= 1:
        return reading
    quotient = _QUOTIENT.fullmatch(text)
    reference = variant.key.reference[part.quantity]
    is_opposite = any(part.sort.distance(part, -v, reference) <= 1 for v in reading.values) and has_sense(
        text
    )
    if (
        is_opposite
        or (quotient and _are_alike(*quotient.groups()))
        or any(_is_right(variant, part, other) for other in _others(reading.text, text))
    ):
        return _unsettled(reading)
    return reading


def _with_thousands(
    variant: Variant,
    part: Part,
    reading: Reading,
    mark: str,
    index: int,
    gap: float,
    answers: Mapping[str, Any],
) -> Reading:
    """Return the reading of ``1,747`` or ``1.747``, which the decimal mark of the sheet's other numbers
    decides."""
    text = reading.text.replace(mark, "", 1)
    if part.sort.turn or (gap <= 1 and index == 0) or not _is_right(variant, part, text):
        return reading
    decimal = _decimal_mark(answers.values(), variant.lang)
    if not decimal:
        return _unsettled(reading)
    if decimal == mark:
        return replace(reading, values=reading.values[:1], read_as=reading.read_as[:1])
    return replace(read(variant, part, text), text=reading.text)


def _decimal_mark(texts: Iterable[Any], lang: str) -> str:
    """Return the decimal mark of the numbers of a sheet, in English the point where none says it; nothing
    where they differ or say nothing."""
    marks = {mark for text in texts if isinstance(text, str) for mark in _DECIMAL.findall(text)}
    if len(marks) == 1:
        return marks.pop()
    return "." if not marks and lang == "en" else ""


def _are_alike(candidate: str, other: str) -> bool:
    first, second = (float(re.search(_DIGITS, text)[0].replace(",", ".")) for text in (candidate, other))  # type: ignore[index]
    return abs(first - second) <= _ALIKE * max(first, second)


def _others(text: str, plain: str) -> Iterator[str]:
    """Yield the other readings of an ambiguous answer."""
    if quotient := _QUOTIENT.fullmatch(plain):
        yield from quotient.groups()
    if dot := _RAISED_DOT.fullmatch(text.strip()):
        yield f"{dot[1]}.{dot[2]}"
    if power := _LOST_POWER.fullmatch(plain):
        yield f"{power[1]}e{power[2]} {power[3]}"


def _is_right(variant: Variant, part: Part, text: str) -> bool:
    reading = read(variant, part, text)
    return nearest_reading(part, reading, variant.key, part)[1] <= 1


def _unsettled(reading: Reading) -> Reading:
    return Reading(reading.text, "unreadable", code="two_ways", found=shorten(reading.text))
