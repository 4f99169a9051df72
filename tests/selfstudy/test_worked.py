"""Worked examples fade: whole, with blanks, bare; what is left is marked, and told apart from what is told."""

from __future__ import annotations

import re

import pytest

import coursework
from coursework.errors import UnknownName, WrongValue
from coursework.language.words import languages

NAME, PARTS = "four_bar_motion", ("theta3", "omega3")


@pytest.mark.parametrize("lang", languages())
def test_each_level_leaves_more_to_the_reader(lang):
    shown = [coursework.worked(NAME, seed=3, lang=lang, level=level) for level in range(5)]
    left = [len(one.left) for one in shown]
    assert left[0] == 0
    assert left == sorted(left)
    assert left[4] == len(shown[0].parts)
    assert len({str(one) for one in shown}) == 5


@pytest.mark.parametrize("level", [1, 2, 3, 4])
def test_what_is_left_is_not_told(level):
    shown = coursework.worked(NAME, seed=3, lang="en", level=level, parts=PARTS)
    text = "".join(piece for piece in shown.pieces if isinstance(piece, str))
    for line in shown.right:
        value = line.partition(r"\num{")[2].partition("}")[0]
        assert value
        assert value not in text
    whole = coursework.worked(NAME, seed=3, lang="en", parts=PARTS)
    assert all(line.partition(r"\num{")[2].partition("}")[0] in str(whole.pieces) for line in shown.right)


def test_only_the_steps_to_what_is_asked_are_told():
    text = str(coursework.worked(NAME, seed=3, lang="en", parts=("theta3",)).pieces)
    assert r"\theta_3" in text
    assert r"\alpha_3" not in text.partition("Solution")[2]


def test_what_is_put_into_the_blanks_is_marked():
    shown = coursework.worked(NAME, seed=3, lang="en", level=4, parts=PARTS)
    reference = coursework.open_course()[NAME].variant(3, "en").walk
    right = shown.check({"theta3": f"{reference['theta3']:.6g}"})
    assert "✓" in str(right)
    assert "omega3" not in str(right)
    assert "✗" in str(shown.check(omega3="1234"))
    with pytest.raises(UnknownName, match="omega3"):
        shown.check(omega33="3")


def test_what_is_none_is_refused():
    with pytest.raises(WrongValue, match="from 0, the whole, to 4, bare; found 7"):
        coursework.worked(NAME, level=7)
    with pytest.raises(UnknownName, match="theta33"):
        coursework.worked(NAME, parts=("theta33",))
    with pytest.raises(UnknownName, match="normal"):
        coursework.mistakes(NAME, "normal_terms")


@pytest.mark.parametrize("lang", languages())
def test_named_mistakes_are_told_in_the_exercise_s_words(lang):
    exercise = coursework.open_course()[NAME]
    names = list(exercise.solution.mistakes)
    shown = coursework.mistakes(NAME, *names, lang=lang)
    told = exercise.variant(0, lang).solution_text
    (lines,) = shown.pieces
    assert lines.splitlines() == ["- " + " ".join(told.sections[f"mistake {n}"].text.split()) for n in names]


@pytest.mark.parametrize("level", [0, 1, 2, 3])
def test_each_step_says_which_question_it_answers_and_bears_no_other_number(level):
    text = coursework.worked(NAME, seed=3, lang="en", level=level).pieces[-1]
    count = len(coursework.open_course()[NAME].variant(3).parts)
    assert [f"*Question {k}.*" in text for k in range(1, count + 1)] == [True] * count
    assert not re.search(r"\*\*\d+\.\*\*", text)
