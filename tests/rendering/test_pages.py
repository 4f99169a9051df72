"""A page of the web is one file that anybody can read and fill in."""

from __future__ import annotations

import re

import pytest
from page_scripts import allowed, digest, runs
from rendering_samples import answer_sheet, feedback_sheet, handout, many_given

from coursework.course.builtin import builtin_root
from coursework.rendering.renderer import Renderer

TEMPLATES = builtin_root() / "templates"
RENDERER = Renderer([TEMPLATES])
SHEETS = {"handout": handout, "many given": many_given, "answers": answer_sheet, "feedback": feedback_sheet}
every_language = pytest.mark.parametrize("lang", ["fr", "en"])
every_sheet = pytest.mark.parametrize("make", SHEETS.values(), ids=SHEETS)


@every_language
@every_sheet
def test_a_page_fetches_nothing_and_runs_nothing_but_what_keeps_answers(make, lang):
    page = RENDERER.html(make(lang))
    ran = runs(page)
    assert len(ran) == (make in (handout, many_given))
    assert allowed(page) == [digest(script) for script in ran]
    assert not re.search(r"https?:", page)
    assert re.findall(r"\bon\w+=", page) == []
    for target in re.findall(r"(?:src|href)=\"([^\"]*)\"|url\(\"?([^\")]*)", page):
        assert "".join(target).startswith("data:")
    assert f'<html lang="{lang}">' in page
    assert page.count("<h1>") == 1


@every_language
def test_a_page_has_a_labelled_box_for_every_answer_and_words_for_its_figure(lang):
    sheet = handout(lang)
    page = RENDERER.html(sheet)
    for question in sheet.questions:
        if question.choices:
            assert page.count(f'type="radio" name="{question.id}"') == len(question.choices)
        else:
            assert f'<label for="answer-{question.id}">' in page
            assert f'id="answer-{question.id}"' in page
    assert f'alt="{sheet.figure_alt}"' in page
