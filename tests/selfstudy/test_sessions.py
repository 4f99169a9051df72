"""A session marks what is written, keeps it, and says what it cannot use."""

from __future__ import annotations

import json
from datetime import UTC, datetime

import numpy as np
import pytest
from study_words import BOTH, SAID, flat, start_of

import coursework
from coursework.course.answer_keys import answer_keys
from coursework.errors import BadInput, CourseworkError, UnknownName
from coursework.issuing.protection import valid_variants
from coursework.language.words import words
from coursework.rendering.renderer import renderer_of
from coursework.selfstudy import predictions
from coursework.selfstudy.progress import FILE, Progress, entry

COURSE = coursework.open_course()
every_exercise = pytest.mark.parametrize("name", COURSE.names)


@every_exercise
def test_right_answers_are_all_right(name, here):
    session = coursework.study(name, seed=1, lang="en")
    variant = session.variant
    values = variant.solution()
    answers = {p.id: _as_answer(values[p.quantity], p) for p in variant.parts}
    said = str(session.check(answers))
    total = sum(p.points for p in variant.parts)
    assert f"{total:g} out of {total:g} points" in said
    assert "✗" not in said


def _as_answer(value, part):
    if isinstance(value, (list, tuple, np.ndarray)):
        return "; ".join(repr(float(v)) for v in value)
    text = value if isinstance(value, str) else repr(int(value) if part.kind == "integer" else float(value))
    return f"{text} {part.unit}" if part.asks_unit else text


def test_feedback_names_what_is_blank_and_what_to_ask_next(here):
    session = coursework.study("slotted_mechanism", seed=42, lang="en")
    right = session.variant.solution()
    said = str(session.check({"student": "Zoé", "rA": f"{right['rA']:.5g}", "omega4": "1e9"}))
    assert said.startswith("- ✓ 1.")
    assert 'study.hint("omega4")' in said
    assert "theta4" in said.partition("Still blank")[2]
    with pytest.raises(UnknownName, match="omega4"):
        session.check({"omega44": "1"})


def test_what_is_written_is_never_lost(here):
    session = coursework.study("slotted_mechanism", seed=5, lang="en")
    session.check({"rA": "100", "theta4": "20"})
    assert "before" not in str(session.check({"rA": "100", "theta4": "20"}))
    assert "before: rA" in str(session.check({"rA": "", "theta4": "30"}))
    session.predict(dict.fromkeys([p.id for p in predictions.before_answers(session.variant)], ""))
    session.predict({"theta4": "2"})
    session.predict({"theta4": ""})
    again = session.fresh(1)
    again.check({"rA": "7"})
    assert again.variant.seed > 5
    later = coursework.study("slotted_mechanism", seed=5, lang="fr")
    assert later.answers == {"rA": "100", "theta4": "30"}
    assert later.predictions == {"theta4": "2"}
    assert later.fresh(1).answers == {"rA": "7"}
    assert later.fresh().variant.seed == later.fresh(2).variant.seed > again.variant.seed
    assert f"variante {again.variant.seed}" in str(later.progress())


def test_answers_of_another_variant_are_not_kept_for_this_one(here):
    session = coursework.study("slotted_mechanism", seed=5, lang="en")
    session.check({"rA": "100", "theta4": "20"})
    again = session.fresh(2)
    assert "variant 5" in str(again.check({"rA": "100", "theta4": "20"}))
    assert again.answers == {}


@BOTH
def test_a_damaged_file_is_set_aside_and_told(lang, here):
    for number in ("", "1"):
        (here / FILE).write_text("[", "utf-8")
        session = coursework.study("coriolis", lang=lang)
        told = {"en": "could not be read", "fr": "pas pu être lu"}[lang]
        assert told in flat(session.progress())
        assert (here / f"progress.damaged{number}.json").read_text("utf-8") == "["
        session.check({"a_coriolis": "3"})
        (one,) = Progress.read((here / FILE).read_text("utf-8"))
        assert (one["part"], one["answer"]) == ("a_coriolis", "3")


def test_a_folder_that_cannot_be_written_is_told(here):
    session = coursework.study("coriolis", lang="en", folder=here / "nowhere")
    assert "cannot be written" in str(session.check({"a_coriolis": "3"}))
    assert session.answers == {"a_coriolis": "3"}


