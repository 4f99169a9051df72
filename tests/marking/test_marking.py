"""Marking: fair to every honest spelling, and never a point for what is wrong."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from tables import each_row

from coursework.errors import UnknownName, WrongValue
from coursework.marking import marking
from coursework.markup.markdown import plain_line
from coursework.model import Part

GIVEN = {"r1": 228.6, "r2": 114.3, "theta1": 90.0, "theta2": 135.0, "omega2": 5.0, "alpha2": 0.0}


def distance(part, *values):
    return part.sort.distance(part, *values)


@pytest.fixture(scope="module")
def slotted(course):
    """The course's own numbers: rA = 319.80 mm, theta4 = 104.64 deg."""
    from coursework.api import Variant

    return Variant(course["slotted_mechanism"], 0, GIVEN, "fr")


def verdict(variant, part, answer):
    return variant.grade({part: answer})[part].verdict


@each_row(
    "answer",
    [
        "319,8 mm",
        "319.8",
        "0.3198 m",
        "31,98 cm",
        "3,198e2",
        "3.198·10²",
        " 319,80 mm ",
        "rA = 319,8 mm",
        319.8,
    ],
)
def test_a_length_is_right_in_every_honest_spelling(slotted, answer):
    assert verdict(slotted, "rA", answer) == "correct"


@each_row("answer", ["104,6°", "104.64 deg", "1.8263 rad", "-255,4", "464.64", "104°38'"])
def test_an_angle_is_right_in_every_honest_spelling(slotted, answer):
    assert verdict(slotted, "theta4", answer) == "correct"


@each_row(
    ("answer", "expected"),
    [
        ("319,8 kg", "wrong_unit"),
        ("319,8 rad", "wrong_unit"),
        ("", "missing"),
        ("   ", "missing"),
        (None, "missing"),
        ("beaucoup", "unreadable"),
        ("9**9**9", "unreadable"),
        ("nan", "unreadable"),
        ("x" * 10_000, "unreadable"),
        ("0", "wrong"),
        ("500", "wrong"),
        ("319.8 m", "slip:unit"),
        (True, "unreadable"),
    ],
)
def test_what_is_not_right_has_its_own_verdict(slotted, answer, expected):
    mark = slotted.grade({"rA": answer})["rA"]
    assert mark.verdict == expected
    assert mark.points == (0.5 if expected == "slip:unit" else 0)


def test_answers_that_are_no_answers_are_refused(slotted):
    for nothing in (None, ["3"], "3"):
        with pytest.raises(WrongValue, match="by part"):
            slotted.grade(nothing)


def test_the_original_text_is_always_kept(slotted):
    for answer in ("x" * 10_000, "  319,8  ", "319.8\u202fmm"):
        assert slotted.grade({"rA": answer})["rA"].answer == answer


def test_a_part_left_out_is_missing(slotted):
    marking = slotted.grade({})
    assert {m.verdict for m in marking.values()} == {"missing"}
    assert marking.points == 0
    assert marking.out_of == sum(p.points for p in slotted.parts)


def test_an_answer_to_an_unknown_part_is_refused_with_the_nearest(slotted):
    with pytest.raises(UnknownName, match="did you mean 'theta4'"):
        slotted.grade({"theta5": "3"})
    with pytest.raises(UnknownName, match="did you mean 'rA'"):
        slotted.grade({})["ra"]


@each_row("lang", ["fr", "en"])
def test_a_choice_may_be_given_by_label_in_either_language_or_by_key(course, lang):
    exercise = course["slotted_mechanism"]
    variant = next(v for v in exercise.variants(range(20), lang) if any(p.id == "guide" for p in v.parts))
    right = variant.solution()["guide"]
    (part,) = (p for p in variant.parts if p.id == "guide")
    place = variant.letters(part)[right]
    labels = [variant.in_language(other).text.label("guide", right) for other in ("fr", "en")]
    for answer in (*labels, right, right.upper(), f"{place}) {labels[1]}", labels[0].upper()):
        assert verdict(variant, "guide", answer) == "correct", answer
    assert verdict(variant, "guide", f"{place})") == "correct"
    assert verdict(variant, "guide", f"{'ab'.replace(place, '')})") == "wrong"
    other = {"oscillates": "rotates", "rotates": "oscillates"}[right]
    assert verdict(variant, "guide", other) == "wrong"
    assert verdict(variant, "guide", "peut-être") == "unreadable"
    record = {**variant.record, "parts": [{**p, "choices": []} for p in variant.record["parts"]]}
    for one in record["parts"]:
        del one["choices"]
    assert verdict(exercise.from_record(record), "guide", f"{place})") == "unreadable"


