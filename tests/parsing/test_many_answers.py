"""Many answers read at once are read as each alone."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import ANYTHING, NBSP

from coursework.errors import WrongUnit
from coursework.parsing.numbers import read_number, read_numbers


def agrees_one_by_one(texts):
    """Whether the array of readings says of each answer what its own reading says."""
    values, left = read_numbers(texts, "mm")
    assert values.dtype == float
    assert left.dtype == bool
    assert values.shape == left.shape == (len(texts),)
    for text, value, later in zip(texts, values, left, strict=True):
        reading = read_number(text, "mm")
        if later:
            assert math.isnan(value)
        elif math.isnan(value):
            assert reading.status == "missing"
        else:
            assert (reading.status, reading.values) == ("read", (value,)), text
            assert math.copysign(1.0, value) == math.copysign(1.0, reading.values[0])
            assert not reading.unit_given
    return left


@given(
    st.lists(
        ANYTHING | st.sampled_from(["", " ", NBSP, "1 1/2", "12 mm", "1,234", "1e999", "\u200b", "9" * 50])
    )
)
@settings(max_examples=100, deadline=None)
def test_many_answers_at_once_are_read_as_each_alone(texts):
    agrees_one_by_one(texts)


def test_plain_digits_leave_nothing_to_the_full_reader():
    texts = ["319.8", "104,6", "-12", "3.2e2", "+7", " 5 ", "", None, 3, 2.5]
    assert not agrees_one_by_one(texts).any()
    assert not agrees_one_by_one(np.array(["319,8", "-12", " "])).any()
    assert agrees_one_by_one(["1,234", "12 mm", "π", True, float("nan"), "nan", "1e999", 10**400]).all()


def test_many_answers_in_an_unknown_unit_are_the_callers_error():
    with pytest.raises(WrongUnit):
        read_numbers(["5"], "frogs")
