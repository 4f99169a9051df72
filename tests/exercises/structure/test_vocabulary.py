"""The bank of questions: complete in every language, drawn by theme, and open to a teacher who writes texts
only."""

import shutil
import tomllib
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.api import Variant
from coursework.authoring import checks
from coursework.course.course import Course
from coursework.course.folder import Folder
from coursework.course.texts import constants
from coursework.errors import BadCourse
from coursework.kinematics.slotted_guide import motion
from coursework.language.words import languages
from coursework.structure import LIBRARY

COURSE = coursework.open_course()
EXERCISE = COURSE["vocabulary"]
EXERCISES, SOLUTIONS = (COURSE.folder.home(kind, "vocabulary").parent for kind in ("exercises", "solutions"))
THEMES = tomllib.loads((EXERCISES / "vocabulary.toml").read_text("utf-8"))
ANSWERS = tomllib.loads((SOLUTIONS / "vocabulary.toml").read_text("utf-8"))


def labels(lang):
    return list(constants(EXERCISES / f"vocabulary.{lang}.md.j2").labels)


@each_row("lang", languages())
def test_each_question_has_the_same_cases_in_the_same_order_in_every_language(lang):
    assert labels(lang) == labels("en")
    asked = {question for theme in THEMES.values() for question in theme["questions"]}
    assert {question for question, _ in labels(lang)} == asked == ANSWERS.keys()
    assert all(2 <= n <= 5 for n in Counter(question for question, _ in labels(lang)).values())


@each_row("lang", languages())
def test_remarks_are_to_wrong_cases_and_the_same_in_every_language(lang):
    def remarks(one):
        texts = constants(SOLUTIONS / f"vocabulary.{one}.md.j2").texts
        return {name.removeprefix("mistake ") for name in texts if name.startswith("mistake ")}

    wrong = {f"{question}_{case}" for question, case in labels(lang) if ANSWERS[question] != case}
    assert remarks(lang) == remarks("en") <= wrong
    assert set(EXERCISE.solution.mistakes) == remarks(lang)


def test_a_variant_asks_of_every_theme():
    for variant in EXERCISE.variants(range(50)):
        for theme in THEMES.values():
            assert len(set(variant.part_ids) & set(theme["questions"])) == theme["ask"]
    met = Counter(i for v in EXERCISE.variants(range(400)) for i in v.part_ids)
    assert set(met) == ANSWERS.keys()


def test_the_right_case_stands_at_no_favourite_place():
    order: dict[str, list[str]] = {}
    for question, case in labels("en"):
        order.setdefault(question, []).append(case)
    places = Counter(order[question].index(right) for question, right in ANSWERS.items())
    assert max(places.values()) <= 0.5 * len(ANSWERS)


@each_row(("fixed", "driven", "turns"), [(40.0, 100.0, 1), (100.0, 40.0, 0)])
def test_the_guide_of_an_inversion_turns_or_swings_as_the_bank_says(fixed, driven, turns):
    """The crank fixed and the longer rod driven: the guide turns. The rod fixed, the shorter crank driven: it
    swings."""
    assert (ANSWERS["inversion_crank"], ANSWERS["inversion_slotted"]) == ("turns", "rod")
    angles = motion(fixed, driven, np.linspace(0, 2 * np.pi, 2001), order=0).guide_angle
    assert np.sum(np.angle(np.exp(1j * np.diff(angles)))) == pytest.approx(2 * np.pi * turns, abs=1e-9)


def test_a_contact_in_place_of_the_coupler_leaves_the_degrees_of_freedom():
    assert ANSWERS["derived_contact"] == "coupler"
    assert LIBRARY["figure_3"].counts.w == LIBRARY["figure_6_gears"].counts.w == 1


def test_who_is_wrong_is_told_what_was_confused():
    variant = next(v for v in EXERCISE.variants(range(100), "en") if "coriolis_size" in v.part_ids)
    mark = variant.grade({"coriolis_size": "once"})["coriolis_size"]
    assert mark.verdict == "mistake:coriolis_size_once"
    assert "twice" in mark.feedback
    for answer in ("twice", "2 |ω ṙ|", "2|omega r_dot|", "2 ω ṙ", "2*|omega*rdot|", r"2\,|\omega\,\dot r|"):
        assert variant.grade({"coriolis_size": answer})["coriolis_size"].verdict == "correct", answer
    for answer in ("2 omega r", "d", "3 |ω ṙ|"):
        assert variant.grade({"coriolis_size": answer})["coriolis_size"].verdict == "unreadable", answer


@pytest.fixture
def own_course(tmp_path):
    """The bank alone, in its topic: a solution reads the exercise of the same folder."""
    for kind, folder in (("exercises", EXERCISES), ("solutions", SOLUTIONS)):
        own = tmp_path / kind / folder.name
        own.mkdir(parents=True)
        for path in folder.glob("vocabulary.*"):
            shutil.copy(path, own)
    return tmp_path


def add(path: Path, text: str) -> None:
    path.write_text(path.read_text("utf-8") + text, "utf-8")


@pytest.mark.e2e
def test_a_teacher_adds_a_question_by_texts_alone(own_course):
    add(
        own_course / "exercises" / EXERCISES.name / "vocabulary.toml",
        '\n[belts]\nask = 1\nquestions = ["belt_sense"]\n',
    )
    add(own_course / "solutions" / SOLUTIONS.name / "vocabulary.toml", 'belt_sense = "same"\n')
    for lang, asks in (
        ("fr", "Une courroie ouverte fait tourner les poulies :"),
        ("en", "An open belt turns pulleys:"),
    ):
        statement = f"\n## belt_sense\n{asks}\n- same: + +\n- opposite: + -\n"
        add(own_course / "exercises" / EXERCISES.name / f"vocabulary.{lang}.md.j2", statement)
        add(
            own_course / "solutions" / SOLUTIONS.name / f"vocabulary.{lang}.md.j2",
            "\n## mistake belt_sense_opposite\n×\n",
        )
    exercise = coursework.open_course(own_course)["vocabulary"]
    report = checks.check(exercise, 20, rendered=1)
    assert report.failures == []
    variant = exercise.variant(3)
    assert "belt_sense" in variant.part_ids
    assert variant.grade({"belt_sense": "opposite"})["belt_sense"].mistakes == ("belt_sense_opposite",)


def test_a_question_without_answer_or_without_words_is_said(own_course):
    add(
        own_course / "exercises" / EXERCISES.name / "vocabulary.toml",
        '\n[belts]\nask = 1\nquestions = ["belt_sense"]\n',
    )
    with pytest.raises(BadCourse, match="'belt_sense', which has no section"):
        coursework.open_course(own_course)["vocabulary"]
    add(
        own_course / "exercises" / EXERCISES.name / "vocabulary.en.md.j2",
        "\n## belt_sense\nWhich?\n- same: + +\n- opposite: + -\n",
    )
    exercise = Course(Folder(own_course), Variant)["vocabulary"]
    with pytest.raises(BadCourse, match="needs an answer"):
        assert exercise.solution


def test_an_answer_that_is_no_case_is_found_by_the_check(own_course):
    path = own_course / "solutions" / SOLUTIONS.name / "vocabulary.toml"
    path.write_text(path.read_text("utf-8").replace('spin = "normal"', 'spin = "normale"'), "utf-8")
    report = checks.check(coursework.open_course(own_course)["vocabulary"], 5, rendered=0)
    assert any("residual" in failure for failure in report.failures)
