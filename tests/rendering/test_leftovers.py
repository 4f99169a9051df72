"""No page of a handout holds a few questions that are left over: where a page's end parts them, four at least
come after it. In a solution a question and its answer stand on one page."""

from __future__ import annotations

import json
import multiprocessing
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from itertools import product

import pytest
import typst
from paper_samples import COURSE, NAMES, bare, heading, paper, solution
from rendering_samples import handout
from sweeps import at_once, sampled, whole_course

from coursework.language.words import languages
from coursework.rendering.papers import typst_source
from coursework.rendering.renderer import PAPERS, renderer_of
from coursework.rendering.views import LAST_TOGETHER, SHORT_SOLUTION, worked

RENDERER = renderer_of(COURSE.folder)
every_language = pytest.mark.parametrize("lang", sampled(languages(), ["fr"]))
every_paper = pytest.mark.parametrize("size", PAPERS)

_NUMBER = "strong[#number.]"


@pytest.fixture(scope="module")
def marked_in():
    """What is marked ``<found>`` in a text that is typeset: by another process, since the typesetter keeps 10
    MB of each."""
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(1, spawn, max_tasks_per_child=40) as pool:
        yield lambda source: json.loads(
            pool.submit(typst.query, source.encode(), "<found>", field="value").result()
        )


@pytest.fixture(scope="module")
def pages_of_questions(marked_in):
    """The page of each question, in order: a mark that takes no room stands in its number."""

    def pages(source: str) -> list[int]:
        assert source.count(_NUMBER) == 2  # in the two forms of a question
        return marked_in(
            source.replace(_NUMBER, "strong[#number.#context [#metadata(here().page()) <found>]]")
        )

    return pages


def assert_none_left_over(pages: list[int]) -> None:
    last = pages.count(pages[-1])
    assert last >= min(LAST_TOGETHER, len(pages)), pages


@every_language
@every_paper
@pytest.mark.parametrize("seed", [2, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (1, 3, 4))])
@at_once(COURSE.names, COURSE.names[::3])
def test_no_handout_has_a_page_of_a_few_questions_that_are_left_over(
    pages_of_questions, size, lang, seed, names
):
    parted = 0
    for name in names:
        sheet = COURSE[name].variant(seed, lang).handout("Zoé Martin")
        pages = pages_of_questions(RENDERER.on(size).typst(sheet))
        assert_none_left_over(pages)
        parted += len(set(pages)) > 1
    assert parted >= len(names) // 8


@every_language
@every_paper
@pytest.mark.e2e
def test_nor_has_a_paper(pages_of_questions, size, lang):
    made = paper(heading(lang), (*NAMES, "four_bar_motion"))
    source = typst_source(RENDERER.template_folders, [made], size)
    pages = pages_of_questions(source)
    start = 0
    for sheet in made.handouts:
        assert_none_left_over(pages[start : start + len(sheet.questions)])
        start += len(sheet.questions)
    assert start == len(pages)


@pytest.mark.e2e
def test_questions_too_tall_to_stay_together_take_the_pages_that_they_need(pages_of_questions):
    sheet = handout("en")
    tall = [
        replace(q, number=n, box="blank", room=(100, 110)) for n, q in enumerate(sheet.questions[:6], start=1)
    ]
    pages = pages_of_questions(RENDERER.typst(replace(sheet, questions=tuple(tall))))
    assert pages == sorted(pages)
    assert max(pages.count(page) for page in pages) <= 2


# ---------------------------------------------------------------------- solutions

_ASKED, _ANSWERED = "strong(number), prompt, small(points),", 'text(weight: "bold", fill: ink, label)'
_PLACE = "here().page(), here().position().y.mm()"


@pytest.fixture(scope="module")
def places_in_solution(marked_in):
    """For each question the page it stands on, that of its answer, and how far down that is, mm."""

    def places(source: str) -> list[tuple[float, float, float]]:
        assert source.count(_ASKED) == source.count(_ANSWERED) == 1
        marked = source.replace(
            _ASKED, f"[#strong(number)#context [#metadata((0, {_PLACE})) <found>]], prompt, small(points),"
        ).replace(_ANSWERED, f"[#{_ANSWERED}#context [#metadata((1, {_PLACE})) <found>]]")
        found = marked_in(marked)
        asked, answered = ([place for which, *place in found if which == one] for one in (0, 1))
        return [(one[0], *two) for one, two in zip(asked, answered, strict=True)]

    return places


@whole_course
@pytest.mark.parametrize("printed", sampled(product(PAPERS, languages()), [("letter", "fr")]), ids="-".join)
def test_a_question_of_a_solution_stands_on_one_page_with_its_answer_where_that_takes_few_steps(
    places_in_solution, printed
):
    size, lang = printed
    high, short = {"a4": 297, "letter": 279}[size], 0
    for name in COURSE.names:
        made = solution(bare(lang), (name,), 2)
        steps = [len(steps) for _, steps in worked(made.sheets[0], lang)]
        found = places_in_solution(typst_source(RENDERER.template_folders, [made], size))
        for count, (asked, answered, down) in zip(steps, found, strict=True):
            assert down < high - 16, name
            assert asked == answered or count > SHORT_SOLUTION, name
            short += count <= SHORT_SOLUTION
    assert short > 200
