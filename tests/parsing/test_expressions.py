"""Formulas and equations are read as people write them, within limits, and compared by value."""

import contextlib
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tables import each_row

from coursework.kinds.equation_latex import latex_of_equation
from coursework.parsing.equations import parse_equation
from coursework.parsing.equivalence import same_equation
from coursework.parsing.expressions import parse_expression
from coursework.parsing.vocabulary import Unreadable

NAMES = (
    "r1",
    "r2",
    "r3",
    "r4",
    "theta2",
    "theta3",
    "theta4",
    "theta3_open",
    "psi_dot",
    "r1_dot",
    "r6_ddot",
    "R",
    "r",
    "omega2",
    "alpha2",
)

NUMBERS = [
    ("2π/3", 2 * math.pi / 3),
    ("2*pi/3", 2 * math.pi / 3),
    ("0,58 π", 0.58 * math.pi),
    ("sqrt(2)/2", math.sqrt(0.5)),
    ("√2/2", math.sqrt(0.5)),
    ("\\frac{\\sqrt{2}}{2}", math.sqrt(0.5)),
    ("1/3", 1 / 3),
    ("3×10^-2", 0.03),
    ("3·10⁻²", 0.03),
    ("-2^2", -4),
    ("(-2)^2", 4),
    ("2^-1", 0.5),
    ("2^3^2", 512),
    ("2**3", 8),
    ("7 - 2 - 3", 2),
    ("8/4/2", 1),
    ("1 234,5*2", 2469),
    ("sin(0.3)", math.sin(0.3)),
    ("sin(30°)", 0.5),
    ("sin 30°", 0.5),
    ("sin(30 deg)", 0.5),
    ("30° + 15°", math.pi / 4),
    ("cos²(1)+sin^2(1)", 1),
    ("arctan(1)", math.pi / 4),
    ("atan2(1, -1)", 3 * math.pi / 4),
    ("atan2(1,5; 2,5)", math.atan2(1.5, 2.5)),
    ("2(3+4)", 14),
    ("(1+2)(3+4)", 21),
    ("2 x 3", 6),
    ("exp(1)", math.e),
    ("e^2", math.e**2),
    ("ln(e)", 1),
    ("abs(-3)", 3),
    ("−5 + –2", -7),
    ("6 ÷ 4", 1.5),
]


@each_row(("text", "value"), NUMBERS)
def test_a_formula_has_its_value(text, value):
    assert parse_expression(text).evaluate() == pytest.approx(value, rel=1e-14)


@each_row(
    ("spelling", "name"),
    [(s, "theta2") for s in ("theta2", "θ2", "θ_2", "theta_2", "θ₂", "\\theta_2", "\\theta_{2}", "ϑ2")]
    + [(s, "psi_dot") for s in ("psi_dot", "psidot", "ψ̇", "\\dot\\psi", "\\dot{\\psi}", "ψ_dot")]
    + [(s, "r1_dot") for s in ("r1_dot", "ṙ1", "ṙ_1", "\\dot{r}_1", "\\dot r_1", "r1dot", "\\dot{r_1}")]
    + [(s, "r6_ddot") for s in ("r6_ddot", "r̈6", "\\ddot r_{6}")]
    + [(s, "theta3_open") for s in ("theta3_open", "θ3_open", "θ_{3_open}")]
    + [
        ("R", "R"),
        ("r", "r"),
        ("R2", "r2"),
        ("R_2", "r2"),
        ("Theta2", "theta2"),
        ("THETA_2", "theta2"),
        ("Θ2", "theta2"),
    ]
    + [
        (s, "omega2")
        for s in ("theta2_dot", "θ̇2", "θ̇_2", "\\dot\\theta_2", "\\dot{\\theta}_{2}", "θ2'", "ω2", "Omega2")
    ]
    + [(s, "alpha2") for s in ("theta2_ddot", "θ̈2", "\\ddot\\theta_2", "θ2''", "α_2")],
)
def test_a_symbol_is_known_by_every_spelling(spelling, name):
    assert parse_expression(spelling, NAMES).variables == {name}


