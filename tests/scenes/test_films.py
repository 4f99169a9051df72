"""Films: a picture of their own, over their own turns."""

from __future__ import annotations

import json

import numpy as np
import pytest
from animations import COURSE, Page
from sweeps import sampled

import coursework
from coursework.authoring.checks import check
from coursework.cli import run
from coursework.errors import BadCourse
from coursework.rendering.displayed import DisplayedAnimation as Animation

FILM = """
from coursework.degrees import polar
from coursework.figures import Figure, link, pin
from coursework.solution import Film, Moving


def _turning(turned, r):
    return Figure(link(0, polar(r, turned / 4)), pin(polar(r, turned / 4), "A"))


def _turns(r):
    return {turns}


def motion(turned, r):
    return {{"A": Moving(polar(r, turned / 4))}}


FILM = Film(_turning, angle="turned", speed="omega", turns=_turns)
"""


def filmed(small_course, turns="2.3"):
    """The small course, its exercise with a film: a bar that turns a quarter as fast as what drives it."""
    for lang in ("en", "fr"):
        text = small_course / "solutions" / f"crank_pin.{lang}.md.j2"
        text.write_text(text.read_text("utf-8") + f"\n## motion\nr = {{{{ r }}}} ({lang}).\n", "utf-8")
    source = small_course / "solutions" / "crank_pin.py"
    source.write_text(source.read_text("utf-8") + FILM.format(turns=turns), "utf-8")
    return small_course


@pytest.mark.parametrize("way", [1, -1])
def test_a_film_shows_its_own_picture_over_its_turns_at_a_steady_pace(small_course, way):
    exercise = coursework.open_course(filmed(small_course))["crank_pin"]
    given = {**exercise.variant(0).given, "omega": way * 3.0}
    moved = Animation(coursework.Variant(exercise, 0, given, "en"), count=24)
    shown = moved.angles[list(moved.order)]
    assert shown[:-1] == pytest.approx(way * 15.0 * np.arange(56))
    assert shown[-1] == pytest.approx(way * 828.0)
    assert moved.times == pytest.approx(shown / shown[-1])
    assert moved.seconds == pytest.approx(2.3 * Animation(COURSE["slotted_mechanism"].variant(0)).seconds)
    at_A = [next(e.p for e in elements if getattr(e, "label", "") == "A") for elements in moved.frames]
    assert at_A == pytest.approx(given["r"] * np.exp(1j * np.radians(moved.angles) / 4))
    assert at_A == pytest.approx(moved.points["A"].position)
    # Nothing leads from the last picture back to the first.
    path = next(t for t in moved.drawing(("position",)).tracks if t.effect == "position" and not t.mark)
    assert not path.closed
    assert not moved.closed


@pytest.mark.parametrize("lang", ["fr", "en"])
def test_a_film_has_its_own_words_and_the_page_says_that_it_starts_over(small_course, lang):
    variant = coursework.open_course(filmed(small_course))["crank_pin"].variant(0, lang)
    moved = variant.animation()
    assert moved.words.startswith("r = ")
    assert moved.words.endswith(f"({lang}).")
    page = moved.html()
    assert ("2.3 turns" if lang == "en" else "2,3 tours") in page
    assert ("statement" if lang == "en" else "énoncé") not in page
    data = json.loads(Page(page).data)
    assert data["seconds"] == pytest.approx(13.8)
    assert data["film"] is True
    assert data["angles"][72].startswith("360")  # not the first angle once more


@pytest.mark.parametrize("lang", ["fr", pytest.param("en", marks=pytest.mark.slow)])
def test_a_film_without_words_in_a_language_is_a_failure(small_course, lang):
    exercise = coursework.open_course(filmed(small_course))["crank_pin"]
    assert check(exercise, 1, rendered=0).failures == []
    text = small_course / "solutions" / f"crank_pin.{lang}.md.j2"
    text.write_text(text.read_text("utf-8").replace("## motion", "## omission"), "utf-8")
    found = check(coursework.open_course(small_course)["crank_pin"], 1, rendered=0).failures
    assert any(f"crank_pin.{lang}.md.j2" in f and "motion" in f for f in found)


@pytest.mark.parametrize("turns", ["0.0", "-1.0", "float('nan')", "float('inf')"])
def test_a_film_of_no_turns_is_refused(small_course, turns):
    exercise = coursework.open_course(filmed(small_course, turns))["crank_pin"]
    with pytest.raises(BadCourse, match=r"crank_pin.py: FILM: turns gives a number above 0"):
        exercise.variant(0).animation().svg()


@pytest.mark.parametrize(
    ("right", "wrong", "told"),
    [
        ('speed="omega"', 'speed="omga"', "speed='omga' is not a given quantity"),
        ("FILM = Film(_turning", "FILM = Film(lambda: None", "figure gives a Figure"),
        ("2.3", "'2.3'", "turns gives a number"),
        ("2.3", "1e9", "turns gives a number above 0, at most"),
    ],
)
def test_a_film_that_cannot_be_shown_is_told_by_check(small_course, right, wrong, told):
    source = filmed(small_course) / "solutions" / "crank_pin.py"
    text = source.read_text("utf-8")
    assert right in text
    source.write_text(text.replace(right, wrong), "utf-8")
    found = check(coursework.open_course(small_course)["crank_pin"], 1, rendered=1).failures
    assert any(told in fault and "crank_pin.py: FILM" in fault for fault in found), found


def test_a_film_that_is_none_is_refused(small_course):
    source = filmed(small_course) / "solutions" / "crank_pin.py"
    source.write_text(source.read_text("utf-8") + "\nFILM = _turning\n", "utf-8")
    with pytest.raises(BadCourse, match=r"crank_pin.py: FILM is a Film"):
        coursework.open_course(small_course)["crank_pin"].variant(0).animation()


@pytest.mark.e2e
@pytest.mark.parametrize("lang", sampled(["fr", "en"], ["fr"]))
def test_the_command_writes_a_film_in_both_languages(tmp_path, lang):
    assert (
        run(["animate", "ball_reducer", "--lang", lang, "--effects", "velocity", "--out", str(tmp_path)]) == 0
    )
    page = (tmp_path / "ball_reducer.html").read_text("utf-8")
    assert f'<html lang="{lang}">' in page
    assert "<animate" in (tmp_path / "ball_reducer.svg").read_text("utf-8")
