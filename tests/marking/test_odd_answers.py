"""Whatever a program hands over as an answer is judged or unreadable, and nothing of it is believed or
printed blindly."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
from course_of_every_kind import write_course
from tables import each_row

import coursework
from coursework.errors import WrongValue
from coursework.parsing.plain_values import Strange, plain_answer


def _raise(*_, **__):
    raise RuntimeError("evil")


class Evil:
    __str__ = __repr__ = __len__ = __iter__ = __float__ = __eq__ = __bool__ = _raise
    __hash__ = object.__hash__


class EvilText(str):
    __slots__ = ()
    __str__ = strip = __len__ = __contains__ = lower = _raise


class EvilFloat(float):
    __slots__ = ()
    __float__ = __eq__ = __abs__ = __str__ = __repr__ = _raise
    __hash__ = float.__hash__


class EvilList(list):
    __len__ = __iter__ = _raise


def _deep(depth):
    value = []
    for _ in range(depth):
        value = [value]
    return value


_RING: list = []
_RING.append(_RING)
ODD = [
    10**5000,
    -(10**5000),
    Fraction(10**5000, 3),
    Fraction(1, 3),
    Decimal("1.5"),
    Decimal("sNaN"),
    Decimal("1e999999"),
    complex("nan"),
    complex(1, float("inf")),
    float("nan"),
    b"12",
    bytearray(b"12"),
    memoryview(b"12"),
    True,
    None,
    np.float32(3),
    np.longdouble(3),
    np.int64(5),
    np.bool_(True),
    np.array([[1, 2], [3, 4]]),
    np.array(["a"]),
    np.array([Evil()], dtype=object),
    np.datetime64("2020-01-01"),
    np.zeros((300, 300)),
    [1, [2, [3]]],
    [],
    {},
    {1, 2},
    _deep(100_000),
    _RING,
    {"a": _RING},
    [10**5000],
    [b"1", None, Evil()],
    Evil(),
    EvilText("3"),
    EvilFloat(3.0),
    EvilList([1]),
    lambda: 1,
    type,
    range(3),
    iter([1]),
    ...,
    object(),
    "\0",
    "\ud800",
    "9" * 100_000,
]
BUILT_IN = ("slotted_mechanism", "joint_graph", "joint_twist", "grashof", "mobility", "two_circles")


@pytest.fixture(scope="module")
def variants(course, tmp_path_factory):
    own = coursework.open_course(write_course(tmp_path_factory.mktemp("odd") / "own"))
    return [own["coil"].variant(1), *(course[name].variant(1, parts=("all",)) for name in BUILT_IN)]


@pytest.mark.parametrize("most", [2, pytest.param(99, marks=pytest.mark.slow)])
@each_row("odd", ODD)
def test_an_odd_answer_to_a_part_of_any_kind_is_judged_or_unreadable(variants, odd, most):
    for variant in variants[:most]:
        for part in variant.parts:
            mark = variant.grade({part.id: odd})[part.id]
            assert mark.verdict
            assert isinstance(mark.feedback, str)
            assert isinstance(mark.read_as, str)
            if isinstance(odd, (Evil, EvilList, bytes, type)):
                assert mark.verdict == "unreadable" or part.sort.is_open


def test_numbers_of_other_kinds_are_the_numbers_that_they_are(course):
    variant = course["slotted_mechanism"].variant(1)
    right = variant.reference("rA")
    for answer in (
        np.float64(right),
        np.float32(right),
        np.array(right),
        np.array([right]),
        np.longdouble(right),
        Decimal(str(right)),
        Fraction(str(round(right, 3))),
        EvilFloat(right),
        EvilText(f"{right:.2f} mm"),
    ):
        assert variant.grade({"rA": answer})["rA"].verdict == "correct", type(answer)


def test_what_is_nested_or_filled_beyond_measure_is_not_looked_into():
    assert isinstance(plain_answer(_RING), Strange)
    assert isinstance(plain_answer([0] * 20_000), Strange)
    assert plain_answer({"R": np.array([1, 2]), "M": (1.5, None)}) == {"R": [1, 2], "M": (1.5, None)}


@each_row("key", [3, None, b"rA", Evil(), ("rA",), 10**5000, float("nan")])
def test_a_part_that_is_no_text_is_told(course, key):
    with pytest.raises(WrongValue, match="a part is named by a text"):
        course["slotted_mechanism"].variant(1).grade({key: "3"})
