"""Handouts and lessons as Jupyter notebooks.

A notebook is one Markdown text. A line ``<!-- cell -->`` ends a cell; a ```` ```python ```` fence is a
code cell, and ``{tags=answers}`` after ``python`` gives it tags.
"""

from __future__ import annotations

import base64
import hashlib
import json
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import lru_cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jinja2 import Environment

from coursework.language.words import words
from coursework.markup import markdown as markup
from coursework.markup.formulas import number_text
from coursework.rendering import feedback as own
from coursework.rendering import papers, views
from coursework.rendering.environment import environment, render
from coursework.sheets.paper import FeedbackPaper, Paper
from coursework.sheets.sheet import AnswerSheet, FeedbackSheet, Handout
from coursework.system.distribution import DISTRIBUTION

if TYPE_CHECKING:
    from coursework.sheets.sheet import StudySheet

CELL_END = "<!-- cell -->"
FIGURE = "figure.png"
MORE = "figure-{}.png"  #: the second figure is figure-2.png
_FIGURE_PPI = 200
_FENCE = re.compile(
    r"^```python(?:[ \t]+\{tags=([\w,-]+)\})?[ \t]*\n(.*?)^```[ \t]*$", re.DOTALL | re.MULTILINE
)


def notebook(folders: Sequence[Path], handout: Handout, *, collected: bool = False) -> str:
    """Return the notebook to hand in, as JSON text, valid nbformat 4.5; the same text for the same handout.

    It holds the statement, the data and a cell for the answers: nothing in it checks them. One that a
    platform has ``collected`` asks for no name and is not sent back.
    """
    return _of_handout(folders, handout, "notebook/notebook.md.j2", {"collected": True} if collected else {})


def study(folders: Sequence[Path], sheet: StudySheet) -> str:
    """Return the self-study notebook, as JSON text, valid nbformat 4.5; the same text for the same sheet."""
    return _of_handout(folders, sheet.handout, "notebook/study.md.j2", {"study": sheet})


def _of_handout(folders: Sequence[Path], handout: Handout, template: str, more: Mapping[str, object]) -> str:
    env = _environment(tuple(folders), handout.lang)
    text = render(env, template, {**views.context(handout), **more})
    identity = f"{handout.exercise} {handout.version} {handout.seed} {handout.student}"
    cells = list(_cells(text, identity))
    for cell in cells:
        _attach_figure(cell, handout)
    return _json(
        cells,
        {
            "exercise": handout.exercise,
            "version": handout.version,
            "seed": handout.seed,
            "student": handout.student,
            "lang": handout.lang,
            "record": json.loads(json.dumps(handout.record, default=dict)),
        },
    )


def paper(folders: Sequence[Path], handed: Paper, *, collected: bool = False) -> str:
    """Return the notebook of a paper, as JSON text, valid nbformat 4.5: an answers cell an exercise, which
    says whose it is. ``collected`` is as for :func:`notebook`."""
    env = _environment(tuple(folders), handed.heading.lang)
    more = ({"collected": True},) * len(handed.handouts) if collected else ()
    names = papers.context(handed, "md.j2", partial(render, env), more)
    names |= {"collected": True} if collected else {}
    cells = list(_cells(render(env, "paper/paper.md.j2", names), f"{names['variants']} head"))
    for sheet, exercise in zip(handed.handouts, names["exercises"], strict=True):
        cells += _exercise(sheet, exercise["body"], exercise["place"])
    cells += _cells(render(env, "notebook/_hand_in.md.j2", names), "hand in")
    about = [{"exercise": sheet.exercise, "seed": sheet.seed} for sheet in handed.handouts]
    return _json(cells, {"student": handed.heading.student, "sheets": about, "lang": handed.heading.lang})


def feedback(folders: Sequence[Path], feedback_sheet: FeedbackSheet | FeedbackPaper) -> str:
    """Feedback as a notebook to read, as JSON text, valid nbformat 4.5; where another variant is offered,
    cells that open and check it."""
    if isinstance(feedback_sheet, FeedbackPaper):
        env = _environment(tuple(folders), feedback_sheet.heading.lang)
        names = papers.context(feedback_sheet, "md.j2", partial(render, env))
        figure_names = [f"{place}-" for place in papers.places_of(feedback_sheet)]
        sheets, template, student = (
            feedback_sheet.sheets,
            "paper/feedback.md.j2",
            feedback_sheet.heading.student,
        )
    else:
        env = _environment(tuple(folders), feedback_sheet.handout.lang)
        names, figure_names = own.context(feedback_sheet, "md.j2", partial(render, env)), [""]
        sheets, template, student = (
            (feedback_sheet,),
            "feedback/feedback.md.j2",
            feedback_sheet.handout.student,
        )
    seeds = " ".join(f"{sheet.handout.exercise} {sheet.handout.seed}" for sheet in sheets)
    cells = list(_cells(render(env, template, names), f"feedback {student} {seeds}"))
    for cell in cells:
        for figures, sheet in zip(figure_names, sheets, strict=True):
            if sheet.solution is not None:
                _attach_figure(cell, sheet.solution, figures)
    return _json(cells, {"feedback": seeds, "student": student, "lang": names["lang"]})


