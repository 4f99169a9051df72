"""Reading of answers, shown before they count, without any check for correctness."""

from __future__ import annotations

from typing import Any, NamedTuple

from coursework.language.words import words
from coursework.marking.answers import read
from coursework.marking.feedback import say_not_read
from coursework.markup.markdown import plain_line
from coursework.model import Part
from coursework.selfstudy.attempt import read_back as readings


class ReadBack(NamedTuple):
    """Reading of a text."""

    status: str  #: ``read``, ``waits`` for a person, ``missing``, ``unreadable`` or ``wrong_unit``
    message: str  #: plain text; empty for an empty box

    @property
    def is_in_doubt(self) -> bool:
        return self.status in ("unreadable", "wrong_unit")


def read_back(variant: Any, part: Part, text: str) -> ReadBack:
    """Return the reading of an answer, or the reason for which it cannot be read. Two plausible readings are
    both returned: the choice between them depends on the reference, which is not used here."""
    reading, texts = read(variant, part, text), words(variant.lang, "site")["read_back"]
    if reading.status == "missing":
        return ReadBack("missing", "")
    if reading.status != "read":
        return ReadBack(reading.status, say_not_read(variant, part, reading).plain(variant.lang))
    if part.sort.is_open:
        return ReadBack("waits", texts["waits"])
    lines = [plain_line(line, variant.lang) for line in readings(variant, part, text)[1]]
    form = texts["two"] if len(lines) > 1 else texts["read_as"]
    return ReadBack("read", form.format(*lines))
