"""The label that an exported question prints in its text, by which a platform's report tells the variant."""

from __future__ import annotations

import re
from typing import NamedTuple

_LABEL = re.compile(
    r"\[\s*(?P<exercise>\w+)\s*·\s*(?P<seed>[0-9]{1,30})\s*·\s*v(?P<version>\w+)"
    r"(?:\s*·\s*(?P<lang>[a-z]{2,3}))?(?:\s*·\s*(?P<part>\w+))?(?:\s*·\s*(?P<unit>[^\[\]]{1,40}?))?\s*\]"
)


_BARE = re.compile(r"\s*[-+−–]?[0-9][0-9.,\s]*")


class ItemLabel(NamedTuple):
    """``[slotted_mechanism · 4 · v1 · fr · rA]``: language and part where the question prints them."""

    exercise: str
    seed: str
    version: str
    lang: str = ""
    part: str = ""  #: of a question that asks one part alone
    unit: str = ""  #: in which numbers are asked, where it is not the sheet's: ``µrad``, ``10⁻³ °``

    def answer(self, text: str) -> str:
        """What was answered, a bare number with the unit that the question printed beside its box."""
        if not (self.unit and _BARE.fullmatch(text)):
            return text
        return f"{text}{'·' if self.unit.startswith('10') else ' '}{self.unit}"


NO_LABEL = "the question's text has no label as [slotted_mechanism · 4 · v1 · en], which says whose answers these are"


def label_in(text: str) -> ItemLabel | None:
    """The label of a question's text, the last where figures or data look alike; None where it has none."""
    matches = [*_LABEL.finditer(text)]
    return ItemLabel(*(group or "" for group in matches[-1].groups())) if matches else None
