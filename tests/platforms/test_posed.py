"""What a platform is told of a question is what our marking gives, on a sheet that is blank but for the
answer."""

from __future__ import annotations

import html
import itertools
import re

import pytest
from course_of_every_kind import write_course

import coursework
from coursework.language.numbers import plain, significant
from coursework.markup.markdown import html_inline
from coursework.platforms.items import item
from coursework.platforms.pieces import PagePieces
from coursework.platforms.posed import CHOICE, CHOICES, COLLECTED, KINDS, NUMBER
from coursework.rendering.renderer import renderer_of

COURSE = coursework.open_course()
SEEDS = (3, pytest.param(8, marks=pytest.mark.slow))
COUNTED = ("comma", "unit_written", "unit_refused", "turns", "unreadable")  #: features of numbers alone

every_exercise = pytest.mark.parametrize("name", COURSE.names)
every_seed = pytest.mark.parametrize("seed", SEEDS)


def earned(variant, part, answer):
    """The share of its points that an answer earns, and its verdict."""
    mark = variant.grade({part.id: answer})[part.id]
    return mark.points / mark.out_of, mark.verdict


def posed_parts(name, seed, *kinds):
    variant = COURSE[name].variant(seed, "en")
    made = item(variant, "pool")
    for posed, part in zip(made.questions, variant.parts, strict=True):
        if posed.kind in kinds:
            yield variant, posed, part


@every_exercise
@every_seed
def test_right_answers_are_right_from_edge_to_edge(name, seed):
    for variant, posed, part in posed_parts(name, seed, NUMBER):
        for one in (one for one in posed.intervals if one.is_right):
            for value in (one.low, one.value, one.high):
                assert earned(variant, part, repr(value)) == (1, "correct"), (part.id, value)


@every_exercise
@every_seed
def test_beyond_the_edges_nothing_is_right(name, seed):
    for variant, posed, part in posed_parts(name, seed, NUMBER):
        one = posed.intervals[0]
        off = 1.001 * one.half if one.half else 1
        for value in (one.value - off, one.value + off):
            assert earned(variant, part, repr(value))[1] != "correct", (part.id, value)


@every_exercise
@every_seed
def test_what_a_known_error_gives_earns_its_share(name, seed):
    """In its middle, with the digits that students write: of the first interval that holds it."""
    for variant, posed, part in posed_parts(name, seed, NUMBER):
        for one in posed.intervals:
            text = plain(one.value) if part.is_exact else significant(one.value, 7)
            first = next(i for i in posed.intervals if i.low <= float(text) <= i.high)
            assert earned(variant, part, text)[0] == pytest.approx(first.share), (part.id, text, one.verdict)


@every_exercise
@every_seed
def test_options_earn_their_share(name, seed):
    for variant, posed, part in posed_parts(name, seed, CHOICE):
        assert [option.letter for option in posed.options] == list("abcdefghijklmnop")[: len(posed.options)]
        for option in posed.options:
            for answer in (option.case, option.letter):
                assert earned(variant, part, answer)[0] == pytest.approx(option.share), (part.id, answer)
        assert [option.share for option in posed.options].count(1) == 1


@every_exercise
@every_seed
def test_right_ones_come_before_errors_and_sentences_give_no_reference(name, seed):
    for variant, posed, part in posed_parts(name, seed, NUMBER):
        rights = [one.is_right for one in posed.intervals]
        assert rights == sorted(rights, reverse=True)
        assert rights[0]
        reference = significant(float(variant.key.reference[part.quantity]), 4)
        for one in posed.intervals:
            assert bool(one.message) != one.is_right, (part.id, one)
            if not part.is_exact and abs(one.value - float(reference)) > one.half:
                assert f": {reference} " not in one.message, (part.id, one)


