"""A mechanism moves in a notebook: it can be dragged, and tells no more than its figure while questions are
left."""

import html
import re

import pytest
from sweeps import sampled

import coursework


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def framed(shown):
    """The page inside the output of a cell."""
    return html.unescape(re.search(r'<iframe srcdoc="([^"]*)"', shown)[1])


@pytest.mark.parametrize("lang", sampled(["fr", "en"], ["fr"]))
@pytest.mark.e2e
def test_a_notebook_moves_the_figure_alone_until_all_is_answered(lang, here):
    study = coursework.study("four_bar_motion", seed=3, lang=lang)
    shown = study.motion("acceleration")
    assert len(shown.bundles()) == 2
    before = shown.bundles()[-1]["text/html"]
    assert before.startswith("<img ")
    assert 'id="motion-data"' in framed(before)
    told = ("data-effect", "data-reading", "data-key")
    assert not [name for name in told if f"{name}=" in framed(before)]
    for part in study.variant.parts:
        study.reveal(part.id)
    after = study.motion().bundles()
    assert len(after) == 1
    assert all(f"{name}=" in framed(after[0]["text/html"]) for name in told)


@pytest.mark.parametrize("lang", sampled(["fr", "en"], ["fr"]))
@pytest.mark.e2e
def test_a_notebook_shows_no_motion_that_is_the_answer(lang, here):
    study = coursework.study("coupler_curve", seed=3, lang=lang)
    assert [*study.motion().bundles()[0]] == ["text/plain", "text/markdown"]
    assert "curve" in str(study.motion())
    study.reveal("curve")
    assert "text/html" in study.motion().bundles()[-1]
