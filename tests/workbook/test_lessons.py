"""Lessons are notebooks in every language that run from top to bottom."""

from __future__ import annotations

import json
from functools import cache

import nbformat
import pytest
from sweeps import sampled

import coursework
from coursework.cli import run
from coursework.errors import BadCourse, UnknownName
from coursework.language.words import languages
from coursework.workbook.notebooks import lesson_notebook

LESSONS = coursework.open_course().folder.lessons


@cache
def printed_by(course, name, lang):
    """What a lesson prints as it runs from top to bottom, run once."""
    from nbclient import NotebookClient

    book = nbformat.reads(lesson_notebook(course, name, lang), as_version=4)
    NotebookClient(book, timeout=120, kernel_name="python3").execute()
    return [o for cell in book.cells for o in cell.get("outputs", ()) if o.output_type == "stream"]


@pytest.mark.parametrize("lang", sampled(languages(), ["en"]))
@pytest.mark.parametrize("name", sampled(LESSONS, ["accuracy"]))
def test_a_lesson_runs_from_top_to_bottom(course, name, lang):
    printed = printed_by(course, name, lang)
    assert printed
    assert all(output.name == "stdout" for output in printed)


def test_the_french_lesson_prints_no_english(course):
    printed = "".join(output.text for output in printed_by(course, "mechanisms", "fr"))
    for english in ("does not close", "theta3_open", "crank-rocker", "double-rocker", "change-point"):
        assert english not in printed
    for french in ("mode ouvert", "ne se coupent pas", "manivelle-balancier", "double manivelle"):
        assert french in printed


@pytest.mark.parametrize("name", LESSONS)
def test_a_lesson_computes_the_same_in_every_language(course, name):
    """The code differs in its words alone: texts and comments."""
    import ast

    def shape(source):
        tree = ast.parse(source)
        return [type(node).__name__ for node in ast.walk(tree) if not isinstance(node, ast.JoinedStr)]

    books = [json.loads(lesson_notebook(course, name, lang)) for lang in languages()]
    codes = [[shape("".join(c["source"])) for c in b["cells"] if c["cell_type"] == "code"] for b in books]
    assert all(code == codes[0] for code in codes)


def test_lessons_are_listed_and_written(tmp_path, capsys):
    assert run(["lesson"]) == 0
    assert set(capsys.readouterr().out.split()) == set(LESSONS)
    assert run(["lesson", LESSONS[0], "--lang", "en", "--out", str(tmp_path)]) == 0
    assert (tmp_path / f"{LESSONS[0]}.en.ipynb").exists()


def test_a_lesson_that_is_not_there_is_told(course, small_course):
    with pytest.raises(UnknownName, match="lesson"):
        lesson_notebook(course, "accurracy", "fr")
    folder = small_course / "exercises" / "lessons"
    folder.mkdir()
    (folder / "rods.fr.md").write_text("# Bielles\n", "utf-8")
    own = coursework.open_course(small_course)
    assert own.folder.lessons == ("rods",)
    with pytest.raises(BadCourse, match="'en'"):
        lesson_notebook(own, "rods", "en")
