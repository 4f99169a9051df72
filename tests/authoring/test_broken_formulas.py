"""What an author writes for a number alone is told where it breaks: a choice by if on an array, a complex
answer."""

import numpy as np
import pytest

import coursework
from coursework.authoring.checks import check
from coursework.errors import BadCourse, BrokenFunction
from coursework.quantities.graph import Graph


def with_v(small_course, code):
    path = small_course / "solutions" / "crank_pin.py"
    path.write_text(path.read_text("utf-8").replace("    return r * omega\n", code), "utf-8")
    return coursework.open_course(small_course)["crank_pin"]


BRANCH = "    if omega > 10:\n        return r * omega\n    return omega * r\n"
TOLD = (
    "v (crank_pin.py, line 20) branches on an array, at line 21 of crank_pin.py: if omega > 10:; use "
    "np.where("
)


def test_a_choice_by_if_is_told_with_its_line_and_what_would_do(small_course):
    exercise = with_v(small_course, BRANCH)
    assert exercise.solve(r=2, omega=11, only="v") == {"v": 22}
    with pytest.raises(BrokenFunction) as told:
        exercise.solve(r=2, omega=np.array([1, 11]), only="v")
    assert str(told.value).startswith(TOLD)
    assert any(failure.startswith(TOLD) for failure in check(exercise, 5).failures)


def test_a_function_of_math_is_told_with_what_would_do(small_course):
    exercise = with_v(small_course, "    import math\n    return math.hypot(r * omega, 0)\n")
    assert exercise.solve(r=2, omega=11, only="v") == {"v": 22}
    (failure,) = check(exercise, 5).failures
    told = (
        "v (crank_pin.py, line 20) makes one number of an array, at line 22 of crank_pin.py: return "
        "math.hypot("
    )
    assert failure.startswith(told)
    assert "coursework.degrees" in failure


def test_a_choice_in_a_helper_is_told_by_the_line_of_the_helper():
    def helper(x):
        return 1 if x > 0 else -1

    def y(x):
        return helper(x)

    line = helper.__code__.co_firstlineno + 1
    with pytest.raises(BrokenFunction, match=rf"^y \(test_broken.* at line {line} of test_broken"):
        Graph({"y": y}).evaluate(("y",), {"x": np.array([1.0, -1.0])})


def test_a_complex_answer_is_told(small_course):
    exercise = with_v(small_course, "    return 1j * r * omega\n")
    told = (
        "v is a complex number, and part 'v' asks for a real one; return its .real, its .imag, abs(…) or "
        "angle(…)"
    )
    (failure,) = check(exercise, 5).failures
    assert failure.startswith(f"solutions/crank_pin.py: {told}")
    with pytest.raises(BadCourse, match="v is a complex number"):
        exercise.variant(1).grade({"v": "3"})
    assert exercise.solve(r=2, omega=3, only="v") == {"v": 6j}  # a request may want it


def test_a_part_of_a_turn_is_computed_in_degrees_and_printed_so(small_course):
    exercise = with_v(small_course, "    return r * omega * sin(180 / omega)\n")
    failures = [f for f in check(exercise, 5).failures if "printed formula" in f]
    assert failures == []
