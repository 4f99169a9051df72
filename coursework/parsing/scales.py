"""A scale as drawings state it, ``1 cm = 100 mm``, ``1 mm for 20 mm/s``, ``1:2``: what a millimetre of paper
stands for."""

from __future__ import annotations

import re

_NUMBER = r"[0-9]+(?:[.,][0-9]+)?"
_PAPER = rf"(?P<paper>{_NUMBER})\s*(?P<length>mm|cm|dm|m)(?:\s+(?:de|of|sur le|on)\s+(?:papier|paper))?"
_MEANT = rf"(?P<meant>{_NUMBER}(?:\s*[*]?\s*10\^\(?[0-9]\)?|[eE][0-9])?)\s*(?P<unit>[^\W\d_].*)"
_FOR = r"(?:pour|for|représentent|représente|represents?|stands? for|vaut|équivaut à|correspond à|->|→|↔|≙)"
_NAME = r"(?:(?:[^\W\d_]\w*\s*[=:]|[ée]chelle|scale|k\w{0,2}(?=\s))\s*[=:]?\s*)?"
_STATED = re.compile(rf"{_NAME}(?:{_PAPER}\s*(?:=|:|{_FOR})\s*{_MEANT})", re.I)
_TURNED = re.compile(rf"{_NAME}(?:{_MEANT}?)\s*{_FOR}\s*{_PAPER}", re.I)
_RATIO = re.compile(rf"{_NAME}({_NUMBER})(?:\s*:\s*|/)({_NUMBER})", re.I)


def is_of_paper(unit: str) -> bool:
    """Return whether a unit belongs to a scale of paper, so much for a millimetre: ``mm/mm``, ``mm/s/mm``."""
    return unit.endswith("/mm")


def restated(text: str, unit: str) -> tuple[str, ...]:
    """Return the texts to be read in place of a scale: ``100 mm/cm`` for ``1 cm = 100 mm``, or the text as it
    is.

    A ratio of lengths has two honest readings, ``1:2`` or ``1/2`` is 2 mm for one of paper, or half of one.
    """
    if unit == "mm/mm" and (ratio := _RATIO.fullmatch(text)):
        numbers, other = ratio.groups()
        return f"{other}:{numbers}", f"{numbers}:{other}"
    stated = _STATED.fullmatch(text) or _TURNED.fullmatch(text)
    if stated is None:
        return (text,)
    meant, paper = stated["meant"], stated["paper"].replace(",", ".")
    number = meant if float(paper) == 1 else f"({meant.replace(',', '.')})/({paper})"
    return (f"{number} {stated['unit'].strip()}/{stated['length']}",)
