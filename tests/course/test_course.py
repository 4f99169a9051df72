"""A course is a folder: opened by path, checked when opened, and never confused with another."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from tables import each_row

import coursework
from coursework.errors import (
    BadCourse,
    BadInput,
    CannotAssemble,
    Undefined,
    UnknownName,
    WrongUnit,
    WrongValue,
)
from coursework.linkages.linkage_file import ASKED
from coursework.rendering.renderer import renderer_of
from coursework.scenes.effects import EFFECTS

PACKAGE = Path(coursework.__file__).parent


def test_the_built_in_course_has_the_five_chapter_exercises(course):
    chapter = {"ball_reducer", "four_bar_positions", "quick_return", "slider_extras", "slotted_mechanism"}
    assert chapter <= set(course.names)


def test_two_courses_with_the_same_names_do_not_clash(course, tmp_path):
    from coursework.authoring.scaffold import new_exercise

    for root in ("a", "b"):
        new_exercise(tmp_path / root, "slotted_mechanism")
    one, two = coursework.open_course(tmp_path / "a"), coursework.open_course(tmp_path / "b")
    assert set(one["slotted_mechanism"].spec.given) == {"r", "theta", "omega"}
    assert one["slotted_mechanism"] is not two["slotted_mechanism"]
    assert "r1" in course["slotted_mechanism"].spec.given


def test_an_exercise_may_be_a_folder_with_its_assets(small_course):
    exercises = small_course / "exercises"
    (exercises / "crank_pin").mkdir()
    (exercises / "crank_pin.py").rename(exercises / "crank_pin" / "__init__.py")
    for lang in ("fr", "en"):
        (exercises / f"crank_pin.{lang}.md.j2").rename(exercises / "crank_pin" / f"crank_pin.{lang}.md.j2")
    course = coursework.open_course(small_course)
    assert course.names == ("crank_pin",)
    assert course["crank_pin"].variant(1).handout().title == "Un maneton"


def test_a_course_overrides_one_template_and_takes_the_others_from_the_built_in_one(small_course, course):
    template = small_course / "templates" / "sheet" / "sheet.html.j2"
    template.parent.mkdir()
    template.write_text("<p>{{ sheet.title }}, ours</p>", "utf-8")
    own = coursework.open_course(small_course)
    handout = own["crank_pin"].variant(1).handout()
    assert renderer_of(own.folder).html(handout) == "<p>Un maneton, ours</p>"
    assert renderer_of(own.folder).notebook(handout)


def test_exercises_never_import_solutions(course):
    files = list((course.folder.root / "exercises").rglob("*.py"))
    assert len(files) >= len(course)
    for path in files:
        text = path.read_text("utf-8")
        assert not re.search(r"^\s*(from|import)\s.*\bsolutions?\b", text, re.MULTILINE), path.name


def test_no_module_of_the_engine_names_an_exercise(course):
    # A scene's effect, or a question of a mechanism's file, may be called as an exercise is.
    named = re.compile(rf"""["']({"|".join(set(course.names) - {*EFFECTS, *ASKED})})["']""")
    for path in PACKAGE.rglob("*.py"):
        if "_course" in path.parts or path == PACKAGE / "__init__.py":
            continue  # the course itself, and the docstring that shows one of its exercises
        found = named.search(path.read_text("utf-8"))
        assert not found, f"{path.name} names {found[1]}"


def test_sys_path_is_left_alone(small_course):
    import sys

    before = list(sys.path)
    coursework.open_course(small_course)["crank_pin"].variant(0).solution()
    assert sys.path == before


# ------------------------------------------------------------------------- solving


def test_solve_as_the_contract_shows(course):
    exercise = course["slotted_mechanism"]
    theta2 = np.linspace(0, 360, 1000)
    found = exercise.solve(r1=228.6, theta1=90, r2=114.3, theta2=theta2, only=("rA", "theta4"))
    assert set(found) == {"rA", "theta4"}
    assert found["rA"].shape == (1000,)
    guide = 228.6j + 114.3 * np.exp(1j * np.radians(theta2))
    np.testing.assert_allclose(found["rA"], abs(guide), rtol=1e-13)
    np.testing.assert_allclose(found["theta4"], np.degrees(np.angle(guide)), rtol=1e-12)


def test_solve_takes_numbers_texts_lists_and_numpy_scalars(course):
    solve = course["slotted_mechanism"].solve
    expected = solve(r1=228.6, r2=114.3, theta2=135.0, only="rA")["rA"]
    assert isinstance(expected, float)
    for r2 in ("114.3", "114,3 mm", "0.1143 m", np.float64(114.3), np.array(114.3)):
        assert solve(r1=228.6, r2=r2, theta2=135, only="rA")["rA"] == expected
    assert solve(r1=228.6, r2=[114.3], theta2=135, only="rA")["rA"] == pytest.approx([expected])


def test_any_quantity_may_be_given_and_is_used_as_it_is(course):
    found = course["slotted_mechanism"].solve(omega4=2, rA_dot=10, only=("a_coriolis",))
    assert found == {"a_coriolis": 40}


@each_row(
    ("given", "error", "told"),
    [
        ({"r1": -1}, WrongValue, "r1 must be positive; found -1 mm"),
        ({"r1": 0}, WrongValue, "r1 must be positive"),
        ({"r1": np.array([1.0, -2.0])}, WrongValue, "r1 must be positive; found -2"),
        ({"r1": "3 kg"}, WrongUnit, "r1 is in mm"),
        ({"r1": "large"}, WrongValue, "r1 must be a number in mm"),
        ({"r1": "1,234"}, WrongValue, "1.234 or 1234"),
        ({"r1": None}, WrongValue, "r1 must be a number"),
        ({"r1": float("nan")}, WrongValue, "finite"),
        ({"r1": np.int64(-5)}, WrongValue, "r1 must be positive; found -5"),
        ({"r1": np.bool_(True)}, WrongValue, "r1 must be a number"),
        ({"r1": np.array(["a"])}, WrongValue, "r1 must be a number"),
        ({"r1": [1, None]}, WrongValue, "r1 must be a number"),
        ({"r1": [[1], [2, 3]]}, WrongValue, "r1 must be a number"),
        ({"r1": 1j}, WrongValue, "r1 must be a real number"),
        ({"r1": {}}, WrongValue, "r1 must be a number"),
        ({"r1": np.ones(3), "r2": np.ones(4)}, WrongValue, "r1 (3,), r2 (4,)"),
        ({"r7": 3}, UnknownName, "no quantity 'r7'"),
        ({"omega2": 0}, WrongValue, "omega2 must not be 0"),
    ],
)
def test_a_senseless_value_is_one_clear_error(course, given, error, told):
    with pytest.raises(error, match=re.escape(told)):
        course["slotted_mechanism"].solve(
            **{"r1": 200, "r2": 100, "theta2": 10, "omega2": 1, **given}, only=("omega4",)
        )


def test_what_does_not_close_raises_on_a_scalar_and_is_nan_there_and_only_there(course):
    exercise = course["four_bar_positions"]
    shape = {"r1": 300, "r2": 100, "r3": 150, "r4": 120}
    with pytest.raises(CannotAssemble, match=r"gap \d"):
        exercise.solve(**shape, theta2=180, only=("theta4_open",))
    assert issubclass(CannotAssemble, ValueError)
    theta2 = np.array([0.0, 180.0, 20.0, 150.0])
    found = exercise.solve(**shape, theta2=theta2, only=("theta4_open",))["theta4_open"]
    np.testing.assert_array_equal(np.isnan(found), [False, True, False, True])


def test_a_quantity_that_does_not_exist_says_so(course):
    with pytest.raises(Undefined, match="swing does not exist"):
        course["slotted_mechanism"].solve(r1=100, r2=200, only=("swing",))


def test_seeds_are_whole_numbers_from_zero_on(course):
    for seed in (-1, 1.5, "3", True):
        with pytest.raises(WrongValue, match="whole number from 0"):
            course["slotted_mechanism"].variant(seed)


# ------------------------------------------------------------------------- records


def test_a_record_is_checked_when_it_comes_back(course):
    exercise = course["slotted_mechanism"]
    record = exercise.variant(3).record
    with pytest.raises(BadInput, match="version 99"):
        exercise.from_record({**record, "version": 99})
    with pytest.raises(BadInput, match="'ball_reducer'"):
        exercise.from_record({**record, "exercise": "ball_reducer"})
    with pytest.raises(BadInput, match="r1"):
        exercise.from_record({**record, "given": {}})
    with pytest.raises(BadInput, match="not one of its values"):
        exercise.from_record({**record, "given": {**record["given"], "r1": {"value": "x", "unit": "mm"}}})


def test_a_record_is_marked_by_the_values_it_holds_not_by_its_seed(course):
    exercise = course["slotted_mechanism"]
    record = exercise.variant(3).record
    changed = {**record, "given": {**record["given"], "r1": {"value": 777.0, "unit": "mm"}}}
    assert exercise.from_record(changed).given["r1"] == 777.0


# ------------------------------------------------------------------- authors' slips


@pytest.mark.parametrize(
    ("file", "old", "new", "told"),
    [
        ("exercises/crank_pin.py", "EXERCISE = Exercise", "EXERCICE = Exercise", "states no EXERCISE"),
        ("exercises/crank_pin.py", 'Part("y"', 'Part("x"', "two parts are called 'x'"),
        ("exercises/crank_pin.py", "points=2", "points=-2", "points must be positive"),
        ("exercises/crank_pin.py", "points=2", 'kind="nombre"', "no kind 'nombre'"),
        (
            "exercises/crank_pin.py",
            "def pin_off_the_axes(theta)",
            "def pin_off_the_axes(tetha)",
            "needs tetha, which is not given; did you mean 'theta'",
        ),
        (
            "exercises/crank_pin.py",
            '"r": drawn(50, 200, step=5, unit="mm")',
            '"r": drawn(50, 200, unit="furlong")',
            ": the unit of r: no unit 'furlong'; units are",
        ),
        (
            "exercises/crank_pin.py",
            'Part("y", unit="mm")',
            'Part("y", unit="furlong")',
            "the unit of part 'y': no unit 'furlong'",
        ),
        (
            "solutions/crank_pin.py",
            "#: Values known",
            "UNITS = {'x': 'furlong'}\n#:",
            "solutions/crank_pin.py: UNITS of x: no unit 'furlong'",
        ),
        ("exercises/crank_pin.py", "import polar", "import poler", "poler"),
        ("solutions/crank_pin.py", '@mistake("x", "y")', '@mistake("x", "z")', "no quantity 'z'"),
        ("solutions/crank_pin.py", 'kind="constant"', "share=5", "between 0 and 1"),
        ("exercises/crank_pin.py", "O, A = 0, polar", "O, A = zero, polar", "figure (crank_pin.py, line"),
        (
            "exercises/crank_pin.py",
            "return theta % 90",
            "return tetha % 90",
            "pin_off_the_axes (crank_pin.py, line",
        ),
        ("solutions/crank_pin.py", "return r * omega\n", "return r * omegga\n", "v (crank_pin.py, line"),
        ("exercises/course.toml", "[title]", "title = 'Mine'\n[other]", "write [title]"),
        ("exercises/crank_pin.fr.md.j2", "{{ theta }}", "{{ theta + 1 }}", "an expression fails"),
        ("exercises/crank_pin.fr.md.j2", "# Un maneton", "Un maneton", "must begin with its title"),
        ("exercises/crank_pin.fr.md.j2", "## y", "## z", "has no section '## y'"),
        ("exercises/crank_pin.fr.md.j2", "{{ theta }}", "{{ tetha }}", "tetha"),
        ("exercises/crank_pin.fr.md.j2", "{{ theta }}", "{{ theta", "line"),
        ("exercises/crank_pin.fr.md.j2", "$x$", r"$\foo$", "foo"),
    ],
)
def test_an_authors_slip_names_its_file_and_what_would_do(small_course, file, old, new, told):
    path = small_course / file
    text = path.read_text("utf-8")
    assert old in text
    path.write_text(text.replace(old, new), "utf-8")
    with pytest.raises((BadCourse, UnknownName)) as caught:
        use(coursework.open_course(small_course))
    assert told in str(caught.value)


SLIPS_IN_GIVEN = {
    "chosen(4, 5)": (
        30,
        "the cases of chosen(…) are names in quotes; found 4, 5: numbers are drawn(low, high, step=…)",
    ),
    "chosen('a')": (30, "chosen(…) takes two cases or more, all different; found 'a'"),
    "fixed('5')": (30, "fixed(…) takes a number; found '5'"),
    "drawn('a', 5)": (
        30,
        "a bound of drawn(low, high) is a number or a function of quantities declared before; found 'a'",
    ),
    "drawn(5, 1)": (30, "drawn(low, high) takes the smaller bound first; found 5, 1"),
    "drawn(1, 5, step=0)": (30, "a step must be positive; found 0"),
    "5": (28, "r is given as drawn(…), chosen(…) or fixed(…); found 5"),
}


def test_what_is_given_wrongly_is_told_with_its_file_and_line(small_course):
    path = small_course / "exercises" / "crank_pin.py"
    text = path.read_text("utf-8").replace("Part, drawn", "Part, chosen, drawn, fixed")
    shutil.rmtree(small_course / "exercises" / "__pycache__", ignore_errors=True)
    found = {}
    for given in SLIPS_IN_GIVEN:
        path.write_text(text.replace('drawn(50, 200, step=5, unit="mm")', given), "utf-8")
        with pytest.raises(BadCourse) as caught:
            coursework.open_course(small_course)["crank_pin"]
        found[given] = str(caught.value)
    expected = {
        given: f"exercises/crank_pin.py: line {line}: {fault}"
        for given, (line, fault) in SLIPS_IN_GIVEN.items()
    }
    assert found == expected


def use(course):
    variant = course["crank_pin"].variant(0)
    renderer_of(course.folder).html(variant.handout())
    renderer_of(course.folder).pdf(variant.answer_sheet())


def test_what_every_variant_says_alike_is_known_without_a_variant(tmp_path):
    from coursework.course.texts import constants

    path = tmp_path / "x.en.md.j2"
    alike = (
        "# T\n\n{% for n in numbers %}{{ n }}{% endfor %}\n\n## a\nAlike.\n- I: one\n\n## b\n{{ r }} "
        "long.\n- I: {{ r }}\n"
    )
    path.write_text(alike + "\n## c\n{% if r %}Long.{% endif %}\n- I: other\n", "utf-8")
    assert constants(path).texts == {"a": "Alike."}
    assert constants(path).labels == {("a", "I"): "one"}
    path.write_text(alike + "{% for n in numbers %}\n## c\nRepeated.\n{% endfor %}\n", "utf-8")
    assert constants(path).texts == {}
