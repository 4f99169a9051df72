"""On the way to every hard place of every exercise the solver errs by no more than the last digits of the
data explain.

The places are found from the formulas (:mod:`coursework.accuracy.hard_places`), the right values have a
hundred digits, and what is unavoidable is the condition number times the last digit: an error may be eight
times that.
"""

from __future__ import annotations

import pytest
from approaches import misses, misses_near
from sweeps import sampled, slow, whole_course

import coursework
from coursework.accuracy.hard_places import growing_places, hard_places
from coursework.accuracy.reference import Reference
from coursework.accuracy.subject import numbers_of

COURSE = coursework.open_course()
NUMERIC = [name for name in COURSE.names if numbers_of(COURSE[name])]
QUICK = (1e-2, 1e-4, 1e-6, 1e-8)


def lost(name, **how):
    return [miss.told() for miss in misses(COURSE[name], numbers_of(COURSE[name]), **how)]


@pytest.mark.parametrize("name", sampled(NUMERIC, ("slotted_mechanism", "velocity_polygon")))
def test_no_digit_is_lost_on_the_way_to_the_hardest_places(name):
    assert not lost(name, distances=QUICK, most=2)


@slow
@pytest.mark.parametrize("name", NUMERIC)
def test_no_digit_is_lost_on_the_way_to_any_hard_place(name):
    assert not lost(name, most=4)


def test_every_asked_number_has_a_reference_in_many_digits():
    """What has none is measured nowhere, and would be told as kept."""
    lacking = {name: Reference(COURSE[name], numbers_of(COURSE[name])).lacking for name in NUMERIC}
    assert {name: names for name, names in lacking.items() if names} == {}


@whole_course
def test_no_digit_is_lost_beside_a_length_far_larger_than_the_rest():
    found = []
    for name in NUMERIC:
        reference = Reference(COURSE[name], numbers_of(COURSE[name]))
        for place in growing_places(COURSE[name], reference.wanted):
            found += [miss.told() for miss in misses_near(reference, place, (1e-2, 1e-3, 1e-8))]
    assert found == []


@pytest.mark.parametrize("name", sampled(NUMERIC))
def test_the_reference_closes_the_equations_that_are_stated_besides(name):
    """Loops, their derivatives and the residual, at a hundred digits, or in doubles where they take those
    alone."""
    exercise = COURSE[name]
    reference = Reference(exercise, numbers_of(exercise))
    assert not reference.lacking
    closing = reference.closing(exercise.variant(seed).given for seed in range(3))
    assert closing is not None
    assert closing.is_closed, closing


@pytest.mark.parametrize(
    "name", sampled((n for n in NUMERIC if COURSE[n].solution.loops), ("slotted_mechanism",))
)
def test_the_reference_closes_the_loops_at_hard_places_too(name):
    """Forty digits are left of a hundred where the textbook formulas lose most."""
    exercise = COURSE[name]
    reference = Reference(exercise, numbers_of(exercise))
    found = []
    for place in hard_places(exercise, reference.wanted, 4):
        for distance in (1e-3, 1e-12):
            lacks = reference.lacks(place.at(place.sides[0] * distance))
            found += [lack for equation, lack in lacks.items() if equation.startswith("loop")]
    assert len(found) >= 4
    assert max(found) < 1e-40


def test_a_formula_that_loses_digits_is_caught(monkeypatch):
    """The textbook formula in the place of the stable one."""
    exercise = COURSE["slotted_mechanism"]
    monkeypatch.setattr(type(exercise.solution.graph), "evaluate", _textbook(exercise.solution.graph))
    told = lost("slotted_mechanism", distances=QUICK, most=2)
    assert any("rA_ddot" in line for line in told)


def _textbook(graph):
    textbook, plain = graph.textbook, type(graph).evaluate

    def evaluate(self, *args, **options):
        return plain(textbook if self is graph else self, *args, **options)

    return evaluate
