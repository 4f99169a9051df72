"""No name that a student reads tells an answer: choices have letters, and what they are written under is a
symbol or a number."""

from __future__ import annotations

import ast
import json
import re

import pytest
from sweeps import HANDFUL, sampled

import coursework
from coursework.course.answer_keys import answer_keys, part_called, spells_a_symbol
from coursework.language.words import words
from coursework.model import Part
from coursework.rendering.renderer import renderer_of
from coursework.selfstudy.predictions import prediction_keys

COURSE = coursework.open_course()
FRENCH = pytest.mark.parametrize("lang", sampled(["fr", "en"], ["fr"]))  #: English as well in the long run
REGISTRY = pytest.mark.parametrize("name", sampled(COURSE.names, {*HANDFUL, "vocabulary"}))


def notebooks(name, lang, seed=3):
    variant, renderer = COURSE[name].variant(seed, lang), renderer_of(COURSE.folder)
    for text in (renderer.notebook(variant.handout()), renderer.study(variant.study_sheet())):
        yield variant, ["".join(cell["source"]) for cell in json.loads(text)["cells"]]


def told_as_code(text):
    """What a text shows as code, and the texts of its Python."""
    return {*re.findall(r"`([^`\n]+)`", text), *re.findall(r'"([^"\n]*)"', text)}


@REGISTRY
@FRENCH
def test_a_notebook_shows_no_name_of_a_choice_and_no_name_of_a_case(name, lang):
    for variant, cells in notebooks(name, lang):
        shown = set().union(*map(told_as_code, cells))
        for part in variant.parts:
            if part.choices:
                assert part.id not in shown
                assert shown.isdisjoint(
                    c for c in part.choices if len(c) > 1 and c != variant.label(part.id, c)
                )


@REGISTRY
@FRENCH
def test_what_a_session_says_shows_none_either(name, lang, here):
    session = coursework.study(name, seed=3, lang=lang)
    wrong = {p.id: "a" if p.choices else "7" for p in session.variant.parts}
    said = [
        session.check(wrong),
        session.statement(),
        session.hint(),
        session.reveal(),
        session.predict(),
        session.plot(),
    ]
    said += [session.hint(part.id) for part in session.variant.parts]
    shown = set().union(*(told_as_code(one.markdown) for one in said))
    for part in session.variant.parts:
        key = answer_keys(session.variant.parts)[part.id]
        assert key in shown
        assert part.id == key or part.id not in shown
        assert shown.isdisjoint(c for c in part.choices if len(c) > 1)


@pytest.mark.parametrize("name", COURSE.names)
def test_a_key_is_a_symbol_or_a_number_the_same_in_every_language(name):
    for seed in range(4):
        parts = COURSE[name].variant(seed, "fr").parts
        keys = answer_keys(parts)
        assert keys == answer_keys(COURSE[name].variant(seed, "en").parts)
        assert len(set(keys.values())) == len(parts)
        for number, part in enumerate(parts, start=1):
            key = keys[part.id]
            assert key == f"q{number}" if part.choices else key in (f"q{number}", part.id)
            assert key != part.id or spells_a_symbol(part.id)
            ids = tuple(p.id for p in parts)
            assert part_called(key, ids) == part_called(part.id, ids) == part.id


def test_what_spells_a_symbol():
    symbols = ("theta4", "rA_dot", "a_BA_t", "omega3", "Nc", "kv", "x8_ddot", "Gamma_s", "Q")
    assert all(map(spells_a_symbol, symbols))
    words_ = ("highest_group", "stroke", "t_return", "m_useful", "known_A", "mobility", "direction")
    assert not any(map(spells_a_symbol, words_))


def test_a_choice_goes_by_its_number_whatever_it_is_called():
    parts = (
        Part("theta4", kind="angle"),
        Part("n", kind="choice", choices=("n1", "n2")),
        Part("q3", unit="mm"),
        Part("stroke"),
    )
    assert list(answer_keys(parts).values()) == ["theta4", "q2", "q3", "q4"]
    taken = (Part("stroke"), Part("q1", unit="mm"))
    keys = answer_keys(taken)
    assert list(keys.values()) == ["question_1", "q1"]
    assert [part_called(key, ("stroke", "q1")) for key in keys.values()] == ["stroke", "q1"]


def test_a_name_that_is_none_stays_what_it_is():
    assert [part_called(told, ("a", "b")) for told in ("q1", "Q2", "question_2", "q3", "q0", "c", "")] == [
        "a",
        "b",
        "b",
        "q3",
        "q0",
        "c",
        "",
    ]
    assert part_called("q1", ("b", "q1")) == "q1"


@REGISTRY
@FRENCH
def test_every_question_says_what_its_answer_is_written_under_and_every_key_its_question(name, lang):
    """Statement and answers are tied both ways, in the notebook to hand in as in that for study."""
    for variant, cells in notebooks(name, lang):
        keys = answer_keys(variant.parts)
        statement = "\n".join(c for c in cells if f"## {words(lang)['sheet']['questions']}" in c)
        answers = next(c for c in cells if re.search("^answers = ", c, re.M))
        for number, key in enumerate(keys.values(), start=1):
            assert f"**{number}.** `{key}` — " in statement
            line = next(line for line in answers.split("\n") if line.startswith(f'    "{key}": "'))
            if key != f"q{number}" and '"""' not in line:
                assert f"# question {number}" in line
        (one,) = ast.parse(answers).body
        assert [k for k in ast.literal_eval(one.value) if k != "student"] == list(keys.values())


@pytest.mark.parametrize("name", COURSE.names)
def test_a_prediction_is_written_as_the_answer_to_its_question_or_under_a_number(name):
    variant = COURSE[name].variant(2, "fr")
    keys = prediction_keys(variant)
    assert len(set(keys.values())) == len(keys)
    for asked, key in keys.items():
        assert key == answer_keys(variant.parts).get(asked) or re.fullmatch("p[1-9]", key)


def test_both_names_of_a_question_are_read(here):
    session = coursework.study("vocabulary", seed=0, lang="en")
    first = session.variant.parts[0]
    session.check({"q1": "b"})
    assert session.answers == {first.id: "b"}
    session.check({first.id: "c"})
    assert session.answers == {first.id: "c"}
    assert "`q1`" in session.check({}).markdown
