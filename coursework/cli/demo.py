"""The whole job on a bundled class of twelve: sheets, answers as people write them, marks.

The class answers by habit: one writes decimal commas, one metres for millimetres, one leaves blanks,
one writes nonsense, one makes the course's known mistakes. The answers are written as files of every
accepted kind, a damaged one among them, and marked like any others.
"""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from coursework.api import Variant, open_course
from coursework.course.answer_key import Key
from coursework.course.answer_keys import answer_keys
from coursework.errors import counted
from coursework.issuing.issued import COLUMNS, Issued
from coursework.issuing.issuing import issue
from coursework.issuing.roster import read_roster
from coursework.issuing.variant_assignment import AssignedVariants
from coursework.language.numbers import significant
from coursework.language.words import languages
from coursework.markup.markdown import to_text
from coursework.messages import Message, localised
from coursework.model import Part
from coursework.rendering.renderer import renderer_of
from coursework.system.writing import File, write_tree

CLASS = Path(__file__).parent / "class_of_twelve"
ROSTER = CLASS / "roster.csv"
FIRST_SEED = 2024

Habit = Callable[[Variant, Key, Part, int], Any]  #: variant, key, part, its place -> what the student writes


def _right(variant: Variant, key: Key, part: Part, digits: int = 5) -> str:
    """Return the right answer as a careful student writes it, without unit."""

    def label(case: str) -> str:
        return " ".join(to_text(variant.label(part.id, case), variant.lang).split())

    if part.sort.is_open:
        return f"{variant.exercise.name}, {part.id}"
    return part.sort.written(key.reference[part.quantity], digits, label)


def careful(variant: Variant, key: Key, part: Part, index: int) -> Any:
    return _right(variant, key, part)


def decimal_commas(variant: Variant, key: Key, part: Part, index: int) -> Any:
    text = _right(variant, key, part)
    return text if part.sort.is_text else text.replace(".", ",").replace("-", "−")


def with_units(variant: Variant, key: Key, part: Part, index: int) -> Any:
    written = {
        "deg": "°",
        "mm/s^2": " mm.s⁻²",
        "rad/s": " rad.s-1",
        "rad/s^2": " rad/s²",
        "mm^2": " mm²",
        "1": "",
    }
    if not part.sort.is_number:
        return careful(variant, key, part, index)
    return _right(variant, key, part) + written.get(part.unit, f" {part.unit}")


def in_metres(variant: Variant, key: Key, part: Part, index: int) -> Any:
    if not part.sort.is_number or not part.unit.startswith("mm") or part.unit.startswith("mm^2"):
        return careful(variant, key, part, index)
    return f"{key.reference[part.quantity] / 1000:.6f} {part.unit.replace('mm', 'm', 1)}".replace(".", ",", 1)


def in_radians(variant: Variant, key: Key, part: Part, index: int) -> Any:
    if part.unit != "deg":
        return careful(variant, key, part, index)
    return f"{np.radians(key.reference[part.quantity]):.5f} rad"


def with_blanks(variant: Variant, key: Key, part: Part, index: int) -> Any:
    return "" if index % 3 == 2 else careful(variant, key, part, index)


def with_nonsense(variant: Variant, key: Key, part: Part, index: int) -> Any:
    nonsense = ("12,,5", "je sais pas", "trop long", "see notebook", "9**9**9")
    return nonsense[index % len(nonsense)] if index % 4 == 1 else careful(variant, key, part, index)


def known_mistakes(variant: Variant, key: Key, part: Part, index: int) -> Any:
    for values in key.wrong.values():
        wrong = values.get(part.quantity)
        if wrong is not None and index % 2 == 0:
            if isinstance(wrong, np.ndarray):
                return str(wrong.tolist()) if wrong.ndim > 1 else "; ".join(map(repr, wrong.tolist()))
            return str(wrong).strip("()") if isinstance(wrong, complex) else wrong
    return careful(variant, key, part, index)


def wrong_units(variant: Variant, key: Key, part: Part, index: int) -> Any:
    if not part.sort.is_number or index % 3:
        return careful(variant, key, part, index)
    return _right(variant, key, part) + " kg"


def just_off(variant: Variant, key: Key, part: Part, index: int) -> Any:
    if not part.sort.is_number or index % 2:
        return careful(variant, key, part, index)
    value = key.reference[part.quantity]
    return significant(value + 3 * part.half_width(value), 6)


def three_digits(variant: Variant, key: Key, part: Part, index: int) -> Any:
    return _right(variant, key, part, digits=3)


def as_a_formula(variant: Variant, key: Key, part: Part, index: int) -> Any:
    if part.sort.prediction != "size":
        return careful(variant, key, part, index)
    return f"{significant(key.reference[part.quantity] * 2, 6)}/2"


