"""Answers of every sort to a part, and for which feature a platform may judge each otherwise than our marking
does."""

from __future__ import annotations

import random
import re
from typing import NamedTuple

from coursework.language.numbers import significant
from coursework.platforms.posed import CHOICE, CHOICES, NUMBER

_NONSENSE = ("abc", "?", "12 or 13", "2*100", "\u22125", "1 2 3 m", "pi/3", "I do not know", "-", "1e400")

_THOUSANDS = re.compile(r"-?[1-9]\d{0,2}\.\d{3}")  #: a person looks where 1000 times as much would be right


class Given(NamedTuple):
    """An answer to one part."""

    sort: str
    answer: object  #: a text; the place of an option; the places of several
    excuses: frozenset[str]  #: features by which it may be judged otherwise


def given(sort, answer, *excuses):
    return Given(sort, answer, frozenset(excuses))


def answers_to(posed, part, count, seed):
    """So many answers to a question, those of every sort first."""
    rng = random.Random(seed)
    if posed.kind == NUMBER:
        found = [*_right(posed, part), *_wrong(posed, part), *_nonsense()]
        right = posed.intervals[0]
        while len(found) < count:
            value = right.value * rng.choice((1, -1, 2, 0.5, 1.1, 10)) * rng.uniform(0.5, 1.5)
            found.append(given("random", significant(value, 5), "usual_errors"))
    elif posed.kind == CHOICE:
        found = [given("option", place % len(posed.options)) for place in range(count)]
    elif posed.kind == CHOICES:
        places = range(len(posed.options))
        found = [given("options", [p for p in places if rng.random() < 0.5]) for _ in range(count)]
    else:
        texts = ("5", "a = b", "\u00e9; part 2: 5", "(1 ; 2)", "")
        found = [given("collected", texts[k % len(texts)], "collected") for k in range(count)]
    return found[:count]


def _right(posed, part):
    right = posed.intervals[0]
    digits, half = significant(right.value, 6), right.high - right.value
    yield given("six figures", digits)
    yield given("all figures", repr(right.value))
    if not part.is_exact:
        yield given("decimal comma", digits.replace(".", ","), *(("comma",) if "." in digits else ()))
        yield given("on the edge", repr(right.low))
        yield given("on the edge", repr(right.high))
        yield given("within", repr(right.value + 0.99 * half))
    if part.unit != "1":
        yield given("with its unit", f"{digits} {part.unit}", "unit_written")
        yield given("wrong unit", f"{digits} kg", "unit_refused")
    if "mm" in part.unit and "^" not in part.unit:
        metres = significant(right.value / 1000, 6)
        yield given("other unit", f"{metres} {part.unit.replace('mm', 'm')}", "unit_written")
    if part.sort.turn:
        yield given("a turn more", repr(right.value + part.sort.turn))
        yield given("a turn less", repr(right.value - part.sort.turn))
        yield given("two turns more", repr(right.value + 2 * part.sort.turn), "turns")


def _wrong(posed, part):
    for one in posed.intervals:
        if not one.is_right and not one.turns:
            digits = significant(one.value, 6)
            yield given("known error", digits, *(("unreadable",) if _THOUSANDS.fullmatch(digits) else ()))
    right = posed.intervals[0]
    half = right.high - right.value
    for factor in (1.01, 1.5, -1.01, 3):
        beyond = right.value + (factor * half if half else factor)
        yield given("just beyond", repr(beyond), "usual_errors")
    for factor in (-1, 10, 0.1, 1000, 0.001, 57.29578, 0.0174533, 2, 0.5):
        yield given("slip", significant(right.value * factor, 6), "usual_errors")
    yield given("zero", "0", "usual_errors")


def _nonsense():
    yield given("blank", "")
    for text in _NONSENSE:
        yield given("nonsense", text, "unreadable")
