"""Every picture is told in words, in the sheet's language, with the points it shows, and without an
answer."""

from __future__ import annotations

import json
import re
import zlib
from contextlib import suppress
from html.parser import HTMLParser

import pytest

import coursework
from coursework.figures import Figure, ball, contact, ground_pivot, pin, point, slider
from coursework.rendering.displayed import DisplayedAnimation as Animation
from coursework.rendering.renderer import renderer_of
from coursework.sheets.drawings import solution_figure

COURSE = coursework.open_course()
LANGS = ("fr", "en")
WITH_FIGURE = [n for n in COURSE.names if COURSE[n].spec.figure is not None]
WITH_OWN = [n for n in COURSE.names if COURSE[n].solution.figure is not None]
DRIVEN = [n for n in COURSE.names if COURSE[n].spec.driver is not None]
FILMED = [n for n in COURSE.names if COURSE[n].film is not None]
COMMON = {"fr": {"de", "la", "le", "les", "et", "à"}, "en": {"the", "of", "and", "a", "at"}}

both = pytest.mark.parametrize("lang", LANGS)


class Images(HTMLParser):
    """The alternative texts of a page's pictures."""

    def __init__(self, page):
        super().__init__()
        self.told = []
        self.feed(page)

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        if tag == "img":
            self.told.append(attrs.get("alt"))
        elif tag == "svg" and attrs.get("role") == "img":  # other ones are icons, or are drawn on
            self.told.append(attrs.get("aria-label"))


def plainly(words):
    """Without a language's own apostrophes and spaces, which each format writes as it can."""
    return words.replace("\u2019", "'").replace("\u202f", " ").replace("\xa0", " ")


def points_shown(figure):
    """Names of points, as words write them: ``O_4`` is O4."""
    if not any(isinstance(e, ground_pivot | ball) for e in figure.elements):
        return set()  # a graph: its letters are kinds of joints
    named = [e.label for e in figure.elements if isinstance(e, ground_pivot | pin | point | contact | slider)]
    return {label.replace("_", "") for label in named if label and re.fullmatch(r"[A-Z](_\d)?", label)}


def on_the_line(words):
    """Return words with subscripts as digits: ``O₄`` is O4."""
    return words.translate(str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789"))


def assert_tells(words, figure, lang):
    assert words
    assert len(words.split()) >= 8
    assert not re.search(r"[{}$\\]", words)
    found = set(re.findall(r"\w+", words.lower()))
    other = "en" if lang == "fr" else "fr"
    assert len(found & COMMON[lang]) > len(found & (COMMON[other] - COMMON[lang]))
    said = " ".join(re.findall(r"\b(?:[A-Z]\d?)+\b", on_the_line(words)))
    assert points_shown(figure) <= set(re.findall(r"[A-Z]\d?", said))


@pytest.mark.parametrize("name", WITH_FIGURE)
@both
def test_a_statements_figure_is_told_in_every_format_without_an_answer(name, lang):
    variant = COURSE[name].variant(1, lang)
    words = " ".join(variant.text.section("figure").text.split())
    assert_tells(words, variant.figure, lang)
    numbers = set(re.findall(r"(?<![\w.,])\d+(?:[.,]\d+)?", words))
    printed = " ".join(str(v) for v in variant.printed.values()) + str(variant.text.opening)
    assert all(number in printed for number in numbers)
    told, *paper = Images(renderer_of(COURSE.folder).html(variant.handout())).told
    assert plainly(told) == plainly(words)
    assert len(paper) == bool(COURSE[name].spec.drawing_mm)
    notebook = json.loads(renderer_of(COURSE.folder).notebook(variant.handout()))
    shown = ["".join(c["source"]) for c in notebook["cells"] if c.get("attachments")]
    told = [re.search(r"!\[(.*?)\]\(attachment:", one)[1] for one in shown]
    assert list(map(plainly, told)) == [plainly(words)]


@pytest.mark.parametrize("name", WITH_OWN)
@both
def test_a_solutions_own_figure_has_its_own_words(name, lang):
    variant = COURSE[name].variant(1, lang)
    told, *drawings = Images(renderer_of(COURSE.folder).html(variant.answer_sheet())).told
    assert_tells(told, solution_figure(variant), lang)
    assert all(drawings)
    assert bool(drawings) == bool(variant.polygons())
    assert told != " ".join(variant.text.section("figure").text.split())


@pytest.mark.parametrize("name", DRIVEN)
@both
def test_a_moving_figure_is_told_as_its_still_one(name, lang):
    animation = Animation(COURSE[name].variant(1, lang), count=12)
    words = " ".join(COURSE[name].variant(1, lang).text.section("figure").text.split())
    (told,) = Images(animation.html()).told
    assert told == animation.words
    assert plainly(told) == plainly(words)
    assert f"<desc>{told}</desc>" in animation.svg()


@pytest.mark.parametrize("name", FILMED)
@both
def test_a_film_is_told_in_its_own_words(name, lang):
    variant = COURSE[name].variant(1, lang)
    animation = Animation(variant, count=12)
    (told,) = Images(animation.html()).told
    assert told == animation.words
    assert f"<desc>{told}</desc>" in animation.svg()
    assert_tells(plainly(told), Figure(*animation.frames[0]), lang)
    assert {point.replace("_", "") for point in animation.points} <= set(
        re.findall(r"[A-Z]\d?", on_the_line(told))
    )
    assert plainly(told) != plainly(" ".join(variant.text.section("figure").text.split()))
    assert plainly(told) not in plainly(renderer_of(COURSE.folder).html(variant.handout()))


def alternatives(pdf):
    """The alternative texts in the tags of a PDF, whose objects are compressed."""
    parts = [pdf]
    for stream in re.findall(rb"stream\r?\n(.*?)\r?\nendstream", pdf, re.DOTALL):
        with suppress(zlib.error):
            parts.append(zlib.decompress(stream))
    objects = b"\n".join(parts)
    wide = re.findall(rb"/Alt\s*<FEFF([0-9A-F]*)>", objects)
    plain = re.findall(rb"/Alt\s*\(((?:[^()\\]|\\.|\([^()]*\))*)\)", objects)
    return {bytes.fromhex(text.decode()).decode("utf-16-be") for text in wide} | {
        re.sub(r"\\(.)", r"\1", text.decode("latin-1")) for text in plain
    }


@pytest.mark.parametrize("name", ["ball_reducer", "four_bar_motion", "grashof"])
@both
def test_the_pdf_carries_the_words_of_its_figure(name, lang):
    variant = COURSE[name].variant(1, lang)
    words = " ".join(variant.text.section("figure").text.split())
    told = alternatives(renderer_of(COURSE.folder).pdf(variant.handout()))
    assert plainly(words) in set(map(plainly, told))