def test_a_deliberate_error_shows_no_traceback_in_a_notebook():
    (line,) = CourseworkError("too long")._render_traceback_()
    assert line == "CourseworkError: too long"


@pytest.mark.e2e
def test_fresh_variants_are_worth_issuing_all_different_and_the_same_for_ever(here):
    session = coursework.study("four_bar_motion", seed=3, lang="en")
    fresh = [session.fresh(k).variant for k in range(1, 6)]
    assert [v.seed for v in fresh] == [session.fresh(1).fresh(k).variant.seed for k in range(1, 6)]
    assert len({tuple(v.given.values()) for v in (session.variant, *fresh)}) == 6
    assert len(valid_variants(session.variant.exercise, fresh)) == 5
    for number in (0, -1, True, "2"):
        with pytest.raises(BadInput, match="from 1 on"):
            session.fresh(number)


def test_one_fresh_variant_follows_another_without_an_answer(here):
    session = coursework.study("slotted_mechanism", seed=42, lang="en")
    seeds = {session.variant.seed}
    for _ in range(2):
        session = session.fresh()
        assert session.variant.seed not in seeds
        seeds.add(session.variant.seed)
        session.check({"rA": "1"})
    again = session.fresh().fresh()
    assert again.variant.seed not in seeds


@BOTH
def test_values_of_numpy_are_answers_and_predictions(lang, here):
    session = coursework.study("ball_reducer", lang=lang)
    for _ in range(2):
        session.check({"axis_30_dir": np.array([1, 0, 1]), "omega": np.float64(2.5)})
    assert session.answers == {"axis_30_dir": [1, 0, 1], "omega": 2.5}
    assert coursework.study("ball_reducer", lang=lang).answers == session.answers
    session = coursework.study("slotted_mechanism", lang=lang)
    assert start_of(SAID[lang]["not_understood"]) not in flat(session.predict({"theta4": np.int64(2)}))


def first_shared(name, lang, count):
    """A session, another variant, and what is right in both: ``count`` questions at least."""
    for seed in range(50):
        session = coursework.study(name, seed=seed, lang=lang)
        again = session.fresh(1)
        here, there = session.variant.solution(), again.variant.solution()
        exact = [p for p in again.variant.parts if p.is_exact and here[p.quantity] == there[p.quantity]]
        if len(exact) >= count:
            return session, again, {p.id: str(here[p.quantity]) for p in exact}
    raise AssertionError("no variants share as much")


@BOTH
def test_answers_that_are_right_in_both_variants_are_no_copy(lang, here):
    session, again, told = first_shared("closed_chain", lang, 3)
    session.check(told)
    assert start_of(SAID[lang]["copied"]) not in flat(again.check(told))
    assert again.answers == told


@BOTH
def test_a_copy_is_one_too_and_keeps_what_is_right(lang, here):
    session, again, both = first_shared("four_bar_positions", lang, 1)
    right = session.variant.solution()
    told = {**both, **{n: f"{right[n]:.5g}" for n in ("theta3_open", "theta4_open")}}
    session.check(told)
    assert start_of(SAID[lang]["copied"].format(seed=session.variant.seed)) in flat(again.check(told))
    assert again.answers == both
    assert session.answers == told


@BOTH
def test_what_was_accepted_in_another_way_is_not_contradicted(lang, here):
    """The second assembly given first: the reference of the first is neither told nor compared."""
    session = coursework.study("four_bar_positions", seed=1, lang=lang)
    walk = session.variant.walk
    session.predict({"theta4_open": "3"})
    session.check({"theta3_open": f"{walk['theta3_crossed']:.2f}"})
    last = str(session.hint("theta4_open", 4)).rpartition("4. ")[2]
    assert f"{walk['theta3_open']:.1f}" not in last.replace(",", ".")
    assert "θ₃" in last
    said = str(session.check({"theta4_open": f"{walk['theta4_crossed']:.2f}"}))
    assert said.count("- ✓ ") == 3
    assert "- ✗" not in said


@BOTH
@pytest.mark.parametrize("question", [5, "5", "question 5", "Q5", "n° 5"])
def test_a_question_may_be_told_by_its_number(question, lang, here):
    session = coursework.study("slotted_mechanism", seed=42, lang=lang)
    assert str(session.hint(question)) == str(
        coursework.study("slotted_mechanism", seed=42, lang=lang, folder=here / "x").hint("omega4")
    )
    assert str(session.reveal(question)) == str(session.reveal("omega4"))
    assert str(session.plot(question)) == str(session.plot("omega4"))
    session.check({question: "7"})
    assert session.answers == {"omega4": "7"}
    with pytest.raises(UnknownName):
        session.hint(99)