@each_row(
    ("text", "meaning"),
    [
        ("r2cosθ2", lambda v: v["r2"] * np.cos(v["theta2"])),
        ("2 pi r1", lambda v: 2 * np.pi * v["r1"]),
        ("2πr1", lambda v: 2 * np.pi * v["r1"]),
        ("r2 cos 2θ2", lambda v: v["r2"] * np.cos(2 * v["theta2"])),
        ("cos2θ2", lambda v: np.cos(2 * v["theta2"])),
        ("sin θ2 cos θ3", lambda v: np.sin(v["theta2"]) * np.cos(v["theta3"])),
        (
            "r2 sin(θ2−θ4)/(r3 sin(θ4−θ3))",
            lambda v: (
                v["r2"] * np.sin(v["theta2"] - v["theta4"]) / (v["r3"] * np.sin(v["theta4"] - v["theta3"]))
            ),
        ),
        ("r2 e^(i theta2)", lambda v: v["r2"] * np.exp(1j * v["theta2"])),
        ("r_2 e^{i\\theta_2}", lambda v: v["r2"] * np.exp(1j * v["theta2"])),
        ("\\frac{R}{2 r} \\dot\\psi", lambda v: v["R"] / (2 * v["r"]) * v["psi_dot"]),
        ("Rsin(theta2)", lambda v: v["R"] * np.sin(v["theta2"])),
        ("r1²+2r1 r2", lambda v: v["r1"] ** 2 + 2 * v["r1"] * v["r2"]),
    ],
)
def test_side_by_side_means_times(text, meaning):
    values = {name: np.linspace(0.4 + k / 7, 2.0 + k / 10, 5) for k, name in enumerate(NAMES)}
    np.testing.assert_allclose(parse_expression(text, NAMES).evaluate(values), meaning(values), rtol=1e-13)


def test_capitals_tell_names_apart_where_both_are_known_and_letters_always():
    names = ("R", "r", "r2", "R2", "xC")
    assert [parse_expression(s, names).variables for s in ("R2", "r2", "R", "r", "XC")] == [
        {"R2"},
        {"r2"},
        {"R"},
        {"r"},
        {"xC"},
    ]
    for text, known in (
        ("R", ("r",)),
        ("rb", ("rA",)),
        ("theta3_dot", ("omega2", "theta3")),
        ("theta2_dot", ("theta2",)),
    ):
        with pytest.raises(Unreadable):
            parse_expression(text, known)


def test_an_x_between_spaces_is_times_unless_it_is_a_symbol():
    assert parse_expression("r2 x cos(theta2) x 2", NAMES).variables == {"r2", "theta2"}
    assert parse_expression("2 x sqrt(4)").evaluate() == 4
    assert "x" in parse_expression("r2 x cos(theta2)", (*NAMES, "x")).variables
    with pytest.raises(Unreadable):
        parse_expression("r2 x", NAMES)


def test_a_variable_called_e_leaves_euler_under_an_imaginary_exponent():
    expression = parse_expression("e + e^(i theta2)", ("e", "theta2"))
    assert expression.evaluate({"e": 10.0, "theta2": 0.0}) == pytest.approx(11)


def test_a_quotient_before_a_tight_product_has_two_readings():
    expression = parse_expression("1/2π")
    assert (expression.evaluate(), expression.other.evaluate()) == pytest.approx(
        (math.pi / 2, 1 / (2 * math.pi))
    )
    assert parse_expression("2π/3").other is None


