"""What a student's sheet shows, and what it never holds."""

from __future__ import annotations

import re

import pytest
from rendering_samples import ANSWER_DIGITS, feedback_sheet, handout

from coursework.course.builtin import builtin_root
from coursework.rendering.renderer import Renderer

TEMPLATES = builtin_root() / "templates"
RENDERER = Renderer([TEMPLATES])
every_language = pytest.mark.parametrize("lang", ["fr", "en"])


@every_language
def test_feedback_holds_no_reference_value(lang):
    sheet = feedback_sheet(lang)
    for text in (RENDERER.typst(sheet), RENDERER.html(sheet)):
        assert not any(digits in re.sub(r'data:image/[^"]+', "", text) for digits in ANSWER_DIGITS)


@every_language
def test_every_given_value_is_on_the_sheet_as_the_language_writes_it(lang):
    values = ["228,6", "114,3", "−12,5"] if lang == "fr" else ["228.6", "114.3", "−12.5"]
    page = re.sub(r"<[^>]*>", "", RENDERER.html(handout(lang)))
    source = RENDERER.typst(handout(lang)).replace('−"', '"−')
    for value in values:
        assert value in page
        assert f'"{value}"' in source
        assert value in RENDERER.terminal(handout(lang))
