"""Worked examples fade: whole, with blanks, bare; what is left is marked, and told apart from what is
told."""

from __future__ import annotations

import re

import pytest
from sweeps import sampled
from tables import each_row

import coursework
from coursework.authoring.check_alone import asked_alone
from coursework.errors import UnknownName, WrongValue
from coursework.language.words import languages, words
from coursework.selfstudy.worked import has_example

NAME, PARTS = "four_bar_motion", ("theta3", "omega3")


@each_row("lang", languages())
def test_each_level_leaves_more_to_the_reader(lang):
    shown = [coursework.worked(NAME, seed=3, lang=lang, level=level) for level in range(5)]
    left = [len(one.left) for one in shown]
    assert left[0] == 0
    assert left == sorted(left)
    assert left[4] == len(shown[0].parts)
    assert len({str(one) for one in shown}) == 5


@each_row("level", [1, 2, 3, 4])
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


def test_what_a_formula_is_stated_with_is_told_before_it():
    told = coursework.worked("slider_crank", seed=2, lang="en", parts=("omega3",)).pieces[-1]
    assert told.index(r"\theta_3 &= \arcsin") < told.index(r"\omega_3 &=")


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
    with pytest.raises(WrongValue, match=r"from 0 \(complete\) to 4 \(no steps\); found 7"):
        coursework.worked(NAME, level=7)
    with pytest.raises(UnknownName, match="theta33"):
        coursework.worked(NAME, parts=("theta33",))
    with pytest.raises(UnknownName, match="normal"):
        coursework.mistakes(NAME, "normal_terms")


@each_row("lang", languages())
def test_named_mistakes_are_told_in_the_exercise_s_words(lang):
    exercise = coursework.open_course()[NAME]
    names = list(exercise.solution.mistakes)
    shown = coursework.mistakes(NAME, *names, lang=lang)
    told = exercise.variant(0, lang).solution_text
    (lines,) = shown.pieces
    assert lines.splitlines() == ["- " + " ".join(told.sections[f"mistake {n}"].text.split()) for n in names]


@each_row("lang", languages())
def test_a_question_names_its_symbol_once(lang):
    shown = coursework.worked(
        "four_bar_positions", seed=5, lang=lang, level=4, parts=("a", "theta3_open", "mu")
    )
    asked = shown.pieces[-1].splitlines()
    for line, symbol, unit in zip(
        asked, ("$a$", r"$\theta_3^{(1)}$", r"$\mu$"), ("mm²", "°", "°"), strict=True
    ):
        assert line.replace(" ", "").count(symbol) == 1
        assert f"({unit})" in line


@each_row("lang", languages())
def test_choices_are_lettered_as_their_answer_is(lang):
    bare = coursework.worked("grashof", seed=1, lang=lang, level=4, parts=("linkage_type",))
    letter = bare.right[0].rpartition("**")[0].rpartition("**")[2].partition(" ")[0]
    assert f"\n   {letter} " in bare.pieces[-1]  # the letter marks the line: no bullet before it
    half = coursework.worked("grashof", seed=5, lang=lang, level=2)
    assert "linkage" not in half.pieces[-1].rpartition("=")[0].rpartition("\n")[2]
    assert words(lang)["lesson"]["unnamed"].format(question="*Question 3.*") in half.pieces[-1]


def test_a_step_that_only_announces_a_hidden_value_is_left_out():
    told = str(coursework.worked("complex_chain", seed=10, lang="en", level=3).pieces)
    assert "The input is on this body" not in told


def left_at(name, level, **named):
    return [part.id for part in coursework.worked(name, seed=2, lang="en", level=level, **named).left]


def test_what_is_judged_together_is_left_together():
    drawn = ["kv", "p", "a", "b", "ab", "pv_b", "v_B", "omega3", "omega4"]
    assert left_at("velocity_polygon", 1) == drawn
    assert left_at("velocity_polygon", 2) == drawn
    more = left_at("velocity_polygon", 3)
    assert more[-len(drawn) :] == drawn
    assert len(more) > len(drawn)
    assert left_at("velocity_polygon", 1, parts=("omega4", "known_B")) == drawn


