"""A drawing on the sheet, which a person marks."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from coursework.errors import WrongValue
from coursework.kinds.kind import Asking, Stated
from coursework.kinds.open import OpenKind
from coursework.parsing.reading import Reading

_WIDEST, _HIGHEST = 160, 240  #: mm, of what a page holds


class Drawing(OpenKind):
    """Drawn on paper, so that nothing of it comes with the other answers: it waits for a person all the
    same."""

    name = "drawing"
    box = "blank"
    field = "drawing"
    room = (120, 80)

    def read(self, answer: Any, part: Stated, asking: Asking) -> Reading:
        reading = super().read(answer, part, asking)
        return replace(reading, status="read", values=(reading.text,), read_as=(reading.text.strip(),))

    def checked_room(self, room: Any) -> Any:
        try:
            wide, high = room
            fits = 10 <= wide <= _WIDEST and 10 <= high <= _HIGHEST
        except (TypeError, ValueError):
            fits = False
        if not fits:
            raise WrongValue(
                f"its room is its width and height in mm, 10 to {_WIDEST} and 10 to {_HIGHEST}; found "
                f"{room!r}"
            )
        return (int(wide), int(high))
