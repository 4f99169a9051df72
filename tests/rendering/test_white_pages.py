"""No page of a paper but the last is white by more than a quarter of its height, and no data stand before their exercise."""

import random

import numpy as np
import pypdfium2
import pytest
from paper_samples import COURSE, heading, paper

from coursework.language.words import words
from coursework.rendering.renderer import renderer_of
from coursework.selfstudy.workbook.binding import bound

RENDERER = renderer_of(COURSE.folder)
MOST = 0.25


def white(page) -> float:
    """The largest share of a page's height without any ink."""
    grey = page.render(scale=0.8, grayscale=True).to_numpy()
    inked = np.flatnonzero((grey.reshape(grey.shape[:2]) < 252).any(axis=1))
    return float(np.diff(inked).max() / len(grey)) if len(inked) > 1 else 1.0


def places(pages, said: str) -> list[tuple[int, float]]:
    """Where a text stands: its page, and how far up its foot is, counted downwards."""
    found = []
    for number, page in enumerate(pages):
        text = page.get_textpage()
        search = text.search(said, match_case=True)
        while (at := search.get_next()) is not None:
            found.append((number, -text.get_charbox(at[0])[1]))
    return found


@pytest.mark.parametrize(
    "seed",
    [pytest.param(k, marks=() if k in (1, 4, 16, 25) else pytest.mark.slow) for k in range(40)],
)
def test_no_page_but_the_last_is_white_by_more_than_a_quarter(seed):
    names = tuple(random.Random(seed).sample(COURSE.names, 4))
    made = paper(heading(("fr", "en")[seed % 2]), names, seed=seed)
    pages = list(pypdfium2.PdfDocument(RENDERER.pdf(made)))
    assert {n: share for n, page in enumerate(pages[:-1], 1) if (share := white(page)) > MOST} == {}, names
    said = words(made.heading.lang)
    heads = [
        place
        for number, sheet in enumerate(made.handouts, 1)
        for place in places(pages, said["paper"]["numbered"].format(number, ""))
        if sheet.given
    ]
    data = places(pages, said["sheet"]["data"])
    assert len(data) == len(heads)
    assert all(head < place for head, place in zip(heads, sorted(data), strict=True)), names


@pytest.mark.slow
def test_no_figure_of_a_lesson_leaves_a_page_of_the_book_white():
    pdf = RENDERER.book_pdf(bound(COURSE, "en", chapters=[2], solved=False))
    pages = list(pypdfium2.PdfDocument(pdf))
    texts = [page.get_textpage().get_text_bounded() for page in pages]
    first = next(k for k, text in enumerate(texts) if text.startswith("Chapter 2."))
    last = next(k for k, text in enumerate(texts) if "Chapter 2 on a page" in text)
    shares = {k + 1: white(page) for k, page in enumerate(pages[first : last - 1], first)}
    assert {number: share for number, share in shares.items() if share > 0.28} == {}
