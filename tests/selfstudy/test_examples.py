"""Worked examples with blanks: of another variant, fewer help at each level, marked as questions are."""

from __future__ import annotations

import re

import pytest
from study_words import BOTH, flat
from sweeps import sampled

import coursework
from coursework.errors import BadInput
from coursework.selfstudy.mastery import outings
from coursework.selfstudy.wording import unwrapped
from coursework.selfstudy.worked import LEVELS, unchanging

COURSE = coursework.open_course()
every_exercise = pytest.mark.parametrize(
    "name",
    sampled(COURSE.names, {"slotted_mechanism", "slider_crank_torque", "ball_reducer", "velocity_polygon"}),
)


def right_answers(variant):
    values = variant.solution()
    return {p.id: unwrapped(values[p.quantity]) for p in variant.parts}


@every_exercise
def test_each_level_leaves_more_to_fill_and_is_right_when_it_is_filled_rightly(name, here):
    session = coursework.study(name, seed=1, lang="en")
    counts, given = [], [session.variant.given]
    for level in range(1, LEVELS + 1):
        example = session.example(level)
        if not hasattr(example, "level"):
            assert all(p.judge or p.loop or p.id in unchanging(COURSE[name]) for p in session.variant.parts)
            return
        assert example.variant.given not in given
        given.append(example.variant.given)
        counts.append(len(example.variant.parts))
        said = str(example.check(right_answers(example.variant)))
        assert "✗" not in said
        assert said.count("- ✓") == counts[-1]
    assert counts == sorted(counts)
    assert counts[0] == 1
    assert session.fresh(1).variant.given not in given


@every_exercise
def test_no_blank_holds_its_value_and_nothing_tells_what_every_variant_shares(name, here):
    session = coursework.study(name, seed=2, lang="en")
    for level in range(1, LEVELS + 1):
        example = session.example(level)
        if not hasattr(example, "level"):
            return
        text = flat(example)
        values = example.variant.solution()
        left = {part.quantity for part in example.variant.parts}
        # What is given, and what another quantity is as well: a reaction that is equal to the one before it.
        numbers = (
            v for q, v in example._full_sheet.walk.items() if q not in left and isinstance(v, (int, float))
        )
        given = {f"{abs(v):.4g}" for v in numbers}
        for part in example.variant.parts:
            value = values[part.quantity]
            if part.kind == "number" and abs(value) > 10 and value != round(value):
                told = f"{abs(value):.4g}"
                assert told in given or not re.search(rf"(?<![\d.]){re.escape(told)}", text), (part.id, level)


@BOTH
def test_a_theory_question_is_not_told_by_an_example(lang, here):
    session = coursework.study("havens_planetary", seed=1, lang=lang)
    text = flat(session.example(1))
    for part in session.variant.parts:
        if part.choices and part.id in unchanging(session.variant.exercise):
            label = flat(session.variant.label(part.id, session.variant.reference(part.quantity)))
            assert label not in text


@pytest.mark.parametrize("lang", sampled(["fr", "en"], ["fr"]))
def test_examples_go_on_by_themselves_and_count_for_nothing(lang, here):
    session = coursework.study("slotted_mechanism", seed=1, lang=lang)
    levels = [session.example().level for _ in range(LEVELS + 1)]
    assert levels == [1, 2, 3, 4, 4]
    example = session.example(2)
    example.check(right_answers(example.variant))
    assert not outings(session._store.progress)
    assert 'example.reveal("alpha4")' in example.hint("alpha4", 9).markdown
    assert session.fresh().variant.seed == session.fresh(1).variant.seed
    for level in (0, 5, "2", True):
        with pytest.raises(BadInput, match="4"):
            session.example(level)


def test_a_blank_goes_by_the_number_of_its_question(here):
    example = coursework.study("slotted_mechanism", seed=1, lang="en").example(2)
    by_number = {p.id: f"q{k}" for k, p in enumerate(example._full_sheet.parts, start=1)}
    assert f"`{by_number['a_coriolis']}`" in example.statement().markdown
    value = example.variant.solution()["a_coriolis"]
    number = int(by_number["a_coriolis"][1:])
    for told in (by_number["a_coriolis"], number, f"question {number}"):
        assert f"- ✓ {number}." in str(example.check({told: f"{value:.6g}"}))
