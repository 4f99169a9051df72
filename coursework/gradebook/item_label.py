"""Label printed in the text of an exported question, by which a platform's report identifies the variant."""

from __future__ import annotations

import re
from typing import NamedTuple

from coursework.messages import Message

_LABEL = re.compile(
    r"\[\s*(?P<exercise>\w+)\s*·\s*(?P<seed>[0-9]{1,30})\s*·\s*v(?P<version>\w+)"
    r"(?:\s*·\s*(?P<lang>[a-z]{2,3}))?(?:\s*·\s*(?P<part>\w+))?(?:\s*·\s*(?P<unit>[^\[\]]{1,40}?))?\s*\]"
)


_BARE = re.compile(r"\s*[-+−–]?[0-9][0-9.,\s]*")


class ItemLabel(NamedTuple):
    """Label ``[slotted_mechanism · 4 · v1 · fr · rA]``; language and part are optional."""

    exercise: str
    seed: str
    version: str
    lang: str = ""
    part: str = ""  #: of a question that asks one part alone
    unit: str = ""  #: in which numbers are asked, where it is not the sheet's: ``µrad``, ``10⁻³ °``

    def answer(self, text: str) -> str:
        """Return the answer; a bare number gets the unit printed beside its box."""
        if not (self.unit and _BARE.fullmatch(text)):
            return text
        return f"{text}{'·' if self.unit.startswith('10') else ' '}{self.unit}"


NO_LABEL = Message(
    "the text of the question has no label such as [slotted_mechanism · 4 · v1 · en], which identifies "
    "the variant"
)


def languages_in(text: str) -> tuple[str, ...]:
    """Return the languages of the labels in a question's text: several where a platform shows all languages
    of a question at once."""
    return tuple(dict.fromkeys(match["lang"] for match in _LABEL.finditer(text) if match["lang"]))


def label_in(text: str) -> ItemLabel | None:
    """Return the last label in a question's text, since figures or data may look alike; None if there is
    none."""
    matches = [*_LABEL.finditer(text)]
    return ItemLabel(*(group or "" for group in matches[-1].groups())) if matches else None
