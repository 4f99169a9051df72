"""The name that is printed on an answer page, compared with that of the paper that its code says.

Names are drawn as they were printed, and looked for where the page has its own. Only another name of the
class that is plainly there contradicts a code: what is stained, torn, written over or printed with other
fonts does not.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from coursework.errors import CourseworkError
from coursework.language.words import words
from coursework.markup.markdown import typst_string
from coursework.rendering.pdf import compile_pdf
from coursework.scanning.pictures import opencv
from coursework.sheets.answer_pages import Box
from coursework.system.extras import library

_SCALE = 5  #: pixels a mm
_REACH = 4  #: pixels by which a name may lie off its place
_MOST = 3_000  #: names of a class that are drawn
_OWN = 0.9  #: correlation from which on the owner's own name is there
_SEEN = 0.6  #: correlation from which on a name is seen
_BETTER = 0.25  #: by which another name must be seen better than the owner's
_LEANS = 0.5  #: how far, from -1 to 1, what tells two names apart must lean to the other
_NAME = """#set document(title: "-")
#set text(lang: {lang}, font: "Libertinus Serif", size: 10.5pt, number-type: "lining")
#set page(width: {width}mm, height: {height}mm, margin: 0pt)
"""
_LINE = (
    "box(width: {width}mm, height: {height}mm, align(horizon, grid(columns: (auto, 1fr), "
    "column-gutter: 0.6em, align: bottom, {label}, strong({name}))))"
)


@lru_cache(4)
def name_strips(
    names: tuple[str, ...], lang: str, width: float, height: float, folders: tuple[Path, ...] = ()
) -> Mapping[str, np.ndarray]:
    """Return the names as they are printed beside their label: ink from 0 to 1, 5 pixels a mm, by name.

    Parameters
    ----------
    width, height
        Size of the place of a name, mm.
    folders
        Folders of templates, which may bring fonts.
    """
    sheet_words = words(lang)["sheet"]
    size = {"width": f"{width:.3f}", "height": f"{height:.3f}"}
    label = typst_string(f"{sheet_words['name']}{sheet_words['colon']}")
    lines = [f"#{_LINE.format(label=label, name=typst_string(name), **size)}" for name in names]
    source = _NAME.format(lang=f'"{lang}"', **size) + "\n#pagebreak()\n".join(lines)
    pdfium: Any = library("pypdfium2", "reading scans needs", "scan")
    with pdfium.PdfDocument(compile_pdf(source, folders)) as document:
        drawn = [
            document[k].render(scale=_SCALE * 25.4 / 72, grayscale=True).to_numpy()
            for k in range(len(document))
        ]
        return {
            name: 1 - np.array(picture, np.float32).reshape(picture.shape[:2]) / 255
            for name, picture in zip(names, drawn, strict=True)
        }


def other_name(
    paper: np.ndarray, box: Box, owner: str, names: Sequence[str], lang: str, folders: Sequence[Path] = ()
) -> str:
    """Return whose name of the class is printed on a page, where it is plainly another than its owner's; else
    nothing.

    Parameters
    ----------
    paper
        The page laid flat, grey, 10 pixels a mm.
    place
        Where the name stands, mm.
    owner, names
        The student whose paper the code says, and those of the class.
    """
    others = [name for name in dict.fromkeys(names) if name and name != owner]
    if not owner or not others or len(others) > _MOST:
        return ""
    seen = _ink_about(paper, box)
    if seen is None:
        return ""
    try:
        strips = name_strips(tuple(sorted({owner, *others})), lang, box.width, box.height, tuple(folders))
    except CourseworkError:  # a name that cannot be drawn alone
        return ""
    high, wide = strips[owner].shape
    seen = seen[: high + 2 * _REACH, : wide + 2 * _REACH]
    own_share, _ = _best(seen, strips[owner])
    if own_share >= _OWN:
        return ""
    best, at, name = max((*_best(seen, strips[name]), name) for name in others)
    if best < _SEEN or best < own_share + _BETTER or _leaning(seen, strips[owner], strips[name], at) < _LEANS:
        return ""
    return name


def _ink_about(paper: np.ndarray, box: Box) -> np.ndarray | None:
    """Return the ink at the place of the name and a little around, 0 to 1; None if it exceeds the page."""
    reach, scale = _REACH / _SCALE, 10
    top, left = round((box.y - reach) * scale), round((box.x - reach) * scale)
    bottom, right = (round((v + reach) * scale) + scale for v in (box.y + box.height, box.right))
    if min(top, left) < 0 or bottom > paper.shape[0] or right > paper.shape[1]:
        return None
    cut = opencv().resize(
        paper[top:bottom, left:right].astype(np.float32),
        None,
        fx=_SCALE / scale,
        fy=_SCALE / scale,
        interpolation=opencv().INTER_AREA,
    )
    return np.clip(1 - cut / max(1.0, float(np.median(cut))), 0, 1)


def _best(seen: np.ndarray, strip: np.ndarray) -> tuple[float, tuple[int, int]]:
    """Return the greatest correlation of a strip's ink with the picture, and its place."""
    inked = np.flatnonzero(strip.max(axis=0) > 0.3)
    right = min(strip.shape[1], (inked[-1] if inked.size else 0) + 2 * _REACH)
    most = opencv().matchTemplate(
        np.ascontiguousarray(seen[:, : right + 2 * _REACH]),
        np.ascontiguousarray(strip[:, :right]),
        opencv().TM_CCOEFF_NORMED,
    )
    row, column = np.unravel_index(int(np.argmax(most)), most.shape)
    return float(most[row, column]), (int(row), int(column))


def _leaning(seen: np.ndarray, owner: np.ndarray, other: np.ndarray, at: tuple[int, int]) -> float:
    """Return a value from -1 (all the owner's) to 1 (all the other's) for the ink at which the two names
    differ."""
    row, column = at
    here = seen[row : row + owner.shape[0], column : column + owner.shape[1]]
    here = np.clip(here / max(1e-6, float(np.quantile(here, 0.995))), 0, 1)
    theirs, differences = np.clip(other - owner, 0, 1), np.clip(owner - other, 0, 1)
    sums = (float(theirs.sum()), float(differences.sum()))
    if min(sums) < 1:
        return 0.0
    return float((here * theirs).sum() / sums[0] - (here * differences).sum() / sums[1])
