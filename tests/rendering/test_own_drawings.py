"""Feedback shows the student's own drawing over the right one, where the solution may be shown and nowhere else."""

from dataclasses import replace

import pytest

import coursework
from coursework.figures.plot import RIGHT, WRONG
from coursework.marking.marking import mark
from coursework.rendering import html
from coursework.rendering.feedback import own_drawings
from coursework.sheets.answer_sheet import answer_sheet
from coursework.sheets.sheet import FeedbackLine, FeedbackSheet

COURSE = coursework.open_course()


def feedback(name, lang="fr", **other):
    """Feedback on a right drawing with the pole at (20, 30), but for ``other`` answers."""
    variant = COURSE[name].variant(3, lang)
    answers = {}
    for part in variant.parts:
        value = variant.key.reference[part.quantity]
        if part.kind == "point":
            answers[part.id] = f"({value[0] + 20:.2f} ; {value[1] + 30:.2f})"
        elif part.kind == "number":
            answers[part.id] = f"{float(value):.6g}"
    marks, solution = mark(variant, answers | other), answer_sheet(variant)
    lines = tuple(
        FeedbackLine(q, m.answer, m.read_as, m.verdict, m.points, m.out_of, m.says)
        for q in solution.handout.questions
        for m in (marks[q.id],)
    )
    return FeedbackSheet(solution.handout, lines, marks.points, marks.out_of, solution=solution)


@pytest.mark.parametrize(("name", "count"), [("velocity_polygon", 1), ("crank_shaper_drawn", 2)])
def test_each_polygon_that_is_drawn_is_shown_over_the_right_one(name, count):
    drawings = own_drawings(feedback(name))
    assert len(drawings) == count
    assert all(RIGHT in svg and WRONG not in svg for svg in drawings)
    wrong = own_drawings(feedback(name, a="(120 ; 31)"))
    assert WRONG in wrong[0]
    assert len(own_drawings(feedback(name, p=""))) == count - 1


def test_nothing_is_shown_before_the_solution_is():
    sheet = feedback("velocity_polygon")
    assert own_drawings(replace(sheet, solution=None)) == []
    page = html.page(COURSE.folder.template_folders, sheet)
    before = html.page(COURSE.folder.template_folders, replace(sheet, solution=None))
    assert ("Votre dessin sur" in page, "Votre dessin sur" in before) == (True, False)
