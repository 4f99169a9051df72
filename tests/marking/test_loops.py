"""Equations of loops are right in any correct form, beside each other; what is wrong is named by its link."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from sweeps import sampled, seeds, slow
from tables import each_row

import coursework
from coursework.authoring.check_loops import check_loops, equation_holds
from coursework.authoring.check_report import CheckReport
from coursework.errors import BadCourse, UnknownName, WrongValue
from coursework.issuing.issuing import issue
from coursework.kinematics.chains import ClosedChain, Vector
from coursework.marking.loop_judge import judge_of
from coursework.model import Part, loop_equations
from coursework.parsing.equations import parse_equation
from coursework.quantities.loops import Loop, stated

COURSE = coursework.open_course()
WITH_LOOPS = tuple(n for n in COURSE.names if any(part.loop for part in COURSE[n].spec.parts))
LOOPS = [(n, loop) for n in WITH_LOOPS for loop in COURSE[n].solution.loops]
every_loop = pytest.mark.parametrize(("name", "loop"), LOOPS)
few_loops = pytest.mark.parametrize(
    ("name", "loop"), [one if k % 3 == 0 else pytest.param(*one, marks=slow) for k, one in enumerate(LOOPS)]
)
every_exercise = pytest.mark.parametrize("name", WITH_LOOPS)


@cache
def asking_all(name, lang="en"):
    return COURSE[name].variant(1, lang, ("all",))


def verdicts(name, **answers):
    marking = asking_all(name).grade(answers)
    return tuple(marking[part].verdict for part in answers)


def verdict(name, part, answer):
    return verdicts(name, **{part: answer})[0]


# ------------------------------------------------------------------- right in any form

#: Right answers written by hand: exercise, part, text.
RIGHT = [
    ("slotted_mechanism", "loop_1_x", "r2*cos(theta2) = rA*cos(theta4)"),  # theta1 is always 90°
    ("slotted_mechanism", "loop_1_x", "r1 cos θ1 + r2 cos θ2 - rA cos θ4 = 0"),
    ("slotted_mechanism", "loop_1_y", "r1 + r2*sin(theta2) = rA*sin(theta4)"),
    ("slotted_mechanism", "loop_1_y", "rA = (r1 + r2*sin(theta2))/sin(theta4)"),
    ("slotted_mechanism", "loop_1_y", "r_1 cos(θ_4 - 90°) + r_2 cos(θ_4 - θ_2) = r_A"),  # on the guide
    ("slotted_mechanism", "loop_1_x", "r1 sin(theta1 - theta4) + r2 sin(theta2 - theta4) = 0"),  # across it
    ("slotted_mechanism", "loop_1_x", "tan(theta4) = (r1 + r2*sin(theta2))/(r2*cos(theta2))"),
    ("slotted_mechanism", "loop_1_y", "rA = sqrt(r1^2 + r2^2 + 2*r1*r2*sin(theta2))"),
    ("slotted_mechanism", "loop_1_complex", "i r1 + r2 e^(i θ2) = rA e^(i θ4)"),
    ("slotted_mechanism", "loop_1_complex", "r1*e^(-i*theta1) + r2*exp(-i*theta2) - rA*exp(-i*theta4) = 0"),
    ("slotted_mechanism", "loop_1_complex", "rA = r1 e^(i(θ1 - θ4)) + r2 e^(i(θ2 - θ4))"),
    ("slotted_mechanism", "loop_1_x_dot", "rA_dot cos θ4 - rA omega4 sin θ4 = -r2 omega2 sin θ2"),
    ("slotted_mechanism", "loop_1_x_dot", "rA_dot = r2 omega2 sin(theta4 - theta2)"),
    ("slotted_mechanism", "loop_1_y_dot", "rA omega4 = r2 omega2 cos(theta4 - theta2)"),
    (
        "slotted_mechanism",
        "loop_1_y_ddot",
        "rA alpha4 + 2 rA_dot omega4 = r2 alpha2 cos(theta4 - theta2) + r2 omega2^2 sin(theta4 - theta2)",
    ),
    ("four_bar_positions", "loop_1_x", "-r2*cos(theta2) = r3*cos(theta3) - r1 - r4*cos(theta4)"),
    ("four_bar_positions", "loop_1_y", "2*r2*sin(theta2) + 2*r3*sin(theta3) = 2*r4*sin(theta4)"),
    (
        "four_bar_positions",
        "loop_1_y",
        "r2*cos(theta2 - pi/2) + r3*cos(theta3 - pi/2) = r4*cos(theta4 - 90°)",
    ),
    (
        "four_bar_positions",
        "loop_1_x",
        "r2*sin(theta2 + 90) + r3*sin(theta3 + 90) - r4*sin(theta4 + 90) = r1",
    ),
    (
        "four_bar_positions",
        "loop_1_x",
        "r2*cos(pi*theta2/180) + r3*cos(pi*theta3/180) = r1 + r4*cos(pi*theta4/180)",
    ),
    (
        "four_bar_positions",
        "loop_1_x",
        "r2*cos(theta2 - theta3) + r3 = r1*cos(theta3) + r4*cos(theta4 - theta3)",
    ),
    ("four_bar_positions", "loop_1_x", "r4^2 = (r2 cos θ2 + r3 cos θ3 - r1)^2 + (r2 sin θ2 + r3 sin θ3)^2"),
    (
        "four_bar_positions",
        "loop_1_complex",
        r"r_2 e^{i\theta_2} + r_3 e^{i\theta_3} = r_1 + r_4 e^{i\theta_4}",
    ),
    ("four_bar_positions", "loop_1_complex", "r2 (cos θ2 + i sin θ2) + r3 e^(iθ3) - r1 - r4 e^(iθ4) = 0"),
    (
        "four_bar_motion",
        "loop_1_x_dot",
        "r2 omega2 sin(theta2 - theta4) + r3 omega3 sin(theta3 - theta4) = 0",
    ),
    ("four_bar_motion", "loop_1_y_dot", "omega4 = r2 omega2 sin(theta2 - theta3)/(r4 sin(theta4 - theta3))"),
    (
        "four_bar_motion",
        "loop_1_complex_dot",
        "r2 omega2 e^(i theta2) + r3 omega3 e^(i theta3) = r4 omega4 e^(i theta4)",
    ),
    ("slider_crank", "loop_1_x", "r1 = r2 cos θ2 + r3 cos θ3"),
    ("slider_crank", "loop_1_x", "r1 = r2 cos θ2 + sqrt(r3^2 - (e - r2 sin θ2)^2)"),
    ("slider_crank", "loop_1_y", "sin(theta3) = (e - r2*sin(theta2))/r3"),
    (
        "slider_crank",
        "loop_1_y_ddot",
        "r3 alpha3 cos θ3 - r3 omega3^2 sin θ3 = r2 omega2^2 sin θ2",
    ),  # alpha2 is 0
    ("slider_extras", "loop_1_x", "r4*cos(theta4) - r3*cos(theta3) = r2*cos(theta2)"),
    ("slider_extras", "loop_2_x", "r4*cos(theta4 - theta5) - r5 = r6*cos(theta5)"),
    ("quick_return", "loop_2_y", "h = r1 sin θ1 + r4 sin θ4 + r5 sin θ5"),
    ("quick_return", "loop_1_x", "r2 cos(θ2 - θ1) + r3 cos(θ3 - θ1) = r1 + r4 cos(θ4 - θ1)"),
    ("quick_return", "loop_2_x_dot", "v_C = -r4*omega4*sin(theta4) - r5*omega5*sin(theta5)"),
    ("quick_return_offset", "loop_1_y", "r2 sin(theta2) = e - r3 sin(theta3)"),
    ("quick_return_whitworth", "loop_1_x", "r1*cos(pi/2) + r2*cos(theta2) = rA*cos(theta4)"),
    ("quick_return_shaper", "loop_2_y", "0 = r4 sin θ4 + r5 sin θ5 - h"),
    ("havens_planetary", "loop_1_x", "d + (r2 + r3)*cos(theta1) = rA*cos(theta4)"),
    ("havens_planetary", "loop_1_y", "d*sin(theta4) = (r2 + r3)*sin(theta1 - theta4)"),
    ("two_loop_linkage", "loop_2_x", "xC + r5*cos(beta + theta4) - xF = r7*cos(theta7) - r6*cos(theta6)"),
    ("two_loop_linkage", "loop_2_y", "yF + r7 sin θ7 - r6 sin θ6 - yC = r5 (sin θ4 cos β + cos θ4 sin β)"),
    ("slotted_mechanism", "loop_1_x", "R2 x cos(Theta2) == RA x cos(Θ4)"),
    ("slotted_mechanism", "loop_1_x_dot", "ṙA cos θ4 - rA θ̇4 sin θ4 = -r2 θ̇2 sin θ2"),
    ("slotted_mechanism", "loop_1_x", "r1*cos(90)+r2*cos(theta2)-rA*cos(theta4)=0"),
    ("slotted_mechanism", "loop_1_y", "r1*sin(90) + r2*cos(theta2 - 90) - rA*sin(theta4) = 0"),
    ("slotted_mechanism", "loop_1_complex", "r1*e^(i*90) + r2*e^(i*theta2) = rA*e^(i*theta4)"),
    ("slotted_mechanism", "loop_1_complex", "r1*exp(90i) + r2*e^(i*(theta2 + 360)) = rA*e^(iθ4 - 360i)"),
    ("four_bar_motion", "loop_1_x", "r2*cos(theta2) + r3*cos(theta3) - r4*cos(theta4) + r1*cos(180) = 0"),
    ("slider_crank", "loop_1_y", "r2 sin θ2 + r3 sin θ3 - e sin(90) = 0"),
    ("three_loop_shaper", "loop_3_y", "d3 = yD + r5 sin θ5 + r7 sin θ7"),
    ("three_loop_shaper", "loop_2_complex", "r2 e^(iθ2) + r6 e^(i(θ3 + β)) = xD + i yD + d5 e^(iθ5)"),
]


@each_row(("name", "part", "text"), RIGHT)
def test_any_correct_form_is_right(name, part, text):
    assert verdict(name, part, text) == "correct"


@pytest.mark.parametrize("name", sampled(WITH_LOOPS, ["slotted_mechanism", "four_bar_positions"]))
def test_the_two_projections_may_be_exchanged_turned_and_complex(name):
    report = CheckReport(name)
    check_loops(asking_all(name), report)
    assert report.failures == []
    assert report.counts["loops explained"] > 30


@every_exercise
@seeds(3, 20)
def test_the_equations_of_the_loops_hold_for_the_answers_of_twenty_variants(name, seeds):
    exercise = COURSE[name]
    for variant in exercise.variants(seeds, "en", ("all",)):
        for part in exercise.spec.parts:
            assert not part.loop or equation_holds(variant, part), part.id


def test_a_complex_equation_is_right_for_a_projection_and_holds_both():
    closed = "r2 e^(iθ2) + r3 e^(iθ3) = r1 + r4 e^(iθ4)"
    sine = "r2 sin θ2 + r3 sin θ3 = r4 sin θ4"
    assert verdicts("four_bar_positions", loop_1_x=closed, loop_1_y=sine) == ("correct", "correct")
    assert verdicts("four_bar_positions", loop_1_complex=sine) == ("slip:one_projection",)


def test_two_answers_about_a_loop_say_different_things():
    cosine = "r2 cos θ2 + r3 cos θ3 = r1 + r4 cos θ4"
    again = "2 r1 - 2 r2 cos θ2 = 2 r3 cos θ3 - 2 r4 cos θ4"
    sine = "r2 sin θ2 + r3 sin θ3 = r4 sin θ4"
    name = "four_bar_positions"
    assert verdicts(name, loop_1_x=cosine, loop_1_y=again) == ("correct", "slip:repeated_equation")
    assert verdicts(name, loop_1_x=sine, loop_1_y=cosine) == ("correct", "correct")
    on_the_coupler = "r2*cos(theta2 - theta3) + r3 = r1*cos(theta3) + r4*cos(theta4 - theta3)"
    assert verdicts(name, loop_1_x=on_the_coupler, loop_1_y=sine) == ("correct", "correct")


# ------------------------------------------------------------------- what is not right


#: A right equation under a function: it holds where the equation does, and is not the equation.
WRAPPED = tuple(
    way.format("(r2 sin(θ2) + r3 sin(θ3) - r4 sin(θ4))", "(r2 sin(θ2) + r3 sin(θ3))", "(r4 sin(θ4))")
    for way in (
        "atan({0}) = 0",
        "exp({0}) = 1",
        "exp({1}) = exp({2})",
        "sin({0}/r1) = 0",
        "tan({0}) = 0",
        "1 + {0} = exp({0})*(1 - {0})",
        "atan({1}) = atan({2})",
        "(1 + {0})^3 = 1",
        "2^{0} = 1",
        "ln(1 + {0}/r2) = 0",
        "e^(i*{0}) = 1",
        "r1*exp({0}) = r1",
    )
)


@pytest.mark.parametrize(
    ("name", "part", "text", "told"),
    [
        ("four_bar_positions", "loop_1_x", "r1 = r1", "slip:says_nothing"),
        ("four_bar_positions", "loop_1_x", "cos(theta2)^2 + sin(theta2)^2 = 1", "slip:says_nothing"),
        ("four_bar_positions", "loop_1_y", "(r2 sin θ2 + r3 sin θ3 - r4 sin θ4)^2 = 0", "slip:squared"),
        ("four_bar_positions", "loop_1_y", "atan(r2 sin θ2 + r3 sin θ3 - r4 sin θ4) = 0", "slip:wrapped"),
        (
            "four_bar_positions",
            "loop_1_y",
            "r2 sin(180/pi*θ2) + r3 sin(180θ3/pi) = r4 sin(180 θ4/pi)",
            "slip:angle_unit",
        ),
        ("four_bar_motion", "loop_1_y_dot", "r2 sin θ2 + r3 sin θ3 = r4 sin θ4", "slip:not_derived"),
        (
            "slider_extras",
            "loop_2_x",
            "r2*cos(theta2) + r3*cos(theta3) = r6 + r5*cos(theta5)",
            "slip:other_loop",
        ),
        (
            "four_bar_positions",
            "loop_1_x",
            "r2*cos(theta2) + r3*cos(theta3) = r4*cos(theta4)",
            "slip:link_missing",
        ),
        ("four_bar_positions", "loop_1_x", "r2 cos θ2 - r3 cos θ3 = r1 + r4 cos θ4", "slip:link_sign"),
        ("four_bar_positions", "loop_1_x", "r2 cos θ2 + r3 sin θ3 = r1 + r4 cos θ4", "slip:link_axis"),
        ("four_bar_positions", "loop_1_x", "r2 cos θ2 + r3 cos θ2 = r1 + r4 cos θ4", "slip:link_angle"),
        (
            "four_bar_positions",
            "loop_1_x",
            "r2 cos(θ2 - θ3) - r3 = r1 cos θ3 + r4 cos(θ4 - θ3)",
            "slip:link_sign",
        ),
        ("three_loop_shaper", "loop_3_x", "r5 cos θ5 + r7 cos θ7 = 0", "slip:frame_missing"),
        (
            "four_bar_motion",
            "loop_1_x_ddot",
            "r2 alpha2 sin θ2 + r3 omega3^2 cos θ3 + r3 alpha3 sin θ3 = r4 omega4^2 cos θ4 + r4 alpha4 "
            "sin θ4",
            "slip:link_term",
        ),
        (
            "slotted_mechanism",
            "loop_1_complex_ddot",
            "r2*(i*alpha2 - omega2^2)*e^(i*theta2) = (rA_ddot - rA*omega4^2 + i*(rA*alpha4 + "
            "rA_dot*omega4))*e^(i*theta4)",
            "slip:link_term",
        ),
        ("four_bar_positions", "loop_1_x", "r2 + r3 = r1 + r4", "wrong"),
        ("four_bar_positions", "loop_1_x", "rA = 3", "unreadable"),
    ],
)
def test_what_is_missed_is_told(name, part, text, told):
    assert verdict(name, part, text) == told


def test_an_equation_under_a_function_is_not_the_equation():
    paid = [text for text in WRAPPED if verdict("four_bar_positions", "loop_1_y", text) == "correct"]
    assert paid == []


@each_row(
    "text",
    [
        "exp(exp(r1)) = exp(exp(r2))",
        "exp(r1^3)*(r2 sin θ2 + r3 sin θ3 - r4 sin θ4) = 0",
        "1e300*r1^60 = 1",
        "ln(-r1) = 0",
        "(r2 sin θ2 + r3 sin θ3)/0 = r4",
        "r2 sin θ2 + r3 sin θ3 = 1.000001 r4 sin θ4",
    ],
)
def test_what_overflows_or_has_no_value_is_wrong_and_stops_nothing(text):
    assert verdict("four_bar_positions", "loop_1_y", text) == "wrong"


@each_row("factor", ["1e-200", "1e200", "(2 + sin(theta3))", "r1*r2^3", "(1 + 2i)"])
def test_a_factor_that_does_not_vanish_changes_nothing(factor):
    text = f"{factor}*(r2 sin θ2 + r3 sin θ3 - r4 sin θ4) = 0"
    assert verdict("four_bar_positions", "loop_1_y", text) == "correct"


@pytest.mark.parametrize("step", [45, pytest.param(15, marks=pytest.mark.slow)])
def test_a_constant_angle_in_degrees_is_right_only_where_it_is_the_direction(step):
    """Every multiple of 15 degrees, in every place and both signs, against the direction that it gives."""
    vertical = {"cos": 0.0, "sin": 1.0}
    for function, right in vertical.items():
        part = "loop_1_x" if function == "cos" else "loop_1_y"
        for written, trig in (("cos", math.cos), ("sin", math.sin)):
            for degrees in range(-360, 361, step):
                text = f"r1*{written}({degrees}) + r2*{function}(theta2) - rA*{function}(theta4) = 0"
                is_right = abs(trig(math.radians(degrees)) - right) < 1e-9
                assert (verdict("slotted_mechanism", part, text) == "correct") == is_right, text
    for degrees in range(-360, 361, step):
        text = f"r1*e^(i*({degrees})) + r2*e^(i*theta2) = rA*e^(i*theta4)"
        assert (verdict("slotted_mechanism", "loop_1_complex", text) == "correct") == (
            degrees in (90, -270)
        ), text


@each_row(
    ("part", "text", "slip"),
    [
        ("loop_1_x", "r1*cos(90) + r2*cos(theta2) + rA*cos(theta4) = 0", "slip:link_sign"),
        ("loop_1_y", "r1*sin(-90) + r2*sin(theta2) - rA*sin(theta4) = 0", "slip:link_sign"),
        ("loop_1_x", "r1*cos(0) + r2*cos(theta2) - rA*cos(theta4) = 0", "slip:link_axis"),
        ("loop_1_x", "r1*cos(pi/2 + 1) + r2*cos(theta2) - rA*cos(theta4) = 0", "wrong"),
    ],
)
def test_what_is_wrong_beside_a_constant_angle_in_degrees_is_told(part, text, slip):
    assert verdict("slotted_mechanism", part, text) == slip


def test_numbers_in_place_of_symbols_are_told():
    variant = asking_all("four_bar_positions")
    r1, r2 = (f"{variant.given[n]:g}" for n in ("r1", "r2"))
    text = f"{r2}*cos(theta2) + r3*cos(theta3) = {r1} + r4*cos(theta4)"
    assert verdict("four_bar_positions", "loop_1_x", text) == "slip:numbers"
    assert (
        verdict("four_bar_positions", "loop_1_x", text.replace(r1, f"{variant.given['r1'] + 1:g}")) == "wrong"
    )


@each_row(
    ("text", "slip"),
    [
        ("theta4 = arccos(r2*cos(theta2)/rA)", "slip:some_positions"),
        ("theta4 = 180 - arcsin((r1 + r2*sin(theta2))/rA)", "wrong"),  # the wrong unit as well
        ("theta4 = pi - arcsin((r1 + r2*sin(theta2))/rA)", "slip:some_positions"),
        ("theta4 = pi - arcsin(({r1} + r2*sin(theta2))/rA)", "slip:numbers"),
        ("theta4 = arccos({r2}*cos(theta2)/rA)", "slip:numbers"),
        ("theta4 = arccos(-r2*cos(theta2)/rA)", "wrong"),
    ],
)
def test_an_equation_that_loses_a_quadrant_is_told_so_and_not_blamed_for_numbers(text, slip):
    variant = COURSE["slotted_mechanism"].variant(0, "en", ("all",))
    mark = variant.grade({"loop_1_x": text.format(**variant.given)})["loop_1_x"]
    assert mark.verdict == slip
    assert ("only for some positions" in mark.feedback) == (slip == "slip:some_positions")


@few_loops
@pytest.mark.parametrize("lang", sampled(["fr", "en"], ["fr"]))
def test_a_wrong_sign_and_a_forgotten_link_are_told_by_the_symbol_of_every_link(name, loop, lang):
    """The wrong equations are put together here from the vectors, on an axis turned by 20°."""
    exercise, variant = COURSE[name], asking_all(name, lang)
    links = exercise.solution.loops[loop].links
    part, symbols = f"{loop}_y", exercise.solution.symbols
    right = [_turned(link.vector) for link in links]
    for k, link in enumerate(links):
        fixed = isinstance(link.vector.length, str) and exercise.spec.given.get(str(link.vector.angle))
        left = [other.name for j, other in enumerate(links) if j != k]
        # Two bars of given lengths alone close nowhere: who leaves the third link out has no mechanism to be
        # right on.
        closes = len(left) > 2 or not set(left) <= set(exercise.spec.given)
        for terms, kind in (
            ([f"-({t})" if j == k else t for j, t in enumerate(right)], "link_sign"),
            ([t for j, t in enumerate(right) if j != k], "link_missing"),
        ):
            mark = variant.grade({part: " + ".join(f"({t})" for t in terms) + " = 0"})[part]
            if kind == "link_missing" and not closes:
                assert mark.verdict in ("wrong", "slip:link_missing")
                continue
            assert f"slip:{kind}" in mark.matches, (terms, mark.verdict)
            symbol = symbols.get(link.name) or exercise.spec.symbol(link.name)
            assert symbol in mark.says or mark.mistakes, (mark.says, fixed)


def _turned(v):
    angle = v.angle if isinstance(v.angle, str) else f"{math.degrees(v.angle):g}°"
    turn = f" + {v.turn}" if isinstance(v.turn, str) else ""
    return f"{'-' if v.sign < 0 else ''}{v.length}*cos({angle}{turn} - 20°)"


@every_loop
@pytest.mark.parametrize("tries", sampled([10, 150], [10]))
def test_no_equation_with_other_coefficients_is_right(name, loop, tries):
    """Thousands of sums of the right terms with wrong factors, in random combinations of both projections."""
    rng = np.random.default_rng(5)
    exercise = COURSE[name]
    part = exercise.spec.part(f"{loop}_x")
    judge = judge_of(exercise, part)
    links = exercise.solution.loops[loop].links
    for _ in range(tries):
        factors = rng.choice([-2, -1, -0.5, 0, 0.5, 1, 2], len(links))
        if len(set(factors)) == 1:
            continue
        terms = [f"({f})*({_turned(link.vector)})" for f, link in zip(factors, links, strict=True)]
        finding = judge.finding(parse_equation(" + ".join(terms) + " = 0", part.variables))
        assert finding.rank == 0, terms
        # A function of other symbols, or a constant, added to a right equation.
        right = " + ".join(_turned(link.vector) for link in links)
        odd = f"{right} + {rng.uniform(0.01, 5):.4f}*{rng.choice(part.variables)} = 0"
        assert judge.finding(parse_equation(odd, part.variables)).rank == 0, odd


# ------------------------------------------------------------------- parts by request


@every_exercise
def test_the_usual_sheet_asks_no_part_by_request(name):
    exercise = COURSE[name]
    usual = exercise.variant(3)
    assert usual.part_ids == tuple(p.id for p in usual.parts if not p.by_request)
    everything = exercise.variant(3, parts=("all",))
    asked = {p.id for p in exercise.spec.parts if p.loop}
    assert asked
    assert asked <= set(everything.part_ids)
    assert exercise.variant(3, parts=("usual", "loop_1_complex")).part_ids == tuple(
        p for p in everything.part_ids if p in usual.part_ids or p == "loop_1_complex"
    )


def test_a_record_keeps_the_parts_that_were_named_and_is_marked_by_them():
    variant = COURSE["slotted_mechanism"].variant(4, "en", ("loop_1_y", "theta4"))
    assert variant.part_ids == ("theta4", "loop_1_y")
    again = COURSE["slotted_mechanism"].from_record(variant.record)
    assert again.part_ids == variant.part_ids
    assert again.in_language("fr").part_ids == variant.part_ids
    marking = again.grade({"loop_1_y": "rA sin θ4 = r1 + r2 sin θ2"})
    assert (marking["loop_1_y"].verdict, marking.out_of) == ("correct", 2)
    with pytest.raises(UnknownName, match="rA"):
        again.grade({"rA": "3 mm"})


def test_an_unknown_part_is_told_with_the_nearest():
    with pytest.raises(UnknownName, match=r"loop_1_z.*loop_1_[xy]"):
        COURSE["slotted_mechanism"].variant(4, parts=("loop_1_z",))


def test_a_build_asks_of_each_exercise_the_named_parts_that_it_has():
    issues = issue(
        COURSE,
        ("slotted_mechanism", "four_bar_motion"),
        first_seed=0,
        count=2,
        langs=("en",),
        parts=("theta4", "omega3", "rA"),
    )
    assert [i.variant.part_ids for i in issues] == [("rA", "theta4")] * 2 + [("theta4", "omega3")] * 2
    with pytest.raises(coursework.errors.BadInput, match="four_bar_motion has none"):
        issue(
            COURSE,
            ("slotted_mechanism", "four_bar_motion"),
            first_seed=0,
            count=1,
            langs=("en",),
            parts=("rA",),
        )


def test_variants_that_ask_none_of_the_named_parts_are_passed_over():
    issues = issue(COURSE, ("slotted_mechanism",), first_seed=0, count=6, langs=("en",), parts=("swing",))
    assert all(i.variant.part_ids == ("swing",) for i in issues)


@every_exercise
def test_sheets_say_in_which_symbols_once_for_each_set(name):
    for lang in ("fr", "en"):
        handout = COURSE[name].variant(2, lang, ("all",)).handout()
        prompts = [q.prompt for q in handout.questions if q.kind == "equation"]
        assert all("{" not in p.replace(r"\overrightarrow{", "") or "$" in p for p in prompts)
        assert sum("cos(theta2)" in p for p in prompts) == 1


# ------------------------------------------------------------------- statement of loops


def test_equations_of_a_loop_are_printed_in_its_own_order():
    loop = Loop.of(
        (
            Vector("r5", "theta4", turn="beta"),
            Vector("d5", "theta5", -1),
            Vector("yC", math.pi / 2, -1),
            Vector(2.5, math.pi),
        ),
        {"theta4": ("omega4", "alpha4"), "d5": ("d5_dot", "")},
    )
    assert loop.equation("x") == "r5*cos(theta4 + beta) = d5*cos(theta5) + 2.5"
    assert loop.equation("y") == "r5*sin(theta4 + beta) = d5*sin(theta5) + yC"
    assert loop.equation("complex") == "r5*e^(i*(theta4 + beta)) = d5*e^(i*theta5) + yC*i + 2.5"
    assert loop.equation("x", 1) == "0 = r5*omega4*sin(theta4 + beta) + d5_dot*cos(theta5)"


@every_loop
def test_derived_equations_are_the_derivatives_of_the_position_equations(name, loop):
    """Against a difference in time along an arbitrary motion of all symbols, whether the loop closes or
    not."""
    found = COURSE[name].solution.loops[loop]
    rng = np.random.default_rng(3)
    names = found.names
    motion = {n: rng.uniform(0.5, 2, 3) for n in names}  # value, first and second derivative
    for n in names:
        motion[n][1:] *= [bool(found.rates.get(n, ("", ""))[0]), bool(found.rates.get(n, ("", ""))[1])]
    symbols = set(names) | {r for pair in found.rates.values() for r in pair if r}

    def at(t):
        values = {}
        for n, (p, v, a) in motion.items():
            values[n] = p + v * t + a * t * t / 2
            for r, value in zip(found.rates.get(n, ()), (v + a * t, a), strict=False):
                values |= {r: value} if r else {}
        return values

    for order in range(found.known):
        for form in ("x", "y", "complex"):
            lower, upper = (parse_equation(found.equation(form, o), symbols) for o in (order, order + 1))
            step = 1e-5
            slope = (lower.difference(at(step)) - lower.difference(at(-step))) / (2 * step)
            # A difference of sides keeps no sign of its own: terms change sides.
            assert slope == pytest.approx(upper.difference(at(0)), abs=1e-6)


def test_a_loop_that_names_no_quantity_is_refused_with_the_nearest():
    with pytest.raises(BadCourse, match=r"rB.*rA"):
        stated("solutions/x.py", {"loop_1": (Vector("rB", "theta2"),)}, {}, {"rA"}, {"theta2"})
    with pytest.raises(BadCourse, match="sequence of Vector"):
        stated("solutions/x.py", {"loop_1": ("r2", "theta2")}, {}, {"r2"}, {"theta2"})


def test_a_loop_is_derived_as_far_as_its_rates_are_known():
    vectors = {"a": (Vector("r2", "theta2"), Vector("r3", "theta3"))}
    given = {"r2", "r3", "theta2", "omega2"}
    assert stated("s", vectors, {}, {"theta3"}, given)["a"].known == 0
    assert stated("s", vectors, {}, {"theta3", "omega3"}, given)["a"].known == 1
    assert stated("s", vectors, {}, {"theta3", "omega3", "alpha3"}, given)["a"].known == 2


def test_a_part_of_a_loop_bears_its_name():
    with pytest.raises(BadCourse, match="loop_1_x, loop_1_y or loop_1_complex"):
        Part("closing", kind="equation", variables=("r2",), loop="loop_1")
    parts = loop_equations("a", ("r2", "theta2"), rates=("omega2",), usual=("x", "y_dot"))
    assert [(p.id, p.by_request) for p in parts] == [
        ("a_x", False),
        ("a_y", True),
        ("a_complex", True),
        ("a_x_dot", True),
        ("a_y_dot", False),
        ("a_complex_dot", True),
    ]


def test_a_chain_takes_an_added_angle_by_name():
    """The plate of the linkage of two loops: its side CD lies at theta4 + beta."""
    loop = COURSE["two_loop_linkage"].solution.loops["loop_2"]
    vectors = [link.vector for link in loop.links]
    chain = ClosedChain([vectors], ("theta6", "theta7"))
    exercise = COURSE["two_loop_linkage"]
    variant = exercise.variant(3)
    found = exercise.solve(**variant.given, only=("theta4", "theta6", "theta7"))
    known = {n: variant.given[n] for n in ("xC", "yC", "xF", "yF", "r5", "r6", "r7")}
    angles = {"beta": math.radians(variant.given["beta"]), "theta4": math.radians(found["theta4"])}
    start = {n: math.radians(found[n]) + 0.05 for n in ("theta6", "theta7")}
    pose = chain.solve({**known, **angles}, start)
    for n in ("theta6", "theta7"):
        assert math.degrees(pose.values[n]) == pytest.approx(found[n], abs=1e-9)
    with pytest.raises(WrongValue, match="cannot be unknown"):
        ClosedChain([vectors], ("beta", "theta7"))
