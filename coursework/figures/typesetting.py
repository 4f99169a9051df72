"""What needs typst: PNG, PDF, and the outlines of letters. Imported only when one of them is asked."""

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
    """Return one compiler for each thread, kept: a new one would read its fonts again."""
    if not hasattr(_own, "compiler"):
        _own.compiler = typst.Compiler(ignore_system_fonts=True)
    return _own.compiler


def _compiled(page: bytes, form: Form, inputs: dict[str, str], ppi: float | None = None) -> bytes:
    """Return a page that is one file: not the list of files that several pages of PNG or SVG are."""
    found = _compiler().compile(input=page, format=form, ppi=ppi, sys_inputs=inputs, timestamp=0)
    assert isinstance(found, bytes)
    return found


def converted(svg: str, width_mm: float, form: Form, ppi: float | None = None) -> bytes:
    """Return an SVG drawing as ``png`` or ``pdf``, with the fonts that typst brings and no other."""
    inputs = {"svg": svg, "width": str(width_mm)}
    return _compiled(_PAGE, form, inputs, ppi)


def pages(drawings: Sequence[tuple[str, float]]) -> bytes:
    """Return SVG drawings, each with its width in mm, as the pages of one PDF, each of its own size."""
    listed = json.dumps([{"svg": svg, "width": width} for svg, width in drawings])
    return _compiled(_PAGES, "pdf", {"drawings": listed})


@lru_cache(maxsize=512)
def glyph(letter: str, italic: bool) -> str:
    """Return SVG path of a letter, hundredths of an em, y up; empty for a space."""
    inputs = {"letter": letter, "style": "italic" if italic else "normal"}
    page = _compiled(_LETTER, "svg", inputs).decode()
    return " ".join(re.findall(r'<symbol[^>]*><path d="([^"]*)"', page)).strip()
