"""A language's words: what is wrong with their file is said with its place, when they are read."""

from __future__ import annotations

import codecs
import re
import shutil
from pathlib import Path

import pytest
from tables import each_row

from coursework.cli import run
from coursework.errors import BadCourse, UnknownName
from coursework.language import words as language
from coursework.language.numbers import significant, with_minus_signs
from coursework.system import cache


@pytest.fixture
def spanish(tmp_path, monkeypatch):
    """A third language: the path of its words, which are the English ones."""
    folder = tmp_path / "words"
    shutil.copytree(language._FOLDER, folder)
    monkeypatch.setattr(language, "_FOLDER", folder)
    language.languages.cache_clear()
    language.words.cache_clear()
    shutil.copy(folder / "en.toml", folder / "es.toml")
    yield folder / "es.toml"
    language.languages.cache_clear()
    language.words.cache_clear()


def test_a_copy_of_the_english_words_is_a_language_with_a_byte_order_mark_too(spanish):
    spanish.write_bytes(codecs.BOM_UTF8 + spanish.read_bytes())
    assert language.languages() == ("en", "es", "fr")
    assert language.words("es") == language.words("en")


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('data = "Given"', 'data = "Datos', "column 14)"),
        ('data = "Given"', 'data = "Dátos"', "is not UTF-8"),
        ('data = "Given"\n', "", "lacks sheet.data"),
        ('data = "Given"', "data = 1", "sheet.data is to be like the English 'Given'; found 1"),
        ("To be predicted: {names}", "A predecir: {nombres}", "{nombres}"),
        (
            "To be predicted: {names}",
            "A predecir: {nombres}",
            "study.which_predictions has {call}, {nombres} where",
        ),
        ("To be predicted: {names}", "A predecir:", "where the English text has {call}, {names}"),
        ("To be predicted: {names}", "A predecir: {names", "study.which_predictions"),
    ],
)
def test_words_that_cannot_be_used_are_one_line_with_file_and_place(spanish, capsys, old, new, told):
    text = spanish.read_text("utf-8")
    assert old in text
    spanish.write_bytes(text.replace(old, new).encode("latin-1" if "á" in new else "utf-8", "replace"))
    with pytest.raises(BadCourse) as caught:
        language.words("es")
    assert told in str(caught.value)
    assert str(spanish) in str(caught.value)
    assert run(["show", "slotted_mechanism", "--lang", "es"]) == 2
    assert str(spanish) in capsys.readouterr().err


def test_a_language_that_is_not_there_names_the_file_that_would_make_it_one():
    with pytest.raises(UnknownName, match=r"no language 'it'; available: en, fr; .*language.it\.toml"):
        language.words("it")


@each_row(
    ("halfway", "digits", "text"),
    [
        (46.75, 3, "46.8"),
        (223.5, 3, "224"),
        (0.0625, 2, "0.062"),
        (-1234.5, 4, "-1234"),
        (62.5e9, 2, "6.2e10"),
    ],
)
def test_a_number_halfway_between_two_is_printed_alike_whatever_its_last_bits(halfway, digits, text):
    for off in range(-100, 101):
        assert significant(halfway * (1 + off * 2.0**-52), digits) == text


def test_a_hyphen_before_a_number_is_printed_as_a_minus_sign_and_no_other_is():
    told = "a -3.5 mm, (-.5), 7 - 6 = 1, Q - 1, 4-bar 1-3 x-1 1e-06 --n 2, - a, $-3 - 1$"
    with_minus = "a −3.5 mm, (−.5), 7 − 6 = 1, Q − 1, 4-bar 1-3 x-1 1e-06 --n 2, - a, $-3 - 1$"
    assert with_minus_signs(told) == with_minus


def test_words_kept_from_an_earlier_run_give_way_to_a_changed_file(spanish, monkeypatch):
    """The file is read once while it stays as it is, and again when it has changed."""
    monkeypatch.setattr(cache, "_SETTLED", -(10**12))

    def title():
        language.words.cache_clear()
        return language.words("es")["sheet"]["data"]

    first = title()
    with monkeypatch.context() as patch:
        patch.setattr(language, "_read", None)
        assert title() == first
    spanish.write_text(spanish.read_text("utf-8").replace(f'"{first}"', '"Datos"'), "utf-8")
    assert title() == "Datos"


def test_no_template_prints_a_method_of_the_words():
    """``words.sheet.keys`` is a method of the table, not its entry: ``words.sheet["keys"]``."""
    method = re.compile(
        r"\b(?:words|said\w*)(?:\.\w+)*\.(?:clear|copy|get|items|keys|pop|update|values)\b(?!\()"
    )
    found = {
        file.name: names
        for file in (Path(__file__).parents[2] / "templates").rglob("*.j2")
        if (names := method.findall(file.read_text("utf-8")))
    }
    assert found == {}
