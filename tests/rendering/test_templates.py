"""A course replaces templates; what is wrong with one is told."""

from __future__ import annotations

from pathlib import Path

import pytest
from rendering_samples import handout

from coursework.course.builtin import builtin_root
from coursework.errors import BadCourse, BadStatement
from coursework.rendering.renderer import Renderer

TEMPLATES = builtin_root() / "templates"


def _replace(folder: Path, name: str, text: str) -> None:
    (folder / name).parent.mkdir(exist_ok=True)
    (folder / name).write_text(text, "utf-8")


def test_a_course_replaces_one_template_and_takes_the_others(tmp_path):
    _replace(tmp_path, "parts/figure_and_data.html.j2", "<p>{{ sheet.title }} & co</p>")
    page = Renderer([tmp_path, TEMPLATES]).html(handout("en"))
    assert "<p>Slotted mechanism & co</p>" in page
    assert "<img" not in page


def test_a_name_that_a_template_does_not_have_is_an_error(tmp_path):
    _replace(tmp_path, "parts/figure_and_data.html.j2", "{{ nonsense }}")
    with pytest.raises(BadStatement, match="nonsense"):
        Renderer([tmp_path, TEMPLATES]).html(handout("en"))


def test_a_course_template_may_use_macros(tmp_path):
    _replace(
        tmp_path,
        "parts/figure_and_data.html.j2",
        "{% macro shown(name) %}<b>{{ name }}</b>{% endmacro %}{{ shown('a < b') }}",
    )
    assert "<b>a &lt; b</b>" in Renderer([tmp_path, TEMPLATES]).html(handout("en"))


def test_a_template_that_typst_refuses_is_an_error_of_the_course(tmp_path):
    _replace(tmp_path, "parts/figure_and_data.typ.j2", "#nonsense")
    with pytest.raises(BadStatement, match="nonsense"):
        Renderer([tmp_path, TEMPLATES]).pdf(handout("en"))


def test_a_missing_template_is_named(tmp_path):
    _replace(tmp_path, "sheet/sheet.html.j2", (TEMPLATES / "sheet/sheet.html.j2").read_text("utf-8"))
    with pytest.raises(BadCourse, match="parts/page"):
        Renderer([tmp_path]).html(handout("en"))


def test_a_template_beside_the_folders_is_an_error_that_names_its_place(tmp_path):
    for old, place in {
        "sheet.html.j2": "sheet/sheet.html.j2",
        "_figure_and_data.typ.j2": "parts/figure_and_data.typ.j2",
        "paper_solution.tex.j2": "paper/solution.tex.j2",
        "_site_practice_told.html.j2": "site/student/_practice_told.html.j2",
        "site_desk_class.html.j2": "site/instructor/class.html.j2",
    }.items():
        (tmp_path / old).write_text("", "utf-8")
        with pytest.raises(BadCourse, match=place):
            Renderer([tmp_path, TEMPLATES]).html(handout("en"))
        (tmp_path / old).unlink()
    (tmp_path / "our_words.md.j2").write_text("", "utf-8")
    assert Renderer([tmp_path, TEMPLATES]).html(handout("en"))
