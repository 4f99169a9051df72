"""Papers of three exercises of the built-in course, as handed out, solved and marked."""

from __future__ import annotations

from functools import cache

import coursework
from coursework.marking.marking import mark
from coursework.sheets.paper import FeedbackPaper, Logo, Paper, PaperHeading, SolutionPaper
from coursework.sheets.sheet import FeedbackLine, FeedbackSheet

COURSE = coursework.open_course()
#: Two of them ask a part of one name.
NAMES = ("slotted_mechanism", "grashof", "four_bar_positions")
ALT = {"fr": "Emblème de l'école", "en": "Emblem of the school"}
SVG = (
    b'<svg xmlns="http://www.w3.org/2000/svg" width="120" height="50"><circle cx="25" cy="25" r="14"/></svg>'
)
NOTES = {
    "fr": (
        "Devoir surveillé 2",
        "Mécanique 2A",
        ("Numéro", "Groupe"),
        "4 décembre 2026",
        "Calculatrice **autorisée**.",
    ),
    "en": ("Midterm 2", "Mechanics 2A", ("Number", "Group"), "4 December 2026", "Calculators **allowed**."),
}


def heading(lang: str, student: str = "Zoé #1 Martin", *, cover: bool = False) -> PaperHeading:
    """Title, date, instructions, logo, version, a mark, one column printed and one to fill in."""
    title, course, (number, group), date, instructions = NOTES[lang]
    return PaperHeading(
        lang,
        title,
        course,
        student,
        ((number, "20261234"), (group, "")),
        date,
        "1 h 30",
        instructions,
        "B",
        Logo(SVG, "svg", ALT[lang]),
        cover,
        "20",
    )


def bare(lang: str, student: str = "") -> PaperHeading:
    title, course, *_ = NOTES[lang]
    return PaperHeading(lang, title, course, student)


@cache
def variants(lang: str, names=NAMES, seed: int = 7):
    return [COURSE[name].variant(seed=seed + place, lang=lang) for place, name in enumerate(names)]


@cache
def paper(top: PaperHeading, names=NAMES, seed: int = 7) -> Paper:
    return Paper(top, tuple(one.handout(top.student) for one in variants(top.lang, names, seed)))


@cache
def solution(top: PaperHeading, names=NAMES, seed: int = 7) -> SolutionPaper:
    return SolutionPaper(top, tuple(one.answer_sheet(top.student) for one in variants(top.lang, names, seed)))


@cache
def feedback(top: PaperHeading, *, answers: bool = True, names=NAMES) -> FeedbackPaper:
    """Every second question answered wrong, the others not at all; advice at the end."""
    sheets = tuple(_marked(one, top.student) for one in variants(top.lang, names))
    points, out_of = (sum(getattr(sheet, name) for sheet in sheets) for name in ("points", "out_of"))
    return FeedbackPaper(top, sheets, points, out_of, "14.5", answers, ("Reread **chapter 3**.",))


def _marked(variant, student: str) -> FeedbackSheet:
    sheet = variant.answer_sheet(student)
    given = {q.id: "17.25" if q.number % 2 else "" for q in sheet.handout.questions}
    marks = mark(variant, given)
    lines = tuple(
        FeedbackLine(
            answer.question,
            one.answer,
            one.read_as,
            one.verdict,
            one.points,
            one.out_of,
            one.says,
            answer.text,
        )
        for answer, one in ((answer, marks[answer.question.id]) for answer in sheet.answers)
    )
    return FeedbackSheet(sheet.handout, lines, marks.points, marks.out_of)
