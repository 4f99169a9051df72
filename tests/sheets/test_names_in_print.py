"""Sheets print symbols: the name of a quantity in Python stands in no text outside formulas and code."""

from __future__ import annotations

import re
from collections.abc import Iterator

from sweeps import whole_course

import coursework
from coursework.rendering.views import quantity_words
from coursework.sheets.sheet import AnswerSheet

COURSE = coursework.open_course()
_APART = re.compile(r"\$\$.*?\$\$|\$[^$]*\$|`[^`]*`|\]\([^)]*\)", re.DOTALL)
_IN_PYTHON = re.compile(
    r"(?<![\w\\])(?:[^\W_]+(?:_[^\W_]+)+|(?:alpha|beta|gamma|delta|epsilon|theta|phi|psi|omega)\d*"
    r"|[A-Za-z]{1,3}\d+)(?!\w)"
)


def _printed(sheet: AnswerSheet) -> Iterator[tuple[str, str]]:
    """Yield the texts of a sheet, each with its place."""
    handout = sheet.handout
    yield "statement", handout.statement
    yield "introduction", sheet.introduction
    yield from (("caption", text) for text in (handout.figure_alt, sheet.figure_alt))
    yield from (("caption", text) for _, text in handout.more_figures)
    for value in handout.given:
        yield f"given {value.name}", f"{value.value} {value.unit}"
    for answer in sheet.answers:
        question = answer.question
        yield (
            f"question {question.id}",
            " ".join([question.prompt, question.unit, question.hint, question.rule, question.tolerance]),
        )
        yield (
            f"entry {question.id}",
            (question.symbol and f"${question.symbol}$") or quantity_words(question, handout.lang),
        )
        yield from ((f"choice of {question.id}", label) for _, label in question.choices)
        yield f"answer {question.id}", f"{answer.text} {answer.margin}"
    for step in sheet.steps:
        yield f"step {step.name}", step.words
        for remark in step.remarks:
            yield f"remark at {step.name}", f"{remark.words} {remark.wrong}"


@whole_course
def test_no_sheet_prints_the_python_name_of_a_quantity():
    found = [
        (lang, name, place, match.group())
        for name in COURSE.names
        for variant in COURSE[name].variants([0], "en", ["all"])
        for lang in ("en", "fr")
        for place, text in _printed(variant.in_language(lang).answer_sheet(polygons=False))
        for match in _IN_PYTHON.finditer(_APART.sub(" ", text))
    ]
    assert found == []
