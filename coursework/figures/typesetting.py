"""Functions that need typst, imported on demand: PNG, PDF, and the outlines of letters."""

from __future__ import annotations

import json
import re
import threading
from collections.abc import Sequence
from functools import lru_cache
from typing import Literal, TypeAlias

import typst

from coursework.figures.ink import FONT

_PAGE = b"""#set page(width: auto, height: auto, margin: 0pt)
#image(bytes(sys.inputs.svg), format: "svg", width: float(sys.inputs.width) * 1mm)"""

_PAGES = b"""#set page(width: auto, height: auto, margin: 0pt)
#for drawing in json(bytes(sys.inputs.drawings)) {
  page(image(bytes(drawing.svg), format: "svg", width: drawing.width * 1mm))
}"""

# One letter at 100 pt on its baseline, so that outlines are in hundredths of an em, y up.
_LETTER = f"""#set page(width: auto, height: auto, margin: 0pt, fill: none)
#set text(font: "{FONT}", size: 100pt, top-edge: "baseline", bottom-edge: "baseline")
#text(style: sys.inputs.style, sys.inputs.letter)""".encode()

Form: TypeAlias = Literal["png", "pdf", "svg"]

_own = threading.local()


def _compiler() -> typst.Compiler:
    """Return this thread's compiler, created once since a new one reads its fonts again."""
    if not hasattr(_own, "compiler"):
        _own.compiler = typst.Compiler(ignore_system_fonts=True)
    return _own.compiler


def _compiled(page: bytes, form: Form, inputs: dict[str, str], ppi: float | None = None) -> bytes:
    """Compile a page to one file; several pages of PNG or SVG would give a list."""
    result = _compiler().compile(input=page, format=form, ppi=ppi, sys_inputs=inputs, timestamp=0)
    assert isinstance(result, bytes)
    return result


def converted(svg: str, width_mm: float, form: Form, ppi: float | None = None) -> bytes:
    """Return an SVG drawing as ``png`` or ``pdf``, with the fonts of typst alone."""
    inputs = {"svg": svg, "width": str(width_mm)}
    return _compiled(_PAGE, form, inputs, ppi)


def pages(drawings: Sequence[tuple[str, float]]) -> bytes:
    """Return one PDF of SVG drawings, each on a page of its own size; each comes with its width in mm."""
    listed = json.dumps([{"svg": svg, "width": width} for svg, width in drawings])
    return _compiled(_PAGES, "pdf", {"drawings": listed})


@lru_cache(maxsize=512)
def _letter(letter: str, italic: bool) -> str:
    inputs = {"letter": letter, "style": "italic" if italic else "normal"}
    return _compiled(_LETTER, "svg", inputs).decode()


def glyph(letter: str, italic: bool) -> str:
    """Return the SVG path of a letter, hundredths of an em, y up; empty for a space."""
    return " ".join(re.findall(r'<symbol[^>]*><path d="([^"]*)"', _letter(letter, italic))).strip()


def glyph_width(letter: str, italic: bool) -> float:
    """Return the advance width of a letter, em."""
    width = re.search(r'width="([\d.]+)pt"', _letter(letter, italic))
    return float(width[1]) / 100 if width else 0.75
