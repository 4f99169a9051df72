"""No honest student is marked wrong, no known mistake right: rounding on the way, earlier errors, slips."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np
import pytest
from sweeps import sampled
from tables import each_row

import coursework
from coursework.authoring import checks
from coursework.authoring.check_report import KEPT_DIGITS, CheckReport
from coursework.course.answer_key import Key
from coursework.course.key_batch import keys_of
from coursework.course.marking_rules import Rules
from coursework.errors import BadCourse, Starved
from coursework.issuing.flaws import HIDDEN, SHOWN, flaws, visibility
from coursework.issuing.issuing import distinct_variants
from coursework.issuing.protection import valid_variants
from coursework.model import Part
from coursework.quantities.rounding import envelope, half_step, rounded, student_who_rounds

COURSE = coursework.open_course()
every_exercise = pytest.mark.parametrize("name", COURSE.names)


def distance(part, *values):
    return part.sort.distance(part, *values)


def issued(name, count=25):
    return distinct_variants(COURSE[name], 0, count, "en")


# --------------------------------------------------------------------- rounding


@each_row(
    ("value", "digits", "expected"),
    [(319.8037, 4, 319.8), (-0.00123456, 3, -0.00123), (99995.0, 4, 100000.0), (0.0, 4, 0.0), (7, 3, 7.0)],
)
def test_numbers_round_to_significant_digits(value, digits, expected):
    assert rounded(value, digits) == pytest.approx(expected, rel=1e-15)
    assert rounded(np.array([float(value)]), digits)[0] == pytest.approx(expected, rel=1e-12)


def test_what_is_no_number_is_not_rounded():
    assert rounded("open", 4) == "open"
    assert rounded(1.23456 + 7.65432j, 3) == 1.23 + 7.65j
    assert rounded((1.23456, "a"), 3) == (1.23, "a")
    assert math.isnan(rounded(math.nan, 3))
    assert half_step(319.8, 4) == pytest.approx(0.05)


@each_row("exponent", range(-6, 9))
def test_the_last_digit_kept_does_not_hang_on_a_last_bit(exponent):
    power = 10.0**exponent
    for off in range(-20, 21):
        number = power * (1 + off * np.finfo(float).eps)
        assert half_step(number, 4) == pytest.approx(0.0005 * power, rel=1e-12)


@every_exercise
@pytest.mark.parametrize("digits", sampled(KEPT_DIGITS, KEPT_DIGITS[:1]))
def test_who_rounds_at_every_step_is_right(name, digits):
    report = CheckReport(name)
    drawn = issued(name)
    keys_of(COURSE[name], drawn)
    checks.check_rounding_students(COURSE[name], drawn, report, (digits,))
    assert report.failures == []
    rounded_parts = [p for p in COURSE[name].spec.parts if p.has_margin]
    assert (report.counts[f"rounding to {digits}"] > 0) == bool(rounded_parts)


@pytest.mark.parametrize("count", [8, pytest.param(60, marks=pytest.mark.slow)])
def test_rounding_would_cost_honest_students_the_usual_margin(count):
    """Why the margin follows the graph: at three digits many land outside 1 % by rounding alone."""
    report = CheckReport("slider_extras")
    drawn = issued("slider_extras", count)
    keys_of(COURSE["slider_extras"], drawn)
    checks.check_rounding_students(COURSE["slider_extras"], drawn, report, (3,))
    assert report.counts["outside the usual margin at 3"] > count / 6


def test_an_envelope_is_the_sum_of_what_each_step_can_move():
    """x = 2 a, y = x + b: by hand, half a last digit of x and half a one of y."""
    from coursework.quantities.graph import Graph

    def x(a):
        return 2 * a

    def y(x, b):
        return x + b

    found = envelope(Graph({"x": x, "y": y}), ("y",), {"a": 61.7, "b": 800.0}, (), 4)
    assert found["y"][0] == pytest.approx(1.1 * (0.05 + 0.05))
    student = student_who_rounds(Graph({"x": x, "y": y}), ("y",), {"a": 61.73, "b": 800.0}, (), 3)
    assert student == {"y": 923.0}


def test_an_envelope_takes_arrays_vectors_and_directions():
    from coursework.quantities.graph import Graph

    def turned(theta):
        return theta + 100.0

    def point(turned):
        return np.stack([turned, 0 * turned, 2 * turned], axis=-1)

    graph = Graph({"turned": turned, "point": point})
    given = {"theta": np.array([10.0, 79.97])}
    found = envelope(graph, ("turned", "point"), given, (), 4, {"turned"})
    assert found["turned"] == pytest.approx(1.1 * np.array([0.05, 0.05]))
    # The step of `turned` moves all coordinates together; each coordinate is rounded by itself, too.
    one = 1.1 * (0.05 * math.sqrt(5) + 0.05 + 0.05)
    assert found["point"][0] == pytest.approx(one)


# --------------------------------------------------------------------- worth it


@every_exercise
def test_an_issued_variant_tells_every_known_mistake_from_a_right_answer(name):
    for variant in issued(name, 12):
        assert list(flaws(variant.key)) == []
        for mistake, stated in variant.key.solution.mistakes.items():
            seen = {kind for _, kind in visibility(variant.key, mistake)}
            assert stated.approximation or "murky" not in seen


@every_exercise
def test_an_issued_variant_survives_rounding(name):
    for variant in issued(name, 12):
        for part in variant.parts:
            if part.is_exact or part.kind == "direction":
                continue
            reference = variant.key.reference[part.quantity]
            limit = 1.0 if part.unit == "deg" else 0.03 * np.linalg.norm(reference)
            assert variant.key.envelope[part.quantity] <= limit


def test_unworthy_seeds_are_passed_over_and_counted():
    exercise, refused = COURSE["slotted_mechanism"], Counter()
    drawn = distinct_variants(exercise, 0, 30, "fr", refused)
    seeds = [v.seed for v in drawn]
    assert len(set(seeds)) == 30
    assert sum(refused.values()) > 5
    assert all(flaw.startswith(("murky", "ill-conditioned", "unseen")) for flaw in refused)
    # The same seeds draw what they always draw, and are the same in the students' order.
    assert [exercise.variant(s).given for s in seeds] == [v.given for v in drawn]
    assert seeds == [v.seed for v in valid_variants(exercise, exercise.variants(range(max(seeds) + 1)))]


def test_a_course_of_murky_variants_starves_with_the_reason(small_course):
    path = small_course / "solutions" / "crank_pin.py"
    text = path.read_text("utf-8")
    path.write_text(text.replace("return r * omega * 2 * np.pi", "return r * omega * 1.015"), "utf-8")
    with pytest.raises(Starved, match="murky: turns_for_radians on v"):
        distinct_variants(coursework.open_course(small_course)["crank_pin"], 0, 5, "fr")


@every_exercise
def test_keys_made_together_are_those_made_alone(name):
    exercise = COURSE[name]
    together = exercise.variants(range(8))
    keys_of(exercise, together)
    for variant in together:
        alone = Key(exercise.variant(variant.seed))
        assert variant.key.reference.keys() == alone.reference.keys()
        for quantity, value in alone.reference.items():
            if isinstance(value, str):
                assert variant.key.reference[quantity] == value
            else:
                np.testing.assert_allclose(variant.key.reference[quantity], value, rtol=1e-9, atol=1e-12)
        for quantity, width in alone.envelope.items():
            assert variant.key.envelope[quantity] == pytest.approx(width, rel=1e-6, abs=1e-12)
        for mistake, values in alone.wrong.items():
            for quantity, value in values.items():
                if not isinstance(value, str) and np.all(np.isfinite(value)):
                    np.testing.assert_allclose(
                        variant.key.wrong[mistake][quantity], value, rtol=1e-8, atol=1e-9
                    )


# --------------------------------------------------------------- follow-through


@pytest.fixture
def slotted():
    """The course's own numbers, with rates."""
    exercise = COURSE["slotted_mechanism"]
    record = exercise.variant(0).record
    given = {"r1": 228.6, "r2": 114.3, "theta1": 90.0, "theta2": 135.0, "omega2": 4.0, "alpha2": 10.0}
    values = {n: {"value": v, "unit": exercise.spec.given[n].unit} for n, v in given.items()}
    return exercise.from_record({**record, "given": values, "lang": "en"})


