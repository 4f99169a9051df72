"""Names of students as they are printed: whose have letters that no font at hand draws."""

from __future__ import annotations

from collections.abc import Iterable

from coursework.errors import counted
from coursework.rendering.renderer import Renderer

_NAMED = 5  #: students whom the note names


def unprinted_names(renderer: Renderer, names: Iterable[str]) -> list[str]:
    """What is to be told of names that a PDF prints with squares; nothing where there is none."""
    lacking = {name: "".join(letters) for name in names if (letters := renderer.undrawn(name))}
    if not lacking:
        return []
    named = ", ".join(f"{name} ({letters})" for name, letters in list(lacking.items())[:_NAMED])
    more = ", …" if len(lacking) > _NAMED else ""
    return [
        f"{counted(len(lacking), 'name')} with letters that no font of the PDF draws, printed as squares: {named}{more}; "
        "put a font that has them (.ttf, .otf) into templates/fonts of the course"
    ]