def test_a_known_mistake_is_recognised_with_its_share_of_the_points(slotted):
    marking = slotted.grade({"theta4": "-75,36", "a_coriolis": ""})
    assert marking["theta4"].verdict == "mistake:arctan_no_quadrant"
    assert marking["theta4"].points == 0.5
    assert "quadrant" in marking["theta4"].feedback


def test_feedback_never_gives_the_reference(slotted):
    for answer in ("12", "-75.36", "3 kg", "??", ""):
        for lang in ("fr", "en"):
            mark = slotted.in_language(lang).grade({"theta4": answer})["theta4"]
            assert "104" not in mark.feedback
            assert mark.feedback


def test_feedback_names_the_quantity_and_what_was_read(slotted):
    assert slotted.grade({"theta4": "12,5 grad"})["theta4"].feedback.startswith("θ₄ : 12,5 grad")
    assert (
        slotted.in_language("en")
        .grade({"theta4": "12,5 grad"})["theta4"]
        .feedback.startswith("θ₄: 12.5 grad")
    )


def test_a_hostile_answer_cannot_write_markup_into_feedback(slotted):
    mark = slotted.grade({"rA": "<script>$x$`*_[a](b)|\\"})["rA"]
    assert "<script>$x$`*_[a](b)|\\" in mark.feedback
    written = re.sub(r"\\.", "", mark.says.replace("$r_A$", ""))
    assert not set("<>$`*_[]|\\") & set(written)


def test_an_equation_is_quoted_with_its_stars(course):
    variant = course["slotted_mechanism"].variant(0, "en", ("all",))
    mark = variant.grade({"loop_1_x": "r2*cos(theta2) - 2**rA*cos(theta4)"})["loop_1_x"]
    assert "“r2*cos(theta2) - 2**rA*cos(theta4)”" in mark.feedback
    assert r"r2\*cos(theta2)" in mark.says


def test_both_readings_of_an_ambiguous_group_are_tried(course):
    from coursework.api import Variant

    variant = Variant(
        course["slotted_mechanism"], 0, {**GIVEN, "r1": 1000.0, "r2": 234.0, "theta2": 90.0}, "fr"
    )
    assert variant.grade({"rA": "1,234", "omega4": "12.5"})["rA"].verdict == "correct"
    assert verdict(variant, "rA", "1,234") == verdict(variant, "rA", "1.234") == "unreadable"
    assert verdict(variant, "rA", "1,234 m") == "correct"
    small = Variant(course["slotted_mechanism"], 0, {**GIVEN, "r1": 1.0, "r2": 0.234, "theta2": 90.0}, "fr")
    assert verdict(small, "rA", "1,234") == "correct"
    assert small.grade({"rA": "1,234"})["rA"].read_as == "1.234"


def test_a_wrong_angle_is_not_right_as_so_many_thousand_degrees(course):
    """113466° is 66° modulo a turn; 113,466 is 113,466 and wrong."""
    variant = course["slotted_mechanism"].variant(1, "fr")
    for thousandths in range(10_000, 360_000, 371):
        value = thousandths / 1000
        if distance(Part("x", kind="angle", atol=3.0), value, variant.solution()["theta4"]) > 1:
            mark = variant.grade({"theta4": f"{value:.3f}".replace(".", ",")})["theta4"]
            assert mark.verdict != "correct", value
            assert mark.read_as.startswith(f"{value:.3f}")


