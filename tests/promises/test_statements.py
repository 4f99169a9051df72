"""What a student has of an exercise without its printed sheet says all that the drawing and the answers
need."""

import re

import pytest
from sweeps import whole_course

import coursework
from coursework.errors import Cycle, MissingQuantity
from coursework.quantities.graph import graph_of
from coursework.rendering.renderer import renderer_of

COURSE = coursework.open_course()
RENDERER = renderer_of(COURSE.folder)
TO_DRAW = [name for name in COURSE.names if COURSE[name].spec.drawing_mm]
every_language = pytest.mark.parametrize("lang", ["fr", "en"])
SIDES = {"en": (r"on the (left|right)", "from {0} to {1}"), "fr": (r"à (gauche|droite)", "de {0} vers {1}")}


@every_language
@pytest.mark.parametrize("name", TO_DRAW)
def test_the_paper_to_draw_on_is_told_by_its_size_and_drawn_on_the_page(name, lang):
    handout = COURSE[name].variant(7, lang).handout()
    wide, high = handout.drawing_mm
    for shown in (handout.statement, RENDERER.notebook(handout), RENDERER.terminal(handout)):
        assert re.search(rf"{wide}\s+mm\D+{high}\s+mm", shown.replace("\\n", "\n"))
    page = RENDERER.html(handout)
    grid = page[page.index('<figure class="paper">') :]
    assert f'<svg width="{wide + 10}mm" height="{high + 6}mm" viewBox="-8 -1 {wide + 10} {high + 6}"' in grid
    across, along = re.search(r'<path d="M0 0([^M"]+)M0 \d+([^"]+)"', grid).groups()  # each by a millimetre
    assert (across, along) == (f"v{high}m1-{high}" * (wide + 1), f"h{wide}m-{wide}-1" * (high + 1))
    assert not re.search(r"\.paper \{[^}]*display: none", page)


@whole_course
def test_a_sheet_lists_what_the_statement_or_an_asked_question_uses_and_no_more():
    wrong = []
    for name in COURSE.names:
        exercise = COURSE[name]
        whole, graph, figure = exercise.variant(1, "en"), exercise.solution.graph, exercise.spec.figure
        drawn = graph_of(figure, tuple(exercise.spec.helpers)).leaves if figure else ()
        stated = bare(whole.text.opening, *(s.text for k, s in whole.text.sections.items() if "figure" in k))
        for part in exercise.judged_parts:
            asked = exercise.variant(1, "en", [part.id])  # and what is judged with it
            listed = {given.name for given in asked.handout().given}
            for given in [g for g, spec in exercise.spec.given.items() if spec.shown is not False]:
                try:
                    graph.plan(asked.asked_quantities, {*whole.used} - {given}, whole.effects)
                    is_used = False
                except (Cycle, MissingQuantity):
                    is_used = True
                may_be = is_used or given in drawn or bare(exercise.symbol(given, "en")) in stated
                if is_used > (given in listed) or (given in listed) > may_be:
                    wrong.append((name, part.id, given, is_used))
    assert not wrong


def bare(*texts):
    """Return LaTeX without braces and blanks, which may stand or not."""
    return re.sub(r"[{}\s]|\\angle", "", " ".join(texts))


@every_language
@pytest.mark.parametrize("name", COURSE.names)
def test_left_and_right_of_a_line_are_told_with_the_sense_in_which_it_runs(name, lang):
    side, way = SIDES[lang]
    handout = COURSE[name].variant(7, lang).handout()
    for given in handout.given:
        if not given.is_number and re.search(side, given.value):
            ends = way.format(r"\$?([A-Z])\$?", r"\$?([A-Z])\$?")
            assert re.search(ends, re.sub(r"\s+", " ", given.value + " " + handout.statement)), given.value
