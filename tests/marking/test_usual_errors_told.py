"""An error that nobody named is seen, told by its term, and paid for once."""

from __future__ import annotations

import re

import numpy as np
import pytest
from sweeps import whole_course
from tables import each_row

import coursework
from coursework.authoring.check_knowledge import check_knowledge
from coursework.authoring.check_penalties import check_prices
from coursework.authoring.check_report import CheckReport
from coursework.authoring.check_usual import check_usual_errors
from coursework.course.answer_key import Key
from coursework.course.exercise import ALL
from coursework.course.marking_rules import Rules
from coursework.course.variant import Variant
from coursework.errors import BadCourse
from coursework.issuing.issuing import distinct_variants
from coursework.language.words import words
from coursework.marking.usual import why
from coursework.quantities.error_kinds import PENALTIES
from coursework.quantities.usual_errors import formula_errors

COURSE = coursework.open_course()
every_exercise = pytest.mark.parametrize("name", COURSE.names)
NUMERIC = [n for n in COURSE.names if any(p.sort.is_scalar and not p.judge for p in COURSE[n].spec.parts)]


@every_exercise
def test_every_usual_error_that_shows_is_told_and_no_price_differs(name):
    exercise, report = COURSE[name], CheckReport(name)
    drawn = distinct_variants(exercise, 0, 7, "en", parts=(ALL,))
    check_usual_errors(drawn, report)
    check_prices(drawn, report)
    assert report.failures == []


def test_an_acceleration_without_its_normal_part_is_right_on_no_variant():
    told = set()
    for variant in distinct_variants(COURSE["four_bar_motion"], 0, 60, "en", parts=("a_B",)):
        tangential = abs(variant.given["r4"] * variant.quantities(["alpha4"])["alpha4"])
        mark = variant.grade({"a_B": f"{tangential:.5g}"})["a_B"]
        assert mark.verdict != "correct"
        told.add(mark.verdict)
    assert "slip:term" in told


@each_row(("lang", "said"), [("en", "the term ω₄⁴ is left out"), ("fr", "le terme ω₄⁴ manque")])
def test_the_sentence_names_the_term_and_not_the_value(lang, said):
    (variant,) = distinct_variants(COURSE["four_bar_motion"], 0, 1, lang, parts=("a_B",))
    right = variant.quantities(["alpha4", "a_B"])
    mark = variant.grade({"a_B": abs(variant.given["r4"] * right["alpha4"])})["a_B"]
    assert said in mark.feedback
    assert str(round(right["a_B"])) not in mark.feedback


def test_what_nothing_explains_is_told_what_it_is_computed_from():
    variant = COURSE["slotted_mechanism"].variant(7, "en")
    right = variant.solution()
    answers = {"rA": right["rA"], "theta4": right["theta4"], "omega4": 7.123 * right["omega4"]}
    mark = variant.grade(answers)["omega4"]
    assert mark.verdict == "wrong"
    assert "r_A and θ₄ (right)" in mark.feedback
    assert "the relation between them" in mark.feedback
    wrong = variant.grade({**answers, "rA": 1.23 * right["rA"]})["omega4"]
    assert "not yet right" in wrong.feedback


@whole_course
def test_one_wrong_sign_costs_the_same_in_every_exercise():
    """Told by its author or by the engine, with all else blank."""
    for name in NUMERIC:
        for variant in distinct_variants(COURSE[name], 0, 2, "en", parts=(ALL,)):
            for part in variant.parts:
                if not part.sort.is_number or part.judge or part.sort.turn:
                    continue
                value = variant.key.reference[part.quantity]
                if not value:
                    continue
                mark = variant.grade({part.id: -value})[part.id]
                is_sign = mark.verdict == "slip:sign" or (
                    mark.verdict.startswith("mistake:")
                    and variant.exercise.solution.mistakes[mark.verdict[8:]].kind == "sign"
                )
                if is_sign:
                    assert mark.points == PENALTIES["sign"] * mark.out_of, (name, part.id)


def test_all_signs_of_an_equation_are_one_error():
    variant = COURSE["slider_extras"].variant(3, "en")
    right = variant.quantities(["a", "b", "c"])
    marking = variant.grade({name: -value for name, value in right.items()})
    assert [marking[i].points for i in "abc"] == [0.5, 1.0, 1.0]
    assert f"counted once (question {variant.part_ids.index('a') + 1})" in marking["b"].feedback
    # One sign of three is an error of its own.
    alone = variant.grade({**right, "b": -right["b"]})
    assert [alone[i].points for i in "abc"] == [1.0, 0.5, 1.0]