@each_row("lang", languages())
def test_a_drawing_that_is_left_is_marked_as_one(lang):
    shown = coursework.worked("velocity_polygon", seed=2, lang=lang, level=1)
    values = shown.variant.solution()
    right = {
        p.id: values[p.quantity].tolist() if p.kind == "point" else values[p.quantity] for p in shown.left
    }
    assert str(shown.check(right)).count("✓") == len(right) == 9
    right["b"] = [-right["b"][1], right["b"][0]]
    assert "✗" in str(shown.check(right))


def test_what_every_variant_shares_is_left_in_a_lesson_and_not_in_a_study_session():
    asked = coursework.open_course()["vocabulary"].variant(2, "en").part_ids
    for level, count in ((1, 1), (2, -(-len(asked) // 3)), (3, -(-2 * len(asked) // 3))):
        assert left_at("vocabulary", level) == list(asked[-count:])
    assert not has_example(coursework.open_course()["vocabulary"].variant(2, "en"))


@each_row("lang", languages())
def test_a_choice_that_is_left_stands_by_its_question_and_the_others_are_told(lang):
    shown = coursework.worked("vocabulary", seed=2, lang=lang, level=1)
    (left,) = shown.left
    *told, blank = shown.pieces[-1].split("\n\n")
    room = words(lang)["lesson"]["unnamed"].format(question=f"*Question {len(shown.parts)}.*")
    assert blank == room
    for part, text in zip(shown.parts, told[-len(shown.parts) + 1 :], strict=False):
        assert f"**{shown.variant.label(part.id, shown.variant.reference(part.quantity))}**" in text
    assert shown.variant.label(left.id, shown.variant.reference(left.quantity)) not in blank


def test_the_equations_of_a_loop_are_left_together_and_may_be_asked_for_by_name():
    shown = coursework.worked(
        "slider_crank", seed=2, lang="en", level=1, parts=("theta3", "loop_1_x", "loop_1_y")
    )
    assert [part.id for part in shown.left] == ["loop_1_x", "loop_1_y"]
    right = {
        "loop_1_x": "r2*cos(theta2) + r3*cos(theta3) = r1",
        "loop_1_y": "r2*sin(theta2) + r3*sin(theta3) = e",
    }
    assert re.findall(r"✓ (\w+) — Question (\d)", str(shown.check(right))) == [("q2", "2"), ("q3", "3")]
    assert "≈" in str(shown.check({**right, "loop_1_y": "r2*sin(theta2) - r3*sin(theta3) = e"}))


every_exercise = pytest.mark.parametrize(
    "name",
    sampled(coursework.open_course().names, {"four_bar_torque", "grashof", "velocity_polygon", "vocabulary"}),
)


@every_exercise
@pytest.mark.parametrize("lang", languages())
def test_every_exercise_has_an_example_of_every_level(name, lang):
    shown = [coursework.worked(name, seed=1, lang=lang, level=level) for level in range(5)]
    left = [len(one.left) for one in shown]
    questions = {part.judge or part.loop or part.id for part in shown[0].parts if not part.sort.is_open}
    assert left[0] == 0
    assert left[1:] == sorted(left[1:])
    assert left[1] > 0
    assert left[3] <= left[4] == len(shown[0].parts)
    for level, count in ((1, 1), (2, -(-len(questions) // 3)), (3, -(-2 * len(questions) // 3))):
        assert len({part.judge or part.loop or part.id for part in shown[level].left}) == count


@every_exercise
@pytest.mark.parametrize("lang", languages())
def test_each_question_alone_is_a_worked_example_of_every_level(name, lang):
    for parts in asked_alone(coursework.open_course()[name]):
        if parts[0].id not in coursework.open_course()[name].variant(1, lang, [parts[0].id]).part_ids:
            continue
        if parts[0].sort.is_open:
            continue  # it has a model answer, and no blank
        for level in range(5) if lang == "en" else (2,):
            shown = coursework.worked(name, seed=1, lang=lang, level=level, parts=(parts[0].id,))
            assert [part.id for part in shown.parts] == [part.id for part in parts]
            assert len(shown.right) == len(shown.left) == (len(parts) if level else 0)
            assert shown.pieces[-1] or level == 4
