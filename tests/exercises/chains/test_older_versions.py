"""Sheets that were issued before a version was raised are marked as they were issued."""

import json
from pathlib import Path

import pytest

import coursework

COURSE = coursework.open_course()
RECORDS = json.loads(Path(__file__).with_name("records_of_older_versions.json").read_text("utf-8"))


@pytest.mark.parametrize("name", RECORDS)
def test_an_older_record_keeps_its_data_parts_and_points(name):
    record = RECORDS[name]
    variant = COURSE[name].from_record(record)
    assert record["version"] < COURSE[name].version
    assert variant.record == record
    assert "gamma" in variant.part_ids, "asked by request alone since then"
    right = variant.solution()
    assert right["gamma"] == 1
    letters = {p["id"]: p["choices"].index(right[p["id"]]) for p in record["parts"] if "choices" in p}
    answers = {i: "abcd"[letters[i]] if i in letters else str(right[i]) for i in variant.part_ids}
    marking = variant.grade(answers)
    assert marking.points == marking.out_of == sum(part["points"] for part in record["parts"])
