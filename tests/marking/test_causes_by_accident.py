"""Random wrong numbers get a cause by accident in fewer than one case of a hundred; the commonest slips
always, over all exercises."""

import math
import random

import pytest
from sweeps import at_once

import coursework
from coursework.issuing.issuing import distinct_variants
from coursework.language.numbers import significant

COURSE = coursework.open_course()
MOST = 0.01


@pytest.mark.slow
def test_random_wrong_numbers_are_told_no_cause():
    """To run it alone: python -m pytest -m slow tests/marking/test_causes_by_accident.py"""
    told, tried = [], 0
    for name in COURSE.names:
        for variant in distinct_variants(COURSE[name], 0, 3, "en"):
            numbers = [p for p in variant.parts if p.sort.is_number and not p.judge]
            right = {p.id: significant(float(variant.key.reference[p.quantity]), 5) for p in numbers}
            for part in (p for p in numbers if p.kind in ("number", "angle")):
                rng = random.Random(f"{name}{variant.seed}{part.id}")
                size = abs(float(variant.key.reference[part.quantity])) or 100.0
                for others in ({}, right, {}, right):
                    value = size * 10 ** rng.uniform(-1, 1) * rng.choice((-1, 1))
                    value = rng.uniform(-180, 180) if part.sort.turn else value
                    verdict = variant.grade({**others, part.id: significant(value, 4)})[part.id].verdict
                    if verdict != "correct":
                        tried += 1
                        told += [(name, part.id, value, verdict)] * (verdict != "wrong")
    assert tried > 2000
    assert len(told) < MOST * tried, told


@at_once(COURSE.names, COURSE.names[::4])
def test_a_sign_a_thousand_and_radians_are_recognised_within_the_whole_margin(names):
    missed = []
    for variant in (COURSE[name].variant(0, "en") for name in names):
        for part in (p for p in variant.parts if p.kind in ("number", "angle") and not p.judge):
            reference = float(variant.key.reference[part.quantity])
            off = 1 + min(0.005, 0.9 * variant.key.half_width(part) / abs(reference)) if reference else 0.0
            slips = {"sign": -reference, "thousand": reference / 1000 if "mm" in part.unit else 0.0}
            slips["radians"] = math.radians(reference) if part.sort.turn else 0.0
            for slip, value in slips.items():
                answer = significant(value * off, 4)
                verdict = variant.grade({part.id: answer})[part.id].verdict if value else "zero"
                missed += [(variant.exercise.name, part.id, slip, answer)] * (verdict == "wrong")
    assert not missed, missed