@every_exercise
@every_seed
def test_every_part_is_posed_and_says_why_where_it_is_collected(name, seed):
    variant = COURSE[name].variant(seed, "en")
    made = item(variant, "pool")
    assert [posed.question.id for posed in made.questions] == [part.id for part in variant.parts]
    assert made.points == sum(part.points for part in variant.parts)
    for posed, part in zip(made.questions, variant.parts, strict=True):
        assert posed.kind in KINDS
        assert (
            ("collected" in posed.features)
            == (posed.kind == COLLECTED)
            == (not posed.intervals + posed.options)
        )
        if posed.kind == COLLECTED:
            assert not posed.features.intersection(COUNTED)
            assert (
                part.judge
                or not part.sort.is_scalar
                or posed.features & {"either_order", "unit_asked", "form"}
            )


@every_exercise
def test_the_same_item_in_both_languages_judges_alike(name):
    variant = COURSE[name].variant(3, "en")
    one, other = item(variant, "pool"), item(variant.in_language("fr"), "pool")
    assert one.identifier.removesuffix("en") == other.identifier.removesuffix("fr")
    for english, french in zip(one.questions, other.questions, strict=True):
        assert english.features == french.features
        assert [(i.low, i.high, i.share) for i in english.intervals] == [
            (i.low, i.high, i.share) for i in french.intervals
        ]
        assert [(o.case, o.letter, o.share) for o in english.options] == [
            (o.case, o.letter, o.share) for o in french.options
        ]


def test_several_right_ones_share_the_points(tmp_path):
    """Each right case gives its share, each wrong one takes as much, and all together give nothing.

    Answers without a number, and those that a person marks, are collected.
    """
    course = coursework.open_course(write_course(tmp_path))
    variant = course[course.names[0]].variant(1, "en")
    kinds = {}
    for posed, part in zip(item(variant, "pool").questions, variant.parts, strict=True):
        kinds[part.id] = posed.kind
        if posed.kind == CHOICES:
            right = [option.share for option in posed.options if option.share > 0]
            wrong = [-option.share for option in posed.options if option.share < 0]
            assert right == [1 / len(right)] * len(right)
            assert wrong == [max(1 / len(right), 1 / len(wrong))] * len(wrong)
            for count in range(1, len(posed.options) + 1):
                for named in itertools.combinations(posed.options, count):
                    answer = ", ".join(option.case for option in named)
                    share = max(0.0, sum(option.share for option in named))
                    assert earned(variant, part, answer)[0] == pytest.approx(share), answer
    assert kinds["true_of_it"] == CHOICES
    assert {kinds[one] for one in ("Z", "I", "drops", "M", "why", "sketch")} == {COLLECTED}


@pytest.mark.parametrize("lang", ["en", "fr"])
@every_exercise
def test_options_are_read_as_reports_make_plain_text_of_them(name, lang):
    """Letter and words as a platform's report has them, formulas without their layout: the same as the letter
    alone."""
    variant = COURSE[name].variant(3, lang)
    pieces = PagePieces(renderer_of(COURSE.folder).template_folders, lang)
    for posed, part in zip(item(variant, "pool").questions, variant.parts, strict=True):
        for option in posed.options:
            flat = " ".join(html.unescape(re.sub(r"<[^>]*>", "", pieces.option(option))).split())
            assert earned(variant, part, flat) == earned(variant, part, option.letter), (part.id, flat)


def test_a_line_is_the_same_whether_its_digits_were_blank_or_not():
    pieces = PagePieces(renderer_of(COURSE.folder).template_folders, "fr")
    lines = (
        "$r_2$ : −193,70 mm est 2 fois trop grand.",
        "1. 12 mm",
        "a\n2) b",
        "`x1`",
        "&#49;2",
        "[1](http://a.b/2)",
        "$$x_1$$ 3",
        "cost 5$, or 6",
        r"5 \$ and 6 $x_1$ 7",
        "**faux** (0,5/2) 12 % de 3,5 rad/s ; 7 !",
        "\N{MATHEMATICAL MONOSPACE DIGIT ZERO} 1",
        "# 4",
        "<b>5</b>",
    )
    for line in lines:
        assert pieces.inline(line) == html_inline(line, "fr"), line
