"""What is told of a wrong answer is the likelier cause: found from the whole sheet where one error shows in several boxes."""

from __future__ import annotations

import math
import sys
from itertools import combinations

import numpy as np
import pytest

import coursework
from coursework import degrees
from coursework.errors import CourseworkError
from coursework.language.numbers import significant
from coursework.making.issuing import distinct_variants
from coursework.quantities.error_kinds import PRICES

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


IN_RADIANS = {
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan,
    "atan2": np.arctan2, "angle": np.angle, "from_radians": lambda theta: theta,
    "polar": lambda length, theta: length * np.exp(1j * np.asarray(theta)),
}  # fmt: skip
KNOWN = {getattr(degrees, name): function for name, function in IN_RADIANS.items()}


def worked_in_radians(variant, monkeypatch, *, converts):
    """The answers of a student whose calculator is in radians: each step from the ones that were written, to five digits.

    Within the solutions every function of degrees is exchanged for that of radians; who ``converts`` writes and types
    degrees for the angles that come out.
    """
    graph = variant.exercise.solution.graph.textbook
    quantities = {p.quantity: p for p in measured(variant)}
    values, answers = dict(variant.used), {}
    with monkeypatch.context() as patch:
        homes = {f.__module__ for f in (graph.node(n).function for n in graph.names)}
        for module in [sys.modules[n] for n in homes if "solutions" in n.split(".")]:
            for name, value in list(vars(module).items()):
                if callable(value) and value in KNOWN:
                    patch.setattr(module, name, KNOWN[value])
        for quantity, part in quantities.items():
            try:
                value = graph.evaluate((quantity,), values, variant.effects)[quantity]
            except CourseworkError:
                continue  # the calculator says error
            if isinstance(value, complex) or not np.isfinite(value):
                continue
            if converts and part.unit == "deg" and value != variant.key.reference[quantity]:
                value = math.degrees(value)
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
