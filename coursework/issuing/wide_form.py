"""Form for answers typed from paper, with a line for each paper and a column for each question."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from coursework.course.course import Course
from coursework.course.variant import Variant
from coursework.issuing.identity import column_called
from coursework.issuing.issued import NOT_ASKED, items_of_papers
from coursework.issuing.questions import PaperQuestions, Question
from coursework.sheets.units import units_text


def wide_form(
    course: Course[Any],
    content: Mapping[str, Any],
    questions: PaperQuestions,
    identity: Sequence[str] = (),
    codes: Mapping[str, str] | None = None,
) -> tuple[list[str], list[dict[str, Any]]]:
    """Return the columns and the rows of ``answers_wide.csv``, which :mod:`coursework.gradebook.wide_answers`
    reads, for the papers of an ``issued.json``.

    A column is titled by the number of its question on the papers, all its numbers if these differ, the
    exercise, the part and the unit. What a paper does not ask is dashed on its line. ``identity`` names
    columns of the roster by which a person finds a line; ``codes`` stand in place of the names.
    """
    papers, codes = items_of_papers(content), codes or {}
    if codes:
        papers.sort(key=lambda items: (codes.get(items[0]["student"], ""), items[0].get("sitting", 1)))
        identity = ()
    asking: dict[Question, Variant] = {}  #: a variant with each question
    rows: list[dict[str, Any]] = []
    asked: list[set[Question]] = []
    for items in papers:
        student = str(items[0].get("student", ""))
        cells = content.get("students", {}).get(student, {})
        rows.append({title: cells.get(column_called(cells, title), "") for title in identity})
        rows[-1] |= {"student": codes.get(student, student), "version": items[0].get("version", "")}
        asked.append(set())
        for record in (item["record"] for item in items):
            rows[-1][f"{record['exercise']} seed"] = record["seed"]
            on_paper = {(str(record["exercise"]), str(part["id"])) for part in record["parts"]}
            asked[-1] |= on_paper
            if new := on_paper - asking.keys():
                asking |= dict.fromkeys(new, course[record["exercise"]].from_record(record))
    columns = ["student", *identity, *(["version"] if any(row["version"] for row in rows) else [])]
    needs_seeds = any(not items[0].get("student") or items[0].get("sitting", 1) > 1 for items in papers)
    for question in (question for question in questions if question in asking):
        if needs_seeds and (seed := f"{question[0]} seed") not in columns:
            columns.append(seed)
        columns.append(f"{questions[question]} {' '.join(question)}{_unit(question, asking[question])}")
        for row, on_paper in zip(rows, asked, strict=True):
            row[columns[-1]] = "" if question in on_paper else NOT_ASKED
    return columns, [{column: row.get(column, "") for column in columns} for row in rows]


def _unit(question: Question, variant: Variant) -> str:
    part = next(part for part in variant.parts if part.id == question[1])
    unit = units_text(part, variant.lang, variant)
    return f" ({unit})" if unit else ""