def test_the_same_error_on_the_way_to_two_answers_is_paid_once():
    variant = COURSE["quick_return"].variant(2, "en")
    wrong = variant.key.wrong["cosine_rule_sign"]
    both = [i for i in variant.part_ids if i in wrong and i != "OB"][:2]
    marking = variant.grade({i: wrong[i] for i in both})
    first, second = (marking[i] for i in both)
    assert first.verdict == "mistake:cosine_rule_sign"
    assert (second.verdict, second.points) == ("follow_through", second.out_of)


def test_a_calculator_set_to_radians_is_one_error_though_angles_are_right():
    """Each formula is worked out in radians, from the rates that came out of the ones before."""
    for variant in distinct_variants(COURSE["four_bar_motion"], 0, 6, "en"):
        graph = variant.exercise.solution.graph.textbook
        values = {**variant.used, **variant.quantities(["theta3", "theta4"])}
        answers = {"theta3": f"{values['theta3']:.1f}", "theta4": f"{values['theta4']:.1f}"}
        for name in ("omega3", "omega4", "alpha3", "alpha4"):
            errors = formula_errors(graph.node(name).function)
            values[name] = next(e for e in errors if e.kind == "all_degrees").formula(values)
            answers[name] = f"{values[name]:.4g}"
        marking = variant.grade(answers)
        assert marking["omega3"].verdict == "slip:all_degrees"
        assert {marking[i].verdict for i in ("omega4", "alpha3", "alpha4")} == {"follow_through"}


def test_metres_everywhere_are_one_error():
    variant = COURSE["slider_crank"].variant(3, "en")
    lengths = [p for p in variant.parts if p.unit == "mm" and p.sort.is_number and not p.judge]
    marking = variant.grade({p.id: f"{variant.key.reference[p.quantity] / 1000:.6g}" for p in lengths})
    points = [marking[p.id].points / marking[p.id].out_of for p in lengths]
    assert points[0] == PENALTIES["unit"]
    assert set(points[1:]) == {1.0}


def test_a_wrong_first_point_leaves_the_pole():
    variant = COURSE["velocity_polygon"].variant(3, "en")
    right = variant.solution()
    x, y = right["a"]
    written = {i: "; ".join(f"{c:.1f}" for c in right[i]) for i in ("p", "b")}
    marking = variant.grade({"kv": right["kv"], **written, "a": f"{x + 20:.1f}; {y + 15:.1f}"})
    assert marking["p"].verdict == "correct"
    assert marking["a"].points == 0


def marked(name, rules, **answers):
    variant = COURSE[name].variant(3, "en")
    variant.key = Key(variant, rules)
    return variant.grade(answers)


def test_a_course_sets_its_prices():
    rules = Rules.of({"prices": {"sign": 0.25}}, "course.toml")
    omega3 = COURSE["four_bar_motion"].variant(3).solution()["omega3"]
    assert marked("four_bar_motion", rules, omega3=-omega3)["omega3"].points == 0.25
    assert Rules.of({"slip": 0.1}, "course.toml").share("unit") == 0.1
    assert Rules.of({"prices": {"unit": 0.2}}, "assignment", rules).share("sign") == 0.25
    for table, said in (({"sing": 1}, "'sign'"), ({"sign": 2}, "share from 0 to 1"), (3, "is a table")):
        with pytest.raises(BadCourse, match=said):
            Rules.of({"prices": table}, "course.toml")


def test_a_course_may_charge_for_the_other_case_wherever_it_shows():
    exercise = COURSE["four_bar_motion"]
    variant = exercise.variant(3, "en")
    other = "crossed" if variant.given["mode"] == "open" else "open"
    swapped = Variant(exercise, 3, {**variant.given, "mode": other}, "en").solution()
    swapped = {i: value for i, value in swapped.items() if i in variant.part_ids}
    for share in (1.0, 0.5):
        marking = marked("four_bar_motion", Rules(other_case=share), **swapped)
        followed = [m for m in marking.values() if m.verdict == "follow_through"]
        assert len(followed) > 3
        assert {m.points / m.out_of for m in followed} == {share}, [m.feedback for m in followed]


# ---------------------------------------------------------------- nobody earns without knowing