@each_row(
    ("text", "code"),
    [
        ("9**9**9", "too_complex"),
        ("9^9^9^9", "too_complex"),
        ("2^65", "too_complex"),
        ("2^(10*10)", "too_complex"),
        ("(" * 400 + "1" + ")" * 50, "too_complex"),
        ("√" * 400 + "2", "too_complex"),
        ("2^" * 200 + "1", "too_complex"),
        ("1+" * 300 + "1", "too_long"),
        ("x" * 10_000, "too_long"),
        ("180° - 75", "mixed_units"),
        ("__import__('os')", "not_a_number"),
        ("().__class__", "not_a_number"),
        ("lambda: 1", "unknown_symbol"),
        ("theta2", "unknown_symbol"),
        ("open(1)", "unknown_symbol"),
        ("i", "unknown_symbol"),
        ("2 3", "not_a_number"),
        ("1.2.3", "not_a_number"),
        ("(1", "not_a_number"),
        ("1)", "not_a_number"),
        ("2*", "not_a_number"),
        ("*2", "not_a_number"),
        ("", "not_a_number"),
        ("5!", "not_a_number"),
        ("cos^-2(0.5)", "not_a_number"),
        ("atan2(1)", "not_a_number"),
        ("½", "not_a_number"),
    ],
)
def test_what_is_no_formula_is_unreadable_with_its_reason(text, code):
    with pytest.raises(Unreadable) as error:
        parse_expression(text)
    assert error.value.code == code
    assert len(error.value.found) <= 60
    assert len(str(error.value)) < 300


@each_row("text", ["1/0", "sqrt(-1)", "acos(2)", "10^64*10^64*10^64*10^64*10^64", "ln(0)"])
def test_a_value_that_is_not_finite_is_unreadable(text):
    with pytest.raises(Unreadable) as error:
        parse_expression(text).evaluate()
    assert error.value.code == "not_finite"


@given(st.text(max_size=80) | st.text("0123456789.,+-*/^()πe sincot√°r2θ=[]{}\\_", max_size=60))
@settings(max_examples=300, deadline=None)
def test_any_text_is_read_or_unreadable_and_nothing_else(text):
    with contextlib.suppress(Unreadable):
        assert np.isfinite(parse_expression(text, NAMES).evaluate(dict.fromkeys(NAMES, 1.5)))


LOOP = "r2*cos(theta2) + r3*cos(theta3) = r1 + r4*cos(theta4)"


@each_row(
    "text",
    [
        "r1 + r4 cos θ4 = r2 cos θ2 + r3 cos θ3",
        "r2cosθ2 + r3cosθ3 - r1 - r4cosθ4 = 0",
        "0 = 2r1 + 2r4 cosθ4 - 2r2 cosθ2 - 2r3 cosθ3",
        "-r2 cosθ2 = r3 cosθ3 - r1 - r4 cosθ4",
        "r2 sin(π/2 - θ2) + r3 cos(-θ3) = r1 + r4 (2cos²(θ4/2) - 1)",
        "r_2\\cos\\theta_2 + r_3\\cos\\theta_3 = r_1 + r_4\\cos\\theta_4",
        "$r_2\\cos(\\theta_2) + r_3\\cos(\\theta_3) = r_1 + r_4\\cos(\\theta_4)$",
    ],
)
def test_an_equation_is_known_however_it_is_arranged(text):
    assert same_equation(parse_equation(text, NAMES), parse_equation(LOOP, NAMES))


@each_row(
    "text",
    [
        "r2 cosθ2 + r3 cosθ3 = r1 - r4 cosθ4",
        "r2 sinθ2 + r3 sinθ3 = r4 sinθ4",
        "r2 cosθ2 + r3 cosθ3 = r4 cosθ4",
        "r2 cosθ2 + r3 cosθ3 = r1 + r4 cosθ4 + 0.000001",
        "r1 (r2 cosθ2 + r3 cosθ3) = r1 (r1 + r4 cosθ4)",
        "0 = 0",
        "r1 = r1",
        "1 = 2",
        "0 (r2 cosθ2 + r3 cosθ3) = 0 (r1 + r4 cosθ4)",
        "sqrt(-1-r1) = r1",
    ],
)
def test_another_equation_is_told_apart(text):
    reference = parse_equation(LOOP, NAMES)
    assert not same_equation(parse_equation(text, NAMES), reference)
    assert not same_equation(reference, parse_equation(text, NAMES))


