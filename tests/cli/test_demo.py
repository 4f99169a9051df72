"""The demo does the whole job."""

from __future__ import annotations

from pathlib import Path

import pytest
from class_of_three import table
from sweeps import sampled

from coursework.cli import demo


@pytest.mark.e2e
@pytest.mark.parametrize("exercises", sampled(["a pair", "the class's"], ["a pair"]))
def test_the_demo_does_the_whole_job(cli, tmp_path, monkeypatch, exercises):
    if exercises == "a pair":
        (tmp_path / "exercises.txt").write_text("slotted_mechanism\nfour_bar_positions\n", "utf-8")
        monkeypatch.setattr(demo, "CLASS", tmp_path)
    status, out, _ = cli("demo", "--out", tmp_path / "demo")
    assert status == 0
    marks = table(tmp_path / "demo" / "marks" / "marks.csv")
    rejected = table(tmp_path / "demo" / "marks" / "rejected.csv")
    verdicts = {m["verdict"].partition(":")[0] for m in marks}
    assert {"correct", "mistake", "wrong", "wrong_unit", "unreadable", "missing"} <= verdicts
    assert len(rejected) == 3
    assert len(table(tmp_path / "demo" / "marks" / "summary.csv")) == 12
    assert "rejected" in out
    full = {s["student"]: s["percent"] for s in table(tmp_path / "demo" / "marks" / "summary.csv")}
    # Those who answered right, in whatever spelling, have all their points.
    for honest in (
        "Amel Benali",
        "Bastien Roux",
        "Chloé Marchand",
        "David O'Neil",
        "Émilie Lefèvre",
        "Léa Petit",
    ):
        assert full[honest] == "100.0", honest
    assert Path(tmp_path / "demo" / "issued.json").exists()
