"""Answers that established grading systems judge: ours says the same, or differs by a rule that is named."""

import json
import re
from pathlib import Path
from types import SimpleNamespace

import pytest
from tables import each_row

from coursework.errors import WrongUnit
from coursework.kinds.kind import kind_of
from coursework.parsing.numbers import read_number
from coursework.parsing.units import convert

CASES = json.loads((Path(__file__).parent / "peer_cases.json").read_text(encoding="utf-8"))["cases"]
PAGE = Path(__file__).parents[2] / "docs" / "fair_marking.md"

#: What a verdict of theirs is called among ours; "partial" has no counterpart.
ALIKE = {
    "correct": ("correct",),
    "incorrect": ("wrong", "wrong_unit"),
    "invalid": ("unreadable", "missing"),
    "partial": (),
}

#: Where we differ, by the rule of ours that says so: what ours gives, and the cases by their id.
DIFFERENCES = {
    "No part can ask for a unit that is not in the table of units": {
        "no_such_unit": (135, 136, 210, 211, 212, 213, 214, 215, 221, 225, 226),
    },
    "The electronvolt is that of the SI since 2019": {"wrong": (35,)},
    "An unknown unit is unreadable and listed for a person, neither ignored nor wrong": {
        "unreadable": (89, 94, 112, 116, 209, 218, 222),
    },
    "A unit is written after its number, not within a formula": {
        "unreadable": (170, 171, 183, 184, 185, 189, 190),
    },
    "Without a unit, a number is in the unit printed beside the box": {
        "correct": (95, 106, 113, 114, 178, 197, 202),
    },
    "A part has one tolerance, without half marks inside a second one": {"wrong": (107, 108, 109)},
    "A number is judged in the unit written with it": {"wrong": (99,)},
    "A unit may be spelled out or glued, `Joule`, `Nm`": {"correct": (204, 205)},
    "Dollar signs belong to LaTeX and are ignored": {"correct": (115,)},
    "The form of a right value costs nothing: fraction, formula or decimals": {
        "correct": (121, 123, 127),
        "read": (142,),
    },
    "Infinity is not a value: unreadable rather than wrong": {"unreadable": (128,)},
    "An answer equal to the reference is right, whatever the unit of the tolerance": {"correct": (180,)},
}

_MEASURE = re.compile(r"(?P<number>[+-]?[0-9.]+(?:[eE][+-]?[0-9]+)?(?:/[0-9]+)?)\s*\*?\s*(?P<unit>[^(].*)?")


def distance(part, *values):
    return part.sort.distance(part, *values)


def measure(text: object, unit: str = "1") -> tuple[float, str]:
    """Number and unit of a reference or a tolerance as the cases write it, ``12.3*m/s``."""
    text = str(text).split(" (also")[0]
    if (degrees := re.fullmatch(r"(sin|cos)\((\d+)\)", text)) is not None:
        return {"sin90": 1.0, "cos60": 0.5, "cos90": 0.0}[degrees[1] + degrees[2]], unit
    found = _MEASURE.fullmatch(text)
    above, _, below = found["number"].partition("/")
    return float(above) / float(below or 1), found["unit"] or unit


def half_width(case: dict, reference: float, unit: str) -> float:
    """The tolerance of a case as one half-width in the unit of the reference."""
    tolerance = case["tolerance"]
    if tolerance["type"] == "relabs":
        atol, of = measure(tolerance["atol"], unit)
        return convert(atol, of, unit) + tolerance["rtol"] * abs(reference)
    value, of = measure(tolerance.get("value") or 0, unit)
    return value * abs(reference) if tolerance["type"] == "relative" else convert(value, of, unit)


def ours(case: dict) -> str:
    """Our verdict on the answer of a case, the sheet printing the unit of the reference beside the box.

    ``no_such_unit``: no part can be asked in that unit. ``read``: the case has no reference to compare with.
    """
    answer = case["answer"] + " " + case.get("unit_given_apart", "")
    if case["reference"] == "any":
        return read_number(answer, "1").status
    metres = "m" if case["units"] and case["system"] == "moodle/moodle" else "1"
    reference, unit = measure(case["reference"], metres)
    try:
        reading = read_number(answer, unit)
        width = half_width(case, reference, unit)
    except WrongUnit:
        return "no_such_unit"
    if reading.status != "read":
        return reading.status
    part = SimpleNamespace(sort=kind_of("number"), half_width=lambda reference: width)
    gap = min(distance(part, value, reference) for value in reading.values)
    return "correct" if gap <= 1 else "wrong"


EXPECTED = {i: given for groups in DIFFERENCES.values() for given, ids in groups.items() for i in ids}


@each_row("case", CASES)
def test_ours_agrees_or_differs_as_the_list_says(case):
    found = ours(case)
    if case["id"] in EXPECTED:
        assert found == EXPECTED[case["id"]]
        assert found not in ALIKE[case["verdict"]]
    else:
        assert found in ALIKE[case["verdict"]]


def test_a_case_differs_for_one_reason_only():
    listed = [i for groups in DIFFERENCES.values() for ids in groups.values() for i in ids]
    assert len(set(listed)) == len(listed)
    assert [case["id"] for case in CASES] == list(range(1, len(CASES) + 1))


def counts() -> dict[str, int]:
    """Cases by what became of them: agreement, or the rule by which ours differs."""
    by_rule = {rule: sum(map(len, groups.values())) for rule, groups in DIFFERENCES.items()}
    return {"Cases": len(CASES), "Ours says the same": len(CASES) - sum(by_rule.values()), **by_rule}


@pytest.mark.skipif(not PAGE.exists(), reason="the page is beside the sources only")
def test_the_page_tells_these_counts():
    rows = re.findall(r"^\| (.+?) \| +(\d+) \|", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    assert {rule: int(count) for rule, count in rows if rule in counts()} == counts()
    systems = re.findall(
        r"^\| (\S+/\S+) \| (\d+) \| (\d+) \| (\d+) \|$", PAGE.read_text(encoding="utf-8"), re.M
    )
    assert {(s, int(n), int(same), int(differ)) for s, n, same, differ in systems} == {
        (s, len(ids), len(ids - EXPECTED.keys()), len(ids & EXPECTED.keys()))
        for s in {c["system"] for c in CASES}
        for ids in [{c["id"] for c in CASES if c["system"] == s}]
    }
