"""The cells of a notebook as nbgrader knows them, by metadata of its schema 3.

The answers cell is a solution cell; a locked grade cell stands behind it for each part. Everything that a student should
not change is locked: nbgrader writes it anew before it marks.
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
OURS = "coursework-"  #: every grade_id of ours begins so
Cell = dict[str, Any]


def grade_id(exercise: str, key: str) -> str:
    """What nbgrader calls the cell that holds the points of a part, by what the notebook calls its answer: a part's own name
    may tell what is asked."""
    return f"{OURS}{_plain(exercise)}-{_plain(key)}"


def answers_id(exercise: str) -> str:
    """What nbgrader calls the answers cell of an exercise."""
    return f"{OURS}answers-{_plain(exercise)}"


def _plain(name: str) -> str:
    return re.sub(r"[^A-Za-z0-9_]", lambda found: f"-{ord(found[0]):x}-", name)


def metadata(name: str, *, solution: bool = False, points: float | None = None) -> dict[str, Any]:
    """A cell's metadata: of a solution, of a grade where it has points, else of a text that is locked."""
    graded = points is not None
    said = {"schema_version": SCHEMA, "grade_id": name, "grade": graded, "solution": solution}
    return {**said, "locked": not solution, "task": False, **({"points": points} if graded else {})}


def for_nbgrader(book: Mapping[str, Any], handouts: Sequence[Handout], *, own: bool) -> dict[str, Any]:
    """A notebook of these handouts with what nbgrader needs; of students' ``own`` notebooks the texts are not locked, since
    nbgrader would write those of one notebook for all into them."""
    waiting = list(handouts)
    cells = []
    for place, cell in enumerate(map(_with_pictures, book["cells"])):
        if "answers" in cell["metadata"].get("tags", ()):
            handout = waiting.pop(0)
            prefix = f"{len(handouts) - len(waiting)}." if len(handouts) > 1 else ""
            cells.append(_marked(cell, metadata(answers_id(handout.exercise), solution=True)))
            cells += _grade_cells(handout, prefix)
        elif own or not "".join(cell["source"]).strip():
            cells.append(cell)
        else:
            cells.append(_marked(cell, metadata(f"{OURS}text-{place + 1}")))
    return {**book, "cells": cells}


def _with_pictures(cell: Cell) -> Cell:
    """A cell whose pictures stand in its text: nbgrader keeps no attachments, and writes no feedback where one is missing."""
    source = "".join(cell["source"])
    for name, kinds in cell.get("attachments", {}).items():
        for kind, data in kinds.items():
            source = source.replace(f"(attachment:{name})", f"(data:{kind};base64,{data})")
    kept = {key: value for key, value in cell.items() if key != "attachments"}
    return {**kept, "source": source.splitlines(keepends=True)}


def _marked(cell: Cell, said: Mapping[str, Any]) -> Cell:
    return {**cell, "metadata": {**cell["metadata"], "nbgrader": dict(said)}}


def _grade_cells(handout: Handout, prefix: str) -> Iterator[Cell]:
    for question in handout.questions:
        name = grade_id(handout.exercise, question.key or question.id)
        yield {
            "cell_type": "code",
            "execution_count": None,
            "id": hashlib.sha256(name.encode()).hexdigest()[:12],
            "metadata": {"nbgrader": metadata(name, points=float(question.points))},
            "outputs": [],
            "source": [f"# {_called(question, prefix, handout.lang)}"],
        }


def _called(question: Question, prefix: str, lang: str) -> str:
    """The line of a grade cell: which question it is, and its points."""
    said = str(words(lang)["nbgrader"]["grade"])
    key, points = question.key or question.id, points_text(question.points, lang)
    return said.format(number=f"{prefix}{question.number}", key=key, points=points)


def without_variants(book: Mapping[str, Any], handouts: Sequence[Handout], title: str) -> dict[str, Any]:
    """Of somebody's own notebook what is everybody's: the answers and grade cells under a text that says to take one's own."""
    lang = handouts[0].lang
    said = words(lang)["nbgrader"]
    text = f"# {title}\n\n**{said['title']}.** {said['own']}"
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
