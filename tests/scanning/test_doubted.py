"""A number that is read with less confidence counts where it is the right answer of its variant, and waits
otherwise."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from coursework import open_course
from coursework.scanning.gathering import FieldPosition, PrintedField, PrintedPaper, gather
from coursework.scanning.parts import Joins
from coursework.scanning.scan_store import (
    ANSWERS,
    PageScan,
    Scanned,
    ScannedField,
    ScannedFile,
    page_as_json,
    page_of,
)

CODE, FILE = "ABC", ScannedFile("a.png", "f" * 8, 1)


class Paper:
    """Papers with one variant, as :class:`Joins` asks them."""

    def __init__(self, variant):
        self._variant = variant
        self.papers = {CODE: self}
        self.records = [variant.record]

    def variant(self, code, index):
        return self._variant

    def __getitem__(self, code):
        return ()


def gathered(variant, part, *fields):
    """What comes of the fields of a part: text, confidence, why each waits, and what else it may be."""
    key = variant.exercise.name, variant.seed, part
    count = len(fields)
    scanned = tuple(
        ScannedField(*key, k, count, "number", text, confidence, waits, "", (0, 0, 1, 1), *candidates)
        for k, (text, confidence, waits, *candidates) in enumerate(fields)
    )
    asked = tuple(PrintedField(FieldPosition(*key, k), count, "number", 1) for k in range(count))
    printed = {CODE: PrintedPaper(CODE, "Zoé", 1, asked)}
    page = Scanned(FILE, 1, "page-1", PageScan(ANSWERS, "", CODE, 1, scanned, True))
    return gather([page], printed, (), Joins(Paper(variant), printed))


@pytest.fixture(scope="module")
def variant():
    return open_course()["slotted_mechanism"].variant(4, "en")


def test_a_doubted_number_counts_where_it_is_right_alone(variant):
    right = f"{float(variant.key.reference['rA']):.1f}"
    wrong = f"{float(right) + 20:.1f}"
    told = {
        "right": [(right, 0.91, "doubted")],
        "with its unit": [(f"{right} mm", 0.99, "doubted")],
        "wrong": [(wrong, 0.99, "doubted")],
        "read with too little confidence": [(right, 0.5, "digit")],
        "struck by an edge": [(right, 0.99, "digit")],
        "written beside": [(right, 0.99, "free")],
    }
    found = {name: gathered(variant, "rA", *fields) for name, fields in told.items()}
    assert {name: [a.answer for a in one.answers] for name, one in found.items() if one.answers} == {
        "right": [right],
        "with its unit": [f"{right} mm"],
    }
    assert all(len(one.cards) == (not one.answers) for one in found.values())
    assert found["right"].confirmed == {"page-1": 1}


def test_a_doubted_number_counts_where_it_is_probably_one_of_the_right_ones(variant):
    value = float(variant.key.reference["rA"])
    right, other, wrong = f"{value:.1f}", f"{value:.0f}", f"{value + 20:.1f}"
    told = {
        "each is right": ([(other, 0.5), (right, 0.3)], [other]),
        "the right one is likelier": ([(right, 0.85), (wrong, 0.14)], [right]),
        "the likeliest is wrong": ([(wrong, 0.5), (right, 0.49)], []),
        "none is likely": ([(right, 0.4), (other, 0.2)], []),
    }
    found = {
        name: [a.answer for a in gathered(variant, "rA", (may[0][0], may[0][1], "doubted", may)).answers]
        for name, (may, _) in told.items()
    }
    assert found == {name: answers for name, (_, answers) in told.items()}


def test_coordinates_count_where_all_together_are_right():
    variant = open_course()["joint_twist"].variant(1, "en")
    first, *others = (f"{v:.0f}" for v in variant.key.reference["V_plane"])
    sure = [(text, 1.0, "") for text in others]
    assert len(gathered(variant, "V_plane", (first, 0.99, "doubted"), *sure).answers) == 1
    assert len(gathered(variant, "V_plane", (f"{first}1", 0.99, "doubted"), *sure).cards) == 1
    assert len(gathered(variant, "V_plane", (first, 0.99, "doubted"), *sure[:-1], ("9", 1.0, "")).cards) == 1


def test_what_a_number_may_be_is_kept():
    field = ScannedField("a", 1, "b", 0, 1, "number", "1.5", 0.8, "doubted", "", (0, 0, 1, 1))
    for candidates in ((), (("1.5", 0.8), ("1.3", 0.15))):
        page = PageScan(ANSWERS, "", CODE, 1, (replace(field, candidates=candidates),), True)
        stored = json.loads(json.dumps(page_as_json(page)))
        assert page_of(stored) == page
        stored["fields"][0]["candidates"] = [5]
        assert page_of(stored) is None
        del stored["fields"][0]["candidates"]  # of a page that was read before
        assert page_of(stored).fields == (field,)


def test_an_answer_that_is_judged_with_others_counts_where_it_is_the_right_one():
    def taken(exercise, part, *texts):
        variant = open_course()[exercise].variant(5, "en")
        fields = [(text, 0.99, "doubted") for text in texts]
        return len(gathered(variant, part, *fields).answers) == 1, variant.key.reference

    _, key = taken("two_circles", "kl", "2")
    angle, other = (f"{key[name]:.2f}" for name in ("theta3_open", "theta3_crossed"))
    scale, point = f"{key['kl']:.0f}", [f"{v:.1f}" for v in key["a"]]
    assert taken("two_circles", "theta3_open", angle)[0]
    assert not taken("two_circles", "theta3_open", other)[0]
    assert taken("two_circles", "kl", scale)[0]
    assert not taken("two_circles", "kl", f"{2 * float(scale):.0f}")[
        0
    ]  # any scale is right, but may be misread
    assert taken("two_circles", "a", *point)[0]
    assert not taken("two_circles", "a", point[0], f"{float(point[1]) + 5:.1f}")[0]


def test_an_answer_of_groups_that_may_be_exchanged_counts_in_either_order():
    variant = open_course()["four_bar_positions"].variant(5, "en")
    right = [f"{variant.key.reference[name]:.2f}" for name in ("theta3_open", "theta3_crossed")]
    for text in right:
        assert len(gathered(variant, "theta3_open", (text, 0.99, "doubted")).answers) == 1
    assert gathered(variant, "theta3_open", (f"{float(right[0]) + 9:.2f}", 0.99, "doubted")).cards
