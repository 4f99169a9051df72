"""No huge number is near a reference, a column of answers is marked as each alone, and no number stops the
reading."""

from __future__ import annotations

import math
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from tables import each_row

import coursework
from coursework.course.key_batch import keys_of
from coursework.kinds.kind import Kind, kind_of, kinds
from coursework.kinds.number import Number
from coursework.marking.marking import mark
from coursework.marking.plain_answers import plainly_right
from coursework.parsing.numbers import read_number, read_numbers
from coursework.parsing.reading import MOST_TURNS

COURSE = coursework.open_course()
COLUMN_KINDS = [name for name in kinds() if kind_of(name).marks_columns()]


def part_of(kind, rtol=0.01, atol=0.0):
    return SimpleNamespace(
        unit="deg" if kind_of(kind).turn else "mm",
        rtol=rtol,
        atol=atol,
        half_width=lambda r: max(atol, rtol * abs(r)),
    )


# --------------------------------------------------------------------- columns


def test_numbers_and_angles_are_marked_by_columns():
    assert {"number", "angle"} <= set(COLUMN_KINDS)
    assert not kind_of("integer").marks_columns()


def test_a_kind_that_measures_in_its_own_way_is_not_marked_by_columns():
    class Stricter(Number):
        name = ""

        def distance(self, part, value, reference, along=None, envelope=0.0):
            return math.inf

    class Reader(Number):
        name = ""

        def read(self, answer, part, asking):
            raise AssertionError

    assert not Stricter.marks_columns()
    assert not Reader.marks_columns()
    assert type("Same", (Number,), {"name": ""}).marks_columns()
    assert not Kind.accepted(kind_of("point"), np.ones(2), np.ones(2), np.ones(2)).any()


REFERENCES = st.floats(-400, 400) | st.sampled_from([0.0, 180.0, -180.0, 1e-300, 1e6])
HUGE = st.floats(allow_nan=False, allow_infinity=False) | st.integers(-(10**39), 10**39)
SHIFTS = st.tuples(
    st.sampled_from([0.0, 0.5, 1.0, 1.0 + 1e-15, 1.0 - 1e-15, 1 + 1e-9, 2.0, 170.0]), st.integers(-130, 130)
)


@pytest.mark.e2e
@pytest.mark.parametrize("kind", COLUMN_KINDS)
@given(
    pairs=st.lists(st.tuples(REFERENCES, HUGE | SHIFTS), min_size=1, max_size=8),
    rtol=st.sampled_from([0.0, 0.01, 1e-9]),
    atol=st.sampled_from([0.0, 1.0, 1e-6, 179.999]),
)
@settings(max_examples=600, deadline=None)
@example(pairs=[(122.1, 3.6e19), (10.0, 1e300), (0.0, 36000.0), (0.0, 36000.1)], rtol=0.0, atol=1.0)
def test_a_column_is_marked_as_each_answer_alone(kind, pairs, rtol, atol):
    sort, part = kind_of(kind), part_of(kind, rtol, atol)
    texts, references = [], []
    for reference, written in pairs:
        if isinstance(written, tuple):
            share, turns = written
            written = reference + share * part.half_width(reference) + sort.turn * turns
        texts.append(repr(written))
        references.append(reference)
    values, later = read_numbers(texts, part.unit)
    half_widths = np.array([part.half_width(reference) for reference in references])
    accepted = sort.accepted(values, np.array(references), half_widths)
    for text, reference, right, left in zip(texts, references, accepted, later, strict=True):
        reading = sort.read(text, part, None)
        alone = any(sort.distance(part, value, reference) <= 1 for value in reading.values)
        assert bool(right) == (alone and not left), (text, reference)


HOSTILE = (
    "3.6e19",
    "1e300",
    "-1e20",
    "1e22",
    "36000",
    "36001",
    "99999999999999999999",
    "123456789",
    "0",
    "-0",
    "1e-320",
    "1e999",
    "3,6e19",
)


