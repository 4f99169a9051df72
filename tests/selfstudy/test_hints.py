"""Hints come one by one and tell nothing that is asked."""

from __future__ import annotations

import re

import pytest
from study_words import BOTH

import coursework
from coursework.errors import UnknownName
from coursework.selfstudy import hints

COURSE = coursework.open_course()
every_exercise = pytest.mark.parametrize("name", COURSE.names)


@BOTH
def test_a_hint_holds_what_the_student_wrote_not_the_reference(lang, here):
    session = coursework.study("slotted_mechanism", seed=1, lang=lang)
    session.check({"theta4": "66"})
    last = str(session.hint("omega4", 4))
    assert "66.7" not in last.replace(",", ".")
    assert "− 66°" in last


@BOTH
def test_another_scale_of_the_drawing_leaves_symbols_in_the_hints(lang, here):
    session = coursework.study("velocity_polygon", seed=1, lang=lang)
    walk = session.variant.walk
    scale = 2 * walk["kv"]
    told = {"kv": f"{scale:g}", "p": "0; 0", "a": walk["a"] / 2, "b": walk["b"] / 2, "ab": walk["ab"] / 2}
    said = str(session.check({**told, "pv_b": walk["pv_b"] / 2}))
    place = session.variant.part_ids.index("pv_b") + 1
    assert f"- ✓ {place}." in said
    last = str(session.hint("v_B", 9))
    assert not re.search(r"\d", last.rpartition("=")[2].partition("\n")[0])


#: Of a law that the statement gives, and of its derivatives.
COEFFICIENTS = {"cam_follower": (8,), "flat_faced_cam": (8, 10, 15, 30, 36, 60)}


@every_exercise
def test_no_hint_holds_a_value_that_is_asked(name):
    """Numbers of hints are given ones, or small whole numbers of formulas."""
    for seed in range(3):
        variant = COURSE[name].variant(seed, "en")
        given = [abs(v) for v in variant.given.values() if not isinstance(v, str)]
        for part in variant.parts:
            for text in hints.steps(variant, part.id):
                for number in re.findall(r"\\num\{([^{}]*)\}", text):
                    known = any(abs(abs(float(number)) - g) <= 1e-5 * g for g in given)
                    constant = float(number) in (
                        *COEFFICIENTS.get(name, ()),
                        0,
                        0.5,
                        1,
                        2,
                        3,
                        4,
                        5,
                        6,
                        90,
                        180,
                        360,
                        1000,
                    )
                    assert known or constant, f"{part.id}: {number} in {text}"


@every_exercise
def test_every_question_has_a_hint_and_a_revealed_value(name):
    for lang in ("fr", "en"):
        variant = COURSE[name].variant(2, lang)
        for part in variant.parts:
            assert hints.revealed_text(variant, part.id)
            assert all(text.strip() for text in hints.steps(variant, part.id))
            assert hints.steps(variant, part.id), part.id


@every_exercise
def test_no_hint_tells_the_case_of_a_choice(name):
    for seed in range(4):
        variant = COURSE[name].variant(seed, "en")
        for part in variant.parts:
            if part.kind == "choice":
                label = variant.label(part.id, str(variant.walk[part.quantity]))
                for text in hints.steps(variant, part.id):
                    assert f"“{label}”" not in text, f"{part.id}: {text}"
                    assert f"**{label}**" not in text, f"{part.id}: {text}"


def test_numbers_side_by_side_would_be_the_answer_and_are_no_hint():
    variants = (COURSE["ball_reducer"].variant(seed, "en") for seed in range(20))
    variant = next(v for v in variants if "axis_31_point" in v.part_ids)
    assert [
        r"\num{" in text.replace(r"\num{0}", "") for text in hints.steps(variant, "axis_31_point")[1:]
    ] == [False, False]


def test_hints_come_one_by_one_and_stay(here):
    session = coursework.study("slotted_mechanism", seed=42, lang="en")
    first, second = str(session.hint("omega4")), str(session.hint("omega4"))
    assert "Hint 1 of 4" in first
    assert "Hint 2" not in first
    assert "Hint 1 of 4" in second
    assert "Hint 2 of 4" in second
    assert "Hint 4 of 4" in str(session.hint("omega4", 4))
    assert "reveal" in str(session.hint("omega4"))
    with pytest.raises(UnknownName, match="omega4"):
        session.hint("omega44")


def test_what_the_student_has_found_stands_as_a_number_in_the_last_hint(here):
    session = coursework.study("slotted_mechanism", seed=42, lang="en")
    assert "r_A" in str(session.hint("omega4", 4)).rpartition("Hint 4")[2]
    right = session.variant.solution()
    session.check({"rA": f"{right['rA']:.6g}"})
    last = str(session.hint("omega4", 4)).rpartition("Hint 4")[2]
    assert f"{right['rA']:.6g}" in last
    assert "r_A" not in last


def test_a_step_on_the_way_has_hints_of_its_own(here):
    session = coursework.study("slotted_mechanism", seed=42, lang="en")
    assert 'study.hint("delta")' in str(session.hint("rA"))
    assert "Hint 1" in str(session.hint("delta"))
