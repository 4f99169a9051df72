"""Lessons are notebooks in every language that run from top to bottom."""

from __future__ import annotations

import re

import nbformat
import pytest
from sweeps import sampled
from tables import each_row

import coursework
from coursework.cli import run
from coursework.course.lessons import lesson_file, lesson_sections, taught_by
from coursework.errors import BadCourse, UnknownName
from coursework.language.words import languages
from coursework.selfstudy.workbook.files import lesson_notebook
from coursework.selfstudy.workbook.lesson_source import (
    CodeCell,
    LessonAnswer,
    LessonImage,
    LessonProse,
    blocks,
)
from coursework.selfstudy.workbook.lessons import faults, lesson_text, opened
from coursework.sheets.book import CodePiece, PrintedPiece
from coursework.sheets.book import ProsePiece as Prose_

every_language = pytest.mark.parametrize("lang", languages())
LESSONS = coursework.open_course().folder.lessons


@pytest.mark.e2e
@pytest.mark.parametrize("name", sampled(LESSONS, ["accuracy"]))
def test_a_lesson_runs_from_top_to_bottom(course, name):
    """In English; in each language they run below, without a notebook's kernel."""
    from nbclient import NotebookClient

    book = nbformat.reads(lesson_notebook(course, name, "en"), as_version=4)
    prints = any("print(" in cell.source for cell in book.cells if cell.cell_type == "code")
    NotebookClient(book, timeout=120, kernel_name="python3").execute()
    printed = [o for cell in book.cells for o in cell.get("outputs", ()) if o.output_type == "stream"]
    assert bool(printed) == prints
    assert all(output.name == "stdout" for output in printed)


#: Words of the exercises' and lessons' English that no French text has.
ENGLISH = re.compile(r"\b(the|with|crank|rocker|does not|velocity|yes|length|slider|found)\b")


def prints(told):
    """The texts that a lesson prints, those of its answers too."""
    pieces = [*told.pieces, *(piece for _, answer in told.answers for piece in answer)]
    return [piece.text for piece in pieces if isinstance(piece, (PrintedPiece, Prose_))]


def numbers(told):
    """The numbers that come out, whatever the sign of their decimals."""
    printed = " ".join(
        p.text for _, answer in told.answers for p in answer if getattr(p, "text", "").startswith("- ")
    )
    return sorted(re.findall(r"\d+(?:[.,]\d+)?", printed.replace(",", ".").replace("{.}", ".")))


#: What a cell prints in columns, once it is a line of an answer: a value, and another at once.
COLUMNS = re.compile(r"^- .*= −?[\d.,]*\d(?: ?[a-zµ°/²]{1,5})? (?:\d|[^\W\d_]\S* =).*$", re.MULTILINE)


@pytest.mark.parametrize("name", sampled(LESSONS, ["positions"]))
def test_a_lesson_is_read_drawn_and_run_and_is_the_same_in_every_language(course, name):
    assert faults(course, name) == ()
    told = {lang: lesson_text(course, name, lang) for lang in languages()}
    for one in told.values():
        for piece in one.pieces:
            if isinstance(piece, (PrintedPiece, CodePiece)):
                assert max(map(len, piece.text.splitlines())) <= 100, f"wider than a page: {piece.text}"
            assert getattr(piece, "caption", "told") or not piece.number, piece.said
        said = re.sub(r"\$+[^$]*\$+", "", "\n".join(prints(one)))
        assert re.findall(r".*(?<![\w.)-])-\d.*", said) == []
        answers = "\n".join(p.text for _, found in one.answers for p in found if isinstance(p, Prose_))
        assert COLUMNS.findall(answers) == [], "an answer is a sentence, not a row of a table"
    if name != "accuracy":  # which has times
        assert numbers(told["en"]) == numbers(told["fr"])
    said = re.sub(r"\$+[^$]*\$+", "", " ".join(prints(told["fr"])))
    found = ENGLISH.search(said)
    assert not found, said[max(0, found.start() - 60) : found.end() + 60]


@every_language
@each_row("name", LESSONS)
def test_a_lesson_teaches_and_lets_try(course, name, lang):
    """Goals, something to predict, an example that fades, usual mistakes, three questions, figures, terms."""
    found = blocks(lesson_file(course.folder, name, lang).read_text("utf-8"), name)
    text = "\n".join(one.text for one in found if isinstance(one, LessonProse))
    code = "\n".join(one.code for one in found if isinstance(one, CodeCell))
    assert re.search(r"^## (What you will be able to do|Ce que vous saurez faire)$", text, re.MULTILINE)
    assert len(lesson_sections(course.folder, name, lang)) >= 3
    assert "coursework.compare(" in code
    assert "coursework.mistakes(" in code
    levels = {int(level) for level in re.findall(r"\blevel=(\d)", code)}
    assert 4 in levels, "a bare example"
    assert levels & {1, 2, 3}, "a half-worked example"
    assert re.search(r"coursework\.worked\((?![^)]*level=)", code), "a whole example"
    assert sum(isinstance(one, LessonAnswer) for one in found) >= 3
    assert sum(isinstance(one, LessonImage) for one in found) >= 2
    assert len(opened(course, name, lang).terms) >= 3


def test_every_exercise_leads_to_its_lesson_and_back(course):
    for name in course.names:
        for lang in languages():
            taught = taught_by(course.folder, name, lang)
            assert taught, name
            section = course.folder.section_of(name)
            assert section.lesson in {one.name for one in taught}
            assert name in section.exercises


@pytest.mark.e2e
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
