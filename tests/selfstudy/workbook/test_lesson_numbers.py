"""The numbers that the lessons on motion quote, and the polygons that they draw, are those of the
solutions."""

from __future__ import annotations

import math
import re
from itertools import pairwise

import numpy as np
import pytest
from tables import each_row

from coursework.course.lessons import lesson_file
from coursework.language.words import languages

BARS = {"r1": 200.0, "r2": 60.0, "r3": 180.0, "r4": 140.0, "theta2": 60.0}
GUIDE = {"r1": 228.6, "theta1": 90.0, "r2": 114.3, "theta2": 135.0, "omega2": 10.0, "alpha2": 0.0}
#: What is quoted, as a lesson writes it, and the quantity that it is, over what divides it on paper.
QUOTED = {
    "positions": {
        r"r_A = \sqrt{r_1^2 + r_2^2 + 2\,r_1 r_2\sin\theta_2} = \num{319.80}": "slotted.rA",
        r"= \num{104.64}°": "slotted.theta4",
        r"a = \num{-61200}": "positions.a",
        r"b = \num{18706}": "positions.b",
        r"c = \num{-44400}": "positions.c",
        r"\num{29.07}°$": "positions.theta3_open",
        r"\num{-63.06}°$": "positions.theta3_crossed",
        r"\varphi = \num{163.00}": "positions.phi",
        r"\psi = \num{133.93}": "positions.psi",
    },
    "velocities": {
        r"ab = \num{37.8}": "motion.v_BA/10",
        r"p_v b = \num{33.7}": "motion.v_B/10",
        r"\omega_3 = \num{-2.10}": "motion.omega3",
        r"\omega_4 = \num{+2.41}": "motion.omega4",
        r"p_v a_4 = \num{49.3}": "slotted.v_guide/20",
        r"a_4 a = \num{28.9}": "slotted.slide/20",
        r"\dot r_A = -578": "slotted.rA_dot",
        r"\num{319.8} = \num{+3.08}": "slotted.omega4",
    },
    "accelerations": {
        r"V_{B/A}^2 / r_3 = 795": "motion.a_BA_n",
        r"b'b = \num{48.3}": "motion.a_BA_t/100",
        r"b''b = \num{61.4}": "motion.a_B_t/100",
        r"p_a b = \num{61.9}": "motion.a_B/100",
        r"= \num{26.8}": "motion.alpha3",
        r"V_{A_4}^2 / O_4A = 3041": "slotted.normal",
        r"V_{A/A_4} = 3563": "slotted.coriolis",
        r"a_4' a_4 = \num{11.1}": "slotted.tangential/200",
        r"a_4 k = \num{34.1}": "slotted.gain/200",
    },
}


@pytest.fixture(scope="module")
def solved(course):
    positions = course["four_bar_positions"].solve(**BARS)
    more = course["four_bar_positions"].solve(**BARS, only=("phi", "psi"))
    motion = course["four_bar_motion"].solve(**BARS, omega2=10.0, alpha2=0.0, mode="open")
    slotted = course["slotted_mechanism"].solve(**GUIDE)
    drawn = {
        "v_guide": slotted["rA"] * slotted["omega4"],
        "slide": -slotted["rA_dot"],
        "normal": -slotted["a_centripetal"],
        "coriolis": -slotted["a_coriolis"],
        "tangential": -slotted["rA"] * slotted["alpha4"],
        "gain": -slotted["rA_ddot"],
    }
    return {
        "positions": positions | more,
        "motion": motion | {"a_B_t": BARS["r4"] * motion["alpha4"]},
        "slotted": slotted | drawn,
    }


@each_row("lang", languages())
@each_row(("lesson", "quoted"), [(one, text) for one, texts in QUOTED.items() for text in texts])
def test_a_number_of_a_lesson_is_that_of_the_solution(course, solved, lesson, quoted, lang):
    assert quoted in lesson_file(course.folder, lesson, lang).read_text("utf-8")
    name, _, scale = QUOTED[lesson][quoted].partition("/")
    exercise, quantity = name.split(".")
    told = quoted.rpartition(r"\num{")[2].rpartition("= ")[2].rstrip("}°$")
    step = 10.0 ** -len(told.partition(".")[2])
    assert abs(float(told) - solved[exercise][quantity] / float(scale or 1)) <= 0.5 * step


