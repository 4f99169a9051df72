"""Cells of a notebook with the metadata of nbgrader, schema 3.

The answers cell is a solution cell; a locked grade cell stands behind it for each part. Everything that a
student should not change is locked: nbgrader writes it again before it marks.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from coursework.language.words import words
from coursework.rendering.views import points_text
from coursework.sheets.sheet import Handout, Question

SCHEMA = 3
OURS = "coursework-"  #: prefix of all our grade identifiers
Cell = dict[str, Any]


def grade_id(exercise: str, key: str) -> str:
    """Return nbgrader's name of the cell that holds the points of a part.

    ``key`` is the name of the answer in the notebook; the part's own name may give away the question.
    """
    return f"{OURS}{_plain(exercise)}-{_plain(key)}"


def answers_id(exercise: str) -> str:
    """Return nbgrader's name of the answers cell of an exercise."""
    return f"{OURS}answers-{_plain(exercise)}"


def _plain(name: str) -> str:
    return re.sub(r"[^A-Za-z0-9_]", lambda match: f"-{ord(match[0]):x}-", name)


def metadata(name: str, *, solution: bool = False, points: float | None = None) -> dict[str, Any]:
    """Return the metadata of a cell: a solution, a grade cell if ``points`` are given, else a locked text."""
    graded = points is not None
    fields = {"schema_version": SCHEMA, "grade_id": name, "grade": graded, "solution": solution}
    return {**fields, "locked": not solution, "task": False, **({"points": points} if graded else {})}


def for_nbgrader(book: Mapping[str, Any], handouts: Sequence[Handout], *, personal: bool) -> dict[str, Any]:
    """Return a notebook of these handouts with the metadata that nbgrader needs.

    The texts of ``personal`` notebooks are not locked: nbgrader would overwrite them with the texts of the
    one notebook of the class.
    """
    waiting = list(handouts)
    cells = []
    for index, cell in enumerate(map(_with_pictures, book["cells"])):
        if "answers" in cell["metadata"].get("tags", ()):
            handout = waiting.pop(0)
            prefix = f"{len(handouts) - len(waiting)}." if len(handouts) > 1 else ""
            cells.append(_marked(cell, metadata(answers_id(handout.exercise), solution=True)))
            cells += _grade_cells(handout, prefix)
        elif personal or not "".join(cell["source"]).strip():
            cells.append(cell)
        else:
            cells.append(_marked(cell, metadata(f"{OURS}text-{index + 1}")))
    return {**book, "cells": cells}


def _with_pictures(cell: Cell) -> Cell:
    """Return a cell with its pictures inside its text.

    nbgrader drops attachments, and writes no feedback if one is missing.
    """
    source = "".join(cell["source"])
    for name, kinds in cell.get("attachments", {}).items():
        for kind, data in kinds.items():
            source = source.replace(f"(attachment:{name})", f"(data:{kind};base64,{data})")
    fields = {key: value for key, value in cell.items() if key != "attachments"}
    return {**fields, "source": source.splitlines(keepends=True)}


def _marked(cell: Cell, nbgrader_metadata: Mapping[str, Any]) -> Cell:
    return {**cell, "metadata": {**cell["metadata"], "nbgrader": dict(nbgrader_metadata)}}


def _grade_cells(handout: Handout, prefix: str) -> Iterator[Cell]:
    for question in handout.questions:
        name = grade_id(handout.exercise, question.key or question.id)
        yield {
            "cell_type": "code",
            "execution_count": None,
            "id": hashlib.sha256(name.encode()).hexdigest()[:12],
            "metadata": {"nbgrader": metadata(name, points=float(question.points))},
            "outputs": [],
            "source": [f"# {_grade_line(question, prefix, handout.lang)}"],
        }


def _grade_line(question: Question, prefix: str, lang: str) -> str:
    """Return the comment line of a grade cell: the question's number and its points."""
    template = str(words(lang)["nbgrader"]["grade"])
    key, points = question.key or question.id, points_text(question.points, lang)
    return template.format(number=f"{prefix}{question.number}", key=key, points=points)


def without_variants(book: Mapping[str, Any], handouts: Sequence[Handout], title: str) -> dict[str, Any]:
    """Return the notebook of the class, made from one student's notebook.

    It has the answers cells and grade cells, under a text that tells students to open their personal
    notebook.
    """
    lang = handouts[0].lang
    texts = words(lang)["nbgrader"]
    text = f"# {title}\n\n**{texts['title']}.** {texts['own']}"
    head = {"cell_type": "markdown", "id": f"{OURS}own", "source": text.splitlines(keepends=True)}
    seeds = {f"# {h.exercise} {h.seed}": f"# {h.exercise}" for h in handouts}
    cells = [head | {"metadata": {"nbgrader": metadata(f"{OURS}text-1")}}]
    for cell in book["cells"]:
        if "nbgrader" in cell["metadata"]:
            source = "".join(cell["source"])
            for with_seed, without in seeds.items():
                source = source.replace(with_seed, without)
            more = {k: v for k, v in cell["metadata"].items() if k != "coursework"}
            if "coursework" in cell["metadata"]:
                more["coursework"] = {"exercise": cell["metadata"]["coursework"]["exercise"]}
            cells.append({**cell, "metadata": more, "source": source.splitlines(keepends=True)})
    about = book["metadata"]["coursework"]
    if "sheets" in about:
        about = {"sheets": [{"exercise": h.exercise} for h in handouts], "student": "", "lang": lang}
    else:
        about = {"exercise": about["exercise"], "version": about["version"], "student": "", "lang": lang}
    return {**book, "cells": cells, "metadata": {**book["metadata"], "coursework": about}}
