"""A handout as a Jupyter notebook.

The template is one Markdown text. A line ``<!-- cell -->`` ends a cell; a ```` ```python ```` fence is a
code cell, and ``{tags=answers}`` after ``python`` gives it tags.
"""

from __future__ import annotations

import base64
import hashlib
import json
import re
from collections.abc import Iterator, Sequence
from functools import lru_cache
from pathlib import Path

from jinja2 import Environment

from coursework.handout import Handout
from coursework.rendering import markup, views
from coursework.rendering.environment import environment, render
from coursework.rendering.formulas import number_text

CELL_END = "<!-- cell -->"
FIGURE = "figure.png"
_FIGURE_PPI = 200
_FENCE = re.compile(
    r"^```python(?:[ \t]+\{tags=([\w,-]+)\})?[ \t]*\n(.*?)^```[ \t]*$", re.DOTALL | re.MULTILINE
)


def notebook(folders: Sequence[Path], handout: Handout, *, practice: bool) -> str:
    """The notebook's JSON text, valid nbformat 4.5; the same text for the same handout."""
    import nbformat

    env = _environment(tuple(folders), handout.lang)
    text = render(env, "notebook.md.j2", views.context(handout) | {"practice": practice})
    cells = [_cell(number, *piece, handout) for number, piece in enumerate(_pieces(text))]
    book = {
        "cells": cells,
        "metadata": {
            "coursework": {
                "exercise": handout.exercise,
                "version": handout.version,
                "seed": handout.seed,
                "student": handout.student,
                "lang": handout.lang,
                "record": json.loads(json.dumps(handout.record, default=dict)),
            },
            "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
            "language_info": {"file_extension": ".py", "mimetype": "text/x-python", "name": "python"},
        },
        "nbformat": 4,
        "nbformat_minor": 5,
    }
    nbformat.validate(book)
    return json.dumps(book, ensure_ascii=False, indent=1, sort_keys=True) + "\n"


def _pieces(text: str) -> Iterator[tuple[str, tuple[str, ...], str]]:
    """Each cell as its type, its tags and its source."""
    end = 0
    for fence in _FENCE.finditer(text):
        yield from _markdown_pieces(text[end : fence.start()])
        yield "code", tuple(fence[1].split(",")) if fence[1] else (), fence[2].rstrip()
        end = fence.end()
    yield from _markdown_pieces(text[end:])


def _markdown_pieces(text: str) -> Iterator[tuple[str, tuple[str, ...], str]]:
    for piece in text.split(CELL_END):
        source = re.sub(r"\n{3,}", "\n\n", piece).strip()
        if source:
            yield "markdown", (), source


def _cell(number: int, kind: str, tags: tuple[str, ...], source: str, handout: Handout) -> dict[str, object]:
    identity = f"{handout.exercise} {handout.version} {handout.seed} {handout.student} {number} {source}"
    cell: dict[str, object] = {
        "cell_type": kind,
        "id": hashlib.sha256(identity.encode()).hexdigest()[:12],
        "metadata": {"tags": list(tags)} if tags else {},
        "source": source.splitlines(keepends=True),
    }
    if kind == "code":
        cell |= {"execution_count": None, "outputs": []}
    elif handout.figure is not None and f"attachment:{FIGURE}" in source:
        png = base64.b64encode(handout.figure.png(ppi=_FIGURE_PPI)).decode()
        cell["attachments"] = {FIGURE: {"image/png": png}}
    return cell


@lru_cache(maxsize=32)
def _environment(folders: tuple[Path, ...], lang: str) -> Environment:
    filters = {
        "markup": lambda text: markup.to_notebook_markdown(text, lang),
        "inline": lambda text: " ".join(markup.to_notebook_markdown(text, lang).split("\n")),
        "math": lambda tex: markup.to_notebook_markdown(f"${tex}$", lang),
        "number": lambda text: number_text(text, lang),
        "literal": lambda value: json.dumps(value, ensure_ascii=False),
        "code": str,
        "comment": lambda text: re.sub(r"[\r\n]+", " ", str(text)),
    }
    return environment(folders, lang, markup.notebook_text, filters)