def test_a_right_method_from_an_earlier_wrong_answer_keeps_its_points(slotted):
    rA = 280.0  # wrong
    right = slotted.solution()
    omega4 = right["omega4"] * right["rA"] / rA
    marking = slotted.grade({"rA": rA, "omega4": omega4})
    assert marking["rA"].verdict == "wrong"
    assert marking["omega4"].verdict == "follow_through"
    assert marking["omega4"].points == marking["omega4"].out_of
    assert "(question 1)" in marking["omega4"].feedback


@pytest.mark.parametrize("share", [1.012, 1.015, 1.018, 1.03, 1.3])
def test_a_small_error_costs_no_more_than_a_large_one(slotted, share):
    right = slotted.solution()
    omega4 = right["omega4"] / share
    wrong = {"rA": right["rA"] * share, "omega4": omega4}
    follows = {"a_centripetal": -wrong["rA"] * omega4**2, "a_coriolis": 2 * omega4 * right["rA_dot"]}
    marking = slotted.grade({**wrong, "rA_dot": right["rA_dot"], **follows})
    assert marking["rA"].verdict == "wrong"
    assert {marking[i].verdict for i in ("omega4", *follows)} <= {"correct", "follow_through"}


def test_what_is_counted_follows_from_an_earlier_count():
    """m, r_s and h of a chain whose N_c has been miscounted, by the rules of the course."""
    variant = COURSE["planar_chain"].variant(2)
    right = variant.solution()
    m = right["Nc"] + 1 - right["rc"]
    answers = {"Nc": right["Nc"] + 1, "rc": right["rc"], "m": m, "Ns": right["Ns"], "rs": 9 - m}
    marking = variant.grade({**answers, "h": right["Ns"] - (9 - m)})
    assert marking["Nc"].verdict != "correct"
    assert [marking[i].verdict for i in ("m", "rs", "h")] == ["follow_through"] * 3
    # From a degree of mobility of 0, too: that is an answer like others.
    marking = variant.grade({"m": 0, "rs": 9})
    assert marking["m"].verdict != "correct"
    assert marking["rs"].verdict == "follow_through"