def test_complex_equations_compare_up_to_a_complex_factor():
    reference = parse_equation("r2 e^(i theta2) + i r1 = r4 e^(i theta4)", NAMES)
    assert same_equation(parse_equation("i r2 e^(iθ2) - r1 = i r4 e^(iθ4)", NAMES), reference)
    assert not same_equation(parse_equation("r2 e^(iθ2) - i r1 = r4 e^(iθ4)", NAMES), reference)


def test_the_angle_of_complex_coordinates_is_no_solution_of_anything():
    names = ("x", "y")
    text = "atan2(e^(i x); y) = y"
    assert not same_equation(parse_equation(text, names), parse_equation("x = y", names))


def test_a_domain_that_fails_at_some_points_does_not_hide_the_others():
    a = parse_equation("sqrt(r1 - 1) = r2", NAMES)
    assert same_equation(a, parse_equation("3 sqrt(r1 - 1) - 3 r2 = 0", NAMES))
    assert not same_equation(a, parse_equation("sqrt(r1 - 1) = 1.001 r2", NAMES))


@each_row(("text", "code"), [("r1", "no_equals_sign"), ("r1 = r2 = r3", "two_equals_signs")])
def test_an_equation_has_one_equals_sign(text, code):
    with pytest.raises(Unreadable) as error:
        parse_equation(text, NAMES)
    assert error.value.code == code


SYMBOLS = {
    "r1": "r_1",
    "r2": "r_2",
    "r3": "r_3",
    "r4": "r_4",
    "R": "R",
    "r": "r",
    "theta2": r"\theta_2",
    "theta3": r"\theta_3",
    "theta4": r"\theta_4",
    "psi_dot": r"\dot\psi",
}


@each_row(
    ("text", "latex"),
    [
        (LOOP, r"r_2\cos\theta_2 + r_3\cos\theta_3 = r_1 + r_4\cos\theta_4"),
        ("r2*e^(i*theta2) = r1", r"r_2 e^{i\theta_2} = r_1"),
        ("2*(R + r)*psi_dot = -R/(2*r)", r"2\left(R + r\right)\dot\psi = -\frac{R}{2 r}"),
        ("r1^2 - (r2 - r3) = 0.5*sqrt(r4)", r"r_1^{2} - \left(r_2 - r_3\right) = \num{0.5}\sqrt{r_4}"),
        ("sin(theta2 - theta4) = 2*3", r"\sin\left(\theta_2 - \theta_4\right) = 2\cdot 3"),
    ],
)
def test_a_reference_equation_is_written_with_its_symbols(text, latex):
    assert latex_of_equation(text, SYMBOLS) == latex


def test_the_latex_of_an_equation_reads_back_as_the_same_equation():
    for text in (LOOP, "2*(R + r)*psi_dot = -R/(2*r)", "r1^2 - (r2 - r3) = 0.5*sqrt(r4)"):
        again = parse_equation(latex_of_equation(text, SYMBOLS), NAMES)
        assert same_equation(again, parse_equation(text, NAMES))


ROCKER = "r4*sin(theta4) = r5*sin(theta5)"
LOOP_NAMES = ("r4", "r5", "theta4", "theta5")


@each_row(
    ("text", "same"),
    [
        ("sin(theta5) = r4/r5*sin(theta4)", True),
        ("r4^2*sin(theta4) - r4*r5*sin(theta5) = 0", True),
        ("sin(theta4)/r5 = sin(theta5)/r4", True),
        ("sin(theta5) = r5/r4*sin(theta4)", False),
        ("sin(theta5) = -r4/r5*sin(theta4)", False),
        ("r4*sin(theta4)*sin(theta5) = r5*sin(theta5)^2", False),
        ("r4*0 = 0", False),
        ("r4 = r5", False),
    ],
)
def test_a_factor_may_hold_lengths_where_they_are_declared(text, same):
    one, other = parse_equation(text, LOOP_NAMES), parse_equation(ROCKER, LOOP_NAMES)
    assert same_equation(one, other, parameters=("r4", "r5")) is same


