"""Draws: the same for ever, on the printed grid, uniform, bounded, and honest when they starve."""

from __future__ import annotations

import json
from collections import Counter

import numpy as np
import pytest
from golden import FILE, drawn
from hypothesis import given, settings
from hypothesis import strategies as st
from tables import each_row

from coursework.course.draws import Draws, _words
from coursework.errors import BadCourse, Starved
from coursework.issuing.issuing import distinct_variants
from coursework.model import Exercise, Part, chosen, fixed
from coursework.model import drawn as ranged

FROZEN = json.loads(FILE.read_text("utf-8"))


@each_row("name, frozen", FROZEN.items())
def test_seeds_draw_what_they_have_always_drawn(name, frozen, course):
    exercise = course[name]
    if frozen["version"] == exercise.version:
        assert drawn(exercise) == frozen
    else:
        assert frozen["version"] < exercise.version, "a version goes up, never down"


def test_raw_bits_are_those_of_the_published_function():
    """SHAKE-128 of the key, little-endian, as any other language gives it."""
    import hashlib

    expected = hashlib.shake_128(b"coursework/four_bar/2/7/3").digest(8 * 16 * 5)
    words = _words("four_bar", 2, 7, 3, 5)
    assert words.shape == (16, 5)
    assert [int(w) for w in words.ravel()] == [
        int.from_bytes(expected[i : i + 8], "little") for i in range(0, len(expected), 8)
    ]


def exercise_of(given, **more):
    return Exercise(given=given, parts=(Part("y"),), **more)


def values(name, exercise, count=4000):
    return [v[name] for v in Draws("test", exercise).draw(range(count))]


@given(st.integers(-400, 400), st.integers(1, 300), st.sampled_from(["0.1", "0.25", "0.5", "1", "2", "5"]))
@settings(max_examples=60)
def test_values_are_decimals_of_the_grid_within_the_range(low, steps, step):
    low, high = low * float(step), (low + steps) * float(step)
    exercise = exercise_of({"x": ranged(low, high, step=float(step))})
    for value in values("x", exercise, 50):
        assert low - 1e-9 <= value <= high + 1e-9
        assert float(f"{value:.2f}") == value
        assert abs(value / float(step) - round(value / float(step))) < 1e-9


def test_both_ends_of_a_range_are_drawn_and_all_is_equally_likely():
    counts = Counter(values("x", exercise_of({"x": ranged(10, 19)})))
    assert set(counts) == set(range(10, 20))
    # 4000 draws in 10 cells: chi-square of 9 degrees of freedom stays below 27.9 in 999 cases of 1000.
    assert sum((n - 400) ** 2 / 400 for n in counts.values()) < 27.9


def test_a_range_may_depend_on_what_was_drawn_before():
    exercise = exercise_of({"a": ranged(10, 20), "b": ranged(lambda a: 2 * a, lambda a: 3 * a)})
    for variant in Draws("test", exercise).draw(range(500)):
        assert 2 * variant["a"] <= variant["b"] <= 3 * variant["a"]


def test_zero_is_passed_over_where_it_is_refused():
    counts = Counter(values("x", exercise_of({"x": ranged(-2, 2, nonzero=True)})))
    assert set(counts) == {-2, -1, 1, 2}
    assert min(counts.values()) > 850


def test_cases_are_equally_likely():
    counts = Counter(values("mode", exercise_of({"mode": chosen("open", "crossed")})))
    assert set(counts) == {"open", "crossed"}
    assert abs(counts["open"] - 2000) < 200


def test_a_bound_that_is_not_drawn_before_is_named():
    with pytest.raises(BadCourse, match="range of a needs b"):
        exercise_of({"a": ranged(lambda b: b, 3), "b": ranged(1, 2)})


def test_a_step_must_be_a_decimal():
    with pytest.raises(BadCourse, match="decimal"):
        values("x", exercise_of({"x": ranged(0, 1, step=1 / 3)}), 1)


def test_a_step_too_fine_is_told():
    with pytest.raises(BadCourse, match="make the step coarser"):
        values("x", exercise_of({"x": ranged(1, 300, step=1e-8)}), 1)


def never(x):
    return x > 1000


def rarely(x):
    return x > 2


def test_starving_names_the_constraint_that_refuses():
    exercise = exercise_of({"x": ranged(1, 9)}, constraints=(rarely, never))
    with pytest.raises(Starved, match=r"refused by never \(4096 times\), rarely"):
        Draws("test", exercise).draw([3])


def test_a_constraint_refuses_what_is_fixed_as_well():
    """Only values that somebody states stand against the constraints."""
    exercise = exercise_of({"x": fixed(9)}, constraints=(never,))
    with pytest.raises(Starved, match=r"refused by never \(4096 times\)"):
        Draws("test", exercise).draw([3])
    assert Draws("test", exercise).draw([3], stated={"x": 9.0}) == [{"x": 9.0}]


def test_an_empty_range_is_named():
    given = {"x": ranged(1, 9), "y": ranged(lambda x: x + 10, 9), "z": ranged(lambda y: y, 9)}
    with pytest.raises(Starved, match=r"refused by range of y is empty \(4096 times\); widen"):
        Draws("test", exercise_of(given)).draw([3, 4])


