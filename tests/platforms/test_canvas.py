"""The Canvas export, read back by another reader and judged as Canvas judges, agrees with our marking."""

from __future__ import annotations

import re
from functools import cache
from xml.etree import ElementTree as ET

import pytest
from platforms.canvas_reader import quiz_of, share_of_chosen, takes_number, unpacked
from tables import each_row

from coursework.api import open_course
from coursework.authoring.scaffold import new_course
from coursework.platforms.platform import platform_of
from coursework.platforms.pools import of_exercises
from coursework.platforms.posed import mark_alone
from coursework.sheets.handout import handout

LANGS = ("en", "fr")
#: Numbers, angles, choices, several cases, equations, other parts in other variants.
EXERCISES = ("slotted_mechanism", "four_bar_positions", "vocabulary", "mobility", "parallel_joints")


@pytest.fixture(scope="module")
def drawn(course):
    return of_exercises(course, EXERCISES, 3, 0, LANGS, None)


CANVAS = platform_of("canvas")


@cache
def packed(drawn, lang):
    (file,) = CANVAS.files(drawn.pool(lang, CANVAS))
    return str(file.path), file.make()


@cache
def quiz(drawn, lang):
    return quiz_of(unpacked(packed(drawn, lang)[1]))


def questions(drawn, lang):
    """Each question of the quiz with the variant and part that its label names."""
    variants = {
        (issue.variant.exercise.name, str(issue.variant.seed)): issue.variant for issue in drawn.issues
    }
    for _, _, some in quiz(drawn, lang).values():
        for one in some:
            exercise, seed, _, lang, part, *_ = one["label"][1:-1].split(" · ")
            variant = variants[exercise, seed].in_language(lang)
            yield one, variant, next(p for p in variant.parts if p.id == part)


@each_row("lang", LANGS)
@pytest.mark.e2e
def test_a_student_gets_each_question_once_and_all_points(drawn, lang):
    found = quiz(drawn, lang)
    assert sum(pick * points for pick, points, _ in found.values()) == drawn.pool(lang, CANVAS).points
    for _, points, some in found.values():
        assert some
        assert {one["points"] for one in some} == {points}
    for exercise in EXERCISES:
        homes: dict[str, set[str]] = {}
        for title, (_, _, some) in found.items():
            for one in some:
                name, _, _, _, part, *_ = one["label"][1:-1].split(" · ")
                if name == exercise:
                    homes.setdefault(part, set()).add(title)
        assert all(len(titles) == 1 for titles in homes.values())


@each_row("lang", LANGS)
@pytest.mark.e2e
def test_numbers_are_taken_as_we_take_them(drawn, lang):
    tried = 0
    for one, variant, part in questions(drawn, lang):
        if one["sort"] != "numerical_question":
            continue
        reference, half = float(variant.key.reference[part.quantity]), variant.key.half_width(part)
        for off in (0, 0.9, -0.9, 1.1, -3):
            value = reference + off * (half or 0.6)
            typed = f"{value:.4f}" if half else f"{round(value)}"
            if half and abs(abs(off) - 1) * half < 2e-4:
                continue
            ours = mark_alone(variant, part, typed).verdict == "correct"
            assert takes_number(one, typed) == ours, (one["label"], typed)
            tried += 1
        if part.sort.turn:
            assert takes_number(one, reference + part.sort.turn)
            assert takes_number(one, reference - part.sort.turn)
        assert not takes_number(one, -reference) or abs(reference) <= half or part.sort.turn
    assert tried > 200


@each_row("lang", LANGS)
def test_choices_earn_as_we_pay_them_and_say_what_we_say(drawn, lang):
    said = 0
    for one, variant, part in questions(drawn, lang):
        if one["sort"] != "multiple_choice_question":
            continue
        letters = variant.letters(part)
        asked = next(q for q in handout(variant).questions if q.id == part.id)
        cases = [case for case, _ in asked.choices]
        assert len(one["offered"]) == len(cases)
        for ident, case in zip(one["offered"], cases, strict=True):
            mark = mark_alone(variant, part, case)
            assert (share_of_chosen(one, [ident]) == 1) == (mark.points == mark.out_of)
            assert letters[case] in one["offered"][ident]
            if mark.verdict != "correct" and mark.says:
                assert one["said"][f"{ident}_fb"]
                said += 1
    assert said > 10


def test_each_question_repeats_statement_figure_and_data(drawn):
    files = unpacked(packed(drawn, "en")[1])
    for one, variant, _ in questions(drawn, "en"):
        for name in re.findall(r'src="\$IMS-CC-FILEBASE\$/([^"]+)"', one["text"]):
            ET.fromstring(files[name])
        assert 'src="data:' not in one["text"]
        assert one["text"].count(one["label"]) == 1
        if variant.exercise.name == "slotted_mechanism":
            assert "$IMS-CC-FILEBASE$" in one["text"]
            assert "mm" in one["text"]


