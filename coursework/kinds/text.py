"""Some sentences, which a person marks."""

from __future__ import annotations

from coursework.kinds.open import OpenKind


class TextKind(OpenKind):
    name = "text"
    box = "lines"
    room, most_lines = 4, 40  # of a page
