"""Letters in students' names that no font of the PDF has."""

from __future__ import annotations

from collections.abc import Iterable

from coursework.errors import counted, first_few
from coursework.messages import Message
from coursework.rendering.renderer import Renderer

_NAMED = 5  #: names in the note


def unprinted_names(renderer: Renderer, names: Iterable[str]) -> list[str]:
    """Return notes on names that a PDF prints with squares; empty if there is none."""
    lacking = {name: "".join(letters) for name in names if (letters := renderer.undrawn(name))}
    if not lacking:
        return []
    named = first_few([f"{name} ({letters})" for name, letters in lacking.items()], _NAMED)
    note = Message(
        (
            "{names} with letters that no font of the PDF has, printed as squares: {named}; put a font "
            "with these"
            " letters (.ttf, .otf) into templates/fonts of the course"
        ),
        names=counted(len(lacking), "name"),
        named=named,
    )
    return [note]