def test_a_constraint_on_something_unknown_is_refused_at_once():
    exercise = exercise_of({"r": ranged(1, 9)}, constraints=(never,))
    with pytest.raises(BadCourse, match="never needs x"):
        Draws("test", exercise)


def constrained(small_course, code, *names):
    """The exercise of a new course, its constraints these beside its own."""
    import coursework

    path = small_course / "exercises" / "crank_pin.py"
    text = path.read_text("utf-8").replace("def figure(", f"{code}\n\n\ndef figure(")
    text = text.replace("import Exercise, Part, drawn", "import Exercise, Part, detectable, drawn")
    path.write_text(
        text.replace("constraints=(pin_off_the_axes,", f"constraints=(pin_off_the_axes, {', '.join(names)},")
    )
    return coursework.open_course(small_course)["crank_pin"]


def test_a_constraint_is_handed_what_the_solution_computes(small_course):
    exercise = constrained(small_course, "def pin_is_quick(v, r):\n    return v > 10 * r", "pin_is_quick")
    assert {v.given["omega"] > 10 for v in exercise.variants(range(30))} == {True}


def test_a_mistake_that_must_show_does_or_changes_nothing(small_course):
    exercise = constrained(small_course, "", 'detectable("sine_and_cosine_exchanged", "x", least=90)')
    cosines = [np.radians(v.given["theta"]) for v in exercise.variants(range(30))]
    shares = [abs(np.sin(a) / np.cos(a) - 1) for a in cosines]
    assert {share >= 0.9 or share <= 0.0025 + 1e-12 for share in shares} == {True}
    assert min(shares) < 1


UNUSABLE = {
    "def f(vv):\n    return vv > 0": "a constraint cannot be evaluated: f needs vv, which is not given",
    "def f(v):\n    return v > 0\n\n\nf.__name__ = 'x'": "x is a constraint and a quantity; "
    "rename the constraint",
}


@pytest.mark.parametrize("code", UNUSABLE)
def test_a_constraint_that_cannot_be_used_is_told(small_course, code):
    with pytest.raises(BadCourse) as caught:
        constrained(small_course, code, "f").variant(0)
    assert UNUSABLE[code] in str(caught.value)


def test_the_solution_computes_for_draws_alone_that_satisfy_the_other_constraints(small_course):
    code = "SEEN = []\n\n\ndef seen(x, theta):\n    SEEN.extend(theta)\n    return x == x"
    exercise = constrained(small_course, code, "seen")
    exercise.variants(range(20))
    seen = exercise.folder.module("exercises", "crank_pin").SEEN
    assert len(seen) > 20
    assert {theta % 90 >= 10 for theta in seen} == {True}


def test_variants_are_the_candidates_that_no_constraint_refuses(course):
    unlike = {}
    for name in course.names:
        drawing = course[name].draws
        candidates = drawing.first_candidates(256)
        refused = np.any([np.zeros(256, dtype=bool), *drawing.refused(candidates).values()], axis=0)
        if not np.array_equal(drawing.accepted(candidates), ~refused):
            unlike[name] = np.flatnonzero(drawing.accepted(candidates) == refused).tolist()
    assert unlike == {}


def test_population_counts_the_variants_that_exist():
    exercise = exercise_of(
        {"x": ranged(1, 9), "mode": chosen("p", "q"), "c": fixed(3)}, constraints=(rarely,)
    )
    assert Draws("test", exercise).population() == 7 * 2
    fine = exercise_of({"x": ranged(1, 9, step=0.001), "y": ranged(1, 9, step=0.001)})
    assert Draws("test", fine).population() is None


def test_distinct_variants_are_distinct_or_the_error_says_how_many_exist(small_course):
    import coursework

    path = small_course / "exercises" / "crank_pin.py"
    text = path.read_text("utf-8")
    text = text.replace("drawn(50, 200, step=5", "drawn(50, 60, step=5")
    path.write_text(
        text.replace("drawn(2, 20", "drawn(2, 3").replace("drawn(-175, 180, step=5", "drawn(20, 60, step=20")
    )
    exercise = coursework.open_course(small_course)["crank_pin"]
    assert exercise.draws.population() == 3 * 2 * 3
    drawn = distinct_variants(exercise, 0, 18, "fr")
    assert len({tuple(v.given.values()) for v in drawn}) == 18
    with pytest.raises(Starved, match="19 different variants requested, only 18 exist"):
        distinct_variants(exercise, 0, 19, "fr")
    refused = Counter()
    with pytest.raises(Starved, match="1 different variant requested, 0 found"):
        distinct_variants(exercise, 0, 1, "fr", refused, parts=())


def test_another_version_draws_something_else():
    one = exercise_of({"x": ranged(1, 1000)})
    two = exercise_of({"x": ranged(1, 1000)}, version=2)
    assert values("x", one, 20) != values("x", two, 20)


def test_draws_do_not_touch_numpys_random_state():
    np.random.seed(1)
    before = np.random.get_state()[1].copy()
    values("x", exercise_of({"x": ranged(1, 9)}), 10)
    assert (np.random.get_state()[1] == before).all()