HABITS: tuple[Habit, ...] = (
    careful,
    decimal_commas,
    with_units,
    in_metres,
    in_radians,
    with_blanks,
    with_nonsense,
    known_mistakes,
    wrong_units,
    just_off,
    three_digits,
    as_a_formula,
)


SHOWN_VERDICTS = (
    "correct",
    "follow_through",
    "mistake",
    "slip",
    "partial",
    "wrong",
    "wrong_unit",
    "unreadable",
    "to_mark",
    "missing",
)


def class_of_twelve(
    out: Path, build: Callable[..., tuple[int, bool]], grade: Callable[..., Any]
) -> tuple[list[Mapping[str, Any]], list[str]]:
    """Build, answer and mark; gives a table, a line an exercise, and where the files are.

    ``build`` and ``grade`` write the files: the command line's own.
    """
    course = open_course()
    names = (CLASS / "exercises.txt").read_text("utf-8").split()
    formats = ("pdf", "ipynb", "html")
    langs, roster = languages()[:1], read_roster(ROSTER)
    issues = issue(course, names, first_seed=FIRST_SEED, count=1, langs=langs, roster=roster)
    written, _ = build(course, AssignedVariants(issues), formats, out, overwrite=True)
    issued = Issued.read(out / "issued.json")
    notes = _hand_in(course, issued, out / "submissions")
    book = grade(course, [out / "submissions"], out / "issued.json", out / "marks", feedback=True)
    rows: list[Mapping[str, Any]] = []
    for name in names:
        total = book.exercises[name]
        rows.append(
            {
                "exercise": name,
                "answers": total.answers,
                **{v: total.verdicts[v] for v in SHOWN_VERDICTS},
                "mean": f"{100 * total.points / total.out_of:.0f} %" if total.out_of else "",
            }
        )
    marked = sum(r["answers"] for r in rows)
    folders = {
        Message("sheets and notebooks to give away"): "handouts",
        Message("worked solutions and key"): "instructor",
        Message("answers as they came"): "submissions",
        Message("marks, summary, rejected, feedback"): "marks",
    }
    width = max(len(localised(words)) for words in folders)
    report = [
        *(Message("note: {note}", note=note) for note in notes),
        Message(
            "{files} built, {rows} handed in: {marked} marked, {rejected} rejected.",
            files=counted(written, "file"),
            rows=counted(book.rows_in, "row"),
            marked=marked,
            rejected=len(book.rejected),
        ),
        *(Message("  rejected: {source}: {reason}", source=r.place, reason=r.reason) for r in book.rejected),
        Message("  The answers contain a second answer, a stranger and a damaged notebook on purpose."),
        *(f"{localised(words):{width}}  {out / folder}" for words, folder in folders.items()),
    ]
    return rows, [localised(line) for line in report]


def _hand_in(course: Any, issued: Issued, folder: Path) -> list[str]:
    """Write the class's answers: CSV, JSON and notebooks, with the accidents of a real Monday.

    They take the place of those before; gives notes on what else stood there.
    """
    files: dict[str, str] = {"broken.ipynb": '{"cells": ['}
    rows: list[list[Any]] = []
    sheets: list[dict[str, Any]] = []
    for number, student in enumerate(issued.students):
        habit = HABITS[number % len(HABITS)]
        for name in issued.exercises:
            seed = issued.seeds[student, name]
            variant = course[name].from_record(issued.records[name, seed])
            key = variant.key
            answers = {p.id: habit(variant, key, p, index) for index, p in enumerate(variant.parts)}
            if number % 3 == 0:
                rows += [[student, name, seed, part, answer] for part, answer in answers.items()]
            elif number % 3 == 1:
                sheets.append({"student": student, "exercise": name, "seed": seed, "answers": answers})
            else:
                files[f"{name}-{seed}.ipynb"] = _notebook(course, variant, student, answers)
    rows.insert(3, [*rows[2][:4], "a second thought"])
    rows.insert(9, ["Zoé Inconnue", *rows[8][1:]])
    typed = io.StringIO(newline="")
    csv.writer(typed, delimiter=";").writerows([COLUMNS, *rows])
    files["answers.csv"] = f"\ufeff{typed.getvalue()}"
    files["answers.json"] = json.dumps(sheets, ensure_ascii=False, indent=1)
    wanted = [File(Path(name), text.encode) for name, text in files.items()]
    return write_tree(folder, wanted, anew=True)


def _notebook(course: Any, variant: Variant, student: str, answers: Mapping[str, Any]) -> str:
    notebook = json.loads(renderer_of(course.folder).notebook(variant.handout(student)))
    cell = next(c for c in notebook["cells"] if "answers" in c["metadata"].get("tags", ()))
    keys = answer_keys(variant.parts)
    lines = [f"    {keys.get(part, part)!r}: {answer!r},\n" for part, answer in answers.items()]
    cell["source"] = ["answers = {\n", *lines, "}"]
    return json.dumps(notebook, ensure_ascii=False)
