"""Predictions are read, and compared with what comes out."""

from __future__ import annotations

import re

import numpy as np
import pytest
from study_words import BOTH, SAID, flat, start_of
from tables import each_row

import coursework
from coursework.errors import UnknownName
from coursework.language.words import words
from coursework.selfstudy import predictions, wording

COURSE = coursework.open_course()
every_exercise = pytest.mark.parametrize("name", COURSE.names)


@each_row("lang", ["fr", "en"])
def test_what_is_offered_as_a_prediction_is_read(lang):
    offered = words(lang)["study"]["options"]
    assert [wording.sign(option) for option in offered["sign"].split(" / ")] == ["+", "-"]
    assert [wording.comparison(option) for option in offered["compare"].split(" / ")] == [">", "<"]
    assert [wording.quadrant(option) for option in offered["quadrant"].split(" / ")] == [1, 2, 3, 4]


def test_predictions_are_compared_with_what_comes_out(here):
    """The values are the course's own: at theta2 = 135° the guide points at 104.64°, 319.80 mm long."""
    exercise = COURSE["slotted_mechanism"]
    variant = exercise.variant(0, "en")
    given = {"r1": 228.6, "theta1": 90, "r2": 114.3, "theta2": 135, "omega2": 1, "alpha2": 0}
    variant = type(variant)(exercise, 0, given, "en")
    asked = {
        "theta4": ("quadrant", "2", "1"),
        "rA": ("compare", ">", "<"),
        "omega4": ("sign", "+", "-"),
        "guide": ("guess", "oscillates", "rotates"),
        # The crank lies along the frame at 90°; the guide oscillates, so it stands still twice.
        "highest_rA": ("highest", "80", "270"),
        "zeros_omega4": ("zeros", "2", "0"),
    }
    for key, (kind, right, wrong) in asked.items():
        quantity = key.rpartition("_")[2]
        choices = ("oscillates", "rotates") if kind == "guess" else ()
        one = predictions.Prediction(key, quantity, kind, "r1" if kind == "compare" else "", choices)
        assert predictions.compared(variant, one, right).right is True, key
        assert predictions.compared(variant, one, wrong).right is False, key
        assert predictions.compared(variant, one, " ") is None
        assert predictions.compared(variant, one, "eh?").right is None, key


READ = {
    wording.sign: {
        "+": ["+", "positif", "Positive", "plus", "+ 3", "> 0", "POSITIF."],
        "-": ["-", "−", "négatif", "negative", "negatif", "moins", "minus", "< 0"],
        "": ["+/-", "+ ou -", "positif ou négatif", "eh?", "0", "non positif"],
    },
    wording.comparison: {
        ">": [
            ">",
            "plus grand",
            "plus grande que r1",
            "larger",
            "larger than r1",
            "> r1",
            "greater",
            "Plus Grand",
        ],
        "<": ["<", "plus petit", "smaller", "plus petit que $r_1$", "less than r1", "inférieur à r1"],
        "=": ["=", "égal", "equal to r1"],
        "": ["<>", "plus grand ou plus petit", "12", "eh?"],
    },
    wording.quadrant: {
        4: [
            "4",
            "IV",
            "iv",
            "4e",
            "4ème",
            "4th",
            "quatrième",
            "fourth",
            "Q4",
            "quadrant 4",
            "le 4e quadrant",
            "4.0",
        ],
        1: ["1", "I", "1er", "premier", "first", "the first quadrant", "1st", "un", "one"],
        None: ["5", "0", "V", "1 ou 2", "eh?", "45°"],
    },
    wording.count: {
        2: ["2", "2 fois", "deux", "deux fois", "2.0", "2,0", "two", "twice", "two times", "2 times"],
        0: ["0", "jamais", "never", "zéro", "aucune"],
        1: ["une fois", "once", "1 fois"],
        None: ["2,5", "-1", "eh?", "plusieurs"],
    },
    wording.truth: {
        True: ["oui", "yes", "Vrai", "True", True],
        False: ["non", "no", "Faux", "false", False],
        None: ["eh?", "oui et non", "1"],
    },
}


@each_row("reader", READ)
def test_predictions_are_read_in_the_words_of_their_questions(reader):
    for meant, texts in READ[reader].items():
        for text in texts:
            assert reader(text) == meant, text


@BOTH
@each_row("text", ["90 degrés", "90 degrees", "90°", "90", "environ 90", "vers 90°", "1,5708 rad", 90.0])
def test_the_place_of_a_peak_is_read_with_its_unit(text, lang):
    variant = COURSE["slotted_mechanism"].variant(1, lang)
    (one,) = [p for p in predictions.over_the_cycle(variant) if p.kind == "highest"]
    assert predictions.compared(variant, one, text).right is True


