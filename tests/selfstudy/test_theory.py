"""What has one answer whatever the numbers is theory: marked, and not asked again."""

from __future__ import annotations

import json

import numpy as np
import pytest
from study_words import BOTH, SAID
from sweeps import sampled

import coursework
from coursework.course.answer_keys import answer_keys
from coursework.rendering.renderer import renderer_of
from coursework.selfstudy.worked import theory, without_theory

COURSE = coursework.open_course()
every_exercise = pytest.mark.parametrize(
    "name", sampled(COURSE.names, {"ball_reducer", "slider_extras", "vocabulary"})
)


def same(one, other):
    return (
        bool(np.all(one == other))
        if isinstance(one, str)
        else bool(np.allclose(one, other, rtol=1e-9, atol=1e-9))
    )


@every_exercise
def test_what_a_fresh_variant_asks_differs_among_variants_and_what_it_leaves_out_does_not(name):
    """Over other variants than those by which it was found."""
    variants = COURSE[name].variants(range(100, 130))
    values = [v.solution() for v in variants]
    known = theory(COURSE[name])
    for part in variants[0].parts:
        if part.sort.is_open or not all(part.id in v.part_ids for v in variants):
            assert part.id not in known
            continue
        is_same = all(same(v[part.quantity], values[0][part.quantity]) for v in values)
        if part.id in known:
            assert is_same
        elif len(known) and not part.judge:
            assert not is_same
    assert without_theory(variants[0]).parts


def test_the_points_of_theory_are_those_that_a_fresh_variant_leaves_out():
    variant = COURSE["slider_extras"].variant(1)
    left_out = sum(p.points for p in variant.parts if p.id in theory(variant.exercise))
    assert 0 < left_out < sum(p.points for p in variant.parts)
    assert (
        sum(p.points for p in without_theory(variant).parts)
        == sum(p.points for p in variant.parts) - left_out
    )


@BOTH
def test_theory_is_marked_and_left_out_of_what_is_fresh(lang, here):
    session = coursework.study("ball_reducer", seed=1, lang=lang)
    known = theory(session.variant.exercise)
    book = json.loads(renderer_of(COURSE.folder).study(session.variant.study_sheet()))
    text = "\n".join("".join(c["source"]) for c in book["cells"])
    questions = text[text.index("**1.**") :]
    assert questions.count(f", {SAID[lang]['theory']}*") == len(known)
    again = session.fresh(1)
    assert not known & set(again.variant.part_ids)
    told = {p.id: "" for p in session.variant.parts}
    again.check(told)  # a notebook that asked them before still runs
    keys = answer_keys(again.variant.parts).values()
    cell = next(c for c in book["cells"] if "".join(c["source"]).startswith("again.check"))
    assert all(f'"{key}": ""' in "".join(cell["source"]) for key in keys)
