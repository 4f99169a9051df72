"""An answer on a scan that nobody has typed yet waits for a person, whatever its kind."""

import csv
import json

from sweeps import whole_course

import coursework
from coursework.cli import run
from coursework.marking.marking import mark
from coursework.parsing.scanned import (
    crop_of,
    names_pictures,
    picture_of,
    scan_reference,
    scan_references,
)
from coursework.scanning.scan_store import page_id

COURSE = coursework.open_course()
PAGE = page_id("0123456789abcdef", 12)
FORMS = (crop_of(PAGE, 3), f"{crop_of(PAGE, 103)}; {picture_of(PAGE)}", scan_reference(PAGE, 3))


def waiting(names):
    found = []
    for name in names:
        variant = COURSE[name].variant(3)
        empty = mark(variant, {})
        for form in FORMS:
            marks = mark(variant, dict.fromkeys(variant.part_ids, form))
            found += [(name, part, form) for part in marks if marks[part].verdict != "to_mark"]
        for part in variant.part_ids:
            marks = mark(variant, {part: FORMS[0]})
            found += [(name, other) for other in marks if other != part and marks[other] != empty[other]]
    return found


def test_it_is_neither_wrong_nor_left_out_and_changes_no_other_mark():
    assert not waiting(("velocity_polygon", "mobility", "joint_graph", "parallel_joints"))


@whole_course
def test_so_of_every_question_of_the_course():
    assert not waiting(COURSE.names)


def test_a_reference_is_told_from_what_people_write():
    assert all(map(names_pictures, FORMS))
    assert scan_references(f"{FORMS[2]}; {scan_reference(PAGE, 12)}") == ((PAGE, "3"), (PAGE, "12"))
    written = ("scan 12", "crops/a.png", f"{FORMS[0]} 12 mm", f"12; {FORMS[0]}", "scan", "", "pictures/")
    assert not [text for text in written if names_pictures(text)]


def built(folder):
    """Two papers of one exercise; return the folder and the file of the assignment."""
    out, exam = folder / "out", folder / "exam.toml"
    exam.write_text('[[exercises]]\nname = "slotted_mechanism"\n', "utf-8")
    (folder / "class.csv").write_text("student\nAda\nBo\n", "utf-8")
    usual = ["--roster", str(folder / "class.csv"), "--formats", "ipynb", "--with", "no-solutions"]
    assert run(["build", str(exam), *usual, "--out", str(out)]) == 0
    return out, exam


def test_marks_do_not_go_out_while_a_paper_lacks_a_page(tmp_path, capsys):
    """Who handed in nothing, ``all``, lacks no page: the attendance list says more of them."""
    out, exam = built(tmp_path)
    issued = ["--issued", str(out / "issued.json")]
    assert run(["grade", str(out / "answers.csv"), *issued, "--no-feedback"]) == 0
    assert run(["after", str(exam), *issued]) == 0
    lines = "student;paper;pages;scanned;missing", "Ada;x1;4;3;2", "Bo;x2;;0;all"
    for folder, read in ((out / "read", []), (tmp_path / "r", ["--read", str(tmp_path / "r")])):
        folder.mkdir()
        (folder / "missing.csv").write_text("\n".join(lines), "utf-8")
        capsys.readouterr()
        assert run(["after", str(exam), *issued, *read]) == 1
        text = capsys.readouterr().out
        assert "(1): Ada" in text
        assert "Nothing waits" not in text
        assert run(["after", str(exam), *issued, *read, "--json"]) == 1
        assert json.loads(capsys.readouterr().out)["incomplete_papers"] == ["Ada"]


def test_refusing_all_that_waits_in_a_question_does_not_refuse_what_nobody_has_read(tmp_path, capsys):
    out, exam = built(tmp_path)
    with (out / "answers.csv").open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        row["answer"] = {"Ada": FORMS[0], "Bo": "xyz ??"}[row["student"]] if row["part"] == "rA" else ""
    with (out / "answers.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    issued = ["--issued", str(out / "issued.json")]
    assert run(["grade", str(out / "answers.csv"), *issued, "--no-feedback"]) == 1
    assert "1 of them is on scans" in capsys.readouterr().out
    assert run(["after", str(exam), *issued]) == 1
    told = capsys.readouterr().out
    assert "On scans, to type (cards: 1, answers: 1)" in told
    assert "Texts to mark" not in told
    assert run(["after", str(exam), *issued, "--refuse", "1.1", "--yes"]) == 0
    capsys.readouterr()
    assert run(["after", str(exam), *issued, "--cards"]) == 1
    told = capsys.readouterr().out
    assert FORMS[0] in told
    assert "xyz" not in told