@BOTH
def test_a_prediction_that_cannot_be_read_is_told_at_once(lang, here):
    session = coursework.study("slotted_mechanism", seed=1, lang=lang)
    told = start_of(SAID[lang]["not_understood"])
    said = flat(session.predict({"theta4": "eh?", "rA_dot": "+/-", "rA": ">"}))
    assert said.count(told) == 2
    assert "1 / 2 / 3 / 4" in said
    assert told not in flat(
        session.predict({"theta4": "IV", "rA_dot": words(lang)["study"]["reads"]["negative"][0]})
    )


@every_exercise
def test_the_choices_of_a_prediction_are_named_in_the_language_of_the_notebook(name):
    variant = COURSE[name].variant(4, "fr")
    for one in predictions.before_answers(variant):
        shown = predictions.options(variant, one)
        for case in one.choices:
            label = variant.label(one.id, case)
            plain = re.sub(r"[$\\].*", "", label).replace("'", "’").split(":")[0].strip()
            assert plain in shown.replace("'", "’").replace("\u202f", " "), (label, shown)


LENGTHS, EFFORTS = ("mm",), ("N", "N*m")
RATES = ("rad/s", "mm/s", "rad/s^2", "mm/s^2")


@every_exercise
def test_only_what_a_body_or_a_point_has_is_predicted(name):
    """No ratio, no coefficient, no count, no length on paper; a question itself only where it is a choice
    that the variants decide."""
    exercise = COURSE[name]
    for seed in range(1, 21):
        variant = exercise.variant(seed, "en")
        parts = {p.quantity: p for p in variant.parts}
        found = (*predictions.before_answers(variant), *predictions.over_the_cycle(variant))
        assert sum(one.kind == "guess" for one in found) <= 1
        for one in found:
            part = parts[one.quantity]
            if one.kind == "guess":
                assert part.choices
            elif one.kind == "quadrant":
                assert part.kind == "angle" or part.unit == "deg"
            else:
                assert part.unit in (*LENGTHS, *EFFORTS, *RATES, "deg")
                assert len(one.quantity) > 1, "a letter alone is a coefficient"


@every_exercise
def test_a_length_that_is_predicted_does_not_hang_on_how_fast_the_mechanism_runs(name):
    """A length on paper does: it stands for a velocity or an acceleration."""
    exercise = COURSE[name]
    variant = exercise.variant(3, "en")
    parts = {p.quantity: p for p in variant.parts}
    for one in (*predictions.before_answers(variant), *predictions.over_the_cycle(variant)):
        if parts[one.quantity].unit != "mm":
            continue
        given = dict(variant.used)
        here = exercise.solve(**given, only=one.quantity)[one.quantity]
        for rate, spec in exercise.spec.given.items():
            if rate in given and spec.unit in RATES:
                given[rate] = 2 * given[rate]
        assert exercise.solve(**given, only=one.quantity)[one.quantity] == here


@every_exercise
def test_what_is_compared_with_a_bar_stands_in_the_figure_beside_it(name):
    """It moves with the driver, so the figure is of one instant and shows its length; efforts are compared by
    reason."""
    exercise = COURSE[name]
    variant = exercise.variant(3, "en")
    for one in predictions.before_answers(variant):
        if one.kind == "compare" and exercise.units[one.quantity] in LENGTHS:
            assert variant.figure is not None
            assert np.ptp(predictions.curve(variant, one.quantity)[1]) > 1


@every_exercise
def test_where_something_is_largest_is_asked_only_of_what_stays_finite(name):
    for seed in range(1, 21):
        variant = COURSE[name].variant(seed, "en")
        for one in predictions.over_the_cycle(variant):
            if one.kind == "highest":
                sizes = np.abs(predictions.curve(variant, one.quantity)[1])
                assert np.nanmax(sizes) < 100 * np.nanmedian(sizes)


@every_exercise
def test_nothing_is_compared_with_a_direction(name):
    variant = COURSE[name].variant(4, "fr")
    for one in predictions.before_answers(variant):
        assert one.kind != "compare" or COURSE[name].spec.given[one.other].unit != "deg"


def test_a_curve_that_vanishes_at_the_ends_of_the_turn_vanishes_there_once():
    turn = np.radians(np.linspace(0, 360, 721))
    counts = [predictions.zeros(f(k * turn)) for f in (np.sin, np.cos) for k in (1, 2)]
    assert counts == [2, 4, 2, 4]
    assert predictions.zeros(np.ones(9)) == 0


@every_exercise
def test_a_rate_whose_sign_is_asked_over_the_cycle_passes_through_zero_there(name):
    """Lengths of vectors touch zero without a change of sign: they are not asked."""
    for seed in (1, 2):
        variant = COURSE[name].variant(seed, "en")
        for one in predictions.over_the_cycle(variant):
            if one.kind == "zeros":
                values = predictions.curve(variant, one.quantity)[1]
                touches = (np.abs(values) <= np.roll(np.abs(values), 1)) & (
                    np.abs(values) < np.roll(np.abs(values), -1)
                )
                near = np.abs(values) < 2e-3 * np.nanmax(np.abs(values))
                if not np.isnan(values).any():
                    assert (touches & near)[:-1].sum() <= predictions.zeros(values)