@every_exercise
@pytest.mark.parametrize("count", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_nothing_follows_for_who_writes_without_work(name, count):
    report = CheckReport(name)
    check_knowledge(distinct_variants(COURSE[name], 0, count, "en"), report)
    assert report.failures == []
    assert report.counts["sheets without work"] >= count * 40


@pytest.mark.parametrize("name", ["velocity_polygon", "acceleration_polygon", "velocity_polygon_slider"])
def test_no_value_is_paid_for_that_is_read_off_a_drawing_of_one_number(name):
    for variant in distinct_variants(COURSE[name], 0, 3, "en"):
        for number in ("1", "2", "0.5"):
            marking = variant.grade(dict.fromkeys(variant.part_ids, number))
            read_off = [
                p.id for p in variant.parts if p.judge and p.sort.is_number and not p.unit.endswith("/mm")
            ]
            assert not {marking[i].verdict for i in read_off} & {"follow_through", "correct"}


def test_a_number_far_from_any_size_is_no_attempt_and_one_of_the_right_size_is():
    variant = COURSE["slotted_mechanism"].variant(7, "en")
    right = variant.solution()
    for rA, follows in ((1.3 * right["rA"], True), (317.0 * right["rA"], False)):
        omega4 = right["omega4"] * right["rA"] / rA
        assert (variant.grade({"rA": rA, "omega4": omega4})["omega4"].verdict == "follow_through") is follows


def test_values_by_the_column_are_those_of_each_alone():
    from coursework.course.key_batch import keys_of

    exercise = COURSE["quick_return"]
    alone, together = (distinct_variants(exercise, 0, 2, "en") for _ in range(2))
    keys_of(exercise, together)
    for one, other in zip(alone, together, strict=True):
        for part in one.parts:
            if not part.sort.is_scalar or part.judge:
                continue
            own = dict(zip(*one.key.usual_ways(part.quantity), strict=True))
            shared = dict(zip(*other.key.usual_ways(part.quantity), strict=True))
            for error in own.keys() & shared.keys():
                if np.isfinite(own[error]) and np.isfinite(shared[error]):
                    assert own[error] == pytest.approx(shared[error], rel=1e-6, abs=1e-9), error


@pytest.mark.parametrize("name", NUMERIC)
def test_a_cause_is_told_in_symbols_that_the_student_has_seen(name):
    """Those of what is given or asked; of any other quantity the symbol stands in no sentence, in either
    language."""
    for lang in ("en", "fr"):
        (variant,) = distinct_variants(COURSE[name], 0, 1, lang, parts=(ALL,))
        known = {*variant.given, *(part.quantity for part in variant.exercise.spec.parts)}
        seen = sorted((variant.solution_symbol(quantity) for quantity in known), key=len, reverse=True)
        names = variant.exercise.solution.graph.names - known
        unseen = {variant.solution_symbol(name) for name in names} - {*seen}
        wrong = []
        for part in variant.parts:
            if not part.sort.is_scalar or part.judge:
                continue
            for error in variant.key.usual_ways(part.quantity)[0]:
                text = why(variant, error, part.quantity)
                printed = re.findall(r"\$([^$]*)\$", text)
                wrong += [(part.id, text) for piece in printed if _holds(piece, seen, unseen)]
        assert wrong == []


def _holds(piece, seen, unseen):
    """Return whether a formula is an unseen symbol, or holds one of several letters, once the seen ones are
    taken out."""
    if piece in unseen:
        return True
    for one in seen:
        piece = piece.replace(one, " ")
    return any(
        len(one) > 1 and re.search(rf"(?<![A-Za-z\\]){re.escape(one)}(?![A-Za-z0-9_'^])", piece)
        for one in unseen
    )


@whole_course
@each_row("lang", ["en", "fr"])
def test_a_number_that_nothing_explains_is_told_its_sign_and_order_of_magnitude(lang):
    table, silent, told = words(lang)["marking"], [], 0
    for name in NUMERIC:
        variant = COURSE[name].variant(4, lang)
        for part in variant.parts:
            if part.judge or part.kind != "number":
                continue
            value = variant.solution()[part.quantity]
            for factor, due in ((71.23, {"large"}), (-0.007123, {"sign", "small"}), (1.37, set())):
                mark = variant.grade({part.id: f"{factor * value:.6g}"})[part.id]
                if mark.verdict != "wrong":
                    continue
                said = {
                    key
                    for key, sentence in table["size"].items()
                    if sentence.replace("'", "’") in mark.feedback.replace("'", "’")
                }
                told += 1
                if said != due and value:
                    silent.append((name, part.id, factor, mark.feedback))
    assert silent == []
    assert told > 100
