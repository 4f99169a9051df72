"""Form for answers typed from paper, with a line for each paper and a column for each question."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from coursework.issuing.issued import by_code
from coursework.issuing.issuing import Issue
from coursework.issuing.students import folded
from coursework.sheets.units import units_text


def wide_form(
    issues: Sequence[Issue], identity: Sequence[str] = ()
) -> tuple[list[str], list[dict[str, Any]]]:
    """Return the columns and the rows of ``answers_wide.csv``, which :mod:`coursework.gradebook.wide_answers` reads.

    A column is titled by the number of its question on the paper, the exercise, the part and the unit. ``identity``
    names columns of the roster by which a person finds a line.
    """
    issues, identity = by_code(issues), () if any(issue.code for issue in issues) else identity
    needs_seeds = any(not issue.student or issue.sitting > 1 for issue in issues)
    papers: dict[tuple[str, int], dict[str, Any]] = {}
    exercises: dict[str, dict[str, tuple[int, str]]] = {}  #: by part: number of the question, and unit
    for issue in issues:
        name, paper = issue.variant.exercise.name, (issue.stem, issue.sitting)
        if paper not in papers:
            cells = {folded(t): value for t, value in issue.columns.items()}
            papers[paper] = {t: cells.get(folded(t), "") for t in identity}
            papers[paper] |= {"student": issue.shown, "version": issue.version}
        papers[paper][f"{name} seed"] = issue.variant.seed
        for number, part in enumerate(issue.variant.parts, 1):
            unit = units_text(part, issue.langs[0], issue.variant)
            exercises.setdefault(name, {}).setdefault(part.id, (number, f" ({unit})" if unit else ""))
    columns = ["student", *identity, *(["version"] if any(issue.version for issue in issues) else [])]
    for place, (name, asked) in enumerate(exercises.items(), 1):
        columns += [f"{name} seed"] if needs_seeds else []
        numbered = sorted(asked.items(), key=lambda item: item[1][0])
        columns += [f"{place}.{number} {name} {part}{unit}" for part, (number, unit) in numbered]
    return columns, [{**dict.fromkeys(columns, ""), **row} for row in papers.values()]
