"""Form for answers typed from paper, with a line for each paper and a column for each question."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from coursework.issuing.issued import NOT_ASKED, by_code
from coursework.issuing.issuing import Issue
from coursework.issuing.students import folded
from coursework.sheets.units import units_text


def wide_form(
    issues: Sequence[Issue], identity: Sequence[str] = ()
) -> tuple[list[str], list[dict[str, Any]]]:
    """Return the columns and the rows of ``answers_wide.csv``, which :mod:`coursework.gradebook.wide_answers`
    reads.

    A column is titled by the number of its question on the papers, all its numbers if these differ, the
    exercise, the part and the unit. What a paper does not ask is dashed on its line. ``identity`` names
    columns of the roster by which a person finds a line.
    """
    issues, identity = by_code(issues), () if any(issue.code for issue in issues) else identity
    needs_seeds = any(not issue.student or issue.sitting > 1 for issue in issues)
    papers: dict[tuple[str, int], dict[str, Any]] = {}
    on_paper: dict[tuple[str, int], list[str]] = {}  #: exercises of each paper, in their order
    exercises: dict[str, dict[str, _Column]] = {}  #: by part
    for issue in issues:
        name, paper = issue.variant.exercise.name, (issue.stem, issue.sitting)
        if paper not in papers:
            cells = {folded(t): value for t, value in issue.columns.items()}
            papers[paper] = {t: cells.get(folded(t), "") for t in identity}
            papers[paper] |= {"student": issue.shown, "version": issue.version}
        papers[paper][f"{name} seed"] = issue.variant.seed
        order = on_paper.setdefault(paper, [])
        order += [] if name in order else [name]
        for number, part in enumerate(issue.variant.parts, 1):
            column = exercises.setdefault(name, {}).get(part.id)
            if column is None:
                unit = units_text(part, issue.langs[0], issue.variant)
                column = exercises[name][part.id] = _Column(
                    f"{name} {part.id}" + (f" ({unit})" if unit else "")
                )
            column.numbers.add((order.index(name) + 1, number))
            column.papers.add(paper)
    columns = ["student", *identity, *(["version"] if any(issue.version for issue in issues) else [])]
    for name, asked in exercises.items():
        columns += [f"{name} seed"] if needs_seeds else []
        for column in sorted(asked.values(), key=lambda column: min(column.numbers)):
            columns.append(column.title)
            for paper in papers.keys() - column.papers:
                papers[paper][column.title] = NOT_ASKED
    return columns, [{**dict.fromkeys(columns, ""), **row} for row in papers.values()]


@dataclass
class _Column:
    """Column of a question: its numbers on the papers, and the papers that ask it."""

    name: str
    numbers: set[tuple[int, int]] = field(default_factory=set)
    papers: set[tuple[str, int]] = field(default_factory=set)

    @property
    def title(self) -> str:
        return "/".join(f"{place}.{number}" for place, number in sorted(self.numbers)) + f" {self.name}"
