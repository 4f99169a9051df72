"""A course replaces templates; what is wrong with one is told."""

from __future__ import annotations

import shutil

import pytest
from rendering_samples import handout

from coursework.course.builtin import builtin_root
from coursework.errors import BadCourse, BadStatement
from coursework.rendering.renderer import Renderer

TEMPLATES = builtin_root() / "templates"


def test_a_course_replaces_one_template_and_takes_the_others(tmp_path):
    (tmp_path / "_figure_and_data.html.j2").write_text("<p>{{ sheet.title }} & co</p>", "utf-8")
    page = Renderer([tmp_path, TEMPLATES]).html(handout("en"))
    assert "<p>Slotted mechanism & co</p>" in page
    assert "<img" not in page


def test_a_name_that_a_template_does_not_have_is_an_error(tmp_path):
    (tmp_path / "_figure_and_data.html.j2").write_text("{{ nonsense }}", "utf-8")
    with pytest.raises(BadStatement, match="nonsense"):
        Renderer([tmp_path, TEMPLATES]).html(handout("en"))


def test_a_course_template_may_use_macros(tmp_path):
    (tmp_path / "_figure_and_data.html.j2").write_text(
        "{% macro shown(name) %}<b>{{ name }}</b>{% endmacro %}{{ shown('a < b') }}", "utf-8"
    )
    assert "<b>a &lt; b</b>" in Renderer([tmp_path, TEMPLATES]).html(handout("en"))


def test_a_template_that_typst_refuses_is_an_error_of_the_course(tmp_path):
    (tmp_path / "_figure_and_data.typ.j2").write_text("#nonsense", "utf-8")
    with pytest.raises(BadStatement, match="nonsense"):
        Renderer([tmp_path, TEMPLATES]).pdf(handout("en"))


def test_a_missing_template_is_named(tmp_path):
    shutil.copy(TEMPLATES / "sheet.html.j2", tmp_path)
    with pytest.raises(BadCourse, match="_page"):
        Renderer([tmp_path]).html(handout("en"))
