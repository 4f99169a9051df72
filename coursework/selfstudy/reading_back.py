"""Readings of an answer, shown before it counts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from coursework.language.numbers import unit_text
from coursework.marking.answers import read
from coursework.marking.error_messages import shown_as
from coursework.marking.feedback import say_not_read
from coursework.marking.mark import made_mark
from coursework.selfstudy.answers import sentence_of

if TYPE_CHECKING:
    from coursework.course.variant import Variant
    from coursework.model import Part


def read_back(variant: Variant, part: Part, text: str) -> tuple[bool, tuple[str, ...]]:
    """Return whether an answer can be read, and its readings as Markdown, or else the reason.

    A blank answer, or one that a person marks, has no readings. Nothing of the variant is computed.
    """
    reading = read(variant, part, text)
    if reading.status == "missing" or part.sort.is_open:
        return True, ()
    if reading.status == "read":
        displayed = (shown_as(variant, part, reading, k)[1] for k in range(len(reading.values)))
        bare = part.sort.is_scalar and part.unit != "1" and not (reading.unit_given or part.asks_unit)
        unit = unit_text(part.unit, variant.lang) if bare else ""
        return True, tuple(dict.fromkeys(_with(unit, item) for item in displayed))
    mark = made_mark(variant, part, reading, reading.status, 0.0, "", say_not_read(variant, part, reading))
    return False, (sentence_of(variant, mark, ""),)


def _with(unit: str, text: str) -> str:
    return f"{text}{'' if unit == '°' or not unit else chr(0xA0)}{unit}"
