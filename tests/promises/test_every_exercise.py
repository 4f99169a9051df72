"""The promises that every registered exercise keeps. An empty registry fails at collection."""

from __future__ import annotations

import re
from functools import cache

import numpy as np
import pytest
import sweeps
from sweeps import slow

import coursework
from coursework.authoring import checks
from coursework.authoring.check_report import CheckReport
from coursework.course.draws import BLOCK
from coursework.language.words import languages
from coursework.rendering.renderer import renderer_of

COURSE = coursework.open_course()
FEW, MANY = 5, 30  #: variants

every_exercise = pytest.mark.parametrize("name", COURSE.names)
every_language = pytest.mark.parametrize("lang", languages())
every_seed = sweeps.seeds(FEW, MANY)


@cache
def keys(name, seeds=range(FEW)):
    return [v.key for v in COURSE[name].variants(seeds)]


def failures(name, check, *arguments):
    report = CheckReport(name)
    check(*arguments, report)
    assert sum(report.counts.values()) > 0 or report.mistakes, "the check tried nothing"
    return report.failures


@every_exercise
def test_known_cases_come_out(name):
    assert failures(name, checks.check_known, COURSE[name]) == []


@every_exercise
@every_seed
def test_answers_satisfy_the_governing_equations(name, seeds):
    for key in keys(name, seeds):
        assert failures(name, checks.check_solves, key.variant, key) == []


@every_exercise
@every_seed
def test_arrays_give_what_scalars_give(name, seeds):
    assert failures(name, checks.check_arrays, COURSE[name], [k.variant for k in keys(name, seeds)]) == []


@every_exercise
@every_seed
def test_right_answers_mark_right_in_every_spelling(name, seeds):
    for key in keys(name, seeds):
        assert failures(name, checks.check_right_answers, key.variant, key) == []


@every_exercise
@every_seed
def test_each_mistake_marks_as_that_mistake(name, seeds):
    for key in keys(name, seeds):
        assert failures(name, checks.check_mistakes, key.variant, key) == []
    assert len(COURSE[name].solution.mistakes) >= 3


@every_exercise
def test_nonsense_is_never_right(name):
    assert failures(name, checks.check_nonsense, keys(name)[0].variant) == []


@every_exercise
def test_texts_are_complete_in_every_language(name):
    assert failures(name, checks.check_texts, COURSE[name]) == []


@every_exercise
@pytest.mark.parametrize("count", [1, pytest.param(2, marks=slow)])
def test_sheets_render_in_every_format_and_language(name, count):
    report = CheckReport(name)
    checks.check_rendering(COURSE[name], count, report)
    assert report.counts["sheets rendered"] == count * 5 * len(languages())


@every_exercise
@every_seed
def test_just_beyond_the_tolerance_is_not_right(name, seeds):
    for key in keys(name, seeds):
        for part in key.variant.parts:
            if part.kind not in ("number", "angle") or not part.has_margin:
                continue
            value = key.reference[part.quantity]
            for side in (-1, 1):
                width = max(part.half_width(value), key.envelope[part.quantity])
                inside = value + side * 0.99 * width
                beyond = value + side * 1.01 * width
                assert key.variant.grade({part.id: inside})[part.id].verdict == "correct"
                assert key.variant.grade({part.id: beyond})[part.id].verdict != "correct"


@every_exercise
def test_an_angle_and_a_full_turn_more_is_the_same_angle_but_an_amount_is_not(name):
    key = keys(name)[0]
    for part in key.variant.parts:
        value = key.reference[part.quantity]
        if part.kind == "angle":
            marks = [key.variant.grade({part.id: angle})[part.id] for angle in (value, value + 360)]
            assert marks[0].verdict == marks[1].verdict in ("correct", "slip:not_drawn")
        elif part.unit == "deg":
            assert key.variant.grade({part.id: value + 360})[part.id].verdict != "correct"


@every_exercise
def test_a_request_computes_what_it_needs_and_nothing_else(name):
    exercise = COURSE[name]
    graph = exercise.solution.graph
    for part in exercise.spec.parts:
        if part.sort.is_open:
            continue  # no quantity: a person marks it
        plan = exercise.plan((part.quantity,))
        assert plan[-1] == part.quantity
        # Taking any step out starves the request: every step is needed.
        for step in plan[:-1]:
            later = plan[plan.index(step) + 1 :]
            assert any(step in graph.node(n).needs for n in later)


@every_exercise
def test_at_least_one_draw_in_ten_is_a_variant(name):
    assert COURSE[name].draws.acceptance() > 0.1


