"""What is printed beside a question agrees with it: units in the order that is asked, drawn points within the
box."""

from __future__ import annotations

import re

import numpy as np
import pytest
from sweeps import sampled, seeds

import coursework
from coursework.sheets.answer_sheet import answer_sheet

COURSE = coursework.open_course()
every_language = pytest.mark.parametrize("lang", sampled(["en", "fr"], ["fr"]))
DRAWN = [n for n in COURSE.names if any(p.kind == "point" and p.judge for p in COURSE[n].spec.parts)]
_NUMBER = re.compile(r"\\num\{([^{}]*)\}")


@every_language
def test_no_label_has_its_units_in_another_order_than_its_question(lang):
    """A question that tells its units, and whose columns are not lettered, tells them in the label's
    order."""
    labels = [
        (name, question, question.unit.split(" | "))
        for name in COURSE.names
        for question in COURSE[name].variants([0], lang, ["all"])[0].handout().questions
        if " | " in question.unit
    ]
    assert labels
    for name, question, units in labels:
        plain = [unit.rpartition(" ")[2] for unit in units]
        places = [re.search(rf"(?<!\w){re.escape(unit)}(?!\w)", question.prompt) for unit in plain]
        asked = [found.start() for found in places if found]
        lettered = all(unit != bare for unit, bare in zip(units, plain, strict=True))
        assert asked == sorted(asked) or lettered, (name, question.id, units)


@every_language
@pytest.mark.parametrize("name", DRAWN)
@seeds(2, 6)
def test_a_drawing_of_a_free_pole_is_printed_within_the_box_and_is_right(name, lang, seeds):
    exercise = COURSE[name]
    width, height = exercise.spec.drawing_mm
    for variant in exercise.variants(seeds, lang, ["all"]):
        points = [p for p in variant.parts if p.kind == "point" and p.judge]
        has_pole = any(not np.any(variant.key.reference[p.quantity]) for p in points)
        told = {a.question.id: a.text for a in answer_sheet(variant).answers}
        steps = {s.name: s.value for s in answer_sheet(variant).steps}
        printed = {p.id: tuple(map(float, _NUMBER.findall(told[p.id]))) for p in points}
        written = {i: f"({x}; {y})" for i, (x, y) in printed.items()}
        marking = variant.grade(
            {
                **{p.id: variant.key.reference[p.quantity] for p in variant.parts if p.sort.is_scalar},
                **written,
            }
        )
        assert {marking[i].verdict for i in written} == {"correct"}
        for part in points:
            x, y = printed[part.id]
            assert not has_pole or (0 <= x <= width and 0 <= y <= height)
            assert not has_pole or not told[part.id].startswith("$")
            assert steps[part.quantity] in told[part.id]