@every_exercise
def test_the_name_of_a_question_stands_beside_its_number(name, here):
    variant = COURSE[name].variant(3, "fr")
    book = json.loads(renderer_of(COURSE.folder).study(variant.study_sheet()))
    text = "\n".join("".join(c["source"]) for c in book["cells"] if c["cell_type"] == "markdown")
    for number, key in enumerate(answer_keys(variant.parts).values(), start=1):
        assert f"**{number}.** `{key}` — " in text


@BOTH
def test_feedback_names_the_question_beside_its_number(lang, here):
    said = coursework.study("slotted_mechanism", lang=lang).check({"omega4": "1e9"})
    assert "**5.** `omega4` — " in said.markdown


@BOTH
def test_a_call_without_what_it_needs_says_what_there_is(lang, here):
    session = coursework.study("slotted_mechanism", lang=lang)
    for said in (session.reveal(), session.predict(), session.predict({}), session.hint()):
        assert "theta4" in str(said)
    session.check(rA="238")
    session.predict(theta4="1")
    assert session.answers == {"rA": "238"}
    assert session.predictions == {"theta4": "1"}
    with pytest.raises(UnknownName) as refused:
        session.hints("rA")
    assert start_of(SAID[lang]["refused"]["method"]) in str(refused.value)
    assert "hint" in str(refused.value).partition("hints")[2]
    assert not hasattr(session, "hints")


NOT_READ = {
    "velocity_polygon": {"kv": "12 ± 3 ± 1", "p": "là", "known_A": "perhaps this"},
    "slider_extras": {"mobility": "un peu", "theta3": "50 ou 60", "loop_1_x": "r2 + + = 3 )"},
}


@BOTH
@pytest.mark.parametrize("name", NOT_READ)
def test_who_works_alone_is_not_told_that_somebody_will_look(name, lang, here):
    session = coursework.study(name, seed=1, lang=lang)
    for part, text in NOT_READ[name].items():
        said = " ".join(str(session.check({part: text})).split())
        assert "- ? " in said, said
        assert "somebody" not in said
        assert "quelqu" not in said
    said = flat(session.check(NOT_READ[name]))
    if name == "velocity_polygon":
        (part,) = (p for p in session.variant.parts if p.id == "known_A")
        letter = session.variant.letters(part)["length"]
        assert f"{letter} ({flat(session.variant.label('known_A', 'length'))})" in said
    else:
        assert start_of(words(lang)["marking"]["unreadable"]["not_an_equation"]) in said


@BOTH
def test_what_a_file_holds_beyond_what_is_asked_stays_and_does_no_harm(lang, here):
    path = here / FILE
    answers = {"rA": "1", "zz": "3", "omega4": {"x": 1}, "guide": [2], "theta4": None}
    stated = [(part, "answer", answer) for part, answer in answers.items()]
    stated += [("yy", "prediction", "+"), ("theta4", "prediction", [1])]
    at = datetime(2026, 1, 1, tzinfo=UTC)
    entries = [entry(at, "slotted_mechanism", 1, part, what, answer=answer) for part, what, answer in stated]
    path.write_text(Progress(entries).text(), "utf-8")
    session = coursework.study("slotted_mechanism", seed=1, lang=lang)
    for said in (session.check({}), session.hint("rA_dot", 4), session.plot(), session.progress()):
        assert str(said)
    session.check({"rA": "2"})
    assert "zz" not in session.answers
    assert [e["answer"] for e in Progress.read(path.read_text("utf-8")) if e["part"] == "zz"] == ["3"]


@pytest.mark.parametrize("lang", ["en", "fr"])
def test_one_mistyped_name_is_told_and_the_other_answers_are_checked(here, lang):
    session = coursework.study("slotted_mechanism", seed=42, lang=lang)
    told = str(session.check({"rA": "12", "tehta4": "12", "zzz": "3"}))
    assert {name for name in ("tehta4", "theta4", "zzz") if name in told} == {"tehta4", "theta4", "zzz"}
    assert session.answers == {"rA": "12"}
    assert "thta4" in str(session.predict({"rA": ">", "thta4": "1"}))
    assert session.predictions == {"rA": ">"}