def test_a_case_follows_from_an_earlier_count():
    variant = next(v for v in issued("closed_chain") if v.solution()["h"] == 0)
    marking = variant.grade({"h": 1, "statics": "hyperstatic"})
    assert (marking["h"].verdict, marking["statics"].verdict) == ("wrong", "follow_through")
    assert variant.grade({"h": 0, "statics": "hyperstatic"})["statics"].points == 0


@every_exercise
def test_no_mistake_is_told_that_an_earlier_right_answer_disproves(name):
    """The sign of one answer is wrong, all before it is right."""
    for variant in issued(name, 12):
        key, right = variant.key, {}
        for part in variant.parts:
            reference = key.reference[part.quantity]
            if part.kind not in ("number", "angle", "integer") or part.judge:
                continue
            mark = variant.grade({**right, part.id: -reference})[part.id]
            kind, _, mistake = mark.verdict.partition(":")
            right[part.id] = reference
            if kind == "mistake" and part.quantity not in key.solution.mistakes[mistake].targets:
                about = [p for p in variant.parts if p.quantity in key.solution.mistakes[mistake].targets]
                disproved = [
                    p.id
                    for p in about
                    if p.id in right
                    and (wrong := key.wrong[mistake].get(p.quantity)) is not None
                    and distance(p, wrong, key.reference[p.quantity], None, key.envelope[p.quantity]) > 1
                ]
                assert not disproved, (variant.seed, part.id, mistake)