def _exercise(sheet: Handout, body: str, number: int) -> list[dict[str, Any]]:
    """Return the cells of an exercise of a paper."""
    cells = list(_cells(body, f"{number} {sheet.exercise} {sheet.version} {sheet.seed} {sheet.student}"))
    for cell in cells:
        _attach_figure(cell, sheet)
        if "answers" in cell["metadata"].get("tags", ()):
            cell["metadata"]["coursework"] = {"exercise": sheet.exercise, "seed": sheet.seed}
    return cells


def _cells(text: str, identity: str) -> Iterator[dict[str, Any]]:
    for number, piece in enumerate(_pieces(text)):
        yield _cell(f"{identity} {number}", *piece)


def lesson(
    folders: Sequence[Path],
    name: str,
    text: str,
    lang: str,
    install: str,
    pictures: Mapping[str, Mapping[str, str]],
) -> str:
    """Return the notebook of a lesson: its Markdown as it is, its fences as code cells; before the first that
    imports the package, one that says how to install it where it is missing. ``pictures``, by name and type
    in base64, are attached to the cells that show them."""
    env = _environment(tuple(folders), lang)
    names = {"words": words(lang), "package": DISTRIBUTION, "install": install}
    guard = f"```python\n{render(env, 'notebook/_import.md.j2', names)}\n```\n"
    first = next((f.start() for f in _FENCE.finditer(text) if "import coursework" in f[2]), None)
    content = text if first is None else f"{text[:first]}{guard}\n{text[first:]}"
    cells = list(_cells(content, f"{name} {lang}"))
    for cell in cells:
        attachments = {
            n: dict(p) for n, p in pictures.items() if f"(attachment:{n})" in "".join(cell["source"])
        }
        if attachments:
            cell["attachments"] = attachments
    return _json(cells, {"lesson": name, "lang": lang})


def _json(cells: list[dict[str, object]], about: dict[str, object]) -> str:
    import nbformat

    book = {
        "cells": cells,
        "metadata": {
            "coursework": about,
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


def _cell(identity: str, kind: str, tags: tuple[str, ...], source: str) -> dict[str, Any]:
    cell: dict[str, Any] = {
        "cell_type": kind,
        "id": hashlib.sha256(f"{identity} {source}".encode()).hexdigest()[:12],
        "metadata": {"tags": list(tags)} if tags else {},
        "source": source.splitlines(keepends=True),
    }
    if kind == "code":
        cell |= {"execution_count": None, "outputs": []}
    return cell


def _attach_figure(cell: dict[str, Any], sheet: Handout | AnswerSheet, before: str = "") -> None:
    """Attach the figures that a cell shows, by name; ``before`` tells those of several exercises apart."""
    figures = {f"{before}{FIGURE}": views.figure_of(sheet)}
    figures |= {
        f"{before}{MORE.format(k)}": drawing
        for k, (drawing, _) in enumerate(views.more_figures(sheet), start=2)
    }
    for name, figure in figures.items():
        is_referenced = any(f"attachment:{name}" in line for line in cell["source"])
        if cell["cell_type"] == "markdown" and figure is not None and is_referenced:
            png = base64.b64encode(figure.png(ppi=_FIGURE_PPI)).decode()
            cell["attachments"] = {**cell.get("attachments", {}), name: {"image/png": png}}


@lru_cache(maxsize=32)
def _environment(folders: tuple[Path, ...], lang: str) -> Environment:
    filters: dict[str, Callable[..., str]] = {
        "markup": lambda text: markup.to_notebook_markdown(text, lang),
        "inline": lambda text: " ".join(markup.to_notebook_markdown(text, lang).split("\n")),
        "math": lambda tex: markup.to_notebook_markdown(f"${tex}$", lang),
        "number": lambda text: number_text(text, lang),
        "literal": lambda value: json.dumps(value, ensure_ascii=False),
        "code": str,
        "typed": _typed,
        "display": lambda tex: markup.to_notebook_markdown(f"$${tex}$$", lang),
        "comment": lambda text: re.sub(r"[\r\n]+", " ", str(text)),
    }
    return environment(folders, lang, markup.notebook_text, filters)


def _typed(text: str) -> str:
    """Return a typed text as inline code, which shows its characters literally and copies as they are."""
    one_line = " ".join(text.split("\n"))
    runs = re.findall("`+", one_line)
    fence = "`" * (1 + max(map(len, runs), default=0))
    pad = " " if one_line[:1] in "` " or one_line[-1:] in "` " else ""
    return f"{fence}{pad}{one_line}{pad}{fence}"
