"""Nothing is dropped in silence: what our marking does with a part, each platform keeps, or has a sentence
for what it does instead."""

from __future__ import annotations

import pytest
from tables import each_row

import coursework
from coursework.errors import BadCourse
from coursework.language.words import words
from coursework.platforms.items import Loss, item
from coursework.platforms.losses import (
    feature_words,
    loss_lines,
    loss_row,
    losses,
    lost_words,
    platform_words,
)
from coursework.platforms.platform import platform_of, platforms
from coursework.platforms.pools import of_exercises
from coursework.platforms.posed import COLLECTED

COURSE = coursework.open_course()
LANGS = ("en", "fr")

every_platform = pytest.mark.parametrize("platform", platforms())
every_exercise = pytest.mark.parametrize("name", COURSE.names)


@every_platform
@each_row("lang", LANGS)
def test_every_platform_has_its_words(platform, lang):
    """A sentence a feature, all of features that there are; steps of how to import."""
    said = words(lang)["platforms"]
    assert set(lost_words(platform, lang)) <= set(said["features"])
    assert all(sentence.strip() for sentence in lost_words(platform, lang).values())
    assert len(said["steps"][platform]) == 6
    assert set(lost_words(platform, "fr")) == set(lost_words(platform, "en"))


@each_row("section", ("lost", "steps"))
def test_a_platform_without_words_is_told(section):
    with pytest.raises(BadCourse, match=rf"'nowhere' has no words.* lacks platforms\.{section}\.nowhere"):
        platform_words(section, "nowhere", "en")


@pytest.fixture(scope="module")
def pools():
    made = {}

    def pool(name):
        if name not in made:
            made[name] = of_exercises(COURSE, [name], 1, 0, ["en"], None).pool("en", platform_of("moodle"))
        return made[name]

    return pool


@every_exercise
def test_moodle_lists_what_it_does_not_do(pools, name):
    """By what the parts are, and not by what is posed: collected parts, commas, units, right methods from a
    wrong answer."""
    pool = pools(name)
    listed = {(loss.part, loss.feature) for loss in losses(pool, "moodle")}
    given = item(COURSE[name].variant(int(pool.items[0].identifier.split(".")[-2]), "en"), pool.name)
    variant = given.variant
    assert ("", "corrected") in listed
    assert (("", "drawing_paper") in listed) == (given.handout.drawing_mm is not None)
    parts = {part.id: part for part in variant.parts}
    for posed in given.questions:
        part, features = parts[posed.question.id], {f for p, f in listed if p == posed.question.id}
        if posed.kind == COLLECTED:
            assert features & {"open", "judged_together", "either_order", "none_right", "form", "unit_asked"}
            assert not features & {"comma", "unit_written", "unreadable", "usual_errors"}
        elif part.sort.is_scalar:
            assert {"unreadable", "usual_errors"} <= features
            assert ("comma" in features) != part.is_exact
            assert {"unit_written", "unit_refused"}.isdisjoint(features) == (part.unit == "1")
        asked = {p.quantity for p in variant.parts[: variant.parts.index(part)] if p.sort.is_followed}
        ancestors = set(variant.exercise.plan((part.quantity,))) - {part.quantity}
        if part.sort.follows and part.sort.is_followed and asked & ancestors:
            assert "follow_through" in features


def test_what_a_platform_has_no_word_for_is_kept_and_more_is_added(pools):
    pool = pools("grashof")
    more = Loss("grashof", "s_l", "fraction", "rounded")
    found = losses(pool, "moodle", [more])
    assert more in found
    assert not any(loss.feature in ("mistakes", "partial", "one_variant") for loss in found)
    assert loss_row(more, "fr")["feature"] == feature_words("fraction", "fr")


def test_a_line_a_feature_says_of_how_many_parts(pools):
    lost = losses(pools("slotted_mechanism"), "moodle")
    lines = list(loss_lines(lost, "en"))
    assert len(lines) == len({loss.feature for loss in lost})
    commas = sum(loss.feature == "comma" for loss in lost)
    assert any(line.startswith(f"decimal comma (parts: {commas}, exercises: 1): ") for line in lines)
    assert any(line.startswith("corrected set (exercises: 1): ") for line in lines)


@every_platform
def test_a_platform_is_asked_for_by_the_name_of_its_file(platform):
    assert platform_of(platform).name == platform
