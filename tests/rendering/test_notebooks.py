"""Notebooks to hand in: valid, the same twice, with one cell of answers."""

from __future__ import annotations

import ast
import json
from dataclasses import replace

import nbformat
import pytest
from rendering_samples import handout

from coursework.course.builtin import builtin_root
from coursework.rendering.renderer import Renderer
from coursework.sheets.sheet import GivenValue

TEMPLATES = builtin_root() / "templates"
RENDERER = Renderer([TEMPLATES])
every_language = pytest.mark.parametrize("lang", ["fr", "en"])


def cells(book: dict, kind: str) -> list[str]:
    return ["".join(cell["source"]) for cell in book["cells"] if cell["cell_type"] == kind]


@every_language
def test_a_notebook_is_valid_and_the_same_twice(lang):
    text = RENDERER.notebook(handout(lang))
    nbformat.validate(nbformat.reads(text, as_version=4))
    assert text == RENDERER.notebook(handout(lang))
    ids = [cell["id"] for cell in json.loads(text)["cells"]]
    assert len(set(ids)) == len(ids)


@every_language
def test_one_cell_of_a_notebook_holds_the_answers_as_a_literal(lang):
    sheet = handout(lang)
    book = json.loads(RENDERER.notebook(sheet))
    (tagged,) = [cell for cell in book["cells"] if "answers" in cell["metadata"].get("tags", ())]
    (statement,) = ast.parse("".join(tagged["source"])).body
    assert isinstance(statement, ast.Assign)
    nobodys = {} if sheet.student else {"student": ""}
    assert ast.literal_eval(statement.value) == nobodys | {question.id: "" for question in sheet.questions}


@every_language
def test_a_notebook_names_each_choice_as_it_is_to_be_written_and_says_cases_as_words(lang):
    sheet = handout(lang)
    choices = (("one", "$w = 1$"), ("two", "l'autre"))
    question = replace(sheet.questions[0], kind="choice", choices=choices, letters=("a", "b"))
    case = GivenValue("mode", r"\text{mode}", "l'autre", "", is_number=False)
    book = nbformat.reads(RENDERER.notebook(replace(sheet, questions=(question,), given=(case,))), 4)
    words_of = "\n".join(cells(book, "markdown"))
    assert "- `a`" in words_of
    assert "- `b`" in words_of
    assert "`one`" not in words_of
    assert "| l’autre |" in words_of
    assert "a, b" in "\n".join(cells(book, "code"))


@every_language
def test_a_notebook_sets_the_given_values_as_python_numbers(lang):
    book = json.loads(RENDERER.notebook(handout(lang)))
    names: dict[str, object] = {}
    for statement in ast.parse(cells(book, "code")[0]).body:
        names[statement.targets[0].id] = ast.literal_eval(statement.value)
    assert names == {"r1": 228.6, "theta1": 90, "r2": 114.3, "theta2": 135, "omega2": -12.5, "alpha2": 0}


def test_a_given_named_as_a_word_of_python_still_makes_a_variable():
    sheet = replace(handout("en"), given=(GivenValue("lambda", r"\lambda", "1.2e-3", ""),))
    book = json.loads(RENDERER.notebook(sheet))
    assert "lambda_ = 1.2e-3" in cells(book, "code")[0]


@every_language
def test_a_notebook_to_hand_in_runs_nothing_and_checks_nothing(lang):
    book = json.loads(RENDERER.notebook(handout(lang)))
    code = [ast.parse(source) for source in cells(book, "code")]
    # Literals with names, and nothing that could be called.
    assert all(isinstance(line, ast.Assign) for cell in code for line in cell.body)
    assert not any(isinstance(node, (ast.Call, ast.Import)) for cell in code for node in ast.walk(cell))


@every_language
def test_a_notebook_knows_whose_and_which_variant_it_is(lang):
    sheet = handout(lang, student="Zoé")
    book = json.loads(RENDERER.notebook(sheet))
    assert book["metadata"]["coursework"] == {
        "exercise": "slotted_mechanism",
        "version": 1,
        "seed": 42,
        "student": "Zoé",
        "lang": lang,
        "record": sheet.record,
    }


def test_a_notebook_carries_its_figure():
    book = json.loads(RENDERER.notebook(handout("en")))
    (shown,) = [cell for cell in book["cells"] if "attachments" in cell]
    assert shown["attachments"]["figure.png"]["image/png"].startswith("iVBORw0KGgo")
    assert handout("en").figure_alt in "".join(shown["source"])