def test_a_wrong_number_is_quoted_as_it_is_written_unless_its_thousands_are_meant(slotted):
    for answer, read in (("246,729", "246.729"), ("500,123", "500.123"), ("1,234", "1.234")):
        assert slotted.grade({"rA": answer})["rA"].read_as == read
    # 319 800 for 319.8 is a slip of the unit, of which the thousands tell.
    assert slotted.grade({"rA": "319,800 m"})["rA"].verdict == "slip:unit"
    large = slotted.solution()["a_centripetal"] * 10
    mark = slotted.grade({"a_centripetal": f"{large:,.0f}"})["a_centripetal"]
    assert (mark.verdict, mark.read_as) == ("slip:unit", f"{large:.0f}")


@each_row("wrap", [np.float64, np.array, lambda x: np.array([x]), lambda x: [x]])
def test_what_a_cell_computes_is_marked_and_quoted_as_a_number(slotted, wrap):
    assert verdict(slotted, "rA", wrap(319.8)) == "correct"
    mark = slotted.grade({"rA": wrap(238.4)})["rA"]
    assert (mark.verdict, mark.answer) == ("wrong", "238.4")
    assert "238,4" in mark.feedback
    assert "np" not in mark.feedback


# ----------------------------------------------------------------------- distance


@each_row("reference", [319.8, -0.731, 12345.6, 1e-6])
@each_row("rtol", [0.01, 0.05, 1e-3])
def test_the_boundary_counts_as_right_and_a_hair_beyond_does_not(reference, rtol):
    part = Part("x", rtol=rtol)
    for side in (-1, 1):
        for edge in (reference * (1 + side * rtol), reference + side * rtol * abs(reference)):
            assert distance(part, edge, reference) <= 1
        assert distance(part, reference * (1 + side * rtol * (1 + 1e-8)), reference) > 1


def test_every_decimal_on_the_edge_of_a_decimal_reference_is_right():
    """An answer of so many cents on the edge, written in decimals, is inside: no rounding decides."""
    part = Part("x", rtol=0.01)
    for cents in range(100, 20_000, 100):
        reference = cents / 100
        for edge in (cents * 99, cents * 101):
            assert distance(part, edge / 10_000, reference) <= 1


def test_angles_compare_modulo_a_turn_and_amounts_do_not():
    angle, amount = Part("x", kind="angle"), Part("x", unit="deg")
    assert distance(angle, -179.5, 180.0) <= 1
    assert distance(angle, 539.0, 180.0) <= 1
    assert distance(angle, 178.9, 180.0) > 1
    assert distance(amount, -179.5, 180.0) > 1


def test_a_zero_reference_needs_an_absolute_tolerance():
    assert distance(Part("x"), 0.0, 0.0) <= 1
    assert distance(Part("x"), 1e-9, 0.0) == math.inf
    assert distance(Part("x", atol=0.1), 0.1, 0.0) <= 1


def test_any_point_of_the_line_is_right_and_no_other():
    part = Part("p", unit="mm", kind="point_on_line", along="d", atol=0.5, rtol=0.0)
    reference, along = np.array([10.0, 0.0, 0.0]), np.array([1.0, 0.0, 1.0])
    assert distance(part, (10.0, 0.0, 0.0), reference, along) <= 1
    assert distance(part, (60.0, 0.0, 50.0), reference, along) <= 1
    assert distance(part, (10.0, 0.5, 0.0), reference, along) <= 1
    assert distance(part, (10.0, 0.6, 0.0), reference, along) > 1
    assert distance(part, (0.0, 0.0, 0.0), reference, along) > 1


def test_any_nonzero_multiple_of_a_direction_is_right():
    part, reference = Part("d", kind="direction"), np.array([1.0, 0.0, 1.5])
    for multiple in (1, -1, 1e-6, 250, 1e200, 1e-200):
        assert distance(part, tuple(multiple * reference), reference) <= 1
    assert distance(part, (0.0, 0.0, 0.0), reference) > 1
    assert distance(part, (1.0, 0.0, 1.0), reference) > 1