def test_a_prediction_is_compared_only_when_its_answer_is_right(here):
    session = coursework.study("slotted_mechanism", seed=42, lang="en")
    session.predict({"theta4": "1"})
    assert "You said" not in str(session.check({"theta4": "1000"}))
    right = session.variant.solution()["theta4"]
    assert "You said" in str(session.check({"theta4": f"{right:.4f}"}))


#: Counts alone, words alone, and bars that are to be found: nothing here is told by a figure or by reason
#: before it is computed.
NOTHING_TO_PREDICT = {
    "crank_rocker_design",
    "joint_graph",
    "joint_twist",
    "mobility",
    "quick_return_design",
    "vocabulary",
}


@every_exercise
def test_every_exercise_that_computes_what_can_be_seen_has_something_to_predict(name):
    variant = COURSE[name].variant(4, "en")
    before = predictions.before_answers(variant)
    assert (name in NOTHING_TO_PREDICT) == (not before)
    assert len(before) <= predictions.MOST
    for one in (*before, *predictions.over_the_cycle(variant)):
        assert predictions.question_of(variant, one).endswith("?")
        assert predictions.options(variant, one)


def test_what_to_predict_does_not_depend_on_the_variant():
    """Else the question itself would tell something of the answer."""
    exercise = COURSE["four_bar_motion"]
    kinds = {tuple(predictions.before_answers(exercise.variant(seed))) for seed in range(5)}
    assert len(kinds) == 1


def test_something_not_asked_cannot_be_predicted(here):
    with pytest.raises(UnknownName, match="theta4"):
        coursework.study("slotted_mechanism").predict({"theta5": "1"})


def test_lessons_compare_predictions_with_what_came_out():
    said = str(
        coursework.compare(
            {"a": 2, "b": None, "c": True, "d": "x"}, {"a": 2.1, "b": 5, "c": False, "d": 1}, "en"
        )
    )
    assert said.splitlines() == [
        "- ✓ a: predicted 2, found 2.1",
        "- · b: no prediction, found 5",
        "- ✗ c: predicted yes, found no",
        "- ✗ d: predicted x, found 1",
    ]


AGREE = [
    ("non", False, True),
    ("oui", False, False),
    ("Vrai", True, True),
    ("True", True, True),
    (True, True, True),
    ("eh?", False, False),
    ("2,3", 2.3, True),
    ("140 mm", 140.0, True),
    ("0,14 m", 140.0, True),
    ("deux", 2, True),
    ("2 fois", 2, True),
    ("0", 0, True),
    (0.01, 0, True),
    (1, 0, False),
    ("5°", 0, True),
    ("360°", 0, True),
    ("20°", 0, False),
    (np.float64(2.2), 2.3, True),
    ("II", "II", True),
    ("ii", "II", True),
    ("I", "II", False),
    (2, 2.5, False),
    ("+/-", 1, False),
]


@each_row(("guess", "value", "agrees"), AGREE)
def test_a_lesson_reads_predictions_as_they_are_written(guess, value, agrees):
    for lang in ("fr", "en"):
        assert str(coursework.compare({"a": guess}, {"a": value}, lang)).startswith(
            "- ✓" if agrees else "- ✗"
        )


def test_an_angle_is_near_whole_turns_apart_where_it_is_named_as_one():
    for guess in (5, 360, "-4", "355"):
        assert str(coursework.compare({"a": guess}, {"a": 0}, "fr", angles=("a",))).startswith("- ✓")
        assert str(coursework.compare({"a": guess}, {"a": 0}, "fr")).startswith("- ✗")
    assert str(coursework.compare({"a": 20}, {"a": 0}, "fr", angles=("a",))).startswith("- ✗")


def test_a_result_is_told_with_its_unit():
    predicted, found = {"speed": "630", "turn": None}, {"speed": 640.0, "turn": 12.5}
    told = coursework.compare(predicted, found, "en", angles=("turn",), units={"speed": "mm/s"})
    assert told.outcome == "- speed: 640\N{NO-BREAK SPACE}mm/s\n- turn: 12.5°"
    shown = str(told).replace("\N{NO-BREAK SPACE}", " ").splitlines()
    assert shown == ["- ✓ speed: predicted 630, found 640 mm/s", "- · turn: no prediction, found 12.5°"]


@BOTH
def test_a_lesson_says_which_name_nothing_has_come_out_of(lang):
    said = str(coursework.compare({"facteru": 2, "other": None}, {"facteur": 2}, lang))
    assert said.splitlines()[1].startswith("- ? facteru")
    assert said.replace("\n", " ").count("facteur") == 2
    assert "other" not in said
