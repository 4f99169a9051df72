"""Summary of a chapter: each formula is one that its lesson states, in every language."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from coursework.errors import BadCourse, CourseworkError
from coursework.selfstudy.workbook import lesson_source as source
from coursework.selfstudy.workbook.numbering import LessonNumbers
from coursework.selfstudy.workbook.summaries import RULES, summary_of
from coursework.sheets.book import BookChapter, LessonText, SummaryCard


def written(folder, name, lang):
    """Return a lesson with its text alone: nothing is drawn or run."""
    text = (folder.lesson_place / f"{name}.{lang}.md").read_text("utf-8")
    numbers = LessonNumbers(1 + folder.lessons.index(name), lang)
    prose = (b.text for b in source.blocks(text, name) if isinstance(b, source.LessonProse))
    pieces = tuple(piece for words in prose for piece in numbers.prose(words))
    return LessonText(name, 1, lang, name, pieces, ())


def test_every_lesson_has_a_summary_whose_formulas_it_states(course):
    faults = []
    for lang in course.folder.languages:
        for name in course.folder.lessons:
            try:
                card = summary_of(course.folder, written(course.folder, name, lang))
            except CourseworkError as fault:
                faults.append(f"{lang}: {fault}")
                continue
            if card is None or not all(getattr(card, rule) for rule in RULES):
                faults.append(f"{lang}, {name}: {card}")
    assert faults == []


def test_a_formula_is_cut_at_its_wide_spaces_and_bears_the_number_of_the_lesson(course):
    card = summary_of(course.folder, written(course.folder, "velocities", "en"))
    number, lines = next(item for item in card.formulas if len(item[1]) > 1)
    assert re.fullmatch(r"5\.\d+", number)
    assert lines[0].startswith(r"\omega_3 =")
    assert lines[1].startswith(r"\omega_4 =")


def test_a_formula_that_no_lesson_states_is_told(course):
    silent = replace(written(course.folder, "velocities", "en"), pieces=())
    with pytest.raises(BadCourse, match="velocities states no formula with"):
        summary_of(course.folder, silent)


def test_the_cards_stand_in_two_columns_of_about_one_height():
    cards = tuple(SummaryCard(None, (), ("x" * 60 * n,), (), ()) for n in (2, 2, 4))
    columns = BookChapter(1, "", (), cards).summary_columns
    assert [len(column) for column in columns] == [2, 1]
    assert BookChapter(1, "", ()).summary_columns == ((), ())
