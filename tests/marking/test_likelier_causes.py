"""What is told of a wrong answer is the likelier cause: found from the whole sheet where one error shows in
several boxes."""

from __future__ import annotations

import math
import sys
from itertools import combinations

import numpy as np
import pytest
from sweeps import seeds, whole_course

import coursework
from coursework import degrees
from coursework.course.exercise import ALL
from coursework.errors import CourseworkError
from coursework.issuing.issuing import distinct_variants
from coursework.language.numbers import significant
from coursework.quantities.error_kinds import PENALTIES

COURSE = coursework.open_course()


def measured(variant):
    """The numbers of a variant that are judged each for itself."""
    return [p for p in variant.parts if p.sort.is_number and not p.judge]


def with_angles(name):
    spec = COURSE[name].spec
    return any(g.unit == "deg" for g in spec.given.values()) and any(
        p.sort.is_number and not p.judge for p in spec.parts
    )


NUMERIC = [n for n in COURSE.names if any(p.sort.is_number and not p.judge for p in COURSE[n].spec.parts)]
WITH_ANGLES = [n for n in COURSE.names if with_angles(n)]


# --------------------------------------------------------------- a calculator in radians


TAKING = {
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "polar": lambda length, theta: length * np.exp(1j * np.asarray(theta)),
}
GIVING = {
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "atan2": np.arctan2,
    "angle": np.angle,
    "from_radians": lambda theta: theta,
}


#: Roots that are approached step by step: in radians they lead anywhere.
APPROACHED = {"theta_rise", "theta_fall"}


def worked_in_radians(variant, monkeypatch, *, converts):
    """The answers of a student whose calculator is in radians: each step from the ones that were written, to
    five digits.

    Within the solutions functions of degrees are exchanged for those of radians; who ``converts`` writes the
    angles that come out in degrees, and types them so.
    """
    functions = TAKING if converts else TAKING | GIVING
    known = {getattr(degrees, name): function for name, function in functions.items()}
    graph = variant.exercise.solution.graph.textbook
    quantities = {p.quantity: p for p in measured(variant)}
    values, answers = dict(variant.used), {}
    with monkeypatch.context() as patch:
        homes = {f.__module__ for f in (graph.node(n).function for n in graph.names)}
        for module in [sys.modules[n] for n in homes if "solutions" in n.split(".")]:
            for name, value in list(vars(module).items()):
                if callable(value) and value in known:
                    patch.setattr(module, name, known[value])
        for quantity, part in quantities.items():
            try:
                value = graph.evaluate((quantity,), values, variant.effects)[quantity]
            except CourseworkError:
                continue  # the calculator says error
            if isinstance(value, complex) or not np.isfinite(value):
                continue
            if not value or quantity in APPROACHED:
                continue  # from nought nothing follows
            answers[part.id] = significant(float(value), 5)
            values[quantity] = float(answers[part.id])
    return answers


@pytest.mark.parametrize("converts", [False, True], ids=["as they come", "converted"])
@pytest.mark.parametrize("name", WITH_ANGLES)
def test_a_calculator_in_radians_throughout_costs_one_question(name, converts, monkeypatch):
    for variant in distinct_variants(COURSE[name], 0, 4, "en"):
        answers = worked_in_radians(variant, monkeypatch, converts=converts)
        marking = variant.grade(answers)
        lost = [i for i in answers if marking[i].points < marking[i].out_of]
        assert len(lost) <= 1, [(i, answers[i], marking[i].verdict, marking[i].feedback) for i in lost]


@whole_course
@seeds(1, 12)
def test_angles_told_in_radians_are_named_once_and_paid_once(seeds):
    """Each angle alone amid right answers, in whichever kind of part it is asked, then all of a sheet: the
    first pays."""
    missed, tried = [], 0
    for variant in (
        v
        for n in COURSE.names
        for v in distinct_variants(COURSE[n], seeds[0], len(seeds), "en", parts=(ALL,))
    ):
        reference = variant.key.reference
        right = {p.id: reference[p.quantity] for p in variant.parts if not p.sort.is_open}
        angles = {p.id: p.quantity for p in variant.parts if p.unit == "deg" and p.sort.is_number}
        told = {i: significant(math.radians(reference[q]), 4) for i, q in angles.items()}
        told = {
            i: text for i, text in told.items() if variant.grade({**right, i: text})[i].verdict != "correct"
        }
        for answers in (told, *({i: text} for i, text in told.items() if len(told) > 1)):
            if not answers:
                continue
            marking = variant.grade({**right, **answers})
            said = [(marking[i].verdict, marking[i].points / marking[i].out_of) for i in answers]
            paid = [("slip:radians", PENALTIES["radians"]), *[("follow_through", 1.0)] * (len(answers) - 1)]
            others = {
                i: m.verdict
                for i, m in marking.items()
                if i in right and i not in answers and m.verdict != "correct"
            }
            tried += 1
            missed += [(variant.exercise.name, variant.seed, answers, said, others)] * (
                said != paid[: len(said)] or bool(others)
            )
    assert tried > 60
    assert not missed, missed


# ----------------------------------------------------------------------- exchanged boxes


