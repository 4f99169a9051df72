"""Summary of a lesson for a page that is cut out: its formulas as the lesson states them, conditions, sign
rules, traps."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from coursework.course.folder import Folder
from coursework.errors import BadCourse
from coursework.sheets.book import BoxPiece, LessonText, ProsePiece, SummaryCard

_EQUATION = re.compile(r"^\$\$((?:.|\n)+?)\$\$ \((\d+\.\d+)\)$", re.MULTILINE)
_APART = re.compile(r"\\qquad")
_MARK = re.compile(r"[\s\\,]*[.,;:]?\s*\Z")
_FORM = "formulas = ['w = 3n'], conditions = [{ en = \"…\" }], signs = […], traps = […]"
RULES = ("conditions", "signs", "traps")


def summary_of(folder: Folder, lesson: LessonText) -> SummaryCard | None:
    """Return the summary of a lesson, as ``exercises/book/summaries.toml`` states it; None where it states
    none.

    Raises
    ------
    BadCourse
        It is of another form, or the lesson states no such formula.
    """
    stated = folder.book_table("summaries").get(lesson.name)
    if stated is None:
        return None
    if not isinstance(stated, Mapping) or not set(stated) <= {"formulas", *RULES}:
        raise BadCourse(f"exercises/book/summaries.toml: {lesson.name}: write {_FORM}")
    equations = [(" ".join(tex.split()), number) for tex, number in _equations(lesson)]
    pieces = map(folder.symbols(lesson.lang), stated.get("formulas", ()))
    formulas = [_found(equations, piece, lesson.name) for piece in pieces]
    return SummaryCard(lesson, tuple(formulas), *(_said(stated, rule, lesson.lang) for rule in RULES))


def _equations(lesson: LessonText) -> Iterator[tuple[str, str]]:
    """Yield the numbered formulas of a lesson, each with its number."""
    for piece in lesson.pieces:
        if isinstance(piece, (ProsePiece, BoxPiece)):
            yield from _EQUATION.findall(piece.text)


def _found(equations: Sequence[tuple[str, str]], piece: str, lesson: str) -> tuple[str, tuple[str, ...]]:
    """Return the first formula that has a piece: its number, and its equalities, a line each."""
    for tex, number in equations:
        if piece in tex:
            parts = [tex] if r"\begin" in tex else _APART.split(tex)
            lines = (_MARK.sub("", one).strip() for one in parts)
            return number, tuple(
                one for one in lines if one and not one.startswith((r"\text", r"\Rightarrow"))
            )
    raise BadCourse(f"exercises/book/summaries.toml: {lesson} states no formula with {piece!r}")


def _said(stated: Mapping[str, Any], rule: str, lang: str) -> tuple[str, ...]:
    try:
        return tuple(str(item[lang]) for item in stated.get(rule, ()) if lang in item)
    except TypeError as fault:
        raise BadCourse(f"exercises/book/summaries.toml: {rule}: write {_FORM}") from fault
