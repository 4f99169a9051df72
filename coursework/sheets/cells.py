"""Boxes for the components of an answer: they make the one text that a marker reads, and such a text fills
them.

A form of text has ``{}`` for each component; ``templates/parts/cells.js`` does the same with it in a page.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

from coursework.errors import NoSolution
from coursework.language.numbers import unit_text

if TYPE_CHECKING:
    from coursework.course.variant import Variant
    from coursework.kinds.kind import ComponentBox
    from coursework.model import Part

_PIECE = re.compile(r"[^\s,;|&()\[\]{}]+")


def cells_of(variant: Variant, part: Part) -> tuple[tuple[ComponentBox, ...], ...]:
    """Return the boxes for the components of a part, in groups, their units as the language prints them.

    There are none for an answer of one component, and where the course has no solution that says how many
    there are.
    """
    if not part.sort.has_cells:
        return ()
    try:
        groups = part.sort.cells(part, variant)
    except NoSolution:
        return ()
    if sum(map(len, groups)) < 2:
        return ()
    return tuple(
        tuple(
            cell._replace(unit="" if part.asks_unit else unit_text(cell.unit, variant.lang)) for cell in group
        )
        for group in groups
    )


def form_of(variant: Variant, part: Part) -> str:
    """Return the form of text of a part, with ``{}`` for each component; empty for a part without such
    boxes."""
    count = sum(map(len, cells_of(variant, part)))
    return part.sort.joined(["{}"] * count, part, variant) if count else ""


def cell_names(name: str, form: str) -> tuple[str, ...]:
    """Return the names of the boxes of the components, for the name of the box of the whole text."""
    return tuple(f"{name}-{index}" for index in range(1, form.count("{}") + 1))


def answer_in(texts: Mapping[str, Sequence[str]], name: str, form: str) -> str:
    """Return the answer that a form of a page holds: the whole text, or else that of its components.

    A whole text in the box of the first component, with nothing in the others, is taken as it stands.

    Parameters
    ----------
    texts
        Values of the fields of the page, by name; those of ticks are several.
    form
        Form of text (:func:`form_of`).
    """
    whole = ", ".join(texts.get(name, ()))
    if whole.strip() or not form:
        return whole
    cells = [" ".join(" ".join(texts.get(cell, ())).split()) for cell in cell_names(name, form)]
    if not any(cells):
        return whole
    if not any(cells[1:]) and len(_PIECE.findall(cells[0])) >= len(cells):
        return cells[0]
    pieces = form.split("{}")
    return "".join(piece for pair in zip(pieces, [*cells, ""], strict=True) for piece in pair)


def in_cells(text: str, form: str) -> tuple[str, ...]:
    """Return the components of a text that :func:`answer_in` made; none of a text that is written
    otherwise."""
    match = _pattern(form).fullmatch(text) if form else None
    return tuple(cell.strip() for cell in match.groups()) if match else ()


@lru_cache(maxsize=64)
def _pattern(form: str) -> re.Pattern[str]:
    pieces = (re.escape(piece.strip()) for piece in form.split("{}"))
    return re.compile(r"\s*" + r"\s*([^;=\[\]\n]*)\s*".join(pieces) + r"\s*")


def filled_cells(texts: Mapping[str, str], forms: Mapping[str, str]) -> dict[str, str]:
    """Return texts by box with those of components in the boxes of these.

    Parameters
    ----------
    texts
        Texts by the name of the box of the whole.
    forms
        Forms of text by the same names; of boxes without components none, or empty ones.
    """
    filled: dict[str, str] = {}
    for name, text in texts.items():
        cells = in_cells(text, forms.get(name, ""))
        filled |= dict(zip(cell_names(name, forms[name]), cells, strict=True)) if cells else {name: text}
    return filled


def is_incomplete(text: str, form: str) -> bool:
    """Return whether a text has some of its components, and not all."""
    cells = in_cells(text, form)
    return any(cells) and not all(cells)