def test_a_sign_is_not_laid_to_an_arctangent_that_was_right():
    variant = COURSE["slotted_mechanism"].variant(7)
    right = variant.solution()
    answers = {i: right[i] for i in ("rA", "theta4", "omega4")}
    mark = variant.grade({**answers, "rA_dot": -right["rA_dot"]})["rA_dot"]
    assert mark.verdict == "mistake:rA_dot_sign"
    mark = variant.grade({**answers, "rA_dot": right["rA_dot"], "a_coriolis": -right["a_coriolis"]})
    assert mark["a_coriolis"].verdict == "slip:sign"
    # Alone, the same answer may well come of it.
    assert "mistake:rA_dot_sign" in variant.grade({"a_coriolis": -right["a_coriolis"]})["a_coriolis"].matches


def test_nothing_follows_from_a_right_a_later_or_an_unread_answer(slotted):
    right = slotted.solution()
    follows = right["omega4"] * right["rA"] / 280.0
    for earlier in ({"rA": right["rA"]}, {"rA": "beaucoup"}, {"rA": "280 kg"}, {}):
        assert slotted.grade({**earlier, "omega4": follows})["omega4"].verdict == "wrong"
    # A later part explains no earlier one.
    assert slotted.grade({"omega4": 99.0, "rA": 280.0})["rA"].verdict == "wrong"


def test_nothing_follows_from_nought(slotted):
    """With omega4 = 0 every term that holds it is 0: that earns nothing."""
    marking = slotted.grade({"omega4": 0, "a_centripetal": 0, "a_coriolis": 0})
    assert [m.verdict for m in marking.values() if m.answer == "0"] == ["wrong"] * 3


def test_an_earlier_error_that_hardly_matters_explains_nothing():
    exercise = COURSE["four_bar_motion"]
    variant = issued("four_bar_motion", 1)[0]
    right = variant.solution()
    # v_B does not depend on omega3.
    marking = variant.grade({"omega3": 2 * right["omega3"], "v_B": 1.5 * right["v_B"]})
    assert marking["v_B"].verdict == "wrong"
    assert exercise.solution.depending_on("omega3").isdisjoint({"v_B", "theta4"})


def test_a_course_may_give_a_share_for_what_follows(small_course):
    course = small_course / "exercises" / "course.toml"
    course.write_text("[marking]\nfollow_through = 0.5\nslip = 0.25\ndigits = 3\n", "utf-8")
    rules = coursework.open_course(small_course).folder.rules
    assert rules == Rules(digits=3, follow_through=0.5, slip=0.25)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("[marking]\ndigit = 3\n", "did you mean"),
        ("[marking]\ndigits = 1\n", "from 2 to 12"),
        ("[marking]\nslip = 2\n", "from 0 to 1"),
        ("marking = 4\n", "is a table"),
    ],
)
def test_rules_that_make_no_sense_are_told(small_course, text, told):
    (small_course / "exercises" / "course.toml").write_text(text, "utf-8")
    with pytest.raises(BadCourse, match=told):
        _ = coursework.open_course(small_course).folder.rules


# ------------------------------------------------------------------------ slips


def test_slips_are_recognised_and_told(slotted):
    right = slotted.solution()
    for part, answer, kind, told in (
        ("rA_dot", -right["rA_dot"], "sign", "opposite sign"),
        ("theta4", math.radians(right["theta4"]), "radians", "degrees and radians"),
        ("rA", right["rA"] / 1000, "unit", "power of ten"),
        ("omega4", right["omega4"] * 60 / (2 * math.pi), "turns_a_minute", "turns a minute"),
    ):
        mark = slotted.grade({part: answer})[part]
        assert f"slip:{kind}" in mark.matches, part
        if not mark.verdict.startswith("mistake"):
            assert told in mark.feedback
            assert mark.points == 0.5 * mark.out_of
            assert str(round(float(right[part]), 3)) not in mark.feedback


