"""Draws are fair to all: each is out of the same points, and no question that all are asked has one answer
for all."""

import json
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.errors import BadCourse
from coursework.model import Part, in_turn

COURSE = coursework.open_course()
#: For each version before the present one whose records have other parts: one of them.
RECORDS = json.loads(Path(__file__).with_name("records_of_older_versions.json").read_text("utf-8"))
SEEDS = range(24)


@pytest.mark.parametrize("name", COURSE.names)
def test_every_draw_is_out_of_the_same_points_and_tells_no_answer_of_another(name):
    variants = COURSE[name].variants(SEEDS, "en")
    assert len({sum(part.points for part in variant.parts) for variant in variants}) == 1
    asked = Counter(part.id for variant in variants for part in variant.parts)
    for part in COURSE[name].spec.parts:
        # An equation is derived, and written in symbols; a drawing has its pole anywhere.
        if asked[part.id] < len(SEEDS) or part.sort.is_open or part.variables or part.judge:
            continue
        right = {np.array2string(np.asarray(v.reference(part.quantity)), precision=6) for v in variants}
        assert len(right) > 1, f"{part.id} is asked of everybody, and {right} is always right"


@pytest.mark.parametrize("name", COURSE.names)
def test_choices_are_shuffled_unless_their_order_says_something(name):
    variants = COURSE[name].variants(SEEDS, "en")
    for part in COURSE[name].spec.parts:
        places = {
            v.cases(part).index(v.reference(part.quantity))
            for v in variants
            if part in v.parts and part.choices
        }
        if len(places) == 1:
            asked = [v for v in variants if part in v.parts]
            assert len(asked) < 4 or len({v.reference(part.quantity) for v in asked}) > 1, part.id


@each_row("record", RECORDS)
def test_what_was_issued_before_asks_and_marks_what_it_lists(record):
    exercise = COURSE[record["exercise"]]
    variant = exercise.from_record(record)
    assert record["version"] < exercise.version
    assert variant.record == record
    assert list(variant.part_ids) == [part["id"] for part in record["parts"]]
    given = {p.id: written(variant, p) for p in variant.parts if not p.sort.is_open}
    marking = variant.grade(given)
    assert {i: m.verdict for i, m in marking.items() if m.points < m.out_of and i in given} == {}


def written(variant, part):
    """The right answer as a student writes it."""
    right = variant.reference(part.quantity)
    if part.choices:
        return variant.letters(part)[right]
    return "; ".join(f"{x:.9g}" for x in right) if isinstance(right, np.ndarray) and right.ndim else right


def test_groups_in_turn_are_worth_the_same():
    with pytest.raises(BadCourse, match="found a 1, b 2 points"):
        in_turn(1, ("x",), Part("a"), (Part("b"), Part("c")))