# -------------------------------------------------------------------- either order


def test_two_assemblies_may_be_given_in_the_other_order_consistently(course):
    variant = course["four_bar_positions"].variant(3)
    right = variant.solution()
    names = ("theta3", "theta4")
    swapped = {}
    for name in names:
        swapped[f"{name}_open"] = right[f"{name}_crossed"]
        swapped[f"{name}_crossed"] = right[f"{name}_open"]
    marking = variant.grade(swapped)
    assert [marking[p].verdict for p in swapped] == ["correct"] * 4
    assert "autre ordre" in marking["theta3_open"].feedback
    mixed = {**swapped, "theta3_open": right["theta3_open"], "theta3_crossed": right["theta3_crossed"]}
    assert sum(variant.grade(mixed)[p].verdict == "correct" for p in mixed) == 2


# ------------------------------------------------------------------------- words


def told(course, name, seed, lang, **answers):
    marking = course[name].variant(seed, lang).grade(answers)
    return {part: marking[part] for part in answers}


def test_what_may_be_written_for_a_choice_is_listed(course):
    exercise = course["slotted_mechanism"]
    seed = next(s for s in range(20) if "guide" in exercise.variant(s).part_ids)
    said = told(course, "slotted_mechanism", seed, "fr", guide="peut-être")["guide"]
    assert said.verdict == "unreadable"
    letters = exercise.variant(seed).letters(exercise.spec.part("guide"))
    offered = {
        "oscillates": ("« oscille »", "“oscillates”"),
        "rotates": ("« fait un tour complet »", "“makes a full turn”"),
    }
    in_french, in_english = (
        [f"{letter} ({offered[case][k]})" for case, letter in letters.items()] for k in (0, 1)
    )
    assert " ou ".join(in_french) in " ".join(said.feedback.split())
    said = told(course, "slotted_mechanism", seed, "en", guide="maybe")["guide"]
    assert " or ".join(in_english) in said.feedback


def test_long_labels_are_listed_by_what_stands_before_their_explanation(course):
    said = told(course, "four_bar_positions", 0, "en", linkage_type="a cranky thing")["linkage_type"]
    assert "“a crank-rocker”" in said.feedback
    assert "oscillates" not in said.feedback
    for name in course.names:
        variant = course[name].variant(0, "fr")
        for part in (p for p in variant.parts if p.kind == "choice"):
            assert len(variant.grade({part.id: "qzx"})[part.id].feedback) < 420


def test_a_choice_is_quoted_with_quotation_marks(course):
    right = course["vocabulary"].variant(0).solution()["useful_none"]
    said = told(course, "vocabulary", 0, "en", useful_none=right)["useful_none"]
    assert said.feedback.endswith("“m_u = 0” is right.")
    said = told(course, "vocabulary", 0, "fr", useful_none="m_u=1")["useful_none"]
    assert "« m_u = 1 »" in " ".join(said.feedback.split())


def test_a_name_is_quoted_with_its_underscore(course):
    said = told(course, "vocabulary", 7, "en", parallel_degree="h = N_s_r")["parallel_degree"]
    assert "“h = N_s_r”" in said.feedback


@each_row(("lang", "words"), [("fr", "un nombre entier, sans unité"), ("en", "a whole number, without")])
def test_a_whole_number_with_a_unit_is_said_to_have_none(course, lang, words):
    for answer in ("3 mm", "3 frogs"):
        assert words in told(course, "mobility", 0, lang, w=answer)["w"].feedback
    right = course["mobility"].variant(0).solution()["w"]
    assert told(course, "mobility", 0, lang, w=f"{right} ddl")["w"].verdict == "correct"


def test_an_area_in_square_metres_is_a_slip_of_the_unit(course):
    variant = course["four_bar_positions"].variant(0, "fr")
    area = variant.solution()["a"] * 1e-6
    assert variant.grade({"a": f"{area:.6g}".replace(".", ",")})["a"].verdict == "slip:unit"
    assert variant.grade({"a": f"{area:.6g} m²"})["a"].verdict == "correct"


