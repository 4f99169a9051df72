"""From the printer to the marks: sheets are built, filled in by hand in simulation, scanned, typed where they
wait, and marked."""

from __future__ import annotations

import csv
import io
import json

import cv2
import numpy as np
import pytest
from scanned_class import handwritten, rows, write
from scanned_pages import Hand, Scan, scanned, sheet_of_pdf

from coursework.api import open_course
from coursework.cli import run
from coursework.course.answer_key import Key
from coursework.issuing.answer_papers import answer_papers
from coursework.issuing.students import file_stems
from coursework.system.tables import csv_file

EXERCISE = "slotted_mechanism"
NAMES = ("Zoé", "Max")


@pytest.mark.e2e
def test_from_the_printer_to_the_marks(tmp_path):
    roster = tmp_path / "class.csv"
    roster.write_text("student\n" + "\n".join(NAMES) + "\n", "utf-8")
    out = tmp_path / "out"
    assert (
        run(
            [
                "build",
                EXERCISE,
                "--roster",
                str(roster),
                *"--with scan --formats pdf --lang en --out".split(),
                str(out),
            ]
        )
        == 0
    )
    truth = {name: _filled_and_scanned(tmp_path, out, name) for name in NAMES}
    read = out / "read"
    status = run(["scan", str(tmp_path / "scans"), "--issued", str(out / "issued.json")])
    cards = json.loads((read / "queue" / "queue.json").read_text("utf-8"))["cards"]
    assert status == (1 if cards else 0)
    assert {row["what"] for row in rows(read / "pages.csv")} == {"answers", "statement", "blank"}
    for row in rows(read / "answers.csv"):
        assert row["answer"] == truth[row["student"]].get(row["part"], ""), (
            "what is not left to a person is right"
        )
    typed = [
        dict(zip(("student", "exercise", "seed", "part", "coordinate"), card["place"], strict=True))
        | {"answer": truth[card["student"]].get(card["part"], ""), "seen": card["seen"]}
        for card in cards
    ]
    (tmp_path / "typed.csv").write_bytes(
        csv_file(typed, ("student", "exercise", "seed", "part", "coordinate", "answer", "seen"))
    )
    assert run(["scan", "--issued", str(out / "issued.json"), "--typed", str(tmp_path / "typed.csv")]) == 0
    run(["grade", str(read / "answers.csv"), "--issued", str(out / "issued.json"), "--no-feedback"])
    summary = csv.DictReader(io.StringIO((out / "marks" / "marks.csv").read_text("utf-8-sig")))
    verdicts = {(row["student"], row["part"]): row["verdict"] for row in summary}
    for name in NAMES:
        assert verdicts[name, "rA"] == "correct"
        assert verdicts[name, "theta4"] == "correct"
        assert verdicts[name, "omega4"] not in ("correct", "missing", "unreadable")
        assert verdicts[name, "alpha4"] == "missing"


def _filled_and_scanned(tmp_path, out, name):
    """Write on somebody's sheet, and scan all of it; gives what was written, as it should be read."""
    course = open_course()
    papers = answer_papers(json.loads((out / "issued.json").read_text("utf-8")))
    paper = next(p for p in papers.values() if p.student == name and p.size == "a4")
    (variant,) = paper.variants(course)
    key = Key(variant)
    told = {
        "rA": f"{float(key.reference['rA']):.1f} mm",
        "theta4": f"{float(key.reference['theta4']):.1f}",
        "omega4": "98765 rad/s",
    }
    stem = file_stems([name])[0]
    data = (out / "handouts" / EXERCISE / f"{stem}.en.pdf").read_bytes()
    pages = paper.pages(course)
    count = _page_count(data)
    rng = np.random.default_rng(sum(map(ord, name)))
    hand = Hand(jitter=0.2, bank=handwritten(), rng=rng)
    (tmp_path / "scans").mkdir(exist_ok=True)
    for number in range(count):
        sheet = sheet_of_pdf(data, number)
        if number >= count - len(pages):
            hand.begin(sheet)
            for field in pages[number - (count - len(pages))].fields:
                write(hand, field, told.get(field.part, ""))
            sheet = hand.finish(sheet)
        picture = scanned(sheet, Scan(dpi=200, skew=1.5, turn=2 * (number % 2), noise=2.5), rng)
        cv2.imwrite(str(tmp_path / "scans" / f"{len(list((tmp_path / 'scans').iterdir())):03d}.png"), picture)
    return told


def _page_count(data):
    import pypdfium2

    with pypdfium2.PdfDocument(data) as document:
        return len(document)