def test_a_factor_holds_no_length_where_none_is_declared():
    one = parse_equation("r4^2*sin(theta4) = r4*r5*sin(theta5)", LOOP_NAMES)
    assert not same_equation(one, parse_equation(ROCKER, LOOP_NAMES))


#: An equation, another, and whether they have the same solutions wherever both are defined.
DIVIDED = [
    ("sin(theta4)/sin(theta5) = r5/r4", ROCKER, True),
    ("r5/r4 = sinθ4/sinθ5", ROCKER, True),
    ("r4 sinθ4/(r5 sinθ5) = 1", ROCKER, True),
    ("r4/sinθ5 = r5/sinθ4", ROCKER, True),
    ("r4 tanθ4 = r5 sinθ5/cosθ4", ROCKER, True),
    ("r4 sinθ4 (sinθ5)^-2 - r5/sinθ5 = 0", ROCKER, True),
    ("\\frac{\\sin\\theta_4}{\\sin\\theta_5} = \\frac{r_5}{r_4}", ROCKER, True),
    ("tanθ4 = x/y", "y sinθ4 = x cosθ4", True),
    ("y = x/tanθ4", "y tanθ4 = x", True),
    ("(r4 + x cosθ4)/cosθ5 = y", "r4 + x cosθ4 = y cosθ5", True),
    ("r4/(r5 cosθ4 + x cosθ5) = 1", "r4 = r5 cosθ4 + x cosθ5", True),
    ("sinθ4/sinθ5 = r4/r5", ROCKER, False),
    ("sinθ4/sinθ5 = -r5/r4", ROCKER, False),
    ("sinθ4/sinθ5 = r5/r4 + 0.000001", ROCKER, False),
    ("sinθ4^2/sinθ5^2 = r5^2/r4^2", ROCKER, False),
    ("sinθ4/sinθ5 = x", ROCKER, False),
    ("sinθ4 sinθ5/sinθ5 = 0", ROCKER, False),
    ("1/(r4 sinθ4 - r5 sinθ5) = 0", ROCKER, False),
    ("(r4 sinθ4 - r5 sinθ5) sinθ5^2/sinθ5 = 0", ROCKER, False),
    ("(r4 sinθ4 - r5 sinθ5) x/(x + 0) = 0", "x (r4 sinθ4 - r5 sinθ5) = 0", False),
    ("y = 0", "sinθ5 y = 0", False),
    ("sinθ5 y/sinθ5 = 0", "sinθ5 y = 0", False),
    ("(1 - cosθ5) y/(1 - cosθ5) = 0", "(1 - cosθ5) y = 0", False),
    ("y (1 - cosθ5)^2/(1 - cosθ5) = 0", "y = 0", False),
    ("x/tanθ5 = 0", "x sinθ5 = 0", False),
    ("x/tanθ5 = 0", "x = 0", False),
    ("x e^(i theta4)/x^2 = 1", "e^(i theta4) = x + 1", False),
    ("(e^(i theta4) - x)/y = 0", "e^(i theta4) = x", False),
    ("(x^2 + 1)/y = 0", "x^2 + 1 = 0", False),
]


@each_row(("text", "reference", "same"), DIVIDED)
def test_an_equation_may_be_divided_by_what_is_not_zero_with_it(text, reference, same):
    names = (*LOOP_NAMES, "x", "y")
    one, other = parse_equation(text, names), parse_equation(reference, names)
    assert same_equation(one, other, parameters=("r4", "r5")) is same
    assert same_equation(other, one, parameters=("r4", "r5")) is same


MAY_VANISH = ("sinθ5", "x", "(1 - cosθ4)", "(x - y)", "(r4 + x)", "(r4 sinθ4 - r5 sinθ5)")