def test_a_longer_pool_keeps_the_identifiers_of_a_shorter(course):
    shorter, longer = (
        {
            one["label"]: one["ident"]
            for _, _, some in quiz(
                of_exercises(course, ["slotted_mechanism"], count, 0, ["en"], None), "en"
            ).values()
            for one in some
        }
        for count in (2, 4)
    )
    assert shorter.items() < longer.items()
    assert len(set(longer.values())) == len(longer)


def test_languages_are_told_apart(drawn):
    idents = [{q["ident"] for q, *_ in questions(drawn, lang)} for lang in LANGS]
    assert not idents[0] & idents[1]


TEXT = """# A bolt {hostile}

A bolt of diameter $d$ {hostile}

## radius
Its radius {hostile}.

## mass
Its mass.

## ratio
A ratio.

## fits
Does it fit?
- yes: it does {hostile}
- no: it does not
"""
HOSTILE = "]]> <script>alert(1)</script> & \"' $IMS-CC-FILEBASE$"
BOLT = """
from coursework.model import Exercise, Part, drawn

EXERCISE = Exercise(
    given={"d": drawn(3, 9, step=0.5, unit="mm")},
    parts=(
        Part("radius", unit="m", points=1),
        Part("mass", unit="kg", points=1),
        Part("ratio", unit="1", points=1),
        Part("fits", kind="choice", choices=("yes", "no"), points=1),
    ),
)
"""
BOLT_SOLVED = """
import numpy as np

def radius(d):
    return d / 2000

def mass(d):
    return 1e-5 * d

def ratio(d):
    return 1e-6 * d

def fits(d):
    return np.where(np.asarray(d) > 2, "yes", "no")

KNOWN = [({"d": 4}, {"radius": 0.002})]
"""


@pytest.fixture(scope="module")
def bolts(tmp_path_factory):
    """A pool of a course whose answers are so small that four decimals do not say them, and whose words are
    hostile."""
    folder = tmp_path_factory.mktemp("bolts") / "c"
    new_course(folder)
    (folder / "exercises" / "bolt.py").write_text(BOLT)
    (folder / "solutions" / "bolt.py").write_text(BOLT_SOLVED)
    for lang in LANGS:
        (folder / "exercises" / f"bolt.{lang}.md.j2").write_text(TEXT.replace("{hostile}", HOSTILE))
    return of_exercises(open_course(folder), ["bolt"], 3, 0, ["en"], None)


def test_numbers_too_small_for_the_page_are_asked_in_a_smaller_unit_and_that_is_said(bolts):
    powers = {"radius": ("mm", 3), "mass": ("10⁻⁶ kg", 6), "ratio": ("10⁻⁶", 6)}
    for one, variant, part in questions(bolts, "en"):
        if part.id not in powers:
            continue
        unit, decades = powers[part.id]
        assert one["label"].endswith(f" · {unit}]")
        assert f"… {unit}<" in one["text"]
        reference, half = variant.key.reference[part.quantity], variant.key.half_width(part)
        for off in (0, 0.9, -0.9, 1.2, -1.2):
            value = reference + off * half
            ours = mark_alone(variant, part, f"{value:.9g}").verdict == "correct"
            assert takes_number(one, value * 10**decades) == ours
            assert mark_alone(variant, part, f"{value * 10**decades:.9g} {unit}").verdict == (
                "correct" if ours else mark_alone(variant, part, f"{value:.9g}").verdict
            )
    told = {loss.part: loss.instead for loss in CANVAS.losses(bolts.pool("en", CANVAS))}
    assert set(told) == set(powers)
    assert "asked in mm rather than in m" in told["radius"]


def test_hostile_words_change_nothing_but_the_words(bolts):
    assert len(quiz(bolts, "en")) == 4
    for one, _, _ in questions(bolts, "en"):
        assert "<script" not in one["text"]
        assert "&lt;script&gt;alert(1)&lt;/script&gt;" in one["text"]
        assert all("<script" not in text for text in one["offered"].values())


def test_control_characters_do_not_break_the_package():
    from xml.etree.ElementTree import Element, fromstring

    from coursework.platforms._xml import below, xml_bytes

    root = Element("a")
    below(root, "b", "x\0\x07\ud800y<&>]]>", name="\x1b\"'<")
    assert fromstring(xml_bytes(root)).find("b").text == "xy<&>]]>"
    assert fromstring(xml_bytes(root)).find("b").get("name") == "\"'<"
