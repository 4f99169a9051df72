"""Every message for instructors and students is a template that stands in the French catalogue with the same places."""

import ast
import pickle
import string
import tomllib
from collections import Counter
from pathlib import Path

import pytest

import coursework
from coursework.errors import BadInput, UnknownName, counted, unknown
from coursework.language.words import languages
from coursework.messages import CATALOGUES, Message, as_message, localised, messages_in, translations

PACKAGE = Path(coursework.__file__).resolve().parent

#: What takes a template first, and is read by those who use the product; errors in the code of a course stay English.
FOR_USERS = {
    "BadInput",
    "Message",
    "UnplacedError",
    "Lost",
    "NotAtHand",
    "NotServed",
    "NoSolution",
    "say",
    "warn",
}


def calls():
    for path in sorted(PACKAGE.rglob("*.py")):
        if path.name in ("messages.py", "errors.py"):
            continue
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") in FOR_USERS and node.args:
                first = node.args[0]
                for template in (first.body, first.orelse) if isinstance(first, ast.IfExp) else (first,):
                    yield f"{path.relative_to(PACKAGE)}:{template.lineno}", template, node.keywords


def places(template):
    return sorted({field for _, field, _, _ in string.Formatter().parse(template) if field})


@pytest.mark.parametrize("lang", [lang for lang in languages() if lang != "en"])
def test_each_message_has_a_translation_with_the_same_places(lang):
    known = translations(lang)

    def fault(first, keywords):
        if not isinstance(first, ast.Constant):
            # A message passed on whole, a variable, or a text of words in the reader's language: never one put together on the spot.
            return (
                None
                if isinstance(first, ast.Name | ast.Call | ast.Attribute | ast.Subscript)
                else "put together, not a template"
            )
        template, given = first.value, sorted(word.arg or "**" for word in keywords)
        if template not in known:
            return f"not translated: {template!r}"
        if "**" not in given and given and places(template) != given:
            return f"places {places(template)}, values {given}"
        return None

    found = {place: why for place, *call in calls() if (why := fault(*call))}
    assert found == {}


@pytest.mark.parametrize("lang", [lang for lang in languages() if lang != "en"])
def test_each_translation_has_the_places_of_its_template(lang):
    tables = tomllib.loads((CATALOGUES / f"{lang}.toml").read_text("utf-8"))
    twice = Counter(template for table in tables.values() for template in table)
    assert [template for template, count in twice.items() if count > 1] == []
    pairs = translations(lang).items()
    assert {template: text for template, text in pairs if places(text) != places(template)} == {}


def test_a_message_is_printed_in_the_language_of_its_reader():
    error = unknown("exercise", "cranck", ["crank"], where="exam.toml")
    assert str(error) == "no exercise 'cranck' in exam.toml; did you mean 'crank'?"
    with messages_in("fr"):
        assert str(error).replace("\u202f", " ") == (
            "aucun exercice « cranck » dans exam.toml ; vouliez-vous dire « crank » ?"
        )
    assert str(error).startswith("no exercise")
    assert isinstance(error, UnknownName)


def test_values_that_are_messages_are_translated_with_the_whole():
    error = BadInput("{cells} where the header has {most}", cells=counted(3, "cell"), most=5)
    assert str(error) == "3 cells where the header has 5"
    assert localised(pickle.loads(pickle.dumps(error)), "fr").startswith("3 cellules")
    assert localised(as_message(error).replacing("5", "7"), "en") == "3 cells where the header has 7"


def test_a_text_without_values_keeps_its_braces():
    assert str(BadInput("write {a} as it is")) == "write {a} as it is"
    assert Message("100 % {") == "100 % {"
