"""Notebooks of a paper: an answers cell an exercise, each read for what it is."""

from __future__ import annotations

import json

import pytest

from coursework.gradebook.rows import AnswerRow, Rejected
from coursework.gradebook.submissions import read_file

SHEETS = [{"exercise": "crank_pin", "seed": 5}, {"exercise": "grashof", "seed": 12}]


def cell(code, about=None, tags=("answers",)):
    metadata = {"tags": list(tags)} | ({} if about is None else {"coursework": about})
    return {"cell_type": "code", "metadata": metadata, "source": code}


def read(tmp_path, cells, student="Ada", sheets=SHEETS):
    content = {
        "cells": [{"cell_type": "markdown", "metadata": {}, "source": "# Midterm"}, *cells],
        "metadata": {"coursework": {"student": student, "sheets": sheets, "lang": "en"}},
    }
    (tmp_path / "ada.ipynb").write_text(json.dumps(content), "utf-8")
    return list(read_file(tmp_path / "ada.ipynb"))


def placed(rows):
    return [(r.student, r.exercise, r.seed, r.part, r.answer) for r in rows if isinstance(r, AnswerRow)]


def refused(rows):
    return [
        (r.row["student"], r.row["exercise"], r.row["seed"], r.reason)
        for r in rows
        if isinstance(r, Rejected)
    ]


BOTH = [("Ada", "crank_pin", "5", "x", "1,5"), ("Ada", "grashof", "12", "class", "2")]


@pytest.mark.parametrize("by_comment", [False, True])
def test_every_answers_cell_is_read_by_its_metadata_or_its_comment(tmp_path, by_comment):
    """The cells in another order than the paper's."""
    cells = [
        cell('answers = {  # grashof 12\n    "class": "2",\n}', None if by_comment else SHEETS[1]),
        cell('answers = {  # crank_pin 5\r\n    "x": "1,5",  # mm\r\n}', None if by_comment else SHEETS[0]),
    ]
    rows = read(tmp_path, cells)
    assert placed(rows) == BOTH[::-1]
    assert not refused(rows)
    assert {r.lang for r in rows} == {"en"}


def test_metadata_goes_before_a_comment_that_was_pasted(tmp_path):
    cells = [cell('answers = {  # grashof 12\n "x": "1,5"}', SHEETS[0]), cell('{"class": "2"}', SHEETS[1])]
    assert placed(read(tmp_path, cells)) == BOTH


def test_a_cell_that_cannot_be_read_costs_its_own_exercise(tmp_path):
    rows = read(
        tmp_path, [cell('answers = {"x": "1,5"}', SHEETS[0]), cell("import os\nos.abort()", SHEETS[1])]
    )
    assert placed(rows) == BOTH[:1]
    (student, exercise, seed, reason) = refused(rows)[0]
    assert (student, exercise, seed) == ("Ada", "grashof", "12")
    assert "one dict and nothing else" in reason


def test_a_cell_that_is_gone_or_not_tagged_is_told_with_what_stands_in_others(tmp_path):
    rows = read(tmp_path, [cell('{"x": "1,5"}', SHEETS[0]), cell('{"class": "2"}', SHEETS[1], tags=())])
    assert placed(rows) == BOTH[:1]
    assert refused(rows) == [("Ada", "grashof", "12", "no cell tagged 'answers' belongs to grashof, seed 12")]
    assert rows[-1].row["answer"] == '{"class": "2"}'


def test_a_cell_of_no_exercise_is_told_what_to_write(tmp_path):
    rows = read(tmp_path, [cell('{"x": "1,5"}'), cell('{"class": "2"}', SHEETS[1])])
    assert placed(rows) == BOTH[1:]
    assert "write # crank_pin 5 after its {" in refused(rows)[0][3]


def test_one_exercise_needs_neither(tmp_path):
    assert placed(read(tmp_path, [cell('{"x": "1,5"}')], sheets=SHEETS[:1])) == BOTH[:1]


def test_two_cells_of_one_exercise_lose_no_answer(tmp_path):
    rows = read(tmp_path, [cell('{"x": "1"}', SHEETS[0]), cell('{"x": "2"}', SHEETS[0])], sheets=SHEETS[:1])
    assert [r.answer for r in rows] == ["1", "2"]


def test_the_name_written_in_one_cell_is_that_of_all(tmp_path):
    cells = [cell('{"x": "1,5"}', SHEETS[0]), cell('{"student": "Ada", "class": "2"}', SHEETS[1])]
    assert placed(read(tmp_path, cells, student="")) == BOTH
    cells = [cell('{"x": "1,5"}', SHEETS[0]), cell('{"class": "2"}', SHEETS[1])]
    rows = read(tmp_path, cells, student="")
    assert {r.student for r in rows} == {"ada"}
    assert all("the name of its file is taken" in r.warning for r in rows)


@pytest.mark.parametrize("sheets", [[], ["x"], [{"exercise": None}], [{}]])
def test_a_damaged_notebook_is_told_and_no_traceback(tmp_path, sheets):
    rows = read(tmp_path, [], sheets=sheets)
    assert rows
    assert all(isinstance(r, Rejected) for r in rows)


def test_a_paper_without_tags_or_metadata_is_known_by_what_it_prints(tmp_path):
    cells = [
        cell('answers = {  # crank_pin 5\n "x": "1,5"}', tags=()),
        cell('answers = {  # grashof 12\n "class": "2"}', tags=()),
    ]
    rows = read(tmp_path, cells)
    assert placed(rows) == BOTH
    assert all("no cell is tagged" in r.warning for r in rows)
    printed = (
        "# Midterm\n\n**Name:** Ada — Group: 2\n\ncrank\\_pin · 5 · v1\n\ngrashof · 12 · v1\n\n## Your "
        "answers"
    )
    content = {
        "cells": [{"cell_type": "markdown", "metadata": {}, "source": printed}, *cells],
        "metadata": {},
    }
    (tmp_path / "ada.ipynb").write_text(json.dumps(content), "utf-8")
    rows = list(read_file(tmp_path / "ada.ipynb"))
    assert placed(rows) == BOTH
    assert all("metadata is gone" in r.warning for r in rows)
