"""Some sentences, which a person marks."""

from __future__ import annotations

from typing import Any

from coursework.errors import WrongValue
from coursework.kinds.open import OpenKind

_MOST_LINES = 40  #: of a page


class TextKind(OpenKind):
    name = "text"
    box = "lines"
    room = 4

    def checked_room(self, room: Any) -> Any:
        if isinstance(room, bool) or not isinstance(room, int) or not 1 <= room <= _MOST_LINES:
            raise WrongValue(f"its room is a number of lines, 1 to {_MOST_LINES}; found {room!r}")
        return room