@whole_course
@seeds(1, 6)
def test_two_exchanged_boxes_are_found_and_counted_once(seeds):
    """In any pair of boxes of numbers, read off a drawing or not, all other answers right: the first pays,
    the second and what follows do not. Save where another cause explains both, in one pair of ten at most. A
    scale may be any, for another drawing."""
    tried, missed, wrong = 0, [], []
    for name in COURSE.names:
        for variant in distinct_variants(COURSE[name], seeds[0] + 3, len(seeds), "en"):
            if COURSE[name].spec.either_order:
                continue  # there an exchange may be right
            numbers = [p for p in variant.parts if p.sort.is_number and not p.unit.endswith("/mm")]
            right = {p.id: significant(float(variant.key.reference[p.quantity]), 5) for p in numbers}
            points = {
                p.id: variant.key.reference[p.quantity]
                for p in variant.parts
                if p.judge and p.id not in right
            }
            pairs = list(combinations(numbers, 2))
            for one, other in pairs[:: max(1, len(pairs) // 8)]:
                swapped = {one.id: right[other.id], other.id: right[one.id]}
                marking = variant.grade({**right, **points, **swapped})
                marks = [marking[i] for i in swapped]
                said = [(mark.verdict, mark.points / mark.out_of) for mark in marks]
                if any(mark.verdict == "correct" for mark in marks):
                    continue  # the two values are alike
                tried += 1
                if said != [("slip:exchanged", PENALTIES["exchanged"]), ("follow_through", 1.0)]:
                    missed.append((name, one.id, other.id, said))
                    wrong += missed[-1:] * ({mark.verdict for mark in marks} == {"wrong"})
                others = {marking[i].verdict for i in {**right, **points}.keys() - swapped.keys()}
                wrong += [(name, swapped, others)] * (not others <= {"correct"})
    assert not wrong, wrong
    assert len(missed) < 0.1 * tried, missed


def test_an_exchange_is_found_whatever_units_are_written():
    (variant,) = distinct_variants(COURSE["slotted_mechanism"], 0, 1, "en")
    right = variant.solution()
    marking = variant.grade(
        {"rA_dot": f"{right['omega4']:.5g} rad/s", "omega4": f"{right['rA_dot']:.5g} mm/s"}
    )
    assert {marking[i].verdict for i in ("rA_dot", "omega4")} == {"slip:exchanged", "follow_through"}
    assert "exchanged" in marking["omega4"].feedback


def test_an_exchange_that_a_judge_names_is_counted_once_and_told_in_its_words():
    variant = COURSE["function_generation"].variant(0, lang="en")
    right = {i: significant(float(variant.key.reference[i]), 5) for i in ("r2", "r3", "r4")}
    marking = variant.grade({**right, "r2": right["r4"], "r4": right["r2"]})
    assert [marking[i].verdict for i in right] == ["slip:exchanged", "correct", "follow_through"]
    assert "which ratio belongs to which angle?" in marking["r2"].feedback
    # Other answers that are near an exchange.
    by_chance = COURSE["function_generation"].variant(18, lang="en")
    key, name = by_chance.key, "ratios_upside_down"
    answers = {"r2": key.wrong[name]["r2"], "r3": key.reference["r3"], "r4": key.wrong[name]["r4"]}
    marking = by_chance.grade({i: significant(float(value), 6) for i, value in answers.items()})
    assert marking["r2"].mistakes == (name,)


def test_wrong_counts_are_no_exchange_where_others_are_wrong():
    (variant,) = distinct_variants(COURSE["planar_chain"], 0, 1, "en")
    right = {p.id: int(variant.key.reference[p.quantity]) for p in variant.parts if p.kind == "integer"}
    one, other = next((a, b) for a, b in combinations(right, 2) if right[a] != right[b])
    swapped = {**right, one: right[other], other: right[one]}
    assert {variant.grade(swapped)[i].verdict for i in (one, other)} == {"slip:exchanged", "follow_through"}
    third = next(i for i in right if i not in (one, other))
    marking = variant.grade({**swapped, third: right[third] + 1})
    assert "slip:exchanged" not in {marking[i].verdict for i in (one, other)}


# ------------------------------------------------------------------------ the likelier cause


@pytest.mark.parametrize("name", NUMERIC)
def test_an_opposite_sign_is_told_as_such_or_as_a_mistake_about_this_very_quantity(name):
    """Each number alone on its sheet: nothing that was made elsewhere goes before its sign."""
    for variant in distinct_variants(COURSE[name], 0, 3, "en"):
        for part in measured(variant):
            value = variant.key.reference[part.quantity]
            mark = variant.grade({part.id: significant(-value, 5)})[part.id]
            kind, _, mistake = mark.verdict.partition(":")
            is_here = (
                kind == "mistake" and part.quantity in variant.exercise.solution.mistakes[mistake].targets
            )
            assert mark.verdict in ("slip:sign", "correct", "slip:other_case") or is_here, (part.id, mark)


def test_a_case_is_not_told_of_an_error_that_the_right_answer_above_it_disproves():
    """Of few cases any error gives one: who has the degree of indeterminacy right did not err before it."""
    variant = COURSE["closed_chain"].variant(3, "en")
    wrong = variant.key.wrong["unknowns_exchanged"]
    answers = {p.id: str(variant.key.reference[p.quantity]) for p in variant.parts}
    marking = variant.grade({**answers, "m": str(wrong["m"]), "statics": wrong["statics"]})
    assert "mistake:unknowns_exchanged" in marking["m"].matches
    assert marking["statics"].verdict == "wrong"