@pytest.mark.parametrize("count", [4, pytest.param(8, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", ["four_bar_motion", "slider_extras", "slotted_mechanism", "ball_reducer"])
def test_both_ways_to_mark_a_class_give_one_verdict(name, count):
    exercise = COURSE[name]
    variants = list(exercise.variants(range(1, count)))
    keys_of(exercise, variants)
    for turn in range(len(HOSTILE)):
        sheets = []
        for variant in variants:
            texts = {}
            for place, part in enumerate(variant.parts):
                reference = variant.key.reference[part.quantity]
                way = (place + turn) % (len(HOSTILE) + 3)
                if way < len(HOSTILE):
                    texts[part.id] = HOSTILE[way]
                elif np.ndim(reference) == 0 and not isinstance(reference, str):
                    texts[part.id] = repr(
                        float(reference) + (0.0, 0.02 * abs(float(reference)), 36360.0)[way - len(HOSTILE)]
                    )
            sheets.append(texts)
        for variant, texts, right in zip(
            variants, sheets, plainly_right(list(zip(variants, sheets, strict=True))), strict=True
        ):
            marks = mark(variant, texts)
            for part in variant.parts:
                if part.id in right:
                    assert marks[part.id].verdict == "correct", (part.id, texts[part.id])
                    assert marks[part.id].read_as == right[part.id]


# ------------------------------------------------------------------------ huge


@given(st.floats(min_value=36_001, allow_infinity=False) | st.integers(36_001, 10**30), st.floats(-180, 180))
@settings(max_examples=200, deadline=None)
def test_no_huge_number_is_a_direction(huge, reference):
    sort, part = kind_of("angle"), part_of("angle", 0.0, 1.0)
    for text in (repr(huge), f"-{huge!r} deg", huge):
        reading = sort.read(text, part, None)
        assert (reading.status, reading.code) == ("unreadable", "too_many_turns")
    assert sort.distance(part, float(huge), reference) == math.inf


def test_a_direction_has_a_hundred_turns_at_most():
    sort, part = kind_of("angle"), part_of("angle", 0.0, 1.0)
    assert sort.read(f"{360 * MOST_TURNS}", part, None).status == "read"
    assert sort.read("100 tr", part, None).status == "read"
    assert sort.read("101 tr", part, None).code == "too_many_turns"
    assert sort.read("1000π", part, None).code == "too_many_turns"
    assert sort.read("1.2345x104", part, None).values == (pytest.approx(128.388),)
    assert (
        read_number("3.6e19", "deg").status == "read"
    )  # an angle that counts its turns, as one of two cranks


@each_row("lang", ["fr", "en"])
def test_too_many_turns_are_said_in_a_sentence(lang):
    variant = COURSE["slotted_mechanism"].variant(1, lang)
    said = mark(variant, {"theta4": "3.6e19"})["theta4"]
    assert (said.verdict, said.points) == ("unreadable", 0)
    assert {"fr": "trop de tours", "en": "too many turns"}[lang] in said.feedback


def test_a_point_so_far_out_that_its_line_is_lost_is_not_on_it():
    variant = COURSE["ball_reducer"].variant(1)
    parts = [part for part in variant.parts if part.kind == "point_on_line"]
    assert parts
    for part in parts:
        reference, along = variant.key.reference[part.quantity], variant.key.reference[part.along]
        for size in (1e13, 1e17, 1e20, 1e60):
            far = reference + size * np.asarray(along)
            assert part.sort.distance(part, far, reference, along) == math.inf
        near = reference + 1e4 * np.asarray(along)
        assert part.sort.distance(part, near, reference, along) <= 1


def test_a_direction_of_few_digits_is_none_and_a_large_one_is_one():
    direction, part = kind_of("direction"), part_of("direction")
    assert direction.distance(part, (1e300, 0, 1e300), (1.0, 0.0, 1.0)) <= 1
    assert direction.distance(part, (5e-324, 0, 5e-324), (1.0, 0.0, 1.0)) == math.inf


def test_a_complex_number_too_large_for_a_float_is_far():
    assert kind_of("complex").distance(part_of("complex"), complex(1.7e308, 1.7e308), 3 + 4j) > 1


HUGE_VALUES = [
    10**5000,
    -(10**5000),
    10**309,
    Fraction(10**5000),
    Fraction(10**5000, 3),
    [10**5000],
    [10**5000, 1],
    (10**5000, 10**5000),
    np.array([10**400], dtype=object),
    {"a": 10**5000},
    complex(1e308, 1e308),
    1e308,
    float("inf"),
    {10**5000},
]


@pytest.mark.parametrize("name", COURSE.names)
def test_a_number_that_no_float_holds_stops_nothing(name):
    variant = COURSE[name].variant(1)
    for value in HUGE_VALUES:
        marks = mark(variant, dict.fromkeys((part.id for part in variant.parts), value))
        for part in variant.parts:
            assert marks[part.id].verdict != "correct"
            assert isinstance(marks[part.id].answer, str)


def test_a_whole_number_of_thousands_of_digits_is_told_by_its_power_of_ten():
    reading = read_number(-123 * 10**5000, "mm")
    assert (reading.status, reading.code, reading.text) == ("unreadable", "not_finite", "-1.23e5002")
    assert read_number(Fraction(1, 10**5000), "mm").text == "1/1e5000"