@every_exercise
def test_variants_are_nearly_all_different(name):
    drawn = COURSE[name].variants(range(300))
    assert len({tuple(v.given.values()) for v in drawn}) >= 290


@every_exercise
def test_a_seed_draws_the_same_alone_and_in_company(name):
    exercise = COURSE[name]
    together = exercise.variants([7, 3, 3 + BLOCK, 7])
    assert dict(together[0].given) == dict(exercise.variant(7).given) == dict(together[3].given)
    assert dict(together[1].given) == dict(exercise.variant(3).given)


@every_exercise
@every_seed
def test_given_values_are_the_decimals_that_are_printed(name, seeds):
    for key in keys(name, seeds):
        handout = key.variant.handout()
        for given in handout.given:
            if given.is_number:
                assert float(given.value) == key.variant.given[given.name]
                assert len(given.value.lstrip("-")) <= 6


@every_exercise
def test_a_record_gives_back_its_variant(name):
    for key in keys(name)[:5]:
        again = COURSE[name].from_record(key.variant.record)
        assert again.record == key.variant.record
        assert {k: np.asarray(v).tolist() for k, v in again.solution().items()} == {
            k: np.asarray(v).tolist() for k, v in key.reference.items()
        }


#: In a sheet's source: a drawing, its size, and where its letters stand.
PLACES_ON_PAPER = r'<svg.*?</svg>|size: \([^)]*\)|letters: "(?:[^"\\]|\\.)*"'

#: In a page: drawings, also those within its styles, and the styles.
PLACES_ON_PAGE = r'<svg.*?</svg>|<style.*?</style>|data:image/svg[^"]*'


@every_exercise
@every_language
@sweeps.seeds(1, 3)
def test_a_handout_holds_no_answer(name, lang, seeds):
    """No reference value, to four digits, stands in what the student receives, but where it is a given
    one."""
    for key in keys(name)[seeds.start : seeds.stop]:
        handout, renderer = key.variant.in_language(lang).handout(), renderer_of(COURSE.folder)
        given = {f"{abs(v):.4g}" for v in key.variant.given.values() if isinstance(v, float)}
        texts = {
            "page": re.sub(PLACES_ON_PAGE, "", renderer.html(handout), flags=re.DOTALL),
            "notebook": re.sub(r'"image/png": "[^"]*"', "", renderer.notebook(handout)),
            "sheet": re.sub(PLACES_ON_PAPER, "", renderer.typst(handout), flags=re.DOTALL),
            "source": renderer.tex(handout, ["f.pdf"]).partition(r"\begin{document}")[2].replace("{,}", ","),
            "terminal": renderer.terminal(handout),
        }
        for part in key.variant.parts:
            value = key.reference[part.quantity]
            printed = f"{abs(value):.4g}" if part.kind in ("number", "angle") else "1"
            if len(printed.replace(".", "")) < 4 or printed in given or "e" in printed:
                continue  # too short to tell from other numbers
            for where, text in texts.items():
                for spelling in (printed, printed.replace(".", ",")):
                    found = re.search(rf"(?<![0-9.,#]){re.escape(spelling)}", text)
                    assert not found, f"{part.id} = {spelling} stands in the {where}"


@every_exercise
def test_a_french_page_parts_no_high_mark_from_its_word(name):
    variant = keys(name)[0].variant.in_language("fr")
    for sheet in (variant.handout(), variant.answer_sheet(polygons=False)):
        page = renderer_of(COURSE.folder).html(sheet)
        text = re.sub(r"<(style|script).*?</\1>|<[^>]*>", "", page, flags=re.DOTALL)
        assert not re.findall(r"\S*[ \u00a0][;:!?»](?=\s|$)", text)


@every_exercise
def test_the_textbook_formulas_give_what_the_stable_ones_give(name):
    """On the variants that are handed out; where they differ, it is at places that no student meets."""
    exercise = COURSE[name]
    graph = exercise.solution.graph
    for variant in exercise.variants(range(20)):
        asked = variant.asked_quantities
        stable = graph.evaluate(asked, variant.used, variant.effects)
        plain = graph.textbook.evaluate(asked, variant.used, variant.effects)
        for quantity in asked:
            if np.asarray(stable[quantity]).dtype.kind == "U":
                assert plain[quantity] == stable[quantity]
            else:
                size = 360.0 if exercise.units.get(quantity) == "deg" else np.max(np.abs(stable[quantity]))
                assert plain[quantity] == pytest.approx(stable[quantity], rel=1e-10, abs=1e-10 * size)
