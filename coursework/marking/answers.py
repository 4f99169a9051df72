"""An answer read as its part's kind asks."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from coursework.model import Part
from coursework.parsing.plain_values import plain_answer
from coursework.parsing.reading import Reading
from coursework.parsing.scanned import names_pictures
from coursework.parsing.spoken import bare, refers_elsewhere, says_nothing

if TYPE_CHECKING:
    from coursework.course.variant import Variant


def read(variant: Variant, part: Part, answer: Any) -> Reading:
    """Read an answer as the part's kind asks; a vector has as many coordinates as its reference. Whatever
    it is, it is read, unreadable or missing: words that say that there is no answer are none, and those that
    lead to one are left out. The pictures of an answer on a scanned page wait for a person."""
    if isinstance(answer, str) and names_pictures(answer):
        return Reading(answer, "to_mark")
    reading = part.sort.read(plain_answer(answer), part, variant)
    if reading.status != "unreadable":
        return reading
    if says_nothing(reading.text):
        return replace(reading, status="missing", code="", found="")
    if refers_elsewhere(reading.text):
        return replace(reading, code="elsewhere", found="")
    if (text := bare(reading.text)) not in (reading.text, ""):
        again = part.sort.read(text, part, variant)
        return replace(again, text=reading.text) if again.status == "read" else reading
    return reading