@each_row("factor", MAY_VANISH)
@each_row("divisor", MAY_VANISH)
def test_a_factor_that_may_vanish_is_allowed_below_only(factor, divisor):
    names = (*LOOP_NAMES, "x", "y")
    reference = parse_equation(ROCKER, names)
    text = "r4 sinθ4 {0}/{1} = r5 sinθ5 {0}/{1}"
    multiplied = parse_equation(text.format(factor, divisor), names)
    divided = parse_equation(text.format("(1)", divisor), names)
    assert same_equation(multiplied, reference, parameters=("r4", "r5")) is (factor == divisor)
    assert same_equation(divided, reference, parameters=("r4", "r5")) is (divisor != MAY_VANISH[-1])


def solutions(equation, names, unknown, draws):
    """Points that solve an equation, by bisection in one variable, the others scattered."""
    rng = np.random.default_rng(5)
    for _ in range(draws):
        values = {name: rng.uniform(0.4, 2.8) for name in names}
        t = np.linspace(-3.1, 3.1, 200)
        gaps = equation.difference({**{n: np.full(t.size, v) for n, v in values.items()}, unknown: t})
        for k in np.nonzero(np.sign(gaps[:-1]) != np.sign(gaps[1:]))[0]:
            low, high = t[k], t[k + 1]
            for _ in range(60):
                middle = (low + high) / 2
                below = np.sign(at(equation, values, unknown, middle)) == np.sign(gaps[k])
                low, high = (middle, high) if below else (low, middle)
            if abs(at(equation, values, unknown, low)) < 1e-9:
                yield {**values, unknown: low}


def at(equation, values, unknown, value):
    """The difference of the sides at one point, infinite where a side is."""
    return equation.difference({**values, unknown: np.array([value])})[0]


@pytest.mark.parametrize("draws", [10, pytest.param(40, marks=pytest.mark.slow)])
@each_row(("text", "reference"), [(t, r) for t, r, same in DIVIDED if same])
def test_equations_said_to_be_the_same_hold_at_the_same_points(text, reference, draws):
    names = (*LOOP_NAMES, "x", "y")
    pair = parse_equation(text, names), parse_equation(reference, names)
    for one, other in (pair, pair[::-1]):
        found = list(solutions(one, names, "theta4", draws))
        assert len(found) > 5
        for values in found:
            assert abs(at(other, values, "theta4", values["theta4"])) < 1e-6
            assert abs(at(other, values, "theta4", values["theta4"] + 1e-3)) > 1e-8


@each_row(
    ("spelling", "name"),
    [
        (s, "phi_dot")
        for s in ("phi'", "φ'", "φ′", "φ’", "\\dot\\varphi", "\\dot{\\varphi}", "\\varphi'", "\\dot φ")
    ]
    + [(s, "r1_dot") for s in ("r1'", "r_1'", "r'_1", "r_1^\\prime", "r_1^{\\prime}")]
    + [(s, "r6_ddot") for s in ("r6''", "r_6″", 'r6"', "r_6^{\\prime\\prime}", "r_6^{''}")],
)
def test_a_prime_is_a_derivative(spelling, name):
    assert parse_expression(spelling, (*NAMES, "phi_dot")).variables == {name}


def test_primes_stand_anywhere_in_an_equation():
    names = ("R", "r", "phi_dot", "psi_dot", "omega")
    reference = parse_equation("(R + r)*phi_dot - r*omega = R*psi_dot", names)
    assert same_equation(parse_equation("(R+r)φ' = rω + Rψ'", names), reference)
    assert not same_equation(parse_equation("(R+r)φ' = rω - Rψ'", names), reference)


@each_row("text", ["r1''' + r1", "'", "phi'", "theta3'", "r1 '"])
def test_a_prime_without_its_derivative_among_the_names_is_unreadable(text):
    with pytest.raises(Unreadable):
        parse_expression(text, NAMES)


def test_an_apostrophe_still_separates_thousands():
    assert parse_expression("1'234.5 r1", NAMES).evaluate({"r1": 2.0}) == 2469


@each_row("text", [".E0", ".", ".e", "-.E+3"])
def test_an_exponent_without_digits_before_it_is_no_number(text):
    with pytest.raises(Unreadable):
        parse_expression(text)