def test_the_drawn_polygons_are_those_of_the_solutions(course, solved):
    lesson = course.folder.lesson_module("accelerations")
    _, n, m, b = lesson._images()
    assert abs(b - n) == pytest.approx(solved["motion"]["a_BA_t"], rel=1e-9)
    assert abs(b - m) == pytest.approx(solved["motion"]["a_B_t"], rel=1e-9)
    assert abs(b) == pytest.approx(solved["motion"]["a_B"], rel=1e-9)
    _, A, a, k, normal, own = lesson._slotted()
    along = A / abs(A)
    assert ((k - own) / along).real == pytest.approx(solved["slotted"]["rA_ddot"], rel=1e-9)
    assert ((own - normal) / (1j * A)).real == pytest.approx(solved["slotted"]["alpha4"], rel=1e-9)
    assert np.abs(((k - own) / along).imag) < 1e-6 * abs(a)
    *_, V_A, V_B = course.folder.lesson_module("velocities")._linkage()
    assert abs(V_B) == pytest.approx(solved["motion"]["v_B"], rel=1e-9)
    assert abs(V_B - V_A) == pytest.approx(solved["motion"]["v_BA"], rel=1e-9)


_FUNCTIONS = {
    "sin_": lambda t: math.sin(math.radians(t)),
    "cos_": lambda t: math.cos(math.radians(t)),
    "tan_": lambda t: math.tan(math.radians(t)),
}
_PRINTED = (
    (r"\\num\{([^{}]*)\}", r"\1"),
    (r"\\(?:mathrm|text)\{[^{}]*\}|\\(?:left|right|q?quad)|\\[,;!: ]|\^\\circ|[°~]", ""),
    (r"\\d?frac\{([^{}]*)\}\{([^{}]*)\}", r"((\1)/(\2))"),
    (r"\\sqrt\{([^{}]*)\}", r"((\1)**0.5)"),
    (r"\\(?:times|cdot)", "*"),
    (r"\^2", "**2"),
    (r"\\(cos|sin|tan)\s*\(?(-?[\d.]+)\)?", r"\1_(\2)"),
)


def computed(side: str) -> tuple[str, float | None]:
    """A side of a printed equation as an expression, and its value where it has numbers alone."""
    for pattern, plain in _PRINTED:
        side = re.sub(pattern, plain, side)
    side = side.strip(" .,;\n")
    if not re.fullmatch(r"(?=.*\d)(?:[\d.+*/() -]|(?:sin|cos|tan)_)+", side):
        return side, None
    try:
        return side, float(eval(side, {"__builtins__": {}}, _FUNCTIONS))
    except SyntaxError:  # a piece of a longer formula
        return side, None


@each_row("lang", languages())
def test_a_number_that_a_lesson_computes_is_that_of_the_numbers_before_it(course, lang):
    """Of every equation between numbers, to the last digit that it prints."""
    count, wrong = 0, []
    for name in course.folder.lessons:
        text = re.sub(
            r"```python.*?```", "", lesson_file(course.folder, name, lang).read_text("utf-8"), flags=re.S
        )
        for formula in map("".join, re.findall(r"\$\$(.+?)\$\$|\$(.+?)\$", text, re.S)):
            for equation in re.split(r"\\q?quad|,\s", formula):
                sides = [computed(side) for side in re.split(r"=|\\approx", equation)]
                for (left, value), (right, told) in pairwise(sides):
                    if value is None or told is None or not re.fullmatch(r"[+-]?\d+(\.\d+)?", right):
                        continue
                    count += 1
                    if abs(value - told) > 0.5 * 10.0 ** -len(right.partition(".")[2]) + 1e-9:
                        wrong.append(f"{name}: {left} = {value}, not {right}")
    assert not wrong
    assert count > 70