def test_an_equation_with_numbers_put_in_is_said_to_be_that(course):
    variant = course["ball_reducer"].variant(0, "fr")
    R, r = (int(variant.given[n]) for n in "Rr")
    for answer in (f"{R + r}*phi_dot = -{r}*omega", f"(R + {r})*phi_dot = -{r}*omega"):
        mark = variant.grade({"no_slip_A": answer})["no_slip_A"]
        assert (mark.verdict, mark.points) == ("slip:numbers", 0)
        assert "vos nombres" in mark.feedback
    for answer in (f"{R + r}*phi_dot = {r}*omega", f"{R + r + 1}*phi_dot = -{r}*omega"):
        assert variant.grade({"no_slip_A": answer})["no_slip_A"].verdict != "slip:numbers"
    assert variant.grade({"no_slip_A": "(R + r)*phi_dot = -r*omega"})["no_slip_A"].verdict == "correct"


@each_row(
    ("lang", "missing", "scale"),
    [
        ("fr", "sans réponse : question {} ou {}", "une échelle est positive"),
        ("en", "without an answer to question {} or {}", "a scale is positive"),
    ],
)
def test_what_a_drawing_lacks_and_a_scale_that_is_none_are_told(course, lang, missing, scale):
    said = told(course, "velocity_polygon", 1, lang, kv="10", p="(0;0)")["p"]
    assert said.verdict == "wrong"
    asked = course["velocity_polygon"].variant(1).part_ids
    assert missing.format(*(asked.index(i) + 1 for i in "ab")) in " ".join(said.feedback.split())
    for answer in ("0", "-10"):
        assert scale in told(course, "velocity_polygon", 1, lang, kv=answer)["kv"].feedback
    drawn = told(course, "velocity_polygon", 1, lang, kv="-10", p="(0;0)", a="(1;2)", b="(3;4)")
    assert scale in drawn["kv"].feedback
    assert scale not in drawn["p"].feedback


@each_row("lang", ["fr", "en"])
def test_every_choice_is_read_by_what_is_offered_for_it(course, lang):
    """The label in one line of plain text, as a transcript or the feedback has it."""
    for name in course.names:
        variant = course[name].variant(1, lang, parts=["all"])
        for part in variant.parts:
            for case in part.choices if part.kind == "choice" else ():
                reading = marking.read(variant, part, plain_line(variant.label(part.id, case), lang))
                assert reading.values == (case,), (name, part.id, case, reading)


@each_row("lang", ["fr", "en"])
def test_what_may_be_written_for_a_choice_is_said_in_the_language_of_the_sheet_and_is_read(course, lang):
    variant = course["parallel_joints"].variant(0, lang)
    said = " ".join(variant.grade({"equivalent": "qzx"})["equivalent"].feedback.split())
    shown = (
        ("« pivot »", "« rotule à doigt »") if lang == "fr" else ("“revolute joint”", "“ball joint with pin”")
    )
    assert all(quotation in said for quotation in shown)
    assert ("revolute" in said) == (lang == "en")
    for quotation in re.findall("«\\s(.+?)\\s»|“(.+?)”", said)[1:]:
        assert variant.grade({"equivalent": max(quotation)})["equivalent"].verdict != "unreadable", quotation


@each_row(
    ("part", "answer", "told"),
    [
        ("rA", "douze virgule", "« douze virgule »"),
        ("rA", "12.5.8", "« 12.5.8 »"),
        ("rA", "la\nlongueur qui est dessinée sur la figure", "« la longueur qui est dessinée sur la fig… »"),
        ("rA", "12 parsecs", "« parsecs »"),
    ],
)
def test_an_answer_that_cannot_be_read_is_quoted_whole(course, part, answer, told):
    feedback = course["slotted_mechanism"].variant(1, "fr").grade({part: answer})[part].feedback
    plain = feedback.replace("\N{NARROW NO-BREAK SPACE}", " ").replace("’", "'")
    assert told in plain