def test_the_other_assembly_is_recognised():
    variant = next(v for v in issued("slider_extras", 5))
    other = "crossed" if variant.given["mode"] == "open" else "open"
    value = variant.exercise.solve(**{**variant.given, "mode": other}, only="theta3")["theta3"]
    assert "slip:other_case" in variant.grade({"theta3": value})["theta3"].matches


def test_a_declared_mistake_comes_before_a_slip():
    for variant in issued("slider_crank", 5):
        mark = variant.grade({"r1_dot": -variant.solution()["r1_dot"]})["r1_dot"]
        assert mark.matches[:2] == ("mistake:notes_piston_sign", "slip:sign")


# ------------------------------------------------------------------------ units


def test_a_part_that_asks_for_the_unit_says_when_it_is_missing(small_course):
    path = small_course / "exercises" / "crank_pin.py"
    text = path.read_text("utf-8")
    assert 'Part("v", unit="mm/s"' in text
    path.write_text(text.replace('Part("v", unit="mm/s"', 'Part("v", asks_unit=True, unit="mm/s"'), "utf-8")
    variant = coursework.open_course(small_course)["crank_pin"].variant(1, "en")
    value = variant.solution()["v"]
    assert variant.grade({"v": f"{value} mm/s"})["v"].verdict == "correct"
    assert variant.grade({"v": f"{value / 1000} m/s"})["v"].verdict == "correct"
    missing = variant.grade({"v": value})["v"]
    assert (missing.verdict, missing.points) == ("missing_unit", 0)
    assert "unit" in missing.feedback
    assert variant.grade({"v": 3 * value})["v"].verdict == "wrong"
    question = next(q for q in variant.handout().questions if q.id == "v")
    assert question.unit == ""
    with pytest.raises(BadCourse, match="unit"):
        Part("n", kind="integer", asks_unit=True)


def test_the_envelope_widens_and_never_narrows():
    part = Part("x", unit="mm")
    assert distance(part, 103.0, 100.0) > 1
    assert distance(part, 103.0, 100.0, None, 3.0) == 1.0
    assert distance(part, 101.0, 100.0, None, 0.1) == 1.0
    assert HIDDEN < 1 < SHOWN


# ------------------------------------------------------------------------- bulk


@pytest.mark.parametrize("name", sampled(COURSE.names))
def test_many_sheets_are_marked_as_each_alone(name):
    """By the column or one by one, the verdict, the points, what was read and what is said are the same."""
    from coursework.gradebook.class_marking import _mark_chunk, _SheetJob, _waiting
    from coursework.marking.mark import Mark

    exercise = COURSE[name]
    variants = exercise.variants(range(24), "en")
    jobs = []
    for i, variant in enumerate(variants):
        answers = {}
        for j, part in enumerate(variant.parts):
            value = variant.key.reference[part.quantity]
            if isinstance(value, float) and not part.is_exact:
                ways = (
                    f"{value:.6g}",
                    f" {value:.5g}".replace(".", ","),
                    f"{-value:.5g}",
                    "",
                    "abc",
                    1.3 * value,
                )
                answers[part.id] = (*ways, f"{value:.7g} {part.unit}")[(i + j) % 7]
            elif isinstance(value, str):
                answers[part.id] = value
        jobs.append(_SheetJob(variant.record, answers))
    together = _mark_chunk(COURSE, jobs, None, {})
    for job, lines in zip(jobs, together, strict=True):
        alone = exercise.from_record(job.record).grade(job.answers)
        lines = [Mark(*line) for line in lines]
        assert [line.part for line in lines] == list(alone)
        for line in lines:
            mark = _waiting(alone[line.part])
            assert (line.verdict, line.points, line.read_as, line.answer, line.feedback, line.matches) == (
                mark.verdict,
                mark.points,
                mark.read_as,
                mark.answer,
                mark.feedback,
                mark.matches,
            )
