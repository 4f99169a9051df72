"""No page of a paper but the last is white by more than a quarter of its height; a cover bears its table alone."""

import random

import numpy as np
import pypdfium2
import pytest
from paper_samples import COURSE, heading, paper

from coursework.rendering.renderer import renderer_of

RENDERER = renderer_of(COURSE.folder)
MOST = 0.25


def white(page) -> float:
    """The largest share of a page's height without any ink."""
    grey = page.render(scale=0.8, grayscale=True).to_numpy()
    inked = np.flatnonzero((grey.reshape(grey.shape[:2]) < 252).any(axis=1))
    return float(np.diff(inked).max() / len(grey)) if len(inked) > 1 else 1.0


@pytest.mark.parametrize(
    "seed", [1, 4, 28, 38, *(pytest.param(k, marks=pytest.mark.slow) for k in range(40))]
)
def test_no_page_but_the_last_is_white_by_more_than_a_quarter(seed):
    names = tuple(random.Random(seed).sample(COURSE.names, 4))
    made = paper(heading(("fr", "en")[seed % 2]), names, seed=seed)
    pages = list(pypdfium2.PdfDocument(RENDERER.pdf(made)))[:-1]
    assert {n: share for n, page in enumerate(pages, 1) if (share := white(page)) > MOST} == {}, names
