"""A process that marks for several courses: the records of a corrected course are those of the course
before."""

import shutil

import coursework
from coursework.gradebook.class_marking import _mark_elsewhere, _SheetJob


def test_a_worker_marks_by_the_course_that_it_is_sent(small_course, tmp_path):
    corrected = tmp_path / "corrected"
    shutil.copytree(small_course, corrected)
    solution = corrected / "solutions" / "crank_pin.py"
    text = solution.read_text("utf-8")
    assert "sin" in text
    solution.write_text(text.replace("sin", "cos"), "utf-8")
    variant = coursework.open_course(small_course)["crank_pin"].variant(3)
    answers = {part.id: f"{variant.key.reference[part.quantity]:.6g}" for part in variant.parts}
    chunk = [_SheetJob(variant.record, answers)]
    by_course = [_mark_elsewhere(str(root), chunk, None) for root in (small_course, corrected)]
    assert by_course[0] != by_course[1]
