"""Nobody is paid for nothing: texts that answer nothing are read as nothing, in every part of every exercise
and of every kind."""

from __future__ import annotations

import json
from pathlib import Path

import course_of_every_kind
import numpy as np
import pytest
from sweeps import sampled, whole_course
from tables import each_row

import coursework
from coursework.authoring.check_guesses import MOST, best_guess
from coursework.authoring.check_report import CheckReport
from coursework.authoring.checks import check_guesses
from coursework.marking.answers import read
from coursework.model import Part

COURSE = coursework.open_course()
TEXTS = [
    text
    for texts in json.loads(
        (Path(__file__).parents[1] / "answers_of_nothing.json").read_text("utf-8")
    ).values()
    for text in texts
]


@pytest.fixture(scope="module")
def every_kind(tmp_path_factory):
    return coursework.open_course(
        course_of_every_kind.write_course(tmp_path_factory.mktemp("kinds") / "course")
    )


def asked(course):
    """Every part of a course that a machine marks, with a variant that asks it; parts that read alike
    once."""
    seen = set()
    for name in course.names:
        left = {part.id for part in course[name].judged_parts}
        for variant in course[name].variants(range(40), "en", ["all"]):
            for part in (p for p in variant.parts if p.id in left):
                left.remove(part.id)
                reference = variant.key.reference[part.quantity]
                shape = reference if part.sort.family == "graph" else np.shape(reference)
                alike = (part.kind, part.unit, part.variables, shape, part.choices and (name, part.id))
                if alike not in seen:
                    seen.add(alike)
                    yield name, variant, part
            if not left:
                break
        assert not left, f"{name}: no variant asks {left}"


def test_texts_that_answer_nothing_are_enough_and_differ():
    assert len(set(TEXTS)) == len(TEXTS) >= 400


@whole_course
def test_no_part_of_any_exercise_reads_what_answers_nothing(every_kind):
    """What is not read waits, and earns nothing; so this holds whatever the variant's right answer is."""
    found = [
        (name, part.id, text, reading.read_as)
        for course in (COURSE, every_kind)
        for name, variant, part in asked(course)
        for text in TEXTS
        if (reading := read(variant, part, text)).status == "read"
        and (part.kind, text) != ("wrench_pattern", "X")
    ]
    assert found == []  # a wrench's X is a component, and no cross


@each_row(
    ("part", "reference"),
    [
        (Part("g", kind="unnamed_graph"), "1-2 revolute, 2-3 revolute, 1-3 prismatic"),
        (Part("w", kind="wrench"), np.array([1.0, 2.0, 3.0])),
        (Part("t", kind="twist"), np.arange(6.0)),
        (Part("v", kind="vector"), np.arange(4.0)),
        (Part("m", kind="matrix"), np.eye(3)),
        (Part("d", kind="direction"), np.array([1.0, 0.0])),
        (Part("k", kind="complex", unit="V"), 1 + 2j),
        (Part("s", unit="mm/mm"), 2.0),
        (Part("T", unit="K"), 300.0),
    ],
)
def test_no_other_kind_reads_what_answers_nothing(part, reference):
    found = [
        (text, reading.read_as)
        for text in TEXTS
        if (reading := part.sort.read(text, part, course_of_every_kind.Asking(reference))).status == "read"
    ]
    assert found == []


@pytest.mark.parametrize("name", COURSE.names)
def test_a_sheet_of_such_texts_earns_nothing(name):
    """Each box holds another text; what a person marks waits."""
    variant = COURSE[name].variant(0)
    for start in range(0, len(TEXTS), 97):
        answers = {i: TEXTS[(start + 7 * n) % len(TEXTS)] for n, i in enumerate(variant.part_ids)}
        assert variant.grade(answers).points == 0


#: Exercises of counts and cases, of which guessing earns most.
COUNTED = tuple(
    name
    for name in COURSE.names
    if sum(
        p.points for p in COURSE[name].spec.parts if p.is_exact and not p.sort.is_open and not p.by_request
    )
    > MOST * sum(p.points for p in COURSE[name].spec.parts if not p.by_request)
)


@whole_course
def test_the_same_on_every_sheet_earns_half_at_most():
    assert len(COUNTED) > 5
    shares = {name: best_guess(COURSE[name].variants(range(1000, 1200))).share for name in COUNTED}
    assert {name: share for name, share in shares.items() if share > MOST} == {}


def test_what_is_right_on_every_sheet_earns_half_at_most():
    """An equation in symbols may be the same for all: with the best guesses, who copies it earns no more."""
    for name in COURSE.names:
        if not any(part.sort.family == "equation" for part in COURSE[name].spec.parts):
            continue
        drawn, rights = [*COURSE[name].variants(range(60))], {}
        for variant in drawn:
            for part in (p for p in variant.parts if p.sort.family == "equation"):
                rights.setdefault(part, set()).add(str(variant.key.reference[part.quantity]))
        same = sum(part.points for part, right in rights.items() if len(right) == 1)
        total = sum(p.points for v in drawn for p in v.parts) / len(drawn)
        assert best_guess(drawn).share + same / total <= MOST, name


@pytest.mark.parametrize("name", sampled(("planar_chain", "closed_chain", "vocabulary"), ("closed_chain",)))
def test_guesses_that_agree_with_each_other_earn_half_at_most(name):
    """The whole sheet of the best guess, marked: what follows from guesses counts."""
    variants = COURSE[name].variants(range(100))
    texts = best_guess(variants).texts
    marked = [v.grade({i: t for i, t in texts.items() if i in v.part_ids}) for v in variants]
    assert sum(m.points for m in marked) <= (MOST + 0.03) * sum(m.out_of for m in marked)


def test_an_exercise_that_a_guess_answers_is_told():
    report = CheckReport("one")
    variants = [
        v.asking([p for p in v.exercise.spec.parts if p.id == "gamma"])
        for v in COURSE["closed_chain"].variants(range(60))
    ]
    check_guesses(variants, report)
    assert len(report.failures) == 1
    assert "gamma = 1" in report.failures[0]
