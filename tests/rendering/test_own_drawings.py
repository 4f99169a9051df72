"""Feedback shows the student's own drawing over the right one, where the solution may be shown and nowhere
else."""

import re
from dataclasses import replace

import pytest

import coursework
from coursework.figures.plot import RIGHT, WRONG
from coursework.gradebook.own_drawings import own_drawings
from coursework.marking.marking import mark
from coursework.rendering import html, pdf
from coursework.sheets.answer_sheet import answer_sheet
from coursework.sheets.sheet import FeedbackLine, FeedbackSheet

COURSE = coursework.open_course()
DRAWN = {"velocity_polygon": 1, "crank_shaper_drawn": 2, "two_circles": 1, "havens_construction": 1}
#: A drawn point far off, and as the box of a student who writes with commas takes it.
WRONG_POINT = {"two_circles": ("b1", "(120 ; 31,5)"), "havens_construction": ("v20", "(-120 ; 31,5)")}


def marked(name, lang="fr", **other):
    """A variant, and the marks of a right drawing with the pole at (20, 30), but for ``other`` answers."""
    variant = COURSE[name].variant(3, lang)
    pole = 0 if name == "havens_construction" else 20 + 30j
    answers = {}
    for part in variant.parts:
        value = variant.key.reference[part.quantity]
        if part.kind == "point":
            z = complex(*value) + pole
            answers[part.id] = f"({z.real:.2f} ; {z.imag:.2f})"
        elif part.kind in ("number", "angle"):
            answers[part.id] = f"{float(value):.6g}"
    return variant, mark(variant, answers | other)


def drawings(name, **other):
    return [drawing.outlined_svg() for drawing in own_drawings(*marked(name, **other))]


@pytest.mark.parametrize("name", DRAWN)
def test_each_construction_is_shown_over_the_right_one(name):
    shown = drawings(name)
    assert len(shown) == DRAWN[name]
    assert all(RIGHT in svg and WRONG not in svg for svg in shown)
    part, text = WRONG_POINT.get(name, ("a", "(120 ; 31)"))
    wrong = drawings(name, **{part: text})
    assert WRONG in wrong[0]
    assert RIGHT in wrong[0]


def test_a_polygon_without_a_pole_is_not_shown():
    assert len(drawings("crank_shaper_drawn", p="")) == 1
    assert drawings("two_circles", p="") == []


def test_the_value_is_drawn_that_was_marked():
    """A point in metres stands where it stands in millimetres."""
    (usual,) = drawings("velocity_polygon")
    x, y = COURSE["velocity_polygon"].variant(3, "fr").key.reference["b"] + (20, 30)
    (metres,) = drawings("velocity_polygon", b=f"({x / 1000:.5f} ; {y / 1000:.5f}) m")
    assert metres == usual


def test_circles_have_the_radii_of_the_bars_at_the_student_s_scale():
    variant, marks = marked("two_circles")
    (drawing,) = own_drawings(variant, marks)
    kl = float(variant.key.reference["kl"])
    expected = [variant.given["r3"] / kl, variant.given["r4"] / kl]
    assert [radius for _, radius in drawing.circles] == pytest.approx(expected)
    for centre, radius in drawing.circles:
        for name in ("B_1", "B_2"):
            assert abs(drawing.points[name] - centre) == pytest.approx(radius, abs=0.02)


def feedback(name):
    variant, marks = marked(name)
    solution = answer_sheet(variant)
    lines = tuple(
        FeedbackLine(q, m.answer, m.read_as, m.verdict, m.points, m.out_of, m.says)
        for q in solution.handout.questions
        for m in (marks[q.id],)
    )
    drawn = own_drawings(variant, marks)
    return FeedbackSheet(
        solution.handout, lines, marks.points, marks.out_of, solution=solution, drawings=drawn
    )


def test_a_page_and_a_pdf_show_it_and_neither_before_the_solution():
    sheet = feedback("two_circles")
    folders = COURSE.folder.template_folders
    before = replace(sheet, drawings=())
    assert ["Votre dessin sur" in html.page(folders, s) for s in (sheet, before)] == [True, False]
    sources = [pdf.source(folders, [s]) for s in (sheet, before)]
    assert [len(re.findall("Votre dessin sur", source)) for source in sources] == [
        2,
        0,
    ]  # caption, description
