"""Words and typography of each language."""

from __future__ import annotations

import re
import tomllib
from dataclasses import replace
from functools import reduce

import pytest
from rendering_samples import handout
from tables import each_row

from coursework.errors import BadCourse
from coursework.language import words as language
from coursework.language.typography import typeset
from coursework.language.words import words
from coursework.markup.markdown import to_html, to_notebook_markdown, to_typst_markup
from coursework.rendering.feedback import verdict_word
from coursework.rendering.views import points_text, tolerances

every_language = pytest.mark.parametrize("lang", ["fr", "en"])


def keys(table: dict, path: str = "") -> set[str]:
    return {
        key
        for name, value in table.items()
        for key in (keys(value, f"{path}{name}.") if isinstance(value, dict) else {path + name})
    }


@each_row("of", ["", "site"])
def test_both_languages_have_the_same_words(of):
    tables = {lang: tomllib.loads(language.file_of(lang, of).read_text("utf-8")) for lang in ("fr", "en")}
    french, english = (keys({k: v for k, v in t.items() if k != "units"}) for t in tables.values())
    assert french == english
    for name in english:
        texts = [reduce(lambda table, key: table[key], name.split("."), table) for table in tables.values()]
        blanks = [set(re.findall(r"\{\w*\}", text)) for text in texts if isinstance(text, str)]
        assert blanks[1:] == blanks[:-1], f"{name}: {texts}"


def test_a_language_whose_file_lacks_a_text_says_which(monkeypatch):
    whole = language._read(language.file_of("en"))
    lacking = {**whole, "study": {k: v for k, v in whole["study"].items() if k != "refused"}}
    monkeypatch.setattr(language, "cached_result", lambda files, name, make: make())
    monkeypatch.setattr(language, "_read", lambda file: lacking if file.stem == "fr" else whole)
    with pytest.raises(BadCourse, match=r"fr\.toml lacks study\.refused\.all_begun, .*en\.toml"):
        words.__wrapped__("fr")


def test_french_puts_narrow_spaces_where_french_does():
    assert typeset("Est-ce juste ? Oui : « voici » ; 3 mm", "fr") == (
        "Est-ce juste\u202f? Oui\u202f: «\u202fvoici\u202f»\u202f; 3\u202fmm"
    )
    assert typeset("l'angle, quoi?", "fr") == "l’angle, quoi\u202f?"
    assert typeset("Havens' gear, the wheels'\nteeth, Willis'; don't", "en") == (
        "Havens’ gear, the wheels’\nteeth, Willis’; don’t"
    )
    assert typeset("no 'rod'; did you mean 'rods' or the pin's", "en") == (
        "no 'rod'; did you mean 'rods' or the pin’s"
    )
    assert typeset("Is it right? 3 mm", "en") == "Is it right? 3\u00a0mm"
    assert typeset("à 12:30 (a:b)", "fr") == "à 12:30 (a:b)"
    for write in (to_html, to_typst_markup, to_notebook_markdown):
        assert write("$x$ ; **y** : z", "fr").count("\u202f") == 2
        assert write("`x` : `y`", "fr").count("\u202f") == 1


@each_row(
    ("points", "fr", "en"),
    [
        (0, "0 point", "0 points"),
        (0.5, "0,5 point", "0.5 points"),
        (1, "1 point", "1 point"),
        (1.5, "1,5 point", "1.5 points"),
        (2, "2 points", "2 points"),
    ],
)
def test_points_take_their_plural_as_the_language_does(points, fr, en):
    assert points_text(points, "fr") == fr
    assert points_text(points, "en") == en


@every_language
def test_a_verdict_is_said_without_the_name_of_the_mistake(lang):
    assert verdict_word("mistake:arctan_without_quadrant", lang) == verdict_word("mistake", lang)
    assert "arctan" not in verdict_word("mistake:arctan_without_quadrant", lang)


def test_margins_are_said_once_each_with_their_questions():
    assert tolerances(handout("en").questions, "en") == (
        ("questions 2, 6–10", "within 1%"),
        ("questions 3, 5", "within 0.5°"),
    )
    alike = [replace(q, tolerance="within 1%") for q in handout("en").questions]
    assert tolerances(alike, "en") == (("", "within 1%"),)
